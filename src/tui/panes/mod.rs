//! The panes: each draws its part of the state into a rectangle.

pub mod answer;
mod legend;
pub mod loading;
pub mod map;
pub mod pairs;
pub mod parameters;
pub mod pivots;
pub mod plot;
pub mod quantities;
mod strip;
pub mod structure;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::app::State;
use super::pane::Pane;

/// Draws the inside of a pane.
pub fn draw(state: &State, pane: Pane, area: Rect, buffer: &mut Buffer) {
    if area.is_empty() {
        return;
    }
    match pane {
        Pane::Structure => structure::draw(state, area, buffer),
        Pane::Parameters => parameters::draw(state, area, buffer),
        Pane::Pairs => pairs::draw(state, area, buffer),
        Pane::Pivots => pivots::draw(state, area, buffer),
        Pane::Plot => plot::draw(state, area, buffer),
        Pane::Answer => answer::draw(state, area, buffer),
        Pane::Quantities => quantities::draw(state, area, buffer),
        Pane::Loading => loading::draw(state, area, buffer),
        Pane::Map => map::draw(state, area, buffer),
    }
}

/// What stands in the border of a pane, at the right.
pub fn note(state: &State, pane: Pane) -> String {
    match pane {
        Pane::Structure => structure::note(state),
        Pane::Pairs => pairs::note(state),
        Pane::Pivots => pivots::note(state),
        Pane::Loading => loading::note(state),
        Pane::Map => map::note(state),
        Pane::Parameters | Pane::Plot | Pane::Answer | Pane::Quantities => String::new(),
    }
}
