//! Arithmetic modulo a prime just below 2⁶¹.

use num_traits::{Signed, ToPrimitive};

use crate::lcp::exact::scalar::BigInt;

/// Bits below which 2⁶¹ ≡ c is folded in.
const LOW: u128 = (1 << 61) - 1;

/// The prime 2⁶¹ − c.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Prime {
    c: u64,
}

impl Prime {
    /// Some of them; another is taken when one divides a determinant.
    pub const ALL: [Prime; 4] = [Prime { c: 1 }, Prime { c: 31 }, Prime { c: 45 }, Prime { c: 229 }];

    /// The prime itself.
    pub fn value(self) -> u64 {
        (1 << 61) - self.c
    }

    /// x modulo the prime.
    #[inline]
    pub fn reduce(self, x: u128) -> u64 {
        let fold = |x: u128| (x & LOW) + (x >> 61) * u128::from(self.c);
        // Below 2⁷⁶ after the first fold, below 2⁶¹ + 2²³ after the second.
        let folded = fold(fold(x)) as u64;
        if folded >= self.value() { folded - self.value() } else { folded }
    }

    /// a b.
    #[inline]
    pub fn times(self, a: u64, b: u64) -> u64 {
        self.reduce(u128::from(a) * u128::from(b))
    }

    /// x + a b, all reduced.
    #[inline]
    pub fn plus_product(self, x: u64, a: u64, b: u64) -> u64 {
        self.reduce(u128::from(x) + u128::from(a) * u128::from(b))
    }

    /// −a.
    pub fn minus(self, a: u64) -> u64 {
        if a == 0 { 0 } else { self.value() - a }
    }

    /// 1 / a, by Fermat.
    pub fn inverse(self, a: u64) -> u64 {
        let (mut base, mut exponent, mut result) = (a, self.value() - 2, 1);
        while exponent > 0 {
            if exponent & 1 == 1 {
                result = self.times(result, base);
            }
            base = self.times(base, base);
            exponent >>= 1;
        }
        result
    }

    /// Residue of an integer.
    pub fn residue(self, a: &BigInt) -> u64 {
        let r = (a % self.value()).to_i64().unwrap_or(0); // |r| < 2⁶¹ fits
        if r.is_negative() { self.value() - r.unsigned_abs() } else { r.unsigned_abs() }
    }

    /// Σ a_i b_i, all reduced.
    pub fn dot(self, a: &[u64], b: &[u64]) -> u64 {
        // Products stay below 2¹²²: 32 of them fit beside a reduced sum.
        let mut sum = 0;
        for (a, b) in a.chunks(32).zip(b.chunks(32)) {
            let products = a.iter().zip(b).map(|(a, b)| u128::from(*a) * u128::from(*b));
            sum = u128::from(self.reduce(sum + products.sum::<u128>()));
        }
        sum as u64
    }
}

/// A row of integers as limbs of 64 bits: its product with short numbers needs no room of its own.
#[derive(Clone, Debug)]
pub struct LimbRow {
    /// The limbs of all entries, the lowest of each, then the second of each, and so on.
    limbs: Vec<Vec<u64>>,
    /// −1 for a negative entry, else 0.
    sign: Vec<i128>,
}

impl LimbRow {
    /// The same numbers.
    pub fn new(row: &[BigInt]) -> LimbRow {
        let width = row.iter().map(|entry| entry.bits().div_ceil(64)).max().unwrap_or(0) as usize;
        let mut limbs = vec![vec![0; row.len()]; width];
        for (i, entry) in row.iter().enumerate() {
            entry.iter_u64_digits().zip(&mut limbs).for_each(|(digit, limbs)| limbs[i] = digit);
        }
        LimbRow { limbs, sign: row.iter().map(|entry| -i128::from(entry.is_negative())).collect() }
    }

    /// Σ a_i y_i.
    pub fn dot(&self, y: &[u64]) -> BigInt {
        let mut sum = BigInt::default();
        for limbs in self.limbs.iter().rev() {
            // Both halves of the products are summed separately: so few terms cannot overflow.
            let (mut low, mut high) = (0_i128, 0_i128);
            for ((limb, sign), y) in limbs.iter().zip(&self.sign).zip(y) {
                let product = u128::from(*limb) * u128::from(*y);
                let (l, h) = (i128::from(product as u64), (product >> 64) as i128);
                // x ^ −1 − −1 = −x.
                low += (l ^ sign) - sign;
                high += (h ^ sign) - sign;
            }
            sum = ((sum + BigInt::from(high)) << 64_u32) + BigInt::from(low);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use num_traits::{One, Zero};
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Against the arithmetic of big integers.
        #[test]
        fn residues_are_those_of_big_integers(x in any::<u128>(), a in any::<u64>(), b in any::<u64>(), negative: bool) {
            for prime in Prime::ALL {
                let p = BigInt::from(prime.value());
                prop_assert_eq!(BigInt::from(prime.reduce(x)), BigInt::from(x) % &p);
                let big = if negative { -BigInt::from(x) } else { BigInt::from(x) };
                let r = ((&big % &p) + &p) % &p;
                prop_assert_eq!(BigInt::from(prime.residue(&big)), r);
                let (a, b) = (a % prime.value(), b % prime.value());
                prop_assert_eq!(BigInt::from(prime.times(a, b)), BigInt::from(a) * BigInt::from(b) % &p);
                if a != 0 {
                    prop_assert_eq!(prime.times(a, prime.inverse(a)), 1);
                }
                prop_assert_eq!(prime.reduce(u128::from(a) + u128::from(prime.minus(a))), 0);
            }
        }

        #[test]
        fn a_row_of_limbs_gives_the_sum_of_products(
            row in prop::collection::vec((any::<i128>(), 0_u64..200), 0..40),
            seed in any::<u64>(),
        ) {
            let row: Vec<BigInt> = row.into_iter().map(|(mantissa, shift)| BigInt::from(mantissa) << shift).collect();
            let y: Vec<u64> = (0..row.len() as u64).map(|i| (seed ^ i.wrapping_mul(0x9e37_79b9_7f4a_7c15)) >> 3).collect();
            let expected: BigInt = row.iter().zip(&y).map(|(a, y)| a * y).sum();
            prop_assert_eq!(LimbRow::new(&row).dot(&y), expected);
            let prime = Prime::ALL[3];
            let reduced: Vec<u64> = row.iter().map(|a| prime.residue(a)).collect();
            let y: Vec<u64> = y.into_iter().map(|y| y % prime.value()).collect();
            let expected: BigInt = reduced.iter().zip(&y).map(|(a, y)| BigInt::from(*a) * y).sum();
            prop_assert_eq!(BigInt::from(prime.dot(&reduced, &y)), expected % prime.value());
        }
    }

    #[test]
    fn the_largest_limbs_carry() {
        let largest = (BigInt::one() << 128_u32) - BigInt::one();
        let row = vec![largest.clone(); 300];
        let y = vec![(1 << 61) - 2; 300];
        assert_eq!(LimbRow::new(&row).dot(&y), largest * BigInt::from(300_u64) * BigInt::from((1_u64 << 61) - 2));
        assert_eq!(LimbRow::new(&[]).dot(&[]), BigInt::zero());
    }
}
