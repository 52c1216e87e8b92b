//! What a key of the full screen costs: milliseconds and bytes, at several numbers of contact pairs.
//!
//! ```text
//! keys [WIDTHxHEIGHT] PAIRS…        a table in Markdown; 140x45 and 10 300 1000 by default
//! ```
//!
//! Two flat plates on one another. `screen` is the time from the key to the bytes of its frames, `session` the work of
//! the session meanwhile: milliseconds of the processor (of all threads for the session), the least of several
//! repetitions, so that other work of the machine counts little. `first` is the cost of a slider or an arrow that is
//! held down until the new states are on the screen; displacements, the check of equilibrium and the pivots follow when
//! it rests.

use std::cell::Cell;
use std::collections::VecDeque;
use std::io::{self, Write};
use std::process::ExitCode;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::backend::CrosstermBackend;
use ratatui::layout::Rect;
use ratatui::{Terminal, TerminalOptions, Viewport};

use plates::Plates;
use stickslip::session::Session;
use stickslip::tui::action::{Action, Effect, Job, Leave};
use stickslip::tui::app::State;
use stickslip::tui::draw::draw;
use stickslip::tui::frame::Frame;
use stickslip::tui::input;
use stickslip::tui::key::Key;
use stickslip::tui::keymap::Keymap;
use stickslip::tui::shown::Shown;
use stickslip::tui::theme::Look;
use stickslip::tui::update::update;
use stickslip::tui::worker::perform;
use stickslip::watch::Quiet;

type Failure = Box<dyn std::error::Error>;

/// Counts what a terminal would get.
#[derive(Clone, Default)]
struct Counter(Rc<Cell<usize>>);

impl Write for Counter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.set(self.0.get() + bytes.len());
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A screen on a session of its own.
struct Rig {
    session: Session,
    state: State,
    terminal: Terminal<CrosstermBackend<Frame<Counter>>>,
    sent: Counter,
}

/// The time that the processor has spent on this thread, or on all threads of the program.
fn processor(clock: libc::clockid_t) -> Duration {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: `time` is a valid place for the result, and both clocks are those of this program.
    if unsafe { libc::clock_gettime(clock, &raw mut time) } != 0 {
        return Duration::ZERO;
    }
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec.unsigned_abs() as u32)
}

const THREAD: libc::clockid_t = libc::CLOCK_THREAD_CPUTIME_ID;
const PROGRAM: libc::clockid_t = libc::CLOCK_PROCESS_CPUTIME_ID;

/// What a key cost.
#[derive(Clone, Copy, Default)]
struct Cost {
    screen: Duration,
    session: Duration,
    bytes: usize,
}

impl Rig {
    fn new(pairs: usize, (width, height): (u16, u16)) -> Result<Rig, Failure> {
        let plates = Plates { size: [8.0, 1.0], ..Plates::with_pairs(pairs, 0.4) };
        let session = Session::new(plates.scenario(), &Quiet)?;
        let look = Look { color: true, ascii: false };
        let shown = Arc::new(Shown::of(&session));
        let state = State::new(shown, look, Arc::new(Keymap::default()), (width, height), Leave::Quit);
        let sent = Counter::default();
        let viewport = Viewport::Fixed(Rect::new(0, 0, width, height));
        let backend = CrosstermBackend::new(Frame::new(sent.clone()));
        let terminal = Terminal::with_options(backend, TerminalOptions { viewport })?;
        Ok(Rig { session, state, terminal, sent })
    }

    /// Presses a key, carries out the jobs that follow from it, draws after each as the loop does; `first`: only one of
    /// them, as when the next key comes before the others begin.
    fn press(&mut self, key: &str, first: bool) -> Result<Cost, Failure> {
        let before = self.sent.0.get();
        let key = Key::parse(key).ok_or_else(|| format!("no key `{key}`"))?;
        let modifiers = if key.control { KeyModifiers::CONTROL } else { KeyModifiers::NONE };
        let code = if key.code == KeyCode::Char(' ') { KeyCode::Char(' ') } else { key.code };
        let mut cost = Cost::default();
        let begun = processor(THREAD);
        let action = input::action(&self.state, &KeyEvent::new(code, modifiers));
        let mut effects = VecDeque::from(action.map_or_else(Vec::new, |action| update(&mut self.state, action)));
        self.terminal.draw(|frame| draw(&self.state, frame))?;
        cost.screen += processor(THREAD) - begun;
        while let Some(effect) = effects.pop_front() {
            if let Effect::Run(job) = effect {
                let begun = processor(PROGRAM);
                let done = self.work(job);
                cost.session += processor(PROGRAM) - begun;
                let begun = processor(THREAD);
                effects.extend(update(&mut self.state, done));
                self.terminal.draw(|frame| draw(&self.state, frame))?;
                cost.screen += processor(THREAD) - begun;
                if first {
                    self.state.running = None;
                    break;
                }
            }
        }
        cost.bytes = self.sent.0.get() - before;
        Ok(cost)
    }

    fn work(&mut self, job: Job) -> Action {
        let style = self.state.look.report(100);
        Action::Done(Box::new(perform(&mut self.session, &self.state.shown, job, style, &Quiet)))
    }
}

/// What is measured: its name, the keys that lead there, the keys that are pressed in turn. Where the name ends in
/// `first`, only the first job is carried out.
const ROWS: &[(&str, &[&str], &[&str])] = &[
    ("row of Pairs", &["3"], &["down"]),
    ("page of Pairs", &["3"], &["pagedown", "pageup"]),
    ("order of Pairs", &["3"], &["s"]),
    ("pair in Structure", &["1"], &["down"]),
    ("zoom", &["1"], &["i", "o"]),
    ("scale", &["1"], &["d", "D"]),
    ("next pane", &["3"], &["tab"]),
    ("next plot", &["5"], &["p"]),
    ("row of Parameters", &["2"], &["down", "up"]),
    ("letter of a command", &["2", ":"], &["x"]),
    ("help", &["2"], &["?", "esc"]),
    ("pivot back, first", &["4"], &["left"]),
    ("pivot back, all", &["4"], &["left"]),
    ("slider of a load, first", &["2", "down"], &["+", "-"]),
    ("slider of a load, all", &["2", "down"], &["+", "-"]),
    ("slider of f, first", &["2", "up"], &["+", "-"]),
    ("slider of f, all", &["2", "up"], &["+", "-"]),
];
const REPETITIONS: usize = 9;

fn measure(size: (u16, u16), sizes: &[usize]) -> Result<(), Failure> {
    let mut table: Vec<Vec<String>> = ROWS.iter().map(|(name, ..)| vec![(*name).to_owned()]).collect();
    for &pairs in sizes {
        let mut rig = Rig::new(pairs, size)?;
        for ((name, first, keys), row) in ROWS.iter().zip(&mut table) {
            rig.press("esc", false)?;
            for key in *first {
                rig.press(key, false)?;
            }
            let repetitions = if name.ends_with("all") { 3 } else { REPETITIONS };
            let mut costs = Vec::new();
            for round in 0..repetitions {
                costs.push(rig.press(keys[round % keys.len()], name.ends_with("first"))?);
            }
            let least =
                |of: fn(&Cost) -> Duration| costs.iter().map(of).min().map_or(0.0, |least| 1e3 * least.as_secs_f64());
            let mut bytes: Vec<usize> = costs.iter().map(|cost| cost.bytes).collect();
            bytes.sort_unstable();
            row.push(format!("{:.2}", least(|cost| cost.screen)));
            row.push(format!("{:.2}", least(|cost| cost.session)));
            row.push(bytes[bytes.len() / 2].to_string());
        }
    }
    let mut out = io::stdout();
    let heads = sizes.iter().map(|m| format!(" screen ms, m = {m} | session ms | bytes |"));
    writeln!(out, "| key, {}x{} |{}", size.0, size.1, heads.collect::<String>())?;
    writeln!(out, "| --- |{}", " ---: | ---: | ---: |".repeat(sizes.len()))?;
    for row in table {
        writeln!(out, "| {} |", row.join(" | "))?;
    }
    Ok(())
}

fn read(arguments: &[String]) -> Result<((u16, u16), Vec<usize>), Failure> {
    let mut size = (140, 45);
    let mut sizes = Vec::new();
    for word in arguments {
        match word.split_once('x') {
            Some((width, height)) => size = (width.parse()?, height.parse()?),
            None => sizes.push(word.parse()?),
        }
    }
    if sizes.is_empty() {
        sizes = vec![10, 300, 1000];
    }
    Ok((size, sizes))
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    crossterm::style::force_color_output(true);
    match read(&arguments).and_then(|(size, sizes)| measure(size, &sizes)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}
