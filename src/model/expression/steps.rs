//! An expression in postfix order, so that neither its value nor its end needs recursion.

use std::sync::Arc;

use crate::model::jet::Jet;

/// One step in postfix order: it takes its operands off the stack and puts its value there.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    Value(f64),
    Parameter(Arc<str>),
    Negate,
    Binary(Binary),
    /// The function and its number of arguments.
    Call(Function, usize),
}

/// An operator of two operands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Binary {
    Plus,
    Minus,
    Times,
    Over,
    Power,
}

/// A function of one argument, `min` and `max` of several.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Function {
    Sqrt,
    Abs,
    Min,
    Max,
    Sin,
    Cos,
    Tan,
    Atan,
}

/// The functions by their names.
pub const FUNCTIONS: [(&str, Function); 8] = [
    ("sqrt", Function::Sqrt),
    ("abs", Function::Abs),
    ("min", Function::Min),
    ("max", Function::Max),
    ("sin", Function::Sin),
    ("cos", Function::Cos),
    ("tan", Function::Tan),
    ("atan", Function::Atan),
];

/// Value and rate of the steps, from those of the parameters.
pub fn evaluate(steps: &[Step], parameter: &dyn Fn(&str) -> Jet) -> Jet {
    let mut stack: Vec<Jet> = Vec::with_capacity(8);
    for step in steps {
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
