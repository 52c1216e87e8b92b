//! Pairs chosen and sorted by the words of a command, and what is said of names that do not exist.

use std::collections::HashMap;

use crate::answer::record::PairState;
use crate::model::quantity::{Internal, Meaning, displacement_words, entry, fits, pair_words};
use crate::model::structure::Dimension;

use crate::model::words::{did_you_mean_typed, no_such};
use crate::session::CommandError;

/// Keys of `displacements … sort KEY`, by magnitude; `u` is the length of the displacement.
pub fn displacement_keys(dimension: Dimension) -> Vec<&'static str> {
    ["u"].into_iter().chain(displacement_words(dimension).map(|(word, _)| word)).collect()
}

/// Keys of `members … sort KEY`, by the largest magnitude along an element.
pub fn member_keys(dimension: Dimension) -> Vec<&'static str> {
    Internal::of(dimension == Dimension::Space).iter().map(|which| which.symbol()).collect()
}

/// Keys of `pairs … sort KEY`.
pub fn pair_keys(dimension: Dimension) -> Vec<&'static str> {
    ["id", "state"].into_iter().chain(pair_words(dimension).map(|(word, _)| word)).chain(["position"]).collect()
}

pub(in crate::session) fn no_pair(id: &str, pairs: &[PairState]) -> CommandError {
    CommandError::Refused(match pairs {
        [] => format!("no pair `{id}`: this scenario has no contact pairs"),
        pairs => no_such("pair", id, pairs.iter().map(|pair| pair.id.as_str())),
    })
}

/// Which rows of a table are asked for.
#[derive(Clone, Copy, Debug)]
pub(in crate::session) struct Rows<'w> {
    /// Names, ranges and patterns; all rows without one.
    pub(in crate::session) names: &'w [String],
    /// Column to sort by.
    pub(in crate::session) sort: Option<&'w str>,
    /// How many at most.
    pub(in crate::session) top: Option<usize>,
}

impl<'w> Rows<'w> {
    /// Reads `[NAMES] [sort KEY] [top N]`.
    ///
    /// # Errors
    /// An unknown key, no number.
    pub(in crate::session) fn read(
        words: &'w [String],
        command: &str,
        keys: &[&str],
    ) -> Result<Rows<'w>, CommandError> {
        let first = words.iter().position(|word| word == "sort" || word == "top").unwrap_or(words.len());
        let mut rows = Rows { names: &words[..first], sort: None, top: None };
        let mut rest = &words[first..];
        while let Some((word, after)) = rest.split_first() {
            let argument = after.first().map(String::as_str);
            match (word.as_str(), argument) {
                ("sort", Some(key)) if keys.contains(&key) => rows.sort = Some(key),
                ("sort", Some(key)) => {
                    return Err(CommandError::Refused(format!(
                        "{command}: no sort key `{key}`{}: expected {}",
                        did_you_mean_typed(key, keys.iter().copied()),
                        keys.join(", ")
                    )));
                }
                ("sort", None) => {
                    return Err(CommandError::Refused(format!("{command}: `sort` takes one of {}", keys.join(", "))));
                }
                ("top", Some(number)) if number.parse::<usize>().is_ok_and(|number| number > 0) => {
                    rows.top = number.parse().ok();
                }
                ("top", _) => {
                    return Err(CommandError::Refused(format!(
                        "{command}: `top` takes a number of rows, e.g. `top 5`"
                    )));
                }
                _ => {
                    return Err(CommandError::Refused(format!(
                        "{command}: `{word}` makes no sense behind `sort` or `top`: names come first"
                    )));
                }
            }
            rest = &after[1..];
        }
        Ok(rows)
    }

    /// Indices of the rows that are named, in the order of the names; all of them without names.
    ///
    /// A name is an id, a range `A..B` or `joint[0..4]` of them, a pattern with `*`, or what stands before a bracket:
    /// `joint` for all `joint[…]`.
    ///
    /// # Errors
    /// A name that fits none.
    pub(in crate::session) fn chosen(&self, what: &str, ids: &[&str]) -> Result<Vec<usize>, CommandError> {
        if self.names.is_empty() {
            return Ok((0..ids.len()).collect());
        }
        let mut at: HashMap<&str, Vec<usize>> = HashMap::new();
        for (index, id) in ids.iter().enumerate() {
            at.entry(id).or_default().push(index);
        }
        let none = |id: &str| {
            let mut distinct = ids.to_vec();
            distinct.dedup();
            CommandError::Refused(no_such(what, id, distinct))
        };
        let find = |id: &str| at.get(id).ok_or_else(|| none(id));
        let mut chosen = Vec::new();
        for word in self.names.iter().flat_map(|word| outside_brackets(word)) {
            if let Some(found) = at.get(word) {
                chosen.extend(found);
            } else if let Some((from, to)) = ends_of_range(word) {
                let (from, to) = (find(&from)?, find(&to)?);
                let (first, last) = (from[0].min(to[0]), from[from.len() - 1].max(to[to.len() - 1]));
                if from[0] <= to[0] { chosen.extend(first..=last) } else { chosen.extend((first..=last).rev()) }
            } else {
                let before = chosen.len();
                chosen.extend((0..ids.len()).filter(|index| fits(word, ids[*index])));
                if chosen.len() == before {
                    return Err(none(word));
                }
            }
        }
        Ok(chosen)
    }

    /// Sorts by the key, from large to small, and keeps the first rows; without a key `top` means the largest by
    /// `usual`.
    pub(in crate::session) fn order<T>(&self, rows: &mut Vec<T>, usual: &str, number: impl Fn(&T, &str) -> f64) {
        if let Some(key) = self.sort.or_else(|| self.top.map(|_| usual)) {
            rows.sort_by(|a, b| number(b, key).total_cmp(&number(a, key)));
        }
        self.cut(rows);
    }

    /// Keeps the first rows.
    pub(in crate::session) fn cut<T>(&self, rows: &mut Vec<T>) {
        rows.truncate(self.top.unwrap_or(usize::MAX));
    }
}

/// The ids at both ends of a range: `c1..c3`, or with its numbers in one bracket `joint[0..4]`.
fn ends_of_range(word: &str) -> Option<(String, String)> {
    let (from, to) = word.split_once("..")?;
    let open = from.rfind('[').filter(|open| !from[*open..].contains(']'));
    Some(match open.zip(to.split_once(']')) {
        Some((open, (last, behind))) => {
            let (head, first) = from.split_at(open + 1);
            (format!("{head}{first}]{behind}"), format!("{head}{last}]{behind}"))
        }
        None => (from.to_owned(), to.to_owned()),
    })
}

/// The parts of a word between commas that stand outside brackets.
fn outside_brackets(word: &str) -> Vec<&str> {
    let mut depth = 0;
    let parts = word.split(|c| {
        match c {
            '[' | '{' => depth += 1,
            ']' | '}' => depth -= 1,
            _ => {}
        }
        c == ',' && depth == 0
    });
    parts.filter(|part| !part.is_empty()).collect()
}

/// Sorts by a key; numbers from large to small, ids, states and positions upwards.
pub(in crate::session) fn sort(pairs: &mut [PairState], key: &str) {
    if let Some(Meaning::Pair(which)) = entry(key).map(|entry| entry.meaning) {
        pairs.sort_by(|a, b| which.of(b).total_cmp(&which.of(a)));
        return;
    }
    match key {
        "id" => pairs.sort_by(|a, b| a.id.cmp(&b.id)),
        "state" => pairs.sort_by_key(|pair| pair.state.word()),
        _ => pairs.sort_by(|a, b| {
            let place = |pair: &PairState| pair.position.unwrap_or([f64::INFINITY; 3]);
            let (a, b) = (place(a), place(b));
            a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(a[2].total_cmp(&b[2]))
        }),
    }
}
