//! Probes of the scenario, and quantities that were asked for.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use unicode_width::UnicodeWidthStr;

use crate::tui::app::State;
use crate::tui::kept::The;
use crate::tui::listing::{GUTTER, Listing};
use crate::tui::paint::{inside, put_text};
use crate::tui::pane::Pane;
use crate::view::style::{Role, pad_right};

fn listing(state: &State, width: u16) -> Listing {
    let look = state.look;
    let width = usize::from(width.saturating_sub(GUTTER));
    let names: Vec<String> = state.gauges.iter().map(|gauge| look.text(&gauge.quantity.to_string())).collect();
    let name = names.iter().map(|name| name.width()).max().unwrap_or(0).min(width * 3 / 5);
    // while a new state has no values yet, those of the last one are shown as such
    let is_old = state.gauges_at.as_ref() != Some(&The::one(&state.shown.moment));
    let rows = state.gauges.iter().zip(&names).map(|(gauge, text)| {
        let room = width.saturating_sub(name + 2);
        let role = if is_old { Role::Muted } else { gauge.role };
        Line::from(vec![
            Span::raw(format!("{}  ", pad_right(&look.fit(text, name), name))),
            Span::styled(look.fit(&gauge.value, room), look.role(role)),
        ])
    });
    Listing::new(Vec::new(), rows.collect())
}

/// The quantity in a row of the screen.
pub fn row_at(state: &State, area: Rect, y: u16) -> Option<usize> {
    let inside = inside(area);
    listing(state, inside.width).row_at(state.quantity, inside, y)
}

/// Draws the pane.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let look = state.look;
    if state.gauges.is_empty() {
        let text = if state.shown.solved.is_none() {
            "not solved yet"
        } else if state.gauges_at.is_none() {
            "their values come in a moment"
        } else {
            "no quantities: Enter asks for one, `help show` lists them all"
        };
        put_text(look, text, look.role(Role::Muted), area, buffer);
        return;
    }
    let selected = (state.quantity, state.focus == Pane::Quantities);
    listing(state, area.width).draw(look, selected, |_| false, area, buffer);
}
