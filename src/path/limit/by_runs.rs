//! The limit of a load in space: no path leads there, since slips turn; runs of their own bracket it, each with an
//! answer on Coulomb's cone or a collapse that is certified on it.

use super::record::{Limit, beside, size};
use crate::path::edge::{Bracket, CLOSE, Run, narrowed};
use crate::path::load_parameter::LoadParameter;
use crate::path::start::PathError;
use crate::solve::Case;

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
    let there = |value: f64| beside(&parameter, grown.is_some(), case, value);
    let run = |value: f64| -> Result<Run, PathError> {
        case.watch.progress(&format!("{name} = {value}"), 0.0);
        let (prepared, _) = there(value)?;
        Run::of(value, Case { prepared: &prepared, ..case })
    };
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
        lost: false,
    };
    let Some(collapse) = collapse else { return Ok(limit) };
    let Bracket { answer, none: collapse, proof } = narrowed(&run, answer, collapse, true)?;
    limit.last = answer.value;
    limit.bracket = Some([answer.value, collapse.value]);
    limit.proof = proof.map(|proof| proof.value);
    let (prepared, _) = there(collapse.value)?;
    let found = Case { prepared: &prepared, ..case }.solve()?.answer.ray;
    if (answer.value - collapse.value).abs() > CLOSE * size(collapse.value, present) {
        limit.collapse = found;
        return Ok(limit);
    }
    limit.factor = Some(answer.value);
    limit.safety = (present != 0.0).then(|| answer.value / present);
    limit.confirmed = collapse.is_proved();
    if let Some(found) = found {
        limit.put_collapse(found);
    }
    Ok(limit)
}
