//! Random steps against the same steps made at once on a plain matrix.

use nalgebra::{DMatrix, DVector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::{Combination, UpdatedMatrix};

/// The definition: every step rewrites the whole matrix.
struct Plain(DMatrix<f64>);

impl Plain {
    fn row(&self, combination: &Combination) -> DVector<f64> {
        let mut sum = DVector::zeros(self.0.ncols());
        for &(row, factor) in &combination.rows {
            sum += self.0.row(row).transpose() * factor;
        }
        for &(column, factor) in &combination.units {
            sum[column] += factor;
        }
        sum
    }

    fn replace_row(&mut self, row: usize, combination: &Combination) {
        let new = self.row(combination);
        self.0.row_mut(row).copy_from(&new.transpose());
    }

    fn exchange(&mut self, row: Option<usize>, c: usize, combination: &Combination, factor: f64) {
        let mut u = self.0.column(c).into_owned();
        let mut v = self.row(combination);
        v[c] = factor;
        if let Some(row) = row {
            u[row] = 1.0;
            self.0.row_mut(row).fill(0.0);
        }
        self.0.column_mut(c).fill(0.0);
        self.0 += u * v.transpose();
    }
}

/// Random steps on a matrix of the given size; only `read` columns are looked at after each, so that others fall
/// behind. Returns whether the run went past as many steps as may wait.
fn walk(rng: &mut ChaCha8Rng, (rows, columns): (usize, usize), read: usize) -> bool {
    let start = DMatrix::from_fn(rows, columns, |_, _| rng.random_range(-0.5..0.5));
    let mut plain = Plain(start.clone());
    let mut updated = UpdatedMatrix::new(rows, columns, start.as_slice().to_vec());
    let mut largest = 1.0_f64;
    for step in 0..250 {
        let (r, other) = (rng.random_range(0..rows), rng.random_range(0..rows));
        let (c, unit) = (rng.random_range(0..columns), rng.random_range(0..columns));
        let mut u = Vec::new();
        let combination = Combination { rows: vec![(r, -0.4), (other, 0.3)], units: vec![(unit, 0.5)] };
        match step % 5 {
            0 => {
                plain.replace_row(r, &combination);
                updated.replace_row(r, &combination);
            }
            1 => {
                plain.0.column_mut(c).neg_mut();
                updated.scale_column(c, -1.0);
            }
            2 => {
                plain.exchange(None, c, &combination, 0.7);
                updated.column(c, &mut u);
                updated.exchange(None, c, &u, &combination, 0.7);
            }
            _ => {
                plain.exchange(Some(r), c, &combination, 0.7);
                updated.column(c, &mut u);
                updated.exchange(Some(r), c, &u, &combination, 0.7);
            }
        }
        largest = largest.max(plain.0.amax());
        if largest > 1e3 {
            return false;
        }
        let within = |value: f64, expected: f64, terms: f64, what: &str| {
            let error = (value - expected).abs();
            assert!(error <= 1e-13 * largest * terms, "step {step}, {what}: {value} for {expected}");
        };
        let close = |value: f64, expected: f64, what: &str| within(value, expected, 1.0, what);
        // What leaves the matrix as it is comes first: it must be right in columns that are behind too.
        let far = rng.random_range(0..columns);
        close(updated.reader(far).entry(other), plain.0[(other, far)], "entry");
        let terms: Vec<(usize, f64)> = (0..columns).step_by(3).map(|j| (j, 0.1 * (j % 7) as f64 - 0.2)).collect();
        let expected = terms.iter().fold(DVector::zeros(rows), |sum, &(j, x)| sum + plain.0.column(j) * x);
        for (value, expected) in updated.combined(&terms).iter().zip(expected.iter()) {
            within(*value, *expected, terms.iter().map(|term| term.1.abs()).sum(), "combination");
        }
        let mut column = Vec::new();
        for _ in 0..read {
            let j = rng.random_range(0..columns);
            updated.column(j, &mut column);
            for (value, expected) in column.iter().zip(plain.0.column(j).iter()) {
                close(*value, *expected, "column");
            }
        }
        if step % 10 == 9 {
            let (some_rows, some_columns) = ([r, other], [c, unit, 0]);
            for (k, entry) in updated.block(&some_rows, &some_columns).iter().enumerate() {
                close(*entry, plain.0[(some_rows[k % 2], some_columns[k / 2])], "block");
            }
        }
    }
    true
}

#[test]
fn waiting_steps_read_as_if_made_at_once() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    // One block of columns, in which every batch is multiplied out at once, and several that fall behind differently.
    for (size, read) in [((9, 11), 3), ((12, 70), 1), ((40, 140), 0)] {
        let whole = (0..30).filter(|_| walk(&mut rng, size, read)).count();
        assert!(whole > 5, "{whole} runs of {size:?} went past the steps that may wait");
    }
}
