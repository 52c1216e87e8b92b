//! The panes: each draws its part of the state into a rectangle.

pub mod answer;
pub mod pairs;
pub mod parameters;
pub mod pivots;
pub mod plot;
pub mod structure;

use std::io::{self, Write};

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::Line;

use crate::view::style;

use super::app::State;
use super::pane::Pane;
use super::theme::Look;

/// Draws the inside of a pane.
pub fn draw(state: &State, pane: Pane, area: Rect, buffer: &mut Buffer) {
    if area.is_empty() {
        return;
    }
    match pane {
        Pane::Structure => structure::draw(state, area, buffer),
        Pane::Parameters => parameters::draw(state, area, buffer),
        Pane::Pairs => pairs::draw(state, area, buffer),
        Pane::Pivots => pivots::draw(state, area, buffer),
        Pane::Plot => plot::draw(state, area, buffer),
        Pane::Answer => answer::draw(state, area, buffer),
    }
}

/// What stands in the border of a pane, at the right.
pub fn note(state: &State, pane: Pane) -> String {
    match pane {
        Pane::Structure => structure::note(state),
        Pane::Pairs => pairs::note(state),
        Pane::Pivots => pivots::note(state),
        Pane::Parameters | Pane::Plot | Pane::Answer => String::new(),
    }
}

/// A pane without its border.
pub fn inside(area: Rect) -> Rect {
    Rect::new(area.x + 1, area.y + 1, area.width.saturating_sub(2), area.height.saturating_sub(2))
}

/// First of `rows` rows that show the selected one of `count`.
pub fn window(selected: usize, count: usize, rows: usize) -> usize {
    selected.saturating_sub(rows / 2).min(count.saturating_sub(rows))
}

/// The lines of a report of `width` columns.
pub fn report(
    look: Look,
    width: usize,
    write: impl FnOnce(&mut dyn Write, &style::Style) -> io::Result<()>,
) -> Vec<Line<'static>> {
    let mut text = Vec::new();
    // writing to memory does not fail
    let _ = write(&mut text, &look.report(width));
    look.lines(&String::from_utf8_lossy(&text))
}

/// Writes lines from the top, as far as they fit.
fn put_lines(lines: &[Line<'_>], area: Rect, buffer: &mut Buffer) {
    for (row, line) in lines.iter().take(usize::from(area.height)).enumerate() {
        buffer.set_line(area.x, area.y + row as u16, line, area.width);
    }
}

/// Writes a text, broken into lines.
fn put_text(look: Look, text: &str, style: Style, area: Rect, buffer: &mut Buffer) {
    let lines: Vec<Line<'_>> = look
        .report(usize::from(area.width))
        .wrap(text, usize::from(area.width))
        .into_iter()
        .map(|line| Line::styled(line, style))
        .collect();
    put_lines(&lines, area, buffer);
}
