//! Load history with memory: the stages of a scenario followed one after the other (method §6).
//!
//! Eq. (8) relates the *total* slip to the force, which is right for one monotone loading from the unloaded state. A
//! history is followed event by event instead: at each state the rate problem gives the rates of all displacements
//! and forces ([`rate_problem`]); they are constant until a contact force, a reserve or a gap is used up ([`event`]);
//! there every slip is committed and the next rate problem is written ([`walk`]). Where the rate problem has no
//! answer, that is a limit or a jump ([`beyond`]). Within a stage all factors move in proportion from the last stage's
//! values to this one's.

mod beyond;
mod condensed;
mod course;
mod energy;
mod event;
mod follower;
mod force_form;
mod integrals;
mod loose_scheme;
mod rate_problem;
mod record;
mod released;
mod resting;
mod space;
mod standing;
mod walk;

pub(in crate::path) use released::loose_motions;

pub use record::{Energy, History, HistoryEnd, Moment, StageResult};
pub(super) use record::{RESTS, limit_words};

use std::time::Instant;

use standing::Laws;
use walk::Walk;

use super::start::PathError;
use crate::solve::Case;
use crate::solve::problem::{contact_problem, factors};

/// Follows the stages of the scenario from the unloaded structure.
///
/// # Errors
/// No stages; a state that cannot be found; see [`PathError`]. A limit load on the way is not an error.
pub fn follow(case: Case<'_>) -> Result<History, PathError> {
    let Case { scenario, prepared, values, .. } = case;
    if scenario.stages.is_empty() {
        return Err(PathError::Missing(
            "the scenario has no `stages`: nothing tells the order of its loads (see the scenario format)".to_owned(),
        ));
    }
    let own = factors(prepared, values);
    let targets: Vec<Vec<f64>> = scenario
        .stages
        .iter()
        .map(|stage| {
            let mut target = vec![0.0; own.len()];
            for (name, multiplier) in &stage.multipliers {
                if let Some(case) = prepared.cases.iter().position(|(known, _)| known == name) {
                    target[case] = own[case] * multiplier.value(values);
                }
            }
            target
        })
        .collect();
    follow_until(case, &Begin::Unloaded, &targets, &mut |_| false)
}

/// Where a history begins.
#[derive(Clone, Debug, PartialEq)]
pub enum Begin {
    /// At the unloaded structure.
    Unloaded,
    /// Under the first factors, with slips of the pairs, along t or along t1 and t2, that something before has left
    /// behind: the first stage is the state there.
    Slips(Vec<[f64; 2]>),
}

/// Follows a structure through the given factors of all load cases.
///
/// # Errors
/// As [`follow`]; slips from which there is no answer; a stage that breaks down.
pub fn follow_factors(case: Case<'_>, begin: &Begin, targets: &[Vec<f64>]) -> Result<History, PathError> {
    follow_until(case, begin, targets, &mut |_| false)?.unbroken()
}

/// The same, up to the stage after which those that were followed are `enough`, or to one that breaks down.
///
/// # Errors
/// As [`follow_factors`], but for the break-down of a stage after the first.
pub(super) fn follow_until(
    case: Case<'_>,
    begin: &Begin,
    targets: &[Vec<f64>],
    enough: &mut dyn FnMut(&[StageResult]) -> bool,
) -> Result<History, PathError> {
    let Case { prepared, values, rules, watch, .. } = case;
    let system = prepared.system().ok_or(PathError::Plain("stages"))?;
    let none = vec![0.0; prepared.cases.len()];
    let problem = contact_problem(system, &none, values);
    let start = Instant::now();
    let laws = Laws { problem: &problem };
    let mut history = match system.force_form {
        _ if system.is_in_space() => space::follow(prepared, laws, (begin, rules), (targets, enough), watch)?,
        Some(_) => force_form::follow(prepared, laws, begin, (targets, enough), watch)?,
        None => Walk::start(prepared, laws, begin, targets, watch)?.follow((targets, enough))?,
    };
    if let Some(stage) = history.stages.last_mut() {
        let timings = &mut stage.end.timings;
        timings.factor = prepared.factor_seconds;
        timings.condense = prepared.condense_seconds;
        timings.total = prepared.seconds + start.elapsed().as_secs_f64();
    }
    Ok(history)
}
