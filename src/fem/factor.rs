//! The main system, factorized and condensed to its joints in one sweep.
//!
//! ```text
//!     [ Pᵀ S K_m S P   .  ]   [ L        ]            S = diag of powers of two that brings the diagonal of K_m
//!     [   Cᵀ S P       0  ] = [ L_C   1  ] …            to 0.5 … 2
//!
//!     Cᵀ K_m⁻¹ C = L_C L_Cᵀ
//! ```
//!
//! z is carried along as further rows that are not eliminated ([`super::supernodes`]), so the sparsity of C is used
//! to the end. The unknowns that the joints tie to others come last: before them the bodies are apart, and only the
//! one that C belongs to carries the rows of z. How the others are ordered: [`super::order`].

use faer::perm::PermRef;
use faer::sparse::FaerError;
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::{Mat, MatMut, Side};
use nalgebra::DMatrix;

use super::error::MainSystemError;
use super::memory::available_memory;
use super::order::{Places, elimination_order};
use super::sparse::SymmetricSparse;
use super::supernodes::Supernodes;
use super::watch::check_stop;
use crate::watch::Watch;

/// L, L_C, P and S of K_m.
#[derive(Debug)]
pub struct Factor {
    supernodes: Supernodes,
    /// Diagonal of S.
    scale: Vec<f64>,
    /// Position in P of each row of K_m.
    position: Vec<u32>,
    joints: usize,
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
    /// Orders and factorizes K_m (scaled in place) with the terms (row, joint, value) of C for `joints` joints;
    /// the rows that have to come last are ordered behind all others.
    ///
    /// # Errors
    /// Singular; too large; out of memory; interrupted.
    pub fn new(
        k_m: &mut SymmetricSparse,
        c: &[(u32, u32, f64)],
        places: Places,
        joints: usize,
        watch: &dyn Watch,
    ) -> Result<Factor, FactorError> {
        if k_m.order() == 0 {
            // Everything is held. One idle unknown spares all that follows the empty case.
            *k_m = SymmetricSparse { column_start: vec![0, 1], rows: vec![0], values: vec![1.0] };
        }
        let idle = Places { node: &[0], coordinates: &[[0.0; 2]], last: &[false] };
        let places = if places.node.is_empty() { idle } else { places };
        let n = k_m.order();
        let scale = k_m.scale_to_unit_diagonal();
        let forward = elimination_order(k_m, places, watch)?;
        let mut position = vec![0_u32; n];
        for (at, &row) in forward.iter().enumerate() {
            position[row as usize] = at as u32;
        }
        drop(forward);
        check_stop(watch)?;
        let too_large = |needed: u64| MainSystemError::TooLarge {
            unknowns: n,
            joints,
            needed,
            available: available_memory().unwrap_or(u64::MAX),
        };
        watch.progress(&format!("analysing {n} unknowns"), 0.0);
        let matrix = with_joints(k_m, &position, &scale, c, joints);
        let order = n + joints;
        let same: Vec<u32> = (0..order as u32).collect();
        let symbolic = factorize_symbolic_cholesky(
            SymbolicSparseColMatRef::new_checked(order, order, &matrix.column_start, None, &matrix.rows),
            Side::Lower,
            // With `Identity` faer takes the lower triangle for the upper one.
            SymmetricOrdering::Custom(PermRef::new_checked(&same, &same, order)),
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
        let SymbolicCholeskyRaw::Supernodal(structure) = symbolic.raw() else {
            // FORCE_SUPERNODAL compares > 0 with the operation count, which counts one division per column.
            unreachable!("the supernodal factorization was asked for")
        };
        let mut begin = structure.supernode_begin().to_vec();
        begin.push(order as u32);
        let supernodes = Supernodes::new(n, begin, |s| structure.supernode(s).pattern());
        drop(symbolic);
        let mut factor = Factor { supernodes, scale, position, joints };
        let needed = factor.bytes_needed();
        if available_memory().is_some_and(|available| needed > available) {
            return Err(too_large(needed).into());
        }
        check_stop(watch)?;
        let positive = factor.supernodes.factorize(&matrix, 0.0, watch)?;
        check_stop(watch)?;
        match factor.null_vector(k_m, &matrix, positive, watch)? {
            Some(null_vector) => Err(FactorError::Singular(null_vector)),
            None => Ok(factor),
        }
    }

    /// Order of K_m.
    pub fn order(&self) -> usize {
        self.scale.len()
    }

    /// Entries stored for L and L_C.
    pub fn stored(&self) -> usize {
        self.supernodes.stored()
    }

    /// Bytes of the factor and of a few matrices as large as R.
    fn bytes_needed(&self) -> u64 {
        8 * (self.stored() as u64 + 4 * (self.joints as u64).pow(2))
    }

    /// A vector v with K_m v = 0 to rounding, if there is one (K_m as scaled, v in the unscaled unknowns).
    ///
    /// A small pivot alone proves nothing: a sound beam of a thousand elements has pivots of 1e-10. So the vector
    /// that a suspect pivot points to is sharpened by inverse iteration, and its residual decides: rounding
    /// level for a mechanism, the smallest eigenvalue otherwise.
    fn null_vector(
        &mut self,
        k_m: &SymmetricSparse,
        matrix: &SymmetricSparse,
        positive: bool,
        watch: &dyn Watch,
    ) -> Result<Option<Vec<f64>>, MainSystemError> {
        const SUSPECT_PIVOT: f64 = 1e-9;
        const RESIDUAL: f64 = 1e-13;
        let n = self.order();
        let mut start = vec![0.0; n];
        if positive {
            let (at, pivot) = self.supernodes.smallest_pivot();
            if pivot > SUSPECT_PIVOT {
                return Ok(None);
            }
            start[at] = 1.0;
        } else {
            let mut shift = 1e-13;
            while !self.supernodes.factorize(matrix, shift, watch)? {
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
            self.supernodes.forward(x.as_mut());
            self.supernodes.backward(x.as_mut());
            let largest = (0..n).fold(0.0_f64, |m, i| m.max(x[(i, 0)].abs()));
            if !(largest > 0.0 && largest.is_finite()) {
                break;
            }
            (0..n).for_each(|i| x[(i, 0)] /= largest);
        }
        let v: Vec<f64> = self.position.iter().map(|&at| x[(at as usize, 0)]).collect();
        let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let residual = norm(&k_m.times(&v));
        let is_null = !positive || residual <= RESIDUAL * norm(&k_m.times_absolute(&v));
        Ok(is_null.then(|| std::iter::zip(&v, &self.scale).map(|(v, s)| v * s).collect()))
    }

    /// D − Cᵀ K_m⁻¹ C, exactly symmetric.
    pub fn schur(&self, mut d: DMatrix<f64>) -> DMatrix<f64> {
        self.supernodes.each_schur_entry(|i, j, value| d[(i, j)] += value);
        d.fill_upper_triangle_with_lower_triangle();
        d
    }

    /// K_m⁻¹ b, in place.
    pub fn solve(&self, b: &mut [f64]) {
        let mut x = Mat::<f64>::zeros(self.order(), 1);
        for (i, b) in b.iter().enumerate() {
            x[(self.position[i] as usize, 0)] = self.scale[i] * b;
        }
        self.supernodes.forward(x.as_mut());
        self.supernodes.backward(x.as_mut());
        for (i, b) in b.iter_mut().enumerate() {
            *b = self.scale[i] * x[(self.position[i] as usize, 0)];
        }
    }

    /// Cᵀ K_m⁻¹ b = L_C L⁻¹ Pᵀ S b for every b, as columns.
    pub fn project(&self, b: &[Vec<f64>]) -> DMatrix<f64> {
        let (n, cases) = (self.order(), b.len());
        // Row by row: the sweep goes down the rows, and the cases lie side by side.
        let mut x = vec![0.0; (n + self.joints) * cases];
        for (case, b) in b.iter().enumerate() {
            for (i, b) in b.iter().enumerate() {
                x[self.position[i] as usize * cases + case] = self.scale[i] * b;
            }
        }
        let rows = n + self.joints;
        self.supernodes.forward(MatMut::from_row_major_slice_mut(&mut x, rows, cases));
        DMatrix::from_fn(self.joints, cases, |joint, case| -x[(n + joint) * cases + case])
    }
}

/// The lower triangle of [K_m .; Cᵀ 0], K_m permuted, the rows of z behind it with a diagonal of zeros.
fn with_joints(
    k_m: &SymmetricSparse,
    position: &[u32],
    scale: &[f64],
    c: &[(u32, u32, f64)],
    joints: usize,
) -> SymmetricSparse {
    let n = k_m.order();
    let each = |visit: &mut dyn FnMut(usize, usize, f64)| {
        for column in 0..n {
            let a = position[column] as usize;
            for (row, value) in k_m.column(column) {
                let b = position[row] as usize;
                visit(a.max(b), a.min(b), value);
            }
        }
        for &(row, joint, value) in c {
            let column = position[row as usize] as usize;
            visit(n + joint as usize, column, scale[row as usize] * value);
        }
        for z in n..n + joints {
            visit(z, z, 0.0);
        }
    };
    let sum: Result<SymmetricSparse, std::convert::Infallible> = SymmetricSparse::from_terms(
        n + joints,
        |visit| each(&mut |_, column, _| visit(column)),
        |visit| {
            each(visit);
            Ok(())
        },
    );
    let Ok(sum) = sum;
    sum
}
