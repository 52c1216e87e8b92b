//! Joints that carry no force at a rate: those of open pairs. They are condensed out of the rate problem.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::contact::system::ContactSystem;
use crate::lcp::problem::NOISE;

/// A motion of the kernel whose part in the other joints is below this lies in the released ones alone (the kernel is
/// orthonormal; its rows are known to about 1e-12).
pub(super) const OUTSIDE: f64 = 1e-8;

/// The released joints F with R_FF factorized.
#[derive(Clone)]
pub(super) struct Released {
    pub(super) joints: Vec<usize>,
    factor: Cholesky<f64, Dyn>,
    /// Motions of the released joints alone that cost no energy, orthonormal; |F| × r.
    loose: DMatrix<f64>,
}

impl Released {
    /// R_FF is positive definite but for the motions of the kernel that need no other joint; these are held at rest by
    /// an added stiffness, which changes no solution whose load does no work on them. `None` where R_FF is not even
    /// that: its data are not a condensed stiffness.
    pub(super) fn new(system: &ContactSystem, joints: Vec<usize>) -> Option<Released> {
        let loose = loose_motions(system, &joints);
        let r = &system.stiffness;
        let mut matrix = DMatrix::from_fn(joints.len(), joints.len(), |a, b| r[(joints[a], joints[b])]);
        if loose.ncols() > 0 {
            let size = matrix.diagonal().amax();
            matrix += &loose * loose.transpose() * if size > 0.0 { size } else { 1.0 };
        }
        let factor = Cholesky::new(matrix)?;
        Some(Released { joints, factor, loose })
    }

    /// The released joints and others, in increasing order, and the motions of all these alone that cost no energy; `None`
    /// where the others add none to those of the released ones.
    pub(super) fn loose_with(
        &self,
        system: &ContactSystem,
        others: impl Iterator<Item = usize>,
    ) -> Option<(Vec<usize>, DMatrix<f64>)> {
        let mut joints: Vec<usize> = self.joints.iter().copied().chain(others).collect();
        joints.sort_unstable();
        joints.dedup();
        let loose = loose_motions(system, &joints);
        (loose.ncols() > self.loose.ncols()).then_some((joints, loose))
    }

    /// A loose motion on which the forces `right` of the released joints do work; `None` where they do none.
    /// `sizes`: what their rounding is judged against.
    pub(super) fn driven_motion(&self, right: &DVector<f64>, sizes: &DVector<f64>) -> Option<DVector<f64>> {
        self.loose.column_iter().find_map(|motion| {
            let power = -right.dot(&motion);
            let terms: f64 = sizes.iter().zip(motion.iter()).map(|(size, v)| (size * v).abs()).sum();
            (power.abs() > NOISE * terms).then(|| motion * power.signum())
        })
    }

    /// Entries of a vector over all joints.
    pub(super) fn pick(&self, all: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(self.joints.len(), |a, _| all[self.joints[a]])
    }

    /// R_FF⁻¹ right.
    pub(super) fn solve(&self, right: &DVector<f64>) -> DVector<f64> {
        self.factor.solve(right)
    }

    /// R_FF⁻¹ of a matrix of right-hand sides.
    pub(super) fn solve_many(&self, right: &DMatrix<f64>) -> DMatrix<f64> {
        self.factor.solve(right)
    }
}

/// The part of z along orthonormal motions of some joints alone.
pub(super) fn part_along(loose: &DMatrix<f64>, joints: &[usize], z: &DVector<f64>) -> DVector<f64> {
    let part = DVector::from_fn(joints.len(), |at, _| z[joints[at]]);
    let mut along = DVector::zeros(z.len());
    joints.iter().zip((loose * loose.tr_mul(&part)).iter()).for_each(|(&joint, moved)| along[joint] = *moved);
    along
}

/// Combinations of the kernel of R that move no joint but the given ones, over these; orthonormal.
pub(in crate::path) fn loose_motions(system: &ContactSystem, joints: &[usize]) -> DMatrix<f64> {
    let kernel = &system.kernel;
    let count = kernel.ncols();
    if count == 0 || joints.is_empty() {
        return DMatrix::zeros(joints.len(), 0);
    }
    let mut inside = vec![false; system.joint_count()];
    joints.iter().for_each(|&joint| inside[joint] = true);
    let outside: Vec<usize> = (0..system.joint_count()).filter(|&joint| !inside[joint]).collect();
    // At least as many rows as columns, so that the singular values are complete.
    let rest = DMatrix::from_fn(outside.len().max(count), count, |a, b| {
        outside.get(a).map_or(0.0, |&joint| kernel[(joint, b)])
    });
    let svd = rest.svd(false, true);
    let Some(v_t) = svd.v_t else {
        return DMatrix::zeros(joints.len(), 0);
    };
    let motions: Vec<DVector<f64>> = (0..count)
        .filter(|&k| svd.singular_values[k] <= OUTSIDE)
        .map(|k| {
            let motion = kernel * v_t.row(k).transpose();
            DVector::from_fn(joints.len(), |a, _| motion[joints[a]])
        })
        .collect();
    if motions.is_empty() { DMatrix::zeros(joints.len(), 0) } else { DMatrix::from_columns(&motions) }
}
