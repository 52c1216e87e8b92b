//! What every path starts from.

use std::sync::Arc;

use super::{CommandError, Session, Setup};
use crate::solve::{Case, Prepared, Solved};
use crate::watch::Watch;

/// The present setup, solved.
#[derive(Clone)]
pub(in crate::session) struct PathStart {
    pub(in crate::session) setup: Setup,
    pub(in crate::session) prepared: Arc<Prepared>,
    pub(in crate::session) solved: Arc<Solved>,
}

impl PathStart {
    pub(in crate::session) fn case<'a>(&'a self, watch: &'a dyn Watch) -> Case<'a> {
        self.setup.case(&self.prepared, watch)
    }
}

/// The names of the load cases.
pub(in crate::session) fn case_names(prepared: &Prepared) -> Vec<String> {
    prepared.cases.iter().map(|(name, _)| name.clone()).collect()
}

impl Session {
    /// The present setup, solved; with the factors that the scenario gives, also where a combination is shown.
    pub(in crate::session) fn ground(&self, watch: &dyn Watch) -> Result<PathStart, CommandError> {
        let mut setup = self.now.clone();
        let solved = match (&self.solved, &setup.prepared) {
            (Some(solved), Some(_)) if self.combination.is_none() => Arc::clone(solved),
            _ => setup.solve(watch)?,
        };
        let prepared = setup
            .prepared
            .clone()
            .ok_or_else(|| CommandError::Internal("a solved scenario has no prepared geometry".to_owned()))?;
        Ok(PathStart { setup, prepared, solved })
    }
}
