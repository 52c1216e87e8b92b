//! Expressions: numbers of a scenario written as formulas of its parameters, `2*F + 1`, `sin(alpha)`.
//!
//! Operators, from the loosest: `+ -`, `* /`, a sign, `^` (which binds to the right, so −2^2 = −4 and 2^3^2 = 512).
//! An expression is kept in postfix order, so that neither its value nor its end needs recursion.

use std::f64::consts::PI;
use std::sync::Arc;

use winnow::Parser;
use winnow::combinator::{Infix, Prefix, expression as pratt};
use winnow::error::ParserError;
use winnow::stream::{LocatingSlice, Location, Stream};
use winnow::token::{any, take_while};

use super::jet::Jet;
use super::words::{did_you_mean, listed};

/// A longer text is refused.
const LONGEST: usize = 2_000;
/// Parentheses and powers of one expression: what the parser may have open at the same time.
const DEEPEST: usize = 64;

/// What may stand in an expression besides numbers and parameters.
pub const GRAMMAR: &str = "expressions are made of numbers, parameters, pi, + - * / ^, parentheses, sqrt, abs, min, max, sin, cos, tan and atan";

/// A formula of parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    text: Arc<str>,
    steps: Arc<[Step]>,
}

#[derive(Clone, Debug, PartialEq)]
enum Step {
    Value(f64),
    Parameter(Arc<str>),
    Negate,
    Binary(Binary),
    /// The function and its number of arguments.
    Call(Function, usize),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Binary {
    Plus,
    Minus,
    Times,
    Over,
    Power,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Function {
    Sqrt,
    Abs,
    Min,
    Max,
    Sin,
    Cos,
    Tan,
    Atan,
}

const FUNCTIONS: [(&str, Function); 8] = [
    ("sqrt", Function::Sqrt),
    ("abs", Function::Abs),
    ("min", Function::Min),
    ("max", Function::Max),
    ("sin", Function::Sin),
    ("cos", Function::Cos),
    ("tan", Function::Tan),
    ("atan", Function::Atan),
];

/// A text that is no expression.
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

impl Expression {
    /// Reads a text; `names` are the parameters there are.
    ///
    /// # Errors
    /// What is wrong, where in the text, and what to do.
    pub fn parse(text: &str, names: &[&str]) -> Result<Expression, ExpressionError> {
        if text.trim().is_empty() {
            return Err(ExpressionError::new(
                0,
                "the expression is empty",
                "write a number, or a formula of parameters",
            ));
        }
        let deep = text.bytes().filter(|byte| matches!(byte, b'(' | b'^')).count();
        if text.len() > LONGEST || deep > DEEPEST {
            return Err(ExpressionError::new(
                0,
                format!(
                    "the expression is too long: at most {LONGEST} characters and {DEEPEST} parentheses and powers"
                ),
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
        Ok(Expression { text: text.trim().into(), steps: steps.into() })
    }

    /// The expression as written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The parameters in it, each as often as it stands there.
    pub fn parameters(&self) -> impl Iterator<Item = &str> {
        self.steps.iter().filter_map(|step| match step {
            Step::Parameter(name) => Some(name.as_ref()),
            _ => None,
        })
    }

    /// The parameter, if the expression is nothing else.
    pub fn single_parameter(&self) -> Option<&str> {
        match &self.steps[..] {
            [Step::Parameter(name)] => Some(name),
            _ => None,
        }
    }

    /// Its value and rate, from those of the parameters.
    pub fn evaluate(&self, parameter: &dyn Fn(&str) -> Jet) -> Jet {
        let mut stack: Vec<Jet> = Vec::with_capacity(8);
        for step in self.steps.iter() {
            // The parser puts as many values on the stack as every operation takes off.
            let mut pop = || stack.pop().unwrap_or(Jet::constant(f64::NAN));
            let value = match step {
                Step::Value(value) => Jet::constant(*value),
                Step::Parameter(name) => parameter(name),
                Step::Negate => -pop(),
                Step::Binary(operator) => {
                    let (right, left) = (pop(), pop());
                    match operator {
                        Binary::Plus => left + right,
                        Binary::Minus => left - right,
                        Binary::Times => left * right,
                        Binary::Over => left / right,
                        Binary::Power => left.power(right),
                    }
                }
                Step::Call(function, count) => {
                    let first = pop();
                    let rest: Vec<Jet> = (1..*count).map(|_| pop()).collect();
                    match function {
                        Function::Sqrt => first.sqrt(),
                        Function::Abs => first.abs(),
                        Function::Sin => first.sin(),
                        Function::Cos => first.cos(),
                        Function::Tan => first.tan(),
                        Function::Atan => first.atan(),
                        // The arguments come off in reverse; neither minds.
                        Function::Min => rest.into_iter().fold(first, Jet::min),
                        Function::Max => rest.into_iter().fold(first, Jet::max),
                    }
                }
            };
            stack.push(value);
        }
        stack.pop().unwrap_or(Jet::constant(f64::NAN))
    }
}

/// A name with `-` reads as a difference: it cannot stand in an expression, and where it could be meant it is told.
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
        (None, _) => Err(ExpressionError::new(at, format!("`{literal}` is no number"), GRAMMAR)),
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

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        let names = ["F", "h", "alpha", "e"];
        let expression = Expression::parse(text, &names).unwrap_or_else(|error| panic!("{text}: {}", error.message));
        let of = |name: &str| match name {
            "F" => 100.0,
            "h" => 4.0,
            "alpha" => 0.5,
            _ => 3.0,
        };
        expression.evaluate(&|name| Jet::constant(of(name))).value
    }

    #[test]
    fn precedence_and_binding_are_those_of_mathematics() {
        for (text, expected) in [
            ("2*F + 1", 201.0),
            ("1+2*3", 7.0),
            ("(1+2)*3", 9.0),
            ("-2^2", -4.0),
            ("(-2)^2", 4.0),
            ("2^3^2", 512.0),
            ("2^-1", 0.5),
            ("2^-1*3", 1.5),
            ("2^-2^2", 0.0625),
            ("-2^-2", -0.25),
            ("8/4/2", 1.0),
            ("8-4-2", 2.0),
            ("2*-3", -6.0),
            ("2--3", 5.0),
            ("2 - - 3", 5.0),
            ("+3", 3.0),
            ("--3", 3.0),
            ("-F^2/h", -2500.0),
            ("2*e", 6.0),
            ("1e2", 100.0),
            ("1.5E-1", 0.15),
            (".5+2.", 2.5),
            (" F / h ", 25.0),
            ("F", 100.0),
        ] {
            assert_eq!(value(text), expected, "{text}");
        }
    }

    #[test]
    fn functions_and_pi() {
        for (text, expected) in [
            ("sqrt(h)", 2.0),
            ("abs(-3)", 3.0),
            ("min(3, h, 2*F)", 3.0),
            ("max(3, h, -2)", 4.0),
            ("sin(alpha)", 0.5f64.sin()),
            ("cos (alpha)", 0.5f64.cos()),
            ("tan(alpha)", 0.5f64.tan()),
            ("4*atan(1)", PI),
            ("pi", PI),
            ("sin(pi/2)", 1.0),
            ("sqrt(sqrt(16))", 2.0),
        ] {
            assert!((value(text) - expected).abs() <= 1e-15 * expected.abs(), "{text}: {}", value(text));
        }
    }

    fn error(text: &str, names: &[&str]) -> (usize, String) {
        let error = Expression::parse(text, names).unwrap_err();
        (error.at, error.message)
    }

    #[test]
    fn what_is_wrong_is_said_with_its_place() {
        for (text, at, part) in [
            ("", 0, "empty"),
            ("  ", 0, "empty"),
            ("2F", 1, "expected an operator after 2, found `F`"),
            ("2*", 2, "found the end"),
            ("(2*F", 0, "this `(` is not closed"),
            ("2*(F+)", 5, "found `)`"),
            ("2*F)", 3, "a `)` without its `(`"),
            ("F F", 2, "expected an operator or the end, found `F`"),
            ("2*G", 2, "unknown parameter \"G\""),
            ("exp(1)", 0, "unknown function \"exp\""),
            ("squrt(1)", 0, "did you mean \"sqrt\"?"),
            ("2 + sin", 4, "needs its argument in parentheses"),
            ("sin(1, 2)", 3, "takes one argument, found 2"),
            ("min(1)", 3, "takes two arguments or more, found 1"),
            ("sin()", 4, "found `)`"),
            ("E", 0, "unknown parameter \"E\""),
            ("2 % 3", 2, "found `%`"),
            ("1,5", 1, "found `,`"),
            ("1e", 1, "expected an operator after 1"),
            ("1..2", 2, "found `.`"),
            ("F = 3", 2, "found `=`"),
            ("ü*2", 0, "unknown parameter \"ü\""),
        ] {
            let (found, message) = error(text, &["F"]);
            assert!(message.contains(part), "{text}: {message}");
            assert_eq!(found, at, "{text}: {message}");
        }
    }

    #[test]
    fn declared_names_win() {
        let of = |text: &str, names: &[&str]| {
            Expression::parse(text, names).unwrap().evaluate(&|_| Jet::constant(7.0)).value
        };
        assert_eq!(of("2*pi", &["pi"]), 14.0);
        assert_eq!(of("2*sin", &["sin"]), 14.0);
        assert!(error("sin(2)", &["sin"]).1.contains("expected an operator"));
    }

    #[test]
    fn a_name_with_a_hyphen_is_refused_where_it_could_be_meant() {
        let names = ["a", "b", "a-b"];
        let (at, message) = error("2*a-b", &names);
        assert!(at == 2 && message.contains("\"a-b\" cannot stand in an expression"), "{message}");
        assert!(Expression::parse("2*a - b", &names).is_ok());
        assert!(Expression::parse("2*a-bb", &["a", "bb", "a-b"]).is_ok());
    }

    #[test]
    fn no_text_is_too_deep() {
        for text in ["(".repeat(100_000), "-".repeat(1_900) + "1", "2^".repeat(900), "sin(".repeat(400)] {
            let _ = Expression::parse(&text, &[]);
        }
        let long = vec!["1"; 900].join("+");
        assert_eq!(value(&long), 900.0);
        let nested = format!("{}1{}", "(".repeat(64), ")".repeat(64));
        assert_eq!(value(&nested), 1.0);
    }

    proptest::proptest! {
        #[test]
        fn no_text_panics(text in "[-+*/^()., 0-9eEaFspin√]{0,40}") {
            if let Ok(expression) = Expression::parse(&text, &["F", "a"]) {
                let _ = expression.evaluate(&|_| Jet::constant(1.0));
            }
        }
    }
}
