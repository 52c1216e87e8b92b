//! The REPL on a terminal.

use std::collections::VecDeque;
use std::fs;
use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;

use rustyline::config::Configurer;
use rustyline::error::ReadlineError;
use rustyline::history::FileHistory;
use rustyline::{ColorMode, CompletionType, Config, Editor, Event, EventHandler};

use unicode_width::UnicodeWidthStr;

use crate::session::commands::reload::open_editor;
use crate::session::file_watch::FileWatch;
use crate::session::{CommandError, Next, Output, Session, journal};
use crate::text::printable;
use crate::view::style::{Role, Style};

use super::editor::{Editing, Pace};
use super::{Ended, pager, show_error};
use crate::signals::{self, Signals, TerminalWatch};

/// Lines of history kept.
const HISTORY: usize = 10_000;

type Line = Editor<Editing, FileHistory>;

/// Runs until `quit`, Ctrl-D or a signal.
pub fn run(session: &mut Session, style: Style, signals: &Signals) -> io::Result<Ended> {
    let mut editor = editor(session, style).map_err(io::Error::other)?;
    let history = History::open(&mut editor);
    let pace = Pace::default();
    editor.bind_sequence(Event::Any, EventHandler::Conditional(Box::new(pace.clone())));
    // an external printer makes the editor wait for more than keys, so that a signal can wake it
    let printer = editor.create_external_printer();
    if printer.is_ok() {
        signals.wake_editor();
    }
    let knocking = signals.clone();
    let files = FileWatch::start(move || knocking.knock()).ok().filter(|_| printer.is_ok());
    let fixed_width = style.width != terminal_width();
    let mut style = style;
    // lines of a paste or typed ahead, and the beginning of one
    let mut waiting: VecDeque<String> = VecDeque::new();
    let mut pasted = false;
    let mut begun = (String::new(), String::new());
    let prompt_text = if style.ascii { "> " } else { "› " };
    let prompt_colour = style.paint(Role::Accent, prompt_text);
    loop {
        if signals.must_end() {
            return Ok(Ended::with(signals.status()));
        }
        let (line, echoes) = match waiting.pop_front() {
            Some(line) => (line, true),
            None => {
                pasted = false;
                if let Some(files) = &files {
                    files.aim(session.watched());
                }
                if signals.take_knock() && session.watched().is_some() {
                    reload(session, style, signals);
                }
                if let Some(helper) = editor.helper_mut() {
                    helper.vocabulary = session.vocabulary();
                }
                let prompt = (prompt_text, prompt_colour.as_str());
                let raw = signals.raw();
                let read = editor.readline_with_initial(&prompt, (&begun.0, &begun.1));
                drop(raw);
                begun = Default::default();
                signals.take_interrupt();
                if read.is_err() && signals.has_knocked() {
                    // the line gives way to what is told, and comes again as it was
                    begun = editor.helper().map(Editing::last_line).unwrap_or_default();
                    erase_line(prompt_text, &begun.0)?;
                    continue;
                }
                if signals.take_stop() {
                    // what was typed so far stands in the line again after `fg`
                    begun = editor.helper().map(Editing::last_line).unwrap_or_default();
                    writeln!(io::stdout())?;
                    signals::stop()?;
                    continue;
                }
                match read {
                    Ok(text) => {
                        // a paste of several lines arrives as one text
                        let mut lines = text.lines().map(ToOwned::to_owned);
                        let Some(first) = lines.next() else { continue };
                        waiting.extend(lines);
                        let several = !waiting.is_empty();
                        (first, several)
                    }
                    Err(ReadlineError::Interrupted | ReadlineError::Signal(_)) => continue,
                    Err(ReadlineError::Eof) if io::stdin().is_terminal() => return Ok(Ended::with(0)),
                    // a terminal that hung up reads as an end or an error: the signal may come a moment later
                    Err(_) => {
                        std::thread::sleep(std::time::Duration::from_millis(200));
                        signals.note_hangup();
                        return Ok(Ended::with(signals.status()));
                    }
                }
            }
        };
        if line.trim().is_empty() {
            continue;
        }
        // the history is a comfort: a full disk must not end the session
        let _ = editor.add_history_entry(line.as_str());
        history.append(&line);
        if !fixed_width {
            style.width = terminal_width();
        }
        if echoes {
            // each answer of a paste stands under its command
            let _ = writeln!(io::stdout(), "{prompt_colour}{}", printable::line(&line));
        }
        // nobody reads while the next lines are there already
        let by_hand = waiting.is_empty() && !pace.is_burst();
        pasted |= !by_hand;
        let (result, typed) = execute(session, &line, style, signals, by_hand, pasted);
        let mut typed: Vec<&str> = typed.split('\n').collect();
        begun = (typed.pop().unwrap_or_default().to_owned(), String::new());
        waiting.extend(typed.into_iter().map(ToOwned::to_owned));
        match result {
            Ok(Next::Continue) => {}
            Ok(Next::Quit) => return Ok(Ended::with(0)),
            Ok(Next::Edit) => edit(session, style, signals),
            Ok(next) => return Ok(Ended { status: 0, next }),
            Err(error) if error.is_output() => {
                if signals.must_end() || !io::stdin().is_terminal() {
                    signals.note_hangup();
                    return Ok(Ended::with(signals.status()));
                }
                return Err(error.into_output());
            }
            Err(error) => {
                if error.is_interrupted() {
                    signals.take_interrupt();
                    waiting.clear();
                }
                let _ = writeln!(io::stderr(), "{}", show_error(&error, &style));
            }
        }
    }
}

/// Takes the line away that was being typed; the cursor stood behind `before`.
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
            let _ = writeln!(io::stderr(), "{}", show_error(&error, &style));
        }
    }
}

/// `reload`, which nobody typed.
fn reload(session: &mut Session, style: Style, signals: &Signals) {
    let (result, _) = execute(session, "reload", style, signals, false, false);
    if let Err(error) = result {
        signals.take_interrupt();
        let _ = writeln!(io::stderr(), "{}", show_error(&error, &style));
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

/// Columns of the terminal now.
fn terminal_width() -> usize {
    crossterm::terminal::size().map_or(80, |(columns, _)| usize::from(columns).max(20))
}

fn editor(session: &Session, style: Style) -> rustyline::Result<Line> {
    let config = Config::builder()
        .completion_type(CompletionType::List)
        .completion_show_all_if_ambiguous(true)
        .history_ignore_space(true)
        .max_history_size(HISTORY)?
        .build();
    let mut editor = Line::with_config(config)?;
    editor.set_color_mode(if style.color { ColorMode::Forced } else { ColorMode::Disabled });
    editor.set_helper(Some(Editing::new(session.vocabulary(), style)));
    Ok(editor)
}

/// The file of all lines typed, one a line, written as they come: sessions that run beside each other lose nothing.
struct History {
    path: Option<PathBuf>,
}

impl History {
    fn open(editor: &mut Line) -> Self {
        let path = journal::state_directory()
            .filter(|folder| fs::create_dir_all(folder).is_ok())
            .map(|folder| folder.join("history"));
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
