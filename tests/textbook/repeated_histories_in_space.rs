//! Load histories in space over joints that repeat one another.

use stickslip::path::stages::{Begin, History, HistoryEnd, follow_factors};

use super::guides::{EA, EI, L};
use super::repeated_in_space::{SIDES, guided, turned};
use crate::common::*;

/// Factors of press, push and pull.
fn history(case: &Case, stages: &[[f64; 3]]) -> History {
    let values = case.scenario.parameter_values();
    let targets: Vec<Vec<f64>> = stages.iter().map(|stage| stage.to_vec()).collect();
    follow_factors(case.prepared.case(&case.scenario, &values), &Begin::Unloaded, &targets)
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Two guides share the shoe of a pipe that is pressed with P = 1 on the low one, then pulled to and fro. Friction bound
/// r = f (P − k g₁). Pulled by T the tip slips by s = (T − r)/k_a; unloaded it stays, held by k_a s = T − r; pulled back by −T
/// it slips to −s, from k_a s − r on.
#[test]
fn two_guides_under_a_cyclic_pull() {
    let (k, k_a) = (3.0 * EI / L.powi(3), EA / L);
    let (pull, r) = (0.5, 0.3 * (1.0 - k * 0.01));
    let s = (pull - r) / k_a;
    for rotation in turned() {
        let case = guided(&rotation, &SIDES);
        let stages = [0.0, pull, 0.0, -pull, pull].map(|pull| [0.0, 1.0, pull]);
        let found = history(&case, &stages);
        assert_eq!(found.end, HistoryEnd::Complete);
        let slips = [0.0, s, s, -s, s];
        let friction = [0.0, -r, k_a * s, r, -r];
        for ((stage, slip), friction) in found.stages.iter().zip(slips).zip(friction) {
            let [low, up] = &stage.end.pairs[..] else { panic!() };
            near_all("slip", &low.slip(), &[slip, 0.0], 1e-8);
            near_all("slip", &up.slip(), &[slip, 0.0], 1e-8);
            near("friction", low.friction()[0] + up.friction()[0], friction, 1e-8, 1.0);
            near("x_n", low.x_n, 1.0 - k * 0.01, 1e-8, 1.0);
            near("z_n", up.z_n, 0.03, 1e-8, 0.03);
            assert!(stage.energy.expect("a structure").residual < 1e-7);
        }
        for (stage, way) in found.stages.iter().zip([0.0, s, 0.0, 2.0 * s, 2.0 * s]) {
            near("dissipated", stage.dissipated, r * way, 1e-7, r * s);
        }
        let begins = found.stages[3].moments.iter().find(|moment| !moment.changes.is_empty()).expect("a slip");
        // Events are crossed in steps of 1e-7 of a stage, in which T goes by 1/2.
        near("reversal", begins.factors[2], k_a * s - r, 1e-7, 1.0);
    }
}
