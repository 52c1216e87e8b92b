//! Partial Cholesky factorization by supernodes: the first columns of a symmetric matrix eliminated, the others kept
//! as their Schur complement.
//!
//! ```text
//!     [ A   .  ]   [ L_A    ] [ L_Aᵀ  L_Cᵀ ]
//!     [ C   0  ] = [ L_C  1 ] [       −L_C L_Cᵀ ]        A = L_A L_Aᵀ,  C = L_C L_Aᵀ
//! ```
//! Structure and solutions; the numbers of the factor are found in [`numeric`].

use rayon::iter::IndexedParallelIterator;

use crate::analysis::SupernodePatterns;
use crate::blocks::{Accum, MatMut, MatRef, multiply, solve_lower, solve_upper};
use crate::watch::Watch;

mod numeric;

/// What a factorization is called in progress and refusals.
pub const DOING: &str = "factorizing the main system";

/// Why there is no factor.
#[derive(Debug)]
pub enum FactorError {
    /// Memory is short.
    OutOfMemory,
    /// The watcher said to stop.
    Interrupted,
}

/// Fewer entries than this are not worth a second thread to fill them with zeros.
const LARGE: usize = 1 << 20;

/// The lower triangle of a symmetric matrix by columns, as terms that are summed; in any order.
pub struct Terms {
    start: Vec<usize>,
    /// (row, value).
    terms: Vec<(u32, f64)>,
}

impl Terms {
    /// `each` visits all terms (row, column, value), row ≥ column; it is called twice.
    pub fn new(order: usize, each: impl Fn(&mut dyn FnMut(usize, usize, f64))) -> Terms {
        let mut start = vec![0; order + 1];
        each(&mut |_, column, _| start[column + 1] += 1);
        for column in 0..order {
            start[column + 1] += start[column];
        }
        let mut next = start.clone();
        let mut terms = vec![(0, 0.0); start[order]];
        each(&mut |row, column, value| {
            terms[next[column]] = (row as u32, value);
            next[column] += 1;
        });
        Terms { start, terms }
    }

    fn column(&self, column: usize) -> &[(u32, f64)] {
        &self.terms[self.start[column]..self.start[column + 1]]
    }
}

/// Which columns make a supernode, and which rows its block has: those of its columns, then those of its pattern.
#[derive(Debug)]
struct Shape {
    /// Columns that are eliminated; the others come last.
    eliminated: usize,
    /// First column of each supernode, and the order of the matrix.
    begin: Vec<u32>,
    /// Where the pattern of each supernode starts in `rows`.
    pattern_start: Vec<usize>,
    /// Rows below the supernodes, ascending.
    rows: Vec<u32>,
    /// Where the block of each supernode starts in the values, column-major.
    value_start: Vec<usize>,
}

impl Shape {
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

    /// Rows of the block.
    fn height(&self, s: usize) -> usize {
        self.width(s) + self.pattern(s).len()
    }

    /// Columns of the supernode that are eliminated.
    fn active(&self, s: usize) -> usize {
        self.eliminated.saturating_sub(self.begin(s)).min(self.width(s))
    }

    fn pattern(&self, s: usize) -> &[u32] {
        &self.rows[self.pattern_start[s]..self.pattern_start[s + 1]]
    }

    /// Rows of the block below the eliminated columns, in the whole matrix; ascending.
    fn below(&self, s: usize) -> impl Iterator<Item = usize> + '_ {
        let begin = self.begin(s);
        (begin + self.active(s)..begin + self.width(s)).chain(self.pattern(s).iter().map(|&row| row as usize))
    }

    /// How many of the rows of [`Shape::below`] are less than `limit`.
    fn below_until(&self, s: usize, limit: usize) -> usize {
        let end = self.begin(s) + self.width(s);
        let own = end.min(limit).saturating_sub(self.begin(s) + self.active(s));
        let pattern = self.pattern(s);
        own + pattern.partition_point(|&row| (row as usize) < limit)
    }
}

/// The factor, dense block by block.
#[derive(Debug)]
pub struct Supernodes {
    shape: Shape,
    values: Vec<f64>,
}

impl Supernodes {
    /// Structure only: first columns of the supernodes (and the order at the end) and the pattern of each.
    pub fn new(eliminated: usize, patterns: SupernodePatterns) -> Supernodes {
        let SupernodePatterns { begin, pattern_start, rows } = patterns;
        let mut value_start = vec![0];
        let mut values = 0;
        for (columns, pattern) in begin.windows(2).zip(pattern_start.windows(2)) {
            let width = (columns[1] - columns[0]) as usize;
            values += width * (width + pattern[1] - pattern[0]);
            value_start.push(values);
        }
        let shape = Shape { eliminated, begin, pattern_start, rows, value_start };
        Supernodes { shape, values: Vec::new() }
    }

    /// Entries stored.
    pub fn stored(&self) -> usize {
        self.shape.value_start[self.shape.count()]
    }

    fn block(&self, s: usize) -> MatRef<'_, f64> {
        let values = &self.values[self.shape.value_start[s]..self.shape.value_start[s + 1]];
        MatRef::from_column_major_slice(values, self.shape.height(s), self.shape.width(s))
    }

    /// Factorizes A + `shift`·1 on the eliminated columns; `matrix` is in the order of the supernodes. False if a
    /// pivot was not positive. Large ones are spread over threads if `can_spread` says so.
    ///
    /// # Errors
    /// Out of memory; interrupted.
    pub fn factorize(
        &mut self,
        matrix: &Terms,
        shift: f64,
        can_spread: fn() -> bool,
        watch: &dyn Watch,
    ) -> Result<bool, FactorError> {
        let length = self.stored();
        self.values.clear();
        self.values.try_reserve_exact(length).map_err(|_| FactorError::OutOfMemory)?;
        if length > LARGE && can_spread() {
            // The first touch of so many pages takes its time.
            rayon::iter::repeat_n(0.0, length).collect_into_vec(&mut self.values);
        } else {
            self.values.resize(length, 0.0);
        }
        numeric::factorize(&self.shape, &mut self.values, matrix, shift, can_spread, watch)
    }

    /// Position and size of the smallest squared pivot of L_A.
    pub fn smallest_pivot(&self) -> (usize, f64) {
        let mut smallest = (0, f64::INFINITY);
        for s in 0..self.shape.count() {
            let block = self.block(s);
            for j in 0..self.shape.active(s) {
                let pivot = block[(j, j)].powi(2);
                if pivot < smallest.1 {
                    smallest = (self.shape.begin(s) + j, pivot);
                }
            }
        }
        smallest
    }

    /// Calls `visit(i, j, value)` with the lower triangle of −L_C L_Cᵀ, numbered from 0.
    pub fn each_schur_entry(&self, mut visit: impl FnMut(usize, usize, f64)) {
        for s in (0..self.shape.count()).filter(|&s| self.shape.active(s) < self.shape.width(s)) {
            let block = self.block(s);
            let active = self.shape.active(s);
            let rows: Vec<usize> = self.shape.below(s).map(|row| row - self.shape.eliminated).collect();
            for j in active..self.shape.width(s) {
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
        for s in 0..self.shape.count() {
            let active = self.shape.active(s);
            if active == 0 {
                break;
            }
            let block = self.block(s);
            let mut x_top = x.as_mut().subrows_mut(self.shape.begin(s), active);
            solve_lower(block.get(..active, ..active), x_top.as_mut());
            let rows = self.shape.below_until(s, limit);
            if rows == 0 {
                continue;
            }
            buffer.resize(rows * columns, 0.0);
            let mut product = MatMut::from_column_major_slice_mut(&mut buffer, rows, columns);
            multiply(product.as_mut(), Accum::Replace, block.get(active..active + rows, ..active), x_top.as_ref(), 1.0);
            for j in 0..columns {
                for (i, row) in self.shape.below(s).take(rows).enumerate() {
                    x[(row, j)] -= product[(i, j)];
                }
            }
        }
    }

    /// x_A ← L_A⁻ᵀ x_A.
    pub fn backward(&self, mut x: MatMut<'_, f64>) {
        let columns = x.ncols();
        let mut buffer = Vec::new();
        for s in (0..self.shape.count()).rev().filter(|&s| self.shape.active(s) > 0) {
            let active = self.shape.active(s);
            let block = self.block(s);
            let rows = self.shape.below_until(s, self.shape.eliminated);
            buffer.resize(rows * columns, 0.0);
            for j in 0..columns {
                for (i, row) in self.shape.below(s).take(rows).enumerate() {
                    buffer[j * rows + i] = x[(row, j)];
                }
            }
            let below = MatRef::from_column_major_slice(&buffer, rows, columns);
            let mut x_top = x.as_mut().subrows_mut(self.shape.begin(s), active);
            if rows > 0 {
                multiply(
                    x_top.as_mut(),
                    Accum::Add,
                    block.get(active..active + rows, ..active).transpose(),
                    below,
                    -1.0,
                );
            }
            let top = block.get(..active, ..active);
            solve_upper(top.transpose(), x_top.as_mut());
        }
    }
}
