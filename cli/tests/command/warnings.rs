//! Values that are allowed but hardly meant: one line each on standard error, whatever subcommand takes them.

use crate::run;
use std::fs;

const ROWS: &str = "ix,iy,iz,ox,oy,oz\n0,0,1,0,0,1\n";
const FOOTPRINT: &str =
    "prob-water: warning: footprint = 175 is allowed but unusual: usual is 0.001 to 100 m, or inf\n";
const DIRECTION: &str =
    "prob-water: warning: wind_direction = 1000000000 is allowed but unusual: usual is -360 to 360 degrees\n";

#[test]
fn every_subcommand_tells_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    fs::write(path("sea.toml"), "footprint = 175\nwind_direction = 1e9\n").unwrap();
    let engagement =
        "[[engagement]]\nlaser = [0, 0, 9]\ntarget = [0, 0, 0]\nobservers = [[0, 0, 9], [1, 0, 9]]\n";
    for name in ["plain", "told"] {
        let model = if name == "told" { "footprint = 175\nwind_direction = 1e9\n" } else { "" };
        let text = format!("[model]\ninstances = 100\n{model}{engagement}{engagement}");
        fs::write(path(&format!("{name}.toml")), text).unwrap();
    }
    let flags = "--footprint 175 --wind-direction 1e9";
    let from = format!("--from {}", path("sea.toml"));
    let both = format!("{DIRECTION}{FOOTPRINT}");
    for subcommand in
        ["wind", "spectrum --wave-number 1", "surface --grid 2,2,1", "brdf", "brdf --surface ensemble"]
    {
        for given in [flags, &from] {
            let output = run(&format!("{subcommand} {given}"), ROWS);
            let text = String::from_utf8(output.stderr).unwrap();
            assert!(output.status.success() && text == both, "{subcommand} {given}: {text}");
            assert!(!output.stdout.is_empty());
        }
    }
    for arguments in [format!("{} {flags}", path("plain.toml")), path("told.toml")] {
        let output = run(&format!("scenario {arguments}"), "");
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success() && text == both, "{arguments}: {text}");
    }
    let output = run("table show --incidence 30 --wind-azimuth 400", "");
    assert_eq!(
        String::from_utf8(output.stderr).unwrap(),
        "prob-water: warning: wind_direction = 400 is allowed but unusual: usual is -360 to 360 degrees\n"
    );
}

/// Hints at a unit.
#[test]
fn a_friction_velocity_in_other_units() {
    let output = run("wind --friction-velocity 0.3", "");
    assert!(output.status.success());
    assert!(
        String::from_utf8(output.stderr).unwrap().contains("friction_velocity = 0.3 is allowed but unusual")
    );
}
