//! Sparse Cholesky factorization of the main system: the one file that names faer's sparse solver.
//!
//! ```text
//!     Pᵀ S K_m S P = L Lᵀ,    S = diag of powers of two that brings the diagonal of K_m to 0.5 … 2
//!     W = L⁻¹ Pᵀ S C,         Cᵀ K_m⁻¹ C = Wᵀ W
//! ```
//!
//! The rows that C touches are ordered last, so W has entries only there and comes from the last supernodes of L.
//! The other rows are ordered by approximate minimum degree, whose order is a postorder of its elimination tree;
//! appending rows keeps it one, as faer's supernodes need.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::matmul::{matmul, triangular};
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::perm::PermRef;
use faer::sparse::FaerError;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::amd;
use faer::sparse::linalg::cholesky::supernodal::{SupernodalLltRef, SymbolicSupernodalCholesky};
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Accum, Mat, MatMut, MatRef, Par, Side};
use nalgebra::DMatrix;

use super::error::MainSystemError;
use super::memory::available_memory;
use super::sparse::SymmetricSparse;
use super::watch::check_stop;
use crate::watch::Watch;

/// One thread: results do not depend on the machine's number of cores.
const PAR: Par = Par::Seq;

/// L, P and S of K_m.
#[derive(Debug)]
pub struct Factor {
    symbolic: SymbolicCholesky<u32>,
    values: Vec<f64>,
    /// Diagonal of S.
    scale: Vec<f64>,
    /// Position in P of each row of K_m.
    position: Vec<u32>,
    /// First position of the rows that C touches.
    tail: usize,
}

/// W on its rows from `start` on (all others are zero).
#[derive(Debug)]
pub struct Trailing {
    start: usize,
    w: Mat<f64>,
}

/// Why there is no factor.
#[derive(Debug)]
pub enum FactorError {
    /// K_m is not positive definite to working precision; the vector is nearly in its kernel.
    Singular(Vec<f64>),
    /// Anything else.
    Other(MainSystemError),
}

impl From<MainSystemError> for FactorError {
    fn from(error: MainSystemError) -> FactorError {
        FactorError::Other(error)
    }
}

fn out_of_memory(doing: &'static str) -> MainSystemError {
    MainSystemError::OutOfMemory { doing }
}

impl Factor {
    /// Orders and factorizes K_m (scaled in place) for `joints` columns of C that touch the rows `touched`.
    ///
    /// # Errors
    /// Singular; too large; out of memory; interrupted.
    pub fn new(
        k_m: &mut SymmetricSparse,
        touched: &[bool],
        joints: usize,
        watch: &dyn Watch,
    ) -> Result<Factor, FactorError> {
        if k_m.order() == 0 {
            // Everything is held. One idle unknown spares all that follows the empty case.
            *k_m = SymmetricSparse {
                column_start: vec![0, 1],
                rows: vec![0],
                values: vec![1.0],
            };
        }
        let touched = if touched.is_empty() {
            &[false]
        } else {
            touched
        };
        let n = k_m.order();
        let scale = k_m.scale_to_unit_diagonal();
        watch.progress("ordering the unknowns", 0.0);
        let forward = order_touched_last(k_m, touched)?;
        let tail = n - touched.iter().filter(|touched| **touched).count();
        let mut position = vec![0_u32; n];
        for (at, &row) in forward.iter().enumerate() {
            position[row as usize] = at as u32;
        }
        check_stop(watch)?;
        let pattern =
            SymbolicSparseColMatRef::new_checked(n, n, &k_m.column_start, None, &k_m.rows);
        let too_large = |needed: u64| MainSystemError::TooLarge {
            unknowns: n,
            joints,
            needed,
            available: available_memory().unwrap_or(u64::MAX),
        };
        let symbolic = factorize_symbolic_cholesky(
            pattern,
            Side::Lower,
            SymmetricOrdering::Custom(PermRef::new_checked(&forward, &position, n)),
            CholeskySymbolicParams {
                supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
                ..Default::default()
            },
        )
        .map_err(|error| match error {
            // More entries than a 32-bit index counts.
            FaerError::IndexOverflow => too_large(8 * (i32::MAX as u64)),
            _ => out_of_memory("analysing the main system"),
        })?;
        let mut factor = Factor {
            symbolic,
            values: Vec::new(),
            scale,
            position,
            tail,
        };
        let needed = factor.bytes_needed(joints);
        if available_memory().is_some_and(|available| needed > available) {
            return Err(too_large(needed).into());
        }
        check_stop(watch)?;
        watch.progress("factorizing the main system", 0.0);
        let length = factor.symbolic.len_val();
        factor
            .values
            .try_reserve_exact(length)
            .map_err(|_| out_of_memory("factorizing the main system"))?;
        factor.values.resize(length, 0.0);
        let positive = factor.factorize(k_m, 0.0)?;
        check_stop(watch)?;
        watch.progress("factorizing the main system", 1.0);
        match factor.null_vector(k_m, positive)? {
            Some(null_vector) => Err(FactorError::Singular(null_vector)),
            None => Ok(factor),
        }
    }

    /// Order of K_m.
    pub fn order(&self) -> usize {
        self.scale.len()
    }

    /// Entries stored for L.
    pub fn stored(&self) -> usize {
        self.symbolic.len_val()
    }

    /// Bytes of the factor, of W and of a few matrices as large as R.
    fn bytes_needed(&self, joints: usize) -> u64 {
        let w = (self.order() - self.tail) as u64 * joints as u64;
        8 * (self.symbolic.len_val() as u64 + w + 4 * (joints as u64).pow(2))
    }

    /// L of S K_m S + `shift`·1; false if a pivot was not positive.
    fn factorize(&mut self, k_m: &SymmetricSparse, shift: f64) -> Result<bool, MainSystemError> {
        let doing = "factorizing the main system";
        let n = self.order();
        let mut shifted;
        let mut values = &k_m.values;
        if shift != 0.0 {
            shifted = k_m.values.clone();
            for column in 0..n {
                // Every column begins with its diagonal entry.
                shifted[k_m.column_start[column] as usize] += shift;
            }
            values = &shifted;
        }
        let pattern =
            SymbolicSparseColMatRef::new_checked(n, n, &k_m.column_start, None, &k_m.rows);
        let request = self
            .symbolic
            .factorize_numeric_llt_scratch::<f64>(PAR, Default::default());
        let mut memory = MemBuffer::try_new(request).map_err(|_| out_of_memory(doing))?;
        let result = self.symbolic.factorize_numeric_llt(
            &mut self.values,
            SparseColMatRef::new(pattern, values),
            Side::Lower,
            Default::default(),
            PAR,
            MemStack::new(&mut memory),
            Default::default(),
        );
        Ok(result.is_ok())
    }

    /// A vector v with K_m v = 0 to rounding, if there is one (K_m as scaled, v in the unscaled unknowns).
    ///
    /// A small pivot alone proves nothing: a sound beam of a thousand elements has pivots of 1e-10. So the vector
    /// that a suspect pivot points to is sharpened by inverse iteration, and its residual decides: rounding
    /// level for a mechanism, the smallest eigenvalue otherwise.
    fn null_vector(
        &mut self,
        k_m: &SymmetricSparse,
        positive: bool,
    ) -> Result<Option<Vec<f64>>, MainSystemError> {
        const SUSPECT_PIVOT: f64 = 1e-9;
        const RESIDUAL: f64 = 1e-13;
        let n = self.order();
        let mut start = vec![0.0; n];
        if positive {
            let (at, pivot) = self.smallest_pivot();
            if pivot > SUSPECT_PIVOT {
                return Ok(None);
            }
            start[at] = 1.0;
        } else {
            let mut shift = 1e-13;
            while !self.factorize(k_m, shift)? {
                // Gershgorin: the scaled matrix is bounded by its row sums, so this ends.
                shift *= 100.0;
            }
            // Any vector that is not orthogonal to the kernel will do; this one has no symmetry.
            let mut state = 0.5;
            for x in &mut start {
                state = (state * 997.0_f64).fract() + 1e-3;
                *x = state - 0.4;
            }
        }
        let mut x = Mat::from_fn(n, 1, |i, _| start[i]);
        for _ in 0..4 {
            self.forward(x.as_mut(), 0, 0);
            self.backward(x.as_mut());
            let largest = (0..n).fold(0.0_f64, |m, i| m.max(x[(i, 0)].abs()));
            if !(largest > 0.0 && largest.is_finite()) {
                break;
            }
            (0..n).for_each(|i| x[(i, 0)] /= largest);
        }
        let v: Vec<f64> = self
            .position
            .iter()
            .map(|&at| x[(at as usize, 0)])
            .collect();
        let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let residual = norm(&k_m.times(&v));
        let is_null = !positive || residual <= RESIDUAL * norm(&k_m.times_absolute(&v));
        Ok(is_null.then(|| {
            std::iter::zip(&v, &self.scale)
                .map(|(v, s)| v * s)
                .collect()
        }))
    }

    /// Position and size of the smallest squared pivot of L.
    fn smallest_pivot(&self) -> (usize, f64) {
        let llt = self.llt();
        let mut smallest = (0, f64::INFINITY);
        for s in 0..self.supernodes().n_supernodes() {
            let block = llt.supernode(s);
            for j in 0..block.val().ncols() {
                let pivot = block.val()[(j, j)].powi(2);
                if pivot < smallest.1 {
                    smallest = (block.start() + j, pivot);
                }
            }
        }
        smallest
    }

    /// W = L⁻¹ Pᵀ S C from the terms (row, joint, value) of C, by the last supernodes only.
    pub fn trailing(
        &self,
        c: &[(u32, u32, f64)],
        joints: usize,
        watch: &dyn Watch,
    ) -> Result<Trailing, MainSystemError> {
        watch.progress("condensing to the contact joints", 0.0);
        let n = self.order();
        let symbolic = self.supernodes();
        let first = symbolic
            .supernode_end()
            .partition_point(|&end| end as usize <= self.tail);
        let start = symbolic
            .supernode_begin()
            .get(first)
            .map_or(n, |&begin| begin as usize);
        let mut w = Mat::zeros(n - start, joints);
        for &(row, joint, value) in c {
            let at = self.position[row as usize] as usize - start;
            w[(at, joint as usize)] += self.scale[row as usize] * value;
        }
        self.forward(w.as_mut(), first, start);
        check_stop(watch)?;
        Ok(Trailing { start, w })
    }

    /// K_m⁻¹ b, in place.
    pub fn solve(&self, b: &mut [f64]) {
        let mut x = Mat::<f64>::zeros(self.order(), 1);
        for (i, b) in b.iter().enumerate() {
            x[(self.position[i] as usize, 0)] = self.scale[i] * b;
        }
        self.forward(x.as_mut(), 0, 0);
        self.backward(x.as_mut());
        for (i, b) in b.iter_mut().enumerate() {
            *b = self.scale[i] * x[(self.position[i] as usize, 0)];
        }
    }

    /// Cᵀ K_m⁻¹ b = Wᵀ L⁻¹ Pᵀ S b for every b, as columns.
    pub fn project(&self, trailing: &Trailing, b: &[Vec<f64>]) -> DMatrix<f64> {
        let (n, cases) = (self.order(), b.len());
        // Row by row: the sweep goes down the rows, and the cases lie side by side.
        let mut x = vec![0.0; n * cases];
        for (case, b) in b.iter().enumerate() {
            for (i, b) in b.iter().enumerate() {
                x[self.position[i] as usize * cases + case] = self.scale[i] * b;
            }
        }
        let mut x = MatMut::from_row_major_slice_mut(&mut x, n, cases);
        self.forward(x.as_mut(), 0, 0);
        let mut out = DMatrix::zeros(trailing.w.ncols(), cases);
        matmul(
            MatMut::from_column_major_slice_mut(out.as_mut_slice(), trailing.w.ncols(), cases),
            Accum::Replace,
            trailing.w.transpose(),
            x.as_ref().subrows(trailing.start, trailing.w.nrows()),
            1.0,
            PAR,
        );
        out
    }

    fn supernodes(&self) -> &SymbolicSupernodalCholesky<u32> {
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Supernodal(symbolic) => symbolic,
            // FORCE_SUPERNODAL compares > 0 with the operation count, which counts one division per column.
            SymbolicCholeskyRaw::Simplicial(_) => {
                unreachable!("the supernodal factorization was asked for")
            }
        }
    }

    fn llt(&self) -> SupernodalLltRef<'_, u32, f64> {
        SupernodalLltRef::new(self.supernodes(), &self.values)
    }

    /// x ← L⁻¹ x on the rows from `offset` = begin of supernode `first` on.
    fn forward(&self, mut x: MatMut<'_, f64>, first: usize, offset: usize) {
        let llt = self.llt();
        let columns = x.ncols();
        let mut buffer = Vec::new();
        for s in first..self.supernodes().n_supernodes() {
            let block = llt.supernode(s);
            let size = block.val().ncols();
            let (top, bottom) = block.val().split_at_row(size);
            let mut x_top = x.as_mut().subrows_mut(block.start() - offset, size);
            solve_lower_triangular_in_place(top, x_top.as_mut(), PAR);
            let rows = block.pattern().len();
            if rows == 0 {
                continue;
            }
            buffer.resize(rows * columns, 0.0);
            let mut product = MatMut::from_column_major_slice_mut(&mut buffer, rows, columns);
            matmul(
                product.as_mut(),
                Accum::Replace,
                bottom,
                x_top.as_ref(),
                1.0,
                PAR,
            );
            for j in 0..columns {
                for (i, &row) in block.pattern().iter().enumerate() {
                    x[(row as usize - offset, j)] -= product[(i, j)];
                }
            }
        }
    }

    /// x ← L⁻ᵀ x.
    fn backward(&self, mut x: MatMut<'_, f64>) {
        let llt = self.llt();
        let columns = x.ncols();
        let mut buffer = Vec::new();
        for s in (0..self.supernodes().n_supernodes()).rev() {
            let block = llt.supernode(s);
            let size = block.val().ncols();
            let (top, bottom) = block.val().split_at_row(size);
            let rows = block.pattern().len();
            buffer.resize(rows * columns, 0.0);
            for j in 0..columns {
                for (i, &row) in block.pattern().iter().enumerate() {
                    buffer[j * rows + i] = x[(row as usize, j)];
                }
            }
            let below = MatRef::from_column_major_slice(&buffer, rows, columns);
            let mut x_top = x.as_mut().subrows_mut(block.start(), size);
            if rows > 0 {
                matmul(
                    x_top.as_mut(),
                    Accum::Add,
                    bottom.transpose(),
                    below,
                    -1.0,
                    PAR,
                );
            }
            solve_upper_triangular_in_place(top.transpose(), x_top.as_mut(), PAR);
        }
    }
}

/// Seconds of faer's own Cholesky factorization of the same matrix, ordered by plain AMD: the yardstick.
#[cfg(test)]
pub fn plain_seconds(k: &SymmetricSparse) -> f64 {
    let n = k.order();
    let pattern = SymbolicSparseColMatRef::new_checked(n, n, &k.column_start, None, &k.rows);
    let matrix = SparseColMatRef::new(pattern, &k.values);
    faer::set_global_parallelism(PAR);
    let clock = std::time::Instant::now();
    let factor = matrix.sp_cholesky(Side::Lower);
    let seconds = clock.elapsed().as_secs_f64();
    assert!(factor.is_ok());
    seconds
}

impl Trailing {
    /// D − Wᵀ W, exactly symmetric.
    pub fn schur(&self, d: &DMatrix<f64>) -> DMatrix<f64> {
        let k = d.nrows();
        let mut r = d.clone();
        triangular::matmul(
            MatMut::from_column_major_slice_mut(r.as_mut_slice(), k, k),
            triangular::BlockStructure::TriangularLower,
            Accum::Add,
            self.w.transpose(),
            triangular::BlockStructure::Rectangular,
            &self.w,
            triangular::BlockStructure::Rectangular,
            -1.0,
            PAR,
        );
        r.fill_upper_triangle_with_lower_triangle();
        r
    }
}

/// The order: AMD of the rows that are not touched, then the touched ones; entry i is the row at position i.
fn order_touched_last(k: &SymmetricSparse, touched: &[bool]) -> Result<Vec<u32>, MainSystemError> {
    let doing = "ordering the unknowns";
    let inner: Vec<u32> = (0..k.order() as u32)
        .filter(|&row| !touched[row as usize])
        .collect();
    let mut number = vec![u32::MAX; k.order()];
    for (i, &row) in inner.iter().enumerate() {
        number[row as usize] = i as u32;
    }
    let mut column_start = Vec::with_capacity(inner.len() + 1);
    let mut rows = Vec::with_capacity(k.rows.len());
    column_start.push(0_u32);
    for &column in &inner {
        for (row, _) in k.column(column as usize) {
            if !touched[row] {
                rows.push(number[row]);
            }
        }
        column_start.push(rows.len() as u32);
    }
    drop(number);
    let n = inner.len();
    let pattern = SymbolicSparseColMatRef::new_checked(n, n, &column_start, None, &rows);
    let mut order = vec![0_u32; n];
    let mut inverse = vec![0_u32; n];
    let request = amd::order_scratch::<u32>(n, rows.len());
    let mut memory = MemBuffer::try_new(request).map_err(|_| out_of_memory(doing))?;
    amd::order(
        &mut order,
        &mut inverse,
        pattern,
        amd::Control::default(),
        MemStack::new(&mut memory),
    )
    .map_err(|_| out_of_memory(doing))?;
    let mut forward: Vec<u32> = order.into_iter().map(|i| inner[i as usize]).collect();
    forward.extend((0..k.order() as u32).filter(|&row| touched[row as usize]));
    Ok(forward)
}
