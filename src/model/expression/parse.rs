//! From the text of an expression to its steps.

use std::f64::consts::PI;

use winnow::Parser;
use winnow::combinator::{Infix, Prefix, expression as pratt};
use winnow::error::ParserError;
use winnow::stream::{LocatingSlice, Location, Stream};
use winnow::token::{any, take_while};

use super::steps::{Binary, FUNCTIONS, Function, Step};
use crate::model::words::{did_you_mean, listed};

/// A longer text is refused.
const LONGEST: usize = 2_000;
/// Parentheses and powers of one expression: what the parser may have open at the same time.
const DEEPEST: usize = 64;

/// What may stand in an expression besides numbers and parameters.
pub const GRAMMAR: &str = "expressions are made of numbers, parameters, pi, + - * / ^, parentheses, sqrt, abs, min, max, sin, cos, tan and atan";

/// A text that is not an expression.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExpressionError {
    /// Byte offset in the text.
    pub at: usize,
    /// What is wrong there.
    pub message: String,
    /// What to do.
    pub help: String,
    /// Whether another reading of the same place may still succeed.
    open: bool,
}

impl ExpressionError {
    fn new(at: usize, message: impl Into<String>, help: impl Into<String>) -> Self {
        ExpressionError { at, message: message.into(), help: help.into(), open: false }
    }
}

type Input<'t> = LocatingSlice<&'t str>;

impl ParserError<Input<'_>> for ExpressionError {
    type Inner = Self;

    fn from_input(input: &Input<'_>) -> Self {
        let found = match input.chars().next() {
            Some(c) => format!("found `{c}`"),
            None => "found the end".to_owned(),
        };
        let message = format!("expected a number, a parameter, a function or `(`, {found}");
        ExpressionError { open: true, ..Self::new(input.current_token_start(), message, GRAMMAR) }
    }

    fn is_backtrack(&self) -> bool {
        self.open
    }

    fn into_inner(self) -> Result<Self, Self> {
        Ok(self)
    }
}

/// Reads a text; `names` are the parameters there are.
///
/// # Errors
/// What is wrong, where in the text, and what to do.
pub fn parse(text: &str, names: &[&str]) -> Result<Vec<Step>, ExpressionError> {
    if text.trim().is_empty() {
        return Err(ExpressionError::new(0, "the expression is empty", "write a number, or a formula of parameters"));
    }
    let deep = text.bytes().filter(|byte| matches!(byte, b'(' | b'^')).count();
    if text.len() > LONGEST || deep > DEEPEST {
        return Err(ExpressionError::new(
            0,
            format!("the expression is too long: at most {LONGEST} characters and {DEEPEST} parentheses and powers"),
            "give a part of it a name: { \"formula\": … } under `parameters`",
        ));
    }
    refuse_hyphens(text, names)?;
    let mut input = LocatingSlice::new(text);
    let steps = sum(&mut input, names)?;
    skip_blanks(&mut input);
    if let Some(c) = input.chars().next() {
        let at = input.current_token_start();
        return Err(match c {
            ')' => ExpressionError::new(at, "a `)` without its `(`", "remove it, or open it before"),
            _ => ExpressionError::new(at, format!("expected an operator or the end, found `{c}`"), GRAMMAR),
        });
    }
    Ok(steps)
}

/// A name with `-` reads as a difference: it cannot stand in an expression, and where it could be meant the error says
/// so.
fn refuse_hyphens(text: &str, names: &[&str]) -> Result<(), ExpressionError> {
    let of_name = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
    for name in names.iter().filter(|name| name.contains('-')) {
        let place = text.match_indices(name).find(|(at, _)| {
            let before = text[..*at].chars().next_back();
            let after = text[at + name.len()..].chars().next();
            !before.is_some_and(of_name) && !after.is_some_and(of_name)
        });
        if let Some((at, _)) = place {
            return Err(ExpressionError::new(
                at,
                format!("the parameter \"{name}\" cannot stand in an expression: its `-` is a minus there"),
                format!("rename it, e.g. \"{}\"; for a difference put blanks around the minus", name.replace('-', "_")),
            ));
        }
    }
    Ok(())
}

fn skip_blanks(input: &mut Input<'_>) {
    while input.chars().next().is_some_and(char::is_whitespace) {
        input.next_token();
    }
}

fn sum<'t>(input: &mut Input<'t>, names: &[&str]) -> Result<Vec<Step>, ExpressionError> {
    pratt(|input: &mut Input<'t>| operand(input, names)).prefix(signs).infix(operator).parse_next(input)
}

fn operator<'t>(input: &mut Input<'t>) -> Result<Infix<Input<'t>, Vec<Step>, ExpressionError>, ExpressionError> {
    skip_blanks(input);
    let start = input.checkpoint();
    Ok(match any.parse_next(input)? {
        '+' => Infix::Left(1, |_, left, right| Ok(joined(left, right, Binary::Plus))),
        '-' => Infix::Left(1, |_, left, right| Ok(joined(left, right, Binary::Minus))),
        '*' => Infix::Left(3, |_, left, right| Ok(joined(left, right, Binary::Times))),
        '/' => Infix::Left(3, |_, left, right| Ok(joined(left, right, Binary::Over))),
        '^' => Infix::Right(7, |_, left, right| Ok(joined(left, right, Binary::Power))),
        _ => {
            input.reset(&start);
            return Err(ExpressionError::from_input(input));
        }
    })
}

fn joined(mut left: Vec<Step>, right: Vec<Step>, operator: Binary) -> Vec<Step> {
    left.extend(right);
    left.push(Step::Binary(operator));
    left
}

/// Signs before an operand, taken together.
fn signs<'t>(input: &mut Input<'t>) -> Result<Prefix<Input<'t>, Vec<Step>, ExpressionError>, ExpressionError> {
    skip_blanks(input);
    let (mut any, mut negative) = (false, false);
    while let Some(sign @ ('+' | '-')) = input.chars().next() {
        input.next_token();
        skip_blanks(input);
        any = true;
        negative ^= sign == '-';
    }
    match (any, negative) {
        (false, _) => Err(ExpressionError::from_input(input)),
        (true, false) => Ok(Prefix(5, |_, operand| Ok(operand))),
        (true, true) => Ok(Prefix(5, |_, mut operand| {
            operand.push(Step::Negate);
            Ok(operand)
        })),
    }
}

/// A number, a parameter, pi, a function with its arguments, or a sum in parentheses.
fn operand(input: &mut Input<'_>, names: &[&str]) -> Result<Vec<Step>, ExpressionError> {
    skip_blanks(input);
    let at = input.current_token_start();
    match input.chars().next() {
        Some('(') => {
            input.next_token();
            let inside = sum(input, names).map_err(decided)?;
            close(input, at)?;
            Ok(inside)
        }
        Some(c) if c.is_ascii_digit() || c == '.' => number(input, at).map(|value| vec![Step::Value(value)]),
        Some(c) if c.is_alphabetic() || c == '_' => {
            let name = name(input)?;
            if names.contains(&name) {
                return Ok(vec![Step::Parameter(name.into())]);
            }
            let call = { input.chars().find(|c| !c.is_whitespace()) == Some('(') };
            match FUNCTIONS.iter().find(|(word, _)| *word == name) {
                Some((_, function)) if call => arguments(input, names, name, *function),
                Some(_) => Err(ExpressionError::new(
                    at,
                    format!("the function {name} needs its argument in parentheses"),
                    format!("write {name}(…)"),
                )),
                None if call => {
                    let near = did_you_mean(name, FUNCTIONS.map(|(word, _)| word));
                    Err(ExpressionError::new(at, format!("unknown function \"{name}\"{near}"), GRAMMAR))
                }
                None if name == "pi" => Ok(vec![Step::Value(PI)]),
                None => {
                    let near = did_you_mean(name, names.iter().copied());
                    let help = match names {
                        [] => "the scenario has no parameters: define the name under `parameters`".to_owned(),
                        _ => format!("expected {}; or define the name under `parameters`", listed(names)),
                    };
                    Err(ExpressionError::new(at, format!("unknown parameter \"{name}\"{near}"), help))
                }
            }
        }
        _ => Err(ExpressionError::from_input(input)),
    }
}

/// What fails inside parentheses is no longer open to another reading.
fn decided(error: ExpressionError) -> ExpressionError {
    ExpressionError { open: false, ..error }
}

fn close(input: &mut Input<'_>, opened: usize) -> Result<(), ExpressionError> {
    skip_blanks(input);
    match input.chars().next() {
        Some(')') => {
            input.next_token();
            Ok(())
        }
        None => Err(ExpressionError::new(opened, "this `(` is not closed", "close it with `)`")),
        Some(c) => Err(ExpressionError::new(
            input.current_token_start(),
            format!("expected an operator or `)`, found `{c}`"),
            GRAMMAR,
        )),
    }
}

fn name<'t>(input: &mut Input<'t>) -> Result<&'t str, ExpressionError> {
    take_while(1.., |c: char| c.is_alphanumeric() || c == '_').parse_next(input)
}

/// `2`, `0.5`, `.5`, `1e-3`.
fn number(input: &mut Input<'_>, at: usize) -> Result<f64, ExpressionError> {
    let text: &str = input;
    let digits = |from: usize| text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let mut end = digits(0);
    if text[end..].starts_with('.') {
        end += 1 + digits(end + 1);
    }
    if text[end..].starts_with(['e', 'E']) {
        let sign = usize::from(text[end + 1..].starts_with(['+', '-']));
        let exponent = digits(end + 1 + sign);
        if exponent > 0 {
            end += 1 + sign + exponent;
        }
    }
    let literal = &text[..end];
    let value = literal.parse().ok();
    let next = text[end..].chars().next();
    input.next_slice(end);
    match (value, next) {
        (Some(_), Some(c)) if c.is_alphanumeric() || c == '_' || c == '.' => Err(ExpressionError::new(
            at + end,
            format!("expected an operator after {literal}, found `{c}`"),
            "a product is written with `*`: 2*F",
        )),
        (Some(value), _) => Ok(value),
        (None, _) => Err(ExpressionError::new(at, format!("`{literal}` is not a number"), GRAMMAR)),
    }
}

fn arguments(
    input: &mut Input<'_>,
    names: &[&str],
    name: &str,
    function: Function,
) -> Result<Vec<Step>, ExpressionError> {
    skip_blanks(input);
    let at = input.current_token_start();
    input.next_token();
    let (mut steps, mut count) = (Vec::new(), 0);
    loop {
        steps.extend(sum(input, names).map_err(decided)?);
        count += 1;
        skip_blanks(input);
        if !input.starts_with(',') {
            break;
        }
        input.next_token();
    }
    close(input, at)?;
    let several = matches!(function, Function::Min | Function::Max);
    if several && count < 2 || !several && count != 1 {
        return Err(ExpressionError::new(
            at,
            format!("{name} takes {}, found {count}", if several { "two arguments or more" } else { "one argument" }),
            if several { format!("write {name}(a, b)") } else { format!("write {name}(a)") },
        ));
    }
    steps.push(Step::Call(function, count));
    Ok(steps)
}
