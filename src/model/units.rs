//! The author's units.

/// Labels of the author's units; nothing is converted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Units {
    /// Unit of length, e.g. `m`.
    pub length: Option<String>,
    /// Unit of force, e.g. `kN`.
    pub force: Option<String>,
}
