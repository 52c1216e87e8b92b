//! Friction paths and sensitivities: the frame's published intervals, a jump, differences.

use serde_json::{Value, json};
use stickslip::model::embedded;
use stickslip::model::parameter::ParameterValues;
use stickslip::model::scenario::Scenario;
use stickslip::path::end::PathEnd;
use stickslip::path::friction::{FrictionPath, trace};
use stickslip::path::sensitivity::sensitivity;
use stickslip::solve::{Prepared, Solved, prepare};
use stickslip::watch::Quiet;

use super::common::lines;

fn load(name: &str, set: &[(&str, f64)]) -> (Scenario, Prepared, ParameterValues) {
    let scenario = embedded::load(name).expect("embedded");
    let mut values = scenario.parameter_values();
    for (name, value) in set {
        values.insert((*name).to_owned(), *value).expect("a parameter");
    }
    let prepared = prepare(&scenario, &Quiet).expect("sound");
    (scenario, prepared, values)
}

fn solve(scenario: &Scenario, prepared: &Prepared, values: &ParameterValues) -> Solved {
    prepared.case(scenario, values).solve().expect("solvable")
}

fn follow(name: &str, from: f64, to: f64) -> FrictionPath {
    let (scenario, prepared, values) = load(name, &[("f", from)]);
    let solved = solve(&scenario, &prepared, &values);
    trace(prepared.case(&scenario, &values), Some(&solved), "f", to).expect("a path")
}

/// The ends of the intervals come from frame elements and an enumeration of the working schemes, independent of this program.
#[test]
fn the_frames_hold_their_schemes_in_the_known_intervals() {
    for (name, expected) in
        [("frame", [0.39319471, 0.75271411, 5.42608696]), ("frame-rotated", [0.28331450, 0.44932055, 0.68876861])]
    {
        for (from, to) in [(0.1, 6.0), (6.0, 0.1)] {
            let path = follow(name, from, to);
            assert_eq!(path.end, PathEnd::Target);
            let mut found: Vec<f64> = path.breakpoints.iter().map(|b| b.value).collect();
            found.sort_by(f64::total_cmp);
            assert_eq!(found.len(), 3, "{name} {:?}", path.breakpoints);
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() <= 0.51e-8, "{name}: {found} is not {expected}");
            }
            assert!(path.breakpoints.iter().all(|b| !b.jump && b.changes.len() == 1));
            assert_eq!(path.intervals.len(), 4);
            assert_eq!(path.intervals[0].from, from);
            assert_eq!(path.intervals[3].to, to);
        }
    }
}

/// One pair, R = [[1, −1], [−1, 1.5]], RF = (0.6, −1): stick holds for f ≥ 1/0.6, beside it the pair is open for
/// every f. Coming from large f the answer must jump at 5/3.
#[test]
fn an_answer_that_ends_jumps_to_another() {
    let path = follow("klarbring", 4.0, 1.0);
    assert_eq!(path.end, PathEnd::Target);
    assert_eq!(path.breakpoints.len(), 1, "{:?}", path.breakpoints);
    let breakpoint = &path.breakpoints[0];
    assert!((breakpoint.value - 5.0 / 3.0).abs() <= 1e-8, "{breakpoint:?}");
    assert!(breakpoint.jump);
    assert_eq!(breakpoint.changes[0].from, "stick");
    assert_eq!(breakpoint.changes[0].to, "open");
}

/// The pulled bar: slip of the k-th support from the closed form ends where r = f F passes F2/k.
#[test]
fn the_beam_sticks_support_by_support_as_friction_grows() {
    let path = follow("beam", 0.45, 3.0);
    let found: Vec<f64> = path.breakpoints.iter().map(|b| b.value).collect();
    let expected: Vec<f64> = (1..=5).rev().map(|k| 2.5 / f64::from(k)).collect();
    assert_eq!(found.len(), 5, "{found:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= 1e-10 * expected, "{found} is not {expected}");
    }
    // Towards less friction the beam slides away at f = 2.5/6.
    let path = follow("beam", 0.45, 0.1);
    assert_eq!(path.end, PathEnd::NoAnswer);
    let last = path.intervals.last().expect("an interval").to;
    assert!((last - 2.5 / 6.0).abs() <= 1e-9, "{last}");
}

#[test]
fn sensitivities_agree_with_differences() {
    for (name, set) in [
        ("beam", vec![("F2", 230.0)]),
        ("frame-rotated", vec![("f", 0.35)]),
        ("plates-free", vec![]),
        ("plates-hinged", vec![]),
        ("gap", vec![]),
    ] {
        let (scenario, prepared, values) = load(name, &set);
        let solved = solve(&scenario, &prepared, &values);
        let found = sensitivity(prepared.case(&scenario, &values), &solved).expect("an answer");
        assert!(found.on_limit.is_empty(), "{name}: {:?}", found.on_limit);
        for rate in &found.parameters {
            let at = |sign: f64| {
                let mut moved = values.clone();
                let value = moved[&rate.parameter];
                let step = 1e-6 * value.abs().max(1e-3);
                moved.insert(rate.parameter.clone(), value + sign * step);
                (solve(&scenario, &prepared, &moved).answer.pairs, step)
            };
            let ((plus, step), (minus, _)) = (at(1.0), at(-1.0));
            type Read = fn(&stickslip::answer::record::PairState) -> f64;
            let reads: [(&str, Read); 4] =
                [("x_n", |p| p.x_n), ("x_t", |p| p.x_t), ("z_n", |p| p.z_n), ("z_t", |p| p.z_t)];
            for (which, read) in reads {
                let mine = |k: usize| match which {
                    "x_n" => rate.pairs[k].x_n,
                    "x_t" => rate.pairs[k].x_t,
                    "z_n" => rate.pairs[k].z_n,
                    _ => rate.pairs[k].z_t,
                };
                let size = (0..plus.len()).map(|k| mine(k).abs()).fold(0.0, f64::max);
                let value = solved.answer.pairs.iter().map(|p| read(p).abs()).fold(0.0, f64::max);
                for k in 0..plus.len() {
                    let difference = (read(&plus[k]) - read(&minus[k])) / (2.0 * step);
                    let tolerance = 1e-5 * size + 1e-9 * value / step;
                    assert!(
                        (difference - mine(k)).abs() <= tolerance,
                        "{name}: d{which}[{}]/d{} = {} is not {difference}",
                        plus[k].id,
                        rate.parameter,
                        mine(k)
                    );
                }
            }
        }
    }
}

/// Example 1 with F2 = 150: the k-th support from the pulled end slips at f = 150 / (100 k), wherever the path starts. From
/// 0.6 to 0.2 a step of the search ends exactly on the first of these places, 0.5.
#[test]
fn a_zero_at_the_end_of_a_step_is_found_there() {
    for start in [0.5, 0.55, 0.58, 0.6, 0.65, 0.7, 0.9] {
        let mut session = super::find::beam();
        for command in ["set F 100".to_owned(), "set F2 150".to_owned(), format!("set f {start}")] {
            super::find::report(&mut session, &command).unwrap();
        }
        let path = super::find::report(&mut session, "trace f to 0.2").unwrap();
        let found: Vec<f64> =
            path["breakpoints"].as_array().unwrap().iter().map(|at| at["value"].as_f64().unwrap()).collect();
        let expected: Vec<f64> = (2..=5).map(|k| 150.0 / (100.0 * f64::from(k))).filter(|f| *f < start).collect();
        assert_eq!(found.len(), expected.len(), "{start}: {found:?}");
        let end = path["intervals"].as_array().unwrap().last().unwrap()["to"].as_f64().unwrap();
        assert!((end - 0.25).abs() < 1e-9, "{path}");
        for (found, expected) in found.iter().zip(&expected) {
            assert!((found - expected).abs() < 1e-9, "{start}: {found} {expected}");
        }
    }
}

/// Three nodes of weight 1 in a row of bars of E A = 1000 and length 1, each pushed by H = 0.2 towards the support: below f = H each
/// holds f, and the bars take H − f, 2 (H − f), 3 (H − f). All slip at once, from nothing, and every place is told once.
#[test]
fn slips_that_begin_together_need_no_small_steps() {
    let nodes = ["a", "b", "c"];
    let bar = |from: &str, to: &str| json!({"id": format!("{from}{to}"), "nodes": [from, to], "kind": "truss", "material": "m", "section": "q"});
    let points = |force: [f64; 2]| json!({"items": nodes.map(|node| json!({"point": {"at": node, "force": force}}))});
    let scenario = json!({
        "format": "stickslip/1", "title": "t", "parameters": {"f": 0.5},
        "nodes": {"a": [0, 0], "b": [1, 0], "c": [2, 0], "s": [3, 0]},
        "materials": {"m": {"E": 1000, "nu": 0}}, "sections": {"q": {"area": 1}},
        "bars": [bar("a", "b"), bar("b", "c"), bar("c", "s")],
        "supports": [{"at": "s", "fixed": ["x", "y"]}],
        "contacts": nodes.map(|node| json!({"id": format!("at-{node}"), "node": node, "against": "ground", "normal": [0, 1], "friction": "f"})),
        "loads": {"weight": points([0.0, -1.0]), "push": points([0.2, 0.0])},
    });
    let mut session = lines::read(&scenario.to_string());
    let path = lines::report(&mut session, "trace f to 0.1 of x_t at-a, z_t at-a").unwrap();
    let numbers = |value: &Value| -> Vec<f64> { serde_json::from_value(value.clone()).unwrap() };
    let (at, columns) = (numbers(&path["along"]["values"]), &path["along"]["quantities"]);
    let (force, slip) = (numbers(&columns[0]["values"]), numbers(&columns[1]["values"]));
    assert!((4..=12).contains(&at.len()) && at.is_sorted_by(|a, b| a > b), "{at:?}");
    for ((f, force), slip) in at.iter().zip(force).zip(slip) {
        assert!(
            (force + f.min(0.2)).abs() < 1e-12 && (slip - 0.006 * (0.2 - f).max(0.0)).abs() < 1e-14,
            "{f} {force} {slip}"
        );
    }
}
