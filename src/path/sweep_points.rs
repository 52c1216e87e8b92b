//! The points of a sweep solved, each from z = 0, a block side by side.

use std::ops::Range;

use rayon::prelude::*;
use serde_json::Value;

use super::quantity::{Facts, history_for};
use super::stages::{History, HistoryEnd};
use super::start::PathError;
use super::sweep::{Found, Sweep, fields};
use crate::answer::record::Answer;
use crate::model::parameter::ParameterValues;
use crate::solve::counted::Unbalanced;
use crate::solve::{Case, PrepareError, SolveError, Solved};
use crate::watch::Watch;

/// On the way to [`Found`].
enum Looked {
    Found(Found),
    /// The equilibrium of the answer is still to be checked.
    Left(Box<(Answer, Unbalanced)>),
}

impl Sweep<'_> {
    /// What is found at the points of a block, the equilibrium of all of them looked at together.
    pub(super) fn solve(&self, block: Range<usize>, watch: &dyn Watch) -> Vec<Found> {
        let looked = block.clone().into_par_iter().map(|index| self.look(index, watch)).collect();
        self.balanced(block, looked, watch)
    }

    /// The values of the parameters at a point.
    fn values(&self, index: usize) -> ParameterValues {
        let mut values = self.case.values.clone();
        for (axis, value) in self.grid.axes.iter().zip(self.grid.point(index)) {
            values.insert(axis.name.clone(), value);
        }
        values
    }

    /// The case at a point, made ready, handed to `solve`; a refusal in words or a stop as what was found.
    fn at<T>(
        &self,
        index: usize,
        watch: &dyn Watch,
        solve: impl FnOnce(Case<'_>) -> Result<T, SolveError>,
    ) -> Result<T, Found> {
        let (case, values) = (self.case, self.values(index));
        let renewed = case.prepared.renewed(case.scenario, &values, watch).map_err(|error| match error {
            PrepareError::Interrupted => Found::Stopped,
            PrepareError::Problems(problems) => Found::Refused(problems.to_string()),
        })?;
        let prepared = renewed.as_ref().map_or(case.prepared, |(prepared, _)| prepared);
        let found = solve(Case { prepared, values: &values, watch, ..case })
            .map_err(|error| if error.is_interrupted() { Found::Stopped } else { Found::Refused(error.to_string()) })?;
        if watch.stop() { Err(Found::Stopped) } else { Ok(found) }
    }

    fn look(&self, index: usize, watch: &dyn Watch) -> Looked {
        let found = self.at(index, watch, |case| {
            let solved = case.solve_counted()?;
            if !self.quantities.is_empty() {
                let whole = if solved.is_whole() { solved } else { solved.completed() };
                let lost = whole.answer.failure.is_some() && !whole.answer.is_answer();
                let whole = if lost { case.solve_briefly()? } else { whole };
                return Ok(Looked::Found(self.found(case, &whole)));
            }
            let (answer, left) = solved.into_answer();
            Ok(match left {
                Some(left) => Looked::Left(Box::new((answer, left))),
                None => Looked::Found(row(&answer)),
            })
        });
        found.unwrap_or_else(Looked::Found)
    }

    /// The row of a whole answer, its quantities included. That the history was not followed to its end is the
    /// failure of a row that has no other.
    fn found(&self, case: Case<'_>, solved: &Solved) -> Found {
        let (history, missing) = match history_for(case, self.quantities) {
            Ok(history) => {
                let cut = history.as_ref().filter(|history| history.end != HistoryEnd::Complete);
                let missing = cut.map(History::end_sentence);
                (history, missing)
            }
            Err(PathError::Interrupted) => return Found::Stopped,
            Err(error) => (None, Some(error.to_string())),
        };
        let facts = Facts::of_answer(case, solved).beside(history.as_ref());
        let quantities = self.quantities.iter();
        let values = quantities.map(|quantity| facts.value(quantity).map_or(Value::Null, |value| value.json()));
        let mut fields = fields(&solved.answer);
        if let (Some(failure @ Value::Null), Some(why)) = (fields.last_mut(), missing) {
            *failure = Value::String(why);
        }
        fields.extend(values);
        Found::Solved(fields, solved.answer.is_answer())
    }

    /// What was found, with the equilibrium of all answers checked; where it fails, the answer is looked for again like
    /// any other.
    fn balanced(&self, block: Range<usize>, looked: Vec<Looked>, watch: &dyn Watch) -> Vec<Found> {
        let left: Vec<&Unbalanced> = looked
            .iter()
            .filter_map(|looked| match looked {
                Looked::Left(left) => Some(&left.1),
                Looked::Found(_) => None,
            })
            .collect();
        let mut balanced = Unbalanced::are_balanced(&left).into_iter();
        let found = block.zip(looked).map(|(index, looked)| match looked {
            Looked::Found(found) => found,
            Looked::Left(left) if balanced.next() == Some(true) => row(&left.0),
            Looked::Left(_) => {
                let again = self.at(index, watch, |case| Ok(self.found(case, &case.solve_briefly()?)));
                again.unwrap_or_else(|found| found)
            }
        });
        found.collect()
    }
}

/// The usual fields of an answer.
fn row(answer: &Answer) -> Found {
    Found::Solved(fields(answer), answer.is_answer())
}
