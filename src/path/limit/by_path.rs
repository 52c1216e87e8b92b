//! What the end of a load path says of the limit of the load.

use std::sync::Arc;

use super::record::{BESIDE, Limit, beside, size};
use crate::answer::record::Verdict;
use crate::contact::problem::ContactProblem;
use crate::explain::ray;
use crate::lcp::problem::NOISE;
use crate::model::rules::{Covering, Rules};
use crate::path::end::PathEnd;
use crate::path::load::LoadPath;
use crate::path::start::PathError;
use crate::solve::{Case, Prepared};

/// What the end of a path says of the limit.
pub(super) fn of_path(case: Case<'_>, path: LoadPath, negative: bool) -> Result<Limit, PathError> {
    let present = path.parameter.present;
    // A limit that is rounding beside the present value is 0.
    let factor = path.limit().map(|factor| if factor.abs() <= NOISE * present.abs() { 0.0 } else { factor });
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
        beyond: None,
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
            limit.lost = !beside_answers(path, case, inside)?;
        }
        return Ok(());
    };
    let outwards = if negative { -1.0 } else { 1.0 } * BESIDE * size(factor, limit.present);
    let over = factor + outwards;
    let solve = |prepared: &Prepared| Case { prepared, ..case }.under(Rules::default()).solve_pairs();
    let (there, factors) = beside(&path.parameter, path.moves_loads(), case, over)?;
    let Some(system) = there.system() else { return Ok(()) };
    let above = solve(&there)?;
    if above.answer.is_answer() && !above.answer.marginal {
        (limit.factor, limit.safety, limit.beyond) = (None, None, Some(over));
        return Ok(());
    }
    if factor != 0.0 && !above.answer.is_answer() {
        limit.confirmed = beside_answers(path, case, factor - outwards)?;
        limit.lost = !limit.confirmed;
    }
    let problem = ContactProblem { system: Arc::clone(system), factors, ..path.problem_at(over) };
    let mut collapse = ray::look(&problem, path.contact(), direction, 0.0);
    if let Some(found) = &above.ray {
        collapse.class = found.class;
    }
    ray::certify_ray(&mut collapse, &problem, there.built());
    ray::explain(&mut collapse, &problem, there.built());
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

/// Whether a run of its own finds an answer at a value.
fn beside_answers(path: &LoadPath, case: Case<'_>, value: f64) -> Result<bool, PathError> {
    let (there, _) = beside(&path.parameter, path.moves_loads(), case, value)?;
    Ok(Case { prepared: &there, ..case }.under(Rules::default()).solve_pairs()?.answer.is_answer())
}
