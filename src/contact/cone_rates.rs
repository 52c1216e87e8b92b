//! How an answer on Coulomb's cone changes with its load and its laws: the derivative of the equations that its pairs
//! obey (method §7).
//!
//! ```text
//!   open    λ_n′ = 0;      closed   z_n′ = 0;      held   z_τ′ = 0
//!   slips   λ_τ = −b u,  u = z_τ/|z_τ|,  b = f λ_n + c:
//!           λ_τ′ + (f λ_n′ + f′ λ_n + c′) u + b/|z_τ| (1 − u uᵀ) z_τ′ = 0
//!   with    λ′ = R z′ + RF′ − R (g′, 0)
//! ```
//! Of joints in force form ([`super::force_form`]) λ′ is the unknown and z′ what follows.

use nalgebra::{DMatrix, DVector};

use super::problem::ContactProblem;
use super::system::ContactSystem;
use crate::lcp::problem::NOISE;
use stickslip_numerics::decompositions::Factor;
use stickslip_numerics::least_norm::least_norm;

/// A pair as it stands in an answer on the cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// z_n > 0.
    pub open: bool,
    /// λ_n, a force.
    pub pressed: f64,
    /// b, a force.
    pub bound: f64,
    /// z_τ.
    pub slip: [f64; 2],
}

impl Standing {
    /// Whether its tangential joints move: it slips, or nothing holds it.
    fn slips(&self) -> bool {
        self.slip != [0.0; 2] || self.bound == 0.0
    }
}

/// z′ over the joints, λ′ of those in force form, where `rates` is the derivative of the problem, per unit of the
/// parameter in question; `None` where the equations are singular.
pub fn rates_of_unknowns(
    problem: &ContactProblem,
    rates: &ContactProblem,
    standing: &[Standing],
) -> Option<DVector<f64>> {
    let system = &*problem.system;
    let constants = rates.joint_constants();
    let mut moves: Vec<bool> = (0..system.joint_count()).map(|joint| system.is_forced(joint)).collect();
    for (i, (pair, at)) in system.pairs.iter().zip(standing).enumerate() {
        moves[i] |= at.open;
        pair.tangential.clone().for_each(|joint| moves[joint] |= at.slips());
    }
    let moving: Vec<usize> = (0..moves.len()).filter(|&joint| moves[joint]).collect();
    let n = moving.len();
    let mut place = vec![usize::MAX; system.joint_count()];
    moving.iter().enumerate().for_each(|(at, &joint)| place[joint] = at);
    let (mut matrix, mut right): (DMatrix<f64>, DVector<f64>) = (DMatrix::zeros(n, n), DVector::zeros(n));
    for (i, (pair, at)) in system.pairs.iter().zip(standing).enumerate() {
        // factor · λ′ or factor · z′ of a joint; an independent one that is at rest has z′ = 0.
        let mut add = |row: usize, factor: f64, joint: usize, is_force: bool| {
            if is_force == system.is_forced(joint) {
                if moves[joint] {
                    matrix[(row, place[joint])] += factor;
                }
                return;
            }
            for (column, &other) in moving.iter().enumerate() {
                matrix[(row, column)] += factor * system.stiffness[(joint, other)];
            }
            right[row] -= factor * constants[joint];
        };
        if moves[i] {
            add(place[i], 1.0, i, at.open);
        }
        if !at.slips() {
            pair.tangential
                .clone()
                .filter(|&joint| moves[joint])
                .for_each(|joint| add(place[joint], 1.0, joint, false));
            continue;
        }
        let size = at.slip[0].hypot(at.slip[1]);
        let u = if size > 0.0 { at.slip.map(|part| part / size) } else { [0.0; 2] };
        let (law, grows) = (&problem.laws[i], &rates.laws[i]);
        let closed = !at.open && !law.is_bilateral();
        for (t, joint) in pair.tangential.clone().enumerate() {
            add(place[joint], 1.0, joint, true);
            if closed {
                add(place[joint], law.friction() * u[t], i, true);
            }
            for (s, other) in pair.tangential.clone().enumerate().filter(|_| size > 0.0) {
                add(place[joint], at.bound / size * (f64::from(t == s) - u[t] * u[s]), other, false);
            }
        }
        for (t, joint) in pair.tangential.clone().enumerate() {
            let pressed = if closed { grows.friction() * at.pressed } else { 0.0 };
            right[place[joint]] -= (pressed + grows.fixed_bound()) * u[t];
        }
    }
    let found = solved(system, &moving, &matrix, &right)?;
    let mut unknowns = DVector::zeros(system.joint_count());
    moving.iter().zip(found.iter()).for_each(|(&joint, rate)| unknowns[joint] = *rate);
    Some(unknowns)
}

/// The solution, every row and unknown in its own unit.
fn solved(
    system: &ContactSystem,
    moving: &[usize],
    matrix: &DMatrix<f64>,
    right: &DVector<f64>,
) -> Option<DVector<f64>> {
    let size = |entries: &mut dyn Iterator<Item = f64>| {
        let largest = entries.fold(0.0, |a: f64, b| a.max(b.abs()));
        if largest > 0.0 { largest } else { 1.0 }
    };
    let root = |at: usize| {
        let diagonal = system.stiffness[(moving[at], moving[at])];
        if diagonal > 0.0 { diagonal.sqrt() } else { 1.0 }
    };
    let n = moving.len();
    if !moving.iter().any(|&joint| system.is_forced(joint)) {
        let scaled = DMatrix::from_fn(n, n, |i, j| matrix[(i, j)] / (root(i) * root(j)));
        let found = Factor::new(scaled).solve(&DVector::from_fn(n, |i, _| right[i] / root(i)))?;
        return Some(DVector::from_fn(n, |at, _| found[at] / root(at)));
    }
    let columns: Vec<f64> = (0..n).map(|j| size(&mut matrix.column(j).iter().copied())).collect();
    let rows: Vec<f64> = (0..n).map(|i| size(&mut (0..n).map(|j| matrix[(i, j)] / columns[j]))).collect();
    let scaled = DMatrix::from_fn(n, n, |i, j| matrix[(i, j)] / (rows[i] * columns[j]));
    let right = DVector::from_fn(n, |i, _| right[i] / rows[i]);
    let found = least_norm(&scaled, &right)?;
    let largest = found.amax().max(right.amax());
    // Rows that contradict one another leave something over.
    if (&scaled * &found - &right).amax() > n as f64 * NOISE * largest {
        return None;
    }
    let cleaned = |rate: f64| if rate.abs() <= NOISE * largest { 0.0 } else { rate };
    Some(DVector::from_fn(n, |at, _| cleaned(found[at]) / columns[at]))
}
