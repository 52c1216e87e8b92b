//! Contact of edges whose nodes do not match, against closed forms.

use crate::common::{Case, balance, close, displacement, is_answer, lines, mechanism, near, of_pairs, scenario_text};
use serde_json::{Value, json};
use stickslip::answer::record::{OutcomeKind, State};
use stickslip::model::scenario::Source;

const E: f64 = 1000.0;
const NU: f64 = 0.3;

/// A body between two lines y(x) of equal extent: `columns` quads wide, two high, as named edges `id-bottom`, `id-top`.
struct Body<'a> {
    id: &'a str,
    columns: Vec<f64>,
    bottom: &'a dyn Fn(f64) -> f64,
    top: &'a dyn Fn(f64) -> f64,
    triangles: bool,
}

/// Nodes, quads, triangles and edges of some bodies.
#[derive(Default)]
struct Parts {
    nodes: serde_json::Map<String, Value>,
    quads: Vec<Value>,
    triangles: Vec<Value>,
    edges: serde_json::Map<String, Value>,
}

impl Parts {
    fn add(&mut self, body: &Body<'_>, turn: f64) {
        let (sine, cosine) = turn.sin_cos();
        let id = |i: usize, j: usize| format!("{}-{i}-{j}", body.id);
        let count = body.columns.len();
        for (i, &x) in body.columns.iter().enumerate() {
            let (low, high) = ((body.bottom)(x), (body.top)(x));
            for j in 0..3 {
                let y = low + (high - low) * j as f64 / 2.0;
                self.nodes.insert(id(i, j), json!([cosine * x - sine * y, sine * x + cosine * y]));
            }
        }
        for i in 0..count - 1 {
            for j in 0..2 {
                let corners = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
                let name = format!("{}-e-{i}-{j}", body.id);
                let rest = json!({"thickness": 1, "material": "m", "plane": "stress"});
                let put = |list: &mut Vec<Value>, id: String, nodes: Vec<&String>| {
                    let mut element = rest.clone();
                    element["id"] = id.into();
                    element["nodes"] = json!(nodes);
                    list.push(element);
                };
                let [a, b, c, d] = &corners;
                if body.triangles {
                    put(&mut self.triangles, format!("{name}-1"), vec![a, b, c]);
                    put(&mut self.triangles, format!("{name}-2"), vec![a, c, d]);
                } else {
                    put(&mut self.quads, name, vec![a, b, c, d]);
                }
            }
        }
        for (name, j) in [("bottom", 0), ("top", 2)] {
            let nodes: Vec<String> = (0..count).map(|i| id(i, j)).collect();
            self.edges.insert(format!("{}-{name}", body.id), json!(nodes));
        }
    }

    fn scenario(self, mut rest: Value) -> Value {
        rest["materials"] = json!({"m": {"E": E, "nu": NU}});
        rest["nodes"] = self.nodes.into();
        rest["quads"] = self.quads.into();
        rest["triangles"] = self.triangles.into();
        rest["edges"] = self.edges.into();
        rest
    }
}

fn even(divisions: usize, length: f64) -> Vec<f64> {
    (0..=divisions).map(|i| length * i as f64 / divisions as f64).collect()
}

/// Two bodies pressed together across a line, all turned by an angle: a uniform stress −p across, whatever the meshes.
/// The sides are free, so u = (ν p x / E, −p (y + 1) / E) in the unturned axes, the same in both
/// bodies; the base is at y = −1.
fn patch(upper: &Body<'_>, lower: &Body<'_>, mortar_is_upper: bool, turn: f64, what: &str) {
    let p = 2.0;
    let mut parts = Parts::default();
    parts.add(upper, turn);
    parts.add(lower, turn);
    let nodes = parts.nodes.clone();
    let (sine, cosine) = turn.sin_cos();
    let mut contact = json!({"id": "joint", "friction": 1, "method": "mortar"});
    let (edge, against) = if mortar_is_upper { ("u-bottom", "l-top") } else { ("l-top", "u-bottom") };
    contact["edge"] = edge.into();
    contact["against"] = against.into();
    // The base slides along itself on rollers: bars would do, supports in turned axes are contacts with a bound of 0.
    let scenario = parts.scenario(json!({
        "supports": [],
        "contacts": [contact, {"id": "base", "edge": "l-bottom", "against": "ground", "law": "bound", "bound": 0},
        ],
        "springs": [{"at": "l-0-0", "direction": [cosine, sine], "stiffness": 1000},
                    {"at": "u-0-2", "direction": [cosine, sine], "stiffness": 0}],
        "loads": {"press": {"items": [{"traction": {"edge": "u-top", "value": [p * sine, -p * cosine]}}]}}
    }));
    let case = Case::json(scenario);
    let answer = case.solve(&[]);
    is_answer(&answer);
    let size = p / E * upper.columns.last().unwrap();
    for (id, place) in &nodes {
        let at = |i: usize| place[i].as_f64().unwrap();
        let (x, y) = (cosine * at(0) + sine * at(1), cosine * at(1) - sine * at(0));
        let [ux, uy, _] = displacement(&answer, id);
        near(&format!("{what}: u along at {id}"), cosine * ux + sine * uy, NU * p * x / E, 1e-10, size);
        near(&format!("{what}: u across at {id}"), cosine * uy - sine * ux, -p * (y + 1.0) / E, 1e-10, size);
    }
    let values = case.scenario.parameter_values();
    assert!(balance::imbalance(&case.scenario, &values, &answer) < 1e-10, "{what}");
    assert!(balance::incompatibility(&case.scenario, &values, &answer) < 1e-10, "{what}");
    // The nodal forces of a uniform traction, where the line is straight: p × tributary length.
    let ours = if mortar_is_upper { &upper.columns } else { &lower.columns };
    let is_straight = (0..=8).all(|k| ((upper.bottom)(0.25 * f64::from(k)) - (upper.bottom)(0.0)).abs() < 1e-12);
    if is_straight {
        for (k, pair) in answer.pairs.iter().filter(|pair| pair.id.starts_with("joint")).enumerate() {
            let left = if k > 0 { ours[k] - ours[k - 1] } else { 0.0 };
            let right = ours.get(k + 1).map_or(0.0, |x| x - ours[k]);
            close(&format!("{what}: x_n {}", pair.id), pair.x_n, p * 0.5 * (left + right), 1e-10);
            near(&format!("{what}: x_t {}", pair.id), pair.x_t, 0.0, 1e-10, p);
        }
    }
}

#[test]
fn the_patch_test_passes_through_the_joint() {
    let flat = |_: f64| 0.0;
    let (up, down) = (|_: f64| 1.0, |_: f64| -1.0);
    // A chain of chords whose corners both bodies have; slopes stay below the friction of 1.
    let bent = |x: f64| -> f64 {
        let places = [(0.0, 0.0), (0.5, 0.25), (1.0, 0.3), (1.5, 0.1), (2.0, 0.0)];
        let k = places.windows(2).position(|ends| x <= ends[1].0).unwrap();
        let [(a, ya), (b, yb)] = [places[k], places[k + 1]];
        ya + (yb - ya) * (x - a) / (b - a)
    };
    let slanted = |x: f64| 0.3 * x;
    let bodies = |line: &dyn Fn(f64) -> f64, columns: [Vec<f64>; 2], triangles: bool, turn: f64, what: &str| {
        for mortar_is_upper in [true, false] {
            let [above, below] = columns.clone();
            let upper = Body { id: "u", columns: above, bottom: line, top: &up, triangles };
            let lower = Body { id: "l", columns: below, bottom: &down, top: line, triangles: false };
            patch(&upper, &lower, mortar_is_upper, turn, &format!("{what}, mortar is upper: {mortar_is_upper}"));
        }
    };
    bodies(&flat, [even(5, 2.0), even(4, 2.0)], false, 0.0, "6 against 5 nodes");
    bodies(&flat, [even(3, 2.0), even(2, 2.0)], false, 0.0, "3 to 2");
    bodies(&flat, [even(1, 2.0), even(7, 2.0)], false, 0.0, "7 to 1");
    bodies(&flat, [vec![0.0, 0.1, 0.7, 1.1, 2.0], even(6, 2.0)], true, 0.0, "triangles against quads");
    bodies(&flat, [even(5, 2.0), even(4, 2.0)], false, 0.7, "turned by 0.7");
    bodies(&slanted, [even(5, 2.0), even(4, 2.0)], true, 0.0, "inclined");
    // With a corner at every node the pairs must belong to the finer side: a force at a corner does not show how its
    // two sides share it.
    let upper = Body { id: "u", columns: even(4, 2.0), bottom: &bent, top: &up, triangles: false };
    let lower = Body { id: "l", columns: even(8, 2.0), bottom: &down, top: &bent, triangles: false };
    patch(&upper, &lower, false, 0.0, "chords, 1 to 2");
    bodies(&bent, [even(12, 2.0), even(8, 2.0)], false, 0.0, "chords, 3 to 2");
    bodies(&bent, [even(8, 2.0), even(20, 2.0)], true, 0.4, "chords, 2 to 5, turned");
}

fn plates(upper: (f64, f64, u32), lower: (f64, f64, u32), rest: Value) -> Value {
    let plate = |id: &str, (x, width, divisions): (f64, f64, u32), y: f64| {
        json!({"id": id, "origin": [x, y], "size": [width, 1], "divisions": [divisions, 4], "thickness": 1,
               "material": "m", "plane": "stress"})
    };
    let mut scenario = json!({
        "materials": {"m": {"E": E, "nu": NU}},
        "plates": [plate("lower", lower, -1.0), plate("upper", upper, 0.0)],
        "supports": [{"at": "lower.bottom", "fixed": ["x", "y"]}],
    });
    for (key, value) in rest.as_object().unwrap() {
        scenario[key] = value.clone();
    }
    scenario
}

/// A block slides at Σ f x_n = f W, whatever lies under it, and tilts about its last node.
#[test]
fn the_friction_limit_of_a_block_is_exact() {
    for (upper, lower) in [((0.0, 2.0, 5), (0.0, 2.0, 4)), ((1.3, 2.0, 3), (0.0, 5.0, 11))] {
        let case = Case::json(plates(
            upper,
            lower,
            json!({
                "parameters": {"H": 0},
                "contacts": [{"id": "joint", "edge": "upper.bottom", "against": "lower.top", "friction": 0.3}],
                "loads": {"weight": {"items": [{"point": {"at": "upper.top", "force": [0, -7]}}]},
                          "push": {"factor": "H", "items": [{"point": {"at": "upper.bottom", "force": [1, 0]}}]}}
            }),
        ));
        let limit = 0.3 * 7.0;
        let held = case.solve(&[("H", limit * (1.0 - 1e-9))]);
        is_answer(&held);
        close("Σ x_n", of_pairs(&held, |pair| pair.x_n).iter().sum(), 7.0, 1e-12);
        let slides = case.solve(&[("H", limit * (1.0 + 1e-9))]);
        let ray = mechanism(&slides);
        // p is what is missing, spread over the pairs: d_τ − f d_n = 1 of cohesion and f of weight in each.
        close("p", ray.p, limit * 1e-9 / (1.3 * slides.pairs.len() as f64), 1e-5);
    }
}

/// The resultant of an eccentric load stands where the load does: Σ x_n s / Σ x_n.
#[test]
fn moments_are_handed_over() {
    let case = Case::json(plates(
        (0.0, 2.0, 5),
        (0.0, 2.0, 4),
        json!({
            "contacts": [{"id": "joint", "edge": "upper.bottom", "against": "lower.top", "friction": 0.5}],
            "loads": {"weight": {"items": [{"point": {"at": "upper[4,4]", "force": [0, -3]}}]}}
        }),
    ));
    let answer = case.solve(&[]);
    is_answer(&answer);
    let (n, moment) = answer
        .pairs
        .iter()
        .fold((0.0, 0.0), |(n, m), pair| (n + pair.x_n, m + pair.x_n * pair.position.expect("a place")[0]));
    close("N", n, 3.0, 1e-12);
    close("where it stands", moment / n, 1.6, 1e-11);
    assert!(answer.pairs.iter().any(|pair| pair.state == State::Open), "the far end opens");
}

/// On nodes that match the dual functions pick one partner each: the same rows as node to node.
#[test]
fn matching_edges_give_the_pairs_of_their_nodes() {
    let with = |method: &str| {
        let rest = json!({
            "contacts": [{"id": "joint", "edge": "upper.bottom", "against": "lower.top", "friction": 0.3, "method": method}],
            "loads": {"weight": {"items": [{"point": {"at": "upper.top", "force": [1.5, -7]}}]}}
        });
        Case::json(plates((0.4, 2.0, 5), (0.0, 2.8, 7), rest))
    };
    let (mortar, nodes) = (with("mortar"), {
        // Node to node: the same edges by their common nodes.
        let mut scenario = plates((0.4, 2.0, 5), (0.0, 2.8, 7), json!({}));
        scenario["edges"] = json!({"top": (1..=6).map(|i| format!("lower[{i},4]")).collect::<Vec<_>>()});
        scenario["contacts"] =
            json!([{"id": "joint", "edge": "upper.bottom", "against": "top", "friction": 0.3, "method": "nodes"}]);
        scenario["loads"] = json!({"weight": {"items": [{"point": {"at": "upper.top", "force": [1.5, -7]}}]}});
        Case::json(scenario)
    });
    let (a, b) = (mortar.solve(&[]), nodes.solve(&[]));
    is_answer(&a);
    assert_eq!(a.pairs.len(), b.pairs.len());
    for (a, b) in a.pairs.iter().zip(&b.pairs) {
        assert_eq!((&a.id, a.state, a.position), (&b.id, b.state, b.position));
        near("x_n", a.x_n, b.x_n, 1e-11, 7.0);
        near("x_t", a.x_t, b.x_t, 1e-11, 7.0);
    }
}

/// Where the other edge ends inside a side, the joint carries a uniform pressure over the common length, and a block that
/// hangs over tilts when its weight leaves it.
#[test]
fn edges_that_overlap_in_part() {
    // The upper block from 0.5 to 2.5 over a lower one from 0 to 2: 1.5 in common, cut in the middle of a side.
    let case = Case::json(plates(
        (0.5, 2.0, 4),
        (0.0, 1.75, 3),
        json!({
            "parameters": {"s": 0},
            "contacts": [{"id": "joint", "edge": "upper.bottom", "against": "lower.top", "friction": 0.5}],
            "loads": {"weight": {"items": [{"point": {"at": "upper[2,4]", "force": [0, -3]}}]},
                      "more": {"factor": "s", "items": [{"point": {"at": "upper[0,4]", "force": [0, -1]}}]}}
        }),
    ));
    let ids: Vec<String> = case.solve(&[]).pairs.iter().map(|pair| pair.id.clone()).collect();
    // Nodes at 0.5, 1, 1.5 lie on the lower block, 2 and 2.5 beyond it: the pair at its end, 1.75, has the number of 2.
    assert_eq!(ids, ["joint[0]", "joint[1]", "joint[2]", "joint[3]"]);
    assert_eq!(case.solve(&[]).pairs[3].position.map(|[x, y, _]| [x, y]), Some([1.75, 0.0]));
    let answer = case.solve(&[("s", 1.0)]);
    is_answer(&answer);
    let values = case.scenario.parameter_values();
    assert!(balance::incompatibility(&case.scenario, &values, &case.solve(&[])) < 1e-10);
    close("Σ x_n", of_pairs(&answer, |pair| pair.x_n).iter().sum(), 4.0, 1e-11);
}

/// A block of width 2 and weight 20 that is pushed at its top, 1 above the joint, tips about the end of what lies below it,
/// whatever the meshes and whichever edge has the pairs: H = 20 · (end − middle of the block) / 1.
#[test]
fn a_block_tips_about_the_end_of_the_common_length() {
    // Left end of the block, H: inside a wall from 0 to 4, and hanging over its right end at 4.
    for (left, limit) in [(1.3, 20.0), (2.5, 10.0)] {
        for divisions in [(4, 4), (5, 4), (7, 5), (8, 3), (16, 6), (40, 1), (1, 6)] {
            for block_has_pairs in [true, false] {
                let (edge, against) =
                    if block_has_pairs { ("upper.bottom", "lower.top") } else { ("lower.top", "upper.bottom") };
                let case = Case::json(plates(
                    (left, 2.0, divisions.1),
                    (0.0, 4.0, divisions.0),
                    json!({
                        "parameters": {"H": 0},
                        "contacts": [{"id": "joint", "edge": edge, "against": against, "friction": 50}],
                        "loads": {"weight": {"items": [{"traction": {"edge": "upper.top", "value": [0, -10]}}]},
                                  "push": {"factor": "H", "items": [{"point": {"at": "upper.top", "force": [1, 0]}}]}}
                    }),
                ));
                let what = format!("{left}, {divisions:?}, pairs of {edge}");
                let held = case.solve(&[("H", limit * (1.0 - 1e-7))]);
                assert_eq!(held.outcome, OutcomeKind::Normal, "{what}: {:?}", held.failure);
                let tips = case.solve(&[("H", limit * (1.0 + 1e-7))]);
                assert!(mechanism(&tips).direction.pairs().iter().any(|pair| pair.z_n != 0.0), "{what}");
                // The resultant stands where the weight and the push put it: at the middle + H/20.
                let held = case.solve(&[("H", 0.37 * limit)]);
                is_answer(&held);
                let sum = |with: &dyn Fn([f64; 3]) -> f64| -> f64 {
                    held.pairs.iter().map(|pair| pair.x_n * with(pair.position.expect("a place"))).sum()
                };
                close(&what, sum(&|[x, _, _]| x) / sum(&|_| 1.0), left + 1.0 + 0.37 * limit / 20.0, 1e-9);
            }
        }
    }
}

/// `resultant joint e` is where the load stands, from the middle of the edge, also where the other edge ends inside a side.
#[test]
fn the_resultant_stands_where_the_load_does() {
    let scenario = plates(
        (0.8, 2.0, 3),
        (0.0, 4.0, 7),
        json!({
            "parameters": {"H": 0},
            "contacts": [{"id": "joint", "edge": "lower.top", "against": "upper.bottom", "friction": 5}],
            "loads": {"weight": {"items": [{"traction": {"edge": "upper.top", "value": [0, -10]}}]},
                      "push": {"factor": "H", "items": [{"point": {"at": "upper.top", "force": [1, 0]}}]}}
        }),
    );
    let mut session = lines::read(&scenario_text(scenario));
    for h in [0.0, 3.0, 15.0] {
        lines::report(&mut session, &format!("set H {h}")).expect("a parameter");
        // the middle of the block at 1.8, that of the wall at 2; a lever of 1 for the push
        let expected = 1.8 + h * 1.0 / 20.0 - 2.0;
        lines::report(&mut session, &format!("expect resultant joint e = {expected} ± 1e-9")).expect("where it stands");
    }
}

/// A parabola y = x²/2R (a cylinder of radius R near its apex) pressed on a flat block of other nodes, gaps from the
/// geometry; frictionless. Hertz: a² = 4 P R / (π E*), p₀ = 2 P / (π a), with 1/E* = 2 (1 − ν²)/E.
#[test]
fn hertz_on_meshes_that_do_not_match() {
    let (radius, force) = (50.0_f64, 4.0_f64);
    let young = E / (2.0 * (1.0 - NU * NU));
    let a = (4.0 * force * radius / (std::f64::consts::PI * young)).sqrt();
    let p0 = 2.0 * force / (std::f64::consts::PI * a);
    // Lines from 0 outwards (symmetry at x = 0) and down, growing; fine over 2 a.
    let lines = |step: f64, growth: f64, end: f64| {
        let (mut at, mut size, mut lines) = (0.0, step, vec![0.0]);
        while at + size < end {
            at += size;
            lines.push(at);
            if at > 1.6 * a {
                size *= growth;
            }
        }
        lines.push(end);
        lines
    };
    let end = 40.0 * a;
    let build = |columns: u32, others: u32, upper_is_mortar: bool| {
        let xs = [lines(a / f64::from(columns), 1.5, end), lines(a / f64::from(others), 1.5, end)];
        let depth = lines(a / f64::from(columns), 1.4, end);
        let mut nodes = serde_json::Map::new();
        let mut quads = Vec::new();
        let mut edges = serde_json::Map::new();
        for (body, xs) in ["u", "l"].into_iter().zip(&xs) {
            for (i, x) in xs.iter().enumerate() {
                for (j, y) in depth.iter().enumerate() {
                    // The upper body starts on the parabola and ends flat.
                    let place = match body {
                        "u" => x * x / (2.0 * radius) * (1.0 - y / end) + y,
                        _ => -y,
                    };
                    nodes.insert(format!("{body}-{i}-{j}"), json!([x, place]));
                }
            }
            for i in 1..xs.len() {
                for j in 1..depth.len() {
                    let (low, high) = if body == "u" { (j - 1, j) } else { (j, j - 1) };
                    let id = |i: usize, j: usize| format!("{body}-{i}-{j}");
                    quads.push(
                        json!({"id": format!("{body}q-{i}-{j}"), "thickness": 1, "material": "m", "plane": "strain",
                        "element": "incompatible",
                        "nodes": [id(i - 1, low), id(i, low), id(i, high), id(i - 1, high)]}),
                    );
                }
            }
            let row = |j: usize| (0..xs.len()).map(|i| format!("{body}-{i}-{j}")).collect::<Vec<_>>();
            edges.insert(format!("{body}-face"), json!(row(0)));
            edges.insert(format!("{body}-far"), json!(row(depth.len() - 1)));
            let middle: Vec<String> = (0..depth.len()).map(|j| format!("{body}-0-{j}")).collect();
            edges.insert(format!("{body}-middle"), json!(middle));
        }
        let (edge, against) = if upper_is_mortar { ("u-face", "l-face") } else { ("l-face", "u-face") };
        Case::json(json!({
            "materials": {"m": {"E": E, "nu": NU}}, "nodes": nodes, "quads": quads, "edges": edges,
            "supports": [{"at": "l-far", "fixed": ["y"]}, {"at": "u-middle", "fixed": ["x"]},
                         {"at": "l-middle", "fixed": ["x"]}],
            "ties": [{"at": "u-far", "fixed": ["y"]}],
            "contacts": [{"id": "joint", "edge": edge, "against": against, "law": "frictionless", "gap": "geometry"}],
            "loads": {"press": {"items": [{"point": {"at": "u-far", "force": [0, -force / 2.0]}}]}}
        }))
    };
    for upper_is_mortar in [true, false] {
        let case = build(12, 9, upper_is_mortar);
        let answer = case.solve(&[]);
        is_answer(&answer);
        let xs: Vec<f64> = answer.pairs.iter().map(|pair| pair.position.expect("a place")[0]).collect();
        let forces = of_pairs(&answer, |pair| pair.x_n);
        let Source::Structure(structure) = &case.scenario.source else { panic!() };
        let upward = structure.pairs.iter().zip(&forces).map(|(pair, force)| pair.normal[1].abs() * force).sum();
        close("P/2", upward, force / 2.0, 1e-10);
        // Pressure from the nodal forces against p₀ √(1 − (x/a)²), within the mesh: 9 to 12 elements over a.
        let mut worst = 0.0_f64;
        for (k, &x) in xs.iter().enumerate().filter(|(_, x)| **x < 0.8 * a) {
            let left = if k > 0 { x - xs[k - 1] } else { 0.0 };
            let pressure = forces[k] / (0.5 * (left + xs[k + 1] - x));
            worst = worst.max((pressure - p0 * (1.0 - (x / a).powi(2)).sqrt()).abs() / p0);
        }
        println!("upper is mortar: {upper_is_mortar}: worst pressure {worst:.4} of p0");
        assert!(worst < 0.02, "{upper_is_mortar}: {worst}");
        let last = xs.iter().zip(&forces).filter(|(_, f)| **f > 0.0).map(|(x, _)| *x).fold(0.0, f64::max);
        println!("ends at {:.4} a", last / a);
        assert!((last / a - 1.0).abs() < 1.0 / 9.0, "contact ends at {last}, Hertz at {a}");
    }
}

/// Gaps from the geometry: matched nodes by their distance, others by that of the weighted places; interference is < 0.
#[test]
fn gaps_from_the_geometry() {
    for (divisions, apart) in [(4, 0.01), (4, -0.02), (5, 0.01), (5, -0.02)] {
        let mut scenario = plates(
            (0.0, 2.0, divisions),
            (0.0, 2.0, 4),
            json!({
                "contacts": [{"id": "joint", "edge": "upper.bottom", "against": "lower.top", "friction": 0.3, "gap": "geometry"}],
                "loads": {"weight": {"items": [{"point": {"at": "upper.top", "force": [0, -7]}}]}}
            }),
        );
        scenario["plates"][1]["origin"] = json!([0, apart]);
        let case = Case::json(scenario);
        let Source::Structure(structure) = &case.scenario.source else { panic!() };
        for pair in &structure.pairs {
            let (_, gap) = pair.law.numbers().into_iter().find(|(key, _)| *key == "gap").unwrap();
            near("gap", gap.value(&case.scenario.parameter_values()), apart, 1e-13, 1.0);
        }
        // The block sinks by the gap and what the load costs: far less.
        let answer = case.solve(&[]);
        is_answer(&answer);
        let [_, uy, _] = displacement(&answer, "upper[0,0]");
        assert!((uy + apart).abs() < 0.012, "{uy}");
        close("Σ x_n", of_pairs(&answer, |pair| pair.x_n).iter().sum(), 7.0, 1e-10);
    }
}
