//! Work for the session that ended: what comes back is taken over.

use std::sync::Arc;

use crate::session::{DrawnMap, Next};
use crate::view::style::Role;

use super::orders::{RELOAD, order};
use super::{map, output, quantities, selection, tour};
use crate::tui::action::{Do, Done, Effect, Job, Leave, Loading};
use crate::tui::app::{Overlay, PERIOD, State};
use crate::tui::bindings::Context;
use crate::tui::kept::The;
use crate::tui::pane::Pane;
use crate::tui::tour::steps;
use crate::tui::{layout, panes};

/// A job ended: its result is shown, the next one begins.
pub(super) fn finish(state: &mut State, done: Done) -> Vec<Effect> {
    let is_reload = matches!(&done.job, Job::Line { text, .. } if text == RELOAD);
    let new_scenario = !Arc::ptr_eq(&state.shown.scenario, &done.shown.scenario);
    state.running = None;
    state.progress = None;
    let old_map = state.shown.map.as_ref().map(|(drawn, _)| The::one(drawn));
    if matches!(done.job, Job::Glance { .. }) {
        map::take(state, done.shown);
    } else if done.job.is_background() && state.below.is_some() {
        state.below = Some(done.shown);
    } else {
        state.below = None;
        if state.shown.viewpoint != done.shown.viewpoint {
            state.turned = None;
        }
        state.shown = done.shown;
    }
    if new_scenario {
        // Sliders and steps meant the old one; lines (those of the tour, too) are carried out in their order.
        state.waiting.retain(|job| matches!(job, Job::Line { .. }));
        state.wanted_step = None;
        if is_reload {
            state.reloaded();
        } else {
            state.new_scenario();
        }
    }
    if new_scenario || is_reload {
        state.trouble = None;
    }
    settle(state, &done.job);
    if done.job == Job::Remedies && done.interrupted {
        state.remedies_sought = None;
    }
    let changed = matches!(done.job, Job::Set { .. } | Job::Vary { .. } | Job::Show(_)) || done.job.is_background();
    quantities::ask(state, done.asked);
    match (&done.job, done.gauges) {
        // those of the session are not those at the cursor of the map
        (_, Some(gauges)) if state.below.is_none() => quantities::take(state, gauges),
        // whoever types has chosen for himself
        (Job::Line { shows: true, .. }, None) => state.combination = None,
        _ => {}
    }
    let moved = matches!(done.job, Job::Set { .. } | Job::Vary { .. } | Job::Line { shows: false, .. });
    let ended = !done.interrupted && done.error.is_none();
    let followed = changed && ended;
    if let Some(error) = done.error {
        if done.interrupted {
            // a slider or cursor that moved on stops its older solve: nothing to report
            let moves_on = changed || matches!(done.job, Job::Glance { .. });
            if !moves_on || state.waiting.is_empty() {
                state.say(Role::Warning, "stopped: the session is as it was");
            }
        } else if is_reload && matches!(done.job, Job::Line { shows: false, .. }) {
            // it stays over the last good picture until the file is right
            state.trouble = Some(error);
        } else {
            output::tell(state, &done.job, &error, Role::Bad);
        }
    } else if let Some(answers) = done.answers {
        state.overlay = Overlay::Answers { answers, scroll: 0 };
        state.found = None;
    } else {
        output::show_output(state, &done.job, &done.output);
    }
    show_new_map(state, &done.job, old_map);
    let mut effects = Vec::new();
    if let Some(name) = state.combination.clone().filter(|_| moved && ended && state.shown.combination.is_none()) {
        effects.extend(order(state, Job::Show(Loading::Combination(name))));
    }
    match done.next {
        Next::Continue => {}
        Next::Quit => return vec![Effect::Leave(Leave::Quit)],
        Next::Edit => effects.extend(state.shown.scenario.path.clone().map(Effect::Edit)),
        Next::FullScreen { tour: Some(of) } => effects.extend(tour::begin_tour(state, of, 0)),
        Next::FullScreen { tour: None } => {
            state.say(Role::Plain, "this is the full screen: `q` leaves it");
        }
    }
    if state.running.is_none()
        && let Some(next) = state.waiting.pop_front()
    {
        state.running = Some(next.clone());
        effects.push(Effect::Run(next));
    }
    if followed && state.shown.is_warm() && !state.shown.is_behind() {
        // The answer is there; its pivots follow unless a slider moves on.
        effects.extend(order(state, Job::Pivots));
    }
    effects.extend(background(state));
    effects
}

/// What is computed while nothing else is asked for: first what moves, then the remedies of a collapse.
pub fn background(state: &mut State) -> Vec<Effect> {
    if state.running.is_some() || !state.waiting.is_empty() || state.below.is_some() {
        return Vec::new();
    }
    let here = The::one(&state.shown.moment);
    if state.shown.is_behind() {
        order(state, Job::Motion)
    } else if state.gauges_at.as_ref() != Some(&here)
        && state.shown.solved.is_some()
        && layout::area_of(state, Pane::Quantities).is_some()
    {
        order(state, Job::Quantities(state.asked.clone()))
    } else if state.shown.lacks_remedies() && state.remedies_sought.as_ref() != Some(&here) {
        state.remedies_sought = Some(here);
        order(state, Job::Remedies)
    } else {
        Vec::new()
    }
}

/// A map that was drawn is shown in its pane; what it printed can be shown again.
fn show_new_map(state: &mut State, job: &Job, old: Option<The<DrawnMap>>) {
    let new = state.shown.map.as_ref().map(|(drawn, _)| The::one(drawn));
    if new == old {
        return;
    }
    state.map_at = None;
    if let (Some(regions), Job::Line { shows: true, .. }) = (panes::map::drawn(state).map(|d| d.map.regions.len()), job)
    {
        state.overlay = Overlay::None;
        selection::focus(state, Pane::Map);
        let keys = state.keys.of(Context::Everywhere, Do::Output, state.look.ascii);
        state.say(
            Role::Good,
            format!("a map of {regions} regions: the arrows move its cursor ({keys} shows its table)"),
        );
    }
}

/// Brings the selections and what was asked for in line with what is shown.
fn settle(state: &mut State, job: &Job) {
    let waits = |name: &str, state: &State| {
        state.waiting.iter().any(|job| matches!(job, Job::Set { name: other, .. } if other == name))
    };
    let kept: Vec<String> = state.wanted.keys().filter(|name| waits(name, state)).cloned().collect();
    state.wanted.retain(|name, _| kept.contains(name));
    if !state.waiting.iter().any(|job| matches!(job, Job::Step(_))) {
        state.wanted_step = None;
    }
    if !state.waiting.iter().any(|job| matches!(job, Job::Show(_))) {
        state.wanted_loading = None;
    }
    let count = state.pair_count();
    state.pair = state.pair.min(count.saturating_sub(1));
    state.parameter = state.parameter.min(state.shown.values.len().saturating_sub(1));
    if let (Some((of, at)), Job::Line { shows: false, .. }) = (state.tour, job)
        && let Some(step) = steps(of).get(at)
    {
        state.plot = step.plot;
        if at == 0 && (state.shown.previous.is_some() || !state.shown.moment.changes.is_empty()) {
            // the tour begins here: there is nothing before it
            state.shown = Arc::new(state.shown.without_before());
        }
    }
    let plots = state.plots();
    if !plots.contains(&state.plot) {
        state.plot = plots[0];
    }
    if !state.shown.at_ray() {
        state.moving = false;
        state.phase = PERIOD / 4;
    }
    state.answer_scroll = state.answer_scroll.min(selection::last_answer_line(state));
}
