//! Newton's method on the natural map, with halved steps: its semi-smooth derivative on the joints that move.
//!
//! The map need not fall in every step, only below the largest of its last values (Grippo, Lampariello & Lucidi
//! 1986). Near a limit of sliding the answer lies far off, along a motion that costs no energy, at the end of a bent
//! valley: a search that only ever goes down creeps along its floor, one that may climb its side crosses it in some
//! ten steps.

use nalgebra::{DMatrix, DVector};

use super::natural_map::{Branch, NaturalMap};
use super::{ConeFailure, ConeProblem, across};
use crate::watch::Watch;
use stickslip_numerics::decompositions::{Cholesky, Factor};

/// Steps at most.
const STEPS: usize = 60;
/// The least value of the natural map has to halve within this many steps: a search that creeps does not arrive.
const PATIENCE: usize = 12;
/// A step is halved at most this often.
const HALVINGS: usize = 12;
/// A step has to bring the natural map below the largest of this many values before it.
const MEMORY: usize = 8;
/// The natural map has to fall below that by at least this share of what a step promises (Armijo).
const FALL: f64 = 1e-4;

/// Where a search ended: in an answer, or where no step leads down.
pub(super) struct Search {
    pub z: DVector<f64>,
    pub states: Vec<Branch>,
    pub steps: usize,
}

/// Searches from z.
pub(super) fn search(
    problem: &ConeProblem,
    scale: &DVector<f64>,
    mut z: DVector<f64>,
    watch: &dyn Watch,
) -> Result<Search, ConeFailure> {
    let mut map = NaturalMap::at(problem, scale, &z, &problem.forces(&z));
    let mut steps = 0;
    let mut norms = vec![map.norm];
    let mut best = (z.clone(), map.clone());
    while steps < STEPS && !map.is_zero {
        if steps >= PATIENCE && best.1.norm > 0.5 * least(&norms[..=steps - PATIENCE]) {
            break;
        }
        if watch.stop() {
            return Err(ConeFailure::Stopped);
        }
        let equations = Equations::at(problem, scale, &z, &map);
        let below = norms.iter().rev().take(MEMORY).fold(0.0, |a: f64, norm| a.max(*norm));
        let next = [Equations::newton, Equations::damped]
            .iter()
            .find_map(|solve| shortened(problem, scale, (&z, below), &solve(&equations, map.norm)?));
        let Some((point, next)) = next else { break };
        (z, map) = (point, next);
        steps += 1;
        norms.push(map.norm);
        if map.is_zero || map.norm < best.1.norm {
            best = (z.clone(), map.clone());
        }
    }
    let (z, map) = best;
    Ok(Search { z, states: map.branches, steps })
}

fn least(norms: &[f64]) -> f64 {
    norms.iter().fold(f64::INFINITY, |a, norm| a.min(*norm))
}

/// The first of the step from z, its half, its quarter … on which the natural map comes `below`.
fn shortened(
    problem: &ConeProblem,
    scale: &DVector<f64>,
    (z, below): (&DVector<f64>, f64),
    step: &DVector<f64>,
) -> Option<(DVector<f64>, NaturalMap)> {
    let mut share = 1.0;
    for _ in 0..=HALVINGS {
        // A full step ends exactly where it points: z − z is 0.
        let point = z + share * step;
        let next = NaturalMap::at(problem, scale, &point, &problem.forces(&point));
        if next.norm <= (1.0 - FALL * share) * below || next.is_zero {
            return Some((point, next));
        }
        share *= 0.5;
    }
    None
}

/// Φ + DΦ δ = 0, dimensionless (rows and unknowns over √r): what is held goes to z = 0, the others have the equations.
struct Equations {
    /// The joints that move.
    moving: Vec<usize>,
    matrix: DMatrix<f64>,
    right: DVector<f64>,
    /// √r of every joint.
    root: DVector<f64>,
    /// Step of all joints, 0 in the moving ones.
    held: DVector<f64>,
}

impl Equations {
    fn at(problem: &ConeProblem, scale: &DVector<f64>, z: &DVector<f64>, map: &NaturalMap) -> Equations {
        let mut moving = Vec::new();
        let mut held = -z;
        for (i, (pair, branch)) in problem.pairs.iter().zip(&map.branches).enumerate() {
            if !branch.is_closed {
                moving.push(i);
            }
            if branch.outside.is_some() {
                moving.extend(pair.tangents.clone());
            }
        }
        moving.iter().for_each(|&joint| held[joint] = 0.0);
        // What the joints that go to 0 do to the forces.
        let mut shift: DVector<f64> = DVector::zeros(z.len());
        for (joint, step) in held.iter().enumerate().filter(|(_, step)| **step != 0.0) {
            shift.axpy(*step, &problem.stiffness.column(joint), 1.0);
        }
        let n = moving.len();
        let mut place = vec![usize::MAX; z.len()];
        moving.iter().enumerate().for_each(|(at, &joint)| place[joint] = at);
        let root = scale.map(f64::sqrt);
        // Rows as columns: R is symmetric and stored by columns.
        let mut rows: DMatrix<f64> = DMatrix::zeros(n, n);
        let mut right: DVector<f64> = DVector::zeros(n);
        let mut add = |at: usize, factor: f64, joint: usize| {
            let stiffness = problem.stiffness.column(joint);
            rows.column_mut(at).iter_mut().zip(&moving).for_each(|(entry, &k)| *entry += factor * stiffness[k]);
            right[at] -= factor * shift[joint];
        };
        for (i, (pair, branch)) in problem.pairs.iter().zip(&map.branches).enumerate() {
            if !branch.is_closed {
                add(place[i], 1.0, i);
            }
            let Some(outside) = branch.outside else { continue };
            for (t, joint) in pair.tangents.clone().enumerate() {
                for (u, other) in pair.tangents.clone().enumerate() {
                    add(place[joint], f64::from(t == u) - outside.ratio * across(outside.along, t, u), other);
                }
                if branch.is_closed && !pair.law.is_bilateral() {
                    add(place[joint], -pair.friction() * outside.along[t], i);
                }
            }
        }
        for (i, (pair, branch)) in problem.pairs.iter().zip(&map.branches).enumerate() {
            let Some(outside) = branch.outside else { continue };
            for (t, joint) in pair.tangents.clone().enumerate() {
                let at = place[joint];
                for (u, other) in pair.tangents.clone().enumerate() {
                    rows[(place[other], at)] += outside.ratio * scale[joint] * across(outside.along, t, u);
                }
                if branch.is_closed && !pair.law.is_bilateral() {
                    right[at] += pair.friction() * outside.along[t] * scale[i] * z[i];
                }
            }
        }
        let matrix = DMatrix::from_fn(n, n, |i, j| rows[(j, i)] / (root[moving[i]] * root[moving[j]]));
        let right = DVector::from_fn(n, |at, _| (right[at] - map.residual[moving[at]]) / root[moving[at]]);
        Equations { moving, matrix, right, root, held }
    }

    fn step(&self, found: &DVector<f64>) -> DVector<f64> {
        let mut step = self.held.clone();
        self.moving.iter().zip(found.iter()).for_each(|(&joint, value)| step[joint] = value / self.root[joint]);
        step
    }

    /// Newton's step; `None` where the equations are singular.
    fn newton(&self, _: f64) -> Option<DVector<f64>> {
        Some(self.step(&Factor::new(self.matrix.clone()).solve(&self.right)?))
    }

    /// The step of Levenberg and Marquardt, damped the less the smaller the natural map is; it exists where the
    /// equations are singular, too.
    fn damped(&self, norm: f64) -> Option<DVector<f64>> {
        let n = self.moving.len();
        let mut normal = self.matrix.tr_mul(&self.matrix);
        let size = normal.diagonal().amax();
        let length = self.right.norm();
        let damping = size * (norm / (norm + length)).clamp(1e-8, 1.0) * 1e-2;
        for at in 0..n {
            normal[(at, at)] += damping;
        }
        let mut found = self.matrix.tr_mul(&self.right);
        Cholesky::new(&normal)?.solve(found.as_mut_slice());
        found.iter().all(|value| value.is_finite()).then(|| self.step(&found))
    }
}
