//! The main system, factorized and condensed to its joints in one sweep.
//!
//! ```text
//!     [ Pᵀ S K_m S P   .  ]   [ L        ]            S = diag of powers of two that brings the diagonal of K_m
//!     [   Cᵀ S P       0  ] = [ L_C   1  ] …            to 0.5 … 2
//!
//!     Cᵀ K_m⁻¹ C = L_C L_Cᵀ
//! ```
//!
//! z is carried along as further rows that are not eliminated ([`stickslip_numerics::supernodes`]), so the sparsity of
//! C is used to the end. How the others are ordered: [`super::fill`], [`super::order`].

use nalgebra::DMatrix;
use stickslip_numerics::analysis::AnalysisError;
use stickslip_numerics::blocks::MatMut;
use stickslip_numerics::supernodes::{DOING, FactorError, Supernodes, Terms};

use super::assembly::Coupling;
use super::error::MainSystemError;
use super::fill::{best_order, out_of_memory};
use super::order::Places;
use super::sparse::SymmetricSparse;
use super::threads::can_spread;
use super::watch::check_stop;
use crate::model::memory::available_memory;
use crate::watch::Watch;

/// Added to the unit diagonal where K_m itself has no factor in f64, and multiplied by [`SHIFT_STEP`] until it has one.
const FIRST_SHIFT: f64 = 1e-15;
const SHIFT_STEP: f64 = 32.0;

/// A squared pivot below this share of the unit diagonal points to a motion that may cost nothing.
const SUSPECT_PIVOT: f64 = 1e-9;

/// L, L_C, P and S of K_m.
#[derive(Debug)]
pub struct Factor {
    supernodes: Supernodes,
    /// What was added to the diagonal of S K_m S: 0 unless rounding made a pivot fail.
    shift: f64,
    /// Diagonal of S.
    scale: Vec<f64>,
    /// Position in P of each row of K_m.
    position: Vec<u32>,
    joints: usize,
}

impl Factor {
    /// Orders and factorizes K_m (scaled in place) with the terms (row, joint, value) of C for `joints` joints; the
    /// rows marked as last are ordered after all others where that costs less.
    ///
    /// Where rounding makes a pivot fail, the factor is that of a slightly shifted K_m ([`Factor::is_shifted`]): good
    /// for refinement, but neither for R nor for a verdict on the structure.
    ///
    /// # Errors
    /// Too large; out of memory; interrupted.
    pub fn new(
        k_m: &mut SymmetricSparse,
        c: &[Coupling],
        places: Places,
        joints: usize,
        watch: &dyn Watch,
    ) -> Result<Factor, MainSystemError> {
        if k_m.order() == 0 {
            // Everything is held. With one idle unknown, nothing that follows has to deal with an empty matrix.
            *k_m = SymmetricSparse { column_start: vec![0, 1], rows: vec![0], values: vec![1.0] };
        }
        let idle = Places { node: &[0], coordinates: &[[0.0; 3]], last: &[false] };
        let places = if places.node.is_empty() { idle } else { places };
        let n = k_m.order();
        let scale = k_m.scale_to_unit_diagonal();
        watch.progress(&format!("ordering {n} unknowns"), 0.0);
        let ordered = best_order(k_m, places, c, joints, watch)?;
        check_stop(watch)?;
        let too_large = |needed: u64| MainSystemError::TooLarge {
            unknowns: n,
            joints,
            needed,
            available: available_memory().unwrap_or(u64::MAX),
        };
        let (position, supernodes) = ordered.into_supernodes().map_err(|error| match error {
            AnalysisError::TooLarge => too_large(8 * (i32::MAX as u64)),
            AnalysisError::OutOfMemory => out_of_memory(),
        })?;
        let matrix = with_joints(k_m, &position, &scale, c, joints);
        let mut factor = Factor { supernodes, shift: 0.0, scale, position, joints };
        let needed = factor.bytes_needed();
        if available_memory().is_some_and(|available| needed > available) {
            return Err(too_large(needed));
        }
        check_stop(watch)?;
        let failed = |error| match error {
            FactorError::OutOfMemory => MainSystemError::OutOfMemory { doing: DOING },
            FactorError::Interrupted => MainSystemError::Interrupted,
        };
        while !factor.supernodes.factorize(&matrix, factor.shift, can_spread, watch).map_err(failed)? {
            check_stop(watch)?;
            factor.shift = if factor.shift == 0.0 { FIRST_SHIFT } else { factor.shift * SHIFT_STEP };
            if factor.shift > 1.0 {
                // A positive semidefinite matrix of unit diagonal is long positive definite by then.
                return Err(MainSystemError::NotFinite);
            }
        }
        Ok(factor)
    }

    /// Whether this is the factor of a shifted matrix.
    pub fn is_shifted(&self) -> bool {
        self.shift > 0.0
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

    /// A vector v, in the unscaled unknowns, that is nearly in the kernel of K_m, if a pivot points to one.
    ///
    /// It proves nothing: a sound beam of a thousand elements has pivots of 1e-10. What K v is decides.
    pub fn suspect(&self) -> Option<Vec<f64>> {
        let n = self.order();
        let mut start = vec![0.0; n];
        if self.shift == 0.0 {
            let (at, pivot) = self.supernodes.smallest_pivot();
            if pivot > SUSPECT_PIVOT {
                return None;
            }
            start[at] = 1.0;
        } else {
            // Any vector that is not orthogonal to the kernel will do; this one has no symmetry.
            let mut state = 0.5;
            for x in &mut start {
                state = (state * 997.0_f64).fract() + 1e-3;
                *x = state - 0.4;
            }
        }
        let mut x = start;
        for _ in 0..4 {
            self.solve_in_order(&mut x);
            let largest = x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            if !(largest > 0.0 && largest.is_finite()) {
                break;
            }
            x.iter_mut().for_each(|x| *x /= largest);
        }
        Some(self.position.iter().zip(&self.scale).map(|(&at, s)| x[at as usize] * s).collect())
    }

    /// D − Cᵀ K_m⁻¹ C, exactly symmetric.
    pub fn schur(&self, mut d: DMatrix<f64>) -> DMatrix<f64> {
        self.supernodes.each_schur_entry(|i, j, value| d[(i, j)] += value);
        d.fill_upper_triangle_with_lower_triangle();
        d
    }

    /// x := (L Lᵀ)⁻¹ x, in the order of elimination.
    fn solve_in_order(&self, x: &mut [f64]) {
        let n = x.len();
        self.supernodes.forward(MatMut::from_column_major_slice_mut(x, n, 1));
        self.supernodes.backward(MatMut::from_column_major_slice_mut(x, n, 1));
    }

    /// K_m⁻¹ b, in place.
    pub fn solve(&self, b: &mut [f64]) {
        let mut x = vec![0.0; self.order()];
        for (i, b) in b.iter().enumerate() {
            x[self.position[i] as usize] = self.scale[i] * b;
        }
        self.solve_in_order(&mut x);
        for (i, b) in b.iter_mut().enumerate() {
            *b = self.scale[i] * x[self.position[i] as usize];
        }
    }

    /// The same for several right sides, which share each look at L.
    pub fn solve_many(&self, b: &mut [Vec<f64>]) {
        let (n, cases) = (self.order(), b.len());
        let mut x = self.side_by_side(b, n);
        self.supernodes.forward(MatMut::from_row_major_slice_mut(&mut x, n, cases));
        self.supernodes.backward(MatMut::from_row_major_slice_mut(&mut x, n, cases));
        for i in 0..b.first().map_or(0, Vec::len) {
            let row = &x[self.position[i] as usize * cases..][..cases];
            b.iter_mut().zip(row).for_each(|(b, x)| b[i] = self.scale[i] * x);
        }
    }

    /// Pᵀ S b of every b, as a matrix of so many rows, row by row: the sweeps go down the rows. Where everything is held, b
    /// lacks the idle unknown, which stays zero.
    fn side_by_side(&self, b: &[Vec<f64>], rows: usize) -> Vec<f64> {
        let cases = b.len();
        let mut x = vec![0.0; rows * cases];
        for i in 0..b.first().map_or(0, Vec::len) {
            let row = &mut x[self.position[i] as usize * cases..][..cases];
            row.iter_mut().zip(b).for_each(|(x, b)| *x = self.scale[i] * b[i]);
        }
        x
    }

    /// Cᵀ K_m⁻¹ b = L_C L⁻¹ Pᵀ S b for every b, as columns.
    pub fn project(&self, b: &[Vec<f64>]) -> DMatrix<f64> {
        let (n, cases) = (self.order(), b.len());
        let rows = n + self.joints;
        let mut x = self.side_by_side(b, rows);
        self.supernodes.forward(MatMut::from_row_major_slice_mut(&mut x, rows, cases));
        DMatrix::from_fn(self.joints, cases, |joint, case| -x[(n + joint) * cases + case])
    }
}

/// The lower triangle of [K_m .; Cᵀ 0], K_m permuted, the rows of z after it.
fn with_joints(k_m: &SymmetricSparse, position: &[u32], scale: &[f64], c: &[Coupling], joints: usize) -> Terms {
    let n = k_m.order();
    Terms::new(n + joints, |visit| {
        for column in 0..n {
            let a = position[column] as usize;
            for (row, value) in k_m.column(column) {
                let b = position[row] as usize;
                visit(a.max(b), a.min(b), value);
            }
        }
        for &(row, joint, value) in c {
            visit(n + joint as usize, position[row as usize] as usize, scale[row as usize] * value);
        }
    })
}
