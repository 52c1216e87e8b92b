//! A value with its rate along one parameter, and how it depends on it.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// How a number depends on the parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Dependence {
    /// Not at all.
    Constant,
    /// As a + b θ, everywhere.
    Affine,
    /// In another way; the rate is that at the present value.
    Nonlinear,
}

/// Value, derivative and kind of dependence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    /// The value.
    pub value: f64,
    /// d value / dθ.
    pub rate: f64,
    /// How it depends on θ.
    pub dependence: Dependence,
}

impl Jet {
    /// A number that does not depend on θ.
    pub fn constant(value: f64) -> Jet {
        Jet { value, rate: 0.0, dependence: Dependence::Constant }
    }

    /// θ itself.
    pub fn parameter(value: f64) -> Jet {
        Jet { value, rate: 1.0, dependence: Dependence::Affine }
    }

    /// A function of this value with the given slope.
    fn through(self, value: f64, slope: f64) -> Jet {
        match self.dependence {
            Dependence::Constant => Jet::constant(value),
            _ => Jet { value, rate: slope * self.rate, dependence: Dependence::Nonlinear },
        }
    }

    /// √.
    pub fn sqrt(self) -> Jet {
        let root = self.value.sqrt();
        self.through(root, 0.5 / root)
    }

    /// |…|.
    pub fn abs(self) -> Jet {
        self.through(self.value.abs(), if self.value < 0.0 { -1.0 } else { 1.0 })
    }

    /// Sine of radians.
    pub fn sin(self) -> Jet {
        self.through(self.value.sin(), self.value.cos())
    }

    /// Cosine of radians.
    pub fn cos(self) -> Jet {
        self.through(self.value.cos(), -self.value.sin())
    }

    /// Tangent of radians.
    pub fn tan(self) -> Jet {
        let tangent = self.value.tan();
        self.through(tangent, 1.0 + tangent * tangent)
    }

    /// Arc tangent, in radians.
    pub fn atan(self) -> Jet {
        self.through(self.value.atan(), 1.0 / (1.0 + self.value * self.value))
    }

    /// self^exponent.
    pub fn power(self, exponent: Jet) -> Jet {
        let value = self.value.powf(exponent.value);
        if exponent.dependence == Dependence::Constant {
            let slope =
                if exponent.value == 0.0 { 0.0 } else { exponent.value * self.value.powf(exponent.value - 1.0) };
            return self.through(value, slope);
        }
        let rate = exponent.rate * value * self.value.ln()
            + if self.rate == 0.0 { 0.0 } else { exponent.value * self.value.powf(exponent.value - 1.0) * self.rate };
        Jet { value, rate, dependence: Dependence::Nonlinear }
    }

    /// The smaller of two.
    pub fn min(self, other: Jet) -> Jet {
        self.chosen(other, other.value < self.value)
    }

    /// The larger of two.
    pub fn max(self, other: Jet) -> Jet {
        self.chosen(other, other.value > self.value)
    }

    fn chosen(self, other: Jet, take_other: bool) -> Jet {
        // A value that is not a number stays visible.
        let chosen = if take_other || other.value.is_nan() { other } else { self };
        match self.dependence.max(other.dependence) {
            Dependence::Constant => chosen,
            _ => Jet { dependence: Dependence::Nonlinear, ..chosen },
        }
    }
}

impl Neg for Jet {
    type Output = Jet;
    fn neg(self) -> Jet {
        Jet { value: -self.value, rate: -self.rate, ..self }
    }
}

impl Add for Jet {
    type Output = Jet;
    fn add(self, other: Jet) -> Jet {
        Jet {
            value: self.value + other.value,
            rate: self.rate + other.rate,
            dependence: self.dependence.max(other.dependence),
        }
    }
}

impl Sub for Jet {
    type Output = Jet;
    fn sub(self, other: Jet) -> Jet {
        self + -other
    }
}

impl Mul for Jet {
    type Output = Jet;
    fn mul(self, other: Jet) -> Jet {
        let dependence = match (self.dependence, other.dependence) {
            (Dependence::Constant, kind) | (kind, Dependence::Constant) => kind,
            _ => Dependence::Nonlinear,
        };
        let part = |rate: f64, factor: f64| if rate == 0.0 { 0.0 } else { rate * factor };
        Jet {
            value: self.value * other.value,
            rate: part(self.rate, other.value) + part(other.rate, self.value),
            dependence,
        }
    }
}

impl Div for Jet {
    type Output = Jet;
    fn div(self, other: Jet) -> Jet {
        let value = self.value / other.value;
        let rate = (self.rate - value * other.rate) / other.value;
        match other.dependence {
            Dependence::Constant if self.dependence == Dependence::Constant => Jet::constant(value),
            Dependence::Constant => Jet { value, rate, dependence: self.dependence },
            _ => Jet { value, rate, dependence: Dependence::Nonlinear },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::expression::Expression;

    fn jet(text: &str, x: f64) -> Jet {
        let expression = Expression::parse(text, &["x", "c"]).unwrap();
        expression.evaluate(&|name| if name == "x" { Jet::parameter(x) } else { Jet::constant(3.0) })
    }

    #[test]
    fn rates_are_derivatives() {
        for text in [
            "x",
            "2*x + 1",
            "x*x",
            "x^3",
            "c^x",
            "x^x",
            "sin(x)*cos(x)",
            "tan(x)",
            "atan(c*x)",
            "sqrt(x)",
            "abs(-x)",
            "1/x",
            "x/(1+x)",
            "min(x, 2*x)",
            "max(x, 2*x, c*x)",
            "-x^2",
        ] {
            let (x, h) = (0.7, 1e-5);
            let difference = (jet(text, x + h).value - jet(text, x - h).value) / (2.0 * h);
            // Second order in h, and rounding ε/h of the difference.
            assert!((jet(text, x).rate - difference).abs() < 1e-8 * (1.0 + difference.abs()), "{text}");
        }
    }

    #[test]
    fn dependence_is_seen_through_every_operation() {
        use Dependence::{Affine, Constant, Nonlinear};
        for (text, expected) in [
            ("c + 1", Constant),
            ("sin(c)^2", Constant),
            ("x", Affine),
            ("c*(2 - x/4) + sqrt(c)", Affine),
            ("x/c", Affine),
            ("-x", Affine),
            ("x*x", Nonlinear),
            ("c/x", Nonlinear),
            ("x^1", Nonlinear),
            ("sin(x)", Nonlinear),
            ("max(x, 0)", Nonlinear),
        ] {
            assert_eq!(jet(text, 2.0).dependence, expected, "{text}");
        }
    }
}
