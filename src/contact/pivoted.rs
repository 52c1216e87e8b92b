//! A symmetric positive semidefinite matrix factored with pivoting after scaling to unit diagonal, and its null space
//! by the matrix's own digits.
//!
//! ```text
//!   S = D⁻¹ A D⁻¹ (D powers of two near √A_ii, so that S has the digits of A),   P S Pᵀ = L Lᵀ + [0 0; 0 Σ]
//! ```
//! A vector z counts as null only if every |(A z)_i| ≤ 64 ε Σ_k |A_ik||z_k|: what the digits of A cannot tell from 0. A
//! ratio to the largest eigenvalue says nothing: diag(1e9, 1e-3) is regular (method §2).

use std::ops::Range;

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::doubled::{dot, sum_of_products};
use stickslip_numerics::blocks::{MatMut, MatRef, solve_lower, solve_upper};
use stickslip_numerics::doubled::add_response;
use stickslip_numerics::products::{add_columns, halved_sums, roundings, subtract_square};

/// A row of A z below this share of its terms is zero by the digits of A.
pub const DIGITS: f64 = 64.0 * f64::EPSILON;
/// A remaining pivot (of a diagonal of 1) up to this is examined: it may be zero.
pub const NEARLY: f64 = 1e-10;
/// Columns that are subtracted from the rest at once.
const PANEL: usize = 64;

/// See the module.
#[derive(Clone, Debug, PartialEq)]
pub struct PivotedCholesky {
    /// Powers of two near √A_ii; 1 where that is not positive.
    pub scale: Vec<f64>,
    /// Row of A of each row of L.
    pub order: Vec<usize>,
    /// Number of pivots above 1e-10.
    pub rank: usize,
    /// L in its lower triangle.
    l: DMatrix<f64>,
}

/// Vectors that A takes to zero, or nearly so.
#[derive(Clone, Debug, PartialEq)]
pub struct NullSpace {
    /// By the digits of A.
    pub exact: Vec<DVector<f64>>,
    /// Small pivots, and yet not zero by the digits.
    pub near: Vec<DVector<f64>>,
    /// Smallest zᵀS z / zᵀz seen among them; 0 without any. Below zero A is indefinite.
    pub least: f64,
}

impl PivotedCholesky {
    /// Factors A.
    pub fn new(matrix: &DMatrix<f64>) -> PivotedCholesky {
        let n = matrix.nrows();
        let scale = scales(matrix);
        // Powers of two have exact inverses. Most of the upper triangle is never touched, and so takes no memory.
        let inverse: Vec<f64> = scale.iter().map(|scale| scale.recip()).collect();
        let mut l = DMatrix::zeros(n, n);
        for j in 0..n {
            for i in j..n {
                l[(i, j)] = matrix[(i, j)] * inverse[i] * inverse[j];
            }
        }
        let mut order: Vec<usize> = (0..n).collect();
        let mut rank = 0;
        // The diagonal before the panel at hand, side by side, and what the columns of the panel subtract from each entry.
        let mut diagonal = vec![0.0; n];
        let mut taken = vec![0.0; n];
        let mut finished: Vec<(Range<usize>, Vec<usize>)> = Vec::new();
        'panels: while rank < n {
            let panel = rank;
            (panel..n).for_each(|i| diagonal[i] = l[(i, i)]);
            taken.fill(0.0);
            while rank < n.min(panel + PANEL) {
                let k = rank;
                let left = |i: usize| diagonal[i] - taken[i];
                let largest = (k..n).max_by(|&i, &j| left(i).total_cmp(&left(j)).then(j.cmp(&i))).unwrap_or(k);
                let pivot = left(largest);
                if pivot <= NEARLY {
                    break 'panels;
                }
                swap(&mut l, panel, k, largest);
                diagonal.swap(k, largest);
                taken.swap(k, largest);
                order.swap(k, largest);
                finish_column(&mut l, panel, k, pivot.sqrt());
                for i in k + 1..n {
                    taken[i] += l[(i, k)].powi(2);
                }
                rank += 1;
            }
            finish_panel(&mut l, panel, rank);
            finished.push((panel..rank, order.clone()));
        }
        bring_rows_up(&mut l, &finished, &order);
        PivotedCholesky { scale, order, rank, l }
    }

    /// Rows of A that are independent.
    pub fn independent(&self) -> &[usize] {
        &self.order[..self.rank]
    }

    /// The last pivot, of a diagonal of 1: all others are as large. ∞ without any.
    pub fn least_pivot(&self) -> f64 {
        self.rank.checked_sub(1).map_or(f64::INFINITY, |last| self.l[(last, last)].powi(2))
    }

    /// x with A x = b in the independent rows, 0 in the others.
    pub fn solve(&self, b: &DVector<f64>) -> DVector<f64> {
        let mut x = b.clone();
        self.solve_columns(x.as_mut_slice());
        x
    }

    /// The same of some right sides, one after the other, in their place.
    fn solve_columns(&self, columns: &mut [f64]) {
        let (n, rank) = (self.order.len(), self.rank);
        if n == 0 || columns.is_empty() {
            return;
        }
        let independent = || self.independent().iter().map(|&row| (row, self.scale[row]));
        let mut y: Vec<f64> =
            columns.chunks(n).flat_map(|b| independent().map(|(row, scale)| b[row] / scale)).collect();
        if rank > 0 {
            let l = MatRef::from_column_major_slice(self.l.as_slice(), n, n).get(..rank, ..rank);
            let count = columns.len() / n;
            solve_lower(l, MatMut::from_column_major_slice_mut(&mut y, rank, count));
            solve_upper(l.transpose(), MatMut::from_column_major_slice_mut(&mut y, rank, count));
        }
        columns.fill(0.0);
        for (x, y) in columns.chunks_mut(n).zip(y.chunks(rank.max(1))) {
            independent().zip(y).for_each(|((row, scale), y)| x[row] = y / scale);
        }
    }

    /// The null space of A, the matrix that was factored.
    pub fn null_space(&self, matrix: &DMatrix<f64>) -> NullSpace {
        let (n, rank) = (self.order.len(), self.rank);
        let rest = &self.order[rank..];
        let mut null = NullSpace { exact: Vec::new(), near: Vec::new(), least: 0.0 };
        if rest.is_empty() {
            return null;
        }
        let (candidates, are_null) = self.candidates(matrix);
        let size = rest.len();
        let sigma = DMatrix::from_fn(size, size, |i, j| {
            let row = rest[i];
            dot(0.0, matrix.column(row).iter().zip(candidates[j].iter())) / self.scale[row]
        });
        let eigen = SymmetricEigen::new(0.5 * (&sigma + sigma.transpose()));
        for (value, weights) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
            let z: DVector<f64> = candidates.iter().zip(weights.iter()).map(|(z, weight)| z * *weight).sum();
            let length: f64 = (0..n).map(|i| (z[i] * self.scale[i]).powi(2)).sum();
            null.least = null.least.min(value / length);
            if is_null(matrix, &z) { null.exact.push(z) } else { null.near.push(z) }
        }
        // As they were found where all of them are null: simple motions stay simple.
        if null.near.is_empty() && are_null.into_iter().all(|is_null| is_null) {
            null.exact = candidates;
        }
        null
    }

    /// For each dependent row k the vector with 1 / scale there, 0 at the other dependent rows, that A takes to zero in all
    /// independent rows; and which of them are null. Refined until they are, twice at most, all of them in one pass through L.
    fn candidates(&self, matrix: &DMatrix<f64>) -> (Vec<DVector<f64>>, Vec<bool>) {
        let n = self.order.len();
        let own = self.order[self.rank..].iter().map(|&k| (k, 1.0 / self.scale[k]));
        // A z of the rows k, exact: scales are powers of two.
        let mut residual: Vec<f64> = Vec::with_capacity(n * (n - self.rank));
        own.clone().for_each(|(k, own)| residual.extend(matrix.column(k).iter().map(|entry| entry * own)));
        self.solve_columns(&mut residual);
        let mut found: Vec<DVector<f64>> = (own.zip(residual.chunks(n)))
            .map(|((k, own), step)| DVector::from_fn(n, |i, _| if i == k { own } else { -step[i] }))
            .collect();
        let mut are_null = vec![false; found.len()];
        for _ in 0..2 {
            let open: Vec<usize> = (0..found.len()).filter(|&i| !are_null[i]).collect();
            let mut residual = vec![0.0; n * open.len()];
            for (&one, residual) in open.iter().zip(residual.chunks_mut(n)) {
                let mut rest = vec![0.0; n];
                add_response(residual, &mut rest, matrix.as_slice(), found[one].as_slice());
                residual.iter_mut().zip(rest).for_each(|(residual, rest)| *residual += rest);
            }
            self.solve_columns(&mut residual);
            for (&one, step) in open.iter().zip(residual.chunks(n)) {
                found[one].iter_mut().zip(step).for_each(|(z, step)| *z -= step);
            }
            self.settle(matrix, &mut found, &mut are_null);
        }
        (found, are_null)
    }

    /// Tells of candidates whether they are null; without those of their entries that are rounding if they can be: an entry that
    /// should be 0 may be the only term of some row.
    fn settle(&self, matrix: &DMatrix<f64>, found: &mut [DVector<f64>], are_null: &mut [bool]) {
        let simple: Vec<(usize, DVector<f64>)> = (0..found.len())
            .filter(|&one| !are_null[one])
            .map(|one| {
                let z = &found[one];
                let size = |i: usize| z[i].abs() * self.scale[i];
                let least = f64::EPSILON * (0..z.len()).map(size).fold(0.0, f64::max);
                (one, DVector::from_fn(z.len(), |i, _| if size(i) <= least { 0.0 } else { z[i] }))
            })
            .collect();
        let are_simple = self.null_among(matrix, simple.iter().map(|(_, z)| z));
        for ((one, z), is_null) in simple.into_iter().zip(are_simple) {
            are_null[one] = is_null || z != found[one] && self.null_among(matrix, [&found[one]].into_iter())[0];
            if is_null {
                found[one] = z;
            }
        }
    }

    /// Which of some vectors that solve the independent rows are [null](is_null), in one pass through A; the other rows tell first
    /// that they are not.
    fn null_among<'a>(
        &self,
        matrix: &DMatrix<f64>,
        vectors: impl Iterator<Item = &'a DVector<f64>> + Clone,
    ) -> Vec<bool> {
        let mut are_null: Vec<bool> = vectors.clone().map(|_| true).collect();
        for row in self.order[self.rank..].iter().copied().chain(0..matrix.ncols()) {
            for (z, is_null) in vectors.clone().zip(&mut are_null) {
                *is_null = *is_null && is_null_in(matrix, z, row);
            }
        }
        are_null
    }
}

/// Powers of two near √A_ii, 1 where that is not positive: what scales A to unit diagonal and keeps its digits.
pub fn scales(matrix: &DMatrix<f64>) -> Vec<f64> {
    let power = |d: &f64| if *d > 0.0 { 2f64.powi((0.5 * d.log2()).round() as i32) } else { 1.0 };
    matrix.diagonal().iter().map(power).collect()
}

/// Swaps rows and columns of a symmetric matrix of which only the lower triangle is kept, k ≤ p; the columns before `from`
/// stay as they are.
fn swap(a: &mut DMatrix<f64>, from: usize, k: usize, p: usize) {
    if k == p {
        return;
    }
    for j in from..k {
        a.swap((k, j), (p, j));
    }
    a.swap((k, k), (p, p));
    for i in k + 1..p {
        a.swap((i, k), (p, i));
    }
    for i in p + 1..a.nrows() {
        a.swap((i, k), (i, p));
    }
}

/// Finishes column k of L: subtracts the columns of the panel from `from` on and divides by the root of the pivot.
fn finish_column(l: &mut DMatrix<f64>, from: usize, k: usize, root: f64) {
    let n = l.nrows();
    let (done, rest) = l.as_mut_slice().split_at_mut(k * n);
    let column = &mut rest[k + 1..n];
    let known: Vec<(&[f64], f64)> =
        done[from * n..].chunks_exact(n).map(|known| (&known[k + 1..], -known[k])).collect();
    add_columns(column, &known);
    column.iter_mut().for_each(|entry| *entry /= root);
    rest[k] = root;
}

/// Brings the rows of finished columns into the last order, each from that at the end of its panel: swapped one by one,
/// every entry of a row would lie on another page.
fn bring_rows_up(l: &mut DMatrix<f64>, finished: &[(Range<usize>, Vec<usize>)], order: &[usize]) {
    let mut place = vec![0; order.len()];
    for (columns, then) in finished {
        then.iter().enumerate().for_each(|(at, &row)| place[row] = at);
        let from: Vec<usize> = order[columns.end..].iter().map(|&row| place[row]).collect();
        for column in columns.clone() {
            let mut column = l.column_mut(column);
            let moved: Vec<f64> = from.iter().map(|&at| column[at]).collect();
            column.as_mut_slice()[columns.end..].copy_from_slice(&moved);
        }
    }
}

/// Subtracts the columns `from` … `to` from all that is to their right.
fn finish_panel(l: &mut DMatrix<f64>, from: usize, to: usize) {
    let n = l.nrows();
    let (done, rest) = l.as_mut_slice().split_at_mut(to * n);
    subtract_square(&mut rest[..], &done[from * n..], n, to);
}

/// Whether A z = 0 by the digits of A, row by row.
pub fn is_null(matrix: &DMatrix<f64>, z: &DVector<f64>) -> bool {
    (0..matrix.ncols()).all(|row| is_null_in(matrix, z, row))
}

/// The same of one row.
fn is_null_in(matrix: &DMatrix<f64>, z: &DVector<f64>, row: usize) -> bool {
    // Smaller terms may have lost digits to underflow.
    const SMALLEST: f64 = 1e-270;
    let row = matrix.column(row);
    let (sum, magnitude) = halved_sums(row.as_slice(), z.as_slice());
    let beyond = sum.abs() - DIGITS * magnitude;
    // What rounding can have made of these sums in f64, and as much again for that of their magnitude.
    let doubt = roundings(z.len()) * f64::EPSILON;
    if magnitude.is_finite() && magnitude > SMALLEST && beyond.abs() > doubt * magnitude {
        return beyond < 0.0;
    }
    let sum = sum_of_products(0.0, row.iter().zip(z.iter()));
    sum.value().abs() <= DIGITS * sum.magnitude()
}

/// Orthonormal basis of the span of some vectors of length n; nearly dependent ones count once.
pub fn orthonormal(vectors: &[DVector<f64>], n: usize) -> DMatrix<f64> {
    let mut basis: Vec<DVector<f64>> = Vec::new();
    for vector in vectors {
        let size = vector.norm();
        if size == 0.0 {
            continue;
        }
        let mut rest = vector / size;
        for _ in 0..2 {
            for one in &basis {
                rest -= one.dot(&rest) * one;
            }
        }
        let left = rest.norm();
        if left > 1e-8 {
            basis.push(rest / left);
        }
    }
    if basis.is_empty() { DMatrix::zeros(n, 0) } else { DMatrix::from_columns(&basis) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contrast_of_stiffness_is_no_null_space() {
        let matrix = DMatrix::from_diagonal(&DVector::from_row_slice(&[1e9, 1e-3, 1e9, 1e-3]));
        let factor = PivotedCholesky::new(&matrix);
        assert_eq!(factor.rank, 4);
        assert_eq!(factor.null_space(&matrix).exact.len(), 0);
    }

    #[test]
    fn solves_in_any_order_of_pivots() {
        // A = B Bᵀ with scales 1e±3; x from A x.
        let b = DMatrix::from_fn(5, 5, |i, j| f64::from(((i * 7 + j * 3) % 5) as u8) - 1.5);
        let scale = [1e3, 1e-3, 1.0, 10.0, 1e-2];
        let a = &b * b.transpose() + DMatrix::identity(5, 5);
        let a = DMatrix::from_fn(5, 5, |i, j| scale[i] * a[(i, j)] * scale[j]);
        let x = DVector::from_fn(5, |i, _| (1.0 + i as f64) / scale[i]);
        let found = PivotedCholesky::new(&a).solve(&(&a * &x));
        for i in 0..5 {
            assert!((found[i] / x[i] - 1.0).abs() < 1e-10, "{i}: {} {}", found[i], x[i]);
        }
    }

    #[test]
    fn the_null_space_is_found_at_any_scale() {
        // A = D (I − n nᵀ) D in integers: n = (1, 2, 2)/3, 9 (I − n nᵀ) is integer; null vector D⁻¹ n.
        let integer = [[8.0, -2.0, -2.0], [-2.0, 5.0, -4.0], [-2.0, -4.0, 5.0]];
        let d = [1.0, 1024.0, 1.0 / 1024.0];
        let a = DMatrix::from_fn(3, 3, |i, j| d[i] * integer[i][j] * d[j]);
        let factor = PivotedCholesky::new(&a);
        assert_eq!(factor.rank, 2);
        let null = factor.null_space(&a);
        assert_eq!((null.exact.len(), null.near.len()), (1, 0));
        let z = &null.exact[0];
        for i in 0..3 {
            let expected = [1.0, 2.0, 2.0][i] / d[i];
            assert!((z[i] / z[0] - expected).abs() <= 1e-14 * expected, "{z}");
        }
        // A change in the twelfth digit is nearly singular, not singular.
        let mut rounded = a.clone();
        rounded[(0, 0)] *= 1.0 + 1e-12;
        let null = PivotedCholesky::new(&rounded).null_space(&rounded);
        assert_eq!((null.exact.len(), null.near.len()), (0, 1));
    }

    /// z = (0, 1, 0, 1): what elimination leaves in the first and third entry is all there is in the first row.
    #[test]
    fn a_motion_that_leaves_joints_at_rest_is_found() {
        let rows = [[2.0, 0.0, -1.0, 0.0], [0.0, 3.0, -5.0, -3.0], [-1.0, -5.0, 9.0, 5.0], [0.0, -3.0, 5.0, 3.0]];
        let a = DMatrix::from_fn(4, 4, |i, j| rows[i][j]);
        let null = PivotedCholesky::new(&a).null_space(&a);
        assert_eq!((null.exact.len(), null.near.len()), (1, 0));
        let z = &null.exact[0] / null.exact[0][1];
        assert_eq!(z.as_slice(), [0.0, 1.0, 0.0, 1.0]);
    }

    #[test]
    fn an_indefinite_matrix_shows_itself() {
        let a = DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 2.0, 1.0]);
        assert!(PivotedCholesky::new(&a).null_space(&a).least < -0.1);
    }
}
