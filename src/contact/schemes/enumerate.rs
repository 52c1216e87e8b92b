//! All answers of a contact problem, by a search over working schemes.
//!
//! Depth first, one pair after the other; a partial scheme is cut only where its signs are proved to fail. Two ways to
//! prove it: In balls (f64 with error bounds) every quantity is kept as an affine function of the displacements of the
//! pairs not yet decided; deciding a pair eliminates its displacements, and a sign that fails for all
//! displacements of the others in their box ends the branch. The box: normals z_n ≥ 0 and, where R is positive
//! definite, that around the ellipsoid zᵀR z ≤ −zᵀq that every answer lies in (zᵀλ ≤ 0 for every answer; q is RF −
//! R·(g, 0)), with proved bounds ([`crate::contact::schemes::bounding_box`]). Where balls do not cut, the signs and the box are a linear program in exact arithmetic ([`crate::lcp::exact::polyhedron`]). Of a complete scheme it gives all answers, one or a
//! continuum with its corners and directions. Nothing is accepted or cut by a tolerance.

use std::ops::ControlFlow;

use nalgebra::DVector;
use num_rational::BigRational;

use crate::contact::law::{PairLaw, TangentialJoint};
use crate::contact::polygon::Polygon;
use crate::contact::problem::ContactProblem;
use crate::contact::schemes::ball::{Ball, Row, eliminated};
use crate::contact::schemes::bounding_box::ellipsoid;
use crate::contact::schemes::exact_system::{ExactSystem, PairVariables};
use crate::contact::schemes::scheme::{PairScheme, Tangential, slip_forms};
use crate::lcp::exact::all_solutions::Solutions;
use crate::lcp::exact::corners::corners;
use crate::lcp::exact::dyadic::{nearest, rational};
use crate::lcp::exact::polyhedron::{Polyhedron, State};

/// Undecided pairs from which on the exact linear program pays: without a box, when balls cut little.
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
    /// All schemes there are (at most 2⁶⁴ − 1 is told).
    pub total: u64,
    /// Schemes with too many corners to list them all.
    pub undecided: u64,
    /// Whether the search came to its end.
    pub complete: bool,
}

impl Enumeration {
    /// No answer, and no doubt about it.
    pub fn no_answer(&self) -> bool {
        self.complete && self.undecided == 0 && self.answers.is_empty()
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
fn choices(law: &PairLaw, polygon: Polygon) -> Vec<PairScheme> {
    let all = |open: bool| {
        let states = Tangential::all(polygon).into_iter();
        states.map(move |tangential| PairScheme { open, tangential })
    };
    match law.tangential {
        TangentialJoint::Free => vec![PairScheme::STICK, PairScheme::OPEN_STICK],
        TangentialJoint::Bounded { .. } if law.is_bilateral() => all(false).collect(),
        TangentialJoint::Bounded { fixed, .. } if fixed > 0.0 => all(false).chain(all(true)).collect(),
        TangentialJoint::Bounded { .. } => all(false).chain([PairScheme::OPEN]).collect(),
    }
}

/// Finds every answer. `observer` hears of the progress before every step and may stop the search; what was found until
/// then is returned as incomplete.
pub fn enumerate(problem: &ContactProblem, observer: &mut dyn FnMut(Progress) -> ControlFlow<()>) -> Enumeration {
    let system = &*problem.system;
    let mut search = Search::new(problem, observer);
    let mut scheme = Vec::with_capacity(system.pair_count());
    let root = search.root.clone();
    let ended = search.descend(Some(&root), None, &mut scheme, 1.0);
    search.result(ended.is_continue())
}

/// Rows: one per joint, pair by pair (n, then the tangential ones), holding λ_j or z_j, whichever is not fixed. Columns: the undecided
/// joints from `first` on, then the constant.
#[derive(Clone)]
struct Level {
    first: usize,
    rows: Vec<Ball>,
}

struct Search<'a> {
    exact: ExactSystem<'a>,
    variables: Vec<PairVariables>,
    observer: &'a mut dyn FnMut(Progress) -> ControlFlow<()>,
    progress: Progress,
    /// First joint of every pair in the pair by pair order, and their number at the end.
    offsets: Vec<usize>,
    /// Joint of R of every joint in the pair by pair order.
    joints: Vec<usize>,
    /// Box of every displacement.
    bounds: Vec<(f64, f64)>,
    /// Undecided pairs from which on the exact linear program pays.
    worth: usize,
    choices: Vec<Vec<PairScheme>>,
    /// The forms of the slip that tell its direction.
    forms: Vec<[f64; 2]>,
    root: Level,
    solutions: Solutions,
    /// The schemes of every basic solution.
    schemes: Vec<Vec<Vec<PairScheme>>>,
}

impl<'a> Search<'a> {
    fn new(problem: &'a ContactProblem, observer: &'a mut dyn FnMut(Progress) -> ControlFlow<()>) -> Self {
        let system = &*problem.system;
        let m = system.pair_count();
        let mut joints = Vec::new();
        let mut offsets = vec![0];
        for pair in 0..m {
            joints.push(pair);
            joints.extend(system.pairs[pair].tangential.clone());
            offsets.push(joints.len());
        }
        let exact = ExactSystem::new(problem);
        let ball = |value: &BigRational| {
            let near = nearest(value);
            if rational(near) == *value { Ball::exactly(near) } else { Ball::rounded(near) }
        };
        let mut rows = Vec::with_capacity(joints.len() * (joints.len() + 1));
        for &i in &joints {
            rows.extend(joints.iter().map(|&j| ball(&exact.stiffness[i][j])));
            rows.push(ball(&exact.constants[i]));
        }
        let mut bounds: Vec<(f64, f64)> = joints
            .iter()
            .map(|joint| if *joint < m { (0.0, f64::INFINITY) } else { (f64::NEG_INFINITY, f64::INFINITY) })
            .collect();
        let sides = ellipsoid(&exact.stiffness, &exact.constants, &joints);
        let worth = match (&sides, system.is_in_space()) {
            (_, true) => WORTH_IN_SPACE,
            (Some(_), false) => WORTH_BOXED,
            (None, false) => WORTH,
        };
        for (bound, (low, high)) in bounds.iter_mut().zip(sides.into_iter().flatten()) {
            *bound = (bound.0.max(low), bound.1.min(high));
        }
        Self {
            variables: exact.variables(),
            exact,
            observer,
            progress: Progress { nodes: 0, share: 0.0, found: 0 },
            offsets,
            joints,
            bounds,
            worth,
            choices: problem.laws.iter().map(|law| choices(law, problem.polygon)).collect(),
            forms: slip_forms(problem.polygon),
            root: Level { first: 0, rows },
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
            return polyhedron.map_or(ControlFlow::Continue(()), |polyhedron| self.leaf(&polyhedron, scheme));
        }
        let left = self.choices.len() - pair - 1;
        let share = share / self.choices[pair].len() as f64;
        for choice in self.choices[pair].clone() {
            self.progress.nodes += 1;
            (self.observer)(self.progress)?;
            scheme.push(choice);
            let next = level.and_then(|level| self.decide(level, pair, choice));
            let hopeless = next.as_ref().is_some_and(|next| self.hopeless(next, scheme));
            let result = if hopeless {
                self.end(left, share)
            } else if left == 0 || next.is_none() || left >= self.worth {
                match self.program(above, scheme) {
                    ControlFlow::Break(()) => ControlFlow::Break(()),
                    ControlFlow::Continue(None) => self.end(left, share),
                    ControlFlow::Continue(Some(polyhedron)) if left == 0 => {
                        self.progress.share += share;
                        self.solutions.leaves += 1;
                        self.leaf(&polyhedron, scheme)
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
                let sides = self.joints.iter().zip(&self.bounds).map(|(joint, (low, high))| (*joint, *low, *high));
                let (polyhedron, state) = self.exact.polyhedron(&sides.collect::<Vec<_>>(), &mut go_on);
                (polyhedron, state, 0)
            }
        };
        for (pair, chosen) in scheme.iter().enumerate().skip(decided) {
            if state == State::Feasible {
                let holds = self.exact.problem.laws[pair].fixed_bound() > 0.0;
                state = self.variables[pair].impose(&mut polyhedron, *chosen, holds, &mut go_on);
            }
        }
        match state {
            State::Feasible => ControlFlow::Continue(Some(polyhedron)),
            State::Empty => ControlFlow::Continue(None),
            State::Stopped => ControlFlow::Break(()),
        }
    }

    /// The dictionary with this pair decided; `None` when a pivot may be zero.
    fn decide(&self, level: &Level, pair: usize, choice: PairScheme) -> Option<Level> {
        let k = self.joints.len();
        let width = k + 1 - level.first;
        let n = self.offsets[pair];
        let next = self.offsets[pair + 1];
        let row = |i: usize| &level.rows[i * width..(i + 1) * width];

        // Equations to be solved for the displacements of the released joints, as many as there are of these.
        let (mut equations, mut released): (Vec<Row>, Vec<usize>) = (Vec::new(), Vec::new());
        if choice.open {
            equations.push(row(n).to_vec());
            released.push(n);
        }
        if next - n > 1 && choice.tangential != Tangential::Stick {
            released.extend(n + 1..next);
            equations.extend(self.slip_equations(pair, choice, (level.first, width), &row));
        }
        let columns: Vec<usize> = released.iter().map(|joint| joint - level.first).collect();
        let solved = eliminated(equations, &columns)?;
        // Displacements of this pair in terms of the undecided ones; 0 where the joint is on.
        let mut displacement: Vec<Option<Row>> = vec![None; next - n];
        released.iter().zip(solved).for_each(|(joint, row)| displacement[joint - n] = Some(row));
        let column = |joint: usize| joint - level.first;

        let skip = next - level.first;
        let mut rows = Vec::with_capacity(k * (width - skip));
        for i in 0..k {
            if (n..next).contains(&i)
                && let Some(z) = &displacement[i - n]
            {
                rows.extend_from_slice(&z[skip..]);
                continue;
            }
            let old = row(i);
            let start = rows.len();
            rows.extend_from_slice(&old[skip..]);
            for joint in n..next {
                if let Some(z) = &displacement[joint - n] {
                    let factor = old[column(joint)];
                    if !factor.is_nothing() {
                        for (x, z) in rows[start..].iter_mut().zip(&z[skip..]) {
                            *x = x.plus(factor.times(*z));
                        }
                    }
                }
            }
        }
        Some(Level { first: next, rows })
    }

    /// Whether some sign of the decided pairs fails for all displacements of the others.
    fn hopeless(&self, level: &Level, scheme: &[PairScheme]) -> bool {
        let (system, laws) = (&self.exact.problem.system, &self.exact.problem.laws);
        let polygon = self.exact.problem.polygon;
        let width = self.joints.len() + 1 - level.first;
        let row = |i: usize| &level.rows[i * width..(i + 1) * width];
        let bounds = &self.bounds[level.first..];
        // Σ factor · row + fixed is negative throughout.
        let fails = |terms: &[(usize, f64)], fixed: f64| {
            let entry = |column: usize| {
                let scaled = |&(i, factor): &(usize, f64)| Ball::exactly(factor).times(row(i)[column]);
                terms.iter().map(scaled).fold(Ball::ZERO, Ball::plus)
            };
            let constant = entry(width - 1).plus(Ball::exactly(fixed));
            let mut largest = Ball::exactly(constant.largest_times(1.0, 1.0));
            for (column, (low, high)) in bounds.iter().enumerate() {
                let most = entry(column).largest_times(*low, *high);
                if most == f64::INFINITY {
                    return false;
                }
                largest = largest.plus(Ball::exactly(most));
            }
            largest.middle + largest.radius < 0.0
        };
        scheme.iter().enumerate().any(|(pair, state)| {
            let n = self.offsets[pair];
            let bilateral = system.pairs[pair].law.is_bilateral();
            let fixed = laws[pair].fixed_bound();
            // z_n where open, x_n where closed.
            if !bilateral && fails(&[(n, 1.0)], 0.0) {
                return true;
            }
            let tangents = self.offsets[pair + 1] - n - 1;
            if tangents == 0 {
                return false;
            }
            let along = |parts: [f64; 2]| (0..tangents).map(move |t| (n + 1 + t, parts[t]));
            match state.tangential {
                // An open pair without cohesion slips freely.
                _ if state.open && fixed == 0.0 => false,
                Tangential::Stick => (0..polygon.facets()).any(|facet| {
                    let f = if state.open { 0.0 } else { laws[pair].friction() };
                    fails(&along(polygon.direction(facet)).chain([(n, f)]).collect::<Vec<_>>(), fixed)
                }),
                slip => slip.conditions(polygon).signs.into_iter().any(|(form, up)| {
                    let sign = if up { 1.0 } else { -1.0 };
                    fails(&along(self.forms[form].map(|part| sign * part)).collect::<Vec<_>>(), 0.0)
                }),
            }
        })
    }

    /// What a slip asks for, as rows over the undecided displacements: its reserves are zero and, along one facet in space,
    /// so is the slip across it.
    fn slip_equations<'b>(
        &self,
        pair: usize,
        choice: PairScheme,
        (first, width): (usize, usize),
        row: &dyn Fn(usize) -> &'b [Ball],
    ) -> Vec<Row> {
        let (law, polygon) = (&self.exact.problem.laws[pair], self.exact.problem.polygon);
        let (n, next) = (self.offsets[pair], self.offsets[pair + 1]);
        // λ_n = 0 where open.
        let f = if choice.open { Ball::ZERO } else { Ball::exactly(law.friction()) };
        let reserve = |facet: usize| {
            let mut equation: Row = row(n).iter().map(|entry| f.times(*entry)).collect();
            for (joint, part) in (n + 1..next).zip(polygon.direction(facet)) {
                equation
                    .iter_mut()
                    .zip(row(joint))
                    .for_each(|(sum, entry)| *sum = sum.plus(Ball::exactly(part).times(*entry)));
            }
            equation[width - 1] = equation[width - 1].plus(Ball::exactly(law.fixed_bound()));
            equation
        };
        let across = |form: usize| {
            let mut equation = vec![Ball::ZERO; width];
            (n + 1..next).zip(self.forms[form]).for_each(|(joint, part)| equation[joint - first] = Ball::exactly(part));
            equation
        };
        // Without cohesion all reserves of an open pair are zero: λ_τ = 0.
        if choice.open && law.fixed_bound() == 0.0 {
            return (n + 1..next).map(|joint| row(joint).to_vec()).collect();
        }
        let conditions = choice.tangential.conditions(polygon);
        let reserves = conditions.reserves.into_iter().map(reserve);
        reserves.chain(conditions.zero.into_iter().map(across)).collect()
    }

    /// All answers of a complete scheme.
    fn leaf(&mut self, polyhedron: &Polyhedron, scheme: &[PairScheme]) -> ControlFlow<()> {
        let joints: Vec<usize> = (0..self.exact.problem.system.joint_count()).collect();
        let mut stopped = false;
        let mut go_on = || {
            stopped |= (self.observer)(self.progress).is_break();
            !stopped
        };
        let found = corners(polyhedron, &joints, &mut go_on);
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
