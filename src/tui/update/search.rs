//! `/`: to the row of a list, or the line of a text, that contains what is typed.

use crate::view::pairs::state_words;
use crate::view::style::Role;

use super::map;
use super::selection::{last_answer_line, show};
use super::steps::step_to;
use crate::tui::action::Effect;
use crate::tui::app::{Input, Overlay, State};
use crate::tui::entry::Entry;
use crate::tui::pane::Pane;
use crate::tui::panes::{answer, loading, pairs, pivots};
use crate::tui::{layout, overlay, paint, panes};

/// Opens the line.
pub(super) fn open(state: &mut State) {
    state.input = Input::Search { entry: Entry::default(), from: at(state) };
}

/// After every letter: the first row from where the search began that contains what is typed so far.
pub(super) fn follow(state: &mut State) -> Vec<Effect> {
    let Input::Search { entry, from } = &state.input else {
        return Vec::new();
    };
    let (text, from) = (entry.text.clone(), *from);
    find(state, &text, from, true)
}

/// The next or the last row that contains what was sought.
pub(super) fn again(state: &mut State, forward: bool) -> Vec<Effect> {
    if state.sought.is_empty() {
        state.say(Role::Warning, "nothing was searched for yet: / begins a search");
        return Vec::new();
    }
    let (text, count) = (state.sought.clone(), rows(state).len().max(1));
    let from = (at(state) + if forward { 1 } else { count - 1 }) % count;
    find(state, &text, from, forward)
}

/// Goes to the first row that contains `text`, from `from` on and round.
pub(super) fn find(state: &mut State, text: &str, from: usize, forward: bool) -> Vec<Effect> {
    if text.is_empty() {
        return go(state, from);
    }
    let (rows, wanted) = (rows(state), text.to_lowercase());
    let count = rows.len();
    let nth = |step: usize| (from + if forward { step } else { count - step }) % count;
    match (0..count).map(nth).find(|row| rows[*row].to_lowercase().contains(&wanted)) {
        Some(row) => {
            state.message = None;
            go(state, row)
        }
        None => {
            let place = if state.overlay == Overlay::None { state.focus.title() } else { "this text" };
            state.say(Role::Warning, format!("no `{text}` in {place}"));
            Vec::new()
        }
    }
}

/// The texts that are searched.
fn rows(state: &State) -> Vec<String> {
    if state.overlay != Overlay::None {
        return overlay::lines(state).iter().map(ToString::to_string).collect();
    }
    let shown = &state.shown;
    match state.focus {
        Pane::Parameters => {
            let all = shown.scenario.parameters.iter();
            all.map(|(name, parameter)| format!("{name} {}", parameter.about.as_deref().unwrap_or_default())).collect()
        }
        Pane::Pairs | Pane::Structure if shown.moment.solution.is_some() => pairs::names(state),
        Pane::Pairs | Pane::Structure => {
            let row = |pair: &usize| {
                let pair = &shown.pairs()[*pair];
                format!("{} {}", pair.id, state_words(pair))
            };
            state.order().pairs.iter().map(row).collect()
        }
        Pane::Pivots => {
            let pivots = shown.answer().into_iter().flat_map(|answer| &answer.pivots);
            pivots.map(|pivot| format!("{} {} {}", pivot.step, pivots::turned(pivot, "->"), pivot.leaving)).collect()
        }
        Pane::Plot => state.plots().iter().map(|plot| plot.title().to_owned()).collect(),
        Pane::Quantities => state.gauges.iter().map(|gauge| gauge.quantity.to_string()).collect(),
        Pane::Loading => state.loadings().iter().map(|one| loading::name(state, one)).collect(),
        Pane::Map => panes::map::regions(state),
        Pane::Answer => {
            let width = layout::area_of(state, Pane::Answer).map_or(80, |area| paint::inside(area).width);
            answer::lines(state, usize::from(width)).iter().map(ToString::to_string).collect()
        }
    }
}

/// The row where the cursor stands.
fn at(state: &State) -> usize {
    match &state.overlay {
        Overlay::None => {}
        Overlay::Help { scroll } | Overlay::Output { scroll, .. } | Overlay::Answers { scroll, .. } => {
            return state.found.unwrap_or(*scroll);
        }
    }
    match state.focus {
        Pane::Parameters => state.parameter,
        Pane::Pairs | Pane::Structure if state.shown.moment.solution.is_some() => state.pair,
        Pane::Pairs | Pane::Structure => state.order().place(state.pair),
        Pane::Pivots => state.step().unwrap_or_default(),
        Pane::Plot => state.plots().iter().position(|plot| *plot == state.plot).unwrap_or_default(),
        Pane::Answer => state.answer_scroll,
        Pane::Quantities => state.quantity,
        Pane::Loading => state.loadings().iter().position(|one| *one == state.loading()).unwrap_or_default(),
        Pane::Map => map::region(state),
    }
}

/// Puts the cursor on a row.
pub(super) fn go(state: &mut State, row: usize) -> Vec<Effect> {
    let limit = overlay::last_line(state);
    match &mut state.overlay {
        Overlay::None => {}
        Overlay::Help { scroll } | Overlay::Output { scroll, .. } | Overlay::Answers { scroll, .. } => {
            *scroll = row.min(limit);
            state.found = Some(row);
            return Vec::new();
        }
    }
    // The pane may be another one than that in which the search began, by a click: a row that it has.
    let row = row.min(rows(state).len().saturating_sub(1));
    match state.focus {
        Pane::Parameters => state.parameter = row,
        Pane::Pairs | Pane::Structure if state.shown.moment.solution.is_some() => state.pair = row,
        Pane::Pairs | Pane::Structure => {
            let pair = state.order().pairs.get(row).copied();
            state.pair = pair.unwrap_or_default();
        }
        Pane::Pivots if state.shown.last_step().is_some() => return step_to(state, row),
        Pane::Pivots => {}
        Pane::Plot => {
            if let Some(plot) = state.plots().get(row) {
                state.plot = *plot;
            }
        }
        Pane::Quantities => state.quantity = row,
        Pane::Map => return map::go_to_region(state, row),
        Pane::Loading => {
            if let Some(loading) = state.loadings().get(row) {
                return show(state, loading.clone());
            }
        }
        Pane::Answer => state.answer_scroll = row.min(last_answer_line(state)),
    }
    Vec::new()
}
