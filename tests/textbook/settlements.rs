//! Supports that move: the settlement of a load case times its factor.

use serde_json::json;
use stickslip::answer::record::State;

use crate::common::*;

const EI: f64 = 200.0;
const L: f64 = 4.0;

/// A cantilever propped at its end; the prop settles by δ: it is pulled down by 3EI δ/L³, M = −3EI δ/L² at the clamp.
/// The clamp turned by φ instead: M = 3EI φ/L there.
#[test]
fn a_propped_cantilever() {
    let case = |d: f64, phi: f64| {
        Case::json(json!({
            "parameters": { "d": d, "phi": phi },
            "materials": { "m": { "E": EI, "nu": 0.2 } },
            "sections": { "s": { "area": 1, "inertia": 1 } },
            "nodes": { "a": [0, 0], "b": [L, 0] },
            "bars": [{ "id": "ab", "nodes": ["a", "b"], "material": "m", "section": "s", "divisions": 3 }],
            "supports": [
                { "at": "a", "fixed": ["x", "y", "r"], "settlement": [0, 0, "phi"], "case": "turn" },
                { "at": "b", "fixed": ["y"], "settlement": [0, -1], "case": "soil" }
            ],
            "loads": { "soil": { "factor": "d", "items": [] }, "turn": { "items": [] } }
        }))
    };
    for (d, phi) in [(0.02, 0.0), (0.0, 0.01), (-0.03, 0.02)] {
        let answer = case(d, phi).solve(&[]);
        is_answer(&answer);
        near("b", displacement(&answer, "b")[1], -d, 1e-14, 1.0);
        near("a", displacement(&answer, "a")[2], phi, 1e-14, 1.0);
        let reactions = answer.reactions.as_ref().unwrap();
        // The end of the cantilever wants to go φ L − d further than it may.
        let prop = -3.0 * EI * (d + phi * L) / L.powi(3);
        near("prop", reactions[1].fy, prop, 1e-11, 1.0);
        near("clamp", reactions[0].m, -prop * L, 1e-11, 1.0);
    }
}

/// The same tip on a contact pair against a node that settles, and that node under a settling plate edge: δ > 0 lifts the
/// ground, x_n = 3EI δ/L³; δ < 0 leaves a gap of |δ|. The tangential joint carries what friction can.
#[test]
fn a_settling_node_as_ground() {
    let case = |d: f64| {
        Case::json(json!({
            "parameters": { "d": d },
            "materials": { "m": { "E": EI, "nu": 0.2 } },
            "sections": { "s": { "area": 1, "inertia": 1 } },
            "nodes": { "a": [0, 0], "b": [L, 0], "soil": [L, -1] },
            "bars": [{ "id": "ab", "nodes": ["a", "b"], "material": "m", "section": "s" }],
            "supports": [
                { "at": "a", "fixed": ["x", "y", "r"] },
                { "at": "soil", "fixed": ["x", "y"], "settlement": ["d/100", "d"], "case": "lift" }
            ],
            "contacts": [{ "id": "c", "node": "b", "against": "soil", "normal": [0, 1], "friction": 0.5 }],
            "loads": { "lift": { "items": [] } }
        }))
    };
    for d in [0.02, 0.001] {
        let answer = case(d).solve(&[]);
        is_answer(&answer);
        close("x_n", answer.pairs[0].x_n, 3.0 * EI * d / L.powi(3), 1e-11);
        // It is dragged along by d/100, which takes EA d/100 L < 0.5 x_n.
        assert_eq!(answer.pairs[0].state, State::Stick);
        close("x_t", answer.pairs[0].x_t, EI * d / 100.0 / L, 1e-11);
        close("dragged", displacement(&answer, "b")[0], d / 100.0, 1e-11);
    }
    let answer = case(-0.02).solve(&[]);
    is_answer(&answer);
    assert_eq!(answer.pairs[0].state, State::Open);
    close("z_n", answer.pairs[0].z_n, 0.02, 1e-11);
}

/// A block on an edge that settles as a whole only goes down with it; a tied pair of supports must settle alike.
#[test]
fn an_edge_settles_without_strain() {
    let model = |second: f64| {
        json!({
            "materials": { "m": { "E": 3e4, "nu": 0.2 } },
            "plates": [
                { "id": "p", "origin": [0, 0], "size": [2, 1], "divisions": [3, 2], "thickness": 1, "material": "m",
                  "plane": "strain" },
                { "id": "q", "origin": [2, 0], "size": [2, 1], "divisions": [3, 2], "thickness": 1, "material": "m",
                  "plane": "strain" }],
            "ties": [{ "nodes": ["p[3,0]", "q[0,0]"] }],
            "supports": [
                { "at": "p.bottom", "fixed": ["x", "y"], "settlement": [0.01, -0.02], "case": "soil" },
                { "at": "q.bottom", "fixed": ["x", "y"], "settlement": [0.01, second], "case": "soil" }],
            "loads": { "soil": { "factor": 2, "items": [] } }
        })
    };
    let answer = Case::json(model(-0.02)).solve(&[]);
    is_answer(&answer);
    for node in ["p[1,2]", "q[3,1]", "p[3,0]"] {
        near_all(node, &displacement(&answer, node)[..2], &[0.02, -0.04], 1e-13);
    }
    let scenario = stickslip::model::load::load_text("test", &scenario_text(model(-0.03)), None).unwrap();
    let error = stickslip::solve::prepare(&scenario, &stickslip::watch::Quiet).expect_err("unequal settlements");
    assert!(error.to_string().contains("by different amounts"), "{error}");
}

/// Work on a history with settlement: a beam over a settling prop stores ½·3EI δ²/L³ and nothing is left over.
#[test]
fn the_work_of_a_settlement_is_counted() {
    let case = Case::json(json!({
        "materials": { "m": { "E": EI, "nu": 0.2 } },
        "sections": { "s": { "area": 1, "inertia": 1 } },
        "nodes": { "a": [0, 0], "b": [L, 0], "soil": [L, -1] },
        "bars": [{ "id": "ab", "nodes": ["a", "b"], "material": "m", "section": "s" }],
        "supports": [{ "at": "a", "fixed": ["x", "y", "r"] },
                     { "at": "soil", "fixed": ["x", "y"], "settlement": [0, 1], "case": "lift" }],
        "contacts": [{ "id": "c", "node": "b", "against": "soil", "normal": [0, 1], "friction": 0.2 }],
        "loads": { "lift": { "items": [] } },
        "stages": [{ "lift": 0.03 }, { "lift": 0.01 }]
    }));
    let values = case.scenario.parameter_values();
    let history = stickslip::path::stages::follow(case.prepared.case(&case.scenario, &values))
        .unwrap_or_else(|error| panic!("{error}"));
    let stored = |d: f64| 1.5 * EI * d * d / L.powi(3);
    for (stage, right) in history.stages.iter().zip([stored(0.03), stored(0.01) - stored(0.03)]) {
        let energy = stage.energy.expect("a structure");
        near("work", energy.work, right, 1e-12, stored(0.03));
        near("stored", energy.stored, right, 1e-12, stored(0.03));
        assert!(energy.residual < 1e-12);
    }
}
