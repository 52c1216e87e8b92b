//! What a command printed or why it failed: a line at the bottom, or a box over the panes.

use std::rc::Rc;

use ratatui::text::Line;
use unicode_width::UnicodeWidthStr;

use crate::session::language::grammar;
use crate::session::language::turn::Turn;
use crate::view::style::Role;

use crate::tui::action::{Do, Job};
use crate::tui::app::{Overlay, State};
use crate::tui::bindings::Context;

/// Shows in several lines what a command printed, and keeps it.
fn show(state: &mut State, title: String, lines: Vec<Line<'static>>) {
    state.output = Some((title, Rc::new(lines)));
    again(state);
}

/// Shows what was last printed again.
pub(super) fn again(state: &mut State) {
    state.found = None;
    match &state.output {
        Some((title, lines)) => {
            state.overlay = Overlay::Output { title: title.clone(), lines: Rc::clone(lines), scroll: 0 };
        }
        None => state.say(Role::Warning, "nothing was printed yet: `:` types a command"),
    }
}

/// What a `load` says, in the line at the bottom: what was loaded and what came out, or the first problem. The rest can
/// be shown again, and no box stands in the way of the keys.
fn say_loaded(state: &mut State, title: &str, lines: Vec<Line<'static>>, role: Role) {
    let texts: Vec<String> = lines.iter().map(ToString::to_string).filter(|line| !line.trim().is_empty()).collect();
    let said = match (texts.first(), texts.last()) {
        (Some(first), Some(last)) if texts.len() > 1 && role != Role::Bad => format!("{first} · {last}"),
        (Some(first), _) => first.clone(),
        _ => String::new(),
    };
    let key = state.keys.of(Context::Everywhere, Do::Output, state.look.ascii);
    let whole = texts.len() <= 1 && said.width() <= usize::from(state.size.0);
    let more = if whole { String::new() } else { format!(" ({key} shows all)") };
    let room = usize::from(state.size.0).saturating_sub(more.width());
    let text = format!("{}{more}", state.look.fit(&said, room));
    state.output = Some((title.to_owned(), Rc::new(lines)));
    state.say(role, text);
}

/// Whether all that a line does is to load a scenario.
fn loads(line: &str) -> bool {
    Turn::of_line(line).iter().all(|turn| match grammar::parse(turn.command) {
        Ok(Some(parsed)) => parsed.action.loads() || parsed.command.name == "reload",
        _ => false,
    })
}

/// What a command printed: one line at the bottom, several over the panes.
pub(super) fn show_output(state: &mut State, job: &Job, output: &str) {
    match job {
        Job::Line { text, shows: true } => {
            let lines = state.look.lines(output);
            match lines.as_slice() {
                [] => state.say(Role::Good, "done"),
                _ if loads(text) => say_loaded(state, text, lines, Role::Plain),
                [one] if one.width() + 2 < usize::from(state.size.0) => {
                    let text: String = one.spans.iter().map(|span| span.content.as_ref()).collect();
                    state.say(Role::Plain, text);
                }
                _ => show(state, text.clone(), lines),
            }
        }
        Job::Pivots => {
            if let Some(line) = state.look.lines(output).first() {
                let text: String = line.spans.iter().map(|span| span.content.as_ref()).collect();
                state.say(Role::Warning, text);
            }
        }
        Job::Line { .. } | Job::Set { .. } | Job::Vary { .. } => {
            // `undone: …`, or that a value lies outside its range; the last line says what the screen shows anyway
            let lines = state.look.lines(output);
            if lines.len() > 1 && state.tour.is_none() {
                let text: String = lines[0].spans.iter().map(|span| span.content.as_ref()).collect();
                state.say(Role::Plain, text);
            }
        }
        Job::Step(_) | Job::Show(_) | Job::Answers | Job::Motion | Job::Quantities(_) | Job::Remedies => {}
        Job::Glance { .. } => {}
    }
}

/// An error: short ones at the bottom, long ones over the panes.
pub(super) fn tell(state: &mut State, job: &Job, text: &str, role: Role) {
    let room = usize::from(state.size.0).saturating_sub(2);
    let mut lines = text.lines();
    let first = lines.next().unwrap_or_default();
    if lines.next().is_none() && first.chars().count() <= room {
        state.say(role, first);
        return;
    }
    let title = match job {
        Job::Line { text, .. } => text.clone(),
        Job::Set { name, .. } | Job::Vary { name, .. } => format!("set {name}"),
        Job::Step(_) => "step".into(),
        Job::Answers => "answers".into(),
        Job::Pivots => "pivots".into(),
        Job::Show(_) => "loading".into(),
        Job::Motion => "displacements".into(),
        Job::Quantities(_) => "quantities".into(),
        Job::Remedies => "ray".into(),
        Job::Glance { .. } => "the cursor of the map".into(),
    };
    let style = state.look.role(role);
    // Broken into lines of the window where it is drawn.
    let lines = text.lines().map(|line| Line::styled(line.to_owned(), style)).collect();
    match job {
        Job::Line { text, .. } if loads(text) => say_loaded(state, &title, lines, role),
        _ => show(state, title, lines),
    }
}
