//! A matrix under elimination steps that wait: A = T + U V, the steps' columns U kept, their multipliers V found
//! only when somebody asks for a column (method §5).
//!
//! A step clears a row or a column of A or both and then adds u vᵀ. v is a combination of a few rows of A as they
//! stood before the step; so the multiplier of step k in column j follows from the entries of T in those rows and
//! from the multipliers of the steps before it, a triangular recurrence as long as the number of waiting steps.
//! No row of T is read until [`UpdatedMatrix::flush`], which finds all of V at once and multiplies it out.

use super::dense::{add_product, add_response, solve_unit_lower};

/// A linear combination of rows of the matrix and of unit rows, what a step adds along its column u.
#[derive(Clone, Debug, Default)]
pub(crate) struct Combination {
    /// (row, factor).
    pub(crate) rows: Vec<(usize, f64)>,
    /// (column of the 1, factor).
    pub(crate) units: Vec<(usize, f64)>,
}

/// See the module.
#[derive(Clone, Debug)]
pub(crate) struct UpdatedMatrix {
    rows: usize,
    columns: usize,
    /// Most steps that wait.
    limit: usize,
    /// T, column-major. Rows cleared by a waiting step still stand in it and count as zero.
    t: Vec<f64>,
    /// Whether a waiting step cleared the row.
    cleared: Vec<bool>,
    cleared_rows: Vec<usize>,
    /// Columns of the waiting steps, rows × limit, with zeros where a later step cleared the row.
    u: Vec<f64>,
    /// Rows of T that the multiplier of each waiting step combines: (step, row, factor), steps ascending.
    from_rows: Vec<(usize, usize, f64)>,
    /// Unit rows in it: (step, column, factor).
    from_units: Vec<(usize, usize, f64)>,
    /// What step i gives to the multiplier of step k > i: entry k + limit · i.
    from_steps: Vec<f64>,
    /// Number of steps that wait.
    waiting: usize,
    flushes: usize,
}

impl UpdatedMatrix {
    /// The matrix with the given entries, column-major; nothing waits.
    pub(crate) fn new(rows: usize, columns: usize, entries: Vec<f64>) -> UpdatedMatrix {
        debug_assert_eq!(entries.len(), rows * columns);
        // Long enough for the product to run at full speed, short enough that reading a column stays cheap.
        let limit = (rows / 16).clamp(32, 96);
        UpdatedMatrix {
            rows,
            columns,
            limit,
            t: entries,
            cleared: vec![false; rows],
            cleared_rows: Vec::new(),
            u: vec![0.0; rows * limit],
            from_rows: Vec::new(),
            from_units: Vec::new(),
            from_steps: vec![0.0; limit * limit],
            waiting: 0,
            flushes: 0,
        }
    }

    /// Replaces all entries; nothing waits any more.
    pub(crate) fn replace(&mut self, entries: Vec<f64>) {
        debug_assert_eq!(entries.len(), self.t.len());
        self.t = entries;
        self.forget();
    }

    /// How often waiting steps were multiplied out.
    pub(crate) fn flushes(&self) -> usize {
        self.flushes
    }

    fn stored(&self, j: usize) -> &[f64] {
        &self.t[j * self.rows..(j + 1) * self.rows]
    }

    /// What the multipliers of the waiting steps for A x take from T x and x themselves.
    fn start_multipliers(&self, v: &mut [f64], stored: impl Fn(usize) -> f64, x: impl Fn(usize) -> f64) {
        for &(step, row, factor) in &self.from_rows {
            v[step] += factor * stored(row);
        }
        for &(step, column, factor) in &self.from_units {
            v[step] += factor * x(column);
        }
    }

    /// The same for column j of A.
    fn start_column_multipliers(&self, v: &mut [f64], j: usize) {
        let stored = self.stored(j);
        self.start_multipliers(v, |row| stored[row], |column| f64::from(column == j));
    }

    /// Adds to the multipliers of many columns what each step gives to those after it.
    fn finish_multipliers(&self, v: &mut [f64], columns: usize) {
        let steps = self.waiting;
        let mut lower = vec![0.0; steps * steps];
        for i in 0..steps {
            lower[i + steps * i] = 1.0;
            for k in i + 1..steps {
                lower[k + steps * i] = -self.from_steps[k + self.limit * i];
            }
        }
        solve_unit_lower(&lower, v, steps, columns);
    }

    /// Multipliers of the waiting steps for A x, given T x and x.
    fn multipliers(&self, stored: impl Fn(usize) -> f64, x: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut v = vec![0.0; self.waiting];
        self.start_multipliers(&mut v, stored, x);
        for i in 0..self.waiting {
            let known = v[i];
            if known != 0.0 {
                let further = &self.from_steps[self.limit * i..self.limit * i + self.waiting];
                for (v, factor) in v[i + 1..].iter_mut().zip(&further[i + 1..]) {
                    *v += factor * known;
                }
            }
        }
        v
    }

    fn column_multipliers(&self, j: usize) -> Vec<f64> {
        let stored = self.stored(j);
        self.multipliers(|row| stored[row], |column| f64::from(column == j))
    }

    /// T x or a column of T in `into` becomes the same of A.
    fn finish(&self, into: &mut [f64], multipliers: &[f64]) {
        for &row in &self.cleared_rows {
            into[row] = 0.0;
        }
        add_response(into, &self.u[..self.rows * self.waiting], multipliers);
    }

    /// Column j.
    pub(crate) fn column(&self, j: usize, into: &mut Vec<f64>) {
        into.clear();
        into.extend_from_slice(self.stored(j));
        if self.waiting > 0 {
            self.finish(into, &self.column_multipliers(j));
        }
    }

    /// The entries in the given rows and columns, column-major.
    pub(crate) fn block(&self, rows: &[usize], columns: &[usize]) -> Vec<f64> {
        let mut block = Vec::with_capacity(rows.len() * columns.len());
        let steps = self.waiting;
        let mut multipliers = vec![0.0; steps * columns.len()];
        for (k, &j) in columns.iter().enumerate() {
            let stored = self.stored(j);
            block.extend(rows.iter().map(|&row| if self.cleared[row] { 0.0 } else { stored[row] }));
            self.start_column_multipliers(&mut multipliers[steps * k..steps * (k + 1)], j);
        }
        self.finish_multipliers(&mut multipliers, columns.len());
        let mut waiting = Vec::with_capacity(rows.len() * self.waiting);
        for step in self.u.chunks_exact(self.rows.max(1)).take(self.waiting) {
            waiting.extend(rows.iter().map(|&row| step[row]));
        }
        let (height, width) = (rows.len(), columns.len());
        add_product(&mut block, &waiting, &multipliers, height, width, self.waiting);
        block
    }

    /// Entry (row, j).
    pub(crate) fn entry(&self, row: usize, j: usize) -> f64 {
        let kept = if self.cleared[row] { 0.0 } else { self.stored(j)[row] };
        let u = self.u[row..].iter().step_by(self.rows);
        kept + u.zip(self.column_multipliers(j)).map(|(u, v)| u * v).sum::<f64>()
    }

    /// Σ x_j · column j over the given (j, x_j).
    pub(crate) fn combined(&self, terms: &[(usize, f64)]) -> Vec<f64> {
        let mut sum = vec![0.0; self.rows];
        // Four columns at a time: the sum is read and written a quarter as often.
        let mut fours = terms.chunks_exact(4);
        for four in &mut fours {
            let [a, b, c, d] = [four[0], four[1], four[2], four[3]];
            let columns = self.stored(a.0).iter().zip(self.stored(b.0));
            let columns = columns.zip(self.stored(c.0).iter().zip(self.stored(d.0)));
            for (sum, ((w, x), (y, z))) in sum.iter_mut().zip(columns) {
                *sum += (a.1 * w + b.1 * x) + (c.1 * y + d.1 * z);
            }
        }
        for &(j, factor) in fours.remainder() {
            for (sum, entry) in sum.iter_mut().zip(self.stored(j)) {
                *sum += factor * entry;
            }
        }
        if self.waiting > 0 {
            let mut x = vec![0.0; self.columns];
            for &(j, factor) in terms {
                x[j] += factor;
            }
            let multipliers = self.multipliers(|row| sum[row], |column| x[column]);
            self.finish(&mut sum, &multipliers);
        }
        sum
    }

    /// Row `row` becomes the combination.
    pub(crate) fn replace_row(&mut self, row: usize, combination: &Combination) {
        let u = self.next_step(combination);
        u.fill(0.0);
        self.clear_row(row);
        self.end_step();
    }

    /// Adds `u` times the combination to all other columns, after clearing column `c`, which becomes `factor` · u;
    /// with `row`: clears this row first, and u counts as 1 in it. u stands for column c, whatever it held.
    pub(crate) fn exchange(&mut self, row: Option<usize>, c: usize, u: &[f64], combination: &Combination, factor: f64) {
        self.next_step(combination).copy_from_slice(u);
        self.t[c * self.rows..(c + 1) * self.rows].fill(0.0);
        self.from_units.retain(|&(_, column, _)| column != c);
        self.from_units.push((self.waiting, c, factor));
        match row {
            Some(row) => {
                self.clear_row(row);
                self.end_step();
            }
            None => self.end_step(),
        }
    }

    /// Multiplies column j by `by`.
    pub(crate) fn scale_column(&mut self, j: usize, by: f64) {
        for entry in &mut self.t[j * self.rows..(j + 1) * self.rows] {
            *entry *= by;
        }
        for (_, column, factor) in &mut self.from_units {
            if *column == j {
                *factor *= by;
            }
        }
    }

    /// Notes how the multiplier of a new step comes about, and returns the room for its u.
    fn next_step(&mut self, combination: &Combination) -> &mut [f64] {
        let step = self.waiting;
        for i in 0..step {
            let u = &self.u[i * self.rows..(i + 1) * self.rows];
            self.from_steps[step + self.limit * i] =
                combination.rows.iter().map(|&(row, factor)| factor * u[row]).sum();
        }
        for &(row, factor) in &combination.rows {
            if !self.cleared[row] {
                self.from_rows.push((step, row, factor));
            }
        }
        for &(column, factor) in &combination.units {
            self.from_units.push((step, column, factor));
        }
        &mut self.u[step * self.rows..(step + 1) * self.rows]
    }

    /// Clears a row before the step at hand, whose u counts as 1 in it.
    fn clear_row(&mut self, row: usize) {
        for i in 0..self.waiting {
            self.u[row + i * self.rows] = 0.0;
        }
        self.u[row + self.waiting * self.rows] = 1.0;
        if !std::mem::replace(&mut self.cleared[row], true) {
            self.cleared_rows.push(row);
        }
    }

    fn end_step(&mut self) {
        self.waiting += 1;
        if self.waiting == self.limit {
            self.flush();
        }
    }

    fn forget(&mut self) {
        for row in self.cleared_rows.drain(..) {
            self.cleared[row] = false;
        }
        self.from_rows.clear();
        self.from_units.clear();
        self.waiting = 0;
    }

    /// Multiplies the waiting steps out.
    fn flush(&mut self) {
        let (steps, rows) = (self.waiting, self.rows);
        let mut v = vec![0.0; steps * self.columns];
        for (j, v) in v.chunks_exact_mut(steps).enumerate() {
            self.start_column_multipliers(v, j);
            for &row in &self.cleared_rows {
                self.t[row + j * rows] = 0.0;
            }
        }
        self.flushes += 1;
        self.finish_multipliers(&mut v, self.columns);
        add_product(&mut self.t, &self.u[..rows * steps], &v, rows, self.columns, steps);
        self.forget();
    }
}

#[cfg(test)]
#[path = "updated_matrix_tests.rs"]
mod tests;
