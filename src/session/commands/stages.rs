//! `stages`: the load history of the scenario.

use clap::Args;
use serde_json::{Value, json};

use crate::path::stages::{History, HistoryEnd};
use crate::path::start::PathError;
use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session};
use crate::view;
use crate::view::style::Role;

/// Follow the load history of the scenario, with memory
///
/// Each stage is followed event by event from where the one before ended; slips stay. With STAGE the way through
/// that stage and the pairs at its end are shown. `plot path` draws the loops. Until the next change or `solve`,
/// `expect` and the tables `pairs`, `displacements`, `members`, `reactions` and `check` mean the end of the history.
///
/// In space, where directions of slip turn with the motion, the way is followed on Coulomb's cone and it is said how exactly.
///
/// The rate problems between two events are always solved under the default rules: `set covering`, `set tie-break`
/// and `set engine` do not reach them.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stages\n  stages 2\n  stages; plot path slip c6")]
pub struct Stages {
    /// Number of a stage
    #[arg(value_name = "STAGE")]
    stage: Option<usize>,
}

pub const STAGES: Command = Command::of::<Stages>("stages");

impl Action for Stages {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.stages(self.stage, io)?;
        Ok(Next::Continue)
    }
}

impl Session {
    /// `stages [STAGE]`.
    pub(super) fn stages(&mut self, stage: Option<usize>, io: &mut Output<'_>) -> Result<(), CommandError> {
        let count = self.now.scenario.stages.len();
        if let Some(number) = stage.filter(|number| count > 0 && !(1..=count).contains(number)) {
            return Err(CommandError::Refused(format!("no stage {number}: there are stages 1 to {count}")));
        }
        let history = self.follow_stages(io.watch)?;
        let index = match stage {
            None => None,
            Some(number) => {
                self.stage_answer(number)?;
                Some(number - 1)
            }
        };
        let units = &self.now.scenario.units;
        let place = self.history_place().unwrap_or_default();
        io.show(&history_json(&history), |out, style| {
            match index {
                None => view::stages::write(out, &history, units, style),
                Some(index) => view::stages::write_stage(out, &history, index, units, style),
            }?;
            let line = format!("quantities, `expect` and tables now stand {place}, until the next change or `solve`");
            style.paragraph(out, Role::Muted, &line)
        })?;
        // The stages before it are kept: what is asked for next says where it stands.
        match &history.end {
            HistoryEnd::Broken(error) => Err(CommandError::from(PathError::clone(error))),
            HistoryEnd::Complete | HistoryEnd::Limit { .. } => Ok(()),
        }
    }
}

pub(in crate::session) fn history_json(history: &History) -> Value {
    let stages = history.stages.iter().map(|stage| {
        let changes = stage.moments.iter().filter(|at| !at.changes.is_empty()).map(|at| {
            json!({
                "done": at.t, "factors": at.factors, "changes": at.changes,
                "sentence": at.sentence, "jump": at.jump,
            })
        });
        let mut of_stage = json!({
            "pivots": stage.pivots,
            "factors": stage.moments.last().map(|end| &end.factors),
            "max_slip": stage.max_slip(),
            "max_slip_increment": stage.max_slip_increment(),
            "slip_increment": stage.slip,
            "dissipated": stage.dissipated,
            "work": stage.energy.map(|energy| energy.work),
            "stored": stage.energy.map(|energy| energy.stored),
            "balance": stage.energy.map(|energy| energy.residual),
            "changes": changes.collect::<Vec<_>>(),
            "pairs": stage.moments.last().map(|end| &end.pairs),
        });
        if !stage.rests.is_empty() {
            of_stage["rests"] = json!(stage.rests);
        }
        if let Some(error) = stage.estimated_error {
            of_stage["estimated_error"] = json!(error);
        }
        of_stage
    });
    json!({
        "cases": history.cases,
        "stages": stages.collect::<Vec<_>>(),
        "end": history.end_sentence(),
    })
}
