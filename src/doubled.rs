//! The numbers that an element may be computed in: f64, or doubled precision; and sums that know what they lose.
//!
//! Residuals of equations that cancel are computed in doubled precision, and so are the stiffnesses they need: the f64
//! stiffness matrix of a bar divided into thousands of elements has lost the stiffness of the whole bar in the rounding of
//! its entries. A [`Sum`] is faster where numbers are only added up, and it knows the magnitude of its terms as well.

use std::ops::Neg;

use nalgebra::{ClosedAddAssign, ClosedDivAssign, ClosedMulAssign, ClosedSubAssign, Scalar};
use num_traits::{One, Zero};
pub use stickslip_numerics::doubled::Doubled;

/// A number that elements are computed in: f64, or [`Doubled`] where f64 loses too much.
pub trait Real:
    Scalar
    + Copy
    + Send
    + Sync
    + Zero
    + One
    + From<f64>
    + ClosedAddAssign
    + ClosedSubAssign
    + ClosedMulAssign
    + ClosedDivAssign
    + Neg<Output = Self>
{
    /// Square root of a number ≥ 0.
    fn sqrt(self) -> Self;
    /// The nearest f64.
    fn to_f64(self) -> f64;
    /// a − b, formed in this type: a [`Doubled`] keeps what the difference in f64 rounds away.
    fn difference(a: f64, b: f64) -> Self;
}

impl Real for f64 {
    fn sqrt(self) -> f64 {
        self.sqrt()
    }

    fn to_f64(self) -> f64 {
        self
    }

    fn difference(a: f64, b: f64) -> f64 {
        a - b
    }
}

impl Real for Doubled {
    fn sqrt(self) -> Doubled {
        Doubled::sqrt(self)
    }

    fn to_f64(self) -> f64 {
        Doubled::to_f64(self)
    }

    fn difference(a: f64, b: f64) -> Doubled {
        Doubled::sum(a, -b)
    }
}

/// A sum of numbers and products, carried with an error of the order of ε² Σ |terms| (Ogita, Rump & Oishi, *Accurate
/// sum and dot product*, 2005).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sum {
    high: f64,
    low: f64,
    magnitude: f64,
}

impl Sum {
    /// Adds `term`.
    pub fn add(&mut self, term: f64) {
        let sum = Doubled::sum(self.high, term);
        self.high = sum.to_f64();
        self.low += sum.tail();
        self.magnitude += term.abs();
    }

    /// Adds a · b.
    pub fn add_product(&mut self, a: f64, b: f64) {
        let product = Doubled::product(a, b);
        self.add(product.to_f64());
        self.low += product.tail();
    }

    /// Its value.
    pub fn value(self) -> f64 {
        self.high + self.low
    }

    /// Σ |terms|.
    pub fn magnitude(self) -> f64 {
        self.magnitude
    }

    /// Its value as a fraction of Σ |terms|; 0 where all terms are.
    pub fn relative(self) -> f64 {
        if self.magnitude == 0.0 { 0.0 } else { self.value() / self.magnitude }
    }
}

/// Σ a_i b_i + start, rounded once.
pub fn dot<'a>(start: f64, terms: impl Iterator<Item = (&'a f64, &'a f64)>) -> f64 {
    sum_of_products(start, terms).value()
}

/// The same before it is rounded.
pub fn sum_of_products<'a>(start: f64, terms: impl Iterator<Item = (&'a f64, &'a f64)>) -> Sum {
    let mut sum = Sum::default();
    sum.add(start);
    terms.filter(|(a, b)| **a != 0.0 && **b != 0.0).for_each(|(a, b)| sum.add_product(*a, *b));
    sum
}

#[cfg(test)]
mod tests {
    use num_rational::BigRational;
    use proptest::prelude::*;
    use stickslip_numerics::doubled as vectors;
    use stickslip_numerics::products::{halved_sums, roundings};

    use super::*;

    fn exact(x: Doubled) -> BigRational {
        BigRational::from_float(x.to_f64()).unwrap() + BigRational::from_float(x.tail()).unwrap()
    }

    fn number() -> impl Strategy<Value = Doubled> {
        (-1.0_f64..1.0, -1.0_f64..1.0, -30_i32..30)
            .prop_map(|(hi, lo, scale)| Doubled::sum(hi, lo * 1e-17) * Doubled::from(f64::from(scale).exp2()))
    }

    proptest! {
        /// The four operations and the root against rationals: 2⁻¹⁰² of the terms.
        #[test]
        fn operations_have_twice_the_digits(a in number(), b in number()) {
            prop_assume!(a.to_f64() != 0.0 && b.to_f64() != 0.0);
            let close = |found: Doubled, right: BigRational, terms: f64| {
                let error = exact(found) - right;
                let bound = BigRational::from_float(terms.abs() * (-102_f64).exp2()).unwrap();
                error <= bound && error >= -bound
            };
            let (x, y) = (exact(a), exact(b));
            prop_assert!(close(a + b, &x + &y, a.to_f64().abs() + b.to_f64().abs()));
            prop_assert!(close(a - b, &x - &y, a.to_f64().abs() + b.to_f64().abs()));
            prop_assert!(close(a * b, &x * &y, a.to_f64() * b.to_f64()));
            prop_assert!(close(a / b, &x / &y, a.to_f64() / b.to_f64()));
            let root = (a * a).sqrt();
            prop_assert!(close(root * root, exact(a * a), a.to_f64() * a.to_f64()));
        }
    }

    proptest! {
        /// Work on vectors, with fused products where the processor has them, has the bytes of the operators.
        #[test]
        fn vectors_have_the_bytes_of_their_numbers(
            numbers in prop::collection::vec((number(), number()), 0..40), factor in number(),
        ) {
            let (a, b): (Vec<Doubled>, Vec<Doubled>) = numbers.iter().copied().unzip();
            let sum = numbers.iter().fold(Doubled::zero(), |sum, (a, b)| sum + *a * *b);
            prop_assert_eq!(vectors::dot(&a, &b), sum);
            let mut added = a.clone();
            vectors::add_multiple(&mut added, factor, &b);
            prop_assert!(numbers.iter().zip(added).all(|((a, b), added)| added == *a + factor * *b));
        }
    }

    proptest! {
        /// Sums by halves lose at most what they say, against rationals: terms cancel, every length of a last run.
        #[test]
        fn sums_by_halves_lose_what_they_say(
            numbers in prop::collection::vec((-1.0_f64..1.0, -1.0_f64..1.0, -30_i32..30), 1..300), cancels: bool,
        ) {
            let (mut a, mut b): (Vec<f64>, Vec<f64>) =
                numbers.iter().map(|(a, b, scale)| (a * f64::from(*scale).exp2(), *b)).unzip();
            if cancels {
                let negative: Vec<f64> = a.iter().map(|a| -a * (1.0 + 1e-15)).collect();
                a.extend(negative);
                b.extend_from_within(..);
            }
            let (sum, magnitude) = halved_sums(&a, &b);
            let rational = |x: f64| BigRational::from_float(x).unwrap();
            let terms = || a.iter().zip(&b).map(|(a, b)| rational(*a) * rational(*b));
            let (right, size) = terms().fold((rational(0.0), rational(0.0)), |(sum, size), term| {
                let absolute = if term < rational(0.0) { -term.clone() } else { term.clone() };
                (sum + term, size + absolute)
            });
            // first order in ε, so a thousandth more
            let bound = rational(1.001 * roundings(a.len()) * f64::EPSILON / 2.0) * &size;
            for error in [rational(sum) - right, rational(magnitude) - size] {
                prop_assert!(error <= bound && -error <= bound);
            }
        }
    }

    #[test]
    fn a_product_is_what_a_fused_product_makes_it() {
        let mut state = 0.3_f64;
        let mut next = |exponent: i32| {
            state = (state * 997.0).fract() + 1e-3;
            (state - 0.5) * f64::powi(2.0, exponent)
        };
        // At 2^±500 nothing overflows, at 2^1000 the halves would.
        for exponents in [[0, 0], [500, -500], [400, 500], [-400, -500], [1000, -900], [20, 1000], [3, -300]] {
            for _ in 0..1000 {
                let [a, b] = exponents.map(&mut next);
                let product = Doubled::product(a, b);
                assert_eq!((product.to_f64(), product.tail()), (a * b, a.mul_add(b, -(a * b))), "{a:e} {b:e}");
            }
        }
        assert_eq!(Doubled::product(0.0, -2.0), Doubled::zero());
        assert!(Doubled::product(f64::MAX, 2.0).to_f64().is_infinite());
    }

    #[test]
    fn terms_that_cancel_leave_what_f64_loses() {
        let mut sum = Sum::default();
        let third = 1.0 / 3.0;
        // 3 · fl(1/3) − 1 = −2⁻⁵⁴ exactly, rounded away by f64 arithmetic.
        sum.add_product(3.0, third);
        sum.add(-1.0);
        assert_eq!(sum.value(), -f64::powi(2.0, -54));
        assert_eq!(3.0 * third - 1.0, 0.0);
        let mut sum = Sum::default();
        [1e17, 1.0, -1e17].into_iter().for_each(|term| sum.add(term));
        assert_eq!(sum.value(), 1.0);
    }

    #[test]
    fn what_cancels_is_kept() {
        // (1 + ε)² − 1 − 2ε = ε².
        let a = 1.0 + f64::EPSILON;
        let sum = dot(-1.0, [a, -2.0].iter().zip([a, f64::EPSILON].iter()));
        assert_eq!(sum, f64::EPSILON * f64::EPSILON);
    }
}
