//! Press fit of two rings of one material: Lamé, and how fast the mesh converges to his solution.
//!
//! ```text
//!   inner ring a … b, outer ring b … c, too large by d in radius:
//!   p = E d (b² − a²)(c² − b²) / (2 b³ (c² − a²))
//! ```

use serde_json::{Map, Value, json};

use crate::common::*;

const A: f64 = 10.0;
const B: f64 = 20.0;
const C: f64 = 35.0;
const E: f64 = 2.1e5;
const D: f64 = 0.01;

/// A quarter with `n` segments; n/6 layers in the inner ring, n/4 in the outer one.
fn rings(n: usize) -> Case {
    let mut nodes = Map::new();
    let (mut quads, mut supports) = (Vec::new(), Vec::new());
    for (ring, layers, from, to) in [("i", n / 6, A, B), ("o", n / 4, B, C)] {
        for layer in 0..=layers {
            let r = from + (to - from) * layer as f64 / layers as f64;
            for segment in 0..=n {
                let angle = std::f64::consts::FRAC_PI_2 * segment as f64 / n as f64;
                nodes.insert(format!("{ring}{layer}-{segment}"), json!([r * angle.cos(), r * angle.sin()]));
            }
            supports.push(json!({ "at": format!("{ring}{layer}-0"), "fixed": ["y"] }));
            supports.push(json!({ "at": format!("{ring}{layer}-{n}"), "fixed": ["x"] }));
        }
        for (layer, segment) in (0..layers).flat_map(|layer| (0..n).map(move |segment| (layer, segment))) {
            let corners = [(layer, segment), (layer + 1, segment), (layer + 1, segment + 1), (layer, segment + 1)];
            quads.push(json!({
                "id": format!("{ring}q{layer}-{segment}"),
                "nodes": corners.map(|(layer, segment)| format!("{ring}{layer}-{segment}")),
                "thickness": 1, "material": "m", "plane": "stress", "element": "incompatible"
            }));
        }
    }
    let edge = |ring: &str, layer: usize| -> Value { (0..=n).map(|k| format!("{ring}{layer}-{k}")).collect() };
    let symmetric = |id: &str, k: usize, normal: [i32; 2]| {
        json!({ "id": id, "node": format!("i{}-{k}", n / 6), "against": format!("o0-{k}"), "normal": normal,
                "law": "frictionless", "gap": -D })
    };
    Case::json(json!({
        "materials": { "m": { "E": E, "nu": 0.3 } },
        "nodes": nodes, "quads": quads, "supports": supports,
        "edges": { "seat": edge("i", n / 6), "bore": edge("o", 0) },
        "contacts": [
            symmetric("first", 0, [-1, 0]),
            { "id": "fit", "edge": "seat", "against": "bore", "friction": 0.15, "gap": -D, "skip": [0, n] },
            symmetric("last", n, [0, -1])
        ]
    }))
}

/// The pressure on a segment, and its error, which falls with the square of the size of the elements.
#[test]
fn the_pressure_converges_to_that_of_lame() {
    let p = E * D * (B * B - A * A) * (C * C - B * B) / (2.0 * B.powi(3) * (C * C - A * A));
    let errors = [12, 24, 48].map(|n| {
        let answer = rings(n).solve(&[]);
        is_answer(&answer);
        let length = B * std::f64::consts::FRAC_PI_2 / n as f64;
        let of = |id: &str| answer.pairs.iter().find(|pair| pair.id == id).unwrap().x_n;
        // All alike; half of a segment belongs to the pairs in the planes of symmetry.
        near("first", of("first"), 0.5 * of("fit[1]"), 1e-9, p * length);
        near("last", of("last"), 0.5 * of(&format!("fit[{}]", n / 2)), 1e-9, p * length);
        of("fit[1]") / (p * length) - 1.0
    });
    assert!(errors[0] < 0.006, "{errors:?}");
    for pair in errors.windows(2) {
        let rate = pair[0] / pair[1];
        assert!((3.6..=4.4).contains(&rate), "{errors:?}");
    }
}
