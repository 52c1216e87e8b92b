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
        session.go(Way::Back, io)?;
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
        session.go(Way::Forth, io)?;
        Ok(Next::Continue)
    }
}

#[derive(Clone, Copy)]
enum Way {
    Back,
    Forth,
}

impl Session {
    /// Takes the last change back, or does again the last that was taken back.
    fn go(&mut self, way: Way, io: &mut Output<'_>) -> Result<(), CommandError> {
        let (from, done, record, nothing) = match way {
            Way::Back => (&self.undo, "undone", Record::Undo, "nothing to undo"),
            Way::Forth => (&self.redo, "done again", Record::Redo, "nothing to redo"),
        };
        let Some(change) = from.last().cloned() else {
            return Err(CommandError::Refused(nothing.into()));
        };
        let before = self.now.clone();
        self.enter(change.setup, false, io)?;
        let mut notes = vec![format!("{done}: {}", change.command)];
        notes.extend(self.note_in_journal(&before, |_| record));
        let (from, to) = match way {
            Way::Back => (&mut self.undo, &mut self.redo),
            Way::Forth => (&mut self.redo, &mut self.undo),
        };
        from.pop();
        to.push(Change { command: change.command, setup: before });
        self.say_what_changed(&notes, io)
    }
}
