//! Partial Cholesky factorization by supernodes: the first columns of a symmetric matrix eliminated, the others kept
//! as their Schur complement.
//!
//! ```text
//!     [ A   .  ]   [ L_A    ] [ L_Aᵀ  L_Cᵀ ]
//!     [ C   0  ] = [ L_C  1 ] [       −L_C L_Cᵀ ]        A = L_A L_Aᵀ,  C = L_C L_Aᵀ
//! ```
//! Left-looking (each supernode collects the updates of its descendants, then is factorized densely), in pieces
//! short enough to be stopped between them.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Accum, MatMut, MatRef, Par};

use super::error::MainSystemError;
use super::sparse::SymmetricSparse;
use super::watch::check_stop;
use crate::watch::Watch;

/// One thread: results do not depend on the machine's number of cores.
pub const PAR: Par = Par::Seq;

/// Columns of a supernode that are factorized at once, and of an update that is multiplied out at once: large
/// enough for the dense kernels, small enough to waste little of the triangle.
const PANEL: usize = 128;
/// Multiplications between two looks at the watcher; well below 0.1 s.
const PIECE: usize = 400_000_000;

const DOING: &str = "factorizing the main system";
const NONE: u32 = u32::MAX;

/// The factor, dense block by block: rows begin … end of the supernode, then the rows of its pattern.
#[derive(Debug)]
pub struct Supernodes {
    /// Columns that are eliminated; the others come last.
    eliminated: usize,
    /// First column of each supernode, and the order of the matrix.
    begin: Vec<u32>,
    /// Where the pattern of each supernode starts in `rows`.
    pattern_start: Vec<usize>,
    /// Rows below the supernodes, ascending.
    rows: Vec<u32>,
    /// Where the block of each supernode starts in `values`, column-major.
    value_start: Vec<usize>,
    values: Vec<f64>,
}

impl Supernodes {
    /// Structure only: first columns of the supernodes (and the order at the end) and the pattern of each.
    pub fn new<'a>(eliminated: usize, begin: Vec<u32>, pattern: impl Fn(usize) -> &'a [u32]) -> Supernodes {
        let count = begin.len() - 1;
        let (mut pattern_start, mut value_start) = (vec![0], vec![0]);
        let mut rows = Vec::with_capacity((0..count).map(|s| pattern(s).len()).sum());
        let mut values = 0;
        for s in 0..count {
            let width = (begin[s + 1] - begin[s]) as usize;
            rows.extend_from_slice(pattern(s));
            pattern_start.push(rows.len());
            values += width * (width + pattern(s).len());
            value_start.push(values);
        }
        Supernodes { eliminated, begin, pattern_start, rows, value_start, values: Vec::new() }
    }

    /// Entries stored.
    pub fn stored(&self) -> usize {
        self.value_start[self.count()]
    }

    fn count(&self) -> usize {
        self.begin.len() - 1
    }

    fn order(&self) -> usize {
        self.begin[self.count()] as usize
    }

    fn begin(&self, s: usize) -> usize {
        self.begin[s] as usize
    }

    fn width(&self, s: usize) -> usize {
        (self.begin[s + 1] - self.begin[s]) as usize
    }

    /// Columns of the supernode that are eliminated.
    fn active(&self, s: usize) -> usize {
        self.eliminated.saturating_sub(self.begin(s)).min(self.width(s))
    }

    fn pattern(&self, s: usize) -> &[u32] {
        &self.rows[self.pattern_start[s]..self.pattern_start[s + 1]]
    }

    fn block(&self, s: usize) -> MatRef<'_, f64> {
        let height = self.width(s) + self.pattern(s).len();
        let values = &self.values[self.value_start[s]..self.value_start[s + 1]];
        MatRef::from_column_major_slice(values, height, self.width(s))
    }

    /// Rows of the block below the eliminated columns, in the whole matrix; ascending.
    fn below(&self, s: usize) -> impl Iterator<Item = usize> + '_ {
        let begin = self.begin(s);
        (begin + self.active(s)..begin + self.width(s)).chain(self.pattern(s).iter().map(|&row| row as usize))
    }

    /// How many of the rows of [`Supernodes::below`] are less than `limit`.
    fn below_until(&self, s: usize, limit: usize) -> usize {
        let end = self.begin(s) + self.width(s);
        let own = end.min(limit).saturating_sub(self.begin(s) + self.active(s));
        let pattern = self.pattern(s);
        own + pattern.partition_point(|&row| (row as usize) < limit)
    }

    /// Factorizes A + `shift`·1 on the eliminated columns; `matrix` is in the order of the supernodes. False if a
    /// pivot was not positive.
    ///
    /// # Errors
    /// Out of memory; interrupted.
    pub fn factorize(
        &mut self,
        matrix: &SymmetricSparse,
        shift: f64,
        watch: &dyn Watch,
    ) -> Result<bool, MainSystemError> {
        let out_of_memory = || MainSystemError::OutOfMemory { doing: DOING };
        let length = self.stored();
        self.values.clear();
        self.values.try_reserve_exact(length).map_err(|_| out_of_memory())?;
        self.values.resize(length, 0.0);
        let request = cholesky_in_place_scratch::<f64>(PANEL, PAR, Default::default());
        let mut memory = MemBuffer::try_new(request).map_err(|_| out_of_memory())?;

        let count = self.count();
        let mut owner = vec![0_u32; self.order()];
        for s in 0..count {
            owner[self.begin(s)..self.begin(s + 1)].fill(s as u32);
        }
        let mut work = Work {
            owner,
            local: vec![0; self.order()],
            first: vec![NONE; count],
            next: vec![NONE; count],
            done: vec![0; count],
            buffer: Vec::new(),
            since: 0,
        };
        let cost = |s: usize| self.width(s) as f64 * (self.width(s) + self.pattern(s).len()).pow(2) as f64;
        let total: f64 = (0..count).map(cost).sum();
        let costs: Vec<f64> = (0..count).map(cost).collect();
        let (mut spent, mut told) = (0.0, 0.0);
        for (s, cost) in costs.iter().enumerate() {
            self.assemble(s, matrix, shift, &mut work);
            self.collect(s, &mut work, watch)?;
            if !self.eliminate(s, &mut memory, &mut work.since, watch)? {
                return Ok(false);
            }
            if self.active(s) > 0 {
                work.enlist(s, 0, self.pattern(s));
            }
            spent += cost;
            if spent >= told + 0.01 * total {
                told = spent;
                let done = self.begin(s + 1).min(self.eliminated);
                watch.progress(&format!("{DOING}, {done} of {} unknowns", self.eliminated), spent / total);
                check_stop(watch)?;
            }
        }
        Ok(true)
    }

    /// Writes the entries of the matrix into the block of `s`, and the local number of each of its rows.
    fn assemble(&mut self, s: usize, matrix: &SymmetricSparse, shift: f64, work: &mut Work) {
        let (begin, width) = (self.begin(s), self.width(s));
        let height = width + self.pattern(s).len();
        for i in 0..width {
            work.local[begin + i] = i as u32;
        }
        for (i, &row) in self.pattern(s).iter().enumerate() {
            work.local[row as usize] = (width + i) as u32;
        }
        let values = &mut self.values[self.value_start[s]..self.value_start[s + 1]];
        for column in 0..width {
            for (row, value) in matrix.column(begin + column) {
                values[work.local[row] as usize + column * height] += value;
            }
            if begin + column < self.eliminated {
                values[column + column * height] += shift;
            }
        }
    }

    /// Subtracts the products of all descendants that reach into the columns of `s`.
    fn collect(&mut self, s: usize, work: &mut Work, watch: &dyn Watch) -> Result<(), MainSystemError> {
        let end = self.begin(s + 1);
        let height = self.width(s) + self.pattern(s).len();
        let (before, own) = self.values.split_at_mut(self.value_start[s]);
        let mut descendant = work.first[s];
        while descendant != NONE {
            let d = descendant as usize;
            descendant = work.next[d];
            let pattern = &self.rows[self.pattern_start[d]..self.pattern_start[d + 1]];
            let width = (self.begin[d + 1] - self.begin[d]) as usize;
            let active = self.eliminated.saturating_sub(self.begin[d] as usize).min(width);
            let block = MatRef::from_column_major_slice(
                &before[self.value_start[d]..self.value_start[d + 1]],
                width + pattern.len(),
                width,
            );
            let from = work.done[d] as usize;
            let to = from + pattern[from..].partition_point(|&row| (row as usize) < end);
            let below = block.get(width.., ..active);
            let mut at = from;
            while at < to {
                let rows = pattern.len() - at;
                let strip = (PIECE / (rows * active)).clamp(8, PANEL).min(to - at);
                work.buffer.resize((rows * strip).max(work.buffer.len()), 0.0);
                let product = &mut work.buffer[..rows * strip];
                matmul(
                    MatMut::from_column_major_slice_mut(product, rows, strip),
                    Accum::Replace,
                    below.get(at.., ..),
                    below.get(at..at + strip, ..).transpose(),
                    1.0,
                    PAR,
                );
                for j in 0..strip {
                    let column = work.local[pattern[at + j] as usize] as usize * height;
                    let target = &mut own[column..column + height];
                    let rows = &pattern[at + j..];
                    for (row, value) in rows.iter().zip(&product[j * (pattern.len() - at) + j..]) {
                        target[work.local[*row as usize] as usize] -= value;
                    }
                }
                at += strip;
                work.since += rows * strip * active;
                if work.since > PIECE {
                    work.since = 0;
                    check_stop(watch)?;
                }
            }
            work.enlist(d, to, pattern);
        }
        Ok(())
    }

    /// Factorizes the eliminated columns of the block of `s` and takes their products off its other columns.
    fn eliminate(
        &mut self,
        s: usize,
        memory: &mut MemBuffer,
        since: &mut usize,
        watch: &dyn Watch,
    ) -> Result<bool, MainSystemError> {
        let (width, active) = (self.width(s), self.active(s));
        let height = width + self.pattern(s).len();
        let values = &mut self.values[self.value_start[s]..self.value_start[s + 1]];
        let mut block = MatMut::from_column_major_slice_mut(values, height, width);
        let mut at = 0;
        while at < active {
            let size = PANEL.min(active - at);
            let (panel, mut rest) = block.as_mut().get_mut(at.., at..).split_at_col_mut(size);
            let (mut top, mut bottom) = panel.split_at_row_mut(size);
            let factorized =
                cholesky_in_place(top.as_mut(), Default::default(), PAR, MemStack::new(memory), Default::default());
            if factorized.is_err() {
                return Ok(false);
            }
            solve_lower_triangular_in_place(top.as_ref(), bottom.as_mut().transpose_mut(), PAR);
            // The columns right of the panel, from their diagonal down.
            let columns = rest.ncols();
            let mut column = 0;
            while column < columns {
                let rows = bottom.nrows() - column;
                let strip = (PIECE / (rows * size)).clamp(8, PANEL).min(columns - column);
                matmul(
                    rest.as_mut().get_mut(size + column.., column..column + strip),
                    Accum::Add,
                    bottom.as_ref().get(column.., ..),
                    bottom.as_ref().get(column..column + strip, ..).transpose(),
                    -1.0,
                    PAR,
                );
                column += strip;
                *since += rows * strip * size;
                if *since > PIECE {
                    *since = 0;
                    check_stop(watch)?;
                }
            }
            at += size;
        }
        Ok(true)
    }

    /// Position and size of the smallest squared pivot of L_A.
    pub fn smallest_pivot(&self) -> (usize, f64) {
        let mut smallest = (0, f64::INFINITY);
        for s in 0..self.count() {
            let block = self.block(s);
            for j in 0..self.active(s) {
                let pivot = block[(j, j)].powi(2);
                if pivot < smallest.1 {
                    smallest = (self.begin(s) + j, pivot);
                }
            }
        }
        smallest
    }

    /// Calls `visit(i, j, value)` with the lower triangle of −L_C L_Cᵀ, numbered from 0.
    pub fn each_schur_entry(&self, mut visit: impl FnMut(usize, usize, f64)) {
        for s in (0..self.count()).filter(|&s| self.active(s) < self.width(s)) {
            let block = self.block(s);
            let active = self.active(s);
            let rows: Vec<usize> = self.below(s).map(|row| row - self.eliminated).collect();
            for j in active..self.width(s) {
                for i in j..block.nrows() {
                    visit(rows[i - active], rows[j - active], block[(i, j)]);
                }
            }
        }
    }

    /// x_A ← L_A⁻¹ x_A; if x has the rows of C too, x_C ← x_C − L_C x_A.
    pub fn forward(&self, mut x: MatMut<'_, f64>) {
        let (columns, limit) = (x.ncols(), x.nrows());
        let mut buffer = Vec::new();
        for s in 0..self.count() {
            let active = self.active(s);
            if active == 0 {
                break;
            }
            let block = self.block(s);
            let mut x_top = x.as_mut().subrows_mut(self.begin(s), active);
            solve_lower_triangular_in_place(block.get(..active, ..active), x_top.as_mut(), PAR);
            let rows = self.below_until(s, limit);
            if rows == 0 {
                continue;
            }
            buffer.resize(rows * columns, 0.0);
            let mut product = MatMut::from_column_major_slice_mut(&mut buffer, rows, columns);
            matmul(
                product.as_mut(),
                Accum::Replace,
                block.get(active..active + rows, ..active),
                x_top.as_ref(),
                1.0,
                PAR,
            );
            for j in 0..columns {
                for (i, row) in self.below(s).take(rows).enumerate() {
                    x[(row, j)] -= product[(i, j)];
                }
            }
        }
    }

    /// x_A ← L_A⁻ᵀ x_A.
    pub fn backward(&self, mut x: MatMut<'_, f64>) {
        let columns = x.ncols();
        let mut buffer = Vec::new();
        for s in (0..self.count()).rev().filter(|&s| self.active(s) > 0) {
            let active = self.active(s);
            let block = self.block(s);
            let rows = self.below_until(s, self.eliminated);
            buffer.resize(rows * columns, 0.0);
            for j in 0..columns {
                for (i, row) in self.below(s).take(rows).enumerate() {
                    buffer[j * rows + i] = x[(row, j)];
                }
            }
            let below = MatRef::from_column_major_slice(&buffer, rows, columns);
            let mut x_top = x.as_mut().subrows_mut(self.begin(s), active);
            if rows > 0 {
                matmul(
                    x_top.as_mut(),
                    Accum::Add,
                    block.get(active..active + rows, ..active).transpose(),
                    below,
                    -1.0,
                    PAR,
                );
            }
            let top = block.get(..active, ..active);
            solve_upper_triangular_in_place(top.transpose(), x_top.as_mut(), PAR);
        }
    }
}

/// What the factorization keeps beside the factor.
struct Work {
    /// Supernode of each column.
    owner: Vec<u32>,
    /// Number of a row in the block at hand.
    local: Vec<u32>,
    /// First and next supernode of the lists: who reaches next into the columns of whom.
    first: Vec<u32>,
    next: Vec<u32>,
    /// Rows of each pattern that are dealt with.
    done: Vec<u32>,
    buffer: Vec<f64>,
    /// Multiplications since the last look at the watcher.
    since: usize,
}

impl Work {
    /// Puts `d` on the list of the supernode that holds its next row.
    fn enlist(&mut self, d: usize, done: usize, pattern: &[u32]) {
        self.done[d] = done as u32;
        if let Some(&row) = pattern.get(done) {
            let s = self.owner[row as usize] as usize;
            self.next[d] = self.first[s];
            self.first[s] = d as u32;
        }
    }
}
