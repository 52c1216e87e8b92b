//! Pairs whose forces along the normals the load alone decides: elastic along the normals, free to slip away.
//!
//! A motion that slides them costs nothing and does not part them, so that by statics alone they might be pressed by
//! any force, and friction might hold any load. But where no slip is felt along the normals, R_nτ = 0, the forces along
//! them are those of an LCP of their own, the same in every answer:
//!
//! ```text
//!     x_n = R_nn z_n + RF_n ≥ 0 ⟂ z_n ≥ 0
//!     of two solutions   (z − z′)ᵀ R_nn (z − z′) = −zᵀx′ − z′ᵀx ≤ 0   ⇒   R_nn (z − z′) = 0   ⇒   x = x′
//! ```
//! Then the bounds of friction are known, f x_n + c, and a proof needs motions that part no pressed pair and close no open
//! one: it is one of these forces only, and a larger load may press harder.

use nalgebra::DVector;

use crate::contact::cone::ConePair;
use crate::contact::law::PairLaw;
use crate::contact::problem::ContactProblem;
use crate::contact::sum::Sum;
use crate::contact::sums::joint_forces;
use crate::contact::system::ContactSystem;
use crate::lcp::problem::NOISE;
use crate::lcp::solution::solution;

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
    let (z, forces) = normals(problem, &(0..pairs.len()).filter(opens).collect::<Vec<_>>())?;
    let known = |(i, pair): (usize, &ConePair)| {
        let most = forces[i].value.max(0.0) + forces[i].error();
        let law = match pair.law.is_bilateral() {
            true => pair.law,
            false if z[i] > 0.0 => PairLaw::rubbing(0.0, pair.law.fixed_bound(), 0.0),
            false => PairLaw::bilateral(pair.law.bound(most)),
        };
        ConePair { law, tangents: pair.tangents.clone() }
    };
    Some(pairs.iter().enumerate().map(known).collect())
}

/// Openings, and forces of all joints while none slips: x_n of the pairs that can open is that of every answer. `None`
/// where the load opens them without end, or where rounding leaves doubts.
fn normals(problem: &ContactProblem, pairs: &[usize]) -> Option<(DVector<f64>, Vec<Sum>)> {
    let stiffness = &problem.system.stiffness;
    let mut z = DVector::zeros(problem.system.joint_count());
    let mut forces = joint_forces(problem, &z);
    let size = pairs.iter().map(|&i| forces[i].value.abs()).fold(0.0, f64::max);
    if pairs.iter().any(|&i| forces[i].value < -forces[i].error()) {
        let stiffest = pairs.iter().map(|&i| stiffness[(i, i)]).fold(f64::MIN_POSITIVE, f64::max);
        let row = |&i: &usize| pairs.iter().map(|&j| stiffness[(i, j)] / stiffest).collect();
        let opened =
            solution(pairs.iter().map(row).collect(), pairs.iter().map(|&i| forces[i].value / size).collect())?;
        pairs.iter().zip(opened).for_each(|(&i, opened)| z[i] = opened * size / stiffest);
        forces = joint_forces(problem, &z);
    }
    let obeys = |&i: &usize| forces[i].value >= -forces[i].error() && (z[i] == 0.0 || forces[i].is_zero());
    (pairs.iter().all(obeys) && z.iter().all(|z| *z >= 0.0)).then_some((z, forces))
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
