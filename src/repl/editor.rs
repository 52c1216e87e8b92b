//! What the line editor knows of the language: completion, hints, colours.

use std::borrow::Cow;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use rustyline::Context;
use rustyline::completion::Completer;
use rustyline::highlight::{CmdKind, Highlighter};
use rustyline::hint::Hinter;
use rustyline::{Cmd, ConditionalEventHandler, Event, EventContext, Helper, Validator};

use crate::session::language::complete::{self, Candidate, Vocabulary};
use crate::session::language::error::GrammarError;
use crate::session::language::{grammar, setting, tokens};
use crate::view::style::{Role, Style};

/// Completes, hints and colours by the grammar and the names of the session.
#[derive(Helper, Validator)]
pub struct Editing {
    /// The names as of the last command.
    pub vocabulary: Vocabulary,
    /// Whether and how to colour.
    style: Style,
    /// The line and the cursor in it, as they were seen last.
    line: Mutex<(String, usize)>,
    /// What hears of the keys.
    pace: Pace,
}

impl Editing {
    /// For the names of a session.
    pub fn new(vocabulary: Vocabulary, style: Style) -> Self {
        Editing { vocabulary, style, line: Mutex::default(), pace: Pace::default() }
    }

    /// What hears of the keys.
    pub fn pace(&self) -> Pace {
        self.pace.clone()
    }

    fn keep(&self, line: &str, position: usize) {
        *self.line.lock().unwrap_or_else(PoisonError::into_inner) = (line.to_owned(), position);
    }

    /// The line as it was when the editor was interrupted, before the cursor and after it.
    pub fn last_line(&self) -> (String, String) {
        let (line, position) = self.line.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let (before, behind) = line.split_at_checked(position).unwrap_or((&line, ""));
        (before.to_owned(), behind.to_owned())
    }
}

/// A candidate with its explanation.
pub struct Shown {
    display: String,
    replacement: String,
}

impl rustyline::completion::Candidate for Shown {
    fn display(&self) -> &str {
        &self.display
    }

    fn replacement(&self) -> &str {
        &self.replacement
    }
}

/// Columns of an explanation in the list of candidates.
const ABOUT: usize = 40;

impl Completer for Editing {
    type Candidate = Shown;

    fn complete(&self, line: &str, position: usize, _: &Context<'_>) -> rustyline::Result<(usize, Vec<Shown>)> {
        let completion = complete::completions(line, position, &self.vocabulary);
        let only = completion.candidates.len() == 1;
        let wide = completion.candidates.iter().map(|candidate| candidate.text.chars().count()).max().unwrap_or(0);
        let shown = |Candidate { text, about }: Candidate| {
            let display = if about.is_empty() {
                text.clone()
            } else {
                let about = self.style.fit(&self.style.text(&about), ABOUT);
                format!("{text:<wide$}  {about}")
            };
            // a folder or an unfinished word goes on without a blank
            let goes_on = text.ends_with(['/', ':', '=']);
            let replacement = if only && !goes_on { format!("{text} ") } else { text };
            Shown { display, replacement }
        };
        Ok((completion.start, completion.candidates.into_iter().map(shown).collect()))
    }
}

/// A hint: what Right takes over is only its first part.
pub struct ShownHint {
    text: String,
    insert: Option<String>,
}

impl rustyline::hint::Hint for ShownHint {
    fn display(&self) -> &str {
        &self.text
    }

    fn completion(&self) -> Option<&str> {
        self.insert.as_deref()
    }
}

impl Hinter for Editing {
    type Hint = ShownHint;

    fn hint(&self, line: &str, position: usize, _: &Context<'_>) -> Option<ShownHint> {
        self.keep(line, position);
        if position < line.len() {
            return None;
        }
        let hint = complete::hint(line, &self.vocabulary);
        self.pace.drawn();
        let hint = hint?;
        Some(ShownHint {
            text: self.style.text(&hint.text()),
            insert: Some(hint.insert).filter(|insert| !insert.is_empty()),
        })
    }
}

/// The pace of the keys: a line whose end follows its last character at once was pasted or typed ahead, and more lines
/// may wait in the editor's own buffer.
#[derive(Clone, Default)]
pub struct Pace(Arc<Mutex<Wait>>);

#[derive(Default)]
struct Wait {
    /// Since when the editor has had nothing to do but wait for a key.
    idle_since: Option<Instant>,
    /// How long it waited for the first one of the line.
    first: Option<Duration>,
    /// How long it waited for the last one.
    last: Option<Duration>,
}

/// No hand is faster.
const BY_HAND: Duration = Duration::from_millis(5);

/// Nobody reads an answer and types faster.
const READING: Duration = Duration::from_millis(250);

impl Pace {
    /// Whether the last line came faster than by hand.
    pub fn is_burst(&self) -> bool {
        self.wait().last.is_some_and(|wait| wait < BY_HAND)
    }

    /// A new line.
    pub fn begin(&self) {
        self.wait().first = None;
    }

    /// Whether the line began so late that what stands above it may have been read.
    pub fn began_late(&self) -> bool {
        self.wait().first.is_some_and(|wait| wait >= READING)
    }

    fn wait(&self) -> MutexGuard<'_, Wait> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The editor has drawn the line: that time does not belong to the pace of the keys.
    fn drawn(&self) {
        self.wait().idle_since = Some(Instant::now());
    }
}

impl ConditionalEventHandler for Pace {
    fn handle(&self, _: &Event, _: u16, _: bool, _: &EventContext<'_>) -> Option<Cmd> {
        let mut wait = self.wait();
        wait.last = wait.idle_since.map(|since| since.elapsed());
        wait.first = wait.first.or(wait.last);
        wait.idle_since = Some(Instant::now());
        None
    }
}

impl Highlighter for Editing {
    fn highlight<'l>(&self, line: &'l str, _: usize) -> Cow<'l, str> {
        if !self.style.color {
            return Cow::Borrowed(line);
        }
        Cow::Owned(coloured(line, &self.style))
    }

    fn highlight_hint<'h>(&self, hint: &'h str) -> Cow<'h, str> {
        if self.style.color { Cow::Owned(self.style.paint(Role::Muted, hint)) } else { Cow::Borrowed(hint) }
    }

    fn highlight_char(&self, line: &str, position: usize, kind: CmdKind) -> bool {
        // the only one that hears of a cursor that moves
        self.keep(line, position);
        self.style.color && kind != CmdKind::MoveCursor
    }
}

/// The line with its commands, numbers and comments coloured; the visible characters stay the same.
fn coloured(line: &str, style: &Style) -> String {
    let mut text = String::with_capacity(line.len() + 32);
    let mut done = 0;
    for (from, to) in tokens::spans(line) {
        text.push_str(&line[done..from]);
        done = to;
        let mut first = true;
        for piece in line[from..to].split_inclusive(char::is_whitespace) {
            let word = piece.trim_end();
            let blanks = &piece[word.len()..];
            if word.is_empty() {
                text.push_str(blanks);
                continue;
            }
            let role = if first {
                match grammar::resolve(word) {
                    Ok(_) => Role::Accent,
                    Err(GrammarError::Ambiguous { .. }) => Role::Plain,
                    Err(_) => Role::Bad,
                }
            } else if setting::number(word.trim_end_matches('%')).is_some() {
                Role::Warning
            } else {
                Role::Plain
            };
            first = false;
            text.push_str(&style.paint(role, word));
            text.push_str(blanks);
        }
    }
    let rest = &line[done..];
    // what is left is a comment, or the separator before one
    text.push_str(&style.paint(Role::Muted, rest));
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_change_no_visible_character() {
        let style = Style { color: true, ..Style::default() };
        for line in [
            "set f 0.3; pairs c1 # and \"so\" on",
            "  bogus 1 ;; status",
            "echo \"a ; b\" 'c # d'",
            "",
            "ü ä;ö # ß",
            "\\",
        ] {
            let mut plain = String::new();
            let mut inside = false;
            for c in coloured(line, &style).chars() {
                match c {
                    '\u{1b}' => inside = true,
                    'm' if inside => inside = false,
                    c if !inside => plain.push(c),
                    _ => {}
                }
            }
            assert_eq!(plain, line);
        }
    }
}
