//! Faces of solids: sides of their elements, areas, normals, and the consistent loads on them.

use std::cell::Cell;
use std::collections::{HashMap, HashSet};

use super::edge::{STRAIGHT, crossings, crossings_through};
use super::node::Node;
use super::shape_functions::{AreaShape, MOST};
use super::vector::{cross, dot, length, unit, way};

/// One side of a solid element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FaceSide {
    /// Index of the element.
    pub element: usize,
    /// Its nodes, 3, 4, 6 or 8: corners counter-clockwise as seen from outside the body, then the middles between them.
    pub nodes: Vec<usize>,
}

/// A part of the surface of a body.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Face {
    /// Its nodes, each once.
    pub nodes: Vec<usize>,
    /// Its sides.
    pub sides: Vec<FaceSide>,
}

/// A place on a face, for what acts there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceSpot {
    /// Coordinates.
    pub position: [f64; 3],
    /// Unit normal out of the body.
    pub outward: [f64; 3],
    /// Depth below the level, where there is one: as accurate as the differences between the level and the heights of
    /// the nodes.
    pub depth: f64,
    /// The element whose side it is on.
    pub element: usize,
}

/// Most halvings of the strips of a side. Kinks take some forty halvings each; more are wasted on rounding where hardly
/// anything of a side lies below the level.
const HALVINGS: u32 = 1000;

/// Four Gauss points on (0, 1): exact to degree 7.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Forces on the nodes of a side, and Σ of the magnitudes of their terms.
#[derive(Clone, Copy, Default)]
struct Sum {
    forces: [[f64; 3]; MOST],
    terms: f64,
}

impl Sum {
    fn plus(mut self, other: &Sum) -> Sum {
        for (mine, more) in self.forces.iter_mut().zip(&other.forces) {
            mine.iter_mut().zip(more).for_each(|(mine, more)| *mine += more);
        }
        self.terms += other.terms;
        self
    }

    /// The largest difference of a component.
    fn distance(&self, other: &Sum) -> f64 {
        let all = self.forces.iter().flatten().zip(other.forces.iter().flatten());
        all.fold(0.0, |most, (a, b)| most.max((a - b).abs()))
    }
}

/// A side with its places, to integrate over.
struct Patch<'a> {
    shape: AreaShape,
    places: Vec<[f64; 3]>,
    element: usize,
    /// Height z at which what acts may have a kink.
    level: Option<f64>,
    /// Force per area.
    acts: &'a dyn Fn(&FaceSpot) -> [f64; 3],
    /// Halvings that are left.
    left: Cell<u32>,
}

impl Patch<'_> {
    /// Position and (∂x/∂ξ) × (∂x/∂η), which points out of the body.
    fn at(&self, at: [f64; 2]) -> ([f64; 3], [f64; 3]) {
        let (mut position, mut along) = ([0.0; 3], [[0.0; 3]; 2]);
        let (n, d) = (self.shape.values(at), self.shape.gradients::<f64>(at));
        for (i, place) in self.places.iter().enumerate() {
            for c in 0..3 {
                position[c] += n[i] * place[c];
                // From the first node: the place in space costs no digits.
                let x = place[c] - self.places[0][c];
                (0..2).for_each(|a| along[a][c] += d[i][a] * x);
            }
        }
        (position, cross(along[0], along[1]))
    }

    /// How far a place lies below `level`.
    fn depth(&self, at: [f64; 2], level: f64) -> f64 {
        self.places.iter().zip(self.shape.values(at)).map(|(place, n)| n * (level - place[2])).sum()
    }

    /// The range of η for a given ξ: (0, 1 − ξ) on triangles, (−1, 1) on quadrilaterals.
    fn across(&self, xi: f64) -> [f64; 2] {
        if self.shape.is_triangle() { [0.0, 1.0 - xi] } else { [-1.0, 1.0] }
    }

    /// ∫ N q |dA| over the line of this ξ, cut where it crosses the level (at most twice: z is quadratic on it).
    fn over_line(&self, xi: f64, weight: f64) -> Sum {
        let [from, to] = self.across(xi);
        let mut cuts = vec![0.0];
        if let Some(level) = self.level {
            let [a, m, b] = [0.0, 0.5, 1.0].map(|t| self.depth([xi, from + t * (to - from)], level));
            let is_straight = self.places.len() <= 4;
            cuts.extend(if is_straight { crossings(a, b - a, 0.0) } else { crossings_through([a, m, b]) });
        }
        cuts.push(1.0);
        let mut sum = Sum::default();
        for ends in cuts.windows(2) {
            let size = ends[1] - ends[0];
            for (x, w) in GAUSS {
                let at = [xi, from + (ends[0] + size * x) * (to - from)];
                let (position, normal) = self.at(at);
                let area = length(normal);
                let depth = self.level.map_or(0.0, |level| self.depth(at, level));
                let spot = FaceSpot { position, outward: normal.map(|n| n / area), depth, element: self.element };
                let q = (self.acts)(&spot).map(|q| q * area * w * size * (to - from) * weight);
                for (force, n) in sum.forces.iter_mut().zip(self.shape.values(at)) {
                    force.iter_mut().zip(q).for_each(|(force, q)| *force += n * q);
                }
                sum.terms += q.iter().map(|q| q.abs()).sum::<f64>();
            }
        }
        sum
    }

    /// ∫ N q |dA| between two ξ.
    fn over_strip(&self, [from, to]: [f64; 2]) -> Sum {
        let lines = GAUSS.map(|(x, w)| self.over_line(from + x * (to - from), w * (to - from)));
        lines.iter().fold(Sum::default(), Sum::plus)
    }

    /// The same, its strip halved until nothing changes but by the rounding of `terms`: where the line of the level is
    /// a conic it makes kinks inside.
    fn settle(&self, [from, to]: [f64; 2], whole: Sum, terms: f64) -> Sum {
        let middle = 0.5 * (from + to);
        let halves = [[from, middle], [middle, to]];
        let parts = halves.map(|half| self.over_strip(half));
        let both = parts[0].plus(&parts[1]);
        let left = self.left.get();
        if left == 0 || both.distance(&whole) <= 8.0 * f64::EPSILON * terms {
            return both;
        }
        self.left.set(left - 1);
        let [a, b] = [0, 1].map(|i| self.settle(halves[i], parts[i], terms));
        a.plus(&b)
    }

    /// The ends of ξ, and between them where the level crosses the sides along which η is least and largest: there the
    /// lines over which is integrated begin or end to be cut.
    fn strips(&self, level: f64) -> Vec<f64> {
        let [from, to] = if self.shape.is_triangle() { [0.0, 1.0] } else { [-1.0, 1.0] };
        let mut cuts = vec![from, to];
        for side in [0, 1] {
            let height = |t: f64| {
                let xi = from + t * (to - from);
                self.depth([xi, self.across(xi)[side]], level)
            };
            let crossed = crossings_through([0.0, 0.5, 1.0].map(height));
            cuts.extend(crossed.into_iter().map(|t| from + t * (to - from)));
        }
        cuts.sort_by(f64::total_cmp);
        cuts
    }

    fn forces(&self) -> Sum {
        let Some(level) = self.level else {
            return self.over_strip(if self.shape.is_triangle() { [0.0, 1.0] } else { [-1.0, 1.0] });
        };
        let strips = self.strips(level);
        let strips: Vec<([f64; 2], Sum)> =
            strips.windows(2).map(|ends| ([ends[0], ends[1]], self.over_strip([ends[0], ends[1]]))).collect();
        let terms = strips.iter().map(|(_, sum)| sum.terms).sum();
        let settled = strips.into_iter().map(|(strip, whole)| self.settle(strip, whole, terms));
        settled.fold(Sum::default(), |all, strip| all.plus(&strip))
    }
}

impl Face {
    /// The face of these sides; its nodes in the order in which they come.
    pub fn of(sides: Vec<FaceSide>) -> Face {
        let mut seen = HashSet::new();
        let nodes = sides.iter().flat_map(|side| &side.nodes).copied().filter(|node| seen.insert(*node)).collect();
        Face { nodes, sides }
    }

    /// Nodal forces ∫ N q dA of the force `q` per area; where a `level` is given, q may have a kink at that height z.
    /// Exact, cut or not, where q times the area is a polynomial between: pressures on any side, tractions on plane
    /// ones that are triangles with straight sides or parallelograms.
    pub fn consistent_forces(
        &self,
        nodes: &[Node],
        level: Option<f64>,
        q: &dyn Fn(&FaceSpot) -> [f64; 3],
    ) -> Vec<(usize, [f64; 3])> {
        let place: HashMap<usize, usize> = self.nodes.iter().enumerate().map(|(at, node)| (*node, at)).collect();
        let mut forces = vec![[0.0; 3]; self.nodes.len()];
        for side in &self.sides {
            let sum = side.patch(nodes, level, q).forces();
            for (node, force) in side.nodes.iter().zip(sum.forces) {
                forces[place[node]].iter_mut().zip(force).for_each(|(all, force)| *all += force);
            }
        }
        self.nodes.iter().copied().zip(forces).collect()
    }

    /// The area ∫ N dA that stands for each of its nodes; on quadratic sides corners have a part that is 0 or negative.
    pub fn nodal_areas(&self, nodes: &[Node]) -> Vec<f64> {
        self.consistent_forces(nodes, None, &|_| [1.0, 0.0, 0.0]).into_iter().map(|(_, [area, ..])| area).collect()
    }

    /// Its area.
    pub fn area(&self, nodes: &[Node]) -> f64 {
        self.nodal_areas(nodes).into_iter().sum()
    }

    /// ∫ n dA: the vector area, which points out of the body.
    pub fn vector_area(&self, nodes: &[Node]) -> [f64; 3] {
        let forces = self.consistent_forces(nodes, None, &|spot| spot.outward);
        forces.into_iter().fold([0.0; 3], |sum, (_, force)| [0, 1, 2].map(|c| sum[c] + force[c]))
    }

    /// The unit normal out of the body of a face whose nodes lie in one plane, but for [`STRAIGHT`] of its extent.
    pub fn plane_normal(&self, nodes: &[Node]) -> Option<[f64; 3]> {
        let normal = unit(self.vector_area(nodes))?;
        let from_first = |node: &usize| way(nodes[self.nodes[0]].position, nodes[*node].position);
        let extent = self.nodes.iter().map(|node| length(from_first(node))).fold(0.0, f64::max);
        let is_near = |node: &usize| dot(normal, from_first(node)).abs() <= STRAIGHT * extent;
        self.nodes.iter().all(is_near).then_some(normal)
    }

    /// Unit normals at its nodes, pointing out of the body: that of the whole where the face is plane, else of the sum
    /// of the vector areas of the sides that meet there. `None` where they cancel.
    pub fn outward_normals(&self, nodes: &[Node]) -> Vec<Option<[f64; 3]>> {
        if let Some(normal) = self.plane_normal(nodes) {
            return vec![Some(normal); self.nodes.len()];
        }
        let mut sums: HashMap<usize, [f64; 3]> = HashMap::new();
        for side in &self.sides {
            let patch = side.patch(nodes, None, &|_| [0.0; 3]);
            for (node, at) in side.nodes.iter().zip(patch.shape.nodes()) {
                let (_, normal) = patch.at(*at);
                let sum = sums.entry(*node).or_default();
                sum.iter_mut().zip(normal).for_each(|(sum, n)| *sum += n);
            }
        }
        self.nodes.iter().map(|node| unit(sums[node])).collect()
    }
}

impl FaceSide {
    fn patch<'a>(&self, nodes: &[Node], level: Option<f64>, acts: &'a dyn Fn(&FaceSpot) -> [f64; 3]) -> Patch<'a> {
        let places = self.nodes.iter().map(|&node| nodes[node].position).collect();
        let (shape, left) = (AreaShape::of(self.nodes.len()), Cell::new(HALVINGS));
        Patch { shape, places, element: self.element, level, acts, left }
    }
}

#[cfg(test)]
mod tests;
