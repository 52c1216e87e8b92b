//! The limit load of a case: along the path of its answers in the plane, by runs of their own in space.

mod by_path;
mod by_runs;
mod record;

use self::by_path::of_path;
use self::by_runs::limit_by_runs;
pub use self::record::Limit;
use super::beside::{BESIDE, size};
use super::edge::{Which, edge};
use super::load::{LoadReach, trace};
use super::start::{PathError, is_off_paths};
use crate::solve::{Case, Solved};

/// Finds the limit of a load case or load parameter from the present answer (from 0 where there is none): upwards, or
/// downwards where the present value is negative.
///
/// # Errors
/// See [`PathError`].
pub fn limit(case: Case<'_>, solved: Option<&Solved>, name: &str) -> Result<Limit, PathError> {
    let negative = case.present(name).is_some_and(|present| present < 0.0);
    if case.prepared.is_in_space() {
        return limit_by_runs(case, name);
    }
    // A path knows one self-stress of joints that repeat one another; answers go on under others.
    let repeats = case.prepared.system().is_some_and(|system| system.repeats_joints());
    if repeats && solved.is_some_and(is_off_paths) {
        return limit_by_runs(case, name);
    }
    let to = negative.then_some(f64::NEG_INFINITY);
    let path = trace(case, solved, name, LoadReach { to, through: false })?;
    let found = of_path(case, path, negative)?;
    if repeats && found.beyond.is_some() {
        return limit_by_runs(case, name);
    }
    if found.lost { bracketed(case, name, found) } else { Ok(found) }
}

/// The limit by runs of their own, where the path led on beyond it only by rounding: an answer on one side, a proved
/// collapse on the other.
fn bracketed(case: Case<'_>, name: &str, found: Limit) -> Result<Limit, PathError> {
    let Some(start) = found.path.as_ref().map(|path| path.start) else { return Ok(found) };
    let end = found.last;
    let (range, which) = if end < start { ([end, start], Which::Least) } else { ([start, end], Which::Most) };
    let edge = match edge(case, name, range, which) {
        Ok(edge) => edge,
        Err(PathError::Interrupted) => return Err(PathError::Interrupted),
        // No other answer than the path's own.
        Err(_) => return Ok(found),
    };
    let Some(beyond) = edge.collapse.as_ref().filter(|run| run.is_proved()) else { return Ok(found) };
    let bracket = Some([edge.answer.value, beyond.value]);
    if (edge.answer.value - beyond.value).abs() > BESIDE * size(beyond.value, found.present) {
        // The proof refutes the end of the path, and nothing locates the limit closely.
        return Ok(Limit { factor: None, safety: None, collapse: None, bracket, ..found });
    }
    let collapse = case.at(name, beyond.value)?.case(case).solve()?.answer.ray;
    let safety = (found.present != 0.0).then(|| edge.value / found.present);
    Ok(Limit { factor: Some(edge.value), safety, collapse, confirmed: true, bracket, ..found })
}
