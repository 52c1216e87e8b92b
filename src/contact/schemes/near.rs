//! Whether data that are rounded have no answer on paper either.
//!
//! R and RF of a structure are results in f64: an answer that lies exactly on a limit on paper may lie just beyond it by the
//! numbers that are stored, and then no working scheme is an answer of these. That there is none is proved only where
//! forces that differ by their rounding have none:
//! ```text
//!   λ = R (z − (g, 0)) + RF + e,   |e_j| ≤ what rounding can have made of λ_j where nothing moves
//! ```
//! with every e of its own. Most partial schemes are cut by a contradiction that no such e lifts; for those that are cut
//! by the stored numbers alone it is an exact linear program with e among its unknowns. Where R resists a motion by no
//! more than its own rounding, nothing is proved: what the structure has there is lost beside what is stiffer.

use std::ops::ControlFlow;

use nalgebra::DVector;

use crate::contact::pivoted::PivotedCholesky;
use crate::contact::problem::ContactProblem;
use crate::contact::schemes::enumerate::{
    EnumeratedAnswer, Enumeration, JointState, Progress, choices, enumerate, enumerate_within,
};
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
    if problem.system.has_exact_data() {
        return enumerate(problem, observer);
    }
    let system = &*problem.system;
    let rooms = rounding_at_rest(problem);
    let (mut found, doubtful) = enumerate_within(problem, &rooms, observer);
    if !found.no_answer() {
        return found;
    }
    if PivotedCholesky::new(&system.stiffness).rank + system.kernel.ncols() < system.joint_count() {
        found.within_rounding = true;
        return found;
    }
    if doubtful.is_empty() {
        return found;
    }
    let nodes = found.visited + found.cut;
    match Search::new(problem, &rooms, (observer, nodes)).first(&doubtful) {
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

impl<'a, 'o> Search<'a, 'o> {
    /// After as many `nodes`.
    fn new(
        problem: &'a ContactProblem,
        rooms: &[f64],
        (observer, nodes): (&'o mut dyn FnMut(Progress) -> ControlFlow<()>, u64),
    ) -> Self {
        let exact = ExactSystem::within(problem, rooms);
        Search { variables: exact.variables(), exact, observer, nodes }
    }

    /// The first answer below one of the partial schemes.
    fn first(&mut self, partial: &[Vec<PairScheme>]) -> Flow {
        let progress = self.progress();
        let (root, state) = self.exact.polyhedron(&[], &mut || (self.observer)(progress).is_continue());
        match state {
            State::Feasible => {}
            State::Empty => return Flow::Continue(()),
            State::Stopped => return Flow::Break(None),
        }
        for scheme in partial {
            let mut program = Some(root.clone());
            for (pair, choice) in scheme.iter().enumerate() {
                let Some(above) = program else { break };
                program = self.imposed(&above, pair, *choice)?;
            }
            if let Some(program) = program {
                self.descend(&program, &mut scheme.clone())?;
            }
        }
        Flow::Continue(())
    }

    fn progress(&self) -> Progress {
        Progress { nodes: self.nodes, share: 1.0, found: 0 }
    }

    /// The program with one more pair decided; `None` where it is empty.
    fn imposed(
        &mut self,
        above: &Polyhedron,
        pair: usize,
        choice: PairScheme,
    ) -> ControlFlow<Option<EnumeratedAnswer>, Option<Polyhedron>> {
        self.nodes += 1;
        let progress = self.progress();
        let mut go_on = || (self.observer)(progress).is_continue();
        if !go_on() {
            return ControlFlow::Break(None);
        }
        let mut below = above.clone();
        let holds = self.exact.problem.laws[pair].fixed_bound() > 0.0;
        match self.variables[pair].impose(&mut below, choice, holds, &mut go_on).0 {
            State::Feasible => ControlFlow::Continue(Some(below)),
            State::Empty => ControlFlow::Continue(None),
            State::Stopped => ControlFlow::Break(None),
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
            let Some(below) = self.imposed(above, pair, choice)? else { continue };
            scheme.push(choice);
            self.descend(&below, scheme)?;
            scheme.pop();
        }
        Flow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use nalgebra::DMatrix;

    use super::*;
    use crate::contact::full_lcp::tests::{coulomb, coulomb_in_space, plain, random_number, with_random_bound_and_gap};

    /// What a cut says of all forces in their rooms, against the linear programs of every scheme with these among their
    /// unknowns.
    #[test]
    fn cuts_within_rooms_agree_with_the_programs_of_all_schemes() {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        // Problems without an answer: proved by the cuts alone, with the programs below the doubtful, and lost in the rooms.
        let mut met = [0; 3];
        for case in 0..1500 {
            let in_space = case % 5 == 0;
            let pairs = if in_space { 1 } else { random.random_range(1..=3) };
            let k = if in_space { 3 } else { 2 * pairs };
            let a = DMatrix::from_fn(k, random.random_range(1..=k), |_, _| random_number(&mut random, true, 2));
            let stiffness = &a * a.transpose();
            let load: Vec<f64> = (0..k).map(|_| random_number(&mut random, true, 3)).collect();
            let system = if in_space { coulomb_in_space(stiffness) } else { coulomb(stiffness) };
            let mut problem = plain(&system, [0.25, 1.0, 2.0][case % 3], &load);
            if case % 4 == 1 {
                problem = with_random_bound_and_gap(problem, &mut random);
            }
            let size = [1.0 / 1024.0, 0.125, 1.0][random.random_range(0..3)];
            let rooms: Vec<f64> = (0..k).map(|_| size * f64::from(random.random_range(0..=2))).collect();
            let go_on = &mut |_| ControlFlow::Continue(());
            let (found, doubtful) = enumerate_within(&problem, &rooms, go_on);
            if !found.no_answer() {
                continue;
            }
            let all = Search::new(&problem, &rooms, (go_on, 0)).first(&[Vec::new()]).is_break();
            let below = Search::new(&problem, &rooms, (go_on, 0)).first(&doubtful).is_break();
            assert_eq!(below, all, "case {case}: {doubtful:?} of {problem:?} within {rooms:?}");
            met[if all { 2 } else { usize::from(!doubtful.is_empty()) }] += 1;
        }
        assert!(met.iter().all(|met| *met >= 20), "{met:?}");
    }
}
