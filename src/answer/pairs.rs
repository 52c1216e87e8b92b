//! A vertex in the words of the structure: the state, forces and displacements of every pair.

use nalgebra::DVector;

use super::pair_record::reserve;
use super::record::{InSpace, PairState, State};
use crate::contact::at_rest::AtRest;
use crate::contact::cone::{ConeAnswer, MixedState};
use crate::contact::force_form::unknowns;
use crate::contact::problem::ContactProblem;
use crate::contact::self_stress::least_norm;
use crate::contact::sum::Sum;
use crate::contact::sums::{StateForces, is_still, known_to, state_forces};
use crate::contact::system::{ContactPair, ContactSystem};
use crate::contact::written::ContactLcp;
use crate::lcp::outcome::Point;

/// Which of the forces that the motion of joints which repeat one another leaves undetermined are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shares {
    /// Those of least norm that obey the laws.
    LeastNorm,
    /// Those that the equal small compliances of yielding joints give.
    Compliant,
    /// Some that obey the laws.
    Any,
}

impl Shares {
    /// What is taken where a state is found at once.
    fn of(system: &ContactSystem) -> Shares {
        if system.yielding.is_some() { Shares::Compliant } else { Shares::LeastNorm }
    }
}

/// A vertex over the joints, in the user's units, rounding noise removed.
#[derive(Clone, Debug, PartialEq)]
pub struct JointState {
    /// z over the joints, lengths; z_τ = z⁺ − z⁻.
    pub z: DVector<f64>,
    /// λ = R (z − (g, 0)) + RF, computed afresh, without the covering.
    pub force: DVector<f64>,
    /// Sum of the magnitudes of the terms of each λ.
    pub terms: DVector<f64>,
    /// The same for the z of joints in force form; 0 for the others, whose z is the unknown.
    pub z_terms: DVector<f64>,
    /// What the equations of a file leave over; see [`StateForces`].
    pub left: Vec<Sum>,
    /// p, a force; 0 in an answer.
    pub p: f64,
    /// Pairs whose forces the motion leaves undetermined …
    pub free: Vec<usize>,
    /// … and what theirs are.
    pub shares: Shares,
    /// Whether friction obeys Coulomb's cone in space: where a pair slips it stands at its bound against the slip.
    pub on_cone: bool,
}

/// What the equations of the file leave over, where the joints of the problem are those of a file.
fn left_by_file(problem: &ContactProblem, z: &DVector<f64>, forces: &[Sum]) -> Vec<Sum> {
    let Some(yielding) = problem.system.yielding.as_ref() else {
        return if problem.system.force_form.is_some() { Vec::new() } else { state_forces(problem, z).left };
    };
    let Some(file) = &yielding.exact.file else { return Vec::new() };
    let Some(load) = yielding.exactly(problem).and_then(|exact| exact.file_load) else { return Vec::new() };
    file.left_by(forces, &problem.dislocation(z), &problem.dislocation_sizes(z.abs()), &load)
}

impl JointState {
    /// The state of displacements z, with those that are rounding set to 0. For joints in force form, `z` holds forces.
    pub fn at(problem: &ContactProblem, mut z: DVector<f64>, p: f64) -> JointState {
        let system = &*problem.system;
        let mut forces = state_forces(problem, &z);
        let still: Vec<usize> =
            (0..z.len()).filter(|&joint| z[joint] != 0.0 && is_still(system, &z, &forces.joints, joint)).collect();
        if !still.is_empty() {
            still.iter().for_each(|&joint| z[joint] = 0.0);
            forces = state_forces(problem, &z);
        }
        let StateForces { joints, left } = forces;
        let read = |pick: fn(&Sum) -> f64| DVector::from_iterator(joints.len(), joints.iter().map(pick));
        let (mut force, mut terms) = (read(|sum| sum.value), read(|sum| sum.magnitude));
        let mut z_terms = DVector::zeros(z.len());
        let forced: Vec<usize> = (0..z.len()).filter(|&joint| system.is_forced(joint)).collect();
        for &joint in &forced {
            (force[joint], terms[joint], z_terms[joint]) =
                (z[joint], known_to(system, &joints, joint).max(z[joint].abs()), terms[joint]);
        }
        forced.into_iter().for_each(|joint| z[joint] = joints[joint].cleaned());
        let shares = Shares::of(system);
        JointState { z, force, terms, z_terms, left, p, free: Vec::new(), shares, on_cone: false }.against_file(problem)
    }

    /// The state of an answer on Coulomb's cone.
    pub fn on_cone(problem: &ContactProblem, found: ConeAnswer) -> JointState {
        let ConeAnswer { z, forces, .. } = found;
        JointState { on_cone: true, ..JointState::of(problem, z, &forces) }
    }

    /// The state of these displacements and forces of all joints.
    pub fn of(problem: &ContactProblem, z: DVector<f64>, forces: &[Sum]) -> JointState {
        let yielding = problem.system.yielding.as_ref();
        let free = yielding.map_or(Vec::new(), |yielding| yielding.undetermined(problem, &z, false));
        let read = |pick: fn(&Sum) -> f64| DVector::from_iterator(forces.len(), forces.iter().map(pick));
        JointState {
            left: left_by_file(problem, &z, forces),
            force: read(|sum| sum.value),
            terms: read(|sum| sum.magnitude),
            z_terms: DVector::zeros(z.len()),
            z,
            p: 0.0,
            free,
            shares: Shares::of(&problem.system),
            on_cone: false,
        }
    }

    /// The state of joints that repeat one another, found with the forces of some of them for unknowns.
    pub fn of_mixed(problem: &ContactProblem, MixedState { z, forces, z_terms, .. }: MixedState) -> JointState {
        let state = JointState { z_terms, ..JointState::of(problem, z, &forces) };
        if problem.system.force_form.is_some() { state.with_least_norm(problem) } else { state }
    }

    /// The state of joints that repeat one another, found at rest: in the plane with the forces of least norm of its motion,
    /// in space with those that were found.
    pub fn at_rest(problem: &ContactProblem, AtRest { state, is_least_norm }: AtRest) -> JointState {
        let state = JointState::of_mixed(problem, state);
        if !problem.system.is_in_space() {
            return state;
        }
        let shares = if is_least_norm { Shares::LeastNorm } else { Shares::Any };
        JointState { shares, on_cone: problem.cone, ..state }
    }

    /// No forces at all, on Coulomb's cone.
    pub fn unloaded_on_cone(z: DVector<f64>) -> JointState {
        let none = DVector::zeros(z.len());
        JointState {
            force: none.clone(),
            terms: none.clone(),
            z_terms: none,
            z,
            left: Vec::new(),
            p: 0.0,
            free: Vec::new(),
            shares: Shares::LeastNorm,
            on_cone: true,
        }
    }

    /// With what the compliance of a file leaves over, where joints are in force form.
    fn against_file(mut self, problem: &ContactProblem) -> JointState {
        let system = &*problem.system;
        if let (Some(_), Some(file), Some(load)) = (&system.force_form, &system.file, &problem.file_load) {
            let moved = problem.dislocation(&self.z);
            let sizes = problem.dislocation_sizes(self.z.abs() + &self.z_terms);
            let forces: Vec<Sum> = (0..self.z.len()).map(|joint| self.sum(joint)).collect();
            self.left = file.left_by(&forces, &moved, &sizes, load);
        }
        self
    }

    /// The state with the forces of least norm among those of its motion.
    fn with_least_norm(mut self, problem: &ContactProblem) -> JointState {
        let mut forces: Vec<Sum> = (0..self.z.len()).map(|joint| self.sum(joint)).collect();
        self.free = least_norm(problem, &self.z, &mut forces);
        if self.free.is_empty() {
            return self;
        }
        for (joint, force) in forces.iter().enumerate() {
            (self.force[joint], self.terms[joint]) = (force.value, force.magnitude);
        }
        self.against_file(problem)
    }

    /// The magnitudes of the terms of the forces that the motion leaves undetermined, 0 of the others; `None` without such.
    pub fn shared_terms(&self, system: &ContactSystem) -> Option<DVector<f64>> {
        let mut shared = DVector::zeros(self.terms.len());
        for &pair in &self.free {
            shared[pair] = self.terms[pair];
            system.pairs[pair].tangential.clone().for_each(|joint| shared[joint] = self.terms[joint]);
        }
        (!self.free.is_empty()).then_some(shared)
    }

    /// The unknowns and their counterparts: z and λ, for joints in force form λ and z.
    pub fn in_forms(&self, system: &ContactSystem) -> (DVector<f64>, Vec<Sum>) {
        let (mut unknowns, mut responses) = (self.z.clone(), Vec::with_capacity(self.z.len()));
        for joint in 0..self.z.len() {
            if system.is_forced(joint) {
                unknowns[joint] = self.force[joint];
                responses.push(Sum { value: self.z[joint], magnitude: self.z_terms[joint] });
            } else {
                responses.push(self.sum(joint));
            }
        }
        (unknowns, responses)
    }

    /// z_τ of a pair: see [`ContactPair::slip`].
    pub fn slip(&self, pair: &ContactPair) -> [f64; 2] {
        pair.slip(&self.z)
    }

    /// λ of a joint with the magnitudes of its terms.
    pub fn sum(&self, joint: usize) -> Sum {
        Sum { value: self.force[joint], magnitude: self.terms[joint] }
    }
}

/// The vertex over the joints: z with noise set to zero, λ afresh from R and RF.
pub fn joint_state(problem: &ContactProblem, contact: &ContactLcp, point: &Point) -> JointState {
    let system = &*problem.system;
    let z = match system.force_form {
        Some(_) => unknowns(system, Some(problem), contact, &point.z),
        None => contact.joint_displacements(system, &point.z) * contact.length_unit,
    };
    let state = JointState::at(problem, z, point.p * contact.force_unit);
    if point.p == 0.0 { state.with_least_norm(problem) } else { state }
}

/// The pairs at a vertex. With p > 0 the forces include the covering (method §4): x_n = λ_n + d_n p, bound =
/// f x_n + c + (d_τ − f d_n) p. z_τ of frictionless pairs is left 0: it is read from the displacements.
pub fn pair_states(problem: &ContactProblem, contact: &ContactLcp, state: &JointState) -> Vec<PairState> {
    let system = &*problem.system;
    let pairs = system.pairs.iter().enumerate();
    pairs
        .map(|(i, pair)| {
            let cover = Cover { force: contact.covering_of(i), distance: contact.covered_distance(i, state.p) };
            if pair.is_in_space() || pair.frame.is_some() || (!pair.rubs() && system.is_in_space()) {
                pair_in_space(problem, &cover, state, i)
            } else {
                pair_state(problem, &cover, state, (i, pair.plane_tangential()))
            }
        })
        .collect()
}

/// The pairs of an answer in space.
pub fn pairs_in_space(problem: &ContactProblem, state: &JointState) -> Vec<PairState> {
    let none = Cover { force: (0.0, 0.0), distance: 0.0 };
    (0..problem.system.pair_count()).map(|i| pair_in_space(problem, &none, state, i)).collect()
}

/// What the covering adds to a pair at p > 0.
struct Cover {
    /// (d_n, d_τ).
    force: (f64, f64),
    /// To z_n, where the normal joint is in force form.
    distance: f64,
}

/// One pair; `joints` are its normal and its tangential joint.
fn pair_state(
    problem: &ContactProblem,
    &Cover { force: (d_n, d_t), distance }: &Cover,
    state: &JointState,
    joints: (usize, Option<usize>),
) -> PairState {
    let system = &*problem.system;
    let (i, tangential) = joints;
    let pair = &system.pairs[i];
    let law = &problem.laws[i];
    let z_n =
        if law.is_bilateral() { 0.0 } else { Sum::exactly(state.z[i]).plus(1.0, Sum::exactly(distance)).cleaned() };
    let z_t = tangential.map_or(0.0, |joint| state.z[joint]);
    let open = z_n > 0.0;
    // A released joint carries exactly nothing; what is left of λ there is rounding.
    let mut x_n = if open { Sum::default() } else { state.sum(i).plus(d_n, Sum::exactly(state.p)) };
    let (bound, x_t) = match tangential {
        None => (0.0, 0.0),
        Some(joint) => {
            let f = law.friction();
            let fixed = Sum::exactly(law.fixed_bound());
            let cover = Sum { value: d_t - f * d_n, magnitude: d_t.max(f * d_n) }.cleaned();
            let (raw, constant) = (state.sum(joint), fixed.value + cover * state.p);
            let sum = fixed.plus(f, x_n).plus(cover, Sum::exactly(state.p));
            let used_up = |side: f64| sum.plus(side, raw).is_zero();
            // Slip + goes with x⁺ = 0, x_τ = −bound; where nothing slips and both reserves are zero the sign is that of λ.
            let at_limit = match (used_up(1.0), used_up(-1.0)) {
                _ if z_t != 0.0 => -z_t.signum(),
                (true, true) => raw.value.signum(),
                (true, false) => -1.0,
                (false, true) => 1.0,
                (false, false) => 0.0,
            };
            if at_limit != 0.0 && f > 0.0 && f * x_n.magnitude > raw.magnitude {
                // At the limit x_n and x_τ determine each other: the less accurate one follows.
                let follows = ((at_limit * raw.value - constant) / f).max(0.0);
                let change = Sum { value: follows - x_n.value, magnitude: x_n.magnitude };
                if change.is_zero() {
                    x_n = Sum::exactly(follows);
                }
            }
            let bound = constant + f * x_n.cleaned();
            (bound, if at_limit == 0.0 { raw.cleaned() } else { 0.0 + at_limit * bound })
        }
    };
    let slip = if z_t > 0.0 {
        State::SlipPlus
    } else if z_t < 0.0 {
        State::SlipMinus
    } else {
        State::Stick
    };
    let (word, held) = State::of(open, tangential.map(|_| slip), bound);
    PairState {
        id: pair.id.clone(),
        law: pair.law.kind(),
        state: word,
        held,
        x_n: x_n.cleaned(),
        x_t,
        z_n,
        z_t,
        bound,
        reserve_plus: reserve(bound, x_t),
        reserve_minus: reserve(bound, -x_t),
        position: pair.position,
        joint: pair.joint,
        space: None,
    }
}

/// One pair in space. On a polygon its tangential force may exceed the bound between two facets; on the cone a pair that
/// slips stands exactly at it.
fn pair_in_space(problem: &ContactProblem, cover: &Cover, state: &JointState, i: usize) -> PairState {
    let pair = &problem.system.pairs[i];
    let law = &problem.laws[i];
    let (d_n, d_t) = cover.force;
    let z_n = if law.is_bilateral() { 0.0 } else { state.z[i] };
    let open = z_n > 0.0;
    let x_n = if open { Sum::default() } else { state.sum(i).plus(d_n, Sum::exactly(state.p)) };
    let z_t = state.slip(pair);
    let f = law.friction();
    let bound = match pair.rubs() {
        true => {
            law.fixed_bound() + Sum::exactly(d_t).plus(-f, Sum::exactly(d_n)).cleaned() * state.p + f * x_n.cleaned()
        }
        false => 0.0,
    };
    let size = |[along, across]: [f64; 2]| along.hypot(across);
    let mut x_t = [0.0; 2];
    if state.on_cone && size(z_t) > 0.0 {
        x_t = z_t.map(|slip| 0.0 - bound * (slip / size(z_t)));
    } else if bound > 0.0 {
        x_t.iter_mut().zip(pair.tangential.clone()).for_each(|(force, joint)| *force = state.sum(joint).cleaned());
    }
    let slip = if size(z_t) > 0.0 { State::Slip } else { State::Stick };
    let (word, held) = State::of(open, pair.rubs().then_some(slip), bound);
    let friction = if state.on_cone && size(z_t) > 0.0 { bound } else { size(x_t) };
    PairState {
        id: pair.id.clone(),
        law: pair.law.kind(),
        state: word,
        held,
        x_n: x_n.cleaned(),
        x_t: friction,
        z_n,
        z_t: size(z_t),
        bound,
        reserve_plus: reserve(bound, friction),
        reserve_minus: reserve(bound, -friction),
        position: pair.position,
        joint: pair.joint,
        space: Some(InSpace { x_t, z_t, frame: pair.frame }),
    }
}
