//! Elimination steps that wait: the steps' columns U are kept, their multipliers V are found only when somebody asks
//! for a column (method §5).
//!
//! A step clears a row or a column of A or both and then adds u vᵀ. v is a combination of a few rows of A as they
//! stood before the step; so the multiplier of step k in column j follows from the entries of T in those rows and
//! from the multipliers of the steps before it, a triangular recurrence as long as the number of waiting steps.
//! No row of T is read until a column, or a block of columns, takes the steps over.

use stickslip_numerics::products::{add_product, add_response, solve_unit_lower};

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
pub(super) struct WaitingSteps {
    rows: usize,
    /// Most steps.
    limit: usize,
    /// Whether a step cleared the row: what T holds in it counts as zero.
    cleared: Vec<bool>,
    cleared_rows: Vec<usize>,
    /// Columns of the steps, with zeros where a later step cleared the row.
    u: Vec<f64>,
    /// Rows of T that the multiplier of each step combines: (step, row, factor), steps ascending.
    from_rows: Vec<(usize, usize, f64)>,
    /// Unit rows in it: (step, column, factor).
    from_units: Vec<(usize, usize, f64)>,
    /// What step i gives to the multiplier of step k > i: entry k + limit · i.
    from_steps: Vec<f64>,
    count: usize,
}

impl WaitingSteps {
    pub(super) fn new(rows: usize, limit: usize) -> WaitingSteps {
        WaitingSteps {
            rows,
            limit,
            cleared: vec![false; rows],
            cleared_rows: Vec::new(),
            u: vec![0.0; rows * limit],
            from_rows: Vec::new(),
            from_units: Vec::new(),
            from_steps: vec![0.0; limit * limit],
            count: 0,
        }
    }

    pub(super) fn is_full(&self) -> bool {
        self.count == self.limit
    }

    /// What the multipliers for A x take from T x and x themselves.
    fn start_multipliers(&self, v: &mut [f64], stored: &[f64], x: impl Fn(usize) -> f64) {
        for &(step, row, factor) in &self.from_rows {
            v[step] += factor * stored[row];
        }
        for &(step, column, factor) in &self.from_units {
            v[step] += factor * x(column);
        }
    }

    /// Adds to the multipliers of many columns what each step gives to those after it.
    fn finish_multipliers(&self, v: &mut [f64], columns: usize) {
        let steps = self.count;
        let mut lower = vec![0.0; steps * steps];
        for i in 0..steps {
            lower[i + steps * i] = 1.0;
            for k in i + 1..steps {
                lower[k + steps * i] = -self.from_steps[k + self.limit * i];
            }
        }
        solve_unit_lower(&lower, v, steps, columns);
    }

    /// Multipliers for A x, given T x and x.
    fn multipliers(&self, stored: &[f64], x: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut v = vec![0.0; self.count];
        self.start_multipliers(&mut v, stored, x);
        for i in 0..self.count {
            let known = v[i];
            if known != 0.0 {
                let further = &self.from_steps[self.limit * i..self.limit * i + self.count];
                for (v, factor) in v[i + 1..].iter_mut().zip(&further[i + 1..]) {
                    *v += factor * known;
                }
            }
        }
        v
    }

    /// T x in `into` becomes A x.
    pub(super) fn apply(&self, into: &mut [f64], x: impl Fn(usize) -> f64) {
        if self.count == 0 {
            return;
        }
        let multipliers = self.multipliers(into, x);
        for &row in &self.cleared_rows {
            into[row] = 0.0;
        }
        add_response(into, &self.u[..self.rows * self.count], &multipliers);
    }

    /// Multipliers of some columns of T, one column of multipliers each.
    fn column_multipliers<'a>(&self, columns: impl ExactSizeIterator<Item = (usize, &'a [f64])>) -> Vec<f64> {
        let many = columns.len();
        let mut v = vec![0.0; self.count * many];
        for ((j, stored), v) in columns.zip(v.chunks_exact_mut(self.count.max(1))) {
            self.start_multipliers(v, stored, |column| f64::from(column == j));
        }
        self.finish_multipliers(&mut v, many);
        v
    }

    /// Columns of T from number `first` on in `block` become those of A.
    pub(super) fn apply_to_block(&self, block: &mut [f64], first: usize) {
        let rows = self.rows.max(1);
        let columns = block.len() / rows;
        let v = self.column_multipliers((first..first + columns).zip(block.chunks_exact(rows)));
        for column in block.chunks_exact_mut(rows) {
            for &row in &self.cleared_rows {
                column[row] = 0.0;
            }
        }
        add_product(block, &self.u[..self.rows * self.count], &v, self.rows, columns, self.count);
    }

    /// The entries of A in the given rows, column by column, of columns of T with their numbers.
    pub(super) fn entries<'a>(
        &self,
        rows: &[usize],
        columns: impl ExactSizeIterator<Item = (usize, &'a [f64])> + Clone,
    ) -> Vec<f64> {
        let (height, width) = (rows.len(), columns.len());
        let v = self.column_multipliers(columns.clone());
        let mut entries = Vec::with_capacity(height * width);
        for (_, stored) in columns {
            entries.extend(rows.iter().map(|&row| if self.cleared[row] { 0.0 } else { stored[row] }));
        }
        let mut u = Vec::with_capacity(height * self.count);
        for step in self.u.chunks_exact(self.rows.max(1)).take(self.count) {
            u.extend(rows.iter().map(|&row| step[row]));
        }
        add_product(&mut entries, &u, &v, height, width, self.count);
        entries
    }

    /// Multipliers of column j of T, of which entries will be read one by one.
    pub(super) fn multipliers_of(&self, j: usize, stored: &[f64]) -> Vec<f64> {
        self.multipliers(stored, |column| f64::from(column == j))
    }

    /// Entry of A in the given row of a column of T with these multipliers.
    pub(super) fn entry(&self, row: usize, stored: &[f64], multipliers: &[f64]) -> f64 {
        let kept = if self.cleared[row] { 0.0 } else { stored[row] };
        kept + self.u[row..].iter().step_by(self.rows).zip(multipliers).map(|(u, v)| u * v).sum::<f64>()
    }

    /// Column c of A becomes `factor` · u of the step at hand and nothing else.
    pub(super) fn take_column(&mut self, c: usize, factor: f64) {
        self.from_units.retain(|&(_, column, _)| column != c);
        self.from_units.push((self.count, c, factor));
    }

    /// Column j of A is multiplied by `by`, as that of T was.
    pub(super) fn scale_column(&mut self, j: usize, by: f64) {
        for (_, column, factor) in &mut self.from_units {
            if *column == j {
                *factor *= by;
            }
        }
    }

    /// Notes how the multiplier of a new step comes about, and returns the room for its u, zero so far.
    pub(super) fn next_step(&mut self, combination: &Combination) -> &mut [f64] {
        let step = self.count;
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
    pub(super) fn clear_row(&mut self, row: usize) {
        for i in 0..self.count {
            self.u[row + i * self.rows] = 0.0;
        }
        self.u[row + self.count * self.rows] = 1.0;
        if !std::mem::replace(&mut self.cleared[row], true) {
            self.cleared_rows.push(row);
        }
    }

    /// The step at hand is complete.
    pub(super) fn end_step(&mut self) {
        self.count += 1;
    }
}
