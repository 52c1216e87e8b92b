//! Laws of contact and the numbers that belong to each.

use super::reader::Cursor;
use crate::model::pair::{Law, LawKind};
use crate::model::parameter::Number;
use crate::model::uses::Region;

/// The keys of numbers, with the laws they belong to.
pub const NUMBERS: [(&str, &[LawKind]); 4] = [
    ("friction", &[LawKind::Coulomb]),
    ("cohesion", &[LawKind::Coulomb]),
    ("gap", &[LawKind::Coulomb, LawKind::Frictionless]),
    ("bound", &[LawKind::Bound]),
];

impl LawKind {
    /// Whether a number belongs to this law.
    pub fn takes(self, key: &str) -> bool {
        NUMBERS.iter().any(|(name, laws)| *name == key && laws.contains(&self))
    }

    /// The law with its numbers, given by key; 0 where none is given.
    pub fn with(self, number: impl Fn(&str) -> Option<Number>) -> Law {
        let number = |key| number(key).unwrap_or(Number::Value(0.0));
        match self {
            LawKind::Coulomb => {
                Law::Coulomb { friction: number("friction"), cohesion: number("cohesion"), gap: number("gap") }
            }
            LawKind::Frictionless => Law::Frictionless { gap: number("gap") },
            LawKind::Bound => Law::Bound { bound: number("bound") },
        }
    }
}

/// A number of a law: a gap may be negative (an interference), the others not.
pub fn number(cursor: Cursor<'_>, key: &str) -> Option<Number> {
    let cursor = cursor.of(Region::Law);
    if key == "gap" { cursor.any_number() } else { cursor.non_negative(key) }
}

/// One number per pair: from a list with one entry each, or, where `may_be_single`, from a single one.
pub fn per_pair(cursor: Cursor<'_>, key: &str, count: usize, may_be_single: bool) -> Option<Vec<Number>> {
    if may_be_single && !cursor.is_list() {
        let number = number(cursor, key)?;
        return Some(vec![number; count]);
    }
    let entries = cursor.list_of(count, "one per pair")?;
    let numbers: Vec<Option<Number>> = entries.map(|entry| number(entry, key)).collect();
    numbers.into_iter().collect()
}
