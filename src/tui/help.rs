//! The keys in words: those of the pane first, in two columns where there is room.

use ratatui::text::{Line, Span};
use unicode_width::UnicodeWidthStr;

use crate::view::style::{Role, pad_right};

use super::app::State;
use super::bindings::{Binding, Context};

/// From this width on there are two columns.
const TWO: usize = 72;
/// Blanks between them.
const BETWEEN: usize = 3;

/// The keys, by place; that of the focused pane comes first.
pub fn lines(state: &State, width: usize) -> Vec<Line<'static>> {
    let here = Context::Pane(state.focus);
    let others = Context::ALL.into_iter().filter(|context| *context != here);
    let mut lines = Vec::new();
    for context in [here].into_iter().chain(others) {
        let rows = state.keys.rows(context, state.look.ascii);
        if rows.is_empty() && context != here {
            continue;
        }
        if !lines.is_empty() {
            lines.push(Line::default());
        }
        let mut heading = vec![Span::styled(context.title(), state.look.role(Role::Title))];
        if let Context::Pane(pane) = context {
            let text = state.look.text(&format!("  {}", pane.explanation(false)));
            heading.push(Span::styled(text, state.look.role(Role::Muted)));
        }
        lines.push(Line::from(heading));
        lines.extend(columns(state, &rows, width));
    }
    lines
}

/// Rows of the table in one or two columns.
fn columns(state: &State, rows: &[(String, &Binding)], width: usize) -> Vec<Line<'static>> {
    if width < TWO {
        return rows.iter().flat_map(|row| entry(state, row, width)).collect();
    }
    let column = (width - BETWEEN) / 2;
    let entries: Vec<Vec<Line<'static>>> = rows.iter().map(|row| entry(state, row, column)).collect();
    let all: usize = entries.iter().map(Vec::len).sum();
    let (mut left, mut right): (Vec<Line<'static>>, Vec<Line<'static>>) = (Vec::new(), Vec::new());
    for entry in entries {
        if right.is_empty() && 2 * left.len() < all { left.extend(entry) } else { right.extend(entry) }
    }
    right.resize(left.len().max(right.len()), Line::default());
    left.resize(right.len(), Line::default());
    left.into_iter()
        .zip(right)
        .map(|(mut line, right)| {
            let blanks = (column + BETWEEN).saturating_sub(line.width());
            line.spans.push(Span::raw(" ".repeat(blanks)));
            line.spans.extend(right.spans);
            line
        })
        .collect()
}

/// A key and what it does.
fn entry(state: &State, (keys, binding): &(String, &Binding), width: usize) -> Vec<Line<'static>> {
    /// Columns of the keys.
    const KEYS: usize = 11;
    let report = state.look.report(width);
    let accent = state.look.role(Role::Accent);
    let mut lines = Vec::new();
    let mut label = pad_right(&format!("  {keys}"), KEYS);
    if label.width() > KEYS || !label.ends_with(' ') {
        // keys that do not fit into their column stand on a line of their own
        lines.push(Line::styled(report.fit(label.trim_end(), width), accent));
        label = " ".repeat(KEYS);
    }
    for (i, text) in report.hanging(&label, binding.help).into_iter().enumerate() {
        let cut = if i == 0 { label.len().min(text.len()) } else { 0 };
        let (keys, help) = text.split_at_checked(cut).unwrap_or(("", &text));
        lines.push(Line::from(vec![Span::styled(keys.to_owned(), accent), Span::raw(help.to_owned())]));
    }
    lines
}
