//! TOML in: values that know their line, so that a refusal can name it.

use prob_water::vocabulary::Value;
use std::fmt::Display;
use std::fs;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The text of a file.
pub struct Document {
    name: String,
    text: String,
}

impl Document {
    /// Reads a file.
    pub fn read(path: &Path) -> Result<Self, String> {
        let name = path.display().to_string();
        let bytes = fs::read(path).map_err(|e| format!("cannot read {name}: {e}"))?;
        Self::new(name, bytes)
    }

    /// Text from wherever its name says.
    pub fn new(name: String, bytes: Vec<u8>) -> Result<Self, String> {
        match String::from_utf8(bytes) {
            Ok(text) => Ok(Self { name, text }),
            Err(error) => {
                let good = error.utf8_error().valid_up_to();
                let text = String::from_utf8_lossy(&error.as_bytes()[..good]).into_owned();
                Err(Self { name, text }.refuse(good, "not UTF-8"))
            }
        }
    }

    /// The table that the file is.
    pub fn parse(&self) -> Result<DeTable<'_>, String> {
        let error = |e: toml::de::Error| self.refuse(e.span().map_or(0, |span| span.start), e.message());
        Ok(DeTable::parse(&self.text).map_err(error)?.into_inner())
    }

    /// The keys of a table, in the order of the file.
    pub fn items<'d>(&'d self, table: &'d DeTable<'d>) -> Vec<Item<'d>> {
        let item = |(key, value): (&'d Spanned<_>, _)| Item {
            document: self,
            name: std::borrow::Cow::as_ref(key.get_ref()),
            at: key.span().start,
            value,
        };
        let mut items: Vec<_> = table.iter().map(item).collect();
        items.sort_by_key(|item| item.at);
        items
    }

    /// A refusal of what stands at a byte: `FILE:LINE: message`.
    pub fn refuse(&self, at: usize, message: impl Display) -> String {
        let before = &self.text.as_bytes()[..at.min(self.text.len())];
        let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
        format!("{}:{line}: {message}", self.name)
    }
}

/// A value, the key it belongs to, and where it stands.
#[derive(Clone, Copy)]
pub struct Item<'d> {
    document: &'d Document,
    /// The key.
    pub name: &'d str,
    at: usize,
    value: &'d Spanned<DeValue<'d>>,
}

impl<'d> Item<'d> {
    /// A refusal that names the line.
    pub fn refuse(&self, message: impl Display) -> String {
        self.document.refuse(self.at, message)
    }

    fn is_not(&self, expected: &str) -> String {
        let source = self.document.text.get(self.value.span()).unwrap_or_default();
        let shown: String = source.chars().take(40).collect();
        self.refuse(format!("{} = {shown} is not {expected}", self.name))
    }

    /// A number, whole or not.
    pub fn number(&self) -> Result<f64, String> {
        let number = match self.value.get_ref() {
            DeValue::Integer(x) => i64::from_str_radix(x.as_str(), x.radix()).ok().map(|x| x as f64),
            // What is too large for a number must not become infinite.
            DeValue::Float(x) => {
                let named = x.as_str().contains("inf");
                x.as_str().parse().ok().filter(|x: &f64| named || !x.is_infinite())
            }
            _ => None,
        };
        number.ok_or_else(|| self.is_not("a number"))
    }

    /// Three numbers.
    pub fn position(&self) -> Result<[f64; 3], String> {
        let numbers =
            self.parts().into_iter().flatten().map(|x| x.number()).collect::<Result<Vec<_>, _>>()?;
        numbers.try_into().map_err(|_| self.is_not("[x, y, z]"))
    }

    /// Text.
    pub fn text(&self) -> Result<&'d str, String> {
        self.value.get_ref().as_str().ok_or_else(|| self.is_not("a word"))
    }

    /// One of some words.
    pub fn choice<C: Copy>(&self, choices: &[(&str, C)]) -> Result<C, String> {
        let word = self.text()?;
        choices.iter().find(|(name, _)| *name == word).map(|(_, choice)| *choice).ok_or_else(|| {
            let allowed: Vec<_> = choices.iter().map(|(name, _)| *name).collect();
            self.refuse(format!("{} = {word} is unknown: allowed is {}", self.name, allowed.join(", ")))
        })
    }

    /// What the vocabulary takes.
    pub fn value(&self) -> Result<Value, String> {
        match self.value.get_ref() {
            DeValue::String(text) => Ok(Value::Text(text.to_string())),
            DeValue::Boolean(flag) => Ok(Value::Flag(*flag)),
            DeValue::Integer(_) | DeValue::Float(_) => self.number().map(Value::Number),
            _ => Err(self.is_not("a number, a word, true or false")),
        }
    }

    /// The elements of a list; `None` where it is not one.
    pub fn parts(&self) -> Option<Vec<Item<'d>>> {
        let part = |value: &'d Spanned<DeValue<'d>>| Item { at: value.span().start, value, ..*self };
        Some(self.value.get_ref().as_array()?.iter().map(part).collect())
    }

    /// The elements of a list.
    pub fn list(&self, expected: &str) -> Result<Vec<Item<'d>>, String> {
        self.parts().ok_or_else(|| self.is_not(expected))
    }

    /// The keys of a table.
    pub fn table(&self) -> Result<Vec<Item<'d>>, String> {
        let table = self.value.get_ref().as_table();
        Ok(self.document.items(table.ok_or_else(|| self.is_not("a table"))?))
    }
}
