//! Two edges whose nodes do not match: the dual mortar method (Wohlmuth 2000; Popp, Gee and Wall 2009).
//!
//! ```text
//!     traction on the non-mortar edge   λ(s) = Σ_j Ψ_j(s) λ_j,   x_j = λ_j ∫ N_j ds: the force at its node j
//!     mutual displacement               z_j = Σ_k B_jk u_k − Σ_l M_jl u_l, divided by ∫ N_j ds
//!     B_jk = ∫ Ψ_j N_k ds,  M_jl = ∫ Ψ_j N_l ds       k: nodes of the non-mortar edge, l: nodes of the other one
//! ```
//! With the dual functions of a side, Ψ = D M⁻¹ N (D = diag ∫ N_k ds, M = ∫ N_k N_l ds), B is diagonal and the x·z are
//! the work. They sum to 1, so a uniform traction is carried over exactly. Points of the two edges belong together
//! along the interpolated mean normals of the non-mortar edge; sides are cut where a corner of the other edge is met,
//! so that every integral is one of a polynomial where both edges are straight.
//!
//! * **Ends.** Where the other edge ends inside a side, the functions of that side are the dual of the polynomial through
//!   those of its nodes that face the other edge and the place of the end. That place has a pair of its own, numbered as the
//!   node beyond, which moves with the nodes of the side. So forces and moments of any linear traction are carried over, no
//!   force stands outside the common length, and the force may move up to its very end, where a body tips over.
//! * **Corners.** Where both edges have a node at one bend, it is a pair of two nodes, and the functions next to it are
//!   made of the other nodes of their sides: else the traction of one leg would act on the other one.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use super::edge::{Edge, EdgeSide};
use super::pair::Weights;
use super::structure::Node;

/// Five Gauss points on (0, 1): exact to degree 9.
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

/// A side of the other edge faces one of this edge if the cosine between their normals is below minus this.
const FACING: f64 = 0.1;

/// Shares of a side that count as nothing: coordinates of meshes agree that well (see `decode::sides`).
const NEAR: f64 = 1e-6;

/// An end of the other edge nearer to a node than this share of the side has no pair beside that of the node: R would
/// be worth a million times fewer digits, and a body tips over at most so much too early.
const BESIDE: f64 = 1e-3;

/// Weights that are sums of a few products of numbers up to 1 and vanish by themselves.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Least angle between two sides, in radians, that is a bend of the edge and not rounding.
const BEND: f64 = 1e-6;

/// Why two edges have no mortar contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MortarError {
    /// No part of one lies opposite the other.
    Apart,
    /// They have this node in common.
    Shared(usize),
}

/// A pair of two edges.
pub struct MortarPair {
    /// Nodes of `edge` and what each counts in its place: one node, or those of the side on which the other edge ends.
    pub place: Weights,
    /// Of the mutual displacement, those of each edge summing to 1 and −1; the node that it is numbered as first.
    pub weights: Weights,
    /// Out of the body of `edge`, of unit length.
    pub normal: [f64; 2],
    /// The part of the common length that stands for it.
    pub share: f64,
}

/// The pairs by the nodes of `edge`; `None` where neither the node nor a place beside it, at which `other` ends, faces it.
///
/// # Errors
/// See [`MortarError`].
pub fn pairs(edge: &Edge, other: &Edge, nodes: &[Node]) -> Result<Vec<Option<MortarPair>>, MortarError> {
    if let Some(&shared) = edge.nodes.iter().find(|node| other.nodes.contains(node)) {
        return Err(MortarError::Shared(shared));
    }
    let mortar = Mortar { edge, other, nodes, normals: edge.outward_in_plane(nodes) };
    let sides = mortar.covered_sides();
    let supported = mortar.supported(&sides);
    let corners = mortar.corners(&sides);
    let mut rows: Vec<Row> = vec![Row::default(); edge.nodes.len()];
    for (side, covered) in edge.sides.iter().zip(&sides) {
        if covered.pieces.is_empty() {
            continue;
        }
        let places: Vec<Place> = mortar
            .places(side, covered, &supported)
            .into_iter()
            .filter(|place| corners[place.row].is_none() && !(place.is_end && rows[place.row].end.is_some()))
            .collect();
        mortar.add_side(side, covered, places, &mut rows);
    }
    let pair = |k: usize| {
        let node = edge.nodes[k];
        let (place, weights, normal) = match (corners[k], &rows[k].end) {
            (Some(partner), _) => (vec![(node, 1.0)], vec![(node, 1.0), (partner, -1.0)], mortar.normals[k]),
            (None, None) => (vec![(node, 1.0)], rows[k].finish(node, &corners, edge)?, mortar.normals[k]),
            (None, Some((place, normal))) => (place.clone(), rows[k].finish(node, &corners, edge)?, *normal),
        };
        Some(MortarPair { place, weights, normal, share: rows[k].share })
    };
    let faces = |k: usize| supported[k] || rows[k].end.is_some();
    let found: Vec<_> = (0..edge.distinct_nodes().len()).map(|k| if faces(k) { pair(k) } else { None }).collect();
    if found.iter().all(Option::is_none) { Err(MortarError::Apart) } else { Ok(found) }
}

/// How far the polygon of an edge may lie off the curve it stands for: a share of its longest side by its largest bend.
pub fn chord_error(edge: &Edge, nodes: &[Node]) -> f64 {
    let longest = edge.sides.iter().map(|side| side.length_to(nodes, 1.0)).fold(0.0, f64::max);
    // A chord of an arc that turns by φ lies φ/8 of its length off at most; at a lone bend twice that.
    0.25 * longest * edge.sides.windows(2).map(|sides| bend(&sides[0], &sides[1], nodes)).fold(0.0, f64::max)
}

/// Angle by which an edge turns from one side to the next.
fn bend(side: &EdgeSide, next: &EdgeSide, nodes: &[Node]) -> f64 {
    let ([ax, ay], [bx, by]) = (side.at(nodes, 1.0).1, next.at(nodes, 0.0).1);
    (ax * by - ay * bx).atan2(ax * bx + ay * by).abs()
}

struct Mortar<'a> {
    edge: &'a Edge,
    other: &'a Edge,
    nodes: &'a [Node],
    /// At the nodes of `edge`, out of its body.
    normals: Vec<[f64; 2]>,
}

/// What of a side lies opposite the other edge.
struct Covered {
    /// Place of its first node in the edge.
    first: usize,
    /// Stretches of it, and the side of the other edge opposite each.
    pieces: Vec<([f64; 2], usize)>,
}

/// A place that the functions of a side are made of.
struct Place {
    t: f64,
    /// The row of its pair.
    row: usize,
    /// Whether it is no node, but where the other edge ends; its pair is numbered as the node beyond.
    is_end: bool,
}

/// What is integrated for one pair.
#[derive(Clone, Default)]
struct Row {
    /// The place of the pair by nodes, and its normal, where it is at an end of the other edge.
    end: Option<(Weights, [f64; 2])>,
    /// ∫ Ψ over the common length.
    share: f64,
    /// ∫ Ψ N over the nodes of its own edge.
    own: BTreeMap<usize, f64>,
    /// ∫ Ψ N over the nodes of the other one.
    other: BTreeMap<usize, f64>,
}

impl Row {
    /// Divided so that the weights of the own edge sum to 1, that of `node` alone where a corner takes its share.
    fn finish(&self, node: usize, corners: &[Option<usize>], edge: &Edge) -> Option<Weights> {
        let partner = |k: usize| edge.nodes.iter().position(|&other| other == k).and_then(|k| corners[k]);
        let size: f64 = self.own.iter().filter(|(k, _)| partner(**k).is_none()).map(|(_, weight)| weight).sum();
        if size <= 0.0 {
            return None;
        }
        // What a corner's own node would move is what its partner moves: that pair holds them together.
        let mut all: BTreeMap<usize, f64> = self.other.iter().map(|(&l, weight)| (l, -weight / size)).collect();
        for (&k, weight) in &self.own {
            *all.entry(partner(k).unwrap_or(k)).or_default() += weight / size;
        }
        let own = all.remove(&node)?;
        all.retain(|_, weight| weight.abs() > ROUNDING);
        if all.len() == 1 {
            all.values_mut().for_each(|weight| *weight = -1.0);
        }
        let own = if (own - 1.0).abs() <= ROUNDING { 1.0 } else { own };
        Some(std::iter::once((node, own)).chain(all).collect())
    }
}

impl Mortar<'_> {
    /// A closed edge ends with its first node.
    fn first_mention(&self, k: usize) -> usize {
        if k > 0 && self.edge.nodes[k] == self.edge.nodes[0] { 0 } else { k }
    }

    /// Normal of the edge at t of a side, not of unit length.
    fn normal(&self, side: &EdgeSide, first: usize, t: f64) -> [f64; 2] {
        let mut normal = [0.0; 2];
        for (n, [x, y]) in side.shape(t).0.into_iter().zip(&self.normals[first..]) {
            normal = [normal[0] + n * x, normal[1] + n * y];
        }
        normal
    }

    fn covered_sides(&self) -> Vec<Covered> {
        let mut first = 0;
        let mut sides = Vec::with_capacity(self.edge.sides.len());
        for side in &self.edge.sides {
            let mut cuts: Vec<f64> = self.crossings(side, first);
            cuts.extend([0.0, 1.0]);
            cuts.sort_by(f64::total_cmp);
            let opposite = |ends: &[f64]| {
                let ends = [ends[0], ends[1]];
                let facing = self.opposite(side, first, 0.5 * (ends[0] + ends[1]));
                facing.filter(|_| ends[1] > ends[0]).map(|facing| (ends, facing))
            };
            let mut pieces: Vec<([f64; 2], usize)> = cuts.windows(2).filter_map(opposite).collect();
            if pieces.iter().map(|([a, b], _)| b - a).sum::<f64>() <= NEAR {
                pieces.clear();
            }
            sides.push(Covered { first, pieces });
            first += side.nodes().count() - 1;
        }
        sides
    }

    /// The t at which corners of the other edge lie along the normal of a side.
    fn crossings(&self, side: &EdgeSide, first: usize) -> Vec<f64> {
        // Along a straight side the condition is quadratic in t, along a curved one of degree four.
        let steps = if side.middle.is_some() { 16 } else { 4 };
        let stations: Vec<(f64, [f64; 2], [f64; 2])> = (0..=steps)
            .map(|step| {
                let t = f64::from(step) / f64::from(steps);
                (t, side.at(self.nodes, t).0, self.normal(side, first, t))
            })
            .collect();
        let ends = self.other.sides.iter().map(|side| side.ends[1]);
        let corners = std::iter::once(self.other.sides[0].ends[0]).chain(ends);
        let mut found = Vec::new();
        for corner in corners {
            let corner = self.nodes[corner].position;
            let off = |position: [f64; 2], normal: [f64; 2]| {
                (corner[0] - position[0]) * normal[1] - (corner[1] - position[1]) * normal[0]
            };
            for ends in stations.windows(2) {
                let [(mut a, pa, na), (mut b, pb, nb)] = [ends[0], ends[1]];
                let (at_a, at_b) = (off(pa, na), off(pb, nb));
                if at_b == 0.0 || at_a == 0.0 || (at_a > 0.0) == (at_b > 0.0) {
                    found.extend([(at_a, a), (at_b, b)].into_iter().filter(|(off, _)| *off == 0.0).map(|(_, t)| t));
                    continue;
                }
                while b - a > f64::EPSILON {
                    let t = 0.5 * (a + b);
                    let here = off(side.at(self.nodes, t).0, self.normal(side, first, t));
                    if (here > 0.0) == (at_a > 0.0) { a = t } else { b = t }
                }
                found.push(0.5 * (a + b));
            }
        }
        found
    }

    /// The nearest side of the other edge along the normal at t.
    fn opposite(&self, side: &EdgeSide, first: usize, t: f64) -> Option<usize> {
        let (position, normal) = (side.at(self.nodes, t).0, self.normal(side, first, t));
        let hits = self.other.sides.iter().enumerate().filter_map(|(index, other)| {
            let (t, distance) = along(other, self.nodes, position, normal)?;
            let outward = other.outward(other.at(self.nodes, t).1);
            let cosine = (normal[0] * outward[0] + normal[1] * outward[1]) / normal[0].hypot(normal[1]);
            // Behind by more than a side: the two look away from each other.
            let deep = -side.length_to(self.nodes, 1.0).max(other.length_to(self.nodes, 1.0));
            (cosine < -FACING && distance > deep).then_some((index, distance.abs()))
        });
        hits.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(index, _)| index)
    }

    /// Whether each node faces the other edge.
    fn supported(&self, sides: &[Covered]) -> Vec<bool> {
        let mut supported = vec![false; self.edge.nodes.len()];
        for (side, covered) in self.edge.sides.iter().zip(sides) {
            let last = side.nodes().count() - 1;
            for k in 0..=last {
                let t = k as f64 / last as f64;
                let inside = |([a, b], _): &([f64; 2], usize)| a - NEAR <= t && t <= b + NEAR;
                supported[self.first_mention(covered.first + k)] |= covered.pieces.iter().any(inside);
            }
        }
        supported
    }

    /// The partner of each node at which both edges bend, if its sides have other nodes to carry the traction.
    fn corners(&self, sides: &[Covered]) -> Vec<Option<usize>> {
        let mut corners = vec![None; self.edge.nodes.len()];
        let mut before = false;
        for (k, pair) in self.edge.sides.windows(2).enumerate() {
            let node = pair[0].ends[1];
            let [x, y] = self.nodes[node].in_plane();
            let reach = NEAR * pair[0].length_to(self.nodes, 1.0).min(pair[1].length_to(self.nodes, 1.0));
            let partner = self.other.nodes.iter().copied().find(|&other| {
                let [a, b] = self.nodes[other].in_plane();
                (a - x).hypot(b - y) <= reach
            });
            // A straight side between two such corners would be left without functions: it needs none if nothing of the
            // other edge ends on it.
            let left_without = before && pair[0].middle.is_none() && sides[k].pieces.len() > 1;
            let is_corner = bend(&pair[0], &pair[1], self.nodes) > BEND && !left_without;
            corners[sides[k + 1].first] = partner.filter(|_| is_corner);
            before = corners[sides[k + 1].first].is_some();
        }
        corners
    }

    /// The nodes of a side that face the other edge, and its ends between nodes.
    fn places(&self, side: &EdgeSide, covered: &Covered, supported: &[bool]) -> Vec<Place> {
        let last = side.nodes().count() - 1;
        let t = |k: usize| k as f64 / last as f64;
        let row = |k: usize| self.first_mention(covered.first + k);
        let mut places: Vec<Place> =
            (0..=last).filter(|&k| supported[row(k)]).map(|k| Place { t: t(k), row: row(k), is_end: false }).collect();
        let from = covered.pieces.iter().map(|([a, _], _)| *a).fold(1.0, f64::min);
        let to = covered.pieces.iter().map(|([_, b], _)| *b).fold(0.0, f64::max);
        let ends = [(from, (0..=last).rfind(|&k| t(k) < from)), (to, (0..=last).find(|&k| t(k) > to))];
        for (at, beyond) in ends {
            let is_free = |k: &usize| !supported[row(*k)] && places.iter().all(|place| (place.t - at).abs() > BESIDE);
            if let Some(k) = beyond.filter(is_free) {
                places.push(Place { t: at, row: row(k), is_end: true });
            }
        }
        places
    }

    /// Adds the integrals over one side, with the dual functions of the polynomial through `places`.
    fn add_side(&self, side: &EdgeSide, covered: &Covered, mut places: Vec<Place>, rows: &mut [Row]) {
        let mut points = Vec::new();
        for &([a, b], opposite) in &covered.pieces {
            for (x, w) in GAUSS {
                let t = a + (b - a) * x;
                let [dx, dy] = side.at(self.nodes, t).1;
                points.push((t, w * (b - a) * dx.hypot(dy), opposite));
            }
        }
        let size = |places: &[Place], i: usize| -> f64 {
            points.iter().map(|&(t, weight, _)| weight * lagrange(places, i, t)).sum()
        };
        // A pressure must not pull anywhere: where an end comes too near to the node in the middle, that has no function.
        let length: f64 = points.iter().map(|(_, weight, _)| weight).sum();
        if places.len() == 3 && (0..3).any(|i| size(&places, i) <= BESIDE * length) {
            places.sort_by(|a, b| a.t.total_cmp(&b.t));
            places.remove(1);
        }
        let count = places.len();
        if count == 0 {
            return;
        }
        let sizes: Vec<f64> = (0..count).map(|i| size(&places, i)).collect();
        let lagrange = |i: usize, t: f64| lagrange(&places, i, t);
        let mut mass = DMatrix::<f64>::zeros(count, count);
        for &(t, weight, _) in &points {
            for i in 0..count {
                for j in 0..count {
                    mass[(i, j)] += weight * lagrange(i, t) * lagrange(j, t);
                }
            }
        }
        // A Gram matrix of independent polynomials on a stretch of some length.
        let Some(inverse) = mass.try_inverse() else { return };
        let own: Vec<usize> = side.nodes().collect();
        // The shape functions of the side are among the polynomials: ∫ Ψ N is what they are at the place.
        let is_whole = count == own.len();
        for (i, place) in places.iter().enumerate() {
            let row = &mut rows[place.row];
            let at_place = || own.iter().copied().zip(side.shape(place.t).0).filter(|(_, n)| *n != 0.0);
            row.share += sizes[i];
            if place.is_end {
                row.end = Some((at_place().collect(), side.outward(side.at(self.nodes, place.t).1)));
            }
            if is_whole {
                at_place().for_each(|(node, n)| *row.own.entry(node).or_default() += sizes[i] * n);
            }
            for &(t, weight, opposite) in &points {
                let dual: f64 = (0..count).map(|j| sizes[i] * inverse[(i, j)] * lagrange(j, t)).sum();
                if !is_whole {
                    for (n, &node) in side.shape(t).0.iter().zip(&own) {
                        *row.own.entry(node).or_default() += weight * dual * n;
                    }
                }
                let other = &self.other.sides[opposite];
                let (position, normal) = (side.at(self.nodes, t).0, self.normal(side, covered.first, t));
                let at = along(other, self.nodes, position, normal).map_or(0.5, |(t, _)| t);
                for (n, node) in other.shape(at).0.into_iter().zip(other.nodes()) {
                    *row.other.entry(node).or_default() += weight * dual * n;
                }
            }
        }
    }
}

/// The polynomial that is 1 at place i and 0 at the others.
fn lagrange(places: &[Place], i: usize, t: f64) -> f64 {
    let others = places.iter().enumerate().filter(|(k, _)| *k != i);
    others.map(|(_, other)| (t - other.t) / (places[i].t - other.t)).product()
}

/// Where the line through `position` along `normal` meets a side, 0 ≤ t ≤ 1, and how far away (in lengths of `normal`);
/// the nearest if there are two.
fn along(side: &EdgeSide, nodes: &[Node], position: [f64; 2], normal: [f64; 2]) -> Option<(f64, f64)> {
    let off = |node: usize| {
        let [x, y] = nodes[node].in_plane();
        (x - position[0]) * normal[1] - (y - position[1]) * normal[0]
    };
    let [a, b] = side.ends.map(off);
    let roots = match side.middle.map(off) {
        None => [a / (a - b), f64::NAN],
        Some(m) => {
            // a + c₁ t + c₂ t² = 0
            let (c1, c2) = (4.0 * m - 3.0 * a - b, 2.0 * a - 4.0 * m + 2.0 * b);
            let root = (c1 * c1 - 4.0 * c2 * a).sqrt();
            let r = -0.5 * (c1 + c1.signum() * root);
            [r / c2, a / r]
        }
    };
    let length = normal[0].hypot(normal[1]);
    let inside = roots.into_iter().filter(|t| (-1e-9..=1.0 + 1e-9).contains(t)).map(|t| t.clamp(0.0, 1.0));
    let hits = inside.map(|t| {
        let [x, y] = side.at(nodes, t).0;
        (t, ((x - position[0]) * normal[0] + (y - position[1]) * normal[1]) / length)
    });
    hits.min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
}
