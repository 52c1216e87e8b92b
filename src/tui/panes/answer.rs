//! How the run ended, its check, the rules, the values.

use std::rc::Rc;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

use crate::tui::action::Job;
use crate::tui::app::State;
use crate::tui::kept::The;
use crate::tui::paint::{put_lines, report};
use crate::tui::pictures::{AnswerKey, Sheet};
use crate::view::style::Role;
use crate::view::{self, status};

/// The answer in words, in lines of `width` columns.
pub fn lines(state: &State, width: usize) -> Rc<Vec<Line<'static>>> {
    let sheet = Sheet { width, look: state.look };
    let looking = state.running == Some(Job::Remedies);
    let shown = &state.shown;
    let key = AnswerKey {
        moment: The::one(&shown.moment),
        remedies: shown.remedies.as_ref().map(The::one),
        looking,
        whole: shown.is_whole(),
        sheet,
    };
    state.pictures.answer.of(key, || written(state, width))
}

fn written(state: &State, width: usize) -> Vec<Line<'static>> {
    let shown = &state.shown;
    match shown.answer() {
        Some(answer) => {
            let mut lines = report(state.look, width, |out, style| {
                status::write(out, answer, &shown.scenario, &shown.values, style)
            });
            // the title of the scenario stands at the top of the screen
            if !lines.is_empty() {
                lines.remove(0);
            }
            if let Some(remedies) = &shown.remedies {
                lines.extend(report(state.look, width, |out, style| view::ray::write_remedies(out, remedies, style)));
            } else if state.running == Some(Job::Remedies) {
                lines.push(Line::styled("looking for what would stop it", state.look.role(Role::Muted)));
            }
            lines
        }
        None => vec![Line::raw("not solved yet: `:solve`, or `:set auto on`")],
    }
}

/// The last line that may stand at the top of the `area`.
pub fn last_line(state: &State, area: Rect) -> usize {
    lines(state, usize::from(area.width)).len().saturating_sub(usize::from(area.height))
}

/// Draws the pane.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let lines = lines(state, usize::from(area.width));
    let from = state.answer_scroll.min(lines.len().saturating_sub(usize::from(area.height)));
    put_lines(&lines[from..], area, buffer);
}
