//! What each reading changes in the report's base scenario (section 8), one by one: the table of docs/model.md.
//!
//! `cargo run --release -p prob-water-measure --bin readings` prints it, with `-- --write` into the document. The same seas
//! are drawn for every reading but Eq. 22's.

use prob_water::{
    Engagement, Ensemble, Hiding, Parameters, Readings, Statistics, Surface, WhitecapMode, Wind,
};
use std::fs;

const INSTANCES: u64 = 1 << 18;
const DOCUMENT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/model.md");
const BEGIN: &str = "<!-- sensitivity -->\n";
const END: &str = "<!-- sensitivity end -->";
const HEAD: &str = "\
| as printed | peak, 1/sr | at, degrees | std there, 1/sr | f(70), 1/sr | w* = 56: f(80), 1/sr | f(85), 1/sr |
| --- | ---: | ---: | ---: | ---: | ---: | ---: |
";

/// Angles theta_r in degrees among which the peak is looked for.
const ANGLES: [f64; 25] = {
    let mut angles = [0.0; 25];
    let mut k = 0;
    while k < angles.len() {
        angles[k] = 2.5 * k as f64;
        k += 1;
    }
    angles
};

/// The choices that are compared, by name: none, each equation, the whole print, and the other count of what waves hide.
fn choices() -> Vec<(String, Readings, Hiding)> {
    let mut choices = vec![("none".to_string(), Readings::CORRECTED, Hiding::Report)];
    choices.extend(Readings::equations().map(|(name, reading)| (name.to_string(), reading, Hiding::Report)));
    choices.push(("`as_printed`".into(), Readings::AS_PRINTED, Hiding::Report));
    choices.push(("none, `hiding = \"once\"`".into(), Readings::CORRECTED, Hiding::Once));
    choices
}

/// What observers in the plane of incidence see of the base scenario under a wind, at angles in degrees.
fn statistics(friction_velocity: f64, readings: Readings, hiding: Hiding, angles: &[f64]) -> Vec<Statistics> {
    let water = Parameters {
        wind: Wind::FrictionVelocity(friction_velocity),
        surface: Surface::Instance,
        footprint: Some(0.15),
        components: 5,
        instances: INSTANCES,
        ior: Some(1.33),
        wavelength: 1.0,
        readings,
        hiding,
        ..Parameters::default()
    };
    let water = water.configure().expect("the parameters are valid");
    let views: Vec<_> =
        angles.iter().map(|angle| angle.to_radians().sin_cos()).map(|(sin, cos)| [sin, 0.0, cos]).collect();
    let engagement = Engagement::far(30.0, 1e4, &views, 1e5).expect("a beam that points down");
    let mut ensemble = Ensemble::new(&water).expect("a sea with waves").around(&engagement);
    ensemble.presence = WhitecapMode::Expected;
    let samples = ensemble.sample(&[engagement], &|_| ()).expect("they fit");
    (0..angles.len()).map(|o| samples.statistics(0, o, &[]).expect("an observer")).collect()
}

/// Peak, its angle and its standard deviation, f at 70 degrees; under the strongest wind of the report f at 80 and 85.
fn numbers(readings: Readings, hiding: Hiding) -> [f64; 6] {
    let mut angles = ANGLES.to_vec();
    angles.push(70.0);
    let all = statistics(8.0, readings, hiding, &angles);
    let (flank, near) = all.split_last().expect("there is one");
    let mean = |k: &usize| near[*k].mean;
    let peak = (0..near.len()).max_by(|a, b| mean(a).total_cmp(&mean(b))).expect("there is one");
    let storm = statistics(56.0, readings, hiding, &[80.0, 85.0]);
    [near[peak].mean, ANGLES[peak], near[peak].std, flank.mean, storm[0].mean, storm[1].mean]
}

fn table() -> String {
    let mut text = HEAD.to_string();
    let mut read = None;
    for (name, readings, hiding) in choices() {
        let found = numbers(readings, hiding);
        text += &format!("| {name} |");
        for (k, x) in found.iter().enumerate() {
            text += &match read {
                Some(read) if k != 1 => {
                    let read: [f64; 6] = read;
                    let change = 100.0 * (x / read[k] - 1.0);
                    if change.abs() < 0.05 { " 0 |".into() } else { format!(" {change:+.1} % |") }
                }
                _ if k == 1 => format!(" {x} |"),
                _ => format!(" {x:.3e} |"),
            };
        }
        text += "\n";
        read.get_or_insert(found);
    }
    text
}

/// The document's text before, within and after the marks.
fn split(document: &str) -> Option<[&str; 3]> {
    let (before, rest) = document.split_once(BEGIN)?;
    let (within, after) = rest.split_once(END)?;
    Some([before, within, after])
}

fn main() {
    let table = table();
    print!("{table}");
    if std::env::args().any(|argument| argument == "--write") {
        let document = fs::read_to_string(DOCUMENT).expect("the document");
        let [before, _, after] = split(&document).expect("its marks");
        fs::write(DOCUMENT, format!("{before}{BEGIN}{table}{END}{after}"))
            .expect("the document can be written");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The document's table has this program's head, a row for every choice and a number in every cell; what each is takes
    /// minutes to find.
    #[test]
    fn the_documents_table_has_every_reading() {
        let document = fs::read_to_string(DOCUMENT).unwrap();
        let [_, table, _] = split(&document).unwrap();
        let rows: Vec<_> = table.strip_prefix(HEAD).expect("the head").lines().collect();
        let choices = choices();
        assert_eq!(rows.len(), choices.len());
        for (row, (name, ..)) in rows.iter().zip(choices) {
            let cells: Vec<_> = row.trim_matches('|').split('|').map(str::trim).collect();
            assert_eq!((cells.len(), cells[0]), (7, &name[..]));
            for cell in &cells[1..] {
                cell.trim_end_matches(" %").parse::<f64>().unwrap();
            }
        }
    }
}
