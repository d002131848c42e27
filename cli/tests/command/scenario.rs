use crate::{column, command, float, floats, leave_early, same, succeed, table};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A folder with one scenario file.
pub struct Scenario(TempDir);

impl Scenario {
    pub fn new(text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("sea.toml"), text).unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The statistics.
    #[track_caller]
    pub fn run(&self, flags: &str) -> String {
        succeed(&format!("scenario {} {flags}", self.path("sea.toml").display()), "")
    }

    /// Both streams of a run.
    pub fn output(&self, flags: &str) -> std::process::Output {
        let output = crate::run(&format!("scenario {} {flags}", self.path("sea.toml").display()), "");
        assert!(output.status.success());
        output
    }

    /// The statistics and the table of instances.
    #[track_caller]
    pub fn run_with_instances(&self, flags: &str) -> [String; 2] {
        let path = self.path("instances.csv");
        let statistics = self.run(&format!("{flags} --instances-out {}", path.display()));
        [statistics, fs::read_to_string(path).unwrap()]
    }
}

const HEADER: &str = "time,observer,mean,std,sem,min,p05,p50,p95,p99,max,mean_f_cos,obscured,whitecap,\
                      p_over_0.001,p_over_0.25,p_over_2,p_over_0.001_upper,p_over_0.25_upper,p_over_2_upper,\
                      effective,mean_upper,method,mean_error,share_error,version,readings,seed";
const INSTANCES: &str =
    "time,observer,instance,f,cos_r,obscured,whitecap,x,y,z,nx,ny,nz,weight,version,readings,seed";

/// Two engagements, three observers in all.
const TWO: &str = "
limits = [1e-3, 0.25, 2]

[model]
wind_speed = 7
wind_height = 19.5
instances = 60
seed = 5

[[engagement]]
time = 2
laser = [-50, 0, 86.6]
target = [0, 0, 0]
observers = [[50, 0, 86.6], [200, 20, 9.5]]

[[engagement]]
laser = [0, 0, 10]
direction = [0, 0, -3]
observers = [[0, 0, 1e3]]
";

const MOVING: &str = "
[model]
instances = 20
[[engagement]]
times = [0, 1.5, 3]
laser = [[-50, 0, 60], [-45, 0, 60], [-40, 0, 60]]
target = [0, 1, 0]
observers = [[50, 0, 60], [[50, 0, 60], [51, 0, 60], [52, 0, 60]]]
";

#[test]
fn columns_and_rows() {
    let sea = Scenario::new(TWO);
    let [statistics, instances] = sea.run_with_instances("");
    assert_eq!(statistics.lines().next(), Some(HEADER));
    assert_eq!(column(&statistics, "time"), ["2", "2", "0"]);
    assert_eq!(column(&statistics, "observer"), ["0", "1", "0"]);
    assert_eq!(column(&statistics, "version"), [env!("CARGO_PKG_VERSION"); 3]);
    assert_eq!(column(&statistics, "readings"), ["corrected"; 3]);
    assert_eq!(column(&statistics, "seed"), ["5"; 3]);

    assert_eq!(instances.lines().next(), Some(INSTANCES));
    assert_eq!(table(&instances).len(), 1 + 3 * 60);
    let numbers: Vec<_> = (0..60).map(|i| i.to_string()).collect();
    assert_eq!(column(&instances, "instance"), [&numbers[..]; 3].concat());
    assert!(column(&instances, "obscured").into_iter().all(|o| o == "0" || o == "1"));
    let printed = sea.run("--readings as_printed");
    assert_eq!(column(&printed, "readings"), ["as_printed"; 3]);
    assert_ne!(column(&printed, "mean"), column(&statistics, "mean"));
}

/// Every statistic that has a closed form, from the instances.
#[test]
fn statistics_follow_from_the_instances() {
    let [statistics, instances] = Scenario::new(TWO).run_with_instances("");
    let instance = |name: &str| floats(&instances, name);
    let (f, cos_r) = (instance("f"), instance("cos_r"));
    for (row, f) in f.chunks(60).enumerate() {
        let close = |name: &str, expected: f64| {
            let found = floats(&statistics, name)[row];
            assert!((found - expected).abs() <= 1e-13 * expected.abs(), "{name}: {found}, {expected}");
        };
        let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / 60.0;
        let average = mean(&mut f.iter().copied());
        let std = mean(&mut f.iter().map(|f| (f - average).powi(2))).sqrt();
        close("mean", average);
        close("std", std);
        close("sem", std / 60f64.sqrt());
        close("min", f.iter().copied().fold(f64::INFINITY, f64::min));
        close("max", f.iter().copied().fold(0.0, f64::max));
        close("mean_f_cos", mean(&mut f.iter().zip(&cos_r[60 * row..]).map(|(f, c)| f * c.max(0.0))));
        for name in ["obscured", "whitecap"] {
            close(name, mean(&mut instance(name)[60 * row..][..60].iter().copied()));
        }
        for limit in ["0.001", "0.25", "2"] {
            let over = f.iter().filter(|f| **f > float(limit)).count();
            close(&format!("p_over_{limit}"), over as f64 / 60.0);
        }
        let mut sorted = f.to_vec();
        sorted.sort_by(f64::total_cmp);
        close("p50", 0.5 * (sorted[29] + sorted[30]));
        assert!(average > 0.0 && std > 0.0);
    }
}

/// The hit lies on the surface of the same number, which moves with the time of the engagement.
#[test]
fn instances_are_those_of_the_surface() {
    let [_, instances] = Scenario::new(TWO).run_with_instances("");
    for row in [3, 60 + 41, 120 + 17] {
        let row = &table(&instances)[1 + row];
        let (time, number) = (row[0], row[2]);
        let point = format!("x,y\n{},{}\n", row[7], row[8]);
        let sea = format!("--wind-speed 7 --wind-height 19.5 --seed 5 --time {time} --instance {number}");
        let surface = succeed(&format!("surface --points - {sea}"), &point);
        for (name, expected) in [("height", row[9]), ("nx", row[10]), ("ny", row[11]), ("nz", row[12])] {
            assert!((floats(&surface, name)[0] - float(expected)).abs() < 1e-12, "{name}");
        }
    }
}

#[test]
fn threads_change_no_bit() {
    for settings in ["", "draws = 'sobol'\nwhitecap_presence = 'expected'\n"] {
        let sea = Scenario::new(&format!("{settings}{TWO}"));
        let expected = sea.run_with_instances("");
        for threads in [1, 2, 7] {
            assert_eq!(sea.run_with_instances(&format!("--threads {threads}")), expected);
        }
    }
}

#[test]
fn seeds_and_settings_differ() {
    let sea = Scenario::new(TWO);
    let seeds: Vec<_> = (0..3).map(|seed| sea.run(&format!("--seed {seed}"))).collect();
    assert!(seeds[0] != seeds[1] && seeds[1] != seeds[2]);
    assert_eq!(column(&seeds[2], "seed"), ["2"; 3]);
    assert_eq!(sea.run("--seed 5"), sea.run(""));
    for setting in ["draws = 'sobol'", "whitecap_presence = 'expected'", "statistics = 'exact'"] {
        let wind = "--wind-speed 25";
        assert_ne!(Scenario::new(&format!("{setting}\n{TWO}")).run(wind), sea.run(wind), "{setting}");
    }
    let same = "draws = 'random'\nwhitecap_presence = 'drawn'\nstatistics = 'draws'\n";
    assert_eq!(Scenario::new(&format!("{same}{TWO}")).run(""), sea.run(""));
    // A scenario's own keys may also stand in [model].
    let inside =
        TWO.replace("limits = [1e-3, 0.25, 2]\n", "").replace("[model]", "[model]\nlimits = [1e-3, 0.25, 2]");
    assert_eq!(Scenario::new(&inside).run(""), sea.run(""));
}

#[test]
fn flags_stand_above_the_file() {
    let sea = Scenario::new(TWO);
    let text = sea.run("--instances 7 --footprint inf");
    assert_eq!(text, Scenario::new(&TWO.replace("instances = 60", "instances = 7\nfootprint = inf")).run(""));
    // A wind given as a flag is the whole wind: the file's speed and height are no conflict.
    let text = sea.run("--beaufort 3");
    let without = TWO.replace("wind_speed = 7", "beaufort = 3").replace("wind_height = 19.5", "");
    assert_eq!(text, Scenario::new(&without).run(""));
    let height = Scenario::new(&TWO.replace("wind_speed = 7", "").replace("19.5", "3")).run("");
    assert_eq!(sea.run("--wind-height 3"), height);
}

#[test]
fn a_trajectory_is_an_engagement_for_every_time() {
    let one = |time: &str, laser: &str, observer: &str| {
        format!(
            "[[engagement]]\ntime = {time}\nlaser = {laser}\ntarget = [0, 1, 0]\n\
             observers = [[50, 0, 60], {observer}]\n"
        )
    };
    let apart = [
        "[model]\ninstances = 20\n".to_owned(),
        one("0", "[-50, 0, 60]", "[50, 0, 60]"),
        one("1.5", "[-45, 0, 60]", "[51, 0, 60]"),
        one("3", "[-40, 0, 60]", "[52, 0, 60]"),
    ];
    let moving = Scenario::new(MOVING).run_with_instances("");
    assert_eq!(moving, Scenario::new(&apart.concat()).run_with_instances(""));
    assert_eq!(column(&moving[0], "time"), ["0", "0", "1.5", "1.5", "3", "3"]);
    assert_eq!(column(&moving[0], "observer"), ["0", "1", "0", "1", "0", "1"]);
    // Without a time of its own an engagement takes the model's.
    let model = TWO.replace("seed = 5", "seed = 5\ntime = 4");
    assert_eq!(column(&Scenario::new(&model).run(""), "time"), ["2", "2", "4"]);
}

#[test]
fn json_holds_the_same_numbers() {
    let sea = Scenario::new(TWO);
    let csv = sea.run_with_instances("");
    let json = sea.run_with_instances("--json");
    for (csv, json) in csv.iter().zip(json) {
        let json: Value = serde_json::from_str(&json).unwrap();
        let rows = table(csv);
        assert_eq!(json.as_array().unwrap().len(), rows.len() - 1);
        for (row, object) in rows[1..].iter().zip(json.as_array().unwrap()) {
            let object = object.as_object().unwrap();
            assert_eq!(object.keys().collect::<Vec<_>>(), rows[0]);
            for (text, value) in row.iter().zip(object.values()) {
                assert!(value.as_f64().map_or(value == text, |x| same(x, float(text))), "{text}, {value}");
            }
        }
    }
}

/// There is no smallest and no largest of infinitely many.
#[test]
fn exact_statistics_leave_min_and_max_empty() {
    let sea = Scenario::new(&format!("statistics = 'exact'\n{TWO}"));
    let text = sea.run("");
    assert_eq!(text.lines().next(), Some(HEADER));
    assert_eq!(column(&text, "observer"), ["0", "1", "0"]);
    assert_eq!([column(&text, "min"), column(&text, "max"), column(&text, "effective")].concat(), [""; 9]);
    assert_eq!(column(&text, "method"), ["exact"; 3]);
    let json: Value = serde_json::from_str(&sea.run("--json")).unwrap();
    assert!(json[0]["min"].is_null() && json[2]["max"].is_null());
}

/// Wind 5, looked at in the mirror's direction, 50 draws: facets of a footprint of millimetres are hardly ever met by plain
/// draws, whose mean was 1e-265 with a standard error of 0.
const NARROW: &str = "
limits = [1]
[model]
wind_speed = 5
footprint = 0.003
[[engagement]]
laser = [-5000, 0, 8660.254]
target = [0, 0, 0]
observers = [[5000, 0, 8660.254], [8660.254, 0, 5000]]
";

#[test]
fn no_false_zero_of_narrow_facets() {
    let plain = Scenario::new(&format!("draws = 'random'{NARROW}"));
    let output = plain.output("");
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(column(&text, "method"), ["draws"; 2]);
    for row in 0..2 {
        let of = |name: &str| floats(&text, name)[row];
        assert!(of("mean") < 1e-9 && of("effective") < 10.0 && of("mean_upper") > 1.0, "{text}");
        assert!(of("p_over_1") == 0.0 && (of("p_over_1_upper") - 0.0582).abs() < 1e-3, "{text}");
    }
    assert_eq!(
        String::from_utf8(output.stderr).unwrap(),
        "prob-water: warning: 2 of 2 rows rest on fewer than 10 effective draws (column effective), the first at time 0, \
         observer 0: their mean and sem are not settled, and mean_upper is all that is known; take draws = auto or more instances\n"
    );
    // Draws by importance, the default where facets are narrow, and integrals agree.
    let drawn = Scenario::new(NARROW).run("--instances 4000");
    let exact = Scenario::new(&format!("statistics = 'exact'{NARROW}")).run("");
    assert_eq!(column(&drawn, "method"), ["slopes"; 2]);
    for row in 0..2 {
        let [drawn_mean, exact_mean] = [&drawn, &exact].map(|text| floats(text, "mean")[row]);
        let sem = floats(&drawn, "sem")[row];
        assert!(sem > 0.0 && (drawn_mean - exact_mean).abs() < 4.0 * sem, "{drawn}{exact}");
    }
    let [_, instances] = Scenario::new(NARROW).run_with_instances("");
    let (weights, f) = (floats(&instances, "weight"), floats(&instances, "f"));
    let mean = weights.iter().zip(&f).map(|(w, f)| w * f).take(50).sum::<f64>() / 50.0;
    let found = floats(&Scenario::new(NARROW).run(""), "mean")[0];
    assert!((mean / found - 1.0).abs() < 1e-12, "{mean} against {found}");
}

/// Integrals say how far low views may be off, and `auto` takes draws there.
#[test]
fn methods_that_hold() {
    let low = "
[model]
wind_speed = 5
instances = 400
[[engagement]]
laser = [-870, 0, 108.4]
target = [0, 0, 0]
observers = [[5000, 0, 120], [5000, 0, 2800]]
";
    let exact = Scenario::new(&format!("statistics = 'exact'{low}"));
    let output = exact.output("");
    let text = String::from_utf8(output.stdout).unwrap();
    let [error, share] = ["mean_error", "share_error"].map(|name| floats(&text, name));
    assert!(
        error[0] > 0.2 && error[0] < 1.0 && error[1] < 0.02 && share[0] > 0.05 && share[1] < 0.03,
        "{text}"
    );
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.starts_with("prob-water: warning: 1 of 2 rows may be off by their method"), "{said}");
    let auto = Scenario::new(&format!("statistics = 'auto'{low}"));
    let text = auto.run("");
    assert_eq!(column(&text, "method"), ["draws", "exact"]);
    assert_eq!(column(&text, "mean_error")[0], "0");
    let drawn = Scenario::new(low).run("");
    assert_eq!(floats(&text, "mean")[0], floats(&drawn, "mean")[0]);
    // Too few components for integrals: draws serve all.
    assert_eq!(column(&auto.run("--components 3"), "method"), ["draws"; 2]);
}

#[test]
fn both_files_appear() {
    let sea = Scenario::new(TWO);
    let [statistics, instances] = ["a.csv", "b.csv"].map(|name| sea.path(name));
    let flags = format!("--output {} --instances-out {}", statistics.display(), instances.display());
    assert_eq!(sea.run(&flags), "");
    assert_eq!(
        [statistics, instances].map(|path| fs::read_to_string(path).unwrap()),
        sea.run_with_instances("")
    );
    let mut names: Vec<_> = fs::read_dir(&sea.0).unwrap().map(|e| e.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["a.csv", "b.csv", "instances.csv", "sea.toml"]);
    // The instances alone on standard output, where the statistics go to a file.
    let flags = format!("--output {} --instances-out -", sea.path("a.csv").display());
    assert!(sea.run(&flags).starts_with(INSTANCES));
}

/// Whoever reads the statistics may stop early; the file of instances is still written.
#[test]
fn a_reader_may_leave_early() {
    let times = vec!["0"; 5000].join(", ");
    let text = format!(
        "[model]\ninstances = 1\n[[engagement]]\ntimes = [{times}]\nlaser = [0, 0, 9]\n\
         target = [0, 0, 0]\nobservers = [[0, 0, 9]]\n"
    );
    let sea = Scenario::new(&text);
    let expected = sea.run_with_instances("");
    assert!(expected[0].len() > 500_000, "well over what a pipe holds");
    let path = sea.path("late.csv");
    leave_early(command().arg("scenario").arg(sea.path("sea.toml")).arg("--instances-out").arg(&path));
    assert_eq!(fs::read_to_string(path).unwrap(), expected[1]);
}

#[test]
fn examples_run() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/engagements");
    let mut examples = 0;
    for file in fs::read_dir(folder).unwrap() {
        let text = succeed(&format!("scenario {} --instances 200", file.unwrap().path().display()), "");
        assert!(table(&text).len() > 5);
        assert!(floats(&text, "mean").iter().all(|f| f.is_finite() && *f >= 0.0));
        assert!(floats(&text, "max").iter().any(|f| *f > 0.01));
        examples += 1;
    }
    assert_eq!(examples, 3);
}

#[cfg(unix)]
#[test]
fn interrupted_leaves_neither_file() {
    use std::process::Command;
    use std::thread::sleep;
    use std::time::Duration;

    let endless = TWO.replace("instances = 60", "instances = 1000000\ncomponents = 65536");
    let sea = Scenario::new(&endless);
    let folder = tempfile::tempdir().unwrap();
    let names = || fs::read_dir(&folder).unwrap().map(|e| e.unwrap().file_name()).collect::<Vec<_>>();
    let mut child = command()
        .arg("scenario")
        .arg(sea.path("sea.toml"))
        .args(["--threads", "1", "--output"])
        .arg(folder.path().join("a.csv"))
        .arg("--instances-out")
        .arg(folder.path().join("b.csv"))
        .spawn()
        .unwrap();
    while names().len() < 2 {
        assert!(child.try_wait().unwrap().is_none(), "ended before it wrote");
        sleep(Duration::from_millis(1));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(names().is_empty(), "{:?}", names());
}
