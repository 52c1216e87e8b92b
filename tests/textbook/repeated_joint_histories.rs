//! Load histories over joints that repeat one another.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use stickslip::answer::record::Verdict;
use stickslip::path::stages::{Begin, History, HistoryEnd, follow, follow_factors};

use super::guides::{EA, EI, L, guide};
use super::repeated_joints::corner;
use crate::common::*;

fn history(case: &Case, stages: &[[f64; 2]]) -> History {
    let values = case.scenario.parameter_values();
    let targets: Vec<Vec<f64>> = stages.iter().map(|stage| stage.to_vec()).collect();
    follow_factors(case.prepared.case(&case.scenario, &values), &Begin::Unloaded, &targets)
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Pressed with P = 1 on its low side, then pulled to and fro. Friction bound r = f (P − k g₁). Pulled by T the tip slips by
/// s = (T − r)/k_a; unloaded it stays, held by k_a s = T − r; pulled back by −T it slips to −s, from k_a s − r on.
#[test]
fn history_of_a_guide() {
    let (k, k_a) = (3.0 * EI / L.powi(3), EA / L);
    let (pull, r) = (0.5, 0.3 * (1.0 - k * 0.01));
    let s = (pull - r) / k_a;
    for angle in [0.0, 0.7] {
        let case = guide(angle);
        let found = history(&case, &[[1.0, 0.0], [1.0, pull], [1.0, 0.0], [1.0, -pull], [1.0, pull]]);
        assert_eq!(found.end, HistoryEnd::Complete);
        let slips = [0.0, s, s, -s, s];
        let friction = [0.0, -r, k_a * s, r, -r];
        for ((stage, slip), friction) in found.stages.iter().zip(slips).zip(friction) {
            is_answer(&stage.end);
            let [low, up] = &stage.end.pairs[..] else { panic!() };
            near("slip", low.z_t, slip, 1e-12, s);
            near("slip", up.z_t, -slip, 1e-12, s);
            near("friction", low.x_t, friction, 1e-11, 1.0);
            near("x_n", low.x_n, 1.0 - k * 0.01, 1e-12, 1.0);
            near("z_n", up.z_n, 0.03, 1e-12, 0.03);
            assert!(stage.energy.expect("a structure").residual < 1e-11);
        }
        // Dissipated: r times the way slipped.
        for (stage, way) in found.stages.iter().zip([0.0, s, 0.0, 2.0 * s, 2.0 * s]) {
            near("dissipated", stage.dissipated, r * way, 1e-11, r * s);
        }
        // Where the reversal begins.
        let moments = &found.stages[3].moments;
        let begins = moments[1].factors[1];
        near("reversal", begins, k_a * s - r, 1e-11, 1.0);
    }
}

/// Any history of the guide with press and pull, against the same with stiff springs in series with its sides, which has
/// independent joints and is followed by the rate problem.
#[test]
fn histories_with_springs_in_series_come_near() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    for angle in [0.0, 1.0] {
        let case = guide(angle);
        let mut value: Value = serde_json::from_str(&case.scenario.text).expect("json");
        for (i, id) in ["p", "q"].iter().enumerate() {
            value["nodes"][id] = value["nodes"]["B"].clone();
            value["contacts"][i]["against"] = (*id).into();
            for direction in [[1, 0], [0, 1]] {
                let spring = json!({ "at": id, "direction": direction, "stiffness": 1e7 });
                match value["springs"].as_array_mut() {
                    Some(springs) => springs.push(spring),
                    None => value["springs"] = json!([spring]),
                }
            }
        }
        let sprung = Case::json(value);
        for _ in 0..10 {
            let stages: Vec<[f64; 2]> =
                (0..5).map(|_| [rng.random_range(-1.0..1.0), rng.random_range(-0.8..0.8)]).collect();
            let (a, b) = (history(&case, &stages), history(&sprung, &stages));
            assert_eq!((&a.end, &b.end), (&HistoryEnd::Complete, &HistoryEnd::Complete));
            for (a, b) in a.stages.iter().zip(&b.stages) {
                for (a, b) in a.end.pairs.iter().zip(&b.end.pairs) {
                    near("x_n", a.x_n, b.x_n, 1e-4, 1.0);
                    near("x_t", a.x_t, b.x_t, 1e-4, 1.0);
                    near("z_n", a.z_n, b.z_n, 1e-3, 0.01);
                    near("z_t", a.z_t, b.z_t, 1e-3, 0.01);
                }
            }
        }
    }
}

/// Blocks pushed beyond what their beds hold: the history ends where the limit is.
#[test]
fn a_history_of_the_corner_ends_at_its_limit() {
    let found = history(&corner(0.2), &[[1.0, 0.0], [1.0, 0.5]]);
    let HistoryEnd::Limit { stage, t, collapse } = &found.end else { panic!("{:?}", found.end) };
    assert_eq!(*stage, 1);
    near("place", *t, 0.8, 1e-9, 1.0);
    assert_eq!(collapse.verdict, Some(Verdict::Certified));
}

fn followed(value: Value) -> History {
    let case = Case::json(value);
    follow(case.prepared.case(&case.scenario, &case.scenario.parameter_values()))
        .unwrap_or_else(|error| panic!("{error}"))
}

fn point(at: &str, force: [f64; 2]) -> Value {
    json!({ "items": [{ "point": { "at": at, "force": force } }] })
}

/// Laws at every place that is shown, to a share of the largest force: |x_τ| ≤ f x_n, and nothing where a pair is open.
fn obeys_everywhere(history: &History) {
    let moments = || history.stages.iter().flat_map(|stage| &stage.moments);
    let largest = moments().flat_map(|moment| &moment.pairs).fold(0.0, |most: f64, pair| most.max(pair.x_n));
    for (moment, pair) in moments().flat_map(|moment| moment.pairs.iter().map(move |pair| (moment, pair))) {
        let [over, open] =
            [pair.x_t.abs() - pair.bound, if pair.z_n > 0.0 { pair.x_n.abs() + pair.x_t.abs() } else { 0.0 }];
        assert!(pair.x_n >= 0.0 && over.max(open) <= 1e-11 * largest, "at {}: {pair:?}", moment.t);
    }
}

/// Two blocks side by side on a third, whose corners meet at one node, all rough: f = 1/2 below. A force that pushes one against the
/// other shifts both where |F_x| = f (20 − F_y), whatever heat does to them. Shortly before, the pairs of that corner open; the
/// program that looks for forces at rest missed what has to be 0 there by 5e-4 of the forces, and the history went on with these.
#[test]
fn blocks_whose_corner_opens_are_shifted_at_their_friction() {
    let plate = |id: &str, origin: [f64; 2], size: [f64; 2], divisions: [u32; 2]| json!({ "id": id, "origin": origin, "size": size, "divisions": divisions, "thickness": 1, "material": "a", "plane": "strain" });
    let below = |id: &str, node: &str, against: &str| json!({ "id": id, "node": node, "against": against, "normal": [0, 1], "friction": 0.5 });
    let beside = |row: usize, gap: f64| {
        let [node, against] = ["c[0", "b[1"].map(|corner| format!("{corner},{row}]"));
        json!({ "id": format!("j{row}"), "node": node, "against": against, "normal": [1, 0], "friction": 0.3, "gap": gap })
    };
    let [x, y] = [-14.11, -0.9246];
    let history = followed(json!({
        "materials": { "a": { "E": 1e6, "nu": 0.2, "density": 1, "expansion": 1e-5 } },
        "plates": [
            plate("f", [0.0, 0.0], [2.0, 0.5], [2, 1]),
            plate("b", [0.0, 0.5], [1.0, 1.0], [1, 2]),
            plate("c", [1.0, 0.5], [1.0, 1.0], [1, 2])
        ],
        "supports": [{ "at": "f.bottom", "fixed": ["x", "y"] }],
        "contacts": [
            below("b0", "b[0,0]", "f[0,1]"), below("c0", "c[0,0]", "f[1,1]"), below("b1", "b[1,0]", "f[1,1]"),
            below("c1", "c[1,0]", "f[2,1]"), beside(0, 0.0), beside(1, 1e-5), beside(2, 0.0)
        ],
        "loads": {
            "w": { "items": [{ "gravity": { "acceleration": [0, -10] } }] },
            "p": point("c.top", [x, y]),
            "t": { "items": [{ "temperature": { "change": 30, "on": ["c"] } }] }
        },
        "stages": [{ "w": 1 }, { "w": 1, "p": 0.5 }, { "w": 1, "p": 1, "t": 0.5 }]
    }));
    let HistoryEnd::Limit { stage: 2, collapse, .. } = &history.end else { panic!("{:?}", history.end) };
    assert_eq!(collapse.verdict, Some(Verdict::Certified));
    obeys_everywhere(&history);
    let push = history.cases.iter().position(|case| case == "p").expect("a load");
    near("push", history.stages[2].factors()[push], 0.5 * 20.0 / (-x + 0.5 * y), 1e-9, 1.0);
}

/// A cold block between four walls that it touches as it was built warms until all of them are closed again at once: it stands as it
/// was built then, and goes on so. What rounding left of its displacements was another state there, to which it "jumped".
#[test]
fn a_block_that_fills_its_walls_again_does_not_jump() {
    let wall = |id: &str, side: &str, friction: f64| json!({ "id": id, "edge": format!("b.{side}"), "against": "ground", "friction": friction });
    let history = followed(json!({
        "materials": { "a": { "E": 1e6, "nu": 0.2, "density": 1, "expansion": 1e-5 } },
        "plates": [{
            "id": "b", "origin": [0, 0], "size": [1, 1], "divisions": [2, 1], "thickness": 1, "material": "a", "plane": "stress"
        }],
        "contacts": [wall("fl", "bottom", 0.0), wall("wl", "right", 0.0), wall("tp", "top", 0.0), wall("lf", "left", 0.5)],
        "loads": {
            "w": { "items": [{ "gravity": { "acceleration": [0, -10] } }] },
            "p": point("b.left", [5.702, 3.852]),
            "t": { "items": [{ "temperature": { "change": 10, "on": ["b"] } }] }
        },
        "stages": [{ "w": 1 }, { "w": 1, "p": 1, "t": -1 }, { "w": 1, "p": 1, "t": 1 }]
    }));
    assert_eq!(history.end, HistoryEnd::Complete);
    obeys_everywhere(&history);
    assert!(history.stages.iter().flat_map(|stage| &stage.moments).all(|moment| !moment.jump));
    let (cold, warm) = (&history.stages[1], &history.stages[2].end);
    assert!(warm.is_answer(), "{:?}", warm.failure);
    for pair in &warm.pairs {
        near(&pair.id, pair.z_n.abs() + pair.z_t.abs(), 0.0, 1e-12, cold.max_slip());
    }
}

/// A bar on two feet under ceilings that it never touches, on a spring along it, pushed by P until both feet slide (f N = 0.3 each) and
/// to the other side: z = ±(P − 0.6) / k. Floor and ceiling of a node repeat one another; at the second foot's limit the run under
/// the default covering ended in a ray for some divisions of the bar, and the history was given up; or what the slips before had left by
/// rounding was taken for a jump.
#[test]
fn ceilings_that_are_never_touched_end_no_history() {
    for (divisions, stiffness) in [(1, 3.0), (2, 30.0), (2, 1.0), (4, 1.0), (6, 10.0)] {
        let contact = |id: &str, node: &str, up: f64, gap: f64| json!({ "id": id, "node": node, "against": "ground", "normal": [0, up], "friction": 0.3, "gap": gap });
        let weight = |at: &str| json!({ "point": { "at": at, "force": [0, -1] } });
        let push = 1.0;
        let found = followed(json!({
            "materials": { "steel": { "E": 2e7, "nu": 0.3 } },
            "sections": { "s": { "area": 0.01, "inertia": 0.0001 } },
            "nodes": { "n0": [0, 0], "n1": [2, 0] },
            "bars": [{ "id": "b", "nodes": ["n0", "n1"], "material": "steel", "section": "s", "divisions": divisions }],
            "springs": [{ "at": "n0", "direction": [1, 0], "stiffness": stiffness }],
            "contacts": [
                contact("u0", "n0", 1.0, 0.0), contact("o0", "n0", -1.0, 0.001),
                contact("u1", "n1", 1.0, 0.0), contact("o1", "n1", -1.0, 0.001)
            ],
            "loads": {
                "w": { "items": [weight("n0"), weight("n1")] },
                "p": { "items": [{ "point": { "at": "n0", "force": [push, 0] } }] }
            },
            "stages": [{ "w": 1 }, { "w": 1, "p": 1 }, { "w": 1, "p": 0 }, { "w": 1, "p": -1 }]
        }));
        assert_eq!(found.end, HistoryEnd::Complete, "{divisions} {stiffness}");
        let slips = [1, 3].map(|stage: usize| found.stages[stage].end.pairs[0].z_t);
        let expected = (push - 0.6) / stiffness;
        near("there", slips[0], expected, 1e-9, expected);
        near("back", slips[1], -expected, 1e-9, expected);
        assert!(
            found.stages.iter().flat_map(|stage| &stage.moments).all(|moment| !moment.jump),
            "{divisions} {stiffness}"
        );
    }
}

/// A slab on rough ground, W = 20 and f = 0.5, with a stop 2 before one of its feet, pushed by 10 = f W and more: it slides all the
/// way to the stop at once, which takes f W · 2 = 20 of the work besides what little the slab slipped before, and stands there.
/// The foot's slip and the gap of the stop repeat one another; under the default covering no run found the state at the stop.
/// With f = 1.4 its first feet lift before it slides, and no run found it under any covering.
#[test]
fn what_slides_to_a_stop_jumps_there() {
    for friction in [0.5, 1.4] {
        slides_to_its_stop(friction);
    }
}

fn slides_to_its_stop(friction: f64) {
    let found = followed(json!({
        "materials": { "stiff": { "E": 30, "nu": 0.2 } },
        "plates": [{
            "id": "slab", "origin": [0, 0], "size": [2000, 400], "divisions": [4, 1], "thickness": 1000, "material": "stiff",
            "plane": "stress"
        }],
        "contacts": [
            { "id": "bed", "edge": "slab.bottom", "against": "ground", "friction": friction },
            { "id": "stop", "node": "slab[4,0]", "against": "ground", "normal": [-1, 0], "friction": 0, "gap": 2 }
        ],
        "loads": {
            "w": { "items": [{ "pressure": { "edge": "slab.top", "value": 1e-5 } }] },
            "h": { "items": [{ "point": { "at": "slab[0,1]", "force": [10, 0] } }] }
        },
        "stages": [{ "w": 1 }, { "w": 1, "h": 1 }, { "w": 1, "h": 3 }]
    }));
    assert_eq!(found.end, HistoryEnd::Complete);
    let stage = &found.stages[2];
    assert_eq!(stage.moments.iter().filter(|moment| moment.jump).count(), 1);
    let of = |id: &str| stage.end.pairs.iter().find(|pair| pair.id == id).expect("a pair");
    assert_eq!(of("stop").z_n, 0.0);
    near("slip", of("bed[4]").z_t, 2.0, 1e-12, 2.0);
    // The slab is 30 · 1000 · 400 stiff along 2000: 30 of push shorten it by 0.005.
    near("lost", stage.dissipated, friction * 20.0 * 2.0, 0.005, 20.0);
}

/// A node between a floor 1 mm below and a ceiling that it would have to be 1.5 mm below: 1 − 1.5 mm is the room of both,
/// wherever it moves.
#[test]
fn a_history_of_parts_that_do_not_fit_names_them() {
    let side = |id: &str, y: i32, gap: f64| json!({ "id": id, "node": "n", "against": "ground", "normal": [0, y], "friction": 0.3, "gap": gap });
    let case = Case::json(json!({
        "materials": { "m": { "E": 1e5, "nu": 0 } },
        "sections": { "s": { "area": 0.01, "inertia": 1e-4 } },
        "nodes": { "root": [0, 0], "n": [2, 0] },
        "bars": [{ "id": "bar", "nodes": ["root", "n"], "material": "m", "section": "s" }],
        "supports": [{ "at": "root", "fixed": ["x", "y", "r"] }],
        "contacts": [side("floor", 1, 0.001), side("ceiling", -1, -0.0015)],
        "loads": { "P": { "items": [{ "point": { "at": "n", "force": [0, -1] } }] } }
    }));
    let values = case.scenario.parameter_values();
    let refused = follow_factors(case.prepared.case(&case.scenario, &values), &Begin::Unloaded, &[vec![1.0]])
        .expect_err("no room");
    let expected = "the parts cannot be put together: whatever moves, the distances of pairs floor and ceiling sum up to -0.0005, \
                    and none of them may be negative";
    assert!(refused.to_string().ends_with(expected), "{refused}");
}
