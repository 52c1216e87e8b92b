//! Products of dense matrices, column-major.

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_unit_lower_triangular_in_place;
use faer::{Accum, MatMut, MatRef, Par};
use pulp::Arch;

/// Columns of a triangle that are multiplied out at once.
const STRIP: usize = 128;

/// target += left · right; all column-major: rows × columns, rows × k, k × columns.
pub fn add_product(target: &mut [f64], left: &[f64], right: &[f64], rows: usize, columns: usize, k: usize) {
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
pub fn subtract_square(columns: &mut [f64], panel: &[f64], n: usize, from: usize) {
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

/// target += matrix · x; the matrix column-major, as many columns as x has entries.
pub fn add_response(target: &mut [f64], matrix: &[f64], x: &[f64]) {
    let rows = target.len();
    add_product(target, matrix, x, rows, 1, x.len());
}

/// The same where most entries of x are 0: their columns are not read.
pub fn add_sparse_response(target: &mut [f64], matrix: &[f64], x: &[f64]) {
    let columns = matrix.chunks_exact(target.len().max(1)).zip(x.iter().copied());
    let columns: Vec<(&[f64], f64)> = columns.filter(|column| column.1 != 0.0).collect();
    add_columns(target, &columns);
}

/// target += Σ factor · column over the given (column, factor).
pub fn add_columns(target: &mut [f64], terms: &[(&[f64], f64)]) {
    // Wider registers, where the processor has them, change no byte.
    Arch::new().dispatch(|| add_columns_here(target, terms));
}

#[inline(always)]
fn add_columns_here(target: &mut [f64], terms: &[(&[f64], f64)]) {
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

/// right := lower⁻¹ right, where `lower` (size × size, column-major) has ones on its diagonal.
pub fn solve_unit_lower(lower: &[f64], right: &mut [f64], size: usize, columns: usize) {
    if size == 0 || columns == 0 {
        return;
    }
    solve_unit_lower_triangular_in_place(
        MatRef::from_column_major_slice(lower, size, size),
        MatMut::from_column_major_slice_mut(right, size, columns),
        Par::Seq,
    );
}

/// A number cut into two halves of 26 bits (Veltkamp), so that products of halves are exact.
pub struct Split {
    value: f64,
    high: f64,
    low: f64,
}

impl Split {
    /// Overflows where the value does in 2²⁷ times its size.
    #[inline]
    pub fn new(value: f64) -> Split {
        let carried = 134_217_729.0 * value;
        let high = carried - (carried - value);
        Split { value, high, low: value - high }
    }

    /// Product and its rounding error (Dekker 1971).
    #[inline]
    pub fn times(&self, other: &Split) -> (f64, f64) {
        let product = self.value * other.value;
        let error =
            ((self.high * other.high - product) + self.high * other.low + self.low * other.high) + self.low * other.low;
        (product, error)
    }
}

/// Terms that are summed in eight lanes, one after another.
const RUN: usize = 64;

/// Σ a_i b_i and Σ |a_i b_i| in f64, halves of the terms summed by themselves: how many roundings a term meets at
/// most, [`roundings`] says.
pub fn halved_sums(a: &[f64], b: &[f64]) -> (f64, f64) {
    if a.len() > RUN {
        let middle = a.len().div_ceil(2);
        let (first, second) = (halved_sums(&a[..middle], &b[..middle]), halved_sums(&a[middle..], &b[middle..]));
        return (first.0 + second.0, first.1 + second.1);
    }
    let (mut sum, mut magnitude) = ([0.0; 8], [0.0; 8]);
    let mut eights = a.chunks_exact(8).zip(b.chunks_exact(8));
    for (a, b) in &mut eights {
        for lane in 0..8 {
            let term = a[lane] * b[lane];
            sum[lane] += term;
            magnitude[lane] += term.abs();
        }
    }
    let left = a.len() - a.len() % 8;
    for (lane, (a, b)) in a[left..].iter().zip(&b[left..]).enumerate() {
        sum[lane] += a * b;
        magnitude[lane] += (a * b).abs();
    }
    let all = |lanes: [f64; 8]| {
        ((lanes[0] + lanes[4]) + (lanes[1] + lanes[5])) + ((lanes[2] + lanes[6]) + (lanes[3] + lanes[7]))
    };
    (all(sum), all(magnitude))
}

/// Roundings that a term of [`halved_sums`] of n terms meets at most: its product, the sums of its lane, of the eight
/// lanes and of the halves. The error of the sum is at most so many times ε/2 Σ |a_i b_i|, if no product underflows.
pub fn roundings(n: usize) -> f64 {
    let halves = n.div_ceil(RUN).next_power_of_two().ilog2();
    f64::from(1 + (RUN as u32 / 8 + 1) + 3 + halves)
}
