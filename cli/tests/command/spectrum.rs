use crate::{close, column, float, floats, succeed, table, vectors};
use serde_json::Value;

const HEADER: &str =
    "k_rad_cm,wavelength_m,omega_rad_s,S_cm3,k0_rad_cm,k1_rad_cm,k2_rad_cm,kmin_rad_cm,kmax_rad_cm";

#[test]
fn reproduces_the_reference_vectors() {
    let expected = vectors("spectrum.csv");
    let expected = table(&expected);
    let mut seas = 0;
    // Rows of one sea follow each other; their wave numbers go into one command.
    for rows in expected[1..].chunk_by(|a, b| a[..4] == b[..4]) {
        let [w, density, depth, fetch] = rows[0][..4] else { unreachable!() };
        let water = if density == "1" { "fresh" } else { "ocean" };
        let wave_numbers: Vec<_> = rows.iter().map(|row| row[4]).collect();
        let text = succeed(
            &format!(
                "spectrum --friction-velocity {w} --water {water} --depth {depth} --fetch {fetch} --wave-number {}",
                wave_numbers.join(",")
            ),
            "",
        );
        assert_eq!(table(&text).len(), 1 + rows.len());
        for (name, column) in expected[0].iter().zip(0..).skip(4) {
            for (found, row) in self::column(&text, name).into_iter().zip(rows) {
                close(found, row[column]);
            }
        }
        seas += 1;
    }
    assert!(seas > 50, "{seas}");
}

#[test]
fn covers_its_range() {
    for arguments in ["spectrum", "spectrum --points 200 --surface instance --footprint 0.15"] {
        let text = succeed(arguments, "");
        assert_eq!(text.lines().next(), Some(HEADER));
        let k = floats(&text, "k_rad_cm");
        assert_eq!(k.len(), 200);
        assert_eq!([k[0], k[199]], [floats(&text, "kmin_rad_cm")[0], floats(&text, "k2_rad_cm")[0]]);
        let ratio = k[1] / k[0];
        assert!(k.windows(2).all(|k| (k[1] / k[0] / ratio - 1.0).abs() < 1e-12));
        assert!(floats(&text, "S_cm3").iter().all(|s| *s > 0.0));
        for (k, wavelength) in k.iter().zip(floats(&text, "wavelength_m")) {
            assert!((0.01 * k.recip() * std::f64::consts::TAU / wavelength - 1.0).abs() < 1e-15);
        }
        // Waves down to two footprints are drawn.
        let k_max = floats(&text, "kmax_rad_cm")[0];
        assert!((k_max - std::f64::consts::TAU / 30.0).abs() < 1e-12);
    }
    assert_eq!(table(&succeed("spectrum --points 2", "")).len(), 3);
}

#[test]
fn calm_has_limits_but_no_waves() {
    let text = succeed("spectrum --wind-speed 0 --wave-number 0.1,1 --wave-number 2", "");
    assert_eq!(column(&text, "k_rad_cm").len(), 3);
    assert_eq!(column(&text, "kmax_rad_cm"), ["", "", ""]);
    assert_eq!(column(&text, "kmin_rad_cm"), ["inf", "inf", "inf"]);
    assert_eq!(column(&text, "S_cm3"), ["0", "0", "0"]);
    assert!(float(column(&text, "omega_rad_s")[0]) > 0.0);
    let json = succeed("spectrum --wind-speed 0 --wave-number 0.1 --json", "");
    let json: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json[0].as_object().unwrap().keys().cloned().collect::<Vec<_>>().join(","), HEADER);
    assert!(json[0]["kmax_rad_cm"].is_null() && json[0]["kmin_rad_cm"].is_null());
}
