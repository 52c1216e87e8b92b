//! The steps of the tour.

use crate::view::style::Role;

use super::orders::line;
use super::selection::focus;
use crate::session::commands::screen::Tour;
use crate::tui::action::Effect;
use crate::tui::app::{Input, Overlay, State};
use crate::tui::tour;

pub(super) fn tour_by(state: &mut State, by: isize) -> Vec<Effect> {
    let Some((of, at)) = state.tour else {
        return Vec::new();
    };
    let next = at.saturating_add_signed(by);
    if next >= tour::steps(of).len() {
        state.tour = None;
        state.say(Role::Good, "the tour is over; others: `:tour beam`, `pipe`, `dam`, `lcp`, or `:load` a scenario");
        return Vec::new();
    }
    begin_tour(state, of, next)
}

/// Shows a step of the tour.
pub fn begin_tour(state: &mut State, of: Tour, at: usize) -> Vec<Effect> {
    let Some(step) = tour::steps(of).get(at) else {
        return Vec::new();
    };
    state.tour = Some((of, at));
    state.message = None;
    state.overlay = Overlay::None;
    state.input = Input::None;
    state.playing = false;
    state.moving = false;
    state.maximized = false;
    focus(state, step.pane);
    // the plot is chosen once its answer is there
    line(state, step.commands.to_owned(), false)
}
