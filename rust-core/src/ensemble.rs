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
//! let statistics = samples.statistics(0, 1, &[0.01]);                  // engagement 0, observer 1, limits in 1/sr
//!
//! let exact = Exact::new(&water)?;                                     // infinitely many draws
//! let mean = exact.means(&engagement)[1].f;
//! assert!((statistics.mean - mean).abs() < 5.0 * statistics.sem);
//! # Ok(())
//! # }
//! ```

use crate::cast::Path;
use crate::parameters::DRAWN;
use crate::scenario::Engagement;
use crate::surface::{Surface, normal};
use crate::waves::{Component, Draws, Numbers, Waves};
use crate::{Error, Water};
use glam::DVec3;
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

/// Mean, spread and quantiles of f, 1/sr, over instances.
#[derive(Debug, Clone, PartialEq)]
pub struct Statistics {
    /// Mean.
    pub mean: f64,
    /// Standard deviation over N, not N - 1.
    pub std: f64,
    /// Standard error of the mean, std/sqrt(N) (an overestimate for Sobol draws); 0 for infinitely many.
    pub sem: f64,
    /// Smallest; not a number for infinitely many.
    pub min: f64,
    /// Quantiles 0.05, 0.50, 0.95, 0.99, linear between neighbours.
    pub quantiles: [f64; 4],
    /// Largest; not a number for infinitely many.
    pub max: f64,
    /// Mean of f times the local cosine of the angle of reflection.
    pub mean_f_cos: f64,
    /// Share of instances in which the observer is obscured.
    pub obscured: f64,
    /// Share of instances in which the hit is a whitecap.
    pub whitecap: f64,
    /// Share of instances in which f exceeds each of the limits asked for.
    pub over: Vec<f64>,
}

/// The levels of [`Statistics::quantiles`].
pub const QUANTILES: [f64; 4] = [0.05, 0.50, 0.95, 0.99];

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

    /// Refuses an engagement whose samples would take more than [`MEMORY`].
    pub fn check(&self, engagement: &Engagement) -> Result<(), Error> {
        let instances = self.water.parameters.instances;
        let (one, observers) = (bytes(engagement), engagement.observers().len());
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
        let mut needed = 0;
        let fits = |e: &&Engagement| {
            needed += count * bytes(e);
            needed <= MEMORY
        };
        let group = engagements.iter().take_while(fits).count().max(1).min(engagements.len());
        let group = &engagements[..group];
        let observers: Vec<usize> = group.iter().map(|e| e.observers().len()).collect();
        let width: usize = observers.iter().sum();

        let empty = Hit { position: [0.0; 3], normal: normal([0.0; 2]), whitecap: 0.0 };
        let mut hits = reserved(count as usize * group.len(), empty)?;
        let mut observations = reserved(count as usize * width, Observation::default())?;
        // At least one place for each instance, so that both arrays come apart into as many pieces.
        let rows = hits.par_chunks_mut(group.len()).zip(observations.par_chunks_mut(width.max(1)));
        rows.enumerate().for_each_init(Worker::default, |worker, (row, (hits, observations))| {
            self.instance(worker, instances.start + row as u64, group, hits, observations);
            progress(group.len() as u64);
        });
        Ok(Samples { first: instances.start, observers, hits, observations })
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
                    self.observe(worker, engagement, hit, now);
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
        let probability = self.water.whitecap_probability(point.acceleration);
        Some(Hit {
            position: [place[0], place[1], point.height],
            normal: point.normal(),
            whitecap: match self.presence {
                Presence::Drawn => f64::from(chance < probability),
                Presence::Expected => probability,
            },
        })
    }

    /// What the observers see of a hit.
    fn observe(
        &self,
        worker: &mut Worker,
        engagement: &Engagement,
        hit: &Hit,
        observations: &mut [Observation],
    ) {
        let (from, n) = (DVec3::from(hit.position), DVec3::from(hit.normal));
        let to_laser = -DVec3::from(engagement.direction());
        for (observer, seen) in engagement.observers().iter().zip(observations) {
            let observer = DVec3::from(*observer);
            let way = (observer - from).normalize();
            seen.cos_r = way.dot(n);
            seen.obscured = seen.cos_r <= 0.0 || worker.path.hides(&worker.surface, from, observer);
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
struct Worker {
    surface: Surface,
    path: Path,
}

/// What one instance of an engagement takes.
fn bytes(engagement: &Engagement) -> u64 {
    (size_of::<Hit>() + engagement.observers().len() * size_of::<Observation>()) as u64
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
    /// Of every engagement.
    observers: Vec<usize>,
    /// Instance by instance, in each the engagements.
    hits: Vec<Hit>,
    /// Instance by instance, in each the engagements, in each its observers.
    observations: Vec<Observation>,
}

impl Samples {
    /// How many engagements the group holds.
    pub fn engagements(&self) -> usize {
        self.observers.len()
    }

    /// How many instances were drawn.
    pub fn instances(&self) -> usize {
        self.hits.len() / self.observers.len()
    }

    /// Number, hit and observation of every instance, as an observer of one of the engagements saw it.
    pub fn of(&self, engagement: usize, observer: usize) -> impl Iterator<Item = (u64, &Hit, &Observation)> {
        let before: usize = self.observers[..engagement].iter().sum();
        let hits = self.hits.iter().skip(engagement).step_by(self.observers.len());
        let width = self.observers.iter().sum();
        let seen = self.observations.iter().skip(before + observer).step_by(width);
        hits.zip(seen).zip(self.first..).map(|((hit, seen), instance)| (instance, hit, seen))
    }

    /// Statistics of what an observer of one of the engagements saw.
    pub fn statistics(&self, engagement: usize, observer: usize, limits: &[f64]) -> Statistics {
        let n = self.instances() as f64;
        let mean = |value: &dyn Fn(&Hit, &Observation) -> f64| {
            self.of(engagement, observer).map(|(_, hit, seen)| value(hit, seen)).sum::<f64>() / n
        };
        let values = self.of(engagement, observer).map(|(_, _, seen)| seen.f).collect();
        Statistics {
            mean_f_cos: mean(&|_, seen| seen.f * seen.cos_r.max(0.0)),
            obscured: mean(&|_, seen| f64::from(seen.obscured)),
            whitecap: mean(&|hit, _| hit.whitecap),
            ..Statistics::of(values, limits)
        }
    }
}

impl Statistics {
    /// Of at least one value of f; of what is not f nothing is known.
    pub(crate) fn of(mut values: Vec<f64>, limits: &[f64]) -> Self {
        let n = values.len() as f64;
        values.sort_unstable_by(f64::total_cmp);
        let mean = values.iter().sum::<f64>() / n;
        let std = (values.iter().map(|f| (f - mean).powi(2)).sum::<f64>() / n).sqrt();
        let over = |limit: &f64| (values.len() - values.partition_point(|f| f <= limit)) as f64 / n;
        Self {
            mean,
            std,
            sem: std / n.sqrt(),
            min: values[0],
            quantiles: QUANTILES.map(|level| quantile(&values, level)),
            max: values[values.len() - 1],
            mean_f_cos: f64::NAN,
            obscured: f64::NAN,
            whitecap: f64::NAN,
            over: limits.iter().map(over).collect(),
        }
    }
}

/// Quantile of sorted numbers, linear between neighbours.
fn quantile(sorted: &[f64], level: f64) -> f64 {
    let at = level * (sorted.len() - 1) as f64;
    let (below, rest) = (at.floor() as usize, at.fract());
    let above = (below + 1).min(sorted.len() - 1);
    sorted[below] + rest * (sorted[above] - sorted[below])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_lie_between_neighbours() {
        let sorted = [1.0, 2.0, 4.0, 8.0, 16.0];
        assert_eq!(quantile(&sorted, 0.5), 4.0);
        assert_eq!(quantile(&sorted, 0.25), 2.0);
        assert!((quantile(&sorted, 0.99) - 15.68).abs() < 1e-12);
        assert_eq!(quantile(&[3.0], 0.95), 3.0);
    }
}
