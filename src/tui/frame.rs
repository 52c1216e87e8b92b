//! The bytes of a frame: gathered, then sent in one piece, with the sixteen colours in the codes that every terminal
//! knows.

use std::io::{self, Write};

/// Gathers what is written until it is flushed; what was not flushed is lost with it, so that half a frame never
/// reaches a terminal that was given back meanwhile.
#[derive(Debug, Default)]
pub struct Frame<W: Write> {
    to: W,
    bytes: Vec<u8>,
}

impl<W: Write> Frame<W> {
    /// A frame that is sent to `to`.
    pub fn new(to: W) -> Self {
        Frame { to, bytes: Vec::new() }
    }
}

impl<W: Write> Write for Frame<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        let bytes = sixteen(&self.bytes);
        self.bytes.clear();
        self.to.write_all(&bytes)?;
        self.to.flush()
    }
}

/// crossterm names the sixteen colours by the codes of 256 (`38;5;3`); here they get those of 16 (`33`).
fn sixteen(bytes: &[u8]) -> Vec<u8> {
    let mut out = Vec::with_capacity(bytes.len());
    let mut rest = bytes;
    while let Some(start) = rest.windows(2).position(|two| two == b"\x1b[") {
        let (text, code) = rest.split_at(start);
        out.extend_from_slice(text);
        let end = code.iter().skip(2).position(|byte| (0x40..=0x7e).contains(byte));
        let Some(end) = end.map(|at| at + 2) else {
            rest = code;
            break;
        };
        match std::str::from_utf8(&code[2..end]) {
            Ok(parameters) if code[end] == b'm' => {
                out.extend_from_slice(b"\x1b[");
                out.extend_from_slice(shorter(parameters).as_bytes());
                out.push(b'm');
            }
            _ => out.extend_from_slice(&code[..=end]),
        }
        rest = &code[end + 1..];
    }
    out.extend_from_slice(rest);
    out
}

/// The parameters of a colour code with `38;5;N` and `48;5;N` made short for N < 16.
fn shorter(parameters: &str) -> String {
    let words: Vec<&str> = parameters.split(';').collect();
    let mut out: Vec<String> = Vec::new();
    let mut at = 0;
    while at < words.len() {
        let color = match words.get(at..at + 3) {
            Some([kind @ ("38" | "48"), "5", number]) => number
                .parse::<u8>()
                .ok()
                .filter(|number| *number < 16)
                .map(|number| (if *kind == "38" { 0 } else { 10 }, number)),
            _ => None,
        };
        match color {
            Some((base, number @ ..=7)) => out.push((base + 30 + number).to_string()),
            Some((base, number)) => out.push((base + 82 + number).to_string()),
            None => out.push(words[at].to_owned()),
        }
        at += if color.is_some() { 3 } else { 1 };
    }
    out.join(";")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sent(bytes: &[u8]) -> Vec<u8> {
        let mut to = Vec::new();
        let mut frame = Frame::new(&mut to);
        for part in bytes.chunks(3) {
            frame.write_all(part).unwrap();
        }
        frame.flush().unwrap();
        to
    }

    #[test]
    fn sixteen_colours_have_short_codes() {
        for (long, short) in [
            ("\x1b[38;5;3mab\x1b[39m", "\x1b[33mab\x1b[39m"),
            ("\x1b[38;5;8;49mü", "\x1b[90;49mü"),
            ("\x1b[48;5;15m\x1b[1m", "\x1b[107m\x1b[1m"),
            ("\x1b[38;5;16m", "\x1b[38;5;16m"),
            ("\x1b[38;2;5;3;1m", "\x1b[38;2;5;3;1m"),
            ("38;5;3 \x1b[5;3H\x1b[?25l", "38;5;3 \x1b[5;3H\x1b[?25l"),
            ("\x1b[38;5", "\x1b[38;5"),
            ("\x1b[m\x1b", "\x1b[m\x1b"),
        ] {
            assert_eq!(sent(long.as_bytes()), short.as_bytes(), "{long:?}");
        }
    }

    #[test]
    fn half_a_frame_is_lost() {
        let mut to = Vec::new();
        let mut frame = Frame::new(&mut to);
        frame.write_all(b"half").unwrap();
        drop(frame);
        assert!(to.is_empty());
    }
}
