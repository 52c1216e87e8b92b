//! The script that `record` writes: what is typed, ready to replay, with the answers as comments.

use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::language::command::{Parsed, Recorded};
use super::language::error::GrammarError;
use super::language::tokens;
use super::{CommandError, Next, Output, Session};

/// A script being written.
#[derive(Debug)]
pub(in crate::session) struct Recorder {
    file: File,
    path: PathBuf,
}

impl Recorder {
    /// A new script that begins with these lines.
    ///
    /// # Errors
    /// The file exists already or cannot be written.
    pub(in crate::session) fn create(path: &Path, opening: &str) -> Result<Self, CommandError> {
        let file = File::create_new(path).map_err(|source| match source.kind() {
            io::ErrorKind::AlreadyExists => {
                CommandError::Refused(format!("{} exists already: record to another file", path.display()))
            }
            _ => CommandError::File { doing: "record to", path: path.to_owned(), source },
        })?;
        let mut recorder = Recorder { file, path: path.to_owned() };
        recorder.write(opening)?;
        Ok(recorder)
    }

    /// Where it stands.
    pub(in crate::session) fn path(&self) -> &Path {
        &self.path
    }

    fn write(&mut self, text: &str) -> Result<(), CommandError> {
        self.file.write_all(text.as_bytes()).and_then(|()| self.file.flush()).map_err(|source| CommandError::File {
            doing: "record to",
            path: self.path.clone(),
            source,
        })
    }

    /// A command, what it showed and how it ended.
    fn take(&mut self, text: &str, shown: &[u8], result: &Result<Next, CommandError>) -> Result<(), CommandError> {
        let mut entry = String::new();
        match result {
            // an expectation that does not hold would stop every replay
            Err(CommandError::Unmet(unmet)) => entry.push_str(&format!("# {text}\n#   {unmet}\n")),
            Err(error) => {
                let message = error.to_string();
                let first = message.lines().next().unwrap_or_default();
                entry.push_str(&format!("{text}\nexpect error {}\n", tokens::quote(first)));
            }
            Ok(_) => {
                entry.push_str(&format!("{text}\n"));
                for line in plain(&String::from_utf8_lossy(shown)).lines() {
                    entry.push_str(format!("#   {line}").trim_end());
                    entry.push('\n');
                }
            }
        }
        self.write(&entry)
    }
}

/// Text without colour codes.
fn plain(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text.chars();
    while let Some(c) = rest.next() {
        if c == '\u{1b}' {
            for code in rest.by_ref() {
                if code.is_ascii_alphabetic() {
                    break;
                }
            }
        } else {
            plain.push(c);
        }
    }
    plain
}

/// Writes to the user and keeps a copy.
struct Tee<'a> {
    out: &'a mut dyn Write,
    copy: Vec<u8>,
}

impl Write for Tee<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        self.copy.extend_from_slice(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

impl Session {
    /// The commands that lead to the present state, one a line.
    pub(super) fn opening(&self) -> String {
        let mut opening = self.as_commands().join("\n");
        opening.push('\n');
        if let Some(step) = self.position {
            opening.push_str(&format!("step to {step}\n"));
        }
        opening
    }

    /// Runs a command and writes it down.
    pub(super) fn run_recorded(
        &mut self,
        text: &str,
        parsed: Result<Option<Parsed>, GrammarError>,
        io: &mut Output<'_>,
    ) -> Result<Next, CommandError> {
        let recorded = match &parsed {
            Ok(Some(parsed)) => parsed.command.recorded,
            _ => Recorded::Text,
        };
        let mut tee = Tee { out: &mut *io.out, copy: Vec::new() };
        let mut inner = Output::new(&mut tee, io.style, io.format, io.watch);
        (inner.line, inner.has_screen, inner.unattended) = (io.line, io.has_screen, io.unattended);
        let result = self.run_parsed(text, parsed, &mut inner);
        let report = inner.report.take();
        let mut answers = std::mem::take(&mut inner.answers);
        let shown = std::mem::take(&mut tee.copy);
        io.report = report;
        io.answers.append(&mut answers);
        let opening = (recorded == Recorded::State).then(|| self.opening());
        let Some(recorder) = &mut self.recorder else {
            return result; // that was `record off`
        };
        let interrupted = result.as_ref().is_err_and(|error| error.is_interrupted() || error.is_output());
        let noted = match (recorded, opening) {
            (Recorded::Nothing, _) => Ok(()),
            (_, Some(opening)) => recorder.write(&opening),
            _ if interrupted => Ok(()),
            _ => recorder.take(text, &shown, &result),
        };
        match noted {
            Ok(()) => result,
            Err(error) => {
                self.recorder = None;
                result.and(Err(error))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn colour_codes_are_taken_out() {
        assert_eq!(super::plain("\u{1b}[1;31mred\u{1b}[0m and ü"), "red and ü");
    }
}
