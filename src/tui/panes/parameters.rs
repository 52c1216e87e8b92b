//! The parameters as sliders.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Modifier;
use unicode_width::UnicodeWidthStr;

use crate::text::number::{short, with_unit};
use crate::tui::app::State;
use crate::tui::listing::window;
use crate::tui::paint::{inside, put_text};
use crate::tui::pane::Pane;
use crate::tui::vary;
use crate::view::style::{Role, pad_left, pad_right};

/// Longest name shown in full.
const NAME: usize = 12;
/// A shorter slider says nothing.
const SLIDER: u16 = 6;

/// A name is not cut shorter for the sake of its slider.
const SHORTEST: usize = 6;

/// Width of the names and of the values in a pane of this many columns: names give way to the sliders.
fn widths(state: &State, columns: u16) -> (usize, usize) {
    let names = state.shown.scenario.parameters.keys();
    let name = names.clone().map(|name| name.width()).max().unwrap_or(0);
    let value = names.map(|name| short(state.value(name)).width()).max().unwrap_or(0);
    let value = value.max(6);
    // mark, blank, ends of the slider
    let room = usize::from(columns.saturating_sub(SLIDER)).saturating_sub(2 + 1 + value + 2 + 2);
    (name.min(NAME.min(room.max(SHORTEST))), value)
}

/// First and last column of the sliders; `None` if there is no room for them.
pub fn slider(state: &State, area: Rect) -> Option<(u16, u16)> {
    let inside = inside(area);
    let (name, value) = widths(state, inside.width);
    // mark, name, value, ends of the slider; names and values are short
    let start = inside.x + 2 + name as u16 + 1 + value as u16 + 2;
    let end = inside.right().checked_sub(2)?;
    (end >= start + SLIDER).then_some((start, end))
}

/// The parameter in a row of the screen.
pub fn row_at(state: &State, area: Rect, y: u16) -> Option<usize> {
    let inside = inside(area);
    if y < inside.y || y >= inside.bottom() {
        return None;
    }
    let count = state.shown.scenario.parameters.len();
    let first = window(state.parameter, count, usize::from(inside.height));
    Some(first + usize::from(y - inside.y)).filter(|row| *row < count)
}

/// Draws the pane.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let look = state.look;
    let parameters = &state.shown.scenario.parameters;
    if parameters.is_empty() {
        let text = "nothing to vary: this scenario names no parameters";
        put_text(look, text, look.role(Role::Muted), area, buffer);
        return;
    }
    let outer = Rect::new(area.x.saturating_sub(1), area.y.saturating_sub(1), area.width + 2, area.height + 2);
    let (name_width, value_width) = widths(state, area.width);
    let rows = usize::from(area.height);
    let first = window(state.parameter, parameters.len(), rows);
    for (row, (index, (name, parameter))) in parameters.iter().enumerate().skip(first).take(rows).enumerate() {
        let y = area.y + row as u16;
        let selected = index == state.parameter;
        let value = state.value(name);
        let mark = if selected { look.report(1).mark() } else { ' ' };
        let changed = parameter.value.to_bits() != value.to_bits();
        let mut style = look.role(if selected { Role::Accent } else { Role::Plain });
        if selected && state.focus == Pane::Parameters {
            style = style.add_modifier(Modifier::BOLD);
        }
        let label = format!("{mark} {}", pad_right(&look.fit(name, name_width), name_width));
        buffer.set_stringn(area.x, y, label, usize::from(area.width), style);
        let x = area.x + 2 + name_width as u16 + 1;
        let waits = state.wanted.contains_key(name);
        let role = if waits { Role::Warning } else { Role::Plain };
        let mut style = look.role(role);
        if changed {
            // what differs from the file stands out
            style = style.add_modifier(Modifier::BOLD);
        }
        let room = usize::from(area.right().saturating_sub(x));
        let text = pad_left(&look.text(&short(value)), value_width);
        buffer.set_stringn(x, y, text, room, style);
        let Some((start, end)) = slider(state, outer) else {
            continue;
        };
        let line = look.sign('─', '-');
        let muted = look.role(Role::Muted);
        if vary::range(parameter).is_none() {
            let text = match &parameter.formula {
                Some(formula) => format!("= {}", formula.text()),
                None => "no range: v types a value".to_owned(),
            };
            let text = look.fit(&text, usize::from(end - start) + 1);
            buffer.set_string(start, y, text, muted);
            continue;
        }
        buffer.set_string(start - 1, y, look.sign('├', '[').to_string(), muted);
        buffer.set_string(end + 1, y, look.sign('┤', ']').to_string(), muted);
        let text: String = std::iter::repeat_n(line, usize::from(end - start) + 1).collect();
        buffer.set_string(start, y, text, muted);
        let place = |value: f64| {
            let share = vary::share(value, parameter).unwrap_or_default();
            start + (share * f64::from(end - start)).round() as u16
        };
        if changed {
            // where the file has it
            let sign = look.sign('┼', '|').to_string();
            buffer.set_string(place(parameter.value), y, sign, muted);
        }
        let style = look.role(if selected { Role::Accent } else { Role::Plain });
        let outside = parameter.min.is_some_and(|min| value < min) || parameter.max.is_some_and(|max| value > max);
        let knob = match (outside, value < parameter.min.unwrap_or(value)) {
            (true, true) => look.sign('◀', '<'),
            (true, false) => look.sign('▶', '>'),
            _ => look.sign('●', 'O'),
        };
        buffer.set_string(place(value), y, knob.to_string(), style);
    }
}

/// The marked parameter in a line: what it is, range, step.
pub fn about(state: &State) -> Option<String> {
    let (name, parameter) = state.selected_parameter()?;
    let value = state.value(name);
    let unit = parameter.unit.as_deref();
    let mut text = format!("{name} = {}", with_unit(&short(value), unit));
    if let Some(about) = &parameter.about {
        text.push_str(&format!(", {about}"));
    }
    if parameter.value.to_bits() != value.to_bits() {
        text.push_str(&format!(" · file {}", short(parameter.value)));
    }
    if let Some((low, high)) = vary::range(parameter) {
        text.push_str(&format!(" · {} … {}", short(low), short(high)));
    }
    match &parameter.formula {
        Some(formula) => text.push_str(&format!(" · = {}", formula.text())),
        None => text.push_str(&format!(" · step {}", short(vary::step(value, parameter)))),
    }
    Some(text)
}
