//! `record`: what is typed, ready to replay, with the answers as comments.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::session::language::command::{Action, Command, Recorded};
use crate::session::recorder::Recorder;
use crate::session::{CommandError, Next, Output, Session};

/// Write what is typed from now on to a script, with the answers as comments
///
/// The script begins with the present scenario and values, so that `replay` and `source` bring the same answers.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  record session.stick; set F2 150; pairs; record off")]
pub struct Record {
    /// The script to write, or `off`
    #[arg(value_name = "FILE")]
    file: PathBuf,
}

pub const RECORD: Command = Command { recorded: Recorded::Nothing, ..Command::of::<Record>("record") };

impl Action for Record {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        if self.file == Path::new("off") {
            let Some(recorder) = session.recorder.take() else {
                return Err(CommandError::Refused("nothing is being recorded".into()));
            };
            io.say(&format!("recorded {}", recorder.path().display()))?;
            return Ok(Next::Continue);
        }
        if let Some(recorder) = &session.recorder {
            return Err(CommandError::Refused(format!(
                "already recording to {}: `record off` first",
                recorder.path().display()
            )));
        }
        session.recorder = Some(Recorder::create(&self.file, &session.opening())?);
        io.say(&format!("recording to {} until `record off`", self.file.display()))?;
        Ok(Next::Continue)
    }
}
