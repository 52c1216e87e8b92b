//! Structures at the edge of the format: no contacts, no load, one pair, one node, everything bound.

use serde_json::json;
use stickslip::answer::record::{OutcomeKind, State};
use stickslip::model::rules::Rules;

use super::balance::check;
use crate::common::*;

/// Cantilever of length 2 with EI = 10, load P at its tip, and whatever contacts.
fn cantilever(contacts: serde_json::Value, load: f64) -> Case {
    Case::json(json!({
        "materials": { "m": { "E": 1e6, "nu": 0.3 } },
        "sections": { "s": { "area": 0.01, "inertia": 1e-5 } },
        "nodes": { "A": [0, 0], "B": [2, 0] },
        "bars": [{ "id": "b", "nodes": ["A", "B"], "material": "m", "section": "s", "divisions": 3 }],
        "supports": [{ "at": "A", "fixed": ["x", "y", "r"] }],
        "contacts": contacts,
        "loads": { "load": { "items": [{ "point": { "at": "B", "force": [0, -load] } }] } }
    }))
}

#[test]
fn without_contacts_it_is_a_linear_structure() {
    for contacts in [json!([]), json!(null)] {
        if contacts.is_null() {
            continue;
        }
        let case = cantilever(contacts, 3.0);
        assert!(check(&case, &[], Rules::default()));
        let answer = case.solve(&[]);
        assert_eq!(answer.outcome, OutcomeKind::Trivial);
        assert!(answer.pairs.is_empty() && answer.pivots.is_empty());
        assert_eq!(answer.size.lcp, 0);
        let u = displacement(&answer, "B");
        close("u_y", u[1], -3.0 * 8.0 / (3.0 * 10.0), 1e-9);
        close("θ", u[2], -3.0 * 4.0 / (2.0 * 10.0), 1e-9);
        let root = answer.members.as_ref().unwrap()[0].start;
        close("M", root.m, -6.0, 1e-9);
        close("Q", root.q, 3.0, 1e-9);
        let clamp = &answer.reactions.as_ref().unwrap()[0];
        close("reaction", clamp.fy, 3.0, 1e-9);
        close("reaction moment", clamp.m, 6.0, 1e-9);
    }
}

#[test]
fn without_load_nothing_happens() {
    for law in ["coulomb", "frictionless"] {
        let mut contact = json!([{ "id": "c", "node": "B", "against": "ground", "normal": [0, 1], "law": law }]);
        for gap in [0.0, 0.1] {
            contact[0]["gap"] = gap.into();
            let case = cantilever(contact.clone(), 0.0);
            let answer = case.solve(&[]);
            is_answer(&answer);
            let pair = &answer.pairs[0];
            near("z_n", pair.z_n, gap, 1e-9, 1.0);
            assert_eq!((pair.x_n, pair.x_t, pair.z_t), (0.0, 0.0, 0.0), "{pair:?}");
            assert_eq!(displacement(&answer, "B"), [0.0; 3]);
            assert!(check(&case, &[], Rules::default()));
        }
    }
    for name in ["beam", "block", "plates-free", "greco", "slope", "frame"] {
        let case = Case::embedded(name);
        let zero: Vec<(&str, f64)> =
            case.scenario.parameters.keys().filter(|name| *name != "f").map(|name| (name.as_str(), 0.0)).collect();
        if name == "greco" || name == "frame" || name == "block" {
            continue; // their weight has no parameter
        }
        for rules in all_rules() {
            let answer = case.solve_under(&zero, rules);
            is_answer(&answer);
            assert_eq!(answer.outcome, OutcomeKind::Trivial);
            assert!(answer.pairs.iter().all(|p| p.x_n == 0.0 && p.z_n == 0.0 && p.z_t == 0.0));
        }
    }
}

#[test]
fn a_single_pair_under_a_cantilever() {
    // Prop under the tip: x_n = P, nothing moves; lifted: open.
    for (load, state) in [(3.0, State::Stick), (-3.0, State::Open)] {
        let contact = json!([{ "id": "c", "node": "B", "against": "ground", "normal": [0, 1], "friction": 0.3 }]);
        let case = cantilever(contact, load);
        assert!(check(&case, &[], Rules::default()));
        let answer = case.solve(&[]);
        assert_eq!(answer.pairs[0].state, state);
        if load > 0.0 {
            close("x_n", answer.pairs[0].x_n, load, 1e-9);
        } else {
            close("z_n", answer.pairs[0].z_n, 0.8, 1e-9);
        }
    }
}

#[test]
fn a_node_held_by_its_pair_only() {
    // A point without stiffness, tied to another that has none either (a lone node would be refused): friction holds
    // it, or it flies. A structure needs some element: a spring elsewhere.
    let case = Case::json(json!({
        "parameters": { "Fx": 0.0, "Fy": -2.0 },
        "nodes": { "P": [0, 0], "P2": [0, 0], "Q": [1, 0] },
        "ties": [{ "nodes": ["P", "P2"] }],
        "springs": [{ "at": "Q", "direction": [0, 1], "stiffness": 1 }],
        "supports": [{ "at": "Q", "fixed": ["x"] }],
        "contacts": [{ "id": "c", "node": "P", "against": "ground", "normal": [0, 1], "friction": 0.5 }],
        "loads": {
            "x": { "factor": "Fx", "items": [{ "point": { "at": "P", "force": [1, 0] } }] },
            "y": { "factor": "Fy", "items": [{ "point": { "at": "P", "force": [0, 1] } }] }
        }
    }));
    for fx in [0.0, 0.5, -1.0, 1.0] {
        assert!(check(&case, &[("Fx", fx)], Rules::default()));
        let answer = case.solve(&[("Fx", fx)]);
        near_all("x", &[answer.pairs[0].x_n, answer.pairs[0].x_t], &[2.0, -fx], 1e-9);
    }
    for (fx, fy, p) in [(1.3, -2.0, 0.3 / 1.5), (-4.0, -2.0, 3.0 / 1.5), (0.0, 1.0, 1.0)] {
        let answer = case.solve(&[("Fx", fx), ("Fy", fy)]);
        close("p", mechanism(&answer).p, p, 1e-9);
    }
}

#[test]
fn bound_pairs_alone() {
    // A bar sliding against a known bound: u = (P − b) l/EA where P > b.
    let case = Case::json(json!({
        "parameters": { "P": 5.0 },
        "materials": { "m": { "E": 1e6, "nu": 0.3 } },
        "sections": { "s": { "area": 0.01, "inertia": 1e-5 } },
        "nodes": { "A": [0, 0], "B": [2, 0] },
        "bars": [{ "id": "b", "nodes": ["A", "B"], "kind": "truss", "material": "m", "section": "s" }],
        "supports": [{ "at": "A", "fixed": ["x", "y"] }],
        "contacts": [{ "id": "c", "node": "B", "against": "ground", "normal": [0, 1], "law": "bound", "bound": 2.0 }],
        "loads": { "pull": { "factor": "P", "items": [{ "point": { "at": "B", "force": [1, 3] } }] } }
    }));
    for (load, slip, x_t) in [(5.0, 6e-4, -2.0), (-5.0, -6e-4, 2.0), (1.0, 0.0, -1.0), (2.0, 0.0, -2.0)] {
        assert!(check(&case, &[("P", load)], Rules::default()));
        let answer = case.solve(&[("P", load)]);
        let pair = &answer.pairs[0];
        near("slip", pair.z_t, slip, 1e-9, 1e-3);
        close("x_τ", pair.x_t, x_t, 1e-9);
        // The normal joint stays on: it pulls as well as presses.
        close("x_n", pair.x_n, -3.0 * load, 1e-9);
        assert_eq!(pair.z_n, 0.0);
    }
}

#[test]
fn the_same_pair_order_and_units_of_the_report() {
    let answer = Case::embedded("beam").solve(&[]);
    let ids: Vec<&str> = answer.pairs.iter().map(|p| p.id.as_str()).collect();
    assert_eq!(ids, ["c1", "c2", "c3", "c4", "c5", "c6"]);
    for pair in &answer.pairs {
        near("x⁺ + x⁻", pair.reserve_plus + pair.reserve_minus, 2.0 * pair.bound, 1e-12, 100.0);
        near("x⁺ − x⁻", pair.reserve_plus - pair.reserve_minus, 2.0 * pair.x_t, 1e-12, 100.0);
    }
}

/// A plate in plane strain whose bulk stiffness is 1/(1 − 2ν) = 5e10 of its shear stiffness: the digits that are left do not
/// show the loads, and what is said of it names the material beside a motion.
#[test]
fn a_material_next_to_incompressible_is_not_told_as_a_motion_alone() {
    let answer = Case::json(json!({
        "materials": { "s": { "E": 1, "nu": 0.49999999999 } },
        "plates": [{ "id": "u", "origin": [0, 0], "size": [1, 1], "divisions": [2, 2], "thickness": 1, "material": "s", "plane": "strain" }],
        "contacts": [{ "id": "j", "edge": "u.bottom", "against": "ground", "friction": 0.5 }],
        "loads": { "w": { "items": [{ "point": { "at": "u.top", "force": [0.2, -1] } }] } }
    }))
    .solve(&[]);
    let said = answer.failure.expect("rounding hides the loads");
    assert!(said.contains("stiffnesses too far apart") && said.contains("Poisson's ratio next to 0.5"), "{said}");
}
