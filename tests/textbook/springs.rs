//! Springs between nodes and springs against rotation.

use serde_json::json;

use crate::common::*;

const EI: f64 = 200.0;
const L: f64 = 4.0;

/// Two cantilevers tip to tip, coupled by a spring across them; F on one of them:
/// v₁ − v₂ = F c/(1 + 2 k c) with c = L³/3EI, v₁ + v₂ = F c. Turned by 90° as well.
#[test]
fn a_spring_between_two_cantilevers() {
    let (c, k, f) = (L.powi(3) / (3.0 * EI), 5.0, 2.0);
    for turned in [false, true] {
        let place = |x: f64, y: f64| if turned { json!([-y, x]) } else { json!([x, y]) };
        let case = Case::json(json!({
            "materials": { "m": { "E": EI, "nu": 0.2 } },
            "sections": { "s": { "area": 1, "inertia": 1 } },
            "nodes": { "a": place(0.0, 0.0), "b": place(L, 0.0), "c": place(L, 1.0), "d": place(2.0 * L, 1.0) },
            "bars": [{ "id": "ab", "nodes": ["a", "b"], "material": "m", "section": "s" },
                     { "id": "cd", "nodes": ["c", "d"], "material": "m", "section": "s" }],
            "supports": [{ "at": "a", "fixed": ["x", "y", "r"] }, { "at": "d", "fixed": ["x", "y", "r"] }],
            "springs": [{ "between": ["b", "c"], "direction": place(0.0, 3.0), "stiffness": k }],
            "loads": { "w": { "items": [{ "point": { "at": "b", "force": place(0.0, -f) } }] } }
        }));
        let answer = case.solve(&[]);
        is_answer(&answer);
        let across = |node: &str| {
            let u = displacement(&answer, node);
            if turned { -u[0] } else { u[1] }
        };
        close("difference", across("b") - across("c"), -f * c / (1.0 + 2.0 * k * c), 1e-11);
        close("sum", across("b") + across("c"), -f * c, 1e-11);
        // What stays inside the structure is not a reaction.
        assert_eq!(answer.reactions.as_ref().unwrap().len(), 2);
    }
}

/// Cantilever on a rotational spring: θ₀ = F L/k, tip F L³/3EI + F L²/k; the spring's moment is a reaction. And two bars
/// of a beam joined by one: a clamped beam with a rotational spring at its middle under F there: each half has a guided
/// end with spring 2k to the symmetry plane, v = F L³/24EI (1 + 3 s)/… by the slope condition M = 2 k θ.
#[test]
fn springs_against_rotation() {
    let (k, f) = (30.0, 2.0);
    let bar = |id: &str, a: &str, b: &str| json!({ "id": id, "nodes": [a, b], "material": "m", "section": "s" });
    let case = Case::json(json!({
        "materials": { "m": { "E": EI, "nu": 0.2 } },
        "sections": { "s": { "area": 1, "inertia": 1 } },
        "nodes": { "a": [0, 0], "b": [L, 0] },
        "bars": [bar("ab", "a", "b")],
        "supports": [{ "at": "a", "fixed": ["x", "y"] }],
        "springs": [{ "at": "a", "rotation": k }],
        "loads": { "w": { "items": [{ "point": { "at": "b", "force": [0, -f] } }] } }
    }));
    let answer = case.solve(&[]);
    is_answer(&answer);
    close("tip", displacement(&answer, "b")[1], -f * (L.powi(3) / (3.0 * EI) + L * L / k), 1e-11);
    let reaction = &answer.reactions.as_ref().unwrap()[0];
    close("moment", reaction.m, f * L, 1e-11);
    close("force", reaction.fy, f, 1e-11);

    // Halves of length L, tied in x and y at the middle, turning apart against the spring. Half: tip force F/2 and a
    // moment M = −k (θ₂ − θ₁) with θ₂ = −θ₁ = θ by symmetry: θ₁ = −F L²/4EI + M L/EI, M = 2 k θ₁ against it.
    let middle = Case::json(json!({
        "materials": { "m": { "E": EI, "nu": 0.2 } },
        "sections": { "s": { "area": 1, "inertia": 1 } },
        "nodes": { "a": [0, 0], "b": [L, 0], "c": [L, 0], "d": [2.0 * L, 0] },
        "bars": [bar("ab", "a", "b"), bar("cd", "c", "d")],
        "ties": [{ "nodes": ["b", "c"] }],
        "supports": [{ "at": "a", "fixed": ["x", "y", "r"] }, { "at": "d", "fixed": ["x", "y", "r"] }],
        "springs": [{ "between": ["b", "c"], "rotation": k }],
        "loads": { "w": { "items": [{ "point": { "at": "b", "force": [0, -f] } }] } }
    }));
    let answer = middle.solve(&[]);
    is_answer(&answer);
    let theta = -f * L * L / (4.0 * EI) / (1.0 + 2.0 * k * L / EI);
    close("rotation", displacement(&answer, "b")[2], theta, 1e-11);
    close("rotation", displacement(&answer, "c")[2], -theta, 1e-11);
    let moment = -2.0 * k * theta;
    close(
        "deflection",
        displacement(&answer, "b")[1],
        -f / 2.0 * L.powi(3) / (3.0 * EI) + moment * L * L / (2.0 * EI),
        1e-11,
    );
}

/// A block that only a spring to another, held, block keeps from sliding away: the spring is what makes it stand.
#[test]
fn a_spring_holds_a_loose_block() {
    let plate = |id: &str, y: f64| {
        json!({ "id": id, "origin": [0, y], "size": [2, 1], "divisions": [2, 1],
        "thickness": 1, "material": "m", "plane": "stress" })
    };
    let case = Case::json(json!({
        "materials": { "m": { "E": 1e6, "nu": 0.2 } },
        "plates": [plate("low", 0.0), plate("up", 1.0)],
        "supports": [{ "at": "low.bottom", "fixed": ["x", "y"] }],
        "springs": [{ "between": ["up[0,0]", "low[0,1]"], "direction": [1, 0], "stiffness": 10 }],
        "contacts": [{ "id": "joint", "edge": "up.bottom", "against": "low.top", "law": "frictionless" }],
        "loads": { "w": { "items": [{ "traction": { "edge": "up.top", "value": [0.5, -4] } }] } }
    }));
    let answer = case.solve(&[]);
    is_answer(&answer);
    let slide = displacement(&answer, "up[0,0]")[0] - displacement(&answer, "low[0,1]")[0];
    near("slide", slide, 1.0 / 10.0, 1e-4, 1.0);
}

/// A node at which the only bar is hinged has a rotation where something holds it: a spring from there to the other end of
/// a simple beam follows that end and carries nothing, M = 0 at both ends; one to the ground there carries nothing
/// either. Turned by φ by a support, the node pulls that end through the spring: M = k φ/(1 + k L/3EI), with which a
/// beam that is hinged there as well resists. In space the same.
#[test]
fn rotational_springs_at_hinges() {
    let (k, q, phi) = (30.0, 2.0, 0.01);
    let beam = |in_space: bool, springs: serde_json::Value, turned: bool| {
        let place = |x: f64| if in_space { json!([x, 0, 0]) } else { json!([x, 0]) };
        let section = match in_space {
            true => json!({ "area": 1, "inertia_y": 1, "inertia_z": 1, "torsion": 1 }),
            false => json!({ "area": 1, "inertia": 1 }),
        };
        let axes = |plane: serde_json::Value, space: serde_json::Value| if in_space { space } else { plane };
        let mut ends = axes(json!(["x", "y"]), json!(["x", "y", "z"])).as_array().unwrap().clone();
        let mut start = ends.clone();
        if in_space {
            start.push(json!("rx"));
        }
        let settled = turned.then(|| axes(json!([0, 0, phi]), json!([0, 0, 0, 0, 0, phi])));
        if turned {
            ends.push(axes(json!("r"), json!("rz")));
        }
        let mut support = json!({ "at": "b", "fixed": ends });
        if let Some(settled) = settled {
            support["settlement"] = settled;
            support["case"] = json!("w");
        }
        let line = axes(json!([0, -q]), json!([0, -q, 0]));
        let items = if turned { json!([]) } else { json!([{ "line": { "bar": "ab", "value": line } }]) };
        let mut scenario = json!({
            "materials": { "m": { "E": EI, "nu": 0.2 } },
            "sections": { "s": section },
            "nodes": { "a": place(0.0), "b": place(L) },
            "bars": [{ "id": "ab", "nodes": ["a", "b"], "material": "m", "section": "s", "hinges": ["end"] }],
            "supports": [{ "at": "a", "fixed": start }, support],
            "springs": springs,
            "loads": { "w": { "items": items } }
        });
        if in_space {
            scenario["dimension"] = json!(3);
        }
        Case::json(scenario).solve(&[])
    };
    for in_space in [false, true] {
        let turn = |answer: &stickslip::answer::record::Answer, node: &str| displacement(answer, node)[2];
        let about = |mut spring: serde_json::Value| {
            if in_space {
                spring["direction"] = json!([0, 0, 1]);
            }
            json!([spring])
        };
        let simple = -q * L.powi(3) / (24.0 * EI);
        for spring in [json!({ "between": ["a", "b"], "rotation": k }), json!({ "between": ["b", "a"], "rotation": k })]
        {
            let answer = beam(in_space, about(spring.clone()), false);
            is_answer(&answer);
            close("turn", turn(&answer, "a"), simple, 1e-11);
            close("follows", turn(&answer, "b"), simple, 1e-11);
            let answer = beam(in_space, about(spring), true);
            is_answer(&answer);
            let moment = k * phi / (1.0 + k * L / (3.0 * EI));
            close("turned", turn(&answer, "b"), phi, 1e-14);
            close("pulled", turn(&answer, "a"), moment * L / (3.0 * EI), 1e-11);
        }
        let answer = beam(in_space, about(json!({ "at": "b", "rotation": k })), false);
        close("grounded", turn(&answer, "a"), simple, 1e-11);
    }
}
