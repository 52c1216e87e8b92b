//! `expect`: what a script asserts of the present answer.

use std::fmt;

use thiserror::Error;

use crate::answer::record::{NodeDisplacement, PairState};
use crate::view::status::{class_word, outcome_word, verdict_word};

use super::command::did_you_mean;
use super::values::number;

/// Comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// `=`
    Equal,
    /// `!=`
    NotEqual,
    /// `<`
    Less,
    /// `<=`
    LessEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterEqual,
}

/// A number compared with what is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    operator: Operator,
    value: f64,
    tolerance: f64,
}

/// A quantity of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PairQuantity {
    /// Compressive force.
    XN,
    /// Tangential force.
    XT,
    /// Distance open.
    ZN,
    /// Slip.
    ZT,
    /// Friction bound.
    Bound,
    /// x⁺.
    ReservePlus,
    /// x⁻.
    ReserveMinus,
}

/// What is expected.
#[derive(Clone, Debug, PartialEq)]
pub enum Expectation {
    /// How the run ended.
    Outcome(String),
    /// State of a pair.
    State {
        /// Pair id.
        pair: String,
        /// State word.
        state: String,
    },
    /// A number of a pair.
    Pair {
        /// Which.
        quantity: PairQuantity,
        /// Pair id.
        pair: String,
        /// Compared with.
        bound: Bound,
    },
    /// A displacement.
    Node {
        /// `ux`, `uy` or `rz`.
        component: String,
        /// Node id.
        node: String,
        /// Compared with.
        bound: Bound,
    },
    /// p.
    P(Bound),
    /// The number of pivots.
    Pivots(Bound),
    /// A size of the problem.
    Size {
        /// `unknowns`, `free` or `lcp`.
        what: String,
        /// Compared with.
        bound: Bound,
    },
    /// Class of the ray.
    Ray(String),
    /// Verdict on the ray.
    Verdict(String),
    /// Part of the message of the command before.
    Error(String),
}

/// Words that are no expectation.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("expect: {what}; see `help expect`")]
pub struct ExpectationSyntax {
    what: String,
}

/// An expectation that does not hold.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("expected {expected}, found {found}")]
pub struct Unmet {
    /// What was expected.
    pub expected: String,
    /// What there is.
    pub found: String,
}

/// What expectations are compared with.
pub struct Facts<'a> {
    /// Outcome, ray, pivots.
    pub answer: Option<&'a crate::answer::record::Answer>,
    /// The pairs at the present pivot.
    pub pairs: &'a [PairState],
    /// p at the present pivot.
    pub p: Option<f64>,
    /// The displacements at the present pivot.
    pub displacements: Option<&'a [NodeDisplacement]>,
    /// Message of the command before, if it failed.
    pub error: Option<&'a str>,
}

const OUTCOMES: &[&str] = &["trivial", "normal", "ray", "pivot-limit", "breakdown", "check-failed"];
const STATES: &[&str] = &["open", "stick", "slip+", "slip-", "closed"];
const CLASSES: &[&str] = &["mechanism", "artefact", "fault", "no-equilibrium"];
const VERDICTS: &[&str] = &["certified", "proved", "undecided"];
const QUANTITIES: &[(&str, PairQuantity)] = &[
    ("x_n", PairQuantity::XN),
    ("x_t", PairQuantity::XT),
    ("z_n", PairQuantity::ZN),
    ("z_t", PairQuantity::ZT),
    ("bound", PairQuantity::Bound),
    ("reserve_plus", PairQuantity::ReservePlus),
    ("reserve_minus", PairQuantity::ReserveMinus),
];
const COMPONENTS: &[&str] = &["ux", "uy", "rz"];
const SIZES: &[&str] = &["unknowns", "free", "lcp"];
const OTHERS: &[&str] = &["outcome", "state", "p", "pivots", "ray", "verdict", "error"];

/// What asks for the end of a stage of the history.
pub const STAGE: &str = "stage";

/// The words that may follow `expect`, or `expect stage S`.
pub fn subjects() -> impl Iterator<Item = &'static str> {
    OTHERS
        .iter()
        .copied()
        .chain(QUANTITIES.iter().map(|(word, _)| *word))
        .chain(COMPONENTS.iter().copied())
        .chain(SIZES.iter().copied())
}

/// The words that may follow a subject, where it has a closed list.
pub fn choices(subject: &str) -> &'static [&'static str] {
    match subject {
        "outcome" => OUTCOMES,
        "ray" => CLASSES,
        "verdict" => VERDICTS,
        "state" => STATES,
        _ => &[],
    }
}

/// Whether a subject is followed by a pair.
pub fn takes_pair(subject: &str) -> bool {
    subject == "state" || QUANTITIES.iter().any(|(word, _)| *word == subject)
}

/// Whether a subject is followed by a node.
pub fn takes_node(subject: &str) -> bool {
    COMPONENTS.contains(&subject)
}

/// The stage of `stage S …`, counted from 1, and the words after it.
///
/// # Errors
/// [`ExpectationSyntax`].
pub fn stage(words: &[String]) -> Result<(Option<usize>, &[String]), ExpectationSyntax> {
    match words {
        [word, rest @ ..] if word == STAGE => match rest.split_first().map(|(number, rest)| (number.parse(), rest)) {
            Some((Ok(number), rest)) if !rest.is_empty() => Ok((Some(number), rest)),
            _ => Err(ExpectationSyntax {
                what: "`stage` takes the number of a stage, counted from 1, and what is expected at its end".into(),
            }),
        },
        _ => Ok((None, words)),
    }
}

/// Reads the words after `expect`, or after `expect stage S`.
///
/// # Errors
/// [`ExpectationSyntax`].
pub fn read(words: &[String]) -> Result<Expectation, ExpectationSyntax> {
    let bad = |what: String| ExpectationSyntax { what };
    let Some((subject, rest)) = words.split_first() else {
        return Err(bad("what is expected?".into()));
    };
    let one_of = |allowed: &[&str]| match rest {
        [word] if allowed.contains(&word.as_str()) => Ok(word.clone()),
        [word] => Err(bad(format!(
            "`{word}` is no {subject}{}: expected {}",
            did_you_mean(word, allowed.iter().copied()),
            allowed.join(", ")
        ))),
        _ => Err(bad(format!("`{subject}` takes one of {}", allowed.join(", ")))),
    };
    let named = |what: &str| rest.split_first().ok_or_else(|| bad(format!("`{subject}` of which {what}?")));
    match subject.as_str() {
        "outcome" => Ok(Expectation::Outcome(one_of(OUTCOMES)?)),
        "ray" => Ok(Expectation::Ray(one_of(CLASSES)?)),
        "verdict" => Ok(Expectation::Verdict(one_of(VERDICTS)?)),
        "error" if rest.is_empty() => Err(bad("`error` takes a part of the message".into())),
        "error" => Ok(Expectation::Error(rest.join(" "))),
        "p" => Ok(Expectation::P(bound(rest)?)),
        "pivots" => Ok(Expectation::Pivots(bound(rest)?)),
        size if SIZES.contains(&size) => Ok(Expectation::Size { what: size.to_owned(), bound: bound(rest)? }),
        "state" => match rest {
            [pair, state] if STATES.contains(&state.as_str()) => {
                Ok(Expectation::State { pair: pair.clone(), state: state.clone() })
            }
            _ => Err(bad(format!("`state` takes a pair and one of {}", STATES.join(", ")))),
        },
        component if COMPONENTS.contains(&component) => {
            let (node, rest) = named("node")?;
            Ok(Expectation::Node { component: component.to_owned(), node: node.clone(), bound: bound(rest)? })
        }
        word => {
            let Some((_, quantity)) = QUANTITIES.iter().find(|(name, _)| *name == word) else {
                return Err(bad(format!(
                    "unknown `{word}`{}: expected one of {}",
                    did_you_mean(word, subjects()),
                    subjects().collect::<Vec<_>>().join(", ")
                )));
            };
            let (pair, rest) = named("pair")?;
            Ok(Expectation::Pair { quantity: *quantity, pair: pair.clone(), bound: bound(rest)? })
        }
    }
}

/// `= 100 ± 1e-6`, `<=20`, with or without blanks.
fn bound(words: &[String]) -> Result<Bound, ExpectationSyntax> {
    let text = words.concat();
    let bad = || ExpectationSyntax {
        what: format!(
            "`{}` is no comparison: expected one of = != < <= > >= and a number, after `=` also `± TOLERANCE`",
            words.join(" ")
        ),
    };
    let operators = [
        ("<=", Operator::LessEqual),
        (">=", Operator::GreaterEqual),
        ("!=", Operator::NotEqual),
        ("==", Operator::Equal),
        ("=", Operator::Equal),
        ("<", Operator::Less),
        (">", Operator::Greater),
    ];
    let (operator, rest) =
        operators.iter().find_map(|(sign, operator)| Some((*operator, text.strip_prefix(sign)?))).ok_or_else(bad)?;
    let (value, tolerance) = match rest.split_once('±').or_else(|| rest.split_once("+-")) {
        Some((value, tolerance)) => (value, Some(tolerance)),
        None => (rest, None),
    };
    let value = number(value).filter(|v| v.is_finite()).ok_or_else(bad)?;
    let tolerance = match tolerance {
        None => 0.0,
        Some(_) if operator != Operator::Equal => return Err(bad()),
        Some(text) => match text.strip_suffix('%') {
            Some(percent) => number(percent).ok_or_else(bad)? / 100.0 * value.abs(),
            None => number(text).ok_or_else(bad)?,
        },
    };
    if !(tolerance >= 0.0 && tolerance.is_finite()) {
        return Err(bad());
    }
    Ok(Bound { operator, value, tolerance })
}

impl Bound {
    fn holds(&self, found: f64) -> bool {
        match self.operator {
            Operator::Equal => (found - self.value).abs() <= self.tolerance,
            Operator::NotEqual => found != self.value,
            Operator::Less => found < self.value,
            Operator::LessEqual => found <= self.value,
            Operator::Greater => found > self.value,
            Operator::GreaterEqual => found >= self.value,
        }
    }
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = match self.operator {
            Operator::Equal => "=",
            Operator::NotEqual => "!=",
            Operator::Less => "<",
            Operator::LessEqual => "<=",
            Operator::Greater => ">",
            Operator::GreaterEqual => ">=",
        };
        write!(f, "{sign} {}", shown(self.value))?;
        if self.tolerance > 0.0 {
            write!(f, " ± {}", shown(self.tolerance))?;
        }
        Ok(())
    }
}

/// A number in full, with an exponent where it would be long.
fn shown(value: f64) -> String {
    if value == 0.0 || (1e-4..1e15).contains(&value.abs()) { value.to_string() } else { format!("{value:e}") }
}

impl Expectation {
    /// Compares with the facts.
    ///
    /// # Errors
    /// `Err(Ok(unmet))` if it does not hold; `Err(Err(what))` if it asks for a pair or node that does not exist.
    pub fn test(&self, facts: &Facts<'_>) -> Result<(), Result<Unmet, String>> {
        let words = |expected: String, found: String| {
            if expected == found { Ok(()) } else { Err(Ok(Unmet { expected, found })) }
        };
        let compare = |what: String, bound: &Bound, found: Option<f64>| match found {
            Some(found) if bound.holds(found) => Ok(()),
            found => Err(Ok(Unmet {
                expected: format!("{what} {bound}"),
                found: found.map_or("no answer".to_owned(), shown),
            })),
        };
        let pair_named = |id: &str| {
            facts.pairs.iter().find(|pair| pair.id == id).ok_or_else(|| {
                Err(super::selection::no_such("pair", id, facts.pairs.iter().map(|pair| pair.id.as_str())))
            })
        };
        let ray = facts.answer.and_then(|answer| answer.ray.as_ref());
        let outcome = || match facts.answer {
            Some(answer) => format!("outcome {}", outcome_word(answer.outcome)),
            None => "no answer".to_owned(),
        };
        match self {
            Expectation::Outcome(word) => words(format!("outcome {word}"), outcome()),
            Expectation::Ray(word) => {
                words(format!("ray {word}"), ray.map_or_else(outcome, |ray| format!("ray {}", class_word(ray.class))))
            }
            Expectation::Verdict(word) => words(
                format!("verdict {word}"),
                ray.map_or_else(outcome, |ray| match ray.verdict {
                    Some(verdict) => format!("verdict {}", verdict_word(verdict)),
                    None => "no verdict".to_owned(),
                }),
            ),
            Expectation::State { pair, state } => {
                let found = pair_named(pair)?;
                words(format!("state {pair} {state}"), format!("state {pair} {}", found.state.word()))
            }
            Expectation::Pair { quantity, pair, bound } => {
                let found = quantity.of(pair_named(pair)?);
                let name = QUANTITIES.iter().find(|(_, q)| q == quantity).map_or("", |(name, _)| name);
                compare(format!("{name} {pair}"), bound, Some(found))
            }
            Expectation::Node { component, node, bound } => {
                let Some(displacements) = facts.displacements else {
                    return compare(format!("{component} {node}"), bound, None);
                };
                let found = displacements.iter().find(|d| d.node == *node).ok_or_else(|| {
                    Err(super::selection::no_such("node", node, displacements.iter().map(|d| d.node.as_str())))
                })?;
                let value = match component.as_str() {
                    "ux" => found.ux,
                    "uy" => found.uy,
                    _ => found.rz,
                };
                compare(format!("{component} {node}"), bound, Some(value))
            }
            Expectation::P(bound) => compare("p".into(), bound, facts.p),
            Expectation::Pivots(bound) => {
                compare("pivots".into(), bound, facts.answer.map(|answer| answer.pivot_count as f64))
            }
            Expectation::Size { what, bound } => {
                let size = facts.answer.map(|answer| &answer.size);
                let found = size.and_then(|size| match what.as_str() {
                    "unknowns" => size.unknowns,
                    "free" => size.free,
                    _ => Some(size.lcp),
                });
                compare(what.clone(), bound, found.map(|found| found as f64))
            }
            Expectation::Error(part) => match facts.error {
                Some(message) if message.contains(part.as_str()) => Ok(()),
                Some(message) => Err(Ok(Unmet {
                    expected: format!("an error with \"{part}\""),
                    found: format!("the error \"{message}\""),
                })),
                None => Err(Ok(Unmet { expected: format!("an error with \"{part}\""), found: "no error".to_owned() })),
            },
        }
    }
}

impl PairQuantity {
    fn of(self, pair: &PairState) -> f64 {
        match self {
            PairQuantity::XN => pair.x_n,
            PairQuantity::XT => pair.x_t,
            PairQuantity::ZN => pair.z_n,
            PairQuantity::ZT => pair.z_t,
            PairQuantity::Bound => pair.bound,
            PairQuantity::ReservePlus => pair.reserve_plus,
            PairQuantity::ReserveMinus => pair.reserve_minus,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<String> {
        super::super::words::split(text).unwrap()
    }

    #[test]
    fn comparisons_with_and_without_blanks() {
        for (text, found, holds) in [
            ("p = 100 ± 1e-6", 100.0000005, true),
            ("p = 100 +- 1e-6", 100.000002, false),
            ("p =100±1%", 100.9, true),
            ("p = -3 +-0.5", -3.4, true),
            ("p < 1e-9", 1e-10, true),
            ("p <= 20", 20.0, true),
            ("p > 20", 20.0, false),
            ("p >= 20", 20.0, true),
            ("p != 20", 20.0, false),
            ("p = 20", 20.0, true),
        ] {
            let Ok(Expectation::P(bound)) = read(&words(text)) else {
                panic!("{text}");
            };
            assert_eq!(bound.holds(found), holds, "{text}");
        }
        for text in ["p", "p 3", "p = ", "p = x", "p < 1 ± 2", "p = 1 ± -2", "p = inf"] {
            assert!(read(&words(text)).is_err(), "{text}");
        }
    }

    #[test]
    fn sizes_are_compared_like_numbers() {
        let read = read(&words("lcp <= 48")).unwrap();
        let Expectation::Size { what, bound } = &read else { panic!("{read:?}") };
        assert_eq!((what.as_str(), bound.to_string().as_str()), ("lcp", "<= 48"));
        assert!(bound.holds(48.0) && !bound.holds(49.0));
    }

    #[test]
    fn not_a_number_fulfils_nothing() {
        let Ok(Expectation::P(bound)) = read(&words("p = 1 ± 1")) else { panic!() };
        assert!(!bound.holds(f64::NAN));
    }

    #[test]
    fn unknown_words_are_refused_with_what_is_known() {
        let error = read(&words("outcome norml")).unwrap_err().to_string();
        assert!(error.contains("did you mean `normal`"), "{error}");
        let error = read(&words("xn c1 = 3")).unwrap_err().to_string();
        assert!(error.contains("x_n"), "{error}");
    }
}
