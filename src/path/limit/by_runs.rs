//! The limit of a load in space: no path leads there, since slips turn; runs of their own bracket it, each with an
//! answer on Coulomb's cone or a collapse that is certified on it.

use nalgebra::DVector;

use super::record::Limit;
use crate::contact::sum::LAW_ROUNDING;
use crate::path::beside::{size, there};
use crate::path::edge::{Bracket, CLOSE, Effort, Run, narrowed};
use crate::path::load_parameter::LoadParameter;
use crate::path::start::PathError;
use crate::solve::problem::factors;
use crate::solve::{Case, Prepared};

/// Each increase of the load is this many times the one before it …
const GROWTH: f64 = 4.0;
/// … up to this multiple of its present size.
const MOST: f64 = 1e9;

/// The limit of a load case or load parameter, outwards from its present value, or from 0 where there is no answer.
pub(super) fn limit_by_runs(case: Case<'_>, name: &str) -> Result<Limit, PathError> {
    let (parameter, grown) = LoadParameter::find(case, name)?;
    let grown_or_own = grown.as_deref().unwrap_or(case.prepared);
    if grown_or_own.system().is_some_and(|system| parameter.direction(system).amax() == 0.0) {
        return Err(PathError::Idle(parameter.name));
    }
    let prepared_at = |value: f64| there(&parameter, grown.is_some(), case, value).map(|(prepared, _)| prepared);
    let run_by = |value: f64, effort| -> Result<Run, PathError> {
        case.watch.progress(&format!("{name} = {value}"), 0.0);
        let prepared = prepared_at(value)?;
        Run::of(value, Case { prepared: &prepared, ..case }, effort)
    };
    let run = |value: f64| run_by(value, Effort::All);
    let present = parameter.present;
    let (mut answer, mut collapse) = (run(present)?, None);
    if !answer.is_answer() {
        let zero = run(0.0)?;
        if !zero.is_answer() {
            let how = "without an answer".to_owned();
            return Err(PathError::NoStart { name: name.to_owned(), at: 0.0, how });
        }
        collapse = Some(std::mem::replace(&mut answer, zero));
    }
    let outwards = if present < 0.0 { -1.0 } else { 1.0 };
    let mut step = size(present, 1.0);
    while collapse.is_none() && step <= MOST * size(present, 1.0) {
        let next = run(answer.value + outwards * step)?;
        if next.is_answer() {
            answer = next;
            step *= GROWTH;
        } else {
            collapse = Some(next);
        }
    }
    let mut limit = Limit {
        name: name.to_owned(),
        path: None,
        last: answer.value,
        present,
        factor: None,
        safety: None,
        collapse: None,
        confirmed: false,
        beyond: None,
        bracket: None,
        proof: None,
        polygon_only: false,
        lost: false,
    };
    let Some(collapse) = collapse else { return Ok(limit) };
    // A load that is rounding beside the others is none: what has no answer at twice that has the limit 0.
    let least = outwards * least_felt(case, grown_or_own, &parameter);
    let (mut answer, mut is_none) = (answer, false);
    if least != 0.0 && answer.value.abs() <= least.abs() && collapse.value.abs() > 2.0 * least.abs() {
        let near = run(2.0 * least)?;
        is_none = !near.is_answer();
        if is_none {
            limit.bracket = Some([0.0, near.value]);
            limit.proof = (collapse.is_proved() && !near.is_proved()).then_some(collapse.value);
        } else {
            answer = near;
        }
    }
    let (answer, collapse) = if is_none {
        limit.last = 0.0;
        (0.0, collapse)
    } else {
        let Bracket { answer, none, proof } = narrowed(&run_by, answer, collapse, true)?;
        limit.last = answer.value;
        limit.bracket = Some([answer.value, none.value]);
        limit.proof = proof.map(|proof| proof.value);
        limit.polygon_only = none.is_polygon_only();
        (answer.value, none)
    };
    let prepared = prepared_at(collapse.value)?;
    let found = Case { prepared: &prepared, ..case }.solve()?.answer.ray;
    if !is_none && (answer - collapse.value).abs() > CLOSE * size(collapse.value, present) {
        limit.collapse = found;
        return Ok(limit);
    }
    limit.factor = Some(answer);
    limit.safety = (present != 0.0).then(|| answer / present);
    limit.confirmed = collapse.is_proved();
    if let Some(found) = found {
        limit.put_collapse(found);
    }
    Ok(limit)
}

/// The size of the load up to which it is no more than rounding beside the others: by so much the law of each joint may be
/// violated in an answer, which then is one without the load.
fn least_felt(case: Case<'_>, prepared: &Prepared, parameter: &LoadParameter) -> f64 {
    let Some(system) = prepared.system() else { return 0.0 };
    let mut others = factors(prepared, case.values);
    parameter.drive(&mut others, 0.0);
    let size = |load: &DVector<f64>| system.forces_of(load).amax();
    let beside: f64 = others.iter().zip(&system.loads).map(|(factor, load)| factor.abs() * size(&load.vector)).sum();
    let own = size(&parameter.direction(system));
    if own > 0.0 { system.joint_count() as f64 * LAW_ROUNDING * beside / own } else { 0.0 }
}
