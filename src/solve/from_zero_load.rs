//! The retry that does not start from the load: from zero load, where nothing is violated, the answer is followed
//! along the growing load (method §4, "Rays").

use nalgebra::DVector;

use crate::answer::attempt::{Attempt, AttemptEngine, AttemptRules};
use crate::answer::record::OutcomeKind;
use crate::contact::lcp::contact_lcp_like;
use crate::contact::load_path::path_lcp;
use crate::contact::problem::ContactProblem;
use crate::lcp::basis::Basis;
use crate::lcp::outcome::Point;
use crate::lcp::parametric::{End, Parametric, Reach};
use crate::model::rules::Rules;
use crate::solve::cold::Extent;
use crate::solve::error::SolveError;
use crate::solve::prepared::Prepared;
use crate::solve::state::Solved;
use crate::watch::Watch;

/// A path with more pivots is given up.
const PIVOTS: usize = 20_000;

/// How the path from zero load ended.
pub(super) enum AlongLoad {
    /// At the load.
    Answer(Box<Solved>),
    /// Before it.
    Ended(Attempt),
    /// It was not followed: there are gaps (zero load then is no simpler start).
    NotTried,
}

impl Prepared {
    /// The answer at the end of the path from zero load, turning points passed through.
    ///
    /// # Errors
    /// Where the default covering does not fit the numbers.
    pub(super) fn along_load(&self, problem: &ContactProblem, watch: &dyn Watch) -> Result<AlongLoad, SolveError> {
        let system = &*problem.system;
        // Joints in force form start from gaps that fit, so none may be forced either.
        let forced = system.force_form.is_some();
        if problem.gaps().any(|gap| gap > 0.0 || forced && gap != 0.0) {
            return Ok(AlongLoad::NotTried);
        }
        let mut rest = problem.clone();
        rest.set_load(DVector::zeros(system.joint_count()));
        let path = path_lcp(&rest, &problem.load);
        let nothing = Basis { z: Vec::new(), active: Vec::new(), p: false };
        let Some(mut engine) = Parametric::new(path.lcp.clone(), &nothing, path.lexicographic_order()) else {
            return Ok(AlongLoad::NotTried);
        };
        let reach = Reach { target: 1.0, through: true, pivots: PIVOTS };
        let mut reached = 0.0;
        let (end, pivots) = engine.walk(reach, &mut |t| {
            reached = t;
            watch.go_on()
        });
        let rules = AttemptRules::from(Rules::default()).by(AttemptEngine::LoadPath);
        let (outcome, why) = match end {
            End::Target => (OutcomeKind::Normal, String::new()),
            End::Interrupted => return Err(SolveError::Interrupted),
            End::PivotLimit => (OutcomeKind::PivotLimit, format!("the limit of {PIVOTS} pivots was reached")),
            End::Returned => (OutcomeKind::Ray, "the path from zero load comes back to zero load".to_owned()),
            End::Limit(_) | End::Turning | End::Unbounded => {
                (OutcomeKind::Ray, format!("the path from zero load ends at {reached:.6} of the load"))
            }
            End::Breakdown(why) => (OutcomeKind::Breakdown, why),
        };
        if outcome != OutcomeKind::Normal {
            let attempt = Attempt { pivots: Some(pivots), why: Some(why), ..Attempt::new(rules, outcome) };
            return Ok(AlongLoad::Ended(attempt));
        }
        let contact = contact_lcp_like(Some(&path), problem, Rules::default().covering)?;
        let length = path.length_unit / contact.length_unit;
        let point = Point {
            z: engine.point().z.iter().map(|z| (z * length).max(0.0)).collect(),
            w: vec![0.0; contact.rows.len()],
            p: 0.0,
        };
        let mut solved = self.answer_at(problem, contact, point, rules, Extent::Whole)?;
        solved.answer.attempts.iter_mut().for_each(|attempt| attempt.pivots = Some(pivots));
        Ok(AlongLoad::Answer(Box::new(solved)))
    }
}

#[cfg(test)]
mod tests {
    use super::AlongLoad;
    use crate::answer::same::same_answer;
    use crate::model::embedded;
    use crate::solve::prepare;
    use crate::solve::problem::{contact_problem, factors};
    use crate::watch::Quiet;

    #[test]
    fn the_load_path_ends_in_the_answer_of_the_cold_run() {
        for name in ["beam", "frame", "frame-rotated", "plates-hinged", "plates-free", "greco", "block"] {
            let scenario = embedded::load(name).expect("embedded");
            let prepared = prepare(&scenario, &Quiet).expect("sound");
            let values = scenario.parameter_values();
            let cold = prepared.case(&scenario, &values).solve().expect("solved");
            assert!(cold.answer.is_answer(), "{name}");
            let system = prepared.system().expect("a contact problem");
            let factors = factors(&prepared, &values);
            let problem = contact_problem(system, &factors, &values);
            let AlongLoad::Answer(found) = prepared.along_load(&problem, &Quiet).expect("covered") else {
                panic!("{name}: no way")
            };
            assert!(found.answer.check.passed, "{name}");
            assert!(same_answer(&found.answer, &cold.answer), "{name}");
        }
    }
}
