//! The collapse that a certificate on Coulomb's cone stands for.
//!
//! On the motion of a certificate every pair that slips parts by f |ζ_τ| or more: the proof needs that. The pair itself
//! stays closed. So the collapse that is reported is the nearest motion without that opening:
//!
//! ```text
//!     min |z − ζ|   over the motions that cost no energy with  z_n = 0  where  0 < ζ_n ≤ 2 f |ζ_τ|
//! ```
//!
//! if the loads still do work on it and every other pair parts or stays.

use nalgebra::{DMatrix, DVector};

use super::kernel::releasable_kernel;
use super::mode::STILL;
use super::motions::direction_of;
use crate::contact::on_cone::widest_cone_pairs;
use crate::contact::problem::ContactProblem;

/// A pair that parts by no more than this many times f |ζ_τ| parts for the sake of the proof, which with room takes
/// somewhat more than f |ζ_τ|; pairs that really lift off hardly slip.
const FOR_THE_PROOF: f64 = 2.0;
/// Most motions for which a singular value decomposition is made.
const MOST_MOTIONS: usize = 240;

/// The motion of a certificate without what only its proof needs, largest entry 1; `None` where there is nothing to
/// take away, or where what is left is no collapse.
pub fn sliding(problem: &ContactProblem, motion: &DVector<f64>) -> Option<DVector<f64>> {
    let pairs = widest_cone_pairs(problem);
    let kernel = releasable_kernel(&problem.system);
    let still = STILL * motion.amax();
    let slip = |pair: usize, z: &DVector<f64>| pairs[pair].tangents.clone().map(|joint| z[joint]).fold(0.0, f64::hypot);
    let parts_for_the_proof = |&pair: &usize| {
        let slip = slip(pair, motion);
        slip > still && motion[pair] > still && motion[pair] <= FOR_THE_PROOF * pairs[pair].law.friction() * slip
    };
    let closed: Vec<usize> = (0..pairs.len()).filter(parts_for_the_proof).collect();
    if closed.is_empty() || kernel.ncols() > MOST_MOTIONS {
        return None;
    }
    // The kernel is orthonormal but for what bound pairs hold: amounts of its columns, less their part in the row space.
    let rows = DMatrix::from_fn(closed.len(), kernel.ncols(), |i, k| kernel[(closed[i], k)]);
    let svd = rows.svd(false, true);
    let mut amounts = kernel.transpose() * motion;
    for (row, sigma) in svd.v_t?.row_iter().zip(&svd.singular_values) {
        if *sigma > STILL * svd.singular_values.amax() {
            let row = row.transpose();
            let share = row.dot(&amounts);
            amounts -= row * share;
        }
    }
    let mut left = &kernel * amounts;
    if left.amax() <= still {
        return None;
    }
    left = direction_of(left);
    closed.iter().for_each(|&pair| left[pair] = 0.0);
    let parts_or_stays = (0..pairs.len()).all(|pair| pairs[pair].law.is_bilateral() || left[pair] >= -STILL);
    let (load, terms) = (&problem.load, &problem.load_terms);
    let [load, terms] = [load, terms].map(|load| problem.system.forces_of(load));
    let (work, size) = (-load.dot(&left), terms.dot(&left.abs()));
    (parts_or_stays && closed.iter().all(|&pair| slip(pair, &left) > STILL) && work > STILL * size).then_some(left)
}
