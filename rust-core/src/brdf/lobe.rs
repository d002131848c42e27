//! The BRDF of water at one point: facets about a wave normal (Eqs. 56-61, 68-71), whitecaps, and their mixture.
//!
//! Directions are unit vectors away from the surface: `i` to the source, `o` to the observer,
//! `n` the wave normal, in coordinates with z up. A direction below the horizon of `n` gives 0; a coordinate that is not a
//! number gives none.

use super::fresnel::Reflectance;
use super::shadowing::hidden;
use super::slopes::gram_charlier;
use crate::numeric::real::{Wide, dot, each};
use crate::numeric::{Real, Scalar, Vec3};
use glam::DVec2;

/// The normal of a flat sea.
pub fn up<T: Real>() -> Vec3<T> {
    [T::of(0.0), T::of(0.0), T::of(1.0)]
}

/// The cosine of the angle to a wave normal, or a level surface's; to the last digit also where it is small, since f goes
/// with its inverse.
#[inline(always)]
pub(crate) fn cosine<T: Real>(v: Vec3<T>, n: Option<Vec3<T>>) -> T {
    let Some(n) = n else { return v[2] };
    let ([x, y, z], [nx, ny, nz]) = (each(v, T::Wide::widen), each(n, T::Wide::widen));
    (x * nx + y * ny + z * nz).narrow()
}

/// `f`, or not a number where a coordinate of the directions or one of their cosines to the normal is none: comparisons hide
/// it.
#[inline(always)]
pub(crate) fn defined<T: Real>(i: Vec3<T>, o: Vec3<T>, [ci, cr]: [T; 2], f: T) -> T {
    T::of(0.0).mul_add((i[0] + o[0]) + (i[1] + o[1]) + (ci + cr), f)
}

/// `x/cos^2`, finite.
#[inline(always)]
fn over_square<T: Real>(x: T, cos: T) -> T {
    let cos = T::max(cos, T::SMALL);
    x / (cos * cos)
}

/// The sine of a cosine's angle.
#[inline(always)]
fn sine<T: Real>(cos: T) -> T {
    T::max((-cos).mul_add(cos, T::of(1.0)), T::of(0.0)).sqrt()
}

/// The horizontal part of `v` seen from `n`.
#[inline(always)]
fn leaning<T: Real>(v: Vec3<T>, n: Vec3<T>) -> [T; 2] {
    [v[0] * n[2] - v[2] * n[0], v[1] * n[2] - v[2] * n[1]]
}

/// Coefficients of the facets' lobe, f_SW of Eq. 56: what evaluation needs and nothing else.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Facets<T: Real> {
    /// Cosine of phi_W, the azimuth the wind comes from (Eq. 68).
    pub cos_wind: T::Wide,
    /// Sine of phi_W.
    pub sin_wind: T::Wide,
    /// The wind comes from the azimuth 0: nothing is to be turned.
    pub along_x: bool,
    /// Standard deviation of the facets' slope along the wind (Eq. 74).
    pub sigma_u: T,
    /// And across it (Eq. 75).
    pub sigma_c: T,
    /// 1/sigma_u.
    pub inv_sigma_u: T::Wide,
    /// 1/sigma_c.
    pub inv_sigma_c: T::Wide,
    /// `1/(2 pi sigma_u sigma_c)` times the 1/4 (or, as printed, pi/4) of Eq. 56.
    pub scale: T,
    /// Skewness c21 of Eq. 78.
    pub c21: T::Fine,
    /// Skewness c03 of Eq. 78.
    pub c03: T::Fine,
    /// 1/cos^4 of the tilt beyond which `exp(-xi^2/2 sigma^2)/cos^4 xi` would rise again ([`steep_gain`]).
    pub steep_gain: T,
    /// sigma of Eq. 64.
    pub sigma_shadow: T,
    /// What `rho G (1 + Lambda)` is held to ([`Facets::visible_bound`]).
    pub bound: T,
    /// Standard deviations of the proposal that [`super::sampling`] draws tilts from.
    pub proposal_u: T,
    /// And across the wind.
    pub proposal_c: T,
    /// rho of Eqs. 62-63.
    pub reflectance: Reflectance<T::Fine>,
    /// The density is Gaussian in slopes, not in tilt angles.
    pub slope_measure: bool,
    /// Eq. 78 is applied.
    pub gram_charlier: bool,
    /// Eq. 67 is applied.
    pub shadowing: bool,
    /// `rho G` is held to what the facets themselves leave visible ([`Facets::visible_bound`]).
    pub bounded: bool,
    /// Unsigned angles (71-73) and the c21 term (78) as printed.
    pub as_printed: bool,
}

/// What the two directions and the normal fix, however the water is.
#[derive(Debug, Clone, Copy)]
struct Geometry<T: Real> {
    /// cos theta_i, cos theta_r (Eq. 60).
    cos: [T; 2],
    /// cos zeta (Eq. 61).
    cos_zeta: T::Fine,
    /// 1/cos^2 xi (Eq. 71).
    inv_cos2: T::Fine,
    /// Sine-like and cosine-like parts of the signed tilt xi_u from normal to half vector (Eqs. 69-71).
    tilt_u: [T::Wide; 2],
    /// And of xi_c.
    tilt_c: [T::Wide; 2],
    /// Horizontal parts of the two directions, seen from the normal.
    seen: [[T; 2]; 2],
    /// Finite; not a number where a coordinate is none.
    sum: T,
}

impl<T: Real> Geometry<T> {
    /// `f` where both directions are above the horizon, else 0; not a number where a coordinate is none, which comparisons
    /// would hide.
    #[inline(always)]
    fn above_horizon(&self, f: T) -> T {
        let zero = T::of(0.0);
        let lit = T::lt(zero, self.cos[0]) & T::lt(zero, self.cos[1]);
        zero.mul_add(self.sum, T::select(lit, f, zero))
    }
}

impl<T: Real> Facets<T> {
    /// About a wave normal, or a level surface's.
    #[inline(always)]
    fn geometry(&self, i: Vec3<T>, o: Vec3<T>, n: Option<Vec3<T>>) -> Geometry<T> {
        let (x, y, z) = (T::Wide::sum(i[0], o[0]), T::Wide::sum(i[1], o[1]), T::Wide::sum(i[2], o[2]));
        let h = each([x, y, z], T::Wide::fine);
        let length2 = dot(h, h);
        let cos_zeta = Real::min(T::Fine::of(0.5) * length2.sqrt(), T::Fine::of(1.0));
        let [hu, hc] = self.wind_frame(x, y);
        let Some(n) = n else {
            return Geometry {
                cos: [i[2], o[2]],
                cos_zeta,
                inv_cos2: T::Fine::of(1.0) + over_square(h[0].mul_add(h[0], h[1] * h[1]), h[2]),
                tilt_u: [hu, z],
                tilt_c: [hc, z],
                seen: [[i[0], i[1]], [o[0], o[1]]],
                sum: T::rounded(length2),
            };
        };
        // alpha_u(H) - alpha_u(N) as one angle: its sine is a component of N x H, free of cancellation.
        let [nx, ny, nz] = each(n, T::Wide::widen);
        let [nu, nc] = self.wind_frame(nx, ny);
        let [xu, xc] = self.wind_frame(x * nz - z * nx, y * nz - z * ny);
        let zz = z * nz;
        let cos = [cosine(i, Some(n)), cosine(o, Some(n))];
        Geometry {
            cos,
            cos_zeta,
            // N.V of the sum of both directions, without cancellation where both are small.
            inv_cos2: over_square(length2, cos[0].fine() + cos[1].fine()),
            tilt_u: [xu, zz + hu * nu],
            tilt_c: [xc, zz + hc * nc],
            seen: [leaning(i, n), leaning(o, n)],
            sum: T::rounded(length2) + cos[0],
        }
    }

    /// Components along W_u and W_c (Eq. 68) of a horizontal vector.
    #[inline(always)]
    pub(crate) fn wind_frame(&self, x: T::Wide, y: T::Wide) -> [T::Wide; 2] {
        if self.along_x {
            return [x, y];
        }
        [x * self.cos_wind + y * self.sin_wind, y * self.cos_wind - x * self.sin_wind]
    }

    /// A tilt in the density's measure: the angle, or its tangent; far out where there is none.
    #[inline(always)]
    fn measure(&self, [sine, cosine]: [T::Wide; 2]) -> T::Wide {
        if self.slope_measure { sine.slope(cosine) } else { sine.atan2(cosine) }
    }

    /// f_SW (Eq. 56), 1/sr.
    #[inline(always)]
    pub fn eval(&self, i: Vec3<T>, o: Vec3<T>, n: impl Into<Option<Vec3<T>>>) -> T {
        let g = self.geometry(i, o, n.into());
        g.above_horizon(self.lit(&g))
    }

    /// The same for directions above the horizon.
    #[inline(always)]
    fn lit(&self, g: &Geometry<T>) -> T {
        let value = T::min(self.density(g), T::MAX) * self.visible_reflectance(g);
        T::min(value, T::MAX)
    }

    /// `p/cos^4 xi` (Eqs. 72-73, 78-79) with the constants of Eq. 56.
    #[inline(always)]
    fn density(&self, g: &Geometry<T>) -> T {
        let u = -(self.measure(g.tilt_u) * self.inv_sigma_u);
        let c = self.measure(g.tilt_c) * self.inv_sigma_c;
        T::rounded(self.scale.fine() * self.tilt_density(u, c, g.inv_cos2))
    }

    /// `p/cos^4 xi` with the constants of Eq. 56, of facets along a unit `h` about the wave normal `n`.
    pub(crate) fn density_along(&self, h: Vec3<T>, n: impl Into<Option<Vec3<T>>>) -> T {
        self.density(&self.geometry(h, h, n.into()))
    }

    /// `rho G`, 0 where `n` turns from one of the directions.
    pub(crate) fn shadowed_reflectance(&self, i: Vec3<T>, o: Vec3<T>, n: impl Into<Option<Vec3<T>>>) -> T {
        let g = self.geometry(i, o, n.into());
        let [ci, cr] = g.cos;
        let zero = T::of(0.0);
        let lit = T::lt(zero, ci) & T::lt(zero, cr);
        T::select(lit, self.visible_reflectance(&g) * ci * cr, zero)
    }

    /// The same over its constants, for tilts U and C in standard deviations and 1/cos^2 of the whole tilt.
    #[inline(always)]
    pub(crate) fn tilt_density(&self, u: T::Wide, c: T::Wide, inv_cos2: T::Fine) -> T::Fine {
        let gauss = (T::Wide::of(-0.5) * (u * u + c * c)).exp();
        let inv_cos4 = inv_cos2 * inv_cos2;
        let mut p = gauss * inv_cos4;
        if !self.slope_measure && !self.as_printed {
            let gain = self.steep_gain.fine();
            let held = Real::max(gauss * gain, T::Fine::of(STEEP_FLOOR));
            p = T::Fine::select(gain.lt(inv_cos4), Real::min(p, held), p);
        }
        if self.gram_charlier {
            // Beyond 1000 sigma the density is 0 and its polynomial must not overflow.
            let (zero, far) = (T::Fine::of(0.0), T::Fine::of(1e3));
            let u = Real::max(Real::min(u.fine(), far), -far);
            let c = Real::max(Real::min(c.fine(), far), -far);
            let (u, c) = if self.as_printed { (u.abs(), c.abs()) } else { (u, c) };
            let correction = gram_charlier(self.c21, self.c03, u, c, self.as_printed);
            p = p * Real::max(correction, zero);
        }
        p
    }

    /// `rho G/(cos theta_i cos theta_r)` (Eqs. 61-67).
    #[inline(always)]
    fn visible_reflectance(&self, g: &Geometry<T>) -> T {
        let [ci, cr] = g.cos;
        let rho = T::rounded(self.reflectance.eval(g.cos_zeta));
        // A source on the horizon would have f, and the weight of a draw, without bound.
        let (ci, cr) = (T::max(ci, T::of(GRAZING)), T::max(cr, T::of(GRAZING)));
        let mut area = ci * cr;
        if self.shadowing {
            area = cr.mul_add(hidden(ci, self.sigma_shadow * sine(ci)), area);
            area = ci.mul_add(hidden(cr, self.sigma_shadow * sine(cr)), area);
        }
        let value = rho / T::max(area, T::TINY);
        if self.bounded { T::min(value, self.visible_bound(g)) } else { value }
    }

    /// `bound/((1 + Lambda) cos_i cos_r)`, Lambda the larger of the two directions' by the facets' own
    /// slopes: what is reflected never exceeds what facets of this roughness leave visible. Eq. 64
    /// forgets the roughness that Eqs. 76-77 leave a calm sea; there this bound keeps the albedo below 1.
    #[inline(always)]
    fn visible_bound(&self, g: &Geometry<T>) -> T {
        let ([ci, cr], [i, o]) = (g.cos, g.seen);
        let (shown_i, shown_o) =
            (ci + hidden(ci, self.spread_along(i)), cr + hidden(cr, self.spread_along(o)));
        self.bound / T::max(T::max(shown_i * cr, shown_o * ci), T::TINY)
    }

    /// sqrt 2 times the facets' standard deviation along a direction, times its sine.
    #[inline(always)]
    fn spread_along(&self, [x, y]: [T; 2]) -> T {
        let [u, c] = self.wind_frame(T::Wide::widen(x), T::Wide::widen(y));
        let (u, c) = (u.narrow() * self.sigma_u, c.narrow() * self.sigma_c);
        T::of(std::f64::consts::SQRT_2) * (u * u + c * c).sqrt()
    }
}

/// Which of the two lobes take part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Parts {
    /// The smooth water's facets.
    pub facets: bool,
    /// The whitecaps.
    pub whitecaps: bool,
}

impl Parts {
    /// The whole BRDF.
    pub const ALL: Self = Self { facets: true, whitecaps: true };
}

/// The BRDF of a point of the sea: `(1 - F_WC) f_SW + F_WC f_WC`, finite and non-negative.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Lobe<T: Real> {
    /// The facets of smooth water.
    pub facets: Facets<T>,
    /// F_WC, fraction of the water under whitecaps (Eq. 51); 0 where they are switched off.
    pub whitecap_fraction: T,
    /// 1 - F_WC, whose digits would be lost in a storm.
    pub smooth_fraction: T,
    /// f_WC, BRDF of a whitecap (Eq. 55), 1/sr.
    pub whitecap_brdf: T,
}

impl<T: Real> Lobe<T> {
    /// f, 1/sr.
    #[inline(always)]
    pub fn eval(&self, i: Vec3<T>, o: Vec3<T>, n: impl Into<Option<Vec3<T>>>) -> T {
        self.eval_parts(i, o, n, Parts::ALL)
    }

    /// f of some of its parts, each with its share of the surface, 1/sr.
    #[inline(always)]
    pub fn eval_parts(&self, i: Vec3<T>, o: Vec3<T>, n: impl Into<Option<Vec3<T>>>, parts: Parts) -> T {
        let g = self.facets.geometry(i, o, n.into());
        let mut f = T::of(0.0);
        if parts.facets {
            f = self.smooth_fraction * self.facets.lit(&g);
        }
        if parts.whitecaps {
            f = f + self.whitecap_fraction * self.whitecap_brdf;
        }
        g.above_horizon(f)
    }
}

impl<S: Scalar> Lobe<S> {
    /// The same facets under other whitecaps.
    pub fn with_whitecaps(self, fraction: S) -> Self {
        Self { whitecap_fraction: fraction, smooth_fraction: S::of(1.0) - fraction, ..self }
    }

    /// The same coefficients as another number type.
    pub fn cast<T: Real>(&self) -> Lobe<T> {
        let f = &self.facets;
        let of = |x: S| T::of(x.to_f64());
        Lobe {
            facets: Facets {
                cos_wind: T::Wide::of(f.cos_wind),
                sin_wind: T::Wide::of(f.sin_wind),
                along_x: f.along_x,
                sigma_u: of(f.sigma_u),
                sigma_c: of(f.sigma_c),
                inv_sigma_u: T::Wide::of(f.inv_sigma_u),
                inv_sigma_c: T::Wide::of(f.inv_sigma_c),
                scale: of(f.scale),
                c21: T::Fine::of(f.c21),
                c03: T::Fine::of(f.c03),
                steep_gain: of(f.steep_gain),
                sigma_shadow: of(f.sigma_shadow),
                bound: of(f.bound),
                proposal_u: of(f.proposal_u),
                proposal_c: of(f.proposal_c),
                reflectance: Reflectance {
                    normal: T::Fine::of(f.reflectance.normal),
                    excess: T::Fine::of(f.reflectance.excess),
                    exact: f.reflectance.exact,
                },
                slope_measure: f.slope_measure,
                gram_charlier: f.gram_charlier,
                shadowing: f.shadowing,
                bounded: f.bounded,
                as_printed: f.as_printed,
            },
            whitecap_fraction: of(self.whitecap_fraction),
            smooth_fraction: of(self.smooth_fraction),
            whitecap_brdf: of(self.whitecap_brdf),
        }
    }
}

impl<S: Scalar> Facets<S> {
    /// Turns the wind to another azimuth, in degrees.
    pub(crate) fn turn(&mut self, degrees: f64) {
        (self.sin_wind, self.cos_wind) = degrees.to_radians().sin_cos();
        self.along_x = self.sin_wind == 0.0 && self.cos_wind == 1.0;
    }

    /// Gives the facets other standard deviations of slope, along and across the wind, and Eq. 56's constant with the 2 pi
    /// of the density, `scale`.
    pub(crate) fn set_sigmas(&mut self, [u, c]: [f64; 2], scale: f64) {
        (self.sigma_u, self.sigma_c) = (S::of(u), S::of(c));
        (self.inv_sigma_u, self.inv_sigma_c) = (1.0 / u, 1.0 / c);
        self.scale = S::of(scale / (u * c));
    }
}

/// `rho G (1 + Lambda)` up to which the bound is left out: Eq. 64 and Eqs. 76-77 differ by up to
/// 1.105 even in a gale, where the albedo is far from 1.
pub(crate) const BOUND_SLACK: f64 = 1.11;

impl Facets<f64> {
    /// How far, in slope upwind and crosswind, a wave's slope may be from a facet's: a tilt's standard deviation there.
    pub(crate) fn spread(&self, facet: DVec2) -> DVec2 {
        let widened = if self.slope_measure { DVec2::ONE } else { DVec2::ONE + facet * facet };
        DVec2::new(self.sigma_u, self.sigma_c) * widened
    }

    /// Whether [`Facets::visible_bound`] matters: scanned over both elevations, with the largest
    /// reflectance (forward) and the rougher azimuth. Above w* = 9 cm/s (for an infinite footprint; below
    /// for smaller ones) it does not, and costs nothing.
    pub(crate) fn needs_bound(&self) -> bool {
        const STEPS: i32 = 64;
        let spread = std::f64::consts::SQRT_2 * self.sigma_u.max(self.sigma_c);
        // Elevations from 90 degrees down to 1e-4, evenly in their logarithm.
        let elevation = |k: i32| (90.0 * 10f64.powf(-6.0 * f64::from(k) / f64::from(STEPS))).to_radians();
        let f = |e: f64, s: f64| hidden(e.sin(), s * e.cos()) / e.sin();
        (0..=STEPS).any(|a| {
            (0..=a).any(|b| {
                let (low, high) = (elevation(a), elevation(b));
                let rho = self.reflectance.eval((0.5 * (low + high)).sin());
                let g = 1.0 / (1.0 + f(low, self.sigma_shadow) + f(high, self.sigma_shadow));
                rho * g * (1.0 + f(low, spread)) > BOUND_SLACK
            })
        })
    }
}

/// Smallest cosine to the source that is told from 0: 1e-10 degrees above the horizon.
pub(crate) const GRAZING: f64 = 1e-12;

/// What steep facets may count beside level ones, whatever their density.
pub const STEEP_FLOOR: f64 = 1e-6;

/// 1/cos^4 where `exp(-xi^2/2 sigma^2)/cos^4 xi` starts to rise again (`xi/sigma^2 = 4 tan xi`), which is kept beyond (or
/// [`STEEP_FLOOR`] where that is more). A Gaussian of tilt angles is finite where facets stand upright and 1/cos^4 is not:
/// unbounded, the albedo would pass 1 in a hurricane within a tenth of a degree of the horizon. Slopes need no such bound.
pub(crate) fn steep_gain(sigma: f64) -> f64 {
    let rises = |xi: f64| 4.0 * xi.tan() * sigma * sigma > xi;
    let (mut low, mut high) = (0.1, std::f64::consts::FRAC_PI_2);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if rises(middle) { high = middle } else { low = middle }
    }
    high.cos().powi(-4)
}
