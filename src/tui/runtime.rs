//! The loop: keys, signals, results and time come in; frames and jobs go out. It sleeps while nothing happens.

use std::collections::VecDeque;
use std::io;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crossterm::event::{self, Event, MouseButton, MouseEventKind};

use crate::session::Session;
use crate::session::commands::reload::open_editor;
use crate::session::commands::screen::Tour;
use crate::session::file_watch::FileWatch;
use crate::signals::Signals;
use crate::view::style::{Role, Style};

use super::action::{Action, Effect, Leave, Mouse};
use super::app::State;
use super::config;
use super::input;
use super::overlay;
use super::sequence;
use super::shown::Shown;
use super::terminal::{Asked, Screen, asked};
use super::theme::Look;
use super::update::{background, begin_tour, update};
use super::worker::Worker;

/// Between two looks at the signals while no key comes.
const LOOK: Duration = Duration::from_millis(100);
/// Results that come within this time after a key share its frame.
const TOGETHER: Duration = Duration::from_millis(12);

/// How the screen begins.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// With which tour, if any.
    pub tour: Option<Tour>,
    /// Where `q` goes.
    pub home: Leave,
}

/// How the screen ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ended {
    /// Where it goes on.
    pub leave: Leave,
    /// Exit status, if it ends here; that of a signal if one ended it.
    pub status: u8,
}

/// What comes in.
enum Incoming {
    Terminal(Event),
    Signal(Asked),
    Action(Action),
    Failed(io::Error),
}

/// Shows the session until it is left; gives it back.
///
/// # Errors
/// There is no terminal, or it fails; the session is lost then.
pub fn run(session: Session, style: Style, start: Start, signals: &Signals) -> io::Result<(Session, Ended)> {
    let config = config::load();
    let look = Look { color: style.color, ascii: style.ascii };
    let (sender, incoming) = mpsc::channel();
    let shown = Arc::new(Shown::of(&session));
    let _raw = signals.raw();
    let screen = Screen::take(config.mouse)?;
    // crossterm looks at NO_COLOR itself; whether there is colour was decided before
    crossterm::style::force_color_output(true);
    let mut state = State::new(shown, look, Arc::new(config.keys), screen.size()?, start.home);
    state.mouse = config.mouse;
    state.explains = config.explain;
    if let Some(problem) = config.problems.first() {
        state.say(Role::Warning, problem.clone());
    }
    let results = Mutex::new(sender.clone());
    let worker = Worker::start(session, move |action| {
        // after the end nobody listens
        let _ = results.lock().unwrap_or_else(PoisonError::into_inner).send(Incoming::Action(action));
    })?;
    let reader = Reader::start(sender.clone(), signals.clone())?;
    reader.watch_signals(sender.clone(), signals.clone())?;
    let files = FileWatch::start(move || {
        let _ = sender.send(Incoming::Action(Action::Saved));
    })?;
    let mut loop_ = Loop { state, screen, worker, reader, incoming, files, signals: signals.clone() };
    let ended = loop_.run(start.tour);
    let Loop { screen, worker, reader, .. } = loop_;
    reader.end();
    drop(screen);
    let session = worker.end()?;
    Ok((session, ended?))
}

/// Reads the terminal on a thread of its own, until told to stop.
struct Reader {
    rests: Arc<Rest>,
    thread: JoinHandle<()>,
}

/// What the reader is to do.
#[derive(Default)]
struct Rest {
    end: AtomicBool,
    /// While the program is stopped nobody may read.
    pause: AtomicBool,
    /// Held by the one who reads.
    reading: Mutex<()>,
}

impl Reader {
    fn start(sender: Sender<Incoming>, signals: Signals) -> io::Result<Reader> {
        let rests = Arc::new(Rest::default());
        let theirs = Arc::clone(&rests);
        let read = move || {
            while !theirs.end.load(Ordering::SeqCst) {
                if theirs.pause.load(Ordering::SeqCst) {
                    thread::sleep(TOGETHER);
                    continue;
                }
                let found = {
                    let _reading = theirs.reading.lock().unwrap_or_else(PoisonError::into_inner);
                    let within = |wait| event::poll(wait)?.then(event::read).transpose();
                    within(LOOK).and_then(|first| match first {
                        Some(first) => sequence::joined(first, || within(sequence::WAIT)),
                        None => Ok(Vec::new()),
                    })
                };
                let incoming: Vec<Incoming> = match found {
                    Ok(events) => events.into_iter().map(Incoming::Terminal).collect(),
                    Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                    Err(error) => {
                        // a terminal that is gone fails first; its signal comes a moment later
                        thread::sleep(LOOK);
                        let incoming = match asked(&signals) {
                            Some(asked) => Incoming::Signal(asked),
                            None => Incoming::Failed(error),
                        };
                        let _ = sender.send(incoming);
                        return;
                    }
                };
                for event in incoming {
                    if sender.send(event).is_err() {
                        return;
                    }
                }
            }
        };
        let thread = thread::Builder::new().name("keys".to_owned()).spawn(read)?;
        Ok(Reader { rests, thread })
    }

    /// Looks for signals on a thread of its own: the reader may hang for good in a terminal that is gone (crossterm
    /// 0.29 reads the end of file over and over).
    fn watch_signals(&self, sender: Sender<Incoming>, signals: Signals) -> io::Result<()> {
        let theirs = Arc::clone(&self.rests);
        let look = move || {
            while !theirs.end.load(Ordering::SeqCst) {
                if !theirs.pause.load(Ordering::SeqCst)
                    && let Some(asked) = asked(&signals)
                    && sender.send(Incoming::Signal(asked)).is_err()
                {
                    return;
                }
                thread::sleep(LOOK);
            }
        };
        thread::Builder::new().name("signals".to_owned()).spawn(look)?;
        Ok(())
    }

    fn end(self) {
        self.rests.end.store(true, Ordering::SeqCst);
        // It reads for a tenth of a second more; where the terminal is gone it may never come back, and ends with
        // the process.
        let deadline = Instant::now() + 4 * LOOK;
        while !self.thread.is_finished() {
            if Instant::now() > deadline {
                return;
            }
            thread::sleep(TOGETHER);
        }
        let _ = self.thread.join();
    }
}

struct Loop {
    state: State,
    screen: Screen,
    worker: Worker,
    reader: Reader,
    incoming: Receiver<Incoming>,
    files: FileWatch,
    signals: Signals,
}

impl Loop {
    fn run(&mut self, tour: Option<Tour>) -> io::Result<Ended> {
        let mut effects = tour.map_or_else(Vec::new, |tour| begin_tour(&mut self.state, tour, 0));
        effects.extend(background(&mut self.state));
        if let Some(ended) = self.carry_out(effects)? {
            return Ok(ended);
        }
        self.screen.draw(&self.state)?;
        let mut last_tick = Instant::now();
        loop {
            let first = match self.state.tick() {
                None => self.incoming.recv().map_err(|_| RecvTimeoutError::Disconnected),
                Some(tick) => {
                    let due = (last_tick + tick).saturating_duration_since(Instant::now());
                    self.incoming.recv_timeout(due)
                }
            };
            let mut changed = false;
            let mut next = match first {
                Ok(incoming) => Some(incoming),
                Err(RecvTimeoutError::Timeout) => {
                    last_tick = Instant::now();
                    Some(Incoming::Action(Action::Tick))
                }
                // the reader is gone: nothing can come any more
                Err(RecvTimeoutError::Disconnected) => return Ok(end(143)),
            };
            // all that has come is taken before one frame is drawn
            while let Some(incoming) = next {
                if self.state.tick().is_none() {
                    last_tick = Instant::now();
                }
                let (ended, drew) = self.take(incoming)?;
                if let Some(ended) = ended {
                    return Ok(ended);
                }
                changed |= drew;
                next = if self.state.awaits() {
                    self.incoming.recv_timeout(TOGETHER).ok()
                } else {
                    self.incoming.try_recv().ok()
                };
            }
            if changed {
                self.screen.draw(&self.state)?;
            }
        }
    }

    /// Takes one event; says whether the screen may have changed.
    fn take(&mut self, incoming: Incoming) -> io::Result<(Option<Ended>, bool)> {
        let action = match incoming {
            Incoming::Action(action) => Some(action),
            Incoming::Terminal(event) => self.translate(event),
            Incoming::Signal(Asked::End(status)) => return Ok((Some(end(status)), false)),
            Incoming::Signal(Asked::Suspend) => {
                self.suspend()?;
                return Ok((None, true));
            }
            Incoming::Signal(Asked::Redraw) => {
                self.redraw()?;
                return Ok((None, true));
            }
            Incoming::Failed(error) => return Err(error),
        };
        let Some(action) = action else {
            return Ok((None, false));
        };
        let effects = update(&mut self.state, action);
        Ok((self.carry_out(effects)?, true))
    }

    fn translate(&self, event: Event) -> Option<Action> {
        match event {
            Event::Key(key) => input::action(&self.state, &key),
            Event::Paste(text) => Some(Action::Paste(text)),
            Event::Resize(width, height) => Some(Action::Resize(width, height)),
            Event::Mouse(mouse) => {
                let (x, y) = (mouse.column, mouse.row);
                let mouse = match mouse.kind {
                    MouseEventKind::Down(MouseButton::Left) => Mouse::Press(x, y),
                    MouseEventKind::Drag(MouseButton::Left) => Mouse::Drag(x, y),
                    MouseEventKind::ScrollUp => Mouse::WheelUp(x, y),
                    MouseEventKind::ScrollDown => Mouse::WheelDown(x, y),
                    _ => return None,
                };
                Some(Action::Mouse(mouse))
            }
            Event::FocusGained | Event::FocusLost => None,
        }
    }

    fn carry_out(&mut self, effects: Vec<Effect>) -> io::Result<Option<Ended>> {
        let mut effects = VecDeque::from(effects);
        self.files.aim(self.state.shown.watches.then(|| Arc::clone(&self.state.shown.scenario)));
        while let Some(effect) = effects.pop_front() {
            match effect {
                Effect::Run(job) => {
                    let width = overlay::text_width(&self.state);
                    self.worker.order(job, self.state.look.report(width));
                }
                Effect::Stop => self.worker.stop(),
                Effect::Leave(leave) => {
                    return Ok(Some(Ended { leave, status: 0 }));
                }
                Effect::Suspend => self.suspend()?,
                Effect::Edit(path) => {
                    let edited = self.edit(&path)?;
                    effects.extend(update(&mut self.state, Action::Edited(edited)));
                }
                Effect::Redraw => self.redraw()?,
                Effect::Copy(text) => self.screen.copy(&text)?,
                Effect::Mouse(mouse) => self.screen.set_mouse(mouse)?,
            }
        }
        Ok(None)
    }

    fn suspend(&mut self) -> io::Result<()> {
        self.nobody_reads(Screen::suspend)
    }

    /// The editor of the user has the terminal; why it could not be used.
    fn edit(&mut self, path: &Path) -> io::Result<Option<String>> {
        let signals = self.signals.clone();
        self.nobody_reads(|screen| screen.lend(|| signals.while_cooked(|| open_editor(path))))
            .map(|edited| edited.err().map(|error| error.to_string()))
    }

    /// What is done with the terminal while neither keys nor signals are taken.
    fn nobody_reads<T>(&mut self, with: impl FnOnce(&mut Screen) -> io::Result<T>) -> io::Result<T> {
        let rests = Arc::clone(&self.reader.rests);
        rests.pause.store(true, Ordering::SeqCst);
        let result = {
            let _nobody_reads = rests.reading.lock().unwrap_or_else(PoisonError::into_inner);
            with(&mut self.screen)
        };
        rests.pause.store(false, Ordering::SeqCst);
        let result = result?;
        self.state.size = self.screen.size()?;
        Ok(result)
    }

    fn redraw(&mut self) -> io::Result<()> {
        self.state.size = self.screen.size()?;
        self.screen.clear()
    }
}

/// Ended by a signal.
fn end(status: u8) -> Ended {
    Ended { leave: Leave::Quit, status }
}
