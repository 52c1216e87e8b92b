//! `new`, `import`: scenarios from templates and from problems of other programs.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;

use super::ending::Failure;
use crate::session::commands::{import, new};
use crate::signals::{Signals, TerminalWatch};
use crate::view;
use crate::view::style::Style;

/// Write a scenario to begin with; without KIND, list the kinds
///
/// The kinds are portal, continuous-beam, pipeline, block, block-stack, wall, arch, dam, footing, retaining-wall and
/// press-fit. Their dimensions are parameters, or counts of parts: NAME=VALUE chooses any of them, the others stay as
/// `stickslip new` lists them. The file has comments and is KIND.json if none is named; one that is there already stays
/// as it is.
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  stickslip new\n  stickslip new wall courses=5 bricks=4 f=0.5 wall-5.json")]
pub struct New {
    /// What to begin with
    #[arg(value_name = "KIND")]
    kind: Option<String>,
    /// Values of its parameters and counts, and the file
    #[arg(value_name = "NAME=VALUE|FILE")]
    words: Vec<String>,
}

impl New {
    /// The kinds, or a scenario of one of them and what to type next.
    pub(super) fn run(&self, style: &Style, out: &mut dyn Write) -> Result<u8, Failure> {
        let Some(kind) = self.kind.as_deref() else {
            view::templates::write(out, &new::kinds()?, style)?;
            return Ok(0);
        };
        let watch = TerminalWatch::new(&Signals::install()?);
        let (path, scenario) = new::write(kind, &self.words, &watch)?;
        let file = new::typed(&path);
        let open = format!("  stickslip {file}");
        let wide = open.chars().count() + 4;
        let mut lines = vec![format!("wrote {}: {}", path.display(), scenario.title)];
        lines.extend(new::beyond_range(kind, &scenario)?);
        lines.push(format!("{open:<wide$}  opens it at the prompt, solved"));
        lines.push(format!("  stickslip tui {file}  shows it in the full screen, to vary it"));
        for line in lines {
            writeln!(out, "{}", style.text(&line))?;
        }
        Ok(0)
    }
}

/// Turn an LCP of Siconos (FILE.dat) into a scenario
///
/// Reads dense, sparse and block matrices and writes FILE.json beside the file; one that is there already stays as it is.
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  stickslip import lcp_mmc.dat")]
pub struct Import {
    /// The file
    #[arg(value_name = "FILE")]
    file: PathBuf,
}

impl Import {
    pub(super) fn run(&self, _: &Style, out: &mut dyn Write) -> Result<u8, Failure> {
        let watch = TerminalWatch::new(&Signals::install()?);
        let (written, rows) = import::import(&self.file, &watch)?;
        writeln!(out, "wrote {}: an LCP of {rows} rows", written.display())?;
        Ok(0)
    }
}
