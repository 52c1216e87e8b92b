//! The structure, deformed if displacements are given, with its supports and the states of its contact pairs.

use std::io::{self, Write};

use super::canvas::{Canvas, Stroke};
use super::chart::{dotted, write_legend};
use super::diagram;
use super::scene::{Picture, Scene, arrows};
use crate::answer::diagram::{Diagram, Internal};
use crate::answer::record::{MemberForces, State};
use crate::model::parameter::ParameterValues;
use crate::model::scenario::Units;
use crate::model::structure::Structure;
use crate::view::members::extremes;
use crate::view::number::largest;
use crate::view::style::{Role, Style};

/// Bars whose extremes are told below a picture.
const EXTREMES: usize = 6;
/// Plates are drawn with their grid as long as its lines are this many dots apart.
pub const GRID_PITCH: f64 = 6.0;
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

/// What a support is called that holds so many components.
pub fn support_word(held: usize) -> &'static str {
    match held {
        3.. => "clamped",
        2 => "pinned",
        _ => "held one way",
    }
}

/// Its sign.
pub fn support_sign(held: usize, ascii: bool) -> char {
    match (held, ascii) {
        (3.., false) => '▣',
        (3.., true) => 'C',
        (2, false) => '△',
        (2, true) => 'A',
        (_, false) => '◇',
        (_, true) => 'H',
    }
}

/// Draws the picture with a legend of the signs it uses.
pub fn write(out: &mut dyn Write, picture: &Picture<'_>, style: &Style) -> io::Result<()> {
    draw(out, picture, &Scene::new(picture, &[]), style)
}

/// The same undeformed, with a force along every bar where it lies, and the extremes of each bar in words.
pub fn write_with_diagrams(
    out: &mut dyn Write,
    picture: &Picture<'_>,
    (members, force): (&[MemberForces], Internal),
    units: &Units,
    style: &Style,
) -> io::Result<()> {
    let (name, unit) = diagram::name(force, units);
    let unit = unit.map_or(String::new(), |unit| format!(" [{unit}]"));
    let side = if force == Internal::Moment { ", on the tension side" } else { "" };
    let head = if picture.title.is_empty() { String::new() } else { format!("{} · ", picture.title) };
    let title = format!("{head}{name}{unit}{side}");
    let picture = Picture { title: &title, displacements: None, ..*picture };
    let scene = Scene::new(&picture, &[]).with_diagrams(picture.structure, members, force);
    draw(out, &picture, &scene, style)?;
    let diagrams = picture.structure.bars.iter().filter_map(|bar| Some((&bar.id, Diagram::of(members, &bar.id)?)));
    let size = |diagram: &Diagram| largest(diagram.extremes(force).map(|place| place.value));
    let mut diagrams: Vec<_> = diagrams.collect();
    diagrams.sort_by(|a, b| size(&b.1).total_cmp(&size(&a.1)));
    for (id, found) in diagrams.iter().take(EXTREMES) {
        let line = format!("{id} {}", extremes(found, force, units));
        for line in style.wrap(&style.text(&line), style.width) {
            writeln!(out, "{line}")?;
        }
    }
    if diagrams.len() > EXTREMES {
        let rest = format!("… and {} bars with less: `members BAR`", diagrams.len() - EXTREMES);
        writeln!(out, "{}", style.paint(Role::Muted, &style.fit(&style.text(&rest), style.width)))?;
    }
    Ok(())
}

/// The same with an arrow beside every node and bar that carries load under these parameter values.
pub fn write_with_loads(
    out: &mut dyn Write,
    picture: &Picture<'_>,
    parameters: &ParameterValues,
    style: &Style,
) -> io::Result<()> {
    draw(out, picture, &Scene::new(picture, &arrows(picture.structure, parameters)), style)
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

fn draw(out: &mut dyn Write, picture: &Picture<'_>, scene: &Scene, style: &Style) -> io::Result<()> {
    let title = style.fit(&style.text(&scene.title), style.width);
    writeln!(out, "{}", style.paint(Role::Title, &title))?;
    let Some([[left, right], [bottom, top]]) = scene.bounds.filter(|_| style.width >= 8) else {
        return writeln!(out, "{}", style.fit("nothing to draw", style.width));
    };
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
    if scene.is_deformed {
        let strokes = placed(&scene.before.outline).iter().map(|line| Stroke::Dots(dotted(line, 4.0))).collect();
        canvas.draw_under(Role::Muted, strokes);
    }
    if grid_pitch(picture.structure, pitch) >= GRID_PITCH {
        let strokes = placed(&scene.now.grid).iter().map(|line| Stroke::Dots(dotted(line, 2.0))).collect();
        canvas.draw_under(Role::Muted, strokes);
    }
    let strokes = placed(&scene.now.outline).into_iter().map(Stroke::Line).collect();
    canvas.draw(Role::Plain, strokes);
    let strokes = placed(&scene.diagrams).into_iter().map(Stroke::Line).collect();
    canvas.draw(Role::Accent, strokes);
    let legend = draw_marks(scene, &mut canvas, &place, style);
    for line in canvas.lines(style) {
        writeln!(out, "{line}")?;
    }
    write_legend(out, &legend, 0, style)
}

/// Supports, pairs and loads as signs; the legend of those that occur.
fn draw_marks(
    scene: &Scene,
    canvas: &mut Canvas,
    place: &dyn Fn((f64, f64)) -> (f64, f64),
    style: &Style,
) -> Vec<(char, Role, String)> {
    let mut legend: Vec<(char, Role, String)> = Vec::new();
    let mut note = |sign: char, role: Role, word: &str| {
        let entry = (sign, role, word.to_owned());
        if !legend.contains(&entry) {
            legend.push(entry);
        }
    };
    for &(at, held) in &scene.supports {
        let (sign, word) = (support_sign(held, style.ascii), support_word(held));
        let (x, y) = place(at);
        canvas.put(x, y, sign, Role::Muted);
        note(sign, Role::Muted, word);
    }
    for pair in &scene.pairs {
        let (sign, role, word) = match pair.state {
            Some(state) => (pair_sign(state, pair.tangent, style.ascii), Role::State(state), state.word()),
            None => (if style.ascii { 'o' } else { '◦' }, Role::Accent, "contact pair"),
        };
        let (x, y) = place(pair.place);
        canvas.put(x, y, sign, role);
        canvas.label(x, y, &style.text(&pair.id), Role::Muted);
        note(sign, role, word);
    }
    for &(at, force) in &scene.loads {
        let (x, y) = place(at);
        for (sign, step_x, step_y) in load_signs(force, style.ascii) {
            canvas.put(x + step_x, y + step_y, sign, Role::Accent);
            note(sign, Role::Accent, "load");
        }
    }
    legend
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
