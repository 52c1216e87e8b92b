//! The sliders.

use crate::view::style::Role;

use super::orders::{line, order};
use crate::tui::action::{Effect, Job};
use crate::tui::app::State;
use crate::tui::vary;

/// What is said where there is nothing to vary.
pub(super) const NO_PARAMETERS: &str = "this scenario has no parameters";

/// The selected parameter back to the value of the file.
pub(super) fn reset(state: &mut State) -> Vec<Effect> {
    match state.selected_parameter() {
        Some((name, _)) => {
            let text = format!("reset {name}");
            line(state, text, false)
        }
        None => {
            state.say(Role::Warning, NO_PARAMETERS);
            Vec::new()
        }
    }
}

pub(super) fn vary_by(state: &mut State, tenths: i8) -> Vec<Effect> {
    let Some((name, parameter)) = state.selected_parameter() else {
        state.say(Role::Warning, NO_PARAMETERS);
        return Vec::new();
    };
    let changes = |job: &Job| matches!(job, Job::Line { .. } | Job::Show(_) | Job::Vary { .. });
    if state.running.iter().chain(&state.waiting).any(changes) {
        // a key typed ahead means the value that the command before it leaves
        let job = Job::Vary { name: name.to_owned(), tenths: vec![tenths] };
        return order(state, job);
    }
    let now = state.value(name);
    let new = vary::varied(now, parameter, tenths);
    let name = name.to_owned();
    set(state, name, new)
}

/// A slider moves to `value`.
pub(super) fn set(state: &mut State, name: String, value: f64) -> Vec<Effect> {
    if state.value(&name).to_bits() == value.to_bits() {
        return Vec::new();
    }
    if let Some(refusal) = state.shown.scenario.refusal(&name, value) {
        state.say(Role::Warning, refusal);
        return Vec::new();
    }
    state.playing = false;
    state.wanted.insert(name.clone(), value);
    order(state, Job::Set { name, value })
}
