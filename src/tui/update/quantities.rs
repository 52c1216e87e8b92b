//! What is shown in the Quantities pane.

use crate::model::quantity::Quantity;
use crate::session::Gauge;
use crate::view::style::Role;

use crate::tui::app::State;
use crate::tui::kept::The;

/// These are shown from now on, too.
pub(super) fn ask(state: &mut State, quantities: Vec<Quantity>) {
    for quantity in quantities {
        let is_probe = matches!(quantity, Quantity::Probe(..));
        if !is_probe && !state.asked.contains(&quantity) {
            state.asked.push(quantity);
            state.gauges_at = None;
        }
    }
}

/// The selected one is shown no longer.
pub(super) fn forget(state: &mut State) {
    let probes = state.shown.scenario.probes.len();
    match state.quantity.checked_sub(probes).filter(|at| *at < state.asked.len()) {
        Some(at) => {
            state.asked.remove(at);
            state.gauges.remove(state.quantity);
            state.quantity = state.quantity.min(state.gauges.len().saturating_sub(1));
            state.gauges_at = None;
        }
        None if state.quantity < probes => state.say(Role::Warning, "a probe belongs to the scenario: it stays"),
        None => state.say(Role::Warning, "this one was not asked for: it is shown while nothing else is"),
    }
}

/// Takes over the values of the state shown.
pub(super) fn take(state: &mut State, gauges: Vec<Gauge>) {
    state.quantity = state.quantity.min(gauges.len().saturating_sub(1));
    state.gauges = gauges;
    state.gauges_at = Some(The::one(&state.shown.moment));
}
