//! Block on a slope (NAFEMS CGS-4).
//!
//! ```text
//!            ▼ G            tan α = 0.1, n = (−sin α, cos α), t = (cos α, sin α) up the slope
//!        ┌────────
//!   F ─▶ │   6 × 1.6        13 pairs
//!      ──┴─────── α
//! ```
//!
//! Along the slope F cos α − G sin α, across it N = G cos α + F sin α. It moves up at F/G = (tan α + μ)/(1 − μ tan α) =
//! 0.412371 and down at (tan α − μ)/(1 + μ tan α) = −0.194175; beyond, p = (|along| − μ N)/(13 d_τ).

use crate::common::*;

const TAN: f64 = 0.1;
const F: f64 = 0.3;

/// What is missing per pair, towards up (+1) or down (−1).
fn missing(force: f64, sign: f64) -> f64 {
    let cos = 1.0 / (1.0 + TAN * TAN).sqrt();
    let sin = TAN * cos;
    (sign * (force * cos - sin) - F * (cos + force * sin)) / (13.0 * (1.0 + F))
}

#[test]
fn limits_up_and_down() {
    let case = Case::embedded("slope");
    let up = (TAN + F) / (1.0 - F * TAN);
    let down = (TAN - F) / (1.0 + F * TAN);
    printed("up", up, 0.412371, 1e-6);
    printed("down", down, -0.194175, 1e-6);
    for inside in [0.4123, up * (1.0 - 1e-9), 0.2, 0.0, -0.1, down * (1.0 - 1e-9)] {
        let answer = case.solve(&[("F", inside)]);
        is_answer(&answer);
    }
    for (limit, sign) in [(up, 1.0), (down, -1.0)] {
        for (beyond, tolerance) in [(1.0 + 1e-9, 1e-5), (1.0 + 1e-6, 1e-7), (1.01, 1e-9), (1.1, 1e-9)] {
            let force = limit * beyond;
            let answer = case.solve(&[("F", force)]);
            let ray = mechanism(&answer);
            close(&format!("p at {force}"), ray.p, missing(force, sign), tolerance);
            for pair in ray.direction.pairs() {
                near("z̄_τ", pair.z_t.scalar(), sign, 1e-9, 1.0);
                near("z̄_n", pair.z_n, 0.0, 1e-9, 1.0);
            }
        }
    }
    mechanism(&case.solve(&[("F", 0.4124)]));
}
