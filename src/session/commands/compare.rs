//! `compare`.

use clap::Args;

use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session};
use crate::view;

/// Run every covering, tie-break and engine on the present values, and say which find the same answer
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  load greco; set f 2; compare")]
pub struct Compare;

pub const COMPARE: Command = Command::of::<Compare>("compare");

impl Action for Compare {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.compare(io)?;
        Ok(Next::Continue)
    }

    fn needs_pivots(&self) -> bool {
        true
    }
}

impl Session {
    pub(in crate::session) fn compare(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let values = self.now.values.clone();
        let rules = self.rules();
        let comparison = self.ask(io, move |prepared, _, watch| Ok(prepared.compare(&values, rules, watch)?))?;
        io.show(&comparison, |out, style| view::compare::write(out, &comparison, style))?;
        Ok(())
    }
}
