//! Why nothing was solved, and why a question has no answer.

use super::prepared::PrepareError;
use crate::contact::written::CoveringError;
use crate::model::rules::Covering;

/// Why nothing was solved; the session stays as it was.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// The covering does not fit the numbers.
    #[error(transparent)]
    Covering(#[from] CoveringError),
    /// A covering chosen for a bare LCP.
    #[error(
        "a bare LCP has its own covering vector (`covering` in the file, ones otherwise): `covering {0}` is for contact"
    )]
    CoveringOfPlain(Covering),
    /// A law got a value it cannot have.
    #[error("{0}")]
    Value(String),
    /// More than the exact engine takes.
    #[error(
        "engine exact takes at most {most} {what} (this problem has {found}): use engine scheme or tableau; `check exact` \
         proves an answer of any size"
    )]
    TooLargeForExact {
        /// `contact pairs` or `rows`.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many it takes.
        most: usize,
    },
    /// Stopped from outside.
    #[error("interrupted")]
    Interrupted,
}

impl SolveError {
    /// Whether the work was stopped from outside.
    pub fn is_interrupted(&self) -> bool {
        matches!(self, SolveError::Interrupted)
    }
}

/// Why a question has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum QuestionError {
    /// Says what does not fit.
    #[error("{0}")]
    Refused(String),
    /// Stopped from outside.
    #[error("interrupted")]
    Interrupted,
}

impl From<SolveError> for QuestionError {
    fn from(error: SolveError) -> Self {
        if error.is_interrupted() { QuestionError::Interrupted } else { QuestionError::Refused(error.to_string()) }
    }
}

impl From<PrepareError> for QuestionError {
    fn from(error: PrepareError) -> Self {
        if error.is_interrupted() { QuestionError::Interrupted } else { QuestionError::Refused(error.to_string()) }
    }
}
