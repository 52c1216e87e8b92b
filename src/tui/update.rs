//! (state, action) → state and effects. Pure: no terminal, no clock, no thread.

use std::sync::Arc;

use crate::session::Next;
use crate::view::style::Role;

use super::action::{Action, Do, Done, Effect, Job, Leave, Mouse};
use super::app::{Input, Overlay, PERIOD, Pane, SortKey, State};
use super::entry::Entry;
use super::layout::{self, Places};
use super::{overlay, panes, tour, vary};

/// Rows of a page.
const PAGE: usize = 10;
/// Lines of history kept.
const HISTORY: usize = 1000;
/// Largest zoom.
const ZOOM: f64 = 1e4;

/// Lets `action` happen.
pub fn update(state: &mut State, action: Action) -> Vec<Effect> {
    match action {
        Action::Do(what) => {
            if !matches!(what, Do::Redraw) {
                state.message = None;
            }
            perform(state, what)
        }
        Action::Type(c) => {
            if let Some(entry) = entry(state) {
                entry.insert(c.encode_utf8(&mut [0; 4]));
            }
            Vec::new()
        }
        Action::Paste(text) => {
            if let Some(entry) = entry(state) {
                entry.insert(text.trim_end_matches(['\n', '\r']));
            }
            Vec::new()
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
    }
}

/// The line being typed.
fn entry(state: &mut State) -> Option<&mut Entry> {
    match &mut state.input {
        Input::None => None,
        Input::Command(entry) | Input::Value { entry, .. } => Some(entry),
    }
}

fn perform(state: &mut State, what: Do) -> Vec<Effect> {
    match what {
        Do::Leave => return vec![Effect::Leave(state.home)],
        Do::Exit => return vec![Effect::Leave(Leave::Quit)],
        Do::ToRepl => return vec![Effect::Leave(Leave::Repl)],
        Do::Help => state.overlay = Overlay::Help { scroll: 0 },
        Do::Command => {
            state.overlay = Overlay::None;
            state.input = Input::Command(Entry::default());
        }
        Do::NextPane => focus(state, turn(state.focus, 1)),
        Do::PreviousPane => focus(state, turn(state.focus, Pane::ALL.len() - 1)),
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
        Do::TypeValue => match state.selected_parameter() {
            Some((name, _)) => {
                let name = name.to_owned();
                state.input = Input::Value { name, entry: Entry::default() };
            }
            None => state.say(Role::Warning, "this scenario has no parameters"),
        },
        Do::Reset => match state.selected_parameter() {
            Some((name, _)) => {
                let text = format!("reset {name}");
                return line(state, text, false);
            }
            None => state.say(Role::Warning, "this scenario has no parameters"),
        },
        Do::Undo => return line(state, "undo".into(), false),
        Do::Redo => return line(state, "redo".into(), false),
        Do::NextPlot => turn_plot(state, 1),
        Do::PreviousPlot => turn_plot(state, -1),
        Do::Answers => return order(state, Job::Answers),
        Do::Mode => {
            if !state.shown.at_ray() {
                let why = match state.shown.answer() {
                    Some(answer) if answer.ray.is_some() => "the mode belongs to the ray: go to the end of the pivots",
                    _ => "no ray here: there is an answer, and no mode of collapse",
                };
                state.say(Role::Warning, why);
            } else if state.shown.mode.is_none() {
                state.say(Role::Warning, "this ray has no motion that could be drawn");
            } else {
                state.moving = !state.moving;
                state.phase = PERIOD / 4;
                if state.moving {
                    state.tab = Pane::Structure;
                }
            }
        }
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
        Do::ZoomIn => zoom(state, 1.5),
        Do::ZoomOut => zoom(state, 1.0 / 1.5),
        Do::Fit => state.view = Default::default(),
        Do::Pan(x, y) => {
            let step = 0.2 / state.view.zoom;
            let centre = &mut state.view.centre;
            centre.0 = (centre.0 + f64::from(x) * step).clamp(-1.0, 1.0);
            centre.1 = (centre.1 + f64::from(y) * step).clamp(-1.0, 1.0);
        }
        Do::DeformMore => deform(state, 2.0),
        Do::DeformLess => deform(state, 0.5),
        Do::DeformAuto => state.magnification = None,
        Do::Sort => {
            let at = SortKey::ALL.iter().position(|key| *key == state.sort);
            let next = at.map_or(0, |at| (at + 1) % SortKey::ALL.len());
            state.sort = SortKey::ALL[next];
            state.descending = !matches!(state.sort, SortKey::File | SortKey::State | SortKey::Reserve);
        }
        Do::SortReverse => state.descending = !state.descending,
        Do::TourNext => return tour_by(state, 1),
        Do::TourBack => return tour_by(state, -1),
        Do::TourEnd => state.tour = None,
        Do::Close => state.overlay = Overlay::None,
        Do::Accept => return accept(state),
        Do::Cancel => state.input = Input::None,
        Do::Complete => {
            let vocabulary = state.shown.vocabulary.clone();
            if let Input::Command(entry) = &mut state.input {
                entry.complete(&vocabulary);
            }
        }
        Do::HistoryBack => recall(state, 1),
        Do::HistoryOn => recall(state, -1),
        Do::CursorLeft => edit(state, Entry::left),
        Do::CursorRight => edit(state, Entry::right),
        Do::CursorHome => edit(state, Entry::home),
        Do::CursorEnd => edit(state, Entry::end),
        Do::Backspace => match entry(state) {
            Some(line) if line.text.is_empty() => state.input = Input::None,
            _ => edit(state, Entry::backspace),
        },
        Do::Delete => edit(state, Entry::delete),
        Do::DeleteToStart => edit(state, Entry::delete_to_start),
        Do::DeleteWord => edit(state, Entry::delete_word),
    }
    Vec::new()
}

fn edit(state: &mut State, change: fn(&mut Entry)) {
    if let Some(entry) = entry(state) {
        change(entry);
    }
}

fn recall(state: &mut State, by: isize) {
    let history = std::mem::take(&mut state.history);
    if let Input::Command(entry) = &mut state.input {
        let back = entry.back.saturating_add_signed(by);
        entry.recall(&history, back);
    }
    state.history = history;
}

fn turn(pane: Pane, by: usize) -> Pane {
    Pane::ALL[(pane.index() + by) % Pane::ALL.len()]
}

fn focus(state: &mut State, pane: Pane) {
    state.focus = pane;
    if layout::SHARED.contains(&pane) {
        state.tab = pane;
    }
}

fn zoom(state: &mut State, by: f64) {
    state.view.zoom = (state.view.zoom * by).clamp(1.0, ZOOM);
    if state.view.zoom <= 1.0 + 1e-9 {
        state.view = Default::default();
    }
}

fn deform(state: &mut State, by: f64) {
    let now = state.magnification.unwrap_or_else(|| panes::structure::automatic(state));
    let new = now * by;
    if new.is_finite() && new > 0.0 {
        state.magnification = Some(new);
    }
}

fn turn_plot(state: &mut State, by: isize) {
    let plots = state.plots();
    let count = plots.len() as isize;
    let at = plots.iter().position(|plot| *plot == state.plot).unwrap_or_default() as isize;
    state.plot = plots[(at + by).rem_euclid(count) as usize];
    state.tab = Pane::Plot;
}

/// Up and down in the focused pane, or in what lies over the panes.
fn select(state: &mut State, by: isize) -> Vec<Effect> {
    let limit = overlay::last_line(state);
    match &mut state.overlay {
        Overlay::None => {}
        Overlay::Help { scroll } | Overlay::Output { scroll, .. } | Overlay::Answers { scroll, .. } => {
            *scroll = scroll.saturating_add_signed(by).min(limit);
            return Vec::new();
        }
    }
    let moved = |at: usize, count: usize| at.saturating_add_signed(by).min(count.saturating_sub(1));
    match state.focus {
        Pane::Parameters => state.parameter = moved(state.parameter, state.shown.values.len()),
        Pane::Pairs | Pane::Structure => {
            let order = match state.focus {
                Pane::Pairs => state.order(),
                _ => (0..state.shown.pairs.len()).collect(),
            };
            let at = order.iter().position(|pair| *pair == state.pair);
            if let Some(pair) = order.get(moved(at.unwrap_or_default(), order.len())) {
                state.pair = *pair;
            }
        }
        Pane::Pivots => return step_by(state, by),
        Pane::Plot => turn_plot(state, by.signum()),
        Pane::Answer => {
            let last = panes::answer::last_line(state);
            state.answer_scroll = state.answer_scroll.saturating_add_signed(by).min(last);
        }
    }
    Vec::new()
}

fn scroll_to(state: &mut State, line: usize) {
    let limit = overlay::last_line(state);
    match &mut state.overlay {
        Overlay::None => {}
        Overlay::Help { scroll } | Overlay::Output { scroll, .. } | Overlay::Answers { scroll, .. } => {
            *scroll = line.min(limit)
        }
    }
}

fn step_by(state: &mut State, by: isize) -> Vec<Effect> {
    match state.step() {
        Some(step) => step_to(state, step.saturating_add_signed(by)),
        None => step_to(state, 0),
    }
}

fn step_to(state: &mut State, step: usize) -> Vec<Effect> {
    let Some(last) = state.shown.last_step() else {
        let why = match state.shown.answer() {
            Some(_) => "no pivots: the main system is the answer",
            None => "not solved yet: `:solve`, or `:set auto on`",
        };
        state.say(Role::Warning, why);
        return Vec::new();
    };
    let step = step.min(last);
    if state.step() == Some(step) {
        return Vec::new();
    }
    state.wanted_step = Some(step);
    order(state, Job::Step(step))
}

fn play(state: &mut State) -> Vec<Effect> {
    state.playing = !state.playing;
    if !state.playing {
        return Vec::new();
    }
    if state.step().is_none() || state.step() == state.shown.last_step() {
        let effects = step_to(state, 0);
        state.playing = state.step().is_some();
        return effects;
    }
    Vec::new()
}

fn tick(state: &mut State) -> Vec<Effect> {
    if state.playing {
        // a slow step is waited for
        if state.running.is_some() {
            return Vec::new();
        }
        if state.step() == state.shown.last_step() {
            state.playing = false;
            return Vec::new();
        }
        return step_by(state, 1);
    }
    if state.moving && state.shown.at_ray() {
        state.phase = (state.phase + 1) % PERIOD;
    }
    Vec::new()
}

fn stop(state: &mut State) -> Vec<Effect> {
    state.playing = false;
    state.moving = false;
    state.waiting.clear();
    state.wanted_step = None;
    if state.running.is_some() { vec![Effect::Stop] } else { Vec::new() }
}

fn vary_by(state: &mut State, tenths: i8) -> Vec<Effect> {
    let Some((name, parameter)) = state.selected_parameter() else {
        state.say(Role::Warning, "this scenario has no parameters");
        return Vec::new();
    };
    let now = state.value(name);
    let new = vary::varied(now, parameter, tenths);
    let name = name.to_owned();
    set(state, name, new)
}

/// A slider moves to `value`.
fn set(state: &mut State, name: String, value: f64) -> Vec<Effect> {
    if state.value(&name).to_bits() == value.to_bits() {
        return Vec::new();
    }
    if let Some(refusal) = state.shown.scenario.refusal(&name, value) {
        state.say(Role::Warning, refusal);
        return Vec::new();
    }
    state.playing = false;
    state.wanted.insert(name.clone(), value);
    order(state, Job::Set { name, value })
}

/// Runs a job now, or after the one at work. Of the same slider only the newest value counts: an older solve is
/// stopped. Of the steps only the last counts.
fn order(state: &mut State, job: Job) -> Vec<Effect> {
    let Some(running) = &state.running else {
        state.running = Some(job.clone());
        state.progress = None;
        return vec![Effect::Run(job)];
    };
    let mut effects = Vec::new();
    if *running == Job::Remedies {
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
                Job::Pivots => true,
                _ => false,
            };
            if older {
                effects.push(Effect::Stop);
            }
        }
        Job::Step(_) => state.waiting.retain(|waiting| !matches!(waiting, Job::Step(_))),
        Job::Answers | Job::Line { .. } | Job::Pivots | Job::Remedies => {}
    }
    state.waiting.push_back(job);
    effects
}

/// A command line for the session.
fn line(state: &mut State, text: String, shows: bool) -> Vec<Effect> {
    order(state, Job::Line { text, shows })
}

fn accept(state: &mut State) -> Vec<Effect> {
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
            // short for what the prompt is asked most
            if text == "q" {
                return vec![Effect::Leave(state.home)];
            }
            line(state, text, true)
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

fn tour_by(state: &mut State, by: isize) -> Vec<Effect> {
    let Some(at) = state.tour else {
        return Vec::new();
    };
    let next = at.saturating_add_signed(by);
    if next >= tour::STEPS.len() {
        state.tour = None;
        state.say(Role::Good, "the tour is over: vary f, F, F2, or `:load` another scenario (`:scenarios`)");
        return Vec::new();
    }
    begin_tour(state, next)
}

/// Shows a step of the tour.
pub fn begin_tour(state: &mut State, at: usize) -> Vec<Effect> {
    let Some(step) = tour::STEPS.get(at) else {
        return Vec::new();
    };
    state.tour = Some(at);
    state.message = None;
    state.overlay = Overlay::None;
    state.input = Input::None;
    state.playing = false;
    state.moving = false;
    state.maximized = false;
    focus(state, step.pane);
    // the plot is chosen once its answer is there
    line(state, step.commands.to_owned(), false)
}

/// A job ended: its result is shown, the next one begins.
fn finish(state: &mut State, done: Done) -> Vec<Effect> {
    let new_scenario = !Arc::ptr_eq(&state.shown.scenario, &done.shown.scenario);
    state.running = None;
    state.progress = None;
    state.shown = done.shown;
    if new_scenario {
        // Sliders and steps meant the old one; lines (those of the tour, too) are carried out in their order.
        state.waiting.retain(|job| matches!(job, Job::Line { .. }));
        state.wanted_step = None;
        state.new_scenario();
    }
    settle(state, &done.job);
    let changed = matches!(done.job, Job::Set { .. } | Job::Pivots | Job::Remedies);
    let looked = done.job == Job::Remedies;
    let followed = changed && !done.interrupted && done.error.is_none();
    if let Some(error) = done.error {
        if done.interrupted {
            // a slider that moved on stops its older solve: nothing to tell
            if !changed || state.waiting.is_empty() {
                state.say(Role::Warning, "stopped: the session is as it was");
            }
        } else {
            tell(state, &done.job, &error, Role::Bad);
        }
    } else if let Some(answers) = done.answers {
        state.overlay = Overlay::Answers { answers, scroll: 0 };
    } else {
        show_output(state, &done.job, &done.output);
    }
    let mut effects = Vec::new();
    match done.next {
        Next::Continue => {}
        Next::Quit => return vec![Effect::Leave(Leave::Quit)],
        Next::FullScreen { tour: true } => effects.extend(begin_tour(state, 0)),
        Next::FullScreen { tour: false } => {
            state.say(Role::Plain, "this is the full screen: `q` leaves it");
        }
    }
    if state.running.is_none()
        && let Some(next) = state.waiting.pop_front()
    {
        state.running = Some(next.clone());
        effects.push(Effect::Run(next));
    }
    if followed && state.shown.is_warm() {
        // The answer is there; its pivots follow unless a slider moves on.
        effects.extend(order(state, Job::Pivots));
    }
    if !looked {
        effects.extend(background(state));
    }
    effects
}

/// What is computed while nothing else is asked for: the remedies of a collapse. Whatever is asked for stops it.
pub(super) fn background(state: &mut State) -> Vec<Effect> {
    if state.running.is_some() || !state.waiting.is_empty() || !state.shown.lacks_remedies() {
        return Vec::new();
    }
    order(state, Job::Remedies)
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
    let count = state.shown.pairs.len();
    state.pair = state.pair.min(count.saturating_sub(1));
    state.parameter = state.parameter.min(state.shown.values.len().saturating_sub(1));
    if let (Some(at), Job::Line { shows: false, .. }) = (state.tour, job)
        && let Some(step) = tour::STEPS.get(at)
    {
        state.plot = step.plot;
        if at == 0 && (state.shown.previous.is_some() || !state.shown.changes.is_empty()) {
            // the tour begins here: there is nothing before it
            let mut shown = (*state.shown).clone();
            shown.previous = None;
            shown.changes.clear();
            state.shown = Arc::new(shown);
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
    state.answer_scroll = state.answer_scroll.min(panes::answer::last_line(state));
}

/// What a command printed: one line at the bottom, several over the panes.
fn show_output(state: &mut State, job: &Job, output: &str) {
    match job {
        Job::Line { text, shows: true } => {
            let lines = state.look.lines(output);
            match lines.as_slice() {
                [] => state.say(Role::Good, "done"),
                [one] if one.width() + 2 < usize::from(state.size.0) => {
                    let text: String = one.spans.iter().map(|span| span.content.as_ref()).collect();
                    state.say(Role::Plain, text);
                }
                _ => {
                    state.overlay = Overlay::Output { title: text.clone(), lines, scroll: 0 };
                }
            }
        }
        Job::Pivots => {
            if let Some(line) = state.look.lines(output).first() {
                let text: String = line.spans.iter().map(|span| span.content.as_ref()).collect();
                state.say(Role::Warning, text);
            }
        }
        Job::Line { .. } | Job::Set { .. } => {
            // `undone: …`, or that a value lies outside its range; the last line says what the screen shows anyway
            let lines = state.look.lines(output);
            if lines.len() > 1 && state.tour.is_none() {
                let text: String = lines[0].spans.iter().map(|span| span.content.as_ref()).collect();
                state.say(Role::Plain, text);
            }
        }
        Job::Step(_) | Job::Answers | Job::Remedies => {}
    }
}

/// An error: short ones at the bottom, long ones over the panes.
fn tell(state: &mut State, job: &Job, text: &str, role: Role) {
    let room = usize::from(state.size.0).saturating_sub(2);
    let mut lines = text.lines();
    let first = lines.next().unwrap_or_default();
    if lines.next().is_none() && first.chars().count() <= room {
        state.say(role, first);
        return;
    }
    let title = match job {
        Job::Line { text, .. } => text.clone(),
        Job::Set { name, .. } => format!("set {name}"),
        Job::Step(_) => "step".into(),
        Job::Answers => "answers".into(),
        Job::Pivots => "pivots".into(),
        Job::Remedies => "ray".into(),
    };
    let style = state.look.role(role);
    let report = state.look.report(overlay::text_width(state));
    let lines = text
        .lines()
        .flat_map(|line| {
            let wrapped = report.wrap(line, report.width);
            if wrapped.is_empty() { vec![String::new()] } else { wrapped }
        })
        .map(|line| ratatui::text::Line::styled(line, style))
        .collect();
    state.overlay = Overlay::Output { title, lines, scroll: 0 };
}

fn by_mouse(state: &mut State, mouse: Mouse) -> Vec<Effect> {
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
