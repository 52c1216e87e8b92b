//! How an answer on Coulomb's cone changes with its load and its laws: the derivative of the equations that its pairs
//! obey (method §7).
//!
//! ```text
//!   open    λ_n′ = 0;      closed   z_n′ = 0;      held   z_τ′ = 0
//!   slips   λ_τ = −b u,  u = z_τ/|z_τ|,  b = f λ_n + c:
//!           λ_τ′ + (f λ_n′ + f′ λ_n + c′) u + b/|z_τ| (1 − u uᵀ) z_τ′ = 0
//!   with    λ′ = R z′ + RF′ − R (g′, 0)
//! ```

use nalgebra::{DMatrix, DVector};

use super::problem::ContactProblem;
use stickslip_numerics::decompositions::Factor;

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

/// z′ over the joints where `rates` is the derivative of the problem, per unit of the parameter in question; `None`
/// where the equations are singular.
pub fn displacement_rates(
    problem: &ContactProblem,
    rates: &ContactProblem,
    standing: &[Standing],
) -> Option<DVector<f64>> {
    let system = &*problem.system;
    let constants = rates.joint_constants();
    let mut moving: Vec<usize> = Vec::new();
    for (i, (pair, at)) in system.pairs.iter().zip(standing).enumerate() {
        moving.extend(at.open.then_some(i));
        moving.extend(pair.tangential.clone().filter(|_| at.slips()));
    }
    let n = moving.len();
    let mut place = vec![usize::MAX; system.joint_count()];
    moving.iter().enumerate().for_each(|(at, &joint)| place[joint] = at);
    let root = |at: usize| {
        let diagonal = system.stiffness[(moving[at], moving[at])];
        if diagonal > 0.0 { diagonal.sqrt() } else { 1.0 }
    };
    let (mut matrix, mut right): (DMatrix<f64>, DVector<f64>) = (DMatrix::zeros(n, n), DVector::zeros(n));
    for (i, (pair, at)) in system.pairs.iter().zip(standing).enumerate() {
        let mut add = |row: usize, factor: f64, joint: usize| {
            for (column, &other) in moving.iter().enumerate() {
                matrix[(row, column)] += factor * system.stiffness[(joint, other)];
            }
            right[row] -= factor * constants[joint];
        };
        if at.open {
            add(place[i], 1.0, i);
        }
        if !at.slips() {
            continue;
        }
        let size = at.slip[0].hypot(at.slip[1]);
        let u = if size > 0.0 { at.slip.map(|part| part / size) } else { [0.0; 2] };
        let (law, grows) = (&problem.laws[i], &rates.laws[i]);
        let closed = !at.open && !law.is_bilateral();
        for (t, joint) in pair.tangential.clone().enumerate() {
            add(place[joint], 1.0, joint);
            if closed {
                add(place[joint], law.friction() * u[t], i);
            }
        }
        for (t, joint) in pair.tangential.clone().enumerate() {
            let pressed = if closed { grows.friction() * at.pressed } else { 0.0 };
            right[place[joint]] -= (pressed + grows.fixed_bound()) * u[t];
            for (s, other) in pair.tangential.clone().enumerate().filter(|_| size > 0.0) {
                let across = f64::from(t == s) - u[t] * u[s];
                matrix[(place[joint], place[other])] += at.bound / size * across;
            }
        }
    }
    let scaled = DMatrix::from_fn(n, n, |i, j| matrix[(i, j)] / (root(i) * root(j)));
    let found = Factor::new(scaled).solve(&DVector::from_fn(n, |i, _| right[i] / root(i)))?;
    let mut z = DVector::zeros(system.joint_count());
    moving.iter().enumerate().for_each(|(at, &joint)| z[joint] = found[at] / root(at));
    Some(z)
}
