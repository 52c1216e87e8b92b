//! The characters of a text that a terminal must not get: those that steer it and those that turn the direction of
//! writing. Scenarios, file names and typed words may hold any.

use std::io::{self, Write};

/// Stands for a character that is held back.
const STAND_IN: char = '?';

/// Whether a character steers the terminal or the order of what is shown: C0, DEL, C1, the separators of lines and
/// paragraphs, the marks, embeddings, overrides and isolates of bidirectional text.
pub fn is_unprintable(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// One line for a terminal: line ends and tabs are blanks, whatever else cannot be printed is `?`.
pub fn line(text: &str) -> String {
    text.chars()
        .filter_map(|c| match c {
            '\n' | '\t' => Some(' '),
            '\r' => None,
            c if is_unprintable(c) => Some(STAND_IN),
            c => Some(c),
        })
        .collect()
}

/// JSON in which every such character of a string is escaped; only strings of JSON can hold any.
pub fn json(text: String) -> String {
    if text.chars().all(|c| c == '\n' || !is_unprintable(c)) {
        return text;
    }
    let mut escaped = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if c != '\n' && is_unprintable(c) {
            // all of them lie in the basic plane: one unit of UTF-16
            escaped.push_str(&format!("\\u{:04x}", u32::from(c)));
        } else {
            escaped.push(c);
        }
    }
    escaped
}

/// Text within XML or HTML, also between quotes; what steers a terminal, or what XML cannot hold, is `?`.
pub fn xml(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\n' | '\t' => escaped.push(' '),
            c if is_unprintable(c) || matches!(c, '\u{fffe}' | '\u{ffff}') => escaped.push(STAND_IN),
            c => escaped.push(c),
        }
    }
    escaped
}

/// Length of a colour code at the start of `text`: `ESC [ … m` with the 16 colours, bold and reset alone.
fn colour_code(text: &str) -> Option<usize> {
    let body = text.strip_prefix("\x1b[")?;
    let end = body.find('m')?;
    let known = |code: &str| matches!(code.parse(), Ok(0u8 | 1 | 30..=37 | 90..=97));
    body[..end].split(';').all(known).then_some(end + 3)
}

/// A text of several lines as a terminal may get it; with `color` the colours of this program pass.
pub fn text(text: &str, color: bool) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        match colour_code(rest).filter(|_| color) {
            Some(length) => {
                plain.push_str(&rest[..length]);
                rest = &rest[length..];
                continue;
            }
            None if c == '\n' => plain.push('\n'),
            None => plain.push_str(&line(&rest[..c.len_utf8()])),
        }
        rest = &rest[c.len_utf8()..];
    }
    plain
}

/// The output of every face: what is written through it passes [`text`].
pub struct Printable<W> {
    out: W,
    color: bool,
    /// Beginning of a character whose other bytes are still to come.
    begun: Vec<u8>,
}

impl<W: Write> Printable<W> {
    /// A writer to `out`; with `color` the colours of this program pass.
    pub fn new(out: W, color: bool) -> Self {
        Printable { out, color, begun: Vec::new() }
    }
}

impl<W: Write> Write for Printable<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.write_all(bytes)?;
        Ok(bytes.len())
    }

    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        if self.begun.is_empty() && bytes.iter().all(|byte| *byte == b'\n' || matches!(byte, b' '..=b'~')) {
            return self.out.write_all(bytes);
        }
        self.begun.extend_from_slice(bytes);
        let whole = match std::str::from_utf8(&self.begun) {
            Err(error) if error.error_len().is_none() => error.valid_up_to(),
            _ => self.begun.len(),
        };
        let rest = self.begun.split_off(whole);
        let read = String::from_utf8_lossy(&self.begun).into_owned();
        self.begun = rest;
        self.out.write_all(text(&read, self.color).as_bytes())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(pieces: &[&[u8]], color: bool) -> String {
        let mut out = Vec::new();
        let mut printable = Printable::new(&mut out, color);
        for piece in pieces {
            assert_eq!(printable.write(piece).unwrap(), piece.len());
        }
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn nothing_that_steers_a_terminal_passes() {
        for c in (0..=0x10_ffff).filter_map(char::from_u32).filter(|c| is_unprintable(*c)) {
            for color in [false, true] {
                let shown = written(&[format!("a{c}b").as_bytes()], color);
                assert!(shown.chars().all(|c| c == '\n' || !is_unprintable(c)), "{c:?}");
            }
            let escaped = json(format!("\"{c}\"").replace('\n', "\\n"));
            let meant: String = serde_json::from_str(&escaped).unwrap();
            assert_eq!(meant, c.to_string());
            assert!(escaped.chars().all(|c| !is_unprintable(c)), "{c:?}");
        }
        assert_eq!(line("a\tb\r\nc\u{1b}]0;x\u{7}\u{202e}"), "a b c?]0;x??");
    }

    #[test]
    fn only_our_colours_pass_and_only_where_asked_for() {
        assert_eq!(text("\x1b[1;31mred\x1b[0m", true), "\x1b[1;31mred\x1b[0m");
        assert_eq!(text("\x1b[1;31mred\x1b[0m", false), "?[1;31mred?[0m");
        assert_eq!(text("\x1b[5m\x1b[2J\x1b[38;5;1m\x1b[m\x1b", true), "?[5m?[2J?[38;5;1m?[m?");
    }

    #[test]
    fn characters_may_come_in_pieces() {
        assert_eq!(written(&[&[0xe2, 0x80], &[0xae], b"x"], true), "?x");
        assert_eq!(written(&["ü".as_bytes(), &[0xc3], &[0xbc, 0xff], b"\n"], true), "üü\u{fffd}\n");
    }
}
