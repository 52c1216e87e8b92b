//! Two plates 8 × 4, the upper one free on the lower one (Popov & Lovtsov 2020, Example 3).
//!
//! ```text
//!         ▼ ▼ ▼ ▼ q = 100 ▼ ▼ ▼
//!      ┌──────────────────────────┐
//!  T ─▶│                          │ 4
//!  T ─▶│           upper          │
//!      ├●─●─●─●─●─●─●─●─●─●─●─●─●─┤     17 pairs, distance 0.5
//!      │           lower          │ 4
//!      └──────────────────────────┘
//!      ▓▓▓▓▓▓▓▓▓▓▓▓ 8 ▓▓▓▓▓▓▓▓▓▓▓▓▓
//! ```
//!
//! Sliding: 4 T = 8 f q, T = 200 f, p = (4 T − 800 f)/(17 d_τ). Overturning about the right end of the joint (f > 2):
//! 4 T·2 = 800·4, T = 400; the lever arms of the pairs sum to 68, so p = (8 T − 3200)/68.

use serde_json::json;
use stickslip::answer::record::OutcomeKind;
use stickslip::model::rules::Covering;

use crate::common::*;

const COVERINGS: [Covering; 2] = [Covering::Cohesive, Covering::Weight];

fn d_t(covering: Covering, f: f64) -> f64 {
    match covering {
        Covering::Cohesive => 1.0 + f,
        Covering::Ones => 1.0,
        Covering::Weight => f,
    }
}

#[test]
fn sliding_is_told_apart_at_one_part_in_1e9() {
    let case = Case::embedded("plates-free");
    for f in [0.3, 0.5, 0.75, 1.0, 1.5] {
        let limit = 200.0 * f;
        for rule in COVERINGS {
            for below in [0.5, 0.9, 1.0 - 1e-6, 1.0 - 1e-9] {
                let answer = case.solve_under(&[("f", f), ("T", limit * below)], covering(rule));
                assert!(answer.ray.is_none(), "f = {f}, ×{below}, {rule}: {:?}", answer.ray);
                is_answer(&answer);
            }
            for (beyond, tolerance) in [(1.0 + 1e-9, 1e-5), (1.0 + 1e-6, 1e-7), (1.01, 1e-9), (1.1, 1e-9)] {
                let push = limit * beyond;
                let answer = case.solve_under(&[("f", f), ("T", push)], covering(rule));
                let ray = mechanism(&answer);
                let expected = (4.0 * push - 800.0 * f) / (17.0 * d_t(rule, f));
                close(&format!("p, f = {f}, ×{beyond}, {rule}"), ray.p, expected, tolerance);
                for pair in ray.direction.pairs() {
                    near("z̄_τ", pair.z_t.scalar(), 1.0, 1e-9, 1.0);
                    near("z̄_n", pair.z_n, 0.0, 1e-9, 1.0);
                }
            }
        }
    }
}

#[test]
fn overturning_is_told_apart_at_one_part_in_1e9() {
    let case = Case::embedded("plates-free");
    for f in [2.2, 2.5, 3.0] {
        for rule in COVERINGS {
            for below in [0.9, 1.0 - 1e-6, 1.0 - 1e-9] {
                let answer = case.solve_under(&[("f", f), ("T", 400.0 * below)], covering(rule));
                assert_eq!(answer.outcome, OutcomeKind::Normal, "f = {f}, ×{below}, {rule}");
                is_answer(&answer);
            }
            for (beyond, tolerance) in [(1.0 + 1e-9, 1e-5), (1.0 + 1e-6, 1e-7), (1.01, 1e-9)] {
                let push = 400.0 * beyond;
                let answer = case.solve_under(&[("f", f), ("T", push)], covering(rule));
                let ray = mechanism(&answer);
                let expected = (8.0 * push - 3200.0) / 68.0;
                close(&format!("p, f = {f}, ×{beyond}, {rule}"), ray.p, expected, tolerance);
                for (i, pair) in ray.direction.pairs().iter().enumerate() {
                    near("z̄_n", pair.z_n, (16 - i) as f64 / 16.0, 1e-9, 1.0);
                    near("z̄_τ", pair.z_t.scalar(), 0.0, 1e-9, 1.0);
                }
            }
        }
    }
}

#[test]
fn printed_figures() {
    let case = Case::embedded("plates-free");
    for (push, rule, figure, unit) in [
        (60.00006, Covering::Weight, 4.7059e-5, 1e-9),
        (60.00006, Covering::Cohesive, 1.0860e-5, 1e-9),
        (100.0, Covering::Weight, 31.37255, 1e-5),
        (100.0, Covering::Cohesive, 7.23982, 1e-5),
    ] {
        let answer = case.solve_under(&[("f", 0.3), ("T", push)], covering(rule));
        printed("p", mechanism(&answer).p, figure, unit);
    }
    let slide = Case::embedded("plates-slide").solve(&[]);
    printed("p", mechanism(&slide).p, 1.0860e-5, 1e-9);
}

#[test]
fn exactly_at_the_limits() {
    let case = Case::embedded("plates-free");
    for (f, push) in [(0.3, 60.0), (0.75, 150.0), (1.5, 300.0)] {
        let answer = case.solve(&[("f", f), ("T", push)]);
        assert_eq!(answer.outcome, OutcomeKind::Normal, "f = {f}: {:?}", answer.ray);
        is_answer(&answer);
    }
    for f in [2.2, 2.5, 3.0] {
        let answer = case.solve(&[("f", f), ("T", 400.0)]);
        assert_eq!(answer.outcome, OutcomeKind::Normal, "f = {f}: {:?}", answer.ray);
        is_answer(&answer);
    }
}

#[test]
fn sizes() {
    let hinged = Case::embedded("plates-hinged").solve(&[]);
    is_answer(&hinged);
    assert_eq!(hinged.size.unknowns, Some(612));
    assert_eq!(hinged.size.free, Some(576));
    assert_eq!(hinged.size.pairs, 16);
    assert_eq!(hinged.size.lcp, 48);
    let free = Case::embedded("plates-free").solve(&[]);
    is_answer(&free);
    assert_eq!(free.size.unknowns, Some(612));
    assert_eq!(free.size.pairs, 17);
    assert_eq!(free.size.lcp, 51);
}

/// Two plates, one drawn on the other with nodes at the same places: nothing joins them, and it is said what would.
#[test]
fn a_plate_that_only_lies_on_another_is_told_so() {
    let plate = |id: &str, y: f64| json!({ "id": id, "origin": [0, y], "size": [2, 1], "divisions": [2, 1], "thickness": 1, "material": "m", "plane": "stress" });
    let text = scenario_text(json!({
        "materials": { "m": { "E": 1000, "nu": 0.2 } },
        "plates": [plate("slab", 0.0), plate("stem", 1.0)],
        "contacts": [{ "id": "c", "edge": "slab.bottom", "against": "ground", "friction": 0.5 }],
        "loads": { "w": { "items": [{ "point": { "at": "slab[0,1]", "force": [0, -1] } }] } }
    }));
    let scenario = stickslip::model::load::load_text("test", &text, None).expect("read");
    let Err(refused) = stickslip::solve::prepare(&scenario, &stickslip::watch::Quiet) else { panic!("to be refused") };
    let refused = refused.to_string();
    assert!(refused.contains("stem is free to move"), "{refused}");
    assert!(refused.contains("its node stem[0,0] lies on slab[0,1], which joins nothing by itself"), "{refused}");
}
