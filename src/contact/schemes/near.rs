//! Whether data that are rounded have no answer on paper either.
//!
//! R and RF of a structure are results in f64: an answer that lies exactly on a limit on paper may lie just beyond it by the
//! numbers that are stored, and then no working scheme is an answer of these. That there is none is proved only where
//! forces that differ by their rounding have none:
//! ```text
//!   λ = R (z − (g, 0)) + RF + e,   |e_j| ≤ what rounding can have made of λ_j where nothing moves
//! ```
//! with every e of its own: an exact linear program for each working scheme. Where R resists a motion by no more than its
//! own rounding, nothing is proved: what the structure has there is lost beside what is stiffer.

use std::ops::ControlFlow;

use nalgebra::DVector;

use crate::contact::pivoted::PivotedCholesky;
use crate::contact::problem::ContactProblem;
use crate::contact::schemes::enumerate::{EnumeratedAnswer, Enumeration, JointState, Progress, choices, enumerate};
use crate::contact::schemes::exact_system::{ExactSystem, PairVariables};
use crate::contact::schemes::scheme::PairScheme;
use crate::contact::sums::rounding_at_rest;
use crate::lcp::exact::dyadic::nearest;
use crate::lcp::exact::polyhedron::{Polyhedron, State};

/// Finds every answer; where rounded data have none, one within their rounding. What has [none](Enumeration::no_answer) then
/// is proved to have none.
pub fn enumerate_to_rounding(
    problem: &ContactProblem,
    observer: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Enumeration {
    let mut found = enumerate(problem, observer);
    if !found.no_answer() || problem.system.has_exact_data() {
        return found;
    }
    let system = &*problem.system;
    if PivotedCholesky::new(&system.stiffness).rank + system.kernel.ncols() < system.joint_count() {
        found.within_rounding = true;
        return found;
    }
    let exact = ExactSystem::within(problem, &rounding_at_rest(problem));
    let mut search = Search { variables: exact.variables(), exact, observer, nodes: found.visited + found.cut };
    match search.first() {
        ControlFlow::Continue(()) => {}
        ControlFlow::Break(None) => found.complete = false,
        ControlFlow::Break(Some(near)) => {
            found.within_rounding = true;
            found.answers.push(near);
        }
    }
    found
}

struct Search<'a, 'o> {
    exact: ExactSystem<'a>,
    variables: Vec<PairVariables>,
    observer: &'o mut dyn FnMut(Progress) -> ControlFlow<()>,
    nodes: u64,
}

/// Broken off with an answer, or without one when stopped.
type Flow = ControlFlow<Option<EnumeratedAnswer>>;

impl Search<'_, '_> {
    fn first(&mut self) -> Flow {
        let progress = Progress { nodes: self.nodes, share: 1.0, found: 0 };
        let mut go_on = || (self.observer)(progress).is_continue();
        let (polyhedron, state) = self.exact.polyhedron(&[], &mut go_on);
        match state {
            State::Feasible => self.descend(&polyhedron, &mut Vec::new()),
            State::Empty => Flow::Continue(()),
            State::Stopped => Flow::Break(None),
        }
    }

    /// Pair by pair; `above` is the program of the pairs in `scheme`.
    fn descend(&mut self, above: &Polyhedron, scheme: &mut Vec<PairScheme>) -> Flow {
        let problem = self.exact.problem;
        let pair = scheme.len();
        if pair == problem.laws.len() {
            let joints = 0..problem.system.joint_count();
            let z = DVector::from_iterator(joints.len(), joints.map(|joint| nearest(&above.value(joint))));
            let force = DVector::zeros(z.len());
            let state = JointState { z, force };
            return Flow::Break(Some(EnumeratedAnswer { schemes: vec![scheme.clone()], state, continuum: false }));
        }
        for choice in choices(&problem.laws[pair], problem.polygon) {
            self.nodes += 1;
            let progress = Progress { nodes: self.nodes, share: 1.0, found: 0 };
            if (self.observer)(progress).is_break() {
                return Flow::Break(None);
            }
            let mut below = above.clone();
            let holds = problem.laws[pair].fixed_bound() > 0.0;
            let mut go_on = || (self.observer)(progress).is_continue();
            match self.variables[pair].impose(&mut below, choice, holds, &mut go_on) {
                State::Empty => continue,
                State::Stopped => return Flow::Break(None),
                State::Feasible => {}
            }
            scheme.push(choice);
            self.descend(&below, scheme)?;
            scheme.pop();
        }
        Flow::Continue(())
    }
}
