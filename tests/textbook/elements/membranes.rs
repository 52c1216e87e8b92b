//! Patch tests of the membrane elements: a linear field in a distorted mesh, once by displacements of the whole boundary,
//! once by the tractions of its constant stress; every node and every stress to 1e-12.

use serde_json::{Value, json};
use stickslip::answer::record::Answer;
use stickslip::fem::Displacements;
use stickslip::solve::prepared::Geometry;

use super::mesh::{Grid, Kind};
use crate::common::*;

const E: f64 = 3.0e4;
const NU: f64 = 0.3;
const THICKNESS: f64 = 0.4;
const SIZE: [f64; 2] = [2.4, 1.2];

/// u = B x + c.
#[derive(Clone, Copy)]
struct Field {
    gradient: [[f64; 2]; 2],
    constant: [f64; 2],
}

impl Field {
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|i| self.gradient[i][0] * x + self.gradient[i][1] * y + self.constant[i])
    }

    /// (σ_x, σ_y, τ, σ_z) by Hooke's law.
    fn stress(&self, plane: &str) -> [f64; 4] {
        let [[xx, xy], [yx, yy]] = self.gradient;
        let shear = E / (2.0 * (1.0 + NU)) * (xy + yx);
        if plane == "stress" {
            let c = E / (1.0 - NU * NU);
            return [c * (xx + NU * yy), c * (yy + NU * xx), shear, 0.0];
        }
        let c = E / ((1.0 + NU) * (1.0 - 2.0 * NU));
        let [x, y] = [c * ((1.0 - NU) * xx + NU * yy), c * ((1.0 - NU) * yy + NU * xx)];
        [x, y, shear, NU * (x + y)]
    }
}

/// Displacements of all nodes and stresses of all elements, at their centres and nodes.
fn check(what: &str, case: &Case, answer: &Answer, field: Field, plane: &str) {
    is_answer(answer);
    let Geometry::Structure { main, structure, .. } = &*case.prepared.geometry else { panic!("a structure") };
    let all = answer.displacements.as_ref().expect("displacements");
    let exact: Vec<[f64; 2]> = structure.nodes.iter().map(|node| field.at(node.in_plane())).collect();
    let size = exact.iter().flatten().fold(0f64, |m, u| m.max(u.abs()));
    for (found, exact) in all.iter().zip(&exact) {
        near(&format!("{what}: {}", found.node), found.ux, exact[0], 1e-12, size);
        near(&format!("{what}: {}", found.node), found.uy, exact[1], 1e-12, size);
    }
    let u = Displacements::from(all.iter().map(|d| [d.ux, d.uy, 0.0, 0.0, 0.0, d.rz]).collect::<Vec<_>>());
    let factors = vec![1.0; structure.load_cases.len()];
    let right = field.stress(plane);
    // What the rounding of u itself strains: E size / side, with sides near a tenth of the mesh.
    let scale = right.iter().fold(E * size / SIZE[1], |m, s| m.max(s.abs()));
    let centres = main.element_stresses(structure, &u, &factors).into_iter().map(|s| s.stress);
    let nodes = main.node_stresses(structure, &u, &factors).into_iter().map(|s| s.stress);
    for stress in centres.chain(nodes) {
        for (found, right) in stress.into_iter().zip(right) {
            near(what, found, right, 1e-12, scale);
        }
    }
}

fn fields() -> Vec<Field> {
    // Each of the six alone, then one of all.
    let mut all: Vec<Field> = (0..6)
        .map(|k| {
            let mut field = Field { gradient: [[0.0; 2]; 2], constant: [0.0; 2] };
            match k {
                0..4 => field.gradient[k / 2][k % 2] = 1e-3,
                _ => field.constant[k - 4] = 1e-3,
            }
            field
        })
        .collect();
    all.push(Field { gradient: [[1.3e-3, -0.7e-3], [0.4e-3, -0.9e-3]], constant: [0.2e-3, -0.5e-3] });
    all
}

/// Displacements of the field at the whole boundary.
fn by_displacements(scenario: &mut Value, places: &[(String, [f64; 2])], field: Field) {
    let support = |(node, place): &(String, [f64; 2])| json!({ "at": node, "fixed": ["x", "y"], "settlement": field.at(*place), "case": "moved" });
    scenario["supports"] = places.iter().map(support).collect();
    scenario["loads"] = json!({ "moved": { "items": [] } });
}

/// The tractions of its stress on the four edges (name, outward normal); three supports whose displacements are its own.
fn by_tractions(
    scenario: &mut Value,
    edges: [(&str, [f64; 2]); 4],
    [first, second]: [&(String, [f64; 2]); 2],
    (field, plane): (Field, &str),
) {
    let [x, y, shear, _] = field.stress(plane);
    let traction = |(edge, [nx, ny]): (&str, [f64; 2])| {
        let value = [x * nx + shear * ny, shear * nx + y * ny].map(|t| t * THICKNESS);
        json!({ "traction": { "edge": edge, "value": value } })
    };
    scenario["loads"] = json!({ "pulled": { "items": edges.map(traction) } });
    let (u, v) = (field.at(first.1), field.at(second.1));
    scenario["supports"] = json!([
        { "at": first.0, "fixed": ["x", "y"], "settlement": u, "case": "pulled" },
        { "at": second.0, "fixed": ["y"], "settlement": [0, v[1]], "case": "pulled" },
    ]);
}

fn material() -> Value {
    json!({ "E": E, "nu": NU })
}

/// Plain and incompatible quads, triangles of three and of six nodes, quads of eight (sides straight, and bent inside), in
/// both planes.
#[test]
fn quads_and_triangles() {
    const NAMES: [&str; 4] = ["bottom", "right", "top", "left"];
    const NORMALS: [[f64; 2]; 4] = [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]];
    let folder = tempfile::tempdir().expect("a place");
    for kind in Kind::ALL {
        for (seed, plane) in ["stress", "strain", "stress"].into_iter().enumerate() {
            let grid = Grid::new(kind, SIZE, [4, 3], 0.25, seed as u64);
            let boundary: Vec<(String, [f64; 2])> =
                grid.boundary().into_iter().map(|node| (node.clone(), grid.place(&node))).collect();
            for field in fields() {
                let mut scenario = grid.scenario(THICKNESS, plane, material(), folder.path());
                by_displacements(&mut scenario, &boundary, field);
                let case = Case::in_folder(scenario, folder.path());
                check(&format!("{kind:?}, displacements"), &case, &case.solve(&[]), field, plane);

                let mut scenario = grid.scenario(THICKNESS, plane, material(), folder.path());
                for (name, edge) in NAMES.into_iter().zip(&grid.edges) {
                    scenario["edges"][name] = json!(edge);
                }
                let edges = [0, 1, 2, 3].map(|k| (NAMES[k], NORMALS[k]));
                let corner = |node: &str| (node.to_owned(), grid.place(node));
                let [first, second] = [[0, 0], [4, 0]].map(|at| corner(&kind.corner(at)));
                by_tractions(&mut scenario, edges, [&first, &second], (field, plane));
                let case = Case::in_folder(scenario, folder.path());
                check(&format!("{kind:?}, tractions"), &case, &case.solve(&[]), field, plane);
            }
        }
    }
}

/// Plates with graded grid lines, turned by 25°, of both elements.
#[test]
fn plates() {
    let (s, c) = 25.0_f64.to_radians().sin_cos();
    let (xs, ys) = ([0.0, 0.3, 1.0, 1.4, 2.4], [0.0, 0.5, 0.7, 1.2]);
    for element in ["plain", "incompatible"] {
        for plane in ["stress", "strain"] {
            for field in fields() {
                let mut scenario = json!({
                    "materials": { "m": material() },
                    "plates": [{ "id": "p", "origin": [0.5, -0.2], "rotation": 25, "x": xs, "y": ys, "thickness": THICKNESS,
                                 "material": "m", "plane": plane, "element": element }],
                });
                let place = |i: usize, j: usize| {
                    let at = [0.5 + c * xs[i] - s * ys[j], -0.2 + s * xs[i] + c * ys[j]];
                    (format!("p[{i},{j}]"), at)
                };
                let boundary: Vec<(String, [f64; 2])> = (0..5)
                    .flat_map(|i| (0..4).map(move |j| (i, j)))
                    .filter(|&(i, j)| i == 0 || i == 4 || j == 0 || j == 3)
                    .map(|(i, j)| place(i, j))
                    .collect();
                let mut pulled = scenario.clone();
                by_displacements(&mut scenario, &boundary, field);
                let case = Case::json(scenario);
                check(&format!("{element} plate, displacements"), &case, &case.solve(&[]), field, plane);

                let edges = [("p.bottom", [s, -c]), ("p.right", [c, s]), ("p.top", [-s, c]), ("p.left", [-c, -s])];
                by_tractions(&mut pulled, edges, [&place(0, 0), &place(4, 0)], (field, plane));
                let case = Case::json(pulled);
                check(&format!("{element} plate, tractions"), &case, &case.solve(&[]), field, plane);
            }
        }
    }
}

/// A block on a bonded or tensionless foundation under a uniform pressure q: it settles by q/k at every node of its
/// foot, whatever the grid lines, and presses with q times the length of each node; its stress is q/t throughout.
#[test]
fn foundations_settle_uniformly() {
    let (q, k) = (3.0, 70.0);
    let xs = [0.0, 0.3, 1.0, 1.4, 2.4];
    for element in ["plain", "incompatible"] {
        for tensionless in [false, true] {
            let case = Case::json(json!({
                "materials": { "m": material() },
                "plates": [{ "id": "p", "origin": [0, 0], "x": xs, "y": [0, 0.5, 0.7], "thickness": THICKNESS,
                             "material": "m", "plane": "stress", "element": element }],
                "foundations": [{ "id": "soil", "on": "p.bottom", "stiffness": k, "tensionless": tensionless }],
                "supports": [{ "at": "p[0,0]", "fixed": ["x"] }],
                "loads": { "w": { "items": [{ "pressure": { "edge": "p.top", "value": q / THICKNESS } }] } }
            }));
            let answer = case.solve(&[]);
            // σ_y = −q/t, ε_x = ν q/(E t), ε_y = −q/(E t).
            let e = q / (E * THICKNESS);
            let field = Field { gradient: [[NU * e, 0.0], [0.0, -e]], constant: [0.0, -q / k] };
            // Nodes of the yielding ground go down with the foot, not with the field's x.
            let mut body = answer.clone();
            let ground: Vec<_> = answer.displacements.iter().flatten().filter(|d| d.node.starts_with("soil")).collect();
            for d in &ground {
                near("ground", d.uy, -q / k, 1e-12, q / k);
            }
            if !tensionless {
                assert!(ground.is_empty());
                check("foundation", &case, &body, field, "stress");
            } else {
                let pairs = of_pairs(&answer, |pair| pair.x_n);
                let right = [0.15, 0.5, 0.55, 0.7, 0.5].map(|length| q * length);
                near_all("pressures", &pairs, &right, 1e-12);
                body.displacements.as_mut().unwrap().iter_mut().filter(|d| d.node.starts_with("soil")).for_each(|d| {
                    let (_, index) = d.node.split_once('/').unwrap();
                    d.ux = NU * e * xs[index.parse::<usize>().unwrap()];
                });
                check("foundation", &case, &body, field, "stress");
            }
        }
    }
}
