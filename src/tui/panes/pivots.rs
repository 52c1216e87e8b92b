//! The pivots: what each turned, p after it, ties.

use std::rc::Rc;
use std::sync::Arc;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use unicode_width::UnicodeWidthStr;

use crate::session::Solved;
use crate::session::results::PivotRecord;
use crate::text::number::{short, with_unit};
use crate::tui::app::State;
use crate::tui::kept::The;
use crate::tui::listing::{GUTTER, Listing};
use crate::tui::paint::{inside, put_lines, put_text};
use crate::tui::pane::Pane;
use crate::tui::pictures::Sheet;
use crate::tui::theme::Look;
use crate::view::force_unit;
use crate::view::pivots::{of_contact, title};
use crate::view::scale::Scale;
use crate::view::style::{Role, pad_left, pad_right};

/// p at the pivot shown.
pub fn note(state: &State) -> String {
    let Some(p) = state.shown.moment.p else {
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
    let (solved, inside) = (state.shown.solved.as_ref()?, inside(area));
    let pivots = &solved.answer.pivots;
    let row = listing(state, solved, inside.width).row_at(at(state, pivots), inside, y)?;
    pivots.get(row).map(|pivot| pivot.step)
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
    if state.shown.stage.is_some() {
        put_lines(&events(state, usize::from(area.width)), area, buffer);
        return;
    }
    let Some(solved) = &state.shown.solved else {
        put_text(look, "not solved yet", muted, area, buffer);
        return;
    };
    let pivots = &solved.answer.pivots;
    if pivots.is_empty() {
        let text = if state.shown.is_warm() {
            "followed from the last answer; its pivots come in a moment".to_owned()
        } else if solved.answer.rules.engine.is_without_pivots() {
            solved.answer.rules.why_no_pivots()
        } else {
            "no pivots: with every joint on nothing is violated, so the main system is the answer".to_owned()
        };
        put_text(look, &text, muted, area, buffer);
        return;
    }
    let selected = (at(state, pivots), state.focus == Pane::Pivots);
    listing(state, solved, area.width).draw(look, selected, |_| false, area, buffer);
}

/// What happened on the way through the stage shown.
fn events(state: &State, width: usize) -> Vec<Line<'static>> {
    let look = state.look;
    let stage = state.shown.history.as_ref().zip(state.shown.stage).and_then(|(all, at)| all.stages.get(at));
    let moments = stage.into_iter().flat_map(|stage| &stage.moments).filter(|moment| !moment.sentence.is_empty());
    let mut lines = vec![Line::styled("done    events of the stage", look.role(Role::Header))];
    for moment in moments {
        let label = format!("{}  ", pad_right(&short(moment.t), 6));
        lines.extend(look.report(width).hanging(&label, &look.text(&moment.sentence)).into_iter().map(Line::raw));
    }
    if lines.len() == 1 {
        lines.push(Line::styled("no pair changes its motion", look.role(Role::Muted)));
    }
    lines
}

/// The columns of the list.
struct Columns {
    /// Digits of the number of the pivot.
    step: usize,
    /// What it turned.
    words: usize,
    /// p.
    number: usize,
    /// What stopped p; 0 where there is no room for it.
    until: usize,
    /// How many were tied; 0 where none were.
    tie: usize,
}

impl Columns {
    fn of(pivots: &[PivotRecord], (p, numbers): (&str, &[String]), width: usize) -> Columns {
        let step = pivots.last().map_or(1, |pivot| pivot.step.to_string().len());
        let number = numbers.iter().map(String::len).max().unwrap_or(1).max(3).max(p.width());
        let longest_turn = pivots.iter().filter_map(|pivot| pivot.turned.as_ref());
        let longest_turn = longest_turn.map(|turned| turned.pair.width() + 1 + turned.to.width()).max().unwrap_or(0);
        let bare = step + 2 + 1 + number;
        let tie = match pivots.iter().any(|pivot| pivot.ties.len() > 1) {
            false => 0,
            true if bare + longest_turn + 7 > width => 5,
            true => 7,
        };
        let fixed = bare + tie;
        let longest = pivots.iter().map(|pivot| pivot.leaving.width()).max().unwrap_or(0);
        let until = if width >= fixed + 24 + longest { longest.max(5) + 3 } else { 0 };
        Columns { step, words: width.saturating_sub(fixed + until).clamp(6, 30), number, until, tie }
    }
}

fn listing(state: &State, solved: &Arc<Solved>, width: u16) -> Rc<Listing> {
    let look = state.look;
    let sheet = Sheet { width: usize::from(width.saturating_sub(GUTTER)), look };
    state.pictures.pivots.of((The::one(solved), sheet), || {
        let pivots = &solved.answer.pivots;
        let scale = Scale::of(pivots.iter().map(|pivot| pivot.p));
        let numbers: Vec<String> = pivots.iter().map(|pivot| scale.measured(pivot.p)).collect();
        let p = scale.unit(None, look.ascii).map_or_else(|| "p".to_owned(), |power| format!("p {power}"));
        let columns = Columns::of(pivots, (&p, &numbers), sheet.width);
        let heading = format!(
            "{} {} {}{}{}",
            pad_left("", columns.step),
            pad_right(" turned", columns.words + 1),
            pad_left(&p, columns.number),
            if columns.until > 0 { pad_right("   until", columns.until) } else { String::new() },
            if columns.tie > 0 { pad_left("ties", columns.tie) } else { String::new() }
        );
        let rows = pivots.iter().zip(&numbers).map(|(pivot, p)| row(pivot, p, &columns, look));
        Listing::new(vec![Line::styled(heading, look.role(Role::Header))], rows.collect())
    })
}

fn row(pivot: &PivotRecord, p: &str, columns: &Columns, look: Look) -> Line<'static> {
    let arrow = look.report(1).arrow();
    let mut what = turned(pivot, arrow);
    if what.width() > columns.words {
        what = what.replace(&format!(" {arrow} "), " ").replace(" in, ", "/").replace(" out", "");
    }
    if let Some(turned) = pivot.turned.as_ref().filter(|_| what.width() > columns.words) {
        // what it turned to is said whole, and of its name the beginning and the end
        let room = columns.words.saturating_sub(turned.to.width() + 1);
        what = format!("{} {}", cut_in_the_middle(&turned.pair, room, look.report(1).ellipsis()), turned.to);
    }
    let mut spans = vec![Span::raw(format!(
        "{}  {} {}",
        pad_left(&pivot.step.to_string(), columns.step),
        pad_right(&look.fit(&what, columns.words), columns.words),
        pad_left(p, columns.number),
    ))];
    if columns.until > 0 {
        let room = columns.until - 3;
        let text = format!("   {}", pad_right(&look.fit(&pivot.leaving, room), room));
        spans.push(Span::styled(text, look.role(Role::Muted)));
    }
    if pivot.ties.len() > 1 {
        spans.push(Span::styled(pad_left(&pivot.ties.len().to_string(), columns.tie), look.role(Role::Warning)));
    }
    Line::from(spans)
}

/// At most `room` characters of a name: its beginning and its end.
fn cut_in_the_middle(name: &str, room: usize, ellipsis: &str) -> String {
    let letters: Vec<char> = name.chars().collect();
    if letters.len() <= room {
        return name.to_owned();
    }
    let kept = room.saturating_sub(ellipsis.width());
    let (head, tail) = (kept / 3, kept - kept / 3); // indices stand at the end
    letters[..head].iter().collect::<String>() + ellipsis + &letters[letters.len() - tail..].iter().collect::<String>()
}

/// The sentence of what is shown: the pivot, the ray, or that there was none.
pub fn sentence(state: &State) -> String {
    let Some(answer) = state.shown.answer() else {
        return "Not solved yet: `:solve`, or `:set auto on`.".to_owned();
    };
    if let (Some(history), Some(stage)) = (&state.shown.history, state.shown.stage) {
        let of = state.shown.scenario.stages.len();
        let end =
            if stage + 1 == history.stages.len() { history.end_sentence() } else { "it was completed".to_owned() };
        return format!("Stage {} of {of} of the load history: {end}.", stage + 1);
    }
    if let Some(failure) = &answer.failure {
        return failure.clone();
    }
    if state.shown.at_ray()
        && let Some(ray) = &answer.ray
    {
        return format!("Ray ({}): {}. {}", ray.class.word(), ray.mode, ray.explanation);
    }
    let step = state.shown.step();
    let Some(pivot) = answer.pivots.iter().find(|pivot| Some(pivot.step) == step) else {
        if let Some(step) = step {
            let last = answer.pivots.len() - 1;
            return format!("{}: counted but not recorded, as all after {last}.", capital(&title(step)));
        }
        if answer.rules.engine.is_without_pivots() {
            return format!("{}.", capital(&answer.rules.why_no_pivots()));
        }
        return "With every joint on no condition is violated: the main system itself is the answer, \
                without a pivot."
            .to_owned();
    };
    let mut sentence = format!("{}: {}", capital(&title(pivot.step)), pivot.sentence);
    if pivot.ties.len() > 1 && !pivot.sentence.contains("tied") {
        sentence.push_str(&format!(" (tied: {})", pivot.ties.join(", ")));
    }
    sentence.push('.');
    sentence
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::cut_in_the_middle;

    #[test]
    fn a_long_name_keeps_its_ends() {
        assert_eq!(cut_in_the_middle("c12", 3, "…"), "c12");
        assert_eq!(cut_in_the_middle("abutment-left[12]", 9, "…"), "ab…ft[12]");
        assert_eq!(cut_in_the_middle("abutment-left[12]", 8, "~"), "ab~t[12]");
    }
}
