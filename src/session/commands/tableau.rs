//! `ties`, `tableau`.

use clap::Args;

use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session};
use crate::view;

/// List the pivots with tied rows, what chose among them, and the vertices with basics at zero
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  load cycling; ties")]
pub struct Ties;

pub const TIES: Command = Command::of::<Ties>("ties");

impl Action for Ties {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.report_ties(io)?;
        Ok(Next::Continue)
    }

    fn needs_pivots(&self) -> bool {
        true
    }
}

/// Print the dictionary of a small problem at the pivot chosen by `step`
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  load klarbring; set f 0.5; step first; tableau")]
pub struct Tableau;

pub const TABLEAU: Command = Command::of::<Tableau>("tableau");

impl Action for Tableau {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.report_tableau(io)?;
        Ok(Next::Continue)
    }

    fn needs_pivots(&self) -> bool {
        true
    }
}

impl Session {
    pub(in crate::session) fn report_ties(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let (prepared, solved) = self.both()?;
        let report = solved
            .ties(&prepared, io.watch)?
            .ok_or_else(|| CommandError::Refused("ties: the last vertex is singular".into()))?;
        io.show(&report, |out, style| view::ties::write(out, &report, style))?;
        Ok(())
    }

    pub(in crate::session) fn report_tableau(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let (prepared, solved) = self.both()?;
        let dictionary = solved
            .dictionary_at(&prepared, self.shown_step())
            .map_err(|error| CommandError::Refused(format!("tableau: {error}")))?;
        io.show(&dictionary, |out, style| view::tableau::write(out, &dictionary, style))?;
        Ok(())
    }
}
