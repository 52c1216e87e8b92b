//! Stiffness and load's rate of the joints of a rate problem, once the released joints follow them.

use nalgebra::{DMatrix, DVector};

use super::released::{OUTSIDE, Released};
use super::standing::{Laws, joint_scales};
use crate::lcp::problem::NOISE;
use stickslip_numerics::decompositions::svd;

/// See the module.
pub(super) struct Condensed {
    /// The joints, in increasing order.
    joints: Vec<usize>,
    /// Place of each joint among them; of no meaning for the others.
    place: Vec<usize>,
    stiffness: DMatrix<f64>,
    /// R_FF⁻¹ R_FJ: what the released joints F take back per unit of each joint; 0 × J where none is released.
    follow: DMatrix<f64>,
}

impl Condensed {
    /// R of the given joints, the released ones condensed out. (An open pair's normal joint among them has no entry left.)
    pub(super) fn new(laws: Laws<'_>, released: &Released, mut joints: Vec<usize>) -> Condensed {
        joints.sort_unstable();
        joints.dedup();
        let r = &laws.problem.system.stiffness;
        let mut place = vec![0; r.nrows()];
        joints.iter().enumerate().for_each(|(at, &joint)| place[joint] = at);
        let own = DMatrix::from_fn(joints.len(), joints.len(), |a, b| r[(joints[a], joints[b])]);
        if released.joints.is_empty() {
            let follow = DMatrix::zeros(0, joints.len());
            return Condensed { joints, place, stiffness: own, follow };
        }
        let across = DMatrix::from_fn(released.joints.len(), joints.len(), |a, b| r[(released.joints[a], joints[b])]);
        let follow = released.solve_many(&across);
        Condensed { stiffness: own - across.transpose() * &follow, joints, place, follow }
    }

    /// Makes the stiffness and the load exactly 0 along the motions of the joints that may move, and of the released ones, that
    /// cost no energy and on which the load does next to no work; `false` where there are none.
    ///
    /// Such motions are known to [`OUTSIDE`], the last digits of a file may leave as much. A force of 10⁻¹⁰ against a motion
    /// that is resisted by 10⁻²⁰ would be one that nothing balances.
    pub(super) fn release_loose(
        &mut self,
        laws: Laws<'_>,
        (released, moving): (&Released, &[usize]),
        load: &mut DVector<f64>,
    ) -> bool {
        let Some((all, loose)) = released.loose_with(&laws.problem.system, moving.iter().copied()) else {
            return false;
        };
        let part = |at: usize, one: usize| all.binary_search(&self.joints[at]).map_or(0.0, |row| loose[(row, one)]);
        let Some(svd) = svd(&DMatrix::from_fn(self.joints.len(), loose.ncols(), part)) else { return false };
        let moves: Vec<usize> = (0..svd.sigma.len()).filter(|&k| svd.sigma[k] > OUTSIDE).collect();
        let motions = svd.u.select_columns(&moves).map(|part| if part.abs() <= OUTSIDE { 0.0 } else { part });
        let own = DVector::from_fn(self.joints.len(), |at, _| load[self.joints[at]]);
        let work = motions.tr_mul(&own);
        if work.amax() > OUTSIDE * own.amax() {
            return false;
        }
        let along = &motions * work;
        self.joints.iter().zip(along.iter()).for_each(|(&joint, part)| load[joint] -= part);
        let across = motions.tr_mul(&self.stiffness);
        self.stiffness -= &motions * across;
        let across = &self.stiffness * &motions;
        self.stiffness -= across * motions.transpose();
        true
    }

    /// Entry of two of its joints.
    pub(super) fn entry(&self, row: usize, column: usize) -> f64 {
        self.stiffness[(self.place[row], self.place[column])]
    }

    /// The load's rate in its joints, and what of it may be rounding; both over all joints, and of no meaning in others.
    /// `sizes`: Σ |terms| of the load's rate.
    ///
    /// R is known to some ε √(R_ii R_kk), so that every force of what follows is known to NOISE times such terms. A released
    /// joint whose force is wrong by that follows wrongly, and each joint feels it as its own dislocation moves that one.
    pub(super) fn load(
        &self,
        laws: Laws<'_>,
        released: &Released,
        (rate, sizes): (&DVector<f64>, &DVector<f64>),
    ) -> (DVector<f64>, DVector<f64>) {
        let system = &*laws.problem.system;
        let scales = joint_scales(system);
        let follow = released.solve(&released.pick(rate));
        let (mut load, mut terms) = (rate.clone(), 0.0);
        for (&joint, v) in released.joints.iter().zip(follow.iter()) {
            load.axpy(-v, &system.stiffness.column(joint), 1.0);
            terms += scales[joint] * v.abs();
        }
        let own = |joint: usize| NOISE * (sizes[joint] + scales[joint] * terms);
        let mut noise = DVector::from_fn(load.len(), |joint, _| own(joint));
        for (&joint, follow) in self.joints.iter().zip(self.follow.column_iter()) {
            let others = released.joints.iter().zip(follow.iter());
            noise[joint] += others.map(|(&other, by)| by.abs() * own(other)).sum::<f64>();
        }
        (load, noise)
    }
}
