//! What lies over the panes: keys, output of commands, answers side by side. And the line being typed.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Clear, Widget};
use unicode_width::UnicodeWidthStr;

use crate::session::AllAnswers;
use crate::session::language::complete;
use crate::session::results::PairState;
use crate::view::pairs::state_words;
use crate::view::scale::Scale;
use crate::view::style::{Role, pad_left, pad_right};

use super::app::{Input, Overlay, State};
use super::bindings::Context;
use super::theme::Look;

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
pub fn lines(state: &State) -> Vec<Line<'static>> {
    match &state.overlay {
        Overlay::None => Vec::new(),
        Overlay::Help { .. } => help(state),
        Overlay::Output { lines, .. } => lines.clone(),
        Overlay::Answers { answers, .. } => side_by_side(answers, state.look, text_width(state)),
    }
}

/// The keys, by place.
fn help(state: &State) -> Vec<Line<'static>> {
    let look = state.look;
    let report = look.report(text_width(state));
    let all = || Context::ALL.into_iter().map(|context| state.keys.rows(context, look.ascii));
    let widest = all().flatten().map(|(keys, _)| keys.width()).max().unwrap_or(0);
    let column = (widest + 4).min(report.width / 2);
    let mut lines = Vec::new();
    for (context, rows) in Context::ALL.into_iter().zip(all()) {
        if rows.is_empty() {
            continue;
        }
        if !lines.is_empty() {
            lines.push(Line::default());
        }
        let mut heading = vec![Span::styled(context.title(), look.role(Role::Title))];
        if let Context::Pane(pane) = context {
            heading.push(Span::styled(look.text(&format!("  {}", pane.explanation(false))), look.role(Role::Muted)));
        }
        lines.push(Line::from(heading));
        for (keys, binding) in rows {
            // keys that do not fit into their column stand on a line of their own
            let mut label = pad_right(&format!("  {keys}"), column);
            if !label.ends_with("  ") {
                lines.push(Line::styled(report.fit(label.trim_end(), report.width), look.role(Role::Accent)));
                label = " ".repeat(column);
            }
            for (i, text) in report.hanging(&label, binding.help).into_iter().enumerate() {
                let cut = if i == 0 { label.len().min(text.len()) } else { 0 };
                let (keys, help) = text.split_at_checked(cut).unwrap_or(("", &text));
                lines.push(Line::from(vec![
                    Span::styled(keys.to_owned(), look.role(Role::Accent)),
                    Span::raw(help.to_owned()),
                ]));
            }
        }
    }
    lines
}

/// Answers in columns, as many side by side as fit.
pub fn side_by_side(found: &AllAnswers, look: Look, width: usize) -> Vec<Line<'static>> {
    let mut lines = Vec::new();
    let count = found.answers.len();
    let head = match (count, found.complete) {
        (0, true) => "No working scheme is an answer: there is none.".to_owned(),
        (0, false) => "No answer was found, but not every scheme could be decided.".to_owned(),
        (1, true) => "One answer, and no other.".to_owned(),
        (n, true) => format!("{n} answers, and no others: which one the structure takes depends on its history."),
        (n, false) => format!("{n} answers; not every scheme could be decided."),
    };
    let report = look.report(width);
    for line in report.wrap(&head, width) {
        lines.push(Line::styled(line, look.role(Role::Title)));
    }
    lines.push(Line::default());
    let Some(first) = found.answers.first() else {
        return lines;
    };
    let id = first.pairs.iter().map(|pair| pair.id.width()).max().unwrap_or(0).max(4);
    const NUMBER: usize = 11;
    let words = found.answers.iter().flat_map(|answer| &answer.pairs);
    let word = words.map(|pair| state_words(pair).len()).max().unwrap_or(0) + 1;
    let block = word + 3 * NUMBER + 2;
    let fit = (width.saturating_sub(id + 1) / block).max(1);
    let all = || found.answers.iter().flat_map(|answer| &answer.pairs);
    let forces = Scale::of(all().flat_map(|pair| [pair.x_n, pair.x_t]));
    let lengths = Scale::of(all().map(|pair| pair.z_t));
    let headed = |head: &str, scale: Scale| {
        let power = scale.unit(None, look.ascii).map_or(String::new(), |power| format!(" {power}"));
        pad_left(&format!("{}{power}", look.text(head)), NUMBER)
    };
    for (group, answers) in found.answers.chunks(fit).enumerate() {
        if group > 0 {
            lines.push(Line::default());
        }
        let mut head = vec![Span::raw(" ".repeat(id + 1))];
        for (i, answer) in answers.iter().enumerate() {
            let mut name = format!("answer {}", group * fit + i + 1);
            if answer.shown {
                name.push_str(", the one shown");
            }
            if answer.continuum {
                name.push_str(", one of many beside it");
            } else if !answer.exact {
                name.push_str(", up to rounding");
            }
            head.push(Span::styled(
                pad_right(&look.fit(&name, block - 1), block),
                look.role(if answer.shown { Role::Accent } else { Role::Header }),
            ));
        }
        lines.push(Line::from(head));
        let columns = format!(
            "{}{}{}{}  ",
            pad_right("state", word),
            headed("x_n", forces),
            headed("x_τ", forces),
            headed("z_τ", lengths)
        );
        lines.push(Line::styled(
            format!("{} {}", pad_right("pair", id), columns.repeat(answers.len())),
            look.role(Role::Muted),
        ));
        for row in 0..first.pairs.len() {
            let mut spans = vec![Span::raw(format!("{} ", pad_right(&look.text(&first.pairs[row].id), id)))];
            for answer in answers {
                let pair: &PairState = &answer.pairs[row];
                spans.push(Span::styled(pad_right(state_words(pair), word), look.role(Role::State(pair.state))));
                let numbers = [forces.measured(pair.x_n), forces.measured(pair.x_t), lengths.measured(pair.z_t)];
                let text: String = numbers.iter().map(|n| pad_left(n, NUMBER)).collect();
                spans.push(Span::raw(format!("{text}  ")));
            }
            lines.push(Line::from(spans));
        }
    }
    lines
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
        buffer.set_line(place.x + 2, place.y + 1 + row as u16, line, place.width.saturating_sub(3));
    }
}

/// Draws the line being typed into the last row; gives the place of the cursor.
pub fn draw_input(state: &State, bottom: Rect, buffer: &mut Buffer) -> Option<(u16, u16)> {
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
