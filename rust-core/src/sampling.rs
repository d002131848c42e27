//! Importance sampling: facet normals in proportion to the area they show the source, whitecaps by cosine.
//!
//! A normal tilt `z` (in standard deviations) shows the source the area `c (1 + rD)`, with
//! `c = cos theta_i`, `r` the part of `z` along the source and `D = |spread|/c`. It is drawn from
//!
//! `phi(z)/(1 + D phi(1/D)) [2 A(z)/(A(z) + A(-z)) + rD (where rD > 1)]`:
//!
//! either a Gaussian tilt, kept or turned around in proportion to the areas `A` that the two show
//! (exact while both face the source), or a Rayleigh tail towards the source. Nothing but
//! elementary functions is needed, and against the ideal, area-weighted density its weight is at
//! most 1.22 (`v = 1/D` near 1/2: `(1 + phi(v)/v)/(1 + Lambda)`).

use crate::Real;
use crate::brdf::{Facets, Lobe, Parts};
use crate::real::{Vec3, dot};

/// Reflectance of a whitecap below 0.6 micrometres: its share in choosing a lobe.
const WHITECAP_ALBEDO: f64 = 0.22;
/// Keeps the facets' share positive where they hardly reflect.
const FACET_ALBEDO_FLOOR: f64 = 0.01;
/// Smallest cosine to the source the proposal distinguishes.
const GRAZING: f64 = 1e-12;

/// A drawn direction.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Sample<T> {
    /// To the observer; zero where nothing could be drawn.
    pub direction: Vec3<T>,
    /// Its density, 1/sr: what [`Lobe::pdf`] gives for it. 0 marks a draw without a direction.
    pub pdf: T,
    /// f of the parts that were asked for, 1/sr.
    pub f: T,
    /// Drawn from the whitecaps, not from the facets.
    pub whitecap: bool,
}

/// What the source fixes of the facets' proposal.
struct Proposal<T> {
    /// Components of `z` that make `rD`.
    towards: [T; 2],
    /// D.
    d: T,
    /// D phi(1/D).
    tail: T,
}

impl<T: Real> Facets<T> {
    #[inline(always)]
    fn proposal(&self, i: Vec3<T>, n: Vec3<T>) -> Proposal<T> {
        let c = T::max(dot(i, n), T::of(GRAZING));
        let towards = self.stretched(i, n, [self.proposal_u, self.proposal_c]).map(|x| x / c);
        let d2 = towards[0] * towards[0] + towards[1] * towards[1];
        let d = d2.sqrt();
        let inverse_square = T::of(1.0) / T::max(d2, T::TINY);
        let tail = d * T::exp(T::of(-0.5) * inverse_square) * T::of(0.398_942_280_401_432_7);
        Proposal { towards, d, tail }
    }

    /// The half vector with the tilts `t` (tangents, along and across the wind) from `n`, and the
    /// Jacobian `d omega_h/(d tilt_u d tilt_c)` in the density's measure.
    #[inline(always)]
    fn half_vector(&self, n: Vec3<T>, t: [T; 2]) -> (Vec3<T>, T) {
        let one = T::of(1.0);
        let [nu, nc] = self.wind_frame(n[0].wide(), n[1].wide()).map(T::narrow);
        // tan(a + b) without its quotient, so that upright facets stay finite.
        let (su, cu) = (nu + n[2] * t[0], n[2] - nu * t[0]);
        let (sc, cc) = (nc + n[2] * t[1], n[2] - nc * t[1]);
        let zero = T::of(0.0);
        let valid = T::lt(zero, cu) & T::lt(zero, cc);
        let tangent = |s: T, c: T| s / T::max(c, T::TINY);
        let (tu, tc) = (tangent(su, cu), tangent(sc, cc));
        let cos = one / (one + tu * tu + tc * tc).sqrt();
        let [cw, sw] = [self.cos_wind, self.sin_wind].map(T::narrow);
        let (x, y) = (tu * cw - tc * sw, tu * sw + tc * cw);
        let mut jacobian = cos * cos * cos * (one + tu * tu) * (one + tc * tc);
        if self.slope_measure {
            jacobian = jacobian / ((one + t[0] * t[0]) * (one + t[1] * t[1]));
        }
        ([x * cos, y * cos, cos], T::select(valid, jacobian, zero))
    }

    /// Tangent of a tilt given in the density's measure.
    #[inline(always)]
    fn tangent(&self, tilt: T) -> T {
        if self.slope_measure { tilt } else { tilt.tan() }
    }

    /// Area shown to the source in the density's measure: `cos zeta/cos^4 xi` times the Jacobian.
    #[inline(always)]
    fn shown(&self, cos_zeta: T, cos_xi: T, jacobian: T) -> T {
        let zero = T::of(0.0);
        let cos2 = cos_xi * cos_xi;
        let area = T::max(cos_zeta, zero) * jacobian / T::max(cos2 * cos2, T::TINY);
        T::select(T::lt(zero, cos_xi), area, zero)
    }

    /// A half vector, or zero where the draw is lost.
    #[inline(always)]
    fn sample_half(&self, i: Vec3<T>, n: Vec3<T>, choice: T, u: [T; 2]) -> Vec3<T> {
        let (zero, one, two) = (T::of(0.0), T::of(1.0), T::of(2.0));
        let p = self.proposal(i, n);
        let p_tail = p.tail / (one + p.tail);
        let in_tail = T::lt(choice, p_tail);
        let rest = T::select(in_tail, choice / T::max(p_tail, T::TINY), (choice - p_tail) / (one - p_tail));
        let radius2 = |x: T| -two * T::max(one - x, T::TINY).ln();
        let (sin, cos) = (T::of(std::f64::consts::TAU) * T::select(in_tail, rest, u[1])).sin_cos();
        let first = radius2(u[0]);
        // Box-Muller around the source's azimuth; in the tail r is Rayleigh beyond 1/D.
        let d = T::max(p.d, T::TINY);
        let level = T::lt(p.d, T::of(1e-18));
        let r = T::select(in_tail, (first + one / (d * d)).sqrt(), first.sqrt() * cos);
        let q = T::select(in_tail, T::max(radius2(u[1]), zero).sqrt() * cos, first.sqrt() * sin);
        let e = [T::select(level, one, p.towards[0] / d), T::select(level, zero, p.towards[1] / d)];
        let tilt = [(e[0] * r - e[1] * q) * self.proposal_u, (e[1] * r + e[0] * q) * self.proposal_c];
        if !self.slope_measure {
            let upright = T::of(std::f64::consts::FRAC_PI_2);
            let valid = T::lt(tilt[0].abs(), upright) & T::lt(tilt[1].abs(), upright);
            return self
                .keep_or_turn(i, n, tilt.map(|x| T::select(valid, x, zero)), in_tail, rest)
                .map(|x| T::select(valid, x, zero));
        }
        self.keep_or_turn(i, n, tilt, in_tail, rest)
    }

    /// The half vector of a tilt or of its opposite, in proportion to what they show the source.
    #[inline(always)]
    fn keep_or_turn(&self, i: Vec3<T>, n: Vec3<T>, tilt: [T; 2], in_tail: T::Mask, u: T) -> Vec3<T> {
        let t = tilt.map(|x| self.tangent(x));
        let (kept, j_kept) = self.half_vector(n, t);
        let (turned, j_turned) = self.half_vector(n, t.map(|x| -x));
        let shown = |h: Vec3<T>, jacobian: T| self.shown(dot(i, h), dot(h, n), jacobian);
        let (a, b) = (shown(kept, j_kept), shown(turned, j_turned));
        let turn = T::select(in_tail, T::of(-1.0), b - u * (a + b));
        // u is uniform: the opposite is taken with probability b/(a + b).
        let turn = T::lt(T::of(0.0), turn);
        let pick = |k: usize| T::select(turn, turned[k], kept[k]);
        [pick(0), pick(1), pick(2)]
    }

    /// Density of `o`, 1/sr.
    #[inline(always)]
    fn pdf(&self, i: Vec3<T>, o: Vec3<T>, n: Vec3<T>) -> T {
        let (zero, one, two) = (T::of(0.0), T::of(1.0), T::of(2.0));
        let g = self.geometry(i, o, n);
        let p = self.proposal(i, n);
        let tilt = [g.tilt_u, g.tilt_c].map(|tilt| T::narrow(self.measure(tilt)));
        let z = [tilt[0] / self.proposal_u, tilt[1] / self.proposal_c];
        let level = T::Wide::of(0.0);
        let t = [g.tilt_u, g.tilt_c].map(|[s, c]| T::narrow(s / Real::max(c, T::Wide::TINY)));
        let (_, jacobian) = self.half_vector(n, t);
        let (turned, j_turned) = self.half_vector(n, t.map(|x| -x));
        // i.H, not |i + o|/2: at grazing angles only it agrees with the tilts to the last digit.
        let a = self.shown(g.cos_facet, g.cos_xi, jacobian);
        let b = self.shown(dot(i, turned), dot(turned, n), j_turned);
        let rd = z[0] * p.towards[0] + z[1] * p.towards[1];
        let shape = two * a / T::max(a + b, T::TINY) + T::select(T::lt(one, rd), rd, zero);
        let gauss = T::exp(T::of(-0.5) * (z[0] * z[0] + z[1] * z[1]))
            / (T::of(std::f64::consts::TAU) * self.proposal_u * self.proposal_c);
        let pdf = gauss * shape / ((one + p.tail) * T::max(T::of(4.0) * g.cos_facet * jacobian, T::TINY));
        let valid = T::lt(zero, g.cos[0])
            & T::lt(zero, g.cos[1])
            & T::lt(zero, jacobian)
            & T::Wide::lt(level, g.tilt_u[1])
            & T::Wide::lt(level, g.tilt_c[1]);
        T::select(valid, T::min(pdf, T::MAX), zero)
    }
}

impl Facets<f64> {
    /// Factor on the facets' standard deviations that keeps the sample weights least at their worst:
    /// 1 for a Gaussian of slopes, more where Gram-Charlier tails or steep tilt angles reach further out.
    pub(crate) fn proposal_stretch(&self) -> f64 {
        const STEPS: i32 = 48;
        let mut wanted = Vec::new();
        for a in -STEPS..=STEPS {
            for b in 0..=STEPS {
                let [u, c] = [a, b].map(|k| 6.0 * f64::from(k) / f64::from(STEPS));
                let [t, w] = [u * self.sigma_u, c * self.sigma_c].map(|x| self.tangent(x));
                let slope2 = t * t + w * w;
                if !self.slope_measure && (u * self.sigma_u).abs().max(c * self.sigma_c) > 1.57 {
                    continue;
                }
                let density = self.tilt_density(-u, c, 1.0 / (1.0 + slope2).sqrt()) / (1.0 + slope2).powi(2);
                let measure = if self.slope_measure { 1.0 } else { (1.0 + t * t) * (1.0 + w * w) };
                wanted.push(((density * measure).ln(), 0.5 * (u * u + c * c)));
            }
        }
        let worst = |s: f64| {
            wanted.iter().map(|(ln, half)| ln + half / (s * s)).fold(f64::MIN, f64::max) + 2.0 * s.ln()
        };
        let ladder = (0..=100).map(|k| 1.0 + 0.02 * f64::from(k));
        ladder.min_by(|a, b| worst(*a).total_cmp(&worst(*b))).unwrap_or(1.0)
    }
}

impl<T: Real> Lobe<T> {
    /// Probability of drawing from the facets: by what each part reflects, roughly.
    #[inline(always)]
    fn facet_share(&self, cos: T, parts: Parts) -> T {
        let (zero, one) = (T::of(0.0), T::of(1.0));
        match parts {
            Parts { whitecaps: false, .. } => one,
            Parts { facets: false, .. } => zero,
            _ => {
                let albedo = self.facets.reflectance.schlick(cos) + T::of(FACET_ALBEDO_FLOOR);
                let facets = (one - self.whitecap_fraction) * albedo;
                facets / (facets + T::of(WHITECAP_ALBEDO) * self.whitecap_fraction)
            }
        }
    }

    /// Density of the observer's direction `o` among draws for the source `i`, 1/sr.
    #[inline(always)]
    pub fn pdf(&self, i: Vec3<T>, o: Vec3<T>, n: Vec3<T>) -> T {
        self.pdf_parts(i, o, n, Parts::ALL)
    }

    /// The same where only some parts are drawn from.
    #[inline(always)]
    pub fn pdf_parts(&self, i: Vec3<T>, o: Vec3<T>, n: Vec3<T>, parts: Parts) -> T {
        let (zero, one) = (T::of(0.0), T::of(1.0));
        if !parts.facets && !parts.whitecaps {
            return zero;
        }
        let (ci, cr) = (dot(i, n), dot(o, n));
        let share = self.facet_share(ci, parts);
        let cosine = T::select(T::lt(zero, ci), T::max(cr, zero), zero) * T::of(std::f64::consts::FRAC_1_PI);
        let mut pdf = (one - share) * cosine;
        if parts.facets {
            pdf = pdf + share * self.facets.pdf(i, o, n);
        }
        pdf
    }

    /// Draws an observer's direction for the source `i`, with three uniform numbers of [0, 1).
    #[inline(always)]
    pub fn sample(&self, i: Vec3<T>, n: Vec3<T>, u: [T; 3]) -> Sample<T> {
        self.sample_parts(i, n, u, Parts::ALL)
    }

    /// The same from some parts only.
    pub fn sample_parts(&self, i: Vec3<T>, n: Vec3<T>, u: [T; 3], parts: Parts) -> Sample<T> {
        let (zero, one, two) = (T::of(0.0), T::of(1.0), T::of(2.0));
        let share = self.facet_share(dot(i, n), parts);
        let whitecap = !u[0].below(share);
        let direction = if whitecap {
            cosine_direction(n, [u[1], u[2]])
        } else {
            let choice = T::min(u[0] / T::max(share, T::TINY), one);
            let h = self.facets.sample_half(i, n, choice, [u[1], u[2]]);
            let c = two * dot(i, h);
            [c * h[0] - i[0], c * h[1] - i[1], c * h[2] - i[2]]
        };
        let pdf = self.pdf_parts(i, direction, n, parts);
        if !zero.below(pdf) {
            return Sample { direction: [zero; 3], pdf: zero, f: zero, whitecap };
        }
        Sample { direction, pdf, f: self.eval_parts(i, direction, n, parts), whitecap }
    }
}

/// A direction about `n`, in proportion to its cosine.
#[inline(always)]
fn cosine_direction<T: Real>(n: Vec3<T>, u: [T; 2]) -> Vec3<T> {
    let (zero, one) = (T::of(0.0), T::of(1.0));
    let (sin, cos) = (T::of(std::f64::consts::TAU) * u[1]).sin_cos();
    let r = u[0].sqrt();
    let z = T::max(one - u[0], zero).sqrt();
    // Orthonormal tangents of a normal that points up; the identity for a flat sea.
    let a = -one / (one + n[2]);
    let b = n[0] * n[1] * a;
    let s = [one + n[0] * n[0] * a, b, -n[0]];
    let t = [b, one + n[1] * n[1] * a, -n[1]];
    let (x, y) = (r * cos, r * sin);
    [x * s[0] + y * t[0] + z * n[0], x * s[1] + y * t[1] + z * n[1], x * s[2] + y * t[2] + z * n[2]]
}
