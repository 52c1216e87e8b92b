//! Orders to the worker: what runs now, what waits, what is stopped.

use super::super::action::{Effect, Job};
use super::super::app::State;

/// Runs a job now, or after the one at work. Of the same slider only the newest value counts: an older solve is
/// stopped. Of the steps only the last counts.
pub(super) fn order(state: &mut State, job: Job) -> Vec<Effect> {
    let Some(running) = &state.running else {
        state.running = Some(job.clone());
        state.progress = None;
        return vec![Effect::Run(job)];
    };
    let mut effects = Vec::new();
    if matches!(running, Job::Remedies | Job::Quantities(_)) {
        effects.push(Effect::Stop);
    }
    match &job {
        Job::Set { name, .. } => {
            state.waiting.retain(|waiting| {
                !matches!(waiting, Job::Set { name: other, .. } if other == name) && !matches!(waiting, Job::Step(_))
            });
            state.wanted_step = None;
            let older = match running {
                Job::Set { name: other, .. } => other == name,
                Job::Pivots | Job::Motion => true,
                _ => false,
            };
            if older {
                effects.push(Effect::Stop);
            }
        }
        Job::Vary { name, tenths } => {
            if let Some(Job::Vary { name: other, tenths: before }) = state.waiting.back_mut()
                && other == name
            {
                before.extend(tenths);
                return effects;
            }
        }
        Job::Step(_) => {
            state.waiting.retain(|waiting| !matches!(waiting, Job::Step(_)));
            if matches!(running, Job::Motion) {
                effects.push(Effect::Stop);
            }
        }
        Job::Show(_) => {
            state.waiting.retain(|waiting| !matches!(waiting, Job::Show(_)));
            if matches!(running, Job::Show(_)) {
                effects.push(Effect::Stop);
            }
        }
        Job::Glance { .. } => {
            state.waiting.retain(|waiting| !matches!(waiting, Job::Glance { .. }));
            if matches!(running, Job::Glance { .. } | Job::Pivots) {
                effects.push(Effect::Stop);
            }
        }
        Job::Answers | Job::Line { .. } => {}
        Job::Pivots | Job::Motion | Job::Quantities(_) | Job::Remedies => {}
    }
    state.waiting.push_back(job);
    effects
}

/// A command line for the session.
pub(super) fn line(state: &mut State, text: String, shows: bool) -> Vec<Effect> {
    order(state, Job::Line { text, shows })
}

/// What [`reload`] orders.
pub(super) const RELOAD: &str = "reload";

/// Reads the file again: it was saved. One such job that waits is enough.
pub(super) fn reload(state: &mut State) -> Vec<Effect> {
    let job = Job::Line { text: RELOAD.into(), shows: false };
    if state.waiting.contains(&job) { Vec::new() } else { order(state, job) }
}

pub(super) fn stop(state: &mut State) -> Vec<Effect> {
    state.playing = false;
    state.moving = false;
    state.trouble = None;
    state.waiting.clear();
    state.wanted_step = None;
    state.wanted_loading = None;
    if state.running.is_some() { vec![Effect::Stop] } else { Vec::new() }
}
