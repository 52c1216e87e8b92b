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
    pub beyond: Option<Beyond>,
    /// Up to where the static theorem proves it from every start, and what it says there.
    pub every_start: (Option<f64>, Static),
}

/// What lies beyond a value at which the structure shakes down.
#[derive(Clone, Debug, PartialEq)]
pub struct Beyond {
    /// The least value looked at.
    pub value: f64,
    /// What it comes to there.
    pub kind: Kind,
    /// Where the history there broke down: why.
    pub why: Option<String>,
    /// Where it is undecided there: the least value looked at beyond that does not shake down, and what it comes to.
    pub decided: Option<(f64, Kind)>,
}

/// What an amplitude comes to.
enum Seen {
    Told(Kind),
    /// Its history breaks down, which is short of a proof of anything.
    Broken(PathError),
}

/// A history that breaks down is one amplitude that is not decided, and ends no search.
fn seen(found: Result<Kind, PathError>) -> Result<Seen, PathError> {
    match found {
        Ok(kind) => Ok(Seen::Told(kind)),
        Err(error @ PathError::Breakdown { .. }) => Ok(Seen::Broken(error)),
        Err(error) => Err(error),
    }
}

/// Brackets the largest second end, away from `from`, at which the structure shakes down; `first` is looked at first.
///
/// # Errors
/// As [`super::cycle::cycle`], where the history breaks down at every amplitude.
pub fn shakedown_limit(case: Case<'_>, name: &str, [from, first]: [f64; 2]) -> Result<ShakedownLimit, PathError> {
    let system = case.prepared.system().ok_or(PathError::Plain("limit cycle"))?;
    let (narrow, most) = if system.is_in_space() { (NARROW_IN_SPACE, MOST_IN_SPACE) } else { (NARROW, MOST) };
    let kind = |to: f64| match shakes_down_surely(case, name, [from, to])? {
        true => Ok(Kind::ShakesDown),
        false => followed(case, name, [from, to], most, &Begin::Unloaded).map(|found| found.kind),
    };
    let progress = |to: f64, done: f64| case.watch.progress(&format!("{name} = {to}"), done);
    let (mut good, beyond) = bracket(&|to| seen(kind(to)), [from, first], narrow, &progress)?;
    let Some(beyond) = beyond else {
        let every_start = static_limit(case, name, [from, good])?;
        return Ok(ShakedownLimit { from, shakes_down: good, beyond: None, every_start });
    };
    let every_start = match static_limit(case, name, [from, beyond.value]) {
        Err(PathError::Breakdown { .. }) => static_limit(case, name, [from, good])?,
        found => found?,
    };
    // What was followed in steps has no more digits than these; the theorem has.
    let near = narrow * (beyond.value - from).abs();
    if let Some(proved) = every_start.0.filter(|proved| (good - proved).abs() <= near) {
        good = proved;
    }
    Ok(ShakedownLimit { from, shakes_down: good, beyond: Some(beyond), every_start })
}

/// The largest value found at which the structure shakes down, `from` where it does at none, and what lies beyond it.
fn bracket(
    look: &dyn Fn(f64) -> Result<Seen, PathError>,
    [from, first]: [f64; 2],
    narrow: f64,
    progress: &dyn Fn(f64, f64),
) -> Result<(f64, Option<Beyond>), PathError> {
    let (mut good, mut bad, mut decided) = (from, None, None);
    let mut to = first;
    for round in 0..DOUBLINGS {
        progress(to, 0.5 * round as f64 / DOUBLINGS as f64);
        match look(to)? {
            Seen::Told(Kind::ShakesDown) => {
                good = to;
                to = from + 2.0 * (to - from);
            }
            other => {
                bad = Some((to, other));
                break;
            }
        }
    }
    let Some((mut beyond, mut what)) = bad else { return Ok((good, None)) };
    // An amplitude that is rounding of the first one is none.
    let least = f64::EPSILON * (first - from).abs();
    loop {
        if let Seen::Told(kind) = what
            && kind != Kind::Undecided
        {
            decided = Some((beyond, kind));
        }
        if (beyond - good).abs() <= (narrow * (beyond - from).abs()).max(least) {
            break;
        }
        let middle = 0.5 * (good + beyond);
        if middle == good || middle == beyond {
            break;
        }
        progress(middle, 0.75);
        match look(middle)? {
            Seen::Told(Kind::ShakesDown) => good = middle,
            other => (beyond, what) = (middle, other),
        }
    }
    let (kind, why) = match what {
        Seen::Told(kind) => (kind, None),
        Seen::Broken(error) if good == from => return Err(error),
        Seen::Broken(error) => (Kind::Undecided, Some(error.to_string())),
    };
    let decided = decided.filter(|_| kind == Kind::Undecided);
    Ok((good, Some(Beyond { value: beyond, kind, why, decided })))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A structure that shakes down to 4, of which nothing can be said between the given values, and that collapses beyond.
    fn found(broken: [f64; 2], ends: [f64; 2]) -> Result<(f64, Option<Beyond>), PathError> {
        let look = |to: f64| {
            let at_fault = || PathError::Breakdown { name: "q".to_owned(), at: to, why: "legs in a row".to_owned() };
            let found = match to {
                _ if (broken[0]..broken[1]).contains(&to) => Err(at_fault()),
                _ if to <= 4.0 => Ok(Kind::ShakesDown),
                _ => Ok(Kind::Collapses),
            };
            seen(found)
        };
        bracket(&look, ends, 1e-5, &|_, _| {})
    }

    #[test]
    fn a_history_that_breaks_down_ends_no_search() {
        // Beyond the limit it is passed by; at it, it is what lies beyond.
        for (broken, kind) in [([4.001, 4.2], Kind::Collapses), ([4.0, 4.2], Kind::Undecided)] {
            for first in [1.0, 4.1, 5.0] {
                let (good, beyond) = found(broken, [0.0, first]).expect("a bracket");
                let beyond = beyond.expect("something beyond");
                assert!(good <= 4.0 && beyond.value >= 4.0 && beyond.value - good <= 1e-5 * beyond.value, "{good}");
                assert_eq!((beyond.kind, beyond.why.is_some()), (kind, kind == Kind::Undecided), "from {first}");
                assert!(beyond.decided.is_none_or(|(value, _)| value >= 4.2), "from {first}");
            }
        }
        let decided = found([4.0, 4.2], [0.0, 5.0]).expect("a bracket").1.expect("something beyond").decided;
        assert!(matches!(decided, Some((value, Kind::Collapses)) if (4.2..=5.0).contains(&value)), "{decided:?}");
    }

    #[test]
    fn one_that_breaks_down_everywhere_is_told() {
        assert!(matches!(found([0.0, 9.0], [0.0, 5.0]), Err(PathError::Breakdown { .. })));
    }
}
