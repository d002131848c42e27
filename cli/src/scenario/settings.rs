//! The keys that are a scenario's own: what is asked about the sea.

use crate::toml_file::Item;
use prob_water::{Draws, Proposal, SpotShape, Surface, WhitecapMode};
use std::path::{Path, PathBuf};

/// Their names.
pub const KEYS: [&str; 7] =
    ["limits", "statistics", "draws", "whitecap_presence", "spot", "spot_normal", TABLE];
/// The one that names a table of the empirical model.
pub const TABLE: &str = "table";

/// Whether a key is one of them.
pub fn is(name: &str) -> bool {
    KEYS.contains(&name)
}

/// Where statistics come from: `statistics`.
#[derive(Clone, Copy, Default, PartialEq)]
pub enum Source {
    /// Drawn seas.
    #[default]
    Draws,
    /// Integrals over all seas.
    Exact,
    /// Integrals where their error is small, else draws.
    Auto,
}

/// Their values.
#[derive(Default)]
pub struct Settings {
    /// 1/sr.
    pub limits: Vec<f64>,
    /// Where they come from.
    pub source: Source,
    /// How random numbers are spread over the instances.
    pub draws: Draws,
    /// Which seas are drawn.
    pub proposal: Proposal,
    /// How whitecaps take part.
    pub presence: WhitecapMode,
    /// What a beam lights.
    pub spot: SpotShape,
    /// Whether normals are means over it.
    pub mean_normal: bool,
}

impl Settings {
    /// Each at most once, wherever they stand.
    pub fn read(items: &[Item]) -> Result<Self, String> {
        let mut settings = Self { proposal: Proposal::Auto, ..Self::default() };
        for (i, item) in items.iter().enumerate() {
            if items[..i].iter().any(|before| before.name == item.name) {
                return Err(item.refuse(format!("{} is given twice", item.name)));
            }
            match item.name {
                "limits" => settings.limits = limits(item)?,
                "statistics" => {
                    settings.source = item.choice(&[
                        ("draws", Source::Draws),
                        ("exact", Source::Exact),
                        ("auto", Source::Auto),
                    ])?;
                }
                "draws" => {
                    (settings.draws, settings.proposal) = item.choice(&[
                        ("auto", (Draws::Random, Proposal::Auto)),
                        ("random", (Draws::Random, Proposal::Plain)),
                        ("sobol", (Draws::Sobol, Proposal::Plain)),
                        ("slopes", (Draws::Random, Proposal::Slopes)),
                    ])?;
                }
                "spot" => {
                    settings.spot =
                        item.choice(&[("circle", SpotShape::Circle), ("ellipse", SpotShape::Ellipse)])?;
                }
                "spot_normal" => settings.mean_normal = item.choice(&[("hit", false), ("mean", true)])?,
                TABLE => (), // Model's
                _ => {
                    settings.presence =
                        item.choice(&[("drawn", WhitecapMode::Drawn), ("expected", WhitecapMode::Expected)])?;
                }
            }
        }
        let exact = settings.source == Source::Exact;
        let meaningless = |item: &&Item| match item.name {
            "draws" => exact && settings.proposal != Proposal::Auto,
            "whitecap_presence" => exact && settings.presence != WhitecapMode::Drawn,
            "spot_normal" => settings.source != Source::Draws && settings.mean_normal,
            _ => false,
        };
        match items.iter().find(meaningless) {
            Some(item) => {
                let (value, source) = (item.text()?, if exact { "exact" } else { "auto" });
                Err(item.refuse(format!("{} = {value} has no meaning with statistics = {source}", item.name)))
            }
            None => Ok(settings),
        }
    }
}

/// The path that `table = "..."` gives, from the folder of the file it stands in.
pub fn table(item: &Item, file: &Path) -> Result<PathBuf, String> {
    Ok(file.parent().unwrap_or(Path::new("")).join(item.text()?))
}

/// Refuses what a table of the empirical model has no use for, or a table where there is none.
pub fn check(items: &[Item], surface: Surface) -> Result<(), String> {
    let empirical = surface == Surface::Empirical;
    let meaningless = |item: &&Item| match item.name {
        "limits" | "spot" => false,
        TABLE => !empirical,
        _ => empirical,
    };
    match items.iter().find(meaningless) {
        Some(item) if empirical => Err(item.refuse(format!(
            "{} has no meaning with surface = empirical: statistics come from its table",
            item.name
        ))),
        Some(item) => Err(item.refuse("table has no meaning but with surface = empirical")),
        None => Ok(()),
    }
}

fn limits(item: &Item) -> Result<Vec<f64>, String> {
    let mut limits = Vec::new();
    for part in item.list("a list of numbers")? {
        let limit = part.number()?;
        if !(limit.is_finite() && limit >= 0.0) {
            return Err(
                part.refuse(format!("limits: {limit} is out of range: allowed is finite, from 0 1/sr"))
            );
        }
        if limits.contains(&limit) {
            return Err(part.refuse(format!("limits: {limit} is there twice")));
        }
        limits.push(limit);
    }
    Ok(limits)
}
