//! The structure: undeformed, as it was before the last change, deformed; supports, loads, pairs by state.

use std::sync::Arc;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

use super::legend::Legend;
use super::{loading, strip};
use crate::model::structure::{Dimension, LoadCase, Structure};
use crate::session::results::{PairDirection, Slip, State as PairMotion};
use crate::text::number::short;
use crate::tui::app::{PERIOD, State};
use crate::tui::kept::The;
use crate::tui::paint::{paste, put_lines, put_text};
use crate::tui::pane::Pane;
use crate::tui::pictures::{StructureKey, StructurePicture};
use crate::tui::viewport::View;
use crate::view::pivots::title;
use crate::view::plot::canvas::{Canvas, Stroke};
use crate::view::plot::case_loads::CaseLoads;
use crate::view::plot::chart::dotted;
use crate::view::plot::lines::{Displaced, Move};
use crate::view::plot::load_arrow::Drawn;
use crate::view::plot::scene::{supported, towards};
use crate::view::plot::skeleton::Skeleton;
use crate::view::plot::structure::{GRID_PITCH, HIDDEN_PITCH, pair_sign, support_sign, support_word};
use crate::view::projection::Projection;
use crate::view::style::Role;

/// The scale at which the displacements are drawn.
pub fn scale(state: &State) -> f64 {
    state.magnification.unwrap_or(state.shown.motion.automatic)
}

/// What the picture is, for the border.
pub fn note(state: &State) -> String {
    let Some(structure) = state.shown.structure() else { return String::new() };
    let mut note = match (state.shown.at_ray(), state.shown.has_mode()) {
        (true, true) if state.moving => "mode of the ray, moving".to_owned(),
        (true, true) => "mode of the ray".to_owned(),
        (true, false) if state.shown.is_behind() => "its mode follows".to_owned(),
        (true, false) => "ray without a motion".to_owned(),
        _ if state.shown.is_behind() => "displacements follow".to_owned(),
        _ => match &state.shown.motion.u {
            Some(u) if u.iter().any(|u| *u != [0.0; 6]) => format!("displacements × {}", short(scale(state))),
            _ => "undeformed".to_owned(),
        },
    };
    if structure.dimension == Dimension::Space {
        let viewpoint = state.viewpoint();
        let axes = Projection::new(Dimension::Space, viewpoint).axes_in_words();
        note.push_str(&format!(" · {} · {axes}", viewpoint.words()));
    }
    if state.view.zoom > 1.0 {
        note.push_str(&format!(" · zoom {}", short(state.view.zoom)));
    }
    let loading = loading::note(state);
    if !loading.is_empty() {
        note = format!("{loading} · {note}");
    }
    if let Some(step) = state.shown.position {
        note = format!("{} · {note}", title(step));
    }
    note
}

/// Dots between arrows of loads.
const BETWEEN_ARROWS: f64 = 8.0;

/// Draws the pane.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    match state.shown.structure().zip(state.shown.skeleton()) {
        Some(structure) => draw_structure(state, structure, area, buffer),
        None if state.shown.pairs().is_empty() => {
            let text = "A bare LCP, w = M z + q: there is no structure to draw. Pairs shows z and w, Pivots how \
                        they came about.";
            put_text(state.look, text, state.look.role(Role::Muted), area, buffer);
        }
        None => strip::draw(state, area, buffer),
    }
}

/// A structure and what its pictures share.
type Known<'a> = (&'a Structure, &'a Arc<Skeleton>);

fn draw_structure(state: &State, structure: Known<'_>, area: Rect, buffer: &mut Buffer) {
    let key = StructureKey {
        moment: The::one(&state.shown.moment),
        motion: The::one(&state.shown.motion),
        size: (area.width, area.height),
        look: state.look,
        view: state.view,
        viewpoint: state.viewpoint(),
        scale: scale(state),
        phase: state.shown.at_ray().then_some(state.phase),
        ghost: state.ghost,
        loads: state.loads,
    };
    let picture = state.pictures.structure.of(key, || picture(state, structure, area));
    paste(&picture.buffer, area, buffer);
    // what is selected or changed is marked on the kept picture
    let selected = matches!(state.focus, Pane::Pairs | Pane::Structure).then_some(state.pair);
    let place = |pair: usize| picture.pairs.get(pair).copied().flatten();
    let mut mark = |pair: usize, style: Style| {
        if let Some((column, row)) = place(pair)
            && let Some(cell) = buffer.cell_mut((area.x + column, area.y + row))
        {
            cell.set_style(style);
        }
    };
    if let Some(pair) = selected {
        mark(pair, state.look.selected());
    }
}

/// Draws the structure anew.
fn picture(state: &State, (structure, skeleton): Known<'_>, area: Rect) -> StructurePicture {
    let look = state.look;
    let mut buffer = Buffer::empty(Rect::new(0, 0, area.width, area.height));
    let rows = area.height.saturating_sub(1).max(1);
    let canvas = Canvas::new(usize::from(area.width), usize::from(rows));
    let projection = Projection::new(structure.dimension, state.viewpoint());
    let Some(view) = View::new(skeleton, &projection, state.view, &canvas) else {
        return StructurePicture { buffer, pairs: Vec::new() };
    };
    let swing = if state.shown.at_ray() {
        (std::f64::consts::TAU * f64::from(state.phase) / f64::from(PERIOD)).sin()
    } else {
        1.0
    };
    let factor = scale(state) * swing;
    let motion = &state.shown.motion;
    let moved = Move { u: motion.u.as_deref().unwrap_or_default(), factors: &motion.factors[0], by: factor };
    let displaced = Displaced::new((structure, skeleton), moved, &projection);
    let legend = Legend::default();
    let mut painter =
        Painter { state, structure, skeleton, projection: &projection, view, displaced, moved, canvas, legend };
    painter.draw_lines();
    painter.draw_supports();
    painter.draw_loads();
    let pairs = painter.draw_pairs();
    let Painter { canvas, mut legend, .. } = painter;
    let drawn = look.lines(&canvas.lines(&look.report(usize::from(area.width))).join("\n"));
    put_lines(&drawn, buffer.area, &mut buffer);
    for (pair, place) in pairs.iter().enumerate() {
        if let (Some(place), Some(_)) = (place, state.shown.change(pair))
            && let Some(cell) = buffer.cell_mut(*place)
        {
            cell.set_style(Style::new().add_modifier(Modifier::UNDERLINED | Modifier::BOLD));
        }
    }
    legend.sort();
    legend.draw(look, buffer.area, &mut buffer);
    StructurePicture { buffer, pairs }
}

/// The layers of the picture.
struct Painter<'s> {
    state: &'s State,
    structure: &'s Structure,
    skeleton: &'s Arc<Skeleton>,
    projection: &'s Projection,
    view: View,
    displaced: Displaced<'s>,
    moved: Move<'s>,
    canvas: Canvas,
    legend: Legend,
}

impl Painter<'_> {
    /// Dot of a node, displaced.
    fn dot(&self, node: usize) -> (f64, f64) {
        self.view.place(self.displaced.at(node))
    }

    /// A sign at a dot, if that is in view.
    fn put(&mut self, (x, y): (f64, f64), sign: char, role: Role, word: &str) {
        if self.view.holds((x, y)) {
            self.canvas.put(x, y, sign, role);
            self.legend.note(sign, role, word);
        }
    }

    /// The structure as it is, as it was before, as it was built, and its grid.
    fn draw_lines(&mut self) {
        let look = self.state.look;
        let outline = self.displaced.outline();
        let now = self.view.clip(&outline.seen);
        self.canvas.draw(Role::Plain, now.into_iter().map(Stroke::Line).collect());
        let motion = &self.state.shown.motion;
        if let Some(before) = motion.before.as_ref().filter(|_| self.state.ghost) {
            let moved = Move { u: before, factors: &motion.factors[1], ..self.moved };
            let before = Displaced::new((self.structure, self.skeleton), moved, self.projection).outline();
            self.draw_faint(Role::Series(1), &before.seen, 2.5);
            self.legend.note(look.sign('┈', ':'), Role::Series(1), "before");
        }
        if self.moved.by != 0.0 && self.moved.u.iter().any(|u| *u != [0.0; 6]) {
            let built = Displaced::new((self.structure, self.skeleton), Move::default(), self.projection).outline();
            self.draw_faint(Role::Muted, &built.seen, 5.0);
            self.legend.note(look.sign('·', '.'), Role::Muted, "undeformed");
        }
        self.draw_faint(Role::Muted, &outline.hidden, HIDDEN_PITCH);
        let grid = self.displaced.grid(GRID_PITCH / self.view.pitch);
        if grid.pitch * self.view.pitch >= GRID_PITCH {
            self.draw_faint(Role::Muted, &grid.lines, 2.0);
        }
    }

    fn draw_faint(&mut self, role: Role, lines: &[Vec<(f64, f64)>], pitch: f64) {
        let lines = self.view.clip(lines);
        let strokes = lines.iter().map(|line| Stroke::Dots(dotted(line, pitch))).collect();
        self.canvas.draw_under(role, strokes);
    }

    fn draw_supports(&mut self) {
        let look = self.state.look;
        for (node, held) in supported(self.structure) {
            self.put(self.dot(node), support_sign(held, look.ascii), Role::Muted, support_word(held));
        }
        for node in self.structure.springs.iter().flat_map(|spring| spring.nodes()) {
            self.put(self.dot(node), look.sign('≷', 'S'), Role::Muted, "spring");
        }
    }

    fn draw_loads(&mut self) {
        let (state, look) = (self.state, self.state.look);
        if !state.loads {
            return;
        }
        let (middle, extent) = self.view.extent();
        // those of the loading shown
        let shown = &state.shown;
        let factor = |case: &LoadCase| case.factor.value(&shown.values) * shown.multiplier(&case.name);
        let factors: Vec<f64> = self.structure.load_cases.iter().map(factor).collect();
        let key = (The::one(self.skeleton), The::one(&shown.motion));
        let loads = state.pictures.loads.of(key, || CaseLoads::of(self.structure, self.moved.u));
        let loads = loads.seen(&factors, self.moved.by, self.projection);
        let arrows = loads.arrows(BETWEEN_ARROWS / self.view.pitch);
        let words = loads.legend(&arrows, &state.shown.scenario.units);
        for arrow in &arrows.arrows {
            let drawn = Drawn::new(arrow, self.view.place(arrow.at), middle, extent);
            if let Some(drawn) = drawn.cut(|end| self.view.holds(end)) {
                drawn.draw(&mut self.canvas, look.ascii);
                let text = words.iter().find(|(kind, _)| *kind == arrow.kind).map_or("load", |(_, text)| text);
                self.legend.note(drawn.sign(look.ascii), Role::Accent, text);
            }
        }
    }

    /// The signs of the pairs; gives their places.
    fn draw_pairs(&mut self) -> Vec<Option<(u16, u16)>> {
        let (look, shown) = (self.state.look, &self.state.shown);
        // in the mode of a ray a pair is shown by its motion
        let directions = shown
            .answer()
            .filter(|_| shown.has_mode())
            .and_then(|answer| answer.ray.as_ref())
            .map(|ray| ray.direction.pairs());
        let mut places = Vec::with_capacity(shown.pairs().len());
        for (index, (pair, now)) in self.structure.pairs.iter().zip(shown.pairs()).enumerate() {
            let (x, y) = self.view.place(self.displaced.at_pair(pair));
            if !self.view.holds((x, y)) {
                places.push(None);
                continue;
            }
            let (motion, slip) = match directions.and_then(|directions| directions.get(index)) {
                Some(direction) => (in_motion(direction), direction.slip()),
                None => (now.state, now.slip()),
            };
            let sign = pair_sign(motion, towards(pair, motion, &slip, self.projection), look.ascii);
            self.put((x, y), sign, Role::State(motion), motion.word());
            self.canvas.label(x, y, &look.text(&pair.id), Role::Muted);
            // the canvas is as large as the area
            places.push(self.canvas.cell(x, y).map(|(column, row)| (column as u16, row as u16)));
        }
        places
    }
}

/// The state a pair moves in, in the direction of a ray (largest 1).
fn in_motion(direction: &PairDirection) -> PairMotion {
    if direction.parts() {
        return PairMotion::Open;
    }
    match direction.z_t {
        _ if !direction.slips() => PairMotion::Stick,
        Slip::Space(_) => PairMotion::Slip,
        Slip::Plane(slip) if slip > 0.0 => PairMotion::SlipPlus,
        Slip::Plane(_) => PairMotion::SlipMinus,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::ray::motion_words;

    /// A direction is scaled to its largest entry and freed of rounding: what is left in it moves, in words and in the
    /// picture.
    #[test]
    fn pairs_move_in_the_picture_as_they_do_in_words() {
        for (z_n, z_t, words, motion) in [
            (0.0, Slip::Plane(0.0), None, PairMotion::Stick),
            (0.0, Slip::Space([0.0; 2]), None, PairMotion::Stick),
            (1e-10, Slip::Plane(0.0), Some("parts"), PairMotion::Open),
            (1.0, Slip::Plane(1e-10), Some("parts and slips"), PairMotion::Open),
            (0.0, Slip::Plane(1e-10), Some("slips +"), PairMotion::SlipPlus),
            (0.0, Slip::Plane(-1e-10), Some("slips -"), PairMotion::SlipMinus),
            (0.0, Slip::Space([0.0, 1e-10]), Some("slips towards 90°"), PairMotion::Slip),
        ] {
            let direction = PairDirection { pair: "c".into(), z_n, z_t };
            assert_eq!(motion_words(&direction).as_deref(), words, "{direction:?}");
            assert_eq!(in_motion(&direction), motion, "{direction:?}");
        }
    }
}
