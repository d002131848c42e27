//! What is in the water.

/// Salt or no salt.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Salinity {
    /// Sea water, chlorinity 19 g/kg.
    #[default]
    Ocean,
    /// Fresh water.
    Fresh,
}

impl Salinity {
    /// Salt in per mille: Knudsen's of the chlorinity.
    pub fn per_mille(self) -> f64 {
        match self {
            Self::Ocean => 0.03 + 1.805 * 19.0,
            Self::Fresh => 0.0,
        }
    }
}
