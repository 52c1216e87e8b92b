//! `help`.

use clap::Args;

use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session};

/// Show all commands, or what one of them does
#[derive(Debug, Args)]
#[command(visible_alias = "?", after_help = "Example:\n  help set")]
pub struct Help {
    /// The command
    #[arg(value_name = "COMMAND")]
    command: Option<String>,
}

pub const HELP: Command = Command { alias: Some("?"), without_scenario: true, ..Command::of::<Help>("help") };

impl Action for Help {
    fn run(&self, _: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        Session::show_help(self.command.as_deref(), io)?;
        Ok(Next::Continue)
    }
}
