//! Schemes of a rate problem that leave a motion of the kernel to itself.
//!
//! Where pairs open or slip so that a body can move without strain, the equations of the scheme are singular, and what their
//! rounding makes of them are rates of any size: the load's rate divided by a stiffness that is rounding. Either the motion is
//! not driven, and its rate is 0 for all that is known, or nothing balances the load's rate and there are no rates.
//!
//! A soft spring resists little, but more than rounding does: rates against it are large, and known. How far they may lead is told
//! by the state at their end ([`super::walk`]).

use nalgebra::DVector;

use super::rate_problem::{RateProblem, Rates, Resistance, terms};
use super::released::{loose_motions, part_along};
use super::standing::Standing;
use crate::answer::pairs::JointState;
use crate::contact::problem::ContactProblem;
use crate::contact::sum::{HIDDEN, LAW_ROUNDING};
use crate::lcp::problem::NOISE;

/// The largest part of the load's rate that rounding may hide in rates against little: they are known to two digits then, and
/// neither their sense nor the limit that they come to first hangs on it.
const LITTLE: f64 = 1e-2;

impl RateProblem<'_> {
    /// What resists these rates.
    pub(super) fn resistance(&self, standing: &Standing, rates: &Rates) -> Resistance {
        let (laws, released) = (self.laws, &self.released);
        let Some((joints, loose)) = self.loose_of(released, &rates.moving) else {
            return match self.hidden(rates) {
                hidden if hidden <= HIDDEN => Resistance::Clear,
                hidden if hidden <= LITTLE => Resistance::Little,
                _ => Resistance::None(rates.z.clone()),
            };
        };
        let motion = part_along(&loose, &joints, &rates.z);
        let z = &rates.z - &motion;
        let (force, sizes) = (laws.force(&z, self.rate), laws.force_sizes(&z, self.sizes));
        let balances = |terms: &[(usize, f64)]| {
            let sum = |of: &DVector<f64>| terms.iter().map(|(joint, by)| by * of[*joint]).sum::<f64>();
            let size: f64 = terms.iter().map(|(joint, by)| (by * sizes[*joint]).abs()).sum();
            sum(&force).abs() <= NOISE * size
        };
        let is_driven = released.joints.iter().any(|&joint| !balances(&[(joint, 1.0)]))
            || rates.moving.iter().any(|row| !balances(&terms(laws, *row, standing.is_open(row.pair))));
        // What all that they obey holds without is not driven.
        if is_driven { Resistance::None(motion) } else { Resistance::Clear }
    }

    /// The part of the load's rate that the rounding of the terms of the forces may hide that these rates give.
    fn hidden(&self, rates: &Rates) -> f64 {
        let sizes = self.laws.force_sizes(&rates.z, self.sizes);
        LAW_ROUNDING * sizes.amax() / self.sizes.amax()
    }
}

/// A state with the forces that it has without the motion of the kernel that its scheme leaves to itself; `None` where there is no
/// such motion.
///
/// R moves nothing along it, so that the forces of both are the same but for its rounding: where only the first obey the laws, the
/// stiffness that resists the loads is rounding, and so are its displacements.
pub(super) fn without_loose_motion(problem: &ContactProblem, state: &JointState) -> Option<JointState> {
    let system = &*problem.system;
    let slides_freely = |i: usize| state.z[i] > 0.0 && problem.laws[i].bound(0.0) == 0.0;
    let free =
        (0..system.pair_count()).filter(|&i| slides_freely(i)).filter_map(|i| system.pairs[i].plane_tangential());
    let mut joints: Vec<usize> = (0..state.z.len()).filter(|&joint| state.z[joint] != 0.0).chain(free).collect();
    joints.sort_unstable();
    joints.dedup();
    let loose = loose_motions(system, &joints);
    if loose.ncols() == 0 {
        return None;
    }
    let z = &state.z - part_along(&loose, &joints, &state.z);
    Some(JointState { z: state.z.clone(), ..JointState::at(problem, z, 0.0) })
}
