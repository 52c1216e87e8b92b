//! Ctrl-C, hang-up and termination as flags, and a watch that looks at them.

use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};

use crate::watch::Watch;

/// Longer computations show their progress.
const PATIENCE: Duration = Duration::from_secs(1);
/// Between two lines of progress.
const PACE: Duration = Duration::from_millis(200);

/// What the user or the system asked for since it was looked at.
#[derive(Clone, Debug, Default)]
pub struct Signals {
    interrupt: Arc<AtomicBool>,
    hangup: Arc<AtomicBool>,
    terminate: Arc<AtomicBool>,
}

impl Signals {
    /// Installs the handlers.
    ///
    /// # Errors
    /// The system refuses.
    pub fn install() -> io::Result<Self> {
        let signals = Signals::default();
        for (signal, flag) in [(SIGINT, &signals.interrupt), (SIGHUP, &signals.hangup), (SIGTERM, &signals.terminate)] {
            signal_hook::flag::register(signal, Arc::clone(flag))?;
        }
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

    /// Takes a terminal that cannot be read or written any more as a hang-up, unless another signal is known.
    pub fn note_hangup(&self) {
        if !self.terminated() {
            self.hangup.store(true, Ordering::SeqCst);
        }
    }

    /// Whether the program was asked to end.
    pub fn terminated(&self) -> bool {
        self.terminate.load(Ordering::SeqCst)
    }

    /// Whether the program has to end now.
    pub fn must_end(&self) -> bool {
        self.hung_up() || self.terminated()
    }

    /// Exit status of an end by signal: 128 + its number.
    pub fn status(&self) -> u8 {
        if self.hung_up() {
            129
        } else if self.terminated() {
            143
        } else {
            130
        }
    }

    /// Whether any of them asks to stop what is being computed.
    pub fn any(&self) -> bool {
        self.interrupt.load(Ordering::SeqCst) || self.must_end()
    }

    /// Wakes a line editor that waits for a key when the program has to end.
    ///
    /// The editor listens to SIGINT only; it is raised again and again, as one may arrive just before it listens.
    pub fn wake_editor(&self) {
        let signals = self.clone();
        let watcher = move || {
            loop {
                std::thread::sleep(Duration::from_millis(50));
                if signals.must_end() && signal_hook::low_level::raise(SIGINT).is_err() {
                    return;
                }
            }
        };
        // without that thread the end waits for the next key
        let _ = std::thread::Builder::new().name("signals".to_owned()).spawn(watcher);
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

    /// Takes the line of progress away again.
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

/// Whether the terminal understands no cursor codes.
pub fn is_dumb() -> bool {
    std::env::var_os("TERM").is_none_or(|term| term.is_empty() || term == "dumb")
}
