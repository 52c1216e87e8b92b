//! Structures in space with known answers: a slider on two springs, a block pushed at any angle, a tower in the wind, a
//! twisted cross, a pipe loop.

use serde_json::{Value, json};
use stickslip::session::Session;

use crate::common::lines::{embedded, read, report, text};
use crate::common::{near, scenario_text};

fn told(session: &mut Session, line: &str) -> Value {
    report(session, line).unwrap_or_else(|error| panic!("{line}: {error}"))
}

fn outcome(session: &mut Session) -> String {
    told(session, "solve")["outcome"].as_str().expect("an outcome").to_owned()
}

fn is_answered(session: &mut Session, what: &str) {
    let outcome = outcome(session);
    assert!(outcome == "normal" || outcome == "trivial", "{what}: {outcome}");
}

fn is_certified_collapse(session: &mut Session, what: &str) {
    assert_eq!(outcome(session), "ray", "{what}");
    let verdict = text(session, "show verdict");
    assert!(verdict.contains("certified"), "{what}: {verdict}");
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

fn vector(value: &Value) -> [f64; 2] {
    [number(&value[0]), number(&value[1])]
}

/// x_n, x_τ, z_n, z_τ of every pair obey Coulomb's law with friction f on its cone, to `digits` of the largest force and
/// slip.
fn obeys_coulomb(pairs: &Value, f: f64, digits: f64) {
    let pairs = pairs.as_array().expect("pairs");
    let size = |key: &str| pairs.iter().flat_map(|pair| vector(&pair[key]).map(f64::abs)).fold(0.0, f64::max);
    let force = pairs.iter().map(|pair| number(&pair["x_n"])).fold(size("x_t"), f64::max);
    let slip = size("z_t");
    for pair in pairs {
        let (x_n, z_n) = (number(&pair["x_n"]), number(&pair["z_n"]));
        let ([a, b], [u, v]) = (vector(&pair["x_t"]), vector(&pair["z_t"]));
        assert!(x_n >= -digits * force && z_n >= -digits * slip, "{pair}");
        assert!(x_n <= digits * force || z_n <= digits * slip, "{pair}");
        assert!(a.hypot(b) <= f * x_n + digits * force, "{pair}");
        let moved = u.hypot(v);
        if moved > digits * slip {
            near("x_τ1", a, -f * x_n * u / moved, digits, force);
            near("x_τ2", b, -f * x_n * v / moved, digits, force);
        }
    }
}

/// |F| = 5 > f W = 2: the slider moves towards the pull by (5 − 2)/k, friction stands against it.
#[test]
fn a_slider_on_two_springs_moves_towards_the_pull() {
    let mut session = embedded("bearing-two-way");
    is_answered(&mut session, "at once");
    let moved = told(&mut session, "displacements");
    let node = &moved[0];
    near("u_x", number(&node["ux"]), 1.8, 1e-12, 1.0);
    near("u_y", number(&node["uy"]), 2.4, 1e-12, 1.0);
    let pair = told(&mut session, "pairs")[0].take();
    let [along, across] = vector(&pair["x_t"]);
    near("x_τ1", along, -1.2, 1e-12, 1.0);
    near("x_τ2", across, -1.6, 1e-12, 1.0);
    near("direction", number(&pair["direction"]), (4.0_f64 / 3.0).atan().to_degrees(), 1e-12, 90.0);
    near("x_n", number(&pair["x_n"]), 20.0, 1e-12, 20.0);
    // Pulled with less than f W it stays.
    text(&mut session, "set Fx 1.2");
    text(&mut session, "set Fy 1.599999");
    is_answered(&mut session, "held");
    assert_eq!(told(&mut session, "pairs")[0]["state"], "stick");
}

/// Pulled along a facet the slider slips by (|F| − f W)/k along it on the polygon as on the cone. Rounding leaves a slip along
/// the next facet, 1e-16 of the other, which is no fault of the answer.
#[test]
fn a_pull_along_a_facet_is_answered_on_its_polygon_at_once() {
    let mut session = embedded("bearing-two-way");
    text(&mut session, "set cone off");
    for facets in [6, 12, 16, 32] {
        text(&mut session, &format!("set facets {facets}"));
        for facet in 0..facets {
            let (sine, cosine) = (std::f64::consts::TAU * f64::from(facet) / f64::from(facets)).sin_cos();
            for pull in [3.0, 7.3] {
                text(&mut session, &format!("set Fx {:e}", pull * cosine));
                let said = text(&mut session, &format!("set Fy {:e}", pull * sine)) + &text(&mut session, "solve");
                let what = format!("facet {facet} of {facets}, {pull}: {said}");
                assert!(!said.contains("led to it"), "{what}");
                let [along, across] = vector(&told(&mut session, "pairs")[0]["z_t"]);
                near(&what, along, (pull - 2.0) * cosine, 1e-12, 1.0);
                near(&what, across, (pull - 2.0) * sine, 1e-12, 1.0);
            }
        }
    }
}

/// Friction has no favourite direction: the block slides at P = f W whatever the angle, W = 25 · 1 · 0.8 · 0.4.
#[test]
fn a_block_slides_at_f_times_its_weight_at_every_angle() {
    let weight = 25.0 * 0.8 * 0.4;
    for degrees in [0.0_f64, 17.0, 45.0, 90.0, 201.0] {
        let mut session = embedded("block-3d");
        text(&mut session, &format!("set alpha {}", degrees.to_radians()));
        text(&mut session, &format!("set P {}", 0.5 * weight * (1.0 - 1e-6)));
        is_answered(&mut session, &format!("{degrees}°"));
        obeys_coulomb(&told(&mut session, "pairs"), 0.5, 1e-9);
        text(&mut session, &format!("set P {}", 0.5 * weight * (1.0 + 1e-5)));
        is_certified_collapse(&mut session, &format!("{degrees}°"));
    }
}

/// Moments about the two lee feet: H h cos α = G b/2 (α ≤ 45°); with f = 0.4 nothing slides before.
#[test]
fn a_tower_tips_over_its_lee_feet() {
    for degrees in [0.0_f64, 23.0, 45.0] {
        let alpha = degrees.to_radians();
        let tips = 120.0 * 4.0 / 2.0 / 12.0 / alpha.cos();
        let mut session = embedded("tower");
        text(&mut session, &format!("set alpha {alpha}"));
        text(&mut session, &format!("set H {}", tips * (1.0 - 1e-6)));
        is_answered(&mut session, &format!("{degrees}°"));
        let pairs = told(&mut session, "pairs");
        obeys_coulomb(&pairs, 0.4, 1e-9);
        let carried: f64 = pairs.as_array().expect("pairs").iter().map(|pair| number(&pair["x_n"])).sum();
        near("Σ x_n", carried, 120.0, 1e-9, 120.0);
        text(&mut session, &format!("set H {}", tips * (1.0 + 1e-5)));
        is_certified_collapse(&mut session, &format!("{degrees}°"));
    }
}

/// A cross of four arms of the same length, each foot with its own weight: the twist M that turns it is Σ f N r. Balance
/// alone proves it, for the feet carry Σ N r whatever their shares.
#[test]
fn a_cross_turns_at_the_sum_of_friction_times_radius() {
    let (arms, weights, f) = ([2.0; 4], [10.0, 20.0, 10.0, 20.0], 0.3);
    let limit: f64 = std::iter::zip(arms, weights).map(|(r, n)| f * n * r).sum();
    let directions = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let mut nodes = serde_json::Map::new();
    nodes.insert("hub".to_owned(), json!([0, 0, 0]));
    let (mut bars, mut contacts, mut weight) = (Vec::new(), Vec::new(), Vec::new());
    for (i, ([x, y], r)) in std::iter::zip(directions, arms).enumerate() {
        let foot = format!("foot{i}");
        nodes.insert(foot.clone(), json!([r * x, r * y, 0]));
        bars.push(json!({ "id": format!("arm{i}"), "nodes": ["hub", foot], "material": "steel", "section": "arm" }));
        contacts.push(
            json!({ "id": format!("c{i}"), "node": foot, "against": "ground", "normal": [0, 0, 1], "friction": f }),
        );
        weight.push(json!({ "point": { "at": foot, "force": [0, 0, -weights[i]] } }));
    }
    let scenario = json!({
        "dimension": 3,
        "parameters": { "M": 1.0 },
        "materials": { "steel": { "E": 2e8, "nu": 0.3 } },
        "sections": { "arm": { "area": 0.01, "inertia_y": 1e-4, "inertia_z": 1e-4, "torsion": 1e-4 } },
        "nodes": nodes, "bars": bars, "contacts": contacts,
        "loads": {
            "weight": { "items": weight },
            "twist": { "factor": "M", "items": [{ "point": { "at": "hub", "force": [0, 0, 0], "moment": [0, 0, 1] } }] },
        },
    });
    let mut session = read(&scenario_text(scenario));
    text(&mut session, &format!("set M {}", limit * (1.0 - 1e-6)));
    is_answered(&mut session, "twisted");
    obeys_coulomb(&told(&mut session, "pairs"), f, 1e-9);
    text(&mut session, &format!("set M {}", limit * (1.0 + 1e-5)));
    is_certified_collapse(&mut session, "twisted");
}

/// The loop is symmetric about x = 21: so are its forces; every support carries its share, and without friction none
/// resists.
#[test]
fn a_pipe_loop_is_symmetric_and_carries_its_weight() {
    let mut session = embedded("pipe-loop");
    for f in [0.0, 0.1, 0.3, 0.8] {
        text(&mut session, &format!("set f {f}"));
        is_answered(&mut session, &format!("f = {f}"));
        let pairs = told(&mut session, "pairs");
        obeys_coulomb(&pairs, f, 1e-9);
        let of = |i: usize| (number(&pairs[i]["x_n"]), vector(&pairs[i]["x_t"]), vector(&pairs[i]["z_t"]));
        for (left, right) in [(0, 7), (1, 6), (2, 5), (3, 4)] {
            let (a, b) = (of(left), of(right));
            near("x_n", a.0, b.0, 1e-9, 1.0);
            near("x_τ1", a.1[0], -b.1[0], 1e-9, 1.0);
            near("x_τ2", a.1[1], b.1[1], 1e-9, 1.0);
            near("z_τ1", a.2[0], -b.2[0], 1e-9, 1e-2);
            near("z_τ2", a.2[1], b.2[1], 1e-9, 1e-2);
        }
        let reactions = told(&mut session, "reactions");
        let sum = |key: &str| reactions.as_array().expect("rows").iter().map(|row| number(&row[key])).sum::<f64>();
        let carried: f64 = (0..8).map(|i| of(i).0).sum();
        // 54 m of pipe of 0.75 kN/m.
        near("weight", carried + sum("fz"), 54.0 * 0.75, 1e-9, 40.0);
        let across: f64 = (0..8).map(|i| of(i).1[1]).sum();
        near("across", across + sum("fy"), 0.0, 1e-9, 40.0);
    }
}

/// The slider as a contact system: λ_τ = k z_τ − F. `dimension` may say what the tangents say.
#[test]
fn a_contact_system_in_space_may_say_its_dimension() {
    let given = |dimension: Option<i32>, tangents: Option<i32>| {
        let mut system = json!({
            "pairs": ["slider"], "stiffness": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "friction": [0.1],
            "loads": { "all": { "vector": [20, -3, -4] } },
        });
        let mut file = json!({});
        if let Some(tangents) = tangents {
            system["tangents"] = json!(tangents);
        }
        if let Some(dimension) = dimension {
            file["dimension"] = json!(dimension);
        }
        file["contact_system"] = system;
        file
    };
    for (dimension, tangents) in [(None, Some(2)), (Some(3), Some(2)), (Some(3), None)] {
        let mut session = read(&scenario_text(given(dimension, tangents)));
        is_answered(&mut session, "slider");
        let [along, across] = vector(&told(&mut session, "pairs")[0]["z_t"]);
        near("z_τ1", along, 1.8, 1e-12, 1.0);
        near("z_τ2", across, 2.4, 1e-12, 1.0);
    }
}
