//! How the program ends: exit statuses, and what is said on the way out.

use std::ffi::OsString;
use std::io::{self, Write};

use serde_json::Value;

use crate::export::json as json_export;
use crate::model::problem::Problems;
use crate::session::CommandError;
use crate::view::style::Style;

/// What ends the program early.
pub enum Failure {
    /// A command that failed.
    Command(CommandError),
    /// A message for stderr and a status.
    Status(u8, String),
    /// What is wrong was reported already.
    Told(u8),
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Failure::Command(CommandError::Output(error))
    }
}

impl From<CommandError> for Failure {
    fn from(error: CommandError) -> Self {
        Failure::Command(error)
    }
}

/// The exit status of a face; says on stderr, in the style `errors`, why it could not go on.
pub fn finish(ended: io::Result<u8>, errors: &Style) -> u8 {
    status(ended.map_err(Failure::from), false, errors)
}

/// Whether the arguments ask for JSON; needed where they cannot be read as a whole.
pub(super) fn asks_for_json(arguments: &[OsString]) -> bool {
    let pair = |pair: &[OsString]| pair[0] == "--format" && pair[1] == "json";
    arguments.iter().any(|word| word == "--format=json") || arguments.windows(2).any(pair)
}

/// The exit status of a result; a failure is reported on stderr, and with `json` on stdout as well.
pub(super) fn status(result: Result<u8, Failure>, json: bool, errors: &Style) -> u8 {
    let (status, message, error) = match result {
        Ok(status) | Err(Failure::Told(status)) => return status,
        Err(Failure::Command(error)) if error.is_broken_pipe() => return 0,
        // a shell run leaves no session behind
        Err(Failure::Command(error)) if error.is_interrupted() => (error.status(), "interrupted".to_owned(), None),
        Err(Failure::Command(error)) => (error.status(), error.to_string(), Some(error)),
        Err(Failure::Status(status, message)) => (status, message, None),
    };
    if json && status == 2 && !error.as_ref().is_some_and(CommandError::is_output) {
        let problems = match error {
            Some(CommandError::Scenario(problems)) => problems,
            _ => Problems::of_file("", message.as_str(), ""),
        };
        tell_json(&json_export::no_result(&[problems]));
    }
    tell(errors, &message);
    status
}

/// What is wrong with the input, for a program that reads stdout; if nobody does, so be it.
pub(super) fn tell_json(error: &Value) {
    let _ = json_export::pretty(error).and_then(|text| writeln!(io::stdout(), "{text}"));
}

/// An error on stderr; if nobody can read it, so be it.
pub(super) fn tell(style: &Style, message: &str) {
    let _ = writeln!(io::stderr(), "{}", style.error(message));
}
