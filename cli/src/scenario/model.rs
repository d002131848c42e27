//! `[model]`: parameters by the vocabulary's names.

use super::settings;
use crate::toml_file::{Document, Item};
use prob_water::vocabulary::{Builder, Value, WIND};
use prob_water::{Error, Surface, Water};

/// A parameter given as a flag.
pub type Flag = (&'static str, Value);

/// The parameters of a file.
pub struct Model<'d> {
    /// The file.
    pub document: &'d Document,
    /// The table itself, where there is one.
    pub at: Option<Item<'d>>,
    /// Its keys.
    pub items: Vec<Item<'d>>,
}

/// Whether a flag replaces a parameter of the file: a wind the whole wind.
fn replaces(flag: &str, name: &str) -> bool {
    flag == name || WIND.contains(&flag) && WIND.contains(&name)
}

impl Model<'_> {
    /// The sea, its waves drawn; flags stand above the file.
    pub fn water(&self, flags: &[Flag]) -> Result<Water, String> {
        let mut builder = Builder::on(Surface::Instance);
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
        let water = builder.parameters().and_then(|p| p.configure());
        water.and_then(|water| water.on(&[Surface::Instance])).map_err(|e| self.refuse(flags, &e, None))
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
