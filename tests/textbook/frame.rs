//! Clamped frame on three frictional supports (like Popov & Lovtsov 2020, Example 2).
//!
//! ```text
//!   ▐     30          40          20
//!   ▐│     ▼           ▼           ▼
//!   ▐│─────┼─────●─────┼─────●─────┼─────●──▶ 30     EA = 2.1e6, EI = 2.1e4
//!   ▐            ▲           ▲           ▲ (or turned by 45°)
//!   0     2     4     6     8     10    12
//! ```
//!
//! With vertical supports x_n does not depend on f; S_k = sum of x_n from support k to the end. Support k slips while
//! 30 > f S_k, its slip grows by (30 − f S_k)·4/EA from that of support k − 1.

use stickslip::answer::record::State;

use crate::common::*;

const NORMAL: [f64; 3] = [36.44231, 34.32692, 5.52885];

#[test]
fn vertical_supports() {
    let case = Case::embedded("frame");
    for (f, slips) in
        [(0.1, [0.04261, 0.092161, 0.148251]), (0.3, [0.013544, 0.047912, 0.101896]), (0.6, [0.0, 0.011593, 0.062418])]
    {
        let answer = case.solve(&[("f", f)]);
        is_answer(&answer);
        let x: Vec<f64> = of_pairs(&answer, |p| p.x_n);
        let mut slip = 0.0;
        for k in 0..3 {
            printed("x_n", x[k], NORMAL[k], 1e-5);
            printed("slip in mm", answer.pairs[k].z_t * 1e3, slips[k], if k == 0 && f < 0.2 { 1e-5 } else { 1e-6 });
            let rest = 30.0 - f * x[k..].iter().sum::<f64>();
            slip += rest.max(0.0) * 4.0 / 2.1e6;
            near("slip by the formula", answer.pairs[k].z_t, slip, 1e-9, 1e-4);
        }
    }
}

#[test]
fn vertical_breakpoints() {
    let case = Case::embedded("frame");
    for (k, figure) in [(0, 0.39319471), (1, 0.75271411), (2, 5.42608696)] {
        let below = case.solve(&[("f", figure - 1e-8)]);
        let above = case.solve(&[("f", figure + 1e-8)]);
        is_answer(&below);
        is_answer(&above);
        assert_eq!(below.pairs[k].state, State::SlipPlus);
        assert_eq!(above.pairs[k].state, State::Stick);
        // The formula itself, to 1e-9.
        let exact = 30.0 / below.pairs[k..].iter().map(|p| p.x_n).sum::<f64>();
        printed("breakpoint", exact, figure, 1e-8);
        for (f, state) in [(exact * (1.0 - 1e-9), State::SlipPlus), (exact * (1.0 + 1e-9), State::Stick)] {
            assert_eq!(case.solve(&[("f", f)]).pairs[k].state, state);
        }
    }
    let all_stick = case.solve(&[("f", 5.5)]);
    assert_eq!(count(&all_stick, State::Stick), 3);
}

#[test]
fn turned_support() {
    let case = Case::embedded("frame-rotated");
    let answer = case.solve(&[("f", 0.1)]);
    is_answer(&answer);
    for (k, (x_n, slip, unit)) in
        [(36.54445, 0.030659, 1e-6), (34.19073, 0.06828, 1e-5), (8.78137, 0.158975, 1e-6)].into_iter().enumerate()
    {
        printed("x_n", answer.pairs[k].x_n, x_n, 1e-5);
        printed("slip in mm", answer.pairs[k].z_t * 1e3, slip, unit);
    }
    let slipping = |f: f64| {
        let answer = case.solve(&[("f", f)]);
        is_answer(&answer);
        3 - count(&answer, State::Stick)
    };
    for (breakpoint, before) in [(0.28331450, 3), (0.44932055, 2), (0.68876861, 1)] {
        assert_eq!(slipping(breakpoint - 1e-8), before);
        assert_eq!(slipping(breakpoint + 1e-8), before - 1);
    }
}
