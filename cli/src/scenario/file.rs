//! A scenario file: the sea, what is asked about it, and the engagements.

use super::engagement;
use super::settings::{self, Settings, Source};
use crate::empirical_table;
use crate::model::{Flag, Model};
use crate::toml_file::Document;
use prob_water::Exact;
use prob_water::{
    Draws, EmpiricalLobe, Engagement, Ensemble, Error, OffPlaneModel, Parameters, Surface, Water,
};
use std::path::{Path, PathBuf};

/// What a file describes; checked.
pub struct Scenario {
    /// The sea.
    pub water: Water,
    /// Where its statistics come from.
    pub method: Method,
    /// Values of f, 1/sr, whose exceedance is asked for.
    pub limits: Vec<f64>,
    /// One for every time.
    pub engagements: Vec<Engagement>,
    /// The table that the file names.
    pub table: Option<PathBuf>,
}

/// Where statistics come from.
pub enum Method {
    /// Drawn surfaces.
    Draws(Box<Ensemble>),
    /// Integrals over all surfaces.
    Exact(Box<Exact>),
    /// Integrals where their error is small, if the sea has them, else drawn surfaces.
    Auto(Option<Box<Exact>>, Box<Ensemble>),
    /// A table of the empirical model, and where it takes the report's form across the plane, the same with the slopes'.
    Table(Box<EmpiricalLobe>, Option<Box<EmpiricalLobe>>),
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
        let mut engagements = Vec::new();
        // Of every engagement, where it stands.
        let mut places = Vec::new();
        for entry in &entries {
            let of_entry = engagement::read(entry, water.parameters.time)?;
            places.resize(places.len() + of_entry.len(), entry);
            engagements.extend(of_entry);
        }
        let mut own_table = None;
        let method = if water.parameters.surface == Surface::Empirical {
            own_table = model.table.as_ref().map(|item| settings::table(item, path)).transpose()?;
            let table = (table, own_table.as_deref());
            let lobe = by_table(&model, &water, flags, table)?;
            let slopes = Parameters { across: OffPlaneModel::Slopes, ..water.parameters };
            let slopes = (water.parameters.across == OffPlaneModel::Report)
                .then(|| slopes.configure().map(|water| by_table(&model, &water, flags, table)))
                .transpose()
                .map_err(|e| model.refuse(flags, &e, None))?
                .transpose()?;
            Method::Table(Box::new(lobe), slopes.map(Box::new))
        } else if table.is_some() {
            return Err(empirical_table::MEANINGLESS.into());
        } else if settings.source == Source::Exact {
            let exact = Exact::new(&water).map_err(|e| model.refuse(flags, &e, None))?;
            Method::Exact(Box::new(exact))
        } else {
            let Settings { draws, presence, proposal, .. } = settings;
            let ensemble = Ensemble::new(&water).map_err(|e| model.refuse(flags, &e, None))?;
            let mut ensemble = Ensemble { draws, presence, proposal, ..ensemble };
            if draws == Draws::Sobol {
                ensemble = ensemble.around(&engagements[0]);
            }
            for (engagement, place) in engagements.iter().zip(places) {
                ensemble.check(engagement).map_err(|e| model.refuse(flags, &e, Some(place)))?;
            }
            // Few components, narrow footprints, lasting whitecaps and swell have draws alone.
            match settings.source {
                Source::Auto => Method::Auto(Exact::new(&water).ok().map(Box::new), Box::new(ensemble)),
                _ => Method::Draws(Box::new(ensemble)),
            }
        };
        Ok(Self { water, method, limits: settings.limits, engagements, table: own_table })
    }
}

/// More draws say nothing more of a table.
const MOST_DRAWS: u64 = 10_000_000;

/// The sea by the table that a flag names, or the file, or by the built-in one.
fn by_table(
    model: &Model,
    water: &Water,
    flags: &[Flag],
    (flag, own): (Option<&Path>, Option<&Path>),
) -> Result<EmpiricalLobe, String> {
    let instances = water.parameters.instances;
    if instances > MOST_DRAWS {
        let allowed = format!("1 to {MOST_DRAWS} with surface = empirical");
        let error = Error::OutOfRange { parameter: "instances", value: instances.to_string(), allowed };
        return Err(model.refuse(flags, &error, None));
    }
    empirical_table::lobe(water, flag.or(own)).map_err(|error| match (&error, flag) {
        (Error::Table { .. }, Some(_)) => error.to_string(), // not the file's fault
        _ => model.refuse(flags, &error, model.table.as_ref()),
    })
}
