//! The cursor of the map: the other panes show the answer there, beside the session, until the cursor is left.

use std::sync::Arc;

use super::orders::{line, order};
use crate::tui::action::{Do, Effect, Job};
use crate::tui::app::State;
use crate::tui::layout;
use crate::tui::pane::Pane;
use crate::tui::panes::map;
use crate::view::style::Role;

/// Whether an action leaves the answer at the cursor in sight.
pub(super) fn keeps_glance(what: Do) -> bool {
    matches!(
        what,
        Do::Up
            | Do::Down
            | Do::PageUp
            | Do::PageDown
            | Do::Top
            | Do::Bottom
            | Do::Close
            | Do::Across(_)
            | Do::SetHere
            | Do::NextRegion
            | Do::Search
            | Do::FindNext
            | Do::FindPrevious
            | Do::Accept
            | Do::Cancel
            | Do::Edit(_)
            | Do::Complete
            | Do::HistoryBack
            | Do::HistoryOn
            | Do::CopyValue
            | Do::CopyCommand
            | Do::Help
            | Do::NextPlot
            | Do::PreviousPlot
            | Do::Mode
            | Do::Before
            | Do::Look(_)
            | Do::Maximize
            | Do::Explain
            | Do::Redraw
            | Do::Suspend
            | Do::Mouse
            | Do::Focus(Pane::Map)
    )
}

/// Shows the session again.
pub(super) fn leave(state: &mut State) {
    state.waiting.retain(|job| !matches!(job, Job::Glance { .. }));
    if let Some(session) = state.below.take() {
        state.shown = session;
    }
}

/// Says that there is no map to move in.
fn without_map(state: &mut State) -> Vec<Effect> {
    state.say(Role::Warning, "no map yet: `:map P Q` draws one");
    Vec::new()
}

/// The answer at a place of the map.
pub(super) fn glance_at(state: &mut State, at: [f64; 2]) -> Vec<Effect> {
    let Some(drawn) = map::drawn(state) else { return without_map(state) };
    let axis = |k: usize| (drawn.map.axes[k].name.clone(), at[k]);
    let settings = [axis(0), axis(1)];
    state.map_at = Some(at);
    order(state, Job::Glance { settings })
}

/// The cursor this many cells to the right and up.
pub(super) fn move_by(state: &mut State, by: (isize, isize)) -> Vec<Effect> {
    let to = layout::area_of(state, Pane::Map).and_then(|area| map::moved(state, by, area));
    match to {
        Some(at) => glance_at(state, at),
        None => without_map(state),
    }
}

/// The cursor to the marked place of a region.
pub(super) fn go_to_region(state: &mut State, region: usize) -> Vec<Effect> {
    let at = map::drawn(state).and_then(|drawn| drawn.map.regions.get(region)).map(|region| region.at);
    at.map_or_else(Vec::new, |at| glance_at(state, at))
}

/// The region under the cursor, from 0.
pub(super) fn region(state: &State) -> usize {
    let found = map::drawn(state).zip(map::cursor(state)).and_then(|(drawn, at)| drawn.map.region_at(at));
    found.unwrap_or_default()
}

/// The cursor into the next region.
pub(super) fn next_region(state: &mut State) -> Vec<Effect> {
    match map::drawn(state).map_or(0, |drawn| drawn.map.regions.len()) {
        0 => without_map(state),
        count => go_to_region(state, (region(state) + 1) % count),
    }
}

/// The cursor back to the present values.
pub(super) fn home(state: &mut State) {
    leave(state);
    state.map_at = None;
}

/// Sets both parameters to the place of the cursor.
pub(super) fn set_here(state: &mut State) -> Vec<Effect> {
    match map::command(state) {
        Some(Ok(text)) => {
            leave(state);
            line(state, text, false)
        }
        Some(Err(why)) => {
            state.say(Role::Warning, why);
            Vec::new()
        }
        None => without_map(state),
    }
}

/// A glance came back: shown unless the cursor was left meanwhile.
pub(super) fn take(state: &mut State, shown: Arc<crate::tui::shown::Shown>) {
    if shown.glance.is_some() && state.focus == Pane::Map {
        let session = std::mem::replace(&mut state.shown, shown);
        state.below.get_or_insert(session);
    }
}
