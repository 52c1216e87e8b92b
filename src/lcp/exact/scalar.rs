//! The number types that the tableau can compute with.

use std::cmp::Ordering;
use std::fmt::Debug;

use num_rational::{BigRational, Ratio};
use num_traits::{One, Signed, ToPrimitive, Zero};

/// Names the integers that a ratio is made of.
pub trait RatioOf {
    /// Type of numerator and denominator.
    type Integer;
}

impl<T> RatioOf for Ratio<T> {
    type Integer = T;
}

/// The unlimited integers under [`BigRational`].
pub type BigInt = <BigRational as RatioOf>::Integer;

/// A field with signs. All operations take references: exact numbers are large.
pub trait Scalar: Clone + Debug {
    /// The number that a finite `value` stands for, exactly. Infinite and NaN give a number whose
    /// [`Scalar::sign`] is `None` where the type has one, zero otherwise.
    fn from_f64(value: f64) -> Self;
    /// The nearest f64 (±∞ beyond its range, never NaN for a proper number).
    fn to_f64(&self) -> f64;
    /// 0.
    fn zero() -> Self;
    /// 1.
    fn one() -> Self;
    /// `self` + `other`.
    fn add(&self, other: &Self) -> Self;
    /// `self` − `other`.
    fn sub(&self, other: &Self) -> Self;
    /// `self` × `other`.
    fn mul(&self, other: &Self) -> Self;
    /// `self` / `other`; `other` must not be zero.
    fn div(&self, other: &Self) -> Self;
    /// −`self`.
    fn neg(&self) -> Self;
    /// Sign against zero; `None` when it cannot be determined (NaN, too little precision).
    fn sign(&self) -> Option<Ordering>;
    /// Whether the type knows no rounding: then zero tests compare with zero, without tolerance.
    fn is_exact() -> bool;

    /// `self` against `other`; `None` when it cannot be determined.
    fn compare(&self, other: &Self) -> Option<Ordering> {
        self.sub(other).sign()
    }

    /// Certainly zero.
    fn is_zero(&self) -> bool {
        self.sign() == Some(Ordering::Equal)
    }
}

impl Scalar for f64 {
    fn from_f64(value: f64) -> Self {
        value
    }
    fn to_f64(&self) -> f64 {
        *self
    }
    fn zero() -> Self {
        0.0
    }
    fn one() -> Self {
        1.0
    }
    fn add(&self, other: &Self) -> Self {
        self + other
    }
    fn sub(&self, other: &Self) -> Self {
        self - other
    }
    fn mul(&self, other: &Self) -> Self {
        self * other
    }
    fn div(&self, other: &Self) -> Self {
        self / other
    }
    fn neg(&self) -> Self {
        -self
    }
    fn sign(&self) -> Option<Ordering> {
        self.partial_cmp(&0.0)
    }
    fn is_exact() -> bool {
        false
    }
    fn is_zero(&self) -> bool {
        *self == 0.0
    }
}

impl Scalar for BigRational {
    fn from_f64(value: f64) -> Self {
        BigRational::from_float(value).unwrap_or_else(Zero::zero)
    }
    fn to_f64(&self) -> f64 {
        ratio_to_f64(self.numer(), self.denom())
    }
    fn zero() -> Self {
        Zero::zero()
    }
    fn one() -> Self {
        One::one()
    }
    fn add(&self, other: &Self) -> Self {
        self + other
    }
    fn sub(&self, other: &Self) -> Self {
        self - other
    }
    fn mul(&self, other: &Self) -> Self {
        self * other
    }
    fn div(&self, other: &Self) -> Self {
        self / other
    }
    fn neg(&self) -> Self {
        -self
    }
    fn sign(&self) -> Option<Ordering> {
        // Denominators are kept positive.
        Some(self.numer().cmp(&BigInt::zero()))
    }
    fn compare(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
    fn is_exact() -> bool {
        true
    }
}

/// numerator / denominator as f64 with a relative error below 2⁻⁵²; ±∞ and 0 beyond the range.
/// Both are shifted first, so that neither overflows when the quotient does not.
pub fn ratio_to_f64(numerator: &BigInt, denominator: &BigInt) -> f64 {
    if numerator.is_zero() {
        return 0.0;
    }
    // Quotient with 64 or 65 significant bits.
    let shift = 64 + denominator.bits() as i64 - numerator.bits() as i64;
    let quotient = if shift >= 0 {
        (numerator.abs() << shift as u64) / denominator.abs()
    } else {
        numerator.abs() / (denominator.abs() << (-shift) as u64)
    };
    let mantissa = quotient.to_f64().unwrap_or(f64::INFINITY);
    let magnitude = times_power_of_two(mantissa, -shift);
    if numerator.is_negative() != denominator.is_negative() { -magnitude } else { magnitude }
}

/// x · 2^e without intermediate overflow.
pub(crate) fn times_power_of_two(x: f64, mut exponent: i64) -> f64 {
    let mut x = x;
    exponent = exponent.clamp(-4400, 4400);
    while exponent != 0 && x != 0.0 && x.is_finite() {
        let step = exponent.clamp(-1000, 1000);
        x *= 2f64.powi(step as i32);
        exponent -= step;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn f64_goes_through_rationals_unchanged() {
        for x in [0.1, -3.0, 1e300, 5e-324, f64::MAX, -2.5e-200, 0.0] {
            assert_eq!(Scalar::to_f64(&<BigRational as Scalar>::from_f64(x)), x);
        }
    }

    #[test]
    fn quotients_of_huge_integers_do_not_overflow() {
        let huge = BigInt::one() << 40_000u32;
        let third = BigRational::new(huge.clone() + BigInt::one(), huge.clone() * BigInt::from(3));
        assert!((Scalar::to_f64(&third) - 1.0 / 3.0).abs() < 1e-16);
        let large = BigRational::new(huge.clone(), -BigInt::one());
        assert_eq!(Scalar::to_f64(&large), f64::NEG_INFINITY);
        let small = BigRational::new(BigInt::one(), huge);
        assert_eq!(Scalar::to_f64(&small), 0.0);
    }
}
