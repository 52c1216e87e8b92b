//! The next event on the way: the first limit that a pair reaches while everything moves at constant rates.

use nalgebra::DVector;

use super::rate_problem::Rates;
use super::standing::{Laws, Normal, Reached, Sense, Standing, Tangential, joint_scales};
use crate::lcp::problem::NOISE;

/// How far the rates hold, and the limits reached there; infinite and none where nothing ends them.
///
/// `sizes`: Σ |terms| of the load's rate. A limit at which a pair stands already is kept by the rate problem itself.
pub(super) fn next_event(
    laws: Laws<'_>,
    standing: &Standing,
    rates: &Rates,
    sizes: &DVector<f64>,
) -> (f64, Vec<Reached>) {
    let force_noise = laws.force_sizes(&rates.z, sizes) * NOISE;
    let length_noise = laws.length_sizes(&joint_scales(&laws.problem.system), &rates.z) * NOISE;
    let mut first = f64::INFINITY;
    let mut reached = Vec::new();
    let mut watch = |value: f64, rate: f64, noise: f64, limit: Reached| {
        if rate >= -noise {
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
    };
    for (i, pair) in laws.problem.system.pairs.iter().enumerate() {
        match standing.normal[i] {
            Normal::Open => watch(standing.z[i], rates.z[i], length_noise[i], Reached::Closing(i)),
            Normal::Closed => watch(standing.force[i], rates.force[i], force_noise[i], Reached::Opening(i)),
            Normal::Grazing | Normal::Bilateral => {}
        }
        let (Some(joint), false) = (pair.plane_tangential(), standing.tangential[i] == Tangential::Free) else {
            continue;
        };
        let f = if standing.is_open(i) { 0.0 } else { laws.friction(i) };
        let noise = force_noise[joint] + f * force_noise[i];
        for sense in Sense::BOTH.into_iter().filter(|&sense| !standing.at_limit(i, sense)) {
            let value = standing.bound(laws, i) + sense.sign() * standing.force[joint];
            let rate = f * rates.force[i] + sense.sign() * rates.force[joint];
            watch(value, rate, noise, Reached::Slipping(i, sense));
        }
    }
    (first, reached)
}
