//! What several subcommands read: a scenario by name, the form of the output.

use clap::ValueEnum;

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
    scenario
}
