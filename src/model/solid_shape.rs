//! Shapes of solids: their faces and sides, whether their nodes are in order, how good they are.

use super::shape::{Shape, ShapeFault, coincident, is_negative, sign};
use super::shape_functions::SolidShape;
use super::vector::{cross, dot, length, way};

/// Faces of hexahedra, S1 to S6 as mesh files count them: corners counter-clockwise as seen from outside, then the
/// middles between them.
const HEXAHEDRON_FACES: [[usize; 8]; 6] = [
    [0, 3, 2, 1, 11, 10, 9, 8],
    [4, 5, 6, 7, 12, 13, 14, 15],
    [0, 1, 5, 4, 8, 17, 12, 16],
    [1, 2, 6, 5, 9, 18, 13, 17],
    [2, 3, 7, 6, 10, 19, 14, 18],
    [3, 0, 4, 7, 11, 16, 15, 19],
];

/// Those of tetrahedra, S1 to S4.
const TETRAHEDRON_FACES: [[usize; 6]; 4] =
    [[0, 2, 1, 6, 5, 4], [0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [2, 0, 3, 6, 7, 9]];

/// Sides of hexahedra in the order of their middle nodes.
const HEXAHEDRON_SIDES: [[usize; 2]; 12] =
    [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];

impl Shape {
    /// Faces of a solid, by the places of their nodes in the element: corners counter-clockwise as seen from outside,
    /// then the middles between them. None of anything else.
    pub fn faces(self) -> Vec<&'static [usize]> {
        match self {
            Shape::Tetrahedron4 => TETRAHEDRON_FACES.iter().map(|face| &face[..3]).collect(),
            Shape::Tetrahedron10 => TETRAHEDRON_FACES.iter().map(|face| &face[..]).collect(),
            Shape::Hexahedron8 => HEXAHEDRON_FACES.iter().map(|face| &face[..4]).collect(),
            Shape::Hexahedron20 => HEXAHEDRON_FACES.iter().map(|face| &face[..]).collect(),
            _ => Vec::new(),
        }
    }

    /// Ends of the sides of a solid, in the order of their middle nodes. None of anything else.
    pub fn sides_of_solid(self) -> &'static [[usize; 2]] {
        match self {
            Shape::Tetrahedron4 | Shape::Tetrahedron10 => &super::shape_functions::TETRAHEDRON_SIDES,
            Shape::Hexahedron8 | Shape::Hexahedron20 => &HEXAHEDRON_SIDES,
            _ => &[],
        }
    }

    /// Whether a solid is turned inside out: det J < 0 everywhere.
    ///
    /// # Errors
    /// Nodes that enclose no volume, or one with folds.
    pub fn is_inside_out(self, nodes: &[[f64; 3]]) -> Result<bool, ShapeFault> {
        coincident(nodes)?;
        let functions = SolidShape::of(self.nodes());
        is_negative(places(functions).into_iter().map(|at| sign_of_jacobian(functions, nodes, at)))
    }

    /// The nodes of a solid turned right side out, from the same first corner: mirrored.
    pub fn mirrored<T: Copy>(self, nodes: &[T]) -> Vec<T> {
        // Corners 2 and 3 of a tetrahedron, 2 and 4 with those above them of a hexahedron change places, and with them
        // the middles of their sides.
        const TETRAHEDRON: [usize; 10] = [0, 2, 1, 3, 6, 5, 4, 7, 9, 8];
        const HEXAHEDRON: [usize; 20] = [0, 3, 2, 1, 4, 7, 6, 5, 11, 10, 9, 8, 15, 14, 13, 12, 16, 19, 18, 17];
        let order: &[usize] = if self.corners() == 4 { &TETRAHEDRON } else { &HEXAHEDRON };
        order[..nodes.len()].iter().map(|&place| nodes[place]).collect()
    }

    /// The number that a face of a solid has once its nodes are [mirrored](Self::mirrored).
    pub fn mirrored_face(self, face: usize) -> usize {
        // Faces that hold the corners which change places, or neither, keep their number.
        const TETRAHEDRON: [usize; 4] = [0, 3, 2, 1];
        const HEXAHEDRON: [usize; 6] = [0, 1, 5, 4, 3, 2];
        if self.corners() == 4 { TETRAHEDRON[face] } else { HEXAHEDRON[face] }
    }

    /// Volume of a solid that is not turned inside out.
    pub fn volume(self, nodes: &[[f64; 3]]) -> f64 {
        let functions = SolidShape::of(self.nodes());
        let points = functions.points(self == Shape::Tetrahedron10);
        points.into_iter().map(|(at, weight)| weight * determinant(jacobian(functions, nodes, at))).sum()
    }

    /// Quality of a solid from 0 to 1: the least volume of the unit vectors along the sides at a corner, for tetrahedra
    /// divided by that of the regular one (the scaled Jacobian); for quadratic elements along the tangents.
    pub fn quality_of_solid(self, nodes: &[[f64; 3]]) -> f64 {
        let functions = SolidShape::of(self.nodes());
        let corners = &functions.nodes()[..self.corners()];
        let is_tetrahedron = self.corners() == 4;
        let scaled = |corner: usize| {
            let rows = jacobian(functions, nodes, corners[corner]);
            let rows = if is_tetrahedron { sides_at(rows, corner) } else { rows };
            determinant(rows) / rows.iter().map(|row| length(*row)).product::<f64>()
        };
        let least = (0..corners.len()).map(scaled).fold(f64::INFINITY, f64::min);
        if is_tetrahedron { least * 2.0_f64.sqrt() } else { least }
    }
}

/// The tangents of the three sides at a corner of a tetrahedron, from ∂x/∂ξ, ∂x/∂η, ∂x/∂ζ there, in a right-handed
/// order.
fn sides_at([a, b, c]: [[f64; 3]; 3], corner: usize) -> [[f64; 3]; 3] {
    let minus = |a: [f64; 3]| a.map(|a| -a);
    match corner {
        0 => [a, b, c],
        1 => [way(a, b), minus(a), way(a, c)],
        2 => [minus(b), way(b, a), way(b, c)],
        _ => [way(c, b), way(c, a), minus(c)],
    }
}

/// Where the Jacobian is evaluated: a grid that holds the nodes, and the integration points.
fn places(functions: SolidShape) -> Vec<[f64; 3]> {
    const STEPS: i32 = 4;
    if functions == SolidShape::Tetrahedron4 {
        return vec![functions.centre()];
    }
    let is_tetrahedron = functions == SolidShape::Tetrahedron10;
    let step = |i: i32| {
        let t = f64::from(i) / f64::from(STEPS);
        if is_tetrahedron { t } else { 2.0 * t - 1.0 }
    };
    let line = 0..=STEPS;
    let grid = line.clone().flat_map(|i| line.clone().flat_map(move |j| (0..=STEPS).map(move |k| [i, j, k])));
    let grid = grid.filter(|at| !is_tetrahedron || at.iter().sum::<i32>() <= STEPS);
    let mut places: Vec<[f64; 3]> = grid.map(|at| at.map(step)).collect();
    places.extend(functions.points(is_tetrahedron).into_iter().map(|(at, _)| at));
    places
}

/// ∂x/∂ξ, ∂x/∂η, ∂x/∂ζ.
fn jacobian(functions: SolidShape, nodes: &[[f64; 3]], at: [f64; 3]) -> [[f64; 3]; 3] {
    let mut rows = [[0.0; 3]; 3];
    for (n, node) in functions.gradients::<f64>(at).iter().zip(nodes) {
        let x = way(nodes[0], *node);
        for (row, n) in rows.iter_mut().zip(n) {
            row.iter_mut().zip(x).for_each(|(row, x)| *row += n * x);
        }
    }
    rows
}

fn determinant([a, b, c]: [[f64; 3]; 3]) -> f64 {
    dot(a, cross(b, c))
}

/// Sign of the Jacobian; 0 where it is no more than its rounding.
fn sign_of_jacobian(functions: SolidShape, nodes: &[[f64; 3]], at: [f64; 3]) -> i8 {
    let rows = jacobian(functions, nodes, at);
    // Every coordinate is known to half a unit of its last digit; up to twenty nodes with factors up to 4 meet in a
    // tangent.
    let coordinate = nodes.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
    let [a, b, c] = rows.map(length);
    sign(determinant(rows), 40.0 * f64::EPSILON * coordinate * (a * b + b * c + c * a))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Shape; 4] = [Shape::Tetrahedron4, Shape::Tetrahedron10, Shape::Hexahedron8, Shape::Hexahedron20];

    fn parent(shape: Shape) -> Vec<[f64; 3]> {
        SolidShape::of(shape.nodes()).nodes().to_vec()
    }

    /// Middles lie between the corners that tables say, on faces and on sides, and faces look outwards.
    #[test]
    fn tables_agree() {
        for shape in ALL {
            let nodes = parent(shape);
            let centre = SolidShape::of(shape.nodes()).centre();
            let between =
                |a: usize, b: usize| -> [f64; 3] { std::array::from_fn(|c| 0.5 * (nodes[a][c] + nodes[b][c])) };
            for (side, [a, b]) in shape.sides_of_solid().iter().enumerate() {
                if shape.is_quadratic() {
                    assert_eq!(nodes[shape.corners() + side], between(*a, *b), "{shape:?}");
                }
            }
            for face in shape.faces() {
                let corners = if shape.corners() == 4 { 3 } else { 4 };
                let out = cross(way(nodes[face[0]], nodes[face[1]]), way(nodes[face[1]], nodes[face[2]]));
                assert!(dot(out, way(centre, nodes[face[0]])) > 0.0, "{shape:?} {face:?}");
                for (k, &middle) in face[corners..].iter().enumerate() {
                    assert_eq!(nodes[middle], between(face[k], face[(k + 1) % corners]), "{shape:?} {face:?}");
                }
            }
        }
    }

    /// A face keeps its nodes when they are mirrored.
    #[test]
    fn faces_of_mirrored_nodes() {
        for shape in ALL {
            let places: Vec<usize> = (0..shape.nodes()).collect();
            let mirrored = shape.mirrored(&places);
            for (face, nodes) in shape.faces().into_iter().enumerate() {
                let mut before = nodes.to_vec();
                let mut after: Vec<usize> =
                    shape.faces()[shape.mirrored_face(face)].iter().map(|&place| mirrored[place]).collect();
                before.sort_unstable();
                after.sort_unstable();
                assert_eq!(before, after, "{shape:?} {face}");
            }
        }
    }

    /// Turned inside out and mirrored back, far from the origin too; flat, folded and coincident ones are told apart.
    #[test]
    fn faults_of_nodes() {
        for shape in ALL {
            for shift in [0.0, 7.3e3] {
                let nodes: Vec<[f64; 3]> = parent(shape).iter().map(|at| at.map(|x| 0.1 * x + shift)).collect();
                assert_eq!(shape.is_inside_out(&nodes), Ok(false), "{shape:?}");
                let flipped: Vec<[f64; 3]> = nodes.iter().map(|[x, y, z]| [*x, *y, 2.0 * shift - z]).collect();
                assert_eq!(shape.is_inside_out(&flipped), Ok(true), "{shape:?}");
                assert_eq!(shape.is_inside_out(&shape.mirrored(&flipped)), Ok(false), "{shape:?}");
                if shift == 0.0 {
                    let flat: Vec<[f64; 3]> =
                        nodes.iter().map(|[x, y, z]| [*x, *y, 0.3 * x + 0.1 * y + 1e-18 * z]).collect();
                    let flat = shape.is_inside_out(&flat);
                    assert!(matches!(flat, Err(ShapeFault::NoArea | ShapeFault::Coincident(..))), "{shape:?} {flat:?}");
                }
                let mut twice = nodes.clone();
                twice[2] = twice[1];
                assert_eq!(shape.is_inside_out(&twice), Err(ShapeFault::Coincident(1, 2)));
                if shape.is_quadratic() {
                    let mut folded = nodes.clone();
                    folded[shape.corners()][0] = nodes[0][0] + 0.8 * (nodes[1][0] - nodes[0][0]);
                    assert_eq!(shape.is_inside_out(&folded), Err(ShapeFault::Folded), "{shape:?}");
                }
            }
        }
        // A corner pushed through the opposite face.
        let mut nodes = parent(Shape::Hexahedron8);
        nodes[6] = [-2.0, -2.0, -2.0];
        assert_eq!(Shape::Hexahedron8.is_inside_out(&nodes), Err(ShapeFault::Folded));
    }

    /// Of the parent elements and of the regular tetrahedron. A middle node that is pushed out along y adds the
    /// integral of its function over the face it leaves: x and z do not change, and the function is 0 on the others.
    #[test]
    fn volumes_and_qualities() {
        for (shape, volume) in ALL.into_iter().zip([1.0 / 6.0, 1.0 / 6.0, 8.0, 8.0]) {
            let nodes = parent(shape);
            assert!((shape.volume(&nodes) - volume).abs() < 1e-14, "{shape:?}");
            // At the corners 2 to 4 of the tetrahedron the unit vectors span 1/2, a right angle and two of 45°.
            let quality = if shape.corners() == 4 { 0.5_f64.sqrt() } else { 1.0 };
            assert!((shape.quality_of_solid(&nodes) - quality).abs() < 1e-14, "{shape:?}");
            if shape.is_quadratic() {
                let mut bulging = nodes;
                bulging[shape.corners()][1] -= 0.1;
                // ∫ 4 ξ (1 − ξ − ζ) dA = 4/24, ∫ (1 − ξ²)(1 − ζ)/2 dA = 4/3.
                let added = if shape.corners() == 4 { 4.0 / 24.0 } else { 4.0 / 3.0 };
                assert!((shape.volume(&bulging) - volume - 0.1 * added).abs() < 1e-14, "{shape:?}");
            }
        }
        let regular = [[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0]];
        assert!((Shape::Tetrahedron4.quality_of_solid(&regular) - 1.0).abs() < 1e-15);
    }
}
