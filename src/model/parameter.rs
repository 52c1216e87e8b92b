//! Named numbers that the user varies, and the places of a scenario that may hold one.

use indexmap::IndexMap;

/// A number of the scenario: written out, or the name of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Number {
    /// The value itself.
    Value(f64),
    /// The name of a parameter; `validate` has made sure that it exists.
    Parameter(String),
}

impl Number {
    /// The number under the given parameter values.
    ///
    /// # Panics
    /// Never on a checked scenario: every name was resolved when it was loaded and
    /// [`ParameterValues`] always holds all parameters of its scenario.
    pub fn value(&self, parameters: &ParameterValues) -> f64 {
        match self {
            Number::Value(value) => *value,
            Number::Parameter(name) => parameters[name.as_str()],
        }
    }

    /// The name, if this is a parameter.
    pub fn parameter(&self) -> Option<&str> {
        match self {
            Number::Value(_) => None,
            Number::Parameter(name) => Some(name),
        }
    }
}

/// The present value of every parameter, in the order of the file.
pub type ParameterValues = IndexMap<String, f64>;

/// What the scenario says of one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Value at load.
    pub value: f64,
    /// Lower end of the slider.
    pub min: Option<f64>,
    /// Upper end of the slider.
    pub max: Option<f64>,
    /// Step of the slider.
    pub step: Option<f64>,
    /// Unit, for labels only.
    pub unit: Option<String>,
    /// One line for the user.
    pub about: Option<String>,
}
