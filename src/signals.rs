//! Ctrl-C, hang-up, termination and job control as flags, and a watch that looks at them.

use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use signal_hook::consts::{SIGABRT, SIGCONT, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGTSTP, SIGXFSZ};
use signal_hook::{flag, low_level};

use crate::watch::Watch;

/// Computations that take longer show their progress.
const PATIENCE: Duration = Duration::from_secs(1);
/// Time between two updates of the progress line.
const PACE: Duration = Duration::from_millis(200);

/// Exit status where memory ran out, after the allocator's message: a limit was reached.
const OUT_OF_MEMORY: i32 = 4;

/// Makes a limit of the system an error like any other: writing a file beyond the limit of its size fails as on a full
/// disk, and where memory runs out in spite of all estimates the program ends with a message and a status, not with a
/// core dump.
///
/// # Errors
/// The system refuses.
pub fn survive_limits() -> io::Result<()> {
    flag::register(SIGXFSZ, Arc::default())?;
    flag::register_conditional_shutdown(SIGABRT, OUT_OF_MEMORY, Arc::new(AtomicBool::new(true)))?;
    Ok(())
}

/// What the user or the system has asked for since it was last looked at.
#[derive(Clone, Debug, Default)]
pub struct Signals {
    interrupt: Arc<AtomicBool>,
    hangup: Arc<AtomicBool>,
    terminate: Arc<AtomicBool>,
    quit: Arc<AtomicBool>,
    stop: Arc<AtomicBool>,
    resumed: Arc<AtomicBool>,
    /// Another part of the program wants the line editor to stop waiting for keys.
    knocks: Arc<AtomicBool>,
    /// Whether the terminal is as the shell left it, so that the program may be stopped where it stands.
    cooked: Arc<AtomicBool>,
}

impl Signals {
    /// Installs the handlers.
    ///
    /// # Errors
    /// The system refuses.
    pub fn install() -> io::Result<Self> {
        let signals = Signals { cooked: Arc::new(AtomicBool::new(true)), ..Signals::default() };
        for (signal, seen) in [
            (SIGINT, &signals.interrupt),
            (SIGHUP, &signals.hangup),
            (SIGTERM, &signals.terminate),
            (SIGQUIT, &signals.quit),
            (SIGCONT, &signals.resumed),
        ] {
            flag::register(signal, Arc::clone(seen))?;
        }
        flag::register_conditional_default(SIGTSTP, Arc::clone(&signals.cooked))?;
        flag::register(SIGTSTP, Arc::clone(&signals.stop))?;
        Ok(signals)
    }

    /// Whether Ctrl-C was pressed since the last call.
    pub fn take_interrupt(&self) -> bool {
        self.interrupt.swap(false, Ordering::SeqCst)
    }

    /// Whether the terminal is gone.
    pub fn hung_up(&self) -> bool {
        self.hangup.load(Ordering::SeqCst)
    }

    /// Treats a terminal that can no longer be read or written as a hang-up, unless another signal is known.
    pub fn note_hangup(&self) {
        if !self.must_end() {
            self.hangup.store(true, Ordering::SeqCst);
        }
    }

    /// Whether the program has to end now.
    pub fn must_end(&self) -> bool {
        [&self.hangup, &self.terminate, &self.quit].iter().any(|flag| flag.load(Ordering::SeqCst))
    }

    /// Exit status of an end by signal: 128 + its number.
    pub fn status(&self) -> u8 {
        if self.hung_up() {
            129
        } else if self.terminate.load(Ordering::SeqCst) {
            143
        } else if self.quit.load(Ordering::SeqCst) {
            131
        } else {
            130
        }
    }

    /// Whether any of them asks to stop what is being computed.
    pub fn any(&self) -> bool {
        self.interrupt.load(Ordering::SeqCst) || self.must_end()
    }

    /// While the result is kept, the terminal is not as the shell left it and a stop waits for [`Signals::take_stop`].
    pub fn raw(&self) -> RawTerminal {
        // what came before was dealt with by the system
        self.stop.store(false, Ordering::SeqCst);
        self.resumed.store(false, Ordering::SeqCst);
        self.cooked.store(false, Ordering::SeqCst);
        RawTerminal(self.clone())
    }

    /// Whether the program was asked to stop until `fg`, while the terminal was raw.
    pub fn take_stop(&self) -> bool {
        self.stop.swap(false, Ordering::SeqCst)
    }

    /// Whether the program was stopped and has been resumed.
    pub fn take_resumed(&self) -> bool {
        self.resumed.swap(false, Ordering::SeqCst)
    }

    /// Forgets what came while another program had the terminal: it was meant for that.
    pub fn forget_keys(&self) {
        self.interrupt.store(false, Ordering::SeqCst);
        self.stop.store(false, Ordering::SeqCst);
        self.resumed.store(false, Ordering::SeqCst);
    }

    /// Runs `with` while the terminal is as the shell left it, within the life of a [`RawTerminal`].
    pub fn while_cooked<T>(&self, with: impl FnOnce() -> T) -> T {
        self.cooked.store(true, Ordering::SeqCst);
        let result = with();
        self.cooked.store(false, Ordering::SeqCst);
        self.forget_keys();
        result
    }

    /// Asks the line editor to stop waiting for keys, see [`Signals::wake_editor`].
    pub fn knock(&self) {
        self.knocks.store(true, Ordering::SeqCst);
    }

    /// Whether a knock has not been taken yet.
    pub fn has_knocked(&self) -> bool {
        self.knocks.load(Ordering::SeqCst)
    }

    /// Whether somebody knocked since the last call.
    pub fn take_knock(&self) -> bool {
        self.knocks.swap(false, Ordering::SeqCst)
    }

    /// Wakes a line editor that waits for a key when the program has to end or to stop, or when somebody knocked.
    ///
    /// The editor listens to SIGINT only; it is raised again and again, as one may arrive just before it listens.
    pub fn wake_editor(&self) {
        let signals = self.clone();
        let watcher = move || {
            loop {
                std::thread::sleep(Duration::from_millis(50));
                let is_editing = !signals.cooked.load(Ordering::SeqCst);
                let asked = [&signals.stop, &signals.knocks].iter().any(|flag| flag.load(Ordering::SeqCst));
                let stops = is_editing && asked;
                if (stops || signals.must_end()) && low_level::raise(SIGINT).is_err() {
                    return;
                }
            }
        };
        // without that thread the end waits for the next key
        let _ = std::thread::Builder::new().name("signals".to_owned()).spawn(watcher);
    }
}

/// Stops the program until `fg`; the terminal has to be as the shell left it.
///
/// # Errors
/// The system refuses.
pub fn stop() -> io::Result<()> {
    low_level::emulate_default_handler(SIGTSTP)
}

/// Says that the terminal is raw until it is dropped.
#[must_use]
pub struct RawTerminal(Signals);

impl Drop for RawTerminal {
    fn drop(&mut self) {
        self.0.cooked.store(true, Ordering::SeqCst);
    }
}

/// Stops on signals; shows progress on a terminal at stderr after a second.
#[derive(Debug)]
pub struct TerminalWatch {
    signals: Signals,
    shows: bool,
    state: Mutex<Progress>,
}

#[derive(Debug)]
struct Progress {
    start: Instant,
    last: Option<Instant>,
}

impl TerminalWatch {
    /// A watch over one command.
    pub fn new(signals: &Signals) -> Self {
        TerminalWatch {
            signals: signals.clone(),
            shows: io::stderr().is_terminal() && !is_dumb(),
            state: Mutex::new(Progress { start: Instant::now(), last: None }),
        }
    }

    /// Removes the progress line.
    pub fn clear(&self) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if state.last.take().is_some() {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
        state.start = Instant::now();
    }
}

impl Watch for TerminalWatch {
    fn progress(&self, what: &str, fraction: f64) {
        if !self.shows {
            return;
        }
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let due = state.last.is_none_or(|last| last.elapsed() >= PACE);
        if state.start.elapsed() < PATIENCE || !due {
            return;
        }
        state.last = Some(Instant::now());
        let percent = (fraction.clamp(0.0, 1.0) * 100.0).round();
        // what cannot be shown must not stop the computation
        let _ = write!(io::stderr(), "\r\x1b[K{what} {percent} % · Ctrl-C stops");
        let _ = io::stderr().flush();
    }

    fn stop(&self) -> bool {
        self.signals.any()
    }
}

/// Why a terminal is taken to understand no cursor codes: see [`is_dumb`].
pub const DUMB: &str = "TERM is not set, or dumb";

/// Whether the terminal understands no cursor codes.
pub fn is_dumb() -> bool {
    std::env::var_os("TERM").is_none_or(|term| term.is_empty() || term == "dumb")
}

/// Columns and rows of the terminal now; 80 and 24 where it does not say, or says that it has none.
pub fn terminal_size() -> (usize, usize) {
    let (columns, rows) = crossterm::terminal::size().unwrap_or_default();
    let known = |size: u16, usual: usize| if size == 0 { usual } else { usize::from(size) };
    (known(columns, 80), known(rows, 24))
}

/// Columns of the terminal now, 20 at least.
pub fn terminal_width() -> usize {
    terminal_size().0.max(20)
}
