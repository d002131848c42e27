//! Engagements that have a sea in common, and where their statistics come from.

use super::settings::{Settings, Source};
use crate::model::{Flag, Model};
use crate::toml_file::Item;
use prob_water::{Draws, Engagement, Ensemble, Error, Exact, Parameters, Spot, Surface, Table, Water};
use std::path::Path;
use std::rc::Rc;

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
    /// A table of the empirical model; `None`: the built-in one.
    Table(Option<Rc<Table>>),
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
        let table = match parameters.surface {
            Surface::Empirical => self.open_table(parameters)?,
            _ => None,
        };
        let alike = all.chunk_by(|a, b| a.spot == b.spot);
        alike.map(|alike| self.part(parameters, alike, &all[0].engagement, table.clone())).collect()
    }

    fn part(
        &self,
        parameters: &Parameters,
        all: &[Placed],
        first: &Engagement,
        table: Option<Rc<Table>>,
    ) -> Result<Part, String> {
        let Placed { spot, place, engagement } = &all[0];
        // A footprint that the model does not have is the beam's.
        let place = engagement.beam().map(|_| *place);
        let refuse = |error: &Error| self.refuse(error, place);
        let water = spot.sea(parameters).map_err(|e| refuse(&e))?;
        let method = if water.parameters.surface == Surface::Empirical {
            let key = self.model.table.as_ref();
            let known = table.as_deref().unwrap_or_else(|| Table::standard());
            known.check(&water).map_err(|e| self.refuse(&e, place.or(key)))?;
            Method::Table(table)
        } else if self.settings.source == Source::Exact {
            Method::Exact(Box::new(Exact::new(&water).map_err(|e| refuse(&e))?))
        } else {
            let ensemble = Box::new(self.ensemble(&water, all, first, place)?);
            // Few components, narrow footprints, lasting whitecaps and swell have draws alone.
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

    /// The table that a flag names, or the file; `None`: the built-in one.
    fn open_table(&self, parameters: &Parameters) -> Result<Option<Rc<Table>>, String> {
        let instances = parameters.instances;
        if instances > MOST_DRAWS {
            let allowed = format!("1 to {MOST_DRAWS} with surface = empirical");
            let error = Error::OutOfRange { parameter: "instances", value: instances.to_string(), allowed };
            return Err(self.refuse(&error, None));
        }
        let [flag, own] = self.table;
        let table = flag.or(own).map(Table::open).transpose();
        table.map(|table| table.map(Rc::new)).map_err(|error| match flag {
            Some(_) => error.to_string(), // not the file's fault
            None => self.refuse(&error, self.model.table.as_ref()),
        })
    }

    fn refuse(&self, error: &Error, place: Option<&Item>) -> String {
        self.model.refuse(self.flags, error, place)
    }
}

/// More draws say nothing more of a table.
const MOST_DRAWS: u64 = 10_000_000;
