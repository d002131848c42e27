//! Every example of the guide, with the output it shows. `render.exr`, which some read, shows a flat sea in a Beaufort 4.

use crate::from::{image, text};
use prob_water::{Parameters, Wind};
use std::path::Path;
use std::process::Command;

#[test]
fn examples_give_what_they_show() {
    let guide = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/guide-command.md");
    let guide = std::fs::read_to_string(guide).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let sea = Parameters { wind: Wind::Beaufort(4), wind_direction: -30.0, ..Default::default() };
    image(&folder.path().join("render.exr"), &[("prob_water", text(&sea.configure().unwrap().to_string()))]);
    let binaries = Path::new(env!("CARGO_BIN_EXE_prob-water")).parent().unwrap().display();
    let path = format!("{binaries}:{}", std::env::var("PATH").unwrap());
    let mut examples = 0;
    for block in guide.split("```console\n").skip(1) {
        let (block, _) = block.split_once("```").unwrap();
        for example in block.split("$ ").skip(1) {
            let (line, shown) = example.split_once('\n').unwrap();
            let output = Command::new("sh")
                .args(["-c", &format!("{line} 2>&1")])
                .current_dir(&folder)
                .env("PATH", &path)
                .output()
                .unwrap();
            let found = String::from_utf8(output.stdout).unwrap();
            assert!(alike(&found, shown), "{line}\n{found}");
            examples += 1;
        }
    }
    assert!(examples > 5);
}

/// The same text, but for the last digits, which depend on the platform's logarithm: those of float32, as tables have them.
fn alike(found: &str, shown: &str) -> bool {
    let [found, shown] = [found, shown].map(|text| text.split_inclusive([',', '\n']).collect::<Vec<_>>());
    found.len() == shown.len()
        && found.iter().zip(shown).all(|(found, shown)| {
            let number = |text: &str| text.trim_end_matches([',', '\n']).parse::<f64>();
            match (number(found), number(shown)) {
                (Ok(found), Ok(shown)) => found == shown || (found / shown - 1.0).abs() < 1e-6,
                _ => *found == shown,
            }
        })
}
