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

#[test]
fn waiting_steps_read_as_if_made_at_once() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let (rows, columns) = (9, 11);
    let mut flushed = 0;
    for _ in 0..40 {
        let start = DMatrix::from_fn(rows, columns, |_, _| rng.random_range(-1.0..1.0));
        let mut plain = Plain(start.clone());
        let mut updated = UpdatedMatrix::new(rows, columns, start.as_slice().to_vec());
        // More steps than may wait.
        for step in 0..50 {
            let (r, other) = (rng.random_range(0..rows), rng.random_range(0..rows));
            let (c, unit) = (rng.random_range(0..columns), rng.random_range(0..columns));
            let mut u = Vec::new();
            updated.column(c, &mut u);
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
                    updated.exchange(None, c, &u, &combination, 0.7);
                }
                _ => {
                    plain.exchange(Some(r), c, &combination, 0.7);
                    updated.exchange(Some(r), c, &u, &combination, 0.7);
                }
            }
            let size = plain.0.amax();
            let mut column = Vec::new();
            for j in 0..columns {
                updated.column(j, &mut column);
                let error = (DVector::from_column_slice(&column) - plain.0.column(j)).amax();
                assert!(error <= 1e-13 * size, "step {step}, column {j}: {error:e}");
            }
            let (some_rows, some_columns) = ([r, other], [c, unit, 0]);
            let block = updated.block(&some_rows, &some_columns);
            for (k, entry) in block.iter().enumerate() {
                let expected = plain.0[(some_rows[k % 2], some_columns[k / 2])];
                assert!((entry - expected).abs() <= 1e-13 * size);
            }
            let terms: Vec<(usize, f64)> = (0..7).map(|j| (j, 0.1 * j as f64 - 0.2)).collect();
            let expected = terms.iter().fold(DVector::zeros(rows), |sum, &(j, x)| sum + plain.0.column(j) * x);
            let error = (DVector::from_vec(updated.combined(&terms)) - expected).amax();
            assert!(error <= 1e-13 * size, "step {step}: {error:e}");
            if size > 1e3 {
                break;
            }
            flushed += usize::from(step == 40);
        }
    }
    assert!(flushed > 10, "{flushed} runs went past a flush");
}
