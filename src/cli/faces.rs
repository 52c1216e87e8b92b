//! The faces that stay: the command line, the full screen, `serve`; `main` switches to them.

use std::io::{self, IsTerminal};

use clap::Args;

use super::ending::Failure;
use super::input::named;
use super::look::Look;
use crate::model::embedded;
use crate::session::Session;
use crate::signals::{Signals, TerminalWatch, is_dumb};
use crate::view::style::Style;

/// Show a scenario in the full screen: vary it and watch
#[derive(Args, Debug)]
pub struct Tui {
    /// A file, or an embedded scenario
    #[arg(default_value = embedded::DEFAULT)]
    pub(super) scenario: String,
}

/// Answer the requests of another program: JSON lines on stdin and stdout
///
/// One line is one request, {"id": …, "command": "…"}; its answer comes at once, on one line: {"id": …, "ok": true,
/// "report": …}, the report of `replay --format json`, or {"id": …, "ok": false, "error": "…", "status": N}, with the
/// exit status that the error would have had. A request of several commands is answered by a list of reports. Whatever
/// cannot be understood is answered by an error, with the id null where none can be read. SIGINT stops a long command,
/// `quit` or the end of the input ends the program.
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  echo '{\"id\": 1, \"command\": \"set f 0.4; pairs\"}' | stickslip serve beam")]
pub struct Serve {
    /// The first scenario: a file, or an embedded one
    #[arg(default_value = embedded::DEFAULT)]
    pub(super) scenario: String,
}

/// What comes after the arguments: `main` switches to the next face.
pub enum Next {
    /// The program is done.
    Exit(u8),
    /// The command line that stays.
    Repl(Box<Start>),
    /// The full screen.
    Tui(Box<Start>),
    /// JSON lines.
    Serve(Box<Start>),
}

/// What the REPL, the full screen and `serve` start from.
pub struct Start {
    /// The scenario, loaded and solved.
    pub session: Session,
    /// Style of stdout.
    pub style: Style,
    /// The handlers, installed.
    pub signals: Signals,
    /// Style of stderr.
    pub errors: Style,
}

pub(super) fn start_screen(look: &Look, scenario: &str, errors: Style) -> Result<Start, Failure> {
    if !io::stdin().is_terminal() || !io::stdout().is_terminal() || is_dumb() {
        return Err(Failure::Status(
            2,
            "the full screen needs a terminal that understands cursor codes; `stickslip solve` and `stickslip replay` \
             work without one"
                .to_owned(),
        ));
    }
    start(look, scenario, errors)
}

pub(super) fn start(look: &Look, scenario: &str, errors: Style) -> Result<Start, Failure> {
    let style = look.style(&io::stdout());
    let signals = Signals::install()?;
    let watch = TerminalWatch::new(&signals);
    let scenario = named(scenario, &watch)?;
    let session = Session::new(scenario, &watch);
    watch.clear();
    Ok(Start { session: session?, style, signals, errors })
}
