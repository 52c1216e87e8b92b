//! `limit`: how far a load can grow.

use std::sync::Arc;

use clap::Args;
use serde_json::json;

use crate::path::limit;
use crate::path::record::PathRecord;
use crate::session::language::command::{Action, Command};
use crate::session::start::case_names;
use crate::session::{CommandError, Next, Output, Session, worker};
use crate::view;

/// Find the limit of a load: its factor, the safety, how the structure collapses
///
/// A load whose present value is negative grows downwards.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  limit pull\n  limit F2")]
pub struct Limit {
    /// Load case, or a parameter in which the loads are linear
    #[arg(value_name = "LOAD")]
    name: String,
}

pub const LIMIT: Command = Command { complete: |asked| asked.varied(), ..Command::of::<Limit>("limit") };

impl Action for Limit {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.limit(&self.name, io)?;
        Ok(Next::Continue)
    }

    fn needs_pivots(&self) -> bool {
        true
    }
}

impl Session {
    /// `limit LOAD`.
    pub(in crate::session) fn limit(&mut self, name: &str, io: &mut Output<'_>) -> Result<(), CommandError> {
        let ground = self.ground(io.watch)?;
        let cases = case_names(&ground.prepared);
        let what = name.to_owned();
        let found = worker::run(io.watch, move |watch| limit::limit(ground.case(watch), Some(&ground.solved), &what))??;
        let unit = self.now.scenario.parameters.get(name).and_then(|parameter| parameter.unit.clone());
        io.report(
            || {
                json!({
                    "load": name,
                    "limit": found.factor,
                    "present": found.present,
                    "safety": found.safety,
                    "collapse": found.collapse,
                    "confirmed": found.confirmed,
                    "answer_beyond": found.beyond,
                    "end": found.end_sentence(),
                })
            },
            |out, style| view::path::write_limit(out, &found, unit.as_deref(), style),
        )?;
        let record = PathRecord::of_load(&found.path, &cases);
        // A single place draws no picture: a path that does is kept.
        if record.places.len() > 1 || self.path.is_none() {
            self.path = Some(Arc::new(record));
        }
        Ok(())
    }
}
