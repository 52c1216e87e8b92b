//! The fresh check: the laws of contact evaluated from R, RF and f, without the LCP or any engine.

use nalgebra::DVector;

use super::pairs::JointState;
use super::record::Check;
use crate::contact::on_cone::OnCone;
use crate::contact::problem::ContactProblem;
use crate::contact::sum::{HIDDEN, LAW_ROUNDING, Sum};
use crate::contact::sums::{pair_sums, share_of};

/// Rounding of a sum of products whose factors are rounded once, as a share of the magnitude of its terms.
const LAST_DIGIT: f64 = 4.0 * f64::EPSILON;

/// Largest relative violation that an answer may have where sizes are those of a whole problem.
pub const TOLERANCE: f64 = 1e-9;

/// Checks an answer over the joints, row by row: forces and reserves as shares of the terms they are summed from
/// (loads, gaps closed by force, R z), displacements as the share of those forces that depends on them, and of a couple
/// the smaller of the two shares. `equilibrium` is ‖K u − F − Bᵀλ‖ relative, where there is a K.
pub fn check_contact(problem: &ContactProblem, state: &JointState, equilibrium: Option<f64>) -> Check {
    let system = &*problem.system;
    let forces: Vec<Sum> = (0..system.joint_count()).map(|joint| state.sum(joint)).collect();
    if system.is_in_space() && problem.cone {
        return check_on_cone(problem, state, &forces, equilibrium);
    }
    // Joints that repeat one another are judged as they are: beside what they would be if they yielded, rounding is large.
    if let Some(exact) = system.yielding.as_ref().and_then(|yielding| yielding.exactly(problem)) {
        return check_contact(&exact, state, equilibrium);
    }
    let mut check = Check { equilibrium, ..Check::default() };
    let (unknowns, responses) = state.in_forms(system);
    let share = |joint: usize, moved: f64| match system.is_forced(joint) {
        true => Sum { value: moved, ..responses[joint] }.share(),
        false => share_of(system, &unknowns, &responses, (joint, moved)),
    };
    let mut couple = |x: Sum, z: f64, share: f64| {
        check.min_w = check.min_w.min(x.share());
        check.min_z = check.min_z.min(if z < 0.0 { -share } else { 0.0 });
        // One of the two is zero by its own terms: a product of two small shares would excuse both.
        let smaller = if z == 0.0 { 0.0 } else { x.share().abs().min(share) };
        check.complementarity = check.complementarity.max(smaller);
    };
    for (i, pair) in system.pairs.iter().enumerate() {
        let sums = pair_sums(problem, &forces, (i, state.z[i] > 0.0));
        match sums.normal {
            Some(normal) => couple(normal, state.z[i], share(i, state.z[i].abs())),
            // Held in both directions: the joints that it repeats must leave it at rest.
            None if system.is_forced(i) => couple(Sum::exactly(1.0), state.z[i], share(i, state.z[i].abs())),
            None => {}
        }
        let slips = problem.polygon.slips(state.slip(pair));
        for (facet, (reserve, slip)) in sums.reserves.into_iter().zip(slips).enumerate() {
            // Next to a facet, rounding leaves a slip along the neighbouring one, on which hardly any force depends.
            let along = pair.tangential.clone().zip(problem.polygon.direction(facet));
            let hangs = along.map(|(joint, d)| share(joint, (slip * d).abs())).fold(0.0, f64::max);
            couple(reserve, slip, hangs);
        }
    }
    for left in &state.left {
        check.complementarity = check.complementarity.max(left.share().abs());
    }
    let loads = load_size(problem);
    if loads > 0.0 {
        let free = (0..system.joint_count()).filter(|&joint| !system.is_forced(joint));
        check.hidden = free.map(|joint| LAW_ROUNDING * forces[joint].magnitude / loads).fold(0.0, f64::max);
    }
    check.passed = check.is_within(LAW_ROUNDING);
    check
}

/// The same against Coulomb's cone; a friction force that does not oppose its slip counts among the couples.
fn check_on_cone(problem: &ContactProblem, state: &JointState, forces: &[Sum], equilibrium: Option<f64>) -> Check {
    let found = OnCone::new(problem).check(&state.z, forces);
    let left = state.left.iter().map(|left| left.share().abs());
    let mut check = Check {
        min_w: found.min_w,
        min_z: found.min_z,
        complementarity: left.fold(found.complementarity.max(found.misdirection), f64::max),
        equilibrium,
        hidden: found.hidden,
        ..Check::default()
    };
    check.passed = found.passed && check.is_within(LAW_ROUNDING);
    check
}

/// The largest load on a joint, its terms and those of gaps and known bounds taken by their magnitude.
fn load_size(problem: &ContactProblem) -> f64 {
    let mut closing: DVector<f64> = DVector::zeros(problem.load.len());
    for (joint, gap) in problem.gaps().enumerate().filter(|(_, gap)| *gap != 0.0) {
        let column = problem.system.stiffness.column(joint);
        closing.iter_mut().zip(column.iter()).for_each(|(sum, entry)| *sum += entry.abs() * gap.abs());
    }
    let bounds = problem.fixed_bounds().into_iter().fold(0.0, f64::max);
    problem.load_terms.amax().max(closing.amax()).max(bounds)
}

impl Check {
    /// Whether no law is violated by more than this share of the terms of its row, and what belongs to the whole problem
    /// is within its own bounds.
    pub fn is_within(&self, tolerance: f64) -> bool {
        // Written so that a NaN anywhere is a failure.
        self.min_w >= -tolerance
            && self.min_z >= -tolerance
            && self.complementarity <= tolerance
            && self.hidden <= HIDDEN
            && self.equilibrium_holds()
    }

    /// The same of a state that is proved by exact data: it is known to its last digit, and what this hides of the loads is all
    /// that is hidden. Where that is too much, what is shown is not what was proved.
    pub fn of_proved_state(&self) -> Check {
        let mut check = Check { hidden: self.hidden * (LAST_DIGIT / LAW_ROUNDING), ..*self };
        check.passed = check.is_within(LAW_ROUNDING);
        check
    }

    fn equilibrium_holds(&self) -> bool {
        self.equilibrium.is_none_or(|residual| residual <= TOLERANCE)
    }

    /// A check of the joints alone with the residual of the structure's equilibrium, which completes it.
    pub fn with_equilibrium(self, equilibrium: Option<f64>) -> Check {
        let mut check = Check { equilibrium, joints_only: false, ..self };
        check.passed = self.passed && check.equilibrium_holds();
        check
    }
}
