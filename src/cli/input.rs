//! What several subcommands read: a scenario by name, the form of the output.

use std::path::Path;

use clap::ValueEnum;

use super::prompt;
use crate::model::problem::Problems;
use crate::model::scenario::Scenario;
use crate::session::{CommandError, load};
use crate::signals::TerminalWatch;

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Form {
    Text,
    Json,
}

/// A scenario named on the command line.
pub(super) fn named(word: &str, watch: &TerminalWatch) -> Result<Scenario, CommandError> {
    let scenario = if word == "-" { load::stdin(watch) } else { load::scenario(word, watch) };
    watch.clear();
    match (scenario, prompt::hint_of(word)) {
        (Err(CommandError::Scenario(_)), Some(hint)) if !Path::new(word).exists() => {
            Err(CommandError::Scenario(Problems::of_file(word, "no embedded scenario and no file has this name", hint)))
        }
        (scenario, _) => scenario,
    }
}
