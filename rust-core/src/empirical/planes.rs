//! The two planes in which the report describes a reflection: through the source and the vertical, and across it through
//! the specular direction (Eqs. 80-89). The water is level; angles in radians.

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
        Self { incidence: flat.atan2(source.z), specular, normal_in }
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
        let forward = self.normal_in.cross(DVec3::Z);
        let theta = o.dot(forward).atan2(o.z);
        // The part across lies in the plane of k_r and n_in.
        let phi = o.dot(self.normal_in).atan2(o.dot(self.specular).abs());
        [theta, phi]
    }

    /// The unit vector in the plane at an angle theta_r from the vertical (Eq. 81).
    pub fn in_plane(&self, theta: f64) -> [f64; 3] {
        let (sin, cos) = theta.sin_cos();
        (sin * self.normal_in.cross(DVec3::Z) + cos * DVec3::Z).into()
    }

    /// The unit vector across the plane at an angle phi_r from the specular direction (Eq. 82).
    pub fn across(&self, phi: f64) -> [f64; 3] {
        let (sin, cos) = phi.sin_cos();
        (cos * self.specular + sin * self.normal_in).into()
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

    #[test]
    fn widths_shrink_with_the_cosine() {
        assert_eq!(width(0.2, 0.0, 0.0), 0.2);
        assert!((width(0.2, 1.0, 1.2) - 0.2 * 1f64.cos()).abs() < 1e-15);
        assert!((width(0.2, 1.0, 0.2) - 0.2 * 0.6f64.cos()).abs() < 1e-15);
    }
}
