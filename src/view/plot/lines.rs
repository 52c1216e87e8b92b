//! The lines and faces of a structure as they are displaced and projected, those behind others apart.

use std::ops::Range;

use super::depth::{Depths, Line, Seen};
use super::skeleton::Skeleton;
use crate::fem::ElasticCurves;
use crate::model::edge::EdgeSide;
use crate::model::pair::Pair;
use crate::model::plate::Plate;
use crate::model::structure::{Element, Structure};
use crate::model::vector::{cross, distance, dot, length, unit, way};
use crate::view::projection::Projection;

/// Lines of a structure: bars (bent as the element bends), outlines of plates and meshes, single elements, sharp edges
/// of solids, hulls of rigid bodies and of the parts of a superelement (a line where all their nodes are on one).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline {
    /// In view.
    pub seen: Vec<Line>,
    /// Behind the faces of solids.
    pub hidden: Vec<Line>,
}

impl Outline {
    /// All of it.
    pub fn all(&self) -> impl Iterator<Item = &Line> {
        self.seen.iter().chain(&self.hidden)
    }
}

/// The inner lines of plates, meshes and the faces of solids: drawn only where there is room.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    /// The lines.
    pub lines: Vec<Line>,
    /// How far they are apart.
    pub pitch: f64,
}

/// A face, or the hull of something.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// Its corners.
    pub corners: Line,
    /// How bright it is, from 0 to 1; 1 in the plane.
    pub light: f64,
}

/// How a structure moves.
#[derive(Clone, Copy, Debug, Default)]
pub struct Move<'a> {
    /// Displacements of the nodes; those beyond the list stay where they are.
    pub u: &'a [[f64; 6]],
    /// Factors of the load cases that bend bars between their nodes; none for a motion that no load belongs to.
    pub factors: &'a [f64],
    /// The factor by which all of it is multiplied.
    pub by: f64,
}

/// A structure displaced and projected.
pub struct Displaced<'a> {
    structure: &'a Structure,
    moved: Move<'a>,
    projection: &'a Projection,
    skeleton: &'a Skeleton,
    depths: Option<Depths>,
}

impl<'a> Displaced<'a> {
    /// Of this motion, seen so; `skeleton` is that of the structure.
    pub fn new(
        (structure, skeleton): (&'a Structure, &'a Skeleton),
        moved: Move<'a>,
        projection: &'a Projection,
    ) -> Displaced<'a> {
        let mut displaced = Displaced { structure, moved, projection, skeleton, depths: None };
        let ring = |face: &Vec<usize>| face.iter().map(|&node| displaced.seen(node)).collect();
        displaced.depths = Depths::of(&skeleton.surface.faces.iter().map(ring).collect::<Vec<_>>());
        displaced
    }

    /// Place of a node in the model, displaced.
    fn place(&self, node: usize) -> [f64; 3] {
        let position = self.structure.nodes.get(node).map_or([0.0; 3], |node| node.position);
        let u = self.moved.u.get(node).copied().unwrap_or_default();
        std::array::from_fn(|c| position[c] + self.moved.by * u[c])
    }

    /// The same with its depth.
    pub fn seen(&self, node: usize) -> Seen {
        self.projection.seen(self.place(node))
    }

    /// Place of a node in the picture, in the unit of the coordinates: to the right and up.
    pub fn at(&self, node: usize) -> (f64, f64) {
        self.projection.flat(self.place(node))
    }

    /// That of a pair.
    pub fn at_pair(&self, pair: &Pair) -> (f64, f64) {
        self.projection.flat(pair.at_place(|node| self.place(node)))
    }

    fn ring(&self, nodes: impl Iterator<Item = usize>) -> Vec<Seen> {
        nodes.map(|node| self.seen(node)).collect()
    }

    /// See [`Outline`].
    pub fn outline(&self) -> Outline {
        let mut outline = Outline::default();
        for line in self.all_lines() {
            match &self.depths {
                Some(depths) => {
                    let [seen, hidden] = depths.split(&line);
                    outline.seen.extend(seen);
                    outline.hidden.extend(hidden);
                }
                None => outline.seen.push(flat(&line)),
            }
        }
        outline
    }

    fn all_lines(&self) -> Vec<Vec<Seen>> {
        let structure = self.structure;
        let Move { u, factors, by } = self.moved;
        let is_bent = by != 0.0 && self.skeleton.bends();
        let curves = is_bent.then(|| ElasticCurves::of(structure, factors));
        let shares = self.skeleton.shares();
        let mut lines = Vec::new();
        let mut single = |elements: Range<usize>| {
            for (index, element) in elements.clone().zip(&structure.elements[elements]) {
                let curve = curves.as_ref().and_then(|curves| curves.places(index, u, &shares));
                if element.shape().is_solid() {
                    // its edges are those of the surface
                } else if let Some(curve) = curve {
                    lines.push(self.bent(element, &shares, &curve));
                } else if !element.shape().is_area() {
                    lines.push(self.ring(element.nodes.iter().copied()));
                } else {
                    lines.push(self.ring(element.ring().chain(element.nodes.first().copied())));
                }
            }
        };
        // what is not a part of a plate or mesh, whose outlines are known
        let plates = structure.plates.iter().map(|plate| &plate.elements);
        let mut bodies: Vec<&Range<usize>> = plates.chain(structure.meshes.iter().map(|mesh| &mesh.elements)).collect();
        bodies.sort_by_key(|elements| elements.start);
        let mut next = 0;
        for elements in bodies {
            single(next..elements.start.max(next));
            next = elements.end.max(next);
        }
        single(next..structure.elements.len());
        let sides = structure.meshes.iter().flat_map(|mesh| &mesh.sides);
        lines.extend(sides.filter(|(_, is_inside)| !is_inside).map(|(side, _)| self.ring(along(side))));
        for plate in &structure.plates {
            let (rows, columns) = plate_lines(plate);
            let ends = |count: usize| [0, count.saturating_sub(1)].into_iter().take(count);
            lines.extend(ends(rows).map(|j| self.ring(plate.nodes[j].iter().copied())));
            lines.extend(ends(columns).map(|i| self.ring(plate.nodes.iter().map(|row| row[i]))));
        }
        lines.extend(structure.rigid.iter().map(|body| hull(self.ring(body.nodes.iter().copied()))));
        for part in structure.superelement.iter().flat_map(|element| &element.parts) {
            lines.push(match along_a_line(structure, &part.nodes) {
                Some(order) => self.ring(order.into_iter().map(|k| part.nodes[k])),
                None => hull(self.ring(part.nodes.iter().copied())),
            });
        }
        let sharp = self.skeleton.surface.edges.iter().filter(|edge| edge.is_sharp);
        lines.extend(sharp.map(|edge| self.ring(edge.nodes.iter().copied())));
        lines
    }

    /// An element bent as its elastic curve: places at shares of its length and how they are displaced.
    fn bent(&self, element: &Element, shares: &[f64], curve: &[[f64; 3]]) -> Vec<Seen> {
        let [p, q] = [0, 1].map(|end| self.structure.nodes[element.nodes[end]].position);
        let place =
            |(t, u): (&f64, &[f64; 3])| std::array::from_fn(|c| p[c] + t * (q[c] - p[c]) + self.moved.by * u[c]);
        shares.iter().zip(curve).map(|at| self.projection.seen(place(at))).collect()
    }

    /// See [`Grid`]; its lines are left out where they are nearer than `least`.
    pub fn grid(&self, least: f64) -> Grid {
        if self.depths.is_none() && self.skeleton.pitch < least {
            return Grid { lines: Vec::new(), pitch: self.skeleton.pitch };
        }
        let sides = self.structure.meshes.iter().flat_map(|mesh| &mesh.sides);
        let sides = sides.filter(|(_, is_inside)| *is_inside);
        let mut lines: Vec<Line> = sides.map(|(side, _)| flat(&self.ring(along(side)))).collect();
        for plate in &self.structure.plates {
            let (rows, columns) = plate_lines(plate);
            let row = |j: usize| self.ring(plate.nodes[j].iter().copied());
            let column = |i: usize| self.ring(plate.nodes.iter().map(|row| row[i]));
            lines.extend((1..rows.saturating_sub(1)).map(|j| flat(&row(j))));
            lines.extend((1..columns.saturating_sub(1)).map(|i| flat(&column(i))));
        }
        let mut pitch = self.skeleton.pitch;
        if let Some(depths) = &self.depths {
            let inner = self.skeleton.surface.edges.iter().filter(|edge| !edge.is_sharp);
            let [seen, _] = inner.fold([Vec::new(), Vec::new()], |[mut seen, hidden], edge| {
                seen.extend(depths.split(&self.ring(edge.nodes.iter().copied()))[0].iter().cloned());
                [seen, hidden]
            });
            let mut lengths: Vec<f64> = seen.iter().filter_map(|line: &Line| extent(line)).collect();
            let middle = lengths.len() / 2;
            if middle > 0 {
                pitch = pitch.min(*lengths.select_nth_unstable_by(middle, f64::total_cmp).1);
            }
            lines.extend(seen);
        }
        Grid { lines, pitch }
    }

    /// Membranes, the faces of solids that look to the viewer, hulls; the far ones first.
    pub fn faces(&self) -> Vec<Face> {
        let structure = self.structure;
        let areas = structure.elements.iter().filter(|element| element.shape().is_area());
        let mut faces: Vec<Vec<Seen>> = areas.map(|element| self.ring(element.ring())).collect();
        let parts = structure.superelement.iter().flat_map(|element| &element.parts);
        let wide = parts.map(|part| &part.nodes).filter(|nodes| along_a_line(structure, nodes).is_none());
        for nodes in structure.rigid.iter().map(|body| &body.nodes).chain(wide) {
            let mut ring = hull(self.ring(nodes.iter().copied()));
            ring.pop();
            faces.push(ring);
        }
        let mut lit: Vec<(f64, Face)> = Vec::new();
        for face in &self.skeleton.surface.faces {
            let ring = self.ring(face.iter().copied());
            let normal = normal(&ring);
            if normal[2] > EDGE_ON {
                let depth = ring.iter().map(|point| point[2]).sum::<f64>() / ring.len() as f64;
                lit.push((depth, Face { corners: flat(&ring), light: 0.5 + 0.5 * dot(normal, LIGHT).max(0.0) }));
            }
        }
        lit.sort_by(|a, b| a.0.total_cmp(&b.0));
        let plain = faces.iter().map(|ring| Face { corners: flat(ring), light: 1.0 });
        plain.chain(lit.into_iter().map(|(_, face)| face)).collect()
    }

    /// Whether a node lies behind faces.
    pub fn hides(&self, node: usize) -> bool {
        self.depths.as_ref().is_some_and(|depths| depths.hides(self.seen(node)))
    }
}

/// The largest displacement of nodes and of places between them; `skeleton` is that of the structure.
pub fn largest_displacement(structure: &Structure, skeleton: &Skeleton, factors: &[f64], u: &[[f64; 6]]) -> f64 {
    let curves = skeleton.bends().then(|| ElasticCurves::of(structure, factors));
    let shares = skeleton.shares();
    let bars = structure.elements.iter().enumerate().filter(|(_, element)| element.bends());
    let between =
        curves.iter().flat_map(|curves| bars.clone().filter_map(|(index, _)| curves.places(index, u, &shares)));
    let between = between.flatten();
    let nodes = u.iter().map(|&[x, y, z, ..]| length([x, y, z]));
    nodes.chain(between.map(length)).fold(0.0, f64::max)
}

/// Faces that turn to the viewer by less than this are seen from their side.
const EDGE_ON: f64 = 1e-3;
/// Where the light of a picture comes from: over the left shoulder of the viewer.
const LIGHT: [f64; 3] = [-0.36, 0.8, 0.48];

/// Unit normal of a ring, to the side from which it goes round counter-clockwise.
fn normal(ring: &[Seen]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for k in 1..ring.len().saturating_sub(1) {
        let part = cross(way(ring[0], ring[k]), way(ring[0], ring[k + 1]));
        sum = std::array::from_fn(|c| sum[c] + part[c]);
    }
    unit(sum).unwrap_or_default()
}

fn flat(line: &[Seen]) -> Line {
    line.iter().map(|&[x, y, _]| (x, y)).collect()
}

/// From end to end of a line.
fn extent(line: &Line) -> Option<f64> {
    let (a, b) = (line.first()?, line.last()?);
    Some((b.0 - a.0).hypot(b.1 - a.1))
}

/// Nodes of a side of a mesh, from end to end.
fn along(side: &EdgeSide) -> impl Iterator<Item = usize> + use<> {
    let [a, b] = side.ends;
    [Some(a), side.middle, Some(b)].into_iter().flatten()
}

/// How many rows of nodes a plate has, and how many columns.
fn plate_lines(plate: &Plate) -> (usize, usize) {
    (plate.nodes.len(), plate.nodes.iter().map(Vec::len).min().unwrap_or(0))
}

/// The order of nodes along the line on which they all lie; `None` if they do not.
fn along_a_line(structure: &Structure, nodes: &[usize]) -> Option<Vec<usize>> {
    let places: Vec<[f64; 3]> = nodes.iter().map(|&node| structure.nodes[node].position).collect();
    straight_order(&places)
}

/// The order of places along the line on which they all lie; `None` if they do not.
pub fn straight_order(places: &[[f64; 3]]) -> Option<Vec<usize>> {
    let far = |from: [f64; 3]| {
        let away = |place: &[f64; 3]| distance(from, *place);
        places.iter().copied().max_by(|a, b| away(a).total_cmp(&away(b)))
    };
    let first = far(places.first().copied()?)?;
    let last = far(first)?;
    let whole = way(first, last);
    let size = length(whole);
    if places.iter().any(|&place| length(cross(way(first, place), whole)) > 1e-9 * size * size) {
        return None;
    }
    let along = |k: usize| dot(way(first, places[k]), whole);
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.sort_by(|a, b| along(*a).total_cmp(&along(*b)));
    Some(order)
}

/// Convex hull in the picture as a closed line (Andrew's monotone chain).
fn hull(mut points: Vec<Seen>) -> Vec<Seen> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut ring: Vec<Seen> = Vec::new();
    for way in [points.clone(), points.into_iter().rev().collect()] {
        // The way back begins where the way there ended.
        ring.pop();
        let from = ring.len();
        for point in way {
            let turns_right = |ring: &[Seen]| match ring[from..] {
                [.., a, b] => (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]) <= 0.0,
                _ => false,
            };
            while turns_right(&ring) {
                ring.pop();
            }
            ring.push(point);
        }
    }
    ring
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::structure::Dimension;

    /// A square with points on its sides and inside, and three points on a line.
    #[test]
    fn hulls_are_closed_and_have_no_more_than_the_corners() {
        let of = |points: &[(f64, f64)]| flat(&hull(points.iter().map(|&(x, y)| [x, y, 0.0]).collect()));
        let square = [(0.0, 0.0), (1.0, 1.0), (0.5, 0.0), (0.0, 1.0), (0.5, 0.4), (1.0, 0.0), (1.0, 0.5)];
        assert_eq!(of(&square), [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)]);
        let line = [(2.0, 2.0), (0.0, 0.0), (1.0, 1.0)];
        assert_eq!(of(&line), [(0.0, 0.0), (2.0, 2.0), (0.0, 0.0)]);
        assert_eq!(of(&[(1.0, 1.0), (1.0, 1.0)]).first(), Some(&(1.0, 1.0)));
    }

    use crate::view::projection::Viewpoint;
    use crate::view::tests::sample::block;

    fn view(name: &str) -> Projection {
        Projection::new(Dimension::Space, Viewpoint::named(name).unwrap())
    }

    /// A cube of eight bricks shows three of its sides and nine of its edges in the isometric view, and hides three
    /// edges; along an axis it shows one side.
    #[test]
    fn a_cube_shows_three_sides_and_hides_three_edges() {
        let cube = block([2, 2, 2], [1.0; 3]);
        let projection = view("ISO");
        let skeleton = Skeleton::of(&cube);
        let of_cube = (&cube, &skeleton);
        let displaced = Displaced::new(of_cube, Move::default(), &projection);
        // four faces of elements on each side
        let faces = displaced.faces();
        assert_eq!(faces.len(), 3 * 4);
        let lights: std::collections::BTreeSet<u64> = faces.iter().map(|face| (face.light * 1e9) as u64).collect();
        assert_eq!(lights.len(), 3, "each side has its own light");
        let length = |lines: &[Line]| lines.iter().filter_map(extent).sum::<f64>();
        let outline = displaced.outline();
        let edge = (2.0_f64 / 3.0).sqrt();
        // the raster tells seen from hidden within a few of its cells
        assert!((length(&outline.seen) - 9.0 * edge).abs() < 0.1, "{}", length(&outline.seen));
        assert!((length(&outline.hidden) - 3.0 * edge).abs() < 0.1, "{}", length(&outline.hidden));
        // two lines of one half of an edge on each of the three sides seen, both ways
        let grid = displaced.grid(0.0);
        assert!((length(&grid.lines) - 3.0 * 2.0 * edge).abs() < 0.1, "{}", length(&grid.lines));
        assert!((grid.pitch - 0.5 * edge).abs() < 1e-9);
        for name in ["XY", "XZ", "YZ"] {
            let projection = view(name);
            assert_eq!(Displaced::new(of_cube, Move::default(), &projection).faces().len(), 4, "{name}");
        }
        // the nodes below are hidden but for those on the edges seen
        let hidden = (0..cube.nodes.len()).filter(|&node| displaced.hides(node));
        let is_behind = |node: usize| {
            let [x, y, z] = cube.nodes[node].position;
            // seen from +x, −y, +z
            x < 0.99 && y > 0.01 && z < 0.99
        };
        for node in hidden {
            assert!(is_behind(node), "{:?}", cube.nodes[node]);
        }
        let middle = cube.nodes.iter().position(|node| node.position == [0.5, 0.5, 0.0]).unwrap();
        assert!(displaced.hides(middle));
    }

    /// A column before a wall hides a part of it; behind the wall it is hidden itself.
    #[test]
    fn what_stands_behind_is_hidden() {
        let mut wall = block([1, 1, 1], [4.0, 1.0, 4.0]);
        let first = wall.nodes.len();
        for (id, position) in [("a", [2.0, 3.0, 0.0]), ("b", [2.0, 3.0, 6.0])] {
            wall.nodes.push(crate::model::structure::Node { id: id.into(), position });
        }
        let nodes = vec![first, first + 1];
        let kind = crate::model::structure::ElementKind::Truss { area: 1.0 };
        wall.elements.push(Element { nodes, material: 0, kind });
        // seen from −y the wall, 4 high, stands before the column of 6
        let projection = view("XZ");
        let skeleton = Skeleton::of(&wall);
        let outline = Displaced::new((&wall, &skeleton), Move::default(), &projection).outline();
        let upright = |lines: &[Line]| {
            let middle = lines.iter().filter(|line| line.iter().all(|(x, _)| (x - 2.0).abs() < 1e-9));
            middle.filter_map(extent).sum::<f64>()
        };
        assert!((upright(&outline.seen) - 2.0).abs() < 0.05, "{}", upright(&outline.seen));
        assert!((upright(&outline.hidden) - 4.0).abs() < 0.05);
        // from the other side it stands before the wall
        let projection = Projection::new(Dimension::Space, Viewpoint::new(90.0, 0.0).unwrap());
        let outline = Displaced::new((&wall, &skeleton), Move::default(), &projection).outline();
        assert!(outline.hidden.iter().all(|line| line.iter().any(|(x, _)| (x + 2.0).abs() > 1e-9)));
    }
}
