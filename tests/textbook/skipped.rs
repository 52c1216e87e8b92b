//! Contacts of edges and faces that hang over: nodes left out by `skip` need no partner, the others keep their numbers, and
//! the answer is that of the same pairs written one by one.

use serde_json::{Value, json};

use crate::common::*;

const F: f64 = 0.3;

/// A joint as one entry against the same pairs node by node; `others` is what both scenarios have beside.
fn same_as_one_by_one(others: &Value, joint: Value, pairs: &[(usize, [String; 2])], normal: Value) {
    let with = |contacts: Value| {
        let mut value = others.clone();
        value["contacts"] = contacts;
        Case::json(value).solve(&[])
    };
    let single = |(index, [node, against]): &(usize, [String; 2])| json!({ "id": format!("c{index}"), "node": node, "against": against, "normal": normal, "friction": F });
    let (found, expected) = (with(json!([joint])), with(pairs.iter().map(single).collect()));
    is_answer(&found);
    is_answer(&expected);
    let ids: Vec<&str> = found.pairs.iter().map(|pair| pair.id.as_str()).collect();
    let numbered: Vec<String> = pairs.iter().map(|(index, _)| format!("lap[{index}]")).collect();
    assert_eq!(ids, numbered);
    // The two differ in nothing but names, so in no more than the order of sums; the forces are of size 1.
    near_all("x_n", &of_pairs(&found, |pair| pair.x_n), &of_pairs(&expected, |pair| pair.x_n), 1e-10);
    near_all("x_t", &of_pairs(&found, |pair| pair.x_t), &of_pairs(&expected, |pair| pair.x_t), 1e-10);
    assert!(found.pairs.iter().any(|pair| pair.x_n > 0.1), "the joint bears something");
}

/// Two bricks that overlap by two of three elements: the first three of four columns of nodes, which run along x first.
#[test]
fn a_lap_joint_of_faces() {
    let brick = |id: &str, origin: [i32; 3]| json!({ "id": id, "origin": origin, "size": [3, 1, 1], "divisions": [3, 1, 1], "material": "m" });
    let others = json!({
        "dimension": 3,
        "materials": { "m": { "E": 1000, "nu": 0.2 } },
        "bricks": [brick("lower", [0, 0, 0]), brick("upper", [1, 0, 1])],
        "supports": [{ "at": "lower.bottom", "fixed": ["x", "y", "z"] }],
        "loads": { "F": { "items": [{ "pressure": { "face": "upper.top", "value": 1 } },
                                    { "point": { "at": "upper.right", "force": [0.2, 0.1, 0] } }] } }
    });
    let columns = (0..2).flat_map(|j| (0..3).map(move |i| (i, j)));
    let pairs: Vec<_> =
        columns.map(|(i, j)| (i + 4 * j, [format!("upper[{i},{j},0]"), format!("lower[{},{j},1]", i + 1)])).collect();
    let joint = json!({ "id": "lap", "face": "upper.bottom", "against": "lower.top", "friction": F, "skip": [3, 7] });
    same_as_one_by_one(&others, joint, &pairs, json!([0, 0, 1]));
}

/// The same of plates, node by node; the edge below is longer, so that it has nodes without a partner, too.
#[test]
fn a_lap_joint_of_edges_node_by_node() {
    let plate = |id: &str, origin: [i32; 2], n: usize| {
        json!({ "id": id, "origin": origin, "size": [n, 1], "divisions": [n, 1], "thickness": 1, "material": "m",
                "plane": "stress" })
    };
    let others = json!({
        "materials": { "m": { "E": 1000, "nu": 0.2 } },
        "plates": [plate("lower", [-1, 0], 4), plate("upper", [1, 1], 3)],
        "supports": [{ "at": "lower.bottom", "fixed": ["x", "y"] }],
        "loads": { "F": { "items": [{ "pressure": { "edge": "upper.top", "value": 1 } },
                                    { "point": { "at": "upper.right", "force": [0.2, 0] } }] } }
    });
    let pairs: Vec<_> = (0..3).map(|i| (i, [format!("upper[{i},0]"), format!("lower[{},1]", i + 2)])).collect();
    let joint = json!({ "id": "lap", "edge": "upper.bottom", "against": "lower.top", "method": "nodes", "friction": F,
                        "skip": [3] });
    same_as_one_by_one(&others, joint, &pairs, json!([0, 1]));
}
