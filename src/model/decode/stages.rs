//! `stages`: a load history, each stage a multiplier of some load cases.

use super::reader::{Cursor, Entry};
use super::words::{did_you_mean, listed, quoted};
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
