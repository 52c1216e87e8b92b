//! The motions of loose parts to the last digit: what they do to each joint, in numbers that nothing was rounded in.
//!
//! A part that only an oblique spring holds can turn about its anchor and slide across it. Of that, f64 numbers know all
//! but the last digits, and then the rotation moves the anchor by these: enough that no sum of such motions leaves the
//! pair there at rest. Here the equations of what holds the parts are solved exactly, next to the motions that f64 found.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use super::exact_equations::{Equations, Solved};
use crate::fem::Traces;
use crate::lcp::exact::dyadic::Dyadic;

/// Time to solve the equations of all parts.
const BUDGET: Duration = Duration::from_secs(1);
/// An exact motion lies this close to that of f64, as a share of its largest amount; where what holds the parts leaves it
/// only by rounding there is none.
const NEAR: f64 = 1e-6;
/// A sum below this multiple of the magnitudes of its terms is zero.
pub(super) const ZERO: f64 = 8.0 * f64::EPSILON;

/// Of each joint the motions that move it, and by how much; `None` where the equations have fewer solutions than f64 found,
/// or are too many.
pub(super) fn exact_motions(traces: &[Traces], joints: usize) -> Option<Vec<Vec<(usize, Dyadic)>>> {
    let end = Instant::now() + BUDGET;
    let mut moved = vec![Vec::new(); joints];
    let mut motion = 0;
    for Traces { rows, near, joints } in traces {
        let mut equations = Equations::new(near.nrows(), end);
        rows.iter().for_each(|row| equations.add(summed(row)));
        let joints: Vec<(usize, BTreeMap<usize, Dyadic>)> =
            joints.iter().map(|(joint, row)| (*joint, summed(row))).collect();
        for near in near.column_iter() {
            let near: Vec<f64> = near.iter().copied().collect();
            let amounts = match equations.nearest(&near) {
                Solved::Free => near.iter().map(|amount| Dyadic::from(*amount)).collect(),
                Solved::Exactly(exact) => exact,
                Solved::OutOfTime => return None,
            };
            if !is_near(&amounts, &near) {
                return None;
            }
            for (joint, row) in &joints {
                let parts: Vec<Dyadic> = row.iter().map(|(unknown, a)| a.times(&amounts[*unknown])).collect();
                if let Some(sum) = unless_rounding(&parts) {
                    moved[*joint].push((motion, sum));
                }
            }
            motion += 1;
        }
    }
    Some(moved)
}

/// The coefficients of a row.
fn summed(row: &[(usize, f64)]) -> BTreeMap<usize, Dyadic> {
    let mut parts: BTreeMap<usize, Vec<Dyadic>> = BTreeMap::new();
    row.iter().for_each(|(unknown, a)| parts.entry(*unknown).or_default().push(Dyadic::from(*a)));
    parts.into_iter().filter_map(|(unknown, parts)| Some((unknown, unless_rounding(&parts)?))).collect()
}

/// The sum of terms; `None` where it is no more than what the rounding of the data leaves of a zero: the weights of a pair
/// between edges that do not match, or the direction of a spring along a bar.
fn unless_rounding(parts: &[Dyadic]) -> Option<Dyadic> {
    let sum = parts.iter().fold(Dyadic::default(), |sum, part| sum.plus(part));
    let magnitude: f64 = parts.iter().map(|part| part.to_f64().abs()).sum();
    (sum.to_f64().abs() > ZERO * magnitude).then_some(sum)
}

/// Whether amounts are, but for a factor between 1/2 and 1, those found in f64.
fn is_near(amounts: &[Dyadic], near: &[f64]) -> bool {
    let amounts: Vec<f64> = amounts.iter().map(Dyadic::to_f64).collect();
    let Some(largest) = (0..near.len()).max_by(|&a, &b| near[a].abs().total_cmp(&near[b].abs())) else { return false };
    let factor = amounts[largest] / near[largest];
    let size = near[largest].abs();
    factor > 0.25 && amounts.iter().zip(near).all(|(a, near)| (a - factor * near).abs() <= NEAR * factor * size)
}
