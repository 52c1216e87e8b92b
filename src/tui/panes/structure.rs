//! The structure: undeformed, as it was before the last change, deformed; supports, loads, pairs by state.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

use crate::model::structure::Structure;
use crate::session::results::{PairDirection, PairState, State as PairMotion};
use crate::tui::app::{PERIOD, State};
use crate::tui::pane::Pane;
use crate::view::number::short;
use crate::view::plot::canvas::{Canvas, Stroke};
use crate::view::plot::chart::{dotted, range};
use crate::view::plot::scene::{Magnification, arrows, factor, lines, nodal, supported};
use crate::view::plot::structure::{GRID_PITCH, grid_pitch, load_signs, pair_sign, support_sign, support_word};
use crate::view::plot::zone::zone;
use crate::view::style::Role;

/// Displacements shown: those of the ray's motion at its end, else those of the pivot.
fn displacements(state: &State, structure: &Structure) -> Option<Vec<[f64; 3]>> {
    let shown = &state.shown;
    if shown.at_ray() {
        return shown.mode.as_ref().map(|mode| nodal(structure, mode));
    }
    shown.displacements.as_ref().map(|u| nodal(structure, u))
}

/// The automatic scale. While stepping it is that of the answer, so that pictures can be compared.
pub fn automatic(state: &State) -> f64 {
    let Some(structure) = state.shown.structure() else {
        return 1.0;
    };
    let shown = displacements(state, structure);
    let end = state.shown.answer().and_then(|answer| answer.displacements.as_ref()).map(|u| nodal(structure, u));
    let moves = |u: &Vec<[f64; 3]>| u.iter().any(|u| u[0] != 0.0 || u[1] != 0.0);
    match (end.filter(moves), shown) {
        (Some(u), _) if !state.shown.at_ray() => factor(structure, &u, Magnification::Auto),
        (_, Some(u)) => factor(structure, &u, Magnification::Auto),
        _ => 1.0,
    }
}

fn scale(state: &State) -> f64 {
    state.magnification.unwrap_or_else(|| automatic(state))
}

/// What the picture is, for the border.
pub fn note(state: &State) -> String {
    let Some(structure) = state.shown.structure() else {
        return String::new();
    };
    let mut note = match (state.shown.at_ray(), state.shown.mode.is_some()) {
        (true, true) if state.moving => "mode of the ray, moving".to_owned(),
        (true, true) => "mode of the ray".to_owned(),
        (true, false) => "ray without a motion".to_owned(),
        _ => match displacements(state, structure) {
            Some(u) if u.iter().any(|u| *u != [0.0; 3]) => {
                format!("displacements × {}", short(scale(state)))
            }
            _ => "undeformed".to_owned(),
        },
    };
    if state.view.zoom > 1.0 {
        note.push_str(&format!(" · zoom {}", short(state.view.zoom)));
    }
    if let Some(step) = state.shown.position {
        note = format!("pivot {step} · {note}");
    }
    note
}

/// From the plane of the structure to dots of the canvas.
struct View {
    pitch: f64,
    from: (f64, f64),
    to: (f64, f64),
    dots: (f64, f64),
}

impl View {
    fn new(structure: &Structure, state: &State, canvas: &Canvas) -> Option<View> {
        let of = |axis: usize| range(structure.nodes.iter().map(|node| node.position[axis]));
        let ((left, right), (bottom, top)) = (of(0), of(1));
        let size = (right - left).max(top - bottom);
        if !size.is_finite() || structure.nodes.is_empty() {
            return None;
        }
        let size = if size > 0.0 { size } else { 1.0 };
        let dots = (canvas.dots_x(), canvas.dots_y());
        // room for displacements of a tenth of the size at every side, and for the signs of the loads
        let wide = (right - left) + 0.24 * size;
        let high = (top - bottom) + 0.24 * size;
        let flat = top - bottom < 0.05 * size;
        let pitch_y = (dots.1 - 8.0).max(4.0) / high;
        let pitch = if flat { (dots.0 - 4.0).max(4.0) / wide } else { pitch_y.min((dots.0 - 4.0).max(4.0) / wide) }
            * state.view.zoom;
        Some(View {
            pitch,
            from: (
                0.5 * (left + right) + state.view.centre.0 * size,
                0.5 * (bottom + top) + state.view.centre.1 * size,
            ),
            to: (0.5 * dots.0, 0.5 * dots.1),
            dots,
        })
    }

    fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        ((x - self.from.0) * self.pitch + self.to.0, (y - self.from.1) * self.pitch + self.to.1)
    }

    fn holds(&self, (x, y): (f64, f64)) -> bool {
        (-0.5..=self.dots.0 + 0.5).contains(&x) && (-0.5..=self.dots.1 + 0.5).contains(&y)
    }

    /// The pieces of lines that are in view, in dots.
    fn clip(&self, all: &[Vec<(f64, f64)>]) -> Vec<Vec<(f64, f64)>> {
        let mut pieces = Vec::new();
        for line in all {
            let mut piece: Vec<(f64, f64)> = Vec::new();
            let placed: Vec<(f64, f64)> = line.iter().map(|point| self.place(*point)).collect();
            for ends in placed.windows(2) {
                match segment(ends[0], ends[1], self.dots) {
                    Some((a, b)) => {
                        if piece.last() != Some(&a) {
                            if piece.len() > 1 {
                                pieces.push(std::mem::take(&mut piece));
                            }
                            piece = vec![a];
                        }
                        piece.push(b);
                    }
                    None if piece.len() > 1 => pieces.push(std::mem::take(&mut piece)),
                    None => piece.clear(),
                }
            }
            if piece.len() > 1 {
                pieces.push(piece);
            }
        }
        pieces
    }
}

/// The part of a segment within 0 … dots (Liang and Barsky).
fn segment(a: (f64, f64), b: (f64, f64), dots: (f64, f64)) -> Option<((f64, f64), (f64, f64))> {
    if ![a.0, a.1, b.0, b.1].iter().all(|x| x.is_finite()) {
        return None;
    }
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for (p, q) in [(-dx, a.0), (dx, dots.0 - a.0), (-dy, a.1), (dy, dots.1 - a.1)] {
        if p == 0.0 {
            if q < 0.0 {
                return None;
            }
        } else if p < 0.0 {
            from = from.max(q / p);
        } else {
            to = to.min(q / p);
        }
    }
    (from <= to).then_some(((a.0 + from * dx, a.1 + from * dy), (a.0 + to * dx, a.1 + to * dy)))
}

/// Draws the pane.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    match state.shown.structure() {
        Some(structure) => draw_structure(state, structure, area, buffer),
        None if state.shown.pairs.is_empty() => {
            let text = "A bare LCP, w = M z + q: there is no structure to draw. Pairs shows z and w, Pivots how \
                        they came about.";
            super::put_text(state.look, text, state.look.role(Role::Muted), area, buffer);
        }
        None => draw_zone(state, area, buffer),
    }
}

/// The signs of a picture: those of one meaning together.
#[derive(Default)]
struct Legend(Vec<(String, Role, String)>);

impl Legend {
    fn note(&mut self, sign: char, role: Role, word: &str) {
        match self.0.iter_mut().find(|(_, r, w)| *r == role && w == word) {
            Some((signs, ..)) if signs.contains(sign) => {}
            Some((signs, ..)) => signs.push(sign),
            None => self.0.push((sign.to_string(), role, word.to_owned())),
        }
    }

    /// States of pairs first: they are what one looks for.
    fn sort(&mut self) {
        self.0.sort_by_key(|(_, role, word)| match (role, word.as_str()) {
            (Role::State(_), _) => 0,
            (_, "load") => 1,
            (_, "before") => 2,
            (_, "undeformed") => 4,
            _ => 3,
        });
    }

    fn draw(&self, state: &State, area: Rect, buffer: &mut Buffer) {
        let look = state.look;
        let mut x = area.x;
        let y = area.bottom().saturating_sub(1);
        for (sign, role, word) in &self.0 {
            let word = look.text(word);
            let need = sign.chars().count() + 1 + word.chars().count();
            if usize::from(x) + need > usize::from(area.right()) {
                break;
            }
            let room = usize::from(area.right() - x);
            let (after, _) = buffer.set_stringn(x, y, sign, room, look.role(*role));
            let text = format!(" {word}");
            let room = usize::from(area.right().saturating_sub(after));
            let (after, _) = buffer.set_stringn(after, y, text, room, look.role(Role::Muted));
            x = after.saturating_add(3).min(area.right());
        }
    }
}

fn draw_structure(state: &State, structure: &Structure, area: Rect, buffer: &mut Buffer) {
    let look = state.look;
    let shown = &state.shown;
    let report = look.report(usize::from(area.width));
    let rows = area.height.saturating_sub(1).max(1);
    let mut canvas = Canvas::new(usize::from(area.width), usize::from(rows));
    let Some(view) = View::new(structure, state, &canvas) else {
        return;
    };
    let mut legend = Legend::default();
    let rest = vec![[0.0; 3]; structure.nodes.len()];
    let u = displacements(state, structure).unwrap_or_else(|| rest.clone());
    let swing = if shown.at_ray() {
        let angle = std::f64::consts::TAU * f64::from(state.phase) / f64::from(PERIOD);
        angle.sin()
    } else {
        1.0
    };
    let factor = scale(state) * swing;
    let moves = u.iter().any(|u| *u != [0.0; 3]) && factor != 0.0;
    let now = lines(structure, &u, factor);
    let outline = view.clip(&now.outline);
    canvas.draw(Role::Plain, outline.into_iter().map(Stroke::Line).collect());

    let faint = |lines: &[Vec<(f64, f64)>], pitch: f64| -> Vec<Stroke> {
        view.clip(lines).iter().map(|line| Stroke::Dots(dotted(line, pitch))).collect()
    };
    let before = shown
        .before()
        .and_then(|answer| answer.displacements.as_ref())
        .filter(|_| state.ghost && shown.has_before())
        .map(|u| nodal(structure, u))
        .filter(|before| *before != u);
    if let Some(before) = &before {
        let ghost = lines(structure, before, factor);
        canvas.draw_under(Role::Series(1), faint(&ghost.outline, 2.5));
        legend.note(look.sign('┈', ':'), Role::Series(1), "before");
    }
    if moves {
        canvas.draw_under(Role::Muted, faint(&lines(structure, &rest, 0.0).outline, 5.0));
        legend.note(look.sign('·', '.'), Role::Muted, "undeformed");
    }
    if grid_pitch(structure, view.pitch) >= GRID_PITCH {
        canvas.draw_under(Role::Muted, faint(&now.grid, 2.0));
    }

    let at = |node: usize| {
        let position = structure.nodes.get(node).map_or([0.0; 2], |n| n.position);
        let u = u.get(node).copied().unwrap_or_default();
        view.place((position[0] + factor * u[0], position[1] + factor * u[1]))
    };
    for (node, held) in supported(structure) {
        let (sign, word) = (support_sign(held, look.ascii), support_word(held));
        let (x, y) = at(node);
        if view.holds((x, y)) {
            canvas.put(x, y, sign, Role::Muted);
            legend.note(sign, Role::Muted, word);
        }
    }
    for node in structure.springs.iter().flat_map(|spring| spring.nodes()) {
        let (x, y) = at(node);
        if view.holds((x, y)) {
            let sign = look.sign('≷', 'S');
            canvas.put(x, y, sign, Role::Muted);
            legend.note(sign, Role::Muted, "spring");
        }
    }
    let (left, right) = range(structure.nodes.iter().map(|node| node.position[0]));
    let middle = view.place((0.5 * (left + right), 0.0)).0;
    for arrow in arrows(structure, &shown.values) {
        let count = arrow.nodes.len().max(1) as f64;
        let (mut x, mut y) = (0.0, 0.0);
        for &node in &arrow.nodes {
            let (node_x, node_y) = at(node);
            x += node_x / count;
            y += node_y / count;
        }
        for (sign, step_x, step_y) in load_signs(arrow.force, look.ascii) {
            // a push stands before its body, a pull behind it: outside in either case
            let side = if x < middle { -step_x.abs() } else { step_x.abs() };
            let place = (x + side, y + step_y);
            if view.holds(place) {
                canvas.put(place.0, place.1, sign, Role::Accent);
                legend.note(sign, Role::Accent, "load");
            }
        }
    }
    // in the mode of a ray a pair is shown by its motion
    let directions = shown
        .answer()
        .filter(|_| shown.at_ray() && shown.mode.is_some())
        .and_then(|answer| answer.ray.as_ref())
        .map(|ray| ray.direction.pairs());
    let mut marks: Vec<(usize, usize, bool)> = Vec::new();
    for (index, pair) in structure.pairs.iter().enumerate() {
        let Some(now) = shown.pairs.get(index) else {
            continue;
        };
        let (x, y) = at(pair.node);
        if !view.holds((x, y)) {
            continue;
        }
        let state_shown = directions.and_then(|directions| directions.get(index)).map_or(now.state, in_motion);
        let sign = pair_sign(state_shown, pair.tangent(), look.ascii);
        let role = Role::State(state_shown);
        canvas.put(x, y, sign, role);
        canvas.label(x, y, &look.text(&pair.id), Role::Muted);
        legend.note(sign, role, state_shown.word());
        let changed = shown.position.is_none() && shown.changes.iter().any(|change| change.pair == pair.id);
        let selected = index == state.pair && matches!(state.focus, Pane::Pairs | Pane::Structure);
        if let Some((column, row)) = canvas.cell(x, y).filter(|_| changed || selected) {
            marks.push((column, row, selected));
        }
    }
    let drawn = look.lines(&canvas.lines(&report).join("\n"));
    super::put_lines(&drawn, area, buffer);
    for (column, row, selected) in marks {
        // the canvas is as large as the area
        let cell = (area.x + column as u16, area.y + row as u16);
        if let Some(cell) = buffer.cell_mut(cell) {
            cell.set_style(if selected {
                look.selected()
            } else {
                Style::new().add_modifier(Modifier::UNDERLINED | Modifier::BOLD)
            });
        }
    }
    legend.sort();
    legend.draw(state, area, buffer);
}

/// The state a pair moves in, in the direction of a ray (largest 1).
fn in_motion(direction: &PairDirection) -> PairMotion {
    const NOTHING: f64 = 1e-9;
    if direction.z_n > NOTHING {
        PairMotion::Open
    } else if direction.z_t > NOTHING {
        PairMotion::SlipPlus
    } else if direction.z_t < -NOTHING {
        PairMotion::SlipMinus
    } else {
        PairMotion::Stick
    }
}

/// The pairs of a contact system along a line.
fn draw_zone(state: &State, area: Rect, buffer: &mut Buffer) {
    let look = state.look;
    let pairs: &[PairState] = &state.shown.pairs;
    let text = "A contact system (R and RF are given): there is no structure, only its pairs.";
    super::put_text(look, text, look.role(Role::Muted), area, buffer);
    let rows = area.height.saturating_sub(1).max(1);
    let mut canvas = Canvas::new(usize::from(area.width), usize::from(rows));
    let zone = zone(pairs);
    let (first, last) = range(zone.abscissas.iter().copied());
    let mut legend = Legend::default();
    let (width, y) = (canvas.dots_x(), canvas.dots_y() / 2.0);
    if last > first {
        canvas.draw(Role::Muted, vec![Stroke::Line(vec![(4.0, y), (width - 4.0, y)])]);
    }
    for (pair, at) in pairs.iter().zip(&zone.abscissas) {
        let share = if last > first { (at - first) / (last - first) } else { 0.5 };
        let x = 4.0 + share * (width - 8.0);
        let sign = pair_sign(pair.state, [1.0, 0.0], look.ascii);
        canvas.put(x, y, sign, Role::State(pair.state));
        canvas.label(x, y, &look.text(&pair.id), Role::Muted);
        legend.note(sign, Role::State(pair.state), pair.state.word());
    }
    let report = look.report(usize::from(area.width));
    let drawn = look.lines(&canvas.lines(&report).join("\n"));
    for (row, line) in drawn.iter().enumerate().skip(3) {
        if row < usize::from(rows) {
            buffer.set_line(area.x, area.y + row as u16, line, area.width);
        }
    }
    legend.sort();
    legend.draw(state, area, buffer);
}
