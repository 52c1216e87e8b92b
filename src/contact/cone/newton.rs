//! Newton's method on the natural map, with halved steps: its semi-smooth derivative on the joints that move.
//!
//! The map need not fall in every step, only below the largest of its last values (Grippo, Lampariello & Lucidi
//! 1986). Near a limit of sliding the answer lies far off, along a motion that costs no energy, at the end of a bent
//! valley: a search that only ever goes down creeps along its floor, one that may climb its side crosses it in some
//! ten steps.

use nalgebra::{DMatrix, DVector};

use super::natural_map::{Admitted, NaturalMap};
use super::{ConeFailure, ConeProblem};
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
    /// The unknowns.
    pub at: DVector<f64>,
    pub map: NaturalMap,
    pub steps: usize,
}

/// Laws whose natural map is to become zero.
pub(super) trait Searched {
    /// The map where the unknowns have these values.
    fn map(&self, at: &DVector<f64>) -> NaturalMap;

    /// Newton's step, and what may be tried in its place; `None` where there is none.
    fn step(&self, at: &DVector<f64>, map: &NaturalMap, kind: Step) -> Option<DVector<f64>>;
}

/// How a step is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Step {
    Newton,
    Damped,
}

/// Searches from these values of the unknowns.
pub(super) fn search(laws: &dyn Searched, mut at: DVector<f64>, watch: &dyn Watch) -> Result<Search, ConeFailure> {
    let mut map = laws.map(&at);
    let mut steps = 0;
    let mut norms = vec![map.norm];
    let mut best = (at.clone(), map.clone());
    while steps < STEPS && !map.is_zero {
        if steps >= PATIENCE && best.1.norm > 0.5 * least(&norms[..=steps - PATIENCE]) {
            break;
        }
        if watch.stop() {
            return Err(ConeFailure::Stopped);
        }
        let below = norms.iter().rev().take(MEMORY).fold(0.0, |a: f64, norm| a.max(*norm));
        let next = [Step::Newton, Step::Damped]
            .into_iter()
            .find_map(|kind| shortened(laws, (&at, below), &laws.step(&at, &map, kind)?));
        let Some((point, next)) = next else { break };
        (at, map) = (point, next);
        steps += 1;
        norms.push(map.norm);
        if map.is_zero || map.norm < best.1.norm {
            best = (at.clone(), map.clone());
        }
    }
    let (at, map) = best;
    Ok(Search { at, map, steps })
}

/// Goes on by whole steps of Newton's method, whatever becomes of the map on the way.
pub(super) fn full_steps(laws: &dyn Searched, at: DVector<f64>, watch: &dyn Watch) -> Result<Search, ConeFailure> {
    let map = laws.map(&at);
    let mut search = Search { at, map, steps: 0 };
    while search.steps < STEPS && !search.map.is_zero {
        if watch.stop() {
            return Err(ConeFailure::Stopped);
        }
        let Some(step) = laws.step(&search.at, &search.map, Step::Newton) else { break };
        search.at += step;
        search.map = laws.map(&search.at);
        search.steps += 1;
    }
    Ok(search)
}

fn least(norms: &[f64]) -> f64 {
    norms.iter().fold(f64::INFINITY, |a, norm| a.min(*norm))
}

/// The first of the step, its half, its quarter … on which the natural map comes `below`.
fn shortened(
    laws: &dyn Searched,
    (at, below): (&DVector<f64>, f64),
    step: &DVector<f64>,
) -> Option<(DVector<f64>, NaturalMap)> {
    let mut share = 1.0;
    for _ in 0..=HALVINGS {
        // A full step ends exactly where it points: z − z is 0.
        let point = at + share * step;
        let next = laws.map(&point);
        if next.norm <= (1.0 - FALL * share) * below || next.is_zero {
            return Some((point, next));
        }
        share *= 0.5;
    }
    None
}

/// Searches the answer of a problem from displacements z; `scale`: r of every joint.
pub(super) fn by_displacements(
    problem: &ConeProblem,
    scale: &DVector<f64>,
    z: DVector<f64>,
    watch: &dyn Watch,
) -> Result<Search, ConeFailure> {
    search(&ByDisplacements { problem, scale }, z, watch)
}

/// The laws of a problem, by its displacements.
struct ByDisplacements<'a> {
    problem: &'a ConeProblem<'a>,
    scale: &'a DVector<f64>,
}

impl Searched for ByDisplacements<'_> {
    fn map(&self, z: &DVector<f64>) -> NaturalMap {
        let forces = self.problem.forces(z);
        NaturalMap::at((self.problem.pairs, Admitted::Disk), self.scale, (z, &z.abs()), &forces)
    }

    fn step(&self, z: &DVector<f64>, map: &NaturalMap, kind: Step) -> Option<DVector<f64>> {
        let equations = Equations::at(self.problem, self.scale, z, map);
        match kind {
            Step::Newton => equations.newton(),
            Step::Damped => equations.damped(map.norm),
        }
    }
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
                    add(place[joint], f64::from(t == u) - outside.turned[t][u], other);
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
                    rows[(place[other], at)] += scale[joint] * outside.turned[t][u];
                }
                if branch.is_closed && !pair.law.is_bilateral() {
                    right[at] += pair.friction() * outside.along[t] * scale[i] * z[i];
                }
            }
        }
        let mut matrix = DMatrix::from_fn(n, n, |i, j| rows[(j, i)] / (root[moving[i]] * root[moving[j]]));
        // Without a kernel nothing is free, and no forces are summed to see that.
        if problem.kernel.ncols() > 0 {
            let (forces, is_open) = (problem.forces(&problem.bending(z)), |i: usize| !map.branches[i].is_closed);
            if let Some(free) = problem.free_motions(&forces, is_open, |joint| place[joint] < n) {
                let free = DMatrix::from_fn(n, free.ncols(), |at, one| free[(moving[at], one)] * root[moving[at]]);
                hold(&mut matrix, &free);
            }
        }
        let right = DVector::from_fn(n, |at, _| (right[at] - map.residual[moving[at]]) / root[moving[at]]);
        Equations { moving, matrix, right, root, held }
    }

    fn step(&self, found: &DVector<f64>) -> DVector<f64> {
        let mut step = self.held.clone();
        self.moving.iter().zip(found.iter()).for_each(|(&joint, value)| step[joint] = value / self.root[joint]);
        step
    }

    /// Newton's step; `None` where the equations are singular.
    fn newton(&self) -> Option<DVector<f64>> {
        Some(self.step(&Factor::new(self.matrix.clone()).solve(&self.right)?))
    }

    /// See [`damped`].
    fn damped(&self, norm: f64) -> Option<DVector<f64>> {
        Some(self.step(&damped(&self.matrix, &self.right, norm)?))
    }
}

/// Makes a matrix regular that is singular along some motions, from both sides: what it solves for has none of them.
pub(super) fn hold(matrix: &mut DMatrix<f64>, motions: &DMatrix<f64>) {
    let size = matrix.diagonal().amax();
    let motions = motions.clone().qr().q();
    *matrix += &motions * motions.transpose() * if size > 0.0 { size } else { 1.0 };
}

/// The step of Levenberg and Marquardt, damped the less the smaller the natural map is; it exists where the equations
/// are singular, too.
pub(super) fn damped(matrix: &DMatrix<f64>, right: &DVector<f64>, norm: f64) -> Option<DVector<f64>> {
    let mut normal = matrix.tr_mul(matrix);
    let size = normal.diagonal().amax();
    let length = right.norm();
    let damping = size * (norm / (norm + length)).clamp(1e-8, 1.0) * 1e-2;
    for at in 0..right.len() {
        normal[(at, at)] += damping;
    }
    let mut found = matrix.tr_mul(right);
    Cholesky::new(&normal)?.solve(found.as_mut_slice());
    found.iter().all(|value| value.is_finite()).then_some(found)
}
