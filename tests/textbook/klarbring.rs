//! One pair with several answers (after Klarbring 1990).
//!
//! ```text
//!   R = [[1, −1], [−1, 1.5]]      RF = (0.6, −1)      f_crit = R_ττ/|R_nτ| = 1.5
//! ```
//!
//! f = 2: open z = (0.2, 0.8); stick x = (0.6, −1); slip + z_τ = 0.4, x = (0.2, −0.4). Below f_crit only the open one.

use stickslip::answer::record::State;

use crate::common::*;

#[test]
fn below_the_critical_friction_only_open() {
    let case = Case::embedded("klarbring");
    for f in [0.0, 0.5, 1.0, 1.4, 1.5, 1.6] {
        let answer = case.solve(&[("f", f)]);
        is_answer(&answer);
        let pair = &answer.pairs[0];
        assert_eq!(pair.state, State::Open, "f = {f}");
        close("z_n", pair.z_n, 0.2, 1e-9);
        close("z_τ", pair.z_t, 0.8, 1e-9);
        assert_eq!((pair.x_n, pair.x_t), (0.0, 0.0));
    }
}

#[test]
fn beyond_it_one_of_three_under_every_rule() {
    let case = Case::embedded("klarbring");
    for rules in all_rules() {
        let answer = case.solve_under(&[("f", 2.0)], rules);
        is_answer(&answer);
        let pair = &answer.pairs[0];
        let found = [pair.x_n, pair.x_t, pair.z_n, pair.z_t];
        let expected = match pair.state {
            State::Open => [0.0, 0.0, 0.2, 0.8],
            State::Stick => [0.6, -1.0, 0.0, 0.0],
            State::SlipPlus => [0.2, -0.4, 0.0, 0.4],
            other => panic!("{other:?}"),
        };
        near_all("pair", &found, &expected, 1e-9);
        // RF itself is admissible here, so the main system is the answer.
        assert_eq!(pair.state, State::Stick);
    }
}
