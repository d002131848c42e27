//! A sea in a file: parameters by the vocabulary's names.

use crate::scenario::settings;
use crate::toml_file::{Document, Item};
use prob_water::vocabulary::{Builder, Value, WIND};
use prob_water::{Error, Surface, Water};
use toml::de::DeTable;

/// A parameter given as a flag.
pub type Flag = (&'static str, Value);

/// The sea that a builder has collected, on one of some surfaces; standard error is told of values that are hardly meant.
pub fn configure(builder: &Builder, surfaces: &[Surface]) -> Result<Water, Error> {
    let water = builder.parameters()?.configure()?.on(surfaces)?;
    for warning in water.warnings() {
        eprintln!("prob-water: warning: {warning}");
    }
    Ok(water)
}

/// The parameters of a file.
pub struct Model<'d> {
    /// The file.
    pub document: &'d Document,
    /// The table itself, where there is one.
    pub at: Option<Item<'d>>,
    /// Its keys.
    pub items: Vec<Item<'d>>,
    /// The key that names a table of the empirical model.
    pub table: Option<Item<'d>>,
}

/// Whether a flag replaces a parameter of the file: a wind the whole wind.
fn replaces(flag: &str, name: &str) -> bool {
    flag == name || WIND.contains(&flag) && WIND.contains(&name)
}

impl<'d> Model<'d> {
    /// The sea of a file that has nothing else to say: the file itself, or its `[model]`. What a scenario asks about
    /// the sea may stand there too; but for the table it is passed over.
    pub fn alone(document: &'d Document, root: &'d DeTable<'d>) -> Result<Self, String> {
        let mut items = document.items(root);
        let at = items.iter().position(|item| item.name == "model").map(|at| items.remove(at));
        let mut table = items.iter().find(|item| item.name == settings::TABLE).copied();
        items.retain(|item| item.name != "engagement" && !settings::is(item.name));
        if let Some(model) = at {
            if let Some(item) = items.first() {
                return Err(item.refuse(format!("{} stands outside of [model]", item.name)));
            }
            items = model.table()?;
            table = items.iter().find(|item| item.name == settings::TABLE).copied().or(table);
            items.retain(|item| !settings::is(item.name));
        }
        Ok(Self { document, at, items, table })
    }

    /// The same, for another surface where one is asked for: by a flag, or by a subcommand that knows a single
    /// one. Then the file's `surface` is left out, and its footprint where it is infinite: nothing longer is drawn.
    pub fn for_surface(mut self, flags: &[Flag], surfaces: &[Surface]) -> Result<Self, String> {
        let Some(item) = self.items.iter().find(|item| item.name == "surface") else { return Ok(self) };
        let surface = |value: &Value| {
            let mut builder = Builder::default();
            builder.set("surface", value).and_then(|()| builder.parameters()).map(|p| p.surface)
        };
        let own = surface(&item.value()?).map_err(|e| item.refuse(e))?;
        let wanted = match flags.iter().find(|(flag, _)| *flag == "surface") {
            Some((_, value)) => surface(value).map_err(|e| e.to_string())?,
            None => match surfaces {
                [only] => *only,
                _ => own,
            },
        };
        if own != wanted {
            let infinite = |item: &Item| {
                let number = item.value().ok().and_then(|value| value.to_string().trim().parse::<f64>().ok());
                number.is_some_and(f64::is_infinite)
            };
            self.items.retain(|item| match item.name {
                "surface" => false,
                "footprint" => !infinite(item),
                _ => true,
            });
        }
        Ok(self)
    }

    /// The sea on one of some surfaces, the first unless told; flags stand above the file.
    pub fn water(&self, flags: &[Flag], surfaces: &[Surface]) -> Result<Water, String> {
        let mut builder = Builder::on(surfaces[0]);
        for item in &self.items {
            if !flags.iter().any(|(flag, _)| replaces(flag, item.name)) {
                builder.set(item.name, &item.value()?).map_err(|e| match e {
                    Error::UnknownParameter { name, known } => {
                        let own = settings::KEYS.join(", ");
                        item.refuse(format!("unknown key {name}: known are {known}, {own}"))
                    }
                    e => item.refuse(e),
                })?;
            }
        }
        for (name, value) in flags {
            builder.set(name, value).map_err(|e| e.to_string())?;
        }
        configure(&builder, surfaces).map_err(|e| self.refuse(flags, &e, None))
    }

    /// A refusal at the key that is to blame, or at `place`, or at the table.
    pub fn refuse(&self, flags: &[Flag], error: &Error, place: Option<&Item>) -> String {
        self.refuse_named(flags, &error.parameters(), &error.to_string(), place)
    }

    fn refuse_named(&self, flags: &[Flag], names: &[&str], message: &str, place: Option<&Item>) -> String {
        if flags.iter().any(|(flag, _)| names.contains(flag)) {
            return message.to_owned(); // not the file's fault
        }
        let key = names.iter().find_map(|name| self.items.iter().find(|item| item.name == *name));
        match key.or(place).or(self.at.as_ref()) {
            Some(item) => item.refuse(message),
            None => self.document.refuse(0, message),
        }
    }
}
