//! Half of a block pressed and pushed on a rigid rough base (GRECO; Code_Aster SSNV128A).
//!
//! ```text
//!           ▼ ▼ ▼ 5e7 ▼ ▼ ▼
//!          ┌───────────────┐▐
//!   15e7 ─▶│  0.04 × 0.04  │▐  u_x = 0 (symmetry)
//!        ─▶│  E = 1.3e11   │▐
//!          └●─●─●─●─●─●─●─●┘▐
//!          32 pairs         corner fixed
//! ```
//!
//! Computed independently: base u_x in 1e-5 m at x = 0, 1.25, 5, 7.5, 11.25 mm; 3 open, 22 slip +, 7 stick at f = 1.

use stickslip::answer::record::{OutcomeKind, State};
use stickslip::model::rules::Covering;

use crate::common::*;

#[test]
fn displacements_of_the_base() {
    let answer = Case::embedded("greco").solve(&[]);
    is_answer(&answer);
    for (i, figure) in [(0, 2.84594), (1, 2.70792), (4, 2.27403), (6, 1.97271), (9, 1.53642)] {
        let ux = displacement(&answer, &format!("block[{i},0]"))[0];
        printed(&format!("u_x of node {i}"), ux * 1e5, figure, 1e-5);
        near("slip", answer.pairs[i].z_t, ux, 1e-9, 1e-5);
    }
    assert_eq!(count(&answer, State::Open), 3);
    assert_eq!(count(&answer, State::SlipPlus), 22);
    assert_eq!(count(&answer, State::Stick), 7);
}

#[test]
fn solved_for_every_friction_under_the_default_rules() {
    let case = Case::embedded("greco");
    for k in 0..=40 {
        let f = 0.25 * f64::from(k);
        let answer = case.solve(&[("f", f)]);
        is_answer(&answer);
    }
}

#[test]
fn ones_ends_in_a_ray_above_one() {
    let case = Case::embedded("greco");
    for f in [1.01, 1.1, 1.5, 2.0, 5.0, 10.0] {
        let answer = case.solve_under(&[("f", f)], covering(Covering::Ones));
        assert_eq!(answer.outcome, OutcomeKind::Ray, "f = {f}");
    }
    for f in [0.3, 0.9] {
        is_answer(&case.solve_under(&[("f", f)], covering(Covering::Ones)));
    }
}
