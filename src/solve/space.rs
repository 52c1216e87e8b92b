//! Retries in space: a ray at one polygon is not final (method §7). Turned and finer polygons are tried until an answer
//! reaches Coulomb's cone or a collapse is certified on it; without either, the last of them says what is known.

use std::f64::consts::TAU;

use super::cold::Extent;
use super::error::SolveError;
use super::ladder::Ladder;
use super::prepared::Prepared;
use super::state::Solved;
use crate::contact::polygon::Polygon;
use crate::contact::problem::ContactProblem;
use crate::explain::ray::certify_ray;
use crate::model::rules::Rules;
use crate::watch::Watch;

/// Finest polygon of the retries: a twist at 1.005 of its limit needs 32 facets, a push at 17° 64.
const FINEST: u16 = 64;
/// Parts of the angle between two facets by which polygons are turned.
const TURNS: [f64; 4] = [0.0, 0.5, 0.25, 0.75];
/// Rows of an LCP beyond which no finer polygon is tried: its dictionary would take gigabytes.
const MOST_ROWS: usize = 8_000;

/// The polygons after the first one, each with its turn.
fn polygons(facets: u16, pairs: usize) -> Vec<Polygon> {
    let mut all = Vec::new();
    let mut finer = facets;
    while finer <= FINEST.max(facets) && (1 + usize::from(finer) / 2) * pairs <= MOST_ROWS {
        let step = TAU / f64::from(finer);
        all.extend(TURNS.iter().map(|turn| Polygon::regular(finer, turn * step)));
        finer *= 2;
    }
    // The first of all has failed.
    all.into_iter().skip(1).collect()
}

impl Prepared {
    /// What the run on the first polygon leaves open, under the default rules of covering and ties.
    pub(super) fn retry_in_space(
        &self,
        problem: &ContactProblem,
        rules: Rules,
        first: Solved,
        watch: &dyn Watch,
    ) -> Result<Solved, SolveError> {
        // An answer on one of the finest polygons that Newton's method could not take to the cone. One on a coarser
        // polygon does not count where the finer ones have none: friction beyond Coulomb's bound held it.
        let mut on_polygon = first.answer.is_answer().then(|| first.clone());
        let mut last = first.clone();
        // A certificate depends on the cone, not on the polygon inside it: what was looked for in vain is not looked
        // for again.
        let mut in_vain = first.ray.as_ref().and_then(|report| report.in_vain());
        let mut ladder = Ladder::new(first);
        let mut facets = usize::from(rules.facets);
        for polygon in polygons(rules.facets, problem.system.pairs.len()) {
            if polygon.facets() > facets {
                facets = polygon.facets();
                on_polygon = None;
                // Around a polygon that is solved for its own sake the cone is the narrower the finer it is.
                in_vain = in_vain.filter(|_| problem.cone);
            }
            if watch.stop() {
                return Err(SolveError::Interrupted);
            }
            let turned = problem.clone().with_polygon(polygon);
            let mut again = self.attempt_contact(&turned, (rules, Extent::Whole), watch)?;
            let certified = again.ray.as_mut().is_some_and(|report| {
                if let Some(out_of_time) = in_vain {
                    report.leave_undecided(out_of_time);
                    return false;
                }
                let certified = certify_ray(report, &turned, self.built());
                in_vain = report.in_vain();
                certified
            });
            ladder.tried(&mut again);
            if again.stands(problem.cone) {
                let note = format!(
                    "the polygon of {} facets turned by {:.4}° led to it after {} other{}",
                    polygon.facets(),
                    polygon.turn().to_degrees(),
                    ladder.count() - 1,
                    if ladder.count() == 2 { "" } else { "s" }
                );
                again.answer.notes.push(note);
                return Ok(ladder.with_history(again));
            }
            if certified {
                return Ok(ladder.with_history(again));
            }
            if again.answer.is_answer() {
                on_polygon = Some(again.clone());
            }
            last = again;
        }
        if let Some(answer) = self.tried_at_rest(&mut ladder, problem, Extent::Whole, watch)? {
            return Ok(answer);
        }
        Ok(ladder.with_history(on_polygon.unwrap_or(last)))
    }

    /// Covering and ties that the user chose have failed: says whether the default ones do better.
    pub(super) fn compare_in_space(
        &self,
        problem: &ContactProblem,
        rules: Rules,
        solved: &mut Solved,
        watch: &dyn Watch,
    ) -> Result<(), SolveError> {
        let default = Rules { facets: rules.facets, cone: rules.cone, ..Rules::default() };
        let mut other = self.attempt_contact(problem, (default, Extent::Whole), watch)?;
        if !other.stands(problem.cone) {
            other = self.retry_in_space(problem, default, other, watch)?;
        }
        let words = format!("covering {}, tie-break {}", default.covering, default.tie_break);
        solved.say(&match other.stands(problem.cone) {
            true => format!(" The default rules ({words}) find an answer in {} pivots.", other.pivot_count()),
            false => format!(" The default rules ({words}) find no answer either."),
        });
        Ok(())
    }
}
