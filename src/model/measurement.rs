//! What was measured on the real structure, for `calibrate`.

use super::quantity::Quantity;

/// A measured quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// What was measured; its value is a number.
    pub quantity: Quantity,
    /// What was found.
    pub value: f64,
    /// Standard error of it, > 0, in its unit; `None` where nothing is known.
    pub error: Option<f64>,
}
