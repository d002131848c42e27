//! Beams of scenarios: footprints by divergence and range, spots, and means over them.

use crate::scenario::Scenario;
use crate::{column, floats};

/// A laser that comes nearer to its target.
const MOVING: &str = "
[model]
wind_speed = 5
instances = 40
[[engagement]]
times = [0, 2, 4]
laser = [[-300, 0, 400], [-150, 0, 200], [-30, 0, 40]]
target = [0, 0, 0]
observers = [[300, 0, 400], [0, 50, 90]]
divergence = 0.6
aperture = 0.05
";

/// The same at one of the times, with a footprint.
fn alone(at: usize, footprint: f64) -> String {
    let (time, laser) = [("0", "[-300, 0, 400]"), ("2", "[-150, 0, 200]"), ("4", "[-30, 0, 40]")][at];
    MOVING
        .replace("times = [0, 2, 4]", &format!("time = {time}"))
        .replace("[[-300, 0, 400], [-150, 0, 200], [-30, 0, 40]]", laser)
        .replace("divergence = 0.6\naperture = 0.05\n", "")
        .replace("[model]", &format!("[model]\nfootprint = {footprint:?}"))
}

fn widths() -> [f64; 3] {
    [500.0, 250.0, 50.0].map(|range: f64| (0.05f64 * 0.05 + (0.6e-3 * range).powi(2)).sqrt())
}

/// Rows of a moving laser are those of as many scenarios with the footprint by hand, for every source of statistics.
#[test]
fn footprints_follow_the_range() {
    for settings in ["", "statistics = 'exact'\n", "statistics = 'auto'\n", "draws = 'random'\n"] {
        let text = Scenario::new(&format!("{settings}{MOVING}")).run("");
        let found = floats(&text, "footprint");
        for (row, width) in widths().into_iter().flat_map(|w| [w, w]).enumerate() {
            assert!((found[row] / width - 1.0).abs() < 1e-14, "{} {width}", found[row]);
        }
        for at in 0..3 {
            let one = Scenario::new(&format!("{settings}{}", alone(at, found[2 * at]))).run("");
            assert!(!one.contains("footprint"));
            for name in ["time", "observer", "mean", "std", "p05", "p99", "obscured", "mean_upper", "method"]
            {
                assert_eq!(column(&text, name)[2 * at..][..2], column(&one, name), "{settings} {name} {at}");
            }
        }
    }
    // Other beams are other spots.
    let twice = Scenario::new(&MOVING.replace("0.6", "1.2")).run("");
    assert!(floats(&twice, "footprint")[0] > 0.6 && floats(&twice, "footprint")[0] < 0.61);
    let [_, instances] = Scenario::new(MOVING).run_with_instances("");
    assert_eq!(column(&instances, "instance").len(), 3 * 2 * 40);
}

/// The measure is of divergence and aperture too.
#[test]
fn widths_are_measured_as_footprints() {
    let text = MOVING.replace("[model]", "[model]\nfootprint_measure = '1/e'");
    let found = floats(&Scenario::new(&text).run(""), "footprint");
    for (at, width) in widths().into_iter().enumerate() {
        assert!((found[2 * at] / (2f64.sqrt() * width) - 1.0).abs() < 1e-14);
    }
}

/// A table has a footprint as an axis.
#[test]
fn tables_take_the_footprint_of_the_beam() {
    let table = |text: &str| Scenario::new(text).run("--surface empirical");
    let text = table(MOVING);
    let found = floats(&text, "footprint");
    for at in 0..3 {
        let one = table(&alone(at, found[2 * at]));
        assert_eq!(column(&text, "mean")[2 * at..][..2], column(&one, "mean"));
    }
}

#[test]
fn ellipses_are_longer() {
    let still = MOVING.replace("divergence = 0.6\naperture = 0.05\n", "");
    let ellipse = format!("spot = 'ellipse'\n{still}");
    let text = Scenario::new(&ellipse).run("");
    // Cosine 0.8 at all times: 1.25 times as long.
    for d in floats(&text, "footprint") {
        assert!((d / (0.15 * 1.125) - 1.0).abs() < 1e-12, "{d}");
    }
    let circle = Scenario::new(&still).run("");
    assert_eq!(Scenario::new(&format!("spot = 'circle'\nspot_normal = 'hit'\n{still}")).run(""), circle);
    assert_ne!(column(&text, "mean"), column(&circle, "mean"));
    // In [model] too, as all that is asked about the sea.
    let inside = still.replace("[model]", "[model]\nspot = 'ellipse'");
    assert_eq!(Scenario::new(&inside).run(""), text);
}

/// Normals that are means over the spot: the same hits, another normal, less spread.
#[test]
fn mean_normals_spread_less() {
    let [hit, mean] = ["hit", "mean"].map(|word| {
        Scenario::new(&format!("spot_normal = '{word}'\n{MOVING}")).run_with_instances("--instances 1000")
    });
    for name in ["x", "y", "z", "obscured"] {
        let [hit, mean] = [&hit, &mean].map(|[_, instances]| column(instances, name));
        let same = hit.iter().zip(&mean).filter(|(a, b)| a == b).count();
        assert!(same as f64 > 0.99 * hit.len() as f64, "{name}");
    }
    assert_ne!(column(&hit[1], "nx"), column(&mean[1], "nx"));
    for row in [0, 2, 4] {
        let [hit, mean] =
            [&hit, &mean].map(|[rows, _]| ["mean", "sem", "std"].map(|name| floats(rows, name)[row]));
        println!("{hit:?} {mean:?}");
        assert!(
            (hit[0] - mean[0]).abs() < 0.02 * hit[0] + 3.0 * hit[1] && mean[2] < hit[2],
            "{hit:?} {mean:?}"
        );
    }
}

/// One warning, however many beams are too wide.
#[test]
fn wide_spots_are_told_once() {
    let output = Scenario::new(&MOVING.replace("divergence = 0.6", "divergence = 400")).output("");
    let said = String::from_utf8(output.stderr).unwrap();
    let told = said.lines().filter(|line| line.contains("is allowed but unusual")).count();
    assert!(told == 1 && said.contains("footprint = 200."), "{said}");
}
