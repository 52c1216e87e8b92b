//! Entries of a matrix of another program that are what its rounding left of zeros.
//!
//! Beside a motion that costs nothing such an entry decides whether a structure stands, and by displacements that are as many times
//! larger than all others.

/// Below this share of √(A_ii A_jj): elimination and transformations in f64 leave some ε times the size of what they add up.
const LEFT: f64 = 1024.0 * f64::EPSILON;
/// Whole numbers, and others of no more digits than this, are meant as they stand.
pub const SHORT: usize = 9;

/// Digits of a number as it is printed shortest.
pub fn digits(value: f64) -> usize {
    format!("{value:e}").bytes().take_while(|byte| *byte != b'e').filter(u8::is_ascii_digit).count()
}

/// Whether an entry off the diagonal, which has the given roots √A_ii and √A_jj, may be rounding.
pub fn is_left_by_rounding(entry: f64, roots: [f64; 2]) -> bool {
    is_small(entry, roots) && digits(entry) > SHORT
}

/// Whether it is small enough for that, and not zero.
pub fn is_small(entry: f64, roots: [f64; 2]) -> bool {
    (entry != 0.0) & (entry.abs() <= LEFT * roots[0] * roots[1])
}
