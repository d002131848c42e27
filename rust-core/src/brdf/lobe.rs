//! The BRDF of water at one point: facets about a wave normal and the density of their tilts
//! (Eqs. 56, 59-61, 68-73, 79), whitecaps, and their mixture.
//!
//! Directions are unit vectors away from the surface: `i` to the source, `o` to the observer,
//! `n` the wave normal, in coordinates with z up. A direction below the horizon of `n` gives 0. NaN in, NaN out.

use super::fresnel::Reflectance;
use super::shadowing::{cos_lambda, printed_excess};
use super::slopes::{GramCharlier, WIDTH};
use crate::numeric::real::{Extended, dot};
use crate::numeric::{Real, Scalar, Vec3};
use crate::readings::Readings;
use glam::DVec2;
use std::f64::consts::SQRT_2;

/// The normal of a flat sea.
pub fn up<T: Real>() -> Vec3<T> {
    [T::of(0.0), T::of(0.0), T::of(1.0)]
}

/// The cosine of the angle to a wave normal; in extended precision to the last digit also where it is small, since f goes with its
/// inverse.
#[inline(always)]
pub(crate) fn cosine<T: Real, E: Extended<T>>(v: Vec3<T>, n: Vec3<T>) -> T {
    let [x, y, z] = [E::from_real(v[0]), E::from_real(v[1]), E::from_real(v[2])];
    let [nx, ny, nz] = [E::from_real(n[0]), E::from_real(n[1]), E::from_real(n[2])];
    let one = E::from_real(T::of(1.0));
    E::sum_of_products(z, nz, E::sum_of_products(x, nx, y, ny), one).normalize().to_real()
}

/// `f`; NaN where a coordinate of the directions or one of their cosines to the normal is NaN, which comparisons hide.
#[inline(always)]
pub(crate) fn defined<T: Real>(i: Vec3<T>, o: Vec3<T>, [ci, cr]: [T; 2], f: T) -> T {
    T::of(0.0).mul_add((i[0] + o[0]) + (i[1] + o[1]) + (ci + cr), f)
}

/// cos zeta (Eq. 61), at most 1, of the sum of two unit vectors.
#[inline(always)]
pub(crate) fn cos_zeta<T: Real>(sum: Vec3<T>) -> T {
    T::min(T::of(0.5) * dot(sum, sum).sqrt(), T::of(1.0))
}

/// `sin theta` of `cos theta`.
#[inline(always)]
pub(crate) fn sine<T: Real>(cos: T) -> T {
    T::max((-cos).mul_add(cos, T::of(1.0)), T::of(0.0)).sqrt()
}

/// `v` along the tangents `(n_z, 0, -n_x)` and `(0, n_z, -n_y)`: `n x v` without its vertical component, turned by 90 degrees. Its
/// length is `sin theta` where `n` is vertical or in the plane of `v` and the vertical.
#[inline(always)]
fn tangential_part<T: Real>(v: Vec3<T>, n: Vec3<T>) -> [T; 2] {
    [v[0] * n[2] - v[2] * n[0], v[1] * n[2] - v[2] * n[1]]
}

/// The axes that slopes are told along: W_u, where the wind comes from, and W_c across it (Eq. 68).
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct WindAxes<T: Real> {
    /// Cosine of phi_W, the azimuth the wind comes from.
    pub cos: T::Extended,
    /// Its sine.
    pub sin: T::Extended,
    /// `Some(k)` where the azimuth is k quarter turns: components are exchanged exactly.
    pub quadrant: Option<u8>,
}

impl WindAxes<f64> {
    /// Of an azimuth in degrees.
    pub fn new(azimuth: f64) -> Self {
        let (sin, cos) = azimuth.to_radians().sin_cos();
        let axes = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
        let along = |[x, y]: &[f64; 2]| (cos - x).abs() + (sin - y).abs() < 1e-14;
        Self { cos, sin, quadrant: axes.iter().position(along).map(|k| k as u8) }
    }
}

impl<S: Scalar> WindAxes<S> {
    /// The same axes in another number type.
    pub fn cast<T: Real>(&self) -> WindAxes<T> {
        let of = T::Extended::coefficient;
        WindAxes { cos: of(self.cos), sin: of(self.sin), quadrant: self.quadrant }
    }
}

impl<T: Real> WindAxes<T> {
    /// Components along W_u and W_c of a horizontal vector.
    #[inline(always)]
    pub fn components<E: Extended<T>>(&self, x: E, y: E) -> [E; 2] {
        match self.quadrant {
            Some(0) => [x, y],
            Some(1) => [y, -x],
            Some(2) => [-x, -y],
            Some(_) => [-y, x],
            None => {
                let (cos, sin) = (E::truncate(self.cos), E::truncate(self.sin));
                let u = E::sum_of_products(x, cos, y, sin).normalize();
                [u, E::sum_of_products(y, cos, -x, sin).normalize()]
            }
        }
    }

    /// The same for a vector whose last digits do not matter.
    #[inline(always)]
    pub fn to_wind(&self, [x, y]: [T; 2]) -> [T; 2] {
        let [x, y] = [T::Plain::from_real(x), T::Plain::from_real(y)];
        let [u, c] = self.components(x, y);
        [u.to_real(), c.to_real()]
    }

    /// The horizontal vector of components along W_u and W_c.
    #[inline(always)]
    pub fn to_world(&self, [u, c]: [T; 2]) -> [T; 2] {
        match self.quadrant {
            Some(0) => [u, c],
            Some(1) => [-c, u],
            Some(2) => [-u, -c],
            Some(_) => [c, -u],
            None => {
                let (cos, sin) = (self.cos.to_real(), self.sin.to_real());
                [u * cos - c * sin, u.mul_add(sin, c * cos)]
            }
        }
    }

    /// [`WindAxes::to_wind`] of a vector with a height.
    #[inline(always)]
    pub(crate) fn vector_to_wind(&self, v: Vec3<T>) -> Vec3<T> {
        let [u, c] = self.to_wind([v[0], v[1]]);
        [u, c, v[2]]
    }
}

/// Coefficients of the facets' lobe, f_SW of Eq. 56: what evaluation needs and nothing else. The first ones differ from
/// footprint to footprint.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Facets<T: Real> {
    /// Standard deviation of the facets' slope along the wind (Eq. 74).
    pub sigma_u: T,
    /// And across it (Eq. 75).
    pub sigma_c: T,
    /// The inverse of [`WIDTH`] times sigma_u: tilts in these widths make the Gaussian a power of 2.
    pub inv_width_u: T::Extended,
    /// And of sigma_c.
    pub inv_width_c: T::Extended,
    /// `1/(2 pi sigma_u sigma_c)` times the 1/4 (or, as printed, pi/4) of Eq. 56.
    pub scale: T,
    /// 1/cos^4 of the tilt beyond which `exp(-xi^2/2 sigma^2)/cos^4 xi` would rise again ([`steep_gain`]).
    pub steep_gain: T,
    /// What `rho G (1 + Lambda)` is held to ([`Facets::projected_area`]).
    pub bound: T,
    /// Standard deviations of the proposal that [`crate::sampling`] draws tilts from, along and across the wind.
    pub proposal: [T; 2],
    /// `rho G` is held to what the facets themselves leave visible ([`Facets::projected_area`]).
    pub bounded: bool,
    /// Where the wind comes from.
    pub wind: WindAxes<T>,
    /// Eq. 78.
    pub correction: GramCharlier<T::Density>,
    /// sigma of Eq. 64.
    pub sigma_shadow: T,
    /// Shadowing has the facets' own slopes, along each direction, in place of Eq. 64's.
    pub own_shadows: bool,
    /// rho of Eqs. 62-63.
    pub reflectance: Reflectance<T::Density>,
    /// The density is Gaussian in slopes, not in tilt angles.
    pub slope_measure: bool,
    /// Eq. 78 is applied.
    pub gram_charlier: bool,
    /// Eq. 67 is applied.
    pub shadowing: bool,
    /// The equations that are taken as printed.
    pub readings: Readings,
}

/// What the two directions and the normal fix, however the water is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Geometry<T: Real, E> {
    /// cos theta_i, cos theta_r (Eq. 60).
    pub cos: [T; 2],
    /// cos zeta (Eq. 61).
    pub cos_zeta: T::Density,
    /// tan^2 xi (Eq. 71).
    pub tan2: T::Density,
    /// 1/cos^2 xi.
    pub inv_cos2: T::Density,
    /// Sine-like and cosine-like parts of the signed tilts xi_u and xi_c from normal to half vector (Eqs. 69-71).
    tilt: [[E; 2]; 2],
    /// The same tilts as slopes.
    pub slope: [T; 2],
    /// The source along the wind, across it and along the normal.
    pub local_i: Vec3<T>,
    /// Tangential parts of the two directions.
    tangential: [[T; 2]; 2],
    /// Finite; NaN in, NaN out.
    nan_probe: T,
}

impl<T: Real, E> Geometry<T, E> {
    /// `f` where both directions are above the horizon, else 0; NaN in, NaN out, which comparisons
    /// would hide.
    #[inline(always)]
    pub fn above_horizon(&self, f: T) -> T {
        let zero = T::of(0.0);
        let upper = T::lt(zero, self.cos[0]) & T::lt(zero, self.cos[1]);
        zero.mul_add(self.nan_probe, T::select(upper, f, zero))
    }
}

impl<T: Real> Facets<T> {
    /// Whether a value of the density asks for more digits than `T` has: for Gram-Charlier's polynomial, and where parts nearly
    /// cancel, which an oblique wind turns or a wave's normal leans from.
    #[inline(always)]
    pub(crate) fn needs_extended(&self, level: bool) -> bool {
        self.gram_charlier || self.wind.quadrant.is_none() || !level
    }

    /// About a wave normal, or a level surface's.
    #[inline(always)]
    pub(crate) fn geometry<E: Extended<T>>(
        &self,
        i: Vec3<T>,
        o: Vec3<T>,
        n: Option<Vec3<T>>,
    ) -> Geometry<T, E> {
        let (x, y, z) = (E::sum(i[0], o[0]), E::sum(i[1], o[1]), E::sum(i[2], o[2]));
        let [dx, dy, dz] = [x.to_density(), y.to_density(), z.to_density()];
        let flat2 = dx.mul_add(dx, dy * dy);
        let length2 = dz.mul_add(dz, flat2);
        let one = T::Density::of(1.0);
        let cos_zeta = Real::min(T::Density::of(0.5) * length2.sqrt(), one);
        let [hu, hc] = self.wind.components(x, y);
        let Some(n) = n else {
            let z = z.at_least(T::SMALL);
            let inv_z = z.to_density().recip();
            let tan2 = flat2 / (z.to_density() * z.to_density());
            return Geometry {
                cos: [i[2], o[2]],
                cos_zeta,
                tan2,
                inv_cos2: one + tan2,
                tilt: [[hu, z], [hc, z]],
                slope: [T::from_density(hu.to_density() * inv_z), T::from_density(hc.to_density() * inv_z)],
                local_i: self.wind.vector_to_wind(i),
                tangential: [[i[0], i[1]], [o[0], o[1]]],
                nan_probe: T::from_density(length2),
            };
        };
        // alpha_u(H) - alpha_u(N) as one angle: its sine is a component of N x H, free of cancellation.
        let [nx, ny, nz] = [E::from_real(n[0]), E::from_real(n[1]), E::from_real(n[2])];
        let [nu, nc] = self.wind.components(nx, ny);
        let across_x = E::sum_of_products(x, nz, z, -nx).normalize();
        let [xu, xc] = self.wind.components(across_x, E::sum_of_products(y, nz, z, -ny).normalize());
        let along_u = E::sum_of_products(hu, nu, z, nz).normalize();
        let along_c = E::sum_of_products(hc, nc, z, nz).normalize();
        let frame = self.frame(n);
        let h = [i[0] + o[0], i[1] + o[1], i[2] + o[2]];
        let local_i = [dot(frame[0], i), dot(frame[1], i), dot(frame[2], i)];
        let [u, c, along_n] = [dot(frame[0], h), dot(frame[1], h), dot(frame[2], h)];
        let inv_n = T::max(along_n, T::SMALL).recip();
        let slope = [u * inv_n, c * inv_n];
        let tan2 = T::to_density(slope[0].mul_add(slope[0], slope[1] * slope[1]));
        let cos = [cosine::<T, E>(i, n), cosine::<T, E>(o, n)];
        let mut tilt = [[xu, along_u], [xc, along_c]];
        if self.readings.contains(Readings::EQ_70) {
            let z = z.at_least(T::SMALL);
            tilt = [[hu, z], [hc, z]];
        }
        // N.V of the sum of both directions, without cancellation where both are small.
        let sum_n = Real::max(cos[0].to_density() + cos[1].to_density(), T::Density::SMALL);
        Geometry {
            cos,
            cos_zeta,
            tan2,
            inv_cos2: length2 / (sum_n * sum_n),
            tilt,
            slope,
            local_i,
            tangential: [tangential_part(i, n), tangential_part(o, n)],
            nan_probe: T::from_density(length2) + dot(i, n),
        }
    }

    /// A tilt in the density's measure: the angle, or its tangent, clamped to [`MAX_SLOPE`].
    #[inline(always)]
    fn measure<E: Extended<T>>(&self, [sine, cosine]: [E; 2], level: bool) -> E {
        if level {
            return if self.slope_measure { sine.over(cosine) } else { sine.atan(cosine) };
        }
        if !self.slope_measure {
            return sine.atan2(cosine);
        }
        let steep = cosine.to_density().lt(T::Density::TINY);
        let slope = sine.over(cosine.at_least(T::TINY));
        E::select(steep, E::from_real(T::of(MAX_SLOPE)), slope)
    }

    /// f_SW (Eq. 56), 1/sr.
    #[inline(always)]
    pub fn eval(&self, i: Vec3<T>, o: Vec3<T>, n: impl Into<Option<Vec3<T>>>) -> T {
        let n = n.into();
        let g = self.geometry::<T::Extended>(i, o, n);
        g.above_horizon(self.eval_above(&g, n.is_none()))
    }

    /// The same for directions above the horizon: `D rho G/(4 cos theta_i cos theta_r)` with `D = p/cos^4 xi`.
    #[inline(always)]
    pub(crate) fn eval_above<E: Extended<T>>(&self, g: &Geometry<T, E>, level: bool) -> T {
        let density = self.density(g, level);
        let rho = T::from_density(self.reflectance.eval(g.cos_zeta));
        let area = T::max(self.projected_area(g, rho), T::TINY);
        T::min(T::min(T::from_density(density), T::MAX) * (rho * self.scale) / area, T::MAX)
    }

    /// `p/cos^4 xi` (Eqs. 72-73, 78-79) without its factor `1/(2 pi sigma_u sigma_c)`.
    #[inline(always)]
    fn density<E: Extended<T>>(&self, g: &Geometry<T, E>, level: bool) -> T::Density {
        let [u, c] = [self.measure(g.tilt[0], level), self.measure(g.tilt[1], level)];
        let u = u.times(E::truncate(self.inv_width_u));
        self.tilt_density(u, c.times(E::truncate(self.inv_width_c)), g.inv_cos2)
    }

    /// `p/cos^4 xi` with the constants of Eq. 56, of facets along a unit `h` about the wave normal `n`.
    pub(crate) fn density_along(&self, h: Vec3<T>, n: impl Into<Option<Vec3<T>>>) -> T {
        let n = n.into();
        let density = self.density(&self.geometry::<T::Extended>(h, h, n), n.is_none());
        T::from_density(density * self.scale.to_density())
    }

    /// The same for tilts in widths ([`WIDTH`]) and 1/cos^2 of the whole tilt.
    #[inline(always)]
    pub(crate) fn tilt_density<E: Extended<T>>(&self, u: E, c: E, inv_cos2: T::Density) -> T::Density {
        let (zero, floor) = (T::Density::of(0.0), T::Density::of(STEEP_FLOOR));
        // Slopes have no end; the polynomial must not overflow.
        let [mut u, c] = if self.slope_measure { [u.clamp(MAX_TILT), c.clamp(MAX_TILT)] } else { [u, c] };
        if self.readings.contains(Readings::EQ_71_73) {
            u = E::select(zero.lt(u.to_density()), -u, u);
        }
        let gauss = E::gauss(u, c);
        let mut p = gauss * (inv_cos2 * inv_cos2);
        if !self.slope_measure && !self.readings.contains(Readings::EQ_71_73) {
            p = Real::min(p, Real::max(gauss * self.steep_gain.to_density(), floor));
        }
        if self.gram_charlier {
            let (high_u, high_c) = (u.to_density(), c.to_density());
            let correction = self.correction.eval(high_u, high_c);
            p = p * Real::max(u.corrected(correction, self.correction.steepest(high_u)), zero);
        }
        p
    }

    /// `rho G`, 0 where `n` turns from one of the directions.
    pub(crate) fn shadowed_reflectance(&self, i: Vec3<T>, o: Vec3<T>, n: impl Into<Option<Vec3<T>>>) -> T {
        let g = self.geometry::<T::Plain>(i, o, n.into());
        let [ci, cr] = g.cos;
        let zero = T::of(0.0);
        let upper = T::lt(zero, ci) & T::lt(zero, cr);
        let rho = T::from_density(self.reflectance.eval(g.cos_zeta));
        T::select(upper, rho * ci * cr / T::max(self.projected_area(&g, rho), T::TINY), zero)
    }

    /// `cos theta_i cos theta_r/G` (Eqs. 64-67).
    #[inline(always)]
    fn projected_area<E>(&self, g: &Geometry<T, E>, rho: T) -> T {
        let cos = [T::max(g.cos[0], T::of(GRAZING)), T::max(g.cos[1], T::of(GRAZING))];
        let mut spreads = [T::of(0.0); 2];
        if self.needs_spreads() {
            spreads = [self.alpha_along(g.tangential[0]), self.alpha_along(g.tangential[1])];
        }
        self.masked_area(rho, cos, spreads)
    }

    /// `cos theta_i cos theta_r/G`, held to `rho/bound` times the larger of `(1 + Lambda) cos_i cos_r` of the two directions,
    /// Lambda by the facets' own slopes: what is reflected never exceeds what facets of this roughness leave visible. Eq. 64
    /// forgets the roughness that Eqs. 76-77 leave a calm sea; there this bound keeps the albedo below 1. It needs `spreads`, the
    /// [`Facets::alpha_along`] of both, and so do [`Facets::own_shadows`].
    #[inline(always)]
    pub(crate) fn masked_area(&self, rho: T, [ci, cr]: [T; 2], [spread_i, spread_o]: [T; 2]) -> T {
        let mut area = ci * cr;
        if self.shadowing {
            let mut shadows = [spread_i, spread_o];
            if !self.own_shadows {
                shadows = [self.sigma_shadow * sine(ci), self.sigma_shadow * sine(cr)];
            }
            area = cr.mul_add(self.masked(ci, shadows[0]), area);
            area = ci.mul_add(self.masked(cr, shadows[1]), area);
        }
        if self.bounded {
            let [visible_i, visible_o] = [ci + cos_lambda(ci, spread_i), cr + cos_lambda(cr, spread_o)];
            area = T::max(area, rho / self.bound * T::max(visible_i * cr, visible_o * ci));
        }
        area
    }

    /// `cos theta F` (Eqs. 64-66) of an angle to the normal by its cosine and sigma times its sine.
    #[inline(always)]
    pub(crate) fn masked(&self, cos: T, mut sigma_sin: T) -> T {
        if !self.printed_shadowing() {
            return cos_lambda(cos, sigma_sin);
        }
        if self.readings.contains(Readings::EQ_65) {
            // sqrt(1 - cos) for the sine.
            sigma_sin = sigma_sin * (T::of(1.0) + cos).rsqrt();
        }
        let read = cos_lambda(cos, sigma_sin);
        if self.readings.contains(Readings::EQ_66) { read + printed_excess(cos, sigma_sin) } else { read }
    }

    /// Whether the [`Facets::alpha_along`] of both directions take part.
    #[inline(always)]
    pub(crate) fn needs_spreads(&self) -> bool {
        self.bounded || self.own_shadows
    }

    /// Whether Eqs. 65 or 66 are taken as printed.
    #[inline(always)]
    pub(crate) fn printed_shadowing(&self) -> bool {
        self.readings.intersects(Readings::EQ_65 | Readings::EQ_66)
    }

    /// sqrt 2 times the facets' standard deviation along a direction (Beckmann's alpha), times its sine.
    #[inline(always)]
    fn alpha_along(&self, v: [T; 2]) -> T {
        let [u, c] = self.wind.to_wind(v);
        alpha([u, c], [self.sigma_u, self.sigma_c])
    }
}

/// sqrt 2 times the standard deviation of slopes along a horizontal vector (Beckmann's alpha), times its length; all in the wind's
/// axes.
#[inline(always)]
pub(crate) fn alpha<T: Real>([u, c]: [T; 2], [sigma_u, sigma_c]: [T; 2]) -> T {
    let (u, c) = (u * sigma_u, c * sigma_c);
    T::of(SQRT_2) * u.mul_add(u, c * c).sqrt()
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
    /// Smooth water alone.
    pub const FACETS: Self = Self { facets: true, whitecaps: false };
    /// Whitecaps alone.
    pub const WHITECAPS: Self = Self { facets: false, whitecaps: true };
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
        let n = n.into();
        if self.facets.needs_extended(n.is_none()) {
            self.eval_in::<T::Extended>(i, o, n, parts)
        } else {
            self.eval_in::<T::Plain>(i, o, n, parts)
        }
    }

    /// The same in the digits of `E`.
    #[inline(always)]
    pub(crate) fn eval_in<E: Extended<T>>(
        &self,
        i: Vec3<T>,
        o: Vec3<T>,
        n: Option<Vec3<T>>,
        parts: Parts,
    ) -> T {
        if !parts.facets {
            let whitecaps = self.whitecap_fraction * self.whitecap_brdf;
            let f = if parts.whitecaps { whitecaps } else { T::of(0.0) };
            let cos = n.map_or([i[2], o[2]], |n| [cosine::<T, E>(i, n), cosine::<T, E>(o, n)]);
            let upper = T::lt(T::of(0.0), cos[0]) & T::lt(T::of(0.0), cos[1]);
            return defined(i, o, cos, T::select(upper, f, T::of(0.0)));
        }
        let g = self.facets.geometry::<E>(i, o, n);
        let mut f = self.smooth_fraction * self.facets.eval_above(&g, n.is_none());
        if parts.whitecaps {
            f = self.whitecap_fraction.mul_add(self.whitecap_brdf, f);
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
        let (f, of) = (&self.facets, |x: S| T::coefficient(x.to_f64()));
        Lobe {
            facets: Facets {
                sigma_u: of(f.sigma_u),
                sigma_c: of(f.sigma_c),
                inv_width_u: T::Extended::coefficient(f.inv_width_u),
                inv_width_c: T::Extended::coefficient(f.inv_width_c),
                scale: of(f.scale),
                steep_gain: of(f.steep_gain),
                bound: of(f.bound),
                proposal: f.proposal.map(of),
                bounded: f.bounded,
                wind: f.wind.cast(),
                correction: f.correction.cast(),
                sigma_shadow: of(f.sigma_shadow),
                own_shadows: f.own_shadows,
                reflectance: f.reflectance.cast(),
                slope_measure: f.slope_measure,
                gram_charlier: f.gram_charlier,
                shadowing: f.shadowing,
                readings: f.readings,
            },
            whitecap_fraction: of(self.whitecap_fraction),
            smooth_fraction: of(self.smooth_fraction),
            whitecap_brdf: of(self.whitecap_brdf),
        }
    }
}

impl<T: Real> Facets<T> {
    /// Gives the facets other standard deviations of slope, along and across the wind, and Eq. 56's constant with the 2 pi
    /// of the density, `scale`.
    pub(crate) fn set_sigmas(&mut self, [u, c]: [T; 2], scale: T) {
        (self.sigma_u, self.sigma_c) = (u, c);
        let width = T::of(1.0 / WIDTH);
        (self.inv_width_u, self.inv_width_c) =
            (T::Extended::from_real(width / u), T::Extended::from_real(width / c));
        self.scale = scale / (u * c);
    }
}

/// `rho G (1 + Lambda)` up to which the bound is left out: Eq. 64 and Eqs. 76-77 differ by up to
/// 1.105 even in a gale, where the albedo is far from 1.
pub(crate) const BOUND_SLACK: f64 = 1.11;

impl Facets<f64> {
    /// How far, in slope upwind and crosswind, a wave's slope may be from a facet's: a tilt's standard deviation there.
    pub(crate) fn slope_width(&self, facet: DVec2) -> DVec2 {
        let widened = if self.slope_measure { DVec2::ONE } else { DVec2::ONE + facet * facet };
        DVec2::new(self.sigma_u, self.sigma_c) * widened
    }

    /// Whether [`Facets::masked_area`]'s bound matters: scanned over both elevations, with the largest
    /// reflectance (forward) and the rougher azimuth. Above w* = 9 cm/s (for an infinite footprint; below
    /// for smaller ones) it does not, and costs nothing.
    pub(crate) fn needs_bound(&self) -> bool {
        const STEPS: i32 = 64;
        let spread = std::f64::consts::SQRT_2 * self.sigma_u.max(self.sigma_c);
        // Elevations from 90 degrees down to 1e-4, evenly in their logarithm.
        let elevation = |k: i32| (90.0 * 10f64.powf(-6.0 * f64::from(k) / f64::from(STEPS))).to_radians();
        let f = |e: f64, s: f64| cos_lambda(e.sin(), s * e.cos()) / e.sin();
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

/// Cosines are clamped to this: 1e-10 degrees above the horizon. On the horizon f, and the weight of a draw, would have no
/// bound.
pub(crate) const GRAZING: f64 = 1e-12;

/// The slope of what has none.
const MAX_SLOPE: f64 = 1e6;

/// Slopes in widths are clamped to this: the density there is 0.
const MAX_TILT: f64 = 1e3;

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
