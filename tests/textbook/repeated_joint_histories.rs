//! Load histories over joints that repeat one another.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use stickslip::answer::record::Verdict;
use stickslip::path::stages::{Begin, History, HistoryEnd, follow_factors};

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
