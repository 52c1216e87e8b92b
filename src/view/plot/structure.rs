//! The structure, deformed if displacements are given, with its supports and the states of its contact pairs.

use std::collections::HashMap;
use std::io::{self, Write};

use super::canvas::{Canvas, Stroke};
use super::chart::{dotted, range, write_legend};
use crate::answer::record::{NodeDisplacement, PairState, State};
use crate::model::edge::Sides;
use crate::model::parameter::ParameterValues;
use crate::model::structure::{Element, ElementKind, Load, Structure};
use crate::view::number::short;
use crate::view::style::{Role, Style};

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
    /// States of its contact pairs, in the order of the structure; without them the pairs are marked as such.
    pub pairs: Option<&'a [PairState]>,
    /// Magnification of the displacements.
    pub magnification: Magnification,
    /// Most rows of the drawing; a flat structure takes fewer.
    pub height: usize,
}

/// Plates are drawn with their grid as long as its lines are this many dots apart.
pub const GRID_PITCH: f64 = 6.0;
/// Straight pieces of a bent frame element.
const PIECES: usize = 8;

/// u of every node of the structure: (u_x, u_y, rotation), 0 where the list has no such node.
pub fn nodal(structure: &Structure, displacements: &[NodeDisplacement]) -> Vec<[f64; 3]> {
    let by_id: HashMap<&str, &NodeDisplacement> = displacements.iter().map(|node| (node.node.as_str(), node)).collect();
    structure
        .nodes
        .iter()
        .map(|node| by_id.get(node.id.as_str()).map_or([0.0; 3], |u| [u.ux, u.uy, u.rz]))
        .map(|u| u.map(|u| if u.is_finite() { u } else { 0.0 }))
        .collect()
}

/// The factor by which displacements are drawn: the one asked for, or 1, 2 or 5 × 10^k so that the largest becomes
/// at most a tenth of the model's larger side; 1 where nothing moves.
pub fn factor(structure: &Structure, u: &[[f64; 3]], magnification: Magnification) -> f64 {
    if let Magnification::Factor(factor) = magnification {
        return if factor.is_finite() { factor } else { 1.0 };
    }
    let side = |axis: usize| {
        let (low, high) = range(structure.nodes.iter().map(|node| node.position[axis]));
        (high - low).max(0.0)
    };
    let size = side(0).max(side(1));
    let largest = u.iter().map(|u| u[0].hypot(u[1])).fold(0.0, f64::max);
    let rough = 0.1 * size / largest;
    if !(rough.is_finite() && rough > 0.0) {
        return 1.0;
    }
    let power = 10f64.powi(rough.log10().floor() as i32);
    let nice = [5.0, 2.0, 1.0].into_iter().map(|digit| digit * power).find(|nice| *nice <= rough).unwrap_or(power);
    if nice.is_finite() && nice > 0.0 { nice } else { 1.0 }
}

/// Lines of the structure in the plane, displaced by `factor` × u: bars (bent as the element bends), plate outlines,
/// single quads; plate grids apart, because they are drawn only where there is room.
pub struct Lines {
    /// Bars, outlines, quads.
    pub outline: Vec<Vec<(f64, f64)>>,
    /// Inner grid lines of the plates.
    pub grid: Vec<Vec<(f64, f64)>>,
}

/// See [`Lines`].
pub fn lines(structure: &Structure, u: &[[f64; 3]], factor: f64) -> Lines {
    let at = |node: usize| -> (f64, f64) {
        let position = structure.nodes.get(node).map_or([0.0; 2], |n| n.position);
        let u = u.get(node).copied().unwrap_or_default();
        (position[0] + factor * u[0], position[1] + factor * u[1])
    };
    let mut outline = Vec::new();
    let mut grid = Vec::new();
    let plates = structure.plates.iter().map(|plate| &plate.elements);
    let own: Vec<_> = plates.chain(structure.meshes.iter().map(|mesh| &mesh.elements)).collect();
    let in_plate = |index: usize| own.iter().any(|elements| elements.contains(&index));
    for (index, element) in structure.elements.iter().enumerate() {
        match &element.kind {
            ElementKind::Truss { .. } => {
                outline.push(element.nodes.iter().map(|&node| at(node)).collect());
            }
            ElementKind::Frame { hinges, .. } => {
                outline.push(bent(structure, element, *hinges, u, factor));
            }
            ElementKind::Membrane { .. } if in_plate(index) => {}
            ElementKind::Membrane { .. } => {
                let ring = element.ring().chain(element.nodes.first().copied());
                outline.push(ring.map(at).collect());
            }
        }
    }
    for mesh in &structure.meshes {
        for (side, is_inside) in Sides::of(&structure.elements[mesh.elements.clone()]).all() {
            let [a, b] = side.ends;
            let line = [Some(a), side.middle, Some(b)].into_iter().flatten().map(at).collect();
            if is_inside { grid.push(line) } else { outline.push(line) }
        }
    }
    for plate in &structure.plates {
        let last = plate.nodes.len().saturating_sub(1);
        for (j, row) in plate.nodes.iter().enumerate() {
            let line: Vec<_> = row.iter().map(|&node| at(node)).collect();
            if j == 0 || j == last {
                outline.push(line);
            } else {
                grid.push(line);
            }
        }
        let columns = plate.nodes.iter().map(Vec::len).min().unwrap_or(0);
        for i in 0..columns {
            let line: Vec<_> = plate.nodes.iter().map(|row| at(row[i])).collect();
            if i == 0 || i + 1 == columns {
                outline.push(line);
            } else {
                grid.push(line);
            }
        }
    }
    Lines { outline, grid }
}

/// Shape of a frame element: linear along it, cubic across it; at a hinge its end turns freely.
fn bent(structure: &Structure, element: &Element, hinges: [bool; 2], u: &[[f64; 3]], factor: f64) -> Vec<(f64, f64)> {
    let &[a, b] = &element.nodes[..] else {
        return Vec::new();
    };
    let (Some(start), Some(end)) = (structure.nodes.get(a), structure.nodes.get(b)) else {
        return Vec::new();
    };
    let (p, q) = (start.position, end.position);
    let (ua, ub) = (u.get(a).copied().unwrap_or_default(), u.get(b).copied().unwrap_or_default());
    let length = (q[0] - p[0]).hypot(q[1] - p[1]);
    if length <= 0.0 || !length.is_finite() {
        return vec![(p[0], p[1])];
    }
    let (c, s) = ((q[0] - p[0]) / length, (q[1] - p[1]) / length);
    let axial = |u: [f64; 3]| c * u[0] + s * u[1];
    let across = |u: [f64; 3]| -s * u[0] + c * u[1];
    let chord = (across(ub) - across(ua)) / length;
    // End rotations; without a moment at an end: θ₁ = 3/2 chord − θ₂/2.
    let (turn_a, turn_b) = match hinges {
        [false, false] => (ua[2], ub[2]),
        [true, false] => (1.5 * chord - 0.5 * ub[2], ub[2]),
        [false, true] => (ua[2], 1.5 * chord - 0.5 * ua[2]),
        [true, true] => (chord, chord),
    };
    let straight = (across(ua), across(ub), turn_a, turn_b) == (0.0, 0.0, 0.0, 0.0);
    let pieces = if straight { 1 } else { PIECES };
    (0..=pieces)
        .map(|i| {
            let t = i as f64 / pieces as f64;
            let along = axial(ua) + t * (axial(ub) - axial(ua));
            let v = (1.0 - 3.0 * t * t + 2.0 * t * t * t) * across(ua)
                + (3.0 * t * t - 2.0 * t * t * t) * across(ub)
                + length * (t - 2.0 * t * t + t * t * t) * turn_a
                + length * (t * t * t - t * t) * turn_b;
            let x = p[0] + t * (q[0] - p[0]) + factor * (c * along - s * v);
            let y = p[1] + t * (q[1] - p[1]) + factor * (s * along + c * v);
            (x, y)
        })
        .collect()
}

/// Sign of a pair in a picture. A slip points the way the second side moves over the first.
pub fn pair_sign(state: State, tangent: [f64; 2], ascii: bool) -> char {
    let towards = |direction: [f64; 2]| {
        let signs = if ascii { ['>', '<', '^', 'v'] } else { ['▶', '◀', '▲', '▼'] };
        if direction[0].abs() >= direction[1].abs() {
            signs[usize::from(direction[0] < 0.0)]
        } else {
            signs[2 + usize::from(direction[1] < 0.0)]
        }
    };
    match (state, ascii) {
        (State::Stick, false) => '●',
        (State::Stick, true) => '*',
        (State::Open, false) => '○',
        (State::Open, true) => 'o',
        (State::Closed, false) => '■',
        (State::Closed, true) => '#',
        (State::SlipPlus, _) => towards(tangent),
        (State::SlipMinus, _) => towards([-tangent[0], -tangent[1]]),
    }
}

/// Sign of a support: all components held, two of them, one.
pub fn support_sign(held: usize, ascii: bool) -> (char, &'static str) {
    match (held, ascii) {
        (3.., false) => ('▣', "clamped"),
        (3.., true) => ('C', "clamped"),
        (2, false) => ('△', "pinned"),
        (2, true) => ('A', "pinned"),
        (_, false) => ('◇', "held one way"),
        (_, true) => ('H', "held one way"),
    }
}

/// Draws the picture with a legend of the signs it uses.
pub fn write(out: &mut dyn Write, picture: &Picture<'_>, style: &Style) -> io::Result<()> {
    draw(out, picture, &[], style)
}

/// The same with an arrow beside every node and bar that carries load under these parameter values.
pub fn write_with_loads(
    out: &mut dyn Write,
    picture: &Picture<'_>,
    parameters: &ParameterValues,
    style: &Style,
) -> io::Result<()> {
    draw(out, picture, &arrows(picture.structure, parameters), style)
}

/// Where a load acts and in which direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrow {
    /// The node, or the ends of the element.
    pub nodes: Vec<usize>,
    /// Sum of all cases, each by its factor.
    pub force: [f64; 2],
}

/// Forces on nodes and elements, all cases added up; those that cancel out are left out.
pub fn arrows(structure: &Structure, parameters: &ParameterValues) -> Vec<Arrow> {
    let mut arrows: Vec<Arrow> = Vec::new();
    let mut places: HashMap<Vec<usize>, usize> = HashMap::new();
    for case in &structure.load_cases {
        let factor = case.factor.value(parameters);
        for load in &case.loads {
            let at = |element: usize| structure.elements.get(element).map(|element| element.nodes.clone());
            let (nodes, force) = match load {
                Load::Nodal { node, force, .. } => (Some(vec![*node]), *force),
                Load::Line { element, value: [a, b], .. } => (at(*element), [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]),
                Load::BarPoint { element, force, .. } => (at(*element), *force),
                // They act everywhere, or along no direction.
                Load::Body { .. } | Load::FreeStrain { .. } | Load::Settlement { .. } => continue,
            };
            let Some(nodes) = nodes else { continue };
            let place = *places.entry(nodes.clone()).or_insert_with(|| {
                arrows.push(Arrow { nodes, force: [0.0; 2] });
                arrows.len() - 1
            });
            arrows[place].force[0] += factor * force[0];
            arrows[place].force[1] += factor * force[1];
        }
    }
    let size = |arrow: &Arrow| arrow.force[0].hypot(arrow.force[1]);
    let most = arrows.iter().map(size).fold(0.0, f64::max);
    arrows.retain(|arrow| size(arrow) > 1e-9 * most);
    arrows
}

/// A component below this share of a load gets no arrow of its own.
const COMPONENT: f64 = 0.05;

/// Signs of the components of a load and the steps from its node to their places, in dots: a force down or up stands
/// before its node, one sideways behind it.
pub fn load_signs(force: [f64; 2], ascii: bool) -> Vec<(char, f64, f64)> {
    let signs = if ascii { ['V', 'U', '{', '}'] } else { ['↓', '↑', '←', '→'] };
    let least = COMPONENT * force[0].hypot(force[1]);
    let mut shown = Vec::new();
    if force[1].abs() > least {
        let up = force[1] > 0.0;
        shown.push((signs[usize::from(up)], 0.0, if up { -4.0 } else { 4.0 }));
    }
    if force[0].abs() > least {
        let right = force[0] > 0.0;
        let step = if right { 2.0 } else { -2.0 };
        shown.push((signs[2 + usize::from(right)], step, 0.0));
    }
    shown
}

fn draw(out: &mut dyn Write, picture: &Picture<'_>, arrows: &[Arrow], style: &Style) -> io::Result<()> {
    let structure = picture.structure;
    let rest = vec![[0.0; 3]; structure.nodes.len()];
    let u = picture.displacements.map(|displacements| nodal(structure, displacements));
    let moved = u.as_ref().unwrap_or(&rest);
    let factor = factor(structure, moved, picture.magnification);
    let mut title = picture.title.to_owned();
    if u.is_some() {
        title.push_str(&format!(" · displacements × {}", short(factor)));
    }
    let title = style.fit(&style.text(&title), style.width);
    writeln!(out, "{}", style.paint(Role::Title, &title))?;

    let before = lines(structure, &rest, 0.0);
    let now = lines(structure, moved, factor);
    let all = || {
        before
            .outline
            .iter()
            .chain(&now.outline)
            .flatten()
            .copied()
            .chain(structure.nodes.iter().map(|n| (n.position[0], n.position[1])))
            .filter(|(x, y)| x.is_finite() && y.is_finite())
    };
    if all().next().is_none() || style.width < 8 {
        return writeln!(out, "{}", style.fit("nothing to draw", style.width));
    }
    let (left, right) = range(all().map(|(x, _)| x));
    let (bottom, top) = range(all().map(|(_, y)| y));
    let (wide, high) = (right - left, top - bottom);
    let most = picture.height.clamp(3, 200);
    let columns = style.width;
    // One scale for both directions: a dot is about as high as it is wide. A character stays free at every side.
    let room_x = (2 * columns - 5) as f64;
    let room_y = (4 * most - 9).max(1) as f64;
    let mut pitch = f64::min(room_x / wide, room_y / high);
    if !(pitch.is_finite() && pitch > 0.0) {
        pitch = 1.0;
    }
    let rows = (((high * pitch) / 4.0).ceil() as usize + 2).clamp(3, most);
    let mut canvas = Canvas::new(columns, rows);
    let (shift_x, shift_y) = ((canvas.dots_x() - wide * pitch) / 2.0, (canvas.dots_y() - high * pitch) / 2.0);
    let place = |(x, y): (f64, f64)| ((x - left) * pitch + shift_x, (y - bottom) * pitch + shift_y);
    let ends = (canvas.dots_x(), canvas.dots_y());
    let placed = |lines: &[Vec<(f64, f64)>]| -> Vec<Vec<(f64, f64)>> {
        lines
            .iter()
            .map(|line| {
                let finite = line.iter().filter(|(x, y)| x.is_finite() && y.is_finite());
                finite.map(|&point| place(point)).map(|(x, y)| (x.clamp(0.0, ends.0), y.clamp(0.0, ends.1))).collect()
            })
            .collect()
    };
    let is_deformed = moved.iter().any(|u| *u != [0.0; 3]) && factor != 0.0;
    if is_deformed {
        let strokes = placed(&before.outline).iter().map(|line| Stroke::Dots(dotted(line, 4.0))).collect();
        canvas.draw_under(Role::Muted, strokes);
    }
    if grid_pitch(structure, pitch) >= GRID_PITCH {
        let strokes = placed(&now.grid).iter().map(|line| Stroke::Dots(dotted(line, 2.0))).collect();
        canvas.draw_under(Role::Muted, strokes);
    }
    let strokes = placed(&now.outline).into_iter().map(Stroke::Line).collect();
    canvas.draw(Role::Plain, strokes);

    let mut legend: Vec<(char, Role, String)> = Vec::new();
    let mut note = |sign: char, role: Role, word: &str| {
        let entry = (sign, role, word.to_owned());
        if !legend.contains(&entry) {
            legend.push(entry);
        }
    };
    let at = |node: usize| {
        let position = structure.nodes.get(node).map_or([0.0; 2], |n| n.position);
        let u = moved.get(node).copied().unwrap_or_default();
        place((position[0] + factor * u[0], position[1] + factor * u[1]))
    };
    for (node, held) in supported(structure) {
        let (sign, word) = support_sign(held, style.ascii);
        let (x, y) = at(node);
        canvas.put(x, y, sign, Role::Muted);
        note(sign, Role::Muted, word);
    }
    for (index, pair) in structure.pairs.iter().enumerate() {
        let state = picture.pairs.and_then(|states| states.get(index));
        let (sign, role, word) = match state {
            Some(state) => {
                (pair_sign(state.state, pair.tangent(), style.ascii), Role::State(state.state), state.state.word())
            }
            None => (if style.ascii { 'o' } else { '◦' }, Role::Accent, "contact pair"),
        };
        let (x, y) = at(pair.node);
        canvas.put(x, y, sign, role);
        canvas.label(x, y, &style.text(&pair.id), Role::Muted);
        note(sign, role, word);
    }
    for arrow in arrows {
        let count = arrow.nodes.len().max(1) as f64;
        let (mut x, mut y) = (0.0, 0.0);
        for &node in &arrow.nodes {
            let (node_x, node_y) = at(node);
            x += node_x / count;
            y += node_y / count;
        }
        for (sign, step_x, step_y) in load_signs(arrow.force, style.ascii) {
            canvas.put(x + step_x, y + step_y, sign, Role::Accent);
            note(sign, Role::Accent, "load");
        }
    }
    for line in canvas.lines(style) {
        writeln!(out, "{line}")?;
    }
    write_legend(out, &legend, 0, style)
}

/// Smallest distance of two grid lines in dots.
pub fn grid_pitch(structure: &Structure, pitch: f64) -> f64 {
    structure
        .plates
        .iter()
        .flat_map(|plate| structure.elements.get(plate.elements.clone()))
        .flatten()
        .filter_map(|element| {
            let place = |i: usize| Some(structure.nodes.get(*element.nodes.get(i)?)?.position);
            let (a, b, d) = (place(0)?, place(1)?, place(3)?);
            let side = |p: [f64; 2], q: [f64; 2]| (q[0] - p[0]).hypot(q[1] - p[1]);
            Some(side(a, b).min(side(a, d)) * pitch)
        })
        .fold(f64::INFINITY, f64::min)
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
