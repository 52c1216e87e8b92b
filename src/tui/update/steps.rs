//! Along the pivots.

use crate::view::style::Role;

use super::orders::order;
use crate::tui::action::{Effect, Job};
use crate::tui::app::{PERIOD, State};

pub(super) fn step_by(state: &mut State, by: isize) -> Vec<Effect> {
    match state.step() {
        Some(step) => step_to(state, step.saturating_add_signed(by)),
        None => step_to(state, 0),
    }
}

pub(super) fn step_to(state: &mut State, step: usize) -> Vec<Effect> {
    let Some(last) = state.shown.last_step() else {
        let why = match state.shown.answer() {
            Some(_) if state.shown.stage.is_some() => {
                "a stage is shown, whose events stand in Pivots; 8 goes back to the answer".to_owned()
            }
            Some(answer) => answer.rules.why_no_pivots(),
            None => "not solved yet: `:solve`, or `:set auto on`".to_owned(),
        };
        state.say(Role::Warning, why);
        return Vec::new();
    };
    let step = step.min(last);
    if state.step() == Some(step) {
        return Vec::new();
    }
    state.wanted_step = Some(step);
    order(state, Job::Step(step))
}

pub(super) fn play(state: &mut State) -> Vec<Effect> {
    state.playing = !state.playing;
    if !state.playing {
        return Vec::new();
    }
    if state.step().is_none() || state.step() == state.shown.last_step() {
        let effects = step_to(state, 0);
        state.playing = state.step().is_some();
        return effects;
    }
    Vec::new()
}

pub(super) fn tick(state: &mut State) -> Vec<Effect> {
    if state.playing {
        // a slow step is waited for
        if state.running.is_some() {
            return Vec::new();
        }
        if state.step() == state.shown.last_step() {
            state.playing = false;
            return Vec::new();
        }
        return step_by(state, 1);
    }
    if state.moving && state.shown.at_ray() {
        state.phase = (state.phase + 1) % PERIOD;
    }
    Vec::new()
}
