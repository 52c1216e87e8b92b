//! A matrix under elimination steps that wait: A = T + U V, column block by column block (method §5).
//!
//! Steps are collected in batches ([`super::waiting_steps`]). A full batch is multiplied out only in the blocks of
//! columns that somebody reads, and kept for the others: most columns of a contact problem lie far from where the
//! contact changes and are never asked for.

use std::sync::Arc;

use super::waiting_steps::{Combination, WaitingSteps};
use stickslip_numerics::products::add_columns;

/// Columns that take batches over together: enough for products to run at full speed, and few enough to lie close to
/// the one that was asked for. Measured from 8 to 64 at 1000 pairs.
const BLOCK: usize = 64;

/// Steps that are kept, per column of the matrix; beyond that all blocks take them over. They take twice the room of
/// the matrix.
const KEPT: usize = 2;

/// See the module.
#[derive(Clone, Debug)]
pub(crate) struct UpdatedMatrix {
    rows: usize,
    columns: usize,
    /// Most steps of a batch.
    limit: usize,
    /// T, column-major.
    t: Vec<f64>,
    /// Full batches, oldest first.
    full: Vec<Arc<WaitingSteps>>,
    /// How many of them each block of columns has taken over.
    taken: Vec<usize>,
    /// The batch that is being collected.
    open: WaitingSteps,
    /// Number of batches filled so far.
    filled: usize,
}

/// A column of which entries are read one by one.
pub(super) enum ColumnReader<'a> {
    /// All of it.
    Whole(Vec<f64>),
    /// What it was before the waiting steps, and their multipliers.
    Waiting { steps: &'a WaitingSteps, stored: &'a [f64], multipliers: Vec<f64> },
}

impl ColumnReader<'_> {
    /// The entry in a row.
    pub(super) fn entry(&self, row: usize) -> f64 {
        match self {
            ColumnReader::Whole(column) => column[row],
            ColumnReader::Waiting { steps, stored, multipliers } => steps.entry(row, stored, multipliers),
        }
    }
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
            full: Vec::new(),
            taken: vec![0; columns.div_ceil(BLOCK)],
            open: WaitingSteps::new(rows, limit),
            filled: 0,
        }
    }

    /// Replaces all entries; nothing waits any more.
    pub(crate) fn replace(&mut self, entries: Vec<f64>) {
        debug_assert_eq!(entries.len(), self.t.len());
        self.t = entries;
        self.open = WaitingSteps::new(self.rows, self.limit);
        self.forget();
    }

    /// How many batches of steps were filled.
    pub(crate) fn filled(&self) -> usize {
        self.filled
    }

    fn stored(&self, j: usize) -> &[f64] {
        &self.t[j * self.rows..(j + 1) * self.rows]
    }

    /// Full batches that column j has taken over.
    fn taken(&self, j: usize) -> usize {
        self.taken[j / BLOCK]
    }

    /// Block number `block` takes over all full batches.
    fn settle_block(&mut self, block: usize) {
        let first = block * BLOCK;
        let end = (first + BLOCK).min(self.columns);
        let columns = &mut self.t[first * self.rows..end * self.rows];
        for steps in &self.full[self.taken[block]..] {
            steps.apply_to_block(columns, first);
        }
        self.taken[block] = self.full.len();
    }

    /// Columns that will be read one by one take over the full batches, which is cheaper for all of them at once.
    pub(crate) fn settle(&mut self, columns: impl Iterator<Item = usize>) {
        for j in columns {
            self.settle_block(j / BLOCK);
        }
    }

    /// Column j.
    pub(crate) fn column(&mut self, j: usize, into: &mut Vec<f64>) {
        self.settle_block(j / BLOCK);
        into.clear();
        into.extend_from_slice(self.stored(j));
        self.open.apply(into, |column| f64::from(column == j));
    }

    /// The entries in the given rows and columns, column-major.
    pub(crate) fn block(&mut self, rows: &[usize], columns: &[usize]) -> Vec<f64> {
        self.settle(columns.iter().copied());
        self.open.entries(rows, columns.iter().map(|&j| (j, self.stored(j))))
    }

    /// Column j, of which some entries will be read; quick where it is settled.
    pub(super) fn reader(&self, j: usize) -> ColumnReader<'_> {
        if self.taken(j) < self.full.len() {
            return ColumnReader::Whole(self.combined(&[(j, 1.0)]));
        }
        let stored = self.stored(j);
        ColumnReader::Waiting { steps: &self.open, stored, multipliers: self.open.multipliers_of(j, stored) }
    }

    /// Σ x_j · column j over the given (j, x_j).
    pub(crate) fn combined(&self, terms: &[(usize, f64)]) -> Vec<f64> {
        let mut sum = vec![0.0; self.rows];
        let mut x = vec![0.0; self.columns];
        let oldest = terms.iter().map(|term| self.taken(term.0)).min().unwrap_or(self.full.len());
        for batch in oldest..=self.full.len() {
            // A column joins at the first batch that it has not taken over.
            let joining = || terms.iter().filter(|term| self.taken(term.0) == batch);
            let columns: Vec<_> = joining().map(|&(j, factor)| (self.stored(j), factor)).collect();
            add_columns(&mut sum, &columns);
            for &(j, factor) in joining() {
                x[j] += factor;
            }
            let steps = self.full.get(batch).map_or(&self.open, |steps| &**steps);
            steps.apply(&mut sum, |column| x[column]);
        }
        sum
    }

    /// Row `row` becomes the combination.
    pub(crate) fn replace_row(&mut self, row: usize, combination: &Combination) {
        self.open.next_step(combination);
        self.open.clear_row(row);
        self.end_step();
    }

    /// Adds `u` times the combination to all other columns, after clearing column `c`, which becomes `factor` · u;
    /// with `row`: clears this row first, and u counts as 1 in it. u stands for column c, whatever it held.
    pub(crate) fn exchange(&mut self, row: Option<usize>, c: usize, u: &[f64], combination: &Combination, factor: f64) {
        self.settle_block(c / BLOCK);
        self.open.next_step(combination).copy_from_slice(u);
        self.t[c * self.rows..(c + 1) * self.rows].fill(0.0);
        self.open.take_column(c, factor);
        if let Some(row) = row {
            self.open.clear_row(row);
        }
        self.end_step();
    }

    /// Multiplies column j by `by`.
    pub(crate) fn scale_column(&mut self, j: usize, by: f64) {
        self.settle_block(j / BLOCK);
        for entry in &mut self.t[j * self.rows..(j + 1) * self.rows] {
            *entry *= by;
        }
        self.open.scale_column(j, by);
    }

    fn end_step(&mut self) {
        self.open.end_step();
        if self.open.is_full() {
            let full = std::mem::replace(&mut self.open, WaitingSteps::new(self.rows, self.limit));
            self.full.push(Arc::new(full));
            self.filled += 1;
        }
        if self.full.len() * self.limit >= KEPT * self.columns {
            for block in 0..self.taken.len() {
                self.settle_block(block);
            }
            self.forget();
        }
    }

    /// No block waits for a full batch any more.
    fn forget(&mut self) {
        self.full.clear();
        self.taken.fill(0);
    }
}

#[cfg(test)]
#[path = "updated_matrix_tests.rs"]
mod tests;
