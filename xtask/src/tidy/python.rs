//! The order of validation's folders, from the table in the head of its `__init__.py`, and no circles among its files.

use super::{File, in_circles};

/// Where Python is.
pub const FOLDER: &str = "validation";

/// Uses of a folder that stands below, of a test and in a circle, and files in no folder of the table.
pub fn faults(files: &[File]) -> Vec<String> {
    let row = |line: &str| Some(line.strip_prefix("| `")?.split_once('`')?.0.to_string());
    let head = files.iter().find(|file| file.path == "__init__.py").map_or("", |file| &file.text);
    let folders: Vec<String> = head.lines().filter_map(row).collect();
    let mut faults = Vec::new();
    let mut uses = Vec::new();
    for file in files.iter().filter(|file| file.path != "__init__.py") {
        let own = file.path.split('/').next().unwrap_or("");
        let Some(rank) = folders.iter().position(|known| known == own) else {
            faults.push(format!("{FOLDER}/{}:1: not in a folder of {FOLDER}/__init__.py's table", file.path));
            continue;
        };
        for (line, used) in imports(&file.text, files) {
            let place = format!("{FOLDER}/{}:{line}", file.path);
            let folder = used.split('/').next().unwrap_or("");
            match folders.iter().position(|known| known == folder) {
                Some(below) if below > rank => {
                    faults.push(format!("{place}: uses `{folder}`, which stands below `{own}`"));
                }
                Some(_) if Some(folder) == folders.last().map(String::as_str) => {
                    faults.push(format!("{place}: uses the test {used}"));
                }
                Some(_) => uses.push((file.path.as_str(), line, used)),
                None => faults.push(format!("{place}: no file of a folder of {FOLDER}")),
            }
        }
    }
    faults.extend(in_circles(FOLDER, &uses));
    faults
}

/// The lines on which a module, or code within it that it starts, imports from validation, and the files that it names.
fn imports(text: &str, files: &[File]) -> Vec<(usize, String)> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    for (number, line) in lines.iter().enumerate() {
        let line = line.trim_start();
        let Some(rest) = ["from ", "import "].iter().find_map(|word| line.strip_prefix(word)) else {
            continue;
        };
        let (module, names) = rest.split_once(" import ").unwrap_or((rest, ""));
        let module = module.split_whitespace().next().unwrap_or("");
        let inner = module.strip_prefix(FOLDER).filter(|inner| inner.is_empty() || inner.starts_with('.'));
        match inner.map(|inner| inner.trim_start_matches('.').replace('.', "/")) {
            Some(path) if files.iter().any(|file| file.path == format!("{path}.py")) => {
                found.push((number + 1, format!("{path}.py")));
            }
            Some(path) => {
                let all = if names.starts_with('(') { lines[number..].join(" ") } else { names.to_string() };
                let list = all.split_once('(').map_or(all.as_str(), |(_, list)| list);
                for name in list.split(')').next().unwrap_or("").split(',') {
                    let name = name.split_whitespace().next().unwrap_or("");
                    found.push((number + 1, format!("{path}/{name}.py")));
                }
            }
            None if module.starts_with('.') => found.push((number + 1, module.to_string())),
            None => {}
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn imports_follow_the_table() {
        let head = ("__init__.py", "| `support` | a |\n| `bench` | b |\n| `tests` | c |");
        let found = |files: &[(&str, &str)]| {
            let file = |(path, text): &(&str, &str)| File { path: path.to_string(), text: text.to_string() };
            faults(&[head].iter().chain(files).map(file).collect::<Vec<_>>())
        };
        let [a, b] =
            [("bench/a.py", "\nfrom validation.bench.b import X"), ("bench/b.py", "import numpy as np")];
        let allowed = "from validation.bench import (a,\n    b as other)\nfrom validationary.bench import x";
        assert_eq!(found(&[a, b, ("tests/test_a.py", allowed)]), [""; 0]);
        for import in [
            "from validation.bench import (x,\n  a)",
            "    from validation.bench.a import X",
            "import validation.bench.a",
        ] {
            let below = "validation/support/c.py:2: uses `bench`, which stands below `support`";
            assert!(
                found(&[a, b, ("support/c.py", &format!("\n{import}\n"))]).contains(&below.into()),
                "{import}"
            );
        }
        let circle = "validation/bench/a.py:2: a circle: bench/b.py leads back here";
        assert_eq!(found(&[a, ("bench/b.py", "def f():\n    from validation.bench import a")])[0], circle);
        let test =
            found(&[("tests/test_a.py", "from validation.tests.test_b import x"), ("tests/test_b.py", "")]);
        assert_eq!(test, ["validation/tests/test_a.py:1: uses the test tests/test_b.py"]);
        assert!(
            found(&[("bench/a.py", "from . import b")])[0].ends_with(":1: no file of a folder of validation")
        );
        assert!(found(&[("other/a.py", "")])[0].contains("other/a.py:1: not in a folder of"));
    }
}
