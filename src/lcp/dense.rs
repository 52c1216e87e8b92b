//! The dense products and factorizations of the engine: the one file of `lcp` that names faer.

use faer::linalg::matmul::matmul;
use faer::linalg::solvers::{Llt, PartialPivLu, Solve};
use faer::linalg::triangular_solve::solve_unit_lower_triangular_in_place;
use faer::{Accum, Mat, MatMut, MatRef, Par, Side};
use nalgebra::{DMatrix, DVector};

/// Columns of a triangle that are multiplied out at once.
const STRIP: usize = 128;

/// Lets faer compute on one thread, so that the bits of a result do not depend on the number of threads; parallel
/// factorizations of the sizes met here are no faster.
pub(crate) fn compute_sequentially() {
    faer::set_global_parallelism(Par::Seq);
}

/// target += left · right; all column-major: rows × columns, rows × k, k × columns.
pub(crate) fn add_product(target: &mut [f64], left: &[f64], right: &[f64], rows: usize, columns: usize, k: usize) {
    if rows == 0 || columns == 0 || k == 0 {
        return;
    }
    matmul(
        MatMut::from_column_major_slice_mut(target, rows, columns),
        Accum::Add,
        MatRef::from_column_major_slice(left, rows, k),
        MatRef::from_column_major_slice(right, k, columns),
        1.0,
        Par::Seq,
    );
}

/// Lower triangle of the trailing square −= P Pᵀ: `columns` are the last columns of an n × n matrix, from number `from`
/// on, `panel` some columns before them; P is the rows of `panel` from `from` on. What is above the diagonal is left
/// undefined.
pub(crate) fn subtract_square(columns: &mut [f64], panel: &[f64], n: usize, from: usize) {
    if columns.is_empty() || panel.is_empty() {
        return;
    }
    let panel = MatRef::from_column_major_slice(panel, n, panel.len() / n);
    for (index, strip) in columns.chunks_mut(STRIP * n).enumerate() {
        let (first, width) = (from + index * STRIP, strip.len() / n);
        matmul(
            MatMut::from_column_major_slice_mut(strip, n, width).get_mut(first.., ..),
            Accum::Add,
            panel.get(first.., ..),
            panel.get(first..first + width, ..).transpose(),
            -1.0,
            Par::Seq,
        );
    }
}

/// Smallest eigenvalue of a symmetric matrix; `None` if the iteration did not converge.
pub(crate) fn smallest_eigenvalue(matrix: &DMatrix<f64>) -> Option<f64> {
    let n = matrix.nrows();
    let view = MatRef::from_column_major_slice(matrix.as_slice(), n, n);
    view.self_adjoint_eigenvalues(Side::Lower).ok()?.first().copied()
}

/// target += matrix · x; the matrix column-major, as many columns as x has entries.
pub(crate) fn add_response(target: &mut [f64], matrix: &[f64], x: &[f64]) {
    let rows = target.len();
    add_product(target, matrix, x, rows, 1, x.len());
}

/// target += Σ factor · column over the given (column, factor).
pub(crate) fn add_columns<'a>(target: &mut [f64], terms: impl Iterator<Item = (&'a [f64], f64)>) {
    let terms: Vec<_> = terms.collect();
    // Four columns at a time: the sum is read and written a quarter as often.
    let mut fours = terms.chunks_exact(4);
    for four in &mut fours {
        let [a, b, c, d] = [four[0], four[1], four[2], four[3]];
        let columns = a.0.iter().zip(b.0).zip(c.0.iter().zip(d.0));
        for (sum, ((w, x), (y, z))) in target.iter_mut().zip(columns) {
            *sum += (a.1 * w + b.1 * x) + (c.1 * y + d.1 * z);
        }
    }
    for &(column, factor) in fours.remainder() {
        for (sum, entry) in target.iter_mut().zip(column) {
            *sum += factor * entry;
        }
    }
}

/// high + low += matrix · x, the rounding errors of every product and sum carried along in `low` (Ogita, Rump, Oishi
/// 2005), column by column as the matrix is stored.
pub(crate) fn add_doubled_response(high: &mut [f64], low: &mut [f64], matrix: &[f64], x: &[f64]) {
    let columns = matrix.chunks_exact(high.len().max(1)).zip(x).filter(|(_, x)| **x != 0.0);
    for (column, x) in columns {
        let factor = Split::new(*x);
        for ((high, low), entry) in high.iter_mut().zip(low.iter_mut()).zip(column) {
            let (product, product_error) = Split::new(*entry).times(&factor);
            let next = *high + product;
            let back = next - *high;
            *low += (*high - (next - back)) + (product - back) + product_error;
            *high = next;
        }
    }
}

/// right := lower⁻¹ right, where `lower` (size × size, column-major) has ones on its diagonal.
pub(crate) fn solve_unit_lower(lower: &[f64], right: &mut [f64], size: usize, columns: usize) {
    if size == 0 || columns == 0 {
        return;
    }
    solve_unit_lower_triangular_in_place(
        MatRef::from_column_major_slice(lower, size, size),
        MatMut::from_column_major_slice_mut(right, size, columns),
        Par::Seq,
    );
}

/// Cholesky factorization of a symmetric matrix.
pub(crate) struct Cholesky(Llt<f64>);

impl Cholesky {
    /// `None` where a pivot is not positive.
    pub(crate) fn new(matrix: &DMatrix<f64>) -> Option<Cholesky> {
        let n = matrix.nrows();
        MatRef::from_column_major_slice(matrix.as_slice(), n, n).llt(Side::Lower).ok().map(Cholesky)
    }

    /// right := matrix⁻¹ right.
    pub(crate) fn solve(&self, right: &mut [f64]) {
        let n = right.len();
        self.0.solve_in_place(MatMut::from_column_major_slice_mut(right, n, 1));
    }
}

/// LU factorization with partial pivoting of a square matrix, with the matrix kept for refinement.
pub(crate) struct Factor {
    lu: PartialPivLu<f64>,
    matrix: DMatrix<f64>,
}

impl Factor {
    /// Factorizes; a singular matrix shows as non-finite or failing solutions (`solve` returns `None`).
    pub(crate) fn new(matrix: DMatrix<f64>) -> Factor {
        let n = matrix.nrows();
        let view = MatRef::from_column_major_slice(matrix.as_slice(), n, n);
        Factor { lu: view.partial_piv_lu(), matrix }
    }

    /// Solves A X = B for all columns; `None` if not finite.
    pub(crate) fn solve_many(&self, right: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let mut x = Mat::from_fn(right.nrows(), right.ncols(), |i, j| right[(i, j)]);
        if right.nrows() > 0 {
            self.lu.solve_in_place(x.as_mut());
        }
        let solution = DMatrix::from_fn(right.nrows(), right.ncols(), |i, j| x[(i, j)]);
        solution.iter().all(|value| value.is_finite()).then_some(solution)
    }

    /// Solves A x = b with refinement (two steps for small systems, one for large ones), residuals in twice the
    /// precision; `None` if not finite.
    pub(crate) fn solve(&self, right: &DVector<f64>) -> Option<DVector<f64>> {
        let n = right.len();
        let mut solution = DVector::zeros(n);
        let mut residual = right.clone();
        let refinements = if n > 128 { 1 } else { 2 };
        for round in 0..=refinements {
            let mut correction = Mat::from_fn(n, 1, |i, _| residual[i]);
            if n > 0 {
                self.lu.solve_in_place(correction.as_mut());
            }
            for i in 0..n {
                solution[i] += correction[(i, 0)];
            }
            if !solution.iter().all(|value: &f64| value.is_finite()) {
                return None;
            }
            if round < refinements {
                residual = self.residual(right, &solution);
            }
        }
        Some(solution)
    }

    /// b − A x in doubled precision, rounded.
    fn residual(&self, right: &DVector<f64>, x: &DVector<f64>) -> DVector<f64> {
        let mut sum = right.clone();
        let mut error = DVector::<f64>::zeros(right.len());
        add_doubled_response(sum.as_mut_slice(), error.as_mut_slice(), self.matrix.as_slice(), (-x).as_slice());
        sum + error
    }
}

/// A number cut into two halves of 26 bits (Veltkamp), so that products of halves are exact.
struct Split {
    value: f64,
    high: f64,
    low: f64,
}

impl Split {
    #[inline]
    fn new(value: f64) -> Split {
        let carried = 134_217_729.0 * value;
        let high = carried - (carried - value);
        Split { value, high, low: value - high }
    }

    /// Product and its rounding error (Dekker).
    #[inline]
    fn times(&self, other: &Split) -> (f64, f64) {
        let product = self.value * other.value;
        let error =
            ((self.high * other.high - product) + self.high * other.low + self.low * other.high) + self.low * other.low;
        (product, error)
    }
}
