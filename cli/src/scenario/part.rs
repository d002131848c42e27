//! Engagements that have a sea in common, and where their statistics come from.

use super::settings::{Settings, Source};
use crate::empirical_table;
use crate::model::{Flag, Model};
use crate::toml_file::Item;
use prob_water::{
    Draws, EmpiricalLobe, Engagement, Ensemble, Error, Exact, OffPlaneModel, Parameters, Spot, Surface, Water,
};
use std::path::Path;

/// Engagements in a row whose beams light alike spots.
pub struct Part {
    /// The sea, divided into waves and facets by the spot.
    pub water: Water,
    /// Where its statistics come from.
    pub method: Method,
    /// One for every time.
    pub engagements: Vec<Engagement>,
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

/// An engagement, its spot, and where it stands in the file.
pub struct Placed<'d> {
    /// Checked.
    pub engagement: Engagement,
    /// What its beam lights.
    pub spot: Spot,
    /// Its entry.
    pub place: &'d Item<'d>,
}

/// What a file says that holds for all parts.
pub struct Parts<'a, 'd> {
    /// The sea as the file has it.
    pub model: &'a Model<'d>,
    /// What stands above it.
    pub flags: &'a [Flag],
    /// What is asked about it.
    pub settings: &'a Settings,
    /// The table that a flag names, and the file's.
    pub table: [Option<&'a Path>; 2],
}

impl Parts<'_, '_> {
    /// All parts, in the order of the file; refused is whatever cannot be worked out.
    pub fn of(&self, parameters: &Parameters, all: &[Placed]) -> Result<Vec<Part>, String> {
        let alike = all.chunk_by(|a, b| a.spot == b.spot);
        alike.map(|alike| self.part(parameters, alike, &all[0].engagement)).collect()
    }

    fn part(&self, parameters: &Parameters, all: &[Placed], first: &Engagement) -> Result<Part, String> {
        let Placed { spot, place, engagement } = &all[0];
        // A footprint that the model does not have is the beam's.
        let place = engagement.beam().map(|_| *place);
        let refuse = |error: &Error| self.refuse(error, place);
        let water = spot.sea(parameters).map_err(|e| refuse(&e))?;
        let method = if water.parameters.surface == Surface::Empirical {
            let slopes = Parameters { across: OffPlaneModel::Slopes, ..water.parameters };
            let slopes = (water.parameters.across == OffPlaneModel::Report)
                .then(|| {
                    slopes.configure().map_err(|e| refuse(&e)).and_then(|water| self.by_table(&water, place))
                })
                .transpose()?;
            Method::Table(Box::new(self.by_table(&water, place)?), slopes.map(Box::new))
        } else if self.settings.source == Source::Exact {
            Method::Exact(Box::new(Exact::new(&water).map_err(|e| refuse(&e))?))
        } else {
            let ensemble = Box::new(self.ensemble(&water, all, first, place)?);
            // Few components and narrow footprints have draws alone.
            match self.settings.source {
                Source::Auto => Method::Auto(Exact::new(&water).ok().map(Box::new), ensemble),
                _ => Method::Draws(ensemble),
            }
        };
        let engagements = all.iter().map(|placed| placed.engagement.clone()).collect();
        Ok(Part { water, method, engagements })
    }

    /// What the settings draw, whose evenly spread phases count at the first engagement of the file.
    fn ensemble(
        &self,
        water: &Water,
        all: &[Placed],
        first: &Engagement,
        place: Option<&Item>,
    ) -> Result<Ensemble, String> {
        let Settings { draws, presence, proposal, mean_normal, .. } = *self.settings;
        let refuse = |error: Error| self.refuse(&error, place);
        let mut ensemble = Ensemble { draws, presence, proposal, ..Ensemble::new(water).map_err(refuse)? };
        if draws == Draws::Sobol {
            ensemble = ensemble.around(first);
        }
        if mean_normal {
            ensemble = ensemble.over(all[0].spot).map_err(refuse)?;
        }
        for Placed { engagement, place, .. } in all {
            ensemble.check(engagement).map_err(|e| self.refuse(&e, Some(place)))?;
        }
        Ok(ensemble)
    }

    /// The sea by the table that a flag names, or the file, or by the built-in one.
    fn by_table(&self, water: &Water, place: Option<&Item>) -> Result<EmpiricalLobe, String> {
        let instances = water.parameters.instances;
        if instances > MOST_DRAWS {
            let allowed = format!("1 to {MOST_DRAWS} with surface = empirical");
            let error = Error::OutOfRange { parameter: "instances", value: instances.to_string(), allowed };
            return Err(self.refuse(&error, None));
        }
        let [flag, own] = self.table;
        let key = self.model.table.as_ref();
        empirical_table::lobe(water, flag.or(own)).map_err(|error| match (&error, flag) {
            (Error::Table { .. }, Some(_)) => error.to_string(), // not the file's fault
            (Error::Table { .. }, None) => self.refuse(&error, key),
            _ => self.refuse(&error, place.or(key)),
        })
    }

    fn refuse(&self, error: &Error, place: Option<&Item>) -> String {
        self.model.refuse(self.flags, error, place)
    }
}

/// More draws say nothing more of a table.
const MOST_DRAWS: u64 = 10_000_000;
