//! Scripts: files of commands that `source` and `replay` run.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Format, Next, Output, Session, language::tokens, load};
use crate::view::style::Role;

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
        source(session, &self.file, io)
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

/// Scripts within scripts, at most: a script that sources itself ends here.
const DEEPEST: usize = 16;

/// A longer line, in bytes, is no command.
pub const LONGEST: usize = 1 << 20;

impl Session {
    /// The refusal of such a line: of no part of it anything is done.
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
    let commands: Vec<(usize, &str)> = text
        .lines()
        .enumerate()
        .flat_map(|(index, line)| tokens::commands(line).into_iter().map(move |command| (index + 1, command)))
        .collect();
    let mut status = 0;
    let mut next = Next::Continue;
    let unattended = std::mem::replace(&mut io.unattended, true);
    for (index, (line, command)) in commands.iter().enumerate() {
        io.line = *line;
        if io.echo && io.format == Format::Text {
            let said = io.style.paint(Role::Accent, &io.style.text(&format!("> {command}")));
            writeln!(io.out, "{said}")?;
        }
        let result =
            if command.len() > LONGEST { Err(session.refuse_long_line(*line)) } else { session.run(command, io) };
        match result {
            Ok(Next::Continue) => {}
            Ok(end) => {
                next = end;
                break;
            }
            Err(error) if error.is_output() => return Err(error),
            Err(error) => {
                let interrupted = error.is_interrupted();
                let asked_for = commands.get(index + 1).is_some_and(|(_, next)| session.lets_fail(next));
                if asked_for && !interrupted {
                    continue;
                }
                if status == 0 {
                    status = error.status();
                }
                failed(CommandError::Script { script: name.to_owned(), line: *line, error: Box::new(error) });
                if interrupted || !keep_going {
                    break;
                }
            }
        }
    }
    io.unattended = unattended;
    if status == 0 {
        status = session.trouble_status();
    }
    Ok(Ended { next, status })
}

/// `source FILE`: its first failure is the failure of `source`; what ran before it stays done. `quit` in a script
/// leaves the program.
pub(in crate::session) fn source(
    session: &mut Session,
    path: &Path,
    io: &mut Output<'_>,
) -> Result<Next, CommandError> {
    if session.depth >= DEEPEST {
        return Err(CommandError::Refused(format!("{DEEPEST} scripts within scripts: does one source itself?")));
    }
    let text = load::script(Some(path), io.watch)?;
    let line = io.line;
    let mut first = None;
    session.depth += 1;
    let ended = run(session, &path.display().to_string(), &text, false, io, &mut |error| first = Some(error));
    session.depth -= 1;
    io.line = line;
    io.report = None;
    match first {
        Some(error) => Err(error),
        None => Ok(ended?.next),
    }
}
