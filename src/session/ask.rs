//! Long questions, answered beside the session.

use super::{CommandError, Output, Session, worker};
use crate::solve::error::QuestionError;
use crate::solve::{Prepared, Solved};
use crate::watch::Watch;

impl Session {
    /// Runs a long question beside the session.
    pub(super) fn ask<T: Send + 'static>(
        &self,
        io: &Output<'_>,
        question: impl FnOnce(&Prepared, &Solved, &dyn Watch) -> Result<T, QuestionError> + Send + 'static,
    ) -> Result<T, CommandError> {
        let (prepared, solved) = self.both()?;
        let result = worker::run(io.watch, move |watch| question(&prepared, &solved, watch))?;
        Ok(result?)
    }
}
