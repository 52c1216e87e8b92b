//! What a picture of a structure shows, projected, in the unit of length of the model: drawn with characters by
//! `structure`, as SVG by `view::svg`.

use std::collections::HashMap;

use super::bar_line::BarLine;
use super::case_loads::CaseLoads;
use super::lines::{Displaced, Face, Grid, Move, Outline, largest_displacement};
use super::loads::Loads;
use super::skeleton::Skeleton;
use super::ticks::range;
use super::{Series, diagram};
use crate::answer::diagram::Internal;
use crate::answer::record::{MemberForces, NodeDisplacement, PairState, State};
use crate::answer::rounding::largest;
use crate::model::pair::Pair;
use crate::model::structure::{Bar, Component, Dimension, Structure};
use crate::model::vector::unit;
use crate::text::number::short;
use crate::view::projection::{Projection, Viewpoint};

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
    /// From where a structure in space is seen.
    pub viewpoint: Viewpoint,
    /// Most rows of the drawing; a flat structure takes fewer.
    pub height: usize,
}

/// The largest ordinate of a diagram as a share of the model.
const ORDINATE: f64 = 0.125;

/// u of every node of the structure, in the order of the components; 0 where the list has no such node.
pub fn nodal(structure: &Structure, displacements: &[NodeDisplacement]) -> Vec<[f64; 6]> {
    let finite = |u: &NodeDisplacement| u.all().map(|u| if u.is_finite() { u } else { 0.0 });
    let nodes = &structure.nodes;
    if nodes.len() == displacements.len() && nodes.iter().zip(displacements).all(|(node, u)| node.id == u.node) {
        return displacements.iter().map(finite).collect();
    }
    let by_id: HashMap<&str, &NodeDisplacement> = displacements.iter().map(|node| (node.node.as_str(), node)).collect();
    nodes.iter().map(|node| by_id.get(node.id.as_str()).map_or([0.0; 6], |u| finite(u))).collect()
}

/// The factor by which displacements are drawn: the one asked for, or 1, 2 or 5 × 10^k so that the largest, between the
/// nodes too, becomes at most a tenth of the model's larger side; 1 where nothing moves. `factors`: see [`Picture`].
pub fn factor(
    (structure, skeleton): (&Structure, &Skeleton),
    factors: &[f64],
    u: &[[f64; 6]],
    magnification: Magnification,
) -> f64 {
    if let Magnification::Factor(factor) = magnification {
        return if factor.is_finite() { factor } else { 1.0 };
    }
    let size = [0, 1, 2].map(|axis| skeleton.side(axis)).into_iter().fold(0.0, f64::max);
    // a single point is seen in a picture of size 1
    let size = if size > 0.0 { size } else { 1.0 };
    let rough = 0.1 * size / largest_displacement(structure, skeleton, factors, u);
    if !(rough.is_finite() && rough > 0.0) {
        return 1.0;
    }
    let power = 10f64.powi(rough.log10().floor() as i32);
    let nice = [5.0, 2.0, 1.0].into_iter().map(|digit| digit * power).find(|nice| *nice <= rough).unwrap_or(power);
    if nice.is_finite() && nice > 0.0 { nice } else { 1.0 }
}

/// The structure in a picture.
#[derive(Clone, Debug)]
pub struct Lines {
    /// Bars, outlines, edges.
    pub outline: Outline,
    /// Inner lines of plates and faces.
    pub grid: Grid,
    /// Membranes, faces of solids, hulls; the far ones first.
    pub faces: Vec<Face>,
}

impl Lines {
    fn of(displaced: &Displaced) -> Lines {
        Lines { outline: displaced.outline(), grid: displaced.grid(0.0), faces: displaced.faces() }
    }
}

/// What a picture shows, projected: the same for characters and for SVG.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Title, with the magnification where there are displacements.
    pub title: String,
    /// By how much the displacements are enlarged.
    pub factor: f64,
    /// How the model is seen.
    pub projection: Projection,
    /// Whether anything is displaced.
    pub is_deformed: bool,
    /// The undeformed structure.
    pub before: Lines,
    /// The structure as displaced.
    pub now: Lines,
    /// Supported nodes and how they are held: see [`supported`].
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
    /// Its place in the picture, displaced.
    pub place: (f64, f64),
    /// Whether it lies behind the faces of a solid.
    pub is_hidden: bool,
    /// Its id.
    pub id: String,
    /// Its state; `None` where none is shown.
    pub state: Option<State>,
    /// Unit vector in the picture along which the second side slips; `None` where it does not, or straight into the
    /// picture or out of it.
    pub towards: Option<(f64, f64)>,
}

/// A slip of length 1 that is shorter than this in the picture is seen from its tip or its tail.
const END_ON: f64 = 0.1;

/// Which way the second side of a pair in this state slips in the picture, where in space `slip` is along t1 and t2.
pub fn towards(pair: &Pair, state: State, slip: &[f64], projection: &Projection) -> Option<(f64, f64)> {
    let slip = match state {
        State::SlipPlus => pair.tangents[0],
        State::SlipMinus => pair.tangents[0].map(|t| -t),
        State::Slip => pair.along_tangents(slip),
        State::Open | State::Stick | State::Closed => return None,
    };
    let (x, y) = projection.flat(unit(slip)?);
    let length = x.hypot(y);
    (length > END_ON).then(|| (x / length, y / length))
}

impl Scene {
    /// The scene of a picture, with the loads under these factors of the load cases.
    pub fn new(picture: &Picture<'_>, loads: Option<&[f64]>) -> Scene {
        let structure = picture.structure;
        let projection = Projection::new(structure.dimension, picture.viewpoint);
        let u = picture.displacements.map(|displacements| nodal(structure, displacements));
        let factors = if u.is_some() { picture.factors } else { &[] };
        let moved = u.as_deref().unwrap_or_default();
        let skeleton = Skeleton::of(structure);
        let factor = factor((structure, &skeleton), factors, moved, picture.magnification);
        let mut title = picture.title.to_owned();
        if u.is_some() {
            title.push_str(&format!(" · displacements × {}", short(factor)));
        }
        if structure.dimension == Dimension::Space {
            title.push_str(&format!(" · {} · {}", picture.viewpoint.words(), projection.axes_in_words()));
        }
        let at_rest = Displaced::new((structure, &skeleton), Move::default(), &projection);
        let displaced = Displaced::new((structure, &skeleton), Move { u: moved, factors, by: factor }, &projection);
        let (before, now) = (Lines::of(&at_rest), Lines::of(&displaced));
        let all = || {
            let outlines = [&before.outline, &now.outline].into_iter().flat_map(Outline::all).flatten().copied();
            let nodes = structure.nodes.iter().map(|node| projection.flat(node.position));
            outlines.chain(nodes).filter(|(x, y)| x.is_finite() && y.is_finite())
        };
        let (left, right) = range(all().map(|(x, _)| x));
        let (bottom, top) = range(all().map(|(_, y)| y));
        let bounds = all().next().map(|_| [[left, right], [bottom, top]]);
        let at = |node: usize| displaced.at(node);
        let mark = |(index, pair): (usize, &Pair)| {
            let state = picture.pairs.and_then(|states| states.get(index));
            PairMark {
                place: displaced.at_pair(pair),
                is_hidden: displaced.hides(pair.node),
                id: pair.id.clone(),
                state: state.map(|state| state.state),
                towards: state.and_then(|state| towards(pair, state.state, &state.slip(), &projection)),
            }
        };
        Scene {
            title,
            factor,
            projection,
            is_deformed: before.outline != now.outline,
            supports: supported(structure).into_iter().map(|(node, held)| (at(node), held)).collect(),
            pairs: structure.pairs.iter().enumerate().map(mark).collect(),
            loads: loads.map_or_else(Loads::default, |factors| {
                CaseLoads::of(structure, moved).seen(factors, factor, &projection)
            }),
            diagrams: Vec::new(),
            before,
            now,
            bounds,
        }
    }

    /// Adds a force along every bar of the structure, positive values on the side of [`BarLine`]. The largest ordinate
    /// is an eighth of the model.
    pub fn with_diagrams(mut self, structure: &Structure, members: &[MemberForces], force: Internal) -> Scene {
        let all: Vec<(&Bar, Series)> =
            structure.bars.iter().filter_map(|bar| Some((bar, diagram::series(members, &bar.id, force)?))).collect();
        let largest = largest(all.iter().flat_map(|(_, series)| series.points.iter().map(|(_, value)| *value)));
        let Some([[left, right], [bottom, top]]) = self.bounds.filter(|_| largest > 0.0) else { return self };
        let scale = ORDINATE * (right - left).max(top - bottom) / largest;
        for (bar, series) in all {
            let line = ordinates(&BarLine::of(structure, bar, force), &series.points, scale);
            let line: Vec<(f64, f64)> = line.into_iter().map(|at| self.projection.flat(at)).collect();
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
fn ordinates(bar: &BarLine, points: &[(f64, f64)], scale: f64) -> Vec<[f64; 3]> {
    let feet = bar.feet(points);
    let tips = feet
        .iter()
        .zip(points)
        .map(|((at, across), (_, value))| -> [f64; 3] { std::array::from_fn(|c| at[c] + scale * value * across[c]) });
    let [first, last] = [feet.first(), feet.last()].map(|foot| foot.map(|(at, _)| *at));
    first.into_iter().chain(tips).chain(last).collect()
}

/// Nodes with supports and how they are held: 3 clamped, 2 at their place, 1 in some directions.
pub fn supported(structure: &Structure) -> Vec<(usize, usize)> {
    let mut held: Vec<(usize, Vec<Component>)> = Vec::new();
    let mut place: HashMap<usize, usize> = HashMap::new();
    for support in &structure.supports {
        let index = *place.entry(support.node).or_insert_with(|| {
            held.push((support.node, Vec::new()));
            held.len() - 1
        });
        held[index].1.push(support.component);
    }
    let dimension = structure.dimension;
    let all = |held: &[Component], of: &[Component]| of.iter().all(|component| held.contains(component));
    let how = |held: &[Component]| match (all(held, dimension.translations()), all(held, dimension.rotations())) {
        (true, true) => 3,
        (true, false) => 2,
        (false, _) => 1,
    };
    held.into_iter().map(|(node, components)| (node, how(&components))).collect()
}

#[cfg(test)]
mod tests {
    use super::{Magnification, Picture, Scene};
    use crate::answer::diagram::Internal;
    use crate::model::structure::{ElementLoad, Load};
    use crate::view::projection::Viewpoint;
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
            viewpoint: Viewpoint::default(),
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
            viewpoint: Viewpoint::default(),
            height: 10,
        };
        let scene = Scene::new(&picture, None);
        assert_eq!(scene.factor, 20.0);
        let [line] = &scene.now.outline.seen[..] else { panic!("{:?}", scene.now.outline) };
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
        let lowest = scene.now.outline.seen[0].iter().map(|(_, y)| *y).fold(0.0, f64::min);
        assert!((lowest + 1000.0 * q * l.powi(4) / (384.0 * ei)).abs() < 1e-12, "{lowest}");
    }
}
