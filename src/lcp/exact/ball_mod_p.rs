//! Exact signs at the price of floating point: a number held twice, as a ball of many bits and modulo a prime.
//!
//! Rational entries of a large tableau grow to tens of thousands of bits; their signs rarely need more than a
//! few hundred. A [`BallModP`] number is an interval (midpoint of at most `precision` bits, radius) that is sure to
//! hold the true rational value, and the residue of that value modulo 2⁶¹ − 1. Sign:
//!
//! * the ball does not hold zero: the sign is certain;
//! * it does, and the residue is zero: taken for zero. Wrong with a chance of about 2⁻⁴⁶ per number, so whoever uses
//!   this verifies the end result in rationals;
//! * it does, and the residue is not zero: not zero for certain, but the sign is not known: `None`. The run is
//!   repeated with more bits.

use std::cmp::Ordering;

use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};

use crate::lcp::exact::scalar::{BigInt, Scalar, times_power_of_two};

/// 2⁶¹ − 1, prime; powers of two are rotations.
const PRIME: u64 = (1 << 61) - 1;
/// Makes a rounded f64 product or sum an upper bound.
const UP: f64 = 1.0 + 4.0 * f64::EPSILON;

/// A positive upper bound m · 2^e, 1 ≤ m < 2, or zero.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bound {
    m: f64,
    e: i64,
}

impl Bound {
    const ZERO: Bound = Bound { m: 0.0, e: 0 };
    /// The bound of a number of which nothing is known.
    const INFINITE: Bound = Bound { m: f64::INFINITY, e: 0 };

    fn new(mut m: f64, mut e: i64) -> Self {
        if m == 0.0 || m.is_infinite() {
            return Bound { m, e: 0 };
        }
        if m < f64::MIN_POSITIVE {
            // Subnormal: normalize first.
            m *= 2f64.powi(64);
            e -= 64;
        }
        // The exponent bits of a positive normal number.
        let bits = m.to_bits();
        let exponent = (bits >> 52) as i64 - 1023;
        m = f64::from_bits((bits & ((1 << 52) - 1)) | (1023 << 52));
        Bound { m, e: e + exponent }
    }

    fn power_of_two(e: i64) -> Self {
        Bound { m: 1.0, e }
    }

    fn is_zero(self) -> bool {
        self.m == 0.0
    }

    fn times(self, other: Bound) -> Bound {
        if self.is_zero() || other.is_zero() {
            return Bound::ZERO;
        }
        Bound::new(self.m * other.m * UP, self.e + other.e)
    }

    fn plus(self, other: Bound) -> Bound {
        if self.is_zero() {
            return other;
        }
        if other.is_zero() {
            return self;
        }
        let (large, small) = if self.e >= other.e { (self, other) } else { (other, self) };
        let shift = (large.e - small.e).min(200) as i32;
        Bound::new((large.m + small.m * 2f64.powi(-shift)) * UP, large.e)
    }

    fn less_than(self, other: Bound) -> bool {
        if self.m.is_infinite() || other.is_zero() {
            return false;
        }
        self.is_zero() || other.m.is_infinite() || (self.e, self.m) < (other.e, other.m)
    }
}

/// See the [module documentation](self).
#[derive(Clone, Debug)]
pub struct BallModP {
    mantissa: BigInt,
    exponent: i64,
    radius: Bound,
    /// `None`: the prime divides a denominator.
    residue: Option<u64>,
    precision: u32,
}

fn reduce(x: u128) -> u64 {
    let folded = (x & u128::from(PRIME)) + (x >> 61);
    let folded = (folded as u64 & PRIME) + (folded >> 61) as u64;
    if folded >= PRIME { folded - PRIME } else { folded }
}

fn times(a: u64, b: u64) -> u64 {
    reduce(u128::from(a) * u128::from(b))
}

/// a · 2^e modulo the prime.
fn rotated(a: u64, e: i64) -> u64 {
    times(a, 1 << e.rem_euclid(61))
}

fn inverted(a: u64) -> u64 {
    let (mut base, mut exponent, mut result) = (a, PRIME - 2, 1);
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = times(result, base);
        }
        base = times(base, base);
        exponent >>= 1;
    }
    result
}

fn residue(a: &BigInt) -> u64 {
    // |a| < 2^61 fits.
    let r = (a % PRIME).to_i64().unwrap_or(0);
    if r < 0 { (r + PRIME as i64) as u64 } else { r as u64 }
}

/// Upper (side 1) or lower (side −1) bound of |mantissa| · 2^exponent.
fn magnitude(mantissa: &BigInt, exponent: i64, side: f64) -> Bound {
    // The two highest words, without copying the others.
    let mut words = mantissa.iter_u64_digits().rev();
    let (Some(high), below) = (words.next(), words.next()) else {
        return Bound::ZERO;
    };
    let shift = 64 * (words.len() as i64 + i64::from(below.is_some()));
    let top = high as f64 + below.unwrap_or(0) as f64 * 2f64.powi(-64);
    Bound::new(top * (1.0 + side * 8.0 * f64::EPSILON), exponent + shift)
}

impl BallModP {
    /// The ball of `precision` bits around a rational number.
    pub fn new(value: &BigRational, precision: u32) -> Self {
        let denominator = value.denom();
        let twos = denominator.trailing_zeros().unwrap_or(0);
        let odd: BigInt = denominator >> twos;
        let mut number = Self {
            residue: Some(rotated(residue(value.numer()), -(twos as i64))),
            mantissa: value.numer().clone(),
            exponent: -(twos as i64),
            radius: Bound::ZERO,
            precision,
        };
        if !odd.is_one() {
            let divisor =
                Self { residue: Some(residue(&odd)), mantissa: odd, exponent: 0, radius: Bound::ZERO, precision };
            number = number.div(&divisor);
        }
        number.tidy()
    }

    /// Drops bits beyond the precision or below the radius; makes a certain zero exact.
    fn tidy(mut self) -> Self {
        let bits = self.mantissa.bits() as i64;
        let mut surplus = bits - i64::from(self.precision);
        if !self.radius.is_zero() && self.radius.m.is_finite() {
            surplus = surplus.max(self.radius.e - self.exponent - 8);
        }
        if surplus > 0 {
            self.mantissa >>= surplus as u64;
            self.exponent += surplus;
            self.radius = self.radius.plus(Bound::power_of_two(self.exponent));
        }
        if self.residue == Some(0) && !self.excludes_zero() {
            return Self { precision: self.precision, ..Self::zero() };
        }
        self
    }

    fn excludes_zero(&self) -> bool {
        !self.mantissa.is_zero() && self.radius.less_than(magnitude(&self.mantissa, self.exponent, -1.0))
    }

    fn upper(&self) -> Bound {
        magnitude(&self.mantissa, self.exponent, 1.0)
    }

    fn plus(&self, other: &Self, negative: bool) -> Self {
        let (a, b) = (self, other);
        // The finer exponent holds both exactly; only the coarser mantissa moves.
        let coarser = a.exponent - b.exponent;
        let (first, second);
        let (mut x, mut y, mut exponent) = (&a.mantissa, &b.mantissa, a.exponent);
        if x.is_zero() {
            exponent = b.exponent;
        } else if !y.is_zero() && coarser > 0 {
            first = x << coarser as u64;
            (x, exponent) = (&first, b.exponent);
        } else if !y.is_zero() && coarser < 0 {
            second = y << coarser.unsigned_abs();
            y = &second;
        }
        let mantissa = if negative { x - y } else { x + y };
        let residue = match (a.residue, b.residue) {
            (Some(a), Some(b)) => {
                let b = if negative { PRIME - b } else { b };
                Some(reduce(u128::from(a) + u128::from(b)))
            }
            _ => None,
        };
        Self { mantissa, exponent, radius: a.radius.plus(b.radius), residue, precision: a.precision.max(b.precision) }
            .tidy()
    }

    fn is_exact_zero(&self) -> bool {
        self.mantissa.is_zero() && self.radius.is_zero()
    }
}

impl PartialEq for BallModP {
    /// Equal as far as can be told; used to compare steps only.
    fn eq(&self, other: &Self) -> bool {
        self.compare(other) == Some(Ordering::Equal)
    }
}

impl Scalar for BallModP {
    /// Exact; takes part with the precision of the numbers it meets.
    fn from_f64(value: f64) -> Self {
        BallModP::new(&<BigRational as Scalar>::from_f64(value), 64)
    }

    fn to_f64(&self) -> f64 {
        let shift = (self.mantissa.bits() as i64 - 64).max(0);
        let top = (&self.mantissa >> shift as u64).to_f64().unwrap_or(0.0);
        times_power_of_two(top, self.exponent + shift)
    }

    fn zero() -> Self {
        Self { mantissa: BigInt::zero(), exponent: 0, radius: Bound::ZERO, residue: Some(0), precision: 64 }
    }

    fn one() -> Self {
        Self { mantissa: BigInt::one(), residue: Some(1), ..Self::zero() }
    }

    fn add(&self, other: &Self) -> Self {
        self.plus(other, false)
    }

    fn sub(&self, other: &Self) -> Self {
        self.plus(other, true)
    }

    fn mul(&self, other: &Self) -> Self {
        let precision = self.precision.max(other.precision);
        if self.is_exact_zero() || other.is_exact_zero() {
            return Self { precision, ..Self::zero() };
        }
        let radius = if self.radius.is_zero() && other.radius.is_zero() {
            Bound::ZERO
        } else {
            self.upper()
                .times(other.radius)
                .plus(other.upper().times(self.radius))
                .plus(self.radius.times(other.radius))
        };
        Self {
            mantissa: &self.mantissa * &other.mantissa,
            exponent: self.exponent + other.exponent,
            radius,
            residue: self.residue.zip(other.residue).map(|(a, b)| times(a, b)),
            precision,
        }
        .tidy()
    }

    fn div(&self, other: &Self) -> Self {
        let precision = self.precision.max(other.precision);
        if self.is_exact_zero() {
            return Self { precision, ..Self::zero() };
        }
        let residue = match (self.residue, other.residue) {
            (Some(a), Some(b)) if b != 0 => Some(times(a, inverted(b))),
            _ => None,
        };
        if !other.excludes_zero() {
            return Self { mantissa: BigInt::zero(), exponent: 0, radius: Bound::INFINITE, residue, precision };
        }
        let shift = (i64::from(precision) + 2 + other.mantissa.bits() as i64 - self.mantissa.bits() as i64).max(0);
        let mantissa = (&self.mantissa << shift as u64) / &other.mantissa;
        let exponent = self.exponent - other.exponent - shift;
        // |a/b − ã/b̃| ≤ (r_a + |ã/b̃| r_b) / (|b̃| − r_b), and the quotient's own rounding.
        let quotient = magnitude(&mantissa, exponent, 1.0).plus(Bound::power_of_two(exponent));
        let spread = self.radius.plus(quotient.times(other.radius));
        let radius = if spread.is_zero() {
            Bound::ZERO
        } else {
            // |b̃| − r_b from below: bits of the mantissa left after the radius.
            let low = magnitude(&other.mantissa, other.exponent, -1.0);
            let gap = if other.radius.is_zero() {
                low
            } else {
                let shift = (low.e - other.radius.e).min(200) as i32;
                let rest = low.m * (1.0 - 4.0 * f64::EPSILON) - other.radius.m * 2f64.powi(-shift) * UP;
                if rest <= 0.0 { Bound::ZERO } else { Bound::new(rest * (1.0 - 4.0 * f64::EPSILON), low.e) }
            };
            if gap.is_zero() { Bound::INFINITE } else { Bound::new(spread.m / gap.m * UP, spread.e - gap.e) }
        };
        Self { mantissa, exponent, radius: radius.plus(Bound::power_of_two(exponent)), residue, precision }.tidy()
    }

    fn neg(&self) -> Self {
        Self {
            mantissa: -&self.mantissa,
            residue: self.residue.map(|r| if r == 0 { 0 } else { PRIME - r }),
            ..self.clone()
        }
    }

    fn sign(&self) -> Option<Ordering> {
        if self.is_exact_zero() {
            return Some(Ordering::Equal);
        }
        if self.excludes_zero() {
            return Some(if self.mantissa.is_negative() { Ordering::Less } else { Ordering::Greater });
        }
        (self.residue == Some(0)).then_some(Ordering::Equal)
    }

    fn is_exact() -> bool {
        true
    }

    fn is_zero(&self) -> bool {
        self.is_exact_zero()
    }
}

#[cfg(test)]
#[path = "ball_mod_p_tests.rs"]
mod tests;
