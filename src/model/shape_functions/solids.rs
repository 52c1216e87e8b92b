//! Shape functions and integration points of the elements of a solid.
//!
//! ```text
//!     4 nodes   L1 = 1 − ξ − η − ζ, L2 = ξ, L3 = η, L4 = ζ                  one point
//!     10 nodes  L(2L − 1) at the corners, 4 L L at the middles of 1-2, 2-3, 3-1, 1-4, 2-4, 3-4; four points,
//!               fourteen where its sides bulge
//!     8 nodes   (1 + ξ_i ξ)(1 + η_i η)(1 + ζ_i ζ)/8                        2 × 2 × 2 Gauss points
//!     20 nodes  serendipity: corners, then the middles of 1-2, 2-3, 3-4, 4-1, of 5-6, 6-7, 7-8, 8-5 above them,
//!               and of 1-5, 2-6, 3-7, 4-8; 3 × 3 × 3 Gauss points
//! ```
//! Corners 1-2-3 of a tetrahedron go round counter-clockwise as seen from 4, 1-2-3-4 of a hexahedron as seen from
//! 5-6-7-8, which lie above them. Forces of a constant stress are exact in any shape: adj J ∇N has the degree 5 in each
//! variable of the hexahedron and 3 in all of the tetrahedron with bulging sides. Hughes, *The Finite Element Method*,
//! 1987, §3.2, §3.8 and appendices 3.I, 3.II; fourteen points: Walkington, *Quadrature on simplices of arbitrary
//! dimension*, 2000.

use crate::doubled::Real;

/// Most nodes of a solid element.
pub const MOST: usize = 20;

/// Shape of a solid element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolidShape {
    /// Linear tetrahedron.
    Tetrahedron4,
    /// Quadratic tetrahedron.
    Tetrahedron10,
    /// Trilinear hexahedron.
    Hexahedron8,
    /// Serendipity hexahedron.
    Hexahedron20,
}

const HEXAHEDRON_NODES: [[f64; 3]; 20] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    // Middles: below, above, upright.
    [0.0, -1.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, -1.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [-1.0, 0.0, 1.0],
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
];

const TETRAHEDRON_NODES: [[f64; 3]; 10] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.5, 0.0, 0.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.0],
    [0.0, 0.0, 0.5],
    [0.5, 0.0, 0.5],
    [0.0, 0.5, 0.5],
];

/// Ends of the sides of a tetrahedron, in the order of their middle nodes.
pub const TETRAHEDRON_SIDES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

/// Coordinates of the four points of the tetrahedron of degree 2: b three times and 1 − 3b, b = (5 − √5)/20.
const NEAR: f64 = 0.138_196_601_125_010_5;

/// An integration point: (ξ, η, ζ) and weight.
pub type VolumePoint = ([f64; 3], f64);

impl SolidShape {
    /// The shape with this number of nodes: 4, 8, 10 or 20.
    pub fn of(nodes: usize) -> SolidShape {
        match nodes {
            4 => SolidShape::Tetrahedron4,
            10 => SolidShape::Tetrahedron10,
            20 => SolidShape::Hexahedron20,
            _ => SolidShape::Hexahedron8,
        }
    }

    fn is_tetrahedron(self) -> bool {
        matches!(self, SolidShape::Tetrahedron4 | SolidShape::Tetrahedron10)
    }

    /// (ξ, η, ζ) of the nodes.
    pub fn nodes(self) -> &'static [[f64; 3]] {
        match self {
            SolidShape::Tetrahedron4 => &TETRAHEDRON_NODES[..4],
            SolidShape::Tetrahedron10 => &TETRAHEDRON_NODES,
            SolidShape::Hexahedron8 => &HEXAHEDRON_NODES[..8],
            SolidShape::Hexahedron20 => &HEXAHEDRON_NODES,
        }
    }

    /// (ξ, η, ζ) of the centroid of the parent element.
    pub fn centre(self) -> [f64; 3] {
        if self.is_tetrahedron() { [0.25; 3] } else { [0.0; 3] }
    }

    /// Points of the stiffness and of the loads on the volume; `bulges` tells whether sides are not straight.
    pub fn points(self, bulges: bool) -> Vec<VolumePoint> {
        match self {
            SolidShape::Tetrahedron10 if bulges => fourteen(),
            SolidShape::Tetrahedron4 => vec![([0.25; 3], 1.0 / 6.0)],
            SolidShape::Tetrahedron10 => {
                let far = 1.0 - 3.0 * NEAR;
                let at = [[NEAR; 3], [far, NEAR, NEAR], [NEAR, far, NEAR], [NEAR, NEAR, far]];
                at.map(|at| (at, 1.0 / 24.0)).to_vec()
            }
            SolidShape::Hexahedron8 => {
                let g = 1.0 / 3.0_f64.sqrt();
                HEXAHEDRON_NODES[..8].iter().map(|corner| (corner.map(|c| c * g), 1.0)).collect()
            }
            SolidShape::Hexahedron20 => {
                let g = 0.6_f64.sqrt();
                let line = [(-g, 5.0 / 9.0), (0.0, 8.0 / 9.0), (g, 5.0 / 9.0)];
                let mut points = Vec::with_capacity(27);
                for (z, c) in line {
                    for (y, b) in line {
                        points.extend(line.map(|(x, a)| ([x, y, z], a * b * c)));
                    }
                }
                points
            }
        }
    }

    /// N_i at (ξ, η, ζ); entries beyond the number of nodes are zero.
    pub fn values(self, [x, y, z]: [f64; 3]) -> [f64; MOST] {
        let mut n = [0.0; MOST];
        let l = [1.0 - x - y - z, x, y, z];
        match self {
            SolidShape::Tetrahedron4 => n[..4].copy_from_slice(&l),
            SolidShape::Tetrahedron10 => {
                for (n, l) in n.iter_mut().zip(l) {
                    *n = l * (2.0 * l - 1.0);
                }
                for (n, [i, j]) in n[4..].iter_mut().zip(TETRAHEDRON_SIDES) {
                    *n = 4.0 * l[i] * l[j];
                }
            }
            SolidShape::Hexahedron8 => {
                for (n, c) in n.iter_mut().zip(&HEXAHEDRON_NODES[..8]) {
                    *n = 0.125 * (1.0 + c[0] * x) * (1.0 + c[1] * y) * (1.0 + c[2] * z);
                }
            }
            SolidShape::Hexahedron20 => {
                for (i, c) in HEXAHEDRON_NODES.iter().enumerate() {
                    let (a, b, c) = (c[0] * x, c[1] * y, c[2] * z);
                    n[i] = match i {
                        0..8 => 0.125 * (1.0 + a) * (1.0 + b) * (1.0 + c) * (a + b + c - 2.0),
                        8 | 10 | 12 | 14 => 0.25 * (1.0 - x * x) * (1.0 + b) * (1.0 + c),
                        9 | 11 | 13 | 15 => 0.25 * (1.0 + a) * (1.0 - y * y) * (1.0 + c),
                        _ => 0.25 * (1.0 + a) * (1.0 + b) * (1.0 - z * z),
                    };
                }
            }
        }
        n
    }

    /// (∂N_i/∂ξ, ∂N_i/∂η, ∂N_i/∂ζ) at (ξ, η, ζ); entries beyond the number of nodes are zero.
    pub fn gradients<T: Real>(self, at: [f64; 3]) -> [[T; 3]; MOST] {
        let number = T::from;
        let [x, y, z] = at.map(number);
        let (o, one) = (T::zero(), T::one());
        let mut n = [[o; 3]; MOST];
        let l = [one - x - y - z, x, y, z];
        let dl = [[-one; 3], [one, o, o], [o, one, o], [o, o, one]];
        match self {
            SolidShape::Tetrahedron4 => n[..4].copy_from_slice(&dl),
            SolidShape::Tetrahedron10 => {
                let four = number(4.0);
                for i in 0..4 {
                    n[i] = dl[i].map(|d| (four * l[i] - one) * d);
                }
                for (n, [i, j]) in n[4..].iter_mut().zip(TETRAHEDRON_SIDES) {
                    *n = [0, 1, 2].map(|a| four * (dl[i][a] * l[j] + l[i] * dl[j][a]));
                }
            }
            SolidShape::Hexahedron8 => {
                for (n, c) in n.iter_mut().zip(&HEXAHEDRON_NODES[..8]) {
                    let c = c.map(number);
                    let [a, b, g] = [one + c[0] * x, one + c[1] * y, one + c[2] * z];
                    *n = [c[0] * b * g, c[1] * a * g, c[2] * a * b].map(|d| d * number(0.125));
                }
            }
            SolidShape::Hexahedron20 => {
                for (n, c) in n.iter_mut().zip(&HEXAHEDRON_NODES) {
                    *n = serendipity([x, y, z], c.map(number));
                }
            }
        }
        n
    }

    /// Points at which the stresses of the element are best: those of the stiffness, 2 × 2 × 2 of them for 20 nodes.
    pub fn stress_points(self) -> Vec<[f64; 3]> {
        match self {
            SolidShape::Hexahedron20 => SolidShape::Hexahedron8.stress_points(),
            _ => self.points(false).into_iter().map(|(at, _)| at).collect(),
        }
    }

    /// Weights of the values at the [`stress_points`](Self::stress_points) that give the value at (ξ, η, ζ): constant
    /// (4 nodes), linear (10), trilinear (8 and 20).
    pub fn extrapolation(self, at: [f64; 3]) -> Vec<f64> {
        match self {
            SolidShape::Tetrahedron4 => vec![1.0],
            SolidShape::Tetrahedron10 => {
                // The points are the corners of a smaller tetrahedron about the same centroid.
                let [x, y, z] = at.map(|c| (c - NEAR) / (1.0 - 4.0 * NEAR));
                vec![1.0 - x - y - z, x, y, z]
            }
            SolidShape::Hexahedron8 | SolidShape::Hexahedron20 => {
                let g = 3.0_f64.sqrt();
                SolidShape::Hexahedron8.values(at.map(|c| g * c))[..8].to_vec()
            }
        }
    }
}

/// Points of the tetrahedron of degree 5.
fn fourteen() -> Vec<VolumePoint> {
    let mut points = Vec::with_capacity(14);
    // Three coordinates equal, the fourth the rest to 1.
    for (a, w) in
        [(0.310_885_919_263_300_6, 0.018_781_320_953_002_64), (0.092_735_250_310_891_22, 0.012_248_840_519_393_658)]
    {
        let far = 1.0 - 3.0 * a;
        points.extend([[a; 3], [far, a, a], [a, far, a], [a, a, far]].map(|at| (at, w)));
    }
    // Two and two.
    let (a, b, w) = (0.045_503_704_125_649_65, 0.454_496_295_874_350_35, 0.007_091_003_462_846_911);
    points.extend([[a, a, b], [a, b, a], [b, a, a], [a, b, b], [b, a, b], [b, b, a]].map(|at| (at, w)));
    points
}

/// Gradient of the function of the serendipity hexahedron's node at `node`.
fn serendipity<T: Real>(at: [T; 3], node: [T; 3]) -> [T; 3] {
    let (one, two) = (T::one(), T::from(2.0));
    // Products with the node's coordinates, and the factors 1 + c x.
    let p = [0, 1, 2].map(|a| node[a] * at[a]);
    let f = p.map(|p| one + p);
    match node.iter().position(|c| c.is_zero()) {
        None => [0, 1, 2].map(|a| {
            let (b, c) = ((a + 1) % 3, (a + 2) % 3);
            T::from(0.125) * node[a] * f[b] * f[c] * (two * p[a] + p[b] + p[c] - one)
        }),
        // In the middle of a side along axis m.
        Some(m) => {
            let (b, c) = ((m + 1) % 3, (m + 2) % 3);
            let bubble = T::from(0.25) * (one - at[m] * at[m]);
            let mut n = [T::zero(); 3];
            n[m] = T::from(-0.5) * at[m] * f[b] * f[c];
            n[b] = bubble * node[b] * f[c];
            n[c] = bubble * node[c] * f[b];
            n
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::assert_derivatives;
    use super::*;

    const ALL: [SolidShape; 4] =
        [SolidShape::Tetrahedron4, SolidShape::Tetrahedron10, SolidShape::Hexahedron8, SolidShape::Hexahedron20];

    fn powers(most: u32) -> impl Iterator<Item = [u32; 3]> {
        (0..=most).flat_map(move |a| (0..=most).flat_map(move |b| (0..=most).map(move |c| [a, b, c])))
    }

    #[test]
    fn one_at_its_own_node_and_zero_at_the_others() {
        for shape in ALL {
            assert_eq!(SolidShape::of(shape.nodes().len()), shape);
            for (i, &at) in shape.nodes().iter().enumerate() {
                for (j, n) in shape.values(at)[..shape.nodes().len()].iter().enumerate() {
                    assert!((n - f64::from(i == j)).abs() < 1e-15, "{shape:?} {i} {j}");
                }
            }
        }
    }

    #[test]
    fn gradients_are_derivatives_and_sum_to_zero() {
        let at = [0.23, 0.31, 0.17];
        for shape in ALL {
            let gradients = &shape.gradients::<f64>(at)[..shape.nodes().len()];
            assert!(assert_derivatives(at, gradients, |at| shape.values(at)) < 1e-14, "{shape:?}");
        }
    }

    /// ∫ of every monomial up to the degree of the points, in each variable over the cube: over the tetrahedron
    /// a! b! c!/(a + b + c + 3)!, over the cube products of 2/(n + 1) for even powers.
    #[test]
    fn points_integrate_polynomials() {
        let factorial = |n: u32| f64::from((1..=n).product::<u32>());
        let all = ALL.map(|shape| (shape, false)).into_iter().chain([(SolidShape::Tetrahedron10, true)]);
        for ((shape, bulges), degree) in all.zip([1, 2, 3, 5, 5]) {
            let tetrahedron = shape.is_tetrahedron();
            for [a, b, c] in powers(degree) {
                if tetrahedron && a + b + c > degree {
                    continue;
                }
                let [p, q, r] = [a, b, c].map(|n| n as i32);
                let found: f64 =
                    shape.points(bulges).iter().map(|([x, y, z], w)| w * x.powi(p) * y.powi(q) * z.powi(r)).sum();
                let line = |n: u32| if n.is_multiple_of(2) { 2.0 / f64::from(n + 1) } else { 0.0 };
                let right = if tetrahedron {
                    factorial(a) * factorial(b) * factorial(c) / factorial(a + b + c + 3)
                } else {
                    line(a) * line(b) * line(c)
                };
                assert!((found - right).abs() < 1e-14, "{shape:?} {bulges} {a} {b} {c}");
            }
        }
    }

    #[test]
    fn extrapolation_reproduces_linear_functions() {
        for shape in ALL {
            let linear = |[x, y, z]: [f64; 3]| {
                if shape == SolidShape::Tetrahedron4 { 2.0 } else { 2.0 + 3.0 * x - 5.0 * y + 4.0 * z }
            };
            for &at in shape.nodes().iter().chain([&shape.centre()]) {
                let weights = shape.extrapolation(at);
                let value: f64 = shape.stress_points().iter().zip(&weights).map(|(p, w)| w * linear(*p)).sum();
                assert!((value - linear(at)).abs() < 1e-13, "{shape:?}");
            }
        }
    }
}
