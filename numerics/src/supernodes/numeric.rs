//! The numbers of the factor, left-looking: each supernode collects the products of its descendants, then is factorized
//! densely, in pieces short enough to be stopped between them.
//!
//! The elimination tree is cut into *branches*, whole subtrees that lie in one stretch of supernodes, and the *crown*
//! above them. No branch needs another: they are factorized side by side, each on one thread. The crown follows
//! supernode by supernode, each cut into strips of columns that are worked on side by side. The cuts depend on the
//! structure alone, and each sum is formed in one order, so that the factor is the same on any number of threads.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::{DOING, FactorError, Shape, Terms};
use crate::blocks::{Accum, BlockCholesky, MatMut, MatRef, multiply, solve_lower};
use crate::watch::Watch;

/// Columns of a supernode that are factorized at once, and of an update that is multiplied out at once: large
/// enough for the dense kernels, small enough to waste little of the triangle.
const PANEL: usize = 128;
/// Multiplications between two looks at the watcher; well below 0.1 s.
const PIECE: usize = 400_000_000;
/// Columns of a supernode of the crown that collect their updates on one thread.
const STRIP: usize = 128;
/// Rows below a panel of the crown that are solved for on one thread.
const ROWS: usize = 512;
/// A branch has at most this share of the whole work: enough of them to keep some cores busy to the end.
const BRANCHES: f64 = 64.0;
/// Multiplications that are not worth a second thread.
const SMALL: f64 = 1e7;

const NONE: u32 = u32::MAX;

/// Interrupted, if the watcher says so.
fn check_stop(watch: &dyn Watch) -> Result<(), FactorError> {
    if watch.stop() { Err(FactorError::Interrupted) } else { Ok(()) }
}

/// Why a factorization ends early.
enum Halt {
    /// A pivot is not positive.
    Pivot,
    Error(FactorError),
}

impl From<FactorError> for Halt {
    fn from(error: FactorError) -> Halt {
        Halt::Error(error)
    }
}

/// Writes L, L_C and −L_C L_Cᵀ of A + `shift`·1 into `values`, which are zero; false if a pivot was not positive.
///
/// # Errors
/// Out of memory; interrupted.
pub(super) fn factorize(
    shape: &Shape,
    values: &mut [f64],
    matrix: &Terms,
    shift: f64,
    can_spread: fn() -> bool,
    watch: &dyn Watch,
) -> Result<bool, FactorError> {
    let count = shape.count();
    let mut owner = vec![0_u32; shape.order()];
    for s in 0..count {
        owner[shape.begin(s)..shape.begin(s + 1)].fill(s as u32);
    }
    let costs: Vec<f64> = (0..count).map(|s| shape.active(s) as f64 * (shape.height(s) as f64).powi(2)).collect();
    let branches = branches(shape, &owner, &costs);
    let progress = Progress { total: costs.iter().sum(), state: Mutex::default(), watch };
    let is_spread = progress.total >= SMALL && can_spread();
    let work = Work { shape, matrix, shift, owner, costs, is_spread, progress };
    let mut links = vec![Link { first: NONE, next: NONE, done: 0 }; count];
    let done = work.branches(&branches, values, &mut links).and_then(|()| work.crown(&branches, values, &mut links));
    match done {
        Ok(()) => Ok(true),
        Err(Halt::Pivot) => Ok(false),
        Err(Halt::Error(error)) => Err(error),
    }
}

/// Stretches of supernodes that are whole subtrees, none with more than its share of the work; ascending.
fn branches(shape: &Shape, owner: &[u32], costs: &[f64]) -> Vec<Range<usize>> {
    let count = shape.count();
    // Of each supernode: the first of its subtree, how many there are in it, and their work.
    let mut first: Vec<usize> = (0..count).collect();
    let mut members = vec![1; count];
    let mut work = costs.to_vec();
    for s in 0..count {
        if let Some(&row) = shape.pattern(s).first() {
            let parent = owner[row as usize] as usize;
            first[parent] = first[parent].min(first[s]);
            members[parent] += members[s];
            work[parent] += work[s];
        }
    }
    let total: f64 = costs.iter().sum();
    let limit = if total < SMALL { f64::INFINITY } else { total / BRANCHES };
    let mut branches: Vec<Range<usize>> = Vec::new();
    let (mut end, mut filled) = (count, 0.0);
    // The largest subtrees that are small enough, from the last on; neighbours go together while they are.
    while end > 0 {
        let root = end - 1;
        let is_stretch = first[root] + members[root] == end;
        if !is_stretch || work[root] > limit {
            end = root;
            continue;
        }
        match branches.last_mut() {
            Some(last) if last.start == end && filled + work[root] <= limit => {
                last.start = first[root];
                filled += work[root];
            }
            _ => {
                branches.push(first[root]..end);
                filled = work[root];
            }
        }
        end = first[root];
    }
    branches.reverse();
    branches
}

/// What has been done, for the watcher.
struct Progress<'a> {
    total: f64,
    /// Work and columns done, and the work last reported.
    state: Mutex<(f64, usize, f64)>,
    watch: &'a dyn Watch,
}

impl Progress<'_> {
    fn add(&self, cost: f64, columns: usize, all: usize) -> Result<(), FactorError> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.0 += cost;
        state.1 += columns;
        if state.0 < state.2 + 0.01 * self.total {
            return Ok(());
        }
        state.2 = state.0;
        // Under the lock: no thread reports progress after another was stopped.
        check_stop(self.watch)?;
        self.watch.progress(&format!("{DOING}, {} of {all} unknowns", state.1), (state.0 / self.total).min(1.0));
        check_stop(self.watch)
    }
}

/// Who reaches next into the columns of whom.
#[derive(Clone, Copy)]
struct Link {
    /// First supernode that reaches into the columns of this one.
    first: u32,
    /// The one after this in the list that this stands in.
    next: u32,
    /// Rows of the pattern that are dealt with.
    done: u32,
}

/// Some supernodes side by side.
struct Stretch<'a> {
    supernodes: Range<usize>,
    values: &'a mut [f64],
    links: &'a mut [Link],
}

/// Rows of the pattern of a descendant that are columns of the supernode at hand.
struct Update {
    descendant: usize,
    rows: Range<usize>,
}

/// What a thread keeps besides the factor.
struct Scratch {
    /// Number of a row in the block at hand.
    local: Vec<u32>,
    updates: Vec<Update>,
    product: Product,
    dense: BlockCholesky,
}

/// Room for a product, and the multiplications since the last look at the watcher.
#[derive(Default)]
struct Product {
    buffer: Vec<f64>,
    since: usize,
}

struct Work<'a> {
    shape: &'a Shape,
    matrix: &'a Terms,
    shift: f64,
    /// Supernode of each column.
    owner: Vec<u32>,
    costs: Vec<f64>,
    /// Whether there are threads for it.
    is_spread: bool,
    progress: Progress<'a>,
}

impl Work<'_> {
    fn scratch(&self) -> Result<Scratch, FactorError> {
        let dense = BlockCholesky::new(PANEL).ok_or(FactorError::OutOfMemory)?;
        let local = vec![0; self.shape.order()];
        Ok(Scratch { local, updates: Vec::new(), product: Product::default(), dense })
    }

    /// Factorizes the branches, each on one thread.
    fn branches(&self, branches: &[Range<usize>], values: &mut [f64], links: &mut [Link]) -> Result<(), Halt> {
        let start = &self.shape.value_start;
        let mut stretches = Vec::with_capacity(branches.len());
        let (mut values, mut links, mut at) = (values, links, 0);
        for branch in branches {
            let of_branch = values.split_at_mut(start[branch.end] - start[at]);
            let link = links.split_at_mut(branch.end - at);
            stretches.push(Stretch {
                supernodes: branch.clone(),
                values: &mut of_branch.0[start[branch.start] - start[at]..],
                links: &mut link.0[branch.start - at..],
            });
            (values, links, at) = (of_branch.1, link.1, branch.end);
        }
        let factorize = |mut branch: Stretch| {
            let mut scratch = self.scratch()?;
            branch.supernodes.clone().try_for_each(|s| self.supernode(s, &mut branch, &mut scratch, false))
        };
        if self.is_spread && stretches.len() > 1 {
            stretches.into_par_iter().try_for_each(factorize)
        } else {
            stretches.into_iter().try_for_each(factorize)
        }
    }

    /// Factorizes the supernodes above the branches one by one, each on all threads.
    fn crown(&self, branches: &[Range<usize>], values: &mut [f64], links: &mut [Link]) -> Result<(), Halt> {
        let mut all = Stretch { supernodes: 0..self.shape.count(), values, links };
        branches.iter().cloned().flatten().for_each(|d| self.enlist(d, &mut all));
        let mut scratch = self.scratch()?;
        let mut at = 0;
        let end = self.shape.count();
        for branch in branches.iter().chain([&(end..end)]) {
            (at..branch.start).try_for_each(|s| self.supernode(s, &mut all, &mut scratch, true))?;
            at = branch.end;
        }
        Ok(())
    }

    /// Factorizes one supernode; `in_strips`: with all threads there are.
    fn supernode(&self, s: usize, stretch: &mut Stretch, scratch: &mut Scratch, in_strips: bool) -> Result<(), Halt> {
        let shape = self.shape;
        self.take_updates(s, stretch, &mut scratch.updates);
        let start = shape.value_start[stretch.supernodes.start];
        let (before, own) = stretch.values.split_at_mut(shape.value_start[s] - start);
        let own = &mut own[..shape.height(s) * shape.width(s)];
        self.assemble(s, own, &mut scratch.local);
        let target = Target { s, local: &scratch.local, updates: &scratch.updates, before, start };
        let columns = if in_strips { STRIP } else { shape.width(s) };
        self.each_strip(
            own,
            columns * shape.height(s),
            in_strips,
            &mut scratch.product,
            |product, (strip, values)| self.collect(&target, strip * columns, values, product),
        )?;
        self.eliminate(s, own, scratch, in_strips)?;
        self.enlist(s, stretch);
        self.progress.add(self.costs[s], shape.active(s), shape.eliminated)?;
        Ok(())
    }

    /// `work` on strips of `size` values each, side by side if `spread` and there are threads.
    fn each_strip(
        &self,
        values: &mut [f64],
        size: usize,
        spread: bool,
        product: &mut Product,
        work: impl Fn(&mut Product, (usize, &mut [f64])) -> Result<(), Halt> + Send + Sync,
    ) -> Result<(), Halt> {
        if spread && self.is_spread && values.len() > size {
            values.par_chunks_mut(size).enumerate().try_for_each_init(Product::default, work)
        } else {
            values.chunks_mut(size).enumerate().try_for_each(|strip| work(product, strip))
        }
    }

    /// Puts `d` on the list of the supernode that holds its next row, if that belongs to the stretch.
    fn enlist(&self, d: usize, stretch: &mut Stretch) {
        let from = stretch.supernodes.start;
        let done = stretch.links[d - from].done as usize;
        if self.shape.active(d) == 0 {
            return;
        }
        if let Some(&row) = self.shape.pattern(d).get(done) {
            let s = self.owner[row as usize] as usize;
            if s < stretch.supernodes.end {
                stretch.links[d - from].next = stretch.links[s - from].first;
                stretch.links[s - from].first = d as u32;
            }
        }
    }

    /// All descendants that reach into the columns of `s`; they go on to the lists that they stand in next.
    fn take_updates(&self, s: usize, stretch: &mut Stretch, updates: &mut Vec<Update>) {
        let (from, end) = (stretch.supernodes.start, self.shape.begin(s + 1));
        updates.clear();
        let mut descendant = stretch.links[s - from].first;
        while descendant != NONE {
            let d = descendant as usize;
            descendant = stretch.links[d - from].next;
            let pattern = self.shape.pattern(d);
            let done = stretch.links[d - from].done as usize;
            let to = done + pattern[done..].partition_point(|&row| (row as usize) < end);
            updates.push(Update { descendant: d, rows: done..to });
            stretch.links[d - from].done = to as u32;
            self.enlist(d, stretch);
        }
    }

    /// Writes the entries of the matrix into the block of `s`, and the local number of each of its rows.
    fn assemble(&self, s: usize, values: &mut [f64], local: &mut [u32]) {
        let shape = self.shape;
        let (begin, width, height) = (shape.begin(s), shape.width(s), shape.height(s));
        for i in 0..width {
            local[begin + i] = i as u32;
        }
        for (i, &row) in shape.pattern(s).iter().enumerate() {
            local[row as usize] = (width + i) as u32;
        }
        for column in 0..width {
            for &(row, value) in self.matrix.column(begin + column) {
                values[local[row as usize] as usize + column * height] += value;
            }
            if begin + column < shape.eliminated {
                values[column + column * height] += self.shift;
            }
        }
    }

    /// Subtracts the products of all descendants that reach into some columns of a supernode, from `at` of it on.
    fn collect(&self, target: &Target, at: usize, values: &mut [f64], product: &mut Product) -> Result<(), Halt> {
        let shape = self.shape;
        let height = shape.height(target.s);
        let first = shape.begin(target.s) + at;
        let end = first + values.len() / height;
        for Update { descendant: d, rows } in target.updates {
            let (pattern, active) = (shape.pattern(*d), shape.active(*d));
            let until =
                |row: usize| rows.start + pattern[rows.clone()].partition_point(|&other| (other as usize) < row);
            let (from, to) = (until(first), until(end));
            let below = target.block(shape, *d).get(shape.width(*d).., ..active);
            let mut at_row = from;
            while at_row < to {
                let rows = pattern.len() - at_row;
                let strip = (PIECE / (rows * active)).clamp(8, PANEL).min(to - at_row);
                product.buffer.resize((rows * strip).max(product.buffer.len()), 0.0);
                let buffer = &mut product.buffer[..rows * strip];
                multiply(
                    MatMut::from_column_major_slice_mut(buffer, rows, strip),
                    Accum::Replace,
                    below.get(at_row.., ..),
                    below.get(at_row..at_row + strip, ..).transpose(),
                    1.0,
                );
                for (j, column) in buffer.chunks_exact(rows).enumerate() {
                    let own = target.local[pattern[at_row + j] as usize] as usize - at;
                    let values = &mut values[own * height..(own + 1) * height];
                    for (row, value) in pattern[at_row + j..].iter().zip(&column[j..]) {
                        values[target.local[*row as usize] as usize] -= value;
                    }
                }
                at_row += strip;
                self.look(&mut product.since, rows * strip * active)?;
            }
        }
        Ok(())
    }

    /// Counts `multiplications` more and asks the watcher when a [`PIECE`] is full.
    fn look(&self, since: &mut usize, multiplications: usize) -> Result<(), FactorError> {
        *since += multiplications;
        if *since <= PIECE {
            return Ok(());
        }
        *since = 0;
        check_stop(self.progress.watch)
    }

    /// Factorizes the eliminated columns of the block of `s` and takes their products off its other columns.
    fn eliminate(&self, s: usize, values: &mut [f64], scratch: &mut Scratch, in_strips: bool) -> Result<(), Halt> {
        let (active, height) = (self.shape.active(s), self.shape.height(s));
        let mut at = 0;
        while at < active {
            let size = PANEL.min(active - at);
            let below = at + size;
            let (panel, rest) = values.split_at_mut(below * height);
            let panel = MatMut::from_column_major_slice_mut(&mut panel[at * height..], height, size);
            let (mut top, mut bottom) = panel.get_mut(at.., ..).split_at_row_mut(size);
            scratch.dense.factorize(top.as_mut()).map_err(|_| Halt::Pivot)?;
            let top = top.as_ref();
            let solve = |rows: MatMut<f64>| solve_lower(top, rows.transpose_mut());
            let rows = if in_strips { ROWS } else { bottom.nrows() };
            if in_strips && self.is_spread && bottom.nrows() > rows {
                bottom.as_mut().par_row_chunks_mut(rows).for_each(solve);
            } else {
                let mut rest = bottom.as_mut();
                while rest.nrows() > 0 {
                    let size = rows.min(rest.nrows());
                    let (piece, more) = rest.split_at_row_mut(size);
                    solve(piece);
                    rest = more;
                }
            }
            // The columns right of the panel, from their diagonal down.
            let bottom = bottom.as_ref();
            let strip = (PIECE / (bottom.nrows().max(1) * size)).clamp(8, PANEL);
            self.each_strip(rest, strip * height, in_strips, &mut scratch.product, |product, (index, columns)| {
                let (first, width) = (index * strip, columns.len() / height);
                multiply(
                    MatMut::from_column_major_slice_mut(columns, height, width).get_mut(below + first.., ..),
                    Accum::Add,
                    bottom.get(first.., ..),
                    bottom.get(first..first + width, ..).transpose(),
                    -1.0,
                );
                Ok(self.look(&mut product.since, (bottom.nrows() - first) * width * size)?)
            })?;
            at = below;
        }
        Ok(())
    }
}

/// A supernode that collects what reaches into it.
struct Target<'a> {
    s: usize,
    local: &'a [u32],
    updates: &'a [Update],
    /// Values from the entry `start` on, up to those of the supernode.
    before: &'a [f64],
    start: usize,
}

impl Target<'_> {
    /// The block of a supernode before it.
    fn block(&self, shape: &Shape, d: usize) -> MatRef<'_, f64> {
        let values = &self.before[shape.value_start[d] - self.start..shape.value_start[d + 1] - self.start];
        MatRef::from_column_major_slice(values, shape.height(d), shape.width(d))
    }
}
