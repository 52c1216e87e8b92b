//! The REPL on a terminal.

use std::collections::VecDeque;
use std::fs;
use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;
use std::time::Duration;

use rustyline::config::Configurer;
use rustyline::error::ReadlineError;
use rustyline::history::FileHistory;
use rustyline::{ColorMode, CompletionType, Config, Editor, Event, EventHandler, ExternalPrinter};

use unicode_width::UnicodeWidthStr;

use crate::session::commands::reload::open_editor;
use crate::session::file_watch::FileWatch;
use crate::session::{CommandError, Next, Output, Session, journal, places};
use crate::text::printable;
use crate::view::style::{Role, Style};

use super::editor::{Editing, Pace};
use super::{Ended, pager};
use crate::signals::{self, Signals, TerminalWatch, terminal_width};

/// A terminal that hung up reads as ended, and refuses writes, a moment before the signal says so.
const HANGING_UP: Duration = Duration::from_millis(200);
/// Lines of history kept.
const HISTORY: usize = 10_000;

type LineEditor = Editor<Editing, FileHistory>;

/// Runs until `quit`, Ctrl-D or a signal.
pub fn run(session: &mut Session, style: Style, signals: &Signals) -> io::Result<Ended> {
    let mut input = Input::open(session, style, signals).map_err(io::Error::other)?;
    let fixed_width = style.width != terminal_width();
    let mut style = style;
    loop {
        if signals.must_end() {
            return Ok(Ended::with(signals.status()));
        }
        let line = match input.next(session, style, signals)? {
            Typed::Line(line) => line,
            Typed::Nothing => continue,
            Typed::End(status) => return Ok(Ended::with(status)),
        };
        if !fixed_width {
            style.width = terminal_width();
        }
        input.show(&line);
        if !line.came_with_others && input.pace.began_late() {
            session.attend();
        }
        let by_hand = input.is_by_hand();
        let (result, typed) = execute(session, &line.text, style, signals, by_hand, input.pasted);
        input.type_ahead(&typed);
        match result {
            Ok(Next::Continue) => {}
            Ok(Next::Quit) => return Ok(Ended::with(0)),
            Ok(Next::Edit) => edit(session, style, signals),
            Ok(next) => return Ok(Ended { status: 0, next }),
            Err(error) if error.is_output() => {
                std::thread::sleep(HANGING_UP);
                if signals.must_end() || !io::stdin().is_terminal() {
                    signals.note_hangup();
                    return Ok(Ended::with(signals.status()));
                }
                return Err(error.into_output());
            }
            Err(error) => {
                if error.is_interrupted() {
                    signals.take_interrupt();
                    input.waiting.clear();
                }
                let _ = writeln!(io::stderr(), "{}", style.error_in_lines(&error.to_string()));
            }
        }
    }
}

/// A line to run.
struct Line {
    text: String,
    /// Whether it came with others: then it is shown above its answer.
    came_with_others: bool,
}

/// What the keyboard gave.
enum Typed {
    Line(Line),
    /// No line: a key that ends one, a file that was saved.
    Nothing,
    /// The end, with its status.
    End(u8),
}

/// The lines of the keyboard, with what was pasted or typed ahead.
struct Input {
    editor: LineEditor,
    history: History,
    pace: Pace,
    /// While it lives the editor waits for more than keys, so that a signal can wake it.
    _printer: Option<Box<dyn ExternalPrinter>>,
    /// Tells when a watched file was saved.
    files: Option<FileWatch>,
    /// Lines of a paste or typed ahead …
    waiting: VecDeque<String>,
    /// … and the beginning of one, before and after the cursor.
    begun: (String, String),
    /// Whether a line since the last prompt came without a hand on the keys.
    pasted: bool,
    prompt: &'static str,
    coloured_prompt: String,
}

impl Input {
    fn open(session: &Session, style: Style, signals: &Signals) -> rustyline::Result<Input> {
        let mut editor = editor(session, style)?;
        let history = History::open(&mut editor);
        let pace = editor.helper().map(Editing::pace).unwrap_or_default();
        editor.bind_sequence(Event::Any, EventHandler::Conditional(Box::new(pace.clone())));
        let printer =
            editor.create_external_printer().ok().map(|printer| Box::new(printer) as Box<dyn ExternalPrinter>);
        if printer.is_some() {
            signals.wake_editor();
        }
        let knocking = signals.clone();
        let files = FileWatch::start(move || knocking.knock()).ok().filter(|_| printer.is_some());
        let prompt = if style.ascii { "> " } else { "› " };
        let coloured_prompt = style.paint(Role::Accent, prompt);
        let (waiting, begun) = Default::default();
        Ok(Input {
            editor,
            history,
            pace,
            _printer: printer,
            files,
            waiting,
            begun,
            pasted: false,
            prompt,
            coloured_prompt,
        })
    }

    /// The next line: one that waits, or from the keyboard.
    fn next(&mut self, session: &mut Session, style: Style, signals: &Signals) -> io::Result<Typed> {
        let typed = match self.waiting.pop_front() {
            Some(text) => Typed::Line(Line { text, came_with_others: true }),
            None => self.read(session, style, signals)?,
        };
        Ok(match typed {
            Typed::Line(line) if line.text.trim().is_empty() => Typed::Nothing,
            typed => typed,
        })
    }

    fn read(&mut self, session: &mut Session, style: Style, signals: &Signals) -> io::Result<Typed> {
        self.pasted = false;
        if let Some(files) = &self.files {
            files.aim(session.watched());
            if signals.take_knock() && files.take_news() {
                reload(session, style, signals);
                files.aim(session.watched());
            }
        }
        if let Some(helper) = self.editor.helper_mut() {
            helper.vocabulary = session.vocabulary();
        }
        let prompt = (self.prompt, self.coloured_prompt.as_str());
        self.pace.begin();
        let raw = signals.raw();
        let read = self.editor.readline_with_initial(&prompt, (&self.begun.0, &self.begun.1));
        drop(raw);
        self.begun = Default::default();
        signals.take_interrupt();
        if read.is_err() && signals.has_knocked() {
            // the line gives way to what is reported, and comes again as it was
            self.begun = self.editor.helper().map(Editing::last_line).unwrap_or_default();
            erase_line(self.prompt, &self.begun.0)?;
            return Ok(Typed::Nothing);
        }
        if signals.take_stop() {
            // what was typed so far stands in the line again after `fg`
            self.begun = self.editor.helper().map(Editing::last_line).unwrap_or_default();
            writeln!(io::stdout())?;
            signals::stop()?;
            return Ok(Typed::Nothing);
        }
        Ok(match read {
            Ok(text) => {
                // a paste of several lines arrives as one text
                let mut lines = text.lines().map(ToOwned::to_owned);
                let Some(first) = lines.next() else { return Ok(Typed::Nothing) };
                self.waiting.extend(lines);
                Typed::Line(Line { text: first, came_with_others: !self.waiting.is_empty() })
            }
            Err(ReadlineError::Interrupted | ReadlineError::Signal(_)) => Typed::Nothing,
            Err(ReadlineError::Eof) if io::stdin().is_terminal() => Typed::End(0),
            Err(_) => {
                std::thread::sleep(HANGING_UP);
                signals.note_hangup();
                Typed::End(signals.status())
            }
        })
    }

    /// Keeps a line in the history, and shows it where it came with others: each answer of a paste stands under its
    /// command.
    fn show(&mut self, line: &Line) {
        // the history is a comfort: a full disk must not end the session
        let _ = self.editor.add_history_entry(line.text.as_str());
        self.history.append(&line.text);
        if line.came_with_others {
            let _ = writeln!(io::stdout(), "{}{}", self.coloured_prompt, printable::line(&line.text));
        }
    }

    /// Whether somebody reads the answer: nobody does while the next lines are there already.
    fn is_by_hand(&mut self) -> bool {
        let by_hand = self.waiting.is_empty() && !self.pace.is_burst();
        self.pasted |= !by_hand;
        by_hand
    }

    /// What was typed while a command ran.
    fn type_ahead(&mut self, typed: &str) {
        let mut lines: Vec<&str> = typed.split('\n').collect();
        self.begun = (lines.pop().unwrap_or_default().to_owned(), String::new());
        self.waiting.extend(lines.into_iter().map(ToOwned::to_owned));
    }
}

/// Takes the line away that was being typed; the cursor stood after `before`.
fn erase_line(prompt: &str, before: &str) -> io::Result<()> {
    // the editor has gone to the next row when it returns
    let rows = (prompt.width() + before.width()) / terminal_width().max(1) + 1;
    let mut out = io::stdout();
    write!(out, "\x1b[{rows}A\r\x1b[J")?;
    out.flush()
}

/// `edit`: the editor has the terminal, then the file is read again.
fn edit(session: &mut Session, style: Style, signals: &Signals) {
    let Some(path) = session.scenario().path.clone() else { return };
    let edited = open_editor(&path);
    signals.forget_keys();
    match edited {
        Ok(()) => reload(session, style, signals),
        Err(error) => {
            let _ = writeln!(io::stderr(), "{}", style.error_in_lines(&error.to_string()));
        }
    }
}

/// `reload`, which nobody typed.
fn reload(session: &mut Session, style: Style, signals: &Signals) {
    let (result, _) = execute(session, "reload", style, signals, false, false);
    if let Err(error) = result {
        signals.take_interrupt();
        let gone = session.watched().filter(|watched| watched.path.as_ref().is_some_and(|path| !path.exists()));
        let told = match gone {
            Some(watched) => {
                let gone =
                    format!("{} is gone: the last answer stays; it is read when it is there again", watched.name);
                style.paint(Role::Warning, &style.text(&gone))
            }
            None => style.error_in_lines(&error.to_string()),
        };
        let _ = writeln!(io::stderr(), "{told}");
    }
}

/// Runs a line and shows its results, long ones by the page. Gives back also what was typed meanwhile.
fn execute(
    session: &mut Session,
    line: &str,
    style: Style,
    signals: &Signals,
    paged: bool,
    pasted: bool,
) -> (Result<Next, CommandError>, String) {
    let watch = TerminalWatch::new(signals);
    let mut shown = Vec::new();
    let mut io = Output::text(&mut shown, style, &watch);
    (io.has_screen, io.unattended) = (true, pasted);
    let result = session.execute(line, &mut io);
    watch.clear();
    let shown = printable::text(&String::from_utf8_lossy(&shown), style.color);
    let mut stdout = io::stdout().lock();
    let typed = if paged {
        pager::show(&shown, &mut stdout, signals)
    } else {
        stdout.write_all(shown.as_bytes()).map(|()| String::new())
    };
    match typed {
        Ok(typed) => (result, typed),
        Err(error) => (result.and(Err(error.into())), String::new()),
    }
}

fn editor(session: &Session, style: Style) -> rustyline::Result<LineEditor> {
    let config = Config::builder()
        .completion_type(CompletionType::List)
        .completion_show_all_if_ambiguous(true)
        .history_ignore_space(true)
        .max_history_size(HISTORY)?
        .build();
    let mut editor = LineEditor::with_config(config)?;
    editor.set_color_mode(if style.color { ColorMode::Forced } else { ColorMode::Disabled });
    editor.set_helper(Some(Editing::new(session.vocabulary(), style)));
    Ok(editor)
}

/// The file of all lines typed, one a line, written as they come: sessions that run beside each other lose nothing.
struct History {
    path: Option<PathBuf>,
}

impl History {
    fn open(editor: &mut LineEditor) -> Self {
        let path =
            places::state().filter(|folder| fs::create_dir_all(folder).is_ok()).map(|folder| folder.join("history"));
        if let Some(path) = &path
            && let Ok(bytes) = fs::read(path)
        {
            let text = String::from_utf8_lossy(&bytes);
            let lines: Vec<&str> = text.lines().collect();
            for line in &lines[lines.len().saturating_sub(HISTORY)..] {
                let _ = editor.add_history_entry(*line);
            }
            if lines.len() > 2 * HISTORY {
                let kept = lines[lines.len() - HISTORY..].join("\n") + "\n";
                let _ = crate::export::atomic::write(path, |out| out.write_all(kept.as_bytes()));
            }
        }
        History { path }
    }

    fn append(&self, line: &str) {
        let Some(path) = &self.path else { return };
        if line.starts_with(' ') {
            return;
        }
        if let Ok(mut file) = journal::append_privately(path, false) {
            let _ = file.write_all(format!("{line}\n").as_bytes());
        }
    }
}
