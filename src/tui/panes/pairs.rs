//! The table of the pairs.

use std::rc::Rc;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

use crate::session::results::PairState;
use crate::text::number::{short, with_unit};
use crate::tui::app::State;
use crate::tui::kept::The;
use crate::tui::listing::{GUTTER, Listing};
use crate::tui::paint::{inside, put_lines, put_text, report};
use crate::tui::pane::{Pane, SortKey};
use crate::tui::pictures::Sheet;
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
fn listing(state: &State, width: u16) -> Rc<Listing> {
    let sheet = Sheet { width: usize::from(width.saturating_sub(GUTTER)), look: state.look };
    let key = (The::one(&state.shown.moment), state.sort, state.descending, sheet);
    state.pictures.pairs.of(key, || {
        let pairs: Vec<PairState> =
            state.order().pairs.iter().map(|index| state.shown.pairs()[*index].clone()).collect();
        let units = &state.shown.scenario.units;
        let mut lines = report(state.look, sheet.width, |out, style| write(out, &pairs, units, style));
        // the remark on columns that found no room; no pair begins with a bracket
        let remark =
            |line: &Line<'_>| line.spans.first().is_some_and(|span| span.content.trim_start().starts_with('('));
        if lines.last().is_some_and(remark) {
            lines.pop();
        }
        let rows = lines.split_off(lines.len().saturating_sub(pairs.len()));
        Listing { heading: lines, rows }
    })
}

/// The pair in a row of the screen.
pub fn pair_at(state: &State, area: Rect, y: u16) -> Option<usize> {
    let inside = inside(area);
    let order = state.order();
    let row = listing(state, inside.width).row_at(order.place(state.pair), inside, y)?;
    order.pairs.get(row).copied()
}

/// Draws the pane.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let look = state.look;
    if let Some(solution) = &state.shown.moment.solution {
        draw_solution(state, &solution.z, &solution.w, area, buffer);
        return;
    }
    let order = state.order();
    if order.pairs.is_empty() {
        put_text(look, "no contact pairs", look.role(Role::Muted), area, buffer);
        return;
    }
    let changed = |row: usize| order.pairs.get(row).is_some_and(|pair| state.shown.change(*pair).is_some());
    let selected = (order.place(state.pair), state.focus == Pane::Pairs);
    listing(state, area.width).draw(look, selected, changed, area, buffer);
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
    put_lines(&lines, area, buffer);
}

/// The selected pair in a line.
pub fn about(state: &State) -> Option<String> {
    let pair = state.shown.pairs().get(state.pair)?;
    let units = &state.shown.scenario.units;
    let (force, length) = (force_unit(units), length_unit(units));
    let f = |value: f64| with_unit(&short(value), force.as_deref());
    let d = |value: f64| with_unit(&short(value), length.as_deref());
    let mut text = format!("{} {}", pair.id, state_words(pair));
    if let Some(change) = state.shown.change(state.pair) {
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
