//! The answer over a whole range: what `find` and `envelope` look at. Where a path ends early, or has no answer to start from,
//! answers are looked for in the rest of the range and followed from there.

use std::sync::Arc;

use super::route::{Led, Route};
use super::start::PathError;
use crate::answer::same::same_pairs;
use crate::solve::Case;
use crate::solve::error::QuestionError;
use crate::solve::known_collapses::KnownCollapses;
use crate::text::number::short;

/// Where in a rest of the range an answer is looked for, as shares of it from the end of the path.
const LOOKS: [f64; 6] = [1.0, 0.5, 1e-3, 0.25, 0.75, 0.125];
/// In space, where a run without an answer takes its time, at the first of them only.
const LOOKS_IN_SPACE: usize = 2;
/// Where no answer is found at either end it is looked for at the odd places of these divisions.
const DIVISIONS: [usize; 5] = [2, 4, 8, 16, 32];
/// So often answers are looked for beyond the end of a path.
const AGAIN: usize = 3;
/// Less of a range than this share is not looked at.
const BESIDE: f64 = 1e-9;

impl<'a> Route<'a> {
    /// Follows the answer over `range`, and others where it ends. `None` where no path leads over this parameter, or not over
    /// all answers found.
    ///
    /// # Errors
    /// No answer at either end, at the present value and at 31 between; see [`PathError`].
    pub fn over_all(case: Case<'a>, name: &str, range: [f64; 2]) -> Result<Option<Route<'a>>, PathError> {
        let known = KnownCollapses::default();
        let mut route = match Route::new(case, name, range) {
            Ok(Some(route)) => route,
            Err(no_start @ PathError::NoStart { .. }) => {
                let mut route = Route::empty(case, name);
                let inner = DIVISIONS.iter().flat_map(|&cells| (1..cells).step_by(2).map(move |k| (k, cells)));
                let looks: Vec<f64> = inner.map(|(k, cells)| k as f64 / cells as f64).collect();
                if !route.fill(range, &looks, AGAIN, &known)? {
                    return Ok(None);
                }
                if route.stretches.is_empty() {
                    return Err(no_start);
                }
                return Ok(Some(route).filter(|route| !route.stops_short()));
            }
            none => return none,
        };
        let [low, high] = range;
        let [from, to] = route.covered();
        for (upwards, rest) in [(false, [from, low]), (true, [to, high])] {
            if !route.ends_for_good(upwards) && !route.fill_from(rest, AGAIN, &known)? {
                return Ok(None);
            }
        }
        Ok(Some(route).filter(|route| !route.stops_short()))
    }

    /// [Fills](Route::fill) the rest of the range from the end of a path to another value.
    fn fill_from(&mut self, [end, to]: [f64; 2], again: usize, known: &KnownCollapses) -> Result<bool, PathError> {
        let count = if self.case.prepared.is_in_space() { LOOKS_IN_SPACE } else { LOOKS.len() };
        let looks: Vec<f64> = LOOKS[..count].iter().map(|share| if end < to { *share } else { 1.0 - share }).collect();
        self.fill([end.min(to), end.max(to)], &looks, again, known)
    }

    /// Takes the paths from the first answer found at one of some places between two values, shares of the way, and goes on
    /// with what is left on both sides. False where no path leads on from an answer.
    fn fill(
        &mut self,
        [from, to]: [f64; 2],
        looks: &[f64],
        again: usize,
        known: &KnownCollapses,
    ) -> Result<bool, PathError> {
        if again == 0 || to - from <= BESIDE * from.abs().max(to.abs()) {
            return Ok(true);
        }
        for share in looks {
            let at = if *share == 1.0 { to } else { from + share * (to - from) };
            let there = match self.case.at(&self.name, at) {
                Ok(there) => there,
                Err(QuestionError::Refused(_)) => continue,
                Err(error) => return Err(error.into()),
            };
            let Ok(solved) = there.case(self.case).look_for_pairs(known)? else { continue };
            let targets: Vec<f64> = [from, to].into_iter().filter(|target| *target != at).collect();
            let before = self.legs.len();
            if self.lead(Arc::new(there), &solved, &targets)? != Led::On {
                return Ok(false);
            }
            let [low, high] = self.covered_by(before).unwrap_or([at, at]);
            return Ok(self.fill_from([low, from], again - 1, known)? && self.fill_from([high, to], again - 1, known)?);
        }
        Ok(true)
    }

    /// Where it goes on from another answer than before, and between which of its paths none was found, in sentences.
    pub(super) fn joint_notes(&self) -> Vec<String> {
        let name = &self.name;
        let joints = self.legs.windows(2).filter(|two| !Arc::ptr_eq(&two[0].there, &two[1].there));
        let starts = joints.filter_map(|two| Some(two[1].way.stretches().first()?[0]));
        let gaps = self.stretches.windows(2).map(|two| [two[0].to, two[1].from]).filter(|[from, to]| from < to);
        let from = starts
            .map(|at| format!("from an answer of its own at {name} = {} the rest of the range is followed", short(at)));
        let without = gaps.map(|[from, to]| {
            format!("no answer was found at a few values of {name} between {} and {}", short(from), short(to))
        });
        from.chain(without).collect()
    }

    /// The least of some values at which a run of its own finds another answer, in a sentence.
    ///
    /// # Errors
    /// Stopped.
    pub fn other_answer(&self, places: impl IntoIterator<Item = f64>) -> Result<Option<String>, PathError> {
        let known = KnownCollapses::default();
        let mut places: Vec<f64> = places.into_iter().collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        for at in places {
            let followed: Vec<_> = self
                .stretches
                .iter()
                .filter(|stretch| (stretch.from..=stretch.to).contains(&at))
                .filter_map(|stretch| self.pairs(stretch, at))
                .collect();
            if followed.is_empty() {
                continue;
            }
            let there = self.case.at(&self.name, at)?;
            let Ok(solved) = there.case(self.case).look_for_pairs(&known)? else { continue };
            if !followed.iter().any(|pairs| same_pairs(pairs, &solved.answer.pairs)) {
                return Ok(Some(format!(
                    "there are several answers: at {} = {} a run of its own finds another one than the path that was \
                     followed here (`enumerate` finds all)",
                    self.name,
                    short(at)
                )));
            }
        }
        Ok(None)
    }
}
