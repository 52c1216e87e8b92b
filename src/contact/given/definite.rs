//! Whether a given matrix can be positive semidefinite: what its own entries say before anything is factored.
//!
//! A_ii ≥ 0, and A_ij² ≤ A_ii A_jj, of any two joints. Numbers are what a file has, so a diagonal entry below zero is no
//! rounding, whatever its size. A product may exceed the other by what the digits of the matrix leave open: matrices that other
//! programs print are rounded to some digits, and of one that is singular the smaller side may come out larger.

use nalgebra::DMatrix;

use super::error::GivenError;
use crate::contact::pivoted::DIGITS;
use crate::model::left_by_rounding::{SHORT, digits, is_left_by_rounding, is_small};

/// Digits that an f64 has.
const MOST: usize = 17;

/// Takes the entries below the diagonal that may be [rounding](is_left_by_rounding), and their twins above it, out of a
/// symmetric matrix.
pub(super) fn take_rounding(matrix: &mut DMatrix<f64>) -> Vec<(usize, usize, f64)> {
    let roots: Vec<f64> = matrix.diagonal().iter().map(|entry| entry.max(0.0).sqrt()).collect();
    let mut taken = Vec::new();
    for (j, column) in matrix.column_iter().enumerate() {
        let (below, root) = (&column.as_slice()[j + 1..], roots[j]);
        let may_be_left = |(entry, other): (&f64, &f64)| is_small(*entry, [root, *other]);
        // A column at a time: most have none.
        if below.iter().zip(&roots[j + 1..]).fold(false, |any, one| any | may_be_left(one)) {
            let below = (j + 1..column.len()).map(|i| (i, j, column[i]));
            taken.extend(below.filter(|&(i, _, entry)| is_left_by_rounding(entry, [roots[i], root])));
        }
    }
    set_entries(matrix, &taken, |_| 0.0);
    taken
}

/// Sets entries of a symmetric matrix, on both sides of the diagonal, to what is made of their values.
pub(super) fn set_entries(matrix: &mut DMatrix<f64>, entries: &[(usize, usize, f64)], value: impl Fn(f64) -> f64) {
    for &(i, j, entry) in entries {
        matrix[(i, j)] = value(entry);
        matrix[(j, i)] = value(entry);
    }
}

/// Frobenius norm of entries below the diagonal and their twins, of a matrix scaled to unit diagonal.
pub(super) fn size(entries: &[(usize, usize, f64)], scale: &[f64]) -> f64 {
    let squares = entries.iter().map(|&(i, j, entry)| (entry / scale[i] / scale[j]).powi(2));
    (2.0 * squares.sum::<f64>()).sqrt()
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
        (0..n).find_map(|j| {
            let column = matrix.column(j);
            let below = || column.as_slice()[j + 1..].iter().zip(&roots[j + 1..]);
            let is_beyond = |(entry, root): (&f64, &f64)| entry.abs() > most * (root * roots[j]);
            // A column at a time: there is nearly always nothing to find.
            let has_any = below().fold(false, |any, one| any | is_beyond(one));
            let i = j + 1 + has_any.then(|| below().position(is_beyond))??;
            Some((i, j, roots[i] * roots[j]))
        })
    };
    // How many digits the matrix has matters, and is looked at, only where it matters.
    if beyond(1.0 + DIGITS).is_some()
        && let Some((i, j, bound)) = beyond(1.0 + DIGITS.max(2.0 * rounding(matrix)))
    {
        return Err(GivenError::NegativeMinor { key, joints: [name(j), name(i)], entry: matrix[(i, j)], bound });
    }
    Ok(())
}
