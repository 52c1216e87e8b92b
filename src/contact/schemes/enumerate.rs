//! All answers of a contact problem, by a search over working schemes.
//!
//! Depth first, one pair after the other; a partial scheme is cut only where its signs are proved to fail. Two ways to
//! prove it: In balls (f64 with error bounds) every quantity is kept as an affine function of the displacements of the
//! pairs not yet decided; deciding a pair eliminates its one or two displacements, and a sign that fails for all
//! displacements of the others in their box ends the branch. The box: normals z_n ≥ 0 and, where R is positive
//! definite, that around the ellipsoid zᵀR z ≤ −zᵀq that every answer lies in (zᵀλ ≤ 0 for every answer; q is RF −
//! R·(g, 0)), with proved bounds ([`crate::contact::schemes::bounding_box`]). Where balls do not cut, the signs and the box are a linear program in exact arithmetic ([`crate::lcp::exact::polyhedron`]). Of a complete scheme it gives all answers, one or a
//! continuum with its corners and directions. Nothing is accepted or cut by a tolerance.

use std::ops::ControlFlow;

use nalgebra::DVector;
use num_rational::BigRational;

use crate::contact::law::{PairLaw, TangentialJoint};
use crate::contact::problem::ContactProblem;
use crate::contact::schemes::ball::{Ball, Row, size, solved};
use crate::contact::schemes::bounding_box::ellipsoid;
use crate::contact::schemes::exact_system::{ExactSystem, PairVariables};
use crate::contact::schemes::scheme::{PairScheme, Tangential};
use crate::lcp::exact::all_solutions::Solutions;
use crate::lcp::exact::corners::corners;
use crate::lcp::exact::dyadic::{nearest, rational};
use crate::lcp::exact::polyhedron::{Polyhedron, State};

/// Undecided pairs from which on the exact linear program pays: without a box, when balls cut little.
const WORTH: usize = 3;
/// The same with a box: measured, it costs as much as some hundred partial schemes in balls.
const WORTH_BOXED: usize = 5;

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
fn choices(law: &PairLaw) -> Vec<PairScheme> {
    let closed = [PairScheme::STICK, PairScheme::SLIP_PLUS, PairScheme::SLIP_MINUS];
    match law.tangential {
        TangentialJoint::Free => vec![PairScheme::STICK, PairScheme::OPEN_STICK],
        TangentialJoint::Bounded { .. } if law.is_bilateral() => closed.to_vec(),
        TangentialJoint::Bounded { fixed, .. } if fixed > 0.0 => {
            closed.into_iter().chain(closed.map(|scheme| PairScheme { open: true, ..scheme })).collect()
        }
        TangentialJoint::Bounded { .. } => closed.into_iter().chain([PairScheme::OPEN]).collect(),
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

/// Rows: one per joint, pair by pair (n, then τ), holding λ_j or z_j, whichever is not fixed. Columns: the undecided
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
            joints.extend(system.pairs[pair].plane_tangential());
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
        let worth = if sides.is_some() { WORTH_BOXED } else { WORTH };
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
            choices: problem.laws.iter().map(choices).collect(),
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
        let problem = self.exact.problem;
        let k = self.joints.len();
        let width = k + 1 - level.first;
        let n = self.offsets[pair];
        let next = self.offsets[pair + 1];
        let row = |i: usize| &level.rows[i * width..(i + 1) * width];
        let f = Ball::exactly(problem.laws[pair].friction());

        // Equations to be solved for the displacement of a joint.
        let mut equations: Vec<(usize, Row)> = Vec::new();
        if choice.open {
            equations.push((n, row(n).to_vec()));
        }
        let slip = choice.tangential.sign();
        if next - n == 2 && slip != 0.0 {
            // x^± = 0: λ_τ ± (f λ_n + c) = 0; λ_n = 0 where open.
            let f = if choice.open { Ball::ZERO } else { f };
            let sign = |ball: Ball| if slip > 0.0 { ball } else { ball.negative() };
            let mut equation: Row = row(n + 1).iter().zip(row(n)).map(|(t, n)| t.plus(sign(f.times(*n)))).collect();
            let bound = Ball::exactly(problem.laws[pair].fixed_bound());
            equation[width - 1] = equation[width - 1].plus(sign(bound));
            equations.push((n + 1, equation));
        }
        // Displacements of this pair in terms of the undecided ones; 0 where the joint is on.
        let mut displacement: [Option<Row>; 2] = [None, None];
        let column = |joint: usize| joint - level.first;
        match &mut equations[..] {
            [(_, first), (_, second)] => {
                // Two by two with the larger pivot first.
                let relative = |own: &Row, at: usize| own[column(at)].middle.abs() / size(own);
                let normal_first = relative(first, n) >= relative(second, n + 1);
                let (lead, at, follow, follow_at) = if normal_first {
                    (&*first, column(n), &mut *second, column(n + 1))
                } else {
                    (&*second, column(n + 1), &mut *first, column(n))
                };
                let factor = follow[at].over(lead[at])?;
                for (x, y) in follow.iter_mut().zip(lead) {
                    *x = x.minus(factor.times(*y));
                }
                follow[at] = Ball::ZERO;
                let z_follow = solved(follow, follow_at)?;
                let coupling = lead[follow_at];
                let mut inserted: Row = lead.iter().zip(&z_follow).map(|(x, z)| x.plus(coupling.times(*z))).collect();
                inserted[follow_at] = Ball::ZERO;
                let z_lead = solved(&inserted, at)?;
                displacement =
                    if normal_first { [Some(z_lead), Some(z_follow)] } else { [Some(z_follow), Some(z_lead)] };
            }
            [(joint, equation)] => displacement[*joint - n] = Some(solved(equation, column(*joint))?),
            _ => {}
        }

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
            if self.offsets[pair + 1] - n != 2 {
                return false;
            }
            match state.tangential {
                // An open pair without cohesion slips freely.
                _ if state.open && fixed == 0.0 => false,
                Tangential::Stick => [1.0, -1.0].into_iter().any(|side| {
                    let f = if state.open { 0.0 } else { laws[pair].friction() };
                    fails(&[(n, f), (n + 1, side)], fixed)
                }),
                Tangential::SlipPlus => fails(&[(n + 1, 1.0)], 0.0),
                Tangential::SlipMinus => fails(&[(n + 1, -1.0)], 0.0),
            }
        })
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

    /// The direction in which open pairs slip that nothing holds.
    fn with_slips(&self, scheme: &[PairScheme], state: &JointState) -> Vec<PairScheme> {
        let mut scheme = scheme.to_vec();
        for (pair, chosen) in scheme.iter_mut().enumerate() {
            if *chosen == PairScheme::OPEN
                && self.exact.problem.laws[pair].fixed_bound() == 0.0
                && self.exact.problem.system.pairs[pair].plane_tangential().is_some_and(|joint| state.z[joint] < 0.0)
            {
                chosen.tangential = Tangential::SlipMinus;
            }
        }
        scheme
    }
}

#[cfg(test)]
#[path = "enumerate_tests.rs"]
mod tests;
