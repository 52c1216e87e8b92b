//! `replay`.

use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

use clap::Args;

use super::ending::{Failure, tell};
use super::input::Form;
use crate::model::embedded;
use crate::session::script;
use crate::session::{Format, Output, Session, load};
use crate::signals::{Signals, TerminalWatch};
use crate::view::style::Style;

/// Run a script of REPL commands; `-` reads it from stdin
#[derive(Args, Debug)]
pub struct Replay {
    /// The script
    script: PathBuf,
    /// Text, or one JSON object per command
    #[arg(long, value_enum, default_value_t = Form::Text)]
    format: Form,
    /// Go on after a command that fails (a script that `source` runs ends at its first one all the same)
    #[arg(long)]
    keep_going: bool,
    /// Say each command before its result
    #[arg(long)]
    echo: bool,
}

impl Replay {
    pub(super) fn run(&self, style: &Style, out: &mut dyn Write) -> Result<u8, Failure> {
        let signals = Signals::install()?;
        let watch = TerminalWatch::new(&signals);
        let stdin = self.script == Path::new("-");
        let name = if stdin { "stdin".to_owned() } else { self.script.display().to_string() };
        let text = load::script((!stdin).then_some(self.script.as_path()), &watch)?;
        let mut session = Session::new(load::scenario(embedded::DEFAULT, &watch)?, &watch)?;
        let format = match self.format {
            Form::Text => Format::Text,
            Form::Json => Format::JsonLines,
        };
        let errors = Style { color: style.color && io::stderr().is_terminal(), ..*style };
        let mut io = Output::new(out, *style, format, &watch);
        io.echo = self.echo;
        let ended = script::run(&mut session, &name, &text, self.keep_going, &mut io, &mut |error| {
            watch.clear();
            tell(&errors, &error.to_string());
        });
        watch.clear();
        Ok(ended?.status)
    }
}
