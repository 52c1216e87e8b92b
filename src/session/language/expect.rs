//! `expect`: what a script asserts of the present answer.

use std::fmt;

use thiserror::Error;

use crate::model::expression::Expression;
use crate::model::jet::Jet;
use crate::model::parameter::ParameterValues;
use crate::model::quantity::{self, Names, OfAnswer, Quantity, words_of};
use crate::model::structure::Dimension;
use crate::path::quantity::{Facts, Value};

use crate::model::words::did_you_mean_typed;
use crate::session::language::setting::number;

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

/// What is expected.
#[derive(Clone, Debug, PartialEq)]
pub enum Expectation {
    /// A quantity that is a word.
    Word {
        /// Which.
        quantity: Quantity,
        /// The word.
        word: String,
        /// Whether it is this one, or any other.
        equal: bool,
    },
    /// A quantity that is a number.
    Number {
        /// Which.
        quantity: Quantity,
        /// Compared with.
        bound: Bound,
    },
    /// Class of the ray.
    Ray(String),
    /// Part of the message of the command before.
    Error(String),
}

/// Words that are not an expectation.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("expect: {what}; see `help expect`")]
pub struct ExpectationSyntax {
    what: String,
}

impl ExpectationSyntax {
    /// The same said by another command that takes such words.
    pub fn said_by(&self, command: &str) -> String {
        format!("{command}: {}; see `help {command}`", self.what)
    }
}

/// An expectation that does not hold.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("expected {expected}, found {found}")]
pub struct Unmet {
    /// What was expected.
    pub expected: String,
    /// What was found.
    pub found: String,
}

/// Besides the quantities.
const OTHERS: &[&str] = &["ray", "error", "collapse", "undecided", "result"];

/// The words that may follow `expect`, besides the probes.
pub fn subjects(dimension: Dimension) -> impl Iterator<Item = &'static str> {
    OTHERS.iter().copied().chain(words_of(dimension).map(|entry| entry.word))
}

/// The words that may follow a subject, where it has a closed list.
pub fn choices(subject: &str, dimension: Dimension) -> Vec<&'static str> {
    // `ray` is the older word for the class.
    let subject = if subject == "ray" { "class" } else { subject };
    quantity::entry(subject).map_or(Vec::new(), |entry| entry.choices_of(dimension))
}

/// Reads the words after `expect`; numbers may be formulas of the parameters, which have these values.
///
/// # Errors
/// [`ExpectationSyntax`].
pub fn read(words: &[String], names: &Names<'_>, values: &ParameterValues) -> Result<Expectation, ExpectationSyntax> {
    let bad = |what: String| ExpectationSyntax { what };
    let Some((first, rest)) = words.split_first() else {
        return Err(bad("what is expected?".into()));
    };
    let one_of = |subject: &str, rest: &[String]| {
        let allowed = choices(subject, names.dimension);
        match rest {
            [word] if allowed.contains(&word.as_str()) => Ok(word.clone()),
            [word] => Err(bad(format!(
                "`{word}` is not a {subject}{}: expected {}",
                did_you_mean_typed(word, allowed.iter().copied()),
                allowed.join(", ")
            ))),
            _ => Err(bad(format!("`{subject}` takes one of {}", allowed.join(", ")))),
        }
    };
    match first.as_str() {
        "ray" => return Ok(Expectation::Ray(one_of("ray", rest)?)),
        "error" if rest.is_empty() => return Err(bad("`error` takes a part of the message".into())),
        "error" => return Ok(Expectation::Error(rest.join(" "))),
        _ => {}
    }
    let mut words = words.to_vec();
    if let [stage, _, word, ..] = &mut words[..]
        && stage == "stage"
        && word == "ray"
    {
        *word = "class".to_owned();
    }
    // As they stand first: a probe with blanks in its name may have a sign in it.
    let is_read = match quantity::read(&words, names) {
        Ok((_, rest)) => rest.first().is_none_or(|word| word.starts_with(['=', '<', '>', '!'])),
        Err(_) => false,
    };
    if !is_read {
        words = apart(&words, |word| names.has(word));
    }
    let (quantity, rest) = quantity::read(&words, names).map_err(|error| bad(error.to_string()))?;
    let rest = &apart(rest, |_| false)[..];
    if !quantity.is_word() {
        return Ok(Expectation::Number { quantity, bound: bound(rest, values)? });
    }
    let (equal, rest) = match rest {
        [sign, rest @ ..] if sign == "=" || sign == "==" => (true, rest),
        [sign, rest @ ..] if sign == "!=" => (false, rest),
        rest => (true, rest),
    };
    let word = one_of(quantity.word(), rest)?;
    Ok(Expectation::Word { quantity, word, equal })
}

/// The signs of comparisons, those first that begin as another.
const SIGNS: [(&str, Operator); 7] = [
    ("<=", Operator::LessEqual),
    (">=", Operator::GreaterEqual),
    ("!=", Operator::NotEqual),
    ("==", Operator::Equal),
    ("=", Operator::Equal),
    ("<", Operator::Less),
    (">", Operator::Greater),
];

/// The words with the first sign of a comparison in a word of its own: `ux C=0` as `ux C = 0`. A sign in a name is a part
/// of that name.
pub fn apart(words: &[String], is_name: impl Fn(&str) -> bool) -> Vec<String> {
    let sign = |text: &str| SIGNS.iter().map(|(sign, _)| *sign).find(|sign| text.starts_with(sign));
    for (k, word) in words.iter().enumerate().filter(|(_, word)| !is_name(word)) {
        let signs: Vec<(usize, &str)> =
            word.char_indices().filter_map(|(at, _)| Some((at, sign(&word[at..])?))).collect();
        let behind_name = signs.iter().rev().find(|(at, _)| is_name(&word[..*at]));
        let Some(&(at, sign)) = behind_name.or(signs.first()) else { continue };
        let parts = [&word[..at], sign, &word[at + sign.len()..]];
        let parts = parts.into_iter().filter(|part| !part.is_empty()).map(str::to_owned);
        return words[..k].iter().cloned().chain(parts).chain(words[k + 1..].iter().cloned()).collect();
    }
    words.to_vec()
}

/// A number, or a formula of the parameters.
///
/// # Errors
/// What is wrong with the formula.
fn computed(text: &str, values: &ParameterValues) -> Result<f64, String> {
    if let Some(value) = number(text) {
        return Ok(value);
    }
    let names: Vec<&str> = values.keys().map(String::as_str).collect();
    let formula = Expression::parse(text, &names).map_err(|error| error.message)?;
    let known = |name: &str| Jet::constant(values.get(name).copied().unwrap_or(f64::NAN));
    Ok(formula.evaluate(&known).value)
}

/// `= 100 ± 1e-6`, `<=20`, `= q*L^2/8 ± 1%`, with or without blanks.
pub fn bound(words: &[String], values: &ParameterValues) -> Result<Bound, ExpectationSyntax> {
    let text = words.join(" ");
    let bad = || ExpectationSyntax {
        what: format!(
            "`{text}` is not a comparison: expected one of = != < <= > >= and a number or a formula of the parameters, after \
             `=` also `± TOLERANCE`"
        ),
    };
    let finite = |part: &str| match computed(part, values) {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(value) => Err(ExpectationSyntax { what: format!("`{}` is {value}, not a finite number", part.trim()) }),
        Err(message) => Err(ExpectationSyntax { what: format!("`{}`: {message}", part.trim()) }),
    };
    let (operator, rest) =
        SIGNS.iter().find_map(|(sign, operator)| Some((*operator, text.strip_prefix(sign)?))).ok_or_else(bad)?;
    let (value, tolerance) = match rest.split_once('±').or_else(|| rest.split_once("+-")) {
        Some((value, tolerance)) => (value, Some(tolerance)),
        None => (rest, None),
    };
    if value.trim().is_empty() {
        return Err(ExpectationSyntax {
            what: format!("a number, or a formula of the parameters, is missing after `{text}`"),
        });
    }
    let value = finite(value)?;
    let tolerance = match tolerance {
        None => 0.0,
        Some(_) if operator != Operator::Equal => return Err(bad()),
        Some(text) => match text.trim_end().strip_suffix('%') {
            Some(percent) => finite(percent)? / 100.0 * value.abs(),
            None => finite(text)?,
        },
    };
    if tolerance < 0.0 {
        return Err(ExpectationSyntax { what: format!("`{text}`: what stands after `±` is not negative") });
    }
    Ok(Bound { operator, value, tolerance })
}

impl Bound {
    /// Operator, value and tolerance.
    pub fn parts(&self) -> (Operator, f64, f64) {
        (self.operator, self.value, self.tolerance)
    }

    /// Whether what was found is as expected.
    pub fn holds(&self, found: f64) -> bool {
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
    /// Compares with the facts; `error` is the message of the command before, if it failed.
    ///
    /// # Errors
    /// If it does not hold.
    pub fn test(&self, facts: &Facts<'_>, error: Option<&str>) -> Result<(), Unmet> {
        match self {
            Expectation::Word { quantity, word, equal } => {
                let found = match facts.value(quantity) {
                    Ok(Value::Word(found)) => found,
                    Ok(Value::Number(found)) => shown(found),
                    Err(reason) => {
                        return Err(Unmet { expected: format!("{quantity} {word}"), found: reason.0 });
                    }
                };
                let holds = found == *word || word == "answer" && matches!(found.as_str(), "trivial" | "normal");
                if holds == *equal {
                    return Ok(());
                }
                let not = if *equal { "" } else { "!= " };
                Err(Unmet { expected: format!("{quantity} {not}{word}"), found: format!("{quantity} {found}") })
            }
            Expectation::Number { quantity, bound } => {
                let found = match facts.value(quantity) {
                    Ok(Value::Number(found)) if bound.holds(found) => return Ok(()),
                    Ok(Value::Number(found)) => shown(found),
                    Ok(Value::Word(word)) => word,
                    Err(reason) => reason.0,
                };
                Err(Unmet { expected: format!("{quantity} {bound}"), found })
            }
            Expectation::Ray(class) => match facts.value(&Quantity::Answer(OfAnswer::Class)) {
                Ok(Value::Word(found)) if found == *class => Ok(()),
                Ok(Value::Word(found)) => {
                    Err(Unmet { expected: format!("ray {class}"), found: format!("ray {found}") })
                }
                Ok(Value::Number(found)) => Err(Unmet { expected: format!("ray {class}"), found: shown(found) }),
                Err(reason) => Err(Unmet { expected: format!("ray {class}"), found: reason.0 }),
            },
            Expectation::Error(part) => match error {
                Some(message) if message.contains(part.as_str()) => Ok(()),
                Some(message) => Err(Unmet {
                    expected: format!("an error with \"{part}\""),
                    found: format!("the error \"{message}\""),
                }),
                None => Err(Unmet { expected: format!("an error with \"{part}\""), found: "no error".to_owned() }),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Expectation, ExpectationSyntax> {
        let scenario = crate::model::embedded::load("beam").unwrap();
        super::read(
            &crate::session::language::tokens::split(text).unwrap(),
            &Names::of(&scenario),
            &scenario.parameter_values(),
        )
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
            ("p<1e-9", 1e-10, true),
            ("p>=20", 20.0, true),
            ("p!=20", 20.0, false),
            ("p=100±1%", 100.9, true),
            ("p <=20", 20.0, true),
            ("p< 20", 20.0, false),
        ] {
            let Ok(Expectation::Number { bound, .. }) = read(text) else {
                panic!("{text}");
            };
            assert_eq!(bound.holds(found), holds, "{text}");
        }
        for text in ["p", "p 3", "p = ", "p = x", "p < 1 ± 2", "p = 1 ± -2", "p = inf", "p = 1 ± inf", "p = 1/0"] {
            assert!(read(text).is_err(), "{text}");
        }
    }

    /// `a=1` and `c<` are names here, `a` and `c` too.
    #[test]
    fn signs_stand_apart_from_names() {
        let names = ["a", "a=1", "c", "c<", "joint[0]"];
        for (typed, expected) in [
            ("ux a=0", "ux|a|=|0"),
            ("ux a=1", "ux|a=1"),
            ("ux a=1=3", "ux|a=1|=|3"),
            ("ux c<3", "ux|c|<|3"),
            ("ux c<<3", "ux|c<|<|3"),
            ("ux c<=3", "ux|c<|=|3"),
            ("ux c >=3", "ux|c|>=|3"),
            ("x_n joint[0]!=2*f", "x_n|joint[0]|!=|2*f"),
            ("state c==open", "state|c|==|open"),
            ("ux a = 0", "ux|a|=|0"),
            ("N d<2<3", "N|d|<|2<3"),
        ] {
            let words: Vec<String> = typed.split(' ').map(str::to_owned).collect();
            assert_eq!(apart(&words, |word| names.contains(&word)).join("|"), expected, "{typed}");
        }
    }

    #[test]
    fn numbers_may_be_formulas_of_the_parameters() {
        // The file has f = 0.5, F = 100, F2 = 250.
        for (text, found, holds) in [
            ("p = F2 - 6*f*F ± 1e-9", -50.0, true),
            ("p = (F2 - 6*f*F)/6±1%", -8.41, true),
            ("p = -f*F +- f", -50.6, false),
            ("p < 6 * f * F", 300.0, false),
        ] {
            let Ok(Expectation::Number { bound, .. }) = read(text) else {
                panic!("{text}");
            };
            assert_eq!(bound.holds(found), holds, "{text}");
        }
        let error = read("p = 6*g*F").unwrap_err().to_string();
        assert!(error.contains("`6*g*F`") && error.contains("\"g\""), "{error}");
        let error = read("p = 1/(f - 0.5)").unwrap_err().to_string();
        assert!(error.contains("not a finite number"), "{error}");
    }

    #[test]
    fn sizes_are_compared_like_numbers() {
        let read = read("lcp <= 48").unwrap();
        let Expectation::Number { quantity, bound } = &read else { panic!("{read:?}") };
        assert_eq!((quantity.to_string().as_str(), bound.to_string().as_str()), ("lcp", "<= 48"));
        assert!(bound.holds(48.0) && !bound.holds(49.0));
    }

    #[test]
    fn not_a_number_fulfils_nothing() {
        let Ok(Expectation::Number { bound, .. }) = read("p = 1 ± 1") else { panic!() };
        assert!(!bound.holds(f64::NAN));
    }

    #[test]
    fn unknown_words_are_refused_with_what_is_known() {
        let error = read("outcome norml").unwrap_err().to_string();
        assert!(error.contains("did you mean `normal`"), "{error}");
        let error = read("xn c1 = 3").unwrap_err().to_string();
        assert!(error.contains("x_n"), "{error}");
    }
}
