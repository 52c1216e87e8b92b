//! Several quantities in the words of a command or in a text.

use super::read::{QuantityError, error, read};
use super::words::entry;
use super::{BarPlace, Names, Quantity};
use crate::model::words::did_you_mean_typed;

/// Reads all quantities of `words`; commas outside brackets may separate them.
///
/// # Errors
/// As [`read`].
pub fn read_all(words: &[String], names: &Names<'_>) -> Result<Vec<Quantity>, QuantityError> {
    let mut quantities = Vec::new();
    for part in listed_parts(words, names) {
        let mut rest = &part[..];
        while let Some(word) = rest.first() {
            let (quantity, after) = read(rest, names).map_err(|error| match quantities.last() {
                // What stands behind a bar is more likely a place on it than another quantity.
                Some(bar @ Quantity::Bar(.., BarPlace::Extreme))
                    if rest.len() < part.len() && entry(word).is_none() =>
                {
                    let near = did_you_mean_typed(word, ["at", "start", "end"]);
                    QuantityError(format!(
                        "`{word}` after `{bar}`{near}: expected `at DISTANCE`, `start` or `end`, or another quantity"
                    ))
                }
                _ => error,
            })?;
            quantities.push(quantity);
            rest = after;
        }
    }
    Ok(quantities)
}

/// Reads quantities from a text in which quotation marks hold a name together.
///
/// # Errors
/// As [`read`], and an open quotation.
pub fn read_text(text: &str, names: &Names<'_>) -> Result<Vec<Quantity>, QuantityError> {
    let Some(words) = shlex::split(text) else {
        return error(format!("a quotation mark in `{text}` is left open"));
    };
    read_all(&words, names)
}

/// The words between the commas that stand outside brackets.
fn listed_parts(words: &[String], names: &Names<'_>) -> Vec<Vec<String>> {
    let mut parts = vec![Vec::new()];
    for word in words {
        if names.probes.iter().any(|(name, _)| name == word) {
            parts.last_mut().into_iter().for_each(|part: &mut Vec<String>| part.push(word.clone()));
            continue;
        }
        let mut depth = 0;
        let mut piece = String::new();
        for c in word.chars() {
            match c {
                '[' | '{' | '(' => depth += 1,
                ']' | '}' | ')' => depth -= 1,
                _ => {}
            }
            if c != ',' || depth > 0 {
                piece.push(c);
                continue;
            }
            let piece = std::mem::take(&mut piece);
            parts.last_mut().into_iter().filter(|_| !piece.is_empty()).for_each(|part| part.push(piece.clone()));
            parts.push(Vec::new());
        }
        parts.last_mut().into_iter().filter(|_| !piece.is_empty()).for_each(|part| part.push(piece.clone()));
    }
    parts.retain(|part| !part.is_empty());
    parts
}
