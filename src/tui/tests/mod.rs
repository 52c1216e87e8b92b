//! The screen without a terminal: actions on a state, drawings in memory. Jobs run at once, in the same thread.

mod anything;
mod commands;
mod drawings;
mod keys;
mod lists;
mod live;
mod map;
mod mouse;
mod panes;
mod parameters;
mod steps;
mod tour;

use std::sync::Arc;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use proptest::prelude::*;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::Buffer;
use ratatui::style::Modifier;

use crate::model::embedded;
use crate::model::load::load_text;
use crate::model::scenario::Scenario;
use crate::session::Session;
use crate::session::results::{OutcomeKind, State as PairMotion};
use crate::watch::Quiet;

use super::action::{Action, Do, Done, Effect, Job, Leave, Mouse};
use super::app::{Input, Overlay, State};
use super::bindings::BINDINGS;
use super::draw;
use super::input;
use super::keymap::{self, Keymap};
use super::layout;
use super::pane::{Pane, Plot};
use super::shown::Shown;
use super::theme::Look;
use super::update::update;
use super::vary;
use super::worker::perform;

/// A session with its screen.
struct Rig {
    session: Session,
    state: State,
}

impl Rig {
    fn new(scenario: &str, width: u16, height: u16) -> Rig {
        Rig::of(embedded::load(scenario).unwrap(), width, height)
    }

    fn of(scenario: Scenario, width: u16, height: u16) -> Rig {
        let session = Session::new(scenario, &Quiet).unwrap();
        let look = Look { color: true, ascii: false };
        let state =
            State::new(Arc::new(Shown::of(&session)), look, Arc::new(Keymap::default()), (width, height), Leave::Quit);
        Rig { session, state }
    }

    /// Does a job as the worker would.
    fn perform(&mut self, job: Job) -> Done {
        perform(&mut self.session, &self.state.shown, job, self.state.look.report(76), &Quiet)
    }

    /// Lets an action happen and every job that follows from it; gives the other effects.
    fn act(&mut self, action: Action) -> Vec<Effect> {
        let mut left = Vec::new();
        let mut effects = update(&mut self.state, action);
        while !effects.is_empty() {
            let mut next = Vec::new();
            for effect in effects {
                match effect {
                    Effect::Run(job) => {
                        let done = self.perform(job);
                        next.extend(update(&mut self.state, Action::Done(Box::new(done))));
                    }
                    other => left.push(other),
                }
            }
            effects = next;
        }
        left
    }

    fn press(&mut self, keys: &[&str]) -> Vec<Effect> {
        let mut left = Vec::new();
        for key in keys {
            if let Some(action) = input::action(&self.state, &event(key)) {
                left.extend(self.act(action));
            }
        }
        left
    }

    /// `:` line Enter.
    fn command(&mut self, line: &str) -> Vec<Effect> {
        self.press(&[":"]);
        self.act(Action::Paste(line.to_owned()));
        self.press(&["enter"])
    }

    fn buffer(&self) -> Buffer {
        let (width, height) = self.state.size;
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        terminal.draw(|frame| draw::draw(&self.state, frame)).unwrap();
        terminal.backend().buffer().clone()
    }

    fn screen(&self) -> String {
        text(&self.buffer())
    }

    fn pane(&self, pane: Pane) -> ratatui::layout::Rect {
        let places = layout::places(&self.state).unwrap();
        places.panes.iter().find(|(p, _)| *p == pane).unwrap().1
    }
}

/// A block of weight 10 on the ground, pulled by `pull` and held by a spring of stiffness 1000: it slips where the pull
/// is more than 10 f, and then by (pull − 10 f)/1000. `parameters` stand beside f, `rest` after the loads.
fn block_on_a_spring(parameters: &str, pull: &str, rest: &str) -> Scenario {
    let text = format!(
        r#"{{ "format": "stickslip/1", "title": "block on a spring",
  "parameters": {{ "f": {{ "value": 0.4, "min": 0, "max": 1, "step": 0.1 }}{parameters} }},
  "materials": {{ "m": {{ "E": 1000, "nu": 0 }} }}, "sections": {{ "s": {{ "area": 1 }} }},
  "nodes": {{ "A": [0, 0], "B": [1, 0] }},
  "bars": [ {{ "id": "AB", "nodes": ["A", "B"], "kind": "truss", "material": "m", "section": "s" }} ],
  "supports": [ {{ "at": "A", "fixed": ["x", "y"] }} ],
  "contacts": [ {{ "id": "c", "node": "B", "against": "ground", "normal": [0, 1], "friction": "f" }} ],
  "loads": {{ "weight": {{ "factor": 10, "items": [ {{ "point": {{ "at": "B", "force": [0, -1] }} }} ] }},
             "pull": {{ "factor": {pull}, "items": [ {{ "point": {{ "at": "B", "force": [1, 0] }} }} ] }} }}{rest} }}"#
    );
    load_text("block", &text, None).unwrap()
}

fn event(key: &str) -> KeyEvent {
    let (code, modifiers) = match key {
        "left" => (KeyCode::Left, KeyModifiers::NONE),
        "right" => (KeyCode::Right, KeyModifiers::NONE),
        "up" => (KeyCode::Up, KeyModifiers::NONE),
        "down" => (KeyCode::Down, KeyModifiers::NONE),
        "home" => (KeyCode::Home, KeyModifiers::NONE),
        "end" => (KeyCode::End, KeyModifiers::NONE),
        "pageup" => (KeyCode::PageUp, KeyModifiers::NONE),
        "pagedown" => (KeyCode::PageDown, KeyModifiers::NONE),
        "tab" => (KeyCode::Tab, KeyModifiers::NONE),
        "shift-tab" => (KeyCode::BackTab, KeyModifiers::SHIFT),
        "enter" => (KeyCode::Enter, KeyModifiers::NONE),
        "esc" => (KeyCode::Esc, KeyModifiers::NONE),
        "backspace" => (KeyCode::Backspace, KeyModifiers::NONE),
        "space" => (KeyCode::Char(' '), KeyModifiers::NONE),
        "ctrl-c" => (KeyCode::Char('c'), KeyModifiers::CONTROL),
        "ctrl-z" => (KeyCode::Char('z'), KeyModifiers::CONTROL),
        one => (KeyCode::Char(one.chars().next().unwrap()), KeyModifiers::NONE),
    };
    KeyEvent::new(code, modifiers)
}

fn text(buffer: &Buffer) -> String {
    let area = buffer.area;
    let mut text = String::new();
    for y in 0..area.height {
        let line: String = (0..area.width).map(|x| buffer[(x, y)].symbol()).collect();
        text.push_str(line.trim_end());
        text.push('\n');
    }
    masked(&text)
}

/// Residuals of the check are rounding: `3.7e-16` depends on the machine.
fn masked(text: &str) -> String {
    let mut out = String::new();
    for line in text.split_inclusive('\n') {
        let words: Vec<String> = line
            .split(' ')
            .map(|word| {
                let noise =
                    word.split_once("e-1").is_some_and(|(_, rest)| rest.starts_with(|c: char| c.is_ascii_digit()));
                if noise {
                    word.chars().map(|c| if "0123456789.-e".contains(c) { '#' } else { c }).collect()
                } else {
                    word.to_owned()
                }
            })
            .collect();
        out.push_str(&words.join(" "));
    }
    out
}

/// A letter per cell for its look: reversed, underlined, bold, coloured, plain.
fn styles(buffer: &Buffer) -> String {
    let area = buffer.area;
    let mut text = String::new();
    for y in 0..area.height {
        let line: String = (0..area.width)
            .map(|x| {
                let cell = &buffer[(x, y)];
                let fg = format!("{:?}", cell.fg);
                if cell.modifier.contains(Modifier::REVERSED) {
                    'R'
                } else if cell.modifier.contains(Modifier::UNDERLINED) {
                    'U'
                } else if cell.symbol() == " " {
                    ' '
                } else {
                    match fg.as_str() {
                        "Reset" if cell.modifier.contains(Modifier::BOLD) => 'B',
                        "Reset" => '.',
                        "DarkGray" => ',',
                        other => other.chars().next().unwrap().to_ascii_lowercase(),
                    }
                }
            })
            .collect();
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}
