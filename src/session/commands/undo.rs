//! `undo`, `redo`.

use clap::Args;

use crate::session::journal::Record;
use crate::session::language::command::{Action, Command};
use crate::session::{Change, CommandError, Next, Output, Session};

/// Take back the last change
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  set F2 500; undo")]
pub struct Undo;

pub const UNDO: Command = Command::of::<Undo>("undo");

impl Action for Undo {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.undo_change(io)?;
        Ok(Next::Continue)
    }
}

/// Do again what was undone
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  undo; redo")]
pub struct Redo;

pub const REDO: Command = Command::of::<Redo>("redo");

impl Action for Redo {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.redo_change(io)?;
        Ok(Next::Continue)
    }
}

impl Session {
    fn undo_change(&mut self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let Some(change) = self.undo.last().cloned() else {
            return Err(CommandError::Refused("nothing to undo".into()));
        };
        let before = self.now.clone();
        self.enter(change.setup, false, io)?;
        self.undo.pop();
        let mut notes = vec![format!("undone: {}", change.command)];
        notes.extend(self.note_in_journal(&before, |_| Record::Undo));
        self.redo.push(Change { command: change.command, setup: before });
        self.say_what_changed(&notes, io)
    }

    fn redo_change(&mut self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let Some(change) = self.redo.last().cloned() else {
            return Err(CommandError::Refused("nothing to redo".into()));
        };
        let before = self.now.clone();
        self.enter(change.setup, false, io)?;
        self.redo.pop();
        let mut notes = vec![format!("done again: {}", change.command)];
        notes.extend(self.note_in_journal(&before, |_| Record::Redo));
        self.undo.push(Change { command: change.command, setup: before });
        self.say_what_changed(&notes, io)
    }
}
