//! The points of a sweep solved, a block of a grid line at a time.
//!
//! The last parameter runs along a line. Where it is proved that there is one answer at most (see [`crate::solve::line`]) the
//! points of a block follow one another from its first, which is solved cold; the others are solved cold, side by side. Blocks
//! lie at fixed places of their line, so that no row depends on where a shard or a continued file begins.

use std::ops::Range;

use rayon::prelude::*;
use serde_json::Value;

use super::quantity::Facts;
use super::sweep::{COLUMNS, Following, Found, Sweep, fields};
use crate::answer::record::Answer;
use crate::model::parameter::ParameterValues;
use crate::model::quantity::{OfAnswer, Quantity};
use crate::model::uses::Redone;
use crate::solve::follow::WARM_PAIRS;
use crate::solve::line::{Line, Proofs, Unbalanced};
use crate::solve::{Case, PrepareError, SolveError, Solved};
use crate::watch::Watch;

/// Points of a block.
const BLOCK: usize = 16;
/// Answers whose equilibrium is checked together.
const TOGETHER: usize = 16;
/// A proof that the answers are unique takes as long as some twenty cold runs: it is looked for in a grid of this many points.
const MANY: usize = 64;

/// On the way to [`Found`].
enum Looked {
    Found(Found),
    /// The equilibrium of the answer is still to be checked.
    Left(Box<(Answer, Unbalanced, bool)>),
}

/// What the points of one run have in common.
pub(super) struct Points<'s> {
    sweep: &'s Sweep<'s>,
    /// `None` where points are not to follow one another.
    proofs: Option<Proofs>,
}

impl<'s> Points<'s> {
    pub(super) fn new(sweep: &'s Sweep<'s>, following: Following) -> Points<'s> {
        let prepared = sweep.case.prepared;
        let grid = sweep.grid;
        let large = || prepared.system().is_some_and(|system| system.pair_count() >= WARM_PAIRS);
        let pays = || grid.drawn.is_none() && grid.len() >= MANY && large();
        let wanted = match following {
            Following::WhereItPays => pays(),
            Following::Always => true,
            Following::Never => false,
        };
        let counts = sweep.quantities.contains(&Quantity::Answer(OfAnswer::Pivots));
        Points { sweep, proofs: if wanted && !counts { Proofs::of(prepared) } else { None } }
    }

    /// The blocks that share points with the range, each with its points from there.
    pub(super) fn blocks(&self, range: Range<usize>) -> Vec<Range<usize>> {
        let line = self.sweep.grid.line_length();
        let mut blocks = Vec::new();
        let mut next = range.start;
        while next < range.end {
            let (start, along) = (next - next % line, next % line);
            let end = (start + (along / BLOCK + 1) * BLOCK).min(start + line).min(range.end);
            blocks.push(next..end);
            next = end;
        }
        blocks
    }

    /// What is found at the points of a block.
    pub(super) fn solve(&self, wanted: Range<usize>, watch: &dyn Watch) -> Vec<Found> {
        let line = self.sweep.grid.line_length();
        let first = wanted.start - wanted.start % line % BLOCK;
        let unique: Vec<bool> = match &self.proofs {
            Some(proofs) => (first..wanted.end).map(|index| self.is_unique(index, proofs)).collect(),
            None => Vec::new(),
        };
        let looked: Vec<Looked> = if unique.contains(&true) {
            let mut line = Line::default();
            let mut looked = Vec::with_capacity(wanted.len());
            for (index, unique) in (first..wanted.end).zip(unique) {
                if unique || index >= wanted.start {
                    let found = self.look(index, unique.then_some(&mut line), watch);
                    looked.extend((index >= wanted.start).then_some(found));
                }
            }
            looked
        } else {
            wanted.clone().into_par_iter().map(|index| self.look(index, None, watch)).collect()
        };
        self.balanced(wanted, looked, watch)
    }

    /// The values of the parameters at a point.
    fn values(&self, index: usize) -> ParameterValues {
        let mut values = self.sweep.case.values.clone();
        for (axis, value) in self.sweep.grid.axes.iter().zip(self.sweep.grid.point(index)) {
            values.insert(axis.name.clone(), value);
        }
        values
    }

    fn is_unique(&self, index: usize, proofs: &Proofs) -> bool {
        let (case, values) = (self.sweep.case, self.values(index));
        case.scenario.uses.between(case.values, &values) == Redone::Lcp
            && Case { values: &values, ..case }.is_unique(proofs)
    }

    /// The case at a point, made ready, handed to `solve`; a refusal in words or a stop as what was found.
    fn at<T>(
        &self,
        index: usize,
        watch: &dyn Watch,
        solve: impl FnOnce(Case<'_>) -> Result<T, SolveError>,
    ) -> Result<T, Found> {
        let (case, values) = (self.sweep.case, self.values(index));
        let renewed = case.prepared.renewed(case.scenario, &values, watch).map_err(|error| match error {
            PrepareError::Interrupted => Found::Stopped,
            PrepareError::Problems(problems) => Found::Refused(problems.to_string()),
        })?;
        let prepared = renewed.as_ref().map_or(case.prepared, |(prepared, _)| prepared);
        let found = solve(Case { prepared, values: &values, watch, ..case })
            .map_err(|error| if error.is_interrupted() { Found::Stopped } else { Found::Refused(error.to_string()) })?;
        if watch.stop() { Err(Found::Stopped) } else { Ok(found) }
    }

    /// A point; with the line on which it follows the point before it where there is one answer at most.
    fn look(&self, index: usize, line: Option<&mut Line>, watch: &dyn Watch) -> Looked {
        let unique = line.is_some();
        let found = self.at(index, watch, |case| {
            let solved = match line {
                Some(line) => case.solve_next(line)?,
                None => case.solve_counted()?,
            };
            if !self.sweep.quantities.is_empty() {
                let whole = if solved.is_whole() { solved } else { solved.completed() };
                let lost = whole.answer.failure.is_some() && !whole.answer.is_answer();
                let whole = if lost { case.solve_briefly()? } else { whole };
                return Ok(Looked::Found(self.found(case, &whole, unique)));
            }
            let (answer, left) = solved.into_answer();
            Ok(match left {
                Some(left) => Looked::Left(Box::new((answer, left, unique))),
                None => Looked::Found(row(&answer, unique)),
            })
        });
        found.unwrap_or_else(Looked::Found)
    }

    /// The row of a whole answer, its quantities included.
    fn found(&self, case: Case<'_>, solved: &Solved, unique: bool) -> Found {
        let facts = Facts::of_answer(case, solved);
        let quantities = self.sweep.quantities.iter();
        let values = quantities.map(|quantity| facts.value(quantity).map_or(Value::Null, |value| value.json()));
        match row(&solved.answer, unique) {
            Found::Solved(mut fields, is_answer) => {
                fields.extend(values);
                Found::Solved(fields, is_answer)
            }
            other => other,
        }
    }

    /// What was found, with the equilibrium of all answers checked; where it fails, the answer is looked for again like
    /// any other.
    fn balanced(&self, wanted: Range<usize>, looked: Vec<Looked>, watch: &dyn Watch) -> Vec<Found> {
        let left: Vec<&Unbalanced> = looked
            .iter()
            .filter_map(|looked| match looked {
                Looked::Left(left) => Some(&left.1),
                Looked::Found(_) => None,
            })
            .collect();
        let mut balanced = left.chunks(TOGETHER).flat_map(Unbalanced::are_balanced).collect::<Vec<bool>>().into_iter();
        let found = wanted.zip(looked).map(|(index, looked)| match looked {
            Looked::Found(found) => found,
            Looked::Left(left) if balanced.next() == Some(true) => row(&left.0, left.2),
            Looked::Left(left) => {
                let again = self.at(index, watch, |case| Ok(self.found(case, &case.solve_briefly()?, left.2)));
                again.unwrap_or_else(|found| found)
            }
        });
        found.collect()
    }
}

/// The usual fields of an answer. Where answers may follow one another, no row states pivots, not even that of the one
/// solved cold: which one that is must not show.
fn row(answer: &Answer, unique: bool) -> Found {
    let mut fields = fields(answer);
    if let Some(pivots) = COLUMNS.iter().position(|name| unique && *name == "pivots") {
        fields[pivots] = Value::Null;
    }
    Found::Solved(fields, answer.is_answer())
}
