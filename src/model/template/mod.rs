//! `new`: scenarios to begin with. A template is the text of a scenario whose dimensions are parameters; where the
//! count of its parts varies, the text is written for that count.
//!
//! To add a kind: a file here with its `TEMPLATE` (the text may be that of an embedded scenario), and its line in
//! [`ALL`].

mod arch;
mod block;
mod block_stack;
mod continuous_beam;
mod dam;
mod footing;
mod pipeline;
mod portal;
mod press_fit;
mod retaining_wall;
mod wall;

use std::path::Path;

use jsonc_parser::ParseOptions;
use jsonc_parser::cst::CstRootNode;
use thiserror::Error;

use super::amend::{self, Amended};
use super::expression::Expression;
use super::jet::Jet;
use super::load::load_text;
use super::parameter::{Parameter, ParameterValues};
use super::problem::Problems;
use super::scenario::Scenario;
use super::words::did_you_mean_typed;

/// All kinds, in the order of the list.
pub const ALL: &[Template] = &[
    portal::TEMPLATE,
    continuous_beam::TEMPLATE,
    pipeline::TEMPLATE,
    block::TEMPLATE,
    block_stack::TEMPLATE,
    wall::TEMPLATE,
    arch::TEMPLATE,
    dam::TEMPLATE,
    footing::TEMPLATE,
    retaining_wall::TEMPLATE,
    press_fit::TEMPLATE,
];

/// A kind of structure to begin with.
pub struct Template {
    /// Its word.
    pub kind: &'static str,
    /// How many parts it has.
    counts: &'static [Count],
    /// What its parameters must fulfil together.
    needs: &'static [Need],
    /// The text of the scenario for these counts, in their order; the parameters stand at their defaults.
    text: fn(&[usize]) -> String,
}

/// A number of parts.
pub struct Count {
    name: &'static str,
    default: usize,
    /// The least and the largest: what solves in seconds.
    range: (usize, usize),
    about: &'static str,
}

/// One expression of the parameters that must be less than another one, or the structure makes no sense.
struct Need {
    less: &'static str,
    than: &'static str,
    why: &'static str,
}

/// What can be chosen of a template: a count or a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Its name.
    pub name: String,
    /// What it is if it is not chosen.
    pub default: f64,
    /// Whether it counts parts.
    pub count: bool,
    /// Range: of a count what is allowed, of a parameter that of its slider.
    pub range: Option<(f64, f64)>,
    /// Unit.
    pub unit: Option<String>,
    /// What it means.
    pub about: String,
}

/// Why `new` cannot make what was asked for.
#[derive(Debug, Error)]
pub enum TemplateError {
    /// No such kind.
    #[error("`{kind}` is not a kind of structure{near}: the kinds are {known} (`new` lists them with their names)")]
    Kind {
        /// The word.
        kind: String,
        /// The question whether a near one was meant, or nothing.
        near: String,
        /// All of them.
        known: String,
    },
    /// No such name.
    #[error("{kind} has no `{name}`{near}: its names are {known}")]
    Name {
        /// The kind.
        kind: &'static str,
        /// The word.
        name: String,
        /// The question whether a near one was meant, or nothing.
        near: String,
        /// All of them.
        known: String,
    },
    /// A name that is given twice.
    #[error("`{0}` is given twice: once will do")]
    Twice(String),
    /// A value that its name cannot have.
    #[error("`{name}` is the {about}: expected {expected}, found `{found}`")]
    Value {
        /// The name.
        name: String,
        /// What it means.
        about: String,
        /// What it may be.
        expected: String,
        /// What was given.
        found: String,
    },
    /// Values that do not go together.
    #[error("{why}: {less} = {small} must be less than {than} = {large}")]
    Need {
        /// What would be wrong.
        why: &'static str,
        /// The expression that must be less.
        less: &'static str,
        /// Its value.
        small: f64,
        /// The other one.
        than: &'static str,
        /// Its value.
        large: f64,
    },
    /// The scenario with these values has problems of its own.
    #[error("with these values the scenario would have problems:\n{0}")]
    Scenario(Problems),
    /// An error of this program.
    #[error("the template of {kind} is broken, please report this: {what}")]
    Broken {
        /// The kind.
        kind: &'static str,
        /// What is wrong with it.
        what: String,
    },
}

/// The template of a kind.
///
/// # Errors
/// There is no such kind.
pub fn find(kind: &str) -> Result<&'static Template, TemplateError> {
    ALL.iter().find(|template| template.kind == kind).ok_or_else(|| {
        let kinds: Vec<&str> = ALL.iter().map(|template| template.kind).collect();
        TemplateError::Kind {
            kind: kind.to_owned(),
            near: did_you_mean_typed(kind, kinds.iter().copied()),
            known: kinds.join(", "),
        }
    })
}

impl Template {
    /// The scenario as it is without any choice.
    ///
    /// # Errors
    /// The template is broken; a test loads them all.
    pub fn default_scenario(&self) -> Result<Scenario, TemplateError> {
        let counts: Vec<usize> = self.counts.iter().map(|count| count.default).collect();
        load_text(self.kind, &(self.text)(&counts), None).map_err(TemplateError::Scenario)
    }

    /// What can be chosen: the counts, then the parameters of `scenario`, one of this template.
    pub fn choices(&self, scenario: &Scenario) -> Vec<Choice> {
        let counts = self.counts.iter().map(|count| Choice {
            name: count.name.to_owned(),
            default: count.default as f64,
            count: true,
            range: Some((count.range.0 as f64, count.range.1 as f64)),
            unit: None,
            about: count.about.to_owned(),
        });
        let free = scenario.parameters.iter().filter(|(_, parameter)| parameter.formula.is_none());
        let parameters = free.map(|(name, parameter)| Choice {
            name: name.clone(),
            default: parameter.value,
            count: false,
            range: parameter.min.zip(parameter.max),
            unit: parameter.unit.clone(),
            about: parameter.about.clone().unwrap_or_default(),
        });
        counts.chain(parameters).collect()
    }

    /// The scenario with the given names and values, checked, as it will stand in `path`.
    ///
    /// # Errors
    /// [`TemplateError`]
    pub fn scenario(&self, given: &[(String, String)], path: &Path) -> Result<Scenario, TemplateError> {
        for (index, (name, _)) in given.iter().enumerate() {
            if given[..index].iter().any(|(before, _)| before == name) {
                return Err(TemplateError::Twice(name.clone()));
            }
        }
        let counts = self.counts.iter().map(|count| match given.iter().find(|(name, _)| name == count.name) {
            Some((_, value)) => count.read(value),
            None => Ok(count.default),
        });
        let counts: Vec<usize> = counts.collect::<Result<_, _>>()?;
        let text = (self.text)(&counts);
        let plain = load_text(self.kind, &text, None).map_err(TemplateError::Scenario)?;
        let mut values = plain.parameter_values();
        for (name, value) in given.iter().filter(|(name, _)| self.counts.iter().all(|count| count.name != name)) {
            let parameter = plain.parameters.get(name).filter(|parameter| parameter.formula.is_none());
            let parameter = parameter.ok_or_else(|| self.unknown(name, &plain))?;
            values.insert(name.clone(), number(name, parameter, value)?);
        }
        self.check_needs(&values)?;
        let text = self.with_values(&text, &plain, &values)?;
        load_text(&path.display().to_string(), &text, Some(path)).map_err(TemplateError::Scenario)
    }

    fn unknown(&self, name: &str, scenario: &Scenario) -> TemplateError {
        let names: Vec<String> = self.choices(scenario).into_iter().map(|choice| choice.name).collect();
        TemplateError::Name {
            kind: self.kind,
            name: name.to_owned(),
            near: did_you_mean_typed(name, names.iter().map(String::as_str)),
            known: names.join(", "),
        }
    }

    fn check_needs(&self, values: &ParameterValues) -> Result<(), TemplateError> {
        let names: Vec<&str> = values.keys().map(String::as_str).collect();
        let value = |text: &str| {
            let expression = Expression::parse(text, &names)
                .map_err(|error| TemplateError::Broken { kind: self.kind, what: format!("{text}: {error:?}") })?;
            Ok(expression.evaluate(&|name| Jet::constant(values[name])).value)
        };
        for need in self.needs {
            let (small, large) = (value(need.less)?, value(need.than)?);
            if small >= large {
                return Err(TemplateError::Need { why: need.why, less: need.less, small, than: need.than, large });
            }
        }
        Ok(())
    }

    /// The text with the chosen values in place of the defaults; a slider that does not reach a value is widened.
    fn with_values(&self, text: &str, plain: &Scenario, values: &ParameterValues) -> Result<String, TemplateError> {
        let broken = |what: String| TemplateError::Broken { kind: self.kind, what };
        let root = CstRootNode::parse(text, &ParseOptions::default()).map_err(|error| broken(error.to_string()))?;
        let object = root.object_value().ok_or_else(|| broken("no object".to_owned()))?;
        for (name, value) in values.free() {
            let of_file = &plain.parameters[name];
            if of_file.value.to_bits() == value.to_bits() {
                continue;
            }
            let put = |key, value| amend::set_parameter(&object, name, key, value).map_err(&broken);
            put(Amended::Value, value)?;
            if of_file.min.is_some_and(|min| value < min) {
                put(Amended::Min, value)?;
            }
            if of_file.max.is_some_and(|max| value > max) {
                put(Amended::Max, value)?;
            }
        }
        Ok(root.to_string())
    }
}

impl Count {
    fn read(&self, text: &str) -> Result<usize, TemplateError> {
        let (least, largest) = self.range;
        text.parse().ok().filter(|count| (least..=largest).contains(count)).ok_or_else(|| TemplateError::Value {
            name: self.name.to_owned(),
            about: self.about.to_owned(),
            expected: format!("a whole number from {least} to {largest}"),
            found: text.to_owned(),
        })
    }
}

/// The value of a parameter. Its slider says which signs make sense.
fn number(name: &str, parameter: &Parameter, text: &str) -> Result<f64, TemplateError> {
    let positive = parameter.min.is_some_and(|min| min > 0.0);
    let not_negative = parameter.min.is_some_and(|min| min >= 0.0);
    let fits = |value: &f64| value.is_finite() && !(positive && *value <= 0.0) && !(not_negative && *value < 0.0);
    text.parse().ok().filter(fits).ok_or_else(|| TemplateError::Value {
        name: name.to_owned(),
        about: parameter.about.clone().unwrap_or_default(),
        expected: match (positive, not_negative) {
            (true, _) => "a number greater than 0".to_owned(),
            (_, true) => "a number that is not negative".to_owned(),
            _ => "a number".to_owned(),
        },
        found: text.to_owned(),
    })
}

/// Lines of a list of the text, a comma between them.
fn lines(lines: impl IntoIterator<Item = String>) -> String {
    lines.into_iter().collect::<Vec<_>>().join(",\n    ")
}

#[cfg(test)]
mod tests;
