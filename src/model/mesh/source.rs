//! Numbers of a .msh file, written out or binary, one record after the other.

use super::{MeshProblem, Place};

/// Stands for a line that is not UTF-8; no line of a mesh reads so by itself.
const NO_TEXT: &str = "\u{fffd}";

/// How the numbers stand in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Written out, a record a line.
    Text,
    /// Binary, in the byte order of this format or (`true`) the other one.
    Binary { big_endian: bool },
}

/// The file, read from the front.
pub struct Source<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u32,
    name: &'a str,
    pub form: Form,
    /// What is being read, for messages: `node 5`.
    pub item: Item,
}

/// What a number belongs to.
#[derive(Clone, Copy, Debug)]
pub enum Item {
    /// Part of the file as a whole: `the nodes`.
    Section(&'static str),
    /// One of many: `node 5`.
    One(&'static str, u64),
}

impl std::fmt::Display for Item {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Item::Section(name) => f.write_str(name),
            Item::One(name, tag) => write!(f, "{name} {tag}"),
        }
    }
}

impl<'a> Source<'a> {
    pub fn new(bytes: &'a [u8], name: &'a str) -> Self {
        Source { bytes, at: 0, line: 1, name, form: Form::Text, item: Item::Section("the file") }
    }

    /// Where the reading stands.
    pub fn place(&self) -> Place {
        // Lines of a binary file mean nothing.
        Place { file: 0, line: if self.form == Form::Text { self.line } else { 0 } }
    }

    /// A problem with a whole line, where another one was expected.
    pub fn line_problem(&self, expected: &str, found: &str, help: &str) -> MeshProblem {
        if found == NO_TEXT {
            return self.problem(
                format!("expected {expected}, found a line that is not UTF-8"),
                "save the file as text in UTF-8, without letters of other encodings in its names",
            );
        }
        self.problem(format!("expected {expected}, found {}", shown(found.as_bytes())), help)
    }

    /// A problem where the reading stands.
    pub fn problem(&self, message: impl Into<String>, help: impl Into<String>) -> MeshProblem {
        let line = self.place().line as usize;
        MeshProblem { file: self.name.to_owned(), line, message: message.into(), help: help.into() }
    }

    /// Bytes that are left.
    pub fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// What a message names: `x of node 5`, or `the number of blocks` where it belongs to the section itself.
    fn whose(&self, what: &str) -> String {
        match self.item {
            Item::Section(_) => format!("{what} in {}", self.item),
            Item::One(..) => format!("{what} of {}", self.item),
        }
    }

    fn ended(&self, what: &str) -> MeshProblem {
        self.problem(
            format!("the file ends in {}, before {what}", self.item),
            "it is cut off: save or copy the mesh again",
        )
    }

    /// The next line that is not blank, without its ends; `None` at the end of the file.
    pub fn text_line(&mut self) -> Option<&'a str> {
        loop {
            let rest = &self.bytes[self.at..];
            if rest.is_empty() {
                return None;
            }
            let end = rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len());
            self.skip(end);
            let line = std::str::from_utf8(&rest[..end]).map(str::trim).unwrap_or(NO_TEXT);
            if !line.is_empty() {
                return Some(line);
            }
            self.skip((rest.len() > end) as usize);
        }
    }

    fn skip(&mut self, count: usize) {
        if self.form == Form::Text {
            let lines = self.bytes[self.at..self.at + count].iter().filter(|byte| **byte == b'\n').count();
            self.line += lines as u32;
        }
        self.at += count;
    }

    /// Skips past the line `end`; where there is none, goes to the end of the file and returns false.
    pub fn skip_behind(&mut self, end: &str) -> bool {
        let mut from = self.at;
        while let Some(found) = self.bytes[from..].windows(end.len()).position(|word| word == end.as_bytes()) {
            let behind = from + found + end.len();
            if matches!(self.bytes.get(behind), None | Some(b'\n' | b'\r' | b' ')) {
                self.skip(behind - self.at);
                return true;
            }
            from = behind;
        }
        self.skip(self.left());
        false
    }

    /// Begins a record: in a text it stands on one line.
    pub fn record(&mut self, item: Item) {
        self.item = item;
        if self.form == Form::Text {
            let blank = self.bytes[self.at..].iter().take_while(|byte| byte.is_ascii_whitespace()).count();
            self.skip(blank);
        }
    }

    /// Ends a record: nothing else may stand on its line.
    pub fn end_of_record(&mut self) -> Result<(), MeshProblem> {
        if self.form != Form::Text {
            return Ok(());
        }
        match self.word() {
            None => Ok(()),
            Some(word) => Err(self.problem(
                format!("{} has one number too many: found {}", self.item, shown(word)),
                "the line holds more than its record has",
            )),
        }
    }

    /// The next word of the line.
    fn word(&mut self) -> Option<&'a [u8]> {
        let rest = &self.bytes[self.at..];
        let blank = rest.iter().take_while(|byte| matches!(byte, b' ' | b'\t' | b'\r')).count();
        let end = rest[blank..].iter().position(|byte| byte.is_ascii_whitespace());
        let end = blank + end.unwrap_or(rest.len() - blank);
        self.at += end;
        (end > blank).then(|| &rest[blank..end])
    }

    /// The next word as text.
    fn text_word(&mut self, what: &str, expected: &str) -> Result<&'a str, MeshProblem> {
        match self.word() {
            Some(word) => std::str::from_utf8(word).map_err(|_| self.unreadable(what, expected, word)),
            None if self.left() == 0 => Err(self.ended(what)),
            None => Err(self.problem(
                format!("the line ends before {}", self.whose(what)),
                format!("expected {expected}: a record stands on one line"),
            )),
        }
    }

    fn unreadable(&self, what: &str, expected: &str, found: &[u8]) -> MeshProblem {
        if found.starts_with(b"$") {
            return self.problem(
                format!("{} comes in {}, before {what}", shown(found), self.item),
                "the section has fewer entries than its count says, or is cut off: save or copy the mesh again",
            );
        }
        self.problem(
            format!("{}: expected {expected}, found {}", self.whose(what), shown(found)),
            "correct the file, or save the mesh again",
        )
    }

    fn raw<const N: usize>(&mut self, what: &str) -> Result<[u8; N], MeshProblem> {
        let Some(raw) = self.bytes[self.at..].first_chunk::<N>() else {
            self.at = self.bytes.len();
            return Err(self.ended(what));
        };
        self.at += N;
        let mut raw = *raw;
        if self.form == (Form::Binary { big_endian: true }) {
            raw.reverse();
        }
        Ok(raw)
    }

    /// An `int`.
    pub fn integer(&mut self, what: &str) -> Result<i64, MeshProblem> {
        if self.form != Form::Text {
            return Ok(i64::from(i32::from_le_bytes(self.raw(what)?)));
        }
        let word = self.text_word(what, "a whole number")?;
        word.parse().map_err(|_| self.unreadable(what, "a whole number", word.as_bytes()))
    }

    /// A `size_t`: a count or a number of a node or element.
    pub fn size(&mut self, what: &str) -> Result<u64, MeshProblem> {
        if self.form != Form::Text {
            return Ok(u64::from_le_bytes(self.raw(what)?));
        }
        let word = self.text_word(what, "a whole number from 0")?;
        word.parse().map_err(|_| self.unreadable(what, "a whole number from 0", word.as_bytes()))
    }

    /// A `double`; anything that is one, finite or not.
    pub fn double(&mut self, what: &str) -> Result<f64, MeshProblem> {
        if self.form != Form::Text {
            return Ok(f64::from_le_bytes(self.raw(what)?));
        }
        let word = self.text_word(what, "a number")?;
        word.parse().map_err(|_| self.unreadable(what, "a number", word.as_bytes()))
    }

    /// A count of entries, each of at least `bytes_each` bytes.
    pub fn count(&mut self, what: &'static str, bytes_each: usize) -> Result<usize, MeshProblem> {
        let count = self.size(what)?;
        self.fits(count, what, bytes_each)
    }

    /// The count, if the rest of the file has room for this many entries.
    pub fn fits(&self, count: u64, what: &str, bytes_each: usize) -> Result<usize, MeshProblem> {
        let most = self.left() / bytes_each;
        if count <= most as u64 {
            return Ok(count as usize);
        }
        Err(self.problem(
            format!("{} is said to be {count}, but the file has only {} bytes more", self.whose(what), self.left()),
            "it is cut off, or the count is wrong: save or copy the mesh again",
        ))
    }

    /// Skips to the end of the line, after which binary numbers begin.
    pub fn end_text_line(&mut self) {
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(|byte| *byte == b'\n').map_or(rest.len(), |end| end + 1);
        self.skip(end);
    }

    /// The line that must come next.
    pub fn expect_line(&mut self, expected: &str) -> Result<(), MeshProblem> {
        match self.text_line() {
            Some(line) if line == expected => Ok(()),
            Some(line) => Err(self.line_problem(
                &format!("{expected} after {}", self.item),
                line,
                "the section has more entries than its count says, or is damaged: save the mesh again",
            )),
            None => Err(self.ended(expected)),
        }
    }
}

/// What was found, cut where it is long.
pub fn shown(found: &[u8]) -> String {
    crate::model::words::quoted(&String::from_utf8_lossy(&found[..found.len().min(200)]))
}
