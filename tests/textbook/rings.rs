//! Closed edges: the node where one begins and ends is one node, wherever that is.

use serde_json::{Value, json};

use crate::common::*;

/// The boundary of a plate of 2 × 2 elements, from its node `start` on, counter-clockwise.
fn around(plate: &str, start: usize) -> Vec<String> {
    let ring = [[0, 0], [1, 0], [2, 0], [2, 1], [2, 2], [1, 2], [0, 2], [0, 1]];
    (0..=8).map(|k| ring[(start + k) % 8]).map(|[i, j]| format!("{plate}[{i},{j}]")).collect()
}

/// A square block in the square hole of a frame of eight quads, pressed in with an interference; the two rings begin at
/// `starts`, the outer one runs backwards if asked.
fn pressed_in(starts: [usize; 2], backwards: bool) -> Case {
    let mut nodes = json!({});
    let places = [[0, 0], [1, 0], [2, 0], [2, 1], [2, 2], [1, 2], [0, 2], [0, 1]].map(|p: [i32; 2]| p.map(f64::from));
    let mut quads = Vec::new();
    for k in 0..8 {
        let [x, y] = places[k];
        nodes[format!("h{k}")] = json!([x, y]);
        nodes[format!("o{k}")] = json!([3.0 * x - 2.0, 3.0 * y - 2.0]);
        let next = (k + 1) % 8;
        let ring = [format!("o{k}"), format!("o{next}"), format!("h{next}"), format!("h{k}")];
        quads.push(json!({ "id": format!("q{k}"), "nodes": ring, "thickness": 1, "material": "m", "plane": "stress" }));
    }
    // Round the hole the frame lies on the right of a way counter-clockwise.
    let mut hole: Vec<String> = (0..=8).map(|k| format!("h{}", (starts[1] + k) % 8)).collect();
    if backwards {
        hole.reverse();
    }
    Case::json(json!({
        "materials": { "m": { "E": 1000, "nu": 0.25 } },
        "nodes": nodes, "quads": quads,
        "plates": [{ "id": "p", "origin": [0, 0], "size": [2, 2], "divisions": [2, 2], "thickness": 1, "material": "m",
                     "plane": "stress" }],
        "edges": { "block": around("p", starts[0]), "hole": hole },
        "supports": [{ "at": "o0", "fixed": ["x", "y"] }, { "at": "o2", "fixed": ["y"] }],
        "contacts": [{ "id": "fit", "edge": "block", "against": "hole", "method": "nodes", "friction": 0.3, "gap": -0.01 }],
        "loads": { "none": { "items": [] } }
    }))
}

/// Eight pairs, each node with the one at its place; by symmetry the four corners carry the same force and the four
/// middles do, whatever node the rings begin with.
#[test]
fn a_ring_may_begin_anywhere() {
    let forces = |starts: [usize; 2], backwards: bool| {
        let case = pressed_in(starts, backwards);
        let answer = case.solve(&[]);
        is_answer(&answer);
        assert_eq!(answer.pairs.len(), 8);
        let mut around = of_pairs(&answer, |pair| pair.x_n);
        around.rotate_right(starts[0]);
        around
    };
    let right = forces([0, 0], false);
    for k in 0..8 {
        near("symmetry", right[k], right[k % 2], 1e-10, right[k]);
        assert!(right[k] > 0.0);
    }
    for (starts, backwards) in [([3, 0], false), ([0, 5], false), ([2, 7], true), ([6, 6], true)] {
        near_all(&format!("{starts:?} {backwards}"), &forces(starts, backwards), &right, 1e-10);
    }
}

/// What stands at every node of a closed edge stands at the first one once: springs, foundations (k times the perimeter
/// along each side), and pairs with the ground.
#[test]
fn a_closed_edge_counts_its_first_node_once() {
    let with = |what: Value| {
        let mut scenario = json!({
            "materials": { "m": { "E": 1e5, "nu": 0.25 } },
            "plates": [{ "id": "p", "origin": [0, 0], "size": [2, 2], "divisions": [2, 2], "thickness": 1, "material": "m",
                         "plane": "stress" }],
            "edges": { "ring": around("p", 3) },
            "rigid": [{ "id": "body", "at": "ring" }],
            "loads": { "w": { "items": [{ "point": { "at": "p[1,2]", "force": [0, -6] } }] } }
        });
        for (key, value) in what.as_object().expect("an object") {
            scenario[key] = value.clone();
        }
        let answer = Case::json(scenario).solve(&[]);
        is_answer(&answer);
        answer
    };
    let held = json!([{ "at": "p[1,1]", "fixed": ["x"] }, { "at": "p[1,0]", "fixed": ["x"] }]);
    let springs = with(json!({
        "supports": held, "springs": [{ "at": "ring", "direction": [0, 1], "stiffness": 5 }]
    }));
    // p[1,1] is not of the body: it hangs on the elements, which nothing else loads.
    close("springs", displacement(&springs, "p[1,0]")[1], -6.0 / (8.0 * 5.0), 1e-11);
    let founded = with(json!({
        "supports": held,
        "foundations": [{ "id": "soil", "on": "ring", "stiffness": 5, "direction": [0, 1] }]
    }));
    close("foundation", displacement(&founded, "p[1,0]")[1], -6.0 / (8.0 * 5.0), 1e-11);
    let pairs = with(json!({
        "contacts": [{ "id": "g", "edge": "ring", "against": "ground", "normal": [0, 1], "law": "frictionless" }],
        "supports": held
    }));
    assert_eq!(pairs.pairs.len(), 8);
    close("carried", of_pairs(&pairs, |pair| pair.x_n).iter().sum(), 6.0, 1e-8);
}
