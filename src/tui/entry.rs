//! A line being typed: text, cursor, completion.

use crate::session::language::complete::{Candidate, Vocabulary, completions};

/// A change of the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Edit {
    /// Cursor left.
    Left,
    /// Cursor right.
    Right,
    /// Cursor to the start.
    Home,
    /// Cursor to the end.
    End,
    /// Delete before the cursor.
    Backspace,
    /// Delete at the cursor.
    Delete,
    /// Delete to the start of the line.
    DeleteToStart,
    /// Delete the word before the cursor.
    DeleteWord,
}

/// The line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Entry {
    /// What was typed.
    pub text: String,
    /// Byte of the cursor, on a boundary of characters.
    pub cursor: usize,
    /// Candidates after Tab, and the one that stands in the line.
    pub offered: Vec<Candidate>,
    /// Which of them.
    pub chosen: Option<usize>,
    /// Where their word starts.
    start: usize,
    /// Place in the history, counted from its end.
    pub back: usize,
    /// What was typed before going back.
    draft: String,
}

impl Entry {
    /// A line that begins with this text.
    pub fn with(text: &str) -> Self {
        Entry { text: text.to_owned(), cursor: text.len(), ..Entry::default() }
    }

    fn forget_candidates(&mut self) {
        self.offered.clear();
        self.chosen = None;
    }

    /// Types a text; control characters become blanks.
    pub fn insert(&mut self, text: &str) {
        self.forget_candidates();
        let clean: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        self.text.insert_str(self.cursor, &clean);
        self.cursor += clean.len();
    }

    /// The boundary of characters before the cursor.
    fn before(&self) -> usize {
        self.text[..self.cursor].char_indices().next_back().map_or(0, |(at, _)| at)
    }

    /// The one after it.
    fn after(&self) -> usize {
        self.cursor + self.text[self.cursor..].chars().next().map_or(0, char::len_utf8)
    }

    /// Moves the cursor or deletes.
    pub fn edit(&mut self, edit: Edit) {
        self.forget_candidates();
        match edit {
            Edit::Left => self.cursor = self.before(),
            Edit::Right => self.cursor = self.after(),
            Edit::Home => self.cursor = 0,
            Edit::End => self.cursor = self.text.len(),
            Edit::Backspace => self.delete(self.before()),
            Edit::Delete => {
                let end = self.after();
                self.text.replace_range(self.cursor..end, "");
            }
            Edit::DeleteToStart => self.delete(0),
            Edit::DeleteWord => {
                let head = self.text[..self.cursor].trim_end();
                let blank = head.char_indices().rev().find(|(_, c)| c.is_whitespace());
                self.delete(blank.map_or(0, |(at, c)| at + c.len_utf8()));
            }
        }
    }

    /// Deletes from here to the cursor.
    fn delete(&mut self, from: usize) {
        self.text.replace_range(from..self.cursor, "");
        self.cursor = from;
    }

    /// Completes the word: first what all candidates share, then one after the other.
    pub fn complete(&mut self, vocabulary: &Vocabulary) {
        if !self.offered.is_empty() {
            let next = self.chosen.map_or(0, |at| (at + 1) % self.offered.len());
            let text = self.offered[next].text.clone();
            self.put(&text);
            self.chosen = Some(next);
            return;
        }
        let found = completions(&self.text, self.cursor, vocabulary);
        self.start = found.start;
        match found.candidates.as_slice() {
            [] => {}
            [only] => {
                let folder = only.text.ends_with('/');
                let text = if folder { only.text.clone() } else { format!("{} ", only.text) };
                self.put(&text);
            }
            several => {
                let shared = several[1..].iter().fold(several[0].text.as_str(), |a, b| {
                    let length = a
                        .char_indices()
                        .zip(b.text.chars())
                        .find(|((_, x), y)| x != y)
                        .map_or(a.len().min(b.text.len()), |((at, _), _)| at);
                    &a[..length]
                });
                let shared = shared.to_owned();
                self.put(&shared);
                self.offered = found.candidates;
            }
        }
    }

    fn put(&mut self, word: &str) {
        self.text.replace_range(self.start..self.cursor, word);
        self.cursor = self.start + word.len();
    }

    /// A line of the history: `back` counts from its end, 0 is what was being typed.
    pub fn recall(&mut self, history: &[String], back: usize) {
        self.forget_candidates();
        let back = back.min(history.len());
        if self.back == 0 {
            self.draft = self.text.clone();
        }
        self.text = match back {
            0 => self.draft.clone(),
            back => history[history.len() - back].clone(),
        };
        self.cursor = self.text.len();
        self.back = back;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vocabulary() -> Vocabulary {
        Vocabulary {
            parameters: vec![("f".into(), 0.3), ("F2".into(), 100.0)],
            pairs: vec!["c1".into(), "c2".into()],
            nodes: Vec::new(),
            bars: Vec::new(),
            cases: Vec::new(),
            ..Vocabulary::default()
        }
    }

    #[test]
    fn editing_keeps_the_cursor_on_characters() {
        let mut entry = Entry::with("aü");
        entry.edit(Edit::Left);
        entry.insert("漢");
        assert_eq!(entry.text, "a漢ü");
        entry.edit(Edit::Backspace);
        entry.edit(Edit::Delete);
        assert_eq!(entry.text, "a");
        entry.edit(Edit::Right);
        entry.edit(Edit::Delete);
        entry.edit(Edit::Home);
        entry.edit(Edit::Backspace);
        entry.edit(Edit::End);
        entry.insert(" b\ncd");
        assert_eq!(entry.text, "a b cd");
        entry.edit(Edit::DeleteWord);
        assert_eq!(entry.text, "a b ");
        entry.edit(Edit::DeleteToStart);
        assert_eq!((entry.text.as_str(), entry.cursor), ("", 0));
    }

    #[test]
    fn completion_goes_round() {
        let mut entry = Entry::with("why");
        entry.complete(&vocabulary());
        assert_eq!(entry.text, "why ");
        entry.complete(&vocabulary());
        assert_eq!(entry.text, "why c");
        entry.complete(&vocabulary());
        assert_eq!(entry.text, "why c1");
        entry.complete(&vocabulary());
        assert_eq!(entry.text, "why c2");
        entry.complete(&vocabulary());
        assert_eq!(entry.text, "why c1");
        entry.insert("x");
        assert!(entry.offered.is_empty());
    }

    #[test]
    fn history_comes_back_to_the_draft() {
        let history = vec!["one".to_owned(), "two".to_owned()];
        let mut entry = Entry::with("dra");
        entry.recall(&history, 1);
        assert_eq!(entry.text, "two");
        entry.recall(&history, 5);
        assert_eq!(entry.text, "one");
        entry.recall(&history, 0);
        assert_eq!(entry.text, "dra");
    }
}
