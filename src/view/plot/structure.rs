//! The structure, deformed if displacements are given, with its supports and the states of its contact pairs.

use std::io::{self, Write};

use super::canvas::{Canvas, Stroke};
use super::chart::{dotted, write_legend};
use super::depth::Line;
use super::diagram;
use super::load_arrow::Drawn;
use super::loads::Arrow;
use super::scene::{Picture, Scene};
use crate::answer::diagram::{Diagram, Internal};
use crate::answer::record::{MemberForces, State};
use crate::answer::rounding::largest;
use crate::model::units::Units;
use crate::text::number::heading;
use crate::view::members::extremes;
use crate::view::style::{Role, Style};

/// Most bars whose extremes are given below a picture.
const EXTREMES: usize = 6;
/// Plates and faces are drawn with their grid as long as its lines are this many dots apart.
pub const GRID_PITCH: f64 = 6.0;
/// Dots of lines behind faces are this far apart.
pub const HIDDEN_PITCH: f64 = 3.0;

/// Sign of a pair in a picture. A slip points the way the second side moves over the first, if that can be seen.
pub fn pair_sign(state: State, towards: Option<(f64, f64)>, ascii: bool) -> char {
    match (state, ascii) {
        (State::Stick, false) => '●',
        (State::Stick, true) => '*',
        (State::Open, false) => '○',
        (State::Open, true) => 'o',
        (State::Closed, false) => '■',
        (State::Closed, true) => '#',
        (State::SlipPlus | State::SlipMinus | State::Slip, _) => {
            slip_sign(towards, state == State::Slip && !ascii, ascii)
        }
    }
}

/// An arrowhead to one of four sides, or of eight where there are signs for them.
fn slip_sign(towards: Option<(f64, f64)>, eight: bool, ascii: bool) -> char {
    let Some((x, y)) = towards else { return if ascii { '%' } else { '◆' } };
    // tan 22.5°
    if eight && x.abs().min(y.abs()) > (2.0_f64.sqrt() - 1.0) * x.abs().max(y.abs()) {
        return ['◥', '◢', '◤', '◣'][2 * usize::from(x < 0.0) + usize::from(y < 0.0)];
    }
    let signs = if ascii { ['>', '<', '^', 'v'] } else { ['▶', '◀', '▲', '▼'] };
    if x.abs() >= y.abs() { signs[usize::from(x < 0.0)] } else { signs[2 + usize::from(y < 0.0)] }
}

/// What a support that holds this many components is called.
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

/// Draws the picture with a legend of the signs it uses; with the factors of the load cases and units the loads too.
pub fn write(
    out: &mut dyn Write,
    picture: &Picture<'_>,
    loads: Option<(&[f64], &Units)>,
    style: &Style,
) -> io::Result<()> {
    let scene = Scene::new(picture, loads.map(|(factors, _)| factors));
    draw(out, picture, &scene, loads.map(|(_, units)| units), style)
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
    let name = heading(name, unit.as_deref());
    let side = if force.is_bending() { ", on the tension side" } else { "" };
    let head = if picture.title.is_empty() { String::new() } else { format!("{} · ", picture.title) };
    let title = format!("{head}{name}{side}");
    let picture = Picture { title: &title, displacements: None, ..*picture };
    let scene = Scene::new(&picture, None).with_diagrams(picture.structure, members, force);
    draw(out, &picture, &scene, None, style)?;
    let diagrams = picture.structure.bars.iter().filter_map(|bar| Some((&bar.id, Diagram::of(members, &bar.id)?)));
    let size = |diagram: &Diagram| largest(diagram.extremes(force).map(|place| place.value));
    let mut diagrams: Vec<_> = diagrams.collect();
    diagrams.retain(|(_, found)| size(found) > 0.0);
    diagrams.sort_by(|a, b| size(&b.1).total_cmp(&size(&a.1)));
    if diagrams.is_empty() {
        writeln!(out, "{}", style.paint(Role::Muted, &format!("{} is 0 in every bar", force.symbol())))?;
    }
    for (id, found) in diagrams.iter().take(EXTREMES) {
        let line = format!("{id} {}", extremes(found, force, units));
        style.paragraph(out, Role::Plain, &line)?;
    }
    if diagrams.len() > EXTREMES {
        let rest = format!("… and {} bars with less: `members BAR`", diagrams.len() - EXTREMES);
        writeln!(out, "{}", style.paint(Role::Muted, &style.fit(&style.text(&rest), style.width)))?;
    }
    Ok(())
}

/// Dots between arrows of loads.
const APART: f64 = 8.0;
/// Most dots that arrows take at a side.
const MARGIN: f64 = 24.0;

/// The structure on a canvas: a point of the model is at (x − corner)·pitch + origin, in dots.
struct Fit {
    canvas: Canvas,
    pitch: f64,
    corner: (f64, f64),
    origin: (f64, f64),
}

impl Fit {
    /// As large as it finds room; `margins` (left, right, below, above, in dots) stay free besides a character at every
    /// side. One scale for both directions: a dot is about as high as it is wide.
    fn new([[left, right], [bottom, top]]: [[f64; 2]; 2], columns: usize, most: usize, margins: [f64; 4]) -> Fit {
        let (wide, high) = (right - left, top - bottom);
        let [before, after, below, above] = margins;
        let room_x = ((2 * columns - 5) as f64 - before - after).max(4.0);
        let room_y = ((4 * most) as f64 - 9.0 - below - above).max(1.0);
        let pitch = f64::min(room_x / wide, room_y / high);
        let pitch = if pitch.is_finite() && pitch > 0.0 { pitch } else { 1.0 };
        let rows = (((high * pitch + below + above) / 4.0).ceil().min(most as f64) as usize + 2).clamp(3, most);
        let canvas = Canvas::new(columns, rows);
        let origin = (
            before + 0.5 * (canvas.dots_x() - before - after - wide * pitch),
            below + 0.5 * (canvas.dots_y() - below - above - high * pitch),
        );
        Fit { canvas, pitch, corner: (left, bottom), origin }
    }

    fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        ((x - self.corner.0) * self.pitch + self.origin.0, (y - self.corner.1) * self.pitch + self.origin.1)
    }

    fn placed(&self, lines: &[Vec<(f64, f64)>]) -> Vec<Vec<(f64, f64)>> {
        let ends = (self.canvas.dots_x(), self.canvas.dots_y());
        let place = |line: &Vec<(f64, f64)>| {
            let finite = line.iter().filter(|(x, y)| x.is_finite() && y.is_finite());
            finite.map(|&at| self.place(at)).map(|(x, y)| (x.clamp(0.0, ends.0), y.clamp(0.0, ends.1))).collect()
        };
        lines.iter().map(place).collect()
    }

    /// The arrows of loads as they stand here.
    fn arrows(&self, arrows: &[Arrow], [[left, right], [bottom, top]]: [[f64; 2]; 2]) -> Vec<Drawn> {
        let middle = self.place((0.5 * (left + right), 0.5 * (bottom + top)));
        let extent = (right - left).max(top - bottom) * self.pitch;
        arrows.iter().map(|arrow| Drawn::new(arrow, self.place(arrow.at), middle, extent)).collect()
    }

    /// How far arrows stand out of the structure at each side.
    fn overhang(&self, drawn: &[Drawn], [[left, right], [bottom, top]]: [[f64; 2]; 2]) -> [f64; 4] {
        let ((left, bottom), (right, top)) = (self.place((left, bottom)), self.place((right, top)));
        let mut margins = [0.0_f64; 4];
        for (x, y) in drawn.iter().flat_map(Drawn::ends) {
            for (margin, out) in margins.iter_mut().zip([left - x, x - right, bottom - y, y - top]) {
                // displacements of any size may be drawn
                *margin = if out.is_finite() { margin.max(out.min(MARGIN)) } else { *margin };
            }
        }
        margins
    }
}

fn draw(
    out: &mut dyn Write,
    picture: &Picture<'_>,
    scene: &Scene,
    units: Option<&Units>,
    style: &Style,
) -> io::Result<()> {
    let title = style.fit(&style.text(&scene.title), style.width);
    writeln!(out, "{}", style.paint(Role::Title, &title))?;
    let Some(bounds) = scene.bounds.filter(|_| style.width >= 8) else {
        return writeln!(out, "{}", style.fit("nothing to draw", style.width));
    };
    let most = picture.height.clamp(3, 200);
    let mut fit = Fit::new(bounds, style.width, most, [0.0; 4]);
    let mut arrows = scene.loads.arrows(APART / fit.pitch);
    if !arrows.arrows.is_empty() {
        let margins = fit.overhang(&fit.arrows(&arrows.arrows, bounds), bounds);
        fit = Fit::new(bounds, style.width, most, margins);
        arrows = scene.loads.arrows(APART / fit.pitch);
    }
    let dots = |fit: &Fit, lines: &[Line], pitch: f64| -> Vec<Stroke> {
        fit.placed(lines).iter().map(|line| Stroke::Dots(dotted(line, pitch))).collect()
    };
    if scene.is_deformed {
        fit.canvas.draw_under(Role::Muted, dots(&fit, &scene.before.outline.seen, 4.0));
    }
    let grid = &scene.now.grid;
    if grid.pitch * fit.pitch >= GRID_PITCH {
        fit.canvas.draw_under(Role::Muted, dots(&fit, &grid.lines, 2.0));
    }
    fit.canvas.draw_under(Role::Muted, dots(&fit, &scene.now.outline.hidden, HIDDEN_PITCH));
    let strokes = fit.placed(&scene.now.outline.seen).into_iter().map(Stroke::Line).collect();
    fit.canvas.draw(Role::Plain, strokes);
    let strokes = fit.placed(&scene.diagrams).into_iter().map(Stroke::Line).collect();
    fit.canvas.draw(Role::Accent, strokes);
    let drawn = fit.arrows(&arrows.arrows, bounds);
    drawn.iter().for_each(|arrow| arrow.draw(&mut fit.canvas, style.ascii));
    let mut legend = draw_marks(scene, &mut fit, style);
    let sign = |kind| arrows.arrows.iter().position(|arrow| arrow.kind == kind).map(|k| drawn[k].sign(style.ascii));
    let words = units.map_or_else(Vec::new, |units| scene.loads.legend(&arrows, units));
    legend.extend(words.into_iter().filter_map(|(kind, text)| Some((sign(kind)?, Role::Accent, style.text(&text)))));
    for line in fit.canvas.lines(style) {
        writeln!(out, "{line}")?;
    }
    write_legend(out, &legend, 0, style)
}

/// Supports and pairs as signs; the legend of those that occur.
fn draw_marks(scene: &Scene, fit: &mut Fit, style: &Style) -> Vec<(char, Role, String)> {
    let mut legend: Vec<(char, Role, String)> = Vec::new();
    let mut note = |sign: char, role: Role, word: &str| {
        let entry = (sign, role, word.to_owned());
        if !legend.contains(&entry) {
            legend.push(entry);
        }
    };
    for &(at, held) in &scene.supports {
        let (sign, word) = (support_sign(held, style.ascii), support_word(held));
        let (x, y) = fit.place(at);
        fit.canvas.put(x, y, sign, Role::Muted);
        note(sign, Role::Muted, word);
    }
    for pair in &scene.pairs {
        let (sign, role, word) = match pair.state {
            Some(state) => (pair_sign(state, pair.towards, style.ascii), Role::State(state), state.word()),
            None => (if style.ascii { 'o' } else { '◦' }, Role::Accent, "contact pair"),
        };
        let (x, y) = fit.place(pair.place);
        fit.canvas.put(x, y, sign, role);
        fit.canvas.label(x, y, &style.text(&pair.id), Role::Muted);
        note(sign, role, word);
    }
    legend
}
