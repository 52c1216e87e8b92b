//! `restore`: the changes of a session that ended without `quit`, brought back from its journal.

use std::sync::Arc;

use super::{CommandError, Output, Session, command, journal};

impl Session {
    /// Brings back what an earlier session left behind.
    pub(super) fn restore(&mut self, discard: bool, io: &mut Output<'_>) -> Result<(), CommandError> {
        let Some(left) = self.left_over.take() else {
            return Err(CommandError::Refused(
                "nothing to restore: no session in this directory ended without `quit`".into(),
            ));
        };
        let changes = left.changes();
        if discard {
            left.discard().map_err(|source| CommandError::File {
                doing: "remove the journal in",
                path: journal::state_directory().unwrap_or_default(),
                source,
            })?;
            return Ok(io.say(&format!("{changes} changes forgotten"))?);
        }
        let kept = (
            self.now.clone(),
            self.solved.clone(),
            self.previous.clone(),
            self.position,
            (self.auto, self.trouble),
            (self.undo.clone(), self.redo.clone()),
        );
        let journal = self.journal.take();
        let result = self.replay_journal(&left.commands, io);
        self.journal = journal;
        if let Err(error) = result {
            (self.now, self.solved, self.previous, self.position, (self.auto, self.trouble), (self.undo, self.redo)) =
                kept;
            self.left_over = Some(left);
            return Err(error);
        }
        for command in &left.commands {
            self.note_in_journal(command)?;
        }
        // the new journal holds everything: a file that stays behind is only offered once more
        let _ = left.discard();
        let s = if changes == 1 { "" } else { "s" };
        self.say_what_changed(&[format!("{changes} change{s} restored")], io)
    }

    fn replay_journal(&mut self, commands: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        self.deferred = true;
        let mut nowhere = std::io::sink();
        let mut quiet = Output::text(&mut nowhere, io.style, io.watch);
        let mut result = Ok(());
        for (index, text) in commands.iter().enumerate() {
            let applied = match command::parse(text) {
                Ok(Some(command)) => self.apply(command, text, &mut quiet).map(|_| ()),
                Ok(None) => Ok(()),
                Err(error) => Err(error.into()),
            };
            if let Err(error) = applied {
                result =
                    Err(CommandError::Script { script: "journal".into(), line: index + 2, error: Box::new(error) });
                break;
            }
        }
        self.deferred = false;
        result?;
        if self.auto {
            let mut next = self.now.clone();
            let solved = next.solve(io.watch)?;
            for change in &mut self.undo {
                if Arc::ptr_eq(&change.setup.scenario, &next.scenario) {
                    change.setup.prepared.clone_from(&next.prepared);
                }
            }
            self.now = next;
            self.take_answer(Some(solved));
        }
        Ok(())
    }
}
