//! The screen without a terminal: actions on a state, drawings in memory. Jobs run at once, in the same thread.

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
use super::app::{Input, Overlay, Pane, Plot, State};
use super::draw;
use super::keymap::{self, BINDINGS, Keymap};
use super::layout;
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
        perform(&mut self.session, job, self.state.look.report(76), &Quiet)
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
            if let Some(action) = keymap::action(&self.state, &event(key)) {
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

// ---- drawings ----------------------------------------------------------------------------------------------------

macro_rules! snapshot {
    ($name:literal, $rig:expr) => {
        insta::assert_snapshot!($name, $rig.screen())
    };
}

#[test]
fn first_screens() {
    for scenario in ["beam", "beam-ray", "plates-free", "frame-rotated", "greco", "murty6", "klarbring", "gap"] {
        for (width, height) in [(80, 24), (140, 45)] {
            let rig = Rig::new(scenario, width, height);
            insta::assert_snapshot!(format!("{scenario}-{width}x{height}"), rig.screen());
        }
    }
}

#[test]
fn every_pane_at_both_sizes() {
    for (width, height) in [(80, 24), (140, 45)] {
        for (key, pane) in ["1", "2", "3", "4", "5", "6"].iter().zip(Pane::ALL) {
            let mut rig = Rig::new("plates-free", width, height);
            rig.press(&[key]);
            assert_eq!(rig.state.focus, pane);
            let name = format!("pane-{}-{width}x{height}", pane.title().to_lowercase());
            insta::assert_snapshot!(name, rig.screen());
            rig.press(&["z"]);
            let name = format!("large-{}-{width}x{height}", pane.title().to_lowercase());
            insta::assert_snapshot!(name, rig.screen());
        }
    }
}

#[test]
fn every_plot() {
    let mut rig = Rig::new("beam-ray", 80, 24);
    rig.press(&["5", "z"]);
    for _ in 0..6 {
        let name = format!("plot-{:?}", rig.state.plot).to_lowercase();
        insta::assert_snapshot!(name, rig.screen());
        rig.press(&["p"]);
    }
    assert_eq!(rig.state.plot, Plot::Ray);
}

#[test]
fn without_friction_pressures_are_plotted_first() {
    let mut rig = Rig::new("footing", 80, 24);
    rig.press(&["5", "z"]);
    assert!(rig.screen().contains("Pressing force x_n"), "{}", rig.screen());
    rig.press(&["p", "p"]);
    assert_eq!(rig.state.plot, Plot::P);
}

#[test]
fn before_and_after() {
    let mut rig = Rig::new("beam", 80, 24);
    rig.press(&["down", "down", "[", "5"]);
    assert_eq!(rig.state.value("F2"), 150.0);
    snapshot!("before-and-after", rig);
    insta::assert_snapshot!("before-and-after-styles", styles(&rig.buffer()));
    rig.press(&["b", "3"]);
    snapshot!("changed-pairs", rig);
    insta::assert_snapshot!("changed-pairs-styles", styles(&rig.buffer()));
}

#[test]
fn overlays() {
    let mut rig = Rig::new("beam", 80, 24);
    rig.press(&["?"]);
    snapshot!("help", rig);
    rig.press(&["esc"]);
    rig.command("pivots");
    snapshot!("output", rig);
    rig.press(&["q", ":"]);
    rig.act(Action::Paste("expect ou".into()));
    snapshot!("hint", rig);
    rig.press(&["ctrl-c", ":"]);
    rig.act(Action::Paste("set covering ".into()));
    rig.press(&["tab", "tab"]);
    snapshot!("candidates", rig);
    rig.press(&["esc", "v"]);
    snapshot!("value", rig);
    let mut rig = Rig::new("klarbring", 140, 45);
    rig.press(&["a"]);
    snapshot!("answers", rig);
}

#[test]
fn small_and_plain_terminals() {
    for (width, height) in [(40, 12), (39, 12), (60, 20), (76, 20), (119, 40), (10, 3)] {
        let mut rig = Rig::new("beam", 140, 45);
        rig.act(Action::Resize(width, height));
        insta::assert_snapshot!(format!("beam-{width}x{height}"), rig.screen());
    }
    let mut rig = Rig::new("plates-free", 80, 24);
    rig.state.look = Look::default();
    rig.press(&["1"]);
    let buffer = rig.buffer();
    assert!(buffer.content.iter().all(|cell| cell.fg == ratatui::style::Color::Reset));
    rig.state.look.ascii = true;
    snapshot!("plates-free-ascii", rig);
    for key in ["2", "3", "4", "5", "6", "?"] {
        rig.press(&[key]);
        assert!(rig.screen().is_ascii(), "{}", rig.screen());
    }
}

#[test]
fn the_tour_tells_what_is_true() {
    let mut rig = Rig::new("gap", 80, 24);
    rig.command("tour");
    let mut outcomes = Vec::new();
    for step in 1..=6 {
        assert_eq!(rig.state.tour, Some(step - 1));
        insta::assert_snapshot!(format!("tour-{step}"), rig.screen());
        let answer = rig.state.shown.answer().unwrap();
        outcomes.push((answer.outcome, rig.state.shown.step(), rig.state.shown.p));
        rig.press(&["enter"]);
    }
    assert_eq!(rig.state.tour, None);
    let near = |p: Option<f64>, value: f64| assert!((p.unwrap() - value).abs() < 1e-3, "{p:?}");
    assert_eq!(outcomes[0].0, OutcomeKind::Trivial);
    assert_eq!(outcomes[1].0, OutcomeKind::Normal);
    near(outcomes[2].2, 133.3333);
    assert_eq!(outcomes[2].1, Some(0));
    near(outcomes[3].2, 22.2222);
    assert!(matches!(outcomes[4].0, OutcomeKind::Normal));
    assert_eq!(outcomes[5].0, OutcomeKind::Ray);
    near(outcomes[5].2, 3.3333);
    rig.command("tour");
    rig.press(&["enter", "backspace"]);
    assert_eq!(rig.state.tour, Some(0));
    rig.press(&["esc"]);
    assert_eq!(rig.state.tour, None);
}

// ---- actions -----------------------------------------------------------------------------------------------------

/// A bar of length L pulled by F: the slider of L moves the geometry, the one of the formula does not move.
#[test]
fn a_slider_moves_the_geometry() {
    let text = r#"{ "format": "stickslip/1", "title": "bar",
      "parameters": { "L": { "value": 2, "min": 1, "max": 4, "step": 0.5 }, "W": { "formula": "10*L" } },
      "materials": { "m": { "E": 1000, "nu": 0 } }, "sections": { "s": { "area": 0.1 } },
      "nodes": { "A": [0, 0], "B": ["L", 0] },
      "bars": [ { "id": "AB", "nodes": ["A", "B"], "kind": "truss", "material": "m", "section": "s" } ],
      "supports": [ { "at": "A", "fixed": ["x", "y"] } ],
      "contacts": [ { "id": "c", "node": "B", "against": "ground", "normal": [0, 1], "friction": 0.1 } ],
      "loads": { "weight": { "factor": "W", "items": [ { "point": { "at": "B", "force": [5, -1] } } ] } } }"#;
    let mut rig = Rig::of(load_text("bar", text, None).unwrap(), 140, 45);
    rig.press(&["2", "+"]);
    assert_eq!((rig.state.value("L"), rig.state.value("W")), (2.5, 25.0));
    assert_eq!(rig.state.shown.structure().unwrap().nodes[1].position, [2.5, 0.0]);
    // N = 5 W − 0.1 W = 122.5, u = N L / (E A) = 3.0625.
    let slip = rig.state.shown.pairs[0].z_t;
    assert!((slip - 3.0625).abs() < 1e-12, "{slip}");
    assert!(rig.screen().contains("= 10*L"), "{}", rig.screen());
    rig.press(&["down", "+"]);
    assert_eq!(rig.state.value("W"), 25.0);
    assert!(rig.screen().contains("W is a formula, 10*L"), "{}", rig.screen());
}

#[test]
fn a_slider_solves_at_once_and_says_what_changed() {
    let mut rig = Rig::new("beam", 80, 24);
    rig.press(&["+", "+"]);
    assert_eq!(rig.state.value("f"), 0.6);
    assert_eq!(rig.session.values()["f"], 0.6);
    rig.press(&["down", "down", "-"]);
    assert_eq!(rig.state.shown.values["F2"], 240.0);
    rig.press(&[".", ","]);
    assert_eq!(rig.state.shown.values["F2"], 240.0);
    rig.press(&["["]);
    assert_eq!(rig.state.shown.values["F2"], 140.0);
    assert!(rig.screen().contains("1 pair changed"), "{}", rig.screen());
    rig.press(&["u", "u", "u", "u"]);
    assert_eq!(rig.state.shown.values["F2"], 250.0);
    rig.press(&["U"]);
    assert_eq!(rig.state.shown.values["F2"], 240.0);
    rig.press(&["r"]);
    assert_eq!(rig.state.shown.values["F2"], 250.0);
    assert!(rig.state.wanted.is_empty());
}

#[test]
fn a_typed_value_understands_what_set_understands() {
    let mut rig = Rig::new("beam", 80, 24);
    for (typed, value) in [("0.3", 0.3), ("+10%", 0.33), ("+= 0.07", 0.4), ("3", 3.0)] {
        rig.press(&["v"]);
        assert!(matches!(&rig.state.input, Input::Value { name, .. } if name == "f"));
        for c in typed.chars() {
            rig.act(Action::Type(c));
        }
        rig.press(&["enter"]);
        assert!((rig.state.value("f") - value).abs() < 1e-12, "{typed}");
    }
    // outside its range: said, and taken
    let message = rig.state.message.clone().unwrap();
    assert!(message.text.contains("range"), "{message:?}");
    rig.press(&["v"]);
    rig.act(Action::Paste("-1".into()));
    rig.press(&["enter"]);
    assert_eq!(rig.state.value("f"), 3.0);
    assert!(rig.screen().contains("must not be negative"), "{}", rig.screen());
}

#[test]
fn a_newer_value_stops_the_older_solve() {
    let mut rig = Rig::new("beam", 80, 24);
    let set = |value: f64| Job::Set { name: "f".into(), value };
    let more = || Action::Do(Do::Vary(10));
    assert_eq!(update(&mut rig.state, more()), [Effect::Run(set(0.55))]);
    assert_eq!(update(&mut rig.state, more()), [Effect::Stop]);
    assert_eq!(update(&mut rig.state, more()), [Effect::Stop]);
    // the slider stands where it was moved to, the answer is still the old one
    assert_eq!(rig.state.value("f"), 0.65);
    assert_eq!(rig.state.shown.values["f"], 0.5);
    assert_eq!(rig.state.waiting.len(), 1);
    // another slider waits, and stops nothing
    rig.state.parameter = 2;
    assert_eq!(update(&mut rig.state, more()), []);
    rig.state.parameter = 0;
    let mut stopped = rig.perform(Job::Step(0));
    stopped.job = set(0.55);
    stopped.error = Some("interrupted".into());
    stopped.interrupted = true;
    let effects = update(&mut rig.state, Action::Done(Box::new(stopped)));
    assert_eq!(effects, [Effect::Run(set(0.65))]);
    assert_eq!(rig.state.message, None);
    assert_eq!(rig.state.value("f"), 0.65);
    let done = rig.perform(set(0.65));
    let effects = update(&mut rig.state, Action::Done(Box::new(done)));
    assert_eq!(effects, [Effect::Run(Job::Set { name: "F2".into(), value: 260.0 })]);
    assert_eq!(rig.state.shown.values["f"], 0.65);
    assert_eq!(rig.state.value("F2"), 260.0);
}

#[test]
fn progress_is_shown_and_can_be_stopped() {
    let mut rig = Rig::new("beam", 80, 24);
    update(&mut rig.state, Action::Do(Do::Vary(10)));
    let progress = || Action::Progress { what: "Lemke, pivot 64".into(), fraction: 0.42 };
    update(&mut rig.state, progress());
    assert!(rig.screen().contains("Lemke, pivot 64 42 %"), "{}", rig.screen());
    assert_eq!(update(&mut rig.state, Action::Do(Do::Stop)), [Effect::Stop]);
    let mut stopped = rig.perform(Job::Step(0));
    stopped.job = Job::Set { name: "f".into(), value: 0.55 };
    stopped.error = Some("interrupted".into());
    stopped.interrupted = true;
    update(&mut rig.state, Action::Done(Box::new(stopped)));
    assert_eq!(rig.state.value("f"), 0.5);
    assert!(rig.screen().contains("as it was"));
    // late news of a job that is over
    update(&mut rig.state, progress());
    assert_eq!(rig.state.progress, None);
}

#[test]
fn stepping_moves_every_pane() {
    let mut rig = Rig::new("beam", 140, 45);
    let slipping = |rig: &Rig| rig.state.shown.pairs.iter().filter(|pair| pair.state == PairMotion::SlipPlus).count();
    assert_eq!(slipping(&rig), 4);
    rig.press(&["home"]);
    assert_eq!((rig.state.step(), slipping(&rig)), (Some(0), 0));
    rig.press(&["right", "right"]);
    assert_eq!((rig.state.step(), slipping(&rig)), (Some(2), 2));
    let screen = rig.screen();
    for part in ["Pivot 2 of 4", "p = 22.222 kN", "pivot 2 · displacements"] {
        assert!(screen.contains(part), "{part}\n{screen}");
    }
    rig.press(&["end"]);
    assert_eq!(rig.state.shown.position, None);
    rig.press(&["right"]);
    assert_eq!(rig.state.shown.position, None);
    rig.press(&["4", "up", "up"]);
    assert_eq!(rig.state.step(), Some(2));
    // steps that come faster than they are shown add up
    let back = || Action::Do(Do::StepBack);
    assert_eq!(update(&mut rig.state, back()), [Effect::Run(Job::Step(1))]);
    assert_eq!(update(&mut rig.state, back()), []);
    assert_eq!(rig.state.step(), Some(0));
    let done = rig.perform(Job::Step(1));
    let effects = update(&mut rig.state, Action::Done(Box::new(done)));
    assert_eq!(effects, [Effect::Run(Job::Step(0))]);
}

#[test]
fn pivots_play_to_the_end() {
    let mut rig = Rig::new("beam", 80, 24);
    assert_eq!(rig.state.tick(), None);
    rig.press(&["space"]);
    assert!(rig.state.tick().is_some());
    assert_eq!(rig.state.step(), Some(0));
    for step in 1..=4 {
        rig.act(Action::Tick);
        assert_eq!(rig.state.step(), Some(step));
    }
    rig.act(Action::Tick);
    assert_eq!(rig.state.tick(), None);
    rig.press(&["space", "space"]);
    assert!(!rig.state.playing);
    // nothing to play
    let mut rig = Rig::new("gap", 80, 24);
    rig.press(&["space"]);
    assert_eq!(rig.state.tick(), None);
    assert!(rig.state.message.is_some());
}

#[test]
fn the_mode_moves_only_at_a_ray() {
    let mut rig = Rig::new("beam", 80, 24);
    rig.press(&["m"]);
    assert_eq!(rig.state.tick(), None);
    rig.press(&["2", "down", "down", "v"]);
    rig.act(Action::Paste("330".into()));
    rig.press(&["enter"]);
    assert!(rig.state.shown.at_ray());
    let mode = rig.state.shown.mode.clone().unwrap();
    // the beam slides as a whole
    assert!(mode.iter().all(|u| (u.ux - 1.0).abs() < 1e-9 && u.uy.abs() < 1e-9));
    rig.press(&["m"]);
    assert!(rig.state.tick().is_some());
    let first = rig.screen();
    rig.act(Action::Tick);
    rig.act(Action::Tick);
    rig.act(Action::Tick);
    assert_ne!(rig.screen(), first);
    rig.press(&["esc"]);
    assert_eq!(rig.state.tick(), None);
    rig.press(&["m", "home"]);
    assert_eq!(rig.state.tick(), None, "a pivot on the way has no mode");
}

#[test]
fn commands_run_in_the_same_session() {
    let mut rig = Rig::new("beam", 80, 24);
    rig.command("set F2 120; set covering weight");
    assert_eq!(rig.state.shown.values["F2"], 120.0);
    assert_eq!(rig.state.shown.rules.covering.to_string(), "weight");
    rig.command("pairs");
    assert!(matches!(&rig.state.overlay, Overlay::Output { title, .. } if title == "pairs"));
    rig.press(&["esc"]);
    rig.command("echo one line");
    assert_eq!(rig.state.message.as_ref().unwrap().text, "one line");
    rig.command("pears");
    assert!(rig.screen().contains("did you mean"), "{}", rig.screen());
    rig.press(&["esc"]);
    rig.command("load greco");
    assert_eq!(rig.state.shown.scenario.name, "greco");
    assert_eq!(rig.state.parameter, 0);
    rig.command("load no/such/file.json");
    assert_eq!(rig.state.shown.scenario.name, "greco");
    rig.press(&["esc", ":", "up", "up"]);
    assert!(matches!(&rig.state.input, Input::Command(entry) if entry.text == "load greco"));
    rig.press(&["esc"]);
    assert_eq!(rig.command("quit"), [Effect::Leave(Leave::Quit)]);
    assert_eq!(rig.press(&["q"]), [Effect::Leave(Leave::Quit)]);
    assert_eq!(rig.press(&["R"]), [Effect::Leave(Leave::Repl)]);
    assert_eq!(rig.press(&["ctrl-z"]), [Effect::Suspend]);
    assert_eq!(rig.press(&["M"]), [Effect::Mouse(false)]);
}

#[test]
fn auto_off_leaves_the_panes_empty_and_alive() {
    let mut rig = Rig::new("beam", 140, 45);
    rig.command("set auto off");
    rig.press(&["+"]);
    assert!(rig.state.shown.solved.is_none());
    assert!(rig.screen().contains("not solved yet"));
    rig.press(&["left", "space", "m", "a", "3", "down", "5", "p", "6", "down"]);
    rig.screen();
    rig.press(&["esc"]);
    rig.command("solve");
    assert!(rig.state.shown.solved.is_some());
}

#[test]
fn all_answers_stand_side_by_side() {
    let mut rig = Rig::new("klarbring", 140, 45);
    rig.press(&["a"]);
    let Overlay::Answers { answers, .. } = &rig.state.overlay else {
        panic!("no answers");
    };
    assert!(answers.complete);
    let mut states: Vec<_> = answers.answers.iter().map(|a| a.pairs[0].state.word()).collect();
    states.sort_unstable();
    assert_eq!(states, ["open", "slip+", "stick"]);
    assert_eq!(answers.answers.iter().filter(|answer| answer.shown).count(), 1);
    let mut rig = Rig::new("greco", 80, 24);
    rig.press(&["a"]);
    // Too long for the status line, it stands in a box.
    let screen = rig.screen();
    assert!(screen.contains("at most 10"), "{screen}");
}

#[test]
fn pairs_are_sorted_and_selected() {
    let mut rig = Rig::new("plates-free", 80, 24);
    rig.press(&["3", "down", "down"]);
    assert_eq!(rig.state.pair, 2);
    rig.press(&["s", "s"]);
    let order = rig.state.order();
    let slip = |i: usize| rig.state.shown.pairs[i].z_t.abs();
    assert!(order.windows(2).all(|two| slip(two[0]) >= slip(two[1])));
    rig.press(&["pageup", "pageup"]);
    assert_eq!(rig.state.pair, order[0]);
    rig.press(&["S"]);
    assert_eq!(rig.state.order()[0], *order.last().unwrap());
}

#[test]
fn the_structure_zooms_and_pans() {
    let mut rig = Rig::new("plates-free", 80, 24);
    rig.press(&["1"]);
    let all = rig.screen();
    rig.press(&["i", "i", "i"]);
    assert_ne!(rig.screen(), all);
    rig.press(&["h", "j", "l", "k", "o", "o", "o"]);
    assert_eq!(rig.screen(), all);
    rig.press(&["d"]);
    assert!(rig.screen().contains("× 2000"), "{}", rig.screen());
    rig.press(&["D", "D"]);
    assert!(rig.screen().contains("× 500"));
    rig.press(&["A"]);
    assert_eq!(rig.screen(), all);
}

#[test]
fn the_mouse_finds_panes_sliders_and_rows() {
    let mut rig = Rig::new("beam", 140, 45);
    let area = rig.pane(Pane::Parameters);
    let (start, end) = super::panes::parameters::slider(&rig.state, area).unwrap();
    let y = area.y + 3;
    rig.act(Action::Mouse(Mouse::Press(end, y)));
    assert_eq!((rig.state.parameter, rig.state.value("F2")), (2, 400.0));
    rig.act(Action::Mouse(Mouse::Drag(start, y + 9)));
    assert_eq!(rig.state.value("F2"), 0.0);
    let middle = (start + end) / 2;
    rig.act(Action::Mouse(Mouse::Drag(middle, y)));
    assert!((rig.state.value("F2") - 200.0).abs() <= 10.0);
    let area = rig.pane(Pane::Pivots);
    rig.act(Action::Mouse(Mouse::Press(area.x + 3, area.y + 2)));
    assert_eq!((rig.state.focus, rig.state.step()), (Pane::Pivots, Some(0)));
    let area = rig.pane(Pane::Pairs);
    rig.act(Action::Mouse(Mouse::Press(area.x + 3, area.y + 5)));
    assert_eq!((rig.state.focus, rig.state.pair), (Pane::Pairs, 2));
    rig.act(Action::Mouse(Mouse::WheelDown(area.x + 3, area.y + 5)));
    assert_eq!(rig.state.pair, 3);
    let area = rig.pane(Pane::Structure);
    rig.act(Action::Mouse(Mouse::WheelUp(area.x + 3, area.y + 3)));
    assert!(rig.state.view.zoom > 1.0);
    rig.act(Action::Mouse(Mouse::Press(0, 0)));
    rig.act(Action::Mouse(Mouse::Press(139, 44)));
    // tabs
    let mut rig = Rig::new("plates-free", 80, 24);
    let area = rig.pane(Pane::Structure);
    let tabs = layout::tab_names(area, &layout::SHARED, Pane::Structure);
    for (x, pane, _) in tabs {
        rig.act(Action::Mouse(Mouse::Press(x + 1, area.y)));
        assert_eq!((rig.state.focus, rig.state.tab), (pane, pane));
    }
}

#[test]
fn everything_typed_is_shown_as_typed() {
    let mut rig = Rig::new("beam", 80, 24);
    rig.press(&[":"]);
    for c in "echo ü漢\u{301}".chars() {
        rig.act(Action::Type(c));
    }
    assert!(rig.screen().contains("echo ü漢"), "{}", rig.screen());
    rig.act(Action::Paste("x".repeat(300)));
    rig.screen();
    rig.press(&["enter"]);
    assert!(rig.screen().contains("漢"));
}

#[test]
fn the_manual_names_every_key() {
    let manual = keymap::manual();
    for binding in BINDINGS {
        assert!(manual.contains(&format!("`{}`", binding.name)));
    }
    insta::assert_snapshot!("keys-of-the-manual", manual);
}

// ---- anything ----------------------------------------------------------------------------------------------------

fn any_action() -> impl Strategy<Value = Action> {
    let bound = (0..BINDINGS.len()).prop_map(|row| Action::Do(BINDINGS[row].action));
    let place = || (0u16..150, 0u16..50);
    // no letters that could make up a command that writes files
    let typed = prop::sample::select("setf F20.;+-cwhy pi?ü漢 ".chars().collect::<Vec<_>>());
    prop_oneof![
        8 => bound,
        3 => typed.prop_map(Action::Type),
        1 => place().prop_map(|(x, y)| Action::Mouse(Mouse::Press(x, y))),
        1 => place().prop_map(|(x, y)| Action::Mouse(Mouse::Drag(x, y))),
        1 => place().prop_map(|(x, y)| Action::Mouse(Mouse::WheelUp(x, y))),
        1 => place().prop_map(|(x, y)| Action::Mouse(Mouse::WheelDown(x, y))),
        2 => (0u16..160, 0u16..60).prop_map(|(x, y)| Action::Resize(x, y)),
        1 => Just(Action::Tick),
        1 => prop::sample::select(vec!["load gap", "load murty6", "load klarbring", "load beam-ray", "load block", "tour", "set auto off"])
            .prop_map(|line| Action::Paste(line.to_owned())),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_sequence_of_actions_breaks_the_screen(
        size in (1u16..160, 1u16..60),
        ascii in any::<bool>(),
        actions in prop::collection::vec(any_action(), 1..60),
    ) {
        let mut rig = Rig::new("beam", size.0, size.1);
        rig.state.look.ascii = ascii;
        for action in actions {
            rig.act(action);
            if rig.state.size.0 > 0 && rig.state.size.1 > 0 {
                rig.buffer();
            }
            let state = &rig.state;
            // all jobs are done: what is shown is the session
            prop_assert!(state.running.is_none() && state.waiting.is_empty());
            prop_assert!(state.wanted.is_empty() && state.wanted_step.is_none());
            prop_assert_eq!(&state.shown.values, rig.session.values());
            prop_assert_eq!(state.shown.position, rig.session.position());
            prop_assert!(state.parameter < state.shown.values.len().max(1));
            prop_assert!(state.pair < state.shown.pairs.len().max(1));
            prop_assert!(state.plots().contains(&state.plot));
            prop_assert!(!state.moving || state.shown.at_ray());
        }
    }

    #[test]
    fn no_number_breaks_a_slider(
        value in any::<f64>().prop_filter("finite", |v| v.is_finite()),
        min in proptest::option::of(-1e300f64..1e300),
        max in proptest::option::of(-1e300f64..1e300),
        step in proptest::option::of(-1e9f64..1e9),
        tenths in any::<i8>(),
        share in any::<f64>(),
    ) {
        let parameter = crate::model::parameter::Parameter { value, formula: None, min, max, step, unit: None, about: None };
        let _ = vary::varied(value, &parameter, tenths);
        if let Some(place) = vary::share(value, &parameter) {
            prop_assert!((0.0..=1.0).contains(&place));
        }
        let _ = vary::at(share, &parameter);
    }
}
