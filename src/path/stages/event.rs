//! The next event on the way: the first limit that a pair reaches while everything moves at constant rates.

use nalgebra::DVector;

use super::rate_problem::Rates;
use super::standing::{Laws, Normal, Reached, Sense, Standing, Tangential, joint_scales};
use crate::lcp::problem::NOISE;

/// How far the rates hold on the way that is `left`, and the limits reached there.
///
/// `sizes`: Σ |terms| of the load's rate. A limit at which a pair stands already is kept by the rate problem itself. Limits that
/// the end of the way is at but for the rounding of what they are told by are reached there: which comes a little before it, or
/// behind it, nothing tells.
pub(super) fn next_event(
    laws: Laws<'_>,
    standing: &Standing,
    rates: &Rates,
    (sizes, left): (&DVector<f64>, f64),
) -> (f64, Vec<Reached>) {
    let force_noise = laws.force_sizes(&rates.z, sizes) * NOISE;
    let length_noise = laws.length_sizes(&joint_scales(&laws.problem.system), &rates.z) * NOISE;
    let (mut first, mut is_before) = (f64::INFINITY, false);
    let (mut reached, mut at_end) = (Vec::new(), Vec::new());
    // Of what tells a limit: its value, its rate, and the rounding of both.
    let mut watch = |value: f64, rate: f64, [noise, rate_noise]: [f64; 2], limit: Reached| {
        if rate >= -rate_noise {
            return;
        }
        let step = value.max(0.0) / -rate;
        if step < first {
            first = step;
            reached.clear();
        }
        if step == first {
            reached.push(limit);
        }
        let last = value + left * rate;
        is_before |= last < -noise;
        if last <= noise {
            at_end.push(limit);
        }
    };
    for (i, pair) in laws.problem.system.pairs.iter().enumerate() {
        match standing.normal[i] {
            Normal::Open => {
                watch(standing.z[i], rates.z[i], [standing.length_noise(i), length_noise[i]], Reached::Closing(i));
            }
            Normal::Closed => {
                watch(
                    standing.force[i],
                    rates.force[i],
                    [standing.force_noise(i), force_noise[i]],
                    Reached::Opening(i),
                );
            }
            Normal::Grazing | Normal::Bilateral => {}
        }
        let (Some(joint), false) = (pair.plane_tangential(), standing.tangential[i] == Tangential::Free) else {
            continue;
        };
        let f = if standing.is_open(i) { 0.0 } else { laws.friction(i) };
        let noise = [standing.force_noise(joint), force_noise[joint]];
        let noise = [noise[0] + f * standing.force_noise(i), noise[1] + f * force_noise[i]];
        for sense in Sense::BOTH.into_iter().filter(|&sense| !standing.at_limit(i, sense)) {
            let value = standing.bound(laws, i) + sense.sign() * standing.force[joint];
            let rate = f * rates.force[i] + sense.sign() * rates.force[joint];
            watch(value, rate, noise, Reached::Slipping(i, sense));
        }
    }
    if is_before { (first, reached) } else { (left, at_end) }
}
