//! `solve`, `status`.

use clap::Args;

use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session};
use crate::view;

/// Solve with the present values
///
/// Needed only after `set auto off`, or to solve the same once more.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  set auto off; set f 0.3; set F2 90; solve")]
pub struct Solve;

pub const SOLVE: Command = Command::of::<Solve>("solve");

impl Action for Solve {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.solve_again(io)?;
        Ok(Next::Continue)
    }
}

/// Say what the answer is, under which rules it was found, and its check
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  status")]
pub struct Status;

pub const STATUS: Command = Command::of::<Status>("status");

impl Action for Status {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.report_status(io)?;
        Ok(Next::Continue)
    }
}

impl Session {
    fn solve_again(&mut self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let mut next = self.now.clone();
        let solved = next.solve(io.watch)?;
        self.now = next;
        self.take_answer(Some(solved));
        self.say_what_changed(&[], io)
    }

    pub(in crate::session) fn report_status(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let answer = self.need_answer()?;
        io.show(&self.status_json(), |out, style| {
            view::status::write(out, answer, &self.now.scenario, &self.now.values, style)?;
            view::status::write_loose(out, &self.loose(), style)?;
            if !self.auto {
                writeln!(out, "auto is off: changes wait for `solve`")?;
            }
            match self.position {
                Some(step) => {
                    writeln!(out, "shown at {}: `step last` for the end", view::pivots::title(step))
                }
                None => Ok(()),
            }
        })?;
        Ok(())
    }
}
