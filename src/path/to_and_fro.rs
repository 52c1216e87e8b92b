//! The history of a load that goes to and fro, its places told in the words of that load: the first stage leads from the
//! unloaded structure to the first value, the others there and back.

use super::stages::{Begin, History, HistoryEnd, StageResult, follow_until, limit_words};
use super::start::PathError;
use crate::solve::Case;
use crate::text::number::short;

/// A load and the two values between which it goes.
#[derive(Clone, Copy)]
pub(super) struct ToAndFro<'a> {
    pub(super) name: &'a str,
    pub(super) ends: [f64; 2],
}

impl ToAndFro<'_> {
    /// Follows these factors of all load cases, stage by stage.
    ///
    /// # Errors
    /// As [`follow_until`]; where it breaks down, in these words.
    pub(super) fn follow(
        self,
        case: Case<'_>,
        begin: &Begin,
        targets: &[Vec<f64>],
        enough: &mut dyn FnMut(&[StageResult]) -> bool,
    ) -> Result<History, PathError> {
        let history = follow_until(case, begin, targets, enough).map_err(|error| self.told(error, 0))?;
        let stage = history.stages.len();
        history.unbroken().map_err(|error| self.told(error, stage))
    }

    /// Where a stage leads.
    fn way(self, stage: usize) -> String {
        let Some(half) = stage.checked_sub(1) else {
            return format!("on the way from the unloaded structure to {} = {}", self.name, short(self.ends[0]));
        };
        format!("in cycle {} on the way to {} = {}", half / 2 + 1, self.name, short(self.ends[1 - half % 2]))
    }

    /// The value of the load at a place of a stage that leads there or back.
    fn value(self, stage: usize, t: f64) -> f64 {
        let [a, b] = self.ends;
        let (from, to) = if stage % 2 == 1 { (a, b) } else { (b, a) };
        from + t * (to - from)
    }

    /// An error on the way through a stage.
    fn told(self, error: PathError, stage: usize) -> PathError {
        let PathError::Breakdown { at, why, .. } = error else { return error };
        let why = format!("{}, {why}", self.way(stage));
        match stage {
            0 => PathError::Breakdown { name: "the place before the first cycle".to_owned(), at, why },
            _ => PathError::Breakdown { name: self.name.to_owned(), at: self.value(stage, at), why },
        }
    }

    /// Where a history ended on its way.
    pub(super) fn end_sentence(self, history: &History) -> String {
        let HistoryEnd::Limit { stage, t, collapse } = &history.end else { return history.end_sentence() };
        let (way, met) = (self.way(*stage), limit_words(collapse));
        match stage {
            0 => format!("before the first cycle, {way}: at {t:.6} of it {met}"),
            _ => format!("{way}: at {} {met}", short(self.value(*stage, *t))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A load between 2 and 6: halfway there it is 4, a quarter of the way back 5.
    #[test]
    fn a_break_down_is_told_by_the_load() {
        let load = ToAndFro { name: "q", ends: [2.0, 6.0] };
        let told = |stage, at| {
            let error = PathError::Breakdown { name: "the place in a stage".to_owned(), at, why: "why".to_owned() };
            load.told(error, stage).to_string()
        };
        assert_eq!(
            [told(0, 0.5), told(1, 0.5), told(2, 0.25), told(3, 0.5)],
            [
                "the path broke down at the place before the first cycle = 0.5: on the way from the unloaded structure to \
                 q = 2, why",
                "the path broke down at q = 4: in cycle 1 on the way to q = 6, why",
                "the path broke down at q = 5: in cycle 1 on the way to q = 2, why",
                "the path broke down at q = 4: in cycle 2 on the way to q = 6, why",
            ]
        );
    }
}
