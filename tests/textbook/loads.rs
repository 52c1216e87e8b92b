//! Every kind of load against its closed form: on inclined bars, in every system of axes, with hinges, on edges.

use serde_json::{Value, json};
use stickslip::answer::record::Answer;

use crate::common::*;

const E: f64 = 3.0e4;
const AREA: f64 = 0.5;
const INERTIA: f64 = 0.2;
const DEPTH: f64 = 0.6;
const DENSITY: f64 = 2.5;
const EXPANSION: f64 = 1e-3;

/// A bar from (1, 2) over `span`, clamped or pinned at its ends, under one load.
///
/// ```text
///            ╱ b
///          ╱      L = |span|, direction (c, s)
///      a ╱
/// ```
fn bar(span: [f64; 2], fixed: [&[&str]; 2], divisions: usize, load: Value) -> Answer {
    let supports: Vec<Value> = ["a", "b"]
        .iter()
        .zip(fixed)
        .filter(|(_, fixed)| !fixed.is_empty())
        .map(|(node, fixed)| json!({ "at": node, "fixed": fixed }))
        .collect();
    let case = Case::json(json!({
        "materials": { "m": { "E": E, "nu": 0.2, "density": DENSITY, "expansion": EXPANSION } },
        "sections": { "s": { "area": AREA, "inertia": INERTIA, "depth": DEPTH } },
        "nodes": { "a": [1, 2], "b": [1.0 + span[0], 2.0 + span[1]] },
        "bars": [{ "id": "ab", "nodes": ["a", "b"], "material": "m", "section": "s", "divisions": divisions }],
        "supports": supports,
        "loads": { "w": { "items": [load] } }
    }));
    let answer = case.solve(&[]);
    is_answer(&answer);
    answer
}

const CLAMPED: [&[&str]; 2] = [&["x", "y", "r"], &["x", "y", "r"]];
const SPANS: [[f64; 2]; 4] = [[4.0, 0.0], [3.2, 2.4], [-2.4, 3.2], [0.0, -4.0]];

/// (N, Q, M) at the start of the first element and at the end of the last.
fn ends(answer: &Answer) -> [[f64; 3]; 2] {
    let members = answer.members.as_ref().unwrap();
    let (first, last) = (&members[0].start, &members[members.len() - 1].end);
    [[first.n, first.q, first.m], [last.n, last.q, last.m]]
}

fn near_ends(answer: &Answer, expected: [[f64; 3]; 2], scale: f64) {
    for (found, right) in ends(answer).iter().flatten().zip(expected.iter().flatten()) {
        near("end force", *found, *right, 1e-10, scale);
    }
}

/// Clamped at both ends under a uniform force with components q_x along and q_y across per length:
/// N = ± q_x L/2, Q = ∓ q_y L/2, M = q_y L²/12 at the ends.
fn clamped_under([qx, qy]: [f64; 2]) -> [[f64; 3]; 2] {
    let l = 4.0;
    let m = qy * l * l / 12.0;
    [[qx * l / 2.0, -qy * l / 2.0, m], [-qx * l / 2.0, qy * l / 2.0, m]]
}

#[test]
fn uniform_line_loads_in_every_system_of_axes() {
    let value = [0.7, -3.0];
    for span in SPANS {
        let (c, s) = (span[0] / 4.0, span[1] / 4.0);
        let local = |[x, y]: [f64; 2]| [c * x + s * y, c * y - s * x];
        for (axes, q) in [
            ("global", local(value)),
            ("local", value),
            // Snow and wind: x per vertical length, y per horizontal length.
            ("projected", local([value[0] * s.abs(), value[1] * c.abs()])),
        ] {
            for divisions in [1, 3] {
                let load = json!({ "line": { "bar": "ab", "value": value, "axes": axes } });
                near_ends(&bar(span, CLAMPED, divisions, load), clamped_under(q), 12.0);
            }
        }
    }
}

/// Own weight is a vertical line load of ρ g A.
#[test]
fn gravity_of_bars() {
    for span in SPANS {
        let (c, s) = (span[0] / 4.0, span[1] / 4.0);
        let w = -9.81 * DENSITY * AREA;
        let load = json!({ "gravity": { "acceleration": [0, -9.81] } });
        near_ends(&bar(span, CLAMPED, 2, load), clamped_under([s * w, c * w]), 50.0);
    }
}

/// A trapezoid q1 … q2 between a and b on a bar clamped at its start only: statics alone, whatever the division.
#[test]
fn part_of_a_varying_load_on_a_cantilever() {
    let ([a, b], [q1, q2]) = ([0.7, 3.1], [-2.0, -5.0]);
    for span in SPANS {
        for divisions in [1, 2, 5] {
            let load = json!({ "line": {
                "bar": "ab", "value": [[0.0, q1], [0.0, q2]], "range": [a, b], "axes": "local"
            } });
            let answer = bar(span, [&["x", "y", "r"], &[]], divisions, load);
            let total = (q1 + q2) / 2.0 * (b - a);
            // Its centre from a: (b − a)(q1 + 2 q2)/(3 (q1 + q2)).
            let arm = a + (b - a) * (q1 + 2.0 * q2) / (3.0 * (q1 + q2));
            near_ends(&answer, [[0.0, -total, total * arm], [0.0; 3]], 20.0);
        }
    }
}

/// Force and couple at a place of a cantilever: Q = −F_y, M = F_y s + m in bar axes; at a node or between nodes.
#[test]
fn forces_on_bars() {
    for span in SPANS {
        let (c, s) = (span[0] / 4.0, span[1] / 4.0);
        for (divisions, distance) in [(1, 1.3), (4, 1.3), (4, 2.0), (2, 4.0), (1, 0.0)] {
            let load = json!({ "point": { "bar": "ab", "distance": distance, "force": [2.0, -3.0], "moment": 1.5 } });
            let answer = bar(span, [&["x", "y", "r"], &[]], divisions, load);
            let (x, y) = (c * 2.0 - s * 3.0, -c * 3.0 - s * 2.0);
            near_ends(&answer, [[x, -y, y * distance + 1.5], [0.0; 3]], 20.0);
        }
    }
}

/// Heated and held: N = −EA α ΔT. Warmer on the +y side and held: the −y side is in tension, M = EI α g/d. Free at one
/// end: no force, but u = α ΔT L along it and v = −α g L²/2d across it. Lack of fit likewise: N = −EA ε₀.
#[test]
fn temperature_and_lack_of_fit_of_bars() {
    let (change, gradient, fit) = (20.0, 12.0, 2e-3);
    let n = -E * AREA * EXPANSION * change;
    let m = E * INERTIA * EXPANSION * gradient / DEPTH;
    for span in SPANS {
        let (c, s) = (span[0] / 4.0, span[1] / 4.0);
        for divisions in [1, 3] {
            let load = json!({ "temperature": { "change": change, "gradient": gradient, "on": ["ab"] } });
            near_ends(&bar(span, CLAMPED, divisions, load.clone()), [[n, 0.0, m], [n, 0.0, m]], n.abs());
            let free = bar(span, [&["x", "y", "r"], &[]], divisions, load);
            near_ends(&free, [[0.0; 3]; 2], n.abs());
            let (along, across) = (EXPANSION * change * 4.0, -EXPANSION * gradient / DEPTH * 8.0);
            let u = displacement(&free, "b");
            near("u_x", u[0], c * along - s * across, 1e-12, 1.0);
            near("u_y", u[1], s * along + c * across, 1e-12, 1.0);
            let load = json!({ "strain": { "on": ["ab"], "value": fit } });
            let n = -E * AREA * fit;
            near_ends(&bar(span, CLAMPED, divisions, load), [[n, 0.0, 0.0], [n, 0.0, 0.0]], n.abs());
        }
    }
}

/// A beam clamped at one end and hinged at the other: 3qL/8 at the hinge, 5qL/8 and M = −qL²/8 at the clamp.
#[test]
fn hinged_bars_carry_their_loads() {
    let q = 2.0;
    let case = Case::json(json!({
        "materials": { "m": { "E": E, "nu": 0.2 } },
        "sections": { "s": { "area": AREA, "inertia": INERTIA } },
        "nodes": { "a": [0, 0], "b": [4, 0] },
        "bars": [{ "id": "ab", "nodes": ["a", "b"], "material": "m", "section": "s", "hinges": ["start"] }],
        "supports": [{ "at": "a", "fixed": ["x", "y"] }, { "at": "b", "fixed": ["x", "y", "r"] }],
        "loads": { "w": { "items": [{ "line": { "bar": "ab", "value": [0, -q] } }] } }
    }));
    let answer = case.solve(&[]);
    near_ends(&answer, [[0.0, 3.0 * q * 4.0 / 8.0, 0.0], [0.0, -5.0 * q * 4.0 / 8.0, -q * 16.0 / 8.0]], 10.0);
}

/// A wall 2 wide and 3 high, held along its foot, and beside it a triangle of other thickness: reactions are the
/// resultants of what acts.
fn wall(load: Value) -> Answer {
    let case = Case::json(json!({
        "materials": { "m": { "E": E, "nu": 0.2, "density": DENSITY, "expansion": EXPANSION } },
        "plates": [{ "id": "wall", "origin": [0, 0], "size": [2, 3], "divisions": [2, 4], "thickness": 0.25,
                     "material": "m", "plane": "strain" }],
        "nodes": { "p": [5, 0], "q": [7, 0], "r": [5, 3] },
        "triangles": [{ "id": "fin", "nodes": ["p", "q", "r"], "thickness": 0.5, "material": "m", "plane": "stress" }],
        "edges": { "slope": ["q", "r"] },
        "supports": [{ "at": "wall.bottom", "fixed": ["x", "y"] }, { "at": "p", "fixed": ["x", "y"] },
                     { "at": "q", "fixed": ["x", "y"] }],
        "loads": { "w": { "items": [load] } }
    }));
    let answer = case.solve(&[]);
    is_answer(&answer);
    answer
}

/// Minus the sums of the reactions: (F_x, F_y, moment about the origin).
fn resultant(answer: &Answer) -> [f64; 3] {
    let place = |node: &str| match node {
        "p" => [5.0, 0.0],
        "q" => [7.0, 0.0],
        "wall[1,0]" => [1.0, 0.0],
        "wall[2,0]" => [2.0, 0.0],
        _ => [0.0, 0.0],
    };
    let mut sum = [0.0; 3];
    for reaction in answer.reactions.as_ref().unwrap() {
        let [x, y] = place(&reaction.node);
        sum[0] -= reaction.fx;
        sum[1] -= reaction.fy;
        sum[2] -= x * reaction.fy - y * reaction.fx;
    }
    sum
}

fn near_resultant(load: Value, expected: [f64; 3]) {
    let found = resultant(&wall(load));
    near_all("resultant", &found, &expected, 1e-11);
}

#[test]
fn resultants_of_loads_on_edges_and_areas() {
    // Weight of the wall 2·3·0.25 at x = 1, of the fin 2·3/2·0.5 at x = 5 + 2/3.
    let (g, wall_mass, fin_mass) = (9.81, DENSITY * 1.5, DENSITY * 1.5);
    near_resultant(
        json!({ "gravity": { "acceleration": [0, -g] } }),
        [0.0, -g * (wall_mass + fin_mass), -g * (wall_mass + fin_mass * (5.0 + 2.0 / 3.0))],
    );
    near_resultant(
        json!({ "gravity": { "acceleration": [g, 0], "on": ["wall"] } }),
        [g * wall_mass, 0.0, -g * wall_mass * 1.5],
    );
    // Pressure on the slope: outward normal (3, 2)/√13, length √13, middle (6, 1.5), thickness 0.5.
    near_resultant(
        json!({ "pressure": { "edge": "slope", "value": 4.0 } }),
        [-4.0 * 0.5 * 3.0, -4.0 * 0.5 * 2.0, 4.0 * 0.5 * (3.0 * 1.5 - 2.0 * 6.0)],
    );
    // From 1 at q to 3 at r: mean 2, at 7/12 of the way from q (the centre of the trapezoid).
    let (x, y) = (7.0 - 2.0 * 7.0 / 12.0, 3.0 * 7.0 / 12.0);
    near_resultant(json!({ "pressure": { "edge": "slope", "value": [1.0, 3.0] } }), [-3.0, -2.0, 3.0 * y - 2.0 * x]);
    // Water to y = 2.2 on the left edge: γ h²/2 t at h/3.
    near_resultant(
        json!({ "fluid": { "edge": "wall.left", "level": 2.2, "weight": 10.0 } }),
        [10.0 * 2.2 * 2.2 / 2.0 * 0.25, 0.0, -10.0 * 2.2 * 2.2 / 2.0 * 0.25 * 2.2 / 3.0],
    );
    // The same on the slope pushes down too: the horizontal part as on an upright wall, the vertical one 2/3 of it.
    let push = 10.0 * 2.2 * 2.2 / 2.0 * 0.5;
    let (x, y) = (7.0 - 2.0 / 3.0 * 2.2 / 3.0, 2.2 / 3.0);
    near_resultant(
        json!({ "fluid": { "edge": "slope", "level": 2.2, "weight": 10.0 } }),
        [-push, -push * 2.0 / 3.0, push * y - push * 2.0 / 3.0 * x],
    );
    // Traction along the top, linear from 0 to −6 in y: −6 in all at x = 4/3; and a total on an edge.
    near_resultant(json!({ "traction": { "edge": "wall.top", "value": [[0, 0], [0, -6.0]] } }), [0.0, -6.0, -8.0]);
    near_resultant(json!({ "point": { "at": "slope", "force": [3.0, 0.0] } }), [3.0, 0.0, -4.5]);
}

/// A plate held only against its motion as a body grows freely: u = α ΔT x, plane strain (1 + ν) as much.
#[test]
fn free_plates_grow_with_temperature() {
    for (plane, factor) in [("stress", 1.0), ("strain", 1.2)] {
        let case = Case::json(json!({
            "materials": { "m": { "E": E, "nu": 0.2, "expansion": EXPANSION } },
            "plates": [{ "id": "p", "origin": [0, 0], "size": [2, 1], "divisions": [3, 2], "thickness": 0.3,
                         "rotation": 0, "material": "m", "plane": plane }],
            "supports": [{ "at": "p[0,0]", "fixed": ["x", "y"] }, { "at": "p[3,0]", "fixed": ["y"] }],
            "loads": { "heat": { "factor": 30, "items": [{ "temperature": { "change": 1, "on": ["p"] } }] } }
        }));
        let answer = case.solve(&[]);
        let u = displacement(&answer, "p[3,2]");
        near("u_x", u[0], factor * EXPANSION * 30.0 * 2.0, 1e-12, 0.1);
        near("u_y", u[1], factor * EXPANSION * 30.0, 1e-12, 0.1);
        for reaction in answer.reactions.as_ref().unwrap() {
            near("reaction", reaction.fx.hypot(reaction.fy), 0.0, 1e-9, E * EXPANSION * 30.0);
        }
    }
}

/// A frame as one polyline is the same as its segments one by one; distances run along the whole line.
#[test]
fn polylines_are_chains_of_bars() {
    let nodes = json!({ "a": [0, 0], "b": [0, 3], "c": [4, 5], "d": [4, 0] });
    let model = |bars: Value, loads: Value| {
        Case::json(json!({
            "materials": { "m": { "E": E, "nu": 0.2 } },
            "sections": { "s": { "area": AREA, "inertia": INERTIA, "shear_area": 0.4 } },
            "nodes": nodes, "bars": bars,
            "supports": [{ "at": "a", "fixed": ["x", "y", "r"] }, { "at": "d", "fixed": ["x", "y"] }],
            "loads": { "w": { "items": loads } }
        }))
        .solve(&[])
    };
    let bar = |id: &str, a: &str, b: &str| json!({ "id": id, "nodes": [a, b], "material": "m", "section": "s" });
    let along = 3.0 + 20f64.sqrt() / 2.0;
    let one = model(
        json!([{ "id": "frame", "polyline": ["a", "b", "c", "d"], "divisions": 2, "material": "m", "section": "s" }]),
        json!([{ "line": { "bar": "frame", "value": [1, -2], "range": [0, along] } },
               { "point": { "bar": "frame", "distance": along, "force": [0, -5] } }]),
    );
    let many = model(
        json!([bar("ab", "a", "b"), bar("bc", "b", "c"), bar("cd", "c", "d")]),
        json!([{ "line": { "bar": "ab", "value": [1, -2] } },
               { "line": { "bar": "bc", "value": [1, -2], "range": [0, 20f64.sqrt() / 2.0] } },
               { "point": { "bar": "bc", "distance": 20f64.sqrt() / 2.0, "force": [0, -5] } }]),
    );
    for node in ["b", "c", "d"] {
        near_all(node, &displacement(&one, node), &displacement(&many, node), 1e-9);
    }
}
