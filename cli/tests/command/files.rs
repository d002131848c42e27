use crate::{command, leave_early, refuse, succeed};
use std::fmt::Write;
use std::fs;

const GOOD: &str = "ix,iy,iz,ox,oy,oz\n0,0,1,0,0,1\n";
const BAD: &str = "ix,iy,iz,ox,oy,oz\n0,0,1,0,0,1\n0,0,1,0,0,2\n";

fn names(folder: &tempfile::TempDir) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn many_rows(rows: usize) -> String {
    let mut text = String::from("ix,iy,iz,ox,oy,oz\n");
    for row in 0..rows {
        let (y, x) = (row as f64).sin_cos();
        writeln!(text, "{},{},0.8,{},{},0.6", 0.6 * x, 0.6 * y, 0.8 * y, 0.8 * x).unwrap();
    }
    text
}

#[test]
fn from_file_to_file() {
    let folder = tempfile::tempdir().unwrap();
    let [from, to] = ["in.csv", "out.csv"].map(|name| folder.path().join(name));
    fs::write(&from, GOOD).unwrap();
    let arguments = format!("brdf {} --output {}", from.display(), to.display());
    assert_eq!(succeed(&arguments, ""), "");
    assert_eq!(fs::read_to_string(&to).unwrap(), succeed("brdf", GOOD));
    assert_eq!(names(&folder), ["in.csv", "out.csv"]);
}

/// An output that is read as well is refused, whatever reads it and by whatever name, before anything is written.
#[test]
fn an_input_is_no_output() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let sea = "[model]\nwind_speed = 5\n";
    let scenario =
        format!("{sea}[[engagement]]\nlaser = [0, 0, 9]\ntarget = [0, 0, 0]\nobservers = [[0, 0, 9]]\n");
    let tabled = format!("table = 'table.npz'\n{}", sea.replace("[model]", "surface = 'empirical'"));
    let table = prob_water::Table::standard().to_bytes();
    let files: [(&str, &[u8]); 6] = [
        ("rows.csv", GOOD.as_bytes()),
        ("points.csv", b"x,y\n0,0\n"),
        ("sea.toml", sea.as_bytes()),
        ("tabled.toml", tabled.as_bytes()),
        ("scenario.toml", scenario.as_bytes()),
        ("table.npz", &table),
    ];
    for (name, bytes) in files {
        fs::write(path(name), bytes).unwrap();
    }
    for (arguments, read) in [
        ("brdf rows.csv", "rows.csv"),
        ("brdf rows.csv --from sea.toml", "sea.toml"),
        ("brdf rows.csv --from tabled.toml", "table.npz"),
        ("brdf rows.csv --surface empirical --table table.npz", "table.npz"),
        ("surface --points points.csv", "points.csv"),
        ("surface --bounds --from sea.toml", "sea.toml"),
        ("spectrum --from sea.toml", "sea.toml"),
        ("wind --from sea.toml", "sea.toml"),
        ("scenario scenario.toml --instances 2", "scenario.toml"),
        ("scenario scenario.toml --surface empirical --table table.npz", "table.npz"),
        ("table show table.npz", "table.npz"),
        ("table show table.npz --incidence 30 --angles 0:60:3 --from sea.toml", "sea.toml"),
    ] {
        let words = arguments.split(' ').map(|word| {
            if files.iter().any(|(name, _)| *name == word) { path(word) } else { word.to_owned() }
        });
        let arguments = words.collect::<Vec<_>>().join(" ");
        let other = |name: &str| format!("{arguments} --output {}", path(name));
        let message = refuse(&other(read), "");
        let expected = format!("--output = {0} is also read, as {0}: allowed is another file", path(read));
        assert!(message.contains(&expected), "{message}");
        // Through links as well.
        fs::hard_link(path(read), path("hard")).unwrap();
        assert!(refuse(&other("hard"), "").contains("is also read, as"));
        fs::remove_file(path("hard")).unwrap();
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(path(read), path("soft")).unwrap();
            assert!(refuse(&other("soft"), "").contains("is also read, as"));
            fs::remove_file(path("soft")).unwrap();
        }
        for (name, bytes) in files {
            assert!(fs::read(path(name)).unwrap() == bytes, "{arguments}: {name}");
        }
        assert!(names(&folder).len() == files.len());
        // Another file it is.
        succeed(&other("other"), "");
        fs::remove_file(path("other")).unwrap();
    }
    let other = "--output /dev/null --instances-out";
    let message = refuse(&format!("scenario {0} {other} {0}", path("scenario.toml")), "");
    assert!(message.contains("--instances-out = "), "{message}");
    // Standard input is a file by another name.
    let rows = fs::File::open(path("rows.csv")).unwrap();
    let mut redirected = command();
    redirected.args(["brdf", "--output", &path("rows.csv")]).stdin(rows);
    let output = redirected.output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("is also read, as standard input"));
    assert_eq!(fs::read(path("rows.csv")).unwrap(), GOOD.as_bytes());
}

#[test]
fn an_error_leaves_files_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.csv");
    for arguments in ["brdf", "brdf --ior 0.9", "wind --ior 0.9"] {
        let arguments = format!("{arguments} --output {}", path.display());
        refuse(&arguments, BAD);
        assert!(names(&folder).is_empty());
        fs::write(&path, "precious").unwrap();
        refuse(&arguments, BAD);
        assert_eq!(fs::read_to_string(&path).unwrap(), "precious");
        assert_eq!(names(&folder), ["out.csv"]);
        fs::remove_file(&path).unwrap();
    }
}

#[test]
fn a_reader_may_leave_early() {
    for arguments in ["brdf", "brdf --json"] {
        let folder = tempfile::tempdir().unwrap();
        let input = folder.path().join("in.csv");
        fs::write(&input, many_rows(20_000)).unwrap(); // well over what a pipe holds
        leave_early(command().args(arguments.split_whitespace()).arg(&input));
    }
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::os::unix::fs::{PermissionsExt, symlink};
    use std::process::Command;
    use std::thread::sleep;
    use std::time::Duration;

    #[test]
    fn interrupted_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let input = many_rows(300_000);
        let source = tempfile::NamedTempFile::new().unwrap();
        fs::write(&source, &input).unwrap();
        let out = folder.path().join("out.csv");
        let mut child = command().arg("brdf").arg(source.path()).arg("--output").arg(&out).spawn().unwrap();
        while names(&folder).is_empty() {
            assert!(child.try_wait().unwrap().is_none(), "ended before it wrote");
            sleep(Duration::from_millis(1));
        }
        assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(130));
        assert!(names(&folder).is_empty(), "{:?}", names(&folder));
    }

    #[test]
    fn permissions_and_links_stay() {
        let folder = tempfile::tempdir().unwrap();
        let [file, link] = ["file.csv", "link.csv"].map(|name| folder.path().join(name));
        fs::write(&file, "old").unwrap();
        fs::set_permissions(&file, PermissionsExt::from_mode(0o640)).unwrap();
        symlink(&file, &link).unwrap();
        succeed(&format!("wind --output {}", link.display()), "");
        assert!(link.is_symlink());
        assert_eq!(fs::read_to_string(&file).unwrap(), succeed("wind", ""));
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
        assert_eq!(succeed("wind --output /dev/null", ""), "");
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }
}
