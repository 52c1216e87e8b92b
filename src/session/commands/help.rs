//! `help`.

use clap::Args;

use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session};

/// Show all commands, or what one of them does; `help method`, `help signs`: the theory
///
/// `help ray` also goes through the steps that find out what a ray means, with the names of the problem loaded.
#[derive(Debug, Args)]
#[command(visible_alias = "?", after_help = "Example:\n  help set\n  help method\n  help ray")]
pub struct Help {
    /// The command, or method, or signs
    #[arg(value_name = "COMMAND")]
    command: Option<String>,
}

pub const HELP: Command = Command { alias: Some("?"), without_scenario: true, ..Command::of::<Help>("help") };

impl Action for Help {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.show_help(self.command.as_deref(), io)?;
        Ok(Next::Continue)
    }
}
