use crate::refuse;
use std::fs;

/// A good file; line 1 is empty.
const GOOD: &str = "
limits = [0.1, 1]

[model]
wind_speed = 5
instances = 10
components = 5

[[engagement]]
time = 0
laser = [0, 0, 9]
target = [5, 0, 0]
observers = [
    [0, 0, 9],
    [9, 0, 9],
]
";

const MOVING: &str = "
[[engagement]]
times = [0, 1]
laser = [[0, 0, 9], [1, 0, 9]]
target = [5, 0, 0]
observers = [[0, 0, 9], [[0, 0, 9], [1, 0, 9]]]
";

/// One line that names the line of the file and what is wrong there, and no file left behind.
#[track_caller]
fn refused(text: &[u8], flags: &str, place: &str, named: &str) {
    let folder = tempfile::tempdir().unwrap();
    let [file, out, instances] = ["sea.toml", "out.csv", "instances.csv"].map(|n| folder.path().join(n));
    fs::write(&file, text).unwrap();
    let message = refuse(
        &format!(
            "scenario {} {flags} --output {} --instances-out {}",
            file.display(),
            out.display(),
            instances.display()
        ),
        "",
    );
    let start = if place.is_empty() { String::new() } else { format!("{}:{place}: ", file.display()) };
    assert!(message.starts_with(&format!("prob-water: {start}")), "{place}: {message}");
    assert!(message.contains(named), "{message} does not name {named}");
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
}

/// The same without a table of instances.
#[track_caller]
fn refused_alone(text: &[u8], flags: &str, place: &str, named: &str) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("sea.toml");
    fs::write(&file, text).unwrap();
    let message = refuse(&format!("scenario {} {flags}", file.display()), "");
    assert!(message.starts_with(&format!("prob-water: {}:{place}: ", file.display())), "{place}: {message}");
    assert!(message.contains(named), "{message} does not name {named}");
}

/// A good file in which one text is replaced by another: the line, and what the message names.
#[track_caller]
fn replaced(good: &str, cases: &[(&str, &str, &str, &str)]) {
    for (old, new, line, named) in cases {
        assert!(good.contains(old), "{old}");
        refused(good.replacen(old, new, 1).as_bytes(), "", line, named);
    }
}

#[test]
fn engagements() {
    replaced(
        GOOD,
        &[
            ("target = [5, 0, 0]", "target = [5, 0, 9.1]", "12", "target = [5, 0, 9.1] is out of range"),
            ("target = [5, 0, 0]", "direction = [1, 0, 0]", "12", "direction = [1, 0, 0]"),
            ("target = [5, 0, 0]", "direction = [0, 0, 0]", "12", "a beam that points down"),
            ("target = [5, 0, 0]", "direction = [nan, 0, -1]", "12", "direction = [NaN, 0, -1]"),
            ("target = [5, 0, 0]", "target = [inf, 0, 0]", "12", "finite"),
            ("laser = [0, 0, 9]", "laser = [0, 0, 0]", "11", "laser = [0, 0, 0] is out of range"),
            ("laser = [0, 0, 9]", "laser = [0, 0, -1]", "11", "with z above 0"),
            ("laser = [0, 0, 9]", "laser = [0, 9]", "11", "laser = [0, 9] is not [x, y, z]"),
            ("laser = [0, 0, 9]", "laser = [0, 0, 9, 1]", "11", "is not [x, y, z]"),
            ("laser = [0, 0, 9]", "laser = 9", "11", "laser = 9 is not [x, y, z]"),
            ("laser = [0, 0, 9]", "laser = [0, 0, 'up']", "11", "laser = 'up' is not a number"),
            ("laser = [0, 0, 9]", "laser = [[0, 0, 9]]", "11", "that needs times"),
            ("laser = [0, 0, 9]\n", "", "9", "laser is missing"),
            ("[9, 0, 9]", "[9, 0, 0]", "13", "observers = [9, 0, 0] is out of range"),
            ("[9, 0, 9]", "[9, 0]", "15", "observers = [9, 0] is not [x, y, z]"),
            ("[9, 0, 9]", "9", "15", "observers = 9 is not [x, y, z]"),
            ("[9, 0, 9]", "[9,\n0, true]", "16", "observers = true is not a number"),
            ("    [0, 0, 9],\n    [9, 0, 9],\n", "", "13", "observers = none"),
            ("time = 0", "time = nan", "10", "time = NaN is out of range"),
            ("time = 0", "time = -inf", "10", "time = -inf"),
            ("time = 0", "time = 1e999", "10", "is not a number"),
            ("time = 0", "time = 1979-05-27", "10", "is not a number"),
            ("time = 0", "time = [0]", "10", "time = [0] is not a number"),
            ("time = 0", "tune = 0", "10", "unknown key tune: known are time, times, laser"),
            ("target = [5, 0, 0]", "target = [5, 0, 0]\ndirection = [0, 0, -1]", "13", "are both given"),
            ("target = [5, 0, 0]\n", "", "9", "target or direction is missing"),
            ("[[engagement]]", "[engagement]", "9", "[[engagement]]"),
        ],
    );
    let start = GOOD.find("observers").unwrap();
    refused(&GOOD.as_bytes()[..start], "", "9", "observers is missing");
    let start = GOOD.find("[[engagement]]").unwrap();
    refused(&GOOD.as_bytes()[..start], "", "1", "[[engagement]] is missing");
    // The second engagement's line, not the first one's.
    let second =
        format!("{GOOD}[[engagement]]\nlaser = [0, 0, -9]\ntarget = [0, 0, 0]\nobservers = [[0, 0, 9]]\n");
    refused(second.as_bytes(), "", "18", "laser = [0, 0, -9]");
    let second = format!("{GOOD}[[engagement]]\ntarget = [0, 0, 0]\n");
    refused(second.as_bytes(), "", "17", "laser is missing");
}

#[test]
fn beams() {
    replaced(
        GOOD,
        &[
            (
                "time = 0",
                "divergence = -1",
                "10",
                "divergence = -1 is out of range: allowed is 0 to 500 mrad",
            ),
            ("time = 0", "divergence = 'wide'", "10", "divergence = 'wide' is not a number"),
            ("time = 0", "divergence = 0", "10", "allowed is above 0 mrad where the aperture is 0"),
            (
                "time = 0",
                "divergence = 1\naperture = nan",
                "11",
                "aperture = NaN is out of range: allowed is 0 to 100 m",
            ),
            ("time = 0", "aperture = 0.1", "10", "aperture has no meaning without divergence"),
        ],
    );
    let beam = GOOD.replace("time = 0", "divergence = 2");
    let both = beam.replace("components = 5", "footprint = 0.2");
    let excluded = "footprint = 0.2 and divergence = 2 are both given: allowed is one of footprint, divergence (with aperture)";
    refused(both.as_bytes(), "", "7", excluded);
    // A flag is not the file's fault.
    refused(beam.as_bytes(), "--footprint 0.2", "", excluded);
    // What follows from a beam is the engagement's.
    let wide = beam.replace("divergence = 2", "divergence = 400");
    refused_alone(wide.as_bytes(), "--surface empirical", "9", "footprint = ");
}

#[test]
fn trajectories() {
    replaced(
        MOVING,
        &[
            ("times = [0, 1]", "times = [0, 1, 2]", "4", "laser lists 2 positions for 3 times"),
            ("[[0, 0, 9], [1, 0, 9]]\nt", "[0, 0, 9]\ntime = 1\nt", "3", "time and times are both given"),
            ("times = [0, 1]", "times = []", "3", "times is empty"),
            ("times = [0, 1]", "times = 1", "3", "times = 1 is not a list of times"),
            ("times = [0, 1]", "times = [0, inf]", "3", "time = inf is out of range"),
            ("times = [0, 1]", "times = [0, 'later']", "3", "times = 'later' is not a number"),
            ("target = [5, 0, 0]", "target = [[5, 0, 0]]", "5", "target lists 1 positions for 2 times"),
            ("[1, 0, 9]]]", "[1, 0, 9], [2, 0, 9]]]", "6", "observers lists 3 positions for 2 times"),
            ("[1, 0, 9]]\nt", "[1, 0, -9]]\nt", "4", "laser = [1, 0, -9]"),
            ("[1, 0, 9]]\nt", "[1, 0]]\nt", "4", "laser = [1, 0] is not [x, y, z]"),
        ],
    );
}

#[test]
fn models() {
    replaced(
        GOOD,
        &[
            ("instances = 10", "instances = 0", "6", "instances = 0 is out of range"),
            ("instances = 10", "instances = 2.5", "6", "instances = 2.5"),
            ("instances = 10", "instances = -1", "6", "instances = -1"),
            ("instances = 10", "instances = 1000000000", "6", "4 GiB"),
            ("instances = 10", "instances = 1e12", "6", "instances = 1000000000000"),
            ("instances = 10", "instances = 99999999999999999999", "6", "is not a number"),
            (
                "components = 5",
                "components = 0",
                "7",
                "components = 0 is out of range: allowed is 1 to 65536",
            ),
            ("components = 5", "components = 1000000", "7", "components = 1000000"),
            ("components = 5", "depth = 0", "7", "depth = 0 is out of range"),
            ("components = 5", "depth = -inf", "7", "depth = -inf"),
            ("components = 5", "fetch = -100", "7", "fetch = -100 is out of range"),
            ("components = 5", "fetch = nan", "7", "fetch = NaN"),
            ("components = 5", "time = inf", "7", "time = inf is out of range"),
            ("components = 5", "waves = 5", "7", "unknown key waves"),
            (
                "components = 5",
                "surface = 'flat'",
                "7",
                "surface = flat is not served here: allowed is instance",
            ),
            ("components = 5", "surface = 'wavy'", "7", "surface = wavy is unknown"),
            ("components = 5", "whitecaps = 1", "7", "whitecaps = 1 is not true or false"),
            ("components = 5", "beaufort = 3", "7", "wind_speed = 5 and beaufort = 3 are both given"),
            ("components = 5", "components = 5\ncomponents = 6", "8", "duplicate key"),
            ("wind_speed = 5", "wind_speed = 'fast'", "5", "wind_speed = fast is not a number"),
            ("wind_speed = 5", "wind_speed = [5]", "5", "wind_speed = [5] is not a number"),
            ("wind_speed = 5", "wind_speed = 37", "5", "wind_speed = 37 is out of range"),
            ("wind_speed = 5", "wind_height = 1\nbeaufort = 3", "5", "beaufort = 3 and wind_height = 1"),
            ("[model]\n", "[modle]\n", "4", "unknown key modle: known are model, engagement, limits"),
            ("[model]\n", "model = 5\n[x]\n", "4", "model = 5 is not a table"),
        ],
    );
    // The number of instances is the library's: the engagement is to blame.
    refused(GOOD.as_bytes(), "--instances 1000000000", "", "instances = 1000000000 is out of range");
    // What a flag says is not the file's fault.
    refused(GOOD.as_bytes(), "--depth -1", "", "depth = -1 is out of range");
    refused(GOOD.as_bytes(), "--surface flat", "", "surface = flat is not served here");
    refused(GOOD.as_bytes(), "--beaufort 3 --wind-speed 4", "", "are both given");
}

#[test]
fn settings() {
    replaced(
        GOOD,
        &[
            ("[0.1, 1]", "0.1", "2", "limits = 0.1 is not a list of numbers"),
            ("[0.1, 1]", "[0.1,\n-1]", "3", "limits: -1 is out of range"),
            ("[0.1, 1]", "[0.1, inf]", "2", "limits: inf is out of range"),
            ("[0.1, 1]", "[0.1, nan]", "2", "limits: NaN is out of range"),
            ("[0.1, 1]", "[0.1, 1, 0.10]", "2", "limits: 0.1 is there twice"),
            ("[0.1, 1]", "[0.1, '1']", "2", "limits = '1' is not a number"),
            ("components = 5", "limits = [1]", "7", "limits is given twice"),
            (
                "limits = [0.1, 1]",
                "statistics = 'all'",
                "2",
                "statistics = all is unknown: allowed is draws, exact, auto",
            ),
            ("limits = [0.1, 1]", "statistics = true", "2", "statistics = true is not a word"),
            ("limits = [0.1, 1]", "draws = 'even'", "2", "allowed is auto, random, sobol, slopes"),
            ("limits = [0.1, 1]", "whitecap_presence = 'no'", "2", "allowed is drawn, expected"),
            (
                "limits = [0.1, 1]",
                "statistics = 'exact'\ndraws = 'sobol'",
                "3",
                "draws = sobol has no meaning",
            ),
            (
                "limits = [0.1, 1]",
                "whitecap_presence = 'expected'\nstatistics = 'exact'",
                "2",
                "whitecap_presence = expected has no meaning with statistics = exact",
            ),
            (
                "limits = [0.1, 1]",
                "spot = 'square'",
                "2",
                "spot = square is unknown: allowed is circle, ellipse",
            ),
            ("limits = [0.1, 1]", "spot_normal = 'all'", "2", "allowed is hit, mean"),
            (
                "limits = [0.1, 1]",
                "statistics = 'exact'\nspot_normal = 'mean'",
                "3",
                "spot_normal = mean has no meaning with statistics = exact",
            ),
            (
                "limits = [0.1, 1]",
                "spot_normal = 'mean'\nstatistics = 'auto'",
                "2",
                "spot_normal = mean has no meaning with statistics = auto",
            ),
            (
                "limits = [0.1, 1]\n\n[model]",
                "spot_normal = 'mean'\n\n[model]\nfootprint = inf",
                "5",
                "footprint = inf is out of range: allowed is finite, for a mean over the spot",
            ),
            ("time = 0", "limits = [1]", "10", "unknown key limits"),
        ],
    );
    let slopes = format!("draws = 'slopes'{GOOD}");
    refused(slopes.as_bytes(), "--components 3", "", "components = 3 is out of range: allowed is at least 4");
    let auto = format!("statistics = 'auto'{GOOD}");
    refused(auto.as_bytes(), "", "", "--instances-out has no meaning with statistics = auto");
    let exact = format!("statistics = 'exact'{GOOD}");
    refused(exact.as_bytes(), "", "", "--instances-out has no meaning with statistics = exact");
}

#[test]
fn syntax() {
    replaced(
        GOOD,
        &[
            ("time = 0", "time = ", "10", ""),
            ("time = 0", "time 0", "10", ""),
            ("[model]", "[model", "4", "unclosed table"),
        ],
    );
    refused(b"\n\na = '\xff'\n", "", "3", "not UTF-8");
    refused(b"", "", "1", "[[engagement]] is missing");
}

#[test]
fn one_file_for_two_tables() {
    let folder = tempfile::tempdir().unwrap();
    let [file, out] = ["sea.toml", "out.csv"].map(|name| folder.path().join(name));
    fs::write(&file, GOOD).unwrap();
    for flags in [
        "--instances-out -".to_owned(),
        format!("--output {} --instances-out {}/./out.csv", out.display(), folder.path().display()),
    ] {
        let message = refuse(&format!("scenario {} {flags}", file.display()), "");
        assert!(message.contains("--output and --instances-out are the same"), "{message}");
    }
    let message = refuse(
        &format!(
            "scenario {} --output {} --instances-out no/such/folder/a.csv",
            file.display(),
            out.display()
        ),
        "",
    );
    assert!(message.contains("no/such/folder/a.csv"), "{message}");
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
}
