//! A cantilever under a force at its end, plane stress, against Timoshenko and Goodier's solution: how fast the elements
//! converge. The figures of docs/elements.md; `STICKSLIP_BLESS=1` writes them anew.
//!
//! ```text
//!     I = 2c³/3, force P per thickness upwards as the shear P (c² − y²)/2I on the end x = L
//!     u = −P y (L x − x²/2)/EI − (2 + ν) P y³/6EI
//!     v = ν P (L − x) y²/2EI + P (L x²/2 − x³/6 + (1 + ν) c² x)/EI
//! ```
//!
//! u and v are imposed at x = 0, so that the elements are all that is approximate.

use serde_json::{Value, json};

use super::mesh::{Grid, Kind};
use crate::common::*;

const E: f64 = 1000.0;
const NU: f64 = 0.3;
const P: f64 = 1.0;
const L: f64 = 8.0;
/// Half the depth.
const C: f64 = 1.0;
const EI: f64 = E * 2.0 * C * C * C / 3.0;

fn exact([x, y]: [f64; 2]) -> [f64; 2] {
    let u = -P * y * (L * x - x * x / 2.0) / EI - (2.0 + NU) * P * y * y * y / (6.0 * EI);
    let v =
        NU * P * (L - x) * y * y / (2.0 * EI) + P * (L * x * x / 2.0 - x * x * x / 6.0 + (1.0 + NU) * C * C * x) / EI;
    [u, v]
}

/// ∫ N τ dy over one side of the loaded end, τ = P (c² − y²)/2I, for nodes at `ys`: two or, quadratic, three.
fn end_forces(ys: &[f64]) -> Vec<f64> {
    let (first, last) = (ys[0], ys[ys.len() - 1]);
    // Gauss, three points: exact to degree 5.
    let points = [(-0.6_f64.sqrt(), 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.6_f64.sqrt(), 5.0 / 9.0)];
    let mut forces = vec![0.0; ys.len()];
    for (at, weight) in points {
        let y = 0.5 * (first + last) + 0.5 * (last - first) * at;
        let tau = P * E / (2.0 * EI) * (C * C - y * y);
        for (i, force) in forces.iter_mut().enumerate() {
            let lagrange =
                ys.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, other)| (y - other) / (ys[i] - other));
            *force += 0.5 * (last - first) * weight * tau * lagrange.product::<f64>();
        }
    }
    forces
}

/// v at the end over its exact value, with `n` elements through the depth, twice as long as deep.
fn deflection(kind: Kind, n: usize) -> f64 {
    let grid = Grid::new(kind, [L, 2.0 * C], [2 * n, n], 0.0, 0);
    // The grid starts at the lower corner, the solution on the axis.
    let place = |node: &str| {
        let [x, y] = grid.place(node);
        [x, y - C]
    };
    let folder = tempfile::tempdir().expect("a place");
    let mut scenario = grid.scenario(1.0, "stress", json!({ "E": E, "nu": NU }), folder.path());
    let [_, right, _, left] = &grid.edges;
    let supports: Vec<Value> = left
        .iter()
        .map(|node| json!({ "at": node, "fixed": ["x", "y"], "settlement": exact(place(node)), "case": "w" }))
        .collect();
    scenario["supports"] = supports.into();
    let per_side = (right.len() - 1) / n + 1;
    let mut items = Vec::new();
    for side in 0..n {
        let nodes = &right[side * (per_side - 1)..][..per_side];
        let ys: Vec<f64> = nodes.iter().map(|node| place(node)[1]).collect();
        for (node, force) in nodes.iter().zip(end_forces(&ys)) {
            items.push(json!({ "point": { "at": node, "force": [0, force] } }));
        }
    }
    scenario["loads"] = json!({ "w": { "items": items } });
    let answer = Case::in_folder(scenario, folder.path()).solve(&[]);
    is_answer(&answer);
    let corner = &right[0];
    displacement(&answer, corner)[1] / exact(place(corner))[1]
}

const KINDS: [Kind; 5] = [Kind::T3, Kind::Plain, Kind::Incompatible, Kind::T6, Kind::Q8];
const DEPTHS: [usize; 5] = [1, 2, 4, 8, 16];
const BEGIN: &str = "<!-- bending -->\n";
const END: &str = "<!-- end of bending -->\n";

/// The table of the page is what the program computes; the error falls with the square of the size of the elements (of
/// quadratic ones with its third power or faster), and incompatible modes take most of it away.
#[test]
fn bending_converges_as_the_page_says() {
    let ratios = KINDS.map(|kind| DEPTHS.map(|n| deflection(kind, n)));
    let mut table = String::from(
        "| elements through the depth | T3 | plain quad | incompatible quad | T6 | Q8 |\n| ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    for (row, n) in DEPTHS.into_iter().enumerate() {
        let cells = ratios.map(|column| format!("{:.5}", column[row]));
        table.push_str(&format!("| {n} | {} |\n", cells.join(" | ")));
    }
    let path = "docs/elements.md";
    let page = std::fs::read_to_string(path).expect("the page");
    let (before, rest) = page.split_once(BEGIN).expect("the table begins");
    let (_, after) = rest.split_once(END).expect("the table ends");
    let right = format!("{before}{BEGIN}{table}{END}{after}");
    if std::env::var_os("STICKSLIP_BLESS").is_some() {
        std::fs::write(path, &right).expect("written");
    } else {
        assert_eq!(page, right, "docs/elements.md is not what the program computes");
    }
    for (kind, column) in KINDS.into_iter().zip(ratios) {
        let errors = column.map(|ratio| (1.0 - ratio).abs());
        // Of the last halving; T3 are far from the limit before.
        let order = (errors[3] / errors[4]).log2();
        // Quadratic elements have displacements of the fourth order at their corners and may pass through the exact value.
        let right = if matches!(kind, Kind::T6 | Kind::Q8) { 2.9..f64::INFINITY } else { 1.9..2.05 };
        assert!(right.contains(&order), "{kind:?}: order {order}, {errors:?}");
    }
    let [_, plain, incompatible, ..] = ratios.map(|column| column.map(|ratio| (1.0 - ratio).abs()));
    for (plain, incompatible) in plain.into_iter().zip(incompatible) {
        assert!(incompatible < 0.1 * plain, "{plain} {incompatible}");
    }
}
