//! Answers of which only the joints are asked for, as sweeps, limits and maps ask for them at many sets of numbers: of a
//! structure the equilibrium of several is checked together.

use std::sync::Arc;

use super::case::Case;
use super::cold::Extent;
use super::error::SolveError;
use super::known_collapses::KnownCollapses;
use super::prepared::{Geometry, Prepared};
use super::problem::{contact_problem, factors};
use super::state::{RunData, Solved};
use crate::answer::pairs::JointState;
use crate::answer::record::{Answer, OutcomeKind};
use crate::contact::problem::ContactProblem;
use crate::contact::unique::is_unique;
use crate::fem::BalancedState;
use crate::model::rules::Engine;

impl Case<'_> {
    /// Whether it is proved that there is at most one answer here, whatever the load.
    pub fn is_unique(self) -> bool {
        let usual = self.rules.are_default() && self.rules.engine == Engine::Scheme;
        let Some(system) = self.prepared.system().filter(|_| usual) else { return false };
        let problem = || contact_problem(system, &factors(self.prepared, self.values), self.values);
        self.scenario.law_refusal(self.values).is_none() && is_unique(&problem())
    }

    /// Friction of every pair; none of a bare LCP.
    pub fn frictions(self) -> Vec<f64> {
        let Case { prepared, values, .. } = self;
        let problem = prepared.system().map(|system| contact_problem(system, &factors(prepared, values), values));
        problem.map_or_else(Vec::new, |problem| problem.frictions())
    }

    /// The answer, with the check over the joints; for a structure [`Unbalanced`] has what is left to check. Neither
    /// pivots nor what would stop a collapse are put into words.
    ///
    /// # Errors
    /// As [`Case::solve`].
    pub fn solve_counted(self) -> Result<Solved, SolveError> {
        self.solve_as(true, Extent::Counted)
    }

    /// As [`Case::solve_briefly`], but an answer has only its pairs: it is checked as a whole, but comes without
    /// displacements, members, reactions and descriptions of its pivots.
    ///
    /// # Errors
    /// As [`Case::solve`].
    pub fn solve_pairs(self) -> Result<Solved, SolveError> {
        let solved = self.solve_counted()?;
        if solved.is_balanced() { Ok(solved) } else { self.solve_briefly() }
    }

    /// As [`Case::solve_pairs`], by the first polygon alone in space: whether there is no answer, or only none that it leads
    /// to, is left open unless it is certified.
    ///
    /// # Errors
    /// As [`Case::solve`].
    pub fn solve_at_first(self) -> Result<Solved, SolveError> {
        let Case { scenario, prepared, values, rules, watch } = self;
        let in_space = prepared.system().filter(|system| system.is_in_space() && rules.are_default());
        let Some(system) = in_space.filter(|_| scenario.law_refusal(values).is_none()) else {
            return self.solve_pairs();
        };
        let problem = contact_problem(system, &factors(prepared, values), values).under(rules);
        let (mut solved, _) = prepared.first_run(&problem, (rules, Extent::Counted), watch)?;
        solved.put_verdict();
        if solved.is_balanced() { Ok(solved) } else { self.solve_briefly() }
    }

    /// As [`Case::solve_pairs`], for callers that try many values close to where answers end: what is no answer is
    /// tried again in f64 only, and nothing at all is tried where a known collapse proves that there is none. Without
    /// an answer: the word for how the first run ended.
    ///
    /// # Errors
    /// As [`Case::solve`].
    pub fn look_for_pairs(self, known: &KnownCollapses) -> Result<Result<Solved, &'static str>, SolveError> {
        let Case { prepared, values, .. } = self;
        let plane = prepared.system().filter(|system| !system.is_in_space());
        let solved = match plane.filter(|_| self.scenario.law_refusal(values).is_none()) {
            None => self.solve_pairs()?,
            Some(system) => {
                let problem = contact_problem(system, &factors(prepared, values), values).under(self.rules);
                if known.prove(&problem) {
                    return Ok(Err(OutcomeKind::Ray.word()));
                }
                let solved = prepared.solve_in_f64(&problem, self, known)?;
                if solved.is_balanced() { solved } else { self.solve_briefly()? }
            }
        };
        Ok(solved.if_answer(self.rules.cone))
    }
}

/// An answer of a structure whose equilibrium is still to be checked.
#[derive(Debug)]
pub struct Unbalanced {
    prepared: Prepared,
    problem: ContactProblem,
    joints: JointState,
}

impl Solved {
    /// What the check of equilibrium needs, where that is still to be made.
    fn unbalanced(&self) -> Option<Unbalanced> {
        match (&self.rest, &self.run) {
            (Some(rest), RunData::Contact { problem, .. }) => Some(Unbalanced {
                prepared: rest.prepared.clone(),
                problem: problem.clone(),
                joints: rest.joints.clone(),
            }),
            _ => None,
        }
    }

    /// Itself, or the word for how the run ended without an answer; with `cone`, an answer in space must be on
    /// Coulomb's cone.
    pub fn if_answer(self, cone: bool) -> Result<Solved, &'static str> {
        if self.stands(cone) { Ok(self) } else { Err(self.answer.outcome.word()) }
    }

    /// What is proved of its ray, in its answer.
    pub(super) fn put_verdict(&mut self) {
        if let (Some(report), Some(ray)) = (&self.ray, &mut self.answer.ray) {
            ray.verdict = report.verdict;
        }
    }

    /// Whether nothing is left to check, or the forces balance at every node.
    fn is_balanced(&self) -> bool {
        self.unbalanced().is_none_or(|left| Unbalanced::are_balanced(&[&left]) == [true])
    }

    /// The answer alone, and what the check of its equilibrium needs where that is still to be made.
    pub fn into_answer(self) -> (Answer, Option<Unbalanced>) {
        let left = self.unbalanced();
        (self.answer, left)
    }
}

impl Unbalanced {
    /// The same with one joint force off by `amount`: for tests of the check.
    #[must_use]
    pub fn with_force_off(&self, joint: usize, amount: f64) -> Unbalanced {
        let mut joints = self.joints.clone();
        joints.force[joint] += amount;
        Unbalanced { prepared: self.prepared.clone(), problem: self.problem.clone(), joints }
    }

    /// For each: whether the forces balance at every node.
    pub fn are_balanced(all: &[&Unbalanced]) -> Vec<bool> {
        let mut balanced = Vec::with_capacity(all.len());
        // Those of one geometry share its factorization.
        for same in all.chunk_by(|a, b| Arc::ptr_eq(&a.prepared.geometry, &b.prepared.geometry)) {
            let Geometry::Structure { main, structure, .. } = &*same[0].prepared.geometry else {
                balanced.extend(same.iter().map(|_| true));
                continue;
            };
            let states: Vec<BalancedState<'_>> = same
                .iter()
                .map(|state| BalancedState {
                    factors: &state.problem.factors,
                    dislocation: state.problem.dislocation(&state.joints.z),
                    terms: state.problem.dislocation_sizes(state.joints.z.abs()),
                    force: &state.joints.force,
                    shared: state.joints.shared_terms(&state.problem.system),
                })
                .collect();
            let bounds = main.equilibrium_bounds(structure, &states);
            balanced.extend(bounds.into_iter().map(|bound| bound <= crate::answer::check::TOLERANCE));
        }
        balanced
    }
}
