//! Typed reading of a JSON tree that goes on after a problem, so that one pass finds them all.
//!
//! A [`Cursor`] stands on one value. Its accessors return `None` after having reported what is wrong at that
//! place; the caller leaves the part out and reads on.

use std::cell::RefCell;
use std::collections::HashMap;
use std::fmt::Display;

use jsonc_parser::ast::{ObjectProp, Value};
use jsonc_parser::common::Ranged;

use super::words::{did_you_mean, listed, quoted};
use crate::model::locate::{self, Document};
use crate::model::parameter::{Number, Parameter};
use crate::model::problem::{LISTED, Problem, Problems};

/// Numbers beyond this are refused: their squares must stay finite.
const LARGEST: f64 = 1e150;

/// Problems beyond this many are only counted.
const KEPT: usize = 10_000;

/// Parameters by name; `None` where the definition itself is wrong.
pub type Parameters = indexmap::IndexMap<String, Option<Parameter>>;

struct Finding {
    offset: usize,
    message: String,
    help: String,
}

/// The problems found so far.
#[derive(Default)]
pub struct Findings {
    kept: RefCell<Vec<Finding>>,
    total: std::cell::Cell<usize>,
}

impl Findings {
    fn add(&self, offset: usize, message: String, help: String) {
        self.total.set(self.total.get() + 1);
        let mut kept = self.kept.borrow_mut();
        if kept.len() < KEPT {
            kept.push(Finding {
                offset,
                message,
                help,
            });
        }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.total.get()
    }

    /// The problems in the order of the file, each with its place; `None` without any.
    pub fn into_problems(self, file: &str, document: &Document<'_>) -> Option<Problems> {
        let total = self.total.get();
        let mut findings = self.kept.into_inner();
        if findings.is_empty() {
            return None;
        }
        findings.sort_by_key(|finding| finding.offset);
        findings.truncate(LISTED);
        let problems: Vec<Problem> = findings
            .into_iter()
            .map(|finding| {
                let (line, column) = document.position(finding.offset);
                Problem {
                    line,
                    column,
                    path: document.path_at(finding.offset),
                    message: finding.message,
                    help: finding.help,
                }
            })
            .collect();
        Some(Problems {
            file: file.to_string(),
            more: total - problems.len(),
            problems,
        })
    }
}

/// A place in the text: a value or a key.
#[derive(Clone, Copy)]
pub struct Place<'d> {
    offset: usize,
    findings: &'d Findings,
}

impl Place<'_> {
    /// Reports a problem at this place.
    pub fn problem(self, message: impl Into<String>, help: impl Into<String>) {
        self.findings.add(self.offset, message.into(), help.into());
    }
}

/// A position in the tree: one value.
#[derive(Clone, Copy)]
pub struct Cursor<'d> {
    value: &'d Value<'d>,
    findings: &'d Findings,
}

impl<'d> Cursor<'d> {
    /// The outermost value.
    pub fn root(document: &'d Document<'d>, findings: &'d Findings) -> Self {
        Cursor {
            value: document.root(),
            findings,
        }
    }

    /// Reports a problem at this value.
    pub fn problem(self, message: impl Into<String>, help: impl Into<String>) {
        self.findings
            .add(self.value.start(), message.into(), help.into());
    }

    /// How many problems were reported so far, anywhere.
    pub fn problems_so_far(self) -> usize {
        self.findings.count()
    }

    /// The place of the value.
    pub fn place(self) -> Place<'d> {
        Place {
            offset: self.value.start(),
            findings: self.findings,
        }
    }

    /// What stands here, for messages: `the number 5`, `the string "x"`, `an object`.
    pub fn found(self) -> String {
        match self.value {
            Value::StringLit(string) => format!("the string {}", quoted(&string.value)),
            Value::NumberLit(number) => format!("the number {}", shortened(number.value)),
            Value::BooleanLit(boolean) => format!("`{}`", boolean.value),
            Value::NullKeyword(_) => "`null`".into(),
            Value::Array(array) => format!("a list of {}", array.elements.len()),
            Value::Object(_) => "an object".into(),
        }
    }

    fn wrong_type(self, expected: &str) {
        self.problem(
            format!("expected {expected}, found {}", self.found()),
            String::new(),
        );
    }

    /// Whether a string stands here.
    pub fn is_string(self) -> bool {
        matches!(self.value, Value::StringLit(_))
    }

    /// Whether a list stands here.
    pub fn is_list(self) -> bool {
        matches!(self.value, Value::Array(_))
    }

    /// Whether an object stands here.
    pub fn is_object(self) -> bool {
        matches!(self.value, Value::Object(_))
    }

    /// A string.
    pub fn string(self) -> Option<&'d str> {
        match self.value {
            Value::StringLit(string) => Some(string.value.as_ref()),
            _ => {
                self.wrong_type("a string");
                None
            }
        }
    }

    /// A string that is one of `words`.
    pub fn choice<T: Copy>(self, words: &[(&'static str, T)]) -> Option<T> {
        let word = self.string()?;
        let found = words.iter().find(|(name, _)| *name == word);
        if found.is_none() {
            let names: Vec<&str> = words.iter().map(|(name, _)| *name).collect();
            self.unknown("word", word, &names);
        }
        found.map(|(_, value)| *value)
    }

    /// Reports a word that names nothing known.
    pub fn unknown(self, what: &str, word: &str, known: &[&str]) {
        let help = match known {
            [] => format!("there is no {what} here to name"),
            _ => format!("expected {}", listed(known)),
        };
        self.problem(
            format!(
                "unknown {what} {}{}",
                quoted(word),
                did_you_mean(word, known.iter().copied())
            ),
            help,
        );
    }

    /// A finite number.
    pub fn number(self) -> Option<f64> {
        let Value::NumberLit(number) = self.value else {
            let help = if self.is_string() {
                "only factors, friction, cohesion, gap, bound and the q of an lcp take the name of a parameter"
            } else {
                ""
            };
            self.problem(format!("expected a number, found {}", self.found()), help);
            return None;
        };
        self.magnitude(number.value)
    }

    fn magnitude(self, literal: &str) -> Option<f64> {
        let value: f64 = match literal.parse() {
            Ok(value) => value,
            Err(_) => {
                self.wrong_type("a number");
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
                format!(
                    "the number {} is too large to compute with",
                    shortened(literal)
                ),
                "numbers go up to 1e150: choose other units",
            );
            return None;
        }
        Some(value)
    }

    /// A finite number that passes `is_right`; `expected` completes "… must be".
    pub fn number_that(
        self,
        what: &str,
        expected: &str,
        is_right: impl Fn(f64) -> bool,
    ) -> Option<f64> {
        let value = self.number()?;
        if is_right(value) {
            return Some(value);
        }
        self.problem(
            format!("{what} must be {expected}, found {}", self.found()),
            format!("give {what} a value {expected}"),
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
            format!(
                "{what} must be a whole number from {least}, found {}",
                self.found()
            ),
            "",
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
                self.wrong_type("a number or the name of a parameter");
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
                        format!(
                            "{what} must not be negative, but the parameter `{name}` has the value {value}"
                        ),
                        format!("give parameters.{name} a value of 0 or more"),
                    );
                    return None;
                }
                Some(number)
            }
            Number::Value(_) => Some(number),
        }
    }

    /// The entries of a list.
    pub fn list(self) -> Option<impl ExactSizeIterator<Item = Cursor<'d>>> {
        let Value::Array(array) = self.value else {
            self.wrong_type("a list");
            return None;
        };
        Some(array.elements.iter().map(move |value| Cursor {
            value,
            findings: self.findings,
        }))
    }

    /// The entries of a list that must have `count` of them; `what` says why.
    pub fn list_of(
        self,
        count: usize,
        what: &str,
    ) -> Option<impl ExactSizeIterator<Item = Cursor<'d>>> {
        let entries = self.list()?;
        if entries.len() != count {
            self.problem(
                format!("expected {count} entries, {what}, found {}", entries.len()),
                "",
            );
            return None;
        }
        Some(entries)
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
                    "",
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

    /// The entries of an object as a map from names the author chose; a repeated name is reported.
    pub fn entries(self) -> Option<Vec<Entry<'d>>> {
        let Value::Object(object) = self.value else {
            self.wrong_type("an object { … }");
            return None;
        };
        let mut seen: HashMap<&str, ()> = HashMap::new();
        let mut entries = Vec::with_capacity(object.properties.len());
        for property in &object.properties {
            let entry = Entry {
                property,
                findings: self.findings,
            };
            if seen.insert(entry.name(), ()).is_some() {
                entry.key_problem(
                    format!(
                        "the key {} appears twice in this object",
                        quoted(entry.name())
                    ),
                    "remove or rename one of the two",
                );
            } else {
                entries.push(entry);
            }
        }
        Some(entries)
    }

    /// The entries of an object with fixed keys; any other key is reported.
    pub fn fields(self, known: &[&'static str]) -> Option<Fields<'d>> {
        let entries = self.entries()?;
        for entry in &entries {
            if !known.contains(&entry.name()) {
                entry.key_problem(
                    format!(
                        "unknown key {}{}",
                        quoted(entry.name()),
                        did_you_mean(entry.name(), known.iter().copied())
                    ),
                    format!("known keys here: {}", known.join(", ")),
                );
            }
        }
        Some(Fields {
            cursor: self,
            entries,
        })
    }
}

/// One `key: value` of an object.
#[derive(Clone, Copy)]
pub struct Entry<'d> {
    property: &'d ObjectProp<'d>,
    findings: &'d Findings,
}

impl<'d> Entry<'d> {
    /// The key.
    pub fn name(self) -> &'d str {
        self.property.name.as_str()
    }

    /// The value.
    pub fn value(self) -> Cursor<'d> {
        Cursor {
            value: &self.property.value,
            findings: self.findings,
        }
    }

    /// The place of the key.
    pub fn key_place(self) -> Place<'d> {
        Place {
            offset: self.key_offset(),
            findings: self.findings,
        }
    }

    /// Byte offset of the key.
    pub fn key_offset(self) -> usize {
        locate::key_start(self.property)
    }

    /// Reports a problem at the key.
    pub fn key_problem(self, message: impl Into<String>, help: impl Into<String>) {
        self.key_place().problem(message, help);
    }
}

/// An object with fixed keys.
pub struct Fields<'d> {
    cursor: Cursor<'d>,
    entries: Vec<Entry<'d>>,
}

impl<'d> Fields<'d> {
    /// The object itself.
    pub fn cursor(&self) -> Cursor<'d> {
        self.cursor
    }

    /// The entry of a key, if the key is there.
    pub fn entry(&self, key: &str) -> Option<Entry<'d>> {
        self.entries
            .iter()
            .find(|entry| entry.name() == key)
            .copied()
    }

    /// The value of a key, if the key is there.
    pub fn optional(&self, key: &str) -> Option<Cursor<'d>> {
        self.entry(key).map(Entry::value)
    }

    /// The value of a key; reported if it is missing.
    pub fn required(&self, key: &str) -> Option<Cursor<'d>> {
        let found = self.optional(key);
        if found.is_none() {
            self.cursor
                .problem(format!("missing key `{key}`"), format!("add \"{key}\": …"));
        }
        found
    }

    /// Reports keys that are there but belong elsewhere.
    pub fn refuse(&self, keys: &[&str], message: impl Fn(&str) -> String, help: impl Display) {
        for entry in &self.entries {
            if keys.contains(&entry.name()) {
                entry.key_problem(message(entry.name()), help.to_string());
            }
        }
    }
}

fn shortened(literal: &str) -> String {
    if literal.len() <= 30 {
        literal.to_string()
    } else {
        // JSON numbers are ASCII, so any byte is a boundary.
        format!("{}…", &literal[..27])
    }
}
