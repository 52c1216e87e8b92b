//! The command line that stays: an editor on a terminal, plain lines without one, JSON lines for programs.

mod editor;
mod pager;
mod plain;
mod serve;
mod terminal;

use std::io::{self, IsTerminal, Write};

use crate::session::journal::Journal;
use crate::session::{Next, Session, introduction, places};
use crate::view::status;
use crate::view::style::{Role, Style};

use crate::model::words::counted;
use crate::signals::{Signals, is_dumb};
use crate::text::file::reason;

pub use serve::serve;

/// How a face ended: what `main` does next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ended {
    /// Exit status, if it ends here.
    pub status: u8,
    /// The end, or the full screen.
    pub next: Next,
}

impl Ended {
    /// The program ends with this status.
    pub fn with(status: u8) -> Self {
        Ended { status, next: Next::Quit }
    }
}

/// Keeps a journal of the session in the user's state directory, so that nothing is lost without `quit`.
pub fn keep_journal(session: &mut Session) {
    if let Ok(journal) = journal() {
        session.keep_journal(journal);
    }
}

/// The journal of this workplace, or why none can be kept.
fn journal() -> Result<Journal, String> {
    let state = places::state().ok_or(places::NO_STATE)?;
    let here =
        std::env::current_dir().map_err(|error| format!("the working folder cannot be named: {}", reason(&error)))?;
    Ok(Journal::new(&state, &here))
}

/// Whether both ends are a terminal, so that a journal is kept and the full screen can be shown.
pub fn is_interactive() -> bool {
    io::stdin().is_terminal() && io::stdout().is_terminal()
}

/// Runs the REPL on stdin and stdout until `quit`, the end of the input, or `tui`. `again` says that the session
/// comes back from the full screen: nothing is said about it then.
///
/// # Errors
/// The results cannot be written (a closed pipe is not an error) or the terminal fails.
pub fn run(session: &mut Session, style: Style, signals: &Signals, again: bool) -> io::Result<Ended> {
    if !is_interactive() {
        return plain::run(session, style, signals, false);
    }
    if !again {
        greet(session, &style, &mut io::stdout().lock())?;
    }
    let ended =
        if is_dumb() { plain::run(session, style, signals, true) } else { terminal::run(session, style, signals) }?;
    // after a signal the journal stays: nobody said `quit`, the next start offers it
    if !signals.must_end() && ended.next == Next::Quit {
        session.close()?;
    }
    Ok(ended)
}

/// The first lines.
fn greet(session: &Session, style: &Style, out: &mut dyn Write) -> io::Result<()> {
    let scenario = session.scenario();
    let title = format!("{} · {}", scenario.name, scenario.title);
    writeln!(out, "{}", style.fit(&style.text(&title), style.width))?;
    if let Some(answer) = session.answer() {
        writeln!(out, "{}", status::line(answer, None, &scenario.units, style))?;
    }
    for text in introduction(scenario) {
        style.paragraph(out, Role::Plain, &text)?;
    }
    writeln!(out, "`help` lists the commands, Tab completes, Ctrl-D leaves.")?;
    if let Err(why) = journal() {
        for line in style.hanging("a crash would lose all changes: ", &why) {
            writeln!(out, "{line}")?;
        }
    }
    if let Some(left) = session.left_over() {
        let changes = counted(left.changes(), "change", "changes");
        let of = left.scenario().map_or(String::new(), |name| format!(" of {name}"));
        let text = format!(
            "A session in this directory ended without `quit`: `restore` brings back its {changes}{of}, `restore discard` \
             forgets them."
        );
        style.paragraph(out, Role::Plain, &text)?;
    }
    out.flush()
}
