//! All answers of a contact problem, by a search over working schemes.
//!
//! Depth first, one pair after the other; a partial scheme is cut only where its signs are proved to fail: in balls
//! ([`crate::contact::schemes::pruning`]), and where these do not cut by the signs and the box of the displacements as
//! a linear program in exact arithmetic ([`crate::lcp::exact::polyhedron`]). Of a complete scheme it gives all answers,
//! one or a continuum with its corners and directions. Nothing is accepted or cut by a tolerance.

use std::ops::ControlFlow;

use nalgebra::DVector;
use num_rational::BigRational;

use crate::contact::law::{PairLaw, TangentialJoint};
use crate::contact::polygon::Polygon;
use crate::contact::problem::ContactProblem;
use crate::contact::schemes::exact_system::{ExactSystem, PairVariables, Rooms};
use crate::contact::schemes::pruning::{Level, Pruning};
use crate::contact::schemes::scheme::{PairScheme, Tangential};
use crate::lcp::exact::all_solutions::Solutions;
use crate::lcp::exact::corners::corners;
use crate::lcp::exact::dyadic::nearest;
use crate::lcp::exact::polyhedron::{Polyhedron, State};

/// From this many undecided pairs on the exact linear program pays: without a box, where balls cut little.
const WORTH: usize = 3;
/// The same with a box: measured, it costs as much as some hundred partial schemes in balls.
const WORTH_BOXED: usize = 5;
/// The same in space, where a pair has many states.
const WORTH_IN_SPACE: usize = 1;

/// Displacements and forces of all joints, in the order of R.
#[derive(Clone, Debug, PartialEq)]
pub struct JointState {
    /// z; of a normal joint the distance still open.
    pub z: DVector<f64>,
    /// λ = R (z − (g, 0)) + RF.
    pub force: DVector<f64>,
}

/// One answer, rounded to f64 from its exact value.
#[derive(Clone, Debug, PartialEq)]
pub struct EnumeratedAnswer {
    /// The working schemes that lead to it: several where pairs are exactly on their limits.
    pub schemes: Vec<Vec<PairScheme>>,
    /// z and λ.
    pub state: JointState,
    /// Other answers lie next to this one: it is a corner of a continuum.
    pub continuum: bool,
}

/// A set of answers with more than one element.
#[derive(Clone, Debug, PartialEq)]
pub struct Continuum {
    /// Its corners, as indices of the answers.
    pub corners: Vec<usize>,
    /// Displacements of all joints along which it goes on without end, largest entry 1.
    pub directions: Vec<DVector<f64>>,
}

/// What the search found.
#[derive(Clone, Debug, PartialEq)]
pub struct Enumeration {
    /// All answers, in the order of the search; of a continuum its corners.
    pub answers: Vec<EnumeratedAnswer>,
    /// Sets of answers between and beyond these.
    pub continua: Vec<Continuum>,
    /// Complete schemes that were solved.
    pub visited: u64,
    /// Partial schemes that were cut off.
    pub cut: u64,
    /// Number of all schemes; 2⁶⁴ − 1 where there are more.
    pub total: u64,
    /// Schemes with too many corners to list them all.
    pub undecided: u64,
    /// Whether the search came to its end.
    pub complete: bool,
    /// Whether there is none of the data as they are stored, but may be one within their rounding; its answers are such
    /// ([`super::near`]).
    pub within_rounding: bool,
}

impl Enumeration {
    /// No answer, and no doubt about it.
    pub fn no_answer(&self) -> bool {
        self.complete && self.undecided == 0 && self.answers.is_empty() && !self.within_rounding
    }
}

/// How far the search is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Partial and complete schemes looked at.
    pub nodes: u64,
    /// Share of the tree that is done, 0 … 1.
    pub share: f64,
    /// Answers found.
    pub found: usize,
}

/// The states that a pair can be in.
pub(super) fn choices(law: &PairLaw, polygon: Polygon) -> Vec<PairScheme> {
    let all = |open: bool| {
        let states = Tangential::all(polygon).into_iter();
        states.map(move |tangential| PairScheme { open, tangential })
    };
    match law.tangential {
        TangentialJoint::Free if law.is_bilateral() => vec![PairScheme::STICK],
        TangentialJoint::Free => vec![PairScheme::STICK, PairScheme::OPEN_STICK],
        TangentialJoint::Bounded { .. } if law.is_bilateral() => all(false).collect(),
        TangentialJoint::Bounded { fixed, .. } if fixed > 0.0 => all(false).chain(all(true)).collect(),
        TangentialJoint::Bounded { .. } => all(false).chain([PairScheme::OPEN]).collect(),
    }
}

/// Finds every answer. `observer` hears of the progress before every step and may stop the search; what was found until
/// then is returned as incomplete.
pub fn enumerate(problem: &ContactProblem, observer: &mut dyn FnMut(Progress) -> ControlFlow<()>) -> Enumeration {
    enumerate_within(problem, &[], observer).0
}

/// The same, and the partial schemes that were cut, but not for every system whose joints have forces that lie up to
/// `rooms` beside those of this one; none of them where `rooms` is empty.
pub(super) fn enumerate_within(
    problem: &ContactProblem,
    rooms: &[f64],
    observer: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> (Enumeration, Vec<Vec<PairScheme>>) {
    let mut search = Search::new(problem, rooms, observer);
    let mut scheme = Vec::with_capacity(problem.system.pair_count());
    let root = search.pruning.root(&search.exact);
    let ended = search.descend(Some(&root), None, &mut scheme, 1.0);
    let doubtful = std::mem::take(&mut search.doubtful);
    (search.result(ended.is_continue()), doubtful)
}

struct Search<'a> {
    exact: ExactSystem<'a>,
    variables: Vec<PairVariables>,
    observer: &'a mut dyn FnMut(Progress) -> ControlFlow<()>,
    progress: Progress,
    pruning: Pruning<'a>,
    /// From this many undecided pairs on the exact linear program pays.
    worth: usize,
    choices: Vec<Vec<PairScheme>>,
    /// How far x_n and the reserves may lie from their forms.
    rooms: Rooms,
    /// Partial schemes that are cut, but not within this.
    doubtful: Vec<Vec<PairScheme>>,
    solutions: Solutions,
    /// The schemes of every basic solution.
    schemes: Vec<Vec<Vec<PairScheme>>>,
}

impl<'a> Search<'a> {
    fn new(
        problem: &'a ContactProblem,
        rooms: &[f64],
        observer: &'a mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Self {
        let exact = ExactSystem::new(problem);
        let pruning = Pruning::new(&exact, exact.constants_within(rooms));
        let worth = match (pruning.has_box, problem.system.is_in_space()) {
            (_, true) => WORTH_IN_SPACE,
            (true, false) => WORTH_BOXED,
            (false, false) => WORTH,
        };
        let variables = exact.variables();
        let rooms = if rooms.is_empty() { Rooms::default() } else { exact.rooms_of(&variables, rooms) };
        Self {
            variables,
            exact,
            rooms,
            doubtful: Vec::new(),
            observer,
            progress: Progress { nodes: 0, share: 0.0, found: 0 },
            pruning,
            worth,
            choices: problem.laws.iter().map(|law| choices(law, problem.polygon)).collect(),
            solutions: Solutions::default(),
            schemes: Vec::new(),
        }
    }

    /// `level` is `None` below a partial scheme that balls cannot eliminate; `above` is the exact program of a partial
    /// scheme further up, with the number of pairs decided in it. `share` of the whole tree hangs here.
    fn descend(
        &mut self,
        level: Option<&Level>,
        above: Option<(&Polyhedron, usize)>,
        scheme: &mut Vec<PairScheme>,
        share: f64,
    ) -> ControlFlow<()> {
        let pair = scheme.len();
        if pair == self.choices.len() {
            // Only without any pair.
            let polyhedron = self.program(above, scheme)?;
            return polyhedron.map_or(ControlFlow::Continue(()), |polyhedron| self.leaf(polyhedron, scheme));
        }
        let left = self.choices.len() - pair - 1;
        let share = share / self.choices[pair].len() as f64;
        for choice in self.choices[pair].clone() {
            self.progress.nodes += 1;
            (self.observer)(self.progress)?;
            scheme.push(choice);
            let next = level.and_then(|level| self.pruning.decide(level, pair, choice));
            let hopeless = next.as_ref().is_some_and(|next| self.pruning.hopeless(next, scheme));
            let result = if hopeless {
                self.end(left, share)
            } else if left == 0 || next.is_none() || left >= self.worth {
                match self.program(above, scheme) {
                    ControlFlow::Break(()) => ControlFlow::Break(()),
                    ControlFlow::Continue(None) => self.end(left, share),
                    ControlFlow::Continue(Some(polyhedron)) if left == 0 => {
                        self.progress.share += share;
                        self.solutions.leaves += 1;
                        self.leaf(polyhedron, scheme)
                    }
                    ControlFlow::Continue(Some(polyhedron)) => {
                        self.descend(next.as_ref(), Some((&polyhedron, pair + 1)), scheme, share)
                    }
                }
            } else {
                self.descend(next.as_ref(), above, scheme, share)
            };
            scheme.pop();
            result?;
        }
        ControlFlow::Continue(())
    }

    /// A branch with nothing in it.
    fn end(&mut self, left: usize, share: f64) -> ControlFlow<()> {
        self.progress.share += share;
        if left == 0 {
            self.solutions.leaves += 1;
        } else {
            self.solutions.cut += 1;
        }
        ControlFlow::Continue(())
    }

    /// The exact program of a partial scheme; `None` where it is empty.
    fn program(
        &mut self,
        above: Option<(&Polyhedron, usize)>,
        scheme: &[PairScheme],
    ) -> ControlFlow<(), Option<Polyhedron>> {
        let mut go_on = || (self.observer)(self.progress).is_continue();
        let (mut polyhedron, mut state, decided) = match above {
            Some((polyhedron, decided)) => (polyhedron.clone(), State::Feasible, decided),
            None => {
                let (polyhedron, state) = self.exact.polyhedron(&self.pruning.sides(), &mut go_on);
                // Forces that were fixed have their part in a contradiction.
                let polyhedron =
                    if self.rooms.are_none() { polyhedron } else { polyhedron.keep_fixed(self.exact.stiffness.len()) };
                (polyhedron, state, 0)
            }
        };
        let mut pinned = None;
        for (pair, chosen) in scheme.iter().enumerate().skip(decided) {
            if state == State::Feasible {
                let holds = self.exact.problem.laws[pair].fixed_bound() > 0.0;
                (state, pinned) = self.variables[pair].impose(&mut polyhedron, *chosen, holds, &mut go_on);
            }
        }
        match state {
            State::Feasible => ControlFlow::Continue(Some(polyhedron)),
            State::Stopped => ControlFlow::Break(()),
            State::Empty => {
                if !self.rooms.are_none()
                    && !polyhedron.contradiction(pinned).is_some_and(|found| self.rooms.leave(&found))
                {
                    self.doubtful.push(scheme.to_vec());
                }
                ControlFlow::Continue(None)
            }
        }
    }

    /// All answers of a complete scheme.
    fn leaf(&mut self, polyhedron: Polyhedron, scheme: &[PairScheme]) -> ControlFlow<()> {
        let joints: Vec<usize> = (0..self.exact.problem.system.joint_count()).collect();
        let mut stopped = false;
        let mut go_on = || {
            stopped |= (self.observer)(self.progress).is_break();
            !stopped
        };
        let found = corners(&polyhedron.without_fixed(), &joints, &mut go_on);
        for at in self.solutions.add(found) {
            if at == self.schemes.len() {
                self.schemes.push(Vec::new());
            }
            self.schemes[at].push(scheme.to_vec());
        }
        self.progress.found = self.solutions.basic.len();
        if stopped { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn result(self, complete: bool) -> Enumeration {
        let rounded = |values: &[BigRational]| DVector::from_iterator(values.len(), values.iter().map(nearest));
        let Solutions { basic, continua, unlisted, leaves, cut, .. } = &self.solutions;
        let answers = basic
            .iter()
            .zip(&self.schemes)
            .enumerate()
            .map(|(at, (z, schemes))| {
                let state = JointState { z: rounded(z), force: rounded(&self.exact.force(z)) };
                EnumeratedAnswer {
                    schemes: schemes.iter().map(|scheme| self.with_slips(scheme, &state)).collect(),
                    state,
                    continuum: continua.iter().any(|piece| piece.corners.contains(&at)),
                }
            })
            .collect();
        Enumeration {
            answers,
            continua: continua
                .iter()
                .map(|piece| Continuum {
                    corners: piece.corners.clone(),
                    directions: piece.directions.iter().map(|direction| rounded(direction)).collect(),
                })
                .collect(),
            visited: *leaves,
            cut: *cut,
            total: self.choices.iter().fold(1, |total: u64, choices| total.saturating_mul(choices.len() as u64)),
            undecided: *unlisted,
            complete,
            within_rounding: false,
        }
    }

    /// In the plane: the direction in which open pairs slip that nothing holds.
    fn with_slips(&self, scheme: &[PairScheme], state: &JointState) -> Vec<PairScheme> {
        let mut scheme = scheme.to_vec();
        for (pair, chosen) in scheme.iter_mut().enumerate() {
            let of = &self.exact.problem.system.pairs[pair];
            if *chosen == PairScheme::OPEN
                && self.exact.problem.laws[pair].fixed_bound() == 0.0
                && of.tangential.len() == 1
                && state.z[of.tangential.start] < 0.0
            {
                chosen.tangential = Tangential::MINUS;
            }
        }
        scheme
    }
}

#[cfg(test)]
#[path = "enumerate_tests.rs"]
mod tests;
