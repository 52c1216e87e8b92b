//! What the user has chosen: all that `undo` brings back, `save` and `record` write down.

use std::sync::Arc;

use super::language::setting::{RULES, SetError, Setting};
use super::language::tokens;
use super::{CommandError, Session, worker};
use crate::model::embedded;
use crate::model::parameter::ParameterValues;
use crate::model::rules::Rules;
use crate::model::scenario::Scenario;
use crate::model::uses::Redone;
use crate::solve::{self, Case, Prepared, SolveError, Solved};
use crate::watch::Watch;

/// What the user has chosen: all that `undo` brings back.
#[derive(Clone)]
pub(super) struct Setup {
    pub(super) scenario: Arc<Scenario>,
    /// The factorization and R of the scenario; kept for every change of values and rules.
    pub(super) prepared: Option<Arc<Prepared>>,
    pub(super) values: ParameterValues,
    pub(super) rules: Rules,
}

/// A change that can be taken back.
#[derive(Clone)]
pub(super) struct Change {
    /// The command, as typed.
    pub(super) command: String,
    /// What was before it (in `undo`), or after it (in `redo`).
    pub(super) setup: Setup,
}

impl Setup {
    pub(super) fn of(scenario: Scenario) -> Self {
        Setup {
            values: scenario.parameter_values(),
            rules: scenario.rules,
            scenario: Arc::new(scenario),
            prepared: None,
        }
    }

    /// Makes a setting, all but `auto`.
    pub(super) fn take(&mut self, setting: &Setting) -> Result<(), SetError> {
        match setting {
            Setting::Parameter(name, value) => {
                self.values.insert(name.clone(), *value);
            }
            Setting::Rule(rule, choice) => (rule.set)(&mut self.rules, choice)?,
            Setting::Auto(_) => {}
        }
        Ok(())
    }

    /// What was chosen, with the geometry made ready for it.
    pub(super) fn case<'a>(&'a self, prepared: &'a Prepared, watch: &'a dyn Watch) -> Case<'a> {
        prepared.case(&self.scenario, &self.values).under(self.rules).watched(watch)
    }

    /// Solves cold, preparing the geometry if that was not done yet.
    pub(super) fn solve(&mut self, watch: &dyn Watch) -> Result<Arc<Solved>, CommandError> {
        self.solve_from(None, false, watch)
    }

    /// Solves, from the `last` answer of the same geometry where there is one and that pays; `joints_first`:
    /// displacements and the check of equilibrium of an answer found so are left for [`Session::ensure_whole`].
    pub(super) fn solve_from(
        &mut self,
        last: Option<Arc<Solved>>,
        joints_first: bool,
        watch: &dyn Watch,
    ) -> Result<Arc<Solved>, CommandError> {
        let scenario = Arc::clone(&self.scenario);
        let prepared = self.prepared.clone();
        let (values, rules) = (self.values.clone(), self.rules);
        let (prepared, solved) = worker::run(watch, move |watch| {
            let (prepared, redone) = match prepared {
                Some(prepared) => match prepared.renewed(&scenario, &values, watch)? {
                    Some((renewed, redone)) => (Arc::new(renewed), redone),
                    None => (prepared, Redone::Lcp),
                },
                None => (Arc::new(solve::prepare_at(&scenario, &values, watch)?), Redone::Stiffness),
            };
            let case = prepared.case(&scenario, &values).under(rules).watched(watch);
            let solved = match last.filter(|_| redone < Redone::Stiffness) {
                Some(last) if joints_first => case.solve_joints_from(&last),
                Some(last) => case.solve_from(&last),
                None => case.solve(),
            };
            let mut solved = solved.map_err(refused_or_interrupted)?;
            solved.answer.redone = redone;
            Ok::<_, CommandError>((prepared, Arc::new(solved)))
        })??;
        self.prepared = Some(prepared);
        Ok(solved)
    }

    /// The answer of this setup with what was left for later.
    pub(super) fn whole(&self, solved: Arc<Solved>, watch: &dyn Watch) -> Result<Solved, CommandError> {
        let Some(prepared) = self.prepared.clone() else { return Ok(solved.completed()) };
        let setup = self.clone();
        worker::run(watch, move |watch| setup.case(&prepared, watch).whole(&solved))?.map_err(refused_or_interrupted)
    }

    pub(super) fn same_choice(&self, other: &Setup) -> bool {
        Arc::ptr_eq(&self.scenario, &other.scenario)
            && self.rules == other.rules
            && self.values.len() == other.values.len()
            && self.values.iter().zip(&other.values).all(|((a, x), (b, y))| a == b && x.to_bits() == y.to_bits())
    }
}

pub(super) fn refused_or_interrupted(error: SolveError) -> CommandError {
    if error.is_interrupted() { CommandError::Interrupted } else { CommandError::Solve(error.to_string()) }
}

impl Session {
    /// Commands that bring a fresh session to the present scenario, values and rules.
    pub fn as_commands(&self) -> Vec<String> {
        let scenario = &self.now.scenario;
        // a file may bear the name of an embedded scenario
        let embedded = scenario.path.is_some() && embedded::text(&scenario.name).is_some();
        let place = if embedded { "./" } else { "" };
        let mut commands = vec![format!("load {}", tokens::quote(&format!("{place}{}", scenario.name)))];
        let mut sets: Vec<String> = self
            .now
            .values
            .free()
            .filter(|(name, value)| {
                scenario.parameters.get(*name).is_none_or(|parameter| parameter.value.to_bits() != value.to_bits())
            })
            .map(|(name, value)| format!("set {name} {value}"))
            .collect();
        for rule in &RULES {
            let now = (rule.shown)(&self.now.rules);
            if now != (rule.shown)(&scenario.rules) {
                sets.push(format!("set {} {now}", rule.name));
            }
        }
        // one run for all of them: a run after only some of them might be refused
        if sets.len() > 1 || !self.auto {
            commands.push("set auto off".to_owned());
        }
        let several = sets.len() > 1;
        commands.extend(sets);
        if several && self.auto {
            commands.push("set auto on".to_owned());
        }
        commands
    }
}
