//! Ranges of numbers: `A..B`.

use crate::session::CommandError;

/// `A..B`, the smaller value first.
///
/// # Errors
/// No range, or an empty one; `command` is who asks.
pub fn upwards(word: &str, command: &str) -> Result<[f64; 2], CommandError> {
    match either_way(word, command)? {
        [from, to] if from < to => Ok([from, to]),
        [from, to] => {
            let refusal = format!("{command}: the range {from}..{to} is empty: the smaller value comes first");
            Err(CommandError::Refused(refusal))
        }
    }
}

/// `A..B`, from A to B, which differ.
///
/// # Errors
/// As [`upwards`].
pub fn either_way(word: &str, command: &str) -> Result<[f64; 2], CommandError> {
    let number = |word: &str| word.trim().parse::<f64>().ok().filter(|value| value.is_finite());
    let ends = word.split_once("..").and_then(|(from, to)| Some([number(from)?, number(to)?]));
    let refused = |why: String| Err(CommandError::Refused(format!("{command}: {why}")));
    match ends {
        Some([from, to]) if from == to => refused(format!("the range {from}..{to} is empty: its ends are the same")),
        Some(ends) => Ok(ends),
        None => refused(format!("`{word}` is not a range; expected A..B, e.g. 0..1")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_numbers_that_differ() {
        assert_eq!(upwards("-1..2e3", "find").unwrap(), [-1.0, 2000.0]);
        assert_eq!(either_way("2..-1", "cycle").unwrap(), [2.0, -1.0]);
        for word in ["2..1", "1..1", "1", "1..", "..1", "a..b", "0..inf", "NaN..1"] {
            assert!(upwards(word, "find").is_err(), "{word}");
        }
        assert!(either_way("1..1", "cycle").is_err());
    }
}
