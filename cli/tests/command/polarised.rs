//! Polarised light: Mueller matrices of rows, and what observers see of a polarised laser.

use crate::scenario::Scenario;
use crate::{column, float, floats, refuse, succeed, table};
use std::fs;

const ROWS: &str =
    "ix,iy,iz,ox,oy,oz\n0.6,0,0.8,-0.6,0,0.8\n0.6,0,0.8,0,0.48,0.8772684879784524\n0,0,-1,0,0,1\n";

/// m00 is f on every surface, what reflects in the plane keeps its axes, and the horizon is black.
#[test]
fn matrices_of_rows() {
    for surface in ["flat", "ensemble", "empirical"] {
        let text = succeed(&format!("brdf --mueller --wind-speed 9 --surface {surface}"), ROWS);
        assert_eq!(column(&text, "f"), column(&text, "m00"), "{surface}");
        let rows = table(&text);
        let first = rows[0].iter().position(|name| *name == "m00").unwrap();
        let element = |row: usize, at: usize| float(rows[row][first + at]);
        assert_eq!(
            rows[0][first..].join(","),
            "m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23,m30,m31,m32,m33"
        );
        // In the plane of incidence parallel light is reflected least, and nothing is turned.
        assert!(element(1, 1) < 0.0 && element(1, 1) == element(1, 4), "{surface}");
        assert!(
            [2, 3, 6, 7, 8, 9, 11, 12, 13, 14].iter().all(|at| element(1, *at).abs() < 1e-16),
            "{surface}"
        );
        // Aside of it all is; whitecaps leave light unpolarised.
        assert!(element(2, 2).abs() > 1e-4 * element(2, 0) && element(2, 5) < element(2, 0), "{surface}");
        assert!((0..16).all(|at| element(3, at) == 0.0), "{surface}");
    }
    let places = "x,y,ix,iy,iz,ox,oy,oz\n3,4,0.6,0,0.8,-0.6,0,0.8\n";
    let text = succeed("brdf --mueller --surface instance", places);
    assert!((floats(&text, "m00")[0] / floats(&text, "f")[0] - 1.0).abs() < 1e-15);
}

/// A laser at Brewster's angle of the default index.
const LASER: &str = "
[model]
wind_speed = 5
whitecaps = true
instances = 100
[[engagement]]
laser = [-133.9, 0, 100]
target = [0, 0, 0]
observers = [[133.9, 0, 100], [100, 40, 100]]
stokes = [2, 0, 2, 0]
";

/// In the mirror all light that is left is polarised across the plane of incidence, by draws, integrals and the table; aside of it,
/// the same degree whatever the statistics are from.
#[test]
fn observers_of_a_polarised_laser() {
    for settings in ["", "draws = 'random'\n", "statistics = 'exact'\n", "statistics = 'auto'\n"] {
        let text = Scenario::new(&format!("{settings}{LASER}")).run("");
        let (degrees, angles) =
            (floats(&text, "degree_of_polarisation"), floats(&text, "angle_of_polarisation"));
        assert!(degrees[0] > 0.99 && degrees[0] <= 1.0, "{settings}{degrees:?}");
        assert!((angles[0].abs() - 90.0).abs() < 1.0, "{settings}{angles:?}");
        assert!((20.0..80.0).contains(&angles[1]), "{settings}{angles:?}");
        // Whoever sees it, the statistics of f are those of light without polarisation.
        let plain =
            Scenario::new(&format!("{settings}{}", LASER.replace("stokes = [2, 0, 2, 0]\n", ""))).run("");
        assert_eq!(column(&text, "mean"), column(&plain, "mean"));
        assert!(!plain.contains("polarisation"));
    }
    let text = Scenario::new(LASER).run("--surface empirical");
    assert!(floats(&text, "degree_of_polarisation")[0] > 0.99);
    // Of light along the plane next to nothing is left there, whitecaps aside; across it all keeps its plane.
    for (stokes, least) in [("[1, -1, 0, 0]", 0.99), ("[1, 0, 0, 0]", 0.99)] {
        let text = Scenario::new(&LASER.replace("[2, 0, 2, 0]", stokes)).run("--whitecaps false");
        assert!(floats(&text, "degree_of_polarisation")[0] > least, "{stokes}");
    }
}

#[test]
fn refusals() {
    for (stokes, message) in [
        ("[1, 1]", "stokes is not [I, Q, U, V]"),
        ("[0, 0, 0, 0]", "stokes = [0, 0, 0, 0] is out of range"),
        ("[1, 1, 0.1, 0]", "with I above 0 and Q^2 + U^2 + V^2 up to I^2"),
        ("[1, nan, 0, 0]", "stokes = [1, NaN, 0, 0] is out of range"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("sea.toml");
        fs::write(&file, LASER.replace("[2, 0, 2, 0]", stokes)).unwrap();
        let refused = refuse(&format!("scenario {}", file.display()), "");
        assert!(refused.contains(message) && refused.contains(".toml:10: "), "{refused}");
    }
}
