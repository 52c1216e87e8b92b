//! Edges: chains of element sides, their nodes, normals, and the consistent loads on them.

use super::element::Element;
use super::node::Node;
use super::vector::flat;

/// One element side of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeSide {
    /// Index of the element.
    pub element: usize,
    /// First and last node along the edge.
    pub ends: [usize; 2],
    /// The node in the middle of a quadratic side.
    pub middle: Option<usize>,
    /// Whether the edge runs against the element's own sense, so that the element lies on its right.
    pub reversed: bool,
}

/// A chain of element sides.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edge {
    /// Its nodes in order, middle nodes included.
    pub nodes: Vec<usize>,
    /// Its sides in order.
    pub sides: Vec<EdgeSide>,
}

/// A place on an edge, for what acts there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Coordinates.
    pub position: [f64; 2],
    /// Unit normal out of the body.
    pub outward: [f64; 3],
    /// Share of the edge's length that lies before it, 0 … 1.
    pub along: f64,
    /// The element whose side it is on.
    pub element: usize,
}

/// Nodes this near the chord, relative to the length of the edge, lie on a straight edge.
pub const STRAIGHT: f64 = 1e-9;

/// Three Gauss points on (0, 1): exact to degree 5.
const GAUSS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_31, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

impl EdgeSide {
    /// Its nodes along the edge.
    pub fn nodes(&self) -> impl Iterator<Item = usize> + use<> {
        let [a, b] = self.ends;
        [Some(a), self.middle, Some(b)].into_iter().flatten()
    }

    /// Shape functions and their derivatives at t = 0 … 1, in the order of [`nodes`](Self::nodes).
    pub fn shape(&self, t: f64) -> ([f64; 3], [f64; 3]) {
        match self.middle {
            None => ([1.0 - t, t, 0.0], [-1.0, 1.0, 0.0]),
            Some(_) => (
                [(1.0 - t) * (1.0 - 2.0 * t), 4.0 * t * (1.0 - t), t * (2.0 * t - 1.0)],
                [4.0 * t - 3.0, 4.0 - 8.0 * t, 4.0 * t - 1.0],
            ),
        }
    }

    /// Position and its derivative by t, both lengths.
    pub fn at(&self, nodes: &[Node], t: f64) -> ([f64; 2], [f64; 2]) {
        let (n, d) = self.shape(t);
        let (mut position, mut tangent) = ([0.0; 2], [0.0; 2]);
        for (i, node) in self.nodes().enumerate() {
            for a in 0..2 {
                position[a] += n[i] * nodes[node].position[a];
                tangent[a] += d[i] * nodes[node].position[a];
            }
        }
        (position, tangent)
    }

    /// Length from its first node to t, in the unit of the coordinates.
    pub fn length_to(&self, nodes: &[Node], t: f64) -> f64 {
        GAUSS
            .iter()
            .map(|(x, w)| {
                let (_, [dx, dy]) = self.at(nodes, t * x);
                w * t * dx.hypot(dy)
            })
            .sum()
    }

    /// Unit normal out of the body for a tangent along the edge.
    pub fn outward(&self, [dx, dy]: [f64; 2]) -> [f64; 2] {
        let length = dx.hypot(dy);
        let sign = if self.reversed { -1.0 } else { 1.0 };
        [sign * dy / length, -sign * dx / length]
    }

    /// The places 0 < t < 1 at which it crosses the height y.
    fn crossings(&self, nodes: &[Node], y: f64) -> Vec<f64> {
        let height = |node: usize| nodes[node].position[1] - y;
        let [a, b] = self.ends.map(height);
        match self.middle.map(height) {
            None => crossings(a, b - a, 0.0),
            Some(m) => crossings_through([a, m, b]),
        }
    }
}

/// The places 0 < t < 1 at which a + c1 t + c2 t² is zero, in increasing order; without cancellation.
pub fn crossings(a: f64, c1: f64, c2: f64) -> Vec<f64> {
    let root = (c1 * c1 - 4.0 * c2 * a).sqrt();
    let r = -0.5 * (c1 + c1.signum() * root);
    let mut places: Vec<f64> = [r / c2, a / r].into_iter().filter(|t| *t > 0.0 && *t < 1.0).collect();
    places.sort_by(f64::total_cmp);
    places
}

/// The crossings of the parabola with these values at t = 0, 1/2 and 1.
pub fn crossings_through([a, m, b]: [f64; 3]) -> Vec<f64> {
    crossings(a, 4.0 * m - 3.0 * a - b, 2.0 * a - 4.0 * m + 2.0 * b)
}

impl Edge {
    /// Its nodes without the last one of a closed edge, which is the first.
    pub fn distinct_nodes(&self) -> &[usize] {
        match &self.nodes[..] {
            [first, .., last] if self.sides.len() > 1 && first == last => &self.nodes[..self.nodes.len() - 1],
            nodes => nodes,
        }
    }

    /// Its length.
    pub fn length(&self, nodes: &[Node]) -> f64 {
        self.sides.iter().map(|side| side.length_to(nodes, 1.0)).sum()
    }

    /// Unit normal of the chord from its first to its last node (of the first side where they coincide), pointing out
    /// of the body.
    pub fn outward_normal(&self, nodes: &[Node]) -> [f64; 2] {
        let [first, last] = [self.nodes[0], self.nodes[self.nodes.len() - 1]];
        let side = &self.sides[0];
        let [a, b] = if first == last { side.ends } else { [first, last] }.map(|node| nodes[node].in_plane());
        side.outward([b[0] - a[0], b[1] - a[1]])
    }

    /// Unit normals at its nodes, pointing out of the body: those of the chord where the edge is straight, else the
    /// mean of the sides that meet there.
    pub fn outward_normals(&self, nodes: &[Node]) -> Vec<[f64; 3]> {
        self.outward_in_plane(nodes).into_iter().map(flat).collect()
    }

    /// The same as (x, y).
    pub fn outward_in_plane(&self, nodes: &[Node]) -> Vec<[f64; 2]> {
        let chord = self.outward_normal(nodes);
        let first = nodes[self.nodes[0]].in_plane();
        let length = self.length(nodes);
        let off = |node: &usize| {
            let [x, y] = nodes[*node].in_plane();
            (chord[0] * (x - first[0]) + chord[1] * (y - first[1])).abs()
        };
        if self.nodes.iter().map(off).fold(0.0, f64::max) <= STRAIGHT * length {
            return vec![chord; self.nodes.len()];
        }
        let mut normals = vec![[0.0; 2]; self.nodes.len()];
        let mut at = 0;
        for side in &self.sides {
            let places: &[f64] = if side.middle.is_some() { &[0.0, 0.5, 1.0] } else { &[0.0, 1.0] };
            for (t, normal) in places.iter().zip(&mut normals[at..]) {
                let outward = side.outward(side.at(nodes, *t).1);
                *normal = [normal[0] + outward[0], normal[1] + outward[1]];
            }
            at += places.len() - 1;
        }
        // A closed edge ends where it began.
        if self.nodes.len() > 2 && self.nodes[0] == self.nodes[at] {
            let sum = [normals[0][0] + normals[at][0], normals[0][1] + normals[at][1]];
            (normals[0], normals[at]) = (sum, sum);
        }
        for [x, y] in &mut normals {
            let length = x.hypot(*y);
            (*x, *y) = (*x / length, *y / length);
        }
        normals
    }

    /// Nodal forces ∫ N q ds of the force `q` per length of edge; sides are cut where they cross the height `level`, at
    /// which q may have a kink. Exact where q is linear between the cuts and the sides are straight.
    pub fn consistent_forces(
        &self,
        nodes: &[Node],
        level: Option<f64>,
        q: &dyn Fn(&Spot) -> [f64; 3],
    ) -> Vec<(usize, [f64; 3])> {
        let total = self.length(nodes);
        let mut forces = vec![[0.0; 2]; self.nodes.len()];
        let (mut before, mut at) = (0.0, 0);
        for side in &self.sides {
            let mut cuts = vec![0.0];
            cuts.extend(level.into_iter().flat_map(|level| side.crossings(nodes, level)));
            cuts.push(1.0);
            for ends in cuts.windows(2) {
                let size = ends[1] - ends[0];
                for (x, w) in GAUSS {
                    let t = ends[0] + size * x;
                    let (position, tangent) = side.at(nodes, t);
                    let along = (before + side.length_to(nodes, t)) / total;
                    let spot = Spot { position, outward: flat(side.outward(tangent)), along, element: side.element };
                    let q = q(&spot);
                    let weight = w * size * tangent[0].hypot(tangent[1]);
                    for (n, force) in side.shape(t).0.into_iter().zip(&mut forces[at..]) {
                        *force = [force[0] + weight * n * q[0], force[1] + weight * n * q[1]];
                    }
                }
            }
            before += side.length_to(nodes, 1.0);
            at += if side.middle.is_some() { 2 } else { 1 };
        }
        self.nodes.iter().copied().zip(forces.into_iter().map(flat)).collect()
    }
}

/// Sides of plane elements by their two corner nodes, to find chains of them.
#[derive(Default)]
pub struct Sides {
    by_corners: std::collections::HashMap<(usize, usize), Vec<EdgeSide>>,
    /// Corners of the side that has this node in its middle.
    by_middle: std::collections::HashMap<usize, (usize, usize)>,
}

/// Why nodes do not make an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChainError {
    /// Fewer than two nodes.
    TooShort,
    /// No element has a side between these two nodes.
    NoSide([usize; 2]),
    /// Two elements share the side between these two nodes: it is not on the outside.
    Inside([usize; 2]),
    /// Body on the left of one side and on the right of the next.
    Turns(usize),
}

impl Sides {
    /// The sides of all elements that are areas.
    pub fn of(elements: &[Element]) -> Sides {
        let mut sides = Sides::default();
        for (index, element) in elements.iter().enumerate() {
            if element.shape().is_area() {
                sides.add(index, element.shape().corners(), &element.nodes);
            }
        }
        sides
    }

    /// Adds those of an element: nodes counter-clockwise, corners first.
    pub fn add(&mut self, element: usize, corners: usize, nodes: &[usize]) {
        for k in 0..corners {
            let ends = [nodes[k], nodes[(k + 1) % corners]];
            let middle = nodes.get(corners + k).copied();
            let key = key(ends);
            if let Some(middle) = middle {
                self.by_middle.insert(middle, key);
            }
            self.by_corners.entry(key).or_default().push(EdgeSide { element, ends, middle, reversed: false });
        }
    }

    /// The sides between two corners: two inside a body, one on its boundary.
    pub fn at(&self, ends: [usize; 2]) -> &[EdgeSide] {
        self.by_corners.get(&key(ends)).map_or(&[], Vec::as_slice)
    }

    /// The corners of the side with this node in its middle.
    pub fn with_middle(&self, node: usize) -> Option<[usize; 2]> {
        self.by_middle.get(&node).map(|&(a, b)| [a, b])
    }

    /// All sides, each once, with whether two elements share it.
    pub fn all(&self) -> Vec<(EdgeSide, bool)> {
        let mut all: Vec<_> = self.by_corners.values().map(|sides| (sides[0], sides.len() > 1)).collect();
        all.sort_unstable_by_key(|(side, _)| (side.element, side.ends));
        all
    }

    /// The sides of one element only, in the order of elements, each in the sense of its element.
    pub fn boundary(&self) -> Vec<EdgeSide> {
        let single = self.by_corners.values().filter_map(|sides| <[EdgeSide; 1]>::try_from(&sides[..]).ok());
        let mut boundary: Vec<EdgeSide> = single.flatten().collect();
        boundary.sort_unstable_by_key(|side| (side.element, side.ends));
        boundary
    }

    /// The chain through `nodes`: corners in order; middles of quadratic sides may be named between them.
    ///
    /// # Errors
    /// See [`ChainError`].
    pub fn chain(&self, nodes: &[usize]) -> Result<Edge, ChainError> {
        let mut edge = Edge { nodes: Vec::new(), sides: Vec::new() };
        let mut at = 0;
        while at + 1 < nodes.len() {
            let ends = [nodes[at], nodes[at + 1]];
            let over = nodes.get(at + 2).map(|&end| (self.between(ends[0], end), ends[1]));
            let side = match self.between(ends[0], ends[1]) {
                Some(side) => side?,
                // The next node may be the middle of a side that ends one further on.
                None => match over {
                    Some((Some(side), middle)) if side?.middle == Some(middle) => {
                        at += 1;
                        side?
                    }
                    _ => return Err(ChainError::NoSide(ends)),
                },
            };
            at += 1;
            if edge.sides.last().is_some_and(|last| last.reversed != side.reversed) {
                return Err(ChainError::Turns(side.ends[0]));
            }
            if edge.nodes.is_empty() {
                edge.nodes.push(side.ends[0]);
            }
            edge.nodes.extend(side.middle);
            edge.nodes.push(side.ends[1]);
            edge.sides.push(side);
        }
        if edge.sides.is_empty() { Err(ChainError::TooShort) } else { Ok(edge) }
    }

    /// The side from `a` to `b`, if there is one.
    fn between(&self, a: usize, b: usize) -> Option<Result<EdgeSide, ChainError>> {
        match self.at([a, b]) {
            [] => None,
            [side] => Some(Ok(EdgeSide { ends: [a, b], reversed: side.ends[0] != a, ..*side })),
            _ => Some(Err(ChainError::Inside([a, b]))),
        }
    }
}

fn key([a, b]: [usize; 2]) -> (usize, usize) {
    (a.min(b), a.max(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::grid::{GridLines, PlateGrid};
    use crate::model::plate::{Plate, PlateSide};
    use crate::model::structure::Plane;

    fn graded(rotation: f64) -> (Vec<Node>, Plate, Vec<Element>) {
        let plate = PlateGrid {
            id: "p".into(),
            origin: [0.5, -1.0],
            rotation,
            x: GridLines::Graded(vec![0.0, 0.1, 0.4, 1.0, 2.5]),
            y: GridLines::Uniform { size: 2.0, divisions: 3 },
            thickness: 1.0,
            plane: Plane::Stress,
            incompatible: false,
            material: 0,
        };
        let (mut nodes, mut elements) = (Vec::new(), Vec::new());
        let grid = plate.append_nodes(&mut nodes);
        let range = plate.append_elements(&grid, &mut elements);
        (nodes, Plate { id: plate.id.clone(), elements: range, nodes: grid }, elements)
    }

    #[test]
    fn edges_are_ordered_by_increasing_index() {
        let (nodes, plate, _) = graded(0.0);
        let ids = |side: PlateSide| -> Vec<&str> {
            side.edge(&plate).nodes.iter().map(|&node| nodes[node].id.as_str()).collect()
        };
        assert_eq!(ids(PlateSide::Left), ["p[0,0]", "p[0,1]", "p[0,2]", "p[0,3]"]);
        assert_eq!(ids(PlateSide::Top)[0], "p[0,3]");
        assert_eq!(ids(PlateSide::Right)[3], "p[4,3]");
        assert_eq!(ids(PlateSide::Bottom).len(), 5);
    }

    #[test]
    fn normals_point_outwards_and_turn_with_the_plate() {
        let (nodes, plate, _) = graded(0.0);
        for (side, right) in [
            (PlateSide::Bottom, [0.0, -1.0]),
            (PlateSide::Top, [0.0, 1.0]),
            (PlateSide::Left, [-1.0, 0.0]),
            (PlateSide::Right, [1.0, 0.0]),
        ] {
            assert_eq!(side.edge(&plate).outward_normal(&nodes), right, "{side:?}");
        }
        let (nodes, plate, _) = graded(30.0);
        let normal = PlateSide::Top.edge(&plate).outward_normal(&nodes);
        assert!((normal[0] + 0.5).abs() < 1e-14 && (normal[1] - 0.75f64.sqrt()).abs() < 1e-14);
    }

    /// The sides of a plate are what a search among its elements finds, in both senses.
    #[test]
    fn chains_are_found_among_the_elements() {
        let (_, plate, elements) = graded(0.0);
        let sides = Sides::of(&elements);
        for (_, side) in PlateSide::WORDS {
            let edge = side.edge(&plate);
            assert_eq!(sides.chain(&edge.nodes), Ok(edge.clone()), "{side:?}");
            let back: Vec<usize> = edge.nodes.iter().rev().copied().collect();
            assert_eq!(sides.chain(&back).unwrap().sides[0].reversed, !edge.sides[0].reversed);
        }
        let inner = [plate.nodes[1][0], plate.nodes[1][1]];
        assert_eq!(sides.chain(&inner), Err(ChainError::Inside(inner)));
        let across = [plate.nodes[0][0], plate.nodes[1][1]];
        assert_eq!(sides.chain(&across), Err(ChainError::NoSide(across)));
        assert_eq!(sides.chain(&[3]), Err(ChainError::TooShort));
    }

    #[test]
    fn uniform_forces_keep_total_and_moment() {
        let (nodes, plate, _) = graded(0.0);
        let edge = PlateSide::Bottom.edge(&plate);
        let forces = edge.consistent_forces(&nodes, None, &|_| [1.0, -2.0, 0.0]);
        // Segments 0.1, 0.3, 0.6, 1.5: half of each to its ends.
        for ((_, found), expected) in forces.iter().zip([0.05, 0.2, 0.45, 1.05, 0.75]) {
            assert!((found[0] - expected).abs() < 1e-15 && (found[1] + 2.0 * expected).abs() < 1e-15);
        }
    }

    /// Water to the height 0.3 on an upright edge from −1 to 1: total γ h²/2 = 1.3²/2 at h/3 above the foot, exactly,
    /// although the level cuts an element; pushed into the body.
    #[test]
    fn water_pressure_is_exact_where_the_level_cuts_an_element() {
        let (nodes, plate, _) = graded(0.0);
        let edge = PlateSide::Left.edge(&plate);
        let forces = edge.consistent_forces(&nodes, Some(0.3), &|spot| {
            let pressure = (0.3 - spot.position[1]).max(0.0);
            spot.outward.map(|n| -pressure * n)
        });
        let total: f64 = forces.iter().map(|(_, f)| f[0]).sum();
        let moment: f64 = forces.iter().map(|(node, f)| f[0] * (nodes[*node].position[1] + 1.0)).sum();
        assert!((total - 1.3 * 1.3 / 2.0).abs() < 1e-14, "{total}");
        assert!((moment - total * 1.3 / 3.0).abs() < 1e-14);
        assert!(forces.iter().all(|(_, f)| f[1] == 0.0));
    }

    /// A straight quadratic side takes a uniform load as 1/6, 4/6, 1/6 and a linear one 0 → q as 0, 1/3, 1/6; its
    /// crossings are found on a bent one.
    #[test]
    fn quadratic_sides() {
        let place = |x: f64, y: f64| Node { id: "n".into(), position: [x, y, 0.0] };
        let nodes = [place(0.0, 0.0), place(3.0, 0.0), place(6.0, 0.0)];
        let side = EdgeSide { element: 0, ends: [0, 2], middle: Some(1), reversed: false };
        let edge = Edge { nodes: vec![0, 1, 2], sides: vec![side] };
        let uniform = edge.consistent_forces(&nodes, None, &|_| [0.0, 1.0, 0.0]);
        let linear = edge.consistent_forces(&nodes, None, &|spot| [0.0, spot.along, 0.0]);
        for i in 0..3 {
            assert!((uniform[i].1[1] - [1.0, 4.0, 1.0][i]).abs() < 1e-14);
            assert!((linear[i].1[1] - [0.0, 2.0, 1.0][i]).abs() < 1e-14);
        }
        // y = 4 t (1 − t) reaches 0.75 at t = 1/4 and 3/4.
        let bent = [place(0.0, 0.0), place(3.0, 1.0), place(6.0, 0.0)];
        let crossings = side.crossings(&bent, 0.75);
        assert!(crossings.len() == 2 && (crossings[0] - 0.25).abs() < 1e-15 && (crossings[1] - 0.75).abs() < 1e-15);
    }
}
