//! `import`: problems of other programs as scenarios.

use std::fs::OpenOptions;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use clap::Args;

use crate::export::lcp;
use crate::model::siconos;
use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session, worker};
use crate::text::file::{read_text, reason};
use crate::watch::Watch;

/// Turn an LCP of Siconos (FILE.dat: dense, sparse or in blocks) into a scenario
///
/// Writes FILE.json beside it, which `load` opens; a file that is there already stays as it is.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  import lcp_mmc.dat; load lcp_mmc.json")]
pub struct Import {
    /// The file
    #[arg(value_name = "FILE")]
    file: PathBuf,
}

pub const IMPORT: Command = Command { in_0_1: false, ..Command::of::<Import>("import") };

impl Action for Import {
    fn run(&self, _: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        let (written, rows) = import(&self.file, io.watch)?;
        io.say(&format!("wrote {}: an LCP of {rows} rows", written.display()))?;
        Ok(Next::Continue)
    }
}

/// Writes the LCP of a Siconos file as a scenario beside it, FILE.json for FILE.dat; an existing file stays as it is.
/// Returns the path of the scenario and the number of rows.
///
/// # Errors
/// The file cannot be read or is no such LCP (with the line); the scenario exists or cannot be written; an interruption.
pub fn import(file: &Path, watch: &dyn Watch) -> Result<(PathBuf, usize), CommandError> {
    let refused = |text: String| CommandError::Refused(text);
    let target = file.with_extension("json");
    if target == file {
        return Err(refused(format!(
            "import: {} is a .json file; a scenario is opened with `load`, expected a .dat file of Siconos",
            file.display()
        )));
    }
    let path = file.to_owned();
    let found = worker::run(watch, move |_| {
        let text =
            read_text(&path).map_err(|error| format!("import: cannot read {}: {}", path.display(), reason(&error)))?;
        siconos::read(&text).map_err(|error| format!("import: {}:{}: {}", path.display(), error.line, error.message))
    });
    let found = found?.map_err(refused)?;
    let name = file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let create = OpenOptions::new().write(true).create_new(true).open(&target);
    let created = create.map_err(|error| {
        refused(if error.kind() == std::io::ErrorKind::AlreadyExists {
            format!("import: {} exists already and stays as it is: move it away first", target.display())
        } else {
            format!("import: cannot write {}: {}", target.display(), reason(&error))
        })
    })?;
    let mut out = BufWriter::new(created);
    let written =
        lcp::scenario_text(&mut out, &format!("LCP of {name}"), &found.matrix, &found.q).and_then(|()| out.flush());
    if let Err(error) = written {
        // Half a scenario would be refused later; the file is ours.
        let _ = std::fs::remove_file(&target);
        return Err(refused(format!("import: cannot write {}: {}", target.display(), reason(&error))));
    }
    Ok((target, found.q.len()))
}
