//! Draws by importance, for facets so narrow that hardly any sea drawn as the wind draws them mirrors the source to an
//! observer: half of the seas have their phases drawn such that the slope at the hit does.
//!
//! **Place.** A sea is the same everywhere: a ray meets its points in proportion to the area `A = max(0, N.i)/N_z` that
//! they show, so that with V = 1 where a point sees the laser and else 0,
//!
//! `E[f at the first hit] = E[A V f]/cos theta_i`
//!
//! over seas whose phases count at the hit itself. The hit then lies on the beam at the height that the sea has there.
//!
//! **Slopes.** Split the components into two groups. A common shift theta of the phases of a group moves its slope around
//! an ellipse, `-(S cos theta + C sin theta)` with the sums `S, C` of `a k e sin Psi` and `a k e cos Psi`. For a slope t there
//! are up to four pairs of shifts whose ellipses add up to t, and phases that are uniform stay so under them. A sea drawn by
//! importance takes one of R splits, t from a Gaussian q about the slopes where drawn waves and facets meet, and one of its
//! n pairs; beside the density of uniform phases, that of its phases is
//!
//! `q(t) (2 pi)^2 mean over splits of |J|/n`, `J = dE_1/dtheta_1 x dE_2/dtheta_2`.
//!
//! Where the ellipses of one split touch, J = 0; those of the others do not, so that no weight stands out.
//!
//! **Weights.** Every other sea is drawn so, the rest as the wind draws them; both are weighted by the density of the
//! mixture (the balance heuristic), at most twice what a sea drawn plainly counts. Means are unbiased.

use super::characteristic::{steepest, variances};
use super::engagement::Engagement;
use super::ensemble::{Ensemble, Hit, Observation, Worker};
use super::level_water::BaselineLobe;
use crate::surface::{Component, Draws, InstanceRng};
use glam::{DMat2, DVec2, DVec3};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};
use std::ops::Range;
use std::sync::LazyLock;

/// Plain draws per effective one, for the mean at the lobe's peak, above which facets are narrow.
const NARROW: f64 = 10.0;
/// Fewest components that make two ellipses.
pub const FEWEST_COMPONENTS: u32 = 4;
/// Standard deviation of the proposal over that of the product of drawn slopes and facets: facets have heavier tails.
const WIDENING: f64 = 1.2;
/// Squared length of a pair of normal deviates from uniform numbers of 53 bits, at most: 2 ln 2^53.
const LARGEST: f64 = 73.5;
/// Splits of the components into two groups.
const SPLITS: usize = 3;
/// Steps around an ellipse between which intersections are looked for.
const STEPS: usize = 32;
/// Set in the number of the stream that an instance's further numbers come from.
const FURTHER: u64 = 1 << 63;

/// What observers see of seas drawn by importance.
#[derive(Debug)]
pub(crate) struct SlopeDraws {
    /// Where the beam meets each sea.
    pub hits: Vec<Hit>,
    /// What the observers see of each sea.
    pub observations: Vec<Observation>,
    /// Weights, 1 on average; 0 for a sea whose point the beam does not reach.
    pub weights: Vec<f64>,
    /// No weight is larger.
    pub largest_weight: f64,
}

/// Gaussian density of slopes along and across the wind.
#[derive(Debug, Clone, Copy)]
struct Gaussian {
    wind: DVec2,
    centre: DVec2,
    sigma: DVec2,
}

impl Gaussian {
    fn density(&self, slope: DVec2) -> f64 {
        let at = (DVec2::new(slope.dot(self.wind), slope.dot(self.wind.perp())) - self.centre) / self.sigma;
        // Slopes beyond the largest deviates are never drawn.
        if at.length_squared() > LARGEST {
            return 0.0;
        }
        (-0.5 * at.length_squared()).exp() / (TAU * self.sigma.x * self.sigma.y)
    }

    /// The slope of two uniform numbers (Box and Muller).
    fn draw(&self, [a, b]: [f64; 2]) -> DVec2 {
        let normal = DVec2::from_angle(TAU * b) * (-2.0 * (1.0 - a).ln()).sqrt();
        let at = self.centre + self.sigma * normal;
        at.x * self.wind + at.y * self.wind.perp()
    }
}

impl Ensemble {
    /// Whether plain draws leave the mean of f towards each observer to too few seas: facets are narrow beside the drawn
    /// slopes, and f varies by them more than by whitecaps.
    pub(crate) fn needs_slopes(&self, engagement: &Engagement, baseline: &BaselineLobe) -> Vec<bool> {
        let water = &self.water;
        // Mean square over squared mean of the facets' f at the peak.
        let square = baseline.ln_square([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]).exp();
        let all = baseline.sampler(water);
        let foam = if water.parameters.whitecaps { water.whitecap_fraction } else { 0.0 };
        let facets_matter = |[i, o]: [[f64; 3]; 2]| {
            square * all.facets.eval(i, o, None).powi(2) > foam * all.whitecap_brdf.powi(2)
        };
        engagement.ways().map(|ways| square > NARROW && facets_matter(ways)).collect()
    }

    /// Seas drawn by importance for one observer.
    pub(crate) fn slope_draws(
        &self,
        engagement: &Engagement,
        observer: usize,
        instances: Range<u64>,
        into: SlopeDraws,
    ) -> SlopeDraws {
        let proposal = self.slope_proposal(engagement, observer);
        let count = instances.end - instances.start;
        // Of every two instances the second is drawn by importance.
        let shares = [count.div_ceil(2), count / 2].map(|n| n as f64 / count as f64);
        let mut draws = into;
        let rows = draws.hits.par_iter_mut().zip(&mut draws.observations).zip(&mut draws.weights);
        rows.enumerate().for_each_init(Worker::default, |worker, (row, ((hit, seen), weight))| {
            let instance = instances.start + row as u64;
            *weight = 0.0;
            let phases = self.phases(instance, row % 2 == 1, &proposal, shares);
            if let Some((chance, components, density)) = phases {
                *weight = density * self.look(worker, engagement, observer, (chance, &components), hit, seen);
            }
        });
        let beam = -DVec3::from(engagement.direction());
        // The steepest slope that M components can have shows the largest area.
        let steepest = steepest(&self.waves);
        draws.largest_weight = (1.0 + steepest * beam.truncate().length() / beam.z) / shares[0];
        draws
    }

    fn slope_proposal(&self, engagement: &Engagement, observer: usize) -> Gaussian {
        let [i, o] = engagement.ways().nth(observer).expect("the observer is checked").map(DVec3::from);
        let half = i + o;
        let wind = DVec2::from_angle(self.waves.wind_azimuth);
        let world = -half.truncate() / half.z.max(1e-9);
        let specular = DVec2::new(world.dot(wind), world.dot(wind.perp()));
        let facets = self.water.lobe.facets.slope_width(specular);
        let [upwind, crosswind, _] = variances(&self.waves);
        let [drawn, needed] = [DVec2::new(upwind, crosswind), facets * facets].map(|v| 1.0 / v);
        Gaussian {
            wind,
            centre: specular * needed / (drawn + needed),
            sigma: WIDENING * (drawn + needed).powf(-0.5),
        }
    }

    /// The whitecap's chance, the components with their phases at the hit and at the time, and the density of plain seas
    /// over that of the mixture; `None` where no phases have the slope that was drawn.
    fn phases(
        &self,
        instance: u64,
        important: bool,
        proposal: &Gaussian,
        [plain, slopes]: [f64; 2],
    ) -> Option<(f64, Vec<Component>, f64)> {
        let seed = self.water.parameters.seed;
        let mut numbers = InstanceRng::new(self.draws, seed, instance);
        let chance = numbers.next();
        let mut components: Vec<Component> = self.waves.components(numbers).collect();
        let mut moving: Vec<Ellipse> = components.iter().map(Ellipse::of).collect();
        if important {
            let mut further = InstanceRng::new(Draws::Random, seed, instance | FURTHER);
            let [a, b, pair, split] = [(); 4].map(|()| further.next());
            let split = (split * SPLITS as f64) as usize;
            let meetings = Meetings::new(&Ellipse::pair(&moving, split), proposal.draw([a, b]));
            let shifts = meetings.get((pair * meetings.len() as f64) as usize)?;
            let turns = shifts.map(DVec2::from_angle);
            for (j, (component, slope)) in components.iter_mut().zip(&mut moving).enumerate() {
                let group = group(split, j);
                component.phase = (component.phase + shifts[group]) % TAU;
                *slope = slope.shifted(turns[group]);
            }
        }
        let pairs: [_; SPLITS] = std::array::from_fn(|split| Ellipse::pair(&moving, split));
        let slope = -(pairs[0][0].sine + pairs[0][1].sine);
        let proposed = proposal.density(slope);
        if proposed == 0.0 {
            return Some((chance, components, 1.0 / plain));
        }
        let each = pairs.iter().map(|[first, second]| {
            let jacobian = first.cosine.perp_dot(second.cosine).abs();
            let meetings = Meetings::new(&[*first, *second], slope);
            // A pair that is not found is not drawn either.
            if meetings.hold_no_shift() { jacobian / meetings.len() as f64 } else { 0.0 }
        });
        let over = proposed * (TAU * TAU) * each.sum::<f64>() / SPLITS as f64;
        Some((chance, components, 1.0 / (plain + slopes * over)))
    }

    /// The hit and the observation where the sea's origin lies on the beam, and their weight beside the phases': `A V/cos theta_i`.
    fn look(
        &self,
        worker: &mut Worker,
        engagement: &Engagement,
        observer: usize,
        (chance, components): (f64, &[Component]),
        hit: &mut Hit,
        seen: &mut Observation,
    ) -> f64 {
        worker.surface.draw(components.iter().copied());
        worker.surface.set_time(0.0);
        let point = worker.surface.point([0.0; 2]);
        let (laser, beam) = (DVec3::from(engagement.laser()), DVec3::from(engagement.direction()));
        if point.height >= laser.z {
            hit.position = engagement.laser();
            *seen = Observation { f: 0.0, cos_r: 0.0, obscured: true };
            return 1.0;
        }
        let area = -beam.z + DVec2::from(point.slope).dot(beam.truncate());
        let from = DVec3::new(0.0, 0.0, point.height);
        let back = (laser.z - point.height) / -beam.z;
        if area <= 0.0 || worker.ray.occludes(&worker.surface, from, from - back * beam) {
            return 0.0;
        }
        let place = laser + back * beam;
        let position = [place.x, place.y, point.height];
        *hit = Hit { position, ..self.hit_at(&worker.surface, [0.0; 2], &point, chance) };
        // The sea's origin is the hit's place.
        let origin = place.truncate().extend(0.0);
        self.observe(
            worker,
            engagement,
            hit,
            origin,
            &engagement.observers()[observer..=observer],
            std::slice::from_mut(seen),
        );
        area / -beam.z
    }
}

/// The slopes that a common shift of some components' phases gives.
#[derive(Debug, Clone, Copy)]
struct Ellipse {
    /// Sums of a k e sin Psi and of a k e cos Psi.
    sine: DVec2,
    cosine: DVec2,
}

/// The group of a component in a split of them all.
fn group(split: usize, component: usize) -> usize {
    match split {
        0 => component % 2,
        1 => component / 2 % 2,
        _ => component.div_ceil(2) % 2,
    }
}

impl Ellipse {
    /// Of one component.
    fn of(c: &Component) -> Self {
        let slope = DVec2::from_angle(c.azimuth) * c.amplitude * c.wave_number;
        let (sin, cos) = c.phase.sin_cos();
        Self { sine: sin * slope, cosine: cos * slope }
    }

    /// Those of the two groups of a split.
    fn pair(components: &[Self], split: usize) -> [Self; 2] {
        let mut pair = [Self { sine: DVec2::ZERO, cosine: DVec2::ZERO }; 2];
        for (j, component) in components.iter().enumerate() {
            let ellipse = &mut pair[group(split, j)];
            ellipse.sine += component.sine;
            ellipse.cosine += component.cosine;
        }
        pair
    }

    /// After a shift of a cosine and a sine.
    fn shifted(&self, by: DVec2) -> Self {
        Self { sine: self.sine * by.x + self.cosine * by.y, cosine: self.cosine * by.x - self.sine * by.y }
    }
}

/// A place around an ellipse, radians, and the unit vectors of all.
fn place(step: usize) -> f64 {
    TAU * step as f64 / STEPS as f64 - PI
}
static AROUND: LazyLock<[DVec2; STEPS]> =
    LazyLock::new(|| std::array::from_fn(|step| DVec2::from_angle(place(step))));

/// The pairs of shifts for which two ellipses add up to a slope: four at most.
struct Meetings {
    shifts: [[f64; 2]; 4],
    count: usize,
}

impl Meetings {
    fn new(ellipses: &[Ellipse; 2], slope: DVec2) -> Self {
        let mut meetings = Self { shifts: [[0.0; 2]; 4], count: 0 };
        let [first, second] = ellipses;
        let map = DMat2::from_cols(-second.sine, -second.cosine);
        if map.determinant().abs() < f64::MIN_POSITIVE {
            return meetings;
        }
        // Cosine and sine of the second shift, were its ellipse met, as a + b cos + c sin of the first.
        let inverse = map.inverse();
        let around = &*AROUND;
        let (a, b, c) = (inverse * slope, inverse * first.sine, inverse * first.cosine);
        // How far that is from a circle, as a trigonometric polynomial of the first shift, and its derivatives.
        let (b2, c2, ab, ac, bc) = (b.length_squared(), c.length_squared(), a.dot(b), a.dot(c), b.dot(c));
        let level = a.length_squared() + 0.5 * (b2 + c2) - 1.0;
        let half = 0.5 * (b2 - c2);
        let gap = |at: DVec2| {
            let (c, s) = (at.x, at.y);
            let (s2, c2) = (2.0 * s * c, (c - s) * (c + s));
            [
                level + 2.0 * (ab * c + ac * s) + half * c2 + bc * s2,
                2.0 * (ac * c - ab * s) + 2.0 * (bc * c2 - half * s2),
                -2.0 * (ab * c + ac * s) - 4.0 * (half * c2 + bc * s2),
            ]
        };
        let mut add = |shift: f64| {
            if meetings.count < 4 {
                let (sin, cos) = shift.sin_cos();
                let at = a + b * cos + c * sin;
                meetings.shifts[meetings.count] = [shift, at.y.atan2(at.x)];
                meetings.count += 1;
            }
        };
        let between = |start: f64, end: f64, rises: bool, order: usize| {
            root(start, end, rises, |shift| {
                let gap = gap(DVec2::from_angle(shift));
                (gap[order], gap[order + 1])
            })
        };
        let mut before = gap(around[0]);
        for k in 0..STEPS {
            let after = gap(around[(k + 1) % STEPS]);
            let rises = before[0] < 0.0;
            if rises != (after[0] < 0.0) {
                add(between(place(k), place(k + 1), rises, 0));
            } else if rises == (before[1] > 0.0) && rises == (after[1] < 0.0) {
                // Towards the circle and back: twice across it, or not.
                let middle = between(place(k), place(k + 1), !rises, 1);
                if (gap(DVec2::from_angle(middle))[0] < 0.0) != rises {
                    add(between(place(k), middle, rises, 0));
                    add(between(middle, place(k + 1), !rises, 0));
                }
            }
            before = after;
        }
        meetings
    }

    fn len(&self) -> usize {
        self.count
    }

    fn get(&self, pair: usize) -> Option<[f64; 2]> {
        self.shifts[..self.count].get(pair).copied()
    }

    /// Whether no shift at all is one of the pairs.
    fn hold_no_shift(&self) -> bool {
        let none = |shift: &f64| (shift - TAU * (shift / TAU).round()).abs() < 1e-6;
        self.shifts[..self.count].iter().any(|shifts| shifts.iter().all(none))
    }
}

/// The root between two places, by Newton's steps where they stay between, else by halves; `rises` says that the function
/// is negative at the first.
fn root(mut low: f64, mut high: f64, rises: bool, of: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut x = 0.5 * (low + high);
    for _ in 0..60 {
        let (value, slope) = of(x);
        if (value < 0.0) == rises {
            low = x
        } else {
            high = x
        }
        let newton = x - value / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - x).abs() < 1e-13 {
            break;
        }
        x = next;
    }
    x
}
