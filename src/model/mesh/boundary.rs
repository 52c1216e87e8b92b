//! Edges of a mesh: what its groups are as chains of element sides, and its outer boundary by direction.
//!
//! Nodes and elements of these edges are indices into the mesh.

use std::cell::OnceCell;
use std::collections::{HashMap, HashSet};
use std::ops::Deref;

use super::chain::{chains, oriented, signed_area};
use super::facing::Facing;
use super::{Group, Members, Mesh, MeshElement};
use crate::model::edge::{ChainError, Edge, EdgeSide, Sides};

/// Why a group is not one edge. Nodes are indices into the mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EdgeFault {
    /// It has no side of an element.
    Empty,
    /// A line, or the segment between two nodes, that is not a side of an element.
    NoSide([usize; 2], Option<u32>),
    /// A side that two elements share.
    Inside([usize; 2], Option<u32>),
    /// The middle node of a quadratic side of which only one half is in the group.
    HalfSide(usize),
    /// The middle node of a quadratic side that a set leaves out, though it has both corners.
    WithoutMiddle(usize),
    /// A node at which more than two sides meet.
    Branch(usize),
    /// The number of pieces, and the first node of two of them.
    Pieces(usize, [usize; 2]),
    /// The node at which the body changes from one side to the other.
    Turns(usize),
    /// Its members are not a boundary: points, or elements.
    NoEdge,
}

/// The directions by which a boundary without groups is named: by its outward normal.
const DIRECTIONS: [&str; 4] = ["bottom", "top", "left", "right"];

/// The sides of a mesh, and the edges found among them.
pub struct Boundary<M> {
    mesh: M,
    sides: Sides,
    /// The sides of one element only.
    outer: OnceCell<Vec<EdgeSide>>,
    facing: OnceCell<Vec<Facing<Edge>>>,
}

fn usizes(nodes: &[u32]) -> Vec<usize> {
    nodes.iter().map(|node| *node as usize).collect()
}

impl<M: Deref<Target = Mesh>> Boundary<M> {
    /// The boundary of a mesh.
    pub fn of(mesh: M) -> Self {
        let mut sides = Sides::default();
        let areas = mesh.of_bodies().filter(|index| mesh.elements[*index as usize].shape.is_area());
        for index in areas {
            let element = &mesh.elements[index as usize];
            sides.add(index as usize, element.shape.corners(), &usizes(&element.nodes));
        }
        Boundary { mesh, sides, outer: OnceCell::new(), facing: OnceCell::new() }
    }

    fn outer(&self) -> &[EdgeSide] {
        self.outer.get_or_init(|| self.sides.boundary())
    }

    fn position(&self, node: usize) -> [f64; 2] {
        self.mesh.position(node as u32)
    }

    /// The edge that a group is.
    ///
    /// # Errors
    /// See [`EdgeFault`].
    pub fn edge(&self, group: &Group) -> Result<Edge, EdgeFault> {
        let corners = match &group.members {
            Members::Lines(lines) => self.of_lines(lines)?,
            Members::Sides(sides) => self.of_sides(sides)?,
            Members::NodeSet(nodes) => self.of_nodes(nodes)?,
            Members::Points(_) | Members::Areas(_) | Members::Solids(_) => return Err(EdgeFault::NoEdge),
        };
        self.one_edge(corners)
    }

    fn one_edge(&self, corners: Vec<[usize; 2]>) -> Result<Edge, EdgeFault> {
        let mut seen = HashSet::with_capacity(corners.len());
        let corners: Vec<[usize; 2]> =
            corners.into_iter().filter(|[a, b]| seen.insert((*a.min(b), *a.max(b)))).collect();
        let mut pieces = chains(&corners).map_err(EdgeFault::Branch)?;
        match pieces.len() {
            0 => return Err(EdgeFault::Empty),
            1 => {}
            count => return Err(EdgeFault::Pieces(count, [pieces[0][0], pieces[1][0]])),
        }
        let chain = oriented(pieces.swap_remove(0), &|node| self.position(node));
        self.sides.chain(&chain).map_err(|error| match error {
            ChainError::TooShort => EdgeFault::Empty,
            ChainError::NoSide(ends) => EdgeFault::NoSide(ends, None),
            ChainError::Inside(ends) => EdgeFault::Inside(ends, None),
            ChainError::Turns(node) => EdgeFault::Turns(node),
        })
    }

    /// Corners of the sides that lines lie on. Two lines may be the halves of a quadratic side.
    fn of_lines(&self, lines: &[u32]) -> Result<Vec<[usize; 2]>, EdgeFault> {
        let mut corners = Vec::with_capacity(lines.len());
        // Corners by which each middle node is reached.
        let mut halves: HashMap<usize, Vec<usize>> = HashMap::new();
        for &line in lines {
            let nodes = usizes(&self.mesh.elements[line as usize].nodes);
            let ends = [nodes[0], nodes[1]];
            let half = [ends, [ends[1], ends[0]]].into_iter().find(|[corner, middle]| {
                nodes.len() == 2 && self.sides.with_middle(*middle).is_some_and(|side| side.contains(corner))
            });
            if let Some([corner, middle]) = half {
                let reached = halves.entry(middle).or_default();
                if !reached.contains(&corner) {
                    reached.push(corner);
                }
                if let [a, b] = reached[..] {
                    corners.push([a, b]);
                }
                continue;
            }
            let side = match self.sides.at(ends) {
                [] => return Err(EdgeFault::NoSide(ends, Some(line))),
                [side] => side,
                _ => return Err(EdgeFault::Inside(ends, Some(line))),
            };
            if nodes.get(2).is_some_and(|middle| side.middle != Some(*middle)) {
                return Err(EdgeFault::NoSide(ends, Some(line)));
            }
            corners.push(ends);
        }
        match halves.iter().filter(|(_, reached)| reached.len() == 1).map(|(middle, _)| *middle).min() {
            Some(middle) => Err(EdgeFault::HalfSide(middle)),
            None => Ok(corners),
        }
    }

    fn of_sides(&self, sides: &[(u32, Option<u8>)]) -> Result<Vec<[usize; 2]>, EdgeFault> {
        let mut corners = Vec::with_capacity(sides.len());
        for &(index, corner) in sides {
            let all = side_corners(&self.mesh.elements[index as usize]);
            match corner {
                Some(corner) => {
                    let ends = all[corner as usize];
                    if self.sides.at(ends).len() > 1 {
                        return Err(EdgeFault::Inside(ends, None));
                    }
                    corners.push(ends);
                }
                None => corners.extend(all.into_iter().filter(|ends| self.sides.at(*ends).len() == 1)),
            }
        }
        Ok(corners)
    }

    /// Nodes of the sides that a surface names, whatever they make together.
    pub fn nodes_of_sides(&self, group: &Group) -> Vec<u32> {
        let Members::Sides(sides) = &group.members else { return Vec::new() };
        let corners = self.of_sides(sides).unwrap_or_default();
        let side = |ends: [usize; 2]| self.sides.at(ends).first().and_then(|side| side.middle);
        corners
            .into_iter()
            .flat_map(|ends| [Some(ends[0]), side(ends), Some(ends[1])])
            .flatten()
            .map(|n| n as u32)
            .collect()
    }

    /// Corners of the boundary sides with all their nodes in a set.
    fn of_nodes(&self, nodes: &[u32]) -> Result<Vec<[usize; 2]>, EdgeFault> {
        let set: HashSet<usize> = nodes.iter().map(|node| *node as usize).collect();
        let boundary = self.outer();
        let half = boundary.iter().filter_map(|side| {
            let corners = side.ends.iter().filter(|end| set.contains(end)).count();
            side.middle.filter(|middle| set.contains(middle) && corners < 2)
        });
        if let Some(middle) = half.min() {
            return Err(EdgeFault::HalfSide(middle));
        }
        let whole: Vec<_> = boundary.iter().filter(|side| side.ends.iter().all(|end| set.contains(end))).collect();
        match whole.iter().filter_map(|side| side.middle).filter(|middle| !set.contains(middle)).min() {
            Some(middle) => Err(EdgeFault::WithoutMiddle(middle)),
            None => Ok(whole.into_iter().map(|side| side.ends).collect()),
        }
    }

    /// The pieces of the outer boundary (holes have none) by the direction of their outward normals, those of one
    /// direction from left to right, then from below.
    pub fn facing(&self) -> &[Facing<Edge>] {
        self.facing.get_or_init(|| self.find_facing())
    }

    fn find_facing(&self) -> Vec<Facing<Edge>> {
        let mut found: [Vec<Edge>; DIRECTIONS.len()] = Default::default();
        for ring in self.outer_rings() {
            let directions: Vec<usize> = ring.iter().map(|side| self.direction(side)).collect();
            let n = ring.len();
            // A ring turns all the way round, so it has such a place.
            let Some(start) = (0..n).find(|k| directions[*k] != directions[(*k + n - 1) % n]) else { continue };
            let mut run: Vec<usize> = Vec::new();
            for k in 0..n {
                let (here, next) = ((start + k) % n, (start + k + 1) % n);
                if run.is_empty() {
                    run.push(ring[here].ends[0]);
                }
                run.push(ring[here].ends[1]);
                if k + 1 == n || directions[next] != directions[here] {
                    let corners = oriented(std::mem::take(&mut run), &|node| self.position(node));
                    if let Ok(edge) = self.sides.chain(&corners) {
                        found[directions[here]].push(edge);
                    }
                }
            }
        }
        let start = |edge: &Edge| self.position(edge.nodes[0]);
        let in_order = |mut edges: Vec<Edge>| {
            edges.sort_by(|a, b| {
                let ([ax, ay], [bx, by]) = (start(a), start(b));
                ax.total_cmp(&bx).then(ay.total_cmp(&by))
            });
            edges
        };
        DIRECTIONS.into_iter().zip(found).flat_map(|(word, edges)| Facing::named(word, in_order(edges))).collect()
    }

    /// Where a side in the sense of its element looks; at 45° up or down.
    fn direction(&self, side: &EdgeSide) -> usize {
        let [a, b] = side.ends.map(|node| self.position(node));
        // Outward is to the right.
        let [nx, ny] = [b[1] - a[1], a[0] - b[0]];
        if ny.abs() >= nx.abs() * (1.0 - 1e-9) { usize::from(ny > 0.0) } else { 2 + usize::from(nx > 0.0) }
    }

    /// Rings of boundary sides, each in the sense of its element, that have their body inside.
    fn outer_rings(&self) -> Vec<Vec<EdgeSide>> {
        let boundary = self.outer();
        let mut from: HashMap<usize, Vec<usize>> = HashMap::with_capacity(boundary.len());
        for (index, side) in boundary.iter().enumerate() {
            from.entry(side.ends[0]).or_default().push(index);
        }
        let mut used = vec![false; boundary.len()];
        let mut rings = Vec::new();
        for first in 0..boundary.len() {
            let (mut ring, mut next) = (Vec::new(), Some(first));
            while let Some(index) = next.filter(|index| !used[*index]) {
                used[index] = true;
                ring.push(boundary[index]);
                let onward = from.get(&boundary[index].ends[1]).into_iter().flatten().copied();
                let free = onward.filter(|other| !used[*other]);
                next = free.min_by(|a, b| {
                    let inner = |other: &usize| self.inner_angle(&boundary[index], &boundary[*other]);
                    inner(a).total_cmp(&inner(b))
                });
            }
            let corners: Vec<[f64; 2]> = ring.iter().map(|side| self.position(side.ends[0])).collect();
            if signed_area(&corners) > 0.0 {
                rings.push(ring);
            }
        }
        rings
    }

    /// Angle within the body from one side to the next; where bodies touch at a node the least one stays with its own.
    fn inner_angle(&self, before: &EdgeSide, after: &EdgeSide) -> f64 {
        let angle = |from: usize, to: usize| {
            let (a, b) = (self.position(from), self.position(to));
            (b[1] - a[1]).atan2(b[0] - a[0])
        };
        let back = angle(before.ends[1], before.ends[0]);
        (back - angle(after.ends[0], after.ends[1])).rem_euclid(std::f64::consts::TAU)
    }

    /// What is wrong with a group as an edge, and what to do.
    pub fn words(&self, group: &Group, fault: &EdgeFault) -> (String, String) {
        let mesh = &*self.mesh;
        let tag = |node: usize| mesh.nodes[node].tag;
        let what = |ends: &[usize; 2], line: &Option<u32>| match line {
            Some(line) => {
                let line = &mesh.elements[*line as usize];
                format!("its line {} ({})", line.tag, mesh.at(line.place))
            }
            None => format!("its segment between the nodes {} and {}", tag(ends[0]), tag(ends[1])),
        };
        let split = "make a group of its own of each piece";
        let (why, help) = match fault {
            EdgeFault::Empty => ("has no side of an element on the boundary".into(), "name another group"),
            EdgeFault::NoSide(ends, line) => (
                format!("is not an edge: {} is not a side of an element", what(ends, line)),
                "lines of an edge lie on the boundary and have the nodes of its elements",
            ),
            EdgeFault::Inside(ends, line) => (
                format!("lies inside a body: {} has elements on both sides", what(ends, line)),
                "an edge is on the outside; to cut a body give each part nodes of its own",
            ),
            EdgeFault::HalfSide(middle) => (
                format!(
                    "has half a quadratic edge: it ends at node {}, in the middle of an element side",
                    tag(*middle)
                ),
                "end it at a corner of an element",
            ),
            EdgeFault::WithoutMiddle(middle) => (
                format!(
                    "has half a quadratic edge: both ends of an element side, but not node {} in its middle",
                    tag(*middle)
                ),
                "put the middle nodes into the set, too",
            ),
            EdgeFault::Branch(node) => (format!("branches at node {}", tag(*node)), split),
            EdgeFault::Pieces(count, [a, b]) => (
                format!(
                    "is in {count} pieces, one at node {}, another at node {}, where one edge is asked for",
                    tag(*a),
                    tag(*b)
                ),
                split,
            ),
            EdgeFault::Turns(node) => {
                (format!("changes from one side of the body to the other at node {}", tag(*node)), split)
            }
            EdgeFault::NoEdge => {
                (format!("consists of {} and is not an edge", group.members.what()), "name a group of lines")
            }
        };
        (format!("the group \"{}\" ({}) {why}", group.name, mesh.at(group.place)), help.into())
    }
}

/// Corners of the sides of an area in its sense.
fn side_corners(element: &MeshElement) -> Vec<[usize; 2]> {
    let n = element.shape.corners();
    (0..n).map(|k| [element.nodes[k] as usize, element.nodes[(k + 1) % n] as usize]).collect()
}
