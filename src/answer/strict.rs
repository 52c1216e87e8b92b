//! Whether a state lies clear of every change of scheme.

use super::pairs::JointState;
use crate::contact::problem::ContactProblem;
use crate::contact::sum::Sum;
use crate::contact::sums::{displacement_share, pair_sums};
use crate::contact::unique::is_determined;

/// A force, a reserve or a displacement is clear of zero above this share of its terms: far above the rounding that may
/// sway an engine, which takes less than 1e-14 for zero.
const CLEAR: f64 = 1e-7;

/// Whether one member of each couple is clear of zero, so that only one scheme has this state, and whether the joints
/// that are held leave no motion of the kernel free. Where the forces are unique, such a state is unique.
pub fn is_strict(problem: &ContactProblem, state: &JointState) -> bool {
    let system = &*problem.system;
    if system.is_in_space() {
        // A slip that may turn is not examined.
        return false;
    }
    let forces: Vec<Sum> = (0..system.joint_count()).map(|joint| state.sum(joint)).collect();
    let mut held = vec![false; forces.len()];
    for (i, pair) in system.pairs.iter().enumerate() {
        let moves = |joint: usize| displacement_share(system, &state.z, &forces, joint) >= CLEAR;
        let is_open = state.z[i] > 0.0;
        let sums = pair_sums(problem, &forces, (i, is_open));
        held[i] = !is_open;
        let normal = sums.normal.is_none_or(|normal| if is_open { moves(i) } else { normal.share() >= CLEAR });
        let (Some(joint), &[plus, minus]) = (pair.plane_tangential(), &sums.reserves[..]) else {
            if !normal {
                return false;
            }
            continue;
        };
        let slip = state.z[joint];
        held[joint] = slip == 0.0;
        // An open pair that nothing holds slips either way: the sign of its slip is a matter of the scheme too.
        let free = is_open && problem.laws[i].fixed_bound() == 0.0;
        let tangential = match slip {
            0.0 => !free && plus.share() >= CLEAR && minus.share() >= CLEAR,
            _ if free => moves(joint),
            slip => moves(joint) && (if slip > 0.0 { minus } else { plus }).share() >= CLEAR,
        };
        if !(normal && tangential) {
            return false;
        }
    }
    is_determined(system, &|joint| held[joint])
}
