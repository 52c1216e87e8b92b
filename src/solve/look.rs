//! A look at a scenario that solves nothing: what only contact holds, and what can hardly be meant.

use std::time::Duration;

use super::prepared::{PrepareError, main_system_problem, prepare};
use crate::explain::loose::{LoosePart, loose_parts};
use crate::explain::unpressed::{clearly_pressed, surely_pressed};
use crate::fem::Kinematics;
use crate::model::pair::joints;
use crate::model::plausible;
use crate::model::problem::Problem;
use crate::model::scenario::{Scenario, Source};
use crate::model::structure::Structure;
use crate::watch::{Budget, Watch};

/// Up to this many nodes a factorization takes no noticeable time, and it leaves nothing open.
const FEW_NODES: usize = 2000;

/// Most time for a look into the numbers of a large structure.
pub const LOOK_TIME: Duration = Duration::from_secs(10);

/// What was seen.
#[derive(Debug)]
pub struct Looked {
    /// What only contact holds, in sentences.
    pub loose: Vec<String>,
    /// What is allowed but can hardly be meant, in the order of the file and under its values.
    pub warnings: Vec<Problem>,
    /// What was not looked into for want of time, in a sentence.
    pub left_out: Option<String>,
}

/// Looks at a scenario under the values of its file. Large structures are judged by the motions of their parts. Where
/// those leave open whether the loads press every contact, the forces of the held joints mostly decide it, for which R
/// is not needed; only where they do not, or where something may move in itself, the main system is condensed. All this
/// for [`LOOK_TIME`] at most.
///
/// # Errors
/// As [`prepare`], except for what was left out.
pub fn look(scenario: &Scenario, watch: &dyn Watch) -> Result<Looked, PrepareError> {
    look_within(LOOK_TIME, scenario, watch)
}

fn look_within(time: Duration, scenario: &Scenario, watch: &dyn Watch) -> Result<Looked, PrepareError> {
    let large = match &scenario.source {
        Source::Structure(structure) if structure.nodes.len() > FEW_NODES => Some(structure),
        _ => None,
    };
    let Some(structure) = large else { return by_numbers(scenario, watch) };
    let placed = |error| main_system_problem(scenario, structure, error);
    let kinematics = Kinematics::new(structure, &joints(&structure.pairs), watch).map_err(placed)?;
    if surely_pressed(scenario, structure, &kinematics) && kinematics.is_complete(structure, watch).map_err(placed)? {
        return Ok(by_parts(scenario, structure, &kinematics, None));
    }
    let budget = Budget::new(watch, time);
    if let Ok(Some(held)) = kinematics.held_forces(structure, &budget)
        && clearly_pressed(scenario, structure, &held)
    {
        return Ok(by_parts(scenario, structure, &kinematics, None));
    }
    match by_numbers(scenario, &budget) {
        Err(PrepareError::Interrupted) if budget.ran_out() => {
            let left_out = format!(
                "whether the loads press every contact, and whether a part moves in itself, was not decided within {} s: \
                 `solve` decides it",
                time.as_secs()
            );
            Ok(by_parts(scenario, structure, &kinematics, Some(left_out)))
        }
        looked => looked,
    }
}

fn by_numbers(scenario: &Scenario, watch: &dyn Watch) -> Result<Looked, PrepareError> {
    let prepared = prepare(scenario, watch)?;
    Ok(Looked { loose: prepared.loose_sentences(), warnings: prepared.warnings(scenario), left_out: None })
}

fn by_parts(scenario: &Scenario, structure: &Structure, kinematics: &Kinematics, left_out: Option<String>) -> Looked {
    Looked {
        loose: loose_parts(structure, kinematics.motions()).iter().map(LoosePart::sentence).collect(),
        warnings: plausible::placed(scenario, plausible::warnings(scenario)),
        left_out,
    }
}

#[cfg(test)]
#[path = "look_tests.rs"]
mod tests;
