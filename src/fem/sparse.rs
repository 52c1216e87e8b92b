//! A symmetric sparse matrix, lower triangle by columns, and the counting sort that makes it from its terms.

#[cfg(test)]
use nalgebra::DMatrix;
use stickslip_numerics::doubled::symmetric_times;

use super::threads::map_all;
use crate::doubled::{Doubled, Real};

/// Lower triangle (with diagonal) by columns; rows ascending, none twice.
#[derive(Clone, Debug, PartialEq)]
pub struct SymmetricSparse<T = f64> {
    /// Start of each column, length n + 1.
    pub column_start: Vec<u32>,
    /// Row of each entry, ≥ its column.
    pub rows: Vec<u32>,
    /// Value of each entry.
    pub values: Vec<T>,
}

impl<T: Real> SymmetricSparse<T> {
    /// Sums terms (row, column, value), row ≥ column. `columns` tells the column of every term beforehand, in any
    /// order; `terms` then gives the terms themselves, as many for each column.
    pub fn from_terms<E>(
        n: usize,
        mut columns: impl FnMut(&mut dyn FnMut(usize)),
        mut terms: impl FnMut(&mut dyn FnMut(usize, usize, T)) -> Result<(), E>,
    ) -> Result<SymmetricSparse<T>, E> {
        let mut start = vec![0_usize; n + 1];
        columns(&mut |column| start[column + 1] += 1);
        for column in 0..n {
            start[column + 1] += start[column];
        }
        let mut next = start.clone();
        let mut entries: Vec<(u32, T)> = vec![(0, T::zero()); start[n]];
        terms(&mut |row, column, value| {
            debug_assert!(row >= column);
            entries[next[column]] = (row as u32, value);
            next[column] += 1;
        })?;
        drop(next);
        let mut matrix = SymmetricSparse { column_start: vec![0; n + 1], rows: Vec::new(), values: Vec::new() };
        // First pass: sort and sum each column in place; then copy to exact size.
        let kept = sum_columns(&start, &mut entries);
        for (column, kept) in kept.iter().enumerate() {
            matrix.column_start[column + 1] = matrix.column_start[column] + kept;
        }
        let count = matrix.column_start[n] as usize;
        matrix.rows.reserve_exact(count);
        matrix.values.reserve_exact(count);
        for column in 0..n {
            let from = start[column];
            for &(row, value) in &entries[from..from + kept[column] as usize] {
                matrix.rows.push(row);
                matrix.values.push(value);
            }
        }
        Ok(matrix)
    }

    /// Order n.
    pub fn order(&self) -> usize {
        self.column_start.len() - 1
    }

    /// Entries (row, value) of a column, row ≥ column.
    pub fn column(&self, column: usize) -> impl Iterator<Item = (usize, T)> + '_ {
        let range = self.column_start[column] as usize..self.column_start[column + 1] as usize;
        std::iter::zip(&self.rows[range.clone()], &self.values[range]).map(|(&row, &value)| (row as usize, value))
    }

    /// |A| |x|: the size of the terms that are summed in A x.
    pub fn times_absolute(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.order()];
        for column in 0..self.order() {
            for (row, value) in self.column(column) {
                let value = value.to_f64().abs();
                y[column] += value * x[row].abs();
                if row != column {
                    y[row] += value * x[column].abs();
                }
            }
        }
        y
    }
}

impl SymmetricSparse<Doubled> {
    /// A x.
    pub fn times(&self, x: &[Doubled]) -> Vec<Doubled> {
        symmetric_times(&self.column_start, &self.rows, &self.values, x)
    }
}

impl SymmetricSparse {
    /// A x.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.order()];
        for column in 0..self.order() {
            let mut sum = 0.0;
            for (row, value) in self.column(column) {
                sum += value * x[row];
                if row != column {
                    y[row] += value * x[column];
                }
            }
            y[column] += sum;
        }
        y
    }

    /// A x and |A| |x| of N vectors x, which stand side by side, in one go through A.
    pub fn times_with_terms<const N: usize>(&self, x: &[[f64; N]]) -> Vec<[[f64; N]; 2]> {
        let mut both = vec![[[0.0; N]; 2]; self.order()];
        for column in 0..self.order() {
            let own = x[column];
            let mut here = both[column];
            for (row, value) in self.column(column) {
                for (k, x) in x[row].iter().enumerate() {
                    let term = value * x;
                    here[0][k] += term;
                    here[1][k] += term.abs();
                }
                if row != column {
                    let there = &mut both[row];
                    for (k, x) in own.iter().enumerate() {
                        let term = value * x;
                        there[0][k] += term;
                        there[1][k] += term.abs();
                    }
                }
            }
            both[column] = here;
        }
        both
    }

    /// The diagonal; zero where there is no entry.
    pub fn diagonal(&self) -> Vec<f64> {
        (0..self.order())
            .map(|i| match self.column(i).next() {
                Some((row, value)) if row == i => value,
                _ => 0.0,
            })
            .collect()
    }

    /// S A S with S the powers of two nearest to 1/√A_ii (1 where A_ii is not positive); returns the diagonal of S.
    pub fn scale_to_unit_diagonal(&mut self) -> Vec<f64> {
        let scale: Vec<f64> =
            self.diagonal().into_iter().map(|d| if d > 0.0 { (-0.5 * d.log2()).round().exp2() } else { 1.0 }).collect();
        for column in 0..self.order() {
            let range = self.column_start[column] as usize..self.column_start[column + 1] as usize;
            for at in range {
                self.values[at] *= scale[column] * scale[self.rows[at] as usize];
            }
        }
        scale
    }

    /// The full matrix.
    #[cfg(test)]
    pub fn to_dense(&self) -> DMatrix<f64> {
        let mut dense = DMatrix::zeros(self.order(), self.order());
        for column in 0..self.order() {
            for (row, value) in self.column(column) {
                dense[(row, column)] = value;
                dense[(column, row)] = value;
            }
        }
        dense
    }
}

/// Columns that are worth a thread.
const COLUMNS: usize = 4096;

/// Sorts the entries of each column by their rows and sums those of one row; how many are left at its beginning.
fn sum_columns<T: Real>(start: &[usize], entries: &mut [(u32, T)]) -> Vec<u32> {
    let n = start.len() - 1;
    let mut rest = entries;
    let strips = (0..n).step_by(COLUMNS).map(|first| {
        let bounds = &start[first..=n.min(first + COLUMNS)];
        let (strip, others) = std::mem::take(&mut rest).split_at_mut(bounds[bounds.len() - 1] - bounds[0]);
        rest = others;
        (bounds, strip)
    });
    let kept = map_all(strips.collect(), 1, |(bounds, strip)| -> Vec<u32> {
        bounds.windows(2).map(|column| sum_column(&mut strip[column[0] - bounds[0]..column[1] - bounds[0]])).collect()
    });
    kept.concat()
}

fn sum_column<T: Real>(entries: &mut [(u32, T)]) -> u32 {
    // Stable, so that the sum does not depend on anything but the order of the terms.
    entries.sort_by_key(|entry| entry.0);
    let mut last = 0;
    for i in 1..entries.len() {
        if entries[i].0 == entries[last].0 {
            let value = entries[i].1;
            entries[last].1 += value;
        } else {
            last += 1;
            entries[last] = entries[i];
        }
    }
    if entries.is_empty() { 0 } else { last as u32 + 1 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_terms_are_summed() {
        let terms = [(0, 0, 1.0), (2, 0, -1.0), (1, 1, 4.0), (2, 0, 0.5), (2, 2, 3.0)];
        let matrix = SymmetricSparse::from_terms::<()>(
            3,
            |count| terms.iter().for_each(|&(_, j, _)| count(j)),
            |push| {
                terms.iter().for_each(|&(i, j, v)| push(i, j, v));
                Ok(())
            },
        )
        .unwrap();
        #[rustfmt::skip]
        let dense = DMatrix::from_row_slice(3, 3, &[
             1.0, 0.0, -0.5,
             0.0, 4.0,  0.0,
            -0.5, 0.0,  3.0,
        ]);
        assert_eq!(matrix.to_dense(), dense);
        assert_eq!(matrix.rows.len(), 4);
        assert_eq!(matrix.times(&[1.0, 2.0, 3.0]), vec![-0.5, 8.0, 8.5]);
        assert_eq!(matrix.times_absolute(&[1.0, -2.0, 3.0]), vec![2.5, 8.0, 9.5]);
        let both = matrix.times_with_terms(&[[1.0, 0.0], [-2.0, 0.0], [3.0, 1.0]]);
        assert_eq!(both.iter().map(|[sum, _]| sum[0]).collect::<Vec<_>>(), [-0.5, -8.0, 8.5]);
        assert_eq!(both.iter().map(|[_, terms]| terms[0]).collect::<Vec<_>>(), [2.5, 8.0, 9.5]);
        assert_eq!(both.iter().map(|[sum, _]| sum[1]).collect::<Vec<_>>(), matrix.times(&[0.0, 0.0, 1.0]));
        assert_eq!(matrix.diagonal(), vec![1.0, 4.0, 3.0]);
    }

    #[test]
    fn a_product_in_doubled_precision_keeps_what_cancels() {
        // [2 1; 1 2] + 2⁻⁶⁰ [1 0; 0 3], times (1, −2) and (1, 1).
        let tiny = Doubled::from((-60_f64).exp2());
        let number = |a: f64, tail: f64| Doubled::from(a) + Doubled::from(tail) * tiny;
        let matrix = SymmetricSparse {
            column_start: vec![0, 2, 3],
            rows: vec![0, 1, 1],
            values: vec![number(2.0, 1.0), number(1.0, 0.0), number(2.0, 3.0)],
        };
        let (x, y) = ([1.0, -2.0].map(Doubled::from), [1.0, 1.0].map(Doubled::from));
        assert_eq!(matrix.times(&x), [number(0.0, 1.0), number(-3.0, -6.0)]);
        assert_eq!(matrix.times(&y), [number(3.0, 1.0), number(3.0, 3.0)]);
    }
}
