//! The words after `set`: which parameter or rule, and what becomes of it.

use thiserror::Error;

use crate::model::parameter::ParameterValues;
use crate::model::rules::{Rules, UnknownChoice};
use crate::model::scenario::{Scenario, Source};
use crate::model::structure::Dimension;

use crate::model::words::did_you_mean_typed;
use crate::text::words::list;

/// A `set` that cannot be done.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SetError {
    /// Name without value.
    #[error("`{name}` to what? Write `set {name} VALUE`, `set {name} += 10`, `set {name} 110%` …")]
    NoValue {
        /// The name.
        name: String,
    },
    /// No such parameter.
    #[error("unknown parameter `{name}`{near}: the scenario has {known}; rules are {rules}")]
    UnknownParameter {
        /// The name.
        name: String,
        /// "(did you mean …?)".
        near: String,
        /// The names that there are.
        known: String,
        /// The rules that have an effect in it.
        rules: String,
    },
    /// No number.
    #[error(
        "`{text}` is not a value for {name}: expected a number, `110%`, `+10%`, `-10%`, or one of += -= *= /= and a number"
    )]
    NoNumber {
        /// The parameter.
        name: String,
        /// What was written.
        text: String,
    },
    /// A value that the scenario cannot have.
    #[error("{0}")]
    Value(String),
    /// An unknown rule word.
    #[error(transparent)]
    Choice(#[from] UnknownChoice),
    /// `set auto maybe`.
    #[error("`set auto` takes on or off, not `{0}`")]
    Auto(String),
    /// `set facets` in the plane.
    #[error("`set {0}` is for problems in space: in the plane a pair slips along +t or -t only")]
    InPlane(&'static str),
    /// A covering for a bare LCP.
    #[error(
        "the covering of a bare LCP is given in its file (`lcp.covering`, ones by default): `set covering` is for contact problems"
    )]
    CoveringOfLcp,
}

/// A choice of how to solve, named and described.
#[derive(Debug)]
pub struct Rule {
    /// Its name after `set`.
    pub name: &'static str,
    /// What it is.
    pub about: &'static str,
    /// What it may be.
    pub choices: &'static [&'static str],
    /// What it is at present.
    pub shown: fn(&Rules) -> String,
    /// Changes it to one of the choices.
    pub set: fn(&mut Rules, &str) -> Result<(), UnknownChoice>,
}

/// The rules that `set` changes.
pub static RULES: [Rule; 5] = [
    Rule {
        name: "covering",
        about: "covering vector",
        choices: &["cohesive", "ones", "weight"],
        shown: |rules| rules.covering.to_string(),
        set: |rules, word| word.parse().map(|choice| rules.covering = choice),
    },
    Rule {
        name: "tie-break",
        about: "what decides among tied rows",
        choices: &["lexicographic", "natural", "first-row", "random:"],
        shown: |rules| rules.tie_break.to_string(),
        set: |rules, word| word.parse().map(|choice| rules.tie_break = choice),
    },
    Rule {
        name: "engine",
        about: "implementation of Lemke's algorithm",
        choices: &["scheme", "tableau", "exact"],
        shown: |rules| rules.engine.to_string(),
        set: |rules, word| word.parse().map(|choice| rules.engine = choice),
    },
    Rule {
        name: "facets",
        about: "facets of the friction polygon in space",
        choices: &["8", "16", "32"],
        shown: |rules| rules.facets.to_string(),
        set: Rules::set_facets,
    },
    Rule {
        name: "cone",
        about: "whether the answer in space is taken to Coulomb's cone",
        choices: &["on", "off"],
        shown: |rules| (if rules.cone { "on" } else { "off" }).to_owned(),
        set: Rules::set_cone,
    },
];

/// The rules that have an effect in the plane, or in space: those of the polygon belong to space.
pub fn rules_of(dimension: Dimension) -> impl Iterator<Item = &'static Rule> {
    RULES.iter().filter(move |rule| dimension == Dimension::Space || !matches!(rule.name, "facets" | "cone"))
}

/// The rule of a name.
pub fn rule(name: &str) -> Option<&'static Rule> {
    RULES.iter().find(|rule| rule.name == name)
}

/// What `set` does.
#[derive(Clone, Debug)]
pub enum Setting {
    /// A parameter and its new value.
    Parameter(String, f64),
    /// A rule and its new choice.
    Rule(&'static Rule, String),
    /// Whether changes are solved at once.
    Auto(bool),
}

/// The words of `set`, read against the scenario and the present values.
///
/// # Errors
/// [`SetError`].
pub fn read(words: &[String], scenario: &Scenario, values: &ParameterValues) -> Result<Setting, SetError> {
    let text = words.join(" ");
    let (name, rest) = name_and_rest(&text);
    let no_value = || SetError::NoValue { name: name.to_owned() };
    let choice = || {
        let word = rest.strip_prefix('=').unwrap_or(rest).trim();
        if word.is_empty() { Err(no_value()) } else { Ok(word) }
    };
    if let Some(rule) = rule(name).filter(|rule| rule.name != "covering" || !matches!(scenario.source, Source::Lcp(_)))
    {
        if rules_of(scenario.source.dimension()).all(|known| known.name != rule.name) {
            return Err(SetError::InPlane(rule.name));
        }
        let word = choice()?;
        (rule.set)(&mut Rules::default(), word)?;
        return Ok(Setting::Rule(rule, word.to_owned()));
    }
    match name {
        "covering" => Err(SetError::CoveringOfLcp),
        "auto" => match choice()? {
            "on" => Ok(Setting::Auto(true)),
            "off" => Ok(Setting::Auto(false)),
            other => Err(SetError::Auto(other.to_owned())),
        },
        _ => {
            let present = *values.get(name).ok_or_else(|| unknown_parameter(name, scenario))?;
            if rest.is_empty() || rest == "=" {
                return Err(no_value());
            }
            let value = changed(rest, present).ok_or_else(|| SetError::NoNumber {
                name: name.to_owned(),
                text: rest.strip_prefix('=').unwrap_or(rest).trim().to_owned(),
            })?;
            if let Some(refusal) = scenario.refusal(name, value) {
                return Err(SetError::Value(refusal));
            }
            Ok(Setting::Parameter(name.to_owned(), value))
        }
    }
}

/// The error for a name that is not a parameter.
pub fn unknown_parameter(name: &str, scenario: &Scenario) -> SetError {
    let names: Vec<&str> = scenario.parameters.keys().map(String::as_str).collect();
    let rules: Vec<&str> = rules_of(scenario.source.dimension()).map(|rule| rule.name).chain(["auto"]).collect();
    SetError::UnknownParameter {
        name: name.to_owned(),
        near: did_you_mean_typed(name, names.iter().chain(&rules).copied()),
        known: match names.len() {
            0 => "none".to_owned(),
            _ => names.join(", "),
        },
        rules: list(&rules.iter().map(ToString::to_string).collect::<Vec<_>>()),
    }
}

/// Splits `F2 += 10`, `F2+=10`, `f=0.3`, `f 0.3` after the name.
fn name_and_rest(text: &str) -> (&str, &str) {
    let text = text.trim();
    let mut end = text.find(|c: char| c.is_whitespace() || c == '=').unwrap_or(text.len());
    let before = text[..end].ends_with(['+', '-', '*', '/']);
    if before && text[end..].starts_with('=') {
        // the operator's first character belongs to the value: `F2+=10`
        end -= 1;
    }
    (&text[..end], text[end..].trim())
}

/// The new value; `None` if it cannot be read.
fn changed(rest: &str, present: f64) -> Option<f64> {
    for (operator, of) in [
        ("+=", (|a, b| a + b) as fn(f64, f64) -> f64),
        ("-=", |a, b| a - b),
        ("*=", |a, b| a * b),
        ("/=", |a, b| a / b),
    ] {
        if let Some(operand) = rest.strip_prefix(operator) {
            let operand = operand.trim();
            let number = match operand.strip_suffix('%') {
                // a share of the present value where it is added, a plain factor where it multiplies
                Some(percent) if operator.starts_with(['+', '-']) => present * number(percent)? / 100.0,
                Some(percent) => number(percent)? / 100.0,
                None => number(operand)?,
            };
            return Some(of(present, number));
        }
    }
    let rest = rest.strip_prefix('=').unwrap_or(rest).trim();
    let Some(percent) = rest.strip_suffix('%') else {
        return number(rest);
    };
    let share = number(percent)?;
    if percent.trim_start().starts_with(['+', '-']) {
        Some(present * (100.0 + share) / 100.0)
    } else {
        Some(present * share / 100.0)
    }
}

/// A decimal number; the words `inf` and `nan` are none.
pub fn number(text: &str) -> Option<f64> {
    let text = text.trim();
    let plain = text.chars().all(|c| c.is_ascii_digit() || "+-.eE".contains(c));
    text.parse().ok().filter(|_| plain)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_forms_of_a_value() {
        for (rest, value) in [
            ("120", 120.0),
            ("= 120", 120.0),
            ("=1.2e2", 120.0),
            ("+= 10", 110.0),
            ("-=10", 90.0),
            ("*= 2", 200.0),
            ("/= 4", 25.0),
            ("110%", 110.0),
            ("+10%", 110.0),
            ("-10%", 90.0),
            ("+= 10%", 110.0),
            ("*= 50%", 50.0),
            ("-5", -5.0),
        ] {
            assert_eq!(changed(rest, 100.0), Some(value), "{rest}");
        }
        for rest in ["", "x", "inf", "nan", "1 2", "%", "+=", "1,5", "0x10", "infinity%"] {
            assert_eq!(changed(rest, 100.0), None, "{rest}");
        }
    }

    #[test]
    fn names_with_and_without_blanks() {
        assert_eq!(name_and_rest("F2 120"), ("F2", "120"));
        assert_eq!(name_and_rest("F2=120"), ("F2", "=120"));
        assert_eq!(name_and_rest("F2+=10"), ("F2", "+=10"));
        assert_eq!(name_and_rest("my-name -= 10"), ("my-name", "-= 10"));
        assert_eq!(name_and_rest("F2"), ("F2", ""));
        assert_eq!(name_and_rest("="), ("", "="));
    }
}
