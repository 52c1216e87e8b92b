//! `tui`, `tour`: the full screen. Typed by hand only: in a script they would end it with what it was going to test
//! untested.

use clap::{Args, ValueEnum};

use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session};

/// Go to the full screen, with this session; `q` there comes back
///
/// Only at the prompt of a terminal: in a script and on a pipe it is refused, as a command that fails.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  tui")]
pub struct Tui;

pub const TUI: Command = Command::of::<Tui>("tui");

impl Action for Tui {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        full_screen(session, None, io)
    }
}

/// What `tour` shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Tour {
    /// A beam on six supports: from sticking to the ray
    Beam,
    /// A hot pipe: friction decides what its nozzle bears
    Pipe,
    /// A dam: where it presses, where it opens, when it slides
    Dam,
    /// LCPs without an answer, in a circle, and with a long way
    Lcp,
}

/// Take a guided tour in the full screen: a beam, a pipe, a dam, LCPs that fail
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  tour\n  tour dam")]
pub struct TakeTour {
    /// Which one
    #[arg(value_name = "TOUR", default_value = "beam")]
    tour: Tour,
}

pub const TOUR: Command = Command::of::<TakeTour>("tour");

impl Action for TakeTour {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        full_screen(session, Some(self.tour), io)
    }
}

fn full_screen(session: &Session, tour: Option<Tour>, io: &Output<'_>) -> Result<Next, CommandError> {
    if session.depth > 0 || !io.has_screen {
        let word = if tour.is_some() { TOUR.name } else { TUI.name };
        return Err(CommandError::Refused(format!(
            "`{word}` opens the full screen, which needs a terminal that understands cursor codes: in a script \
             and on a pipe it is refused"
        )));
    }
    Ok(Next::FullScreen { tour })
}
