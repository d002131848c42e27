//! `prob-water table`: builds that are stopped and go on, and what tables say.

use crate::{column, command, floats, refuse, run, succeed};
use prob_water::{EmpiricalLobe, Parameters, Surface, Table, Wind};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

/// 12 rows, each of which takes a while; 32 numbers in a row.
const GRID: &str = "--friction-velocities 6,12 --footprints 0.15 --incidences 40:80:6 --wind-azimuths 0 \
                    --angles -80:80:9 --instances 2048";
const RECORD: u64 = 4 * 32 + 8;

/// A folder with tables.
pub struct Tables(tempfile::TempDir);

impl Tables {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn arguments(&self, name: &str, flags: &str) -> String {
        format!("table build {} {flags}", self.path(name).display())
    }

    #[track_caller]
    pub fn build(&self, name: &str, flags: &str) -> Vec<u8> {
        assert_eq!(succeed(&self.arguments(name, flags), ""), "");
        assert!(!self.path(&format!("{name}.part")).exists());
        fs::read(self.path(name)).unwrap()
    }

    fn names(&self) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(&self.0).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// A build that has made at least two rows, and not all.
    fn begun(&self, name: &str) -> Child {
        let part = self.path(&format!("{name}.part"));
        let arguments = self.arguments(name, &format!("{GRID} --threads 1"));
        let mut child = command().args(arguments.split_whitespace()).stderr(Stdio::piped()).spawn().unwrap();
        let length = || fs::metadata(&part).map_or(0, |file| file.len());
        while header(&part).is_none_or(|header| length() < header + 2 * RECORD) {
            assert!(child.try_wait().unwrap().is_none(), "ended before it was stopped");
            sleep(Duration::from_millis(1));
        }
        child
    }
}

/// How long the text is at the start of a file of rows.
fn header(part: &Path) -> Option<u64> {
    let content = fs::read(part).ok()?;
    let end = b"] }\n";
    Some(content.windows(end.len()).position(|w| w == end)? as u64 + end.len() as u64)
}

#[test]
fn a_killed_build_goes_on() {
    let tables = Tables::new();
    let expected = tables.build("whole.npz", GRID);
    for threads in [1, 3] {
        let mut child = tables.begun("killed.npz");
        child.kill().unwrap();
        child.wait().unwrap();
        assert_eq!(tables.names(), ["killed.npz.part", "whole.npz"]);
        let kept = fs::metadata(tables.path("killed.npz.part")).unwrap().len();
        let flags = format!("{GRID} --threads {threads}");
        // Other flags would make another table of it.
        let other = refuse(&tables.arguments("killed.npz", &format!("{flags} --seed 5")), "");
        assert!(other.contains("killed.npz.part was begun with other flags") && other.contains("delete it"));
        assert_eq!(fs::metadata(tables.path("killed.npz.part")).unwrap().len(), kept);
        assert!(tables.build("killed.npz", &flags) == expected);
        fs::remove_file(tables.path("killed.npz")).unwrap();
    }
}

/// Rows that are whole are taken as they are, others are made again.
#[test]
fn broken_rows_are_made_again() {
    let tables = Tables::new();
    let expected = tables.build("whole.npz", GRID);
    let part = tables.path("broken.npz.part");
    let mut child = tables.begun("broken.npz");
    child.kill().unwrap();
    child.wait().unwrap();
    let content = fs::read(&part).unwrap();
    let start = header(&part).unwrap() as usize;
    let mut flipped = content.clone();
    flipped[start + 50] ^= 1;
    let torn = content[..content.len() - 5].to_vec();
    let longer = [&content[..], &[7; 50]].concat();
    for broken in [flipped, torn, longer, content[..start].to_vec(), content[..20].to_vec(), vec![]] {
        fs::write(&part, broken).unwrap();
        assert!(tables.build("broken.npz", GRID) == expected);
    }
    fs::write(&part, "my notes").unwrap();
    assert!(refuse(&tables.arguments("broken.npz", GRID), "").contains("broken.npz.part was begun"));
    assert_eq!(fs::read_to_string(&part).unwrap(), "my notes");
}

#[cfg(unix)]
#[test]
fn one_build_at_a_time() {
    let tables = Tables::new();
    let child = tables.begun("busy.npz");
    let message = refuse(&tables.arguments("busy.npz", GRID), "");
    assert!(message.contains("busy.npz.part: another build is writing it"), "{message}");
    // Ctrl-C says how to go on.
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert!(message.starts_with("prob-water: stopped; ") && message.lines().count() == 1, "{message}");
    assert!(message.contains("busy.npz.part has the rows so far"), "{message}");
    assert_eq!(tables.names(), ["busy.npz.part"]);
}

/// A small table that takes no time.
pub const SMALL: &str = "--friction-velocities 6,8,12 --footprints 0.1:0.2:2 --incidences 0,30,60 \
                         --wind-azimuths 0:180:3 --angles -80:80:17 --instances 64";

#[test]
fn flags_reach_the_table() {
    let tables = Tables::new();
    let flags = format!("{SMALL} --components 6 --depth 30 --whitecaps false --seed 4");
    tables.build("table.npz", &flags);
    let table = Table::open(&tables.path("table.npz")).unwrap();
    assert_eq!(table.grid.shape(), [3, 2, 3, 3, 17]);
    assert_eq!(table.grid.theta_r[1], -70.0);
    let p = table.parameters;
    assert_eq!((p.components, p.depth, p.whitecaps, p.seed, p.instances), (6, 30.0, false, 4, 64));
    let shown = succeed(&format!("table show {}", tables.path("table.npz").display()), "");
    for line in ["grid, 918 nodes:", "  footprint (m): 0.1, 0.2", "  depth = 30", "  whitecaps = false"] {
        assert!(shown.lines().any(|shown| shown == line), "{line}: {shown}");
    }
    let json = succeed(&format!("table show --json {}", tables.path("table.npz").display()), "");
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["grid"]["incidence"].as_array().unwrap().len(), 3);
    assert_eq!(json["parameters"]["components"], 6);
}

#[test]
fn slices_are_the_librarys() {
    let tables = Tables::new();
    tables.build("table.npz", SMALL);
    let table = Table::open(&tables.path("table.npz")).unwrap();
    let water = Parameters {
        wind: Wind::FrictionVelocity(7.0),
        wind_direction: 40.0,
        footprint: Some(0.15),
        surface: Surface::Empirical,
        wavelength: 1.064,
        ..Parameters::default()
    };
    let lobe = EmpiricalLobe::new(&water.configure().unwrap(), &table).unwrap();
    let show =
        format!("table show {} --friction-velocity 7 --footprint 0.15", tables.path("table.npz").display());
    let (sin, cos) = 25f64.to_radians().sin_cos();
    let i = [-sin, 0.0, cos];
    let slice = format!("{show} --incidence 25 --wind-azimuth 40 --wavelength 1.064");
    let plane = succeed(&slice, "");
    assert_eq!(floats(&plane, "theta_r_deg"), table.grid.theta_r);
    for (row, theta) in table.grid.theta_r.iter().enumerate() {
        let (sin, cos) = theta.to_radians().sin_cos();
        let expected = lobe.estimate(i, [sin, 0.0, cos]);
        assert!((floats(&plane, "mean")[row] / expected.mean - 1.0).abs() < 1e-9);
        assert!((floats(&plane, "std")[row] / expected.std - 1.0).abs() < 1e-9);
    }
    let beyond = succeed(&format!("{slice} --angles 0,85"), "");
    assert_eq!(column(&beyond, "outside"), ["0", "1"]);
    let across = succeed(&format!("{slice} --across-plane"), "");
    let peak = floats(&across, "phi_r_deg").iter().position(|phi| *phi == 0.0).unwrap();
    let expected = lobe.estimate(i, [sin, 0.0, cos]).mean;
    assert!((floats(&across, "mean")[peak] / expected - 1.0).abs() < 1e-9);
    assert!(floats(&across, "mean")[0] < 0.1 * expected);

    let widths = succeed(&format!("{show} --widths"), "");
    assert_eq!(column(&widths, "friction_velocity_cm_s"), ["8"; 9]);
    let sigma = table.node([1, 1, 2, 1]).sigma.to_degrees();
    assert!((floats(&widths, "sigma_deg")[7] / sigma - 1.0).abs() < 1e-12);
}

#[test]
fn refusals() {
    let tables = Tables::new();
    let output = tables.path("out.npz");
    let output = output.display();
    for (flags, named) in [
        ("--wind-speed 5", "--wind-speed has no meaning here: a table's winds are --friction-velocities"),
        ("--footprint 1", "--footprint has no meaning here"),
        ("--surface empirical", "--surface has no meaning here"),
        ("--across slopes", "--across has no meaning here"),
        ("--time 1", "--time has no meaning here"),
        (
            "--incidences 0:90:4",
            "--incidences = 0:90:4 is out of range: allowed is rising numbers from 0 to 89",
        ),
        ("--friction-velocities 8,300", "allowed is rising numbers from 0.1 to 238.65"),
        ("--footprints 1,0.5", "--footprints = 1,0.5"),
        ("--footprints 1:2:1", "COUNT = 1"),
        ("--angles 0,1,x", "\"x\" is not a finite number"),
        ("--angles 0,1,2", "at least 4 angles"),
        ("--wind-azimuths 0,90", "from 0 to 180 degrees"),
        ("--instances 2000000", "instances = 2000000 is out of range: allowed is 1 to 1000000 for a table"),
        ("--components 0", "components = 0 is out of range"),
        ("--threads 0", "--threads"),
    ] {
        let message = refuse(&format!("table build {output} {flags}"), "");
        assert!(message.contains(named), "{flags}: {message}");
    }
    assert!(tables.names().is_empty());
    for (arguments, named) in [
        ("table", "build, show"),
        ("table build", "OUTPUT.npz"),
        ("table build -", "is not a file"),
        ("table build no/such/folder/t.npz", "no/such/folder/t.npz.part"),
        ("table show no/such.npz", "table = no/such.npz: cannot be read"),
        ("table show Cargo.toml", "table = Cargo.toml: is no npz file"),
        ("table show --beaufort 4", "--beaufort tells of a sea: say with --incidence or --widths"),
        ("table show --incidence 90", "0 to below 90"),
        ("table show --incidence 9 --angles 0,90", "90 is out of range"),
        ("table show --across-plane", "--incidence"),
        ("table show --widths --incidence 3", "--widths"),
        ("table show --widths --surface flat", "surface = flat is not served here: allowed is empirical"),
        ("table show --incidence 9 --wind-speed 30", "wind_speed = 30 (friction velocity"),
        ("table show --incidence 9 --footprint 2", "footprint = 2 is out of range: allowed is 0.02 to 1 m"),
        (
            "table show --incidence 9 --components 6",
            "components = 6 is out of range: allowed is 5, what the table",
        ),
        ("table show --output no/such/folder/t.txt", "no/such/folder/t.txt"),
    ] {
        let message = refuse(arguments, "");
        assert!(message.contains(named), "{arguments}: {message}");
    }
}

#[test]
fn a_reader_may_leave_early() {
    crate::leave_early(command().args(["table", "show"]));
    assert!(run("table show --help", "").status.success());
}
