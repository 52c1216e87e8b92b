//! One line of the map: the working schemes over one parameter while the other stands still.

use crate::answer::record::{PairState, State};
use crate::model::rules::Rules;
use crate::path::route::{Known, Route, Start};
use crate::path::start::PathError;
use crate::solve::error::QuestionError;
use crate::solve::known_collapses::KnownCollapses;
use crate::solve::{Case, Solved};
use crate::watch::StopOnly;

/// Where, within a part without an answer, another answer is looked for, as shares of its length.
const PROBES: [f64; 3] = [0.25, 0.625, 1.0];
/// Where an answer is looked for between two ends without one.
const BETWEEN: [f64; 3] = [0.5, 0.25, 0.75];
/// The first such place is this near to the end of the path, as a share of the range.
const BESIDE: f64 = 1e-9;
/// How often a path may begin again beyond the end of another.
const AGAIN: usize = 8;
/// Intervals of a line over a parameter without an exact path.
const CELLS: usize = 24;
/// On such a line a change is narrowed to this share of the range.
const NARROW: f64 = 1e-11;
/// Bounds met upwards and downwards that are nearer than this share of the range are one place …
const SAME: f64 = 1e-10;
/// … or than this one where they are found in steps, since a margin that is crossed flatly fixes its place badly.
const SAME_IN_STEPS: f64 = 1e-6;
/// Parts shorter than this share of the range are rounding of the place where two others meet.
const NOTHING: f64 = 1e-13;

/// What holds at a place: the state of each pair, or no answer.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Scheme {
    /// In the order of the pairs.
    Pairs(Vec<State>),
    /// Followed from the upper end another answer is met: both, the one from the lower end first.
    Several(Vec<State>, Vec<State>),
    /// No answer was found.
    NoAnswer,
}

/// A part of a line in one scheme.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Lower end.
    pub from: f64,
    /// Upper end.
    pub to: f64,
    /// What holds inside.
    pub scheme: Scheme,
}

/// A line across the map.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// The value of the parameter that stands still.
    pub at: f64,
    /// The parts, upwards, without gaps.
    pub parts: Vec<Part>,
}

impl Line {
    /// The schemes in order: lines with the same sequence belong to one panel.
    pub fn same_sequence(&self, other: &Line) -> bool {
        self.parts.len() == other.parts.len() && self.parts.iter().zip(&other.parts).all(|(a, b)| a.scheme == b.scheme)
    }

    /// The places where the scheme changes, with both ends of the line.
    pub fn bounds(&self) -> impl Iterator<Item = f64> + '_ {
        self.parts.first().map(|part| part.from).into_iter().chain(self.parts.iter().map(|part| part.to))
    }
}

fn scheme(pairs: &[PairState]) -> Scheme {
    Scheme::Pairs(pairs.iter().map(|pair| pair.state).collect())
}

/// Pairs that touch in one of two schemes only, and those that do something else.
fn farness(here: Option<&Scheme>, there: &[PairState]) -> (usize, usize) {
    let Some(Scheme::Pairs(here)) = here else { return (0, 0) };
    let pairs = || here.iter().zip(there);
    let opens = pairs().filter(|(a, b)| (**a == State::Open) != (b.state == State::Open)).count();
    (opens, pairs().filter(|(a, b)| **a != b.state).count())
}

/// The parts of both ways over a line: where they differ there is more than one answer. Bounds nearer than `same` are
/// one, and what differs over less than ten times that is no other answer.
fn overlaid(upwards: &[Part], downwards: &[Part], same: f64) -> Vec<Part> {
    let mut parts = Vec::new();
    for a in upwards {
        let mut from = a.from;
        for b in downwards.iter().filter(|b| b.to > a.from + same && b.from < a.to - same) {
            let to = if b.to > a.to - same { a.to } else { b.to };
            let is_wide = to - from.max(b.from) > 10.0 * same;
            let scheme = match (&a.scheme, &b.scheme) {
                (Scheme::Pairs(a), Scheme::Pairs(b)) if a != b && is_wide => Scheme::Several(a.clone(), b.clone()),
                (Scheme::NoAnswer, other) => other.clone(),
                (scheme, _) => scheme.clone(),
            };
            parts.push(Part { from, to, scheme });
            from = to;
        }
        if from < a.to {
            parts.push(Part { from, to: a.to, scheme: a.scheme.clone() });
        }
    }
    parts
}

/// How other answers than the one that is followed upwards are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Others {
    /// It is proved that there are none.
    None,
    /// Each line is followed from its upper end, too.
    FromAbove,
    /// Each line is followed from all answers at its upper end.
    FromAllAbove,
}

/// The lines of a map: `along` is followed where that can be done, `across` stands still.
pub struct Lines<'a> {
    /// The scenario made ready.
    pub case: Case<'a>,
    /// The parameter that is followed.
    pub along: &'a str,
    /// Its range.
    pub range: [f64; 2],
    /// The parameter that stands still on a line.
    pub across: &'a str,
    /// Whether more than one answer is looked for.
    pub others: Others,
    /// What proves collapses on the way.
    pub known: KnownCollapses,
}

impl<'a> Lines<'a> {
    /// Lines along the first parameter, within a range of it, the second standing still.
    pub fn new(case: Case<'a>, (along, range): (&'a str, [f64; 2]), across: &'a str, others: Others) -> Lines<'a> {
        Lines { case, along, range, across, others, known: KnownCollapses::default() }
    }

    /// The line at a value of `across`, how well it is known, and the collapses known after it: those of `self` stay as
    /// they are, so that lines may be looked at in any order. There may be an answer at one of `hints`.
    ///
    /// # Errors
    /// A value that the scenario cannot take, an interruption.
    pub fn line(&self, at: f64, hints: &[f64]) -> Result<(Line, Known, KnownCollapses), PathError> {
        let there = self.case.at(self.across, at)?;
        let step = StopOnly(self.case.watch);
        let own = Lines { known: self.known.clone(), ..*self };
        let (parts, known) = own.over(there.case(self.case).watched(&step), hints)?;
        Ok((Line { at, parts }, known, own.known))
    }

    /// The parts of a line on which this case stands still, and how well they are known.
    ///
    /// # Errors
    /// As [`Lines::line`].
    pub fn over(&self, case: Case<'_>, hints: &[f64]) -> Result<(Vec<Part>, Known), PathError> {
        let any: Start<'_> = &|case: Case<'_>| case.look_for_pairs(&self.known);
        let mut upwards = Vec::new();
        let known = self.fill(case, (self.range, false), (AGAIN, any, hints), &mut upwards)?;
        let mut parts = self.joined(upwards);
        // Lines over cells are answers of their own and do not depend on the end they start from.
        if known == Known::AtPlaces || self.others == Others::None {
            return Ok((parts, known));
        }
        let last = parts.last().map(|part| part.scheme.clone());
        let others = match self.others {
            Others::FromAllAbove => self.other_ends(case, last.as_ref())?,
            _ => Vec::new(),
        };
        if others.is_empty() && last == Some(Scheme::NoAnswer) {
            // The way down would begin at the lower end, too.
            return Ok((parts, known));
        }
        let mut from = |start: Start<'_>| -> Result<(), PathError> {
            let mut downwards = Vec::new();
            self.fill(case, (self.range, true), (AGAIN, start, hints), &mut downwards)?;
            let downwards = self.joined(downwards);
            let same = if known == Known::Exactly { SAME } else { SAME_IN_STEPS };
            parts = self.joined(overlaid(&parts, &downwards, same * self.length()));
            Ok(())
        };
        if others.is_empty() {
            from(any)?;
        }
        for other in others {
            from(&|_| Ok(Ok(other.clone())))?;
        }
        Ok((parts, known))
    }

    /// The answers at the upper end in another scheme than this.
    fn other_ends(&self, case: Case<'_>, here: Option<&Scheme>) -> Result<Vec<Solved>, PathError> {
        let there = case.at(self.along, self.range[1])?;
        let all = match there.prepared.all_answers(&there.values, Rules::default(), case.watch) {
            Ok(all) => all.answers,
            Err(QuestionError::Interrupted) => return Err(PathError::Interrupted),
            // Too many for that.
            Err(_) => return Ok(Vec::new()),
        };
        let mut others: Vec<Solved> = all
            .into_iter()
            .filter(|other| other.answer.is_answer() && here != Some(&scheme(&other.answer.pairs)))
            .collect();
        // The farthest first: what lies between two answers mostly is unstable.
        others.sort_by_key(|other| std::cmp::Reverse(farness(here, &other.answer.pairs)));
        Ok(others)
    }

    fn length(&self) -> f64 {
        self.range[1] - self.range[0]
    }

    /// Fills a range with parts: along the path where there is an answer and, where that ends, from another answer if
    /// one is found, at most `again` times. Returns how well they are known.
    fn fill(
        &self,
        case: Case<'_>,
        (range, upper): ([f64; 2], bool),
        (again, start, hints): (usize, Start<'_>, &[f64]),
        parts: &mut Vec<Part>,
    ) -> Result<Known, PathError> {
        let route = match Route::from_start(case, self.along, range, upper, start) {
            Ok(Some(route)) if !route.stretches.is_empty() => route,
            Ok(None) => return self.cells(case, range, parts).map(|()| Known::AtPlaces),
            // No answer, or one that stands at its very end.
            Ok(Some(_)) | Err(PathError::NoStart { .. }) => {
                return self.between(case, (range, upper), (again, hints), parts);
            }
            Err(error) => return Err(error),
        };
        for stretch in &route.stretches {
            let middle = 0.5 * (stretch.from + stretch.to);
            let scheme = route.pairs(stretch, middle).map_or(Scheme::NoAnswer, |pairs| scheme(&pairs));
            parts.push(Part { from: stretch.from, to: stretch.to, scheme });
        }
        let [low, high] = route.covered();
        let mut known = route.known();
        for (upwards, ends) in [(false, [low, range[0]]), (true, [high, range[1]])] {
            if ends[0] != ends[1] {
                let again = if route.ends_for_good(upwards) { 0 } else { again };
                known = known.max(self.beyond(case, (ends, upper), again, parts)?);
            }
        }
        Ok(known)
    }

    fn has_answer(&self, case: Case<'_>, at: f64) -> Result<bool, PathError> {
        Ok(case.at(self.along, at)?.case(case).look_for_pairs(&self.known)?.is_ok())
    }

    /// Between two ends without an answer: none, unless one is found at one of a few places.
    fn between(
        &self,
        case: Case<'_>,
        ([from, to], upper): ([f64; 2], bool),
        (again, hints): (usize, &[f64]),
        parts: &mut Vec<Part>,
    ) -> Result<Known, PathError> {
        let any: Start<'_> = &|case: Case<'_>| case.look_for_pairs(&self.known);
        if again > 0 && to - from > BESIDE * self.length() {
            let hints = hints.iter().copied().filter(|at| *at > from && *at < to);
            for at in hints.chain(BETWEEN.map(|share| from + share * (to - from))) {
                if self.has_answer(case, at)? {
                    let below = self.fill(case, ([from, at], upper), (again - 1, any, &[]), parts)?;
                    let above = self.fill(case, ([at, to], upper), (again - 1, any, &[]), parts)?;
                    return Ok(below.max(above));
                }
            }
        }
        parts.push(Part { from, to, scheme: Scheme::NoAnswer });
        Ok(Known::Exactly)
    }

    /// From the end of a path to the end of the range: no answer, unless one is found at one of a few places.
    fn beyond(
        &self,
        case: Case<'_>,
        ([from, to], upper): ([f64; 2], bool),
        again: usize,
        parts: &mut Vec<Part>,
    ) -> Result<Known, PathError> {
        let span = |a: f64, b: f64| [a.min(b), a.max(b)];
        let nearest = BESIDE * self.length();
        let any: Start<'_> = &|case: Case<'_>| case.look_for_pairs(&self.known);
        let probes = std::iter::once(nearest / (to - from).abs()).chain(PROBES).filter(|share| *share <= 1.0);
        let probes = probes.filter(|_| again > 0 && (to - from).abs() > nearest);
        for (index, share) in probes.enumerate() {
            let at = from + share * (to - from);
            if !self.has_answer(case, at)? {
                continue;
            }
            // Both ways from there; what is before it has none at its other end.
            let [low, high] = span(at, to);
            let mut known = Known::Exactly;
            if low < high {
                known = self.fill(case, ([low, high], upper), (again - 1, any, &[]), parts)?;
            }
            if index > 0 {
                let beside = from + nearest * (to - from).signum();
                known = known.max(self.fill(case, (span(beside, at), upper), (again - 1, any, &[]), parts)?);
            }
            return Ok(known);
        }
        let [from, to] = span(from, to);
        parts.push(Part { from, to, scheme: Scheme::NoAnswer });
        Ok(Known::Exactly)
    }

    /// Without an exact path: answers of their own at some places, each change between two of them narrowed.
    fn cells(&self, case: Case<'_>, [low, high]: [f64; 2], parts: &mut Vec<Part>) -> Result<(), PathError> {
        let look = |at: f64| -> Result<(f64, Scheme), PathError> {
            let solved = case.at(self.along, at)?.case(case).look_for_pairs(&self.known)?;
            let found = solved.map_or(Scheme::NoAnswer, |solved| scheme(&solved.answer.pairs));
            Ok((at, found))
        };
        let mut last = look(low)?;
        let mut from = low;
        for cell in 1..=CELLS {
            let end = look(if cell == CELLS { high } else { low + (high - low) * cell as f64 / CELLS as f64 })?;
            while last.1 != end.1 {
                let (mut a, mut b) = (last.clone(), end.clone());
                while b.0 - a.0 > NARROW * (high - low) {
                    let middle = look(0.5 * (a.0 + b.0))?;
                    if middle.1 == a.1 { a = middle } else { b = middle }
                }
                let to = 0.5 * (a.0 + b.0);
                parts.push(Part { from, to, scheme: a.1 });
                (from, last) = (to, b);
            }
            last = end;
        }
        parts.push(Part { from, to: high, scheme: last.1 });
        Ok(())
    }

    /// Neighbours in one scheme as one part; parts of no length left out; no gaps.
    fn joined(&self, mut parts: Vec<Part>) -> Vec<Part> {
        let [low, high] = self.range;
        parts.sort_by(|a, b| a.from.total_cmp(&b.from));
        let mut joined: Vec<Part> = Vec::new();
        for part in parts.into_iter().filter(|part| part.to - part.from > NOTHING * (high - low)) {
            match joined.last_mut() {
                Some(last) if last.scheme == part.scheme => last.to = last.to.max(part.to),
                Some(last) => {
                    let from = last.to;
                    if part.to > from {
                        joined.push(Part { from, ..part });
                    }
                }
                None => joined.push(Part { from: low, ..part }),
            }
        }
        if let Some(last) = joined.last_mut() {
            last.to = high;
        }
        joined
    }
}
