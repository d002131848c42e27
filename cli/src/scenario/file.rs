//! A scenario file: the sea, what is asked about it, and the engagements.

use super::engagement;
use super::part::{Part, Parts, Placed};
use super::settings::{self, Settings};
use crate::empirical_table;
use crate::model::{Flag, Model};
use crate::toml_file::Document;
use prob_water::{Spot, SpotShape, Surface, Water};
use std::path::{Path, PathBuf};

/// What a file describes; checked.
pub struct Scenario {
    /// The sea, but for footprints that follow from beams.
    pub water: Water,
    /// Its engagements.
    pub parts: Vec<Part>,
    /// Whether footprints are other than the sea's own.
    pub own_footprints: bool,
    /// Whether a beam is polarised.
    pub polarised: bool,
    /// Values of f, 1/sr, whose exceedance is asked for.
    pub limits: Vec<f64>,
    /// The table that the file names.
    pub table: Option<PathBuf>,
}

impl Scenario {
    /// Reads a file; flags stand above its `[model]`, and a table above its own. Whatever is wrong is refused here.
    pub fn read(path: &Path, flags: &[Flag], table: Option<&Path>) -> Result<Self, String> {
        Self::of(&Document::read(path)?, path, flags, table)
    }

    /// The same of a text that stands for the file.
    pub fn of(
        document: &Document,
        path: &Path,
        flags: &[Flag],
        table: Option<&Path>,
    ) -> Result<Self, String> {
        let root = document.parse()?;
        let mut model = Model { document, at: None, items: Vec::new(), table: None };
        let mut own = Vec::new();
        let mut entries = Vec::new();
        for item in document.items(&root) {
            match item.name {
                "model" => {
                    model.at = Some(item);
                    let (more, vocabulary): (Vec<_>, _) =
                        item.table()?.into_iter().partition(|item| settings::is(item.name));
                    model.items = vocabulary;
                    own.extend(more);
                }
                "engagement" => entries = item.list("a list of tables: write [[engagement]]")?,
                name if settings::is(name) => own.push(item),
                name => {
                    let known = settings::KEYS.join(", ");
                    return Err(
                        item.refuse(format!("unknown key {name}: known are model, engagement, {known}"))
                    );
                }
            }
        }
        if entries.is_empty() {
            return Err(document.refuse(0, "[[engagement]] is missing"));
        }
        let settings = Settings::read(&own)?;
        model.table = own.iter().find(|item| item.name == settings::TABLE).copied();
        let water = model.water(flags, &[Surface::Instance, Surface::Empirical])?;
        settings::check(&own, water.parameters.surface)?;
        let mut all = Vec::new();
        let mut polarised = false;
        for place in &entries {
            polarised |= place.table()?.iter().any(|item| item.name == engagement::STOKES);
            for engagement in engagement::read(place, water.parameters.time)? {
                let spot = Spot::new(&engagement, &water.parameters, settings.spot)
                    .map_err(|e| model.refuse(flags, &e, Some(place)))?;
                all.push(Placed { engagement, spot, place });
            }
        }
        let own_table = match water.parameters.surface {
            Surface::Empirical => model.table.as_ref().map(|item| settings::table(item, path)).transpose()?,
            _ if table.is_some() => return Err(empirical_table::MEANINGLESS.into()),
            _ => None,
        };
        let own_footprints = settings.spot == SpotShape::Ellipse
            || all.iter().any(|placed| placed.engagement.beam().is_some());
        let tables = [table, own_table.as_deref()];
        let parts = Parts { model: &model, flags, settings: &settings, table: tables };
        let parts = parts.of(&water.parameters, &all)?;
        if own_footprints {
            // Once, for the first of them.
            let mut warnings = parts.iter().flat_map(|part| part.water.warnings());
            if let Some(warning) = warnings.find(|warning| warning.parameter == "footprint") {
                eprintln!("prob-water: warning: {warning}");
            }
        }
        Ok(Self { water, parts, own_footprints, polarised, limits: settings.limits, table: own_table })
    }
}
