//! Structures turned by angles whose cosines are zero but for rounding.

use serde_json::{Value, json};

use crate::common::*;
use stickslip::answer::record::State;

/// Sliders at five corners of a hexagon that was turned by 90°: cosines of 1e-16 in place of zeros. A component in which only their
/// rounding acts is judged by the forces at its node. The pushed one sticks, 4 < 0.5 · 10, and nothing moves.
#[test]
fn a_component_that_only_rounding_loads_is_balanced() {
    let (far, tiny) = (2.598_076_211_353_316, 1.110_223_024_625_156_5e-16);
    let spring = |ends: Value, direction: [f64; 2], stiffness: f64| {
        let mut spring = json!({ "direction": [direction[0], direction[1], 0], "stiffness": stiffness });
        let key = if ends.is_array() { "between" } else { "at" };
        spring[key] = ends;
        spring
    };
    let slider = |k: usize| {
        json!({ "id": format!("c{k}"), "node": format!("m{k}"), "against": "ground", "normal": [0, 0, 1], "friction": 0.5,
                "tangent": [tiny, 1, 0] })
    };
    let case = Case::json(json!({
        "dimension": 3,
        "nodes": { "m1": [-far, 1.500_000_000_000_000_7, 0], "m2": [-far, -1.499_999_999_999_999_1, 0],
                   "m3": [-7.004_609_471_317_529e-16, -3, 0], "m4": [2.598_076_211_353_315, -1.500_000_000_000_001_6, 0],
                   "m5": [far, 1.500_000_000_000_000_2, 0] },
        "springs": [spring(json!(["m1", "m2"]), [-3.0 * tiny, -3.0], 155.59),
                    spring(json!("m3"), [1.0, -2.334_869_823_772_51e-16], 236.28),
                    spring(json!(["m3", "m4"]), [2.598_076_211_353_315_6, 1.499_999_999_999_998_4], 155.59),
                    spring(json!("m4"), [0.500_000_000_000_000_6, 0.866_025_403_784_438_3], 236.28),
                    spring(json!(["m4", "m5"]), [11.0 * tiny, 3.000_000_000_000_001_8], 155.59),
                    spring(json!("m5"), [0.866_025_403_784_438_8, 0.5], 276.31),
                    spring(json!("m5"), [-0.5, 0.866_025_403_784_438_8], 236.28)],
        "contacts": (1..6).map(slider).collect::<Vec<_>>(),
        "loads": { "w": { "items": [{ "point": { "at": "m3", "force": [0, 0, -10] } }] },
                   "p": { "items": [{ "point": { "at": "m3", "force": [4, -9.339_479_295_090_04e-16, 0] } }] } } }));
    let answer = case.solve(&[]);
    assert!(answer.is_answer(), "{:?}", answer.failure);
    assert!(answer.pairs.iter().all(|pair| pair.state == State::Stick));
    let pair = &answer.pairs[2];
    near("friction", pair.bound - pair.reserve(), 4.0, 1e-14, 4.0);
}
