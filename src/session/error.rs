//! Why a command failed, and the exit status that this means for a script.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use crate::model::problem::Problems;
use crate::solve::PrepareError;

use super::save::SaveError;
use super::worker::WorkerError;
use crate::path::grid::GridError;
use crate::path::start::PathError;
use crate::path::sweep_file::SweepFileError;
use crate::session::language::error::GrammarError;
use crate::session::language::expect::{ExpectationSyntax, Unmet};
use crate::session::language::setting::SetError;
use crate::solve::error::QuestionError;
use crate::text::file::reason;

/// A command that failed; the session is as it was.
#[derive(Debug, Error)]
pub enum CommandError {
    /// Not in the language.
    #[error(transparent)]
    Grammar(#[from] GrammarError),
    /// `set` with wrong words.
    #[error(transparent)]
    Set(#[from] SetError),
    /// `expect` with wrong words.
    #[error(transparent)]
    ExpectationSyntax(#[from] ExpectationSyntax),
    /// `expect` that does not hold.
    #[error(transparent)]
    Unmet(#[from] Unmet),
    /// A scenario with problems.
    #[error("{0}")]
    Scenario(Problems),
    /// The main system or the rules do not allow to solve.
    #[error("{0}")]
    Solve(String),
    /// The user stopped it.
    #[error("interrupted: the session is as it was")]
    Interrupted,
    /// An error of this program.
    #[error("{0}")]
    Internal(String),
    /// `save` failed.
    #[error(transparent)]
    Save(#[from] SaveError),
    /// A file that cannot be read or written.
    #[error("cannot {doing} {}: {}", .path.display(), reason(.source))]
    File {
        /// `read`, `write` …
        doing: &'static str,
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A command of a script failed.
    #[error("{script}:{line}: {error}")]
    Script {
        /// Name of the script.
        script: String,
        /// Line, from 1.
        line: usize,
        /// What happened there.
        error: Box<CommandError>,
    },
    /// A path whose numbers no longer belong together, or that came to a limit of the program.
    #[error("{0}")]
    Lost(String),
    /// Anything else about the words or the state: what, and what to do.
    #[error("{0}")]
    Refused(String),
    /// The place for the results does not take them.
    #[error("cannot write the result: {}", reason(.0))]
    Output(#[from] io::Error),
}

impl From<WorkerError> for CommandError {
    fn from(error: WorkerError) -> Self {
        match error {
            WorkerError::Interrupted => CommandError::Interrupted,
            other => CommandError::Internal(other.to_string()),
        }
    }
}

impl From<PrepareError> for CommandError {
    fn from(error: PrepareError) -> Self {
        match error {
            PrepareError::Problems(problems) => CommandError::Scenario(problems),
            PrepareError::Interrupted => CommandError::Interrupted,
        }
    }
}

/// A command that cannot be carried out, in a sentence.
pub(in crate::session) fn refused<T>(text: impl Into<String>) -> Result<T, CommandError> {
    Err(CommandError::Refused(text.into()))
}

impl CommandError {
    /// Exit status of a script that ends with this error.
    pub fn status(&self) -> u8 {
        match self {
            CommandError::Unmet(_) => 1,
            CommandError::Internal(_) | CommandError::Lost(_) => 4,
            CommandError::Interrupted => 130,
            CommandError::Script { error, .. } => error.status(),
            _ => 2,
        }
    }

    /// Whether the reader of the results has gone away, which ends a program quietly.
    pub fn is_broken_pipe(&self) -> bool {
        match self {
            CommandError::Output(error) => error.kind() == io::ErrorKind::BrokenPipe,
            CommandError::Script { error, .. } => error.is_broken_pipe(),
            _ => false,
        }
    }

    /// Whether the face cannot show anything any more.
    pub fn is_output(&self) -> bool {
        match self {
            CommandError::Output(_) => true,
            CommandError::Script { error, .. } => error.is_output(),
            _ => false,
        }
    }

    /// What the place for the results said, where that is the error.
    pub fn into_output(self) -> io::Error {
        match self {
            CommandError::Output(error) => error,
            CommandError::Script { error, .. } => error.into_output(),
            other => io::Error::other(other.to_string()),
        }
    }

    /// Whether the user stopped it.
    pub fn is_interrupted(&self) -> bool {
        match self {
            CommandError::Interrupted => true,
            CommandError::Script { error, .. } => error.is_interrupted(),
            _ => false,
        }
    }
}

impl From<PathError> for CommandError {
    fn from(error: PathError) -> Self {
        match error {
            PathError::Interrupted => CommandError::Interrupted,
            lost @ PathError::Breakdown { .. } => CommandError::Lost(lost.to_string()),
            error => CommandError::Refused(error.to_string()),
        }
    }
}

impl From<GridError> for CommandError {
    fn from(error: GridError) -> Self {
        CommandError::Refused(error.to_string())
    }
}

impl From<SweepFileError> for CommandError {
    fn from(error: SweepFileError) -> Self {
        match error {
            SweepFileError::Output(error) => CommandError::Output(error),
            SweepFileError::Interrupted => CommandError::Interrupted,
            error => CommandError::Refused(error.to_string()),
        }
    }
}

impl From<QuestionError> for CommandError {
    fn from(error: QuestionError) -> Self {
        match error {
            QuestionError::Interrupted => CommandError::Interrupted,
            QuestionError::Refused(text) => CommandError::Refused(text),
        }
    }
}
