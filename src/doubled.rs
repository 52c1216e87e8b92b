//! Arithmetic in doubled precision, and the numbers that an element may be computed in.
//!
//! A [`Doubled`] is the unevaluated sum of two f64, some 32 digits, by error-free transformations (Dekker 1971;
//! Hida, Li, Bailey, *Algorithms for quad-double precision floating point arithmetic*, 2001). Residuals of equations
//! that cancel are computed in it, and so are the stiffnesses they need: the f64 stiffness matrix of a bar divided into
//! thousands of elements has lost the stiffness of the whole bar in the rounding of its entries. A [`Sum`] is faster
//! where numbers are only added up, and it knows the magnitude of its terms as well.

use std::fmt;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use nalgebra::{ClosedAddAssign, ClosedDivAssign, ClosedMulAssign, ClosedSubAssign, Scalar};
use num_traits::{One, Zero};
use stickslip_numerics::products::Split;

/// A number that elements are computed in: f64, or [`Doubled`] where f64 loses too much.
pub trait Real:
    Scalar
    + Copy
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

/// hi + lo, |lo| ≤ ½ ulp(hi).
#[derive(Clone, Copy, Default, PartialEq)]
pub struct Doubled {
    hi: f64,
    lo: f64,
}

impl Doubled {
    /// a·b exactly, as long as what is rounded away is not below the numbers there are.
    pub fn product(a: f64, b: f64) -> Doubled {
        let fused = |hi: f64| Doubled { hi, lo: a.mul_add(b, -hi) };
        if cfg!(any(target_feature = "fma", target_arch = "aarch64")) {
            return fused(a * b);
        }
        // Where the processor is not known to have a fused product, calling one costs more than the halves of the
        // digits multiplied one by one.
        let (hi, lo) = Split::new(a).times(&Split::new(b));
        if lo.is_finite() { Doubled { hi, lo } } else { fused(hi) }
    }

    /// What rounding to the nearest f64 leaves.
    pub fn tail(self) -> f64 {
        self.lo
    }

    /// hi + lo of any two numbers.
    pub fn sum(a: f64, b: f64) -> Doubled {
        let hi = a + b;
        let part = hi - a;
        Doubled { hi, lo: (a - (hi - part)) + (b - part) }
    }

    /// As [`Doubled::sum`], for |a| ≥ |b|.
    fn ordered_sum(a: f64, b: f64) -> Doubled {
        let hi = a + b;
        Doubled { hi, lo: b - (hi - a) }
    }
}

impl Real for Doubled {
    fn sqrt(self) -> Doubled {
        if self.hi <= 0.0 {
            return Doubled::default();
        }
        // One step of Newton's method from the f64 root doubles its digits.
        let root = self.hi.sqrt();
        let rest = self - Doubled::product(root, root);
        Doubled::ordered_sum(root, rest.hi / (2.0 * root))
    }

    fn to_f64(self) -> f64 {
        self.hi
    }

    fn difference(a: f64, b: f64) -> Doubled {
        Doubled::sum(a, -b)
    }
}

impl fmt::Debug for Doubled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:e} + {:e}", self.hi, self.lo)
    }
}

impl From<f64> for Doubled {
    fn from(value: f64) -> Doubled {
        Doubled { hi: value, lo: 0.0 }
    }
}

impl Neg for Doubled {
    type Output = Doubled;

    fn neg(self) -> Doubled {
        Doubled { hi: -self.hi, lo: -self.lo }
    }
}

impl Add for Doubled {
    type Output = Doubled;

    fn add(self, other: Doubled) -> Doubled {
        let high = Doubled::sum(self.hi, other.hi);
        let low = Doubled::sum(self.lo, other.lo);
        let sum = Doubled::ordered_sum(high.hi, high.lo + low.hi);
        Doubled::ordered_sum(sum.hi, sum.lo + low.lo)
    }
}

impl Sub for Doubled {
    type Output = Doubled;

    fn sub(self, other: Doubled) -> Doubled {
        self + -other
    }
}

impl Mul for Doubled {
    type Output = Doubled;

    fn mul(self, other: Doubled) -> Doubled {
        let product = Doubled::product(self.hi, other.hi);
        Doubled::ordered_sum(product.hi, product.lo + (self.hi * other.lo + self.lo * other.hi))
    }
}

impl Div for Doubled {
    type Output = Doubled;

    fn div(self, other: Doubled) -> Doubled {
        let first = self.hi / other.hi;
        let rest = self - other * Doubled::from(first);
        let second = rest.hi / other.hi;
        let rest = rest - other * Doubled::from(second);
        Doubled::ordered_sum(first, second) + Doubled::from(rest.hi / other.hi)
    }
}

macro_rules! assign {
    ($($trait:ident $method:ident $operator:tt),*) => {$(
        impl $trait for Doubled {
            fn $method(&mut self, other: Doubled) {
                *self = *self $operator other;
            }
        }
    )*};
}

assign!(AddAssign add_assign +, SubAssign sub_assign -, MulAssign mul_assign *, DivAssign div_assign /);

impl Zero for Doubled {
    fn zero() -> Doubled {
        Doubled::default()
    }

    fn is_zero(&self) -> bool {
        self.hi == 0.0
    }
}

impl One for Doubled {
    fn one() -> Doubled {
        Doubled::from(1.0)
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
        self.high = sum.hi;
        self.low += sum.lo;
        self.magnitude += term.abs();
    }

    /// Adds a · b.
    pub fn add_product(&mut self, a: f64, b: f64) {
        let product = Doubled::product(a, b);
        self.add(product.hi);
        self.low += product.lo;
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

    use super::*;

    fn exact(x: Doubled) -> BigRational {
        BigRational::from_float(x.hi).unwrap() + BigRational::from_float(x.lo).unwrap()
    }

    fn number() -> impl Strategy<Value = Doubled> {
        (-1.0_f64..1.0, -1.0_f64..1.0, -30_i32..30)
            .prop_map(|(hi, lo, scale)| Doubled::sum(hi, lo * 1e-17) * Doubled::from(f64::from(scale).exp2()))
    }

    proptest! {
        /// The four operations and the root against rationals: 2⁻¹⁰² of the terms.
        #[test]
        fn operations_have_twice_the_digits(a in number(), b in number()) {
            prop_assume!(a.hi != 0.0 && b.hi != 0.0);
            let close = |found: Doubled, right: BigRational, terms: f64| {
                let error = exact(found) - right;
                let bound = BigRational::from_float(terms.abs() * (-102_f64).exp2()).unwrap();
                error <= bound && error >= -bound
            };
            let (x, y) = (exact(a), exact(b));
            prop_assert!(close(a + b, &x + &y, a.hi.abs() + b.hi.abs()));
            prop_assert!(close(a - b, &x - &y, a.hi.abs() + b.hi.abs()));
            prop_assert!(close(a * b, &x * &y, a.hi * b.hi));
            prop_assert!(close(a / b, &x / &y, a.hi / b.hi));
            let root = (a * a).sqrt();
            prop_assert!(close(root * root, exact(a * a), a.hi * a.hi));
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
                let Doubled { hi, lo } = Doubled::product(a, b);
                assert_eq!((hi, lo), (a * b, a.mul_add(b, -hi)), "{a:e} {b:e}");
            }
        }
        assert_eq!(Doubled::product(0.0, -2.0), Doubled { hi: 0.0, lo: 0.0 });
        assert!(Doubled::product(f64::MAX, 2.0).hi.is_infinite());
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
