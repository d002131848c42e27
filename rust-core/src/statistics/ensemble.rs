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

use super::engagement::Engagement;
use super::spot::Spot;
use crate::config::Water;
use crate::config::parameters::DRAWN;
use crate::error::Error;
use crate::sea::whitecap::Onset;
use crate::surface::{Component, Draws, InstanceRng, Point, Surface, SurfaceRay, Waves};
use glam::DVec3;

/// Whether a whitecap stands at the hit of an instance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WhitecapMode {
    /// Drawn with its probability (Eq. 53), as in the report: f is the whitecap's or the facets'.
    #[default]
    Drawn,
    /// Both, weighted by the probability: the same mean with less spread.
    Expected,
}

/// How seas are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Proposal {
    /// As the wind draws them: the report's, the same seas for all times and observers.
    #[default]
    Plain,
    /// Half of them with slopes that mirror the source to the observer, each observer at each time with seas of its own.
    Slopes,
    /// [`Proposal::Slopes`] for the observers whose mean would rest on few plain draws, since facets are narrow.
    Auto,
}

/// Instances of a sea to be drawn and looked at.
#[derive(Debug, Clone, Copy)]
pub struct Ensemble {
    /// The sea; its parameters give components, instances and seed.
    pub water: Water,
    /// What its waves are drawn from.
    pub waves: Waves,
    /// Where whitecaps stand on them; `None`: nowhere.
    pub onset: Option<Onset<f64>>,
    /// How their random numbers are spread.
    pub draws: Draws,
    /// How whitecaps take part.
    pub presence: WhitecapMode,
    /// Which seas are drawn, where facets are narrow.
    pub proposal: Proposal,
    /// Place in m and time in s at which the drawn phases count. Any will do, but evenly spread phases help most where
    /// the beam meets the water: [`Ensemble::around`].
    pub phases_at: ([f64; 2], f64),
    /// Over what the wave's normal at a hit is a mean; `None`: the normal of the hit itself, as in the report.
    /// [`Ensemble::over`] sets it, and what follows for facets.
    pub spot: Option<Spot>,
}

/// Where the beam met the water in one instance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// m.
    pub position: [f64; 3],
    /// The wave normal there, or its mean over the spot.
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
            onset: water.whitecap_onset(),
            draws: Draws::Random,
            presence: WhitecapMode::Drawn,
            proposal: Proposal::Plain,
            phases_at: ([0.0; 2], 0.0),
            spot: None,
        })
    }

    /// The same with normals that are means over a spot, weighted by its intensity. Slopes within the spot are then facets':
    /// the mean of f is kept, and its spread is less.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for an infinite footprint.
    pub fn over(self, spot: Spot) -> Result<Self, Error> {
        Ok(Self { water: spot.averaged(&self.water)?, spot: Some(spot), ..self })
    }

    /// The same, with Sobol draws whose phases count where and when this engagement's beam meets the mean surface.
    pub fn around(self, engagement: &Engagement) -> Self {
        let [x, y, _] = engagement.target();
        Self { draws: Draws::Sobol, phases_at: ([x, y], engagement.time()), ..self }
    }

    /// The components of an instance, and the number of [0, 1) that decides about its whitecap.
    pub fn components(&self, instance: u64) -> (f64, impl Iterator<Item = Component>) {
        let mut numbers = InstanceRng::new(self.draws, self.water.parameters.seed, instance);
        let chance = numbers.next();
        let (place, time) = self.phases_at;
        (chance, self.waves.components(numbers).map(move |c| c.with_phase_at(place, time)))
    }

    /// Where the beam meets the water; `None` if a wave covers the laser.
    pub(super) fn hit(&self, worker: &mut Worker, engagement: &Engagement, chance: f64) -> Option<Hit> {
        let (laser, beam) = (engagement.laser().into(), engagement.direction().into());
        let place = worker.ray.first_hit(&worker.surface, laser, beam)?.truncate().to_array();
        let point = worker.surface.point(place);
        Some(self.hit_at(&worker.surface, place, &point, chance))
    }

    /// Probability of a whitecap over a place in m of a drawn surface, where it has this point: by the acceleration there and, with
    /// a lifetime, by what it was.
    pub fn whitecap(&self, surface: &Surface, place: [f64; 2], point: &Point) -> f64 {
        let Some(onset) = self.onset else { return 0.0 };
        match self.waves.foam(self.water.parameters.whitecap_lifetime) {
            None => onset.probability(point.acceleration),
            Some(foam) => foam
                .mean(surface.time(), |before| onset.probability(surface.acceleration_before(before, place))),
        }
    }

    /// The hit at a place in m of a drawn surface, where it has this point.
    pub(super) fn hit_at(&self, surface: &Surface, place: [f64; 2], point: &Point, chance: f64) -> Hit {
        let probability = self.whitecap(surface, place, point);
        Hit {
            position: [place[0], place[1], point.height],
            normal: match &self.spot {
                None => point.normal(),
                Some(spot) => spot.mean(surface, place).normal(),
            },
            whitecap: match self.presence {
                WhitecapMode::Drawn => f64::from(chance < probability),
                WhitecapMode::Expected => probability,
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
            seen.obscured = seen.cos_r <= 0.0
                || self.water.may_occlude(&worker.surface, way)
                    && worker.ray.occludes(&worker.surface, from - origin, observer - origin);
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
    /// The surface drawn last.
    pub surface: Surface,
    /// Of the ray that is followed over it.
    pub ray: SurfaceRay,
}
