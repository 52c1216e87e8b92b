//! Shape functions and integration points of the plane elements, and of the sides of solids.
//!
//! ```text
//!     3 nodes  L1 = 1 − ξ − η, L2 = ξ, L3 = η                      one point
//!     6 nodes  L(2L − 1) at the corners, 4 L L at the middles of 1-2, 2-3, 3-1; three points
//!     4 nodes  (1 + ξ_i ξ)(1 + η_i η)/4                            2 × 2 Gauss points
//!     8 nodes  serendipity: corners, then the middles of 1-2, 2-3, 3-4, 4-1; 3 × 3 Gauss points
//! ```
//! Hughes, *The Finite Element Method*, 1987, §3.2, §3.7, §3.8 and appendix 3.I.

use crate::doubled::Real;

/// Most nodes of a plane element.
pub const MOST: usize = 8;

/// Shape of a plane element; its nodes go round counter-clockwise, corners first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AreaShape {
    /// Linear triangle.
    Triangle3,
    /// Quadratic triangle.
    Triangle6,
    /// Bilinear quadrilateral.
    Quad4,
    /// Serendipity quadrilateral.
    Quad8,
}

const QUAD_CORNERS: [[f64; 2]; 8] = [
    [-1.0, -1.0],
    [1.0, -1.0],
    [1.0, 1.0],
    [-1.0, 1.0],
    // Middles of the sides, for eight nodes.
    [0.0, -1.0],
    [1.0, 0.0],
    [0.0, 1.0],
    [-1.0, 0.0],
];

const TRIANGLE_NODES: [[f64; 2]; 6] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];

/// An integration point: (ξ, η) and weight.
pub type Point = ([f64; 2], f64);

impl AreaShape {
    /// The shape with this number of nodes: 3, 4, 6 or 8.
    pub fn of(nodes: usize) -> AreaShape {
        match nodes {
            3 => AreaShape::Triangle3,
            6 => AreaShape::Triangle6,
            8 => AreaShape::Quad8,
            _ => AreaShape::Quad4,
        }
    }

    /// Whether it is a triangle: 0 ≤ ξ, 0 ≤ η, ξ + η ≤ 1; else −1 ≤ ξ, η ≤ 1.
    pub fn is_triangle(self) -> bool {
        matches!(self, AreaShape::Triangle3 | AreaShape::Triangle6)
    }

    /// (ξ, η) of the nodes.
    pub fn nodes(self) -> &'static [[f64; 2]] {
        match self {
            AreaShape::Triangle3 => &TRIANGLE_NODES[..3],
            AreaShape::Triangle6 => &TRIANGLE_NODES,
            AreaShape::Quad4 => &QUAD_CORNERS[..4],
            AreaShape::Quad8 => &QUAD_CORNERS,
        }
    }

    /// (ξ, η) of the centroid of the parent element.
    pub fn centre(self) -> [f64; 2] {
        match self {
            AreaShape::Triangle3 | AreaShape::Triangle6 => [1.0 / 3.0; 2],
            AreaShape::Quad4 | AreaShape::Quad8 => [0.0; 2],
        }
    }

    /// Points of the stiffness and of the loads on the area.
    pub fn points(self) -> Vec<Point> {
        let product = |line: &[(f64, f64)]| {
            line.iter().flat_map(|&(eta, b)| line.iter().map(move |&(xi, a)| ([xi, eta], a * b))).collect()
        };
        match self {
            AreaShape::Triangle3 => vec![([1.0 / 3.0; 2], 0.5)],
            AreaShape::Triangle6 => {
                [[1.0 / 6.0; 2], [2.0 / 3.0, 1.0 / 6.0], [1.0 / 6.0, 2.0 / 3.0]].map(|at| (at, 1.0 / 6.0)).to_vec()
            }
            AreaShape::Quad4 => {
                let g = 1.0 / 3.0_f64.sqrt();
                QUAD_CORNERS[..4].iter().map(|corner| ([corner[0] * g, corner[1] * g], 1.0)).collect()
            }
            AreaShape::Quad8 => {
                let g = 0.6_f64.sqrt();
                product(&[(-g, 5.0 / 9.0), (0.0, 8.0 / 9.0), (g, 5.0 / 9.0)])
            }
        }
    }

    /// N_i at (ξ, η); entries beyond the number of nodes are zero.
    pub fn values(self, [x, y]: [f64; 2]) -> [f64; MOST] {
        let mut n = [0.0; MOST];
        match self {
            AreaShape::Triangle3 => n[..3].copy_from_slice(&[1.0 - x - y, x, y]),
            AreaShape::Triangle6 => {
                let l = [1.0 - x - y, x, y];
                for i in 0..3 {
                    n[i] = l[i] * (2.0 * l[i] - 1.0);
                    n[3 + i] = 4.0 * l[i] * l[(i + 1) % 3];
                }
            }
            AreaShape::Quad4 => {
                for (n, c) in n.iter_mut().zip(&QUAD_CORNERS[..4]) {
                    *n = 0.25 * (1.0 + c[0] * x) * (1.0 + c[1] * y);
                }
            }
            AreaShape::Quad8 => {
                for (i, c) in QUAD_CORNERS.iter().enumerate() {
                    let (a, b) = (c[0] * x, c[1] * y);
                    n[i] = match i {
                        0..4 => 0.25 * (1.0 + a) * (1.0 + b) * (a + b - 1.0),
                        4 | 6 => 0.5 * (1.0 - x * x) * (1.0 + b),
                        _ => 0.5 * (1.0 + a) * (1.0 - y * y),
                    };
                }
            }
        }
        n
    }

    /// (∂N_i/∂ξ, ∂N_i/∂η) at (ξ, η); entries beyond the number of nodes are zero.
    pub fn gradients<T: Real>(self, [x, y]: [f64; 2]) -> [[T; 2]; MOST] {
        let number = T::from;
        let (x, y, one, half, quarter) = (number(x), number(y), T::one(), number(0.5), number(0.25));
        let mut n = [[T::zero(); 2]; MOST];
        match self {
            AreaShape::Triangle3 => n[..3].copy_from_slice(&[[-one, -one], [one, T::zero()], [T::zero(), one]]),
            AreaShape::Triangle6 => {
                let l = [one - x - y, x, y];
                let dl = [[-one, -one], [one, T::zero()], [T::zero(), one]];
                let four = number(4.0);
                for i in 0..3 {
                    let j = (i + 1) % 3;
                    for a in 0..2 {
                        n[i][a] = (four * l[i] - one) * dl[i][a];
                        n[3 + i][a] = four * (dl[i][a] * l[j] + l[i] * dl[j][a]);
                    }
                }
            }
            AreaShape::Quad4 => {
                for (n, c) in n.iter_mut().zip(&QUAD_CORNERS[..4]) {
                    let [cx, cy] = c.map(number);
                    *n = [quarter * cx * (one + cy * y), quarter * cy * (one + cx * x)];
                }
            }
            AreaShape::Quad8 => {
                for (i, c) in QUAD_CORNERS.iter().enumerate() {
                    let [cx, cy] = c.map(number);
                    let (a, b, two) = (cx * x, cy * y, number(2.0));
                    n[i] = match i {
                        0..4 => [quarter * cx * (one + b) * (two * a + b), quarter * cy * (one + a) * (a + two * b)],
                        4 | 6 => [-x * (one + b), half * (one - x * x) * cy],
                        _ => [half * cx * (one - y * y), -y * (one + a)],
                    };
                }
            }
        }
        n
    }

    /// Points (ξ, η) at which the stresses of the element are best: those of the stiffness, 2 × 2 of them for 8 nodes.
    pub fn stress_points(self) -> Vec<[f64; 2]> {
        match self {
            AreaShape::Quad8 => AreaShape::Quad4.stress_points(),
            _ => self.points().into_iter().map(|(at, _)| at).collect(),
        }
    }

    /// Weights of the values at the [`stress_points`](Self::stress_points) that give the value at (ξ, η): constant (3
    /// nodes), linear (6), bilinear (4 and 8).
    pub fn extrapolation(self, [x, y]: [f64; 2]) -> Vec<f64> {
        match self {
            AreaShape::Triangle3 => vec![1.0],
            AreaShape::Triangle6 => {
                // The points are the corners of a triangle of half the size about the same centroid.
                let (a, b) = (2.0 * x - 1.0 / 3.0, 2.0 * y - 1.0 / 3.0);
                vec![1.0 - a - b, a, b]
            }
            AreaShape::Quad4 | AreaShape::Quad8 => {
                let g = 3.0_f64.sqrt();
                AreaShape::Quad4.values([g * x, g * y])[..4].to_vec()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::assert_derivatives;
    use super::*;

    const ALL: [AreaShape; 4] = [AreaShape::Triangle3, AreaShape::Triangle6, AreaShape::Quad4, AreaShape::Quad8];

    #[test]
    fn one_at_its_own_node_and_zero_at_the_others() {
        for shape in ALL {
            for (i, &at) in shape.nodes().iter().enumerate() {
                for (j, n) in shape.values(at)[..shape.nodes().len()].iter().enumerate() {
                    assert!((n - f64::from(i == j)).abs() < 1e-15, "{shape:?} {i} {j}");
                }
            }
        }
    }

    #[test]
    fn gradients_are_derivatives_and_sum_to_zero() {
        let at = [0.23, 0.31];
        for shape in ALL {
            let gradients = &shape.gradients::<f64>(at)[..shape.nodes().len()];
            assert!(assert_derivatives(at, gradients, |at| shape.values(at)) < 1e-15, "{shape:?}");
        }
    }

    #[test]
    fn weights_sum_to_the_area_and_extrapolation_reproduces_linear_functions() {
        for shape in ALL {
            let area: f64 = shape.points().iter().map(|(_, w)| w).sum();
            let parent = if shape.nodes().len() % 3 == 0 && shape.nodes().len() < 8 { 0.5 } else { 4.0 };
            assert!((area - parent).abs() < 1e-14, "{shape:?}");
            let linear = |[x, y]: [f64; 2]| if shape == AreaShape::Triangle3 { 2.0 } else { 2.0 + 3.0 * x - 5.0 * y };
            for &at in shape.nodes() {
                let weights = shape.extrapolation(at);
                let value: f64 = shape.stress_points().iter().zip(&weights).map(|(p, w)| w * linear(*p)).sum();
                assert!((value - linear(at)).abs() < 1e-13, "{shape:?}");
            }
        }
    }
}
