//! (state, action) → state and effects. Pure: no terminal, no clock, no thread.

mod copy;
mod jobs;
mod map;
mod mouse;
mod orders;
mod output;
mod parameters;
mod quantities;
mod search;
mod selection;
mod steps;
mod structure;
mod tour;
mod typing;

use crate::view::style::Role;

use super::action::{Action, Do, Effect, Job, Leave};
use super::app::{Input, Overlay, State};
use super::entry::Entry;

use jobs::finish;
use mouse::by_mouse;
use orders::{line, order, stop};
use parameters::vary_by;
use selection::{focus, neighbour, scroll_to, select, turn_plot};
use steps::{play, step_by, step_to, tick};
use tour::tour_by;
use typing::{accept, recall};

pub use jobs::background;
pub use tour::begin_tour;

/// Rows of a page.
const PAGE: usize = 10;

/// Lets `action` happen.
pub fn update(state: &mut State, action: Action) -> Vec<Effect> {
    match action {
        Action::Do(what) => {
            if !matches!(what, Do::Redraw) {
                state.message = None;
            }
            if !map::keeps_glance(what) {
                map::leave(state);
            }
            let mut effects = perform(state, what);
            effects.extend(background(state));
            effects
        }
        Action::Type(c) => {
            typing::insert(state, c.encode_utf8(&mut [0; 4]));
            search::follow(state)
        }
        Action::Paste(text) => {
            typing::insert(state, text.trim_end_matches(['\n', '\r']));
            search::follow(state)
        }
        Action::Mouse(mouse) => by_mouse(state, mouse),
        Action::Resize(width, height) => {
            state.size = (width, height);
            vec![Effect::Redraw]
        }
        Action::Tick => tick(state),
        Action::Progress { what, fraction } => {
            if state.running.is_some() {
                state.progress = Some((what, fraction));
            }
            Vec::new()
        }
        Action::Done(done) => finish(state, *done),
        Action::Saved | Action::Edited(None) => orders::reload(state),
        Action::Edited(Some(error)) => {
            state.say(Role::Bad, error);
            Vec::new()
        }
    }
}

fn perform(state: &mut State, what: Do) -> Vec<Effect> {
    match what {
        Do::Leave => return vec![Effect::Leave(state.home)],
        Do::Exit => return vec![Effect::Leave(Leave::Quit)],
        Do::ToRepl => return vec![Effect::Leave(Leave::Repl)],
        Do::Help => {
            state.overlay = Overlay::Help { scroll: 0 };
            state.found = None;
        }
        Do::Command => {
            state.overlay = Overlay::None;
            state.input = Input::Command(Entry::default());
        }
        Do::NextPane => focus(state, neighbour(state, 1)),
        Do::PreviousPane => focus(state, neighbour(state, -1)),
        Do::Focus(pane) => focus(state, pane),
        Do::Maximize => state.maximized = !state.maximized,
        Do::Up => return select(state, -1),
        Do::Down => return select(state, 1),
        Do::PageUp => return select(state, -(PAGE as isize)),
        Do::PageDown => return select(state, PAGE as isize),
        Do::Top => scroll_to(state, 0),
        Do::Bottom => scroll_to(state, usize::MAX),
        Do::StepOn => return step_by(state, 1),
        Do::StepBack => return step_by(state, -1),
        Do::StepFirst => return step_to(state, 0),
        Do::StepLast => return step_to(state, usize::MAX),
        Do::Play => return play(state),
        Do::Vary(tenths) => return vary_by(state, tenths),
        Do::TypeValue => typing::type_value(state),
        Do::Reset => return parameters::reset(state),
        Do::Undo => return line(state, "undo".into(), false),
        Do::Redo => return line(state, "redo".into(), false),
        Do::NextPlot => turn_plot(state, 1),
        Do::PreviousPlot => turn_plot(state, -1),
        Do::Answers => return order(state, Job::Answers),
        Do::Why => return copy::why(state),
        Do::Ties => return copy::ties(state),
        Do::Search => search::open(state),
        Do::FindNext => return search::again(state, true),
        Do::FindPrevious => return search::again(state, false),
        Do::CopyValue => return copy::value(state),
        Do::CopyCommand => return copy::command(state),
        Do::Ask => state.input = Input::Command(Entry::with("show ")),
        Do::Forget => quantities::forget(state),
        Do::Across(by) => return map::move_by(state, (isize::from(by), 0)),
        Do::SetHere => return map::set_here(state),
        Do::NextRegion => return map::next_region(state),
        Do::CursorHome => map::home(state),
        Do::Output => output::again(state),
        Do::Mode => structure::move_mode(state),
        Do::Before => state.ghost = !state.ghost,
        Do::Explain => state.explains = !state.explains,
        Do::Stop => return stop(state),
        Do::Redraw => return vec![Effect::Redraw],
        Do::Suspend => return vec![Effect::Suspend],
        Do::Mouse => {
            state.mouse = !state.mouse;
            let text = if state.mouse { "the mouse works in the panes" } else { "the mouse belongs to the terminal" };
            state.say(Role::Plain, text);
            return vec![Effect::Mouse(state.mouse)];
        }
        Do::Look(change) => structure::look(state, change),
        Do::Sort => selection::sort_by_next(state),
        Do::SortReverse => state.descending = !state.descending,
        Do::TourNext => return tour_by(state, 1),
        Do::TourBack => return tour_by(state, -1),
        Do::TourEnd => state.tour = None,
        Do::Close => {
            state.overlay = Overlay::None;
            state.found = None;
        }
        Do::Accept => return accept(state),
        Do::Cancel => return typing::cancel(state),
        Do::Complete => typing::complete(state),
        Do::HistoryBack => recall(state, 1),
        Do::HistoryOn => recall(state, -1),
        Do::Edit(change) => {
            typing::edit(state, change);
            return search::follow(state);
        }
    }
    Vec::new()
}
