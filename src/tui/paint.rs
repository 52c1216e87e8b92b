//! Lines and pictures into the characters of the screen.

use std::io::{self, Write};

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::Line;

use super::theme::Look;
use crate::view::style;

/// A pane without its border.
pub fn inside(area: Rect) -> Rect {
    Rect::new(area.x + 1, area.y + 1, area.width.saturating_sub(2), area.height.saturating_sub(2))
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
pub fn put_lines(lines: &[Line<'_>], area: Rect, buffer: &mut Buffer) {
    for (row, line) in lines.iter().take(usize::from(area.height)).enumerate() {
        buffer.set_line(area.x, area.y + row as u16, line, area.width);
    }
}

/// Writes a text, broken into lines.
pub fn put_text(look: Look, text: &str, style: Style, area: Rect, buffer: &mut Buffer) {
    let lines: Vec<Line<'_>> = look
        .report(usize::from(area.width))
        .wrap(text, usize::from(area.width))
        .into_iter()
        .map(|line| Line::styled(line, style))
        .collect();
    put_lines(&lines, area, buffer);
}

/// Puts a picture into an area of its size.
pub fn paste(picture: &Buffer, area: Rect, buffer: &mut Buffer) {
    for y in 0..picture.area.height.min(area.height) {
        for x in 0..picture.area.width.min(area.width) {
            if let Some(cell) = buffer.cell_mut((area.x + x, area.y + y)) {
                cell.clone_from(&picture[(x, y)]);
            }
        }
    }
}
