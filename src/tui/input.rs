//! What a key press means in the present state.

use crossterm::event::{KeyCode, KeyEvent, KeyEventKind};

use super::action::Action;
use super::app::{Input, Overlay, State};
use super::bindings::Context;
use super::key::Key;

/// The places in which a key is looked for now, in this order.
pub fn contexts(state: &State) -> Vec<Context> {
    if state.input != Input::None {
        vec![Context::Entry]
    } else if state.overlay != Overlay::None {
        vec![Context::Overlay]
    } else {
        let mut contexts = Vec::new();
        if state.tour.is_some() {
            contexts.push(Context::Tour);
        }
        contexts.push(Context::Pane(state.focus));
        contexts.push(Context::Everywhere);
        contexts
    }
}

/// What a key press means now; `None` if nothing.
pub fn action(state: &State, event: &KeyEvent) -> Option<Action> {
    if event.kind == KeyEventKind::Release {
        return None;
    }
    let key = Key::of(event);
    for context in contexts(state) {
        if let Some(action) = state.keys.find(context, key) {
            return Some(Action::Do(action));
        }
    }
    match key {
        Key { code: KeyCode::Char(c), control: false, alt: false } if state.input != Input::None => {
            Some(Action::Type(c))
        }
        _ => None,
    }
}
