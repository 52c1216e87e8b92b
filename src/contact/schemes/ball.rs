//! f64 numbers with an error bound: what a ball says of a sign is proved.

use num_rational::BigRational;

use crate::lcp::exact::dyadic::{nearest, rational};

/// Bounds the relative error of an operation in f64: four times half a unit in the last place, as the radius itself is
/// rounded, too.
const ROUNDING: f64 = 2.0 * f64::EPSILON;
/// What underflow can lose.
const TINY: f64 = f64::MIN_POSITIVE;

/// All numbers within `radius` of `middle`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ball {
    pub middle: f64,
    pub radius: f64,
}

impl Ball {
    pub const ZERO: Ball = Ball { middle: 0.0, radius: 0.0 };

    /// The number itself.
    pub fn exactly(middle: f64) -> Self {
        Self { middle, radius: 0.0 }
    }

    /// A number that was rounded to the nearest f64, to a unit in the last place.
    pub fn rounded(middle: f64) -> Self {
        Self { middle, radius: f64::EPSILON * middle.abs() + TINY }
    }

    /// A number rounded to the nearest f64.
    pub fn around(value: &BigRational) -> Self {
        let near = nearest(value);
        if rational(near) == *value { Ball::exactly(near) } else { Ball::rounded(near) }
    }

    /// As much farther either way.
    pub fn within(self, room: f64) -> Self {
        self.plus(Ball { middle: 0.0, radius: room })
    }

    fn widened(middle: f64, radius: f64) -> Self {
        Self { middle, radius: (radius + ROUNDING * middle.abs() + TINY) * (1.0 + 4.0 * ROUNDING) }
    }

    /// Exactly zero: nothing can come of it.
    pub fn is_nothing(self) -> bool {
        self.middle == 0.0 && self.radius == 0.0
    }

    pub fn plus(self, other: Self) -> Self {
        if self.is_nothing() {
            return other;
        }
        if other.is_nothing() {
            return self;
        }
        Self::widened(self.middle + other.middle, self.radius + other.radius)
    }

    pub fn minus(self, other: Self) -> Self {
        self.plus(other.negative())
    }

    pub fn negative(self) -> Self {
        Self { middle: -self.middle, ..self }
    }

    pub fn times(self, other: Self) -> Self {
        if self.is_nothing() || other.is_nothing() {
            return Self::ZERO;
        }
        let spread = self.middle.abs() * other.radius + other.middle.abs() * self.radius + self.radius * other.radius;
        Self::widened(self.middle * other.middle, spread)
    }

    /// `None` where the divisor may be zero.
    pub fn over(self, other: Self) -> Option<Self> {
        let least = (other.middle.abs() - other.radius) * (1.0 - 2.0 * ROUNDING);
        if least.is_nan() || least <= 0.0 {
            return None;
        }
        if self.is_nothing() {
            return Some(self);
        }
        let middle = self.middle / other.middle;
        Some(Self::widened(middle, (self.radius + middle.abs() * other.radius) / least))
    }

    /// The largest value that the product with some x in [low, high] can have; low ≤ 0 ≤ high need not hold.
    pub fn largest_times(self, low: f64, high: f64) -> f64 {
        let corner = |a: f64, x: f64| if a == 0.0 { 0.0 } else { a * x };
        let ends = [self.middle - self.radius, self.middle + self.radius];
        let largest = ends
            .iter()
            .flat_map(|a| [corner(*a, low), corner(*a, high)])
            .fold(f64::NEG_INFINITY, |most, value| if value.is_nan() { f64::INFINITY } else { most.max(value) });
        largest + ROUNDING * largest.abs()
    }
}

/// An affine function of undecided displacements, the constant last.
pub(crate) type Row = Vec<Ball>;

/// Largest entry of a row.
fn size(row: &[Ball]) -> f64 {
    row.iter().fold(f64::MIN_POSITIVE, |largest, entry| largest.max(entry.middle.abs()))
}

/// The displacements of `columns` from as many equations, each in terms of the others, by elimination with the
/// relatively largest pivot; `None` where a pivot may be zero.
pub(crate) fn eliminated(mut equations: Vec<Row>, columns: &[usize]) -> Option<Vec<Row>> {
    let mut solved: Vec<Option<Row>> = vec![None; columns.len()];
    for _ in 0..columns.len() {
        let relative = |row: &Row, at: usize| row[columns[at]].middle.abs() / size(row);
        let open = || (0..columns.len()).filter(|at| solved[*at].is_none());
        let candidates = (0..equations.len()).flat_map(|row| open().map(move |at| (row, at)));
        let (row, at) = candidates.max_by(|a, b| {
            let (left, right) = (relative(&equations[a.0], a.1), relative(&equations[b.0], b.1));
            left.total_cmp(&right).then(b.cmp(a))
        })?;
        let pivot = equations[row][columns[at]].negative();
        let mut own: Row = equations.swap_remove(row).iter().map(|entry| entry.over(pivot)).collect::<Option<_>>()?;
        own[columns[at]] = Ball::ZERO;
        for row in equations.iter_mut().chain(solved.iter_mut().flatten()) {
            let factor = std::mem::replace(&mut row[columns[at]], Ball::ZERO);
            row.iter_mut().zip(&own).for_each(|(entry, own)| *entry = entry.plus(factor.times(*own)));
        }
        solved[at] = Some(own);
    }
    solved.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_rational::BigRational;
    use proptest::prelude::*;

    fn exact(value: f64) -> BigRational {
        BigRational::from_float(value).expect("finite")
    }

    fn holds(ball: Ball, value: &BigRational) -> bool {
        exact(ball.middle) - exact(ball.radius) <= *value && *value <= exact(ball.middle) + exact(ball.radius)
    }

    proptest! {
        /// (a b − c) / d and a sum that cancels, against rationals.
        #[test]
        fn the_exact_value_lies_in_the_ball(
            a in -1e6..1e6f64, b in -1e-6..1e6f64, c in -1e6..1e6f64, d in prop_oneof![1e-9..1e9f64, -1e9..-1e-9f64],
        ) {
            let [x, y, z, w] = [a, b, c, d].map(Ball::exactly);
            let product = exact(a) * exact(b);
            prop_assert!(holds(x.times(y), &product));
            let difference = &product - exact(c);
            prop_assert!(holds(x.times(y).minus(z), &difference));
            let quotient = &difference / exact(d);
            let found = x.times(y).minus(z).over(w).expect("d is not zero");
            prop_assert!(holds(found, &quotient));
            let back = found.times(w).plus(z).minus(x.times(y));
            prop_assert!(holds(back, &exact(0.0)));
        }
    }

    #[test]
    fn what_may_be_zero_does_not_divide() {
        assert_eq!(Ball::exactly(1.0).over(Ball { middle: 1e-3, radius: 1e-3 }), None);
        assert_eq!(Ball::exactly(1.0).over(Ball { middle: f64::NAN, radius: 0.0 }), None);
        assert_eq!(Ball::exactly(2.0).largest_times(-1.0, f64::INFINITY), f64::INFINITY);
        assert_eq!(Ball::ZERO.largest_times(0.0, f64::INFINITY), 0.0);
    }
}
