//! `history`: the commands given so far.

use clap::Args;

use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session};

/// List the commands given so far
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  history")]
pub struct History;

pub const HISTORY: Command = Command::of::<History>("history");

impl Action for History {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.report_history(io)?;
        Ok(Next::Continue)
    }
}

impl Session {
    pub(in crate::session) fn report_history(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        io.show(&self.history, |out, style| {
            for (index, command) in self.history.iter().enumerate() {
                writeln!(out, "{:>5}  {}", index + 1, style.text(command))?;
            }
            Ok(())
        })?;
        Ok(())
    }
}
