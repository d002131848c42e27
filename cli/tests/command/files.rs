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
    // Onto its own input, which has been read by then.
    succeed(&format!("brdf {} --output {}", from.display(), from.display()), "");
    assert_eq!(fs::read(&from).unwrap(), fs::read(&to).unwrap());
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
