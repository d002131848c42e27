//! `surface = "empirical"` in `brdf`, `scenario` and `--from`.

use crate::from::{image, text};
use crate::table::{SMALL, Tables};
use crate::{close, column, floats, refuse, run, succeed, table};
use prob_water::{EmpiricalLobe, Parameters, Surface, Table, Wind};
use std::fs;

const ROWS: &str =
    "ix,iy,iz,ox,oy,oz\n0.6,0,0.8,-0.48,0.36,0.8\n0,0,1,0,0,1\n0.999,0,0.04471,-0.6,0,0.8\n0,0,1,0,1,0\n";

fn sea() -> Parameters {
    Parameters {
        wind: Wind::FrictionVelocity(8.0),
        footprint: Some(0.15),
        surface: Surface::Empirical,
        ..Parameters::default()
    }
}

const SEA: &str = "--surface empirical --friction-velocity 8 --footprint 0.15";

#[test]
fn brdf_with_its_uncertainty() {
    let found = succeed(&format!("brdf {SEA}"), ROWS);
    assert_eq!(table(&found)[0].join(","), "ix,iy,iz,ox,oy,oz,f,u,outside");
    let lobe = EmpiricalLobe::new(&sea().configure().unwrap(), Table::standard()).unwrap();
    let expected = lobe.estimate([0.6, 0.0, 0.8], [-0.48, 0.36, 0.8]);
    close(column(&found, "f")[0], &expected.mean.to_string());
    close(column(&found, "u")[0], &expected.std.to_string());
    assert_eq!(column(&found, "outside"), ["0", "0", "1", "0"]);
    assert_eq!((column(&found, "f")[3], column(&found, "u")[3]), ("0", "0"));

    let tables = Tables::new();
    tables.build("own.npz", SMALL);
    let own = succeed(&format!("brdf {SEA} --table {}", tables.path("own.npz").display()), ROWS);
    assert_ne!(own, found);
    assert!((floats(&own, "f")[0] / floats(&found, "f")[0] - 1.0).abs() < 0.2);
}

#[test]
fn brdf_refusals() {
    let with_normals = "ix,iy,iz,ox,oy,oz,nx,ny,nz\n0,0,1,0,0,1,0,0,1\n";
    let message = refuse(&format!("brdf {SEA}"), with_normals);
    assert!(message.contains("normals have no meaning with surface = empirical"), "{message}");
    for (flags, named) in [
        ("--table a.npz", "--table has no meaning but with surface = empirical"),
        ("--surface empirical --table a.npz", "table = a.npz: cannot be read"),
        (
            "--surface empirical --depth 20",
            "depth = 20 is out of range: allowed is inf, what the table was made with",
        ),
        ("--surface empirical --beaufort 12", "beaufort = 12 (friction velocity"),
        ("--surface empirical --footprint inf", "footprint = inf is out of range: allowed is 0.02 to 1 m"),
    ] {
        let message = refuse(&format!("brdf {flags}"), ROWS);
        assert!(message.contains(named), "{flags}: {message}");
    }
}

#[test]
fn a_truncated_table() {
    let tables = Tables::new();
    let whole = tables.build("own.npz", SMALL);
    let path = tables.path("own.npz");
    fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    let [brdf, show] = [format!("brdf {SEA} --table"), "table show".into()];
    for arguments in [brdf, show, scenario(&tables, SCENARIO, "--table")] {
        let message = refuse(&format!("{arguments} {}", path.display()), ROWS);
        assert!(message.contains("own.npz: is no npz file, or a truncated one"), "{message}");
    }
}

/// A render's metadata, and a file with a table beside it.
#[test]
fn the_sea_of_a_file() {
    let tables = Tables::new();
    tables.build("own.npz", SMALL);
    let expected = succeed(&format!("brdf {SEA}"), ROWS);
    let shown = format!("{}\n# table: the built-in one", sea().configure().unwrap());
    image(&tables.path("render.exr"), &[("prob_water", text(&shown))]);
    let from = |name: &str| format!("brdf --from {}", tables.path(name).display());
    assert_eq!(succeed(&from("render.exr"), ROWS), expected);
    let waves = format!("--from {}", tables.path("render.exr").display());
    succeed(&format!("wind {waves}"), "");
    assert_eq!(
        succeed(&format!("surface --waves {waves}"), ""),
        succeed("surface --waves --friction-velocity 8 --footprint 0.15", "")
    );

    let own = succeed(&format!("brdf {SEA} --table {}", tables.path("own.npz").display()), ROWS);
    for toml in ["[model]\ntable = 'own.npz'\n", "table = 'own.npz'\n[model]\n"] {
        let toml = format!("{toml}surface = 'empirical'\nfriction_velocity = 8\n");
        fs::write(tables.path("sea.toml"), toml).unwrap();
        assert_eq!(succeed(&from("sea.toml"), ROWS), own);
        // On another surface the table has no part.
        let flat = succeed("brdf --friction-velocity 8", ROWS);
        assert_eq!(succeed(&format!("{} --surface flat", from("sea.toml")), ROWS), flat);
    }
    fs::write(tables.path("flat.toml"), "friction_velocity = 8\nsurface = 'flat'\nfootprint = inf\n")
        .unwrap();
    let show = format!("table show --incidence 30 --from {}", tables.path("flat.toml").display());
    assert_eq!(succeed(&show, ""), succeed("table show --incidence 30 --friction-velocity 8", ""));
}

const SCENARIO: &str = "
limits = [0.1, 0.2]

[model]
friction_velocity = 8
surface = 'empirical'
instances = 500

[[engagement]]
time = 2
laser = [-50, 0, 86.6]
target = [0, 0, 0]
observers = [[50, 0, 86.6], [0, 0, 100]]
[[engagement]]
laser = [-50, 0, 86.6]
target = [0, 0, 0]
observers = [[500, 0, 5]]
";

fn scenario(tables: &Tables, toml: &str, flags: &str) -> String {
    fs::write(tables.path("scenario.toml"), toml).unwrap();
    format!("scenario {} {flags}", tables.path("scenario.toml").display())
}

#[test]
fn scenario_by_table() {
    let tables = Tables::new();
    let output = run(&scenario(&tables, SCENARIO, ""), "");
    assert!(output.status.success());
    let found = String::from_utf8(output.stdout).unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(
        said.lines().last().unwrap_or_default(),
        "prob-water: warning: 1 of 3 rows are outside of the table's grid (column outside), the first at time 0, observer \
         0: they are its nearest values"
    );
    assert!(found.starts_with(
        "time,observer,mean,std,sem,min,p05,p50,p95,p99,max,mean_f_cos,obscured,whitecap,p_over_0.1,p_over_0.2,outside,\
         p_over_0.1_upper,p_over_0.2_upper,effective,mean_upper,method,mean_error,share_error,version,readings,seed\n2,0,"
    ));
    assert_eq!(column(&found, "outside"), ["0", "0", "1"]);
    assert_eq!(column(&found, "sem"), ["0"; 3]);
    for empty in ["mean_f_cos", "obscured"] {
        assert_eq!(column(&found, empty), [""; 3]);
    }
    let lobe = EmpiricalLobe::new(&sea().configure().unwrap(), Table::standard()).unwrap();
    let way = |x: f64, z: f64| [x / x.hypot(z), 0.0, z / x.hypot(z)];
    let expected = lobe.estimate(way(-50.0, 86.6), way(50.0, 86.6));
    close(column(&found, "mean")[0], &expected.mean.to_string());
    close(column(&found, "std")[0], &expected.std.to_string());
    let row = |name: &str| floats(&found, name)[0];
    assert!(row("min") <= row("p05") && row("p05") < row("p50") && row("p50") < row("p95"));
    assert!(row("p95") < row("p99") && row("p99") <= row("max"));
    assert!(row("p_over_0.2") < row("p_over_0.1") && row("p_over_0.1") < 1.0);
    // Draws agree with the formula, and with the draws of surfaces.
    let two = SCENARIO.split("[[engagement]]\nlaser").next().unwrap();
    let exact = two.replace("limits", "statistics = 'exact'\nlimits");
    let exact = succeed(&scenario(&tables, &exact, "--surface instance"), "");
    assert!((row("mean") / floats(&exact, "mean")[0] - 1.0).abs() < 0.05);
    assert!((row("p50") / floats(&exact, "p50")[0] - 1.0).abs() < 0.25);
    // Threads change nothing, the seed does.
    let all = |flags: &str| succeed(&scenario(&tables, two, flags), "");
    assert_eq!(all("--threads 1"), all("--threads 3"));
    assert_eq!(column(&all("--seed 3"), "mean"), column(&all(""), "mean"));
    assert_ne!(column(&all("--seed 3"), "p50"), column(&all(""), "p50"));
}

#[test]
fn a_scenario_names_its_table() {
    let tables = Tables::new();
    tables.build("own.npz", SMALL);
    let two = SCENARIO.split("[[engagement]]\nlaser").next().unwrap();
    let named = format!("table = 'own.npz'\n{two}");
    let by_file = succeed(&scenario(&tables, &named, ""), "");
    let flag = format!("--table {}", tables.path("own.npz").display());
    assert_eq!(succeed(&scenario(&tables, two, &flag), ""), by_file);
    assert_ne!(succeed(&scenario(&tables, two, ""), ""), by_file);
    // It is read, and so not written.
    let flags = format!("--output {}", tables.path("own.npz").display());
    assert!(refuse(&scenario(&tables, &named, &flags), "").contains("own.npz is also read, as"));
    // The flag stands above the file.
    let missing = named.replace("own.npz", "missing.npz");
    assert_eq!(succeed(&scenario(&tables, &missing, &flag), ""), by_file);
    let message = refuse(&scenario(&tables, &missing, ""), "");
    assert!(message.contains("scenario.toml:1: table = ") && message.contains("cannot be read"), "{message}");
    for (toml, flags, named) in [
        (named.replace("'own.npz'", "3"), "", "scenario.toml:1: table = 3 is not a word"),
        (
            named.clone(),
            "--surface instance",
            "scenario.toml:1: table has no meaning but with surface = empirical",
        ),
        (two.into(), "--surface instance --table x", "--table has no meaning but with surface = empirical"),
        (two.into(), "--instances-out x.csv", "--instances-out has no meaning with surface = empirical"),
        (
            format!("statistics = 'exact'{two}"),
            "",
            "toml:1: statistics has no meaning with surface = empirical",
        ),
        (format!("draws = 'sobol'{two}"), "", "toml:1: draws has no meaning with surface = empirical"),
        (format!("whitecap_presence = 'expected'{two}"), "", "toml:1: whitecap_presence has no meaning"),
        (
            two.replace("= 8", "= 80"),
            "",
            "toml:5: friction_velocity = 80 is out of range: allowed is 2 to 62.9 cm/s",
        ),
        (two.replace("instances = 500", "components = 6"), "", "toml:7: components = 6 is out of range"),
        (two.replace("= 500", "= 10000001"), "", "toml:7: instances = 10000001 is out of range"),
    ] {
        let message = refuse(&scenario(&tables, &toml, flags), "");
        assert!(message.contains(named), "{named}: {message}");
    }
}
