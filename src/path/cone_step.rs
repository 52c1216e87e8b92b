//! One step of a path in space, on Coulomb's cone: the answer of eq. (8) near another one, its slips counted from those where
//! the step began.

use std::borrow::Cow;
use std::cell::Cell;

use nalgebra::DVector;

use super::kept_forces::kept_forces;
use super::resisted::{Place, resisted};
use super::start::{PathError, cold, state_of};
use crate::answer::pairs::JointState;
use crate::answer::record::{PairState, State};
use crate::contact::at_rest::AtRest;
use crate::contact::cone::{ConeAnswer, ConeFailure, MixedProblem, MixedState};
use crate::contact::on_cone::{OnCone, cone_pairs};
use crate::contact::polygon::Polygon;
use crate::contact::problem::ContactProblem;
use crate::contact::written::ContactLcp;
use crate::lcp::outcome::RayDirection;
use crate::lcp::problem::NOISE;
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

    /// The same from a state of the way, its z and λ. Where joints repeat one another the forces that the laws leave
    /// undetermined stay as near to λ as the laws let them.
    pub(super) fn onward(
        &self,
        problem: ContactProblem,
        (from, force): (&DVector<f64>, &DVector<f64>),
        guess: &DVector<f64>,
    ) -> Result<Option<Step>, PathError> {
        let Some(exact) = exactly_behind(&problem, from) else { return self.near(problem, from, guess) };
        let problem = behind_slips(problem, from);
        let start = guess - slips_of(&problem, from);
        self.repeated((&problem, &exact), from, &start, force)
    }

    /// The answer in increments from the slips of `from` that is found from the answers of polygons, finer and finer; where
    /// there is none, what their runs ended in. The forces of `from` are `force`, where they are known.
    pub(super) fn anywhere(
        &self,
        problem: ContactProblem,
        from: &DVector<f64>,
        force: Option<&DVector<f64>>,
    ) -> Result<Result<Step, PolygonRay>, PathError> {
        let exact = force.and_then(|_| exactly_behind(&problem, from));
        let whole = problem;
        let mut problem = behind_slips(whole.clone(), from);
        let mut facets = self.facets;
        loop {
            problem = problem.with_polygon(Polygon::regular(facets, 0.0));
            let found = cold(&problem, self.watch)?;
            self.pivots.set(self.pivots.get() + found.pivots);
            if found.basis.is_some() {
                let start = state_of(&problem, &found.contact, &found.point);
                let step = match (&exact, force) {
                    (Some(exact), Some(force)) => {
                        self.settled((&problem, exact), from, [&start.z, force, &start.force])?
                    }
                    _ => self.newton(&problem, from, &start.z)?,
                };
                if let Some(step) = step {
                    return Ok(Ok(step));
                }
            }
            let ray = found.ray().cloned().map(|ray| {
                let p = found.point.p * found.contact.force_unit;
                Box::new((found.contact.clone(), ray, p))
            });
            if facets >= FINEST {
                let Some(force) = force else { return Ok(Err(ray)) };
                return Ok(self.beyond_a_jump((&whole, exact.as_ref()), (from, force))?.ok_or(ray));
            }
            facets *= 2;
        }
    }

    /// The answer at which a structure comes to rest that moves on from a state without an answer near it. Friction stands
    /// against what moves at the time, not against all of the way.
    fn beyond_a_jump(
        &self,
        (problem, exact): (&ContactProblem, Option<&ContactProblem>),
        (from, force): (&DVector<f64>, &DVector<f64>),
    ) -> Result<Option<Step>, PathError> {
        let start = (from.clone(), force.clone());
        if let Some(exact) = exact {
            let (problem, shift) = (behind_slips(problem.clone(), from), slips_of(problem, from));
            let pairs = cone_pairs(exact);
            let at_rest = |(z, force): &Place| {
                let found = self.mixed((&problem, &MixedProblem::new(exact, &pairs)), &(z - &shift), force)?;
                Ok(found.map(|found| Step::of_mixed(&problem, from, found)))
            };
            return resisted(&|_| (Cow::Borrowed(exact), shift.clone()), start, self.watch, &at_rest);
        }
        let counted = |z: &DVector<f64>| (Cow::Owned(behind_slips(problem.clone(), z)), slips_of(problem, z));
        let at_rest = |(z, _): &Place| self.near(problem.clone(), z, z);
        resisted(&counted, start, self.watch, &at_rest)
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
        // Slips count from there, normal displacements from zero.
        let answer = OnCone::new(problem).least_moved(answer, &(from - slips_of(problem, from)));
        Ok(Some(Step::of(problem, from, JointState::on_cone(problem, answer))))
    }

    /// The answer of a problem whose joints repeat one another, near what an answer of the yielding ones makes of the
    /// increments: the forces it keeps nearest to are those of `from`, or those of the answer itself.
    fn settled(
        &self,
        problems: (&ContactProblem, &ContactProblem),
        from: &DVector<f64>,
        [start, force, found]: [&DVector<f64>; 3],
    ) -> Result<Option<Step>, PathError> {
        for forces in [force, found] {
            if let Some(step) = self.repeated(problems, from, start, forces)? {
                return Ok(Some(step));
            }
        }
        let Some(yielded) = self.newton(problems.0, from, start)? else { return Ok(None) };
        self.repeated(problems, from, &yielded.increments.z, &yielded.increments.force)
    }

    /// The answer near displacements and forces of all joints where these repeat one another: of a problem whose joints
    /// yield, and the same with joints in force form.
    fn repeated(
        &self,
        (problem, exact): (&ContactProblem, &ContactProblem),
        from: &DVector<f64>,
        start: &DVector<f64>,
        force: &DVector<f64>,
    ) -> Result<Option<Step>, PathError> {
        let pairs = cone_pairs(exact);
        let mixed = MixedProblem::new(exact, &pairs);
        let near = |z: &DVector<f64>| self.mixed((problem, &mixed), z, &kept_forces(exact, z, force));
        let Some(found) = near(start)? else { return Ok(None) };
        // Which forces are to stay is seen best where the motion is known.
        let found = near(&found.z)?.unwrap_or(found);
        Ok(Some(Step::of_mixed(problem, from, found)))
    }

    /// The answer of a problem with joints in force form near displacements and forces, if it is one of the problem.
    fn mixed(
        &self,
        (problem, mixed): (&ContactProblem, &MixedProblem<'_>),
        z: &DVector<f64>,
        force: &DVector<f64>,
    ) -> Result<Option<MixedState>, PathError> {
        let found = mixed.answer(z, &|joint| force[joint], self.watch).map_err(|_| PathError::Interrupted)?;
        Ok(found.filter(|found| OnCone::new(problem).check(&found.z, &found.forces).passed))
    }
}

impl Step {
    /// The end of a step from `from`, from its answer in increments.
    fn of(problem: &ContactProblem, from: &DVector<f64>, increments: JointState) -> Step {
        let z = &increments.z + slips_of(problem, from);
        Step { z, scheme: scheme(problem, &increments.z), increments }
    }

    /// The same from an answer in which joints that repeat one another are at rest.
    pub(super) fn at_rest(problem: ContactProblem, from: &DVector<f64>, found: AtRest) -> Step {
        let problem = behind_slips(problem, from);
        let increments = JointState::at_rest(&problem, found);
        Step::of(&problem, from, increments)
    }

    /// The same from the answer of a problem with joints in force form.
    fn of_mixed(problem: &ContactProblem, from: &DVector<f64>, found: MixedState) -> Step {
        Step::of(problem, from, JointState { on_cone: true, ..JointState::of_mixed(problem, found) })
    }
}

/// The problem for slips that count from those of `from`, total z over the joints.
pub(super) fn behind_slips(mut problem: ContactProblem, from: &DVector<f64>) -> ContactProblem {
    let shift = slips_of(&problem, from);
    let [mut load, mut sizes]: [DVector<f64>; 2] = [DVector::zeros(shift.len()), DVector::zeros(shift.len())];
    for (joint, slip) in shift.iter().enumerate().filter(|(_, slip)| **slip != 0.0) {
        if problem.system.is_forced(joint) {
            // Its displacement is what comes out.
            (load[joint], sizes[joint]) = (load[joint] - slip, sizes[joint] + slip.abs());
            continue;
        }
        let column = problem.system.stiffness.column(joint);
        load.axpy(*slip, &column, 1.0);
        sizes.zip_apply(&column, |size: &mut f64, entry: f64| *size += (entry * slip).abs());
    }
    problem.add_load(1.0, &load, &sizes);
    problem
}

/// The same with joints in force form, where the joints of the problem yield.
pub(super) fn exactly_behind(problem: &ContactProblem, from: &DVector<f64>) -> Option<ContactProblem> {
    let exact = problem.system.yielding.as_ref()?.exactly(problem)?;
    Some(behind_slips(exact, from))
}

/// z_τ of total displacements, 0 in the normal joints. Where joints repeat one another a slip that is rounding beside the
/// largest displacement is none: what one joint is said to have slipped must not stand against another one that is held.
fn slips_of(problem: &ContactProblem, z: &DVector<f64>) -> DVector<f64> {
    let pairs = problem.system.pair_count();
    let least = if problem.system.repeats_joints() { NOISE * z.amax() } else { 0.0 };
    DVector::from_fn(z.len(), |joint, _| if joint < pairs || z[joint].abs() <= least { 0.0 } else { z[joint] })
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

/// What the displacements of an answer say of every pair: they are exactly 0 where a joint is held.
fn scheme(problem: &ContactProblem, z: &DVector<f64>) -> Scheme {
    let pairs = problem.system.pairs.iter().zip(&problem.laws).enumerate();
    pairs
        .map(|(i, (pair, law))| {
            let slips = if pair.slip(z) == [0.0; 2] { State::Stick } else { State::Slip };
            State::of(z[i] > 0.0, pair.rubs().then_some(slips), law.fixed_bound())
        })
        .collect()
}
