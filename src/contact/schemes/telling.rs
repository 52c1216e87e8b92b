//! A basis of the kernel for exact arithmetic: each motion moves a joint of its own by 1, and those of the others not at all.

use nalgebra::DMatrix;

/// Entries of the kernel this close to a whole number are that number: they come out of f64 linear algebra.
const WHOLE: f64 = 64.0 * f64::EPSILON;
/// Least pivot, as a share of the largest there is, where it is not that.
const SAFE: f64 = 0.1;
/// Most products of entries with which rows are compared at a step.
const MOST_COMPARED: usize = 1_000_000;

/// A pivot: row, column, magnitude.
type Pivot = (usize, usize, f64);
/// Of the columns from the given one on, and the given rows.
type Choice = fn(&DMatrix<f64>, usize, &[usize]) -> Pivot;

/// Rows P of Z with a safe inverse, and Z Z_P⁻¹; `None` without a kernel.
///
/// Rows that are parallel become 0 together where one of them is pivot. What a rotation about the anchor of a spring does to
/// the pair there, which only slides across the spring, is exactly 0 then, and not what rounding leaves of two columns. So where
/// the largest pivots leave such rows, they are chosen among those first.
pub(crate) fn telling_joints(kernel: &DMatrix<f64>) -> Option<(Vec<usize>, DMatrix<f64>)> {
    let found = reduced(kernel, largest)?;
    if leaves_parallel_rows(&found.1) { reduced(kernel, most_parallel).or(Some(found)) } else { Some(found) }
}

/// Gauss–Jordan over the columns; a pivot comes from the columns from the given one on, and from the given rows.
fn reduced(kernel: &DMatrix<f64>, lead: Choice) -> Option<(Vec<usize>, DMatrix<f64>)> {
    let (k, r) = kernel.shape();
    if r == 0 {
        return None;
    }
    let mut z = kernel.clone();
    let mut telling = Vec::with_capacity(r);
    for column in 0..r {
        let rows: Vec<usize> = (0..k).filter(|i| !telling.contains(i)).collect();
        let (row, from, size) = lead(&z, column, &rows);
        if size <= WHOLE {
            return None; // dependent columns: an orthonormal basis never is
        }
        z.swap_columns(column, from);
        let pivot = z[(row, column)];
        z.column_mut(column).iter_mut().for_each(|entry| *entry /= pivot);
        let own = z.column(column).into_owned();
        for j in (0..r).filter(|&j| j != column) {
            let factor = z[(row, j)];
            for i in 0..k {
                z[(i, j)] -= factor * own[i];
            }
        }
        telling.push(row);
    }
    for entry in z.iter_mut() {
        if (*entry - entry.round()).abs() <= WHOLE {
            *entry = entry.round();
        }
    }
    Some((telling, z))
}

/// The largest entry.
fn largest(z: &DMatrix<f64>, column: usize, rows: &[usize]) -> Pivot {
    let mut best = (0, column, 0.0);
    for j in column..z.ncols() {
        for &i in rows {
            if z[(i, j)].abs() > best.2 {
                best = (i, j, z[(i, j)].abs());
            }
        }
    }
    best
}

/// The largest entry of a row that most others are parallel to, among rows that are not small.
fn most_parallel(z: &DMatrix<f64>, column: usize, rows: &[usize]) -> Pivot {
    let first = largest(z, column, rows);
    let left: Vec<(usize, Vec<f64>)> =
        rows.iter().map(|&i| (i, z.row(i).iter().skip(column).copied().collect())).collect();
    let count = |row: &[f64]| left.iter().filter(|(_, other)| are_parallel(row, other)).count();
    let safe = left.iter().filter(|(_, row)| size(row) >= SAFE * first.2);
    // `max_by` takes the last of equal ones.
    let best = safe.rev().map(|(i, row)| (count(row), largest(z, column, &[*i])));
    best.max_by(|a, b| a.0.cmp(&b.0).then(a.1.2.total_cmp(&b.1.2))).map_or(first, |(_, pivot)| pivot)
}

/// Whether rows of more than one entry are parallel: what is 0 of their sums is so by rounding.
fn leaves_parallel_rows(z: &DMatrix<f64>) -> bool {
    if z.nrows() * z.nrows() * z.ncols() > MOST_COMPARED {
        return false;
    }
    let rows = z.row_iter().map(|row| row.iter().copied().collect::<Vec<f64>>());
    let mixed: Vec<Vec<f64>> = rows.filter(|row| row.iter().filter(|entry| **entry != 0.0).count() > 1).collect();
    (1..mixed.len()).any(|i| mixed[..i].iter().any(|other| are_parallel(&mixed[i], other)))
}

fn size(row: &[f64]) -> f64 {
    row.iter().fold(0.0, |size: f64, entry| size.max(entry.abs()))
}

/// Whether two rows, neither of which is 0, are parallel to rounding.
fn are_parallel(a: &[f64], b: &[f64]) -> bool {
    let at = (0..a.len()).max_by(|&i, &j| a[i].abs().total_cmp(&a[j].abs()));
    let Some(at) = at.filter(|_| size(a).min(size(b)) > WHOLE) else { return false };
    let (share, largest) = (b[at] / a[at], size(a).max(size(b)));
    std::iter::zip(a, b).all(|(a, b)| (b - share * a).abs() <= WHOLE * largest)
}
