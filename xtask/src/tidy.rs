//! What the source of this project keeps to and no compiler checks: the order of rust-core's modules and of validation's
//! folders, no circles within one, no long file without a reason, no public item without a comment.
//!
//! Lines are read, not syntax: comments, literals and tests are blanked first, and paths are found by `crate::` and
//! `super::`. That is enough for source as `cargo fmt` leaves it.

mod python;

use crate::{equations, util};
use anyhow::{Context, Result, bail};
use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

const SOURCE: &str = "rust-core/src";
const LONGEST: usize = 500;

/// Files of more than [`LONGEST`] lines, and why each is one file.
const LONG: [(&str, &str); 5] = [
    ("rust-core/src/api/c_api.rs", "the C interface: its header is written from this one file"),
    ("rust-core/src/brdf/lobe.rs", "the closed form in one piece: facets, whitecaps and their mixture"),
    ("rust-core/src/config/vocabulary.rs", "the one list of parameters, and tests of every row beside it"),
    ("rust-core/src/empirical/table.rs", "making and reading a table share the order of its axes"),
    (
        "rust-core/tests/model/empirical.rs",
        "tests of one model, which share their seas and what they compare with",
    ),
];

/// Uses that close a circle within a module: who uses whom, and why it stays.
const CIRCLES: [(&str, &str, &str); 1] = [(
    "simd/real.rs",
    "simd/double_float.rs",
    "`Real::Extended` of lanes is a pair of lanes: each type is made of the other",
)];

/// A file of rust-core's source or of validation, by its path from there.
struct File {
    path: String,
    text: String,
}

/// Prints every fault as `path:line: what`, and fails if there is one.
pub fn tidy() -> Result<()> {
    let faults = in_tree()?;
    for fault in &faults {
        println!("{fault}");
    }
    if !faults.is_empty() {
        bail!("{} {}", faults.len(), if faults.len() == 1 { "fault" } else { "faults" });
    }
    println!("tidy: no fault");
    Ok(())
}

fn in_tree() -> Result<Vec<String>> {
    let root = util::root();
    let mut faults = in_source(&read(SOURCE, "rs")?, &CIRCLES);
    faults.extend(python::faults(&read(python::FOLDER, "py")?));
    // An unpacked archive does not say which of its files are the project's.
    if root.join(".git").exists() {
        let tracked = util::output(util::command("git").arg("ls-files"), "git ls-files")?;
        let mut lengths = Vec::new();
        for path in
            tracked.lines().filter(|path| [".rs", ".h", ".cpp", ".py"].iter().any(|e| path.ends_with(e)))
        {
            if let Ok(text) = fs::read_to_string(root.join(path)) {
                lengths.push((path.to_string(), text.lines().count()));
            }
        }
        faults.extend(too_long(&lengths, &LONG));
    }
    Ok(faults)
}

/// The files below a directory of the root, in the order of their paths.
fn read(directory: &str, extension: &str) -> Result<Vec<File>> {
    let directory = util::root().join(directory);
    let mut paths = Vec::new();
    equations::collect(&directory, extension, &mut paths)?;
    paths.sort();
    let file = |path: PathBuf| {
        let text =
            fs::read_to_string(&path).with_context(|| format!("cannot read {}", util::shown(&path)))?;
        Ok(File { path: path.strip_prefix(&directory).expect("lies there").display().to_string(), text })
    };
    paths.into_iter().map(file).collect()
}

fn too_long(lengths: &[(String, usize)], reasons: &[(&str, &str)]) -> Vec<String> {
    let mut faults = Vec::new();
    for (path, lines) in lengths {
        if *lines > LONGEST && !reasons.iter().any(|(known, _)| known == path) {
            faults.push(format!("{path}:{lines}: over {LONGEST} lines, and tidy.rs has no reason for it"));
        }
    }
    for (known, _) in reasons {
        if !lengths.iter().any(|(path, lines)| path == known && *lines > LONGEST) {
            faults.push(format!("{known}:1: not over {LONGEST} lines: strike it from tidy.rs"));
        }
    }
    faults
}

fn in_source(files: &[File], circles: &[(&str, &str, &str)]) -> Vec<String> {
    let modules =
        files.iter().find(|file| file.path == "lib.rs").map_or(Vec::new(), |file| modules(&file.text));
    let mut faults = Vec::new();
    // Of each use of a file by another in its module: user, line, used.
    let mut uses: Vec<(&str, usize, String)> = Vec::new();
    for file in files {
        let code = code(&file.text);
        faults.extend(undocumented(file, &code, files));
        if file.path == "lib.rs" {
            continue;
        }
        let (module, name) = file.path.split_once('/').unwrap_or(("", &file.path));
        let rank = modules.iter().position(|known| known == module);
        if (rank.is_none() && !module.is_empty()) || name.contains('/') {
            faults.push(format!("{SOURCE}/{}:1: not in a module of lib.rs's table", file.path));
        }
        for (line, target) in targets(&code, module, name, &modules) {
            let (first, rest) = target.split_once("::").unwrap_or((&target, ""));
            let place = format!("{SOURCE}/{}:{line}", file.path);
            match modules.iter().position(|known| known == first) {
                // What lies outside of the modules stands above all of them.
                Some(used) if rank.is_none_or(|own| used > own) => {
                    let own = if module.is_empty() { name } else { module };
                    faults.push(format!("{place}: uses module `{first}`, which stands below `{own}`"));
                }
                Some(_) => {}
                None if files.iter().any(|file| file.path == format!("{first}.rs")) => {}
                None => faults.push(format!("{place}: `crate::{first}` is the facade: name its module")),
            }
            let used = format!("{module}/{}.rs", rest.split("::").next().unwrap_or(""));
            let is_file = files.iter().any(|file| file.path == used);
            if first == module && name != "mod.rs" && used != file.path && is_file {
                uses.push((&file.path, line, used));
            }
        }
    }
    for (user, used, _) in circles {
        if !uses.iter().any(|(from, _, to)| from == user && to == used) {
            faults.push(format!("{SOURCE}/{user}:1: does not use {used}: strike it from tidy.rs"));
        }
    }
    uses.dedup();
    uses.retain(|(from, _, to)| !circles.iter().any(|(user, used, _)| from == user && to == used));
    faults.extend(in_circles(SOURCE, &uses));
    faults
}

/// Uses (user, line, used) that close a circle.
fn in_circles(directory: &str, uses: &[(&str, usize, String)]) -> Vec<String> {
    let mut faults = Vec::new();
    for (user, line, used) in uses {
        let mut reached = BTreeSet::from([used.as_str()]);
        while let Some((_, _, next)) =
            uses.iter().find(|(from, _, to)| reached.contains(from) && !reached.contains(to.as_str()))
        {
            reached.insert(next);
        }
        if reached.contains(user) {
            faults.push(format!("{directory}/{user}:{line}: a circle: {used} leads back here"));
        }
    }
    faults
}

/// The modules in their order, from the table in the head of lib.rs.
fn modules(lib: &str) -> Vec<String> {
    let row = |line: &str| Some(line.strip_prefix("//! | [`")?.split_once("`]")?.0.to_string());
    lib.lines().filter_map(row).collect()
}

/// The lines on which code names something of the crate, and its path from there. In a module within a file `super::` is
/// that file; it is taken for the module all the same.
fn targets(code: &str, module: &str, name: &str, modules: &[String]) -> Vec<(usize, String)> {
    let mut targets = Vec::new();
    for root in ["crate::", "super::"] {
        for (at, _) in code.match_indices(root) {
            if code[..at].ends_with(|c: char| c.is_alphanumeric() || "_:".contains(c)) {
                continue;
            }
            let mut paths = Vec::new();
            expand(&code[at + root.len()..], "", &mut paths);
            let line = 1 + code[..at].matches('\n').count();
            for path in paths {
                let inner = path.strip_prefix("super::").unwrap_or(&path);
                let to_a_module = modules.iter().any(|module| inner.split("::").next() == Some(module));
                if root == "crate::" {
                    targets.push((line, path));
                } else if to_a_module && (inner.len() < path.len() || name == "mod.rs") {
                    targets.push((line, inner.into()));
                } else if !module.is_empty() {
                    targets.push((line, format!("{module}::{inner}")));
                }
            }
        }
    }
    targets
}

/// The paths that a text begins with: one, or each of a `{list}`.
fn expand(text: &str, before: &str, paths: &mut Vec<String>) {
    let text = text.trim_start();
    if let Some(list) = text.strip_prefix('{') {
        let (mut depth, mut start) = (0, 0);
        for (at, c) in list.char_indices() {
            if depth == 0 && (c == ',' || c == '}') {
                if !list[start..at].trim().is_empty() {
                    expand(&list[start..at], before, paths);
                }
                start = at + 1;
            }
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => return,
                '}' => depth -= 1,
                _ => {}
            }
        }
        return;
    }
    let end = text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len());
    let path = format!("{before}{}", &text[..end]);
    match text[end..].strip_prefix("::") {
        Some(rest) => expand(rest, &format!("{path}::"), paths),
        None => paths.push(path),
    }
}

/// Public items and fields without a comment.
fn undocumented(file: &File, code: &str, files: &[File]) -> Vec<String> {
    let mut faults = Vec::new();
    let mut documented = false;
    // Brackets that an attribute has open.
    let mut open = 0;
    for (number, (line, code)) in file.text.lines().zip(code.lines()).enumerate() {
        let (line, code) = (line.trim(), code.trim());
        documented |= line.starts_with("///") || line.starts_with("#[doc");
        if open > 0 || code.starts_with("#[") {
            open += code.matches('[').count();
            open -= code.matches(']').count();
        } else if !line.is_empty() && !line.starts_with("//") {
            let module = code.strip_prefix("pub mod ").and_then(|rest| rest.strip_suffix(';'));
            let has_head = module.is_some_and(|module| {
                let folder =
                    file.path.rsplit_once('/').map_or(String::new(), |(module, _)| format!("{module}/"));
                let paths = [format!("{folder}{module}.rs"), format!("{folder}{module}/mod.rs")];
                files.iter().any(|file| paths.contains(&file.path) && file.text.starts_with("//!"))
            });
            let public = code.starts_with("pub ") && !code.starts_with("pub use ");
            if public && !documented && !has_head {
                faults.push(format!("{SOURCE}/{}:{}: no comment: `{line}`", file.path, number + 1));
            }
            documented = false;
        }
    }
    faults
}

/// A source without its comments, literals and tests, line for line.
fn code(text: &str) -> String {
    let mut code = String::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let length = not_code(rest, code.chars().next_back());
        if length > 0 {
            code += &blank(&rest[..length]);
            rest = &rest[length..];
        } else {
            code.push(c);
            rest = &rest[c.len_utf8()..];
        }
    }
    while let Some(start) = code.find("#[cfg(test)]") {
        let mut depth = 0;
        let end = code[start..].char_indices().find(|(_, c)| {
            depth += i32::from("([{".contains(*c)) - i32::from(")]}".contains(*c));
            depth == 0 && ";}".contains(*c)
        });
        let end = end.map_or(code.len(), |(length, _)| start + length + 1);
        let blanked = blank(&code[start..end]);
        code.replace_range(start..end, &blanked);
    }
    code
}

fn blank(text: &str) -> String {
    text.chars().map(|c| if c == '\n' { '\n' } else { ' ' }).collect()
}

/// The length of the comment or literal that a text begins with, or 0; `before` is what stands before it.
fn not_code(text: &str, before: Option<char>) -> usize {
    let until = |start: usize, end: &str| {
        text[start..].find(end).map_or(text.len(), |length| start + length + end.len())
    };
    let quoted = |quote: char| {
        let mut escaped = false;
        let end = text.char_indices().skip(1).find(|(_, c)| {
            let ends = *c == quote && !escaped;
            escaped = *c == '\\' && !escaped;
            ends
        });
        end.map_or(text.len(), |(length, _)| length + 1)
    };
    let mut next = text.chars().skip(1);
    match text.chars().next() {
        Some('/') if text.starts_with("//") => text.find('\n').unwrap_or(text.len()),
        Some('/') if text.starts_with("/*") => until(2, "*/"),
        Some('"') => quoted('"'),
        // A character, not a lifetime.
        Some('\'') if text.starts_with("'\\") => quoted('\''),
        Some('\'') if next.nth(1) == Some('\'') => quoted('\''),
        Some('r') if !before.is_some_and(|c| c.is_alphanumeric() && c != 'b' || c == '_') => {
            let hashes = text[1..].chars().take_while(|c| *c == '#').count();
            if text[1 + hashes..].starts_with('"') {
                until(hashes + 2, &format!("\"{}", "#".repeat(hashes)))
            } else {
                0
            }
        }
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIB: &str =
        "//! | [`low`] | a | |\n//! | [`high`] | b | |\n/// C.\npub mod low;\n/// D.\npub mod high;\n";

    /// The faults of a crate of the two modules above and these files.
    fn faults(files: &[(&str, &str)]) -> Vec<String> {
        let file = |(path, text): &(&str, &str)| File { path: path.to_string(), text: text.to_string() };
        let files: Vec<File> = [("lib.rs", LIB), ("error.rs", "")].iter().chain(files).map(file).collect();
        in_source(&files, &[])
    }

    #[test]
    fn imports_follow_the_table() {
        let below = "rust-core/src/low/a.rs:2: uses module `high`, which stands below `low`";
        for import in ["use crate::high::X;", "use crate::{error::E, high};", "use super::super::high::X;"] {
            assert_eq!(faults(&[("low/a.rs", &format!("\n{import}\n"))]), [below], "{import}");
        }
        assert_eq!(faults(&[("low/a.rs", "\nfn f() { crate::high::f('\"') }")]), [below]);
        assert_eq!(faults(&[("low/mod.rs", "use super::high::X;")]).len(), 1);
        assert_eq!(faults(&[("error.rs", "use crate::low::X;")]).len(), 1);
        assert_eq!(
            faults(&[("other/mod.rs", "")]),
            ["rust-core/src/other/mod.rs:1: not in a module of lib.rs's table"]
        );
        assert!(faults(&[("high/a.rs", "use crate::Lobe;")])[0].contains(":1: `crate::Lobe` is the facade"));
        let allowed =
            "use crate::{error::Error, low::{self, X}};\n// crate::high\nconst A: &str = \"crate::high\";\n";
        let test = "#[cfg(test)]\nmod tests {\n    use crate::high::X;\n}\n";
        assert_eq!(faults(&[("low/a.rs", &format!("{allowed}{test}"))]), [""; 0]);
    }

    #[test]
    fn circles() {
        let [a, b] = [("low/a.rs", "use super::b::B;"), ("low/b.rs", "\nuse crate::low::{c::C, D};")];
        let found = faults(&[a, b, ("low/c.rs", "use super::{\n    a::A,\n};")]);
        assert_eq!(found.len(), 3);
        assert_eq!(found[1], "rust-core/src/low/b.rs:2: a circle: low/c.rs leads back here");
        assert_eq!(
            faults(&[a, b, ("low/c.rs", "use super::A;"), ("low/mod.rs", "use self::a::A;")]),
            [""; 0]
        );
    }

    #[test]
    fn circles_with_a_reason() {
        let files = [("lib.rs", LIB), ("low/a.rs", "use super::b;"), ("low/b.rs", "use super::a;")]
            .map(|(path, text)| File { path: path.into(), text: text.into() });
        let found = |circle| in_source(&files, &[circle]);
        assert_eq!(found(("low/a.rs", "low/b.rs", "why")), [""; 0]);
        let stale = "rust-core/src/low/b.rs:1: does not use low/c.rs: strike it from tidy.rs";
        assert!(found(("low/b.rs", "low/c.rs", "why")).contains(&stale.to_string()));
    }

    #[test]
    fn long_files() {
        let lengths = [("a.rs".to_string(), 501), ("b.py".to_string(), 500)];
        assert_eq!(too_long(&lengths, &[("a.rs", "one")]), [""; 0]);
        let found = too_long(&lengths, &[("b.py", "none")]);
        assert!(found[0].starts_with("a.rs:501: over 500") && found[1].starts_with("b.py:1: not over 500"));
    }

    #[test]
    fn public_items_have_comments() {
        for item in
            ["pub fn f() {}", "pub struct S;", "pub const C: f64 = 1.0;", "    pub field: f64,", "pub mod x;"]
        {
            let found = faults(&[("low/a.rs", &format!("// No doc.\n#[a(\n    b,\n)]\n{item}\n"))]);
            assert_eq!(found, [format!("rust-core/src/low/a.rs:5: no comment: `{}`", item.trim())]);
            let text = format!("/// Doc.\n#[a(\n    b,\n)]\n{item}\npub(crate) fn g() {{}}\npub use x;\n");
            assert_eq!(faults(&[("low/a.rs", &text)]), [""; 0]);
        }
        let after = "#[cfg(test)]\nmod tests {\n    /// Doc.\n    pub fn f() {}\n}\npub fn g() {}\n";
        assert_eq!(faults(&[("low/a.rs", after)]), ["rust-core/src/low/a.rs:6: no comment: `pub fn g() {}`"]);
        assert_eq!(faults(&[("low/mod.rs", "pub mod a;"), ("low/a.rs", "//! Head.")]), [""; 0]);
    }

    #[test]
    fn the_tree_has_none() {
        assert_eq!(in_tree().unwrap(), [""; 0]);
    }
}
