/// Why a configuration or a batch of rows was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// A value outside what the parameter allows.
    #[error("{parameter} = {value} is out of range: allowed is {allowed}")]
    OutOfRange {
        /// The parameter's name in the vocabulary.
        parameter: &'static str,
        /// The value as given.
        value: String,
        /// The range, with units.
        allowed: String,
    },
    /// A word that is not one of the parameter's choices.
    #[error("{parameter} = {value} is unknown: allowed is {allowed}")]
    UnknownChoice {
        /// The parameter's name in the vocabulary.
        parameter: &'static str,
        /// The word as given.
        value: String,
        /// The choices.
        allowed: String,
    },
    /// A surface of which a function or a type knows nothing.
    #[error("surface = {value} is not served here: allowed is {allowed}")]
    Surface {
        /// Its word in the vocabulary.
        value: &'static str,
        /// The words of those that are.
        allowed: String,
    },
    /// A value of the wrong kind (a word where a number belongs, say).
    #[error("{parameter} = {value} is not {expected}")]
    WrongType {
        /// The parameter's name in the vocabulary.
        parameter: &'static str,
        /// The value as given.
        value: String,
        /// What was expected.
        expected: &'static str,
    },
    /// A name that is not in the vocabulary.
    #[error("unknown parameter {name}: known are {known}")]
    UnknownParameter {
        /// The name as given.
        name: String,
        /// Every name there is.
        known: String,
    },
    /// Parameters that exclude each other, both given.
    #[error(
        "{first} = {first_value} and {second} = {second_value} are both given: allowed is one of {allowed}"
    )]
    Conflict {
        /// The one given first.
        first: &'static str,
        /// Its value.
        first_value: String,
        /// The one given second.
        second: &'static str,
        /// Its value.
        second_value: String,
        /// The group they belong to.
        allowed: &'static str,
    },
    /// A direction of a batch that is not a unit vector.
    #[error("row {row}: {column} = ({x}, {y}, {z}) is not {expected}")]
    Row {
        /// Number of the row, from 1, the header not counted.
        row: usize,
        /// Which of the row's directions.
        column: &'static str,
        /// Its x component.
        x: f64,
        /// Its y component.
        y: f64,
        /// Its z component.
        z: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// A file that is not a table of the empirical model, or one that cannot be used.
    #[error("table = {name}: {reason}")]
    Table {
        /// Its name.
        name: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A number of something that is not there.
    #[error("{what} {index} does not exist: there are {count}, from 0")]
    Index {
        /// What is counted.
        what: &'static str,
        /// The number asked for.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// Arrays of a batch whose lengths do not belong together.
    #[error("{what} holds {found} rows, expected {expected}")]
    Length {
        /// Which array.
        what: &'static str,
        /// Its length in rows.
        found: usize,
        /// The length it should have.
        expected: usize,
    },
}

/// A value that is allowed but hardly meant: [`crate::Water::warnings`].
#[derive(Debug, Clone, PartialEq)]
pub struct Warning {
    /// The parameter's name in the vocabulary.
    pub parameter: &'static str,
    /// The value in force.
    pub value: String,
    /// The usual values, with units.
    pub usual: &'static str,
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} = {} is allowed but unusual: usual is {}", self.parameter, self.value, self.usual)
    }
}

/// Refuses a parameter's value.
pub(crate) fn refuse<T>(
    parameter: &'static str,
    value: impl ToString,
    allowed: impl Into<String>,
) -> Result<T, Error> {
    Err(Error::OutOfRange { parameter, value: value.to_string(), allowed: allowed.into() })
}

impl Error {
    /// The parameters that are to blame, the last given first.
    pub fn parameters(&self) -> Vec<&'static str> {
        match self {
            Self::OutOfRange { parameter, .. }
            | Self::UnknownChoice { parameter, .. }
            | Self::WrongType { parameter, .. } => vec![parameter],
            Self::Conflict { first, second, .. } => vec![second, first],
            Self::Surface { .. } => vec!["surface"],
            Self::Table { .. } => vec!["table"],
            Self::UnknownParameter { .. } | Self::Row { .. } | Self::Index { .. } | Self::Length { .. } => {
                vec![]
            }
        }
    }
}
