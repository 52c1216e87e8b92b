//! The largest amplitude of a load that goes to and fro at which the structure still shakes down.

use super::cycle::{Cycle, Kind, MOST, followed};
use super::stages::{Begin, HistoryEnd};
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
    /// The value looked at first, on whose side of it the others are.
    pub towards: f64,
    /// A value at which the structure shakes down; `None` where it does at none on this side, for it does not get away from
    /// the first one.
    pub shakes_down: Option<f64>,
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
    /// Where the history there broke down, or gets to no value at all: why.
    pub why: Option<String>,
    /// Where it is undecided there: the least value looked at beyond that does not shake down, and what it comes to.
    pub decided: Option<(f64, Kind)>,
}

/// What an amplitude comes to.
enum Seen {
    Told(Kind),
    /// Nor does any other: its history ends before it gets away from the first value, as this sentence says.
    AtOnce(Kind, String),
    /// Its history breaks down, which is short of a proof of anything.
    Broken(PathError),
}

/// A history that breaks down is one amplitude that is not decided, and ends no search.
fn seen(found: Result<Seen, PathError>) -> Result<Seen, PathError> {
    match found {
        Ok(seen) => Ok(seen),
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
    // An amplitude that is rounding of the first one is none.
    let least = f64::EPSILON * (first - from).abs();
    let look = |to: f64| match shakes_down_surely(case, name, [from, to])? {
        true => Ok(Seen::Told(Kind::ShakesDown)),
        false => followed(case, name, [from, to], most, &Begin::Unloaded).map(|found| came_to(found, least)),
    };
    let progress = |to: f64, done: f64| case.watch.progress(&format!("{name} = {to}"), done);
    let (good, beyond) = bracket(&|to| seen(look(to)), [from, first], (narrow, least), &progress)?;
    let Some(mut good) = good else {
        return Ok(ShakedownLimit {
            from,
            towards: first,
            shakes_down: None,
            beyond,
            every_start: (None, Static::NotAsked),
        });
    };
    let Some(beyond) = beyond else {
        let every_start = static_limit(case, name, [from, good])?;
        return Ok(ShakedownLimit { from, towards: first, shakes_down: Some(good), beyond: None, every_start });
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
    Ok(ShakedownLimit { from, towards: first, shakes_down: Some(good), beyond: Some(beyond), every_start })
}

/// What a history says of its amplitude. One that ends on the way to the first value, or collapses within `least` of it on the
/// first way from there, is that of every other end on this side as well.
fn came_to(found: Cycle, least: f64) -> Seen {
    let HistoryEnd::Limit { stage, t, .. } = &found.history.end else { return Seen::Told(found.kind) };
    let gone = t * (found.ends[1] - found.ends[0]).abs();
    match stage {
        0 => Seen::AtOnce(found.kind, found.sentence),
        1 if gone <= least && found.kind == Kind::Collapses => Seen::AtOnce(found.kind, found.sentence),
        _ => Seen::Told(found.kind),
    }
}

/// The largest value found at which the structure shakes down, `from` where it does at none that was looked at, `None` where it
/// does not get away from there; and what lies beyond it.
fn bracket(
    look: &dyn Fn(f64) -> Result<Seen, PathError>,
    [from, first]: [f64; 2],
    (narrow, least): (f64, f64),
    progress: &dyn Fn(f64, f64),
) -> Result<(Option<f64>, Option<Beyond>), PathError> {
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
    let Some((mut beyond, mut what)) = bad else { return Ok((Some(good), None)) };
    loop {
        match what {
            Seen::AtOnce(kind, sentence) if good == from => {
                return Ok((None, Some(Beyond { value: from, kind, why: Some(sentence), decided: None })));
            }
            Seen::Told(kind) | Seen::AtOnce(kind, _) if kind != Kind::Undecided => decided = Some((beyond, kind)),
            _ => {}
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
        Seen::Told(kind) | Seen::AtOnce(kind, _) => (kind, None),
        Seen::Broken(error) if good == from && decided.is_none() => return Err(error),
        Seen::Broken(error) => (Kind::Undecided, Some(error.to_string())),
    };
    let decided = decided.filter(|_| kind == Kind::Undecided);
    Ok((Some(good), Some(Beyond { value: beyond, kind, why, decided })))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A structure that shakes down to 4, of which nothing can be said between the given values, and that collapses beyond.
    fn found(broken: [f64; 2], ends: [f64; 2]) -> Result<(Option<f64>, Option<Beyond>), PathError> {
        let look = |to: f64| {
            let at_fault = || PathError::Breakdown { name: "q".to_owned(), at: to, why: "legs in a row".to_owned() };
            let found = match to {
                _ if (broken[0]..broken[1]).contains(&to) => Err(at_fault()),
                _ if to <= 4.0 => Ok(Seen::Told(Kind::ShakesDown)),
                _ => Ok(Seen::Told(Kind::Collapses)),
            };
            seen(found)
        };
        bracket(&look, ends, (1e-5, 1e-15), &|_, _| {})
    }

    #[test]
    fn a_history_that_breaks_down_ends_no_search() {
        // Beyond the limit it is passed by; at it, it is what lies beyond.
        for (broken, kind) in [([4.001, 4.2], Kind::Collapses), ([4.0, 4.2], Kind::Undecided)] {
            for first in [1.0, 4.1, 5.0] {
                let (good, beyond) = found(broken, [0.0, first]).expect("a bracket");
                let (good, beyond) = (good.expect("some shake down"), beyond.expect("something beyond"));
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

    /// A history that does not get away from 2, whether that is seen at once or after one that breaks down: no end shakes down.
    /// Where all that is near breaks down, and only farther ones collapse, 2 is the largest found and beyond it is undecided.
    #[test]
    fn what_does_not_get_away_from_the_first_value_shakes_down_at_no_end() {
        let at_once = || Ok(Seen::AtOnce(Kind::Collapses, "at 2".to_owned()));
        for broken in [3.0, 5.0] {
            let look = |to: f64| match to {
                _ if to < broken || to > 5.0 => at_once(),
                at => seen(Err(PathError::Breakdown { name: "q".to_owned(), at, why: "legs in a row".to_owned() })),
            };
            let (good, beyond) = bracket(&look, [2.0, 4.0], (1e-9, 1e-15), &|_, _| {}).expect("told");
            let beyond = beyond.expect("what it comes to");
            assert_eq!(
                (good, beyond.value, beyond.kind, beyond.why.as_deref()),
                (None, 2.0, Kind::Collapses, Some("at 2"))
            );
        }
        let look = |to: f64| match to {
            _ if to > 5.0 => Ok(Seen::Told(Kind::Collapses)),
            at => seen(Err(PathError::Breakdown { name: "q".to_owned(), at, why: "legs in a row".to_owned() })),
        };
        let (good, beyond) = bracket(&look, [2.0, 6.0], (1e-9, 1e-15), &|_, _| {}).expect("told");
        let beyond = beyond.expect("what lies beyond");
        assert_eq!((good, beyond.kind, beyond.decided), (Some(2.0), Kind::Undecided, Some((6.0, Kind::Collapses))));
    }
}
