//! The parameters that a scenario declares, for every number that names one.

use indexmap::IndexMap;

use crate::model::parameter::{Along, Formulas, Parameter, ParameterValues};

/// The parameters of a scenario, with the values under which it is read.
#[derive(Default)]
pub struct Parameters {
    /// `None` where the definition itself is wrong.
    pub known: IndexMap<String, Option<Parameter>>,
    pub values: ParameterValues,
    /// Where rates are read: the parameter and what all of them do along it.
    pub along: Option<(String, Along)>,
}

impl Parameters {
    /// Whether there is a parameter of this name, be its definition right or wrong.
    pub fn contains(&self, name: &str) -> bool {
        self.known.contains_key(name)
    }

    /// All names.
    pub fn names(&self) -> Vec<&str> {
        self.known.keys().map(String::as_str).collect()
    }

    /// The present value; `None` where the definition is wrong.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.known.get(name)?.as_ref()?;
        self.values.get(name).copied()
    }

    /// The parameter along which amounts are read as rates, and what the others do along it.
    pub fn along(&self) -> Option<(&str, &Along)> {
        self.along.as_ref().map(|(name, along)| (name.as_str(), along))
    }

    /// The formulas among them.
    pub fn formulas(&self) -> &Formulas {
        self.values.formulas()
    }

    /// The parameters; `None` if any of them is wrong.
    pub fn complete(&self) -> Option<IndexMap<String, Parameter>> {
        self.known.iter().map(|(name, parameter)| Some((name.clone(), parameter.clone()?))).collect()
    }
}
