//! The terminal: taken at the start, given back as it was on every way out.

use std::io::{self, Stdout, Write};
use std::panic;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use crossterm::event::{DisableBracketedPaste, EnableBracketedPaste};
use crossterm::terminal::{
    BeginSynchronizedUpdate, Clear, ClearType, EndSynchronizedUpdate, EnterAlternateScreen, LeaveAlternateScreen,
    disable_raw_mode, enable_raw_mode,
};
use crossterm::{cursor, execute, queue};
use ratatui::Terminal;
use ratatui::backend::CrosstermBackend;

use crate::signals::{self, Signals};

use super::app::State;
use super::clipboard;
use super::draw;
use super::frame::Frame;

/// Presses, drags and the wheel; not every move of the mouse, which would only cost bytes.
const MOUSE_ON: &[u8] = b"\x1b[?1000h\x1b[?1002h\x1b[?1006h";
const MOUSE_OFF: &[u8] = b"\x1b[?1006l\x1b[?1002l\x1b[?1000l";

type Hook = Box<dyn Fn(&panic::PanicHookInfo<'_>) + Sync + Send + 'static>;

/// The terminal while it belongs to the panes.
pub struct Screen {
    terminal: Terminal<CrosstermBackend<Frame<Stdout>>>,
    mouse: bool,
    hook: Option<Arc<Hook>>,
}

/// Whether the terminal is ours: leaving the alternate screen twice would put the cursor over what was printed since.
static TAKEN: AtomicBool = AtomicBool::new(false);

fn take(mouse: bool) -> io::Result<()> {
    TAKEN.store(true, Ordering::SeqCst);
    enable_raw_mode()?;
    let mut out = io::stdout();
    execute!(out, EnterAlternateScreen, EnableBracketedPaste, cursor::Hide)?;
    if mouse {
        out.write_all(MOUSE_ON)?;
    }
    out.flush()
}

/// Gives the terminal back, if it was taken. What fails because the terminal is gone is passed over.
pub fn restore() {
    if !TAKEN.swap(false, Ordering::SeqCst) {
        return;
    }
    let mut out = io::stdout();
    let _ = out.write_all(MOUSE_OFF);
    let _ = execute!(out, EndSynchronizedUpdate, DisableBracketedPaste, LeaveAlternateScreen, cursor::Show);
    let _ = disable_raw_mode();
}

impl Screen {
    /// Takes the terminal. A panic of this thread gives it back before its message is printed; those of other
    /// threads are reported by the session and not printed over the panes.
    ///
    /// # Errors
    /// There is no terminal.
    pub fn take(mouse: bool) -> io::Result<Screen> {
        let before: Arc<Hook> = Arc::new(panic::take_hook());
        let theirs = Arc::clone(&before);
        let mine = thread::current().id();
        panic::set_hook(Box::new(move |info| {
            if thread::current().id() == mine {
                restore();
                theirs(info);
            }
        }));
        // from here on dropping the screen gives everything back
        let mut screen = Screen {
            terminal: Terminal::new(CrosstermBackend::new(Frame::new(io::stdout())))?,
            mouse,
            hook: Some(before),
        };
        take(mouse)?;
        screen.clear()?;
        Ok(screen)
    }

    /// Columns and rows.
    ///
    /// # Errors
    /// The terminal does not say.
    pub fn size(&self) -> io::Result<(u16, u16)> {
        let size = self.terminal.size()?;
        Ok((size.width, size.height))
    }

    /// Sends what changed since the last frame.
    ///
    /// # Errors
    /// The terminal does not take it.
    pub fn draw(&mut self, state: &State) -> io::Result<()> {
        queue!(self.terminal.backend_mut(), BeginSynchronizedUpdate)?;
        self.terminal.draw(|frame| draw::draw(state, frame))?;
        execute!(self.terminal.backend_mut(), EndSynchronizedUpdate)
    }

    /// The next frame is sent whole.
    ///
    /// # Errors
    /// The terminal does not take it.
    pub fn clear(&mut self) -> io::Result<()> {
        // ratatui's own `clear` asks the terminal where its cursor is, and some never answer
        queue!(self.terminal.backend_mut(), Clear(ClearType::All))?;
        // after a frame the other buffer holds it: swapping empties that, so that all cells are sent again
        self.terminal.swap_buffers();
        Ok(())
    }

    /// Takes or leaves the mouse.
    ///
    /// # Errors
    /// The terminal does not take it.
    pub fn set_mouse(&mut self, mouse: bool) -> io::Result<()> {
        self.mouse = mouse;
        let out = self.terminal.backend_mut();
        out.write_all(if mouse { MOUSE_ON } else { MOUSE_OFF })?;
        Write::flush(out)
    }

    /// Gives the terminal to another program and takes it again when `with` ends.
    ///
    /// # Errors
    /// The terminal does not come back.
    pub fn lend<T>(&mut self, with: impl FnOnce() -> T) -> io::Result<T> {
        restore();
        let result = with();
        take(self.mouse)?;
        self.clear()?;
        Ok(result)
    }

    /// Copies a text into the clipboard of the terminal.
    ///
    /// # Errors
    /// The terminal does not take it.
    pub fn copy(&mut self, text: &str) -> io::Result<()> {
        let within_tmux = std::env::var_os("TMUX").is_some_and(|place| !place.is_empty());
        clipboard::copy(self.terminal.backend_mut(), text, within_tmux)
    }

    /// Gives the terminal back and stops the program; goes on after `fg`.
    ///
    /// # Errors
    /// The terminal does not come back.
    pub fn suspend(&mut self) -> io::Result<()> {
        self.lend(signals::stop)?
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        restore();
        if !thread::panicking()
            && let Some(hook) = self.hook.take()
        {
            // ours goes first, so that theirs is the only one left to share
            drop(panic::take_hook());
            if let Ok(hook) = Arc::try_unwrap(hook) {
                panic::set_hook(hook);
            }
        }
    }
}

/// What a signal asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asked {
    /// To end, with this exit status.
    End(u8),
    /// To stop until `fg`.
    Suspend,
    /// To draw everything anew: the program was stopped and goes on.
    Redraw,
}

/// What was asked for since the last look. The key Ctrl-C is not a signal here: SIGINT comes from outside.
pub fn asked(signals: &Signals) -> Option<Asked> {
    if signals.must_end() || signals.take_interrupt() {
        Some(Asked::End(signals.status()))
    } else if signals.take_stop() {
        Some(Asked::Suspend)
    } else if signals.take_resumed() {
        Some(Asked::Redraw)
    } else {
        None
    }
}
