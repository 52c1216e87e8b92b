//! Pairs chosen and sorted by the words of a command, and what is said of names that do not exist.

use std::collections::HashMap;

use crate::answer::record::PairState;

use super::CommandError;
use super::command::did_you_mean;

/// Keys of `pairs … sort KEY`.
pub const SORT_KEYS: &[&str] =
    &["id", "state", "x_n", "x_t", "z_n", "z_t", "bound", "reserve_plus", "reserve_minus", "position"];

/// The names without those that repeat the one before.
pub(super) fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut names: Vec<&str> = names.collect();
    names.dedup();
    names
}

pub(super) fn no_pair(id: &str, pairs: &[PairState]) -> CommandError {
    CommandError::Refused(match pairs {
        [] => format!("no pair `{id}`: this scenario has no contact pairs"),
        pairs => no_such("pair", id, pairs.iter().map(|pair| pair.id.as_str())),
    })
}

/// "no pair `c9` (did you mean …?): the pairs are c1 … c6".
pub(super) fn no_such<'a>(what: &str, id: &str, known: impl Iterator<Item = &'a str> + Clone) -> String {
    let near = did_you_mean(id, known.clone());
    let names: Vec<&str> = known.collect();
    match names.as_slice() {
        [] => format!("no {what} `{id}`: there is none"),
        [one] => format!("no {what} `{id}`{near}: the only {what} is {one}"),
        [first, .., last] if names.len() > 8 => {
            format!("no {what} `{id}`{near}: the {what}s are {first} … {last}")
        }
        names => format!("no {what} `{id}`{near}: the {what}s are {}", names.join(", ")),
    }
}

/// Pairs named by ids, ranges `A..B`, or the name of an edge contact (`joint` for all `joint[…]`).
pub(super) fn indices(words: &[String], pairs: &[PairState]) -> Result<Vec<usize>, CommandError> {
    let at: HashMap<&str, usize> = pairs.iter().enumerate().map(|(i, pair)| (pair.id.as_str(), i)).collect();
    let find = |id: &str| at.get(id).copied().ok_or_else(|| no_pair(id, pairs));
    let mut chosen = Vec::new();
    for word in words.iter().flat_map(|word| word.split(',')).filter(|word| !word.is_empty()) {
        if let Some(index) = at.get(word) {
            chosen.push(*index);
        } else if let Some((from, to)) = word.split_once("..") {
            let (from, to) = (find(from)?, find(to)?);
            if from <= to {
                chosen.extend(from..=to);
            } else {
                chosen.extend((to..=from).rev());
            }
        } else {
            let edge = format!("{word}[");
            let before = chosen.len();
            chosen.extend((0..pairs.len()).filter(|i| pairs[*i].id.starts_with(&edge)));
            if chosen.len() == before {
                return Err(no_pair(word, pairs));
            }
        }
    }
    Ok(chosen)
}

/// Sorts by a key; numbers from large to small, ids and positions upwards.
pub(super) fn sort(pairs: &mut [PairState], key: &str) -> Result<(), CommandError> {
    let number: fn(&PairState) -> f64 = match key {
        "id" => {
            pairs.sort_by(|a, b| a.id.cmp(&b.id));
            return Ok(());
        }
        "state" => {
            pairs.sort_by_key(|pair| pair.state.word());
            return Ok(());
        }
        "position" => {
            pairs.sort_by(|a, b| {
                let place = |pair: &PairState| pair.position.unwrap_or([f64::INFINITY; 2]);
                let (a, b) = (place(a), place(b));
                a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
            });
            return Ok(());
        }
        "x_n" => |pair| pair.x_n,
        "x_t" => |pair| pair.x_t,
        "z_n" => |pair| pair.z_n,
        "z_t" => |pair| pair.z_t,
        "bound" => |pair| pair.bound,
        "reserve_plus" => |pair| pair.reserve_plus,
        "reserve_minus" => |pair| pair.reserve_minus,
        _ => {
            return Err(CommandError::Refused(format!(
                "pairs: no sort key `{key}`{}: expected {}",
                did_you_mean(key, SORT_KEYS.iter().copied()),
                SORT_KEYS.join(", ")
            )));
        }
    };
    pairs.sort_by(|a, b| number(b).total_cmp(&number(a)));
    Ok(())
}
