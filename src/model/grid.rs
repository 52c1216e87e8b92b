//! Rectangular plates as grids of quads: grid lines, rotation, numbering.

use std::ops::Range;

use super::structure::{Element, ElementKind, Node, Plane};
use super::vector::flat;

/// Grid lines of a plate along one of its sides, as distances from the origin.
#[derive(Clone, Debug, PartialEq)]
pub enum GridLines {
    /// `divisions` equal parts of `size`.
    Uniform {
        /// Length of the side.
        size: f64,
        /// Number of parts.
        divisions: usize,
    },
    /// Increasing distances, at least two.
    Graded(Vec<f64>),
}

/// Share of its distance from the origin of the coordinates below which a side has no place left in their digits.
pub const HIDDEN_SIDE: f64 = 1e-12;

impl GridLines {
    /// Number of lines.
    pub fn count(&self) -> usize {
        match self {
            GridLines::Uniform { divisions, .. } => divisions + 1,
            GridLines::Graded(lines) => lines.len(),
        }
    }

    /// Least distance between two of them.
    pub fn least_part(&self) -> f64 {
        match self {
            GridLines::Uniform { size, divisions } => size / *divisions as f64,
            GridLines::Graded(lines) => lines.windows(2).map(|two| two[1] - two[0]).fold(f64::INFINITY, f64::min),
        }
    }

    fn distances(&self) -> Vec<f64> {
        match self {
            GridLines::Uniform { size, divisions } => {
                (0..=*divisions).map(|line| size * (line as f64 / *divisions as f64)).collect()
            }
            GridLines::Graded(lines) => lines.clone(),
        }
    }
}

/// A plate as the file describes it, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct PlateGrid {
    /// Name in the file.
    pub id: String,
    /// The corner from which the grid lines count.
    pub origin: [f64; 2],
    /// Degrees, counter-clockwise, about `origin`.
    pub rotation: f64,
    /// Lines along the length, index i.
    pub x: GridLines,
    /// Lines along the height, index j.
    pub y: GridLines,
    /// Thickness.
    pub thickness: f64,
    /// Stress state.
    pub plane: Plane,
    /// Whether its elements have incompatible modes.
    pub incompatible: bool,
    /// Index of the material.
    pub material: usize,
}

impl PlateGrid {
    /// Number of nodes, without making them.
    pub fn node_count(&self) -> f64 {
        self.x.count() as f64 * self.y.count() as f64
    }

    /// Appends the nodes `id[i,j]`, row by row from the bottom, and returns their grid `[j][i]`.
    pub fn append_nodes(&self, nodes: &mut Vec<Node>) -> Vec<Vec<usize>> {
        let (cosine, sine) = cosine_and_sine(self.rotation);
        let (xs, ys) = (self.x.distances(), self.y.distances());
        let mut grid = Vec::with_capacity(ys.len());
        for (j, y) in ys.iter().enumerate() {
            let first = nodes.len();
            nodes.extend(xs.iter().enumerate().map(|(i, x)| Node {
                id: format!("{}[{i},{j}]", self.id),
                position: flat([self.origin[0] + cosine * x - sine * y, self.origin[1] + sine * x + cosine * y]),
            }));
            grid.push((first..nodes.len()).collect());
        }
        grid
    }

    /// Appends the elements, row by row from the bottom, and returns their range.
    pub fn append_elements(&self, grid: &[Vec<usize>], elements: &mut Vec<Element>) -> Range<usize> {
        let first = elements.len();
        for rows in grid.windows(2) {
            for (lower, upper) in rows[0].windows(2).zip(rows[1].windows(2)) {
                elements.push(Element {
                    nodes: vec![lower[0], lower[1], upper[1], upper[0]],
                    material: self.material,
                    kind: ElementKind::Membrane {
                        thickness: self.thickness,
                        plane: self.plane,
                        incompatible: self.incompatible,
                    },
                });
            }
        }
        first..elements.len()
    }
}

/// Cosine and sine of an angle in degrees, exact at multiples of 90°.
fn cosine_and_sine(degrees: f64) -> (f64, f64) {
    let turned = degrees.rem_euclid(360.0);
    if turned == 0.0 {
        (1.0, 0.0)
    } else if turned == 90.0 {
        (0.0, 1.0)
    } else if turned == 180.0 {
        (-1.0, 0.0)
    } else if turned == 270.0 {
        (0.0, -1.0)
    } else {
        let radians = turned.to_radians();
        (radians.cos(), radians.sin())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::structure::Plate;

    fn grid(rotation: f64, x: GridLines, y: GridLines) -> (Vec<Node>, Plate, Vec<Element>) {
        let plate = PlateGrid {
            id: "p".into(),
            origin: [1.0, 2.0],
            rotation,
            x,
            y,
            thickness: 0.1,
            plane: Plane::Strain,
            incompatible: false,
            material: 0,
        };
        let (mut nodes, mut elements) = (Vec::new(), Vec::new());
        let grid = plate.append_nodes(&mut nodes);
        assert_eq!(nodes.len() as f64, plate.node_count());
        let plate = Plate { id: plate.id.clone(), elements: plate.append_elements(&grid, &mut elements), nodes: grid };
        (nodes, plate, elements)
    }

    fn uniform(size: f64, divisions: usize) -> GridLines {
        GridLines::Uniform { size, divisions }
    }

    #[test]
    fn nodes_run_along_the_length_then_up() {
        let (nodes, plate, elements) = grid(0.0, uniform(8.0, 16), uniform(4.0, 8));
        assert_eq!(nodes.len(), 17 * 9);
        assert_eq!(elements.len(), 128);
        assert_eq!(plate.elements, 0..128);
        let corner = &nodes[plate.nodes[8][16]];
        assert_eq!(corner.id, "p[16,8]");
        assert_eq!(corner.position, [9.0, 6.0, 0.0]);
        assert_eq!(nodes[plate.nodes[0][1]].position, [1.5, 2.0, 0.0]);
        assert_eq!(elements[0].nodes, [0, 1, 18, 17]);
    }

    #[test]
    fn elements_are_counter_clockwise_under_every_rotation() {
        for rotation in [0.0, 30.0, 90.0, 180.0, 270.0, -45.0, 750.0] {
            let (nodes, _, elements) = grid(rotation, uniform(3.0, 2), uniform(2.0, 2));
            for element in &elements {
                let at = |k: usize| nodes[element.nodes[k]].position;
                let (a, b, d) = (at(0), at(1), at(3));
                let cross = (b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0]);
                assert!((cross - 1.5).abs() < 1e-12, "{rotation}: {cross}");
            }
        }
    }

    #[test]
    fn rotation_turns_about_the_origin() {
        let (nodes, plate, _) = grid(90.0, uniform(3.0, 3), uniform(2.0, 1));
        // The length now points up, the height to the left; exact.
        assert_eq!(nodes[plate.nodes[0][3]].position, [1.0, 5.0, 0.0]);
        assert_eq!(nodes[plate.nodes[1][0]].position, [-1.0, 2.0, 0.0]);
        let (nodes, plate, _) = grid(30.0, uniform(2.0, 1), uniform(1.0, 1));
        let far = nodes[plate.nodes[0][1]].position;
        assert!((far[0] - (1.0 + 3f64.sqrt())).abs() < 1e-14);
        assert!((far[1] - 3.0).abs() < 1e-14);
    }

    #[test]
    fn graded_lines_are_taken_as_given() {
        let (nodes, plate, elements) =
            grid(0.0, GridLines::Graded(vec![0.0, 0.1, 0.3, 1.0]), GridLines::Graded(vec![0.0, 2.0]));
        assert_eq!(nodes[plate.nodes[1][2]].position, [1.3, 4.0, 0.0]);
        assert_eq!(elements.len(), 3);
    }
}
