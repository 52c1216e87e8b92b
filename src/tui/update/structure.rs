//! How the structure is looked at.

use crate::model::structure::Dimension;
use crate::view::projection::Viewpoint;
use crate::view::style::Role;

use crate::tui::action::LookChange;
use crate::tui::app::{PERIOD, State};
use crate::tui::pane::Pane;
use crate::tui::panes;

/// Largest zoom.
const ZOOM: f64 = 1e4;

/// Zooms, pans, or scales the displacements.
pub(super) fn look(state: &mut State, change: LookChange) {
    match change {
        LookChange::ZoomIn => zoom(state, 1.5),
        LookChange::ZoomOut => zoom(state, 1.0 / 1.5),
        LookChange::Fit => state.view = Default::default(),
        LookChange::Pan(x, y) => {
            let step = 0.2 / state.view.zoom;
            let centre = &mut state.view.centre;
            centre.0 = (centre.0 + f64::from(x) * step).clamp(-1.0, 1.0);
            centre.1 = (centre.1 + f64::from(y) * step).clamp(-1.0, 1.0);
        }
        LookChange::DeformMore => deform(state, 2.0),
        LookChange::DeformLess => deform(state, 0.5),
        LookChange::DeformAuto => state.magnification = None,
        LookChange::Loads => state.loads = !state.loads,
        LookChange::Turn(right, up) => turn(state, |view| view.turned(f64::from(right), f64::from(up))),
        LookChange::NextView => turn(state, Viewpoint::next),
    }
}

/// Sees the structure from elsewhere, if it lies in space.
fn turn(state: &mut State, to: impl Fn(Viewpoint) -> Viewpoint) {
    match state.shown.structure().map(|structure| structure.dimension) {
        Some(Dimension::Space) => state.turned = Some(to(state.viewpoint())),
        Some(Dimension::Plane) => state.say(Role::Muted, "this structure lies in the plane: there is nothing to turn"),
        None => state.say(Role::Muted, "there is no structure to turn"),
    }
}

pub(super) fn zoom(state: &mut State, by: f64) {
    state.view.zoom = (state.view.zoom * by).clamp(1.0, ZOOM);
    if state.view.zoom <= 1.0 + 1e-9 {
        state.view = Default::default();
    }
}

fn deform(state: &mut State, by: f64) {
    let now = state.magnification.unwrap_or_else(|| panes::structure::scale(state));
    let new = now * by;
    if new.is_finite() && new > 0.0 {
        state.magnification = Some(new);
    }
}

/// Lets the mode of the ray move, or stops it.
pub(super) fn move_mode(state: &mut State) {
    if !state.shown.at_ray() {
        let why = match state.shown.answer() {
            Some(answer) if answer.ray.is_some() => "the mode belongs to the ray: go to the end of the pivots",
            _ => "no ray here: there is an answer, and no mode of collapse",
        };
        state.say(Role::Warning, why);
    } else if !state.shown.has_mode() {
        state.say(Role::Warning, "this ray has no motion that could be drawn");
    } else {
        state.moving = !state.moving;
        state.phase = PERIOD / 4;
        if state.moving {
            state.tab = Pane::Structure;
        }
    }
}
