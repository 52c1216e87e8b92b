//! The mouse.

use crate::tui::action::{Effect, Mouse};
use crate::tui::app::{Input, Overlay, State};
use crate::tui::layout::{self, Places};
use crate::tui::pane::Pane;
use crate::tui::{panes, vary};

use super::map;
use super::parameters::set;
use super::selection::{focus, select, show};
use super::steps::step_to;
use super::structure::zoom;

pub(super) fn by_mouse(state: &mut State, mouse: Mouse) -> Vec<Effect> {
    let Some(places) = layout::places(state) else {
        return Vec::new();
    };
    match mouse {
        Mouse::WheelUp(x, y) => wheel(state, &places, x, y, -1),
        Mouse::WheelDown(x, y) => wheel(state, &places, x, y, 1),
        _ if state.overlay != Overlay::None || state.input != Input::None => Vec::new(),
        Mouse::Press(x, y) => {
            state.message = None;
            press(state, &places, x, y)
        }
        Mouse::Drag(x, _) => {
            let area = places.panes.iter().find(|(pane, _)| *pane == Pane::Parameters);
            match (state.held, area) {
                (Some(parameter), Some((_, area))) => slide(state, parameter, *area, x),
                _ => Vec::new(),
            }
        }
    }
}

fn wheel(state: &mut State, places: &Places, x: u16, y: u16, by: isize) -> Vec<Effect> {
    if state.overlay != Overlay::None {
        return select(state, 3 * by);
    }
    match layout::pane_at(places, x, y) {
        Some((Pane::Structure, _)) => {
            zoom(state, if by < 0 { 1.25 } else { 0.8 });
            Vec::new()
        }
        Some((pane, _)) => {
            focus(state, pane);
            select(state, by)
        }
        None => Vec::new(),
    }
}

fn press(state: &mut State, places: &Places, x: u16, y: u16) -> Vec<Effect> {
    state.held = None;
    if let Some((area, names)) = &places.tabs
        && y == area.y
    {
        let front = places.panes.first().map_or(state.focus, |(pane, _)| *pane);
        let tab = layout::tab_names(*area, names, front)
            .into_iter()
            .rev()
            .find(|(start, ..)| *start <= x && x < area.right());
        if let Some((_, pane, _)) = tab {
            focus(state, pane);
            return Vec::new();
        }
    }
    let Some((pane, area)) = layout::pane_at(places, x, y) else {
        return Vec::new();
    };
    focus(state, pane);
    match pane {
        Pane::Parameters => {
            if let Some(parameter) = panes::parameters::row_at(state, area, y) {
                state.parameter = parameter;
                state.held = Some(parameter);
                return slide(state, parameter, area, x);
            }
        }
        Pane::Pivots => {
            if let Some(step) = panes::pivots::step_at(state, area, y) {
                return step_to(state, step);
            }
        }
        Pane::Pairs => {
            if let Some(pair) = panes::pairs::pair_at(state, area, y) {
                state.pair = pair;
            }
        }
        Pane::Quantities => {
            if let Some(row) = panes::quantities::row_at(state, area, y) {
                state.quantity = row;
            }
        }
        Pane::Loading => {
            if let Some(loading) = panes::loading::at(state, area, y) {
                return show(state, loading);
            }
        }
        Pane::Map => {
            if let Some(at) = panes::map::place_at(state, area, (x, y)) {
                return map::glance_at(state, at);
            }
        }
        Pane::Structure | Pane::Plot | Pane::Answer => {}
    }
    Vec::new()
}

/// The slider of a parameter goes to the column `x`, if that is on it.
fn slide(state: &mut State, parameter: usize, area: ratatui::layout::Rect, x: u16) -> Vec<Effect> {
    let Some(slider) = panes::parameters::slider(state, area) else {
        return Vec::new();
    };
    if x < slider.0 || x > slider.1 {
        return Vec::new();
    }
    let share = f64::from(x - slider.0) / f64::from((slider.1 - slider.0).max(1));
    let found = state
        .shown
        .scenario
        .parameters
        .get_index(parameter)
        .and_then(|(name, parameter)| Some((name.clone(), vary::at(share, parameter)?)));
    match found {
        Some((name, value)) => set(state, name, value),
        None => Vec::new(),
    }
}
