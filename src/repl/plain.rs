//! Lines from stdin without an editor: pipes, files, `TERM=dumb`.

use std::io::{self, BufRead, IsTerminal, Read, Write};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::time::Duration;

use crate::session::language::{tokens, turn::asks_for_failure};
use crate::session::{Next, Output, Session, script};
use crate::text::printable::Printable;
use crate::view::style::Style;

use super::Ended;
use crate::signals::{Signals, TerminalWatch};

/// Between two looks at the signals while nothing comes in.
pub(super) const LOOK: Duration = Duration::from_millis(50);

/// One result after the other; without a terminal no prompt.
///
/// A failure is reported on stderr and the next command runs. On a pipe the exit status is that of the first failure;
/// on a terminal a failure is part of the conversation.
pub fn run(session: &mut Session, style: Style, signals: &Signals, prompt: bool) -> io::Result<Ended> {
    let lines = reader()?;
    let mut stdout = Printable::new(io::stdout(), style.color);
    let mut status = 0;
    let mut pending = 0;
    let mut line_number = 0;
    let mut waiting = false;
    loop {
        if prompt && !waiting {
            write!(stdout, "> ")?;
            stdout.flush()?;
            waiting = true;
        }
        let input = lines.recv_timeout(LOOK);
        if signals.must_end() {
            return Ok(Ended::with(signals.status()));
        }
        if signals.take_interrupt() {
            if !prompt {
                return Ok(Ended::with(130));
            }
            writeln!(stdout)?;
            waiting = false;
        }
        let bytes = match input {
            Ok(Input::Line(bytes)) => Some(bytes),
            Ok(Input::TooLong) => None,
            Ok(Input::End) | Err(RecvTimeoutError::Disconnected) => break,
            Ok(Input::Failed(error)) => return Err(error),
            Err(RecvTimeoutError::Timeout) => continue,
        };
        waiting = false;
        line_number += 1;
        let line = bytes.as_ref().map_or_else(String::new, |bytes| String::from_utf8_lossy(bytes).into_owned());
        let line = line.trim_end_matches(['\n', '\r']);
        let watch = TerminalWatch::new(signals);
        let mut io = Output::text(&mut stdout, style, &watch);
        (io.line, io.unattended) = (line_number, !prompt);
        let result = match bytes {
            Some(_) => session.execute(line, &mut io),
            None => Err(session.refuse_long_line(line_number)),
        };
        watch.clear();
        // A pipe does not know what comes next: whether a failure was asked for shows in the line after it.
        let commands = tokens::commands(line);
        match &result {
            Ok(_) if commands.first().is_some_and(|first| asks_for_failure(first)) => pending = 0,
            Ok(_) if commands.is_empty() => {}
            _ => {
                if status == 0 {
                    status = pending;
                }
                pending = 0;
            }
        }
        match result {
            Ok(Next::Continue) => {}
            // the session refuses the full screen and the editor here
            Ok(Next::Quit | Next::FullScreen { .. } | Next::Edit) => break,
            Err(error) if error.is_broken_pipe() => return Ok(Ended::with(0)),
            Err(error) if error.is_output() => return Err(error.into_output()),
            Err(error) => {
                // a stderr that is closed is no reason to stop
                let _ = writeln!(io::stderr(), "{}", error_style(style).error(&error.to_string()));
                if error.is_interrupted() {
                    signals.take_interrupt();
                    if signals.must_end() || !prompt {
                        return Ok(Ended::with(signals.status()));
                    }
                }
                pending = error.status();
            }
        }
    }
    if prompt {
        return Ok(Ended::with(0));
    }
    if line_number == 0 {
        let note = "there is no terminal, and stdin holds no commands; `stickslip solve` and `stickslip help` need none (in a \
                    container, `-it` gives a terminal)";
        for line in style.hanging("note: ", note) {
            let _ = writeln!(io::stderr(), "{line}");
        }
    }
    let status = [status, pending, session.trouble_status()].into_iter().find(|status| *status != 0).unwrap_or(0);
    Ok(Ended::with(status))
}

/// No colour on a stderr that is not a terminal.
fn error_style(style: Style) -> Style {
    Style { color: style.color && io::stderr().is_terminal(), ..style }
}

/// What the reader of stdin hands over.
pub(super) enum Input {
    Line(Vec<u8>),
    /// A line of more bytes than any command has: read to its end and dropped.
    TooLong,
    End,
    Failed(io::Error),
}

/// Reads stdin on a thread of its own: a blocked read cannot be given up, a blocked thread can be left behind.
pub(super) fn reader() -> io::Result<Receiver<Input>> {
    // a few lines ahead at most, so that an endless input does not pile up
    let (sender, receiver) = mpsc::sync_channel(16);
    let read = move || {
        let mut stdin = io::stdin().lock();
        loop {
            let input = next(&mut stdin).unwrap_or_else(Input::Failed);
            let last = matches!(input, Input::End | Input::Failed(_));
            if sender.send(input).is_err() || last {
                return;
            }
        }
    };
    std::thread::Builder::new().name("stdin".to_owned()).spawn(read)?;
    Ok(receiver)
}

fn next(stdin: &mut impl BufRead) -> io::Result<Input> {
    let mut bytes = Vec::new();
    let longest = script::LONGEST as u64;
    // the end of the line does not count
    if stdin.by_ref().take(longest + 1).read_until(b'\n', &mut bytes)? == 0 {
        return Ok(Input::End);
    }
    if bytes.ends_with(b"\n") || bytes.len() as u64 <= longest {
        return Ok(Input::Line(bytes));
    }
    stdin.skip_until(b'\n')?;
    Ok(Input::TooLong)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_taken_whole_or_not_at_all() {
        let longest = script::LONGEST;
        for (length, whole) in [(longest - 1, true), (longest, true), (longest + 1, false), (3 * longest, false)] {
            for end in ["\n", ""] {
                let text = format!("{}{end}{}", "x".repeat(length), if end.is_empty() { "" } else { "set f 0.3\n" });
                let mut stdin = text.as_bytes();
                let first = next(&mut stdin).unwrap();
                assert_eq!(matches!(&first, Input::Line(bytes) if bytes.starts_with(b"x")), whole, "{length}");
                assert_eq!(matches!(first, Input::TooLong), !whole, "{length}");
                match next(&mut stdin).unwrap() {
                    Input::Line(bytes) => assert_eq!(bytes, b"set f 0.3\n"),
                    Input::End => assert!(end.is_empty()),
                    _ => panic!("{length}"),
                }
            }
        }
    }
}
