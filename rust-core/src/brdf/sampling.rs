//! Importance sampling of the visible normals (Heitz and d'Eon 2014): facet normals in proportion to the area they show the
//! source; whitecaps by cosine. Their inversion needs the inverse error function, or a density of slopes that a stretch makes
//! isotropic; this mixture needs elementary functions alone and serves densities of tilt angles too.
//!
//! Facets are drawn in the frame of the wave normal as tilts: slopes, or, where the density is one of tilt angles, the angle from
//! the normal with its azimuth (an azimuthal equidistant map, which turns the two flat axes of the density's angles into one and
//! decays slower than it). A tilt `z` in standard deviations shows the source the area `A = cos theta_i (1 + k r)+`, with `r` the
//! part of `z` along the source's azimuth, and `k` the standard deviation of tilts along it times `tan theta_i`. With `v = 1/k`
//! and the normal density `phi` the tilt is drawn from
//!
//! `phi(z)/(1 + k phi(v)) [2 A(z)/(A(z) + A(-z)) + (k r - 1)+ exp(v (r - v))]`:
//!
//! either a Gaussian tilt, kept or turned around in proportion to the areas that the two show (exact while both face the source),
//! or one tilted towards it whose `r - v` is Rayleigh. Against the ideal, area-weighted Gaussian of slopes its weight is at most
//! 1.22 (`v` near 1/2: `(1 + phi(v)/v)/(1 + Lambda)`).

use super::lobe::{Facets, GRAZING, Geometry, Lobe, Parts};
use super::slopes::WIDTH;
use crate::numeric::real::{Extended, dot};
use crate::numeric::{Real, Scalar, Vec3};
use std::f64::consts::{FRAC_1_PI, FRAC_PI_2, LOG2_E, PI};

/// Keeps the facets' share positive where they hardly reflect.
pub const FACET_ALBEDO_FLOOR: f64 = 0.01;
/// Vertical components of normals are clamped to this.
const MIN_NORMAL_Z: f64 = 1e-4;
/// Draws of a lower density are lost: rounding alone makes it, and their weight could be infinite.
const MIN_PDF: f64 = 1e-37;
/// Twice this is log2 e: `exp(-x^2/2) = 2^-(HALF_LOG2_E x^2)`.
const HALF_LOG2_E: f64 = 0.5 * LOG2_E;

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

/// What the source fixes of the facets' proposal.
struct Proposal<T> {
    /// 1/cos theta_i.
    inv_cos: T,
    /// The vector whose product with `z` is `k r`.
    towards: [T; 2],
    /// v = 1/k.
    v: T,
    /// log2 of phi(0)/phi(v).
    halvings: T,
    /// k phi(v): the tail's weight in the mixture, beside 1 for the Gaussian.
    tail_weight: T,
}

impl<T: Real> Facets<T> {
    /// The axes along the wind, across it and along a wave normal: N x W and back, so that no digits are lost where the normal
    /// leans far into the wind, nor all where it lies in it.
    #[inline(always)]
    pub(crate) fn frame(&self, n: Vec3<T>) -> [Vec3<T>; 3] {
        let (zero, one) = (T::of(0.0), T::of(1.0));
        let [cw, sw] = self.wind.to_world([one, zero]);
        let rise = T::max(n[2], T::of(MIN_NORMAL_Z));
        let c = [-(rise * sw), rise * cw, n[0] * sw - n[1] * cw];
        let inverse = T::max(dot(c, c), T::TINY).rsqrt();
        let c = [c[0] * inverse, c[1] * inverse, c[2] * inverse];
        let u = [c[1] * n[2] - c[2] * n[1], c[2] * n[0] - c[0] * n[2], c[0] * n[1] - c[1] * n[0]];
        [u, c, n]
    }

    /// For a source in the frame of the normal, as everything below.
    #[inline(always)]
    fn proposal(&self, i: Vec3<T>) -> Proposal<T> {
        let inv_cos = T::max(i[2], T::of(GRAZING)).recip();
        let towards = [i[0] * self.proposal[0] * inv_cos, i[1] * self.proposal[1] * inv_cos];
        let k2 = T::max(towards[0].mul_add(towards[0], towards[1] * towards[1]), T::TINY);
        let v = k2.rsqrt();
        let halvings = T::of(HALF_LOG2_E) * (v * v);
        let tail_weight = k2 * v * halvings.exp2_neg() * T::of(INV_SQRT_TAU);
        Proposal { inv_cos, towards, v, halvings, tail_weight }
    }

    /// Density, 1/sr, of the observer's direction among draws: the tilt's density times `d tilt^2/d omega_h`, over the mirror's
    /// `4 i.h = 4 cos theta_i cos xi (1 + slope along i/cos theta_i)`.
    #[inline(always)]
    fn pdf<E>(&self, g: &Geometry<T, E>) -> T {
        let (zero, one, two) = (T::of(0.0), T::of(1.0), T::of(2.0));
        let p = self.proposal(g.local_i);
        let tan2 = T::from_density(g.tan2);
        let inv_cos2 = one + tan2;
        // Tilts are slopes, or the angle from the normal with its azimuth; the Jacobian is d tilt^2/d omega_h.
        let (tilt_over_slope, jacobian) = if self.slope_measure {
            (one, inv_cos2 * inv_cos2)
        } else {
            let over = tan2.atan_over();
            (over, inv_cos2 * over)
        };
        let z = [g.slope[0] / self.proposal[0], g.slope[1] / self.proposal[1]];
        let z2 = tilt_over_slope * tilt_over_slope * z[0].mul_add(z[0], z[1] * z[1]);
        let slanted = g.slope[0].mul_add(g.local_i[0], g.slope[1] * g.local_i[1]) * p.inv_cos;
        // 1 + k r for slopes: the area shown over a level facet's; and k r - 1 for tilts.
        let shown = T::max(one + slanted, T::SMALL);
        let beyond = slanted.mul_add(tilt_over_slope, -one);
        // 2 A(z)/(A(z) + A(-z)) is min(1 + k r, 2); 2 pi of phi and the mirror's 4 are in `norm`.
        let halvings = T::of(HALF_LOG2_E) * z2;
        let gauss = halvings.exp2_neg() * T::min(shown, two);
        let tail = T::max((-two * p.halvings).mul_add(beyond, halvings), zero).exp2_neg() * beyond;
        let norm = T::of(8.0 * PI) * self.proposal[0] * self.proposal[1] * (one + p.tail_weight) * shown;
        T::min((gauss + T::select(zero.lt(beyond), tail, zero)) * jacobian * p.inv_cos / norm, T::MAX)
    }

    /// What a tilt is to be multiplied by for the horizontal part of its unit half vector, the vertical part, and whether there
    /// is one: a tilt angle may pass the horizontal.
    #[inline(always)]
    fn half_vector(&self, tilt2: T) -> (T, T, T::Mask) {
        let one = T::of(1.0);
        if self.slope_measure {
            let cos = (one + tilt2).rsqrt();
            return (cos, cos, T::lt(T::of(0.0), one));
        }
        let (sinc, cos) = tilt2.sinc_cos();
        (sinc, cos, T::lt(tilt2, T::of(FRAC_PI_2 * FRAC_PI_2)))
    }

    /// A half vector, and whether there is one, of two uniform numbers and what a third one chose.
    #[inline(always)]
    fn sample_half(&self, i: Vec3<T>, p: &Proposal<T>, u: [T; 2], draw: Draw<T>) -> (Vec3<T>, T::Mask) {
        let (zero, one) = (T::of(0.0), T::of(1.0));
        let Draw { in_tail, rest, sin, cos } = draw;
        // Box-Muller around the source's azimuth; in the tail r is Rayleigh beyond v.
        let first = neg_2_log1m(u[0]).sqrt();
        let r = T::select(in_tail, p.v + first, first * cos);
        let q = T::select(in_tail, neg_2_log1m(u[1]).sqrt() * cos, first * sin);
        let overhead = T::lt(T::of(MAX_V), p.v);
        let e = [T::select(overhead, one, p.towards[0] * p.v), T::select(overhead, zero, p.towards[1] * p.v)];
        let tilt =
            [e[0].mul_add(r, -(e[1] * q)) * self.proposal[0], e[1].mul_add(r, e[0] * q) * self.proposal[1]];
        let (over, vertical, valid) = self.half_vector(tilt[0].mul_add(tilt[0], tilt[1] * tilt[1]));
        let h = [tilt[0] * over, tilt[1] * over];
        // The opposite tilt with probability b/(a + b), by the areas that the two show.
        let (level, slanted) = (vertical * i[2], h[0].mul_add(i[0], h[1] * i[1]));
        let (a, b) = (T::max(level + slanted, zero), T::max(level - slanted, zero));
        let opposite = !in_tail & T::lt(rest * (a + b), b);
        ([T::select(opposite, -h[0], h[0]), T::select(opposite, -h[1], h[1]), vertical], valid)
    }
}

/// Which kind of tilt is drawn, what is left of the number that chose, and the azimuth around the source's.
struct Draw<T: Real> {
    in_tail: T::Mask,
    rest: T,
    sin: T,
    cos: T,
}

/// phi(0), Gauss's density.
const INV_SQRT_TAU: f64 = 0.398_942_280_401_432_7;
/// Beyond this v the source is overhead and has no azimuth.
const MAX_V: f64 = 1e15;

/// `-2 ln(1 - u)`, finite, for u from 0 to 1.
#[inline(always)]
fn neg_2_log1m<T: Real>(u: T) -> T {
    T::max(T::of(-2.0) * T::max(T::of(1.0) - u, T::TINY).ln(), T::of(0.0))
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
                let tilt = [u * self.sigma_u, c * self.sigma_c];
                let tilt2 = tilt[0] * tilt[0] + tilt[1] * tilt[1];
                let (over, vertical, valid) = self.half_vector(tilt2);
                if vertical < 0.05 || !valid {
                    continue;
                }
                let h = [tilt[0] * over, tilt[1] * over, vertical];
                // What the density gives to the facets of this tilt, over d tilt^2, and at worst, towards
                // a grazing source, over the area that the proposal takes them to show.
                let axis = |t: f64, sigma: f64| if self.slope_measure { t } else { t.atan() } / sigma;
                let [x, y] = [axis(h[0] / h[2], self.sigma_u), axis(h[1] / h[2], self.sigma_c)];
                // d omega_h/d tilt^2.
                let jacobian = if self.slope_measure { vertical.powi(3) } else { over };
                let slope_over_tilt = (h[0].hypot(h[1]) / h[2] + 1e-9) / (tilt2.sqrt() + 1e-9);
                let density = self.scale
                    * self.tilt_density(x / WIDTH, y / WIDTH, (h[2] * h[2]).recip())
                    * h[2]
                    * jacobian
                    * slope_over_tilt;
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
    /// What facets and whitecaps reflect, roughly: the shares of draws from them.
    #[inline(always)]
    fn albedos(&self, cos: T) -> [T; 2] {
        let rho = T::from_density(self.facets.reflectance.schlick(cos.to_density()));
        let facets = self.smooth_fraction * (rho + T::of(FACET_ALBEDO_FLOOR));
        [facets, self.whitecap_albedo()]
    }

    /// Density of the observer's direction `o` among draws for the source `i`, 1/sr.
    #[inline(always)]
    pub fn pdf(&self, i: Vec3<T>, o: Vec3<T>, n: impl Into<Option<Vec3<T>>>) -> T {
        self.pdf_parts(i, o, n, Parts::ALL)
    }

    /// The same where only some parts are drawn from.
    #[inline(always)]
    pub fn pdf_parts(&self, i: Vec3<T>, o: Vec3<T>, n: impl Into<Option<Vec3<T>>>, parts: Parts) -> T {
        if !parts.facets && !parts.whitecaps {
            return T::of(0.0);
        }
        // An oblique wind turns a sum of parts that nearly cancel.
        match self.facets.wind.quadrant {
            Some(_) => self.pdf_in::<T::Plain>(i, o, n.into(), parts),
            None => self.pdf_in::<T::Extended>(i, o, n.into(), parts),
        }
    }

    /// The same in the digits of `E`.
    #[inline(always)]
    pub(crate) fn pdf_in<E: Extended<T>>(
        &self,
        i: Vec3<T>,
        o: Vec3<T>,
        n: Option<Vec3<T>>,
        parts: Parts,
    ) -> T {
        let g = self.facets.geometry::<E>(i, o, n);
        let diffuse = g.cos[1] * T::of(FRAC_1_PI);
        g.above_horizon(match parts {
            Parts { whitecaps: false, .. } => self.facets.pdf(&g),
            Parts { facets: false, .. } => diffuse,
            _ => {
                let [facets, whitecaps] = self.albedos(g.cos[0]);
                let both = facets.mul_add(self.facets.pdf(&g), whitecaps * diffuse);
                both / T::max(facets + whitecaps, T::TINY)
            }
        })
    }

    /// A direction to the observer for the source `i`, with three uniform numbers of [0, 1), and whether it was drawn from the
    /// whitecaps; zero where nothing could be drawn.
    #[inline(always)]
    pub(crate) fn draw(&self, i: Vec3<T>, n: Option<Vec3<T>>, u: [T; 3], parts: Parts) -> (Vec3<T>, T::Mask) {
        let (zero, one, two) = (T::of(0.0), T::of(1.0), T::of(2.0));
        if !parts.facets {
            let (sin, cos) = u[2].sin_cos_turns();
            return (cosine_direction(n, u[1], sin, cos), T::lt(zero, one));
        }
        // Not `map`, here and below, whose closures would not be inlined.
        #[allow(clippy::manual_map)]
        let frame = match n {
            Some(n) => Some(self.facets.frame(n)),
            None => None,
        };
        let local = match &frame {
            Some(axes) => [dot(axes[0], i), dot(axes[1], i), dot(axes[2], i)],
            None => self.facets.wind.vector_to_wind(i),
        };
        // u[0] over the facets' share.
        let (mut choice, mut whitecap) = (u[0], T::lt(one, zero));
        if parts.whitecaps {
            let [facets, whitecaps] = self.albedos(local[2]);
            choice = u[0] * (facets + whitecaps) / T::max(facets, T::TINY);
            whitecap = !T::lt(choice, one);
            choice = T::min(choice, one);
        }
        let p = self.facets.proposal(local);
        let scaled = choice * (one + p.tail_weight);
        let in_tail = T::lt(scaled, p.tail_weight);
        let rest = T::select(in_tail, scaled / T::max(p.tail_weight, T::TINY), scaled - p.tail_weight);
        // Tails take their azimuth from the first number, all others from the last.
        let from_rest = if parts.whitecaps { in_tail & !whitecap } else { in_tail };
        let (sin, cos) = T::select(from_rest, rest, u[2]).sin_cos_turns();
        let (h, valid) = self.facets.sample_half(local, &p, [u[1], u[2]], Draw { in_tail, rest, sin, cos });
        let h = match &frame {
            Some(axes) => from_axes(axes, h),
            None => {
                let [x, y] = self.facets.wind.to_world([h[0], h[1]]);
                [x, y, h[2]]
            }
        };
        // The source mirrored by the half vector.
        let c = two * dot(i, h);
        let mirrored = [c.mul_add(h[0], -i[0]), c.mul_add(h[1], -i[1]), c.mul_add(h[2], -i[2])];
        let mut o = select(valid, mirrored, [zero; 3]);
        if parts.whitecaps {
            o = select(whitecap, cosine_direction(n, u[1], sin, cos), o);
        }
        (o, whitecap)
    }

    /// What [`Lobe::sample`] gives, in every lane, without a branch: direction, density, f, and whether it was drawn from the
    /// whitecaps.
    #[inline(always)]
    pub(crate) fn sample_lanes(
        &self,
        i: Vec3<T>,
        n: Option<Vec3<T>>,
        u: [T; 3],
    ) -> (Vec3<T>, [T; 2], T::Mask) {
        let zero = T::of(0.0);
        let (direction, whitecap) = self.draw(i, n, u, Parts::ALL);
        let pdf = self.pdf(i, direction, n);
        let f = self.eval(i, direction, n);
        let lost = T::lt(pdf, T::of(MIN_PDF));
        let values = [T::select(lost, zero, pdf), T::select(lost, zero, f)];
        (select(lost, [zero; 3], direction), values, whitecap)
    }
}

impl<T: Scalar> Lobe<T> {
    /// Draws an observer's direction for the source `i`, with three uniform numbers of [0, 1).
    ///
    /// ```
    /// use prob_water::Parameters;
    ///
    /// let lobe = Parameters::default().configure()?.lobe()?;
    /// let source = [0.6, 0.0, 0.8];
    /// let drawn = lobe.sample(source, None, [0.3, 0.6, 0.9]);
    /// assert_eq!(drawn.pdf, lobe.pdf(source, drawn.direction, None)); // 1/sr
    /// assert_eq!(drawn.f, lobe.eval(source, drawn.direction, None)); // 1/sr
    /// # Ok::<(), prob_water::Error>(())
    /// ```
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
        let (zero, n) = (T::of(0.0), n.into());
        let (direction, whitecap) = self.draw(i, n, u, parts);
        let pdf = self.pdf_parts(i, direction, n, parts);
        if pdf.below(T::of(MIN_PDF)) {
            return Sample { direction: [zero; 3], pdf: zero, f: zero, whitecap };
        }
        Sample { direction, pdf, f: self.eval_parts(i, direction, n, parts), whitecap }
    }
}

/// `a` where `mask` holds, else `b`.
#[inline(always)]
fn select<T: Real>(mask: T::Mask, a: Vec3<T>, b: Vec3<T>) -> Vec3<T> {
    [T::select(mask, a[0], b[0]), T::select(mask, a[1], b[1]), T::select(mask, a[2], b[2])]
}

/// The vector of components along three axes.
#[inline(always)]
fn from_axes<T: Real>([x, y, z]: &[Vec3<T>; 3], v: Vec3<T>) -> Vec3<T> {
    [
        v[0].mul_add(x[0], v[1].mul_add(y[0], v[2] * z[0])),
        v[0].mul_add(x[1], v[1].mul_add(y[1], v[2] * z[1])),
        v[0].mul_add(x[2], v[1].mul_add(y[2], v[2] * z[2])),
    ]
}

/// A direction about `n`, in proportion to its cosine, of a number and of sine and cosine of its azimuth.
#[inline(always)]
fn cosine_direction<T: Real>(n: Option<Vec3<T>>, u: T, sin: T, cos: T) -> Vec3<T> {
    let (zero, one) = (T::of(0.0), T::of(1.0));
    let r = u.sqrt();
    let z = T::max(one - u, zero).sqrt();
    let (x, y) = (r * cos, r * sin);
    let Some(n) = n else { return [x, y, z] };
    // Orthonormal tangents of a normal that points up.
    let a = -(one + n[2]).recip();
    let b = n[0] * n[1] * a;
    let s = [(n[0] * n[0]).mul_add(a, one), b, -n[0]];
    let t = [b, (n[1] * n[1]).mul_add(a, one), -n[1]];
    from_axes(&[s, t, n], [x, y, z])
}
