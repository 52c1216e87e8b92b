//! The table of the pairs.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Modifier;
use ratatui::text::Line;

use crate::session::results::PairState;
use crate::tui::app::State;
use crate::tui::pane::{Pane, SortKey};
use crate::view::number::{short, with_unit};
use crate::view::pairs::{state_words, write};
use crate::view::style::Role;
use crate::view::{force_unit, length_unit};

/// The order, if it is not that of the file.
pub fn note(state: &State) -> String {
    if state.sort == SortKey::File && !state.descending {
        return if state.shown.at_ray() {
            "last vertex before the ray".to_owned()
        } else {
            state.shown.position.map_or(String::new(), |step| format!("pivot {step}"))
        };
    }
    let arrow = if state.descending { "↓" } else { "↑" };
    format!("{} {arrow}", state.sort.word())
}

/// Heading and a line per pair, in the chosen order.
fn table(state: &State, order: &[usize], width: usize) -> (Vec<Line<'static>>, usize) {
    let pairs: Vec<PairState> = order.iter().map(|index| state.shown.pairs[*index].clone()).collect();
    let units = &state.shown.scenario.units;
    let mut lines = super::report(state.look, width, |out, style| write(out, &pairs, units, style));
    // the remark on columns that found no room; no pair begins with a bracket
    if lines.last().and_then(|line| line.spans.first()).is_some_and(|span| span.content.trim_start().starts_with('(')) {
        lines.pop();
    }
    let heading = lines.len().saturating_sub(pairs.len());
    (lines, heading)
}

/// The pair in a row of the screen.
pub fn pair_at(state: &State, area: Rect, y: u16) -> Option<usize> {
    let inside = super::inside(area);
    let order = state.order();
    if order.is_empty() {
        return None;
    }
    let (_, heading) = table(state, &order, usize::from(inside.width.saturating_sub(2)));
    let rows = usize::from(inside.height).saturating_sub(heading);
    let row = usize::from(y.checked_sub(inside.y)?).checked_sub(heading)?;
    let selected = order.iter().position(|pair| *pair == state.pair);
    let first = super::window(selected.unwrap_or(0), order.len(), rows);
    (row < rows).then(|| order.get(first + row).copied())?
}

/// Draws the pane.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let look = state.look;
    if let Some(solution) = &state.shown.solution {
        draw_solution(state, &solution.z, &solution.w, area, buffer);
        return;
    }
    let order = state.order();
    if order.is_empty() {
        super::put_text(look, "no contact pairs", look.role(Role::Muted), area, buffer);
        return;
    }
    let (lines, heading) = table(state, &order, usize::from(area.width.saturating_sub(2)));
    let body = Rect::new(area.x + 2, area.y, area.width.saturating_sub(2), area.height);
    super::put_lines(&lines[..heading.min(lines.len())], body, buffer);
    let rows = usize::from(area.height).saturating_sub(heading);
    let at = order.iter().position(|pair| *pair == state.pair).unwrap_or(0);
    let first = super::window(at, order.len(), rows);
    for (row, line) in lines[heading..].iter().skip(first).take(rows).enumerate() {
        let y = area.y + (heading + row) as u16;
        buffer.set_line(body.x, y, line, body.width);
        let index = order[first + row];
        let id = &state.shown.pairs[index].id;
        let changed = state.shown.position.is_none() && state.shown.changes.iter().any(|change| change.pair == *id);
        let selected = index == state.pair;
        let mark = match (selected, changed) {
            (true, true) => format!("{}*", look.report(1).mark()),
            (true, false) => format!("{} ", look.report(1).mark()),
            (false, true) => " *".to_owned(),
            (false, false) => "  ".to_owned(),
        };
        buffer.set_stringn(area.x, y, mark, 2, look.role(Role::Accent));
        if selected && state.focus == Pane::Pairs {
            let row = Rect::new(area.x, y, area.width, 1);
            buffer.set_style(row, look.selected());
        } else if selected {
            let row = Rect::new(area.x, y, area.width, 1);
            buffer.set_style(row, ratatui::style::Style::new().add_modifier(Modifier::BOLD));
        }
    }
}

/// z and w of a bare LCP.
fn draw_solution(state: &State, z: &[f64], w: &[f64], area: Rect, buffer: &mut Buffer) {
    let look = state.look;
    let names: Vec<String> = match &state.shown.scenario.source {
        crate::model::scenario::Source::Lcp(given) => given.names.clone(),
        _ => (1..=z.len()).map(|i| i.to_string()).collect(),
    };
    let mut lines = vec![Line::styled(format!("{:<8}{:>14}{:>14}", "row", "z", "w"), look.role(Role::Header))];
    for (i, (z, w)) in z.iter().zip(w).enumerate() {
        let name = names.get(i).map_or("", String::as_str);
        lines.push(Line::raw(format!("{:<8}{:>14}{:>14}", look.fit(name, 8), short(*z), short(*w))));
    }
    super::put_lines(&lines, area, buffer);
}

/// The selected pair in a line.
pub fn about(state: &State) -> Option<String> {
    let pair = state.shown.pairs.get(state.pair)?;
    let units = &state.shown.scenario.units;
    let (force, length) = (force_unit(units), length_unit(units));
    let f = |value: f64| with_unit(&short(value), force.as_deref());
    let d = |value: f64| with_unit(&short(value), length.as_deref());
    let mut text = format!("{} {}", pair.id, state_words(pair));
    if let Some(change) = state.shown.changes.iter().find(|c| c.pair == pair.id)
        && state.shown.position.is_none()
    {
        text.push_str(&format!(" (was {})", change.from));
    }
    text.push_str(&format!(" · x_n {}", f(pair.x_n)));
    if pair.law.has_tangential_joint() {
        text.push_str(&format!(" · x_τ {} within ±{}", short(pair.x_t), f(pair.bound)));
    }
    if pair.z_n != 0.0 {
        text.push_str(&format!(" · z_n {}", d(pair.z_n)));
    }
    text.push_str(&format!(" · z_τ {}", d(pair.z_t)));
    if pair.law.has_tangential_joint() {
        text.push_str(&format!(" · reserves x⁺ {} x⁻ {}", short(pair.reserve_plus), short(pair.reserve_minus)));
    }
    Some(text)
}
