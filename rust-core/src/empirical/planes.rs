//! The two planes in which the report describes a reflection: through the source and the vertical, and across it through
//! the specular direction (Eqs. 80-89). The water is level; angles in radians.

use crate::readings::Readings;
use glam::DVec3;

/// A source over level water.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Planes {
    /// Angle of incidence.
    pub incidence: f64,
    /// The specular direction k_r (Eq. 84).
    specular: DVec3,
    /// Normal of the plane of incidence (Eq. 85).
    normal_in: DVec3,
    /// Which of Eqs. 82 and 88 are taken as printed.
    readings: Readings,
}

impl Planes {
    /// For a unit vector to the source. At normal incidence the plane is the wind's, towards `azimuth`.
    pub fn new(to_source: [f64; 3], azimuth: f64) -> Self {
        let source = DVec3::from(to_source);
        let specular = DVec3::new(-source.x, -source.y, source.z);
        let across = DVec3::Z.cross(specular);
        let normal_in = across.try_normalize().unwrap_or_else(|| {
            let (sin, cos) = azimuth.sin_cos();
            DVec3::new(-sin, cos, 0.0)
        });
        let flat = source.truncate().length();
        Self { incidence: flat.atan2(source.z), specular, normal_in, readings: Readings::CORRECTED }
    }

    /// The same with Eqs. 82 and 88 as some readings have them.
    pub fn with_readings(self, readings: Readings) -> Self {
        Self { readings, ..self }
    }

    /// The unit vector to the source.
    pub fn source(&self) -> [f64; 3] {
        [-self.specular.x, -self.specular.y, self.specular.z]
    }

    /// theta_r and phi_r of a unit vector to the observer (Eqs. 86-88, signed): the angle from the vertical of its part in
    /// the plane, positive on the specular side, and the angle of its part across the plane from the specular direction, or
    /// from the opposite one where that is nearer, so that it is 0 everywhere in the plane.
    pub fn angles(&self, to_observer: [f64; 3]) -> [f64; 2] {
        let o = DVec3::from(to_observer);
        let forward = o.dot(self.normal_in.cross(DVec3::Z));
        // The part across lies in the plane of k_r and n_in.
        let (aside, specular) = (o.dot(self.normal_in), o.dot(self.specular));
        if self.readings.contains(Readings::EQ_88) {
            return [forward.abs().atan2(o.z), aside.abs().atan2(specular)];
        }
        [forward.atan2(o.z), aside.atan2(specular.abs())]
    }

    /// The unit vector in the plane at an angle theta_r from the vertical (Eq. 81).
    pub fn in_plane(&self, theta: f64) -> [f64; 3] {
        let (sin, cos) = theta.sin_cos();
        (sin * self.normal_in.cross(DVec3::Z) + cos * DVec3::Z).into()
    }

    /// The unit vector across the plane at an angle phi_r from the specular direction (Eq. 82). As printed it is not of unit
    /// length by itself, and phi_r no angle of the sphere.
    pub fn across(&self, phi: f64) -> [f64; 3] {
        let (sin, cos) = phi.sin_cos();
        let v = cos * self.specular + self.scale_across() * sin * self.normal_in;
        if self.readings.contains(Readings::EQ_82) { v.normalize().into() } else { v.into() }
    }

    /// What a small phi_r of Eq. 82 is on the sphere, over itself: 1, or as printed cos theta_i.
    pub(crate) fn scale_across(&self) -> f64 {
        if self.readings.contains(Readings::EQ_82) { self.incidence.cos() } else { 1.0 }
    }
}

/// How wide the lobe is out of plane at an angle theta_r, for the width at normal incidence (Eq. 89).
pub fn width(sigma: f64, incidence: f64, theta: f64) -> f64 {
    sigma * if theta < incidence { (0.5 * (incidence + theta)).cos() } else { incidence.cos() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn direction(theta: f64, phi: f64) -> [f64; 3] {
        let (sin, cos) = theta.sin_cos();
        [sin * phi.cos(), sin * phi.sin(), cos]
    }

    #[test]
    fn angles_are_those_of_the_directions() {
        for incidence in [0.0, 0.3, 1.0, 1.4] {
            for azimuth in [0.0, 0.7, -2.0] {
                let planes = Planes::new(direction(incidence, azimuth), azimuth);
                assert!((planes.incidence - incidence).abs() < 1e-12);
                for angle in [-1.5, -0.4, 0.0, 0.2, 1.3] {
                    let [theta, phi] = planes.angles(planes.in_plane(angle));
                    assert!(
                        (theta - angle).abs() < 1e-12 && phi.abs() < 1e-12,
                        "{incidence} {angle}: {theta} {phi}"
                    );
                    let [theta, phi] = planes.angles(planes.across(angle));
                    assert!((phi - angle).abs() < 1e-12, "{phi}");
                    // Across the plane, its in-plane part stays specular.
                    assert!((theta - incidence).abs() < 1e-12, "{theta}");
                }
            }
        }
    }

    /// Eqs. 82 and 87-88 written out, with their arccosines.
    #[test]
    fn as_printed_they_are_the_printed_equations() {
        for incidence in [0.3f64, 0.8, 1.3] {
            let (sin_i, cos_i) = incidence.sin_cos();
            let planes = Planes::new([-sin_i, 0.0, cos_i], 0.0).with_readings(Readings::AS_PRINTED);
            for phi in [-1.2f64, -0.3, 0.0, 0.5, 1.4] {
                let (sin, cos) = phi.sin_cos();
                let eq_82 = DVec3::new(sin_i * cos, cos_i * sin, cos_i * cos);
                assert!((DVec3::from(planes.across(phi)) - eq_82.normalize()).length() < 1e-15);
                for azimuth in [0.1, 1.0, 2.5, -2.0] {
                    let o = DVec3::from(direction(phi.abs(), azimuth));
                    let [n_in, k_r] = [DVec3::Y, DVec3::new(sin_i, 0.0, cos_i)];
                    let n_out = k_r.cross(n_in);
                    let [within, out] = [n_in, n_out].map(|n| (o - o.dot(n) * n).normalize());
                    let eq_88 = [within.z.acos(), k_r.dot(out).acos()];
                    let found = planes.angles(o.into());
                    let near = |k: usize| (found[k] - eq_88[k]).abs() < 1e-7;
                    assert!(near(0) && near(1), "{found:?} {eq_88:?}");
                }
            }
        }
    }

    #[test]
    fn widths_shrink_with_the_cosine() {
        assert_eq!(width(0.2, 0.0, 0.0), 0.2);
        assert!((width(0.2, 1.0, 1.2) - 0.2 * 1f64.cos()).abs() < 1e-15);
        assert!((width(0.2, 1.0, 0.2) - 0.2 * 0.6f64.cos()).abs() < 1e-15);
    }
}
