//! Distorted grids of every membrane element, as entries of a scenario.

use std::path::Path;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Map, Value, json};

/// Elements of a scenario; those of eight nodes come from a mesh in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Plain,
    Incompatible,
    T3,
    T6,
    /// With bent sides inside.
    T6Bent,
    Q8,
    Q8Bent,
}

impl Kind {
    pub const ALL: [Kind; 7] =
        [Kind::Plain, Kind::Incompatible, Kind::T3, Kind::T6, Kind::T6Bent, Kind::Q8, Kind::Q8Bent];

    fn is_quadratic(self) -> bool {
        matches!(self, Kind::T6 | Kind::T6Bent) || self.is_from_file()
    }

    fn is_from_file(self) -> bool {
        matches!(self, Kind::Q8 | Kind::Q8Bent)
    }

    /// A corner of the grid; its own tag in a file.
    pub fn corner(self, [i, j]: [usize; 2]) -> String {
        if self.is_from_file() { format!("g/{}", 1 + i + 100 * j) } else { format!("n{i}_{j}") }
    }

    fn middle_of(self, [[i, j], [k, l]]: [[usize; 2]; 2]) -> String {
        if self.is_from_file() { format!("g/{}", 10_001 + i + k + 200 * (j + l)) } else { format!("m{i}_{j}_{k}_{l}") }
    }
}

/// A grid on [0, size] with `divisions` columns and rows.
pub struct Grid {
    kind: Kind,
    nodes: Map<String, Value>,
    /// Entries of `triangles` and of `quads`.
    triangles: Vec<Value>,
    quads: Vec<Value>,
    /// Nodes of the elements of a file.
    eights: Vec<Vec<String>>,
    /// Nodes of the four edges in order, counter-clockwise from the lower left corner.
    pub edges: [Vec<String>; 4],
}

impl Grid {
    /// Nodes inside are moved by up to `shake` of a cell, those of the edges along them.
    pub fn new(kind: Kind, size: [f64; 2], divisions: [usize; 2], shake: f64, seed: u64) -> Grid {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let cell = [0, 1].map(|c| size[c] / divisions[c] as f64);
        let mut moved = |at: usize, c: usize, amount: f64| {
            let inside = at > 0 && at < divisions[c];
            let off: f64 = rng.random_range(-1.0..=1.0);
            cell[c] * (at as f64 + if inside { amount * off } else { 0.0 })
        };
        let mut places = vec![vec![[0.0; 2]; divisions[0] + 1]; divisions[1] + 1];
        for (j, row) in places.iter_mut().enumerate() {
            for (i, place) in row.iter_mut().enumerate() {
                *place = [moved(i, 0, shake), moved(j, 1, shake)];
            }
        }
        let mut grid = Grid {
            kind,
            nodes: Map::new(),
            triangles: Vec::new(),
            quads: Vec::new(),
            eights: Vec::new(),
            edges: [const { Vec::new() }; 4],
        };
        let name = |at: [usize; 2]| kind.corner(at);
        for (j, row) in places.iter().enumerate() {
            for (i, place) in row.iter().enumerate() {
                grid.nodes.insert(name([i, j]), json!(place));
            }
        }
        let bend = if matches!(kind, Kind::T6Bent | Kind::Q8Bent) { 0.05 } else { 0.0 };
        for j in 0..divisions[1] {
            for i in 0..divisions[0] {
                let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
                if matches!(kind, Kind::Plain | Kind::Incompatible) {
                    let element = if kind == Kind::Plain { "plain" } else { "incompatible" };
                    let nodes = corners.map(name);
                    grid.quads.push(json!({ "id": format!("q{i}_{j}"), "nodes": nodes, "element": element }));
                    continue;
                }
                if kind.is_from_file() {
                    let mut nodes = corners.map(name).to_vec();
                    for k in 0..4 {
                        nodes.push(grid.middle(&places, [corners[k], corners[(k + 1) % 4]], divisions, bend));
                    }
                    grid.eights.push(nodes);
                    continue;
                }
                let halves = if (i + j) % 2 == 0 { [[0, 1, 2], [0, 2, 3]] } else { [[0, 1, 3], [1, 2, 3]] };
                for (half, at) in halves.into_iter().enumerate() {
                    let at = at.map(|k: usize| corners[k]);
                    let mut nodes = at.map(name).to_vec();
                    for k in (0..3).filter(|_| kind.is_quadratic()) {
                        let middle = grid.middle(&places, [at[k], at[(k + 1) % 3]], divisions, bend);
                        nodes.push(middle);
                    }
                    grid.triangles.push(json!({ "id": format!("t{i}_{j}_{half}"), "nodes": nodes }));
                }
            }
        }
        let [columns, rows] = divisions;
        let sides: [Vec<[usize; 2]>; 4] = [
            (0..=columns).map(|i| [i, 0]).collect(),
            (0..=rows).map(|j| [columns, j]).collect(),
            (0..=columns).rev().map(|i| [i, rows]).collect(),
            (0..=rows).rev().map(|j| [0, j]).collect(),
        ];
        grid.edges = sides.map(|side| {
            let mut nodes = vec![name(side[0])];
            for ends in side.windows(2) {
                if kind.is_quadratic() {
                    nodes.push(grid.middle(&places, [ends[0], ends[1]], divisions, bend));
                }
                nodes.push(name(ends[1]));
            }
            nodes
        });
        grid
    }

    /// The node in the middle of a side; off the chord by `bend` times its length where the side lies inside.
    fn middle(
        &mut self,
        places: &[Vec<[f64; 2]>],
        mut ends: [[usize; 2]; 2],
        [columns, rows]: [usize; 2],
        bend: f64,
    ) -> String {
        ends.sort_unstable();
        let [a, b] = ends;
        let id = self.kind.middle_of(ends);
        let [p, q] = ends.map(|[i, j]| places[j][i]);
        let outside = |c: usize, last: usize| a[c] == b[c] && (a[c] == 0 || a[c] == last);
        let bend = if outside(0, columns) || outside(1, rows) { 0.0 } else { bend };
        let place = [0.5 * (p[0] + q[0]) - bend * (q[1] - p[1]), 0.5 * (p[1] + q[1]) + bend * (q[0] - p[0])];
        self.nodes.insert(id.clone(), json!(place));
        id
    }

    /// The entries completed by what all elements have in common; a mesh is written into `folder`.
    pub fn scenario(&self, thickness: f64, plane: &str, material: Value, folder: &Path) -> Value {
        if self.kind.is_from_file() {
            std::fs::write(folder.join("grid.inp"), self.file()).expect("written");
            return json!({
                "materials": { "m": material },
                "meshes": [{ "id": "g", "file": "grid.inp",
                             "materials": { "*": { "material": "m", "thickness": thickness, "plane": plane } } }],
            });
        }
        let complete = |elements: &[Value]| -> Vec<Value> {
            let mut elements = elements.to_vec();
            for element in &mut elements {
                element["thickness"] = thickness.into();
                element["plane"] = plane.into();
                element["material"] = "m".into();
            }
            elements
        };
        json!({
            "materials": { "m": material },
            "nodes": self.nodes,
            "triangles": complete(&self.triangles),
            "quads": complete(&self.quads),
        })
    }

    pub fn place(&self, node: &str) -> [f64; 2] {
        [0, 1].map(|c| self.nodes[node][c].as_f64().expect("a number"))
    }

    /// Nodes on the edges, each once.
    pub fn boundary(&self) -> Vec<String> {
        self.edges.iter().flat_map(|edge| edge[1..].to_vec()).collect()
    }

    /// The elements of eight nodes as Abaqus writes them.
    fn file(&self) -> String {
        let tag = |node: &str| node.trim_start_matches("g/").to_owned();
        let mut text = String::from("*NODE\n");
        for node in self.nodes.keys() {
            let [x, y] = self.place(node);
            text.push_str(&format!("{}, {x:?}, {y:?}\n", tag(node)));
        }
        text.push_str("*ELEMENT, TYPE=CPS8\n");
        for (k, nodes) in self.eights.iter().enumerate() {
            let tags: Vec<String> = nodes.iter().map(|node| tag(node)).collect();
            text.push_str(&format!("{}, {}\n", k + 1, tags.join(", ")));
        }
        text
    }
}
