//! Scripts: texts of commands that `source`, `replay` and a pipe run.

use std::path::Path;

use super::language::turn::Turn;
use super::{CommandError, Format, Next, Output, Session, load};
use crate::view::style::Role;

/// Scripts within scripts, at most: a script that sources itself ends here.
const DEEPEST: usize = 16;

/// A longer line, in bytes, is not a command.
pub const LONGEST: usize = 1 << 20;

impl Session {
    /// The refusal of such a line: no part of it is run.
    pub fn refuse_long_line(&mut self, line: usize) -> CommandError {
        let refusal =
            format!("line {line} has more than {LONGEST} bytes: no command is so long; nothing of it was done");
        self.last_error = Some(refusal.clone());
        CommandError::Refused(refusal)
    }
}

/// How a script ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ended {
    /// Whether it said `quit`.
    pub next: Next,
    /// Status of the first command that failed, 4 if a run ended without an answer and nobody expected that, else 0.
    pub status: u8,
}

/// Runs the commands of `text`. Each failure goes to `failed`, with its place; the first ends the script unless
/// `keep_going`.
///
/// # Errors
/// Only when the results cannot be written.
pub fn run(
    session: &mut Session,
    name: &str,
    text: &str,
    keep_going: bool,
    io: &mut Output<'_>,
    failed: &mut dyn FnMut(CommandError),
) -> Result<Ended, CommandError> {
    let mut ended = Ended { next: Next::Continue, status: 0 };
    let unattended = std::mem::replace(&mut io.unattended, true);
    for turn in Turn::of_text(text) {
        io.line = turn.line;
        if io.echo && io.format == Format::Text {
            let said = io.style.paint(Role::Accent, &io.style.text(&format!("> {}", turn.command)));
            writeln!(io.out, "{said}")?;
        }
        let result = match turn.command.len() > LONGEST {
            true => Err(session.refuse_long_line(turn.line)),
            false => session.run(turn.command, io),
        };
        match result {
            Ok(Next::Continue) => {}
            Ok(next) => {
                ended.next = next;
                break;
            }
            Err(error) if error.is_output() => return Err(error),
            Err(error) if turn.forgives(&error) => {}
            Err(error) => {
                if ended.status == 0 {
                    ended.status = error.status();
                }
                let ends = error.is_interrupted() || !keep_going;
                failed(CommandError::Script { script: name.to_owned(), line: turn.line, error: Box::new(error) });
                if ends {
                    break;
                }
            }
        }
    }
    io.unattended = unattended;
    if ended.status == 0 {
        ended.status = session.trouble_status();
    }
    Ok(ended)
}

impl Session {
    /// `source FILE`: its first failure is the failure of `source`; what ran before it stays done. `quit` in a script
    /// leaves the program.
    pub(in crate::session) fn source(&mut self, path: &Path, io: &mut Output<'_>) -> Result<Next, CommandError> {
        if self.depth >= DEEPEST {
            return Err(CommandError::Refused(format!("{DEEPEST} scripts within scripts: does one source itself?")));
        }
        let text = load::script(Some(path), io.watch)?;
        let line = io.line;
        let mut first = None;
        self.depth += 1;
        let ended = run(self, &path.display().to_string(), &text, false, io, &mut |error| first = Some(error));
        self.depth -= 1;
        io.line = line;
        io.report = None;
        match first {
            Some(error) => Err(error),
            None => Ok(ended?.next),
        }
    }
}
