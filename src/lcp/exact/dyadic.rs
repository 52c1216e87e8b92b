//! f64 numbers as what they are, integers times powers of two: exact sums without a greatest common divisor.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use crate::lcp::exact::rational_solve::clear_denominators;
use crate::lcp::exact::scalar::{BigInt, Scalar, ratio_to_f64};

/// Mantissa and exponent of a finite number: mantissa · 2^exponent, the mantissa odd or zero.
pub fn parts(value: f64) -> (i64, i64) {
    if value == 0.0 {
        return (0, 0);
    }
    let bits = value.to_bits();
    let biased = (bits >> 52 & 0x7ff) as i64;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (mantissa, exponent) = if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
    let twos = i64::from(mantissa.trailing_zeros());
    let mantissa = mantissa >> twos;
    (if value < 0.0 { -mantissa } else { mantissa }, exponent + twos)
}

/// a b: mantissa and exponent, exactly.
pub fn product(a: f64, b: f64) -> (i128, i64) {
    let ((a, e), (b, f)) = (parts(a), parts(b));
    (i128::from(a) * i128::from(b), e + f)
}

/// mantissa · 2^shift.
pub fn shifted(mantissa: i128, shift: i64) -> BigInt {
    debug_assert!(mantissa == 0 || shift >= 0);
    if mantissa == 0 { BigInt::default() } else { BigInt::from(mantissa) << shift as u64 }
}

/// The number that a finite f64 stands for.
pub fn rational(value: f64) -> BigRational {
    <BigRational as Scalar>::from_f64(value)
}

/// The numbers that the entries of a matrix stand for, row by row.
pub fn rational_rows(matrix: &nalgebra::DMatrix<f64>) -> Vec<Vec<BigRational>> {
    matrix.row_iter().map(|row| row.iter().map(|entry| rational(*entry)).collect()).collect()
}

/// The nearest f64.
pub fn nearest(value: &BigRational) -> f64 {
    Scalar::to_f64(value)
}

/// An integer times a power of two: sums and products of f64 numbers without a greatest common divisor.
#[derive(Clone, Debug, Default)]
pub struct Dyadic {
    mantissa: BigInt,
    exponent: i64,
}

impl Dyadic {
    /// mantissa · 2^exponent.
    pub fn new(mantissa: BigInt, exponent: i64) -> Dyadic {
        Dyadic { mantissa, exponent }
    }

    /// The exponent of the two.
    pub fn exponent(&self) -> i64 {
        self.exponent
    }

    /// How many times 2^exponent it is, for an exponent up to its own.
    pub fn in_units_of(&self, exponent: i64) -> BigInt {
        if self.is_zero() { BigInt::zero() } else { &self.mantissa << (self.exponent - exponent) as u64 }
    }

    /// Whether it is 0.
    pub fn is_zero(&self) -> bool {
        self.mantissa.is_zero()
    }

    /// Whether it is below 0.
    pub fn is_negative(&self) -> bool {
        self.mantissa.is_negative()
    }

    /// The sum.
    #[must_use]
    pub fn plus(&self, other: &Dyadic) -> Dyadic {
        if self.is_zero() || other.is_zero() {
            return if self.is_zero() { other.clone() } else { self.clone() };
        }
        let exponent = self.exponent.min(other.exponent);
        Dyadic { mantissa: self.in_units_of(exponent) + other.in_units_of(exponent), exponent }
    }

    /// The product.
    #[must_use]
    pub fn times(&self, other: &Dyadic) -> Dyadic {
        Dyadic { mantissa: &self.mantissa * &other.mantissa, exponent: self.exponent + other.exponent }
    }

    /// The nearest f64.
    pub fn to_f64(&self) -> f64 {
        let (up, down) = (self.exponent.max(0) as u64, (-self.exponent).max(0) as u64);
        ratio_to_f64(&(&self.mantissa << up), &(BigInt::one() << down))
    }

    /// The number itself.
    pub fn to_rational(&self) -> BigRational {
        let twos = self.mantissa.trailing_zeros().unwrap_or(0) as i64;
        let left = (self.exponent + twos).min(0);
        let whole =
            Dyadic { mantissa: &self.mantissa >> twos as u64, exponent: self.exponent + twos }.in_units_of(left);
        // An odd number over a power of two, or a whole one: nothing to cancel.
        BigRational::new_raw(whole, BigInt::one() << -left as u64)
    }
}

impl From<f64> for Dyadic {
    fn from(value: f64) -> Dyadic {
        let (mantissa, exponent) = parts(value);
        Dyadic { mantissa: BigInt::from(mantissa), exponent }
    }
}

impl PartialEq for Dyadic {
    fn eq(&self, other: &Dyadic) -> bool {
        let exponent = self.exponent.min(other.exponent);
        self.in_units_of(exponent) == other.in_units_of(exponent)
    }
}

/// Rows of integers, each a positive multiple `scale` of the row it stands for: signs are those of the data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WholeRows {
    /// The integers.
    pub rows: Vec<Vec<BigInt>>,
    /// > 0, one a row.
    pub scale: Vec<BigInt>,
}

impl WholeRows {
    /// Adds a row of finite f64 numbers.
    pub fn push(&mut self, row: &[f64]) {
        let parts: Vec<(i64, i64)> = row.iter().map(|value| parts(*value)).collect();
        // At most 0: integers stay as they are.
        let least = parts.iter().filter(|part| part.0 != 0).map(|part| part.1).min().unwrap_or(0).min(0);
        let whole = parts.iter().map(|&(mantissa, exponent)| shifted(i128::from(mantissa), exponent - least));
        self.rows.push(whole.collect());
        self.scale.push(BigInt::one() << (-least) as u64);
    }

    /// Adds a row of rationals.
    pub fn push_rational(&mut self, row: &[BigRational]) {
        self.push_whole(clear_denominators(row));
    }

    /// Adds a row of integers over a common denominator > 0, without the twos that all have.
    pub fn push_whole(&mut self, (mut row, mut scale): (Vec<BigInt>, BigInt)) {
        let twos = row.iter().chain([&scale]).filter_map(BigInt::trailing_zeros).min().unwrap_or(0);
        if twos > 0 {
            row.iter_mut().for_each(|entry| *entry >>= twos);
            scale >>= twos;
        }
        self.rows.push(row);
        self.scale.push(scale);
    }

    /// M and q side by side, row by row.
    pub fn of_lcp(matrix: &nalgebra::DMatrix<f64>, q: &nalgebra::DVector<f64>) -> Self {
        let mut made = Self::default();
        for (row, q) in matrix.row_iter().zip(q.iter()) {
            let row: Vec<f64> = row.iter().copied().chain([*q]).collect();
            made.push(&row);
        }
        made
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_and_products_are_those_of_rationals() {
        let numbers = [0.0, 1.0, -0.1, 3.0e200, 5e-324, -2.5, 6.0, 1e-17];
        for a in numbers {
            let one = Dyadic::from(a);
            assert_eq!((one.to_f64(), one.to_rational()), (a, rational(a)));
            for b in numbers {
                let other = Dyadic::from(b);
                assert_eq!(one.plus(&other).to_rational(), rational(a) + rational(b));
                assert_eq!(one.times(&other).to_rational(), rational(a) * rational(b));
                assert_eq!(one == other, a == b);
                assert_eq!(one.plus(&other).is_negative(), a + b < 0.0);
            }
        }
    }

    #[test]
    fn every_number_is_its_mantissa_times_a_power_of_two() {
        for value in [1.0, -0.1, 3.0e300, 5e-324, f64::MIN_POSITIVE, -2.5, 6.0, f64::MAX] {
            let mut rows = WholeRows::default();
            rows.push(&[value, 0.0]);
            let back = BigRational::new(rows.rows[0][0].clone(), rows.scale[0].clone());
            assert_eq!(back, rational(value));
            assert_eq!(rows.rows[0][1], BigInt::default());
        }
        assert_eq!(parts(6.0), (3, 1));
        assert_eq!(parts(0.0), (0, 0));
    }
}
