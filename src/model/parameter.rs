//! Named numbers that the user varies, formulas of them, and the numbers of a scenario that may be either.

use std::collections::{BTreeSet, HashMap};
use std::ops::Deref;
use std::sync::Arc;

use indexmap::IndexMap;
use serde::{Serialize, Serializer};

use super::expression::Expression;
use super::jet::{Dependence, Jet};

/// A number of the scenario: written out, the name of a parameter, or an expression of parameters.
#[derive(Clone, Debug, PartialEq)]
pub enum Number {
    /// The value itself.
    Value(f64),
    /// The name of a parameter; the decoder has made sure that it exists.
    Parameter(String),
    /// A formula of parameters.
    Expression(Expression),
}

impl Number {
    /// The number under the given parameter values, which must be those of its scenario.
    pub fn value(&self, values: &ParameterValues) -> f64 {
        match self {
            Number::Value(value) => *value,
            Number::Parameter(name) => values[name.as_str()],
            Number::Expression(expression) => expression.evaluate(&|name| Jet::constant(values[name])).value,
        }
    }

    /// The name, if this is just a parameter.
    pub fn parameter(&self) -> Option<&str> {
        match self {
            Number::Parameter(name) => Some(name),
            Number::Value(_) | Number::Expression(_) => None,
        }
    }

    /// The parameters and formulas named in it.
    pub fn names(&self) -> Vec<&str> {
        match self {
            Number::Value(_) => Vec::new(),
            Number::Parameter(name) => vec![name],
            Number::Expression(expression) => expression.parameters().collect(),
        }
    }

    /// As written in the file: `f`, `2*F + 1`, `0.5`.
    pub fn text(&self) -> String {
        match self {
            Number::Value(value) => value.to_string(),
            Number::Parameter(name) => name.clone(),
            Number::Expression(expression) => expression.text().to_owned(),
        }
    }

    /// Value, rate and kind of dependence along a parameter.
    pub fn along(&self, direction: &Along) -> Jet {
        match self {
            Number::Value(value) => Jet::constant(*value),
            Number::Parameter(name) => direction.of(name),
            Number::Expression(expression) => expression.evaluate(&|name| direction.of(name)),
        }
    }
}

/// The formulas among the parameters, each after those it needs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Formulas(IndexMap<String, Expression>);

impl Formulas {
    /// `formulas` in an order in which each comes after those it needs.
    pub fn new(formulas: Vec<(String, Expression)>) -> Formulas {
        Formulas(formulas.into_iter().collect())
    }

    /// Name and formula, each after those it needs.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Expression)> {
        self.0.iter().map(|(name, expression)| (name.as_str(), expression))
    }

    /// The parameters that can be set and on which any of `names` depends, formulas followed to their end.
    pub fn free<'n>(&self, names: impl IntoIterator<Item = &'n str>) -> BTreeSet<String> {
        let mut wanted: BTreeSet<String> = names.into_iter().map(str::to_owned).collect();
        for (name, expression) in self.0.iter().rev() {
            if wanted.remove(name) {
                wanted.extend(expression.parameters().map(str::to_owned));
            }
        }
        wanted
    }
}

/// The present value of every parameter, in the order of the file, formulas included.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParameterValues {
    values: IndexMap<String, f64>,
    formulas: Arc<Formulas>,
}

impl ParameterValues {
    /// No parameters.
    pub fn new() -> ParameterValues {
        ParameterValues::default()
    }

    /// The values of all parameters; those of `formulas` are computed.
    pub fn with_formulas(values: IndexMap<String, f64>, formulas: Arc<Formulas>) -> ParameterValues {
        let mut values = ParameterValues { values, formulas };
        values.compute();
        values
    }

    /// Sets a parameter; every formula follows. Returns the value before, if there was one. A formula keeps its own
    /// value.
    pub fn insert(&mut self, name: String, value: f64) -> Option<f64> {
        let before = self.values.insert(name, value);
        self.compute();
        before
    }

    fn compute(&mut self) {
        for (name, expression) in &self.formulas.0 {
            let values = &self.values;
            let known = |name: &str| Jet::constant(values.get(name).copied().unwrap_or(f64::NAN));
            let value = expression.evaluate(&known).value;
            self.values.insert(name.clone(), value);
        }
    }

    /// The formula behind a name; `None` for a parameter that can be set.
    pub fn formula(&self, name: &str) -> Option<&Expression> {
        self.formulas.0.get(name)
    }

    /// The formulas.
    pub fn formulas(&self) -> &Formulas {
        &self.formulas
    }

    /// Name and value of every parameter that can be set.
    pub fn free(&self) -> impl Iterator<Item = (&String, f64)> {
        self.values.iter().filter(|(name, _)| self.formula(name).is_none()).map(|(name, value)| (name, *value))
    }

    /// Values and rates along one parameter.
    pub fn along(&self, name: &str) -> Along {
        let jet = |(known, value): (&String, &f64)| {
            (known.clone(), if known == name { Jet::parameter(*value) } else { Jet::constant(*value) })
        };
        let mut direction = Along(self.values.iter().map(jet).collect());
        for (formula, expression) in self.formulas.iter() {
            let jet = expression.evaluate(&|name| direction.of(name));
            direction.0.insert(formula.to_owned(), jet);
        }
        direction
    }
}

/// Every parameter and formula with its rate along one of the parameters.
pub struct Along(HashMap<String, Jet>);

impl Along {
    /// One of them.
    pub fn of(&self, name: &str) -> Jet {
        self.0.get(name).copied().unwrap_or(Jet::constant(f64::NAN))
    }

    /// How a number depends on the parameter.
    pub fn dependence(&self, number: &Number) -> Dependence {
        number.along(self).dependence
    }
}

impl Deref for ParameterValues {
    type Target = IndexMap<String, f64>;
    fn deref(&self) -> &IndexMap<String, f64> {
        &self.values
    }
}

impl<'v> IntoIterator for &'v ParameterValues {
    type Item = (&'v String, &'v f64);
    type IntoIter = indexmap::map::Iter<'v, String, f64>;
    fn into_iter(self) -> Self::IntoIter {
        self.values.iter()
    }
}

impl<const N: usize> From<[(String, f64); N]> for ParameterValues {
    fn from(values: [(String, f64); N]) -> Self {
        ParameterValues::with_formulas(values.into(), Arc::default())
    }
}

impl Serialize for ParameterValues {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.values.serialize(serializer)
    }
}

/// What the scenario says of one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Value at load.
    pub value: f64,
    /// The formula that gives its value; such a parameter cannot be set.
    pub formula: Option<Expression>,
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

#[cfg(test)]
mod tests {
    use super::*;

    fn expression(text: &str) -> Expression {
        Expression::parse(text, &["F", "h", "M", "W"]).unwrap()
    }

    fn values() -> ParameterValues {
        let formulas = Formulas::new(vec![("M".into(), expression("F*h/2")), ("W".into(), expression("M + F"))]);
        let free = [("F", 10.0), ("M", 0.0), ("h", 4.0), ("W", 0.0)];
        let free = free.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
        ParameterValues::with_formulas(free, Arc::new(formulas))
    }

    #[test]
    fn formulas_follow_what_is_set() {
        let mut values = values();
        assert_eq!((values["M"], values["W"]), (20.0, 30.0));
        assert_eq!(values.insert("h".into(), 2.0), Some(4.0));
        assert_eq!((values["M"], values["W"]), (10.0, 20.0));
        values.insert("M".into(), 99.0);
        assert_eq!(values["M"], 10.0);
        let free: Vec<&str> = values.free().map(|(name, _)| name.as_str()).collect();
        assert_eq!(free, ["F", "h"]);
    }

    #[test]
    fn dependences_go_through_formulas() {
        let values = values();
        let free = values.formulas().free(["W"]);
        assert_eq!(free.into_iter().collect::<Vec<_>>(), ["F", "h"]);
        // W = F h / 2 + F: dW/dF = h/2 + 1 = 3, affine; W² is not.
        let along = values.along("F");
        let w = Number::Parameter("W".into()).along(&along);
        assert_eq!((w.value, w.rate, w.dependence), (30.0, 3.0, Dependence::Affine));
        let square = Number::Expression(expression("W^2")).along(&along);
        assert_eq!((square.rate, square.dependence), (180.0, Dependence::Nonlinear));
        assert_eq!(values.along("other").dependence(&Number::Parameter("W".into())), Dependence::Constant);
    }
}
