//! Reading numbers and vectors: the one place where a number of the model becomes a value.

use super::reader::Cursor;
use super::words::{is_id, quoted, shortened};
use crate::model::dimension::Dimension;
use crate::model::expression::Expression;
use crate::model::jet::{Dependence, Jet};
use crate::model::node::Component;
use crate::model::parameter::{Along, Number};
use crate::model::uses::Region;
use crate::model::vector::unit;

/// Numbers beyond this are refused: their squares must stay finite.
const LARGEST: f64 = 1e150;

const LITERAL: &str = "write a plain number, like 0.5 or 2e8";
const NUMBER: &str = "write a number, like 0.5 or 2e8, the name of a parameter or an expression, like \"2*F + 1\"";

impl<'d> Cursor<'d> {
    /// A finite number, written out.
    pub fn literal(self) -> Option<f64> {
        let Some(digits) = self.value.as_number() else {
            self.wrong_type("a number", LITERAL);
            return None;
        };
        self.magnitude(digits)
    }

    /// A number as it stands: written out, a parameter, or an expression. Notes that its parameters stand in its
    /// region.
    pub fn symbolic(self) -> Option<Number> {
        if let Some(digits) = self.value.as_number() {
            return self.magnitude(digits).map(Number::Value);
        }
        let Some(text) = self.value.as_str() else {
            self.wrong_type("a number, a parameter or an expression", NUMBER);
            return None;
        };
        let number = self.named_or_formula(text)?;
        let mut uses = self.reading.uses.borrow_mut();
        for name in number.names() {
            uses.entry((name.to_owned(), self.region)).or_insert(self.value.start());
        }
        Some(number)
    }

    fn named_or_formula(self, text: &str) -> Option<Number> {
        let parameters = self.parameters();
        if parameters.contains(text) {
            return Some(Number::Parameter(text.to_owned()));
        }
        let names = parameters.names();
        // `L-b` may be a name that was not declared: then it is told as one.
        let is_unknown = is_id(text) && Expression::parse(text, &names).is_err();
        if is_unknown && !names.is_empty() {
            self.unknown("parameter", text, &names);
            return None;
        }
        if is_unknown {
            self.problem(
                format!("unknown parameter {}: the scenario has none", quoted(text)),
                "write a number, or define the name under `parameters`",
            );
            return None;
        }
        let expression = self.expression(text, &names)?;
        Some(match expression.single_parameter() {
            Some(name) => Number::Parameter(name.to_owned()),
            None => Number::Expression(expression),
        })
    }

    /// The expression in the string here.
    pub fn expression(self, text: &str, names: &[&str]) -> Option<Expression> {
        match Expression::parse(text, names) {
            Ok(expression) => Some(expression),
            Err(error) => {
                // Behind the quotation mark; without a place of its own where escapes shift the characters.
                let shift = if self.value.is_written_plainly() { 1 + error.at } else { 0 };
                let message = format!("in {}: {}", quoted(text), error.message);
                self.reading.findings.add(self.value.start() + shift, message, error.help);
                None
            }
        }
    }

    /// Where the number here is read as its rate along a parameter: that parameter, and what the others do along it.
    fn along(self) -> Option<(&'d str, &'d Along)> {
        self.parameters().along().filter(|_| self.region == Region::Amount)
    }

    /// A finite number under the present values of the parameters.
    pub fn number(self) -> Option<f64> {
        let number = self.symbolic()?;
        self.value_of(&number)
    }

    /// The value of a number that stands here; `None`, and nothing reported, where a parameter in it is wrong itself.
    pub fn value_of(self, number: &Number) -> Option<f64> {
        let parameters = self.parameters();
        if let Some((name, along)) = self.along() {
            let jet = number.along(along);
            if jet.dependence == Dependence::Nonlinear {
                let message = format!("{} is not a linear function of {name}", self.quoted());
                self.problem(message, format!("`sweep {name} A..B` varies it"));
                return None;
            }
            return Some(jet.rate);
        }
        let value = match number {
            Number::Value(value) => return Some(*value),
            Number::Parameter(name) => parameters.value(name)?,
            Number::Expression(expression) => {
                if expression.parameters().any(|name| parameters.value(name).is_none()) {
                    return None;
                }
                expression.evaluate(&|name| Jet::constant(parameters.value(name).unwrap_or(f64::NAN))).value
            }
        };
        if value.is_finite() && value.abs() <= LARGEST {
            return Some(value);
        }
        let names: Vec<String> =
            number.names().iter().filter_map(|name| Some(format!("{name} = {}", parameters.value(name)?))).collect();
        let at = if names.is_empty() { String::new() } else { format!(" at {}", names.join(", ")) };
        self.problem(
            match value.is_finite() {
                true => format!("the value {value:e} of {} is too large to compute with{at}", self.quoted()),
                false => format!("{} is not a finite number{at}", self.quoted()),
            },
            "numbers are finite and go up to 1e150: change the expression or the values of its parameters",
        );
        None
    }

    /// What stands here with its value, for messages: `the number 5`, `"2*F" = 10`.
    pub(super) fn found_number(self, value: f64) -> String {
        self.value.as_str().map_or_else(|| self.found(), |string| format!("{} = {value}", quoted(string)))
    }

    fn magnitude(self, literal: &str) -> Option<f64> {
        let value: f64 = match literal.parse() {
            Ok(value) => value,
            Err(_) => {
                self.wrong_type("a number", LITERAL);
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
        if is_right(value) || self.along().is_some() {
            return Some(value);
        }
        self.problem(
            format!("{what} must be {expected}, found {}", self.found_number(value)),
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
        let value = self.literal()?;
        // Up to 1e15 every whole number is exact in f64 and fits in usize.
        if value.fract() == 0.0 && value >= least as f64 && value <= 1e15 {
            return Some(value as usize);
        }
        let help = if value.fract() != 0.0 {
            "write it without a fraction".to_owned()
        } else if value < least as f64 {
            format!("give {least} or more")
        } else {
            "give no more than 1e15".to_owned()
        };
        self.problem(format!("{what} must be a whole number from {least}, found {}", self.found()), help);
        None
    }

    /// A number ≥ 0 of the region [`Region::Law`] or another that stays symbolic, checked at the present values.
    pub fn non_negative(self, what: &str) -> Option<Number> {
        let number = self.symbolic()?;
        let value = self.value_of(&number)?;
        if value >= 0.0 {
            return Some(number);
        }
        match &number {
            Number::Parameter(name) => self.problem(
                format!("{what} must not be negative, but the parameter `{name}` has the value {value}"),
                format!("give parameters.{name} a value of 0 or more"),
            ),
            Number::Value(_) | Number::Expression(_) => self.problem(
                format!("{what} must not be negative, found {}", self.found_number(value)),
                format!("give a {what} of 0 or more"),
            ),
        }
        None
    }

    /// A number of any sign that stays symbolic, checked to be finite at the present values.
    pub fn any_number(self) -> Option<Number> {
        let number = self.symbolic()?;
        self.value_of(&number).map(|_| number)
    }

    /// A point or a vector: two numbers in the plane, where its z is 0, three in space.
    pub fn vector(self) -> Option<[f64; 3]> {
        let (count, expected, help) = match self.dimension() {
            Dimension::Plane => (2, "two numbers [x, y]", "points and vectors lie in the plane: give x and y"),
            Dimension::Space => (3, "three numbers [x, y, z]", "points and vectors lie in space: give x, y and z"),
        };
        match self.list() {
            None => None,
            Some(entries) if entries.len() == count => {
                let numbers: Vec<Option<f64>> = entries.map(Cursor::number).collect();
                Some([numbers[0]?, numbers[1]?, if count == 3 { numbers[2]? } else { 0.0 }])
            }
            Some(entries) => {
                // Whoever gives a z has forgotten the key that asks for it.
                let space = "give x and y, or \"dimension\": 3 at the top of the file for a structure in space";
                let help = if entries.len() == 3 { space } else { help };
                self.problem(format!("expected {expected}, found {}", self.found()), help);
                None
            }
        }
    }

    /// A vector that is not zero, made a unit vector.
    pub fn direction(self, what: &str) -> Option<[f64; 3]> {
        let vector = self.vector()?;
        // Scaled first: of a subnormal length the quotient would lose its digits.
        let scale = vector.into_iter().fold(0.0, |largest: f64, entry| largest.max(entry.abs()));
        if scale > 0.0 {
            return unit(vector.map(|entry| entry / scale));
        }
        let (zero, up) = match self.dimension() {
            Dimension::Plane => ("[0, 0]", "[0, 1]"),
            Dimension::Space => ("[0, 0, 0]", "[0, 0, 1]"),
        };
        self.problem(
            format!("{what} is {zero} and has no direction"),
            format!("give any non-zero vector: {up} points upwards"),
        );
        None
    }

    /// A moment about each axis: one number in the plane, counter-clockwise, a vector in space.
    pub fn moment(self) -> Option<[f64; 3]> {
        match self.dimension() {
            Dimension::Plane => Some([0.0, 0.0, self.number()?]),
            Dimension::Space => self.vector(),
        }
    }

    /// The word of a displacement component.
    pub fn component(self) -> Option<Component> {
        self.choice(&self.dimension().words())
    }

    /// `count` numbers.
    pub fn numbers(self, count: usize, what: &str) -> Option<Vec<f64>> {
        let mut numbers = Vec::with_capacity(count);
        // All of them are looked at, whatever is wrong with the first.
        self.list_of(count, what)?.for_each(|entry| numbers.extend(entry.number()));
        (numbers.len() == count).then_some(numbers)
    }
}
