//! What all instances of engagements are seen to reflect: drawn on all cores, kept in memory, and summed up.

use super::engagement::Engagement;
use super::ensemble::{Ensemble, Hit, Observation, Proposal, Worker};
use super::level_water::BaselineLobe;
use super::slope_draws::{FEWEST_COMPONENTS, SlopeDraws};
use super::summary::{Bounds, Draw, Statistics};
use crate::brdf::{Lobe, polarised};
use crate::error::{Error, refuse};
use crate::surface::normal;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::ops::Range;

/// What one group of samples may take, bytes: [`Ensemble::check`] refuses an engagement that needs more.
pub const MEMORY: u64 = 4 << 30;

impl Ensemble {
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
                let baseline = BaselineLobe::new(&self.water);
                engagements.iter().map(|e| Plan(self.needs_slopes(e, &baseline))).collect()
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

    /// The mean of the Stokes vector that an observer of one of the engagements sees of its beam, 1/sr; each instance in the
    /// plane of the vertical and the observer's direction from its hit. `position` in m is the observer's; refused where there is
    /// no such engagement or observer.
    pub fn stokes(
        &self,
        engagement: usize,
        observer: usize,
        beam: &Engagement,
        position: [f64; 3],
    ) -> Result<[f64; 4], Error> {
        let (reflectance, foam) = (&self.lobe.facets.reflectance, self.lobe.whitecap_brdf);
        let i = (-DVec3::from(beam.direction())).into();
        let mut sums = [0.0; 4];
        for s in self.of(engagement, observer)?.filter(|s| s.seen.f > 0.0) {
            let o = (DVec3::from(position) - DVec3::from(s.hit.position)).normalize().into();
            let seen = polarised::seen(reflectance, i, o, [s.seen.f, s.hit.whitecap * foam], beam.stokes());
            sums.iter_mut().zip(seen).for_each(|(sum, x)| *sum += s.weight * x);
        }
        Ok(sums.map(|sum| sum / self.count as f64))
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
    let spread = lobe.facets.slope_width(DVec2::new(specular.dot(wind), specular.dot(wind.perp())));
    let offsets =
        (-REACH..=REACH).flat_map(|u| (-REACH..=REACH).map(move |c| DVec2::new(u.into(), c.into())));
    let f = |at: DVec2| {
        let off = 0.5 * at * spread;
        let slope = specular + off.x * wind + off.y * wind.perp();
        lobe.facets.eval(i, o, normal(slope.into()))
    };
    offsets.map(f).fold(lobe.whitecap_brdf, f64::max)
}
