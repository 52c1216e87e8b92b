//! `stages`, a load history, and `combinations`: each a multiplier of some load cases.

use super::reader::{Cursor, Entry};
use super::words::{ID_RULE, did_you_mean, is_id, listed, quoted};
use crate::model::scenario::Stage;
use crate::model::uses::Region;

/// Reads the stages; `cases` are the names of the load cases.
pub fn read(entry: Entry<'_>, cases: &[&str]) -> Option<Vec<Stage>> {
    let mut stages = Vec::new();
    let mut is_right = true;
    for cursor in entry.value().list()? {
        match stage(cursor, cases) {
            Some(stage) => stages.push(stage),
            None => is_right = false,
        }
    }
    if stages.is_empty() && is_right {
        entry.key_problem(
            "there are no stages",
            "name at least one, or remove `stages`: every load case then acts with its factor",
        );
        return None;
    }
    is_right.then_some(stages)
}

/// Reads `combinations`: each named, otherwise as a stage.
pub fn combinations(entry: Entry<'_>, cases: &[&str]) -> Option<Vec<(String, Stage)>> {
    let mut combinations = Vec::new();
    let mut is_right = true;
    for entry in entry.value().entries()? {
        if !is_id(entry.name()) {
            entry.key_problem(format!("{} cannot name a combination", quoted(entry.name())), ID_RULE);
            is_right = false;
        }
        match stage(entry.value(), cases) {
            Some(stage) if !stage.multipliers.is_empty() => combinations.push((entry.name().to_owned(), stage)),
            Some(_) => {
                entry
                    .key_problem("the combination names no load case", format!("the load cases are {}", listed(cases)));
                is_right = false;
            }
            None => is_right = false,
        }
    }
    is_right.then_some(combinations)
}

fn stage(cursor: Cursor<'_>, cases: &[&str]) -> Option<Stage> {
    let mut multipliers = Vec::new();
    let mut is_right = true;
    for entry in cursor.entries()? {
        if !cases.contains(&entry.name()) {
            let near = did_you_mean(entry.name(), cases.iter().copied());
            entry.key_problem(
                format!("unknown load case {}{near}", quoted(entry.name())),
                format!("the load cases are {}", listed(cases)),
            );
            is_right = false;
            continue;
        }
        match entry.value().of(Region::Factor).any_number() {
            Some(multiplier) => multipliers.push((entry.name().to_string(), multiplier)),
            None => is_right = false,
        }
    }
    is_right.then_some(Stage { multipliers })
}
