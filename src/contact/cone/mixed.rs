//! Joints that repeat one another on the cone itself, or on the polygon: Newton's method on the natural map with the
//! displacements of the independent joints and the forces of the others for its unknowns (see
//! [`force_form`](crate::contact::force_form)).
//!
//! Where self-stress leaves forces undetermined the equations have many solutions, and each step is the shortest: what
//! it starts from decides, and it stays as near to it as the laws let it.

use nalgebra::{DMatrix, DVector};

use super::natural_map::{Admitted, Branch, NaturalMap};
use super::newton::{Search, Searched, Step, damped, full_steps, search};
use super::{ConeFailure, ConePair, length};
use crate::contact::problem::ContactProblem;
use crate::contact::sum::Sum;
use crate::contact::sums::{joint_forces, known_to};
use crate::lcp::problem::NOISE;
use crate::watch::Watch;
use stickslip_numerics::least_norm::least_norm;

/// Multiples of r that are tried for the joints in force form. Of two joints that differ by a small angle d one feels a
/// stiffness d⁻² times that of the structure once the other is closed; the zeros of the natural map do not depend on r.
const STIFFER: [f64; 4] = [1.0, 8_192.0, 67_108_864.0, 549_755_813_888.0];

/// A state of all joints.
#[derive(Clone, Debug)]
pub struct MixedState {
    /// z over the joints; exactly 0 where a joint is held.
    pub z: DVector<f64>,
    /// λ over the joints with the magnitudes of its terms.
    pub forces: Vec<Sum>,
    /// The magnitudes of the terms of each z that is a sum; 0 of the others.
    pub z_terms: DVector<f64>,
    /// Steps of Newton's method that led to it.
    pub steps: usize,
}

/// A problem some of whose joints stand in force form, and the pairs with their laws.
pub struct MixedProblem<'a> {
    problem: &'a ContactProblem,
    pairs: &'a [ConePair],
    admitted: Admitted,
    /// r of every joint.
    scale: DVector<f64>,
}

impl<'a> MixedProblem<'a> {
    /// Friction is the cone's or the polygon's, as the problem has it.
    pub fn new(problem: &'a ContactProblem, pairs: &'a [ConePair]) -> MixedProblem<'a> {
        let system = &*problem.system;
        let own = |joint: usize| {
            let own = system.stiffness[(joint, joint)];
            if system.is_forced(joint) && own > 0.0 { own.recip() } else { own.max(0.0) }
        };
        let largest = (0..system.joint_count()).map(own).fold(0.0, f64::max);
        let or = |stiffness: f64| if stiffness > 0.0 { stiffness } else { largest };
        let or_one = |stiffness: f64| if stiffness > 0.0 { stiffness } else { 1.0 };
        let mut scale = DVector::from_fn(system.joint_count(), |joint, _| or_one(or(own(joint))));
        for pair in pairs {
            let stiffest = pair.tangents.clone().map(own).fold(0.0, f64::max);
            pair.tangents.clone().for_each(|joint| scale[joint] = or_one(or(stiffest)));
        }
        let admitted = if problem.cone { Admitted::Disk } else { Admitted::Polygon(problem.polygon) };
        MixedProblem { problem, pairs, admitted, scale }
    }

    /// The answer that is found near displacements and, of joints in force form, forces; `None` where none is.
    ///
    /// # Errors
    /// Stopped from outside.
    pub fn answer(
        &self,
        z: &DVector<f64>,
        force: &dyn Fn(usize) -> f64,
        watch: &dyn Watch,
    ) -> Result<Option<MixedState>, ConeFailure> {
        let unknown = |joint: usize| if self.is_forced(joint) { force(joint) } else { z[joint] };
        let start = DVector::from_fn(z.len(), |joint, _| unknown(joint));
        for factor in STIFFER {
            let scale = DVector::from_fn(z.len(), |joint, _| {
                self.scale[joint] * if self.is_forced(joint) { factor } else { 1.0 }
            });
            let own = MixedProblem { scale, ..*self };
            if let Some(state) = own.accepted(search(&own, start.clone(), watch)?) {
                return Ok(Some(state));
            }
            // A way that only goes down may end in a cleft; full steps go from one set of states to the next.
            if let Some(state) = own.accepted(full_steps(&own, start.clone(), watch)?) {
                return Ok(Some(state));
            }
        }
        Ok(None)
    }

    /// The state where a search ended in an answer. What is rounding beside the other unknowns is tried as 0 first: nothing
    /// tells it from 0 but rows that hold nothing else.
    fn accepted(&self, found: Search) -> Option<MixedState> {
        let found = self.sharpened(found);
        let size = |joint: usize, unknown: f64| {
            let root = self.scale[joint].sqrt();
            unknown.abs() * if self.is_forced(joint) { root.recip() } else { root }
        };
        let largest = found.at.iter().enumerate().map(|(joint, y)| size(joint, *y)).fold(0.0, f64::max);
        let clean = |joint: usize, y: f64| if size(joint, y) <= NOISE * largest { 0.0 } else { y };
        let cleaned = DVector::from_fn(found.at.len(), |joint, _| clean(joint, found.at[joint]));
        let map = self.map(&cleaned);
        if map.is_zero {
            return Some(self.settled(cleaned, &map.branches, found.steps));
        }
        found.map.is_zero.then(|| self.settled(found.at, &found.map.branches, found.steps))
    }

    /// An answer with one more step, which takes off what rounding would excuse: the direction of a short slip hangs on it.
    fn sharpened(&self, found: Search) -> Search {
        let step = if found.map.is_zero { self.step(&found.at, &found.map, Step::Newton) } else { None };
        let Some(step) = step else { return found };
        let at = &found.at + step;
        let map = self.map(&at);
        let kinds = |map: &NaturalMap| -> Vec<[bool; 2]> {
            map.branches.iter().map(|branch| [branch.is_closed, branch.outside.is_some()]).collect()
        };
        let is_better = map.is_zero && map.norm <= found.map.norm && kinds(&map) == kinds(&found.map);
        if is_better { Search { at, map, steps: found.steps } } else { found }
    }

    fn is_forced(&self, joint: usize) -> bool {
        self.problem.system.is_forced(joint)
    }

    /// Displacements and forces of all joints, each with the magnitudes of its terms.
    fn both(&self, unknowns: &DVector<f64>) -> [Vec<Sum>; 2] {
        let responses = joint_forces(self.problem, unknowns);
        let pick = |forced: bool| {
            let one = |(joint, response): (usize, &Sum)| match self.is_forced(joint) == forced {
                true => *response,
                false => Sum::exactly(unknowns[joint]),
            };
            responses.iter().enumerate().map(one).collect()
        };
        [pick(true), pick(false)]
    }

    /// What is held exactly at rest, and what carries nothing exactly without force. A slip that no force can tell from
    /// 0 is none; that of the others goes against its friction to the last digit.
    fn settled(&self, mut unknowns: DVector<f64>, branches: &[Branch], steps: usize) -> MixedState {
        let mut at_rest = vec![false; unknowns.len()];
        let mut idle = vec![false; unknowns.len()];
        for (i, (pair, branch)) in self.pairs.iter().zip(branches).enumerate() {
            (at_rest[i], idle[i]) = (branch.is_closed, !branch.is_closed);
            let friction = if branch.is_closed { pair.friction() } else { 0.0 };
            for joint in pair.tangents.clone() {
                (at_rest[joint], idle[joint]) = (branch.outside.is_none(), friction == 0.0 && pair.fixed() == 0.0);
            }
        }
        let still = |unknowns: &mut DVector<f64>, at_rest: &[bool]| {
            for joint in 0..unknowns.len() {
                if if self.is_forced(joint) { idle[joint] } else { at_rest[joint] } {
                    unknowns[joint] = 0.0;
                }
            }
        };
        still(&mut unknowns, &at_rest);
        let [moved, forces] = self.both(&unknowns);
        for (pair, _) in self.pairs.iter().zip(branches).filter(|(_, branch)| branch.outside.is_some()) {
            if pair.tangents.clone().all(|joint| self.is_unfelt(joint, moved[joint], &forces)) {
                pair.tangents.clone().for_each(|joint| at_rest[joint] = true);
            }
        }
        still(&mut unknowns, &at_rest);
        let [moved, mut forces] = self.both(&unknowns);
        let responses: Vec<Sum> =
            (0..unknowns.len()).map(|joint| if self.is_forced(joint) { moved[joint] } else { forces[joint] }).collect();
        for joint in (0..unknowns.len()).filter(|&joint| self.is_forced(joint)) {
            let known = known_to(&self.problem.system, &responses, joint);
            forces[joint].magnitude = forces[joint].magnitude.max(known);
        }
        let mut z = DVector::from_fn(unknowns.len(), |joint, _| if at_rest[joint] { 0.0 } else { moved[joint].value });
        for (i, pair) in self.pairs.iter().enumerate() {
            // On a disk only: a force across a facet says nothing of the slip, nor does that of a bound of 0.
            let bound = Sum::exactly(pair.fixed()).plus(if idle[i] { 0.0 } else { pair.friction() }, forces[i]);
            if self.admitted != Admitted::Disk || bound.is_zero() {
                continue;
            }
            let read = |of: &dyn Fn(usize) -> f64| {
                let mut parts = [0.0; 2];
                parts.iter_mut().zip(pair.tangents.clone()).for_each(|(part, joint)| *part = of(joint));
                parts
            };
            let (slip, force) = (read(&|joint| z[joint]), read(&|joint| forces[joint].value));
            let size = length(force);
            let against = (slip[0] * force[0] + slip[1] * force[1]) / size;
            if against < 0.0 {
                pair.tangents.clone().zip(force).for_each(|(joint, force)| z[joint] = against * force / size);
            }
        }
        let terms = |joint: usize| if self.is_forced(joint) { moved[joint].magnitude } else { 0.0 };
        let z_terms = DVector::from_fn(unknowns.len(), |joint, _| terms(joint));
        MixedState { z, forces, z_terms, steps }
    }

    /// Whether no force can tell a displacement from 0.
    fn is_unfelt(&self, joint: usize, moved: Sum, forces: &[Sum]) -> bool {
        if self.is_forced(joint) {
            return moved.is_zero() || self.scale[joint] * moved.value.abs() <= NOISE * forces[joint].magnitude;
        }
        let column = self.problem.system.stiffness.column(joint);
        let felt = |i: usize| (column[i] * moved.value).abs() > NOISE * forces[i].magnitude;
        !(0..column.len()).any(|i| !self.is_forced(i) && felt(i))
    }

    /// Φ + DΦ δ = 0, dimensionless: independent joints that are held go to z = 0, all others have their equations.
    fn equations(&self, unknowns: &DVector<f64>, map: &NaturalMap) -> Equations {
        let k = unknowns.len();
        let mut held: Vec<bool> = (0..k).map(|joint| !self.is_forced(joint)).collect();
        for (i, (pair, branch)) in self.pairs.iter().zip(&map.branches).enumerate() {
            held[i] &= branch.is_closed;
            pair.tangents.clone().for_each(|joint| held[joint] &= branch.outside.is_none());
        }
        let moving: Vec<usize> = (0..k).filter(|&joint| !held[joint]).collect();
        let mut place = vec![usize::MAX; k];
        moving.iter().enumerate().for_each(|(at, &joint)| place[joint] = at);
        let n = moving.len();
        let mut equations = Equations {
            matrix: DMatrix::zeros(n, n),
            right: DVector::from_fn(n, |at, _| -map.residual[moving[at]]),
            unit: DVector::from_fn(n, |at, _| {
                let root = self.scale[moving[at]].sqrt();
                if self.is_forced(moving[at]) { root } else { root.recip() }
            }),
            step: DVector::from_fn(k, |joint, _| if held[joint] { -unknowns[joint] } else { 0.0 }),
            moving,
        };
        let system = &*self.problem.system;
        let mut add = |row: usize, factor: f64, joint: usize, is_force: bool| {
            let Equations { matrix, right, step, moving, .. } = &mut equations;
            if factor == 0.0 {
                return;
            }
            if is_force == self.is_forced(joint) {
                match place[joint] {
                    usize::MAX => right[row] -= factor * step[joint],
                    at => matrix[(row, at)] += factor,
                }
                return;
            }
            let response = system.stiffness.row(joint);
            for (at, &other) in moving.iter().enumerate() {
                matrix[(row, at)] += factor * response[other];
            }
            right[row] -= factor * step.iter().zip(response.iter()).map(|(step, entry)| step * entry).sum::<f64>();
        };
        for (i, (pair, branch)) in self.pairs.iter().zip(&map.branches).enumerate() {
            if !held[i] {
                add(place[i], if branch.is_closed { self.scale[i] } else { 1.0 }, i, !branch.is_closed);
            }
            for (t, joint) in pair.tangents.clone().enumerate().filter(|(_, joint)| !held[*joint]) {
                let (row, r) = (place[joint], self.scale[joint]);
                let Some(outside) = branch.outside else {
                    add(row, r, joint, false);
                    continue;
                };
                add(row, 1.0, joint, true);
                for (other, turned) in pair.tangents.clone().zip(outside.turned[t]) {
                    add(row, -turned, other, true);
                    add(row, turned * r, other, false);
                }
                if branch.is_closed && !pair.law.is_bilateral() {
                    let pressed = pair.friction() * outside.along[t];
                    add(row, -pressed, i, true);
                    add(row, pressed * self.scale[i], i, false);
                }
            }
        }
        equations.made_dimensionless(&self.scale)
    }
}

impl Searched for MixedProblem<'_> {
    fn map(&self, unknowns: &DVector<f64>) -> NaturalMap {
        let [moved, forces] = self.both(unknowns);
        let read = |pick: fn(&Sum) -> f64| DVector::from_iterator(moved.len(), moved.iter().map(pick));
        let (z, sizes) = (read(|sum| sum.value), read(|sum| sum.magnitude));
        NaturalMap::at((self.pairs, self.admitted), &self.scale, (&z, &sizes), &forces)
    }

    fn step(&self, unknowns: &DVector<f64>, map: &NaturalMap, kind: Step) -> Option<DVector<f64>> {
        let Equations { moving, matrix, right, unit, mut step } = self.equations(unknowns, map);
        let found = match kind {
            Step::Newton => least_norm(&matrix, &right)?,
            Step::Damped => damped(&matrix, &right, map.norm)?,
        };
        moving.iter().enumerate().for_each(|(at, &joint)| step[joint] = found[at] * unit[at]);
        Some(step)
    }
}

/// The equations of a step.
struct Equations {
    /// The joints whose unknowns are not held.
    moving: Vec<usize>,
    matrix: DMatrix<f64>,
    right: DVector<f64>,
    /// Unit of each of these unknowns: 1/√r of a displacement, √r of a force.
    unit: DVector<f64>,
    /// Step of all joints, 0 in the moving ones.
    step: DVector<f64>,
}

impl Equations {
    fn made_dimensionless(mut self, scale: &DVector<f64>) -> Equations {
        for (row, &joint) in self.moving.iter().enumerate() {
            let root = scale[joint].sqrt();
            self.right[row] /= root;
            for at in 0..self.moving.len() {
                self.matrix[(row, at)] *= self.unit[at] / root;
            }
        }
        self
    }
}
