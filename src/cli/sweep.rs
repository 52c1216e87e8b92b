//! `sweep`, `merge`.

use std::io::Write;
use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::ending::Failure;
use super::settings::Settings;
use crate::model::embedded;
use crate::session::commands::sweep;
use crate::signals::{Signals, TerminalWatch};
use crate::view::style::Style;

/// Solve at every point of a grid, on all cores
///
/// Rows come in the order of the grid (the last parameter runs fastest) and are the same bytes whatever the number
/// of threads or shards. Ctrl-C keeps the rows that are done; --resume goes on from there. In space, where a slip has a
/// direction and no sense, slip+ and slip- stay empty: --columns "count slip *" counts slips.
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  stickslip sweep beam --vary f=0:1:0.05 --out beam.csv\n  \
                  stickslip sweep beam --vary f=0:1:0.05 --vary F2=0:400:10 --shard $K/$N --out part-$K.csv --resume\n  \
                  stickslip merge part-*.csv > beam.csv")]
pub struct Sweep {
    /// A file, or an embedded scenario; `-` reads one from stdin
    #[arg(default_value = embedded::DEFAULT)]
    scenario: String,
    /// A parameter and its values: NAME=FROM:TO:STEP (TO included), NAME=FROM..TO/COUNT or NAME=VALUE; up to three
    #[arg(long = "vary", value_name = "NAME=RANGE", required = true)]
    axes: Vec<String>,
    #[command(flatten)]
    settings: Settings,
    /// Only part K of N, for batch systems
    #[arg(long, value_name = "K/N")]
    shard: Option<sweep::Shard>,
    /// File to write; otherwise stdout
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Continue the file if it is there
    #[arg(long, requires = "out")]
    resume: bool,
    /// CSV, or JSON lines; otherwise by the ending of FILE, or CSV
    #[arg(long, value_enum)]
    format: Option<Rows>,
    /// Quantities with columns of their own, separated by commas: "x_n c1, max u"
    #[arg(long, value_name = "QUANTITIES")]
    columns: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Rows {
    Csv,
    Json,
}

impl Sweep {
    pub(super) fn run(&self, style: &Style, out: &mut dyn Write) -> Result<u8, Failure> {
        let signals = Signals::install()?;
        let watch = TerminalWatch::new(&signals);
        let session = self.settings.session(&self.scenario, &watch)?;
        let request = sweep::SweepRequest {
            axes: &self.axes,
            shard: self.shard,
            format: self.format.map(|rows| match rows {
                Rows::Csv => sweep::Format::Csv,
                Rows::Json => sweep::Format::Json,
            }),
            out: self.out.as_deref(),
            resume: self.resume,
            columns: self.columns.as_deref(),
        };
        let done = session.sweep_into(&request, out, &watch);
        watch.clear();
        let done = done?;
        if let Some(path) = &self.out {
            writeln!(out, "{}", style.text(&sweep::done_sentence(&done, path)))?;
        }
        Ok(if done.is_complete() { 0 } else { 130 })
    }
}

/// Join the shards of a sweep into what one run would have written, checking that none is missing
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  stickslip merge part-*.csv --out beam.csv")]
pub struct Merge {
    /// The files of all shards, in any order
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// File to write; otherwise stdout
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl Merge {
    pub(super) fn run(&self, style: &Style, out: &mut dyn Write) -> Result<u8, Failure> {
        let watch = TerminalWatch::new(&Signals::install()?);
        let rows = sweep::merge(&self.files, self.out.as_deref(), out, &watch)?;
        if let Some(path) = &self.out {
            writeln!(out, "{}", style.text(&format!("{rows} rows written to {}", path.display())))?;
        }
        Ok(0)
    }
}
