//! `--set` and the rules, as `solve` and `sweep` take them.

use clap::Args;

use super::input::named;
use crate::model::rules::{Covering, Engine, TieBreak};
use crate::session::{CommandError, Session};
use crate::signals::TerminalWatch;

/// What is solved with other values and rules than those of the file.
#[derive(Args, Debug)]
pub struct Settings {
    /// Change a parameter, as the REPL's `set` does: `--set f=0.3`, `--set F2=110%`
    #[arg(long = "set", value_name = "NAME=VALUE")]
    values: Vec<String>,
    /// Covering vector: cohesive, ones or weight (like the next two not for the rate problems of load histories)
    #[arg(long)]
    covering: Option<Covering>,
    /// Tie-break: lexicographic, natural, first-row or random:SEED
    #[arg(long)]
    tie_break: Option<TieBreak>,
    /// Engine: scheme, tableau or exact
    #[arg(long)]
    engine: Option<Engine>,
}

impl Settings {
    pub(super) fn has_rules(&self) -> bool {
        self.covering.is_some() || self.tie_break.is_some() || self.engine.is_some()
    }

    /// A session on a scenario named on the command line, solved after these.
    pub(super) fn session(&self, scenario: &str, watch: &TerminalWatch) -> Result<Session, CommandError> {
        let session = Session::with_settings(named(scenario, watch)?, &self.words(), watch);
        watch.clear();
        session
    }

    /// The words after a `set`, setting by setting.
    fn words(&self) -> Vec<Vec<String>> {
        let rule = |name: &str, choice: Option<String>| choice.map(|choice| vec![name.to_owned(), choice]);
        self.values
            .iter()
            .map(|setting| vec![setting.clone()])
            .chain(rule("covering", self.covering.map(|c| c.to_string())))
            .chain(rule("tie-break", self.tie_break.map(|t| t.to_string())))
            .chain(rule("engine", self.engine.map(|e| e.to_string())))
            .collect()
    }
}
