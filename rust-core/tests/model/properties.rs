//! What holds of any input: texts for parameters, directions, damaged tables. Proptest draws them, and shrinks what fails.

use crate::common::direction;
use prob_water::batch::Rows;
use prob_water::brdf::up;
use prob_water::table::{Grid, Plan};
use prob_water::vocabulary::{Builder, ENTRIES, Value};
use prob_water::{Error, Fresnel, Parameters, SlopeMeasure, Surface, Table, Water, Wind};
use proptest::prelude::*;
use std::sync::LazyLock;

/// A name of the vocabulary.
fn name() -> impl Strategy<Value = &'static str> {
    (0..ENTRIES.len()).prop_map(|at| ENTRIES[at].name)
}

/// Texts that values are made of, and any others.
fn text() -> impl Strategy<Value = String> {
    let words = [
        "inf",
        "-inf",
        "nan",
        "true",
        "false",
        "flat",
        "instance",
        "ensemble",
        "empirical",
        "slope",
        "angle",
        "exact",
        "schlick",
        "as_printed",
        "corrected",
        "56, 71-73",
        "once",
        "fresh",
        "ocean",
        "power",
        "report",
        "slopes",
        "",
        "1e400",
        "-0",
    ];
    prop_oneof![
        3 => any::<f64>().prop_map(|x| x.to_string()),
        3 => (0.0..300.0f64).prop_map(|x| x.to_string()),
        2 => any::<i64>().prop_map(|x| x.to_string()),
        3 => prop::sample::select(words.to_vec()).prop_map(String::from),
        3 => any::<String>(),
    ]
}

/// A value of any kind.
fn value() -> impl Strategy<Value = Value> {
    prop_oneof![
        text().prop_map(Value::Text),
        any::<f64>().prop_map(Value::Number),
        any::<bool>().prop_map(Value::Flag),
    ]
}

/// Seas of the closed form, from calm to hurricane.
fn sea() -> impl Strategy<Value = Water> {
    let wind = prop_oneof![Just(0.0), 0.01..1.0f64, 1.0..238.65f64];
    let footprint = prop_oneof![Just(f64::INFINITY), 1e-3..10.0f64];
    let switches = any::<[bool; 5]>();
    (wind, footprint, -720.0..720.0f64, 0.2..200.0f64, switches).prop_map(
        |(w, footprint, wind_direction, wavelength, on)| {
            let parameters = Parameters {
                wind: Wind::FrictionVelocity(w),
                footprint: Some(footprint),
                wind_direction,
                wavelength,
                whitecaps: on[0],
                shadowing: on[1],
                gram_charlier: on[2],
                slope_measure: if on[3] { SlopeMeasure::Angle } else { SlopeMeasure::Slope },
                fresnel: if on[4] { Fresnel::Exact } else { Fresnel::Schlick },
                ..Parameters::default()
            };
            parameters.configure().unwrap()
        },
    )
}

/// Zenith angle and azimuth, degrees.
fn angles() -> impl Strategy<Value = (f64, f64)> {
    (prop_oneof![0.0..89.0f64, 89.0..89.9999f64], 0.0..360.0f64)
}

/// Not so near to 0 that nothing but rounding is left.
fn near(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * a.abs().max(b.abs()) + 1e-250
}

/// A table of a few nodes, as a file.
static SMALL: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let sea = Parameters { surface: Surface::Empirical, instances: 8, ..Parameters::default() };
    let grid = Grid {
        friction_velocity: vec![8.0, 9.0],
        footprint: vec![0.15],
        incidence: vec![0.0, 80.0],
        wind_azimuth: vec![0.0, 180.0],
        theta_r: vec![-60.0, 0.0, 30.0, 80.0],
    };
    Plan::new(&sea, &grid).unwrap().table().unwrap().to_bytes()
});

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1000) })]

    /// Any value for any name is taken, or refused by an error that names the parameter.
    #[test]
    fn any_value_is_taken_or_refused_by_name(name in name(), value in value()) {
        let mut builder = Builder::default();
        let configured =
            builder.set(name, &value).and_then(|()| builder.parameters()).and_then(|p| p.configure());
        if let Err(error) = configured {
            prop_assert_eq!(error.parameters(), vec![name]);
            let message = error.to_string();
            prop_assert!(message.contains(name) && !message.is_empty());
        }
    }

    /// Any values for several names; the error names one that was given.
    #[test]
    fn any_values_are_taken_or_refused(given in prop::collection::vec((name(), value()), 0..6)) {
        let mut builder = Builder::default();
        let set = given.iter().try_for_each(|(name, value)| builder.set(name, value));
        if let Err(error) = set.and_then(|()| builder.parameters()).and_then(|p| p.configure()) {
            let names: Vec<_> = given.iter().map(|(name, _)| *name).collect();
            let blamed = error.parameters();
            prop_assert!(!blamed.is_empty() && blamed.iter().all(|name| names.contains(name)), "{}", error);
        }
    }

    /// Names that are not in the vocabulary are told as such.
    #[test]
    fn unknown_names_are_refused(name in any::<String>(), value in value()) {
        prop_assume!(ENTRIES.iter().all(|entry| entry.name != name));
        let refused = matches!(Builder::default().set(&name, &value), Err(Error::UnknownParameter { .. }));
        prop_assert!(refused);
    }

    /// A sea shown as text reads back to the same bits.
    #[test]
    fn a_shown_sea_reads_back(
        wind in prop_oneof![
            (0.0..238.65f64).prop_map(Wind::FrictionVelocity),
            (0u8..=12).prop_map(Wind::Beaufort),
            (0.0..20.0f64, 1.0..100.0f64).prop_map(|(speed, height)| Wind::Speed { speed, height }),
        ],
        numbers in any::<[f64; 5]>(),
        (wavelength, ior) in (0.2..=200.0f64, prop::option::of(1.0..=4.0f64)),
        (seed, components, instances) in (0u64..1 << 53, 1u32..=65_536, 1u64..=1_000_000_000),
    ) {
        let [wind_direction, footprint, time, depth, fetch] = numbers;
        let positive = |x: f64| if x.is_nan() || x == 0.0 { f64::INFINITY } else { x.abs() };
        let parameters = Parameters {
            wind,
            wind_direction: if wind_direction.is_finite() { wind_direction } else { -0.0 },
            footprint: Some(positive(footprint)),
            time: if time.abs() <= 1e9 { time } else { -0.0 },
            depth: positive(depth),
            fetch: positive(fetch),
            wavelength,
            ior,
            seed,
            components,
            instances,
            ..Parameters::default()
        };
        let water = parameters.configure().unwrap();
        let mut builder = Builder::default();
        for line in water.to_string().lines().filter(|line| !line.starts_with('#')) {
            let (name, value) = line.split_once(" = ").unwrap();
            builder.set(name, &Value::Text(value.trim_matches('"').into())).unwrap();
        }
        let read = builder.parameters().unwrap();
        prop_assert_eq!(read, parameters);
        // Equality passes over the sign of 0.
        let signs = |p: &Parameters| [p.wind_direction, p.time].map(f64::to_bits);
        prop_assert_eq!(signs(&read), signs(&parameters));
    }

    /// f is the same with source and observer exchanged.
    #[test]
    fn reciprocal(sea in sea(), i in angles(), o in angles()) {
        let [i, o] = [i, o].map(|(theta, phi)| direction(theta, phi));
        let (there, back) = (sea.local_lobe().eval(i, o, up()), sea.local_lobe().eval(o, i, up()));
        prop_assert!(near(there, back, 1e-9), "{} {}", there, back);
    }

    /// Wind and directions turned together change nothing but the last digits: of a tilt, which a Gaussian magnifies, and
    /// the more the nearer the polynomial is to its zero.
    #[test]
    fn turned_together(sea in sea(), i in angles(), o in angles(), turn in -360.0..360.0f64) {
        let p = sea.parameters;
        let turned = Parameters { wind_direction: p.wind_direction + turn, ..p }.configure().unwrap();
        let smooth = Parameters { gram_charlier: false, ..p }.configure().unwrap();
        let [a, b] = [i, o].map(|(theta, phi)| direction(theta, phi));
        let [c, d] = [i, o].map(|(theta, phi)| direction(theta, phi + turn));
        let (before, after) = (sea.local_lobe().eval(a, b, up()), turned.local_lobe().eval(c, d, up()));
        let size = before.max(smooth.local_lobe().eval(a, b, up()));
        prop_assert!((before - after).abs() <= 1e-7 * size + 1e-250, "{} {}", before, after);
    }

    /// The first bad row is refused, whichever it is and whatever is wrong with it; without it none is.
    #[test]
    fn the_first_bad_row_is_refused(
        good in prop::collection::vec((angles(), angles()), 1..20),
        bad in any::<prop::sample::Index>(),
        later in any::<prop::sample::Index>(),
        wrong in prop_oneof![
            Just([f64::NAN, 0.0, 1.0]),
            Just([f64::INFINITY, 0.0, 0.0]),
            Just([0.0, 0.0, 0.0]),
            Just([0.0, 0.0, 1.000_11]),
            Just([0.6, 0.0, 0.799_8]),
            Just([1e300, 1e300, 1e300]),
        ],
        which in 0..2usize,
    ) {
        let mut rows = [vec![], vec![]];
        for (i, o) in &good {
            rows[0].push(direction(i.0, i.1));
            rows[1].push(direction(o.0, o.1));
        }
        prop_assert!(Rows::new(&rows[0], &rows[1], None).is_ok());
        let [first, last] = [bad, later].map(|at| at.index(good.len()));
        let [first, last] = [first.min(last), first.max(last)];
        (rows[which][first], rows[which][last]) = (wrong, wrong);
        let refused = Rows::new(&rows[0], &rows[1], None).unwrap_err();
        let column = ["to_source", "to_observer"][which];
        prop_assert!(
            matches!(refused, Error::Row { row, column: found, .. } if row == first + 1 && found == column),
            "{}", refused
        );
    }

    /// Damage to a table changes nothing, or is refused by an error that names the file.
    #[test]
    fn damaged_tables_are_refused(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let mut bytes = SMALL.clone();
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        match Table::read(&bytes, "damaged.npz") {
            Ok(table) => prop_assert!(table.to_bytes() == *SMALL),
            Err(error) => {
                prop_assert_eq!(error.parameters(), vec!["table"]);
                prop_assert!(error.to_string().contains("damaged.npz"));
            }
        }
    }

    /// Bytes of any kind are no table.
    #[test]
    fn any_bytes_are_no_table(bytes in prop::collection::vec(any::<u8>(), 0..600)) {
        prop_assert!(Table::read(&bytes, "any").is_err());
    }
}
