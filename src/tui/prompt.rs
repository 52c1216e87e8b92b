//! The line being typed, at the bottom.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::widgets::{Clear, Widget};
use unicode_width::UnicodeWidthStr;

use crate::session::language::complete;
use crate::view::style::{Role, pad_right};

use super::app::{Input, State};

/// Draws the line being typed into the last row; gives the place of the cursor.
pub fn draw(state: &State, bottom: Rect, buffer: &mut Buffer) -> Option<(u16, u16)> {
    let look = state.look;
    let (prompt, entry, hint) = match &state.input {
        Input::None => return None,
        Input::Command(entry) => (
            ":".to_owned(),
            entry,
            complete::hint(&entry.text, state.shown.vocabulary())
                .map(|hint| format!("{}{}", hint.insert, hint.note))
                .unwrap_or_default(),
        ),
        Input::Search { entry, .. } => {
            let hint = if entry.text.is_empty() { "a part of a row (Enter stays there, Esc goes back)" } else { "" };
            ("/".to_owned(), entry, hint.to_owned())
        }
        Input::Value { name, entry } => {
            let value = state.value(name);
            let hint = if entry.text.is_empty() {
                format!("{value}, or += 10, +5%  (Enter takes it, Esc drops it)")
            } else {
                String::new()
            };
            (format!("{name} = "), entry, hint)
        }
    };
    buffer.set_style(bottom, Style::reset());
    let blank = " ".repeat(usize::from(bottom.width));
    buffer.set_string(bottom.x, bottom.y, blank, Style::new());
    let prompt = look.text(&prompt);
    let room = usize::from(bottom.width).saturating_sub(prompt.width() + 1);
    // what stands before the cursor stays in view
    let mut start = 0;
    while entry.text[start..entry.cursor].width() > room {
        start += entry.text[start..].chars().next().map_or(1, char::len_utf8);
    }
    let end = bottom.right();
    let (x, _) = buffer.set_stringn(bottom.x, bottom.y, &prompt, usize::from(bottom.width), look.role(Role::Accent));
    let (after, _) =
        buffer.set_stringn(x, bottom.y, &entry.text[start..], usize::from(end.saturating_sub(x)), Style::new());
    if entry.cursor == entry.text.len() {
        buffer.set_stringn(
            after,
            bottom.y,
            look.text(&hint),
            usize::from(end.saturating_sub(after)),
            look.role(Role::Muted),
        );
    }
    draw_candidates(state, entry, bottom, buffer);
    let column = entry.text[start..entry.cursor].width() as u16;
    Some(((x + column).min(end.saturating_sub(1)), bottom.y))
}

/// The candidates of a completion, above the line.
fn draw_candidates(state: &State, entry: &super::entry::Entry, bottom: Rect, buffer: &mut Buffer) {
    if entry.offered.is_empty() {
        return;
    }
    let look = state.look;
    let most = usize::from(bottom.y).saturating_sub(3).clamp(1, 10);
    let chosen = entry.chosen.unwrap_or(0);
    let first = chosen.saturating_sub(most / 2).min(entry.offered.len().saturating_sub(most));
    let shown: Vec<_> = entry.offered.iter().skip(first).take(most).collect();
    let name = shown.iter().map(|c| c.text.width()).max().unwrap_or(0);
    let width = bottom.width;
    let height = shown.len() as u16;
    let place = Rect::new(bottom.x, bottom.y.saturating_sub(height), width, height);
    Clear.render(place, buffer);
    for (i, candidate) in shown.iter().enumerate() {
        let mut style = look.role(Role::Plain);
        if entry.chosen == Some(first + i) {
            style = style.patch(look.selected());
        }
        let text = format!(" {}  {} ", pad_right(&look.text(&candidate.text), name), look.text(&candidate.about));
        buffer.set_stringn(
            place.x,
            place.y + i as u16,
            pad_right(&text, usize::from(width)),
            usize::from(width),
            style,
        );
    }
}
