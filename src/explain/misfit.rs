//! Parts that do not fit together: joints that repeat one another and whose gaps leave no room for all of them.
//!
//! ```text
//!   S μ = s self-stress:   sᵀ (z − (g, 0)) = sᵀ h  whatever moves
//!   a proof:  s_n ≥ 0 in unilateral pairs, s_τ = 0,  sᵀ_n g + sᵀ h < 0;  z_n ≥ 0 then cannot hold, for any load and friction
//! ```
//! A linear program proposes μ; the signs are verified in rationals.

use std::time::Instant;

use super::exact_equations::{Equations, Solved};
use super::proof::BUDGET;
use crate::contact::problem::ContactProblem;
use crate::contact::system::ContactSystem;
use crate::lcp::exact::dyadic::Dyadic;
use crate::lcp::linear_program::{LinearProgram, Outcome};
use crate::lcp::problem::NOISE;
use crate::text::words::{list, short};

/// An s_n below this share of the largest must be 0.
const TIGHT: f64 = 1e-6;

/// The proof.
#[derive(Clone, Debug, PartialEq)]
pub struct Misfit {
    /// The pairs that cannot all be closed or open, those that s presses.
    pub pairs: Vec<usize>,
    /// sᵀ_n g + sᵀ h with the largest s_n = 1: minus the overlap, < 0.
    pub room: f64,
}

impl Misfit {
    /// In words.
    pub fn words(&self, system: &ContactSystem) -> String {
        let ids: Vec<String> = self.pairs.iter().map(|&pair| system.pairs[pair].id.clone()).collect();
        let (ids, room) = (list(&ids), short(self.room));
        format!("whatever moves, the distances of pairs {ids} sum up to {room}, and none of them may be negative")
    }
}

/// What s times gaps and common displacements of the joints sums, per unit of each μ, and its terms.
fn rooms(problem: &ContactProblem, stress: &nalgebra::DMatrix<f64>) -> Vec<(f64, f64)> {
    let system = &*problem.system;
    let given = system.file.as_ref().zip(problem.file_load.as_ref());
    let offset = |joint: usize| match given {
        Some((file, load)) => load.vector[file.kept[joint]],
        None if system.is_forced(joint) => problem.load[joint],
        None => 0.0,
    };
    let gap = |joint: usize| problem.laws.get(joint).map_or(0.0, |law| law.gap());
    (stress.column_iter())
        .map(|s| {
            s.iter().enumerate().fold((0.0, 0.0), |(sum, size), (joint, s)| {
                let terms = [s * gap(joint), s * offset(joint)];
                (sum + terms[0] + terms[1], size + terms[0].abs() + terms[1].abs())
            })
        })
        .collect()
}

/// Looks for a proof that the parts do not fit.
pub fn misfit(problem: &ContactProblem) -> Option<Misfit> {
    if let Some(yielding) = &problem.system.yielding {
        return misfit(&yielding.exactly(problem)?);
    }
    let system = &*problem.system;
    let stress = &system.force_form.as_ref()?.self_stress;
    let rooms = rooms(problem, stress);
    if rooms.iter().all(|(room, _)| *room == 0.0) {
        return None;
    }
    let row = |joint: usize| -> Vec<(usize, f64)> {
        stress.row(joint).iter().copied().enumerate().filter(|(_, s)| *s != 0.0).collect()
    };
    let unilateral: Vec<usize> =
        (0..system.pairs.len()).filter(|&i| !system.pairs[i].law.is_bilateral() && !row(i).is_empty()).collect();
    let tangential: Vec<usize> =
        system.pairs.iter().flat_map(|pair| pair.tangential.clone()).filter(|&joint| !row(joint).is_empty()).collect();
    let mut program = LinearProgram::default();
    let size = rooms.iter().fold(0.0, |a: f64, (_, size)| a.max(*size));
    for (k, (room, _)) in rooms.iter().enumerate() {
        program.variable(room / size);
        program.at_most(vec![(k, 1.0)], 1.0);
        program.at_most(vec![(k, -1.0)], 1.0);
    }
    for &joint in &tangential {
        program.equal(row(joint), 0.0);
    }
    for &joint in &unilateral {
        program.at_most(row(joint).into_iter().map(|(k, s)| (k, -s)).collect(), 0.0);
    }
    let Outcome::Optimum(found) = program.solve(BUDGET.as_secs_f64()) else {
        return None;
    };
    let pressed = |joint: usize| row(joint).iter().map(|(k, s)| s * found.x[*k]).sum::<f64>();
    let largest = unilateral.iter().map(|&joint| pressed(joint)).fold(0.0, f64::max);
    let end = Instant::now() + BUDGET;
    let mut equations = Equations::new(rooms.len(), end);
    let idle = unilateral.iter().filter(|&&joint| pressed(joint) <= TIGHT * largest);
    for &joint in tangential.iter().chain(idle) {
        equations.add(row(joint).into_iter().map(|(k, s)| (k, Dyadic::from(s))));
    }
    let amounts: Vec<Dyadic> = match equations.nearest(&found.x) {
        Solved::Free => found.x.iter().map(|x| Dyadic::from(*x)).collect(),
        Solved::Exactly(amounts) => amounts,
        Solved::OutOfTime => return None,
    };
    let value = |joint: usize| {
        row(joint).into_iter().fold(Dyadic::default(), |sum, (k, s)| sum.plus(&Dyadic::from(s).times(&amounts[k])))
    };
    let holds = tangential.iter().all(|&joint| value(joint).is_zero())
        && unilateral.iter().all(|&joint| !value(joint).is_negative());
    let (mut room, mut terms) = (0.0, 0.0);
    for ((own, size), amount) in rooms.iter().zip(&amounts) {
        room += own * amount.to_f64();
        terms += size * amount.to_f64().abs();
    }
    if !holds || room >= -NOISE * terms {
        return None;
    }
    let sizes: Vec<f64> = unilateral.iter().map(|&joint| value(joint).to_f64()).collect();
    let largest = sizes.iter().fold(0.0, |a: f64, b| a.max(*b));
    let unit = if largest > 0.0 { largest } else { 1.0 };
    let pairs = unilateral.into_iter().zip(sizes).filter(|(_, size)| *size > 0.0).map(|(pair, _)| pair).collect();
    Some(Misfit { pairs, room: room / unit })
}
