//! `load`, `scenarios`.

use std::io::{self, Write};

use clap::Args;
use serde::Serialize;

use crate::model::embedded;
use crate::session::language::candidates::Candidate;
use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session, Setup, introduction, load};
use crate::view::style::Style;

/// Load a scenario, from a file or an embedded one by its name, and solve it
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  load beam-ray\n  load my/structure.json")]
pub struct Load {
    /// File, or name of an embedded scenario
    #[arg(value_name = "SCENARIO")]
    scenario: String,
}

pub const LOAD: Command = Command {
    complete: |asked| {
        let mut all: Vec<Candidate> =
            embedded::list().into_iter().map(|(name, title)| Candidate::new(name, title)).collect();
        all.extend(asked.files());
        all
    },
    ..Command::of::<Load>("load")
};

impl Action for Load {
    fn run(&self, session: &mut Session, text: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        let scenario = load::scenario(&self.scenario, io.watch)?;
        let mut notes = vec![format!("{}: {}", scenario.name, scenario.title)];
        notes.extend(scenario.description.clone());
        notes.extend(introduction(&scenario));
        session.change_noting(Setup::of(scenario), text, &notes, io)?;
        Ok(Next::Continue)
    }

    fn loads(&self) -> bool {
        true
    }
}

/// List the embedded scenarios
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  scenarios")]
pub struct Scenarios;

pub const SCENARIOS: Command = Command { without_scenario: true, ..Command::of::<Scenarios>("scenarios") };

impl Action for Scenarios {
    fn run(&self, _: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        scenarios(io)?;
        Ok(Next::Continue)
    }
}

#[derive(Serialize)]
struct Listed {
    name: &'static str,
    title: String,
}

/// Lists the embedded scenarios.
pub(super) fn scenarios(io: &mut Output<'_>) -> Result<(), CommandError> {
    let list: Vec<Listed> = embedded::list().into_iter().map(|(name, title)| Listed { name, title }).collect();
    io.show(&list, write_scenarios)?;
    Ok(())
}

/// A line per embedded scenario.
///
/// # Errors
/// Those of `out`.
pub fn write_scenarios(out: &mut dyn Write, style: &Style) -> io::Result<()> {
    let width = embedded::names().map(str::len).max().unwrap_or(0);
    for (name, title) in embedded::list() {
        let line = format!("{name:<width$} {title}");
        writeln!(out, "{}", style.fit(&style.text(&line), style.width))?;
    }
    Ok(())
}
