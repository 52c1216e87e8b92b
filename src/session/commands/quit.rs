//! `quit`.

use clap::Args;

use crate::session::language::command::{Action, Command, Recorded};
use crate::session::{CommandError, Next, Output, Session};

/// Leave
#[derive(Debug, Args)]
#[command(visible_alias = "exit", after_help = "Example:\n  quit")]
pub struct Quit;

pub const QUIT: Command =
    Command { alias: Some("exit"), without_scenario: true, recorded: Recorded::Nothing, ..Command::of::<Quit>("quit") };

impl Action for Quit {
    fn run(&self, _: &mut Session, _: &str, _: &mut Output<'_>) -> Result<Next, CommandError> {
        Ok(Next::Quit)
    }
}
