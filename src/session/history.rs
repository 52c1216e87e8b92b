//! A load history that was followed: after `stages`, quantities, `expect` and the tables mean it, until the next change
//! or `solve`.

use std::io::{self, Write};
use std::sync::Arc;

use crate::answer::record::{Answer, NodeDisplacement, PairState};
use crate::path::record::PathRecord;
use crate::path::stages::{self, History, HistoryEnd};
use crate::text::number::short;
use crate::view;
use crate::view::style::{Role, Style};
use crate::watch::Watch;

use super::{CommandError, Session, worker};

impl Session {
    /// The load history that quantities, `expect` and the tables mean at present.
    pub fn history_followed(&self) -> Option<Arc<History>> {
        self.followed.clone()
    }

    /// What a quantity is read from: the end of the last stage followed after `stages`, else the present answer.
    pub fn quantity_answer(&self) -> Option<&Answer> {
        match &self.followed {
            Some(history) => history.answer(),
            None => self.answer(),
        }
    }

    /// As [`Session::quantity_answer`].
    ///
    /// # Errors
    /// There is none because `auto` is off.
    pub(super) fn need_quantities(&self) -> Result<&Answer, CommandError> {
        match &self.followed {
            Some(history) => {
                history.answer().ok_or_else(|| CommandError::Refused("the history has no stages".to_owned()))
            }
            None => self.need_answer(),
        }
    }

    /// The pairs that quantities are read from: of the history, else at the pivot shown.
    pub fn quantity_pairs(&self) -> Vec<PairState> {
        match &self.followed {
            Some(history) => history.answer().map_or_else(Vec::new, |answer| answer.pairs.clone()),
            None => self.pairs(),
        }
    }

    /// Likewise the factors of the load cases.
    pub(super) fn quantity_factors(&self) -> &[f64] {
        match &self.followed {
            Some(history) => history.stages.last().map_or(&[], |stage| stage.factors()),
            None => self.solved.as_ref().map_or(&[], |solved| solved.factors()),
        }
    }

    /// Likewise the displacements; `None` where there are none.
    pub(super) fn quantity_displacements(&self) -> Option<Vec<NodeDisplacement>> {
        match &self.followed {
            Some(history) => history.answer()?.displacements.clone(),
            None => self.displacements(),
        }
    }

    /// The end of a stage that was followed, counted from 1.
    ///
    /// # Errors
    /// No history was followed; the stage was not reached.
    pub fn stage_answer(&self, stage: usize) -> Result<&Answer, CommandError> {
        let refused = |text: String| Err(CommandError::Refused(text));
        let Some(history) = &self.followed else {
            return refused(format!("`stage {stage}` of which history? `stages` follows that of the scenario first"));
        };
        match stage.checked_sub(1).and_then(|index| history.stages.get(index)) {
            Some(stage) => Ok(&stage.end),
            None if (1..=self.now.scenario.stages.len()).contains(&stage) => {
                refused(format!("stage {stage} was not reached: {}", history.end_sentence()))
            }
            None => refused(format!("no stage {stage}: there are stages 1 to {}", self.now.scenario.stages.len())),
        }
    }

    /// Where in the history the tables stand; `None` where they show the present answer.
    pub(super) fn history_place(&self) -> Option<String> {
        let history = self.followed.as_ref()?;
        Some(match &history.end {
            HistoryEnd::Complete => format!("at the end of stage {} of the load history", history.stages.len()),
            HistoryEnd::Limit { stage, t, .. } => {
                format!("where the load history ended, at {} of stage {}", short(*t), stage + 1)
            }
            HistoryEnd::Broken(_) => {
                let last = history.stages.len();
                format!("at the end of stage {last} of the load history, which broke down in stage {}", last + 1)
            }
        })
    }

    /// What the forces and slips shown are where they are not those of an answer: the end of a history, a pivot before
    /// the last one, a ray, at which p still acts.
    pub(super) fn place_shown(&self) -> Option<String> {
        if let Some(place) = self.history_place() {
            return Some(place);
        }
        let units = &self.now.scenario.units;
        let answer = self.answer()?;
        match self.position {
            Some(step) => {
                let p = self.p().map(|p| format!(", p = {}", view::status::weight(p, answer, units)));
                Some(format!("at {}{}", view::pivots::title(step), p.unwrap_or_default()))
            }
            None => view::status::ray_note(answer, units),
        }
    }

    /// Writes beside a table which combination is shown, and [`Session::place_shown`], if there is one.
    pub(super) fn write_place_shown(&self, out: &mut dyn Write, style: &Style) -> io::Result<()> {
        self.write_combination(out, style)?;
        self.place_shown().map_or(Ok(()), |place| style.paragraph(out, Role::Muted, &place))
    }

    /// Writes, after a load history was followed, that `what` is of the answer under all loads at once.
    pub(super) fn write_not_of_history(&self, what: &str, out: &mut dyn Write, style: &Style) -> io::Result<()> {
        self.history_place().map_or(Ok(()), |place| {
            let text = format!("{what}of the answer with every load case acting at once; the tables stand {place}");
            style.paragraph(out, Role::Muted, &text)
        })
    }

    fn write_combination(&self, out: &mut dyn Write, style: &Style) -> io::Result<()> {
        self.combination().map_or(Ok(()), |name| style.paragraph(out, Role::Muted, &format!("of combination {name}")))
    }

    /// Writes ahead of a table that knows no pivots which combination is shown, and [`Session::history_place`], if there is one.
    pub(super) fn write_history_place(&self, out: &mut dyn Write, style: &Style) -> io::Result<()> {
        self.write_combination(out, style)?;
        self.history_place().map_or(Ok(()), |place| style.paragraph(out, Role::Muted, &place))
    }

    /// Follows the stages of the scenario; from here on they are what quantities mean.
    ///
    /// # Errors
    /// A scenario without stages, a history that breaks down, an interruption.
    pub fn follow_stages(&mut self, watch: &dyn Watch) -> Result<Arc<History>, CommandError> {
        let ground = self.ground(watch)?;
        let history = worker::run(watch, move |watch| stages::follow(ground.case(watch)))??;
        let history = Arc::new(history);
        self.keep_path(PathRecord::of_history(&history));
        self.followed = Some(Arc::clone(&history));
        Ok(history)
    }
}
