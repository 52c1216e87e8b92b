//! Bricks: boxes of hexahedra, and their six faces.

use super::element::{Element, ElementKind};
use super::face::{Face, FaceSide};
use super::node::Node;

/// A box of the file as it describes it, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct BrickGrid {
    /// Name in the file.
    pub id: String,
    /// The corner from which the divisions count.
    pub origin: [f64; 3],
    /// Lengths along x, y and z, > 0.
    pub size: [f64; 3],
    /// Elements along them.
    pub divisions: [usize; 3],
    /// Index of the material.
    pub material: usize,
    /// Whether its elements have incompatible modes.
    pub incompatible: bool,
}

/// A box of the structure: a grid of hexahedra.
#[derive(Clone, Debug, PartialEq)]
pub struct Brick {
    /// Name in the file.
    pub id: String,
    /// Its elements `id{i,j,k}`, i first: a range of [`Structure::elements`](super::structure::Structure::elements).
    pub elements: std::ops::Range<usize>,
    /// Its first node, `id[0,0,0]`; the others follow, i first.
    pub first: usize,
    /// Elements along x, y and z.
    pub divisions: [usize; 3],
}

impl BrickGrid {
    /// Number of nodes, without making them.
    pub fn node_count(&self) -> f64 {
        self.divisions.iter().map(|count| *count as f64 + 1.0).product()
    }

    /// Appends its nodes and returns it, still without elements.
    pub fn append_nodes(&self, nodes: &mut Vec<Node>) -> Brick {
        let first = nodes.len();
        let [nx, ny, nz] = self.divisions;
        let place = |axis: usize, line: usize| {
            self.origin[axis] + self.size[axis] * (line as f64 / self.divisions[axis] as f64)
        };
        for k in 0..=nz {
            for j in 0..=ny {
                nodes.extend((0..=nx).map(|i| Node {
                    id: format!("{}[{i},{j},{k}]", self.id),
                    position: [place(0, i), place(1, j), place(2, k)],
                }));
            }
        }
        Brick { id: self.id.clone(), elements: 0..0, first, divisions: self.divisions }
    }

    /// Appends its elements.
    pub fn append_elements(&self, brick: &mut Brick, elements: &mut Vec<Element>) {
        let start = elements.len();
        let [nx, ny, nz] = self.divisions;
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    let round = |k: usize| [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| [i, j, k]);
                    let nodes = round(k).into_iter().chain(round(k + 1)).map(|at| brick.at(at));
                    let kind = ElementKind::Solid { incompatible: self.incompatible };
                    elements.push(Element { nodes: nodes.collect(), material: self.material, kind });
                }
            }
        }
        brick.elements = start..elements.len();
    }
}

impl Brick {
    /// The node `id[i,j,k]`; `None` beyond its ends.
    pub fn node(&self, at: [usize; 3]) -> Option<usize> {
        std::iter::zip(at, self.divisions).all(|(at, count)| at <= count).then(|| self.at(at))
    }

    fn at(&self, [i, j, k]: [usize; 3]) -> usize {
        let [nx, ny, _] = self.divisions;
        self.first + i + (nx + 1) * (j + (ny + 1) * k)
    }

    /// The element `id{i,j,k}`; `None` beyond its ends.
    pub fn element(&self, [i, j, k]: [usize; 3]) -> Option<usize> {
        let [nx, ny, nz] = self.divisions;
        (i < nx && j < ny && k < nz).then(|| self.elements.start + i + nx * (j + ny * k))
    }

    /// (i, j, k) of one of its elements.
    pub fn indices(&self, element: usize) -> [usize; 3] {
        let [nx, ny, _] = self.divisions;
        let at = element - self.elements.start;
        [at % nx, at / nx % ny, at / nx / ny]
    }
}

/// One of the six faces of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BrickSide {
    /// Least z.
    Bottom,
    /// Largest z.
    Top,
    /// Least x.
    Left,
    /// Largest x.
    Right,
    /// Least y.
    Front,
    /// Largest y.
    Back,
}

impl BrickSide {
    /// The words in files.
    pub const WORDS: [(&'static str, BrickSide); 6] = [
        ("bottom", BrickSide::Bottom),
        ("top", BrickSide::Top),
        ("left", BrickSide::Left),
        ("right", BrickSide::Right),
        ("front", BrickSide::Front),
        ("back", BrickSide::Back),
    ];

    /// The axis across it, and whether it is at the far end.
    fn across(self) -> (usize, bool) {
        match self {
            BrickSide::Left => (0, false),
            BrickSide::Right => (0, true),
            BrickSide::Front => (1, false),
            BrickSide::Back => (1, true),
            BrickSide::Bottom => (2, false),
            BrickSide::Top => (2, true),
        }
    }

    /// The face: its nodes along its first axis first.
    pub fn face(self, brick: &Brick) -> Face {
        let (axis, far) = self.across();
        let [u, v] = [[1, 2], [0, 2], [0, 1]][axis];
        let at = |along: usize, up: usize, across: usize| {
            let mut at = [0; 3];
            (at[u], at[v], at[axis]) = (along, up, across);
            at
        };
        let counts = brick.divisions;
        let level = if far { counts[axis] } else { 0 };
        let nodes = (0..=counts[v]).flat_map(|up| (0..=counts[u]).map(move |along| (along, up)));
        let nodes = nodes.map(|(along, up)| brick.at(at(along, up, level))).collect();
        // u × v points along the axis across, but for y: x × z is −y.
        let outward = far != (axis == 1);
        let mut sides = Vec::new();
        for up in 0..counts[v] {
            for along in 0..counts[u] {
                let round = [(0, 0), (1, 0), (1, 1), (0, 1)];
                let mut corners = round.map(|(a, b)| brick.at(at(along + a, up + b, level)));
                if !outward {
                    corners.reverse();
                }
                let inside = at(along, up, if far { level - 1 } else { 0 });
                let element = brick.element(inside).unwrap_or(brick.elements.start);
                sides.push(FaceSide { element, nodes: corners.to_vec() });
            }
        }
        Face { nodes, sides }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::vector::dot;

    fn brick() -> (Vec<Node>, Vec<Element>, Brick) {
        let grid = BrickGrid {
            id: "b".into(),
            origin: [1.0, 2.0, 3.0],
            size: [4.0, 3.0, 2.0],
            divisions: [4, 3, 2],
            material: 0,
            incompatible: false,
        };
        let (mut nodes, mut elements) = (Vec::new(), Vec::new());
        let mut brick = grid.append_nodes(&mut nodes);
        grid.append_elements(&mut brick, &mut elements);
        assert_eq!(nodes.len() as f64, grid.node_count());
        (nodes, elements, brick)
    }

    #[test]
    fn nodes_and_elements_are_where_their_names_say() {
        let (nodes, elements, brick) = brick();
        let at = brick.node([3, 2, 1]).unwrap();
        assert_eq!((nodes[at].id.as_str(), nodes[at].position), ("b[3,2,1]", [4.0, 4.0, 4.0]));
        assert_eq!((brick.node([5, 0, 0]), brick.element([0, 3, 0])), (None, None));
        let element = brick.element([3, 2, 1]).unwrap();
        assert_eq!(brick.indices(element), [3, 2, 1]);
        assert_eq!(elements[element].nodes[0], at);
        assert_eq!(nodes[elements[element].nodes[6]].position, [5.0, 5.0, 5.0]);
    }

    /// Each face has its area, its outward normal and its nodes in order.
    #[test]
    fn faces_look_out() {
        let (nodes, elements, brick) = brick();
        let normals = [
            (BrickSide::Bottom, [0.0, 0.0, -1.0], 12.0, [5, 4]),
            (BrickSide::Top, [0.0, 0.0, 1.0], 12.0, [5, 4]),
            (BrickSide::Left, [-1.0, 0.0, 0.0], 6.0, [4, 3]),
            (BrickSide::Right, [1.0, 0.0, 0.0], 6.0, [4, 3]),
            (BrickSide::Front, [0.0, -1.0, 0.0], 8.0, [5, 3]),
            (BrickSide::Back, [0.0, 1.0, 0.0], 8.0, [5, 3]),
        ];
        for (side, normal, area, [first, second]) in normals {
            let face = side.face(&brick);
            assert_eq!(face.nodes.len(), first * second);
            assert!((face.area(&nodes) - area).abs() < 1e-13);
            for found in face.outward_normals(&nodes) {
                let found = found.unwrap();
                assert!((dot(found, normal) - 1.0).abs() < 1e-14, "{side:?}: {found:?}");
            }
            for part in &face.sides {
                assert!(part.nodes.iter().all(|corner| elements[part.element].nodes.contains(corner)));
            }
        }
    }
}
