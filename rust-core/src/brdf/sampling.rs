//! Importance sampling: facet normals in proportion to the area they show the source, whitecaps by cosine.
//!
//! Facets are drawn in the frame of the wave normal as tilts: slopes, or, where the density is one of
//! tilt angles, the angle from the normal with its azimuth (an azimuthal equidistant map, which turns
//! the two flat axes of the density's angles into one and decays slower than it). A tilt `z`, in
//! standard deviations, shows the source the area `c (1 + rD)`, with `c = cos theta_i`, `r` the part of
//! `z` along the source and `D` the spread of tilts along it over `c`. It is drawn from
//!
//! `phi(z)/(1 + D phi(v)) [2 A(z)/(A(z) + A(-z)) + (rD - 1)+ exp(v (r - v))]` with `v = 1/D`:
//!
//! either a Gaussian tilt, kept or turned around in proportion to the areas `A` that the two show
//! (exact while both face the source), or one tilted towards it by `r - v`, Rayleigh. Nothing but
//! elementary functions is needed, and against the ideal, area-weighted Gaussian of slopes its weight
//! is at most 1.22 (`v` near 1/2: `(1 + phi(v)/v)/(1 + Lambda)`).

use super::lobe::{Facets, GRAZING, Lobe, Parts, cosine, defined};
use crate::numeric::real::{Wide, dot};
use crate::numeric::{Real, Scalar, Vec3};

/// Keeps the facets' share positive where they hardly reflect.
const FACET_ALBEDO_FLOOR: f64 = 0.01;
/// Smallest vertical component of a normal that is told from 0.
const LYING: f64 = 1e-4;
/// Densities below which a draw is lost: rounding alone makes it, and its weight could be infinite.
const LOST: f64 = 1e-37;
/// Smallest tilt that has an azimuth.
const LEVEL: f64 = 1e-18;

/// A drawn direction.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Sample<T> {
    /// To the observer; zero where nothing could be drawn.
    pub direction: Vec3<T>,
    /// Its density, 1/sr: what [`Lobe::pdf`] gives for it. 0 marks a draw without a direction; not a number, a source or a
    /// normal that is none.
    pub pdf: T,
    /// f of the parts that were asked for, 1/sr.
    pub f: T,
    /// Drawn from the whitecaps, not from the facets.
    pub whitecap: bool,
}

/// The wave normal with tangents along and across the wind.
enum Frame<T> {
    /// Of a level surface: cosine and sine of the wind's azimuth.
    Level([T; 2]),
    /// Along the wind, across it and along the normal.
    Wave([Vec3<T>; 3]),
}

impl<T: Real> Frame<T> {
    #[inline(always)]
    fn to_local(&self, v: Vec3<T>) -> Vec3<T> {
        match *self {
            Self::Level([cos, sin]) => [v[0] * cos + v[1] * sin, v[1] * cos - v[0] * sin, v[2]],
            Self::Wave([u, c, n]) => [dot(u, v), dot(c, v), dot(n, v)],
        }
    }

    #[inline(always)]
    fn to_world(&self, v: Vec3<T>) -> Vec3<T> {
        match *self {
            Self::Level([cos, sin]) => [v[0] * cos - v[1] * sin, v[0] * sin + v[1] * cos, v[2]],
            Self::Wave([u, c, n]) => [0, 1, 2].map(|k| v[0] * u[k] + v[1] * c[k] + v[2] * n[k]),
        }
    }
}

/// What the source fixes of the facets' proposal.
struct Proposal<T> {
    /// Components of `z` that make `rD`.
    towards: [T; 2],
    /// D.
    d: T,
    /// v = 1/D.
    v: T,
    /// D phi(v).
    tail: T,
}

impl<T: Real> Facets<T> {
    #[inline(always)]
    fn frame(&self, n: Option<Vec3<T>>) -> Frame<T> {
        let (cw, sw) = (self.cos_wind.narrow(), self.sin_wind.narrow());
        let Some(n) = n else { return Frame::Level([cw, sw]) };
        // N x W and back: no digits are lost where the normal leans far into the wind, nor all where it lies in it.
        let rise = T::max(n[2], T::of(LYING));
        let c = [-rise * sw, rise * cw, n[0] * sw - n[1] * cw];
        let length = T::max(dot(c, c).sqrt(), T::TINY);
        let c = [c[0] / length, c[1] / length, c[2] / length];
        let u = [c[1] * n[2] - c[2] * n[1], c[2] * n[0] - c[0] * n[2], c[0] * n[1] - c[1] * n[0]];
        Frame::Wave([u, c, n])
    }

    /// For a source in the frame of the normal, as everything below.
    #[inline(always)]
    fn proposal(&self, i: Vec3<T>) -> Proposal<T> {
        let c = T::max(i[2], T::of(GRAZING));
        let towards = [i[0] * self.proposal_u / c, i[1] * self.proposal_c / c];
        let d2 = towards[0] * towards[0] + towards[1] * towards[1];
        let d = d2.sqrt();
        let v = T::of(1.0) / T::max(d, T::of(LEVEL));
        let tail = d * T::exp(T::of(-0.5) * v * v) * T::of(0.398_942_280_401_432_7);
        Proposal { towards, d, v, tail }
    }

    /// The tilt of a unit half vector, and the Jacobian `d omega_h/d tilt^2`.
    #[inline(always)]
    fn tilt(&self, h: Vec3<T>) -> ([T; 2], T) {
        let z = T::max(h[2], T::of(LEVEL));
        if self.slope_measure {
            return ([h[0] / z, h[1] / z], z * z * z);
        }
        let sin = T::max((h[0] * h[0] + h[1] * h[1]).sqrt(), T::of(LEVEL));
        let angle = sin.atan2(z);
        ([h[0] * angle / sin, h[1] * angle / sin], sin / angle)
    }

    /// Density, 1/sr, of the observer's direction that makes `h` with the source's, both added up and
    /// not of unit length.
    #[inline(always)]
    fn pdf(&self, i: Vec3<T>, h: Vec3<T>) -> T {
        let (zero, one, two, half) = (T::of(0.0), T::of(1.0), T::of(2.0), T::of(0.5));
        let length = T::max(dot(h, h).sqrt(), T::TINY);
        let h = [h[0] / length, h[1] / length, h[2] / length];
        let p = self.proposal(i);
        let (tilt, jacobian) = self.tilt(h);
        let z = [tilt[0] / self.proposal_u, tilt[1] / self.proposal_c];
        let z2 = z[0] * z[0] + z[1] * z[1];
        let beyond = z[0] * p.towards[0] + z[1] * p.towards[1] - one;
        // The area shown over its value for a level facet; i.H, not |i + o|/2, agrees with the tilts
        // to the last digit at grazing angles.
        let cos = dot(i, h);
        let shown = cos / T::max(h[2] * T::max(i[2], T::of(GRAZING)), T::TINY);
        let gauss = T::exp(-half * z2) * T::min(shown, two);
        let tail = T::select(
            T::lt(zero, beyond),
            beyond * T::exp(T::min(p.v * p.v * beyond - half * z2, zero)),
            zero,
        );
        let norm = T::of(4.0 * std::f64::consts::TAU) * self.proposal_u * self.proposal_c * (one + p.tail);
        let pdf = (gauss + tail) / (norm * T::max(cos * jacobian, T::TINY));
        T::select(T::lt(zero, cos), T::min(pdf, T::MAX), zero)
    }
}

impl<T: Scalar> Facets<T> {
    /// The half vector of a tilt; zero where a tilt angle passes the horizontal.
    #[inline(always)]
    fn half_vector(&self, [u, c]: [T; 2]) -> Vec3<T> {
        let (zero, one) = (T::of(0.0), T::of(1.0));
        let tilt2 = u * u + c * c;
        if self.slope_measure {
            let cos = one / (one + tilt2).sqrt();
            return [u * cos, c * cos, cos];
        }
        let tilt = T::max(tilt2.sqrt(), T::of(LEVEL));
        let (sin, cos) = tilt.sin_cos();
        let valid = T::lt(tilt, T::of(std::f64::consts::FRAC_PI_2));
        [u * sin / tilt, c * sin / tilt, cos].map(|x| T::select(valid, x, zero))
    }

    /// A half vector, or zero where the draw is lost.
    #[inline(always)]
    fn sample_half(&self, i: Vec3<T>, choice: T, u: [T; 2]) -> Vec3<T> {
        let (zero, one, two) = (T::of(0.0), T::of(1.0), T::of(2.0));
        let p = self.proposal(i);
        let scaled = choice * (one + p.tail);
        let in_tail = T::lt(scaled, p.tail);
        let rest = T::select(in_tail, scaled / T::max(p.tail, T::TINY), scaled - p.tail);
        let radius2 = |x: T| T::max(-two * T::max(one - x, T::TINY).ln(), zero);
        let (sin, cos) = (T::of(std::f64::consts::TAU) * T::select(in_tail, rest, u[1])).sin_cos();
        // Box-Muller around the source's azimuth; in the tail r is Rayleigh beyond v.
        let first = radius2(u[0]).sqrt();
        let overhead = T::lt(p.d, T::of(LEVEL));
        let r = T::select(in_tail, p.v + first, first * cos);
        let q = T::select(in_tail, radius2(u[1]).sqrt() * cos, first * sin);
        let e = [T::select(overhead, one, p.towards[0] * p.v), T::select(overhead, zero, p.towards[1] * p.v)];
        let h = self
            .half_vector([(e[0] * r - e[1] * q) * self.proposal_u, (e[1] * r + e[0] * q) * self.proposal_c]);
        // The opposite tilt with probability b/(a + b), by the areas that the two show.
        let (level, slanted) = (h[2] * i[2], h[0] * i[0] + h[1] * i[1]);
        let (a, b) = (T::max(level + slanted, zero), T::max(level - slanted, zero));
        let turn = T::lt(T::select(in_tail, one, rest * (a + b)), T::select(in_tail, zero, b));
        [T::select(turn, -h[0], h[0]), T::select(turn, -h[1], h[1]), h[2]]
    }
}

impl Facets<f64> {
    /// Factor on the facets' standard deviations that keeps the sample weights least at their worst:
    /// 1 for a Gaussian of slopes, more where Gram-Charlier tails or steep tilt angles reach further out.
    pub(crate) fn proposal_stretch(&self) -> f64 {
        const STEPS: i32 = 24;
        let mut wanted = Vec::new();
        for a in -STEPS..=STEPS {
            for b in 0..=STEPS {
                let [u, c] = [a, b].map(|k| 6.0 * f64::from(k) / f64::from(STEPS));
                let h = self.half_vector([u * self.sigma_u, c * self.sigma_c]);
                if h[2] < 0.05 {
                    continue;
                }
                // What the density gives to the facets of this tilt, over d tilt^2, and at worst, towards
                // a grazing source, over the area that the proposal takes them to show.
                let axis = |t: f64, sigma: f64| if self.slope_measure { t } else { t.atan() } / sigma;
                let [x, y] = [axis(h[0] / h[2], self.sigma_u), axis(h[1] / h[2], self.sigma_c)];
                let (tilt, jacobian) = self.tilt(h);
                let slope_over_tilt = (h[0].hypot(h[1]) / h[2] + 1e-9) / (tilt[0].hypot(tilt[1]) + 1e-9);
                let density =
                    self.tilt_density(-x, y, (h[2] * h[2]).recip()) * h[2] * jacobian * slope_over_tilt;
                wanted.push((density.ln(), 0.5 * (u * u + c * c)));
            }
        }
        let worst = |s: f64| {
            wanted.iter().map(|(ln, half)| ln + half / (s * s)).fold(f64::MIN, f64::max) + 2.0 * s.ln()
        };
        let ladder = (0..=40).map(|k| 1.0 + 0.02 * f64::from(k));
        ladder.min_by(|a, b| worst(*a).total_cmp(&worst(*b))).unwrap_or(1.0)
    }
}

impl<T: Real> Lobe<T> {
    /// Probabilities of drawing from the facets and from the whitecaps: by what each reflects, roughly.
    #[inline(always)]
    fn shares(&self, cos: T, parts: Parts) -> [T; 2] {
        let (zero, one) = (T::of(0.0), T::of(1.0));
        match parts {
            Parts { whitecaps: false, .. } => [one, zero],
            Parts { facets: false, .. } => [zero, one],
            _ => {
                let albedo =
                    T::rounded(self.facets.reflectance.schlick(cos.fine())) + T::of(FACET_ALBEDO_FLOOR);
                let facets = self.smooth_fraction * albedo;
                let whitecaps = T::of(std::f64::consts::PI) * self.whitecap_brdf * self.whitecap_fraction;
                {
                    let both = T::max(facets + whitecaps, T::TINY);
                    [facets / both, whitecaps / both]
                }
            }
        }
    }

    /// Density of the observer's direction `o` among draws for the source `i`, 1/sr.
    #[inline(always)]
    pub fn pdf(&self, i: Vec3<T>, o: Vec3<T>, n: impl Into<Option<Vec3<T>>>) -> T {
        self.pdf_parts(i, o, n, Parts::ALL)
    }

    /// The same where only some parts are drawn from.
    #[inline(always)]
    pub fn pdf_parts(&self, i: Vec3<T>, o: Vec3<T>, n: impl Into<Option<Vec3<T>>>, parts: Parts) -> T {
        let (zero, n) = (T::of(0.0), n.into());
        if !parts.facets && !parts.whitecaps {
            return zero;
        }
        let (ci, cr) = (cosine(i, n), cosine(o, n));
        let [facets, whitecaps] = self.shares(ci, parts);
        let mut pdf = whitecaps * cr * T::of(std::f64::consts::FRAC_1_PI);
        if parts.facets {
            let frame = self.facets.frame(n);
            // An oblique wind turns a sum of parts that nearly cancel.
            let (x, y, z) = (T::Wide::sum(i[0], o[0]), T::Wide::sum(i[1], o[1]), T::Wide::sum(i[2], o[2]));
            let h = if n.is_none() {
                let [u, c] = self.facets.wind_frame(x, y);
                [u.narrow(), c.narrow(), z.narrow()]
            } else {
                frame.to_local([x.narrow(), y.narrow(), z.narrow()])
            };
            pdf = pdf + facets * self.facets.pdf(frame.to_local(i), h);
        }
        defined(i, o, [ci, cr], T::select(T::lt(zero, ci) & T::lt(zero, cr), pdf, zero))
    }
}

impl<T: Scalar> Lobe<T> {
    /// Draws an observer's direction for the source `i`, with three uniform numbers of [0, 1).
    #[inline(always)]
    pub fn sample(&self, i: Vec3<T>, n: impl Into<Option<Vec3<T>>>, u: [T; 3]) -> Sample<T> {
        self.sample_parts(i, n, u, Parts::ALL)
    }

    /// The same from some parts only.
    pub fn sample_parts(
        &self,
        i: Vec3<T>,
        n: impl Into<Option<Vec3<T>>>,
        u: [T; 3],
        parts: Parts,
    ) -> Sample<T> {
        let (zero, one, two, n) = (T::of(0.0), T::of(1.0), T::of(2.0), n.into());
        let [share, _] = self.shares(cosine(i, n), parts);
        let whitecap = !u[0].below(share);
        let direction = if whitecap {
            cosine_direction(n, [u[1], u[2]])
        } else {
            let choice = T::min(u[0] / T::max(share, T::TINY), one);
            let frame = self.facets.frame(n);
            let h = frame.to_world(self.facets.sample_half(frame.to_local(i), choice, [u[1], u[2]]));
            let c = two * dot(i, h);
            [c * h[0] - i[0], c * h[1] - i[1], c * h[2] - i[2]]
        };
        let pdf = self.pdf_parts(i, direction, n, parts);
        if pdf.below(T::of(LOST)) {
            return Sample { direction: [zero; 3], pdf: zero, f: zero, whitecap };
        }
        Sample { direction, pdf, f: self.eval_parts(i, direction, n, parts), whitecap }
    }
}

/// A direction about `n`, in proportion to its cosine.
#[inline(always)]
fn cosine_direction<T: Scalar>(n: Option<Vec3<T>>, u: [T; 2]) -> Vec3<T> {
    let (zero, one) = (T::of(0.0), T::of(1.0));
    let (sin, cos) = (T::of(std::f64::consts::TAU) * u[1]).sin_cos();
    let r = u[0].sqrt();
    let z = T::max(one - u[0], zero).sqrt();
    let (x, y) = (r * cos, r * sin);
    let Some(n) = n else { return [x, y, z] };
    // Orthonormal tangents of a normal that points up.
    let a = -one / (one + n[2]);
    let b = n[0] * n[1] * a;
    let s = [one + n[0] * n[0] * a, b, -n[0]];
    let t = [b, one + n[1] * n[1] * a, -n[1]];
    [x * s[0] + y * t[0] + z * n[0], x * s[1] + y * t[1] + z * n[1], x * s[2] + y * t[2] + z * n[2]]
}
