//! The empirical model at one wind and one footprint, laid out so finely that straight lines do between nodes: what renderers
//! evaluate, in any number type.

use crate::brdf::lobe::{cos_zeta, defined, sine};
use crate::brdf::{Lobe, Parts};
use crate::config::OffPlaneModel;
use crate::numeric::packets::{Packets, Tabulated};
use crate::numeric::{Real, Scalar, Vec3};
use crate::readings::Readings;
use crate::statistics::level_water::{MIN_COS, NOTHING};
use std::f64::consts::PI;

/// Steps of the fine grid: over theta_i, the wind's azimuth and theta_r.
pub(crate) const INCIDENCES: usize = 32;
pub(crate) const AZIMUTHS: usize = 16;
pub(crate) const THETAS: usize = 80;
/// Shares of whitecaps come to half precision in this part of 1, so that rare ones keep their digits.
pub(crate) const SHARES: f64 = 1024.0;
/// Nodes on a side of the density of facets.
pub(crate) const DENSITIES: usize = 257;
/// The area shown to both directions is at least this.
const GRAZING: f64 = 1e-6;
/// Sources closer to the vertical have no azimuth.
const OVERHEAD: f64 = 1e-12;

/// The fine grid.
#[derive(Debug, Clone)]
pub struct FineGrid<T: Real> {
    /// Its reflectance, shadowing, wind and whitecaps' BRDF.
    pub(crate) lobe: Lobe<T>,
    /// How f falls off across the plane of incidence.
    pub(crate) across: OffPlaneModel,
    /// There are whitecaps.
    pub(crate) whitecaps: bool,
    /// The largest tan(theta_i/2), and steps over it.
    pub(crate) last: T,
    pub(crate) inv_step: T,
    /// Of a half vector's slope, upwind and crosswind, the share of the waves that carry its facets.
    pub(crate) carried: [T; 2],
    /// The density of facets along a half vector, over its tilt angles upwind and crosswind, 0 in the middle: the inverse of
    /// the standard deviations of both angles in radians, and of the steps in those.
    pub(crate) inv_sigma: [T; 2],
    pub(crate) inv_density_step: [T; 2],
    /// By theta_i, by intervals of the azimuth and by those of theta_r, what the four corners hold, azimuths first:
    /// logarithms of the ratio to level water, and with `whitecaps` [`SHARES`] times their shares.
    pub(crate) in_plane: Packets,
    /// By intervals of theta_i and of the azimuth, of the four corners, azimuths first: sigma, then delta.
    pub(crate) widths: Packets,
    /// By cells, of the four corners, crosswind first, the logarithm of the ratio to Gauss's function of the angles.
    pub(crate) densities: Packets,
}

/// Where a pair of directions lies in the fine grid.
pub(crate) struct Place<T> {
    /// A step over theta_i, and how far along it.
    pub incidence: (T, T),
    /// Over the azimuth.
    pub azimuth: (T, T),
    /// And over theta_r.
    pub theta: (T, T),
    /// Tangents of theta_i/2, not beyond the table, and theta_r/2.
    pub halves: [T; 2],
    /// tan(theta_i/2), also beyond it.
    pub half_i: T,
    /// Cosine and sine of the wind's azimuth from the plane.
    pub wind: [T; 2],
    /// Horizontal, in the plane, away from the source.
    pub forward: [T; 2],
    /// phi_r of Eq. 88 with the table's sign.
    pub phi: T,
    /// sigma's factor of Eq. 89.
    pub narrowing: T,
}

impl<S: Scalar> FineGrid<S> {
    /// The same in another number type.
    pub fn cast<T: Real>(&self) -> FineGrid<T> {
        let of = |x: S| T::coefficient(x.to_f64());
        FineGrid {
            lobe: self.lobe.cast(),
            across: self.across,
            whitecaps: self.whitecaps,
            last: of(self.last),
            inv_step: of(self.inv_step),
            carried: self.carried.map(of),
            inv_sigma: self.inv_sigma.map(of),
            inv_density_step: self.inv_density_step.map(of),
            in_plane: self.in_plane.clone(),
            widths: self.widths.clone(),
            densities: self.densities.clone(),
        }
    }
}

/// Between two values.
#[inline(always)]
fn between<T: Real>(t: T, from: T, to: T) -> T {
    t.mul_add(to - from, from)
}

/// Of four corners, the first axis first.
#[inline(always)]
fn corners<T: Real>(p: &[T], s: T, t: T) -> T {
    between(t, between(s, p[0], p[1]), between(s, p[2], p[3]))
}

impl<T: Tabulated> FineGrid<T> {
    /// f of some of its parts, 1/sr (Eq. 90), for unit vectors to source and observer.
    #[inline(always)]
    pub fn eval(&self, i: Vec3<T>, o: Vec3<T>, parts: Parts) -> T {
        let zero = T::of(0.0);
        let upper = T::lt(zero, i[2]) & T::lt(zero, o[2]);
        let [above_i, above_o] = [i, o].map(|v| [v[0], v[1], T::max(v[2], zero)]);
        if !T::may_hold(upper) {
            return defined(i, o, [i[2], o[2]], zero);
        }
        let place = self.place(above_i, above_o);
        let [ratio, share] = self.in_plane(&place);
        let mut f = zero;
        if parts.facets {
            let (density, visible) = self.level(above_i, above_o, &place);
            let mut exponent = ratio + density;
            if self.across == OffPlaneModel::Report {
                let [sigma, delta] = self.widths(&place);
                let x = (place.phi - delta) * (sigma * place.narrowing).recip();
                exponent = exponent - x * x;
            }
            f = self.reflectance(i, o) * visible * exponent.exp();
        }
        if parts.whitecaps && self.whitecaps {
            f = (self.lobe.whitecap_brdf * T::of(1.0 / SHARES)).mul_add(share, f);
        }
        defined(i, o, [i[2], o[2]], T::select(upper, f, zero))
    }

    /// The logarithm of the ratio to level water, and [`SHARES`] times the share of whitecaps.
    #[inline(always)]
    fn in_plane(&self, place: &Place<T>) -> [T; 2] {
        let ((a, s), (b, t), (k, r)) = (place.incidence, place.azimuth, place.theta);
        let thetas = T::of(THETAS as f64);
        let index = a.mul_add(T::of(AZIMUTHS as f64), b).mul_add(thetas, k);
        let far = index + T::of((AZIMUTHS * THETAS) as f64);
        if !self.whitecaps {
            let near = T::lookup::<4>(&self.in_plane, index, T::everywhere());
            let far = T::lookup::<4>(&self.in_plane, far, T::everywhere());
            let cell = [0, 1, 2, 3].map(|n| between(s, near[n], far[n]));
            return [corners(&cell, t, r), T::of(0.0)];
        }
        let (near, far) = (
            T::lookup::<8>(&self.in_plane, index, T::everywhere()),
            T::lookup::<8>(&self.in_plane, far, T::everywhere()),
        );
        let cell: [T; 8] = std::array::from_fn(|n| between(s, near[n], far[n]));
        [corners(&cell[..4], t, r), corners(&cell[4..], t, r)]
    }

    /// sigma and delta of the lobe across the plane.
    #[inline(always)]
    fn widths(&self, place: &Place<T>) -> [T; 2] {
        let ((a, s), (b, t)) = (place.incidence, place.azimuth);
        let p = T::lookup::<8>(&self.widths, a.mul_add(T::of(AZIMUTHS as f64), b), T::everywhere());
        [corners(&p[..4], t, s), corners(&p[4..], t, s)]
    }

    /// What the facets would reflect on level water, over rho, as the logarithm of their density and the rest: towards the
    /// observer with [`OffPlaneModel::Slopes`], else towards what is in the plane of it.
    #[inline(always)]
    pub(crate) fn level(&self, i: Vec3<T>, o: Vec3<T>, place: &Place<T>) -> (T, T) {
        let (zero, one) = (T::of(0.0), T::of(1.0));
        let facets = &self.lobe.facets;
        let (slope, cos, sin) = match self.across {
            OffPlaneModel::Slopes => {
                let lean = -T::max(i[2] + o[2], T::of(1e-12)).recip();
                let [u, v] = facets.wind.to_wind([i[0] + o[0], i[1] + o[1]]).map(|h| lean * h);
                // The waves that carry these facets lean with them, and show the observer more than level water does.
                let carried = [u * self.carried[0], v * self.carried[1]];
                let [o_u, o_v] = facets.wind.to_wind([o[0], o[1]]);
                let up = o[2] - carried[0].mul_add(o_u, carried[1] * o_v);
                let length = carried[0].mul_add(carried[0], carried[1].mul_add(carried[1], one));
                let cos = T::max(up * length.rsqrt(), T::of(MIN_COS));
                ([u, v], [i[2], cos], [sine(i[2]), sine(cos)])
            }
            OffPlaneModel::Report => {
                // By half angles: the half vector leans by half the difference of theta_r and theta_i.
                let [a, b] = place.halves;
                let lean = (a - b) * a.mul_add(b, one).recip();
                let over = place.halves.map(|t| t.mul_add(t, one).recip());
                let cos = [0, 1].map(|k| {
                    let t = place.halves[k];
                    T::max((-t).mul_add(t, one) * over[k], zero)
                });
                let sin = [0, 1].map(|k| T::of(2.0) * place.halves[k].abs() * over[k]);
                ([lean * place.wind[0], -(lean * place.wind[1])], cos, sin)
            }
        };
        let mut area = cos[0] * cos[1];
        if facets.shadowing {
            let masked = |k: usize| facets.masked(cos[k], facets.sigma_shadow * sin[k]);
            area = cos[1].mul_add(masked(0), cos[0].mul_add(masked(1), area));
        }
        (self.ln_density(slope), T::max(area, T::of(GRAZING)).recip())
    }

    /// The logarithm of the facets' density along a half vector of a slope upwind and crosswind.
    #[inline(always)]
    fn ln_density(&self, slope: [T; 2]) -> T {
        let (zero, steps) = (T::of(0.0), DENSITIES as u32 - 1);
        let (middle, end) = (T::of(0.5 * f64::from(steps)), T::of(f64::from(steps)));
        let tilt = [0, 1].map(|k| slope[k] * (slope[k] * slope[k]).atan_over() * self.inv_sigma[k]);
        let [u, c] = [0, 1].map(|k| tilt[k].mul_add(self.inv_density_step[k], middle));
        let inside = T::lt(zero, u) & T::lt(u, end) & T::lt(zero, c) & T::lt(c, end);
        let [(j, s), (k, t)] = [u, c].map(|x| T::select(inside, x, zero).step(steps));
        let p = T::lookup::<4>(&self.densities, j.mul_add(T::of(f64::from(steps)), k), inside);
        let gauss = T::of(0.5) * tilt[0].mul_add(tilt[0], tilt[1] * tilt[1]);
        T::select(inside, corners(&p, t, s) - gauss, T::of(NOTHING))
    }

    /// rho between two directions (Eqs. 61-63).
    #[inline(always)]
    pub(crate) fn reflectance(&self, i: Vec3<T>, o: Vec3<T>) -> T {
        let h = [i[0] + o[0], i[1] + o[1], i[2] + o[2]];
        let cos = cos_zeta(h);
        T::from_density(self.lobe.facets.reflectance.eval(cos.to_density()))
    }

    /// For directions above the horizon.
    #[inline(always)]
    pub(crate) fn place(&self, i: Vec3<T>, o: Vec3<T>) -> Place<T> {
        let [zero, one, half] = [0.0, 1.0, 0.5].map(T::of);
        let facets = &self.lobe.facets;
        let wind = facets.wind.to_world([one, zero]);
        // Away from the source; with the wind where the source is overhead.
        let flat2 = i[0].mul_add(i[0], i[1] * i[1]);
        let overhead = T::lt(flat2, T::of(OVERHEAD));
        let inverse = T::max(flat2, T::of(OVERHEAD)).rsqrt();
        let [x, y] = [0, 1].map(|k| T::select(overhead, wind[k], -(i[k] * inverse)));
        let half_i = flat2 * inverse * (one + i[2]).recip();
        let tan_i = T::min(half_i, self.last);
        // The wind's azimuth from there, to either side.
        let cos = wind[0].mul_add(x, wind[1] * y);
        let sin = T::select(overhead, zero, wind[1] * x - wind[0] * y);
        let around = one - cos * T::max(cos.abs() + sin.abs(), T::TINY).recip();
        let [forward, aside] = [o[0].mul_add(x, o[1] * y), o[1] * x - o[0] * y];
        let length = forward.mul_add(forward, o[2] * o[2]).sqrt();
        let mut tan_r = forward * T::max(length + o[2], T::SMALL).recip();
        // Eqs. 87-89 by half angles; both components that make phi are 1 + tan^2 times as long.
        let tan2 = tan_i * tan_i;
        let secant2 = one + tan2;
        let specular = (T::of(2.0) * tan_i).mul_add(forward, (one - tan2) * o[2]);
        let mut phi = Real::atan2(aside * secant2, T::max(specular.abs(), T::SMALL));
        phi = T::select(T::lt(sin, zero), -phi, phi);
        if facets.readings.contains(Readings::EQ_88) {
            (tan_r, phi) = (tan_r.abs(), phi.abs());
            phi = T::select(T::lt(specular, zero), T::of(PI) - phi, phi);
        }
        let lower = T::min(tan_i, tan_r);
        let thetas = T::of(0.5 * THETAS as f64);
        Place {
            incidence: (tan_i * self.inv_step).step(INCIDENCES as u32),
            azimuth: (T::of(AZIMUTHS as f64) * half * around).step(AZIMUTHS as u32),
            theta: thetas.mul_add(tan_r, thetas).step(THETAS as u32),
            halves: [tan_i, tan_r],
            half_i,
            wind: [cos, sin],
            forward: [x, y],
            phi,
            narrowing: (-tan_i).mul_add(lower, one) * (secant2 * lower.mul_add(lower, one)).rsqrt(),
        }
    }
}
