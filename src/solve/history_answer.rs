//! The state at a moment of a load history as an answer: displacements, members, reactions, and its own fresh check.

use nalgebra::DVector;

use super::finish::{empty_answer, judge};
use super::prepared::{Geometry, Prepared};
use crate::answer::check::check_contact;
use crate::answer::pairs::JointState;
use crate::answer::record::{Answer, PairState, Size};
use crate::contact::problem::ContactProblem;
use crate::contact::rows::rows;
use crate::lcp::outcome::{Outcome, Point, Run};
use crate::lcp::pivot::PivotLog;
use crate::lcp::problem::NOISE;
use crate::model::rules::Rules;

impl Prepared {
    /// The answer at a moment of a history: `pairs` and `state` have total displacements, `problem` the load there.
    ///
    /// The laws of contact tie the forces to the latest slip, `last_slip` over the joints, and not to the total one:
    /// the check uses it. Total displacements are sums over the history, so each is as good as the rounding of the largest that
    /// was `met` on the way: where the load is taken off again that, and not the load that is left, is what residuals are small
    /// beside.
    pub(crate) fn history_answer(
        &self,
        problem: &ContactProblem,
        state: &JointState,
        (last_slip, met): (&DVector<f64>, &DVector<f64>),
        pairs: Vec<PairState>,
    ) -> Answer {
        let system = &*problem.system;
        let run =
            Run { outcome: Outcome::Normal { marginal: false }, pivots: PivotLog::default(), point: Point::default() };
        let mut size = Size { pairs: system.pairs.len(), lcp: rows(system, problem.polygon).len(), ..Size::default() };
        if let Geometry::Structure { main, .. } = &*self.geometry {
            (size.unknowns, size.free) = (Some(main.size().all), Some(main.size().free));
        }
        let mut answer = empty_answer(&run, 1.0, Rules::default().into(), size);
        answer.pairs = pairs;
        let equilibrium = self.recover(&mut answer, problem, state, met);
        // λ is computed afresh: the history keeps exact values where the laws give them.
        // Joints that repeat one another are taken as they are, and not as they yield.
        let exact = system.yielding.as_ref().and_then(|yielding| yielding.exactly(problem));
        let exact = exact.as_ref().unwrap_or(problem);
        let stiff = &exact.system;
        let (mut unknowns, _) = state.in_forms(stiff);
        let independent: Vec<usize> = (0..stiff.joint_count()).filter(|&joint| !stiff.is_forced(joint)).collect();
        for &joint in &independent {
            if unknowns[joint].abs() <= NOISE * met[joint] {
                unknowns[joint] = 0.0;
            }
        }
        let mut moved = JointState::at(exact, unknowns, 0.0);
        for joint in system.pairs.iter().flat_map(|pair| pair.tangential.clone()) {
            moved.z[joint] = last_slip[joint];
        }
        for &joint in &independent {
            let felt = independent.iter().map(|&other| stiff.stiffness[(joint, other)].abs() * met[other]);
            moved.terms[joint] += felt.sum::<f64>();
        }
        judge(&mut answer, check_contact(problem, &moved, equilibrium));
        answer
    }
}
