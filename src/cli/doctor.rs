//! `doctor`.

use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Value, json};

use super::ending::Failure;
use super::input::Form;
use super::look::{self, Look};
use crate::export::json as json_export;
use crate::model::memory;
use crate::session::places;
use crate::signals::{DUMB, is_dumb};
use crate::text::file::reason;
use crate::view::style::{Role, Style};

/// Say what this program finds around it: the terminal, its folders, the threads
///
/// What is missing is named with what goes without it. Nothing is written, and nothing is wrong: the exit status is 0.
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  stickslip doctor\n  stickslip doctor --format json")]
pub struct Doctor {
    /// For people, or one JSON object
    #[arg(long, value_enum, default_value_t = Form::Text)]
    format: Form,
}

/// A line of the report: what, what was found, and what is missing with what goes without it.
struct Finding {
    what: &'static str,
    found: String,
    missing: Option<String>,
}

impl Doctor {
    pub(super) fn run(&self, look: &Look, style: &Style, out: &mut dyn Write) -> Result<u8, Failure> {
        let surroundings = Surroundings::look(look, style);
        if self.format == Form::Json {
            writeln!(out, "{}", json_export::pretty(&surroundings.json())?)?;
            return Ok(0);
        }
        for Finding { what, found, missing } in surroundings.findings() {
            for line in style.hanging(&format!("{what:<15}"), &found) {
                writeln!(out, "{line}")?;
            }
            for line in missing.iter().flat_map(|missing| style.hanging(&" ".repeat(15), missing)) {
                writeln!(out, "{}", style.paint(Role::Warning, &line))?;
            }
        }
        Ok(0)
    }
}

/// A folder that is wanted, and why nothing can be written there.
struct Folder {
    path: Option<PathBuf>,
    trouble: Option<String>,
}

impl Folder {
    fn of(path: Result<PathBuf, String>) -> Folder {
        match path {
            Ok(path) => Folder { trouble: cannot_write(&path), path: Some(path) },
            Err(why) => Folder { path: None, trouble: Some(why) },
        }
    }

    fn json(&self) -> Value {
        json!({ "path": self.path.as_deref().map(shown), "writable": self.trouble.is_none(), "trouble": self.trouble })
    }

    fn finding(&self, what: &'static str, without: &str) -> Finding {
        let found = self.path.as_deref().map_or_else(|| "none".to_owned(), shown);
        Finding { what, found, missing: self.trouble.as_ref().map(|trouble| format!("{trouble}: {without}")) }
    }
}

/// A path, with what is not text in it replaced.
fn shown(path: &Path) -> String {
    path.display().to_string()
}

/// Why no file can be made in a folder, or in the nearest one above it that is there.
fn cannot_write(path: &Path) -> Option<String> {
    let there = path.ancestors().find(|folder| folder.exists())?;
    // the file has no name and is gone when it is closed
    let error = tempfile::tempfile_in(there).err()?;
    // without the path that the crate adds to the message
    let error = error.raw_os_error().map_or(error, io::Error::from_raw_os_error);
    Some(format!("nothing can be written in {}: {}", there.display(), reason(&error)))
}

struct Surroundings {
    /// stdin, stdout, stderr.
    terminals: [bool; 3],
    size: Option<(u16, u16)>,
    term: Option<String>,
    /// Why there are no cursor codes, colours, other characters than ASCII.
    no_cursor: Option<&'static str>,
    no_color: Option<String>,
    no_unicode: Option<String>,
    state: Folder,
    work: Folder,
    configuration: Option<PathBuf>,
    threads: usize,
    memory: Option<u64>,
}

impl Surroundings {
    fn look(look: &Look, style: &Style) -> Surroundings {
        let terminals = [io::stdin().is_terminal(), io::stdout().is_terminal(), io::stderr().is_terminal()];
        Surroundings {
            terminals,
            size: (terminals[1]).then(|| crossterm::terminal::size().ok()).flatten(),
            term: look::variable("TERM"),
            no_cursor: is_dumb().then_some(DUMB),
            no_color: (!style.color).then(|| look.why_no_color(terminals[1])),
            no_unicode: look.why_ascii(),
            state: Folder::of(places::state().ok_or_else(|| places::NO_STATE.to_owned())),
            work: Folder::of(
                std::env::current_dir().map_err(|error| format!("it cannot be named: {}", reason(&error))),
            ),
            configuration: places::configuration(),
            threads: rayon::current_num_threads(),
            memory: memory::available_memory(),
        }
    }

    fn json(&self) -> Value {
        let [stdin, stdout, stderr] = self.terminals;
        json!({
            "version": env!("CARGO_PKG_VERSION"),
            "terminal": {
                "stdin": stdin, "stdout": stdout, "stderr": stderr,
                "columns": self.size.map(|(columns, _)| columns), "rows": self.size.map(|(_, rows)| rows),
                "term": self.term,
                "cursor_codes": self.no_cursor.is_none(),
                "color": self.no_color.is_none(),
                "unicode": self.no_unicode.is_none(),
                "full_screen": self.no_screen().is_none(),
            },
            "state": self.state.json(),
            "configuration": { "path": self.configuration.as_deref().map(shown), "exists": self.has_configuration() },
            "work": self.work.json(),
            "threads": self.threads,
            "memory": self.memory,
        })
    }

    fn has_configuration(&self) -> bool {
        self.configuration.as_ref().is_some_and(|path| path.exists())
    }

    /// Why the full screen cannot be shown.
    fn no_screen(&self) -> Option<&'static str> {
        if !self.terminals[0] || !self.terminals[1] {
            return Some("stdin or stdout is not a terminal");
        }
        self.no_cursor
    }

    fn findings(&self) -> Vec<Finding> {
        let is = |is: bool| if is { "a terminal" } else { "no terminal" };
        let [stdin, stdout, stderr] = self.terminals;
        let mut streams = format!("stdin {}, stdout {}, stderr {}", is(stdin), is(stdout), is(stderr));
        if let Some((columns, rows)) = self.size {
            streams.push_str(&format!("; {columns} columns, {rows} rows"));
        }
        if let Some(term) = &self.term {
            streams.push_str(&format!("; TERM={term}"));
        }
        let plain = |what, found: &str, missing: Option<String>| Finding { what, found: found.to_owned(), missing };
        let or = |yes: &'static str, no: &'static str, why: bool| if why { no } else { yes };
        let screen = self.no_screen();
        let memory =
            self.memory.map_or_else(|| "not told by the system".to_owned(), |bytes| memory::readable(bytes as f64));
        let configuration = match &self.configuration {
            Some(path) if self.has_configuration() => shown(path),
            Some(path) => format!("{} is not there: the defaults hold", path.display()),
            None => "neither XDG_CONFIG_HOME nor HOME is set to an absolute path: the defaults hold".to_owned(),
        };
        vec![
            plain("stickslip", env!("CARGO_PKG_VERSION"), None),
            plain("streams", &streams, None),
            plain(
                "full screen",
                or("yes", "no", screen.is_some()),
                screen.map(|why| format!("{why}: `solve`, `replay`, `serve` and plain lines on stdin work")),
            ),
            plain("colours", or("yes", "no", self.no_color.is_some()), self.no_color.clone()),
            plain(
                "characters",
                or("Unicode", "plain ASCII", self.no_unicode.is_some()),
                self.no_unicode.as_ref().map(|why| format!("{why}: pictures and plots are coarser")),
            ),
            self.state.finding("state", "a crash loses the changes of a session, and lines typed are forgotten"),
            plain("configuration", &configuration, None),
            self.work.finding("working folder", "`save`, `new` and `export` need a path elsewhere"),
            plain("threads", &self.threads.to_string(), None),
            plain("memory left", &memory, None),
        ]
    }
}
