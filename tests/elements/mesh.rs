//! Distorted grids of every membrane element, as entries of a scenario.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Map, Value, json};

/// Elements that a scenario can name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Plain,
    Incompatible,
    T3,
    T6,
    /// With bent sides inside.
    T6Bent,
}

impl Kind {
    pub const ALL: [Kind; 5] = [Kind::Plain, Kind::Incompatible, Kind::T3, Kind::T6, Kind::T6Bent];

    fn is_quadratic(self) -> bool {
        matches!(self, Kind::T6 | Kind::T6Bent)
    }
}

/// A grid on [0, size] with `divisions` columns and rows.
pub struct Grid {
    pub nodes: Map<String, Value>,
    /// Entries of `triangles` and of `quads`.
    pub triangles: Vec<Value>,
    pub quads: Vec<Value>,
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
        let mut grid =
            Grid { nodes: Map::new(), triangles: Vec::new(), quads: Vec::new(), edges: [const { Vec::new() }; 4] };
        let name = |[i, j]: [usize; 2]| format!("n{i}_{j}");
        for (j, row) in places.iter().enumerate() {
            for (i, place) in row.iter().enumerate() {
                grid.nodes.insert(name([i, j]), json!(place));
            }
        }
        let bend = if kind == Kind::T6Bent { 0.05 } else { 0.0 };
        for j in 0..divisions[1] {
            for i in 0..divisions[0] {
                let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
                if matches!(kind, Kind::Plain | Kind::Incompatible) {
                    let element = if kind == Kind::Plain { "plain" } else { "incompatible" };
                    let nodes = corners.map(name);
                    grid.quads.push(json!({ "id": format!("q{i}_{j}"), "nodes": nodes, "element": element }));
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
        let id = format!("m{}_{}_{}_{}", a[0], a[1], b[0], b[1]);
        let [p, q] = ends.map(|[i, j]| places[j][i]);
        let outside = |c: usize, last: usize| a[c] == b[c] && (a[c] == 0 || a[c] == last);
        let bend = if outside(0, columns) || outside(1, rows) { 0.0 } else { bend };
        let place = [0.5 * (p[0] + q[0]) - bend * (q[1] - p[1]), 0.5 * (p[1] + q[1]) + bend * (q[0] - p[0])];
        self.nodes.insert(id.clone(), json!(place));
        id
    }

    /// The entries completed by what all elements have in common.
    pub fn scenario(&self, thickness: f64, plane: &str, material: Value) -> Value {
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
}
