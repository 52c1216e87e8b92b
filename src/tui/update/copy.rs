//! What is under the cursor, as a text and as a command.

use crate::session::language::tokens::quote;
use crate::view::style::Role;

use super::orders::line;
use crate::tui::action::{Effect, Loading};
use crate::tui::app::{Overlay, State};
use crate::tui::clipboard::MOST;
use crate::tui::pane::Pane;
use crate::tui::panes::{answer, loading, map, pairs, pivots};
use crate::tui::{layout, overlay, paint};

/// What is said where the pivots of the answer are asked for while a stage is shown.
const OF_THE_ANSWER: &str =
    "a stage is shown, whose events stand in Pivots; why and ties ask the answer (8 goes back to it)";

/// `ties` of the pivot shown.
pub(super) fn ties(state: &mut State) -> Vec<Effect> {
    if state.shown.stage.is_some() {
        state.say(Role::Warning, OF_THE_ANSWER);
        return Vec::new();
    }
    line(state, "ties".into(), true)
}

/// `why` of the selected pair.
pub(super) fn why(state: &mut State) -> Vec<Effect> {
    if state.shown.stage.is_some() {
        state.say(Role::Warning, OF_THE_ANSWER);
        return Vec::new();
    }
    match why_command(state) {
        Some(text) => line(state, text, true),
        None => {
            state.say(Role::Warning, "no contact pair is selected: there is none");
            Vec::new()
        }
    }
}

/// The command that says most about the selected pair.
fn why_command(state: &State) -> Option<String> {
    if state.shown.moment.solution.is_some() {
        let name = pairs::names(state).get(state.pair)?.clone();
        return Some(format!("why {}", quote(&format!("z[{name}]"))));
    }
    let id = quote(&state.shown.pairs().get(state.pair)?.id);
    Some(if state.shown.stage.is_some() { format!("pairs {id}") } else { format!("why {id}") })
}

/// Copies the value.
pub(super) fn value(state: &mut State) -> Vec<Effect> {
    let text = value_text(state);
    copy(state, text)
}

/// Copies the command.
pub(super) fn command(state: &mut State) -> Vec<Effect> {
    let text = command_text(state);
    copy(state, text)
}

fn copy(state: &mut State, text: Option<String>) -> Vec<Effect> {
    let Some(text) = text.filter(|text| !text.is_empty()) else {
        state.say(Role::Warning, "nothing to copy here");
        return Vec::new();
    };
    if text.len() > MOST {
        let kilobytes = text.len() / 1000;
        state
            .say(Role::Warning, format!("{kilobytes} kB are too much for a terminal to copy: `:export` writes a file"));
        return Vec::new();
    }
    let said = match text.lines().count() {
        1 => format!("copied: {text}"),
        lines => format!("copied: {lines} lines"),
    };
    state.say(Role::Good, said);
    vec![Effect::Copy(text)]
}

/// The number, row or text under the cursor.
fn value_text(state: &State) -> Option<String> {
    if state.overlay != Overlay::None {
        let lines = overlay::lines(state);
        if let Some(line) = state.found.and_then(|found| lines.get(found)) {
            return Some(line.to_string().trim().to_owned());
        }
        let lines: Vec<String> = lines.iter().map(|line| line.to_string().trim_end().to_owned()).collect();
        return Some(lines.join("\n"));
    }
    match state.focus {
        Pane::Parameters => {
            let (name, _) = state.selected_parameter()?;
            Some(state.value(name).to_string())
        }
        Pane::Pairs | Pane::Structure => pairs::copied(state),
        Pane::Pivots => Some(pivots::sentence(state)),
        Pane::Plot => None,
        Pane::Quantities => state.gauges.get(state.quantity).map(|gauge| gauge.value.clone()),
        Pane::Loading => Some(loading::name(state, &state.loading())),
        Pane::Map => map::about(state),
        Pane::Answer => {
            let width = layout::area_of(state, Pane::Answer).map_or(80, |area| paint::inside(area).width);
            let lines = answer::lines(state, usize::from(width));
            let lines: Vec<String> = lines.iter().map(|line| line.to_string().trim_end().to_owned()).collect();
            Some(lines.join("\n"))
        }
    }
}

/// The command that sets it, goes there or shows it.
fn command_text(state: &State) -> Option<String> {
    match &state.overlay {
        Overlay::None => {}
        Overlay::Output { title, .. } => return Some(title.clone()),
        Overlay::Answers { .. } => return Some("enumerate".to_owned()),
        Overlay::Help { .. } => return None,
    }
    match state.focus {
        Pane::Parameters => {
            let (name, _) = state.selected_parameter()?;
            Some(format!("set {} {}", quote(name), state.value(name)))
        }
        Pane::Pairs | Pane::Structure => why_command(state),
        Pane::Pivots => Some(format!("step to {}", state.step()?)),
        Pane::Plot => state.plot.command().map(str::to_owned),
        Pane::Answer => Some("status".to_owned()),
        Pane::Quantities => state.gauges.get(state.quantity).map(|gauge| format!("show {}", gauge.quantity)),
        Pane::Map => map::command(state)?.ok(),
        Pane::Loading => Some(match state.loading() {
            Loading::Own => "solve".to_owned(),
            Loading::Combination(name) => format!("combine {}", quote(&name)),
            Loading::Stage(stage) => format!("stages {}", stage + 1),
        }),
    }
}
