//! `tui`, `tour`: the full screen. Typed by hand only: in a script they would end it with what it was going to test
//! untested.

use clap::Args;

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
        full_screen(session, false, io)
    }
}

/// Take the guided tour: six steps in the full screen, from sticking to the ray
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  tour")]
pub struct Tour;

pub const TOUR: Command = Command::of::<Tour>("tour");

impl Action for Tour {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        full_screen(session, true, io)
    }
}

fn full_screen(session: &Session, tour: bool, io: &Output<'_>) -> Result<Next, CommandError> {
    if session.depth > 0 || !io.has_screen {
        let word = if tour { TOUR.name } else { TUI.name };
        return Err(CommandError::Refused(format!(
            "`{word}` opens the full screen, which needs a terminal that understands cursor codes: type it at the \
             prompt there; in a script and on a pipe it is refused"
        )));
    }
    Ok(Next::FullScreen { tour })
}
