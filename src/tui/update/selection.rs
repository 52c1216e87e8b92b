//! What has the focus, and what is selected in it.

use super::map;
use super::orders::order;
use super::steps::step_by;
use crate::tui::action::{Effect, Job, Loading};
use crate::tui::app::{Overlay, State};
use crate::tui::paint::inside;
use crate::tui::pane::{Pane, SortKey};
use crate::tui::{layout, overlay, panes};

/// The pane `by` places on, among those that have something to say.
pub(super) fn neighbour(state: &State, by: isize) -> Pane {
    let panes: Vec<Pane> = Pane::ALL.into_iter().filter(|pane| *pane == state.focus || state.offers(*pane)).collect();
    let at = panes.iter().position(|pane| *pane == state.focus).unwrap_or_default() as isize;
    panes[(at + by).rem_euclid(panes.len() as isize) as usize]
}

/// Shows the answer under a loading; a combination is shown again after every change.
pub(super) fn show(state: &mut State, loading: Loading) -> Vec<Effect> {
    if state.loading() == loading {
        return Vec::new();
    }
    state.combination = match &loading {
        Loading::Combination(name) => Some(name.clone()),
        Loading::Own | Loading::Stage(_) => None,
    };
    state.wanted_loading = Some(loading.clone());
    order(state, Job::Show(loading))
}

pub(super) fn focus(state: &mut State, pane: Pane) {
    state.focus = pane;
    if pane != Pane::Map {
        map::leave(state);
    }
    if matches!(pane, Pane::Plot | Pane::Map) {
        state.lower = pane;
    }
    if layout::SHARED.contains(&pane) {
        state.tab = pane;
    }
    if layout::SIDE.contains(&pane) {
        state.side = pane;
    }
}

pub(super) fn turn_plot(state: &mut State, by: isize) {
    let plots = state.plots();
    let count = plots.len() as isize;
    let at = plots.iter().position(|plot| *plot == state.plot).unwrap_or_default() as isize;
    state.plot = plots[(at + by).rem_euclid(count) as usize];
    if state.focus != Pane::Map {
        (state.tab, state.lower) = (Pane::Plot, Pane::Plot);
    }
}

/// Up and down in the focused pane, or in what lies over the panes.
pub(super) fn select(state: &mut State, by: isize) -> Vec<Effect> {
    let limit = overlay::last_line(state);
    match &mut state.overlay {
        Overlay::None => {}
        Overlay::Help { scroll } | Overlay::Output { scroll, .. } | Overlay::Answers { scroll, .. } => {
            *scroll = scroll.saturating_add_signed(by).min(limit);
            return Vec::new();
        }
    }
    let moved = |at: usize, count: usize| at.saturating_add_signed(by).min(count.saturating_sub(1));
    match state.focus {
        Pane::Parameters => state.parameter = moved(state.parameter, state.shown.values.len()),
        Pane::Pairs | Pane::Structure => {
            let order = state.order();
            let to = match state.focus {
                Pane::Pairs if !order.pairs.is_empty() => {
                    order.pairs.get(moved(order.place(state.pair), order.pairs.len())).copied()
                }
                _ => Some(moved(state.pair, state.pair_count())),
            };
            state.pair = to.unwrap_or_default();
        }
        Pane::Pivots => return step_by(state, by),
        Pane::Quantities => state.quantity = moved(state.quantity, state.gauges.len()),
        Pane::Loading => {
            let loadings = state.loadings();
            let at = loadings.iter().position(|loading| *loading == state.loading()).unwrap_or_default();
            return show(state, loadings[moved(at, loadings.len())].clone());
        }
        Pane::Plot => turn_plot(state, by.signum()),
        Pane::Map => return map::move_by(state, (0, -by)),
        Pane::Answer => {
            let last = last_answer_line(state);
            state.answer_scroll = state.answer_scroll.saturating_add_signed(by).min(last);
        }
    }
    Vec::new()
}

pub(super) fn scroll_to(state: &mut State, line: usize) {
    let limit = overlay::last_line(state);
    match &mut state.overlay {
        Overlay::None => {}
        Overlay::Help { scroll } | Overlay::Output { scroll, .. } | Overlay::Answers { scroll, .. } => {
            *scroll = line.min(limit)
        }
    }
}

/// The pairs by the next key: the largest first, where large is what one looks for.
pub(super) fn sort_by_next(state: &mut State) {
    let at = SortKey::ALL.iter().position(|key| *key == state.sort);
    state.sort = SortKey::ALL[at.map_or(0, |at| (at + 1) % SortKey::ALL.len())];
    state.descending = !matches!(state.sort, SortKey::File | SortKey::State | SortKey::Reserve);
}

/// The last line that may stand at the top of the Answer pane.
pub(super) fn last_answer_line(state: &State) -> usize {
    layout::area_of(state, Pane::Answer).map_or(0, |area| panes::answer::last_line(state, inside(area)))
}
