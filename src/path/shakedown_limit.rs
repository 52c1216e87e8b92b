//! The largest amplitude of a load that goes to and fro at which the structure still shakes down.

use super::cycle::{Kind, MOST, followed};
use super::stages::Begin;
use super::start::PathError;
use super::static_shakedown::{Static, shakes_down_surely, static_limit};
use crate::solve::case::Case;

/// The bracket of the largest amplitude that shakes down is narrowed to this share of it.
const NARROW: f64 = 1e-9;
/// In space, where slips are known to the accuracy of the steps, to this one …
const NARROW_IN_SPACE: f64 = 1e-5;
/// … by at most this many cycles at each amplitude: near the largest one they come to rest slowly.
const MOST_IN_SPACE: usize = 64;
/// The amplitude is doubled at most this often in search of one that does not shake down.
const DOUBLINGS: usize = 40;

/// The largest amplitude that shakes down.
#[derive(Clone, Debug, PartialEq)]
pub struct ShakedownLimit {
    /// The value held at the other end.
    pub from: f64,
    /// A value at which the structure shakes down.
    pub shakes_down: f64,
    /// A value beyond, and what it comes to there; `None` where none was found.
    pub beyond: Option<(f64, Kind)>,
    /// Up to where the static theorem proves it from every start, and what it says there.
    pub every_start: (Option<f64>, Static),
}

/// Brackets the largest second end, away from `from`, at which the structure shakes down; `first` is looked at first.
///
/// # Errors
/// As [`super::cycle::cycle`].
pub fn shakedown_limit(case: Case<'_>, name: &str, [from, first]: [f64; 2]) -> Result<ShakedownLimit, PathError> {
    let system = case.prepared.system().ok_or(PathError::Plain("limit cycle"))?;
    let (narrow, most) = if system.is_in_space() { (NARROW_IN_SPACE, MOST_IN_SPACE) } else { (NARROW, MOST) };
    let kind = |to: f64| match shakes_down_surely(case, name, [from, to])? {
        true => Ok(Kind::ShakesDown),
        false => followed(case, name, [from, to], most, &Begin::Unloaded).map(|found| found.kind),
    };
    let (mut good, mut bad) = (from, None);
    let mut to = first;
    for round in 0..DOUBLINGS {
        case.watch.progress(&format!("{name} = {to}"), 0.5 * round as f64 / DOUBLINGS as f64);
        match kind(to)? {
            Kind::ShakesDown => {
                good = to;
                to = from + 2.0 * (to - from);
            }
            other => {
                bad = Some((to, other));
                break;
            }
        }
    }
    let Some((mut beyond, mut what)) = bad else {
        let every_start = static_limit(case, name, [from, good])?;
        return Ok(ShakedownLimit { from, shakes_down: good, beyond: None, every_start });
    };
    while (beyond - good).abs() > narrow * (beyond - from).abs().max(f64::MIN_POSITIVE) {
        let middle = 0.5 * (good + beyond);
        if middle == good || middle == beyond {
            break;
        }
        case.watch.progress(&format!("{name} = {middle}"), 0.75);
        match kind(middle)? {
            Kind::ShakesDown => good = middle,
            other => (beyond, what) = (middle, other),
        }
    }
    let every_start = static_limit(case, name, [from, beyond])?;
    // What was followed in steps has no more digits than these; the theorem has.
    if let Some(proved) = every_start.0.filter(|proved| (good - proved).abs() <= narrow * (beyond - from).abs()) {
        good = proved;
    }
    Ok(ShakedownLimit { from, shakes_down: good, beyond: Some((beyond, what)), every_start })
}
