//! What changed between two answers, pair by pair.

use std::io::{self, Write};

use super::pairs::state_words;
use super::style::{Role, Style};
use crate::answer::record::{Answer, State};

/// A pair whose state changed.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Pair id.
    pub pair: String,
    /// State in words before.
    pub from: &'static str,
    /// State in words after.
    pub to: &'static str,
    /// State after.
    pub state: State,
}

/// The pairs of `now` whose state differs from the one they had in `previous`.
pub fn changes(previous: &Answer, now: &Answer) -> Vec<Change> {
    let before: std::collections::HashMap<&str, &'static str> =
        previous.pairs.iter().map(|pair| (pair.id.as_str(), state_words(pair))).collect();
    now.pairs
        .iter()
        .filter_map(|pair| {
            let from = *before.get(pair.id.as_str())?;
            let to = state_words(pair);
            (from != to).then(|| Change { pair: pair.id.clone(), from, to, state: pair.state })
        })
        .collect()
}

/// Writes a line per changed pair: `c3 stick → slip+`; first the outcome, if that changed.
pub fn write(out: &mut dyn Write, previous: &Answer, now: &Answer, style: &Style) -> io::Result<()> {
    let mut lines = Vec::new();
    if previous.outcome != now.outcome {
        lines.push(("outcome".to_owned(), previous.outcome.word(), now.outcome.word(), Role::of_outcome(now.outcome)));
    }
    for change in changes(previous, now) {
        let role = Role::State(change.state);
        lines.push((style.text(&change.pair), change.from, change.to, role));
    }
    if lines.is_empty() {
        let text = style.fit("no pair changed its state", style.width);
        return writeln!(out, "{text}");
    }
    for (name, from, to, role) in lines {
        let fixed = from.len() + to.len() + style.arrow().chars().count() + 3;
        let name = style.fit(&name, style.width.saturating_sub(fixed));
        if name.is_empty() {
            writeln!(out, "{}", style.fit(to, style.width))?;
            continue;
        }
        let to = style.paint(role, to);
        writeln!(out, "{name} {from} {} {to}", style.arrow())?;
    }
    Ok(())
}
