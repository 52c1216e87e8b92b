//! Long results on a terminal, a screen at a time.

use std::io::{self, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use crossterm::event::{self, Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use crossterm::terminal;
use unicode_width::UnicodeWidthChar;

use crate::signals::{self, Signals, terminal_size};

/// How long the keys of a paste may be apart.
const BURST: Duration = Duration::from_millis(10);

/// Shows `text`; if it is longer than the screen, stops at each screenful and waits for a key.
///
/// What was typed ahead or pasted is no answer to that question: then everything is shown at once and the text is
/// given back, for the prompt.
pub fn show(text: &str, out: &mut dyn Write, signals: &Signals) -> io::Result<String> {
    let (columns, rows) = terminal_size();
    let page = rows.saturating_sub(1).max(2);
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let height = |line: &str| visible(line).div_ceil(columns).max(1);
    let mut room = page;
    let mut left: usize = lines.iter().map(|line| height(line)).sum();
    let mut typed = String::new();
    for (index, line) in lines.iter().enumerate() {
        let needed = height(line);
        // the last line of a screen is worth no question of its own
        if needed > room && left > 1 {
            match ask(out, lines.len() - index, signals)? {
                Answer::Line => room = needed,
                Answer::Page => room = page.max(needed),
                Answer::All => room = usize::MAX,
                Answer::Stop => return Ok(typed),
                Answer::Typed(text) => {
                    typed = text;
                    room = usize::MAX;
                }
            }
        }
        out.write_all(line.as_bytes())?;
        room = room.saturating_sub(needed);
        left = left.saturating_sub(needed);
    }
    out.flush()?;
    Ok(typed)
}

enum Answer {
    Line,
    Page,
    All,
    Stop,
    Typed(String),
}

/// Puts the terminal back however the question ends.
struct Raw;

impl Drop for Raw {
    fn drop(&mut self) {
        let _ = terminal::disable_raw_mode();
    }
}

/// How long a question may still take after a signal that ends the program.
const GRACE: Duration = Duration::from_millis(500);

/// While it is kept, the program ends with its terminal: crossterm 0.29 reads the end of file over and over and does not come
/// back. The journal has all changes already.
struct EndsWithTerminal(Arc<AtomicBool>);

impl EndsWithTerminal {
    fn watch(signals: &Signals) -> io::Result<EndsWithTerminal> {
        let over = Arc::new(AtomicBool::new(false));
        let (theirs, signals) = (Arc::clone(&over), signals.clone());
        let look = move || {
            while !theirs.load(Ordering::SeqCst) {
                thread::sleep(GRACE);
                if signals.must_end() {
                    thread::sleep(GRACE);
                    if !theirs.load(Ordering::SeqCst) {
                        std::process::exit(signals.status().into());
                    }
                }
            }
        };
        thread::Builder::new().name("hang-up".to_owned()).spawn(look)?;
        Ok(EndsWithTerminal(over))
    }
}

impl Drop for EndsWithTerminal {
    fn drop(&mut self) {
        self.0.store(true, Ordering::SeqCst);
    }
}

fn ask(out: &mut dyn Write, left: usize, signals: &Signals) -> io::Result<Answer> {
    out.flush()?;
    let _stops_wait = signals.raw();
    let _ends = EndsWithTerminal::watch(signals)?;
    terminal::enable_raw_mode()?;
    let raw = Raw;
    // what is there already was typed before the question
    let ahead = keys()?;
    if !ahead.is_empty() {
        return Ok(Answer::Typed(as_text(&ahead)));
    }
    let s = if left == 1 { "" } else { "s" };
    let question = format!("-- {left} line{s} more: space page, Enter line, a all, q stop --");
    write!(out, "{question}")?;
    out.flush()?;
    let answer = loop {
        if signals.must_end() || signals.take_interrupt() {
            break Answer::Stop;
        }
        if signals.take_stop() {
            terminal::disable_raw_mode()?;
            signals::stop()?;
            terminal::enable_raw_mode()?;
            write!(out, "\r{question}")?;
            out.flush()?;
        }
        if !event::poll(Duration::from_millis(100))? {
            continue;
        }
        match keys()?.as_slice() {
            [] => {}
            [key] => {
                if let Some(answer) = answer(*key) {
                    break answer;
                }
            }
            burst => break Answer::Typed(as_text(burst)),
        }
    };
    drop(raw);
    write!(out, "\r\x1b[K")?;
    Ok(answer)
}

/// What a single key means; another character begins the next command.
fn answer(key: KeyEvent) -> Option<Answer> {
    let control = key.modifiers.contains(KeyModifiers::CONTROL);
    Some(match key.code {
        KeyCode::Char('c' | 'd') if control => Answer::Stop,
        KeyCode::Char('q') | KeyCode::Esc => Answer::Stop,
        KeyCode::Char(' ') | KeyCode::PageDown => Answer::Page,
        KeyCode::Enter | KeyCode::Down => Answer::Line,
        KeyCode::Char('a') | KeyCode::End => Answer::All,
        KeyCode::Char(_) if !control => Answer::Typed(as_text(&[key])),
        _ => return None,
    })
}

/// The keys that wait, and those that follow at the speed of a paste.
fn keys() -> io::Result<Vec<KeyEvent>> {
    let mut keys = Vec::new();
    while event::poll(BURST)? {
        match event::read()? {
            Event::Key(key) if key.kind != KeyEventKind::Release => keys.push(key),
            _ => {}
        }
    }
    Ok(keys)
}

fn as_text(keys: &[KeyEvent]) -> String {
    keys.iter()
        .filter_map(|key| match key.code {
            KeyCode::Char('j') if key.modifiers.contains(KeyModifiers::CONTROL) => Some('\n'),
            KeyCode::Char(_) if key.modifiers.contains(KeyModifiers::CONTROL) => None,
            KeyCode::Char(c) => Some(c),
            KeyCode::Enter => Some('\n'),
            _ => None,
        })
        .collect()
}

/// Columns of a line without its colour codes and its end.
fn visible(line: &str) -> usize {
    let mut inside = false;
    let mut columns = 0;
    for c in line.chars() {
        match c {
            '\u{1b}' => inside = true,
            c if inside => inside = !c.is_ascii_alphabetic(),
            c => columns += c.width().unwrap_or(0),
        }
    }
    columns
}

#[cfg(test)]
mod tests {
    #[test]
    fn colour_takes_no_room() {
        assert_eq!(super::visible("\u{1b}[1;36mab\u{1b}[0m ü\n"), 4);
    }
}
