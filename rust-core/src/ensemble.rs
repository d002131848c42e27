//! Statistics of the BRDF over drawn surfaces: the probabilistic BRDF (section 7 of the report).
//!
//! ```
//! use prob_water::{Aim, Engagement, Ensemble, Exact, Parameters, Surface, Wind};
//!
//! # fn main() -> Result<(), prob_water::Error> {
//! let water = Parameters {
//!     wind: Wind::FrictionVelocity(8.0),
//!     surface: Surface::Instance,
//!     components: 5,
//!     instances: 1000,
//!     ..Parameters::default()
//! }
//! .configure()?;
//!
//! // A laser at 30 degrees of incidence, and who might look into its reflection; m, s.
//! let engagement = Engagement::new(
//!     0.0,
//!     [-5000.0, 0.0, 8660.0],
//!     Aim::Target([0.0, 0.0, 0.0]),
//!     &[[5000.0, 0.0, 8660.0], [7000.0, 0.0, 7000.0]],
//! )?;
//!
//! let ensemble = Ensemble::new(&water)?;
//! ensemble.check(&engagement)?;                                        // memory, before it is taken
//! let samples = ensemble.sample(&[engagement.clone()], &|_casts| ())?; // on all cores
//! let statistics = samples.statistics(0, 1, &[0.01])?;                 // engagement 0, observer 1, limits in 1/sr
//!
//! let exact = Exact::new(&water)?;                                     // infinitely many draws
//! let mean = exact.means(&engagement)[1].f;
//! assert!((statistics.mean - mean).abs() < 5.0 * statistics.sem);
//! # Ok(())
//! # }
//! ```

use crate::brdf::Lobe;
use crate::cast::Path;
use crate::error::refuse;
use crate::level_water::Spreads;
use crate::parameters::DRAWN;
use crate::scenario::Engagement;
use crate::slope_draws::{FEWEST_COMPONENTS, Proposal, SlopeDraws};
use crate::statistics::{Bounds, Draw, Statistics};
use crate::surface::{self, Surface, normal};
use crate::waves::{Component, Draws, Numbers, Waves};
use crate::{Error, Water};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::ops::Range;

/// What one group of samples may take, bytes: [`Ensemble::check`] refuses an engagement that needs more.
pub const MEMORY: u64 = 4 << 30;

/// Whether a whitecap stands at the hit of an instance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Presence {
    /// Drawn with its probability (Eq. 53), as in the report: f is the whitecap's or the facets'.
    #[default]
    Drawn,
    /// Both, weighted by the probability: the same mean with less spread.
    Expected,
}

/// Instances of a sea to be drawn and looked at.
#[derive(Debug, Clone, Copy)]
pub struct Ensemble {
    /// The sea; its parameters give components, instances and seed.
    pub water: Water,
    /// What its waves are drawn from.
    pub waves: Waves,
    /// How their random numbers are spread.
    pub draws: Draws,
    /// How whitecaps take part.
    pub presence: Presence,
    /// Which seas are drawn, where facets are narrow.
    pub proposal: Proposal,
    /// Place in m and time in s at which the drawn phases count. Any will do, but evenly spread phases help most where
    /// the beam meets the water: [`Ensemble::around`].
    pub phases_at: ([f64; 2], f64),
}

/// Where the beam met the water in one instance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// m.
    pub position: [f64; 3],
    /// The wave normal there.
    pub normal: [f64; 3],
    /// 0 or 1 where whitecaps are drawn, else their probability.
    pub whitecap: f64,
}

/// What one observer saw of one instance.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Observation {
    /// The BRDF, 1/sr; 0 where the observer cannot see the hit.
    pub f: f64,
    /// Cosine of the angle of reflection to the wave normal.
    pub cos_r: f64,
    /// A wave hides the hit from the observer, or covers the observer or the laser.
    pub obscured: bool,
}

impl Ensemble {
    /// The report's: random draws and drawn whitecaps.
    ///
    /// # Errors
    /// [`Error::Surface`] where the surface is flat: it has no waves to draw.
    pub fn new(water: &Water) -> Result<Self, Error> {
        let water = water.on(&DRAWN)?;
        Ok(Self {
            water,
            waves: water.waves(),
            draws: Draws::Random,
            presence: Presence::Drawn,
            proposal: Proposal::Plain,
            phases_at: ([0.0; 2], 0.0),
        })
    }

    /// The same, with Sobol draws whose phases count where and when this engagement's beam meets the mean surface.
    pub fn around(self, engagement: &Engagement) -> Self {
        let [x, y, _] = engagement.target();
        Self { draws: Draws::Sobol, phases_at: ([x, y], engagement.time()), ..self }
    }

    /// The components of an instance, and the number of [0, 1) that decides about its whitecap.
    pub fn components(&self, instance: u64) -> (f64, impl Iterator<Item = Component>) {
        let mut numbers = Numbers::new(self.draws, self.water.parameters.seed, instance);
        let chance = numbers.next();
        let (place, time) = self.phases_at;
        (chance, self.waves.components(numbers).map(move |c| c.with_phase_at(place, time)))
    }

    /// Refuses an engagement whose samples would take more than [`MEMORY`], and slopes of too few components.
    pub fn check(&self, engagement: &Engagement) -> Result<(), Error> {
        self.possible_proposal()?;
        let instances = self.water.parameters.instances;
        let (one, observers) = (self.bytes(engagement), engagement.observers().len());
        if instances <= MEMORY / one {
            return Ok(());
        }
        let allowed = format!(
            "at most {} with {observers} observers, whose samples then take 4 GiB; asked for are {:.1} GiB",
            MEMORY / one,
            instances as f64 * one as f64 / (1u64 << 30) as f64
        );
        Err(Error::OutOfRange { parameter: "instances", value: instances.to_string(), allowed })
    }

    /// Samples of all instances, for as many of the engagements, from the first on, as fit into [`MEMORY`].
    /// `progress` is told how many casts are done, from any thread.
    pub fn sample(
        &self,
        engagements: &[Engagement],
        progress: &(dyn Fn(u64) + Sync),
    ) -> Result<Samples, Error> {
        let instances = self.water.parameters.instances;
        self.sample_range(engagements, 0..instances, progress)
    }

    /// The same for some of the instances.
    pub fn sample_range(
        &self,
        engagements: &[Engagement],
        instances: Range<u64>,
        progress: &(dyn Fn(u64) + Sync),
    ) -> Result<Samples, Error> {
        if engagements.is_empty() {
            return Err(Error::Length { what: "engagements", found: 0, expected: 1 });
        }
        let count = instances.end - instances.start;
        if count == 0 {
            return refuse("instances", count, "at least 1");
        }
        let mut needed = 0;
        let fits = |e: &&Engagement| {
            needed += count * self.bytes(e);
            needed <= MEMORY
        };
        let group = engagements.iter().take_while(fits).count().max(1).min(engagements.len());
        let group = &engagements[..group];
        let plan = self.plan(group)?;

        let plain: Vec<Engagement> = plan.iter().zip(group).filter_map(|(plan, e)| plan.plain(e)).collect();
        let width: usize = plain.iter().map(|e| e.observers().len()).sum();
        let empty = Hit { position: [0.0; 3], normal: normal([0.0; 2]), whitecap: 0.0 };
        let mut hits = reserved(count as usize * plain.len(), empty)?;
        let mut observations = reserved(count as usize * width, Observation::default())?;
        if !plain.is_empty() {
            let rows = hits.par_chunks_mut(plain.len()).zip(observations.par_chunks_mut(width));
            rows.enumerate().for_each_init(Worker::default, |worker, (row, (hits, observations))| {
                self.instance(worker, instances.start + row as u64, &plain, hits, observations);
                progress(plain.len() as u64);
            });
        }

        let mut slopes = vec![];
        for (plan, engagement) in plan.iter().zip(group) {
            for observer in plan.by_slopes() {
                let into = SlopeDraws {
                    hits: reserved(count as usize, empty)?,
                    observations: reserved(count as usize, Observation::default())?,
                    weights: reserved(count as usize, 0.0)?,
                    largest_weight: 0.0,
                };
                slopes.push(self.slope_draws(engagement, observer, instances.clone(), into));
                progress(count);
            }
        }
        let plain =
            Plain { observers: plain.iter().map(|e| e.observers().len()).collect(), hits, observations };
        let ways = group.iter().map(|e| e.ways().collect()).collect();
        Ok(Samples {
            first: instances.start,
            count: count as usize,
            lobe: self.water.lobe,
            ways,
            plan,
            plain,
            slopes,
        })
    }

    /// Number of casts that the instances of these engagements take, for progress.
    pub fn casts(&self, engagements: &[Engagement]) -> Result<u64, Error> {
        let seas = |plan: &Plan| u64::from(plan.has_plain()) + plan.by_slopes().count() as u64;
        Ok(self.plan(engagements)?.iter().map(seas).sum::<u64>() * self.water.parameters.instances)
    }

    /// What is proposed, or what is left of it with few components or no waves.
    fn possible_proposal(&self) -> Result<Proposal, Error> {
        let components = self.water.parameters.components;
        let few = components < FEWEST_COMPONENTS;
        match self.proposal {
            Proposal::Slopes if few => {
                refuse("components", components, format!("at least {FEWEST_COMPONENTS} to draw slopes"))
            }
            Proposal::Auto if few => Ok(Proposal::Plain),
            _ if self.waves.is_empty() => Ok(Proposal::Plain),
            proposal => Ok(proposal),
        }
    }

    /// How every observer's seas are drawn.
    fn plan(&self, engagements: &[Engagement]) -> Result<Vec<Plan>, Error> {
        let all =
            |by_slopes| engagements.iter().map(|e| Plan(vec![by_slopes; e.observers().len()])).collect();
        Ok(match self.possible_proposal()? {
            Proposal::Plain => all(false),
            Proposal::Slopes => all(true),
            Proposal::Auto => {
                let spreads = Spreads::new(&self.water);
                engagements.iter().map(|e| Plan(self.needs_slopes(e, &spreads))).collect()
            }
        })
    }

    /// Memory that one instance of an engagement takes, at most.
    fn bytes(&self, engagement: &Engagement) -> u64 {
        let observers = engagement.observers().len();
        let by_slopes = size_of::<Hit>() + size_of::<f64>();
        let hits = if self.proposal == Proposal::Plain { size_of::<Hit>() } else { observers * by_slopes };
        (hits + observers * size_of::<Observation>()) as u64
    }

    /// One instance: every engagement's hit and observations.
    fn instance(
        &self,
        worker: &mut Worker,
        instance: u64,
        group: &[Engagement],
        hits: &mut [Hit],
        mut observations: &mut [Observation],
    ) {
        let (chance, components) = self.components(instance);
        worker.surface.draw(components);
        for (engagement, hit) in group.iter().zip(hits) {
            let (now, later) = observations.split_at_mut(engagement.observers().len());
            observations = later;
            worker.surface.set_time(engagement.time());
            match self.hit(worker, engagement, chance) {
                Some(found) => {
                    *hit = found;
                    self.observe(worker, engagement, hit, DVec3::ZERO, engagement.observers(), now);
                }
                None => {
                    hit.position = engagement.laser();
                    now.fill(Observation { f: 0.0, cos_r: 0.0, obscured: true });
                }
            }
        }
    }

    /// Where the beam meets the water; `None` if a wave covers the laser.
    fn hit(&self, worker: &mut Worker, engagement: &Engagement, chance: f64) -> Option<Hit> {
        let (laser, beam) = (engagement.laser().into(), engagement.direction().into());
        let place = worker.path.first_hit(&worker.surface, laser, beam)?.truncate().to_array();
        let point = worker.surface.point(place);
        Some(self.hit_of(&point, place, chance))
    }

    /// The hit at a place whose surface is known.
    pub(crate) fn hit_of(&self, point: &surface::Point, place: [f64; 2], chance: f64) -> Hit {
        let probability = self.water.whitecap_probability(point.acceleration);
        Hit {
            position: [place[0], place[1], point.height],
            normal: point.normal(),
            whitecap: match self.presence {
                Presence::Drawn => f64::from(chance < probability),
                Presence::Expected => probability,
            },
        }
    }

    /// What some observers see of a hit, on a surface whose own origin is at a place in m.
    pub(crate) fn observe(
        &self,
        worker: &mut Worker,
        engagement: &Engagement,
        hit: &Hit,
        origin: DVec3,
        observers: &[[f64; 3]],
        observations: &mut [Observation],
    ) {
        let (from, n) = (DVec3::from(hit.position), DVec3::from(hit.normal));
        let to_laser = -DVec3::from(engagement.direction());
        for (observer, seen) in observers.iter().zip(observations) {
            let observer = DVec3::from(*observer);
            let way = (observer - from).normalize();
            seen.cos_r = way.dot(n);
            seen.obscured =
                seen.cos_r <= 0.0 || worker.path.hides(&worker.surface, from - origin, observer - origin);
            if !seen.obscured {
                let lobe = &self.water.lobe;
                let facets = if hit.whitecap < 1.0 {
                    lobe.facets.eval(to_laser.into(), way.into(), hit.normal)
                } else {
                    0.0
                };
                seen.f = (1.0 - hit.whitecap) * facets + hit.whitecap * lobe.whitecap_brdf;
            }
        }
    }
}

/// What one thread needs again and again.
#[derive(Default)]
pub(crate) struct Worker {
    pub surface: Surface,
    pub path: Path,
}

/// Of every observer of an engagement, whether its seas are drawn by slopes.
#[derive(Debug)]
struct Plan(Vec<bool>);

impl Plan {
    fn has_plain(&self) -> bool {
        self.0.contains(&false)
    }

    /// The engagement with the observers of plain draws alone; `None` if there are none.
    fn plain(&self, engagement: &Engagement) -> Option<Engagement> {
        self.has_plain().then(|| engagement.with_observers(|observer| !self.0[observer]))
    }

    fn by_slopes(&self) -> impl Iterator<Item = usize> {
        self.0.iter().enumerate().filter_map(|(observer, by_slopes)| by_slopes.then_some(observer))
    }

    /// Of the observers before one, how many have plain draws and how many have not.
    fn before(&self, observer: usize) -> [usize; 2] {
        let by_slopes = self.0[..observer].iter().filter(|by_slopes| **by_slopes).count();
        [observer - by_slopes, by_slopes]
    }
}

/// Memory for so many, or a refusal instead of an abort.
fn reserved<T: Clone>(count: usize, value: T) -> Result<Vec<T>, Error> {
    let mut all = Vec::new();
    all.try_reserve_exact(count).map_err(|_| Error::OutOfRange {
        parameter: "instances",
        value: format!("{count} samples"),
        allowed: "what fits into this machine's memory".into(),
    })?;
    all.resize(count, value);
    Ok(all)
}

/// All instances of a group of engagements.
#[derive(Debug)]
pub struct Samples {
    first: u64,
    count: usize,
    lobe: Lobe<f64>,
    /// Of every engagement and observer, directions from the target to the laser and to the observer.
    ways: Vec<Vec<[[f64; 3]; 2]>>,
    plan: Vec<Plan>,
    plain: Plain,
    /// Of every observer whose seas are drawn by slopes.
    slopes: Vec<SlopeDraws>,
}

/// Plain draws of the engagements that have any.
#[derive(Debug)]
struct Plain {
    /// Of every engagement.
    observers: Vec<usize>,
    /// Instance by instance, in each the engagements.
    hits: Vec<Hit>,
    /// Instance by instance, in each the engagements, in each its observers.
    observations: Vec<Observation>,
}

/// One drawn sea as an observer sees it.
#[derive(Debug, Clone, Copy)]
pub struct Sighting<'a> {
    /// Its number.
    pub instance: u64,
    /// What it counts in a mean: 1 for plain draws; else 1 on average, and 0 for a sea that the beam does not reach.
    pub weight: f64,
    /// Where the beam meets the water.
    pub hit: &'a Hit,
    /// What the observer sees of that.
    pub seen: &'a Observation,
}

impl Samples {
    /// How many engagements the group holds.
    pub fn engagements(&self) -> usize {
        self.plan.len()
    }

    /// How many instances were drawn.
    pub fn instances(&self) -> usize {
        self.count
    }

    fn seas(&self, engagement: usize, observer: usize) -> Result<Seas<'_>, Error> {
        let missing = |what, index, count| Error::Index { what, index, count };
        let plan =
            self.plan.get(engagement).ok_or_else(|| missing("engagement", engagement, self.plan.len()))?;
        let by_slopes = *plan.0.get(observer).ok_or_else(|| missing("observer", observer, plan.0.len()))?;
        let before = &self.plan[..engagement];
        let [plain, slopes] = plan.before(observer);
        Ok(if by_slopes {
            let others: usize = before.iter().map(|plan| plan.by_slopes().count()).sum();
            Seas::Slopes(&self.slopes[others + slopes])
        } else {
            Seas::Plain { engagement: before.iter().filter(|plan| plan.has_plain()).count(), observer: plain }
        })
    }

    /// Whether an observer's seas were drawn by slopes; refused where there is no such engagement or observer.
    pub fn by_slopes(&self, engagement: usize, observer: usize) -> Result<bool, Error> {
        Ok(matches!(self.seas(engagement, observer)?, Seas::Slopes(_)))
    }

    /// Every instance, as an observer of one of the engagements saw it; refused where there is no such engagement or
    /// observer.
    pub fn of(
        &self,
        engagement: usize,
        observer: usize,
    ) -> Result<impl Iterator<Item = Sighting<'_>>, Error> {
        let every = |first: usize, step: usize| (first, step);
        let (hits, observations, weights, [hit, seen]) = match self.seas(engagement, observer)? {
            Seas::Slopes(draws) => {
                (&draws.hits, &draws.observations, &draws.weights[..], [every(0, 1), every(0, 1)])
            }
            Seas::Plain { engagement, observer } => {
                let Plain { observers, hits, observations } = &self.plain;
                let before: usize = observers[..engagement].iter().sum();
                let places =
                    [every(engagement, observers.len()), every(before + observer, observers.iter().sum())];
                (hits, observations, &[][..], places)
            }
        };
        let hits = hits.iter().skip(hit.0).step_by(hit.1);
        let seen = observations.iter().skip(seen.0).step_by(seen.1);
        let weights = weights.iter().copied().chain(std::iter::repeat(1.0));
        let rows = hits.zip(seen).zip(weights).zip(self.first..);
        Ok(rows.map(|(((hit, seen), weight), instance)| Sighting { instance, weight, hit, seen }))
    }

    /// Statistics of what an observer of one of the engagements saw; refused where there is no such engagement or
    /// observer.
    pub fn statistics(
        &self,
        engagement: usize,
        observer: usize,
        limits: &[f64],
    ) -> Result<Statistics, Error> {
        let all: Vec<Sighting> = self.of(engagement, observer)?.collect();
        let sum = |value: &dyn Fn(&Sighting) -> f64| all.iter().map(|s| s.weight * value(s)).sum::<f64>();
        let (n, total) = (all.len() as f64, sum(&|_| 1.0));
        // Shares are of the seas that the beam reaches.
        let share = |value: &dyn Fn(&Sighting) -> f64| sum(value) / total.max(f64::MIN_POSITIVE);
        let bounds = || Bounds {
            weight: match self.seas(engagement, observer) {
                Ok(Seas::Slopes(draws)) => draws.largest_weight,
                _ => 1.0,
            },
            f: largest(&self.lobe, self.ways[engagement][observer]),
        };
        let draws = all.iter().map(|s| Draw { f: s.seen.f, weight: s.weight }).collect();
        Ok(Statistics {
            mean_f_cos: sum(&|s| s.seen.f * s.seen.cos_r.max(0.0)) / n,
            obscured: share(&|s| f64::from(s.seen.obscured)),
            whitecap: share(&|s| s.hit.whitecap),
            ..Statistics::of(draws, limits, bounds)
        })
    }
}

/// Where an observer's draws are kept.
enum Seas<'a> {
    /// Among the engagements and observers of plain draws.
    Plain {
        engagement: usize,
        observer: usize,
    },
    Slopes(&'a SlopeDraws),
}

/// The largest f, 1/sr, of whitecaps and of facets on any wave: the maximum over a grid of slopes about the specular one.
fn largest(lobe: &Lobe<f64>, [i, o]: [[f64; 3]; 2]) -> f64 {
    const REACH: i32 = 4;
    let half = DVec3::from(i) + DVec3::from(o);
    if half.z <= 0.0 {
        return lobe.whitecap_brdf;
    }
    let specular = -half.truncate() / half.z;
    let wind = DVec2::new(lobe.facets.wind.cos, lobe.facets.wind.sin);
    let spread = lobe.facets.spread(DVec2::new(specular.dot(wind), specular.dot(wind.perp())));
    let offsets =
        (-REACH..=REACH).flat_map(|u| (-REACH..=REACH).map(move |c| DVec2::new(u.into(), c.into())));
    let f = |at: DVec2| {
        let off = 0.5 * at * spread;
        let slope = specular + off.x * wind + off.y * wind.perp();
        lobe.facets.eval(i, o, normal(slope.into()))
    };
    offsets.map(f).fold(lobe.whitecap_brdf, f64::max)
}
