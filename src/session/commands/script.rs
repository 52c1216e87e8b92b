//! `source` runs a file of commands, `echo` prints words in one.

use std::path::PathBuf;

use clap::Args;

use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session};

/// Run the commands of a script
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  source scenarios/scripts/beam.stick")]
pub struct Source {
    /// The script
    #[arg(value_name = "FILE")]
    file: PathBuf,
}

pub const SOURCE: Command = Command::of::<Source>("source");

impl Action for Source {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.source(&self.file, io)
    }
}

/// Print the words that follow
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  echo now with less friction")]
pub struct Echo {
    /// Any words
    #[arg(value_name = "WORDS", trailing_var_arg = true, allow_hyphen_values = true)]
    words: Vec<String>,
}

pub const ECHO: Command =
    Command { verbatim: true, without_scenario: true, keeps_error: true, ..Command::of::<Echo>("echo") };

impl Action for Echo {
    fn run(&self, _: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        io.say(&self.words.join(" "))?;
        Ok(Next::Continue)
    }
}
