//! The pivots: what each turned, p after it, ties.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Modifier;
use unicode_width::UnicodeWidthStr;

use crate::session::results::PivotRecord;
use crate::tui::app::State;
use crate::tui::pane::Pane;
use crate::view::force_unit;
use crate::view::number::{in_column, largest, short, with_unit};
use crate::view::pivots::of_contact;
use crate::view::style::{Role, pad_left, pad_right};

/// Rows of the heading.
const HEADING: u16 = 1;

/// p at the pivot shown.
pub fn note(state: &State) -> String {
    let Some(p) = state.shown.p else {
        return String::new();
    };
    let Some(answer) = state.shown.answer().filter(|answer| !answer.pivots.is_empty()) else {
        return String::new();
    };
    let unit = force_unit(&state.shown.scenario.units).filter(|_| of_contact(&answer.pivots));
    format!("p = {}", with_unit(&short(p), unit.as_deref()))
}

/// The pivot in a row of the screen.
pub fn step_at(state: &State, area: Rect, y: u16) -> Option<usize> {
    let inside = super::inside(area);
    let pivots = &state.shown.answer()?.pivots;
    let row = y.checked_sub(inside.y)?.checked_sub(HEADING)?;
    let rows = inside.height.saturating_sub(HEADING);
    let first = super::window(at(state, pivots), pivots.len(), usize::from(rows));
    let pivot = pivots.get(first + usize::from(row))?;
    (row < rows).then_some(pivot.step)
}

/// Row of the pivot shown.
fn at(state: &State, pivots: &[PivotRecord]) -> usize {
    let step = state.step();
    pivots.iter().position(|pivot| Some(pivot.step) == step).unwrap_or_default()
}

/// What a pivot turned, in a few words.
pub fn turned(pivot: &PivotRecord, arrow: &str) -> String {
    match &pivot.turned {
        Some(turned) => format!("{} {arrow} {}", turned.pair, turned.to),
        None if pivot.entering == "p" => "p enters".to_owned(),
        None => format!("{} in, {} out", pivot.entering, pivot.leaving),
    }
}

/// Draws the pane.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let look = state.look;
    let muted = look.role(Role::Muted);
    let Some(answer) = state.shown.answer() else {
        super::put_text(look, "not solved yet", muted, area, buffer);
        return;
    };
    let pivots = &answer.pivots;
    if pivots.is_empty() {
        let text = if state.shown.is_warm() {
            "followed from the last answer; its pivots come in a moment"
        } else {
            "no pivots: with every joint on nothing is violated, so the main system is the answer"
        };
        super::put_text(look, text, muted, area, buffer);
        return;
    }
    let scale = largest(pivots.iter().map(|pivot| pivot.p));
    let rows = usize::from(area.height.saturating_sub(HEADING));
    let selected = at(state, pivots);
    let first = super::window(selected, pivots.len(), rows);
    let seen = &pivots[first..(first + rows).min(pivots.len())];
    let arrow = look.report(1).arrow();
    let numbers: Vec<String> = pivots.iter().map(|pivot| in_column(pivot.p, scale)).collect();
    let number = numbers.iter().map(String::len).max().unwrap_or(1).max(3);
    let step = pivots.last().map_or(1, |p| p.step.to_string().len());
    let ties = pivots.iter().any(|pivot| pivot.ties.len() > 1);
    let tie = if ties { 7 } else { 0 };
    // mark, step, what turned, p, ties
    let fixed = 2 + step + 2 + 1 + number + tie;
    // what stopped p, where there is room for it
    let longest = pivots.iter().map(|pivot| pivot.leaving.width()).max().unwrap_or(0);
    let until = if usize::from(area.width) >= fixed + 24 + longest { longest.max(5) + 3 } else { 0 };
    let words = usize::from(area.width).saturating_sub(fixed + until).clamp(6, 30);
    let heading = format!(
        "  {} {} {}{}{}",
        pad_left("", step),
        pad_right(" turned", words + 1),
        pad_left("p", number),
        if until > 0 { pad_right("   until", until) } else { String::new() },
        if ties { "   ties" } else { "" }
    );
    buffer.set_stringn(area.x, area.y, heading, usize::from(area.width), look.role(Role::Header));
    for (row, pivot) in seen.iter().enumerate() {
        let y = area.y + HEADING + row as u16;
        let here = first + row == selected;
        let mark = if here { look.report(1).mark() } else { ' ' };
        let mut what = turned(pivot, arrow);
        if what.width() > words {
            what = what.replace(&format!(" {arrow} "), " ").replace(" in, ", "/").replace(" out", "");
        }
        let text = format!(
            "{mark} {}  {} {}",
            pad_left(&pivot.step.to_string(), step),
            pad_right(&look.fit(&what, words), words),
            pad_left(&numbers[first + row], number),
        );
        let style = look.role(if here { Role::Accent } else { Role::Plain });
        let (x, _) = buffer.set_stringn(area.x, y, text, usize::from(area.width), style);
        let x = if until > 0 {
            let text = format!("   {}", pad_right(&look.fit(&pivot.leaving, until - 3), until - 3));
            let room = usize::from(area.right().saturating_sub(x));
            buffer.set_stringn(x, y, text, room, look.role(Role::Muted)).0
        } else {
            x
        };
        if pivot.ties.len() > 1 {
            let text = pad_left(&pivot.ties.len().to_string(), tie);
            let room = usize::from(area.right().saturating_sub(x));
            buffer.set_stringn(x, y, text, room, look.role(Role::Warning));
        }
        if here {
            let row = Rect::new(area.x, y, area.width, 1);
            if state.focus == Pane::Pivots {
                buffer.set_style(row, look.selected());
            } else {
                buffer.set_style(row, ratatui::style::Style::new().add_modifier(Modifier::BOLD));
            }
        }
    }
}

/// The sentence of what is shown: the pivot, the ray, or that there was none.
pub fn sentence(state: &State) -> String {
    let Some(answer) = state.shown.answer() else {
        return "Not solved yet: `:solve`, or `:set auto on`.".to_owned();
    };
    if let Some(failure) = &answer.failure {
        return failure.clone();
    }
    if state.shown.at_ray()
        && let Some(ray) = &answer.ray
    {
        return format!("Ray ({}): {}. {}", crate::view::status::class_word(ray.class), ray.mode, ray.explanation);
    }
    let step = state.shown.step();
    let Some(pivot) = answer.pivots.iter().find(|pivot| Some(pivot.step) == step) else {
        if let Some(step) = step {
            return format!(
                "Pivot {step} of {step}: counted but not recorded, as all after {}.",
                answer.pivots.len() - 1
            );
        }
        return "With every joint on no condition is violated: the main system itself is the answer, \
                without a pivot."
            .to_owned();
    };
    let last = answer.pivot_count.saturating_sub(1);
    let mut sentence = format!("Pivot {} of {last}: {}", pivot.step, pivot.sentence);
    if pivot.ties.len() > 1 && !pivot.sentence.contains("tied") {
        sentence.push_str(&format!(" (tied: {})", pivot.ties.join(", ")));
    }
    sentence.push('.');
    sentence
}
