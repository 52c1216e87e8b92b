//! The retry for joints that repeat one another: the answer in which they do not move, which pivots may pass by
//! ([`crate::contact::at_rest`]).

use super::cold::Extent;
use super::error::SolveError;
use super::ladder::Ladder;
use super::prepared::Prepared;
use super::state::Solved;
use crate::answer::attempt::{AttemptEngine, AttemptRules};
use crate::answer::pairs::JointState;
use crate::answer::record::PolygonRecord;
use crate::contact::at_rest::at_rest;
use crate::contact::cone::ConeFailure;
use crate::contact::lcp::contact_lcp;
use crate::contact::problem::ContactProblem;
use crate::contact::rows::RowKind;
use crate::lcp::outcome::{Outcome, Point, Run};
use crate::lcp::pivot::PivotLog;
use crate::model::rules::Rules;
use crate::watch::Watch;

impl Prepared {
    /// The last rung of a ladder: the answer in which no joint moves that repeats another, with all tries before it; `None`
    /// where there is none, or where it fails its check, which is then a try like the others.
    ///
    /// # Errors
    /// Stopped from outside.
    pub(super) fn tried_at_rest(
        &self,
        ladder: &mut Ladder,
        problem: &ContactProblem,
        extent: Extent,
        watch: &dyn Watch,
    ) -> Result<Option<Solved>, SolveError> {
        Ok(self.answer_at_rest(problem, extent, watch)?.and_then(|again| ladder.add(again).ok()))
    }

    /// That answer, freshly checked; `None` where there is none.
    ///
    /// # Errors
    /// Stopped from outside.
    fn answer_at_rest(
        &self,
        problem: &ContactProblem,
        extent: Extent,
        watch: &dyn Watch,
    ) -> Result<Option<Solved>, SolveError> {
        let found = match at_rest(problem, watch) {
            Ok(Some(found)) => found,
            Err(ConeFailure::Stopped) => return Err(SolveError::Interrupted),
            Ok(None) | Err(_) => return Ok(None),
        };
        let system = &*problem.system;
        let contact = contact_lcp(problem, Rules::default().covering)?;
        let state = JointState::at_rest(problem, found);
        let mut z = vec![0.0; contact.rows.len()];
        for ((z, row), swapped) in z.iter_mut().zip(&contact.rows).zip(&contact.swapped) {
            let slip = system.pairs[row.pair].slip(&state.z);
            *z = match (row.couple, swapped) {
                (RowKind::Normal, true) => state.force[row.pair] / contact.force_unit,
                (RowKind::Normal, false) => state.z[row.pair] / contact.length_unit,
                (RowKind::Facet(facet), false) => problem.polygon.slips(slip)[usize::from(facet)] / contact.length_unit,
                (RowKind::Facet(_), true) => {
                    let bound = problem.laws[row.pair].bound(state.force[row.pair].max(0.0));
                    let along = system.pairs[row.pair].plane_tangential().map_or(0.0, |joint| state.force[joint]);
                    (bound + along).max(0.0) / contact.force_unit
                }
            };
        }
        let point = Point { w: vec![0.0; z.len()], z, p: 0.0 };
        let run = Run { outcome: Outcome::Normal { marginal: false }, pivots: PivotLog::default(), point };
        let polygon = system.is_in_space().then(|| PolygonRecord {
            cone: problem.cone,
            newton: problem.cone.then_some(0),
            ..PolygonRecord::of(problem.polygon)
        });
        let rules = AttemptRules::from(Rules::default()).by(AttemptEngine::AtRest);
        Ok(Some(self.solved_in(problem, (contact, run), (state, polygon), (rules, extent))))
    }
}
