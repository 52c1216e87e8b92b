//! (a b − c d)/e of whole numbers where the division leaves nothing: every step of a dictionary in integers.

use num_traits::Signed;
use stickslip_numerics::integers::ExactDivisor;

use crate::lcp::exact::scalar::BigInt;

/// A number that is a factor of many products.
pub struct Factor {
    digits: Vec<u64>,
    is_negative: bool,
}

impl Factor {
    /// Of a number.
    pub fn new(number: &BigInt) -> Factor {
        Factor { digits: number.magnitude().to_u64_digits(), is_negative: number.is_negative() }
    }
}

/// A number > 0 that divides what it is asked to divide.
pub struct Divisor(ExactDivisor);

impl Divisor {
    /// # Panics
    /// If the number is 0.
    pub fn new(number: &BigInt) -> Divisor {
        Divisor(ExactDivisor::new(&number.magnitude().to_u64_digits()))
    }

    /// (a b − c d)/e.
    pub fn quotient(&self, [a, b]: [&Factor; 2], [c, d]: [&Factor; 2]) -> BigInt {
        let signs = [a.is_negative != b.is_negative, c.is_negative != d.is_negative];
        let sides = [[&*a.digits, &*b.digits], [&*c.digits, &*d.digits]];
        let found = BigInt::from_signed_bytes_le(&self.0.quotient(sides[0], sides[1], signs[0] != signs[1]));
        if signs[0] { -found } else { found }
    }
}

#[cfg(test)]
mod tests {
    use num_traits::Zero;
    use proptest::prelude::*;

    use super::*;

    /// A number of up to six digits of 64 bits, many of them with zeros at its low end, or with ones throughout.
    fn number() -> impl Strategy<Value = BigInt> {
        (prop::collection::vec(prop_oneof![Just(0), Just(u8::MAX), any::<u8>()], 0..48), 0_u32..130)
            .prop_map(|(bytes, twos)| BigInt::from_signed_bytes_le(&bytes) << twos)
    }

    proptest! {
        /// Of q e = a b − c d with any a, c, q and e: b = e s, d = e t, so that q = a s − c t; and where b is what makes a = 1.
        #[test]
        fn quotients_are_those_of_a_division(a in number(), s in number(), c in number(), t in number(), e in number()) {
            prop_assume!(!e.is_zero());
            let e = e.abs();
            let (b, d) = (&e * &s, &e * &t);
            let divisor = Divisor::new(&e);
            let [fa, fb, fc, fd, one] = [&a, &b, &c, &d, &BigInt::from(1)].map(Factor::new);
            prop_assert_eq!(divisor.quotient([&fa, &fb], [&fc, &fd]), &a * &s - &c * &t);
            // (c d + q e) 1 − c d = q e, where both products have nearly all digits in common.
            let sum = Factor::new(&(&c * &d + &s * &e));
            prop_assert_eq!(divisor.quotient([&sum, &one], [&fc, &fd]), s);
        }
    }
}
