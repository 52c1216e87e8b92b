//! Parse, run, switch between the faces, exit status; nothing else.

#![forbid(unsafe_code)]

use std::io;
use std::process::ExitCode;

use stickslip::cli::{self, Next, Start};
use stickslip::tui::{self, action::Leave};
use stickslip::{repl, session};

fn main() -> ExitCode {
    ExitCode::from(match cli::main() {
        Next::Exit(status) => status,
        Next::Repl(start) => finish(*start, None),
        Next::Serve(start) => {
            let Start { mut session, style, signals, errors } = *start;
            cli::finish(repl::serve(&mut session, style, &signals), &errors)
        }
        Next::Tui(start) => {
            let first = tui::Start { tour: None, home: Leave::Quit };
            finish(*start, Some(first))
        }
    })
}

fn finish(start: Start, screen: Option<tui::Start>) -> u8 {
    let errors = start.errors;
    cli::finish(converse(start, screen), &errors)
}

/// The command line and the full screen in turns, with one session.
fn converse(start: Start, mut screen: Option<tui::Start>) -> io::Result<u8> {
    let Start { mut session, style, signals, .. } = start;
    if repl::is_interactive() {
        repl::keep_journal(&mut session);
    }
    let mut again = false;
    loop {
        if let Some(start) = screen.take() {
            let (back, ended) = tui::run(session, style, start, &signals)?;
            session = back;
            if ended.leave == Leave::Quit {
                // after a signal the journal stays: nobody said `quit`, the next start offers it
                if ended.status == 0 {
                    session.close()?;
                }
                return Ok(ended.status);
            }
        }
        let ended = repl::run(&mut session, style, &signals, again)?;
        again = true;
        match ended.next {
            session::Next::FullScreen { tour } => {
                screen = Some(tui::Start { tour, home: Leave::Repl });
            }
            session::Next::Continue | session::Next::Quit | session::Next::Edit => return Ok(ended.status),
        }
    }
}
