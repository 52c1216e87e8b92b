//! `check`, `check exact`.

use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::model::scenario::Source;
use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session};
use crate::view;
use crate::view::style::Role;

/// The word of `check exact`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CheckHow {
    /// In exact arithmetic
    Exact,
}

/// Show the numbers of the fresh check of the answer; `check exact` proves or refutes it
///
/// `check exact` solves the final working scheme in exact arithmetic from the f64 data and tells every sign. In space it is
/// the scheme of the friction polygon, its directions taken as the fractions they are stored as; the answer on the cone that
/// Newton's method goes on to has the figures of `check`.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  check\n  check exact")]
pub struct Check {
    /// In exact arithmetic
    #[arg(value_name = "EXACT")]
    how: Option<CheckHow>,
}

pub const CHECK: Command = Command::of::<Check>("check");

impl Action for Check {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        match self.how {
            None => session.report_check(io)?,
            Some(CheckHow::Exact) => session.check_exactly(io)?,
        }
        Ok(Next::Continue)
    }

    fn needs_pivots(&self) -> bool {
        self.how.is_some()
    }
}

#[derive(Serialize)]
struct ExactReport {
    proved: bool,
    finding: Vec<String>,
}

impl Session {
    pub(in crate::session) fn report_check(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let answer = self.need_quantities()?;
        io.show(&answer.check, |out, style| {
            self.write_history_place(out, style)?;
            view::check::write(out, answer, style)
        })?;
        Ok(())
    }

    pub(in crate::session) fn check_exactly(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let check = self.ask(io, |prepared, solved, watch| prepared.check_exactly(solved, watch))?;
        let names = match &self.now.scenario.source {
            Source::Lcp(lcp) => lcp.names.clone(),
            _ => Vec::new(),
        };
        let (role, finding) = view::exact::sentences(&check, &names);
        let report = ExactReport { proved: role == Role::Good, finding };
        io.show(&report, |out, style| view::exact::write(out, &check, &names, style))?;
        Ok(())
    }
}
