//! The value of a quantity, or why it has none.

use std::fmt;

use crate::model::quantity::Quantity;

/// The value of a quantity.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number in the scenario's units.
    Number(f64),
    /// A word, as in results.
    Word(String),
}

impl Value {
    pub(super) fn finite(number: f64) -> Result<Value, NoValue> {
        if number.is_finite() { Ok(Value::Number(number)) } else { none("not a finite number") }
    }

    /// The number, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Value::Number(value) => Some(*value),
            Value::Word(_) => None,
        }
    }

    /// As in JSON.
    pub fn json(&self) -> serde_json::Value {
        match self {
            // −0 reads as 0.
            Value::Number(value) => (value + 0.0).into(),
            Value::Word(word) => word.as_str().into(),
        }
    }
}

/// A quantity with its values at the places of a path; `None` where it has none.
pub type OnPath = (Quantity, Vec<Option<f64>>);

/// Why a quantity has no value here.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoValue(pub String);

impl fmt::Display for NoValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

pub(super) fn none<T>(why: impl Into<String>) -> Result<T, NoValue> {
    Err(NoValue(why.into()))
}
