//! Warnings of `check`: what is allowed but can hardly be meant. Each fires where it should, with its place, and
//! nowhere else.

use serde_json::{Value, json};
use stickslip::model::embedded;
use stickslip::model::load::load_text;
use stickslip::model::problem::Problem;
use stickslip::session::diagnose;
use stickslip::watch::Quiet;

/// A steel beam of two spans on three bearings, in kN and m: nothing is odd about it.
fn beam() -> Value {
    json!({
        "format": "stickslip/1",
        "title": "beam",
        "units": { "length": "m", "force": "kN" },
        "parameters": { "q": { "value": 10, "min": 0, "max": 20, "unit": "kN/m" }, "f": 0.3 },
        "materials": { "steel": { "E": 2.1e8, "nu": 0.3, "density": 7.85, "expansion": 1.2e-5 } },
        "sections": { "HEA400": { "area": 0.0159, "inertia": 4.507e-4 } },
        "nodes": { "A": [0, 0], "B": [6, 0], "C": [12, 0] },
        "bars": [{ "id": "beam", "polyline": ["A", "B", "C"], "material": "steel", "section": "HEA400", "divisions": 2 }],
        "contacts": [
            { "id": "a", "node": "A", "against": "ground", "normal": [0, 1], "friction": "f" },
            { "id": "b", "node": "B", "against": "ground", "normal": [0, 1], "friction": "f" },
            { "id": "c", "node": "C", "against": "ground", "normal": [0, 1], "friction": "f" }
        ],
        "loads": {
            "weight": { "items": [{ "gravity": { "acceleration": [0, -9.81] } }] },
            "live": { "factor": "q", "items": [{ "line": { "bar": "beam", "value": [0, -1] } }] }
        }
    })
}

/// A block of concrete on the ground, pushed.
fn block() -> Value {
    json!({
        "format": "stickslip/1",
        "title": "block",
        "units": { "length": "m", "force": "kN" },
        "materials": { "concrete": { "E": 3e7, "nu": 0.2, "density": 24 } },
        "plates": [{ "id": "block", "origin": [0, 0], "size": [2, 1], "divisions": [4, 2], "thickness": 1,
                     "material": "concrete", "plane": "stress" }],
        "contacts": [{ "id": "base", "edge": "block.bottom", "against": "ground", "friction": 0.5 }],
        "loads": { "weight": { "items": [{ "gravity": { "acceleration": [0, -1] } }] } }
    })
}

fn warnings(scenario: &Value) -> Vec<Problem> {
    let text = serde_json::to_string_pretty(scenario).unwrap();
    let scenario = load_text("test", &text, None).unwrap_or_else(|problems| panic!("{problems}"));
    let found = diagnose(scenario, &Quiet).unwrap_or_else(|error| panic!("{error}")).warnings;
    for problem in &found {
        assert!(!problem.help.is_empty(), "{problem:?}");
        // The place is that of the path: the line holds its last key, or the entry of a list begins there.
        let line = text.lines().nth(problem.line - 1).unwrap();
        let key = problem.path.rsplit(['.', '[', ']']).find(|key| !key.is_empty()).unwrap();
        assert!(line.contains(key) || line.trim_start().starts_with(['{', '"']), "{}: {line}", problem.path);
    }
    found
}

/// The only warning there is, at this path; its text has these parts.
#[track_caller]
fn only(scenario: &Value, path: &str, parts: &[&str]) {
    let found = warnings(scenario);
    let [one] = &found[..] else { panic!("{found:#?}") };
    assert_eq!(one.path, path, "{one:?}");
    for part in parts {
        assert!(one.message.contains(part), "{part}: {}", one.message);
    }
}

#[track_caller]
fn none(scenario: &Value) {
    assert_eq!(warnings(scenario), []);
}

/// `base` with the value at a JSON pointer replaced; Null takes it away.
fn with(mut base: Value, changes: &[(&str, Value)]) -> Value {
    for (pointer, value) in changes {
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        match base.pointer_mut(parent).unwrap_or_else(|| panic!("{pointer}")) {
            Value::Object(map) if value.is_null() => drop(map.shift_remove(key).unwrap()),
            Value::Object(map) => drop(map.insert(key.to_owned(), value.clone())),
            Value::Array(list) if key == "-" => list.push(value.clone()),
            Value::Array(list) => list[key.parse::<usize>().unwrap()] = value.clone(),
            other => panic!("{pointer}: {other}"),
        }
    }
    base
}

#[test]
fn what_is_not_odd_gets_no_warning() {
    none(&beam());
    none(&block());
}

#[test]
fn embedded_scenarios_get_none() {
    for name in embedded::names() {
        let found = diagnose(embedded::load(name).unwrap(), &Quiet).unwrap().warnings;
        assert_eq!(found, [], "{name}");
    }
}

#[test]
fn stiffness_that_no_material_has() {
    let steel = |e: f64| with(beam(), &[("/materials/steel/E", json!(e))]);
    // In GPa, in N/m², in N/mm²: 210 kN/m² is 2.1e5 N/m², a millionth of steel.
    only(&steel(210.0), "materials.steel.E", &["E = 210 kN/m²", "2.100e5 N/m²", "steel has 2.1e11", "about 1e6 times"]);
    only(&steel(2.1e11), "materials.steel.E", &["about 1000 times less"]);
    only(&steel(2.1e5), "materials.steel.E", &["about 1000 times as much"]);
    none(&steel(7e7));
    // Without known units nothing can be said.
    none(&with(steel(210.0), &[("/units", Value::Null)]));
    none(&with(steel(210.0), &[("/units/force", json!("stone"))]));
    // A name that says nothing: from soft timber, 1e9 N/m², to steel.
    let named = |name: &str, e: f64| {
        let material = json!({ "E": e, "nu": 0.3, "density": 7.85, "expansion": 1.2e-5 });
        with(
            beam(),
            &[
                ("/materials/steel", Value::Null),
                (&format!("/materials/{name}"), material),
                ("/bars/0/material", json!(name)),
            ],
        )
    };
    only(&named("m", 210.0), "materials.m.E", &["structures are made of"]);
    none(&named("rubber", 5e3));
    only(&named("m", 2.1e11), "materials.m.E", &["about 1000 times less"]);
    none(&named("rigid", 1e12));
}

#[test]
fn weight_that_no_material_has() {
    // kg/m³ with kN: 7850 · 9.81 kN/m³.
    let heavy = with(beam(), &[("/materials/steel/density", json!(7850))]);
    only(&heavy, "materials.steel.density", &["77008.5 kN/m³", "about 1000 times less"]);
    // As a weight per volume with an acceleration of 1 it is right.
    let weight =
        [("/materials/steel/density", json!(77)), ("/loads/weight/items/0/gravity/acceleration", json!([0, -1]))];
    none(&with(beam(), &weight));
}

#[test]
fn sections_in_other_units() {
    let section = |area: f64, inertia: f64| {
        with(beam(), &[("/sections/HEA400/area", json!(area)), ("/sections/HEA400/inertia", json!(inertia))])
    };
    // cm² and m⁴, m² and cm⁴
    only(&section(159.0, 4.507e-4), "sections.HEA400", &["not of one section"]);
    only(&section(0.0159, 45070.0), "sections.HEA400", &["not of one section"]);
    // mm² and mm⁴: a radius of gyration of 168 beside a beam of 12
    only(&section(15900.0, 4.507e8), "sections.HEA400", &["deeper than the structure", "168.362 m"]);
}

#[test]
fn parameters_in_other_units() {
    let unit = |unit: &str| with(beam(), &[("/parameters/q/unit", json!(unit))]);
    only(&unit("N/m"), "parameters.q.unit", &["`q` is said to be in N/m", "kN and m"]);
    none(&unit("kN/cm"));
    only(&with(beam(), &[("/parameters/q/unit", json!("N/mm²"))]), "parameters.q.unit", &["N/mm²"]);
    none(&unit("%"));
    // Where it is converted the unit is right.
    none(&with(unit("N/m"), &[("/loads/live/factor", json!("q/1000"))]));
}

#[test]
fn parts_that_nothing_uses() {
    only(&with(beam(), &[("/parameters/x", json!(3))]), "parameters.x", &["nothing uses the parameter `x`"]);
    let formula = [("/parameters/x", json!(3)), ("/parameters/y", json!({ "formula": "2*x" }))];
    only(&with(beam(), &formula), "parameters.x", &["only in y"]);
    let used = [("/parameters/y", json!({ "formula": "2*q" }))];
    none(&with(beam(), &used));
    let material = json!({ "E": 3e7, "nu": 0.2 });
    only(&with(beam(), &[("/materials/concrete", material)]), "materials.concrete", &["no element", "`concrete`"]);
    let section = json!({ "area": 0.01, "inertia": 1e-4 });
    only(&with(beam(), &[("/sections/IPE", section)]), "sections.IPE", &["no bar", "`IPE`"]);
}

#[test]
fn loads_on_nothing() {
    let gravity = with(beam(), &[("/materials/steel/density", json!(0))]);
    only(&gravity, "loads.weight.items[0].gravity", &["gravity does nothing", "density of `steel` is 0"]);
    none(&with(gravity, &[("/materials/steel/density", json!("0*f"))]));
    let hot = json!({ "items": [{ "temperature": { "change": 50, "on": ["beam"] } }] });
    none(&with(beam(), &[("/loads/hot", hot.clone())]));
    let cold = with(beam(), &[("/loads/hot", hot), ("/materials/steel/expansion", Value::Null)]);
    only(&cold, "loads.hot.items[0].temperature", &["temperature does nothing", "expansion of `steel` is 0"]);
    only(&with(beam(), &[("/loads/x", json!({ "items": [] }))]), "loads.x", &["acts on nothing"]);
    let zero = json!({ "items": [{ "point": { "at": "B", "force": [0, 0] } }] });
    only(&with(beam(), &[("/loads/x", zero)]), "loads.x", &["zero"]);
    let push = json!({ "factor": 0, "items": [{ "point": { "at": "B", "force": [1, 0] } }] });
    only(&with(beam(), &[("/loads/push", push)]), "loads.push.factor", &["is 0", "never acts"]);
    // A history that leaves a case out, unless a combination has it.
    let staged = with(beam(), &[("/stages", json!([{ "weight": 1 }]))]);
    only(&staged, "loads.live", &["no stage and no combination"]);
    none(&with(staged, &[("/combinations", json!({ "full": { "weight": 1, "live": 1.5 } }))]));
    // The settlement of a support is a load of its case.
    let settles = [
        ("/nodes/P", json!([6, 0])),
        ("/supports", json!([{ "at": "P", "fixed": ["x", "y"], "settlement": [0, -0.01], "case": "settles" }])),
        ("/contacts/1/against", json!("P")),
        ("/loads/settles", json!({ "items": [] })),
    ];
    none(&with(beam(), &settles));
}

#[test]
fn ground_on_the_wrong_side() {
    // A column on a footing.
    let column = [
        ("/nodes", json!({ "A": [0, 0], "B": [0, 6], "C": [0, 12] })),
        (
            "/contacts/1",
            json!({ "id": "b", "node": "B", "against": "ground", "normal": [1, 0], "law": "bound", "bound": 0 }),
        ),
        (
            "/contacts/2",
            json!({ "id": "c", "node": "C", "against": "ground", "normal": [1, 0], "law": "bound", "bound": 0 }),
        ),
        ("/loads/live/items/0/line/value", json!([0, -1])),
    ];
    let column = with(beam(), &column);
    none(&column);
    let upside = with(column, &[("/contacts/0/normal", json!([0, -1]))]);
    only(&upside, "contacts[0]", &["the normal (0, -1) of `a` points down", "the structure lies above it"]);
    let block_of = |normal: [i32; 2]| with(block(), &[("/contacts/0/normal", json!(normal))]);
    none(&block_of([0, 1]));
    only(&block_of([0, -1]), "contacts[0]", &["`base` points down", "lies above it"]);
    // Held from above and below: a guide.
    let held = [(
        "/contacts/-",
        json!({ "id": "held", "node": "block[0,2]", "against": "ground", "normal": [0, -1], "law": "frictionless" }),
    )];
    let found = warnings(&with(block(), &held));
    assert!(found.iter().all(|of| !of.message.contains("lies above")), "{found:?}");
}

/// Two elements of a kind on the same nodes, in whatever order these are written; a truss beside a beam is none.
#[test]
fn elements_given_twice() {
    let bar = |id: &str, nodes: [&str; 2], kind: &str| {
        ("/bars/-", json!({ "id": id, "nodes": nodes, "kind": kind, "material": "steel", "section": "HEA400" }))
    };
    let first = bar("first", ["A", "C"], "frame");
    only(
        &with(beam(), &[first.clone(), bar("again", ["C", "A"], "frame")]),
        "bars[2]",
        &["`again` has the nodes of `first`"],
    );
    none(&with(beam(), &[first, bar("cable", ["C", "A"], "truss")]));
    let back = [("/bars/0/polyline", json!(["A", "B", "C", "B"])), ("/bars/0/divisions", json!(1))];
    only(&with(beam(), &back), "bars[0]", &["`beam` has two elements with the same nodes"]);
    let quad = |id: &str, nodes: [&str; 4]| json!({ "id": id, "nodes": nodes, "thickness": 1, "material": "concrete", "plane": "stress" });
    let corners = ["block[0,0]", "block[4,0]", "block[4,2]", "block[0,2]"];
    let turned = ["block[4,0]", "block[4,2]", "block[0,2]", "block[0,0]"];
    let quads = [("/quads", json!([quad("p", corners), quad("q", turned)]))];
    only(&with(block(), &quads), "quads[1]", &["`q` has the nodes of `p`", "both count"]);
}

/// The same nodes and the same normal once more: as a second contact, with its sides exchanged, on a face. Faces that
/// meet in a node and the two sides of a guide are none.
#[test]
fn contacts_given_twice() {
    let twice = |base: Value, changes: &[(&str, Value)]| -> Vec<(String, String)> {
        let told = |of: Problem| {
            let (id, others) = of.message.split_once(" has the nodes and the normal of ")?;
            Some((of.path, format!("{id} {}", others.split(':').next()?)))
        };
        warnings(&with(base, changes)).into_iter().filter_map(told).collect()
    };
    let found = |path: &str, ids: &str| vec![(path.to_owned(), ids.to_owned())];
    let at = |id: &str, [node, against]: [&str; 2], normal: [i32; 2]| {
        ("/contacts/-", json!({ "id": id, "node": node, "against": against, "normal": normal, "friction": 0.1 }))
    };
    assert_eq!(twice(beam(), &[at("d", ["B", "ground"], [0, 1])]), found("contacts[3]", "`d` `b`"));
    assert_eq!(twice(beam(), &[at("d", ["B", "ground"], [0, -1])]), []);
    assert_eq!(twice(beam(), &[at("d", ["B", "ground"], [1, 0])]), []);
    let two = |second| {
        let stands = ("/supports", json!([{ "at": "D", "fixed": ["x", "y"] }]));
        twice(beam(), &[("/nodes/D", json!([6, 0])), stands, at("one", ["B", "D"], [0, 1]), second])
    };
    assert_eq!(two(at("two", ["D", "B"], [0, -1])), found("contacts[4]", "`two` `one`"));
    assert_eq!(two(at("two", ["D", "B"], [0, 1])), []);
    let edge = |edge: &str| ("/contacts/-", json!({ "id": "e", "edge": edge, "against": "ground", "friction": 0.5 }));
    assert_eq!(twice(block(), &[edge("block.bottom")]), found("contacts[1]", "`e` `base`"));
    assert_eq!(twice(block(), &[edge("block.left")]), []);
}

/// Of two blocks on one another the outer sides are named: each lies a whole block inside the other. An interference fit
/// is none of these.
#[test]
fn sides_that_look_away_from_each_other() {
    let blocks = |contact: Value| {
        let block = |id: &str, y: i32| json!({ "id": id, "origin": [0, y], "size": [4, 2], "divisions": [4, 2], "thickness": 1, "material": "m", "plane": "stress" });
        let held = ["low[0,1]", "low[4,1]", "up[0,1]", "up[4,1]"].map(|at| json!({ "at": at, "fixed": ["x", "y"] }));
        json!({ "format": "stickslip/1", "title": "blocks", "materials": { "m": { "E": 3e4, "nu": 0.2 } },
            "plates": [block("low", 0), block("up", 2)],
            "supports": held,
            "contacts": [contact], "loads": { "w": { "items": [{ "traction": { "edge": "up.top", "value": [0, -1] } }] } } })
    };
    let away =
        blocks(json!({ "id": "j", "edge": "up.top", "against": "low.bottom", "gap": "geometry", "friction": 0.3 }));
    only(&away, "contacts[0]", &["the sides of `j` begin inside one another", "look away from each other"]);
    let facing =
        blocks(json!({ "id": "j", "edge": "up.bottom", "against": "low.top", "gap": "geometry", "friction": 0.3 }));
    assert_eq!(warnings(&facing).len(), 0);
    let fit = blocks(json!({ "id": "j", "edge": "up.bottom", "against": "low.top", "gap": -0.001, "friction": 0.3 }));
    assert_eq!(warnings(&fit).len(), 0);
}

#[test]
fn pairs_that_no_case_presses() {
    // A bearing the wrong way round on a level beam: its weight opens it.
    let turned = with(beam(), &[("/contacts/1/normal", json!([0, -1]))]);
    only(&turned, "contacts[1]", &["no load case presses `b`", "`weight` pulls it open", "(0, -1) points down"]);
    assert!(warnings(&turned)[0].help.starts_with("turn its normal round"));
    // Where another bearing stands off, what closes that gap may press it: its normal is not to be turned for that.
    let off = with(turned, &[("/contacts/0/gap", json!(0.01))]);
    let help = &warnings(&off)[0].help;
    assert!(help.contains("after gaps close") && !help.contains("turn"), "{help}");
    // Only pulled along: nothing reaches the bearings.
    let pulled = with(
        beam(),
        &[
            ("/materials/steel/density", Value::Null),
            ("/loads", json!({ "pull": { "factor": "q", "items": [{ "point": { "at": "C", "force": [1, 0] } }] } })),
        ],
    );
    only(&pulled, "contacts[0]", &["no load case presses `a`, `b` and `c`", "nothing reaches them"]);
    // A case that is turned round in a stage, or by the range of its slider, presses both ways.
    let wind = |factor: Value| {
        with(
            beam(),
            &[
                ("/contacts/1/normal", json!([0, -1])),
                (
                    "/loads/wind",
                    json!({ "factor": factor, "items": [{ "line": { "bar": "beam", "value": [0, -1] } }] }),
                ),
            ],
        )
    };
    only(&wind(json!(1)), "contacts[1]", &["`b`"]);
    none(&wind(json!(-1)));
    none(&with(wind(json!("w")), &[("/parameters/w", json!({ "value": 1, "min": -1, "max": 1 }))]));
    let uplift = json!({ "uplift": { "weight": 1, "live": 1, "wind": -1 } });
    none(&with(wind(json!(1)), &[("/combinations", uplift)]));
    // Interference presses by itself.
    let fit = with(beam(), &[("/contacts/1/normal", json!([0, -1])), ("/contacts/1/gap", json!(-0.01))]);
    none(&fit);
}

#[test]
fn contact_systems_are_looked_at_too() {
    let system = |force: f64, factor: Value| {
        json!({
            "format": "stickslip/1", "title": "t", "parameters": { "f": 0.5 },
            "contact_system": {
                "pairs": ["c1"], "stiffness": [[1, 0], [0, 1]], "friction": ["f"],
                "loads": { "push": { "factor": factor, "vector": [force, 0] } }
            }
        })
    };
    none(&system(1.0, json!(1)));
    only(&system(-1.0, json!(1)), "contact_system.pairs[0]", &["no load case presses `c1`", "`push` pulls it open"]);
    let zero = warnings(&system(0.0, json!(1)));
    assert!(zero.iter().any(|of| of.path == "contact_system.loads.push" && of.message.contains("zero")), "{zero:?}");
    let lcp =
        json!({ "format": "stickslip/1", "title": "t", "parameters": { "x": 1 }, "lcp": { "M": [[1]], "q": [-1] } });
    only(&lcp, "parameters.x", &["nothing uses"]);
}

/// In space everything has a third extent: a column is as large as it is high, and boxes weigh what plates weigh.
#[test]
fn in_space_heights_and_bricks_count() {
    let empty = json!({
        "format": "stickslip/1",
        "title": "in space",
        "dimension": 3,
        "units": { "length": "m", "force": "kN" }
    });
    let scenario = |parts: Value| {
        let mut scenario = empty.clone();
        scenario.as_object_mut().unwrap().extend(parts.as_object().unwrap().clone());
        scenario
    };
    let column = scenario(json!({
        "materials": { "steel": { "E": 2.1e8, "nu": 0.3, "density": 7.85 } },
        "sections": { "HEA400": { "area": 0.0159, "inertia_y": 4.507e-4, "inertia_z": 8.564e-5, "torsion": 1.89e-6 } },
        "nodes": { "A": [0, 0, 0], "B": [0, 0, 6] },
        "bars": [{ "id": "column", "nodes": ["A", "B"], "material": "steel", "section": "HEA400" }],
        "supports": [{ "at": "A", "fixed": ["x", "y", "z", "rx", "ry", "rz"] }],
        "contacts": [{ "id": "stop", "node": "B", "against": "ground", "normal": [1, 0, 0], "friction": 0.3 }],
        "loads": { "push": { "items": [{ "point": { "at": "B", "force": [-10, 0, 0] } }] } }
    }));
    none(&column);
    let block = scenario(json!({
        "materials": { "concrete": { "E": 3e7, "nu": 0.2, "density": 24 } },
        "bricks": [{ "id": "block", "origin": [0, 0, 0], "size": [2, 1, 1], "divisions": [2, 1, 1], "material": "concrete" }],
        "contacts": [{ "id": "base", "face": "block.bottom", "against": "ground", "friction": 0.5 }],
        "loads": { "weight": { "items": [{ "gravity": { "acceleration": [0, 0, -1], "on": ["block"] } }] } }
    }));
    none(&block);
    let weightless = with(block, &[("/materials/concrete/density", Value::Null)]);
    let found = warnings(&weightless);
    assert!(
        found.iter().any(|one| one.path == "loads.weight.items[0].gravity" && one.message.contains("density")),
        "{found:#?}"
    );
}
