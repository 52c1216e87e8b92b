//! A list in a pane: a heading and rows, one of them selected; only the rows in view are drawn.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};
use ratatui::text::Line;

use super::paint::put_lines;
use super::theme::Look;
use crate::view::style::Role;

/// Columns ahead of every row, for its mark.
pub const GUTTER: u16 = 2;

/// First of `rows` rows that show the selected one of `count`.
pub fn window(selected: usize, count: usize, rows: usize) -> usize {
    selected.saturating_sub(rows / 2).min(count.saturating_sub(rows))
}

/// The rows that may come into view while the selected one of `count` stays in its page of `height` rows.
pub fn around(selected: usize, count: usize, height: usize) -> std::ops::Range<usize> {
    let height = height.max(1);
    let page = selected / height;
    page.saturating_sub(1) * height..((page + 2) * height).min(count)
}

/// The list, or the part of it around the rows in view.
pub struct Listing {
    /// Whether its lines say all there is to say of a row; a table may have more columns than find room.
    pub is_whole: bool,
    /// Stays at the top.
    heading: Vec<Line<'static>>,
    /// The rows, from this one on.
    rows: Vec<Line<'static>>,
    first: usize,
    /// How many there are in all.
    count: usize,
}

impl Listing {
    /// All of a list.
    pub fn new(heading: Vec<Line<'static>>, rows: Vec<Line<'static>>) -> Listing {
        Listing { is_whole: true, heading, first: 0, count: rows.len(), rows }
    }

    /// The rows of a list of `count` from `first` on, among them those around the selected one: see [`around`].
    pub fn part(heading: Vec<Line<'static>>, rows: Vec<Line<'static>>, (first, count): (usize, usize)) -> Listing {
        Listing { is_whole: true, heading, rows, first, count }
    }

    /// With the word whether its lines say all there is to say of a row.
    pub fn whole(self, is_whole: bool) -> Listing {
        Listing { is_whole, ..self }
    }

    /// Lines of the heading and of all rows.
    pub fn height(&self) -> usize {
        self.heading.len() + self.count
    }

    /// First row in view and how many there are.
    fn window(&self, selected: usize, area: Rect) -> (usize, usize) {
        let room = usize::from(area.height).saturating_sub(self.heading.len());
        (window(selected, self.count, room), room)
    }

    /// The row at a line of the screen.
    pub fn row_at(&self, selected: usize, area: Rect, y: u16) -> Option<usize> {
        let (first, room) = self.window(selected, area);
        let row = usize::from(y.checked_sub(area.y)?).checked_sub(self.heading.len())?;
        Some(first + row).filter(|at| row < room && *at < self.count)
    }

    /// Draws it; `starred` rows bear a star. The selected row is reversed where the pane has the focus, else bold.
    pub fn draw(
        &self,
        look: Look,
        (selected, focused): (usize, bool),
        starred: impl Fn(usize) -> bool,
        area: Rect,
        buffer: &mut Buffer,
    ) {
        let body = Rect::new(area.x + GUTTER, area.y, area.width.saturating_sub(GUTTER), area.height);
        put_lines(&self.heading, body, buffer);
        let (first, room) = self.window(selected, area);
        let rows = (self.first..).zip(&self.rows);
        for (row, line) in rows.filter(|(row, _)| (first..first + room).contains(row)) {
            // as many rows as the area has
            let y = area.y + (self.heading.len() + row - first) as u16;
            buffer.set_line(body.x, y, line, body.width);
            let mark = if row == selected { look.report(1).mark() } else { ' ' };
            let star = if starred(row) { '*' } else { ' ' };
            buffer.set_stringn(area.x, y, format!("{mark}{star}"), usize::from(GUTTER), look.role(Role::Accent));
            if row == selected {
                let style = if focused { look.selected() } else { Style::new().add_modifier(Modifier::BOLD) };
                buffer.set_style(Rect::new(area.x, y, area.width, 1), style);
            }
        }
    }
}
