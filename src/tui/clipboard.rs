//! The clipboard of the terminal, by OSC 52: it works over SSH, because the terminal itself takes the text.

use std::io::{self, Write};

use base64::Engine;
use base64::prelude::BASE64_STANDARD;

/// Bytes of a text that terminals take; xterm's buffer is the smallest of the common ones.
pub const MOST: usize = 50_000;

/// Asks the terminal to take `text` into its clipboard. Within tmux the request is also handed through to the terminal
/// outside: tmux drops that unless its user has set `allow-passthrough`, and nothing of it is ever shown.
///
/// # Errors
/// The terminal does not take it.
pub fn copy(out: &mut impl Write, text: &str, within_tmux: bool) -> io::Result<()> {
    let request = format!("\x1b]52;c;{}\x07", BASE64_STANDARD.encode(text));
    out.write_all(request.as_bytes())?;
    if within_tmux {
        write!(out, "\x1bPtmux;{}\x1b\\", request.replace('\x1b', "\x1b\x1b"))?;
    }
    out.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_goes_out_as_osc_52() {
        let sent = |text: &str, within_tmux: bool| {
            let mut out = Vec::new();
            copy(&mut out, text, within_tmux).unwrap();
            String::from_utf8(out).unwrap()
        };
        // base64 of "f = 0.5" by hand: 66 20 3d 20 30 2e 35
        assert_eq!(sent("f = 0.5", false), "\x1b]52;c;ZiA9IDAuNQ==\x07");
        let through = sent("f = 0.5", true);
        assert!(through.ends_with("\x1bPtmux;\x1b\x1b]52;c;ZiA9IDAuNQ==\x07\x1b\\"), "{through:?}");
    }
}
