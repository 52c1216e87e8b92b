//! The keys of the result that quantities fill, on closed forms: stresses, diagrams of members, probes, notes; in stages
//! as well.

use serde_json::Value;
use stickslip::watch::Quiet;

use super::lines::{read, told};

/// A quad 2 × 1 of thickness 0.5 pulled by 6 per length of its right edge: σ_x = 6 / 0.5 = 12. A cantilever of length 4
/// under q = −3 and, at 1 from the clamp, a force −10. A block of weight W that is pushed.
const THREE: &str = r#"{
  "format": "stickslip/1", "title": "quad, cantilever and block", "units": { "length": "m", "force": "kN" },
  "parameters": { "W": 10, "f": 0.5 },
  "materials": { "m": { "E": 20000, "nu": 0.25 } },
  "sections": { "s": { "area": 0.1, "inertia": 0.01 } },
  "nodes": { "a": [0, 5], "b": [2, 5], "c": [2, 6], "d": [0, 6], "A": [0, 0], "B": [4, 0] },
  "bars": [ { "id": "AB", "nodes": ["A", "B"], "material": "m", "section": "s", "divisions": 2 } ],
  "quads": [ { "id": "q1", "nodes": ["a", "b", "c", "d"], "thickness": 0.5, "material": "m", "plane": "stress" } ],
  "edges": { "right": ["b", "c"] },
  "plates": [ { "id": "p", "origin": [10, 0], "size": [2, 1], "divisions": [2, 1], "thickness": 1, "material": "m",
                "plane": "stress" } ],
  "supports": [ { "at": "A", "fixed": ["x", "y", "r"] }, { "at": "a", "fixed": ["x", "y"] }, { "at": "d", "fixed": ["x"] } ],
  "contacts": [ { "id": "base", "edge": "p.bottom", "against": "ground", "friction": "f" } ],
  "loads": {
    "pull": { "items": [ { "traction": { "edge": "right", "value": [6, 0] } } ] },
    "sag": { "items": [ { "line": { "bar": "AB", "value": [0, -3] } },
                        { "point": { "bar": "AB", "distance": 1, "force": [0, -10] } } ] },
    "weight": { "factor": "W", "items": [ { "point": { "at": "p.top", "force": [0, -1] } } ] },
    "push": { "items": [ { "point": { "at": "p.top", "force": [2, 0] } } ] }
  },
  "probes": { "pulled": "sx q1", "clamp": "M AB start" }
}"#;

fn near(found: &Value, expected: f64) {
    let number = found.as_f64().unwrap_or_else(|| panic!("{found}"));
    assert!((number - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{number} {expected}");
}

fn find<'v>(list: &'v Value, key: &str, name: &str) -> &'v Value {
    let list = list.as_array().unwrap_or_else(|| panic!("{list}"));
    list.iter().find(|entry| entry[key] == name).unwrap_or_else(|| panic!("no {key} {name}"))
}

#[test]
fn stresses_stand_at_nodes_and_elements() {
    let result = read(THREE).result(false).expect("an answer");
    let stresses = &result["stresses"];
    for place in [find(stresses, "node", "b"), find(stresses, "element", "q1")] {
        // Uniaxial: s1 = mises = σ_x, s2 = 0.
        for (key, value) in [("sx", 12.0), ("sy", 0.0), ("sxy", 0.0), ("s1", 12.0), ("s2", 0.0), ("mises", 12.0)] {
            near(&place[key], value);
        }
    }
    // Nodes first; every node of a plate or quad once, every element once.
    let list = stresses.as_array().unwrap();
    assert_eq!(list.iter().filter(|entry| entry.get("node").is_some()).count(), 4 + 6);
    assert_eq!(list.iter().filter(|entry| entry.get("element").is_some()).count(), 1 + 2);
    assert!(list[..10].iter().all(|entry| entry.get("node").is_some()));
    near(&result["probes"]["pulled"], 12.0);
    // Plane strain: σ_z = ν σ_x = 3, von Mises √(12² − 12·3 + 3²) = √117.
    let strain = THREE.replacen("\"plane\": \"stress\"", "\"plane\": \"strain\"", 1);
    near(&find(&read(&strain).result(false).unwrap()["stresses"], "element", "q1")["mises"], 117.0_f64.sqrt());
}

/// A block pulled by σ = 12 along x and sheared by τ = 8 in x–z: principal values 6 ± √(6² + 8²) and 0, von Mises
/// √(12² + 3·8²), at every node and in every element.
#[test]
fn stresses_in_space_have_six_components() {
    let text = r#"{
      "format": "stickslip/1", "title": "block", "dimension": 3, "units": { "length": "m", "force": "kN" },
      "materials": { "m": { "E": 20000, "nu": 0.25 } },
      "bricks": [ { "id": "b", "origin": [0, 0, 0], "size": [2, 1, 1], "divisions": [2, 1, 1], "material": "m" } ],
      "supports": [ { "at": "b[0,0,0]", "fixed": ["x", "y", "z"] }, { "at": "b[2,0,0]", "fixed": ["y", "z"] },
                    { "at": "b[0,1,0]", "fixed": ["z"] } ],
      "loads": { "F": { "items": [
        { "traction": { "face": "b.right", "value": [12, 0, 8] } }, { "traction": { "face": "b.left", "value": [-12, 0, -8] } },
        { "traction": { "face": "b.top", "value": [8, 0, 0] } }, { "traction": { "face": "b.bottom", "value": [-8, 0, 0] } } ] } }
    }"#;
    let mut session = read(text);
    let result = session.result(false).expect("an answer");
    let right = [
        ("sx", 12.0),
        ("sy", 0.0),
        ("sz", 0.0),
        ("sxy", 0.0),
        ("syz", 0.0),
        ("sxz", 8.0),
        ("s1", 16.0),
        ("s2", 0.0),
        ("s3", -4.0),
        ("mises", 336.0_f64.sqrt()),
    ];
    let all = result["stresses"].as_array().unwrap();
    assert_eq!(all.len(), 12 + 2);
    for place in all {
        right.iter().for_each(|(key, value)| near(&place[*key], *value));
        assert_eq!(place.as_object().unwrap().len(), 1 + right.len());
    }
    for (word, value) in right {
        told(&mut session, &format!("expect {word} b{{1,0,0}} = {value} ± 1e-9")).unwrap();
    }
    // In the plane there are no others than before.
    let error = told(&mut read(THREE), "show sz q1").unwrap_err();
    assert!(error.contains("`sz` is a quantity of space"), "{error}");
}

#[test]
fn an_unknown_element_is_told() {
    let error = told(&mut read(THREE), "show mises q2").unwrap_err();
    assert!(error.contains("no node or element `q2` (did you mean `q1`?)"), "{error}");
}

/// M(x) = −q (L − x)²/2 − P (1 − x)₊ with q = 3, P = 10, L = 4; Q(x) = q (L − x) + P for x < 1.
#[test]
fn members_have_their_diagrams_with_extremes() {
    let result = read(THREE).result(false).expect("an answer");
    let first = &result["members"][0];
    assert_eq!(first["diagram"].as_array().unwrap().len(), 2, "{first}");
    let moment = |x: f64| -1.5 * (4.0 - x) * (4.0 - x) - 10.0 * (1.0 - x).max(0.0);
    for element in 0..2 {
        for piece in result["members"][element]["diagram"].as_array().unwrap() {
            let (a, b) = (piece["range"][0].as_f64().unwrap(), piece["range"][1].as_f64().unwrap());
            for x in [a, 0.5 * (a + b), b] {
                let powers: Vec<f64> = piece["M"].as_array().unwrap().iter().map(|c| c.as_f64().unwrap()).collect();
                let value = powers.iter().rev().fold(0.0, |sum, c| sum * (x - a) + c);
                assert!((value - moment(x)).abs() < 1e-9, "{value} at {x}");
            }
        }
    }
    let extremes = &first["extremes"];
    near(&extremes["M"]["least"]["value"], moment(0.0));
    near(&extremes["M"]["least"]["at"], 0.0);
    near(&extremes["M"]["largest"]["value"], moment(2.0));
    near(&extremes["M"]["largest"]["at"], 2.0);
    near(&extremes["Q"]["largest"]["value"], 22.0);
    near(&extremes["Q"]["least"]["value"], 6.0);
    // A simple beam under q = −3: M = 1.5 x (4 − x), largest 6 in the middle of it, inside the one element.
    let simple = THREE
        .replace(
            "{ \"at\": \"A\", \"fixed\": [\"x\", \"y\", \"r\"] }",
            "{ \"at\": \"A\", \"fixed\": [\"x\", \"y\"] }, { \"at\": \"B\", \"fixed\": [\"y\"] }",
        )
        .replace("\"divisions\": 2 }", "\"divisions\": 1 }")
        .replace("\"distance\": 1, \"force\": [0, -10]", "\"distance\": 1, \"force\": [0, 0]");
    let member = read(&simple).result(false).unwrap()["members"][0].clone();
    near(&member["extremes"]["M"]["largest"]["value"], 6.0);
    near(&member["extremes"]["M"]["largest"]["at"], 2.0);
}

#[test]
fn stages_hold_the_same_keys() {
    let stages = "\"stages\": [ { \"weight\": 1, \"sag\": 1 }, { \"weight\": 1, \"sag\": 2, \"pull\": 0.5, \"push\": 1 } ],\n  \"probes\"";
    let mut session = read(&THREE.replace("\"probes\"", stages));
    session.follow_stages(&Quiet).expect("it is followed");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("result.json");
    told(&mut session, &format!("export result {}", file.display())).unwrap();
    let result: Value = serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap();
    let stages = result["stages"].as_array().unwrap_or_else(|| panic!("{result}"));
    for (stage, pulled, clamp, tilt) in [(&stages[0], 0.0, -34.0, 0.0), (&stages[1], 6.0, -68.0, 0.2)] {
        near(&stage["probes"]["pulled"], pulled);
        near(&stage["probes"]["clamp"], clamp);
        near(&find(&stage["stresses"], "element", "q1")["sx"], pulled);
        // e = H h / W = 2 · 1 / 10.
        near(&find(&stage["resultants"], "joint", "base")["e"], tilt);
        near(&find(&stage["resultants"], "joint", "base")["N"], 10.0);
    }
    near(&find(&result["stresses"], "element", "q1")["sx"], 6.0);
    near(&result["probes"]["clamp"], -68.0);
}

#[test]
fn remarks_on_the_answer_are_notes() {
    // A pair that cohesion holds while it is open.
    let text = r#"{ "format": "stickslip/1", "title": "held", "contact_system": { "pairs": ["c"],
        "stiffness": [[1, 0], [0, 1]], "law": ["coulomb"], "friction": [0.5], "cohesion": [5],
        "loads": { "all": { "vector": [-1, 1] } } } }"#;
    let result = read(text).result(false).expect("an answer");
    assert_eq!(result["pairs"][0]["state"], "open", "{result}");
    assert!(result["notes"][0].as_str().unwrap().contains("held by its cohesion"), "{result}");
    assert!(read(THREE).result(false).unwrap().get("notes").is_none());
}
