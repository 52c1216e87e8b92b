//! Shapes of elements: how many nodes, whether they enclose an area, how good they are.
//!
//! A quadratic element is the one with straight sides plus the bulges of its sides: with d_k = m_k − (c_k + c_k+1)/2
//!
//! ```text
//!     x = Σ N_k c_k + Σ 4 L_i L_j d_k                        triangles
//!     x = Σ N_k c_k + 4 s(1 − s)(1 − t) d_1 + …              quadrilaterals (serendipity)
//! ```

/// Shape of an element. The nodes of a line or an area go round, corners first, then the middles of the sides 1-2,
/// 2-3 …; those of a solid are in the order of [`shape_functions`](super::shape_functions).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// Straight line.
    Line2,
    /// Line with a node in its middle: two ends, then the middle.
    Line3,
    /// Linear triangle.
    Triangle3,
    /// Quadratic triangle.
    Triangle6,
    /// Bilinear quadrilateral.
    Quad4,
    /// Quadrilateral with nodes in the middle of its sides.
    Quad8,
    /// Linear tetrahedron.
    Tetrahedron4,
    /// Quadratic tetrahedron.
    Tetrahedron10,
    /// Trilinear hexahedron.
    Hexahedron8,
    /// Hexahedron with nodes in the middle of its sides.
    Hexahedron20,
}

/// Sines of inner angles up to this count as flat.
const FLAT: f64 = 1e-9;

/// Why the nodes of an area or a solid enclose none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShapeFault {
    /// Two of its nodes (by their position in the element) are at one place.
    Coincident(usize, usize),
    /// Two of its sides cross.
    BowTie,
    /// All corners on one line; those of a solid in one plane.
    NoArea,
    /// A corner of 180° or more.
    NotConvex,
    /// A middle node so far from its middle, or corners of a solid so far from their places, that the Jacobian is not
    /// positive everywhere.
    Folded,
}

type Point = [f64; 2];

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn norm(a: Point) -> f64 {
    a[0].hypot(a[1])
}

impl Shape {
    /// Number of nodes.
    pub fn nodes(self) -> usize {
        match self {
            Shape::Line2 => 2,
            Shape::Line3 | Shape::Triangle3 => 3,
            Shape::Quad4 | Shape::Tetrahedron4 => 4,
            Shape::Triangle6 => 6,
            Shape::Quad8 | Shape::Hexahedron8 => 8,
            Shape::Tetrahedron10 => 10,
            Shape::Hexahedron20 => 20,
        }
    }

    /// Number of corners, or ends.
    pub fn corners(self) -> usize {
        match self {
            Shape::Line2 | Shape::Line3 => 2,
            Shape::Triangle3 | Shape::Triangle6 => 3,
            Shape::Quad4 | Shape::Quad8 | Shape::Tetrahedron4 | Shape::Tetrahedron10 => 4,
            Shape::Hexahedron8 | Shape::Hexahedron20 => 8,
        }
    }

    /// 1, 2 or 3.
    pub fn dimension(self) -> u8 {
        match self {
            Shape::Line2 | Shape::Line3 => 1,
            Shape::Triangle3 | Shape::Triangle6 | Shape::Quad4 | Shape::Quad8 => 2,
            Shape::Tetrahedron4 | Shape::Tetrahedron10 | Shape::Hexahedron8 | Shape::Hexahedron20 => 3,
        }
    }

    /// Whether it is a triangle or a quadrilateral.
    pub fn is_area(self) -> bool {
        self.dimension() == 2
    }

    /// Whether it is a tetrahedron or a hexahedron.
    pub fn is_solid(self) -> bool {
        self.dimension() == 3
    }

    /// Whether it has nodes in the middle of its sides.
    pub fn is_quadratic(self) -> bool {
        self.nodes() > self.corners()
    }

    /// Whether it may have incompatible modes.
    pub fn can_be_incompatible(self) -> bool {
        matches!(self, Shape::Quad4 | Shape::Hexahedron8)
    }

    /// `triangle`.
    pub fn word(self) -> &'static str {
        match (self.dimension(), self.corners()) {
            (1, _) => "line",
            (2, 3) => "triangle",
            (2, _) => "quadrilateral",
            (_, 4) => "tetrahedron",
            _ => "hexahedron",
        }
    }

    /// `a triangle of 6 nodes`.
    pub fn words(self) -> String {
        format!("a {} of {} nodes", self.word(), self.nodes())
    }

    /// Whether an area runs clockwise.
    ///
    /// # Errors
    /// Nodes that enclose no area, or one with folds.
    pub fn is_clockwise(self, nodes: &[Point]) -> Result<bool, ShapeFault> {
        let corners = &nodes[..self.corners()];
        let n = corners.len();
        coincident(corners)?;
        let turns = (0..n).map(|k| {
            let (u, v) = (minus(corners[k], corners[(k + n - 1) % n]), minus(corners[(k + 1) % n], corners[k]));
            cross(u, v) / (norm(u) * norm(v))
        });
        let turns: Vec<f64> = turns.collect();
        if n == 4
            && (cuts(corners[0], corners[1], corners[2], corners[3])
                || cuts(corners[1], corners[2], corners[3], corners[0]))
        {
            return Err(ShapeFault::BowTie);
        }
        coincident(nodes)?;
        if self.nodes() > n {
            return self.is_quadratic_clockwise(nodes);
        }
        if turns.iter().all(|turn| *turn > FLAT) {
            Ok(false)
        } else if turns.iter().all(|turn| *turn < -FLAT) {
            Ok(true)
        } else if n == 3 || turns.iter().all(|turn| turn.abs() <= FLAT) {
            Err(ShapeFault::NoArea)
        } else {
            Err(ShapeFault::NotConvex)
        }
    }

    fn is_quadratic_clockwise(self, nodes: &[Point]) -> Result<bool, ShapeFault> {
        is_negative(self.places().map(|[s, t]| self.sign_of_jacobian(nodes, s, t)))
    }

    /// Where the Jacobian is evaluated: a grid that holds the nodes, and the integration points of the quadrilateral
    /// and of the triangle.
    fn places(self) -> impl Iterator<Item = Point> {
        const STEPS: usize = 8;
        let is_triangle = self.corners() == 3;
        let g = 0.5 - 0.5 * 0.6_f64.sqrt();
        let gauss: &[f64] = if is_triangle { &[1.0 / 6.0, 2.0 / 3.0] } else { &[g, 0.5, 1.0 - g] };
        let gauss = gauss.to_vec();
        let more = gauss.clone().into_iter().flat_map(move |s| gauss.clone().into_iter().map(move |t| [s, t]));
        let step = |k: usize| k as f64 / STEPS as f64;
        let grid = (0..=STEPS).flat_map(move |i| (0..=STEPS).map(move |j| [step(i), step(j)]));
        grid.chain(more).filter(move |[s, t]| !is_triangle || s + t <= 1.0)
    }

    /// Sign of the Jacobian of a quadratic area at (s, t); 0 where it is no more than its rounding.
    fn sign_of_jacobian(self, nodes: &[Point], s: f64, t: f64) -> i8 {
        let n = self.corners();
        // Gradients of the straight element and of the bulges, (∂/∂s, ∂/∂t).
        let (corner, bulge): (Vec<Point>, Vec<Point>) = if n == 3 {
            let l = [1.0 - s - t, s, t];
            let dl = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];
            let product = |i: usize, j: usize| [0, 1].map(|a| 4.0 * (dl[i][a] * l[j] + l[i] * dl[j][a]));
            (dl.to_vec(), vec![product(0, 1), product(1, 2), product(2, 0)])
        } else {
            let (u, v) = (1.0 - s, 1.0 - t);
            (
                vec![[-v, -u], [v, -s], [t, s], [-t, u]],
                vec![
                    [4.0 * (u - s) * v, -4.0 * s * u],
                    [4.0 * t * v, 4.0 * (v - t) * s],
                    [4.0 * (u - s) * t, 4.0 * s * u],
                    [-4.0 * t * v, 4.0 * (v - t) * u],
                ],
            )
        };
        let (mut along_s, mut along_t) = ([0.0; 2], [0.0; 2]);
        for k in 0..n {
            let (a, b, m) =
                (minus(nodes[k], nodes[0]), minus(nodes[(k + 1) % n], nodes[0]), minus(nodes[n + k], nodes[0]));
            for axis in 0..2 {
                let d = m[axis] - 0.5 * (a[axis] + b[axis]);
                along_s[axis] += corner[k][0] * a[axis] + bulge[k][0] * d;
                along_t[axis] += corner[k][1] * a[axis] + bulge[k][1] * d;
            }
        }
        let det = cross(along_s, along_t);
        // Every coordinate is known to half a unit of its last digit; eight nodes with factors up to 4 meet in a
        // tangent.
        let coordinate = nodes.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
        sign(det, 16.0 * f64::EPSILON * coordinate * (norm(along_s) + norm(along_t)))
    }

    /// The nodes in the other sense of rotation, from the same first corner.
    pub fn turned<T: Copy>(self, nodes: &[T]) -> Vec<T> {
        let n = self.corners();
        let corners = (0..n).map(|k| nodes[(n - k) % n]);
        corners.chain(nodes[n..].iter().rev().copied()).collect()
    }

    /// Quality from 0 to 1: the least sine of a corner's angle, for triangles divided by that of the equilateral one;
    /// for quadratic elements between the tangents of the sides.
    pub fn quality(self, nodes: &[Point]) -> f64 {
        let n = self.corners();
        // Tangents of side k at its start and at its end.
        let tangents = |k: usize| {
            let (a, b) = (nodes[k], nodes[(k + 1) % n]);
            match nodes.get(n + k) {
                None => [minus(b, a); 2],
                Some(m) => {
                    [[0, 1].map(|i| 4.0 * m[i] - 3.0 * a[i] - b[i]), [0, 1].map(|i| a[i] + 3.0 * b[i] - 4.0 * m[i])]
                }
            }
        };
        let unit = if n == 3 { 0.75_f64.sqrt() } else { 1.0 };
        let sine = |k: usize| {
            let (before, after) = (tangents((k + n - 1) % n)[1], tangents(k)[0]);
            cross(before, after) / (norm(before) * norm(after))
        };
        (0..n).map(sine).fold(f64::INFINITY, f64::min) / unit
    }

    /// Area of a counter-clockwise one; parabolic sides included.
    pub fn area(self, nodes: &[Point]) -> f64 {
        let n = self.corners();
        let of_side = |k: usize| {
            let (a, b) = (minus(nodes[k], nodes[0]), minus(nodes[(k + 1) % n], nodes[0]));
            let bulge = nodes.get(n + k).map_or(0.0, |m| {
                let m = minus(*m, nodes[0]);
                let d = [0, 1].map(|i| m[i] - 0.5 * (a[i] + b[i]));
                2.0 / 3.0 * cross(d, minus(b, a))
            });
            0.5 * cross(a, b) + bulge
        };
        (0..n).map(of_side).sum()
    }
}

/// Sign of a Jacobian; 0 where it is no more than its rounding.
pub(super) fn sign(det: f64, rounding: f64) -> i8 {
    match det {
        det if det > rounding => 1,
        det if det < -rounding => -1,
        _ => 0,
    }
}

/// Whether the Jacobian is negative everywhere, by its signs.
///
/// # Errors
/// It is zero everywhere, or changes its sign.
pub(super) fn is_negative(signs: impl Iterator<Item = i8>) -> Result<bool, ShapeFault> {
    let signs: Vec<i8> = signs.collect();
    let all = |sign: i8| signs.iter().all(|other| *other == sign);
    if all(1) {
        Ok(false)
    } else if all(-1) {
        Ok(true)
    } else if all(0) {
        Err(ShapeFault::NoArea)
    } else {
        Err(ShapeFault::Folded)
    }
}

/// Refuses two nodes at one place.
pub(super) fn coincident<P: PartialEq>(nodes: &[P]) -> Result<(), ShapeFault> {
    for (i, a) in nodes.iter().enumerate() {
        if let Some(j) = nodes[..i].iter().position(|b| b == a) {
            return Err(ShapeFault::Coincident(j, i));
        }
    }
    Ok(())
}

/// Whether the segments a-b and c-d cross between their ends.
fn cuts(a: Point, b: Point, c: Point, d: Point) -> bool {
    let side = |p: Point, q: Point, r: Point| cross(minus(q, p), minus(r, p));
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

/// The number of corners among the nodes of a side of a solid: 3 of 3 or 6, 4 of 4 or 8.
pub fn side_corners(nodes: usize) -> usize {
    if nodes.is_multiple_of(3) { 3 } else { 4 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [Point; 4] = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];

    fn with_middles(corners: &[Point]) -> Vec<Point> {
        let n = corners.len();
        let middle = |k: usize| [0, 1].map(|i| 0.5 * (corners[k][i] + corners[(k + 1) % n][i]));
        corners.iter().copied().chain((0..n).map(middle)).collect()
    }

    #[test]
    fn faults_of_corners() {
        let swapped = [SQUARE[0], SQUARE[2], SQUARE[1], SQUARE[3]];
        assert_eq!(Shape::Quad4.is_clockwise(&swapped), Err(ShapeFault::BowTie));
        assert_eq!(Shape::Quad8.is_clockwise(&with_middles(&swapped)), Err(ShapeFault::BowTie));
        let dart = [[0.0, 0.0], [2.0, 0.0], [0.5, 0.5], [0.0, 2.0]];
        assert_eq!(Shape::Quad4.is_clockwise(&dart), Err(ShapeFault::NotConvex));
        let line = [[0.0, 0.0], [1.0, 0.1], [3.0, 0.3], [2.0, 0.2]];
        assert_eq!(Shape::Quad4.is_clockwise(&line), Err(ShapeFault::NoArea));
        assert_eq!(Shape::Triangle3.is_clockwise(&line[..3]), Err(ShapeFault::NoArea));
        assert_eq!(Shape::Triangle6.is_clockwise(&with_middles(&line[..3])), Err(ShapeFault::NoArea));
        let twice = [[0.0, 0.0], [2.0, 0.0], [2.0, 0.0], [0.0, 2.0]];
        assert_eq!(Shape::Quad4.is_clockwise(&twice), Err(ShapeFault::Coincident(1, 2)));
        assert_eq!(Shape::Quad4.is_clockwise(&SQUARE), Ok(false));
    }

    /// A middle node at a quarter makes the Jacobian zero at the corner, beyond it negative.
    #[test]
    fn middles_up_to_the_quarter() {
        for (corners, shape) in [(&SQUARE[..], Shape::Quad8), (&SQUARE[..3], Shape::Triangle6)] {
            for (at, expected) in [
                (0.5, Ok(false)),
                (0.26, Ok(false)),
                (0.25, Err(ShapeFault::Folded)),
                (0.2, Err(ShapeFault::Folded)),
                (0.8, Err(ShapeFault::Folded)),
            ] {
                let mut nodes = with_middles(corners);
                nodes[corners.len()][0] = 2.0 * at;
                assert_eq!(shape.is_clockwise(&nodes), expected, "{shape:?} at {at}");
                assert_eq!(shape.is_clockwise(&shape.turned(&nodes)), expected.map(|clockwise| !clockwise));
                // The same far from the origin, in numbers that are not exact.
                let moved: Vec<Point> = nodes.iter().map(|[x, y]| [0.1 * x + 7.3, 0.1 * y - 2.9]).collect();
                assert_eq!(shape.is_clockwise(&moved), expected, "{shape:?} at {at}, moved");
            }
        }
    }

    /// Half a disc segment: side from (0, 0) to (2, 0) bulging down by 0.3 adds 2/3 · 2 · 0.3.
    #[test]
    fn areas_and_qualities() {
        let mut nodes = with_middles(&SQUARE);
        assert!((Shape::Quad8.area(&nodes) - 4.0).abs() < 1e-15 && Shape::Quad8.quality(&nodes) == 1.0);
        nodes[4][1] -= 0.3;
        assert!((Shape::Quad8.area(&nodes) - 4.4).abs() < 1e-15);
        // The tangent of the parabola at its end: 4 · 0.3 down on 2 along.
        let angle = 90.0_f64.to_radians() + (0.6_f64).atan();
        assert!((Shape::Quad8.quality(&nodes) - angle.sin()).abs() < 1e-15);
        let equilateral = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.75_f64.sqrt()]];
        assert!((Shape::Triangle3.quality(&equilateral) - 1.0).abs() < 1e-15);
        assert!((Shape::Triangle3.area(&equilateral) - 0.75_f64.sqrt() / 2.0).abs() < 1e-15);
    }

    #[test]
    fn turning_keeps_middles_on_their_sides() {
        assert_eq!(Shape::Quad8.turned(&[1, 2, 3, 4, 12, 23, 34, 41]), [1, 4, 3, 2, 41, 34, 23, 12]);
        assert_eq!(Shape::Triangle6.turned(&[1, 2, 3, 12, 23, 31]), [1, 3, 2, 31, 23, 12]);
    }
}
