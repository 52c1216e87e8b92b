//! Where a command writes: text or JSON lines, and how wide and colourful.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::Value;

use crate::view::style::{Role, Style};
use crate::watch::Watch;

/// What the results look like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Format {
    /// For people.
    #[default]
    Text,
    /// One JSON object per command.
    JsonLines,
    /// The same objects, kept in [`Output::answers`] for a face that puts them into its own.
    Values,
}

/// What a command answers: serialized for programs, written for people.
pub(super) trait Report: Serialize {
    /// Writes it as text.
    ///
    /// # Errors
    /// Those of `out`.
    fn write(&self, out: &mut dyn Write, style: &Style) -> io::Result<()>;
}

/// The place a face gives to [`Session::execute`](super::Session::execute).
pub struct Output<'a> {
    /// Receives the results; diagnostics come back as errors.
    pub out: &'a mut dyn Write,
    /// Width, colour, characters.
    pub style: Style,
    /// Text or JSON lines.
    pub format: Format,
    /// Sees progress and may ask to stop.
    pub watch: &'a dyn Watch,
    /// Line of the script, for JSON lines; 0 outside a script.
    pub line: usize,
    /// Whether the face can show the full screen.
    pub has_screen: bool,
    /// Whether the lines come by themselves: from a script, a pipe, a paste. Nobody looks at what the one before said.
    pub unattended: bool,
    /// Whether the face shows states and forces of the pairs ahead of displacements and the check of equilibrium, for which
    /// it asks by [`Session::ensure_whole`](super::Session::ensure_whole).
    pub joints_first: bool,
    /// Whether a script says each command before its result.
    pub echo: bool,
    /// The report of the command that runs, in JSON.
    pub(super) report: Option<Value>,
    /// What the commands answered, with [`Format::Values`].
    pub answers: Vec<Value>,
}

impl<'a> Output<'a> {
    /// Text output.
    pub fn text(out: &'a mut dyn Write, style: Style, watch: &'a dyn Watch) -> Self {
        Self::new(out, style, Format::Text, watch)
    }

    /// Output in the given format.
    pub fn new(out: &'a mut dyn Write, style: Style, format: Format, watch: &'a dyn Watch) -> Self {
        Output {
            out,
            style,
            format,
            watch,
            line: 0,
            has_screen: false,
            joints_first: false,
            unattended: false,
            echo: false,
            report: None,
            answers: Vec::new(),
        }
    }

    /// Shows a report: only the form that is asked for is made.
    pub(super) fn report(&mut self, report: &impl Report) -> io::Result<()> {
        self.show(report, |out, style| report.write(out, style))
    }

    /// Shows a result that a function of `view` writes.
    pub(super) fn show(
        &mut self,
        result: &impl Serialize,
        write: impl FnOnce(&mut dyn Write, &Style) -> io::Result<()>,
    ) -> io::Result<()> {
        match self.format {
            Format::Text => write(self.out, &self.style),
            Format::JsonLines | Format::Values => {
                self.report = Some(serde_json::to_value(result)?);
                Ok(())
            }
        }
    }

    /// Says ahead of a result for people what it is of.
    pub(super) fn remark(&mut self, text: &str) -> io::Result<()> {
        match self.format {
            Format::Text => self.style.paragraph(self.out, Role::Muted, text),
            Format::JsonLines | Format::Values => Ok(()),
        }
    }

    /// Reports a sentence.
    pub(super) fn say(&mut self, sentence: &str) -> io::Result<()> {
        self.show(&sentence, |out, style| writeln!(out, "{}", style.text(sentence)))
    }
}
