//! A vertex of the LCP → state, forces and displacements of every pair.

use nalgebra::DVector;

use super::record::{PairState, State};
use crate::contact::complementarity::{ContactLcp, Couple, load_with_gaps};
use crate::contact::numbers::ContactNumbers;
use crate::contact::system::ContactSystem;
use crate::lcp::outcome::Point;
use crate::lcp::problem::NOISE;
use crate::model::pair::Law;

/// A vertex over the joints, in the user's units, rounding noise removed.
#[derive(Clone, Debug, PartialEq)]
pub struct JointState {
    /// z over the joints; z_τ = z⁺ − z⁻.
    pub z: DVector<f64>,
    /// λ = R (z − (g, 0)) + RF, computed afresh, without the covering.
    pub force: DVector<f64>,
    /// p.
    pub p: f64,
}

/// The vertex over the joints: z with noise set to zero, λ afresh from R and RF.
pub fn joint_state(
    system: &ContactSystem,
    numbers: &ContactNumbers,
    contact: &ContactLcp,
    point: &Point,
) -> JointState {
    let scale = &contact.lcp.scale.column;
    let column = |row: usize| match contact.rows[row].couple {
        Couple::Minus => contact.plus_row[contact.rows[row].pair].map_or(1.0, |plus| scale[plus]),
        _ => scale[row],
    };
    let size: f64 = point.z.iter().enumerate().map(|(row, z)| column(row) * z.abs()).sum();
    let clean: Vec<f64> = point
        .z
        .iter()
        .enumerate()
        .map(|(row, z)| if column(row) * z.abs() <= NOISE * size { 0.0 } else { *z })
        .collect();
    let z = contact.joint_displacements(system, &clean) * contact.length_unit;
    let force = &system.stiffness * &z + load_with_gaps(system, numbers);
    JointState { z, force, p: point.p * contact.force_unit }
}

/// The pairs at a vertex. With p > 0 the forces include the covering (theory §4): x_n = λ_n + d_n p, bound =
/// f x_n + c + (d_τ − f d_n) p. z_τ of frictionless pairs is left 0: it is read from the displacements.
pub fn pair_states(
    system: &ContactSystem,
    numbers: &ContactNumbers,
    contact: &ContactLcp,
    state: &JointState,
) -> Vec<PairState> {
    // What the joints would carry if gaps were closed by force tells the size of rounding where all else is zero.
    let largest = state.force.amax().max(state.p).max(load_with_gaps(system, numbers).amax());
    system
        .pairs
        .iter()
        .enumerate()
        .map(|(i, pair)| {
            let (d_n, d_t) = contact.covering_of(i);
            let z_n = match pair.law {
                Law::Bound { .. } => 0.0,
                _ => state.z[i],
            };
            let z_t = pair.tangential.map_or(0.0, |joint| state.z[joint]);
            let open = z_n > 0.0;
            // A released joint carries exactly nothing; what is left of λ there is rounding.
            let x_n = if open { 0.0 } else { drop_noise(state.force[i] + d_n * state.p, largest) };
            let (bound, x_t) = match pair.law {
                Law::Frictionless { .. } => (0.0, 0.0),
                _ => {
                    let (normal, extra) = match pair.law {
                        Law::Bound { .. } => (0.0, numbers.bound[i]),
                        _ => (x_n, numbers.cohesion[i]),
                    };
                    let f = numbers.friction[i];
                    let bound = f * normal + extra + drop_noise(d_t - f * d_n, d_t.max(f * d_n)) * state.p;
                    let raw = pair.tangential.map_or(0.0, |joint| state.force[joint]);
                    let x_t = if z_t > 0.0 {
                        0.0 - bound
                    } else if z_t < 0.0 || (raw - bound).abs() <= NOISE * largest {
                        bound
                    } else if (raw + bound).abs() <= NOISE * largest {
                        0.0 - bound
                    } else {
                        drop_noise(raw, largest)
                    };
                    (bound, x_t)
                }
            };
            let slip = if z_t > 0.0 {
                State::SlipPlus
            } else if z_t < 0.0 {
                State::SlipMinus
            } else {
                State::Stick
            };
            let (word, held) = match pair.law {
                _ if open => (State::Open, (bound > 0.0).then_some(slip)),
                Law::Frictionless { .. } => (State::Closed, None),
                _ => (slip, None),
            };
            let frictionless = matches!(pair.law, Law::Frictionless { .. });
            PairState {
                id: pair.id.clone(),
                law: pair.law.name(),
                state: word,
                held,
                x_n,
                x_t,
                z_n,
                z_t,
                bound,
                reserve_plus: if frictionless { 0.0 } else { bound + x_t },
                reserve_minus: if frictionless { 0.0 } else { bound - x_t },
                position: pair.position,
            }
        })
        .collect()
}

fn drop_noise(value: f64, size: f64) -> f64 {
    if value.abs() <= NOISE * size { 0.0 } else { value }
}
