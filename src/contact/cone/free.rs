//! Motions that neither the structure nor any friction resists: bodies that hang, or slide on pairs without friction.
//!
//! How far such a motion goes nothing determines. The equations are singular along it, and what a singular matrix makes of
//! their rounding is no motion: searches leave it where it is, and a step of a path takes it back.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::{ConePair, ConeProblem};
use crate::contact::sum::Sum;
use crate::lcp::problem::NOISE;
use stickslip_numerics::decompositions::svd;

/// A square above this is none of a singular value that is rounding, whatever its own rounding.
const SURE: f64 = 1e-10;

impl ConePair {
    /// Whether nothing resists its tangential joints: friction resists nothing where the pair is not pressed.
    fn slides_freely(&self, is_pressed: bool) -> bool {
        self.fixed() == 0.0 && !(is_pressed && self.friction() > 0.0)
    }
}

impl ConeProblem<'_> {
    /// Orthonormal basis, over all joints, of the motions of the kernel in which of the given joints those move that
    /// nothing resists; `None` where there is none.
    pub(super) fn free_motions(
        &self,
        forces: &[Sum],
        is_open: impl Fn(usize) -> bool,
        moves: impl Fn(usize) -> bool,
    ) -> Option<DMatrix<f64>> {
        let kernel = self.kernel;
        if kernel.ncols() == 0 {
            return None;
        }
        let mut held = vec![true; kernel.nrows()];
        for (i, pair) in self.pairs.iter().enumerate() {
            let is_pressed = !is_open(i) && !forces[i].is_zero();
            let sliding = if pair.slides_freely(is_pressed) { pair.tangents.clone() } else { 0..0 };
            let normal = if is_open(i) { i..i + 1 } else { 0..0 };
            normal.chain(sliding).filter(|&joint| moves(joint)).for_each(|joint| held[joint] = false);
        }
        let rows: Vec<usize> = (0..held.len()).filter(|&joint| held[joint]).collect();
        let held = kernel.select_rows(&rows);
        // The squares of the singular values tell at once where none can be rounding.
        if SymmetricEigen::new(held.tr_mul(&held)).eigenvalues.iter().all(|square| *square > SURE) {
            return None;
        }
        let found = svd(&held)?;
        // The basis is orthonormal to rounding.
        let still: Vec<usize> = (0..found.sigma.len()).filter(|&one| found.sigma[one] <= NOISE).collect();
        let mut motions = kernel * found.v.select_columns(&still);
        rows.iter().for_each(|&joint| motions.row_mut(joint).fill(0.0));
        (!still.is_empty()).then_some(motions)
    }

    /// The displacements z of an answer, and its forces, with as little of those motions as there can be from displacements
    /// before; pairs that are open there stay open.
    pub(in crate::contact) fn least_moved(
        &self,
        (z, forces): (&DVector<f64>, &[Sum]),
        before: &DVector<f64>,
    ) -> Option<DVector<f64>> {
        let motions = self.free_motions(forces, |i| z[i] > 0.0, |_| true)?;
        let moved = &motions * motions.tr_mul(&(z - before));
        let least = z - moved;
        (0..self.pairs.len()).all(|i| z[i] == 0.0 || least[i] > 0.0).then_some(least)
    }
}
