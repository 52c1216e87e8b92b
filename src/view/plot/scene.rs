//! What a picture of a structure shows, in the coordinates of the model: drawn with characters by `structure`, as SVG
//! by `view::svg`.

use std::collections::HashMap;
use std::ops::Range;

use super::loads::Loads;
use super::ticks::range;
use super::{Series, diagram};
use crate::answer::diagram::Internal;
use crate::answer::record::{MemberForces, NodeDisplacement, PairState, State};
use crate::answer::rounding::largest;
use crate::fem::ElasticCurves;
use crate::model::edge::EdgeSide;
use crate::model::pair::Pair;
use crate::model::parameter::ParameterValues;
use crate::model::plate::Plate;
use crate::model::structure::{Bar, Element, Node, Structure};
use crate::text::number::short;

/// By how much displacements are enlarged.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Magnification {
    /// So that the largest one is about a tenth of the model.
    #[default]
    Auto,
    /// By this factor.
    Factor(f64),
}

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    /// Title.
    pub title: &'a str,
    /// The structure.
    pub structure: &'a Structure,
    /// Its displacements; the undeformed shape is drawn dotted beside the deformed one.
    pub displacements: Option<&'a [NodeDisplacement]>,
    /// Factors of the load cases under which it is displaced, which bend bars between their nodes; none of a motion.
    pub factors: &'a [f64],
    /// States of its contact pairs, in the order of the structure; without them the pairs are marked as such.
    pub pairs: Option<&'a [PairState]>,
    /// Magnification of the displacements.
    pub magnification: Magnification,
    /// Most rows of the drawing; a flat structure takes fewer.
    pub height: usize,
}

/// The largest ordinate of a diagram as a share of the model.
const ORDINATE: f64 = 0.125;
/// Straight pieces of a bent frame element where there are many of them, and where there are few.
const PIECES: [usize; 2] = [8, 32];
/// So many pieces of all bent elements are enough: the more elements, the fewer pieces of each.
const ALL_PIECES: usize = 512;

/// u of every node of the structure, 0 where the list has no such node.
pub fn nodal(structure: &Structure, displacements: &[NodeDisplacement]) -> Vec<[f64; 6]> {
    let finite = |u: &NodeDisplacement| [u.ux, u.uy, 0.0, 0.0, 0.0, u.rz].map(|u| if u.is_finite() { u } else { 0.0 });
    let nodes = &structure.nodes;
    if nodes.len() == displacements.len() && nodes.iter().zip(displacements).all(|(node, u)| node.id == u.node) {
        return displacements.iter().map(finite).collect();
    }
    let by_id: HashMap<&str, &NodeDisplacement> = displacements.iter().map(|node| (node.node.as_str(), node)).collect();
    nodes.iter().map(|node| by_id.get(node.id.as_str()).map_or([0.0; 6], |u| finite(u))).collect()
}

/// The factor by which displacements are drawn: the one asked for, or 1, 2 or 5 × 10^k so that the largest, between the
/// nodes too, becomes at most a tenth of the model's larger side; 1 where nothing moves. `factors`: see [`Picture`].
pub fn factor(structure: &Structure, factors: &[f64], u: &[[f64; 6]], magnification: Magnification) -> f64 {
    if let Magnification::Factor(factor) = magnification {
        return if factor.is_finite() { factor } else { 1.0 };
    }
    let side = |axis: usize| {
        let (low, high) = range(structure.nodes.iter().map(|node| node.position[axis]));
        (high - low).max(0.0)
    };
    let size = side(0).max(side(1));
    let rough = 0.1 * size / largest_displacement(structure, factors, u);
    if !(rough.is_finite() && rough > 0.0) {
        return 1.0;
    }
    let power = 10f64.powi(rough.log10().floor() as i32);
    let nice = [5.0, 2.0, 1.0].into_iter().map(|digit| digit * power).find(|nice| *nice <= rough).unwrap_or(power);
    if nice.is_finite() && nice > 0.0 { nice } else { 1.0 }
}

/// The largest displacement of nodes and of places between them.
fn largest_displacement(structure: &Structure, factors: &[f64], u: &[[f64; 6]]) -> f64 {
    let curves = ElasticCurves::of(structure, factors);
    let shares = shares(structure);
    let bars = structure.elements.iter().enumerate().filter(|(_, element)| element.bends());
    let between = bars.filter_map(|(index, _)| curves.places(index, u, &shares)).flatten();
    let nodes = u.iter().map(|u| u[0].hypot(u[1]));
    nodes.chain(between.map(|u| u[0].hypot(u[1]))).fold(0.0, f64::max)
}

/// Where the elastic curve of a bar is drawn through, as shares of its length.
fn shares(structure: &Structure) -> Vec<f64> {
    let [many, few] = PIECES;
    let bending = structure.elements.iter().filter(|element| element.bends()).count();
    let pieces = (ALL_PIECES / bending.max(1)).clamp(many, few);
    (0..=pieces).map(|i| i as f64 / pieces as f64).collect()
}

/// Lines of the structure in the plane, displaced by `factor` × u: bars (bent as the element bends), plate outlines,
/// single quads, hulls of rigid bodies and of the parts of a superelement (those along a line as it); plate grids apart, because they are drawn only where there is room.
#[derive(Clone, Debug)]
pub struct Lines {
    /// Bars, outlines, quads.
    pub outline: Vec<Vec<(f64, f64)>>,
    /// Inner grid lines of the plates.
    pub grid: Vec<Vec<(f64, f64)>>,
    /// Corners of the membranes and of the hulls.
    pub faces: Vec<Vec<(f64, f64)>>,
}

/// Place of a node displaced by `factor` × u.
fn displaced(structure: &Structure, u: &[[f64; 6]], factor: f64) -> impl Fn(usize) -> (f64, f64) {
    move |node| {
        let position = structure.nodes.get(node).map_or([0.0; 2], Node::in_plane);
        let u = u.get(node).copied().unwrap_or_default();
        (position[0] + factor * u[0], position[1] + factor * u[1])
    }
}

/// See [`Lines`].
fn lines(structure: &Structure, factors: &[f64], u: &[[f64; 6]], factor: f64) -> Lines {
    Lines {
        outline: outline(structure, factors, u, factor),
        grid: grid(structure, u, factor),
        faces: faces(structure, u, factor),
    }
}

/// [`Lines::outline`]; `factors`: see [`Picture`].
pub fn outline(structure: &Structure, factors: &[f64], u: &[[f64; 6]], factor: f64) -> Vec<Vec<(f64, f64)>> {
    let curves = ElasticCurves::of(structure, factors);
    let at = displaced(structure, u, factor);
    let shares = shares(structure);
    let mut outline = Vec::new();
    let mut single = |elements: Range<usize>| {
        for (index, element) in elements.clone().zip(&structure.elements[elements]) {
            let curve = if factor == 0.0 { None } else { curves.places(index, u, &shares) };
            if let Some(curve) = curve {
                outline.push(bent(structure, element, &shares, &curve, factor));
            } else if !element.shape().is_area() {
                outline.push(element.nodes.iter().map(|&node| at(node)).collect());
            } else {
                let ring = element.ring().chain(element.nodes.first().copied());
                outline.push(ring.map(&at).collect());
            }
        }
    };
    // what is no part of a plate or mesh, whose outlines are known
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
    outline.extend(sides.filter(|(_, is_inside)| !is_inside).map(|(side, _)| side_line(side, &at)));
    for plate in &structure.plates {
        let (rows, columns) = plate_lines(plate);
        let ends = |count: usize| [0, count.saturating_sub(1)].into_iter().take(count);
        outline.extend(ends(rows).map(|j| plate.nodes[j].iter().map(|&node| at(node)).collect()));
        outline.extend(ends(columns).map(|i| plate.nodes.iter().map(|row| at(row[i])).collect()));
    }
    outline.extend(structure.rigid.iter().map(|body| hull(body.nodes.iter().map(|&node| at(node)).collect())));
    for part in structure.superelement.iter().flat_map(|element| &element.parts) {
        outline.push(match along_a_line(structure, &part.nodes) {
            Some(order) => order.into_iter().map(|k| at(part.nodes[k])).collect(),
            None => hull(part.nodes.iter().map(|&node| at(node)).collect()),
        });
    }
    outline
}

/// [`Lines::grid`].
pub fn grid(structure: &Structure, u: &[[f64; 6]], factor: f64) -> Vec<Vec<(f64, f64)>> {
    let at = displaced(structure, u, factor);
    let sides = structure.meshes.iter().flat_map(|mesh| &mesh.sides);
    let mut grid: Vec<_> = sides.filter(|(_, is_inside)| *is_inside).map(|(side, _)| side_line(side, &at)).collect();
    for plate in &structure.plates {
        let (rows, columns) = plate_lines(plate);
        grid.extend((1..rows.saturating_sub(1)).map(|j| plate.nodes[j].iter().map(|&node| at(node)).collect()));
        grid.extend((1..columns.saturating_sub(1)).map(|i| plate.nodes.iter().map(|row| at(row[i])).collect()));
    }
    grid
}

/// [`Lines::faces`].
fn faces(structure: &Structure, u: &[[f64; 6]], factor: f64) -> Vec<Vec<(f64, f64)>> {
    let at = displaced(structure, u, factor);
    let areas = structure.elements.iter().filter(|element| element.shape().is_area());
    let mut faces: Vec<Vec<(f64, f64)>> = areas.map(|element| element.ring().map(&at).collect()).collect();
    let parts = structure.superelement.iter().flat_map(|element| &element.parts);
    let wide = parts.map(|part| &part.nodes).filter(|nodes| along_a_line(structure, nodes).is_none());
    for nodes in structure.rigid.iter().map(|body| &body.nodes).chain(wide) {
        let mut ring = hull(nodes.iter().map(|&node| at(node)).collect());
        ring.pop();
        faces.push(ring);
    }
    faces
}

/// A side of a mesh.
fn side_line(side: &EdgeSide, at: &impl Fn(usize) -> (f64, f64)) -> Vec<(f64, f64)> {
    let [a, b] = side.ends;
    [Some(a), side.middle, Some(b)].into_iter().flatten().map(at).collect()
}

/// How many rows of nodes a plate has, and how many columns.
fn plate_lines(plate: &Plate) -> (usize, usize) {
    (plate.nodes.len(), plate.nodes.iter().map(Vec::len).min().unwrap_or(0))
}

/// The order of nodes along the line on which they all lie; `None` if they do not.
fn along_a_line(structure: &Structure, nodes: &[usize]) -> Option<Vec<usize>> {
    let places: Vec<[f64; 2]> = nodes.iter().map(|&node| structure.nodes[node].in_plane()).collect();
    straight_order(&places)
}

/// The order of places along the line on which they all lie; `None` if they do not.
fn straight_order(places: &[[f64; 2]]) -> Option<Vec<usize>> {
    let far = |from: [f64; 2]| {
        let distance = |place: &[f64; 2]| (place[0] - from[0]).hypot(place[1] - from[1]);
        places.iter().copied().max_by(|a, b| distance(a).total_cmp(&distance(b)))
    };
    let first = far(places.first().copied()?)?;
    let last = far(first)?;
    let (dx, dy) = (last[0] - first[0], last[1] - first[1]);
    let size = dx.hypot(dy);
    let off = |place: &[f64; 2]| ((place[0] - first[0]) * dy - (place[1] - first[1]) * dx).abs();
    if places.iter().any(|place| off(place) > 1e-9 * size * size) {
        return None;
    }
    let along = |k: usize| (places[k][0] - first[0]) * dx + (places[k][1] - first[1]) * dy;
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.sort_by(|a, b| along(*a).total_cmp(&along(*b)));
    Some(order)
}

/// Convex hull as a closed line (Andrew's monotone chain).
fn hull(mut points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut ring: Vec<(f64, f64)> = Vec::new();
    for way in [points.clone(), points.into_iter().rev().collect()] {
        // The way back begins where the way there ended.
        ring.pop();
        let from = ring.len();
        for point in way {
            let turns_right = |ring: &[(f64, f64)]| match ring[from..] {
                [.., a, b] => (b.0 - a.0) * (point.1 - a.1) - (b.1 - a.1) * (point.0 - a.0) <= 0.0,
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

/// An element bent as its elastic curve: places at shares of its length and how they are displaced.
fn bent(structure: &Structure, element: &Element, shares: &[f64], curve: &[[f64; 3]], factor: f64) -> Vec<(f64, f64)> {
    let [p, q] = [0, 1].map(|end| structure.nodes[element.nodes[end]].position);
    let place = |(t, u): (&f64, &[f64; 3])| {
        let [x, y] = [0, 1].map(|axis| p[axis] + t * (q[axis] - p[axis]) + factor * u[axis]);
        (x, y)
    };
    shares.iter().zip(curve).map(place).collect()
}

/// What a picture shows, in the coordinates of the model: the same for characters and for SVG.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Title, with the magnification where there are displacements.
    pub title: String,
    /// By how much the displacements are enlarged.
    pub factor: f64,
    /// Whether anything is displaced.
    pub is_deformed: bool,
    /// The undeformed structure.
    pub before: Lines,
    /// The structure as displaced.
    pub now: Lines,
    /// Supported nodes and how many components of each are held.
    pub supports: Vec<((f64, f64), usize)>,
    /// The contact pairs.
    pub pairs: Vec<PairMark>,
    /// The loads, where they are shown.
    pub loads: Loads,
    /// Forces along the bars, where they lie: closed lines from the bar to its ordinates and back.
    pub diagrams: Vec<Vec<(f64, f64)>>,
    /// Least and largest x and y of all of it; `None` where there is nothing to draw.
    pub bounds: Option<[[f64; 2]; 2]>,
}

/// A contact pair in a picture.
#[derive(Clone, Debug)]
pub struct PairMark {
    /// Its place, displaced.
    pub place: (f64, f64),
    /// Its id.
    pub id: String,
    /// Its state; `None` where none is shown.
    pub state: Option<State>,
    /// Unit tangent t.
    pub tangent: [f64; 3],
}

impl Scene {
    /// The scene of a picture, with the loads under these values of the parameters.
    pub fn new(picture: &Picture<'_>, loads: Option<&ParameterValues>) -> Scene {
        let structure = picture.structure;
        let rest = vec![[0.0; 6]; structure.nodes.len()];
        let u = picture.displacements.map(|displacements| nodal(structure, displacements));
        let moved = u.as_ref().unwrap_or(&rest);
        let factors = if u.is_some() { picture.factors } else { &[] };
        let factor = factor(structure, factors, moved, picture.magnification);
        let mut title = picture.title.to_owned();
        if u.is_some() {
            title.push_str(&format!(" · displacements × {}", short(factor)));
        }
        let (before, now) = (lines(structure, factors, &rest, 0.0), lines(structure, factors, moved, factor));
        let all = || {
            let outlines = before.outline.iter().chain(&now.outline).flatten().copied();
            let nodes = structure.nodes.iter().map(|n| (n.position[0], n.position[1]));
            outlines.chain(nodes).filter(|(x, y)| x.is_finite() && y.is_finite())
        };
        let (left, right) = range(all().map(|(x, _)| x));
        let (bottom, top) = range(all().map(|(_, y)| y));
        let bounds = all().next().map(|_| [[left, right], [bottom, top]]);
        let at = |node: usize| {
            let position = structure.nodes.get(node).map_or([0.0; 2], Node::in_plane);
            let u = moved.get(node).copied().unwrap_or_default();
            (position[0] + factor * u[0], position[1] + factor * u[1])
        };
        let mark = |(index, pair): (usize, &Pair)| PairMark {
            place: at(pair.node),
            id: pair.id.clone(),
            state: picture.pairs.and_then(|states| states.get(index)).map(|state| state.state),
            tangent: pair.tangents[0],
        };
        Scene {
            title,
            factor,
            is_deformed: before.outline != now.outline,
            supports: supported(structure).into_iter().map(|(node, held)| (at(node), held)).collect(),
            pairs: structure.pairs.iter().enumerate().map(mark).collect(),
            loads: loads.map_or_else(Loads::default, |parameters| {
                Loads::of(structure, &|case| case.factor.value(parameters), &at)
            }),
            diagrams: Vec::new(),
            before,
            now,
            bounds,
        }
    }

    /// Adds a force along every bar of the structure: N and Q on its +y side where they are positive, M on the side in
    /// tension. The largest ordinate is an eighth of the model.
    pub fn with_diagrams(mut self, structure: &Structure, members: &[MemberForces], force: Internal) -> Scene {
        let all: Vec<(&Bar, Series)> =
            structure.bars.iter().filter_map(|bar| Some((bar, diagram::series(members, &bar.id, force)?))).collect();
        let largest = largest(all.iter().flat_map(|(_, series)| series.points.iter().map(|(_, value)| *value)));
        let Some([[left, right], [bottom, top]]) = self.bounds.filter(|_| largest > 0.0) else { return self };
        let side = if force == Internal::Moment { -1.0 } else { 1.0 };
        let scale = side * ORDINATE * (right - left).max(top - bottom) / largest;
        for (bar, series) in all {
            let line = ordinates(structure, bar, &series.points, scale);
            for (x, y) in &line {
                let [[left, right], [bottom, top]] = self.bounds.get_or_insert([[*x; 2], [*y; 2]]);
                (*left, *right) = (left.min(*x), right.max(*x));
                (*bottom, *top) = (bottom.min(*y), top.max(*y));
            }
            self.diagrams.push(line);
        }
        self
    }
}

/// The ordinates of values along a bar, from its axis and back to it.
fn ordinates(structure: &Structure, bar: &Bar, points: &[(f64, f64)], scale: f64) -> Vec<(f64, f64)> {
    let mut stretches = Vec::new();
    let mut from = 0.0;
    for element in &structure.elements[bar.elements.clone()] {
        let [a, b] = [0, 1].map(|end| structure.nodes[element.nodes[end]].in_plane());
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        stretches.push((from, length, a, [(b[0] - a[0]) / length, (b[1] - a[1]) / length]));
        from += length;
    }
    let place = |s: f64, value: f64| {
        let at = stretches.partition_point(|(from, ..)| *from < s).saturating_sub(1);
        let (from, _, a, [c, d]) = stretches[at];
        let along = s - from;
        (a[0] + c * along - d * scale * value, a[1] + d * along + c * scale * value)
    };
    let ends = [points.first(), points.last()].map(|end| end.map(|(s, _)| place(*s, 0.0)));
    let [first, last] = ends;
    let line = points.iter().map(|(s, value)| place(*s, *value));
    first.into_iter().chain(line).chain(last).collect()
}

/// Nodes with supports and how many components each holds.
pub fn supported(structure: &Structure) -> Vec<(usize, usize)> {
    let mut held: Vec<(usize, usize)> = Vec::new();
    let mut place: HashMap<usize, usize> = HashMap::new();
    for support in &structure.supports {
        let index = *place.entry(support.node).or_insert_with(|| {
            held.push((support.node, 0));
            held.len() - 1
        });
        held[index].1 += 1;
    }
    held
}

#[cfg(test)]
mod tests {
    use super::{Magnification, Picture, Scene, hull};
    use crate::answer::diagram::Internal;
    use crate::model::structure::{ElementLoad, Load};
    use crate::view::tests::sample::cantilever;

    /// Cantilever of 4 m along x under q = −10: M = −10 (4 − x)²/2, tension above, so its ordinates stand above the bar,
    /// the largest, 80 at the clamp, an eighth of the model high; Q = 10 (4 − x) > 0 on the +y side too.
    #[test]
    fn diagrams_lie_along_the_bars_on_the_side_in_tension() {
        let (structure, members, _) = cantilever();
        let picture = Picture {
            title: "",
            structure: &structure,
            displacements: None,
            factors: &[],
            pairs: None,
            magnification: Magnification::Auto,
            height: 10,
        };
        for (force, value) in [
            (Internal::Moment, (|x: f64| 0.5 * (4.0 - x) * (4.0 - x) / 16.0) as fn(f64) -> f64),
            (Internal::Shear, |x: f64| 0.5 * (4.0 - x) / 4.0),
        ] {
            let scene = Scene::new(&picture, None).with_diagrams(&structure, &members, force);
            let [line] = &scene.diagrams[..] else { panic!("{:?}", scene.diagrams) };
            assert_eq!((line[0], line[line.len() - 1]), ((0.0, 0.0), (4.0, 0.0)));
            for (x, y) in &line[1..line.len() - 1] {
                assert!((y - value(*x)).abs() < 1e-12, "{force:?}: {y} at {x}");
            }
            assert!((scene.bounds.unwrap()[1][1] - 0.5).abs() < 1e-12);
        }
    }

    /// Cantilever of 4 m under q = −10 drawn as one element: v = −q x² (6 L² − 4 L x + x²)/24 EI between the nodes too, and
    /// the automatic factor is that of the tip, 0.1 · 4 / v(4) = 26 and so 20.
    #[test]
    fn a_bar_bends_between_its_nodes_as_its_load_says() {
        let (mut structure, _, mut moved) = cantilever();
        let (q, l, ei) = (10.0, 4.0, 2.1e4);
        let v = |x: f64| -q * x * x * (6.0 * l * l - 4.0 * l * x + x * x) / (24.0 * ei);
        // one element from the clamp to the tip
        structure.elements.truncate(1);
        structure.elements[0].nodes = vec![0, 2];
        structure.bars[0].elements = 0..1;
        structure.load_cases[0].loads.truncate(1);
        let Load::Element { load: ElementLoad::Line { range, .. }, .. } = &mut structure.load_cases[0].loads[0] else {
            panic!("a line load");
        };
        *range = [0.0, l];
        moved[1].uy = 0.0;
        let picture = Picture {
            title: "",
            structure: &structure,
            displacements: Some(&moved),
            factors: &[1.0],
            pairs: None,
            magnification: Magnification::Auto,
            height: 10,
        };
        let scene = Scene::new(&picture, None);
        assert_eq!(scene.factor, 20.0);
        let [line] = &scene.now.outline[..] else { panic!("{:?}", scene.now.outline) };
        assert!(line.len() > 20);
        for (x, y) in line {
            assert!((y - 20.0 * v(*x)).abs() < 1e-13, "{y} at {x}, not {}", 20.0 * v(*x));
        }
        // clamped at both ends it moves at no node: 1/384 q L⁴/EI in the middle, 0.1 · 4 / 3.2e-4 = 1260 and so 1000
        let mut held = moved.clone();
        for node in &mut held {
            (node.uy, node.rz) = (0.0, 0.0);
        }
        let scene = Scene::new(&Picture { displacements: Some(&held), ..picture }, None);
        assert!(scene.is_deformed && scene.factor == 1000.0, "{}", scene.factor);
        let lowest = scene.now.outline[0].iter().map(|(_, y)| *y).fold(0.0, f64::min);
        assert!((lowest + 1000.0 * q * l.powi(4) / (384.0 * ei)).abs() < 1e-12, "{lowest}");
    }

    /// A square with points on its sides and inside, and three points on a line.
    #[test]
    fn hulls_are_closed_and_have_no_more_than_the_corners() {
        let square = [(0.0, 0.0), (1.0, 1.0), (0.5, 0.0), (0.0, 1.0), (0.5, 0.4), (1.0, 0.0), (1.0, 0.5)];
        assert_eq!(hull(square.to_vec()), [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)]);
        let line = [(2.0, 2.0), (0.0, 0.0), (1.0, 1.0)];
        assert_eq!(hull(line.to_vec()), [(0.0, 0.0), (2.0, 2.0), (0.0, 0.0)]);
        assert_eq!(hull(vec![(1.0, 1.0), (1.0, 1.0)]).first(), Some(&(1.0, 1.0)));
    }
}
