//! Derivatives on Coulomb's cone against a closed form and against differences of answers; what is calibrated by them.

use nalgebra::DMatrix;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::json;
use stickslip::answer::record::PairState;
use stickslip::model::parameter::ParameterValues;
use stickslip::path::sensitivity::{PairRate, Sensitivity, sensitivity};
use stickslip::solve::Solved;

use super::find::{report, session};
use crate::common::Case;

fn solved(case: &Case, values: &ParameterValues) -> Solved {
    case.prepared.case(&case.scenario, values).under(case.scenario.rules).solve().expect("an outcome")
}

fn rates(case: &Case, values: &ParameterValues, at: &Solved) -> Sensitivity {
    sensitivity(case.prepared.case(&case.scenario, values), at).expect("an answer")
}

/// A weight W on a slider with friction f, drawn by F against a spring k each way, moves to (1 − f W/|F|) F/k.
#[test]
fn a_slider_between_springs_has_its_closed_form() {
    let case = Case::embedded("bearing-two-way");
    let values = case.scenario.parameter_values();
    let found = rates(&case, &values, &solved(&case, &values));
    let (f, w, k, pull) = (0.1, 20.0, 1.0, [3.0, 4.0]);
    let size = 5.0;
    let rate = |name: &str| -> [[f64; 2]; 2] {
        found.parameters.iter().find(|rate| rate.parameter == name).expect("a parameter").pairs[0].space.expect("space")
    };
    let near = |name: &str, found: [f64; 2], expected: [f64; 2]| {
        let off = (0..2).map(|t| (found[t] - expected[t]).abs()).fold(0.0, f64::max);
        assert!(off < 1e-12, "{name}: {found:?} is not {expected:?}");
    };
    let unit = pull.map(|part| part / size);
    near("f", rate("f")[1], unit.map(|part| -w / k * part));
    near("W", rate("W")[1], unit.map(|part| -f / k * part));
    near("f", rate("f")[0], unit.map(|part| -w * part));
    // d/dF of F − f W F/|F|: what is across F is let go by f W/|F| less.
    let across = |t: usize, s: usize| f64::from(t == s) - unit[t] * unit[s];
    let along_x = [0, 1].map(|t| (f64::from(t == 0) - f * w / size * across(t, 0)) / k);
    near("Fx", rate("Fx")[1], along_x);
    let friction = [0, 1].map(|t| -f * w / size * across(t, 0));
    near("Fx", rate("Fx")[0], friction);
}

/// Each rate against a difference of the answers on both sides.
fn agrees_with_differences(name: &str, case: &Case) -> usize {
    let values = case.scenario.parameter_values();
    let here = solved(case, &values);
    if !here.answer.is_answer() {
        return 0;
    }
    let found = rates(case, &values, &here);
    if !found.on_limit.is_empty() {
        return 0;
    }
    for rate in &found.parameters {
        let at = |sign: f64| {
            let mut moved = values.clone();
            let step = 1e-6 * values[&rate.parameter].abs().max(1e-3);
            moved.insert(rate.parameter.clone(), values[&rate.parameter] + sign * step);
            (solved(case, &moved).answer.pairs, step)
        };
        let ((plus, step), (minus, _)) = (at(1.0), at(-1.0));
        // x_n, x_t1, x_t2; z_n, z_t1, z_t2; the magnitudes.
        let of_pair = |pair: &PairState| {
            let space = pair.space.expect("in space");
            [[pair.x_n, space.x_t[0], space.x_t[1], pair.x_t], [pair.z_n, space.z_t[0], space.z_t[1], pair.z_t]]
        };
        let of_rate = |rate: &PairRate| {
            let [x_t, z_t] = rate.space.expect("in space");
            [[rate.x_n, x_t[0], x_t[1], rate.x_t], [rate.z_n, z_t[0], z_t[1], rate.z_t]]
        };
        for kind in 0..2 {
            let largest = |all: &mut dyn Iterator<Item = [[f64; 4]; 2]>| {
                all.flat_map(|both| both[kind]).fold(0.0f64, |most, value| most.max(value.abs()))
            };
            let size = largest(&mut rate.pairs.iter().map(of_rate));
            let value = largest(&mut here.answer.pairs.iter().map(of_pair));
            for (k, rated) in rate.pairs.iter().enumerate() {
                for entry in 0..4 {
                    let mine = of_rate(rated)[kind][entry];
                    let difference = (of_pair(&plus[k])[kind][entry] - of_pair(&minus[k])[kind][entry]) / (2.0 * step);
                    let tolerance = 2e-5 * size + 1e-9 * value / step;
                    assert!(
                        (difference - mine).abs() <= tolerance,
                        "{name}: {kind} {entry} of {} by {}: {mine} is not {difference}",
                        rated.pair,
                        rate.parameter
                    );
                }
            }
        }
    }
    1
}

#[test]
fn derivatives_of_the_scenarios_agree_with_differences() {
    let told: usize = ["pipe-loop", "tower", "bearing-two-way"]
        .iter()
        .map(|name| agrees_with_differences(name, &Case::embedded(name)))
        .sum();
    assert!(told >= 2, "{told}");
}

#[test]
fn derivatives_of_random_systems_agree_with_differences() {
    let mut random = ChaCha8Rng::seed_from_u64(17);
    let mut told = 0;
    for case in 0..40 {
        let m = 1 + case % 5;
        let k = 3 * m;
        let a = DMatrix::<f64>::from_fn(k, k, |_, _| random.random_range(-1.0..1.0));
        let r = &a * a.transpose() + DMatrix::identity(k, k);
        let rows: Vec<Vec<f64>> = (0..k).map(|i| (0..k).map(|j| 0.5 * (r[(i, j)] + r[(j, i)])).collect()).collect();
        let mut vector = || (0..k).map(|_| random.random_range(-2.0..2.0)).collect::<Vec<f64>>();
        let (first, second) = (vector(), vector());
        let case = Case::json(json!({
            "parameters": { "f": 0.4, "c": 0.2, "P": 1, "g": 0.1 },
            "contact_system": {
                "pairs": (1..=m).map(|i| format!("c{i}")).collect::<Vec<_>>(), "tangents": 2, "stiffness": rows,
                "friction": vec!["f"; m],
                "cohesion": (0..m).map(|i| if i == 0 { json!("c") } else { json!(0) }).collect::<Vec<_>>(),
                "gap": (0..m).map(|i| if i == 1 { json!("g") } else { json!(0) }).collect::<Vec<_>>(),
                "loads": { "a": { "vector": first }, "b": { "factor": "P", "vector": second } } } }));
        told += agrees_with_differences("random", &case);
    }
    assert!(told >= 30, "{told}");
}

#[test]
fn friction_is_found_from_slips_in_space() {
    let case = Case::embedded("bearing-two-way");
    let mut values = case.scenario.parameter_values();
    values.insert("f".to_owned(), 0.173);
    let answer = solved(&case, &values).answer;
    let [along, across] = answer.pairs[0].space.expect("in space").z_t;
    let mut session = session(case.scenario.clone());
    let found = report(&mut session, &format!("calibrate f where ux deck = {along:e}, uy deck = {across:e}"));
    let found = found.unwrap_or_else(|why| panic!("{why}"));
    assert!((found["groups"][0]["value"].as_f64().unwrap_or(f64::NAN) - 0.173).abs() < 1e-6, "{found}");
}
