//! Whole numbers of many digits: (a b − c d)/e where it is known that the division leaves nothing.
//!
//! Such a quotient is known from the low digits alone (Jebelean, *An algorithm for exact division*, 1993): from as many of
//! them as it has itself, which is half of what the products have and a fraction of the work of a division that looks at all.
//! Numbers are magnitudes in digits of 64 bits, the lowest first.

/// e > 0, made ready to divide by.
pub struct ExactDivisor {
    /// e without its factors of two …
    odd: Vec<u64>,
    /// … and how many there were.
    twos: usize,
    /// Of the lowest digit of the odd part, modulo 2⁶⁴.
    inverse: u64,
    bits: usize,
}

impl ExactDivisor {
    /// # Panics
    /// If the number is 0.
    pub fn new(digits: &[u64]) -> ExactDivisor {
        let first = digits.iter().position(|&digit| digit != 0).expect("a divisor that is not 0");
        let twos = 64 * first + digits[first].trailing_zeros() as usize;
        let odd = halved(digits, twos);
        // x x = 1 modulo 8 for every odd x, and each of Newton's steps doubles the digits.
        let lowest = odd[0];
        let inverse = (0..5).fold(lowest, |x, _| x.wrapping_mul(2_u64.wrapping_sub(lowest.wrapping_mul(x))));
        ExactDivisor { odd, twos, inverse, bits: bits(digits) }
    }

    /// (a b − c d)/e, or (a b + c d)/e where `adds`; bytes in two's complement, the lowest first.
    pub fn quotient(&self, [a, b]: [&[u64]; 2], [c, d]: [&[u64]; 2], adds: bool) -> Vec<u8> {
        // |a b| + |c d| < 2 · 2^most and e ≥ 2^(bits − 1); one bit more for the sign.
        let most = (bits(a) + bits(b)).max(bits(c) + bits(d));
        let count = (most + 3).saturating_sub(self.bits) / 64 + 1;
        let mut sum = vec![0; count + self.twos.div_ceil(64)];
        add_product(&mut sum, a, b);
        if adds {
            add_product(&mut sum, c, d);
        } else {
            c.iter().enumerate().take(sum.len()).for_each(|(at, c)| subtract_multiple(&mut sum[at..], *c, d));
        }
        let mut left = halved(&sum, self.twos);
        left.resize(count, 0);
        for at in 0..count {
            let digit = left[at].wrapping_mul(self.inverse);
            subtract_multiple(&mut left[at..], digit, &self.odd);
            // What was subtracted has left a 0 here.
            left[at] = digit;
        }
        left.iter().flat_map(|digit| digit.to_le_bytes()).collect()
    }
}

/// Number of binary digits.
fn bits(digits: &[u64]) -> usize {
    let top = digits.iter().rposition(|&digit| digit != 0);
    top.map_or(0, |top| 64 * top + 64 - digits[top].leading_zeros() as usize)
}

/// The number without its lowest binary digits.
fn halved(digits: &[u64], times: usize) -> Vec<u64> {
    let (digits, shift) = (&digits[times / 64..], times % 64);
    if shift == 0 {
        return digits.to_vec();
    }
    let above = digits.iter().skip(1).chain([&0]);
    digits.iter().zip(above).map(|(low, high)| (low >> shift) | (high << (64 - shift))).collect()
}

/// Adds a b, modulo what the digits of the sum hold.
fn add_product(sum: &mut [u64], a: &[u64], b: &[u64]) {
    for (at, &a) in a.iter().enumerate().take(sum.len()) {
        let mut carry = 0;
        let from = &mut sum[at..];
        let (low, high) = from.split_at_mut(b.len().min(from.len()));
        for (digit, &b) in low.iter_mut().zip(b) {
            let product = u128::from(a) * u128::from(b) + u128::from(*digit) + u128::from(carry);
            (*digit, carry) = (product as u64, (product >> 64) as u64);
        }
        for digit in high {
            let overflows;
            (*digit, overflows) = digit.overflowing_add(carry);
            carry = u64::from(overflows);
            if !overflows {
                break;
            }
        }
    }
}

/// Subtracts a b, modulo what the digits of the sum hold.
fn subtract_multiple(sum: &mut [u64], a: u64, b: &[u64]) {
    let mut carry = 0;
    let (low, high) = sum.split_at_mut(b.len().min(sum.len()));
    for (digit, &b) in low.iter_mut().zip(b) {
        let product = u128::from(a) * u128::from(b) + u128::from(carry);
        let borrows;
        (*digit, borrows) = digit.overflowing_sub(product as u64);
        carry = (product >> 64) as u64 + u64::from(borrows);
    }
    for digit in high {
        let borrows;
        (*digit, borrows) = digit.overflowing_sub(carry);
        carry = u64::from(borrows);
        if !borrows {
            break;
        }
    }
}
