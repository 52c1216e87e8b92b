//! What lies over the panes: keys, output of commands, answers side by side.

use std::rc::Rc;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::{Block, Clear, Widget};

use crate::view::style::Role;

use super::answers::side_by_side;
use super::app::{Overlay, State};
use super::help;
use super::rewrap;

/// Width of the text of an overlay.
pub fn text_width(state: &State) -> usize {
    usize::from(state.size.0).saturating_sub(6).clamp(20, 160)
}

/// Lines of an overlay that are seen at once.
fn rows(state: &State) -> usize {
    usize::from(state.size.1).saturating_sub(5).max(1)
}

/// The last line that may stand at the top.
pub fn last_line(state: &State) -> usize {
    lines(state).len().saturating_sub(rows(state))
}

/// The text of the overlay.
pub fn lines(state: &State) -> Rc<Vec<Line<'static>>> {
    let width = text_width(state);
    match &state.overlay {
        Overlay::None => Rc::default(),
        Overlay::Help { .. } => Rc::new(help::lines(state, width)),
        Overlay::Output { lines, .. } => {
            // As wide as the frame leaves it: what was printed for this terminal stays as it is.
            let room = usize::from(state.size.0).saturating_sub(4).max(1);
            match lines.iter().all(|line| line.width() <= room) {
                true => Rc::clone(lines),
                false => Rc::new(rewrap::within(lines, room)),
            }
        }
        Overlay::Answers { answers, .. } => Rc::new(side_by_side(answers, state.look, width)),
    }
}

/// Draws the overlay, if there is one.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let (title, scroll) = match &state.overlay {
        Overlay::None => return,
        Overlay::Help { scroll } => ("Keys", *scroll),
        Overlay::Output { title, scroll, .. } => (title.as_str(), *scroll),
        Overlay::Answers { scroll, .. } => ("All answers", *scroll),
    };
    let look = state.look;
    let lines = lines(state);
    let widest = lines.iter().map(Line::width).max().unwrap_or(0).max(30);
    // the terminal has at most 65 535 columns and rows
    let width = (widest + 4).min(usize::from(area.width)) as u16;
    let height = (lines.len() + 2).min(usize::from(area.height).saturating_sub(2)).max(3) as u16;
    let place = Rect::new(
        area.x + (area.width - width) / 2,
        area.y + (area.height.saturating_sub(1 + height)) / 2,
        width,
        height.min(area.height),
    );
    Clear.render(place, buffer);
    let room = usize::from(place.height).saturating_sub(2);
    let scroll = scroll.min(lines.len().saturating_sub(room));
    let mut block = Block::bordered().border_set(look.border_set(true)).border_style(look.border(true)).title_top(
        Line::styled(format!(" {} ", look.fit(title, usize::from(width).saturating_sub(6))), look.role(Role::Title)),
    );
    if lines.len() > room {
        block = block.title_bottom(
            Line::raw(format!(" {} - {} of {} ", scroll + 1, scroll + room, lines.len())).right_aligned(),
        );
    }
    block.render(place, buffer);
    for (row, line) in lines.iter().skip(scroll).take(room).enumerate() {
        let y = place.y + 1 + row as u16;
        buffer.set_line(place.x + 2, y, line, place.width.saturating_sub(3));
        if state.found == Some(scroll + row) {
            buffer.set_style(Rect::new(place.x + 1, y, place.width.saturating_sub(2), 1), look.selected());
        }
    }
}
