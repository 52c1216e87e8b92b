//! What a command printed or why it failed: a line at the bottom, or a box over the panes.

use crate::view::style::Role;

use crate::tui::action::Job;
use crate::tui::app::{Overlay, State};
use crate::tui::overlay;

/// What a command printed: one line at the bottom, several over the panes.
pub(super) fn show_output(state: &mut State, job: &Job, output: &str) {
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
        Job::Step(_) | Job::Answers | Job::Motion | Job::Remedies => {}
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
        Job::Set { name, .. } => format!("set {name}"),
        Job::Step(_) => "step".into(),
        Job::Answers => "answers".into(),
        Job::Pivots => "pivots".into(),
        Job::Motion => "displacements".into(),
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
