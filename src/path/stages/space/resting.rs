//! Where joints that repeat one another rest in space.

use super::leg::along;
use super::{SpaceWalk, mean};
use crate::answer::check::check_contact;
use crate::contact::at_rest::AtRest;
use crate::path::cone_step::{Scheme, Step, behind_slips, exactly_behind};
use crate::path::stages::course::Course;
use crate::path::stages::follower::{Follower, Way};
use crate::path::stages::integrals::Integrals;
use crate::path::stages::resting::{Beyond, Rest, rest};
use crate::path::start::PathError;

impl SpaceWalk<'_> {
    /// Whether forces resist no motion at all, as where rigid bodies stand on the ground: then any motion within a step is
    /// rounding as long as they can rest.
    pub(super) fn is_rigid(&self) -> bool {
        let system = &self.place.laws.problem.system;
        let exact = system.yielding.as_ref().map(|yielding| &yielding.exact);
        exact.is_some_and(|exact| {
            let independent = |joint: &usize| !exact.is_forced(*joint);
            let joints: Vec<usize> = (0..exact.joint_count()).filter(independent).collect();
            joints.iter().all(|&i| joints.iter().all(|&j| exact.stiffness[(i, j)] == 0.0))
        })
    }

    /// The place up to which joints that repeat one another are at rest from t on; `None` where they cannot rest.
    pub(super) fn rest(&mut self, course: &Course, t: f64, way: &mut Way) -> Result<Option<(f64, Scheme)>, PathError> {
        let laws = self.place.laws;
        let problem = along(laws.problem, course);
        let behind = |to: f64| exactly_behind(&problem(to), &self.z);
        let passes = |to: f64, found: &AtRest| {
            let increments = Step::at_rest(problem(to), &self.z, found.clone()).increments;
            check_contact(&behind_slips(problem(to), &self.z), &increments, None).passed
        };
        let Some(Rest { to, found }) =
            rest(&Beyond { behind: &behind, passes: &passes }, self.here(), t, self.place.watch)?
        else {
            return Ok(None);
        };
        let step = Step::at_rest(problem(to), &self.z, found);
        let (ends, forces) = ([&self.z, &step.z], [&self.increments.force, &step.increments.force]);
        let straight = Integrals::straight(to - t, ends, forces, &laws.problem.system);
        self.rate = (&step.z - &self.z) / (to - t);
        way.last_slip = step.increments.z.clone();
        way.rest([t, to]);
        let scheme = step.scheme.clone();
        self.stand(step, scheme.clone(), mean(straight, to - t), (course.factors_at(to), course.gaps_at(to)));
        // Its ends say all of a straight way.
        self.integrals = None;
        way.moments.push(self.moment(to, false));
        Ok(Some((to, scheme)))
    }
}
