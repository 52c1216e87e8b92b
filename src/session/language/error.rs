//! Lines that are no commands.

use thiserror::Error;

use super::tokens::OpenQuote;

/// A command that does not belong to the language.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum GrammarError {
    /// Quotation not closed.
    #[error(transparent)]
    Quote(#[from] OpenQuote),
    /// No such command.
    #[error("unknown command `{word}`{near}: `help` lists all commands")]
    Unknown {
        /// The word.
        word: String,
        /// The question whether a near one was meant, or nothing.
        near: String,
    },
    /// A prefix of several commands.
    #[error("`{word}` may be {}: write one more letter", .candidates.join(", "))]
    Ambiguous {
        /// The word.
        word: String,
        /// What it may mean.
        candidates: Vec<String>,
    },
    /// The arguments are wrong; the text is clap's, in one paragraph.
    #[error("{0}")]
    Arguments(String),
}
