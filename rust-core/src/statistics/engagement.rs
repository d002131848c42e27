//! Engagements: a laser, its beam and the observers at one time (Eqs. 28, 57-58).

use super::beam::Beam;
use crate::config::LONGEST_TIME;
use crate::error::{Error, refuse};
use glam::DVec3;

/// The flattest beam, as the sine of its angle below the horizontal: 0.001 degrees. A flatter one might travel
/// without end before it meets a wave.
pub const FLATTEST_BEAM: f64 = 1.745e-5;
/// Coordinates reach to this far from 0, m.
pub const FARTHEST: f64 = 1e9;

/// Light without polarisation, as a Stokes vector.
const UNPOLARISED: [f64; 4] = [1.0, 0.0, 0.0, 0.0];

/// Where the laser points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Aim {
    /// At a place, m.
    Target([f64; 3]),
    /// Along a direction of any length.
    Direction([f64; 3]),
}

/// A laser, its beam and its observers at one time; checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Engagement {
    time: f64,
    laser: [f64; 3],
    direction: [f64; 3],
    observers: Vec<[f64; 3]>,
    beam: Option<Beam>,
    stokes: [f64; 4],
}

/// A Stokes vector may be polarised by this much more than wholly, for its digits.
const STOKES_TOLERANCE: f64 = 1e-6;

impl Engagement {
    /// Time in s, positions in m: all finite, laser and observers above the mean surface, the beam downwards.
    ///
    /// ```
    /// use prob_water::{Aim, Engagement};
    ///
    /// let [laser, observer] = [[-50.0, 0.0, 86.6], [50.0, 0.0, 86.6]];
    /// Engagement::new(0.0, laser, Aim::Target([0.0; 3]), &[observer])?;
    /// let upwards = Engagement::new(0.0, laser, Aim::Direction([1.0, 0.0, 0.1]), &[observer]);
    /// assert!(upwards.unwrap_err().to_string().contains("a beam that points down"));
    /// # Ok::<(), prob_water::Error>(())
    /// ```
    pub fn new(time: f64, laser: [f64; 3], aim: Aim, observers: &[[f64; 3]]) -> Result<Self, Error> {
        if !(-LONGEST_TIME..=LONGEST_TIME).contains(&time) {
            return refuse("time", time, "finite, at most 1e9 s from 0");
        }
        position("laser", laser)?;
        let (name, given, beam) = match aim {
            Aim::Target(target) => {
                if !within(target) {
                    return refuse("target", shown(target), "finite coordinates, at most 1e9 m from 0");
                }
                ("target", target, DVec3::from(target) - DVec3::from(laser))
            }
            Aim::Direction(direction) => ("direction", direction, DVec3::from(direction)),
        };
        // Of any length: squares of the coordinates might not fit.
        let direction = (beam / beam.abs().max_element()).normalize_or_zero();
        if !(beam.is_finite() && direction.z <= -FLATTEST_BEAM) {
            let allowed = "a beam that points down, at least 0.001 degrees below the horizontal";
            return refuse(name, shown(given), allowed);
        }
        if observers.is_empty() {
            return refuse("observers", "none", "at least one");
        }
        for observer in observers {
            position("observers", *observer)?;
        }
        let direction = direction.into();
        let engagement =
            Self { time, laser, direction, observers: observers.into(), beam: None, stokes: UNPOLARISED };
        if !within(engagement.target()) {
            return refuse(name, shown(given), "a beam that meets the water at most 1e9 m from 0");
        }
        Ok(engagement)
    }

    /// The report's geometry for angles (Eqs. 80-82): a laser at an angle of incidence in degrees, so far from the
    /// origin in m, aimed at it in the x-z plane, and observers in directions away from it, so far.
    pub fn far(incidence: f64, laser: f64, directions: &[[f64; 3]], observers: f64) -> Result<Self, Error> {
        let (sin, cos) = incidence.to_radians().sin_cos();
        let observers: Vec<_> = directions.iter().map(|d| d.map(|x| observers * x)).collect();
        Self::new(0.0, [-laser * sin, 0.0, laser * cos], Aim::Target([0.0; 3]), &observers)
    }

    /// The same with a beam that widens on its way, which gives the footprint: [`crate::Spot`].
    pub fn with_beam(self, beam: Beam) -> Self {
        Self { beam: Some(beam), ..self }
    }

    /// The same with polarised light: (I, Q, U, V) of the beam, whose first axis is [`crate::brdf::polarised::mueller`]'s, in the
    /// plane of the beam and the vertical. I counts 1: the others are taken over it.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] where I is not above 0, or the rest of it is longer.
    pub fn with_stokes(self, stokes: [f64; 4]) -> Result<Self, Error> {
        let [i, q, u, v] = stokes;
        let stokes = [1.0, q / i, u / i, v / i];
        if !(i > 0.0
            && stokes.iter().all(|x| x.is_finite())
            && (q / i).hypot(u / i).hypot(v / i) <= 1.0 + STOKES_TOLERANCE)
        {
            let given = format!("[{i}, {q}, {u}, {v}]");
            return refuse("stokes", given, "[I, Q, U, V] with I above 0 and Q^2 + U^2 + V^2 up to I^2");
        }
        Ok(Self { stokes, ..self })
    }

    /// The beam's Stokes vector over its first number.
    pub fn stokes(&self) -> [f64; 4] {
        self.stokes
    }

    /// The same with the observers whose numbers are kept.
    pub fn with_observers(&self, keep: impl Fn(usize) -> bool) -> Self {
        let observers = self.observers.iter().enumerate().filter(|(observer, _)| keep(*observer));
        Self { observers: observers.map(|(_, position)| *position).collect(), ..self.clone() }
    }

    /// s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// m.
    pub fn laser(&self) -> [f64; 3] {
        self.laser
    }

    /// Unit vector along the beam.
    pub fn direction(&self) -> [f64; 3] {
        self.direction
    }

    /// Where the beam meets the mean surface, m.
    pub fn target(&self) -> [f64; 3] {
        let (laser, beam) = (DVec3::from(self.laser), DVec3::from(self.direction));
        (laser - laser.z / beam.z * beam).truncate().extend(0.0).into()
    }

    /// The beam; `None` where the footprint is the sea's.
    pub fn beam(&self) -> Option<Beam> {
        self.beam
    }

    /// From the laser to where the beam meets the mean surface, m.
    pub fn range(&self) -> f64 {
        self.laser[2] / -self.direction[2]
    }

    /// Unit vectors from the target to the laser and to every observer (Eqs. 83, 86).
    pub fn ways(&self) -> impl Iterator<Item = [[f64; 3]; 2]> {
        let (place, source) = (DVec3::from(self.target()), -DVec3::from(self.direction));
        self.observers.iter().map(move |o| [source.into(), (DVec3::from(*o) - place).normalize().into()])
    }

    /// m.
    pub fn observers(&self) -> &[[f64; 3]] {
        &self.observers
    }
}

fn within(position: [f64; 3]) -> bool {
    position.iter().all(|x| x.abs() <= FARTHEST)
}

fn position(parameter: &'static str, position: [f64; 3]) -> Result<(), Error> {
    if within(position) && position[2] > 0.0 {
        return Ok(());
    }
    refuse(parameter, shown(position), "finite coordinates, at most 1e9 m from 0, with z above 0")
}

fn shown(position: [f64; 3]) -> String {
    let [x, y, z] = position.map(|x| {
        let long = x != 0.0 && !(1e-6..1e12).contains(&x.abs());
        if long { format!("{x:e}") } else { x.to_string() }
    });
    format!("[{x}, {y}, {z}]")
}

#[cfg(test)]
mod tests {
    use super::*;

    const HIGH: [f64; 3] = [0.0, 0.0, 10.0];

    #[test]
    fn directions_are_of_unit_length() {
        let e = Engagement::new(1.0, [0.0, 0.0, 8.0], Aim::Target([6.0, 0.0, 0.0]), &[HIGH]).unwrap();
        assert!((DVec3::from(e.direction()) - DVec3::new(0.6, 0.0, -0.8)).length() < 1e-15);
        let e = Engagement::new(1.0, HIGH, Aim::Direction([0.0, 0.0, -7.0]), &[HIGH]).unwrap();
        assert_eq!(e.direction(), [0.0, 0.0, -1.0]);
        for length in [1e300, 1e-300] {
            let e = Engagement::new(1.0, HIGH, Aim::Direction([length, 0.0, -length]), &[HIGH]).unwrap();
            assert!((e.direction()[2] + 0.5f64.sqrt()).abs() < 1e-15);
        }
    }

    #[test]
    fn refusals_name_what_is_wrong() {
        let down = Aim::Direction([0.0, 0.0, -1.0]);
        for (name, refused) in [
            ("time", Engagement::new(f64::NAN, HIGH, down, &[HIGH])),
            ("time", Engagement::new(f64::INFINITY, HIGH, down, &[HIGH])),
            ("laser", Engagement::new(0.0, [0.0, 0.0, 0.0], down, &[HIGH])),
            ("laser", Engagement::new(0.0, [f64::NAN, 0.0, 1.0], down, &[HIGH])),
            ("direction", Engagement::new(0.0, HIGH, Aim::Direction([1.0, 0.0, 0.0]), &[HIGH])),
            ("direction", Engagement::new(0.0, HIGH, Aim::Direction([1.0, 0.0, 1.0]), &[HIGH])),
            ("direction", Engagement::new(0.0, HIGH, Aim::Direction([0.0; 3]), &[HIGH])),
            ("direction", Engagement::new(0.0, HIGH, Aim::Direction([0.0, f64::NAN, -1.0]), &[HIGH])),
            ("direction", Engagement::new(0.0, [0.0, 0.0, 1e6], Aim::Direction([1.0, 0.0, -2e-5]), &[HIGH])),
            ("target", Engagement::new(0.0, HIGH, Aim::Target([0.0, 0.0, 11.0]), &[HIGH])),
            ("target", Engagement::new(0.0, HIGH, Aim::Target(HIGH), &[HIGH])),
            ("target", Engagement::new(0.0, HIGH, Aim::Target([0.0, 0.0, f64::NAN]), &[HIGH])),
            ("observers", Engagement::new(0.0, HIGH, down, &[])),
            ("observers", Engagement::new(0.0, HIGH, down, &[HIGH, [0.0, 0.0, -1.0]])),
        ] {
            let error = refused.unwrap_err();
            assert!(matches!(error, Error::OutOfRange { parameter, .. } if parameter == name), "{error}");
        }
    }
}
