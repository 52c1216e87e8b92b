//! Edges of plates: their nodes, normals, and the consistent loads on them.

use super::structure::{Node, Plate};

/// One of the four edges of a plate, in the plate's own axes (before its rotation).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// j = 0.
    Bottom,
    /// Largest j.
    Top,
    /// i = 0.
    Left,
    /// Largest i.
    Right,
}

impl Side {
    /// The words in files.
    pub const WORDS: [(&'static str, Side); 4] =
        [("bottom", Side::Bottom), ("top", Side::Top), ("left", Side::Left), ("right", Side::Right)];

    /// Nodes of this edge, by increasing i or j.
    pub fn nodes(self, plate: &Plate) -> Vec<usize> {
        // Every plate has at least two rows of at least two nodes.
        let rows = &plate.nodes;
        match self {
            Side::Bottom => rows[0].clone(),
            Side::Top => rows[rows.len() - 1].clone(),
            Side::Left => rows.iter().map(|row| row[0]).collect(),
            Side::Right => rows.iter().map(|row| row[row.len() - 1]).collect(),
        }
    }

    /// Unit normal of this edge, pointing out of the plate.
    pub fn outward_normal(self, plate: &Plate, nodes: &[Node]) -> [f64; 2] {
        let edge = self.nodes(plate);
        let (from, to) = (nodes[edge[0]].position, nodes[edge[edge.len() - 1]].position);
        let along = [to[0] - from[0], to[1] - from[1]];
        let length = along[0].hypot(along[1]);
        let along = [along[0] / length, along[1] / length];
        match self {
            Side::Bottom | Side::Right => [along[1], -along[0]],
            Side::Top | Side::Left => [-along[1], along[0]],
        }
    }
}

/// Length of edge that belongs to each node: half of each segment it ends. Linear shape functions make this the
/// consistent load of a uniform traction 1.
pub fn tributary_lengths(edge: &[usize], nodes: &[Node]) -> Vec<f64> {
    let mut lengths = vec![0.0; edge.len()];
    for k in 1..edge.len() {
        let (a, b) = (nodes[edge[k - 1]].position, nodes[edge[k]].position);
        let half = 0.5 * (b[0] - a[0]).hypot(b[1] - a[1]);
        lengths[k - 1] += half;
        lengths[k] += half;
    }
    lengths
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::mesh::{GridLines, PlateGrid};
    use crate::model::structure::Plane;

    fn graded(rotation: f64) -> (Vec<Node>, Plate) {
        let plate = PlateGrid {
            id: "p".into(),
            origin: [0.5, -1.0],
            rotation,
            x: GridLines::Graded(vec![0.0, 0.1, 0.4, 1.0, 2.5]),
            y: GridLines::Uniform { size: 2.0, divisions: 3 },
            thickness: 1.0,
            plane: Plane::Stress,
            material: 0,
        };
        let mut nodes = Vec::new();
        let plate = Plate { id: plate.id.clone(), elements: 0..0, nodes: plate.append_nodes(&mut nodes) };
        (nodes, plate)
    }

    #[test]
    fn edges_are_ordered_by_increasing_index() {
        let (nodes, plate) = graded(0.0);
        let ids =
            |side: Side| -> Vec<&str> { side.nodes(&plate).iter().map(|&node| nodes[node].id.as_str()).collect() };
        assert_eq!(ids(Side::Left), ["p[0,0]", "p[0,1]", "p[0,2]", "p[0,3]"]);
        assert_eq!(ids(Side::Top)[0], "p[0,3]");
        assert_eq!(ids(Side::Right)[3], "p[4,3]");
        assert_eq!(ids(Side::Bottom).len(), 5);
    }

    #[test]
    fn normals_point_outwards_and_turn_with_the_plate() {
        let (nodes, plate) = graded(0.0);
        assert_eq!(Side::Bottom.outward_normal(&plate, &nodes), [0.0, -1.0]);
        assert_eq!(Side::Top.outward_normal(&plate, &nodes), [0.0, 1.0]);
        assert_eq!(Side::Left.outward_normal(&plate, &nodes), [-1.0, 0.0]);
        assert_eq!(Side::Right.outward_normal(&plate, &nodes), [1.0, 0.0]);
        let (nodes, plate) = graded(30.0);
        let normal = Side::Top.outward_normal(&plate, &nodes);
        assert!((normal[0] + 0.5).abs() < 1e-14 && (normal[1] - 0.75f64.sqrt()).abs() < 1e-14);
    }

    #[test]
    fn consistent_shares_keep_total_and_moment() {
        let (nodes, plate) = graded(0.0);
        let edge = Side::Bottom.nodes(&plate);
        let lengths = tributary_lengths(&edge, &nodes);
        // Segments 0.1, 0.3, 0.6, 1.5.
        for (found, expected) in lengths.iter().zip([0.05, 0.2, 0.45, 1.05, 0.75]) {
            assert!((found - expected).abs() < 1e-15);
        }
        // Total = length; first moment about the start = L²/2, as of the uniform load itself.
        assert!((lengths.iter().sum::<f64>() - 2.5).abs() < 1e-14);
        let moment: f64 =
            edge.iter().zip(&lengths).map(|(&node, length)| (nodes[node].position[0] - 0.5) * length).sum();
        assert!((moment - 2.5 * 2.5 / 2.0).abs() < 1e-14);
    }
}
