//! The table of the pairs.

use std::rc::Rc;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

use crate::model::scenario::Source;
use crate::session::results::PairState;
use crate::text::number::{measured, short};
use crate::tui::app::State;
use crate::tui::kept::The;
use crate::tui::listing::{GUTTER, Listing, around};
use crate::tui::paint::{inside, put_text, report};
use crate::tui::pane::{Pane, SortKey};
use crate::tui::pictures::Sheet;
use crate::view::pairs::{part, state_words};
use crate::view::pivots::title;
use crate::view::style::Role;
use crate::view::{force_unit, length_unit};

/// The order, if it is not that of the file.
pub fn note(state: &State) -> String {
    if state.sort == SortKey::File && !state.descending {
        if state.shown.stage.is_some() {
            return super::loading::note(state);
        }
        return if state.shown.at_ray() {
            "last vertex before the ray".to_owned()
        } else {
            state.shown.position.map_or(String::new(), title)
        };
    }
    let arrow = if state.descending { "↓" } else { "↑" };
    format!("{} {arrow}", state.sort.word())
}

/// Heading and a line for each of the pairs around the selected one, in the chosen order.
fn listing(state: &State, area: Rect) -> Rc<Listing> {
    let sheet = Sheet { width: usize::from(area.width.saturating_sub(GUTTER)), look: state.look };
    let order = state.order();
    let shown = around(order.place(state.pair), order.pairs.len(), usize::from(area.height));
    let key = (The::one(&state.shown.moment), state.sort, state.descending, sheet, shown.clone());
    state.pictures.pairs.of(key, || {
        let all = state.shown.pairs();
        let pairs: Vec<&PairState> = order.pairs[shown.clone()].iter().map(|index| &all[*index]).collect();
        let units = &state.shown.scenario.units;
        let mut is_whole = true;
        let mut heading = report(state.look, sheet.width, |out, style| {
            is_whole = part(&pairs, all, units).write_beside(out, style)?;
            Ok(())
        });
        let rows = heading.split_off(heading.len().saturating_sub(pairs.len()));
        Listing::part(heading, rows, (shown.start, order.pairs.len())).whole(is_whole)
    })
}

/// Lines that the pane fills of those in the area.
pub fn height(state: &State, area: Rect) -> usize {
    match &state.shown.moment.solution {
        Some(solution) => solution.z.len() + 1,
        None => listing(state, area).height(),
    }
}

/// Whether every column of the table finds room.
pub fn is_whole(state: &State, area: Rect) -> bool {
    state.shown.moment.solution.is_some() || listing(state, area).is_whole
}

/// The pair in a row of the screen.
pub fn pair_at(state: &State, area: Rect, y: u16) -> Option<usize> {
    let inside = inside(area);
    let order = state.order();
    let row = listing(state, inside).row_at(order.place(state.pair), inside, y)?;
    order.pairs.get(row).copied()
}

/// Draws the pane.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let look = state.look;
    if let Some(solution) = &state.shown.moment.solution {
        draw_solution(state, (&solution.z, &solution.w), area, buffer);
        return;
    }
    let order = state.order();
    if order.pairs.is_empty() {
        put_text(look, "no contact pairs", look.role(Role::Muted), area, buffer);
        return;
    }
    let changed = |row: usize| order.pairs.get(row).is_some_and(|pair| state.shown.change(*pair).is_some());
    let selected = (order.place(state.pair), state.focus == Pane::Pairs);
    listing(state, area).draw(look, selected, changed, area, buffer);
}

/// Names of the rows of a bare LCP.
pub fn names(state: &State) -> Vec<String> {
    let count = state.shown.moment.solution.as_ref().map_or(0, |solution| solution.z.len());
    match &state.shown.scenario.source {
        Source::Lcp(given) if given.names.len() == count => given.names.clone(),
        _ => (1..=count).map(|row| row.to_string()).collect(),
    }
}

/// z and w of a bare LCP.
fn draw_solution(state: &State, (z, w): (&[f64], &[f64]), area: Rect, buffer: &mut Buffer) {
    let look = state.look;
    let row = |((name, z), w): ((&String, &f64), &f64)| {
        Line::raw(format!("{:<8}{:>14}{:>14}", look.fit(name, 8), short(*z), short(*w)))
    };
    let heading = vec![Line::styled(format!("{:<8}{:>14}{:>14}", "row", "z", "w"), look.role(Role::Header))];
    let listing = Listing::new(heading, names(state).iter().zip(z).zip(w).map(row).collect());
    listing.draw(look, (state.pair, state.focus == Pane::Pairs), |_| false, area, buffer);
}

/// The selected pair with all digits, to be copied.
pub fn copied(state: &State) -> Option<String> {
    if let Some(solution) = &state.shown.moment.solution {
        let (z, w) = (solution.z.get(state.pair)?, solution.w.get(state.pair)?);
        return Some(format!("{} z {z} w {w}", names(state).get(state.pair)?));
    }
    let pair = state.shown.pairs().get(state.pair)?;
    Some(format!(
        "{} {} x_n {} x_t {} z_n {} z_t {} bound {}",
        pair.id,
        state_words(pair),
        pair.x_n,
        pair.x_t,
        pair.z_n,
        pair.z_t,
        pair.bound
    ))
}

/// The selected pair in a line.
pub fn about(state: &State) -> Option<String> {
    let pair = state.shown.pairs().get(state.pair)?;
    let units = &state.shown.scenario.units;
    let (force, length) = (force_unit(units), length_unit(units));
    let f = |value: f64| measured(value, force.as_deref());
    let d = |value: f64| measured(value, length.as_deref());
    let mut text = format!("{} {}", pair.id, state_words(pair));
    if let Some(change) = state.shown.change(state.pair) {
        text.push_str(&format!(" (was {})", change.from));
    }
    text.push_str(&format!(" · x_n {}", f(pair.x_n)));
    if pair.space.is_some() && pair.law.has_tangential_joint() {
        text.push_str(&format!(" · |x_τ| {}, bound {}", short(pair.x_t), f(pair.bound)));
    } else if pair.law.has_tangential_joint() {
        text.push_str(&format!(" · x_τ {} within ±{}", short(pair.x_t), f(pair.bound)));
    }
    if pair.z_n != 0.0 {
        text.push_str(&format!(" · z_n {}", d(pair.z_n)));
    }
    text.push_str(&format!(" · z_τ {}", d(pair.z_t)));
    if pair.space.is_some() {
        text.push_str(&format!(" · reserve {}", short(pair.reserve())));
    } else if pair.law.has_tangential_joint() {
        text.push_str(&format!(" · reserves x⁺ {} x⁻ {}", short(pair.reserve_plus), short(pair.reserve_minus)));
    }
    Some(text)
}
