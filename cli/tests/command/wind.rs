use crate::{close, float, succeed, table, vectors};
use serde_json::Value;

const HEADER: &str = "friction_velocity_cm_s,roughness_height_cm,W10_m_s,W12_5_m_s,W19_5_m_s,beaufort,description,\
                      whitecap_fraction,sigma_u2,sigma_c2,ior";

#[test]
fn reproduces_the_reference_vectors() {
    let expected = vectors("wind.csv");
    let expected = table(&expected);
    assert!(expected.len() > 12);
    for row in &expected[1..] {
        let text = succeed(&format!("wind --friction-velocity {}", row[0]), "");
        let found = table(&text);
        assert_eq!(found[0].join(","), HEADER);
        assert_eq!(found[0][..5], expected[0]);
        assert_eq!(found.len(), 2);
        for (found, expected) in found[1].iter().zip(row) {
            close(found, expected);
        }
    }
}

#[test]
fn reproduces_slope_variances_and_whitecaps() {
    // At 8 cm/s from the library's vectors; the fresh water's index is 0.006004 below the sea's.
    let variances = vectors("slope_variance.csv");
    let variances = table(&variances);
    let row = variances.iter().find(|row| row[0] == "8").unwrap();
    let text = succeed(&format!("wind --friction-velocity 8 --footprint {}", row[1]), "");
    let found = table(&text);
    close(found[1][8], row[2]);
    close(found[1][9], row[3]);
    let whitecaps = vectors("whitecap.csv");
    close(found[1][7], table(&whitecaps).iter().find(|row| row[0] == "8").unwrap()[3]);
    let fresh = succeed("wind --water fresh", "");
    assert!((float(found[1][10]) - float(table(&fresh)[1][10]) - 0.006004).abs() < 1e-6);
}

#[test]
fn names_the_beaufort_number() {
    let text = succeed("wind --beaufort 5", "");
    assert_eq!(table(&text)[1][..1], ["40"]);
    assert_eq!(table(&text)[1][5..7], ["5", "Fresh breeze"]);
}

#[test]
fn calm_is_infinitely_rough_in_csv_and_null_in_json() {
    let text = succeed("wind --wind-speed 0 --footprint inf --wind-direction -30", "");
    assert_eq!(table(&text)[1][..7], ["0", "inf", "0", "0", "0", "0", "Calm"]);
    let json: Value = serde_json::from_str(&succeed("wind --wind-speed 0 --json", "")).unwrap();
    let row = json[0].as_object().unwrap();
    assert_eq!(row.keys().cloned().collect::<Vec<_>>().join(","), HEADER);
    assert!(row["roughness_height_cm"].is_null());
    assert_eq!(row["description"], "Calm");
}

#[test]
fn table_1_as_printed() {
    let text = succeed("wind --table", "");
    let rows = table(&text);
    assert_eq!(rows[0].join(","), "beaufort,description,kind,W10_m_s,friction_velocity_cm_s,printed_cm_s");
    assert_eq!(rows.len(), 1 + 39);
    for row in &rows[1..] {
        assert!((float(row[4]) - float(row[5])).abs() <= 0.00501, "{row:?}");
    }
    assert_eq!(rows[39][..4], ["12", "Hurricane", "nominal", "34.5"]);
    assert_eq!(rows[39][5], "223.89");

    let json: Value = serde_json::from_str(&succeed("wind --table --json", "")).unwrap();
    assert_eq!(json.as_array().unwrap().len(), 39);
    assert_eq!(json[38]["friction_velocity_cm_s"].as_f64().unwrap(), float(rows[39][4]));
    assert_eq!(json[38]["beaufort"].as_u64(), Some(12));
}

#[test]
fn help_shows_units_and_defaults() {
    for (subcommand, surface, footprint) in [
        ("wind", "flat", "inf"),
        ("brdf", "flat", "inf"),
        ("spectrum", "instance", "0.15"),
        ("surface", "instance", "0.15"),
        ("scenario", "instance", "0.15"),
    ] {
        let help = succeed(&format!("{subcommand} --help"), "");
        let [surface, footprint] = [surface, footprint].map(|default| format!("[default: {default}]"));
        for text in ["--friction-velocity <cm/s>", "--footprint <m>", "[default: 5]", &surface, &footprint] {
            assert!(help.contains(text), "{text}");
        }
        for entry in prob_water::vocabulary::ENTRIES {
            assert!(help.contains(&format!("--{} <", entry.name.replace('_', "-"))), "{}", entry.name);
        }
    }
    assert_eq!(succeed("--version", ""), format!("prob-water {}\n", env!("CARGO_PKG_VERSION")));
}
