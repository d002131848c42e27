//! The BRDF of water at one point: facets about a wave normal (Eqs. 56-61, 68-71), whitecaps, and their mixture.
//!
//! Directions are unit vectors away from the surface: `i` to the source, `o` to the observer,
//! `n` the wave normal, in coordinates with z up. A direction below the horizon of `n` gives 0.

use crate::Real;
use crate::optics::Reflectance;
use crate::real::{Vec3, dot};
use crate::shadowing::hidden;
use crate::slopes::gram_charlier;
use glam::DVec2;

/// The normal of a flat sea.
pub fn up<T: Real>() -> Vec3<T> {
    [T::of(0.0), T::of(0.0), T::of(1.0)]
}

/// Coefficients of the facets' lobe, f_SW of Eq. 56: what evaluation needs and nothing else.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Facets<T: Real> {
    /// Cosine of phi_W, the azimuth the wind comes from (Eq. 68).
    pub cos_wind: T::Wide,
    /// Sine of phi_W.
    pub sin_wind: T::Wide,
    /// Standard deviation of the facets' slope along the wind (Eq. 74).
    pub sigma_u: T::Wide,
    /// And across it (Eq. 75).
    pub sigma_c: T::Wide,
    /// `1/(2 pi sigma_u sigma_c)` times the 1/4 (or, as printed, pi/4) of Eq. 56.
    pub scale: T,
    /// Skewness c21 of Eq. 78.
    pub c21: T,
    /// Skewness c03 of Eq. 78.
    pub c03: T,
    /// Cosine of the tilt beyond which `exp(-xi^2/2 sigma^2)/cos^4 xi` would rise again ([`steep_facets`]).
    pub steep_cos: T,
    /// 1/cos^4 of that tilt.
    pub steep_gain: T,
    /// sigma of Eq. 64.
    pub sigma_shadow: T,
    /// What `rho G (1 + Lambda)` is held to ([`Facets::visible_bound`]).
    pub bound: T,
    /// Standard deviations of the proposal that [`crate::sampling`] draws tilts from.
    pub proposal_u: T,
    /// And across the wind.
    pub proposal_c: T,
    /// rho of Eqs. 62-63.
    pub reflectance: Reflectance<T::Wide>,
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
    pub cos: [T; 2],
    /// cos zeta (Eq. 61).
    pub cos_zeta: T::Wide,
    /// cos xi (Eq. 71).
    pub cos_xi: T::Wide,
    /// Sine-like and cosine-like parts of the signed tilt xi_u from normal to half vector (Eqs. 69-71).
    pub tilt_u: [T::Wide; 2],
    /// And of xi_c.
    pub tilt_c: [T::Wide; 2],
}

impl<T: Real> Facets<T> {
    #[inline(always)]
    fn geometry(&self, i: Vec3<T>, o: Vec3<T>, n: Vec3<T>) -> Geometry<T> {
        // alpha_u(H) - alpha_u(N) as one angle: its sine is a component of N x H, free of cancellation.
        let [iw, ow, nw] = [i, o, n].map(|v| v.map(T::wide));
        let hw = [iw[0] + ow[0], iw[1] + ow[1], iw[2] + ow[2]];
        let length = Real::max(dot(hw, hw).sqrt(), T::Wide::of(1e-300));
        let [hu, hc] = self.wind_frame(hw[0], hw[1]);
        let [nu, nc] = self.wind_frame(nw[0], nw[1]);
        let [xu, xc] = self.wind_frame(hw[0] * nw[2] - hw[2] * nw[0], hw[1] * nw[2] - hw[2] * nw[1]);
        let zz = hw[2] * nw[2];
        Geometry {
            cos: [dot(i, n), dot(o, n)],
            cos_zeta: Real::min(T::Wide::of(0.5) * length, T::Wide::of(1.0)),
            cos_xi: dot(hw, nw) / length,
            tilt_u: [xu, zz + hu * nu],
            tilt_c: [xc, zz + hc * nc],
        }
    }

    /// Components along W_u and W_c (Eq. 68) of a horizontal vector.
    #[inline(always)]
    fn wind_frame(&self, x: T::Wide, y: T::Wide) -> [T::Wide; 2] {
        [x * self.cos_wind + y * self.sin_wind, y * self.cos_wind - x * self.sin_wind]
    }

    /// A tilt in the density's measure: the angle, or its tangent; far out where there is none.
    #[inline(always)]
    fn measure(&self, [sine, cosine]: [T::Wide; 2]) -> T::Wide {
        if self.slope_measure {
            let (far, zero) = (T::Wide::of(1e6), T::Wide::of(0.0));
            T::Wide::select(T::Wide::lt(zero, cosine), sine / Real::max(cosine, T::Wide::TINY), far)
        } else {
            Real::atan2(sine, cosine)
        }
    }

    /// f_SW (Eq. 56), 1/sr.
    #[inline(always)]
    pub fn eval(&self, i: Vec3<T>, o: Vec3<T>, n: Vec3<T>) -> T {
        let g = self.geometry(i, o, n);
        let zero = T::of(0.0);
        let lit = T::lt(zero, g.cos[0]) & T::lt(zero, g.cos[1]);
        let value = T::min(self.density(&g), T::MAX) * self.visible_reflectance(&g, i, o, n);
        T::select(lit, T::min(value, T::MAX), zero)
    }

    /// `p/cos^4 xi` (Eqs. 72-73, 78-79) with the constants of Eq. 56.
    #[inline(always)]
    fn density(&self, g: &Geometry<T>) -> T {
        // Beyond 1000 sigma the density is 0 and its polynomial must not overflow.
        let far = T::Wide::of(1e3);
        let clamp = |x: T::Wide| Real::max(Real::min(x, far), -far);
        let u = clamp(-self.measure(g.tilt_u) / self.sigma_u);
        let c = clamp(self.measure(g.tilt_c) / self.sigma_c);
        self.scale * T::narrow(self.tilt_density(u, c, g.cos_xi))
    }

    /// `p/cos^4 xi` with the constants of Eq. 56, of facets along a unit `h` about the wave normal `n`.
    pub(crate) fn density_along(&self, h: Vec3<T>, n: Vec3<T>) -> T {
        self.density(&self.geometry(h, h, n))
    }

    /// `rho G`, 0 where `n` turns from one of the directions.
    pub(crate) fn shadowed_reflectance(&self, i: Vec3<T>, o: Vec3<T>, n: Vec3<T>) -> T {
        let g = self.geometry(i, o, n);
        let [ci, cr] = g.cos;
        let zero = T::of(0.0);
        let lit = T::lt(zero, ci) & T::lt(zero, cr);
        T::select(lit, self.visible_reflectance(&g, i, o, n) * ci * cr, zero)
    }

    /// The same over its constants, for tilts U and C in standard deviations.
    #[inline(always)]
    pub(crate) fn tilt_density(&self, u: T::Wide, c: T::Wide, cos_xi: T::Wide) -> T::Wide {
        let (u, c) = if self.as_printed { (u.abs(), c.abs()) } else { (u, c) };
        let cos2 = cos_xi * cos_xi;
        let gauss = Real::exp(T::Wide::of(-0.5) * (u * u + c * c));
        let mut p = gauss / Real::max(cos2 * cos2, T::Wide::TINY);
        if !self.slope_measure && !self.as_printed {
            let held = Real::max(gauss * self.steep_gain.wide(), T::Wide::of(STEEP_FLOOR));
            p = T::Wide::select(T::Wide::lt(cos_xi, self.steep_cos.wide()), Real::min(p, held), p);
        }
        if self.gram_charlier {
            let correction = gram_charlier(self.c21.wide(), self.c03.wide(), u, c, self.as_printed);
            p = p * Real::max(correction, T::Wide::of(0.0));
        }
        p
    }

    /// `rho G/(cos theta_i cos theta_r)` (Eqs. 61-67).
    #[inline(always)]
    fn visible_reflectance(&self, g: &Geometry<T>, i: Vec3<T>, o: Vec3<T>, n: Vec3<T>) -> T {
        let [ci, cr] = g.cos;
        let rho = T::narrow(self.reflectance.eval(g.cos_zeta));
        let one = T::of(1.0);
        let mut area = ci * cr;
        if self.shadowing {
            let sine = |c: T| T::max(one - c * c, T::of(0.0)).sqrt();
            area = area
                + cr * hidden(ci, self.sigma_shadow * sine(ci))
                + ci * hidden(cr, self.sigma_shadow * sine(cr));
        }
        let value = rho / T::max(area, T::TINY);
        if self.bounded { T::min(value, self.visible_bound(g.cos, i, o, n)) } else { value }
    }

    /// `bound/((1 + Lambda) cos_i cos_r)`, Lambda the larger of the two directions' by the facets' own
    /// slopes: what is reflected never exceeds what facets of this roughness leave visible. Eq. 64
    /// forgets the roughness that Eqs. 76-77 leave a calm sea; there this bound keeps the albedo below 1.
    #[inline(always)]
    fn visible_bound(&self, [ci, cr]: [T; 2], i: Vec3<T>, o: Vec3<T>, n: Vec3<T>) -> T {
        let sigma = [self.sigma_u, self.sigma_c].map(T::narrow);
        let visible = |c: T, v: Vec3<T>| {
            let [a, b] = self.stretched(v, n, sigma);
            c + hidden(c, T::of(std::f64::consts::SQRT_2) * (a * a + b * b).sqrt())
        };
        self.bound / T::max(T::max(visible(ci, i) * cr, visible(cr, o) * ci), T::TINY)
    }

    /// The horizontal part of `v` seen from `n`, stretched by standard deviations along and across the wind.
    #[inline(always)]
    fn stretched(&self, v: Vec3<T>, n: Vec3<T>, [sigma_u, sigma_c]: [T; 2]) -> [T; 2] {
        let (x, y) = (v[0] * n[2] - v[2] * n[0], v[1] * n[2] - v[2] * n[1]);
        let [u, c] = self.wind_frame(x.wide(), y.wide());
        [T::narrow(u) * sigma_u, T::narrow(c) * sigma_c]
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
    /// f_WC, BRDF of a whitecap (Eq. 55), 1/sr.
    pub whitecap_brdf: T,
}

impl<T: Real> Lobe<T> {
    /// f, 1/sr.
    #[inline(always)]
    pub fn eval(&self, i: Vec3<T>, o: Vec3<T>, n: Vec3<T>) -> T {
        self.eval_parts(i, o, n, Parts::ALL)
    }

    /// f of some of its parts, each with its share of the surface, 1/sr.
    #[inline(always)]
    pub fn eval_parts(&self, i: Vec3<T>, o: Vec3<T>, n: Vec3<T>, parts: Parts) -> T {
        let zero = T::of(0.0);
        let mut f = zero;
        if parts.facets {
            f = (T::of(1.0) - self.whitecap_fraction) * self.facets.eval(i, o, n);
        }
        if parts.whitecaps {
            let lit = T::lt(zero, dot(i, n)) & T::lt(zero, dot(o, n));
            f = f + T::select(lit, self.whitecap_fraction * self.whitecap_brdf, zero);
        }
        f
    }
}

impl Lobe<f64> {
    /// The same coefficients, rounded to another number type.
    pub fn cast<T: Real>(&self) -> Lobe<T> {
        let f = &self.facets;
        Lobe {
            facets: Facets {
                cos_wind: T::Wide::of(f.cos_wind),
                sin_wind: T::Wide::of(f.sin_wind),
                sigma_u: T::Wide::of(f.sigma_u),
                sigma_c: T::Wide::of(f.sigma_c),
                scale: T::of(f.scale),
                c21: T::of(f.c21),
                c03: T::of(f.c03),
                steep_cos: T::of(f.steep_cos),
                steep_gain: T::of(f.steep_gain),
                sigma_shadow: T::of(f.sigma_shadow),
                bound: T::of(f.bound),
                proposal_u: T::of(f.proposal_u),
                proposal_c: T::of(f.proposal_c),
                reflectance: Reflectance {
                    normal: T::Wide::of(f.reflectance.normal),
                    ior2: T::Wide::of(f.reflectance.ior2),
                    exact: f.reflectance.exact,
                },
                slope_measure: f.slope_measure,
                gram_charlier: f.gram_charlier,
                shadowing: f.shadowing,
                bounded: f.bounded,
                as_printed: f.as_printed,
            },
            whitecap_fraction: T::of(self.whitecap_fraction),
            whitecap_brdf: T::of(self.whitecap_brdf),
        }
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

/// What steep facets may count beside level ones, whatever their density.
pub const STEEP_FLOOR: f64 = 1e-6;

/// Where `exp(-xi^2/2 sigma^2)/cos^4 xi` starts to rise again (`xi/sigma^2 = 4 tan xi`), as a cosine,
/// and 1/cos^4 there, which is kept beyond (or [`STEEP_FLOOR`] where that is more). A Gaussian of tilt
/// angles is finite where facets stand upright and 1/cos^4 is not: unbounded, the albedo would pass 1
/// in a hurricane within a tenth of a degree of the horizon. Slopes need no such bound.
pub(crate) fn steep_facets(sigma: f64) -> [f64; 2] {
    let rises = |xi: f64| 4.0 * xi.tan() * sigma * sigma > xi;
    let (mut low, mut high) = (0.1, std::f64::consts::FRAC_PI_2);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if rises(middle) { high = middle } else { low = middle }
    }
    let cos = high.cos();
    [cos, cos.powi(-4)]
}
