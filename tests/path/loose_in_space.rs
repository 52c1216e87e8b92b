//! Load histories in space of bodies that something leaves loose: feet without friction, feet that hang before there is any
//! load, springs far softer than what they hold.

use serde_json::json;
use stickslip::path::stages::{History, HistoryEnd, follow};

use crate::common::{Case, near, near_all};

fn followed(case: &Case) -> History {
    let values = case.scenario.parameter_values();
    let history = follow(case.prepared.case(&case.scenario, &values)).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(history.end, HistoryEnd::Complete, "{:?}", history.end);
    for stage in &history.stages {
        assert!(stage.end.check.passed, "{:?}", stage.end.check);
    }
    history
}

/// On a floor without friction heat bends nothing: between two feet a distance ℓ apart a block slips by α ΔT ℓ, and nothing
/// moves it as a whole.
#[test]
fn a_block_without_friction_swells_and_shrinks_where_it_is() {
    let heat = |change: f64| json!({ "weight": 1, "heat": change });
    let case = Case::json(json!({
        "dimension": 3,
        "materials": { "m": { "E": 2e6, "nu": 0, "density": 2.5, "expansion": 1e-5 } },
        "bricks": [{ "id": "b", "origin": [0, 0, 0], "size": [0.8, 0.6, 0.5], "divisions": [2, 2, 2], "material": "m" }],
        "contacts": [{ "id": "c", "face": "b.bottom", "against": "ground", "friction": 0 }],
        "loads": {
            "weight": { "items": [{ "gravity": { "acceleration": [0, 0, -10] } }] },
            "heat": { "items": [{ "temperature": { "change": 40, "on": ["b"] } }] }
        },
        "stages": [{ "weight": 1 }, heat(1.0), heat(-1.0), heat(1.0), heat(0.0)]
    }));
    let history = followed(&case);
    let places: Vec<[f64; 2]> = (0..9).map(|i| [0.4 * f64::from(i % 3), 0.3 * f64::from(i / 3)]).collect();
    let weight = 2.5 * 10.0 * 0.8 * 0.6 * 0.5;
    for (stage, factor) in history.stages.iter().zip([0.0, 1.0, -1.0, 1.0, 0.0]) {
        let pairs = &stage.end.pairs;
        assert!(stage.energy.expect("a structure").residual <= 1e-8, "{:?}", stage.energy);
        near("weight", pairs.iter().map(|pair| pair.x_n).sum(), weight, 1e-10, weight);
        near("dissipated", stage.dissipated, 0.0, 1e-12, weight * 1e-4);
        let strain = 1e-5 * 40.0 * factor;
        for (pair, place) in pairs.iter().zip(&places) {
            let from_first = [0, 1].map(|t| pair.slip()[t] - pairs[0].slip()[t]);
            near_all(
                "slip",
                &from_first,
                &[0, 1].map(|t| strain * (place[t] - places[0][t])),
                1e-9 * strain.abs() + 1e-15,
            );
            // As a whole it may lie anywhere; it stays within itself.
            assert!(pair.z_t <= 1e-5 * 40.0, "{} {}", pair.id, pair.z_t);
        }
    }
}

/// A table of three legs that do not fit: one foot reaches 1 mm into the floor, another ends 1 mm above it. It comes to stand as
/// soon as it weighs anything, by slips as small as its feet are wrong, and three feet bear what equilibrium says.
#[test]
fn a_table_whose_feet_do_not_fit_stands_where_it_was() {
    let feet = [[1.0, 0.0], [-0.5, 0.8], [-0.5, -0.8]];
    let foot = |at: [f64; 2]| json!([at[0], at[1], 0]);
    let leg = |i: usize| json!({ "id": format!("l{i}"), "nodes": [format!("n{i}"), "top"], "kind": "frame", "material": "m", "section": "s" });
    let gaps = [-0.001, 0.0, 0.001];
    let contact = |i: usize| json!({ "id": format!("c{i}"), "node": format!("n{i}"), "against": "ground", "normal": [0, 0, 1], "friction": 0.6, "gap": gaps[i] });
    let case = Case::json(json!({
        "dimension": 3,
        "materials": { "m": { "E": 2e7, "nu": 0.3, "density": 1 } },
        "sections": { "s": { "area": 0.01, "inertia_y": 1e-4, "inertia_z": 2e-4, "torsion": 1.5e-4 } },
        "nodes": { "n0": foot(feet[0]), "n1": foot(feet[1]), "n2": foot(feet[2]), "top": [0, 0, 1] },
        "bars": [leg(0), leg(1), leg(2)],
        "contacts": [contact(0), contact(1), contact(2)],
        "loads": { "load": { "items": [{ "point": { "at": "top", "force": [0, 0, -1] } }] } },
        "stages": [{ "load": 1 }]
    }));
    let history = followed(&case);
    // It drops as soon as there is a load at all: at 1e-7 of it by 1 mm, which is some 1e-5 of the work.
    assert!(history.stages[0].energy.expect("a structure").residual <= 1e-4, "{:?}", history.stages[0].energy);
    let pairs = &history.stages[0].end.pairs;
    // Moments about the line of the other two feet: the load stands at 1/3 of the way from each to its foot.
    for (pair, expected) in pairs.iter().zip([1.0 / 3.0; 3]) {
        near("x_n", pair.x_n, expected, 1e-9, 1.0);
        assert!(pair.z_t <= 0.01, "{} {}", pair.id, pair.z_t);
    }
}
