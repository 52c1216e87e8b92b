//! A line being typed.

use std::sync::Arc;

use crate::view::style::Role;

use super::orders::line;
use super::parameters::NO_PARAMETERS;
use super::search;
use crate::tui::action::Effect;
use crate::tui::app::{Input, State};
use crate::tui::entry::{Edit, Entry};

/// Lines of history kept.
const HISTORY: usize = 1000;

/// The line being typed.
fn entry(state: &mut State) -> Option<&mut Entry> {
    match &mut state.input {
        Input::None => None,
        Input::Command(entry) | Input::Search { entry, .. } | Input::Value { entry, .. } => Some(entry),
    }
}

/// Types a text.
pub(super) fn insert(state: &mut State, text: &str) {
    if let Some(entry) = entry(state) {
        entry.insert(text);
    }
}

/// Changes the line; deleting in an empty one closes it.
pub(super) fn edit(state: &mut State, change: Edit) {
    match entry(state) {
        Some(line) if change == Edit::Backspace && line.text.is_empty() => state.input = Input::None,
        Some(line) => line.edit(change),
        None => {}
    }
}

/// Completes the word of a command.
pub(super) fn complete(state: &mut State) {
    let shown = Arc::clone(&state.shown);
    if let Input::Command(entry) = &mut state.input {
        entry.complete(shown.vocabulary());
    }
}

/// Opens the line for a value of the selected parameter.
pub(super) fn type_value(state: &mut State) {
    match state.selected_parameter() {
        Some((name, _)) => state.input = Input::Value { name: name.to_owned(), entry: Entry::default() },
        None => state.say(Role::Warning, NO_PARAMETERS),
    }
}

pub(super) fn recall(state: &mut State, by: isize) {
    let history = std::mem::take(&mut state.history);
    if let Input::Command(entry) = &mut state.input {
        let back = entry.back.saturating_add_signed(by);
        entry.recall(&history, back);
    }
    state.history = history;
}

pub(super) fn accept(state: &mut State) -> Vec<Effect> {
    match std::mem::take(&mut state.input) {
        Input::None => Vec::new(),
        Input::Command(entry) => {
            let text = entry.text.trim().to_owned();
            if text.is_empty() {
                return Vec::new();
            }
            if state.history.last() != Some(&text) {
                state.history.push(text.clone());
                if state.history.len() > HISTORY {
                    state.history.remove(0);
                }
            }
            // short for what is asked most at the prompt
            if text == "q" {
                return vec![Effect::Leave(state.home)];
            }
            line(state, text, true)
        }
        Input::Search { entry, from } => {
            state.sought = entry.text.clone();
            search::find(state, &entry.text, from, true)
        }
        Input::Value { name, entry } => {
            let text = entry.text.trim();
            if text.is_empty() {
                return Vec::new();
            }
            let text = format!("set {name} {text}");
            line(state, text, false)
        }
    }
}

/// Drops the line; a search goes back to where it began.
pub(super) fn cancel(state: &mut State) -> Vec<Effect> {
    match std::mem::take(&mut state.input) {
        Input::Search { from, .. } => search::go(state, from),
        _ => Vec::new(),
    }
}
