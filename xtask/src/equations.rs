//! Where each equation of the report is: the index in ARCHITECTURE.md, from the comments of rust-core.

use crate::util;
use anyhow::{Context, Result, bail};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

const INDEX: &str = "ARCHITECTURE.md";
const SOURCE: &str = "rust-core/src";
const BEGIN: &str = "<!-- equations -->\n";
const END: &str = "<!-- equations end -->";
const LAST: usize = 91;
/// Equations that no comment names, and where they are.
const OF_THE_SURFACE: &str = "no comment of its own: the drawn surface, `docs/model.md`";
const ELSEWHERE: [(usize, &str); 6] = [
    (30, OF_THE_SURFACE),
    (32, OF_THE_SURFACE),
    (33, OF_THE_SURFACE),
    (34, OF_THE_SURFACE),
    (35, OF_THE_SURFACE),
    (36, OF_THE_SURFACE),
];

/// Writes the index, or only compares it with the committed one. A number that is mentioned nowhere is an error.
pub fn equations(check: bool) -> Result<()> {
    let mut sources = Vec::new();
    collect(&util::root().join(SOURCE), "rs", &mut sources)?;
    sources.sort();
    // These name ranges of what lies in other files.
    const LISTS: [&str; 3] = ["lib.rs", "mod.rs", "vocabulary.rs"];
    sources.retain(|path| LISTS.iter().all(|list| !path.ends_with(list)));
    // Of every equation its files, those first that mention it in their head or most often.
    let mut found: BTreeMap<usize, Vec<(bool, usize, String)>> = BTreeMap::new();
    for path in sources {
        let text =
            fs::read_to_string(&path).with_context(|| format!("cannot read {}", util::shown(&path)))?;
        let name = path.strip_prefix(util::root().join(SOURCE)).expect("lies there").display().to_string();
        let head: String = text.lines().take_while(|line| line.starts_with("//!")).collect();
        let in_head = mentioned(&head);
        let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
        for equation in text.lines().flat_map(mentioned) {
            *counts.entry(equation).or_default() += 1;
        }
        for (equation, count) in counts {
            let files = found.entry(equation).or_default();
            files.push((!in_head.contains(&equation), usize::MAX - count, name.clone()));
        }
    }
    let mut table = String::from("| Eq. | files |\n| --- | --- |\n");
    let mut missing = Vec::new();
    for equation in 1..=LAST {
        let files = match (found.get_mut(&equation), ELSEWHERE.iter().find(|(number, _)| *number == equation))
        {
            (Some(files), _) => {
                files.sort();
                files.iter().take(4).map(|(_, _, name)| format!("`{name}`")).collect::<Vec<_>>().join(", ")
            }
            (None, Some((_, where_to))) => (*where_to).into(),
            (None, None) => {
                missing.push(equation.to_string());
                continue;
            }
        };
        table += &format!("| {equation} | {files} |\n");
    }
    if !missing.is_empty() {
        bail!("no comment in {SOURCE} mentions Eqs. {}", missing.join(", "));
    }
    let path = util::root().join(INDEX);
    let text = fs::read_to_string(&path).with_context(|| format!("cannot read {INDEX}"))?;
    let (before, rest) = text.split_once(BEGIN).with_context(|| format!("{INDEX} has no {BEGIN}"))?;
    let (_, after) = rest.split_once(END).with_context(|| format!("{INDEX} has no {END}"))?;
    let current = format!("{before}{BEGIN}{table}{END}{after}");
    if current == text {
        println!("equations: {INDEX} is current");
        return Ok(());
    }
    if check {
        bail!("the index of {INDEX} is stale: run `cargo xtask equations`");
    }
    fs::write(&path, current).with_context(|| format!("cannot write {INDEX}"))?;
    println!("equations: {INDEX} is written");
    Ok(())
}

/// The files of the directory and all within it that end in this extension.
pub fn collect(directory: &Path, wanted: &str, files: &mut Vec<PathBuf>) -> Result<()> {
    for entry in fs::read_dir(directory).with_context(|| format!("cannot read {}", util::shown(directory)))? {
        let path = entry?.path();
        if path.is_dir() {
            collect(&path, wanted, files)?;
        } else if path.extension().is_some_and(|extension| extension == wanted) {
            files.push(path);
        }
    }
    Ok(())
}

/// The numbers in a text's "Eq. 8", "Eqs. 51, 53-55 and 60".
fn mentioned(text: &str) -> Vec<usize> {
    let mut numbers = Vec::new();
    for (place, word) in text.match_indices("Eq") {
        let Some(list) = ["Eqs. ", "Eq. "].iter().find_map(|start| text[place..].strip_prefix(start)) else {
            debug_assert_eq!(word, "Eq");
            continue;
        };
        let list = list.replace(" and ", ", ");
        let end = list.find(|c: char| !(c.is_ascii_digit() || ", -".contains(c))).unwrap_or(list.len());
        for part in list[..end].split(", ") {
            let mut ends = part.trim().trim_matches([',', '-']).split('-').map(str::trim);
            let first = ends.next().and_then(|n| n.parse::<usize>().ok());
            let last = ends.next().and_then(|n| n.parse().ok()).or(first);
            if let (Some(first), Some(last)) = (first, last) {
                numbers.extend(first..=last);
            }
        }
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::mentioned;

    #[test]
    fn lists_and_ranges() {
        assert_eq!(mentioned("by Eq. 8, where k is"), [8]);
        assert_eq!(mentioned("(Eqs. 51, 53-55); Eqs. 64 and 66."), [51, 53, 54, 55, 64, 66]);
        assert_eq!(mentioned("no Equation"), [0; 0]);
    }
}
