//! Whether a given matrix can be positive semidefinite: what its own entries say before anything is factored.
//!
//! A_ii ≥ 0, and A_ij² ≤ A_ii A_jj, of any two joints. Numbers are what a file has, so a diagonal entry below zero is no
//! rounding, whatever its size. A product may exceed the other by what the digits of the matrix leave open: matrices that other
//! programs print are rounded to some digits, and of one that is singular the smaller side may come out larger.

use nalgebra::DMatrix;

use super::error::GivenError;
use crate::contact::pivoted::DIGITS;
use crate::model::left_by_rounding::{SHORT, digits, is_left_by_rounding};

/// Digits that an f64 has.
const MOST: usize = 17;

/// The matrix with zeros where its entries may be [rounding](is_left_by_rounding); `None` where none is.
pub(super) fn without_rounding(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let roots: Vec<f64> = matrix.diagonal().iter().map(|entry| entry.max(0.0).sqrt()).collect();
    let is_left = |i: usize, j: usize, entry: f64| i != j && is_left_by_rounding(entry, [roots[i], roots[j]]);
    let cleared = matrix.map_with_location(|i, j, entry| if is_left(i, j, entry) { 0.0 } else { entry });
    (cleared != *matrix).then_some(cleared)
}

/// Half a unit of the last digit of the longest entry, relative: how far each entry may be from what was printed.
fn rounding(matrix: &DMatrix<f64>) -> f64 {
    match matrix.iter().map(|entry| digits(*entry)).max() {
        Some(longest) if longest > SHORT && longest < MOST => 0.5 * 10f64.powi(1 - longest as i32),
        _ => 0.0,
    }
}

/// Refuses a matrix that shows it by one entry or two joints; where its author gives the kernel, `all_digits` do not count.
pub(super) fn judge_entries(
    (key, matrix): (&'static str, &DMatrix<f64>),
    all_digits: bool,
    name: &dyn Fn(usize) -> String,
) -> Result<(), GivenError> {
    let n = matrix.nrows();
    if let Some(i) = (0..n).find(|&i| matrix[(i, i)] < 0.0) {
        return Err(GivenError::NegativeDiagonal { key, joint: name(i), value: matrix[(i, i)] });
    }
    if !all_digits {
        return Ok(());
    }
    // Squares underflow and overflow; roots of the diagonal do not.
    let roots: Vec<f64> = matrix.diagonal().iter().map(|entry| entry.sqrt()).collect();
    let beyond = |most: f64| {
        let entries = (0..n).flat_map(|j| (j + 1..n).map(move |i| (i, j)));
        entries.map(|(i, j)| (i, j, roots[i] * roots[j])).find(|&(i, j, bound)| matrix[(i, j)].abs() > most * bound)
    };
    // How many digits the matrix has matters, and is looked at, only where it matters.
    if beyond(1.0 + DIGITS).is_some()
        && let Some((i, j, bound)) = beyond(1.0 + DIGITS.max(2.0 * rounding(matrix)))
    {
        return Err(GivenError::NegativeMinor { key, joints: [name(j), name(i)], entry: matrix[(i, j)], bound });
    }
    Ok(())
}
