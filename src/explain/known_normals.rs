//! Pairs whose forces along the normals the load alone decides: elastic along the normals, free to slip away.
//!
//! A motion that slides them costs nothing and does not part them, so that by statics alone they might be pressed by
//! any force, and friction might hold any load. But where no slip is felt along the normals, R_nτ = 0, and the main
//! system presses every pair, x_n = RF_n ≥ 0, these are the forces of every answer:
//!
//! ```text
//!     x_n = R_nn z_n + RF_n ≥ 0 ⟂ z_n ≥ 0     ⇒     0 = z_nᵀ x_n = z_nᵀ R_nn z_n + z_nᵀ RF_n,   neither < 0   ⇒   R_nn z_n = 0
//! ```
//! Then the bounds of friction are known, f RF_n + c, and a proof needs motions that part no pair: it is one of these
//! forces only, and a larger load may press harder.

use nalgebra::DVector;

use crate::contact::cone::ConePair;
use crate::contact::law::PairLaw;
use crate::contact::problem::ContactProblem;
use crate::contact::sum::Sum;
use crate::contact::sums::joint_forces;
use crate::contact::system::ContactSystem;
use crate::lcp::problem::NOISE;

/// The pairs in space with the bounds of friction that the load decides; `None` where it does not.
pub(super) fn with_known_normals(problem: &ContactProblem, pairs: &[ConePair]) -> Option<Vec<ConePair>> {
    let system = &*problem.system;
    if !system.is_in_space() || system.force_form.is_some() || system.yielding.is_some() {
        return None;
    }
    let opens = |&i: &usize| !pairs[i].law.is_bilateral();
    if (0..pairs.len()).filter(opens).any(|i| feels_slips(system, pairs, i)) {
        return None;
    }
    let forces = joint_forces(problem, &DVector::zeros(system.joint_count()));
    if (0..pairs.len()).filter(opens).any(|i| forces[i].value < -forces[i].error()) {
        return None;
    }
    let known = |(pair, force): (&ConePair, &Sum)| {
        let most = force.value.max(0.0) + force.error();
        let law = if pair.law.is_bilateral() {
            pair.law
        } else {
            PairLaw::bilateral(pair.law.friction() * most + pair.law.fixed_bound())
        };
        ConePair { law, tangents: pair.tangents.clone() }
    };
    Some(pairs.iter().zip(&forces).map(known).collect())
}

/// Whether some slip changes the force along the normal of a pair; entries of a condensed R that are rounding do not.
fn feels_slips(system: &ContactSystem, pairs: &[ConePair], pair: usize) -> bool {
    let stiffness = &system.stiffness;
    let least = |joint: usize| match system.rounded {
        true => NOISE * (stiffness[(pair, pair)] * stiffness[(joint, joint)]).max(0.0).sqrt(),
        false => 0.0,
    };
    pairs.iter().flat_map(|other| other.tangents.clone()).any(|joint| stiffness[(pair, joint)].abs() > least(joint))
}
