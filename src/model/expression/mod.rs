//! Expressions: numbers of a scenario written as formulas of its parameters, `2*F + 1`, `sin(alpha)`.
//!
//! Operators, from the loosest: `+ -`, `* /`, a sign, `^` (which binds to the right, so −2^2 = −4 and 2^3^2 = 512).
//! `parse` reads a text into `steps`, which have its value.

mod parse;
mod steps;

use std::sync::Arc;

use self::steps::Step;
use super::jet::Jet;

pub use self::parse::{ExpressionError, GRAMMAR};

/// A formula of parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    text: Arc<str>,
    steps: Arc<[Step]>,
}

impl Expression {
    /// Reads a text; `names` are the parameters there are.
    ///
    /// # Errors
    /// What is wrong, where in the text, and what to do.
    pub fn parse(text: &str, names: &[&str]) -> Result<Expression, ExpressionError> {
        let steps = parse::parse(text, names)?;
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
        steps::evaluate(&self.steps, parameter)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

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
