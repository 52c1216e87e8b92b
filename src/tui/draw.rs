//! The state on a frame.

use ratatui::Frame;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Modifier;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Widget};
use unicode_width::UnicodeWidthStr;

use crate::text::number::{short, with_unit};
use crate::view::difference::Change;
use crate::view::status::pivot_count;
use crate::view::style::Role;

use super::action::Loading;
use super::app::State;
use super::bindings::Context;
use super::layout::{self, Places};
use super::paint::inside;
use super::pane::Pane;
use super::{input, overlay, panes, prompt, tour};

/// Draws everything.
pub fn draw(state: &State, frame: &mut Frame<'_>) {
    let area = frame.area();
    let buffer = frame.buffer_mut();
    if let Some(cursor) = draw_on(state, area, buffer) {
        frame.set_cursor_position(cursor);
    }
}

/// Draws everything into a buffer; the place of the cursor, if a line is typed.
pub fn draw_on(state: &State, area: Rect, buffer: &mut Buffer) -> Option<(u16, u16)> {
    // a terminal that shrinks may be drawn before its new size is known
    let fits = state.size.0 <= area.width && state.size.1 <= area.height;
    let Some(places) = layout::places(state).filter(|_| fits) else {
        too_small(state, area, buffer);
        return None;
    };
    draw_title(state, places.title, buffer);
    let shared = places.tabs.as_ref().map(|(area, _)| *area);
    for (pane, area) in &places.panes {
        draw_pane(state, &places, *pane, *area, shared == Some(*area), buffer);
    }
    draw_sentence(state, places.sentence, buffer);
    draw_about(state, places.about, buffer);
    if let Some(trouble) = &state.trouble {
        draw_trouble(state, trouble, places.sentence, buffer);
    }
    overlay::draw(state, area, buffer);
    match prompt::draw(state, places.bottom, buffer) {
        Some(cursor) => Some(cursor),
        None => {
            draw_bottom(state, places.bottom, buffer);
            None
        }
    }
}

/// What is wrong with the watched file, over the lowest rows of the panes; `bottom` stands under them.
fn draw_trouble(state: &State, trouble: &str, bottom: Rect, buffer: &mut Buffer) {
    /// More would hide the picture.
    const ROWS: usize = 6;
    let width = usize::from(bottom.width);
    let report = state.look.report(width);
    let mut lines: Vec<String> = trouble.lines().flat_map(|line| report.wrap(line, width)).collect();
    if lines.len() > ROWS {
        let more = lines.len() + 1 - ROWS;
        lines.truncate(ROWS - 1);
        lines.push(format!("{} {more} more lines: `:reload` shows them all", report.ellipsis()));
    }
    lines.truncate(usize::from(bottom.y.saturating_sub(1)));
    let top = bottom.y.saturating_sub(lines.len() as u16);
    let style = state.look.role(Role::Bad).add_modifier(Modifier::REVERSED);
    for (row, line) in lines.iter().enumerate() {
        buffer.set_stringn(bottom.x, top + row as u16, format!("{line:<width$}"), width, style);
    }
}

fn too_small(state: &State, area: Rect, buffer: &mut Buffer) {
    let (columns, rows) = layout::SMALLEST;
    let text = format!(
        "The terminal is {} x {}; the panes need {columns} x {rows}. Enlarge it, or q.",
        area.width, area.height
    );
    let report = state.look.report(usize::from(area.width).max(1));
    for (row, line) in report.wrap(&text, usize::from(area.width)).iter().enumerate() {
        if row < usize::from(area.height) {
            buffer.set_stringn(
                area.x,
                area.y + row as u16,
                line,
                usize::from(area.width),
                state.look.role(Role::Warning),
            );
        }
    }
}

/// Scenario at the left, outcome at the right.
fn draw_title(state: &State, area: Rect, buffer: &mut Buffer) {
    let look = state.look;
    let shown = &state.shown;
    let (outcome, role) = outcome(state);
    let outcome = look.fit(&outcome, usize::from(area.width).saturating_sub(12));
    let width = outcome.width() as u16;
    let start = area.right().saturating_sub(width);
    buffer.set_stringn(start, area.y, &outcome, usize::from(width), look.role(role).add_modifier(Modifier::BOLD));
    let room = usize::from(start.saturating_sub(area.x + 2));
    let title = format!("{} · {}", shown.scenario.name, shown.scenario.title);
    buffer.set_stringn(area.x, area.y, look.fit(&title, room), room, look.role(Role::Title));
}

/// The outcome in a few words, or what is being computed.
fn outcome(state: &State) -> (String, Role) {
    let shown = &state.shown;
    if let Some((what, fraction)) = &state.progress {
        let percent = (100.0 * fraction.clamp(0.0, 1.0)).round();
        return (format!("{what} {percent} % · Esc stops"), Role::Warning);
    }
    let Some(answer) = shown.answer() else {
        return ("not solved yet".into(), Role::Warning);
    };
    let loading = match state.loading() {
        _ if shown.glance.is_some() => "at the cursor of the map · ".to_owned(),
        Loading::Own => String::new(),
        loading => format!("{} · ", panes::loading::name(state, &loading)),
    };
    let mut text = loading
        + &match &answer.ray {
            Some(ray) => format!(
                "ray: {} · p {}",
                ray.class.word(),
                with_unit(
                    &short(ray.p),
                    crate::view::force_unit(&shown.scenario.units).filter(|_| !shown.pairs().is_empty()).as_deref()
                )
            ),
            None => answer.outcome.word().to_owned(),
        };
    if answer.marginal {
        text.push_str(", marginal");
    }
    if shown.stage.is_none() {
        text.push_str(&format!(" · {}", pivot_count(answer)));
    }
    if !shown.moment.changes.is_empty() {
        let count = shown.moment.changes.len();
        let s = if count == 1 { "" } else { "s" };
        text.push_str(&format!(" · {count} pair{s} changed"));
    }
    (text, Role::of_outcome(answer.outcome))
}

fn draw_pane(state: &State, places: &Places, pane: Pane, area: Rect, shares: bool, buffer: &mut Buffer) {
    let look = state.look;
    let focused = pane == state.focus;
    let mut block = Block::bordered().border_set(look.border_set(focused)).border_style(look.border(focused));
    let mut used = 2;
    if !shares {
        let style = if focused { look.role(Role::Accent) } else { look.role(Role::Title) };
        let title = format!(" {} {} ", pane.index() + 1, pane.title());
        used += title.width();
        block = block.title_top(Line::styled(title, style));
    }
    let tabs = places.tabs.as_ref().filter(|_| shares).map(|(area, names)| layout::tab_names(*area, names, pane));
    if let Some(tabs) = &tabs {
        used += tabs.last().map_or(0, |(start, _, name)| usize::from(start - area.x) + name.len() + 2);
    }
    let note = panes::note(state, pane);
    let inner = usize::from(area.width).saturating_sub(2);
    let explains = state.explains && state.tour.is_none();
    let mut below = if explains {
        let plain = matches!(state.shown.scenario.source, crate::model::scenario::Source::Lcp(_));
        match pane {
            Pane::Pivots if state.shown.stage.is_some() => "what happens on the way".to_owned(),
            Pane::Pairs if !panes::pairs::is_whole(state, inside(area)) => "`:pairs` shows all columns".to_owned(),
            _ => pane.explanation(plain).to_owned(),
        }
    } else {
        String::new()
    };
    if !note.is_empty() {
        let note = format!(" {} ", look.text(&note));
        if used + note.width() < usize::from(area.width) {
            block = block.title_top(Line::raw(note).right_aligned());
        } else if below.is_empty() || note.width() + 4 < inner {
            // where the tabs leave no room it is more than an explanation
            below = note.trim().to_owned();
        }
    }
    if !below.is_empty() && inner > 4 {
        let text = format!(" {} ", look.fit(&below, inner - 4));
        block = block.title_bottom(Line::styled(text, look.role(Role::Muted)));
    }
    block.render(area, buffer);
    for (x, tab, name) in tabs.into_iter().flatten() {
        let style = if tab == pane { look.selected() } else { look.role(Role::Muted) };
        let room = usize::from(area.right().saturating_sub(x));
        buffer.set_stringn(x, area.y, format!(" {name} "), room, style);
    }
    panes::draw(state, pane, inside(area), buffer);
}

/// The sentence of the pivot, or the tour.
fn draw_sentence(state: &State, area: Rect, buffer: &mut Buffer) {
    let look = state.look;
    let width = usize::from(area.width);
    let report = look.report(width);
    let (mut lines, head) = match state.tour.and_then(|at| tour::lines(state, at, width)) {
        Some(lines) => lines,
        None => {
            let region = if state.focus == Pane::Map { panes::map::sentence(state) } else { None };
            let text = region.unwrap_or_else(|| panes::pivots::sentence(state));
            (report.wrap(&text, width), 0)
        }
    };
    let rows = usize::from(area.height);
    if lines.len() > rows && rows > 0 {
        lines.truncate(rows);
        if let Some(last) = lines.last_mut() {
            let cut = look.fit(last, width.saturating_sub(1));
            *last = if cut.ends_with(report.ellipsis()) { cut } else { format!("{cut}{}", report.ellipsis()) };
        }
    }
    for (row, line) in lines.iter().enumerate() {
        let y = area.y + row as u16;
        let cut = if row == 0 { head.min(line.len()) } else { 0 };
        let cut = if line.is_char_boundary(cut) { cut } else { 0 };
        let spans =
            vec![Span::styled(line[..cut].to_owned(), look.role(Role::Accent)), Span::raw(line[cut..].to_owned())];
        buffer.set_line(area.x, y, &Line::from(spans), area.width);
    }
}

/// About what is selected in the focused pane, or what the last change changed.
fn draw_about(state: &State, area: Rect, buffer: &mut Buffer) {
    if area.is_empty() {
        return;
    }
    let look = state.look;
    let text = match state.focus {
        Pane::Parameters => panes::parameters::about(state),
        Pane::Pairs | Pane::Structure => panes::pairs::about(state),
        Pane::Map => panes::map::about(state),
        Pane::Pivots | Pane::Plot | Pane::Answer | Pane::Quantities | Pane::Loading => changes(state),
    };
    if let Some(text) = text {
        let width = usize::from(area.width);
        buffer.set_stringn(area.x, area.y, look.fit(&text, width), width, look.role(Role::Muted));
    }
}

/// `changed: c3 stick → slip+, c4 …`.
fn changes(state: &State) -> Option<String> {
    let changes = &state.shown.moment.changes;
    if changes.is_empty() {
        return None;
    }
    let one = |change: &Change| format!("{} {} → {}", change.pair, change.from, change.to);
    // no more than the line may hold
    let most = usize::from(state.size.0);
    let all: Vec<String> = changes.iter().take(most).map(one).collect();
    Some(format!("changed: {}", all.join(", ")))
}

/// A message, or the keys that matter now.
fn draw_bottom(state: &State, area: Rect, buffer: &mut Buffer) {
    let look = state.look;
    let width = usize::from(area.width);
    if let Some(message) = &state.message {
        let text = look.fit(&message.text, width);
        buffer.set_stringn(area.x, area.y, text, width, look.role(message.role));
        return;
    }
    let mut x = area.x;
    let mut contexts = input::contexts(state);
    // the tour shows its keys itself
    contexts.retain(|context| *context != Context::Tour);
    for (keys, word) in state.keys.hints(&contexts, look.ascii) {
        let room = usize::from(area.right().saturating_sub(x));
        let need = keys.width() + 1 + word.width();
        if need > room {
            continue;
        }
        let (after, _) = buffer.set_stringn(x, area.y, keys, room, look.role(Role::Accent));
        let text = format!(" {word}");
        let room = usize::from(area.right().saturating_sub(after));
        let (after, _) = buffer.set_stringn(after, area.y, text, room, look.role(Role::Muted));
        x = after.saturating_add(2).min(area.right());
    }
}
