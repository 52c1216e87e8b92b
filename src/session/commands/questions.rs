//! Commands that ask why: ties, the dictionary, other rules, all answers, critical friction, the exact check.

use std::sync::Arc;
use std::time::Duration;

use serde_json::{Value, json};

use crate::contact::schemes::critical::Coverage;
use crate::explain::margin::Margin;
use crate::model::scenario::Source;
use crate::model::uses::Region;
use crate::solve::all_answers::{AllAnswers, Continuum, Moving};
use crate::solve::error::QuestionError;
use crate::solve::{Prepared, Solved};
use crate::view;
use crate::watch::{Quiet, Watch};

use crate::session::{CommandError, Output, Remedies, Session, worker};

/// How long the answers of a stopped search are waited for.
const PATIENCE: Duration = Duration::from_secs(2);

impl From<QuestionError> for CommandError {
    fn from(error: QuestionError) -> Self {
        match error {
            QuestionError::Interrupted => CommandError::Interrupted,
            QuestionError::Refused(text) => CommandError::Refused(text),
        }
    }
}

/// A set of answers: its corners, numbered from 1 as the answers are, and the directions in which it has no end.
fn continuum(all: &AllAnswers, piece: &Continuum) -> Value {
    let z = |corner: &usize| all.answers[*corner].answer.solution.as_ref().map(|solution| &solution.z);
    let directions: Vec<Value> = piece
        .directions
        .iter()
        .map(|direction| match direction {
            Moving::Pairs(pairs) => json!(pairs),
            Moving::Plain(z) => json!(z),
        })
        .collect();
    json!({
        "answers": piece.corners.iter().map(|corner| corner + 1).collect::<Vec<_>>(),
        "corners": piece.corners.iter().map(z).collect::<Option<Vec<_>>>(),
        "directions": directions,
    })
}

impl Session {
    fn both(&self) -> Result<(Arc<Prepared>, Arc<Solved>), CommandError> {
        self.need_answer()?;
        match (&self.now.prepared, &self.solved) {
            (Some(prepared), Some(solved)) => Ok((Arc::clone(prepared), Arc::clone(solved))),
            _ => Err(CommandError::Refused("not solved yet: `solve`".into())),
        }
    }

    /// Runs a long question beside the session.
    fn ask<T: Send + 'static>(
        &self,
        io: &Output<'_>,
        question: impl FnOnce(&Prepared, &Solved, &dyn Watch) -> Result<T, QuestionError> + Send + 'static,
    ) -> Result<T, CommandError> {
        let (prepared, solved) = self.both()?;
        let result = worker::run(io.watch, move |watch| question(&prepared, &solved, watch))?;
        Ok(result?)
    }

    /// What only contact holds, in sentences.
    pub(in crate::session) fn loose(&self) -> Vec<String> {
        self.now.prepared.as_ref().map_or_else(Vec::new, |prepared| prepared.loose_sentences())
    }

    /// How far the final scheme holds; empty at a pivot on the way.
    pub(in crate::session) fn margins(&self, id: &str) -> Vec<Margin> {
        let (Some(prepared), Some(solved), None) = (&self.now.prepared, &self.solved, self.position) else {
            return Vec::new();
        };
        let pair = solved.answer.pairs.iter().position(|pair| pair.id == id);
        pair.map_or_else(Vec::new, |pair| solved.margins(self.now.case(prepared, &Quiet), pair))
    }

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

    /// `ray`: what it is, the work of the loads on it, its proof, and what would stop it.
    pub(in crate::session) fn report_ray(&mut self, io: &mut Output<'_>) -> Result<(), CommandError> {
        if self.need_answer()?.ray.is_some() {
            self.ensure_remedies(io.watch)?;
        }
        let answer = self.need_answer()?;
        let ray = answer.ray.as_ref().ok_or_else(|| {
            CommandError::Refused(format!("no ray: the run ended {}", view::status::outcome_word(answer.outcome)))
        })?;
        let (prepared, solved) = self.both()?;
        let remedies = self.remedies();
        io.report(
            || {
                let mut value = json!(ray);
                if let Some(found) = &remedies {
                    value["remedies"] = json!(found.remedies);
                    value["remedies_complete"] = json!(found.complete);
                }
                value
            },
            |out, style| {
                view::ray::write(out, ray, &self.now.scenario.units, style)?;
                if let (Some(report), Some(system)) = (&solved.ray, prepared.system()) {
                    view::ray::write_details(out, report, system, style)?;
                }
                match &remedies {
                    Some(found) => view::ray::write_remedies(out, found, style),
                    None => Ok(()),
                }
            },
        )?;
        Ok(())
    }

    pub(in crate::session) fn report_ties(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let (prepared, solved) = self.both()?;
        let report =
            solved.ties(&prepared).ok_or_else(|| CommandError::Refused("ties: the last vertex is singular".into()))?;
        io.report(|| json!(report), |out, style| view::ties::write(out, &report, style))?;
        Ok(())
    }

    pub(in crate::session) fn report_tableau(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let (prepared, solved) = self.both()?;
        let dictionary = solved
            .dictionary_at(&prepared, self.shown_step())
            .map_err(|error| CommandError::Refused(format!("tableau: {error}")))?;
        io.report(|| json!(dictionary), |out, style| view::tableau::write(out, &dictionary, style))?;
        Ok(())
    }

    pub(in crate::session) fn compare(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let values = self.now.values.clone();
        let comparison = self.ask(io, move |prepared, _, watch| Ok(prepared.compare(&values, watch)?))?;
        io.report(|| json!(comparison), |out, style| view::compare::write(out, &comparison, style))?;
        Ok(())
    }

    pub(in crate::session) fn enumerate(
        &mut self,
        answer: Option<usize>,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let values = self.now.values.clone();
        // Stopped, it shows what was found so far.
        let (prepared, _) = self.both()?;
        let mut all: AllAnswers =
            worker::run_patiently(io.watch, PATIENCE, move |watch| prepared.all_answers(&values, watch))??;
        if let Some(number) = answer {
            let count = all.answers.len();
            if number == 0 || number > count {
                return Err(CommandError::Refused(match count {
                    0 => "enumerate: there is no answer to show".to_owned(),
                    1 => format!("enumerate: there is no answer {number}; expected 1"),
                    _ => format!("enumerate: there is no answer {number}; expected 1 … {count}"),
                }));
            }
            let chosen = all.answers.swap_remove(number - 1);
            self.take_answer(Some(Arc::new(chosen)));
            return self.report_pairs(&[], io);
        }
        io.report(
            || {
                let answers: Vec<Value> = all
                    .answers
                    .iter()
                    .zip(all.exact.iter().zip(&all.continuum))
                    .map(|(solved, (exact, continuum))| {
                        json!({
                            "pairs": solved.answer.pairs,
                            "solution": solved.answer.solution,
                            "exact": exact,
                            "continuum": continuum,
                        })
                    })
                    .collect();
                let continua: Vec<Value> = all.continua.iter().map(|piece| continuum(&all, piece)).collect();
                json!({
                    "answers": answers,
                    "continua": continua,
                    "complete": all.complete,
                    "visited": all.visited,
                    "cut": all.cut,
                    "total": all.total,
                    "undecided": all.undecided,
                })
            },
            |out, style| view::enumerate::write(out, &all, style),
        )?;
        Ok(())
    }

    pub(in crate::session) fn critical(&self, friction: &str, io: &mut Output<'_>) -> Result<(), CommandError> {
        let values = self.now.values.clone();
        let name = friction.to_owned();
        if self.now.scenario.uses.place(&name, Region::Geometry).is_some() {
            return Err(CommandError::Refused(format!(
                "{name} stands in the geometry or stiffness as well: `critical` varies friction alone"
            )));
        }
        let found = self.ask(io, move |prepared, _, watch| prepared.critical_friction(&values, &name, watch))?;
        let pairs = self.pairs();
        let ids: Vec<&str> = pairs.iter().map(|pair| pair.id.as_str()).collect();
        io.report(
            || {
                let scheme = found.scheme.as_ref().map(|scheme| view::critical::scheme_words(&ids, scheme));
                json!({
                    "parameter": friction,
                    "value": found.value,
                    "scheme": scheme,
                    "exact": found.coverage == Coverage::Exact,
                    "examined": found.examined,
                    "singular": found.singular,
                })
            },
            |out, style| view::critical::write(out, friction, &found, &ids, style),
        )?;
        Ok(())
    }

    pub(in crate::session) fn check_exactly(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let check = self.ask(io, |prepared, solved, watch| prepared.check_exactly(solved, watch))?;
        let names = match &self.now.scenario.source {
            Source::Lcp(lcp) => lcp.names.clone(),
            _ => Vec::new(),
        };
        io.report(
            || {
                let (role, lines) = view::exact::sentences(&check, &names);
                json!({"proved": role == view::style::Role::Good, "finding": lines})
            },
            |out, style| view::exact::write(out, &check, &names, style),
        )?;
        Ok(())
    }
}
