use crate::{float, floats, refuse, same, succeed, table};

const SEA: &str = "--wind-speed 9 --wind-direction 40 --components 11 --seed 7 --instance 3";
const HEADER: &str = "time,x,y,height,slope_x,slope_y,nx,ny,nz,acceleration,whitecap";

/// Everything over a place and at a time, from the waves as they are listed.
fn recomputed(waves: &str, [x, y, t]: [f64; 3]) -> [f64; 4] {
    let mut point = [0.0; 4];
    for row in &table(waves)[1..] {
        let [k, _, psi, phi, a, omega] = row[..] else { unreachable!() };
        let [k, psi, phi, a, omega] = [k, psi, phi, a, omega].map(float);
        let (k_x, k_y) = (k * phi.cos(), k * phi.sin());
        let (sin, cos) = (psi + k_x * x + k_y * y + omega * t).sin_cos();
        for (sum, term) in point.iter_mut().zip([cos, -k_x * sin, -k_y * sin, -omega * omega * cos]) {
            *sum += a * term;
        }
    }
    point
}

#[test]
fn points_follow_from_the_waves() {
    let waves = succeed(&format!("surface --waves {SEA}"), "");
    assert_eq!(
        waves.lines().next(),
        Some("wave_number_rad_m,wavelength_m,phase_rad,azimuth_rad,amplitude_m,frequency_rad_s")
    );
    assert_eq!(table(&waves).len(), 1 + 11);
    for (k, wavelength) in floats(&waves, "wave_number_rad_m").iter().zip(floats(&waves, "wavelength_m")) {
        assert!((k * wavelength - std::f64::consts::TAU).abs() < 1e-12);
        assert!(wavelength >= 0.3 * (1.0 - 1e-12), "two footprints and longer");
    }

    let bounds = succeed(&format!("surface --bounds {SEA}"), "");
    let (k, a) = (floats(&waves, "wave_number_rad_m"), floats(&waves, "amplitude_m"));
    assert!((floats(&bounds, "highest")[0] - a.iter().sum::<f64>()).abs() < 1e-12);
    let steepest: f64 = k.iter().zip(a).map(|(k, a)| k * a).sum();
    assert!((floats(&bounds, "steepest")[0] - steepest).abs() < 1e-12);

    let input = "time,y,x\n0,0,0\n2.5,-3,4.25\n2.5,1e2,0\n-7,0.5,-60\n";
    let text = succeed(&format!("surface --points - {SEA} --time 99"), input);
    assert_eq!(text.lines().next(), Some(HEADER));
    assert_eq!(floats(&text, "time"), [0.0, 2.5, 2.5, -7.0]);
    assert_eq!(floats(&text, "x"), [0.0, 4.25, 0.0, -60.0]);
    for row in &table(&text)[1..] {
        let row: Vec<_> = row.iter().map(|text| float(text)).collect();
        let [time, x, y, height, slope_x, slope_y, nx, ny, nz, acceleration, whitecap] = row[..] else {
            unreachable!()
        };
        let found = [height, slope_x, slope_y, acceleration];
        for (found, expected) in found.iter().zip(recomputed(&waves, [x, y, time])) {
            assert!((found - expected).abs() < 1e-12, "{found} against {expected}");
        }
        assert!((nx + slope_x * nz).abs() < 1e-15 && (ny + slope_y * nz).abs() < 1e-15);
        assert!((nx * nx + ny * ny + nz * nz - 1.0).abs() < 1e-15);
        assert!((0.0..=1.0).contains(&whitecap));
    }
}

#[test]
fn grids_run_along_x_first() {
    let text = succeed(&format!("surface --grid 3,2,0.5 {SEA} --time 1.5"), "");
    assert_eq!(floats(&text, "x"), [0.0, 0.5, 1.0, 0.0, 0.5, 1.0]);
    assert_eq!(floats(&text, "y"), [0.0, 0.0, 0.0, 0.5, 0.5, 0.5]);
    assert_eq!(floats(&text, "time"), [1.5; 6]);
    // The same as points at that time, to the bit.
    let input = "x,y\n0,0\n.5,0\n1,0\n0,.5\n.5,.5\n1,.5\n";
    assert_eq!(succeed(&format!("surface --points - {SEA} --time 1.5"), input), text);
    let other = succeed(&format!("surface --grid 3,2,0.5 {SEA} --time 1.5 --json"), "");
    let other: serde_json::Value = serde_json::from_str(&other).unwrap();
    for (object, height) in other.as_array().unwrap().iter().zip(floats(&text, "height")) {
        assert!(same(object["height"].as_f64().unwrap(), height));
    }
}

#[test]
fn whitecaps_may_be_left_out() {
    let whitecaps = |flags: &str| {
        floats(&succeed(&format!("surface --grid 40,1,3 --wind-speed 25 {flags}"), ""), "whitecap")
    };
    let found = whitecaps("--whitecap-onset ramp");
    // Eq. 53 of the acceleration beside it.
    let accelerations = floats(&succeed("surface --grid 40,1,3 --wind-speed 25", ""), "acceleration");
    let wind = prob_water::Wind::Speed { speed: 25.0, height: 10.0 }.profile().unwrap();
    for (p, acceleration) in found.iter().zip(&accelerations) {
        let expected = prob_water::whitecap::probability(wind.friction_velocity, 100.0 * acceleration);
        assert!((p - expected).abs() < 1e-12, "{p} {expected}");
    }
    assert!(found.len() == 40 && found.iter().any(|p| *p > 0.0) && found.contains(&0.0));
    assert_eq!(whitecaps("--whitecaps false"), [0.0; 40]);
    // By default with what is not drawn: more where the acceleration is lower.
    let mut calibrated: Vec<_> = accelerations.into_iter().zip(whitecaps("")).collect();
    calibrated.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!(calibrated.is_sorted_by(|a, b| a.1 >= b.1) && calibrated[39].1 < calibrated[0].1);
}

#[test]
fn every_instance_and_seed_is_another_sea() {
    let waves = |flags: &str| succeed(&format!("surface --waves {flags}"), "");
    assert_eq!(waves(""), waves("--instance 0 --seed 0"));
    assert_ne!(waves(""), waves("--instance 1"));
    assert_ne!(waves(""), waves("--seed 1"));
    // More components do not change the first ones but for their share of the energy.
    let [few, many] = ["5", "9"].map(|m| floats(&waves(&format!("--components {m}")), "azimuth_rad"));
    assert_eq!(few[..], many[..5]);
}

#[test]
fn calm_is_level() {
    assert_eq!(table(&succeed("surface --waves --wind-speed 0", "")).len(), 1);
    assert_eq!(succeed("surface --waves --wind-speed 0 --json", ""), "[]\n");
    let text = succeed("surface --grid 2,2,1 --wind-speed 0", "");
    assert_eq!(floats(&text, "height"), [0.0; 4]);
    assert_eq!(floats(&text, "nz"), [1.0; 4]);
}

#[test]
fn rows_that_are_refused() {
    for (input, named) in [
        ("x\n1\n", "header: column y is missing, expected x,y and optionally time"),
        ("x,y,z\n1,2,3\n", "header: column \"z\" is unknown"),
        ("x,y\n0,0\n0,east\n", "row 2: y = \"east\" is not a number"),
        ("x,y\n0\n", "row 1: column y is missing"),
        ("x,y\n0,inf\n", "row 1: y = inf is out of range: allowed is finite, at most 1e9 m from 0"),
        ("x,y,time\n0,0,0\n0,0,nan\n", "row 2: time = NaN is out of range"),
        ("x,y,time\n0,0,2e9\n", "row 1: time = 2000000000 is out of range"),
    ] {
        let message = refuse("surface --points -", input);
        assert!(message.contains(named), "{message}");
    }
}

/// Draws spread over the spectrum: a wave from each of as many parts of it, whichever comes first the longest.
#[test]
fn stratified_and_fading() {
    let sea = "--friction-velocity 16 --footprint 0.2 --components 64 --draws stratified";
    let plain = succeed(&format!("surface --waves {sea}"), "");
    let faded = succeed(&format!("surface --waves {sea} --fade"), "");
    let [ends, fades] = [&plain, &faded].map(|waves| floats(waves, "wave_number_rad_m"));
    for (k, most) in [(&ends, 1.0), (&fades, 2f64.sqrt())] {
        assert!(k.is_sorted());
        let most = most * std::f64::consts::PI / 0.2;
        assert!(k.last().is_some_and(|k| *k <= most && *k > 0.8 * most));
    }
    // An octave about two footprints, at whose middle half of the energy is left.
    let other = succeed(
        &format!("surface --waves --footprint 0.1414213562373095 {}", sea.replace("--footprint 0.2", "")),
        "",
    );
    let (whole, left) = (floats(&other, "amplitude_m"), floats(&faded, "amplitude_m"));
    for (k, (whole, left)) in fades.iter().zip(whole.iter().zip(left)) {
        let share = (0.5 - (k * 0.2 / std::f64::consts::PI).log2()).clamp(0.0, 1.0);
        assert!((left * left / (whole * whole) - share).abs() < 1e-9, "{k}: {left} of {whole}");
    }
    assert!(refuse("surface --bounds --draws even", "").contains("even"));
}
