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
