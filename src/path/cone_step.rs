//! One step of a path in space, on Coulomb's cone: the answer of eq. (8) near another one, its slips counted from those where
//! the step began.

use std::cell::Cell;

use nalgebra::DVector;

use super::start::{PathError, cold, state_of};
use crate::answer::pairs::JointState;
use crate::answer::record::{PairState, State};
use crate::contact::cone::{ConeAnswer, ConeFailure, ConeState};
use crate::contact::on_cone::OnCone;
use crate::contact::polygon::Polygon;
use crate::contact::problem::ContactProblem;
use crate::contact::written::ContactLcp;
use crate::lcp::outcome::RayDirection;
use crate::watch::Watch;

/// Fewest facets of the polygon in a path, on which directions of slip turn.
const FACETS: u16 = 16;
/// Finest polygon from which Newton's method is started.
const FINEST: u16 = 64;

/// Where a step ends.
#[derive(Clone)]
pub(super) struct Step {
    /// Total z over the joints.
    pub(super) z: DVector<f64>,
    /// The same with the slips counted from where the step began: what the laws of contact tie to the forces.
    pub(super) increments: JointState,
    /// What every pair does in it.
    pub(super) scheme: Scheme,
}

/// What every pair does, and what holds it where it is open.
pub(super) type Scheme = Vec<(State, Option<State>)>;

/// The ray that the run on the finest polygon ended in, with its LCP and p.
pub(super) type PolygonRay = Option<Box<(ContactLcp, RayDirection, f64)>>;

/// Takes the steps.
pub(super) struct Stepper<'a> {
    /// Fewest facets of the polygon from whose answer Newton's method is started where no step before leads on.
    pub(super) facets: u16,
    pub(super) watch: &'a dyn Watch,
    /// Pivots made on polygons.
    pub(super) pivots: Cell<usize>,
}

impl<'a> Stepper<'a> {
    /// For a path that is followed with polygons of at least this many facets.
    pub(super) fn new(facets: u16, watch: &'a dyn Watch) -> Stepper<'a> {
        Stepper { facets: facets.max(FACETS), watch, pivots: Cell::new(0) }
    }

    /// The answer of a problem in increments from the slips of `from` that Newton's method finds near `guess`, total z;
    /// `None` where it finds none.
    pub(super) fn near(
        &self,
        problem: ContactProblem,
        from: &DVector<f64>,
        guess: &DVector<f64>,
    ) -> Result<Option<Step>, PathError> {
        let problem = behind_slips(problem, from);
        let start = guess - slips_of(&problem, from);
        self.taken(&problem, from, OnCone::new(&problem).nearby(&start, self.watch))
    }

    /// The same from the answers of polygons, finer and finer; where there is none, what their runs ended in.
    pub(super) fn anywhere(
        &self,
        problem: ContactProblem,
        from: &DVector<f64>,
    ) -> Result<Result<Step, PolygonRay>, PathError> {
        let mut problem = behind_slips(problem, from);
        let mut facets = self.facets;
        loop {
            problem = problem.with_polygon(Polygon::regular(facets, 0.0));
            let found = cold(&problem, self.watch)?;
            self.pivots.set(self.pivots.get() + found.pivots);
            if found.basis.is_some() {
                let start = state_of(&problem, &found.contact, &found.point).z;
                if let Some(step) = self.newton(&problem, from, &start)? {
                    return Ok(Ok(step));
                }
            }
            let ray = found.ray().cloned().map(|ray| {
                let p = found.point.p * found.contact.force_unit;
                Box::new((found.contact.clone(), ray, p))
            });
            if facets >= FINEST {
                return Ok(Err(ray));
            }
            facets *= 2;
        }
    }

    fn newton(
        &self,
        problem: &ContactProblem,
        from: &DVector<f64>,
        start: &DVector<f64>,
    ) -> Result<Option<Step>, PathError> {
        self.taken(problem, from, OnCone::new(problem).answer(start, self.watch))
    }

    /// The answer of a problem in which just those joints move that move in z, near it; `None` where that is none.
    pub(super) fn kept(&self, problem: &ContactProblem, z: &DVector<f64>) -> Result<Option<Step>, PathError> {
        self.taken(problem, &DVector::zeros(z.len()), OnCone::new(problem).kept(z))
    }

    fn taken(
        &self,
        problem: &ContactProblem,
        from: &DVector<f64>,
        found: Result<ConeAnswer, ConeFailure>,
    ) -> Result<Option<Step>, PathError> {
        let answer = match found {
            Ok(answer) => answer,
            Err(ConeFailure::Stopped) => return Err(PathError::Interrupted),
            Err(ConeFailure::NotConverged { .. } | ConeFailure::NotFinite | ConeFailure::DoNotFit) => return Ok(None),
        };
        let scheme = scheme(problem, &answer);
        let increments = JointState::on_cone(problem, answer);
        Ok(Some(Step { z: &increments.z + slips_of(problem, from), increments, scheme }))
    }
}

/// The problem for slips that count from those of `from`, total z over the joints.
pub(super) fn behind_slips(mut problem: ContactProblem, from: &DVector<f64>) -> ContactProblem {
    let shift = slips_of(&problem, from);
    let (load, sizes) = {
        let stiffness = &problem.system.stiffness;
        let mut sizes = DVector::zeros(shift.len());
        for (joint, slip) in shift.iter().enumerate().filter(|(_, slip)| **slip != 0.0) {
            sizes.zip_apply(&stiffness.column(joint), |size: &mut f64, entry| *size += (entry * slip).abs());
        }
        (stiffness * &shift, sizes)
    };
    problem.add_load(1.0, &load, &sizes);
    problem
}

/// z_τ of total displacements, 0 in the normal joints.
fn slips_of(problem: &ContactProblem, z: &DVector<f64>) -> DVector<f64> {
    let pairs = problem.system.pair_count();
    DVector::from_fn(z.len(), |joint, _| if joint < pairs { 0.0 } else { z[joint] })
}

/// What is left of the inequalities that keep a pair in its state, along the normal and along the tangents: a gap, a contact
/// force, a reserve, the length of a slip.
pub(super) fn margins(pair: &PairState) -> [Option<f64>; 2] {
    let slides = match (pair.state, pair.held) {
        (State::Open, None) | (State::Closed, _) => None,
        (State::Stick, _) | (State::Open, Some(State::Stick)) => Some(pair.reserve()),
        _ => Some(pair.z_t),
    };
    [Some(if pair.state == State::Open { pair.z_n } else { pair.x_n }), slides]
}

fn scheme(problem: &ContactProblem, answer: &ConeAnswer) -> Scheme {
    let pairs = problem.system.pairs.iter().zip(&problem.laws).zip(&answer.states);
    pairs
        .map(|((pair, law), state)| {
            let slips = match state {
                ConeState::Closed => None,
                ConeState::Stick => Some(State::Stick),
                ConeState::Slip => Some(State::Slip),
                ConeState::Open => {
                    let moves = pair.tangential.clone().any(|joint| answer.z[joint] != 0.0);
                    pair.rubs().then_some(if moves { State::Slip } else { State::Stick })
                }
            };
            State::of(*state == ConeState::Open, slips, law.fixed_bound())
        })
        .collect()
}
