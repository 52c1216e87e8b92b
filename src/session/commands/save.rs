//! `save`.

use std::path::PathBuf;
use std::sync::Arc;

use clap::Args;

use crate::session::journal::Record;
use crate::session::language::command::{Action, Command};
use crate::session::save;
use crate::session::{CommandError, Next, Output, Session};

/// Write the scenario with the present values and rules to a file
///
/// The text of the file that was loaded is kept, with its order, layout and units; only values that changed are
/// written anew. Without FILE it goes back to the file it came from. The file is replaced whole or not at all, and
/// is the one that `diff` and `reset` compare with from here on.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  set F2 150; save beam-150.json")]
pub struct Save {
    /// File to write
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,
}

pub const SAVE: Command = Command::of::<Save>("save");

impl Action for Save {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.save(self.file.as_deref(), io)?;
        Ok(Next::Continue)
    }
}

impl Session {
    fn save(&mut self, file: Option<&std::path::Path>, io: &mut Output<'_>) -> Result<(), CommandError> {
        let path = match file {
            Some(path) => path.to_owned(),
            None => self.now.scenario.path.clone().ok_or_else(|| {
                CommandError::Refused(format!(
                    "`{}` is an embedded scenario: write `save FILE`",
                    self.now.scenario.name
                ))
            })?,
        };
        let saved = save::save(&self.now.scenario, &self.now.values, self.now.rules, &path)?;
        let mut said = format!("saved {}", path.display());
        // what went into a pipe or a device cannot be loaded again
        if path.is_file() {
            let before = self.now.clone();
            self.now.scenario = Arc::new(saved);
            // where changes are taken back the file stays this one
            for change in self.undo.iter_mut().chain(&mut self.redo) {
                if Arc::ptr_eq(&change.setup.scenario, &before.scenario) {
                    change.setup.scenario = Arc::clone(&self.now.scenario);
                }
            }
            if let Some(note) = self.note_in_journal(&before, Record::Saved) {
                said = format!("{said}; {note}");
            }
        }
        Ok(io.say(&said)?)
    }
}
