//! What changes at a breakpoint, in words.

use crate::answer::record::{PairState, State};
use crate::contact::polygon::{angle, degrees};
use crate::text::words::list;

/// A pair that changes its state at a breakpoint.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Change {
    /// Id of the pair.
    pub pair: String,
    /// State before.
    pub from: String,
    /// State after.
    pub to: String,
    /// Where a pair in space slips to from here on: degrees from t1 towards t2.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub direction: Option<f64>,
}

/// A place of a path over a load or over friction at which the scheme changes.
#[derive(Clone, Debug, PartialEq)]
pub struct Breakpoint {
    /// The load factor, exact to rounding, or the friction, to 1e-10 relative or better.
    pub value: f64,
    /// Index of the first place of the path at this value: of its knots, or of its samples.
    pub place: usize,
    /// The pairs that change.
    pub changes: Vec<Change>,
    /// Whether the pairs move by a finite amount here: at constant load before it goes on, or from one of several answers
    /// under this friction, which ends, to another.
    pub jump: bool,
    /// The changes in words: `pair c5 slips +`.
    pub sentence: String,
}

impl Breakpoint {
    /// With its sentence.
    pub fn new(value: f64, place: usize, changes: Vec<Change>, jump: bool) -> Breakpoint {
        Breakpoint { value, place, sentence: sentence(&changes), changes, jump }
    }
}

/// The state of a pair as a path shows it: its word, and for an open pair held by cohesion what it does.
fn word((state, held): (State, Option<State>)) -> String {
    match held {
        None => state.word().to_owned(),
        Some(State::Stick) => "open (held)".to_owned(),
        Some(State::Slip) => "open (slip)".to_owned(),
        Some(State::SlipPlus) => "open (slip +)".to_owned(),
        Some(_) => "open (slip -)".to_owned(),
    }
}

/// The pairs whose states differ.
pub fn changes(before: &[PairState], after: &[PairState]) -> Vec<Change> {
    let states = |pairs: &[PairState]| pairs.iter().map(|pair| (pair.state, pair.held)).collect::<Vec<_>>();
    between(after.iter().map(|pair| pair.id.as_str()), &states(before), &states(after))
}

/// The pairs whose states, and what holds them where they are open, differ.
pub fn between<'a>(
    ids: impl Iterator<Item = &'a str>,
    before: &[(State, Option<State>)],
    after: &[(State, Option<State>)],
) -> Vec<Change> {
    ids.zip(before.iter().zip(after))
        .filter_map(|(id, (before, after))| {
            let (from, to) = (word(*before), word(*after));
            (from != to).then(|| Change { pair: id.to_owned(), from, to, direction: None })
        })
        .collect()
}

/// Adds the directions of pairs that begin to slip in space; `after` are the pairs from here on.
pub fn with_directions(changes: &mut [Change], after: &[PairState]) {
    for change in changes.iter_mut().filter(|change| change.to == State::Slip.word()) {
        // Friction stands against the slip.
        let space = after.iter().find(|pair| pair.id == change.pair).and_then(|pair| pair.space);
        change.direction = space.map(|space| angle(space.x_t.map(|friction| -friction)));
    }
}

/// `pair c5 slips +`, `pairs c1 and c2 open`; several kinds joined by `; `.
pub fn sentence(changes: &[Change]) -> String {
    let kind_of = |change: &Change| (change.from.clone(), change.to.clone(), change.direction.map(degrees));
    let mut kinds: Vec<(String, String, Option<String>)> = Vec::new();
    for change in changes {
        let kind = kind_of(change);
        if !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    let parts: Vec<String> = kinds
        .into_iter()
        .map(|kind| {
            let same = changes.iter().filter(|change| kind_of(change) == kind);
            let pairs: Vec<String> = same.map(|change| change.pair.clone()).collect();
            let (from, to, direction) = kind;
            let one = pairs.len() == 1;
            let subject = if one { format!("pair {}", pairs[0]) } else { format!("pairs {}", list(&pairs)) };
            let s = |verb: &str| {
                if one { format!("{verb}s") } else { verb.to_owned() }
            };
            let closes = if from.starts_with("open") { format!("{} and ", s("close")) } else { String::new() };
            let towards = direction.map_or(String::new(), |direction| format!(" towards {direction}"));
            let verb = match to.as_str() {
                "stick" => format!("{closes}{}", s("stick")),
                "slip" => format!("{closes}{}", s("slip")),
                "slip+" => format!("{closes}{} +", s("slip")),
                "slip-" => format!("{closes}{} -", s("slip")),
                "closed" => s("close"),
                "open" => s("open"),
                // An open pair that cohesion still holds.
                other if from.starts_with("open") => {
                    format!("{} from {from} to {other}", if one { "goes" } else { "go" })
                }
                other => format!("{} ({})", s("open"), other.trim_start_matches("open ").trim_matches(['(', ')'])),
            };
            format!("{subject} {verb}{towards}")
        })
        .collect();
    parts.join("; ")
}

#[cfg(test)]
mod tests {
    use super::{Change, sentence};

    fn change(pair: &str, from: &str, to: &str) -> Change {
        Change { pair: pair.into(), from: from.into(), to: to.into(), direction: None }
    }

    #[test]
    fn changes_of_one_kind_share_a_sentence() {
        let changes = [change("c1", "stick", "slip+"), change("c2", "stick", "slip+"), change("c3", "open", "stick")];
        assert_eq!(sentence(&changes), "pairs c1 and c2 slip +; pair c3 closes and sticks");
        assert_eq!(sentence(&changes[..1]), "pair c1 slips +");
        let towards = |pair, direction| Change { direction: Some(direction), ..change(pair, "stick", "slip") };
        let changes = [towards("c1", 36.87), towards("c2", 36.87), towards("c3", -90.0)];
        assert_eq!(sentence(&changes), "pairs c1 and c2 slip towards 36.9°; pair c3 slips towards -90°");
    }
}
