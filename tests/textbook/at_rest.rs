//! Rigid bodies on repeated joints that stand at rest by a self-stress which pivots pass by.
//!
//! ```text
//!        P →┌───────────────┐ W
//!           └┬────┬────┬────┬┘
//!            0    1    2    3     feet with different friction: what the middle ones carry is free
//! ```

use serde_json::{Value, json};
use stickslip::answer::record::{Answer, Verdict};
use stickslip::path::limit::{Limit, limit};
use stickslip::path::stages::{Begin, History, HistoryEnd, follow_factors};

use crate::common::laws::violation;
use crate::common::lines::{read, report, text};
use crate::common::*;

/// Friction of the feet at 0, 1, 2, 3.
const FEET: [f64; 4] = [0.5, 0.2, 0.3, 0.6];
/// Weight, its place, the height of the push.
const BLOCK: [f64; 3] = [10.0, 1.2, 0.3];

fn foot(id: &str, node: &str, friction: f64) -> Value {
    json!({ "id": id, "node": node, "against": "ground", "normal": [0, 1], "friction": friction })
}

/// The block with one more foot, which is `gap` short of the ground, and could not hold more than those beside it.
fn block(gap: f64) -> Value {
    let [weight, place, height] = BLOCK;
    let mut contacts: Vec<Value> =
        FEET.iter().enumerate().map(|(i, f)| foot(&format!("c{i}"), &format!("k{i}"), *f)).collect();
    contacts.push(foot("short", "k4", 0.5));
    contacts[4]["gap"] = gap.into();
    contacts[3]["friction"] = "f".into();
    json!({
        "parameters": { "P": 1, "f": FEET[3] },
        "nodes": { "k0": [0, 0], "k1": [1, 0], "k2": [2, 0], "k3": [3, 0], "k4": [1.5, 0], "pushed": [0, height], "top": [place, 0.5] },
        "contacts": contacts,
        "rigid": [{ "id": "block", "nodes": ["k0", "k1", "k2", "k3", "k4", "pushed", "top"] }],
        "loads": {
            "own": { "items": [{ "point": { "at": "top", "force": [0, -weight] } }] },
            "push": { "factor": "P", "items": [{ "point": { "at": "pushed", "force": [1, 0] } }] }
        }
    })
}

fn of_push(case: &Case) -> Limit {
    let values = case.scenario.parameter_values();
    let solved = case.solved(&[], case.scenario.rules);
    limit(case.prepared.case(&case.scenario, &values), Some(&solved), "push").expect("a limit")
}

fn sum(answer: &Answer, read: impl Fn(&stickslip::answer::record::PairState) -> f64) -> f64 {
    answer.pairs.iter().map(read).sum()
}

/// Proved on the far side, and there to 1e-7.
#[track_caller]
fn is_limit(found: &Limit, expected: f64) {
    close("limit", found.factor.expect("a limit"), expected, 1e-7);
    assert!(found.confirmed, "{found:?}");
    let collapse = found.collapse().expect("a collapse");
    assert_eq!(collapse.verdict, Some(Verdict::Certified), "{collapse:?}");
    assert!(found.beyond_sentence().is_some_and(|said| said.contains("proved")), "{found:?}");
}

/// Σ x_n = W and Σ x_n x = W x_W + P h put the centre of pressure to X = x_W + P h/W, and Σ f x_n is largest with all of it
/// in the outer feet, on the chord of f over x: P = W (f_0 + (f_3 − f_0) X/3), which no self-stress exceeds.
#[test]
fn a_rigid_block_stands_as_long_as_some_self_stress_holds_it() {
    let [weight, place, height] = BLOCK;
    let rise = (FEET[3] - FEET[0]) / 3.0;
    let expected = weight * (FEET[0] + rise * place) / (1.0 - rise * height);
    let case = Case::json(block(0.01));
    for push in [2.5, 2.6, 4.0, expected * (1.0 - 1e-7)] {
        let answer = case.solve(&[("P", push)]);
        is_answer(&answer);
        near("pressed", sum(&answer, |pair| pair.x_n), weight, 1e-12, weight);
        near("held", sum(&answer, |pair| pair.x_t), -push, 1e-12, push);
        let turned: f64 = answer.pairs.iter().zip(0..4).map(|(pair, x)| f64::from(x) * pair.x_n).sum();
        near("turned", turned, weight * place + push * height, 1e-12, turned);
        assert!(answer.pairs.iter().all(|pair| pair.z_t == 0.0), "{:?}", answer.pairs);
        close("gap", answer.pairs[4].z_n, 0.01, 1e-12);
        near("laws", violation(&case.scenario, &case.scenario.parameter_values(), &answer), 0.0, 1e-12, 1.0);
    }
    assert_eq!(mechanism(&case.solve(&[("P", expected * (1.0 + 1e-7))])).verdict, Some(Verdict::Certified));
    is_limit(&of_push(&case), expected);
}

/// Weight on the runner and its friction; EA/L of its rod.
const RUNNER: [f64; 2] = [2.0, 0.25];
const ROD: f64 = 1e4 * 0.5 / 2.0;

/// The push reaches the block at the ground, through a bar from a runner of its own that slips beside it.
fn behind_a_runner() -> Value {
    let [pressed, friction] = RUNNER;
    let mut value = block(0.0);
    value["nodes"]["runner"] = json!([-2, 0]);
    value["materials"] = json!({ "m": { "E": 1e4, "nu": 0 } });
    value["sections"] = json!({ "s": { "area": 0.5 } });
    value["bars"] =
        json!([{ "id": "rod", "kind": "truss", "nodes": ["runner", "k0"], "material": "m", "section": "s" }]);
    let contacts = value["contacts"].as_array_mut().expect("pairs");
    contacts.pop();
    contacts.push(foot("under", "runner", friction));
    value["loads"]["own"]["items"]
        .as_array_mut()
        .expect("items")
        .push(json!({ "point": { "at": "runner", "force": [0, -pressed] } }));
    value["loads"]["push"]["items"] = json!([{ "point": { "at": "runner", "force": [1, 0] } }]);
    value
}

/// What is left of the push behind the runner is held by the block, P − f w = W (f_0 + (f_3 − f_0) x_W/3) at its limit.
#[test]
fn what_slips_beside_a_body_at_rest() {
    let ([weight, place, _], [pressed, friction]) = (BLOCK, RUNNER);
    let case = Case::json(behind_a_runner());
    let expected = friction * pressed + weight * (FEET[0] + (FEET[3] - FEET[0]) / 3.0 * place);
    for share in [0.6, 0.9, 1.0 - 1e-7] {
        let push = share * expected;
        let answer = case.solve(&[("P", push)]);
        is_answer(&answer);
        let runner = answer.pairs.last().expect("the runner");
        close("slipping", runner.x_t, -friction * pressed, 1e-12);
        close("slip", runner.z_t, (push - friction * pressed) / ROD, 1e-9);
        near("held", sum(&answer, |pair| pair.x_t), -push, 1e-12, push);
    }
    is_limit(&of_push(&case), expected);
}

/// Weight of the plate and friction of its feet.
const PLATE: (f64, [f64; 4]) = (12.0, [0.5, 0.3, 0.2, 0.4]);

/// A plate on four feet at the corners of a rectangle, W and the push through its centre: x_n = W/4 ± s, and friction along
/// the push is no more than Σ f x_n = (Σ f) W/4, whatever s is, for the sums of f over both diagonals are equal. That is
/// reached where it does not turn the plate: −f_0 x_0 − f_1 x_1 + f_2 x_2 + f_3 x_3 = 0 with s = −W/8.
fn plate() -> Case {
    let (weight, frictions) = PLATE;
    let places = [[0, 0, 0], [4, 0, 0], [4, 3, 0], [0, 3, 0]];
    let nodes: Vec<String> = (0..4).map(|i| format!("k{i}")).collect();
    let mut value = json!({
        "dimension": 3,
        "parameters": { "P": 1 },
        "nodes": { "centre": [2, 1.5, 0] },
        "contacts": nodes.iter().zip(frictions).map(|(node, f)| json!({ "node": node, "id": format!("on_{node}"),
            "against": "ground", "normal": [0, 0, 1], "friction": f })).collect::<Vec<_>>(),
        "rigid": [{ "id": "plate", "nodes": ["k0", "k1", "k2", "k3", "centre"] }],
        "loads": {
            "own": { "items": [{ "point": { "at": "centre", "force": [0, 0, -weight] } }] },
            "push": { "factor": "P", "items": [{ "point": { "at": "centre", "force": [1, 0, 0] } }] }
        }
    });
    nodes.iter().zip(places).for_each(|(node, place)| value["nodes"][node] = json!(place));
    Case::json(value)
}

#[test]
fn a_plate_on_four_feet_in_space() {
    let (case, (weight, frictions)) = (plate(), PLATE);
    let expected = frictions.iter().sum::<f64>() * weight / 4.0;
    let [a, b, c, d] = frictions;
    let s = weight / 4.0 * (c + d - a - b) / (a - b - c + d);
    close("s", s, -weight / 8.0, 1e-14);
    for share in [0.9, 0.99, 1.0 - 1e-6] {
        let answer = case.solve(&[("P", share * expected)]);
        is_answer(&answer);
        assert!(answer.polygon.is_some_and(|polygon| polygon.cone));
        near("pressed", sum(&answer, |pair| pair.x_n), weight, 1e-12, weight);
        near("held", sum(&answer, |pair| pair.friction()[0]), -share * expected, 1e-12, expected);
        near("aside", sum(&answer, |pair| pair.friction()[1]), 0.0, 1e-12, expected);
        let bound = |pair: usize| frictions[pair] * answer.pairs[pair].x_n;
        let held = |pair: usize| answer.pairs[pair].friction()[0].hypot(answer.pairs[pair].friction()[1]);
        assert!((0..4).all(|pair| held(pair) <= bound(pair) * (1.0 + 1e-12)), "{:?}", answer.pairs);
    }
    is_limit(&of_push(&case), expected);
    // Its history rests up to there.
    let found = history(&case, &[0.0, 0.9 * expected, -0.5 * expected, 2.0 * expected]);
    assert!(found.stages.iter().all(|stage| stage.end.pairs.iter().all(|pair| pair.slip() == [0.0; 2])));
    ends_at(&found, 3, [-0.5 * expected, 2.0 * expected, expected], 1e-7);
}

/// What starts from an answer that no pivots led to: each command says what is so of it.
#[test]
fn an_answer_at_rest_is_an_answer_to_every_command() {
    let [weight, place, height] = BLOCK;
    let rise = (FEET[3] - FEET[0]) / 3.0;
    let expected = weight * (FEET[0] + rise * place) / (1.0 - rise * height);
    let mut session = read(&scenario_text(block(0.01)));
    text(&mut session, "set P 4");
    let path = report(&mut session, "trace push").expect("a path");
    assert!(path["limit"].is_null() && path["from_zero"] == true, "{path}");
    assert!(path["answer_beyond"].as_f64().is_some_and(|beyond| beyond < expected), "{path}");
    let said = text(&mut session, "trace push");
    assert!(said.contains("no pivots lead on from the answer at the present load") && !said.contains("limit load"));
    let found = report(&mut session, "limit push").expect("a limit");
    close("limit", found["limit"].as_f64().expect("a limit"), expected, 1e-7);
    // To and fro up to there nothing slips.
    for (end, kind) in [(5.4, "shakes-down"), (5.5, "collapses")] {
        let found = report(&mut session, &format!("cycle push 0..{end}")).expect("cycles");
        assert_eq!(found["kind"], kind, "{found}");
        let said = text(&mut session, &format!("cycle push 0..{end}"));
        assert!(said.replace('\n', " ").contains("stay at rest by forces within friction"), "{said}");
    }
    // More weight holds more.
    let own = report(&mut session, "limit own").expect("an end");
    assert!(own["limit"].is_null() && own["end"].as_str().is_some_and(|end| end.contains("no collapse was found")));
    for command in ["trace f to 0.2", "trace f to 0.9"] {
        let refused = report(&mut session, command).expect_err("no path");
        assert!(refused.contains("no path leads on from the answer at f = 0.6"), "{refused}");
    }
    let refused = report(&mut session, "sensitivity").expect_err("no derivatives");
    assert!(refused.contains("at rest") && refused.contains("`sweep`"), "{refused}");
    for range in ["0..5", "3..5"] {
        let [from, to] = [&range[..1], &range[3..]];
        let said = text(&mut session, &format!("find push {range} where x_n c0 > 0"));
        assert!(said.contains(&format!("x_n c0 > 0 for push from {from} to {to}")), "{said}");
    }
}

/// The same over the friction f of the last foot: a path ends before the answers do.
#[test]
fn friction_that_holds_a_body_at_rest() {
    let [weight, place, height] = BLOCK;
    let limit = |f: f64| {
        let rise = (f - FEET[0]) / 3.0;
        weight * (FEET[0] + rise * place) / (1.0 - rise * height)
    };
    let mut session = read(&scenario_text(block(0.01)));
    text(&mut session, "set P 2.4");
    let path = report(&mut session, "trace f to 0").expect("a path");
    let end = path["end"].as_str().expect("a sentence");
    assert!(end.contains("the path ends at f = ") && end.contains("an answer exists"), "{end}");
    text(&mut session, "set P 4.5");
    // P (1 − r h) = W (f_0 + r x_W) at the limit, f = f_0 + 3 r.
    let least = FEET[0] + 3.0 * (4.5 - weight * FEET[0]) / (weight * place + 4.5 * height);
    close("limit", limit(least), 4.5, 1e-12);
    let found = report(&mut session, "find f 0.1..0.8 where outcome answer").expect("a range");
    close("least friction", found["holds"][0][0].as_f64().expect("a number"), least, 1e-8);
    close("all above", found["holds"][0][1].as_f64().expect("a number"), 0.8, 1e-12);
}

fn history(case: &Case, pushes: &[f64]) -> History {
    let values = case.scenario.parameter_values();
    let targets: Vec<Vec<f64>> = pushes.iter().map(|push| vec![1.0, *push]).collect();
    follow_factors(case.prepared.case(&case.scenario, &values), &Begin::Unloaded, &targets).expect("a history")
}

/// Where a history ends that pushes the block beyond its limit, in the stage of this number.
#[track_caller]
fn ends_at(found: &History, number: usize, [from, to, expected]: [f64; 3], precision: f64) {
    let HistoryEnd::Limit { stage, t, collapse } = &found.end else { panic!("{:?}", found.end) };
    assert_eq!((*stage, collapse.verdict), (number, Some(Verdict::Certified)));
    near("limit", from + t * (to - from), expected, precision, expected);
}

/// Nothing moves as long as some self-stress holds the block: pushed, let go, and pushed beyond the limit of above.
#[test]
fn a_history_rests_as_long_as_some_self_stress_holds_it() {
    let [weight, place, height] = BLOCK;
    let rise = (FEET[3] - FEET[0]) / 3.0;
    let expected = weight * (FEET[0] + rise * place) / (1.0 - rise * height);
    let found = history(&Case::json(block(0.01)), &[0.0, 5.0, -1.0, 5.4, 7.0]);
    assert_eq!(found.stages.len(), 5);
    for (stage, push) in found.stages.iter().zip([0.0, 5.0, -1.0, 5.4, expected]) {
        for moment in &stage.moments {
            let [own, push] = moment.factors[..] else { panic!("two cases") };
            near("pressed", moment.pairs.iter().map(|pair| pair.x_n).sum(), own * weight, 1e-11, weight);
            near("held", moment.pairs.iter().map(|pair| pair.x_t).sum(), -push, 1e-11, weight);
            let turned: f64 = moment.pairs.iter().zip(0..4).map(|(pair, x)| f64::from(x) * pair.x_n).sum();
            near("turned", turned, own * weight * place + push * height, 1e-11, weight);
            assert!(moment.pairs.iter().all(|pair| pair.z_t == 0.0 && pair.reserve() >= -1e-12), "{:?}", moment.pairs);
        }
        near("push", stage.moments.last().expect("an end").factors[1], push, 1e-9, expected);
        near("dissipated", stage.dissipated, 0.0, 1e-12, 1.0);
    }
    assert!(found.stages[1].rests.last().is_some_and(|rest| rest[1] == 1.0), "{:?}", found.stages[1].rests);
    ends_at(&found, 4, [5.4, 7.0, expected], 1e-9);
}

/// The block rests all the while that the runner slips to and fro: pushed to P it slips (P − f w)/k, and pulled back from
/// there on it stays until P has fallen by 2 f w; at P = 0 it is held by f w. It loses f w on all its way.
#[test]
fn a_runner_slips_to_and_fro_beside_a_body_at_rest() {
    let ([weight, place, _], [pressed, friction]) = (BLOCK, RUNNER);
    let (bound, push) = (friction * pressed, 4.5);
    let case = Case::json(behind_a_runner());
    let limit = bound + weight * (FEET[0] + (FEET[3] - FEET[0]) / 3.0 * place);
    let found = history(&case, &[0.0, push, 0.0, push, 2.0 * limit]);
    let far = (push - bound) / ROD;
    let slips = [0.0, far, bound / ROD, far];
    let lost = [0.0, far, far - bound / ROD, far - bound / ROD].map(|way| bound * way);
    for (stage, (slip, lost)) in found.stages.iter().zip(slips.into_iter().zip(lost)) {
        let (runner, feet) = stage.end.pairs.split_last().expect("pairs");
        is_answer(&stage.end);
        near("slip", runner.z_t, slip, 1e-9, far);
        near("dissipated", stage.dissipated, lost, 1e-9, bound * far);
        assert!(feet.iter().all(|pair| pair.z_t == 0.0), "{feet:?}");
        assert!(stage.energy.is_some_and(|energy| energy.is_balanced()), "{:?}", stage.energy);
    }
    assert!(found.stages[1..4].iter().all(|stage| !stage.rests.is_empty()));
    ends_at(&found, 4, [push, 2.0 * limit, limit], 1e-9);
}
