//! Cantilever above a stop.
//!
//! ```text
//!   ▐│                       ▼ P
//!   ▐│───────────────────────●         L = 4, EI = 2.1e4
//!   ▐│                       ┊ g
//!                            ▲
//! ```
//!
//! Tip without the stop: P L³/(3EI). Once the gap is closed the stop carries P − 3 EI g/L³.

use stickslip::answer::record::State;

use crate::common::*;

const EI: f64 = 2.1e4;
const L: f64 = 4.0;

#[test]
fn the_stop_carries_what_is_left_after_the_gap() {
    let case = Case::embedded("gap");
    let answer = case.solve(&[]);
    is_answer(&answer);
    close("x_n", answer.pairs[0].x_n, 30.3125, 1e-9);
    for (load, gap) in [(50.0, 0.0), (50.0, 0.02), (50.0, 0.05), (100.0, 0.1), (7.0, 0.001)] {
        let answer = case.solve(&[("P", load), ("g", gap)]);
        is_answer(&answer);
        let carried = load - 3.0 * EI * gap / L.powi(3);
        close("x_n", answer.pairs[0].x_n, carried, 1e-9);
        assert_eq!(answer.pairs[0].state, State::Closed);
        assert_eq!(answer.pairs[0].z_n, 0.0);
        near("u_y", displacement(&answer, "tip")[1], -gap, 1e-9, 0.05);
        let clamp = &answer.reactions.as_ref().unwrap()[0];
        near("reaction", clamp.fy, load - carried, 1e-9, load);
        near("moment", clamp.m, (load - carried) * L, 1e-9, load * L);
    }
}

#[test]
fn a_wider_gap_stays_open_by_the_difference() {
    let case = Case::embedded("gap");
    let free = 50.0 * L.powi(3) / (3.0 * EI);
    for gap in [0.051, 0.06, 0.1, 1.0] {
        let answer = case.solve(&[("g", gap)]);
        is_answer(&answer);
        let pair = &answer.pairs[0];
        assert_eq!(pair.state, State::Open);
        assert_eq!(pair.x_n, 0.0);
        close("z_n", pair.z_n, gap - free, 1e-9);
        close("u_y", displacement(&answer, "tip")[1], -free, 1e-9);
    }
}

// R comes from terms 256 times as large (the last element alone): a force of 1e-9 P keeps four digits.
#[test]
fn around_the_gap_that_just_closes() {
    let case = Case::embedded("gap");
    let free = 50.0 * L.powi(3) / (3.0 * EI);
    let closed = case.solve(&[("g", free * (1.0 - 1e-9))]);
    assert_eq!(closed.pairs[0].state, State::Closed);
    near("x_n", closed.pairs[0].x_n, 50.0 * 1e-9, 1e-3, 50.0 * 1e-9);
    let open = case.solve(&[("g", free * (1.0 + 1e-9))]);
    assert_eq!(open.pairs[0].state, State::Open);
    near("z_n", open.pairs[0].z_n, free * 1e-9, 1e-3, free * 1e-9);
}
