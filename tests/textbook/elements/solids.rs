//! Patch tests of the solids through meshes of files: a linear field in a distorted mesh, once by displacements of the
//! whole surface, once by the tractions of its constant stress on its six faces; every node and every stress to 1e-12.

use std::collections::{BTreeMap, HashMap};
use std::fmt::Write as _;
use std::path::Path;

use serde_json::{Value, json};
use stickslip::answer::record::Answer;
use stickslip::fem::Displacements;
use stickslip::solve::prepared::Geometry;

use crate::common::*;

const E: f64 = 3.0e4;
const NU: f64 = 0.3;
const SIZE: [f64; 3] = [1.0, 1.2, 0.9];
/// Divisions of each side.
const N: usize = 2;

/// Nodes of an element, its type in a .msh file, and whether with incompatible modes.
const KINDS: [(usize, u8, bool); 5] = [(4, 4, false), (10, 11, false), (8, 5, false), (8, 5, true), (20, 17, false)];

type Place = [f64; 3];

/// u = B x + c.
struct Field {
    gradient: [[f64; 3]; 3],
    constant: [f64; 3],
}

impl Field {
    fn at(&self, x: Place) -> [f64; 3] {
        [0, 1, 2].map(|i| (0..3).map(|j| self.gradient[i][j] * x[j]).sum::<f64>() + self.constant[i])
    }

    /// Its stress by Hooke's law, as a matrix.
    fn stress(&self) -> [[f64; 3]; 3] {
        let b = self.gradient;
        let trace = b[0][0] + b[1][1] + b[2][2];
        let g = E / (2.0 * (1.0 + NU));
        let lambda = 2.0 * g * NU / (1.0 - 2.0 * NU);
        let entry = |i: usize, j: usize| g * (b[i][j] + b[j][i]) + if i == j { lambda * trace } else { 0.0 };
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
    }
}

fn fields() -> Vec<Field> {
    // Each of the twelve alone, then one of all.
    let mut all: Vec<Field> = (0..12)
        .map(|k| {
            let mut field = Field { gradient: [[0.0; 3]; 3], constant: [0.0; 3] };
            if k < 9 {
                field.gradient[k / 3][k % 3] = 1e-3;
            } else {
                field.constant[k - 9] = 1e-3;
            }
            field
        })
        .collect();
    let gradient = [[1.3e-3, -0.7e-3, 0.2e-3], [0.4e-3, -0.9e-3, 0.6e-3], [-0.3e-3, 0.8e-3, 0.5e-3]];
    all.push(Field { gradient, constant: [0.2e-3, -0.5e-3, 0.1e-3] });
    all
}

/// A distorted mesh of a box: nodes move inside, and in their face or along their side on the surface; the sides of
/// quadratic elements inside bulge.
struct Mesh {
    nodes: Vec<Place>,
    elements: Vec<Vec<usize>>,
    /// The elements of each face of the box as areas: left, right, front, back, bottom, top.
    faces: [Vec<Vec<usize>>; 6],
    kind: (usize, u8, bool),
}

/// Sides of a tetrahedron and of a hexahedron in the order in which Gmsh counts their middles.
const TETRAHEDRON: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [3, 0], [2, 3], [1, 3]];
const HEXAHEDRON: [[usize; 2]; 12] =
    [[0, 1], [0, 3], [0, 4], [1, 2], [1, 5], [2, 3], [2, 6], [3, 7], [4, 5], [4, 7], [5, 6], [6, 7]];

impl Mesh {
    fn new(kind: (usize, u8, bool)) -> Mesh {
        let (mut nodes, mut elements) = (Vec::new(), Vec::new());
        let mut wave = 0.0_f64;
        // A shift that leaves the planes of the box.
        let mut moved = |at: Place, by: f64| -> Place {
            std::array::from_fn(|c| {
                wave += 1.0;
                let inside = at[c] > 1e-9 && at[c] < SIZE[c] - 1e-9;
                at[c] + if inside { by * SIZE[c] / N as f64 * (12.9898 * wave).sin() } else { 0.0 }
            })
        };
        for index in 0..(N + 1).pow(3) {
            let at = [index % (N + 1), index / (N + 1) % (N + 1), index / (N + 1).pow(2)];
            nodes.push(moved([0, 1, 2].map(|c| at[c] as f64 / N as f64 * SIZE[c]), 0.15));
        }
        for index in 0..N.pow(3) {
            let [i, j, k] = [index % N, index / N % N, index / N.pow(2)];
            let corner = |a: usize, b: usize, c: usize| i + a + (N + 1) * (j + b + (N + 1) * (k + c));
            let below = [corner(0, 0, 0), corner(1, 0, 0), corner(1, 1, 0), corner(0, 1, 0)];
            let cube = [below, below.map(|node| node + (N + 1).pow(2))].concat();
            if kind.0.is_multiple_of(4) && kind.0 > 4 {
                elements.push(cube);
            } else {
                let round = [1, 2, 3, 7, 4, 5, 1];
                elements.extend(round.windows(2).map(|two| [0, two[0], two[1], 6].map(|at| cube[at]).to_vec()));
            }
        }
        let sides: &[[usize; 2]] = match kind.0 {
            10 => &TETRAHEDRON,
            20 => &HEXAHEDRON,
            _ => &[],
        };
        let mut middles: HashMap<[usize; 2], usize> = HashMap::new();
        for element in &mut elements {
            for [a, b] in sides {
                let (a, b) = (element[*a].min(element[*b]), element[*a].max(element[*b]));
                let middle = *middles.entry([a, b]).or_insert_with(|| {
                    let at = [0, 1, 2].map(|c| 0.5 * (nodes[a][c] + nodes[b][c]));
                    // Sides on the surface stay straight, so that its areas have known tractions.
                    let on_surface = (0..3).any(|c| at[c] < 1e-9 || at[c] > SIZE[c] - 1e-9);
                    nodes.push(if on_surface { at } else { moved(at, 0.05) });
                    nodes.len() - 1
                });
                element.push(middle);
            }
        }
        let mut mesh = Mesh { nodes, elements, faces: Default::default(), kind };
        mesh.find_faces(&middles);
        mesh
    }

    fn find_faces(&mut self, middles: &HashMap<[usize; 2], usize>) {
        let of_cube: [&[usize]; 6] =
            [&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];
        let of_tetrahedron: [&[usize]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];
        let faces: &[&[usize]] = if self.kind.0 == 4 || self.kind.0 == 10 { &of_tetrahedron } else { &of_cube };
        for element in &self.elements {
            for face in faces {
                let mut nodes: Vec<usize> = face.iter().map(|&corner| element[corner]).collect();
                let on = |c: usize, x: f64| nodes.iter().all(|&node| (self.nodes[node][c] - x).abs() < 1e-9);
                let Some(plane) =
                    (0..6).find(|&plane| on(plane / 2, if plane % 2 == 0 { 0.0 } else { SIZE[plane / 2] }))
                else {
                    continue;
                };
                if !middles.is_empty() {
                    let n = nodes.len();
                    let side = |k: usize| [nodes[k].min(nodes[(k + 1) % n]), nodes[k].max(nodes[(k + 1) % n])];
                    let more: Vec<usize> = (0..n).map(|k| middles[&side(k)]).collect();
                    nodes.extend(more);
                }
                self.faces[plane].push(nodes);
            }
        }
    }

    /// Gmsh 2.2; the faces are the groups 1 to 6, the body has none.
    fn write(&self, path: &Path) {
        let mut text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n".to_owned();
        let _ = writeln!(text, "{}", self.nodes.len());
        for (index, [x, y, z]) in self.nodes.iter().enumerate() {
            let _ = writeln!(text, "{} {x} {y} {z}", index + 1);
        }
        let areas =
            self.faces.iter().enumerate().flat_map(|(plane, areas)| areas.iter().map(move |area| (plane + 1, area)));
        let kind_of_area = |nodes: usize| BTreeMap::from([(3, 2), (4, 3), (6, 9), (8, 16)])[&nodes];
        let areas = areas.map(|(group, area)| (kind_of_area(area.len()), group, area));
        let solids = self.elements.iter().map(|element| (self.kind.1, 0, element));
        let all: Vec<(u8, usize, &Vec<usize>)> = areas.chain(solids).collect();
        let _ = writeln!(text, "$EndNodes\n$Elements\n{}", all.len());
        for (index, (kind, group, nodes)) in all.into_iter().enumerate() {
            let nodes: Vec<String> = nodes.iter().map(|node| (node + 1).to_string()).collect();
            let _ = writeln!(text, "{} {kind} 2 {group} 1 {}", index + 1, nodes.join(" "));
        }
        std::fs::write(path, text + "$EndElements\n").expect("a file");
    }

    fn scenario(&self) -> Value {
        let element = if self.kind.2 { "incompatible" } else { "plain" };
        json!({
            "format": "stickslip/1", "title": "patch", "dimension": 3,
            "materials": { "m": { "E": E, "nu": NU } },
            "meshes": [{ "id": "m", "file": "patch.msh", "materials": { "*": { "material": "m", "element": element } } }],
        })
    }
}

/// Displacements of all nodes and stresses of all elements, at their centres and nodes.
fn check(what: &str, case: &Case, answer: &Answer, field: &Field) {
    is_answer(answer);
    let Geometry::Structure { main, structure, .. } = &*case.prepared.geometry else { panic!("a structure") };
    let all = answer.displacements.as_ref().expect("displacements");
    let exact: Vec<[f64; 3]> = structure.nodes.iter().map(|node| field.at(node.position)).collect();
    let size = exact.iter().flatten().fold(0f64, |m, u| m.max(u.abs()));
    for (found, exact) in all.iter().zip(&exact) {
        for (found_u, exact) in found.all().into_iter().zip(exact) {
            near(&format!("{what}: {}", found.node), found_u, *exact, 1e-12, size);
        }
    }
    let u = Displacements::from(all.iter().map(|d| d.all()).collect::<Vec<_>>());
    let factors = vec![1.0; structure.load_cases.len()];
    let s = field.stress();
    let right = [s[0][0], s[1][1], s[0][1], s[2][2], s[1][2], s[2][0]];
    // What the rounding of u itself strains: E size / side, with sides near a tenth of the mesh.
    let scale = right.iter().fold(E * size / SIZE[2], |m, s| m.max(s.abs()));
    let centres = main.element_stresses(structure, &u, &factors).into_iter().map(|s| s.stress);
    let nodes = main.node_stresses(structure, &u, &factors).into_iter().map(|s| s.stress);
    for stress in centres.chain(nodes) {
        for (found, right) in stress.into_iter().zip(right) {
            near(what, found, right, 1e-12, scale);
        }
    }
}

#[test]
fn tetrahedra_and_hexahedra() {
    let folder = tempfile::tempdir().expect("a place");
    for kind in KINDS {
        let mesh = Mesh::new(kind);
        mesh.write(&folder.path().join("patch.msh"));
        let name = |node: usize| format!("m/{}", node + 1);
        // Quadratic elements take a while: the field of all.
        for field in fields().into_iter().skip(if kind.0 > 8 { 12 } else { 0 }) {
            let mut scenario = mesh.scenario();
            let surface =
                mesh.nodes.iter().enumerate().filter(|(_, at)| (0..3).any(|c| at[c] < 1e-9 || at[c] > SIZE[c] - 1e-9));
            let support = |(node, at): (usize, &Place)| json!({ "at": name(node), "fixed": ["x", "y", "z"], "settlement": field.at(*at), "case": "moved" });
            scenario["supports"] = surface.map(support).collect();
            scenario["loads"] = json!({ "moved": { "items": [] } });
            let case = Case::in_folder(scenario, folder.path());
            check(&format!("{kind:?}, displacements"), &case, &case.solve(&[]), &field);

            let mut scenario = mesh.scenario();
            let stress = field.stress();
            let traction = |plane: usize| {
                let sign = if plane.is_multiple_of(2) { -1.0 } else { 1.0 };
                let value = [0, 1, 2].map(|i| sign * stress[i][plane / 2]);
                json!({ "traction": { "face": format!("m.{}", plane + 1), "value": value } })
            };
            scenario["loads"] = json!({ "pulled": { "items": (0..6).map(traction).collect::<Vec<_>>() } });
            // Three corners of the box: one held, one along x kept level, one along y.
            let [first, second, third] = [0, N, N * (N + 1)];
            let of = |node: usize| field.at(mesh.nodes[node]);
            scenario["supports"] = json!([
                { "at": name(first), "fixed": ["x", "y", "z"], "settlement": of(first), "case": "pulled" },
                { "at": name(second), "fixed": ["y", "z"], "settlement": [0, of(second)[1], of(second)[2]], "case": "pulled" },
                { "at": name(third), "fixed": ["z"], "settlement": [0, 0, of(third)[2]], "case": "pulled" },
            ]);
            let case = Case::in_folder(scenario, folder.path());
            check(&format!("{kind:?}, tractions"), &case, &case.solve(&[]), &field);
        }
    }
}
