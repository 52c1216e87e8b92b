//! `ray`: what it is, the work of the loads on it, its proof, and what would stop it.

use std::sync::Arc;

use clap::Args;
use serde::Serialize;

use crate::answer::record;
use crate::explain::remedy::Remedy;
use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Remedies, Session, worker};
use crate::view;
use crate::watch::Watch;

/// Show the ray: its class, its motion and what it means
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  load beam-ray; ray")]
pub struct Ray;

pub const RAY: Command = Command::of::<Ray>("ray");

impl Action for Ray {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.report_ray(io)?;
        Ok(Next::Continue)
    }

    fn needs_pivots(&self) -> bool {
        true
    }
}

/// The ray, and what would stop it where that was looked for.
#[derive(Serialize)]
struct RayReport<'a> {
    #[serde(flatten)]
    ray: &'a record::Ray,
    #[serde(skip_serializing_if = "Option::is_none")]
    remedies: Option<&'a [Remedy]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    remedies_complete: Option<bool>,
}

impl Session {
    /// Looks for what would stop the collapse shown, where there is one and it was not looked for yet.
    ///
    /// # Errors
    /// An interruption.
    pub fn ensure_remedies(&mut self, watch: &dyn Watch) -> Result<(), CommandError> {
        if self.remedies().is_some() {
            return Ok(());
        }
        let (prepared, solved) = self.both()?;
        let asked = Arc::clone(&solved);
        if let Some(found) = worker::run(watch, move |watch| prepared.remedies(&asked, watch))? {
            self.remedies = Some((solved, Arc::new(found)));
        }
        Ok(())
    }

    /// What would stop the collapse shown, if it was looked for.
    pub fn remedies(&self) -> Option<Arc<Remedies>> {
        let (of, found) = self.remedies.as_ref()?;
        self.solved.as_ref().filter(|solved| Arc::ptr_eq(solved, of)).map(|_| Arc::clone(found))
    }

    /// `ray`: what it is, the work of the loads on it, its proof, and what would stop it; after a load history the collapse in
    /// which it ended.
    pub(in crate::session) fn report_ray(&mut self, io: &mut Output<'_>) -> Result<(), CommandError> {
        if let Some(place) = self.history_place() {
            let ended = self.quantity_answer().and_then(|answer| answer.ray.as_ref());
            let ray = ended.ok_or_else(|| CommandError::Refused(format!("no ray: the tables stand {place}")))?;
            let report = RayReport { ray, remedies: None, remedies_complete: None };
            io.show(&report, |out, style| {
                view::ray::write(out, ray, &self.now.scenario.units, style)?;
                self.write_history_place(out, style)
            })?;
            return Ok(());
        }
        if self.need_answer()?.ray.is_some() {
            self.ensure_remedies(io.watch)?;
        }
        let answer = self.need_answer()?;
        let ray = answer
            .ray
            .as_ref()
            .ok_or_else(|| CommandError::Refused(format!("no ray: the run ended {}", answer.outcome.word())))?;
        let (prepared, solved) = self.both()?;
        let remedies = self.remedies();
        let report = RayReport {
            ray,
            remedies: remedies.as_ref().map(|found| &found.remedies[..]),
            remedies_complete: remedies.as_ref().map(|found| found.complete),
        };
        io.show(&report, |out, style| {
            view::ray::write(out, ray, &self.now.scenario.units, style)?;
            if let (Some(report), Some(system)) = (&solved.ray, prepared.system()) {
                view::ray::write_details(out, report, system, style)?;
            }
            match &remedies {
                Some(found) => view::ray::write_remedies(out, found, style),
                None => Ok(()),
            }
        })?;
        Ok(())
    }
}
