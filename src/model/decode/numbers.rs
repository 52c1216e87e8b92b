//! Reading numbers, vectors and names of parameters.

use jsonc_parser::ast::Value;

use super::reader::Cursor;
use super::words::{is_id, quoted};
use crate::model::parameter::{Number, Parameter};

/// Numbers beyond this are refused: their squares must stay finite.
const LARGEST: f64 = 1e150;

const PLAIN_NUMBER: &str = "write a plain number, like 0.5 or 2e8";
const NO_PARAMETER: &str = "write a plain number: only factors, friction, cohesion, gap, bound and the q of an lcp take the name of a parameter";

/// Parameters by name; `None` where the definition itself is wrong.
pub type Parameters = indexmap::IndexMap<String, Option<Parameter>>;

impl Cursor<'_> {
    /// A finite number.
    pub fn number(self) -> Option<f64> {
        let Value::NumberLit(number) = self.value else {
            let is_name = matches!(self.value, Value::StringLit(string) if is_id(&string.value));
            let help = if is_name { NO_PARAMETER } else { PLAIN_NUMBER };
            self.wrong_type("a number", help);
            return None;
        };
        self.magnitude(number.value)
    }

    fn magnitude(self, literal: &str) -> Option<f64> {
        let value: f64 = match literal.parse() {
            Ok(value) => value,
            Err(_) => {
                self.wrong_type("a number", PLAIN_NUMBER);
                return None;
            }
        };
        if !value.is_finite() {
            self.problem(
                format!("the number {} is not finite", shortened(literal)),
                "every number of a scenario is finite: write a smaller one",
            );
            return None;
        }
        if value.abs() > LARGEST {
            self.problem(
                format!("the number {} is too large to compute with", shortened(literal)),
                "numbers go up to 1e150: choose other units",
            );
            return None;
        }
        Some(value)
    }

    /// A finite number that passes `is_right`; `expected` completes "… must be".
    pub fn number_that(self, what: &str, expected: &str, is_right: impl Fn(f64) -> bool) -> Option<f64> {
        let value = self.number()?;
        if is_right(value) {
            return Some(value);
        }
        self.problem(
            format!("{what} must be {expected}, found {}", self.found()),
            format!("give {what} a value that is {expected}"),
        );
        None
    }

    /// A number > 0.
    pub fn positive(self, what: &str) -> Option<f64> {
        self.number_that(what, "greater than 0", |value| value > 0.0)
    }

    /// A whole number ≥ `least`.
    pub fn whole(self, what: &str, least: usize) -> Option<usize> {
        let value = self.number()?;
        // Up to 1e15 every whole number is exact in f64 and fits in usize.
        if value.fract() == 0.0 && value >= least as f64 && value <= 1e15 {
            return Some(value as usize);
        }
        self.problem(
            format!("{what} must be a whole number from {least}, found {}", self.found()),
            "write it without a fraction",
        );
        None
    }

    /// A number or the name of a parameter.
    pub fn number_or_parameter(self, parameters: &Parameters) -> Option<Number> {
        match self.value {
            Value::StringLit(string) => {
                let name = string.value.as_ref();
                if parameters.contains_key(name) {
                    return Some(Number::Parameter(name.to_string()));
                }
                let known: Vec<&str> = parameters.keys().map(String::as_str).collect();
                if known.is_empty() {
                    self.problem(
                        format!("unknown parameter {}: the scenario has none", quoted(name)),
                        "write a number, or define the name under `parameters`",
                    );
                } else {
                    self.unknown("parameter", name, &known);
                }
                None
            }
            Value::NumberLit(number) => self.magnitude(number.value).map(Number::Value),
            _ => {
                self.wrong_type("a number or the name of a parameter", "write one of the two");
                None
            }
        }
    }

    /// A number ≥ 0 or the name of a parameter whose value is.
    pub fn non_negative(self, what: &str, parameters: &Parameters) -> Option<Number> {
        let number = self.number_or_parameter(parameters)?;
        match &number {
            Number::Value(value) if *value < 0.0 => {
                self.problem(
                    format!("{what} must not be negative, found {}", self.found()),
                    format!("give a {what} of 0 or more"),
                );
                None
            }
            Number::Parameter(name) => {
                let value = parameters.get(name)?.as_ref()?.value;
                if value < 0.0 {
                    self.problem(
                        format!("{what} must not be negative, but the parameter `{name}` has the value {value}"),
                        format!("give parameters.{name} a value of 0 or more"),
                    );
                    return None;
                }
                Some(number)
            }
            Number::Value(_) => Some(number),
        }
    }

    /// Two numbers: a point or a vector.
    pub fn vector(self) -> Option<[f64; 2]> {
        match self.list() {
            None => None,
            Some(entries) if entries.len() == 2 => {
                let numbers: Vec<Option<f64>> = entries.map(Cursor::number).collect();
                Some([numbers[0]?, numbers[1]?])
            }
            Some(_) => {
                self.problem(
                    format!("expected two numbers [x, y], found {}", self.found()),
                    "points and vectors lie in the plane: give x and y",
                );
                None
            }
        }
    }

    /// A vector that is not zero, made a unit vector.
    pub fn direction(self, what: &str) -> Option<[f64; 2]> {
        let [x, y] = self.vector()?;
        let length = x.hypot(y);
        if length > 0.0 {
            // Scaled first: of a subnormal length the quotient would lose its digits.
            let scale = x.abs().max(y.abs());
            let (x, y) = (x / scale, y / scale);
            let length = x.hypot(y);
            return Some([x / length, y / length]);
        }
        self.problem(
            format!("{what} is [0, 0] and has no direction"),
            format!("give any non-zero vector, e.g. [0, 1] for a {what} upwards"),
        );
        None
    }

    /// `count` numbers.
    pub fn numbers(self, count: usize, what: &str) -> Option<Vec<f64>> {
        let entries = self.list_of(count, what)?;
        let numbers: Vec<Option<f64>> = entries.map(Cursor::number).collect();
        numbers.into_iter().collect()
    }
}

/// A number as written, cut where it is very long.
pub fn shortened(literal: &str) -> String {
    if literal.len() <= 30 {
        literal.to_string()
    } else {
        // JSON numbers are ASCII, so any byte is a boundary.
        format!("{}…", &literal[..27])
    }
}
