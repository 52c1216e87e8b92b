//! Changes of the session: each is made ready and solved on the side, and taken over only when all of it succeeded.

use std::sync::Arc;

use crate::answer::record::Start;
use crate::answer::same::same_answer;
use crate::model::load::at_values;
use crate::model::uses::Redone;
use crate::solve::{Prepared, Solved};
use crate::view::status;
use crate::view::style::Role;
use crate::watch::Watch;

use super::journal::Record;
use super::{Change, CommandError, Format, Output, Session, Setup, worker};

impl Session {
    /// Takes `next` over if it can be solved (or need not be yet), and says what changed.
    pub(super) fn change(&mut self, next: Setup, text: &str, io: &mut Output<'_>) -> Result<(), CommandError> {
        self.change_noting(next, text, &[], io)
    }

    /// [`Session::change`] with lines ahead of the status line.
    pub(super) fn change_noting(
        &mut self,
        next: Setup,
        text: &str,
        notes: &[String],
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let mut before = self.now.clone();
        let mut notes = notes.to_vec();
        let news = !before.same_choice(&next);
        if !self.auto && before.scenario.uses.between(&before.values, &next.values) > Redone::Lcp {
            // Nothing is solved now, but values that make the model invalid are refused all the same.
            at_values(&next.scenario, &next.values).map_err(CommandError::Scenario)?;
        }
        self.enter(next, true, io)?;
        let same = |a: &Arc<Prepared>, b: &Option<Arc<Prepared>>| b.as_ref().is_some_and(|b| Arc::ptr_eq(a, b));
        if Arc::ptr_eq(&before.scenario, &self.now.scenario) {
            // One factorization for each step of a slider would fill the memory: `undo` computes it anew.
            before.prepared = before.prepared.filter(|prepared| same(prepared, &self.now.prepared));
        }
        if news {
            notes.extend(self.note_in_journal(&before, |now| Record::Change(text.to_owned(), now)));
            self.undo.push(Change { command: text.to_owned(), setup: before });
            self.redo.clear();
        }
        self.say_what_changed(&notes, io)
    }

    /// Makes `next` the present setup, with its answer; `warm`: found from the present one where that pays.
    pub(super) fn enter(&mut self, mut next: Setup, warm: bool, io: &mut Output<'_>) -> Result<(), CommandError> {
        let solved = if self.auto {
            let same_geometry = match (&self.now.prepared, &next.prepared) {
                (Some(now), Some(next)) => Arc::ptr_eq(now, next),
                _ => false,
            };
            let last = self.solved.clone().filter(|_| warm && same_geometry);
            Some(next.solve_from(last, io.joints_first, io.watch)?)
        } else {
            None
        };
        let same_scenario = Arc::ptr_eq(&self.now.scenario, &next.scenario);
        self.now = next;
        self.take_answer(solved);
        if !same_scenario {
            self.previous = None;
            self.path = None;
            self.map = None;
            self.swept = None;
        }
        Ok(())
    }

    /// Works out what is still missing from the present answer and from the one before: displacements, members,
    /// reactions, the check of equilibrium. Every command does so first, unless the face shows the states ahead of the
    /// rest.
    ///
    /// # Errors
    /// As for a solve; the session then is as it was.
    pub fn ensure_whole(&mut self, watch: &dyn Watch) -> Result<(), CommandError> {
        if let Some(solved) = self.solved.clone().filter(|solved| !solved.is_whole()) {
            let whole = self.now.whole(solved, watch)?;
            self.trouble |= whole.answer.outcome.is_failure();
            self.solved = Some(Arc::new(whole));
        }
        if let Some(previous) = self.previous.clone().filter(|previous| !previous.is_whole()) {
            self.previous = Some(Arc::new(worker::run(watch, move |_| previous.completed())?));
        }
        Ok(())
    }

    /// An answer found by a warm start has no pivots of its own: the cold run that has them takes its place. Says so
    /// where it ends in another answer.
    ///
    /// # Errors
    /// As for a solve; the session then is as it was.
    pub fn ensure_pivots(&mut self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let Some(warm) = self.solved.clone() else {
            return Ok(());
        };
        if warm.answer.start == Start::Cold {
            return Ok(());
        }
        let cold = self.now.clone().solve(io.watch)?;
        if !same_answer(&warm.answer, &cold.answer) && io.format == Format::Text {
            let note = "the cold run ends in another answer than the one followed so far: there are several; the \
                        one with these pivots is shown from here on";
            let note = io.style.paint(Role::Warning, note);
            writeln!(io.out, "{note}")?;
        }
        self.solved = Some(cold);
        Ok(())
    }

    /// The one line after a change.
    pub(super) fn say_what_changed(&self, notes: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        let previous = self.previous_answer();
        // what the line before said of its answer is not said again
        let said = previous.filter(|_| notes.is_empty()).map_or(&[][..], |previous| &previous.notes);
        let units = &self.now.scenario.units;
        let mut report = self.status_json();
        if !notes.is_empty() {
            report["notes"] = notes.into();
        }
        io.show(&report, |out, style| {
            for note in notes {
                style.paragraph(out, Role::Plain, note)?;
            }
            match self.answer() {
                Some(answer) => {
                    writeln!(out, "{}", status::line(answer, previous, units, style))?;
                    let fresh = answer.notes.iter().filter(|note| !said.contains(note));
                    fresh.into_iter().try_for_each(|note| style.paragraph(out, Role::Warning, note))
                }
                None => writeln!(out, "not solved yet: `solve`, or `set auto on`"),
            }
        })?;
        Ok(())
    }

    /// Makes `solved` the present answer, shown at its end.
    pub(super) fn take_answer(&mut self, solved: Option<Arc<Solved>>) {
        self.trouble |= solved.as_ref().is_some_and(|solved| solved.answer.outcome.is_failure());
        self.previous = self.solved.take().or(self.previous.take());
        self.solved = solved;
        self.position = None;
        self.followed = None;
        self.combination = None;
    }
}
