//! Small scenarios → what must be in the checked structure, and where it says it came from.

use crate::model::load::load_text;
use crate::model::pair::{Law, Pair};
use crate::model::parameter::Number;
use crate::model::scenario::{Scenario, Source};
use crate::model::structure::{Component, ElementKind, Load, Structure};

fn load(parts: &str) -> Scenario {
    let text = format!(
        r#"{{
  "format": "stickslip/1",
  "title": "a test",
  "parameters": {{ "f": {{ "value": 0.3, "min": 0, "max": 1 }}, "F": 5 }},
  "materials": {{ "m": {{ "E": 1000, "nu": 0.25 }} }},
  "sections": {{ "s": {{ "area": 0.5, "inertia": 0.1 }}, "t": {{ "area": 0.2 }} }},
  {parts}
}}"#
    );
    load_text("test.json", &text, None).unwrap_or_else(|problems| panic!("{problems}"))
}

fn structure(scenario: &Scenario) -> &Structure {
    match &scenario.source {
        Source::Structure(structure) => structure,
        other => panic!("{other:?}"),
    }
}

fn index(structure: &Structure, id: &str) -> usize {
    structure.nodes.iter().position(|node| node.id == id).unwrap_or_else(|| panic!("no node {id}"))
}

/// Sum of the forces, and of their moments about the origin.
fn resultant(structure: &Structure, case: usize) -> ([f64; 2], f64) {
    let (mut force, mut moment) = ([0.0; 2], 0.0);
    for load in &structure.load_cases[case].loads {
        let Load::Nodal { node, force: f, .. } = load else { panic!("{load:?}") };
        let at = structure.nodes[*node].position;
        force = [force[0] + f[0], force[1] + f[1]];
        moment += at[0] * f[1] - at[1] * f[0];
    }
    (force, moment)
}

const PLATES: &str = r#""plates": [
    { "id": "lower", "origin": [0, 0], "x": [0, 0.5, 2, 4], "y": [0, 1], "thickness": 0.1, "material": "m", "plane": "strain" },
    { "id": "upper", "origin": [0, 1], "x": [0, 0.5, 2, 4], "y": [0, 2], "thickness": 0.1, "material": "m", "plane": "stress" }
  ],
  "supports": [{ "at": "lower.bottom", "fixed": ["x", "y"] }, { "at": "lower[0,0]", "fixed": ["y"] }]"#;

#[test]
fn a_divided_bar_makes_a_chain_with_hinges_at_its_ends_only() {
    let scenario = load(
        r#""nodes": { "A": [1, 1], "B": [4, 5] },
  "bars": [{ "id": "AB", "nodes": ["A", "B"], "material": "m", "section": "s", "divisions": 4, "hinges": ["end"] }],
  "supports": [{ "at": "A", "fixed": ["x", "y", "r"] }],
  "loads": { "wind": { "factor": "F", "items": [{ "line": { "bar": "AB", "value": [2, 0] } }, { "point": { "at": "AB/2", "force": [0, 1], "moment": 3 } }] } }"#,
    );
    let structure = structure(&scenario);
    let ids: Vec<&str> = structure.nodes.iter().map(|node| node.id.as_str()).collect();
    assert_eq!(ids, ["A", "B", "AB/1", "AB/2", "AB/3"]);
    assert_eq!(structure.nodes[3].position, [2.5, 3.0, 0.0]);
    assert_eq!(structure.bars[0].elements, 0..4);
    let hinges: Vec<[bool; 2]> = structure
        .elements
        .iter()
        .map(|element| match element.kind {
            ElementKind::Frame { hinges, .. } => hinges,
            _ => panic!("{element:?}"),
        })
        .collect();
    let none = [false, false];
    assert_eq!(hinges, [none, none, none, [false, true]]);
    assert_eq!(structure.elements[3].nodes, [4, 1]);
    let case = &structure.load_cases[0];
    assert_eq!(case.factor, Number::Parameter("F".into()));
    assert_eq!(case.loads.len(), 5);
    assert!(matches!(case.loads[4], Load::Nodal { node: 3, moment: [0.0, 0.0, 3.0], .. }));
    for (node, place) in [(1, "nodes.B"), (4, "bars[0]")] {
        assert_eq!(scenario.places.of_node(structure, node), place);
    }
}

#[test]
fn loads_on_edges_keep_their_resultant() {
    let scenario = load(&format!(
        r#"{PLATES},
  "contacts": [{{ "id": "joint", "edge": "upper.bottom", "against": "lower.top", "friction": "f" }}],
  "loads": {{
    "total": {{ "items": [{{ "point": {{ "at": "upper.top", "force": [3, -8] }} }}] }},
    "traction": {{ "items": [{{ "traction": {{ "edge": "upper.top", "value": [0.75, -2] }} }}] }}
  }}"#
    ));
    let structure = structure(&scenario);
    for case in 0..2 {
        let (force, moment) = resultant(structure, case);
        // Acting at the middle (2, 3) of the top edge: M = 2·(−8) − 3·3.
        assert!((force[0] - 3.0).abs() < 1e-14 && (force[1] + 8.0).abs() < 1e-14);
        assert!((moment + 25.0).abs() < 1e-13, "{moment}");
    }
}

#[test]
fn edge_contacts_pair_nodes_at_the_same_place() {
    let scenario = load(&format!(
        r#"{PLATES},
  "contacts": [
    {{ "id": "joint", "edge": "upper.bottom", "against": "lower.top", "friction": ["f", 0.1, 0.2, 0.3], "gap": 0.01, "skip": [1] }},
    {{ "id": "wall", "edge": "upper.right", "against": "ground", "law": "frictionless" }},
    {{ "id": "pin", "node": "upper[0,1]", "against": "ground", "normal": [3, 4], "law": "bound", "bound": 2 }}
  ]"#
    ));
    let structure = structure(&scenario);
    let ids: Vec<&str> = structure.pairs.iter().map(|pair| pair.id.as_str()).collect();
    assert_eq!(ids, ["joint[0]", "joint[2]", "joint[3]", "wall[0]", "wall[1]", "pin"]);
    let joint = &structure.pairs[1];
    assert_eq!(joint.node, index(structure, "upper[2,0]"));
    assert_eq!(joint.weights, Pair::of_nodes(joint.node, Some(index(structure, "lower[2,1]"))));
    // Out of the lower plate, towards the upper one.
    assert_eq!(joint.normal, [0.0, 1.0, 0.0]);
    assert_eq!(
        joint.law,
        Law::Coulomb { friction: Number::Value(0.2), cohesion: Number::Value(0.0), gap: Number::Value(0.01) }
    );
    // From the ground into the plate.
    assert_eq!(structure.pairs[3].normal, [-1.0, 0.0, 0.0]);
    assert_eq!(structure.pairs[5].normal, [0.6, 0.8, 0.0]);
    assert_eq!(structure.pairs[5].tangents, [[0.8, -0.6, 0.0]]);
    assert_eq!(&*scenario.places.pairs[2], "contacts[0]");
    assert_eq!(&*scenario.places.pairs[4], "contacts[1]");
    // The corner is held by both supports, but listed once.
    assert_eq!(structure.supports.len(), 8);
    let corner = index(structure, "lower[0,0]");
    let held = structure.supports.iter().filter(|support| support.node == corner && support.component == Component::Y);
    assert_eq!(held.count(), 1);
}

#[test]
fn a_plate_turned_upside_down_meets_its_partner_in_reverse() {
    let scenario = load(
        r#""plates": [
    { "id": "lower", "origin": [0, 0], "size": [3, 1], "divisions": [3, 1], "thickness": 1, "material": "m", "plane": "strain" },
    { "id": "upper", "origin": [3, 2], "size": [3, 1], "divisions": [3, 1], "rotation": 180, "thickness": 1, "material": "m", "plane": "strain" }
  ],
  "contacts": [{ "id": "joint", "edge": "upper.top", "against": "lower.top" }]"#,
    );
    let structure = structure(&scenario);
    for pair in &structure.pairs {
        let against = pair.weights[1].0;
        assert_eq!(structure.nodes[pair.node].position, structure.nodes[against].position);
        assert_eq!(pair.normal, [0.0, 1.0, 0.0]);
    }
    assert_eq!(structure.nodes[structure.pairs[0].node].position, [3.0, 1.0, 0.0]);
}

#[test]
fn bars_may_stand_on_plates_and_quads_on_nodes() {
    let scenario = load(&format!(
        r#""nodes": {{ "A": [0, 5], "B": [1, 5], "C": [1, 6], "D": [0, 6] }},
  "bars": [{{ "id": "post", "nodes": ["upper[0,1]", "A"], "kind": "truss", "material": "m", "section": "t" }}],
  "quads": [{{ "id": "q", "nodes": ["A", "B", "C", "D"], "thickness": 1, "material": "m", "plane": "stress" }}],
  "ties": [{{ "nodes": ["lower[0,1]", "upper[0,0]"] }}],
  "springs": [{{ "at": "upper.top", "direction": [0, -2], "stiffness": 7 }}],
  {PLATES}"#
    ));
    let structure = structure(&scenario);
    assert_eq!(structure.elements[0].nodes, [index(structure, "upper[0,1]"), 0]);
    assert_eq!(structure.plates[0].elements, 1..4);
    assert_eq!(structure.elements[7].nodes, [0, 1, 2, 3]);
    assert_eq!(&*scenario.places.elements[7], "quads[0]");
    assert_eq!(structure.ties[0].components, [Component::X, Component::Y]);
    assert_eq!(structure.springs.len(), 4);
    let factors: Vec<f64> = structure.springs[0].terms.iter().map(|term| term.factor).collect();
    assert_eq!(factors, [0.0, -1.0, 0.0]);
    assert_eq!(structure.springs[3].stiffness, 7.0);
}

#[test]
fn later_stages_place_their_problems_in_the_text() {
    let scenario = load(&format!(
        "{PLATES},\n  \"contacts\": [{{ \"id\": \"joint\", \"edge\": \"upper.bottom\", \"against\": \"lower.top\" }}]"
    ));
    let problems = scenario.problem_at(&scenario.places.pairs[0], "held twice", "use `skip`");
    let problem = &problems.problems[0];
    assert_eq!((problem.line, problem.column), (12, 16));
    assert_eq!(problems.to_string(), "test.json:12:16: contacts[0]: held twice\n  help: use `skip`");
    let problems = scenario.problem_at("materials.m.nu", "odd", "");
    assert_eq!(problems.to_string(), "test.json:5:42: materials.m.nu: odd");
    // Nothing there: the place around it.
    let problems = scenario.problem_at("contacts[0].friction", "odd", "");
    assert_eq!(problems.problems[0].path, "contacts[0]");
}

#[test]
fn every_value_has_a_path_that_leads_back_to_it() {
    let text = "{ \"a\": [1, { \"b c\": [] , \"é\": \"ü\" }, [[2]]],\n \"d\": null }";
    let document = crate::model::locate::Document::parse(text).ok().unwrap();
    for (path, line, column) in [
        ("", 1, 1),
        ("a", 1, 8),
        ("a[1]", 1, 12),
        ("a[1][\"b c\"]", 1, 21),
        ("a[1].é", 1, 31),
        ("a[2][0][0]", 1, 40),
        ("d", 2, 7),
    ] {
        let offset = document.offset_of(path);
        assert_eq!(document.path_at(offset), path);
        assert_eq!(document.position(offset), (line, column), "{path}");
    }
}

#[test]
fn parameters_keep_to_what_they_are_used_for() {
    let scenario = load(
        r#""nodes": { "A": [0, 0], "B": [1, 0] },
  "bars": [{ "id": "AB", "nodes": ["A", "B"], "material": "m", "section": "s" }],
  "contacts": [{ "id": "c", "node": "B", "against": "ground", "normal": [0, 1], "friction": "f" }],
  "loads": { "pull": { "factor": "F", "items": [] } }"#,
    );
    assert_eq!(scenario.refusal("f", 0.0), None);
    assert_eq!(scenario.refusal("f", -0.5).unwrap(), "f is the friction of c and must not be negative, found -0.5");
    assert_eq!(scenario.refusal("F", -0.5), None);
    assert!(scenario.refusal("F", f64::NAN).is_some());
    assert_eq!(scenario.parameter_values()["F"], 5.0);
}

#[test]
fn contact_systems_and_lcps_are_read_as_given() {
    let text = r#"{ "format": "stickslip/1", "title": "t", "parameters": { "f": 0.3 },
  "contact_system": {
    "pairs": ["c1", "joint[0]"],
    "stiffness": [[2, 0, 0, 0], [0, 2, 0, 0], [0, 0, 1, -1], [0, 0, -1, 1]],
    "loads": { "pull": { "vector": [1, 1, 0, 0] } },
    "law": ["coulomb", "bound"], "friction": ["f", 0], "bound": [0, 3],
    "kernel": [[0, 0, 1, 1]]
  },
  "solver": { "covering": "ones", "tie_break": "random:7" } }"#;
    let scenario = load_text("t", text, None).unwrap();
    let Source::ContactSystem(system) = &scenario.source else { panic!() };
    assert_eq!(system.laws[1], Law::Bound { bound: Number::Value(3.0) });
    assert_eq!(system.kernel.as_ref().unwrap()[0], [0.0, 0.0, 1.0, 1.0]);
    assert_eq!(scenario.rules.tie_break.to_string(), "random:7");
    let text = r#"{ "format": "stickslip/1", "title": "t", "parameters": { "q": -1 },
  "lcp": { "M": [[1, 0], [0, 1]], "q": ["q", 1], "covering": [1, 2] } }"#;
    let scenario = load_text("t", text, None).unwrap();
    let Source::Lcp(lcp) = &scenario.source else { panic!() };
    assert_eq!(lcp.names, ["1", "2"]);
    assert_eq!(lcp.q[0], Number::Parameter("q".into()));
    assert_eq!(lcp.covering.as_deref(), Some(&[1.0, 2.0][..]));
}

#[test]
fn the_matrix_may_stand_in_a_file_beside_the_scenario() {
    let folder = tempfile::tempdir().unwrap();
    let text = r#"{ "format": "stickslip/1", "title": "t",
  "contact_system": { "pairs": ["c1"], "stiffness": { "file": "csm.mtx" }, "loads": {} } }"#;
    let path = folder.path().join("scenario.json");
    std::fs::write(
        folder.path().join("csm.mtx"),
        "%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n1 1 1\n2 1 -1\n2 2 1.5\n",
    )
    .unwrap();
    let scenario = load_text("scenario.json", text, Some(&path)).unwrap();
    let Source::ContactSystem(system) = &scenario.source else { panic!() };
    assert_eq!(system.matrix.rows(), [[1.0, -1.0], [-1.0, 1.5]]);
    let problems = load_text("inline", text, None).unwrap_err();
    assert!(problems.to_string().contains("without a file of its own"));
}

/// A string equal to a parameter's name is that parameter, any other an expression, with blanks or without.
#[test]
fn differences_need_no_blanks() {
    let text = |nodes: &str| {
        format!(
            r#"{{"format": "stickslip/1", "title": "t", "parameters": {{"L": 4, "b": 1, "my-span": 7}}, "nodes": {{{nodes}}},
                "springs": [{{"at": "A", "direction": [0, 1], "stiffness": 1}}], "supports": [{{"at": "A", "fixed": ["x"]}}],
                "contacts": [{{"id": "c", "node": "A", "against": "ground", "normal": [0, 1], "friction": 0}}], "loads": {{}}}}"#
        )
    };
    for (written, expected) in [
        ("L-b", 3.0),
        ("L-1", 3.0),
        ("L-1e0", 3.0),
        ("L-pi", 4.0 - std::f64::consts::PI),
        ("my-span", 7.0),
        ("L-b-2", 1.0),
    ] {
        let scenario = load_text("t", &text(&format!(r#""A": ["{written}", 0]"#)), None).expect(written);
        let Source::Structure(structure) = &scenario.source else { panic!() };
        assert_eq!(structure.nodes[0].position[0], expected, "{written}");
    }
    let problems = load_text("t", &text(r#""A": ["my-spam", 0]"#), None).expect_err("no such name").to_string();
    assert!(problems.contains("unknown parameter \"my-spam\" (did you mean \"my-span\"?)"), "{problems}");
}

/// A spring that could not be read is told of; that there is nothing beside it is not.
#[test]
fn what_could_not_be_read_is_not_missing() {
    let text = r#"{"format": "stickslip/1", "title": "t", "nodes": {"A": [0, 0]}, "supports": [{"at": "A", "fixed": ["x"]}],
        "springs": [{"at": "A", "direction": [0, 1], "stiffness": -2}], "loads": {},
        "contacts": [{"id": "c", "node": "A", "against": "ground", "normal": [0, 1], "friction": 0}]}"#;
    let problems = load_text("t", text, None).expect_err("a negative stiffness").to_string();
    assert!(problems.contains("springs[0].stiffness") && !problems.contains("no elements"), "{problems}");
}
