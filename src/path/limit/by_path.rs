//! What the end of a load path says of the limit of the load.

use std::sync::Arc;

use super::record::Limit;
use crate::answer::record::Verdict;
use crate::contact::problem::ContactProblem;
use crate::explain::ray;
use crate::model::rules::Covering;
use crate::path::beside::{BESIDE, Beside, size};
use crate::path::end::PathEnd;
use crate::path::load::LoadPath;
use crate::path::start::PathError;
use crate::solve::Case;

/// What the end of a path says of the limit.
pub(super) fn of_path(case: Case<'_>, path: LoadPath, negative: bool) -> Result<Limit, PathError> {
    let present = path.parameter.present;
    let factor = path.limit();
    let safety = factor.filter(|_| present != 0.0).map(|factor| factor / present);
    let mut limit = Limit {
        name: path.parameter.name.clone(),
        last: path.factors.last().copied().unwrap_or(path.start),
        path: None,
        present,
        factor,
        safety,
        collapse: None,
        confirmed: false,
        beyond: path.end.answer_beyond(),
        bracket: None,
        proof: None,
        polygon_only: false,
        lost: false,
    };
    look_beside(&mut limit, &path, case, negative)?;
    limit.path = Some(path);
    Ok(limit)
}

/// Adds what runs of their own on both sides of the end of a path show.
fn look_beside(limit: &mut Limit, path: &LoadPath, case: Case<'_>, negative: bool) -> Result<(), PathError> {
    let (Some(factor), PathEnd::Limit(direction)) = (limit.factor, &path.end) else {
        // Before a turning point there are answers, unless the path was led there by rounding.
        if let PathEnd::Turning = &path.end {
            let inside = limit.last - BESIDE * (limit.last - path.start);
            limit.lost = !path.run_at(case, inside)?.solved.answer.is_answer();
        }
        return Ok(());
    };
    let outwards = if negative { -1.0 } else { 1.0 } * BESIDE * size(factor, limit.present);
    let Some(Beside { value, prepared, factors, solved: above }) = path.beside_end.as_deref() else { return Ok(()) };
    let Some(system) = prepared.system() else { return Ok(()) };
    if factor != 0.0 && !above.answer.is_answer() {
        limit.confirmed = path.run_at(case, factor - outwards)?.solved.answer.is_answer();
        limit.lost = !limit.confirmed;
    }
    let problem = ContactProblem { system: Arc::clone(system), factors: factors.clone(), ..path.problem_at(*value) };
    let mut collapse = ray::look(&problem, path.contact(), direction, 0.0);
    // A ray that is the run's own says nothing against the motion in which the path ends.
    if let Some(found) = above.ray.as_ref().filter(|found| found.class.is_of_structure()) {
        collapse.class = found.class;
    }
    ray::certify_ray(&mut collapse, &problem, prepared.built());
    ray::explain(&mut collapse, &problem, prepared.built());
    let mut collapse = collapse.record(system, Covering::default());
    collapse.p = 0.0;
    // Where no motion proves it, the run beside the limit may have shown that there is no answer there.
    if !collapse.verdict.is_some_and(Verdict::is_proof) {
        let shown = above.answer.ray.as_ref().and_then(|ray| ray.verdict).filter(|verdict| verdict.is_proof());
        collapse.verdict = shown.or(collapse.verdict);
    }
    limit.put_collapse(collapse);
    Ok(())
}
