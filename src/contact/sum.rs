//! A value that knows what it was summed from: the measure of its rounding (method §4, "Zero").

use crate::lcp::problem::NOISE;

/// Largest share of the terms of its own row by which a law of contact may be violated: what rounding leaves of a sum.
pub const LAW_ROUNDING: f64 = 4.0 * NOISE;

/// Largest share of the loads that rounding may hide. Displacements so large that the terms of a force exceed the loads by
/// some 1e9 belong to a motion that nothing resists: any load at all would pass as rounding beside them.
pub const HIDDEN: f64 = 1e-4;

/// A value and the sum of the magnitudes of its terms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sum {
    /// The value.
    pub value: f64,
    /// Σ |term|.
    pub magnitude: f64,
}

impl Sum {
    /// A number that is exact.
    pub fn exactly(value: f64) -> Sum {
        Sum { value, magnitude: value.abs() }
    }

    /// This sum and `factor` times another.
    #[must_use]
    pub fn plus(self, factor: f64, other: Sum) -> Sum {
        Sum { value: self.value + factor * other.value, magnitude: self.magnitude + factor.abs() * other.magnitude }
    }

    /// The value as a share of its terms, −1 … 1; 0 where all terms are zero.
    pub fn share(self) -> f64 {
        if self.magnitude > 0.0 { self.value / self.magnitude } else { self.value }
    }

    /// Most that rounding can have changed the value by.
    pub fn error(self) -> f64 {
        NOISE * self.magnitude
    }

    /// Whether rounding alone can have made the value.
    pub fn is_zero(self) -> bool {
        self.value.abs() <= self.error()
    }

    /// The value, 0 where it is rounding.
    pub fn cleaned(self) -> f64 {
        if self.is_zero() { 0.0 } else { self.value }
    }
}
