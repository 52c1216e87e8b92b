//! `sweep`, and the sweeps and merges of the shell.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use serde::Serialize;
use serde_json::Value;

use crate::export::atomic;
use crate::export::table::Table;
use crate::model::quantity::{self, Quantity};
use crate::model::scenario::Source;
use crate::path::grid::{Axis, Grid, POINTS};
use crate::path::merge::Shards;
use crate::path::sweep;
use crate::path::sweep_file::run_to_file;
use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session, worker};
use crate::view;
use crate::watch::Watch;

pub use crate::path::grid::Shard;
pub use crate::path::sweep::Format;
pub use crate::path::sweep_run::Done;

/// A table with more rows than this belongs in a file.
const ROWS: usize = 2_000;

/// Solve at every point of a grid of up to three parameters
///
/// A range is A..B, with the number of points N after it (11 if left out). With `--out` the rows go to a .csv or
/// .json file as they come; Ctrl-C keeps what is done and `--resume` goes on from there. In space, where a slip has a direction
/// and no sense, slip+ and slip- stay empty: `--columns "count slip *"` counts slips.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  sweep f 0..1 21\n  sweep f 0..1 F2 0..400 41 --out beam.csv")]
pub struct Sweep {
    /// PARAMETER A..B [N], up to three times
    #[arg(value_name = "SWEPT", required = true, allow_negative_numbers = true)]
    words: Vec<String>,
    /// File for the rows: .csv, or .json for one object a line
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Continue the file
    #[arg(long, requires = "out")]
    resume: bool,
    /// Only part K of N
    #[arg(long, value_name = "K/N")]
    shard: Option<Shard>,
    /// Quantities with columns of their own, separated by commas: "x_n c1, max u"
    #[arg(long, value_name = "QUANTITIES")]
    columns: Option<String>,
}

pub const SWEEP: Command = Command {
    complete: |asked| if asked.option.is_none() { asked.parameters() } else { Vec::new() },
    prepare: keep_negative_ranges,
    ..Command::of::<Sweep>("sweep")
};

impl Action for Sweep {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.run_sweep(self, io)?;
        Ok(Next::Continue)
    }

    fn is_of_own_factors(&self, _: &Session) -> bool {
        true
    }
}

/// Options may follow the ranges: a range from below zero would be taken for one of them.
fn keep_negative_ranges(words: &mut [String]) {
    let below_zero = |word: &&mut String| word.starts_with('-') && !word.starts_with("--") && word.contains("..");
    words.iter_mut().filter(below_zero).for_each(|word| word.insert(0, ' '));
}

#[derive(Serialize)]
struct SweepReport<'a> {
    columns: &'a [String],
    rows: &'a [Vec<Value>],
    complete: bool,
}

impl Session {
    /// The quantities of `--columns`.
    fn columns(&self, text: Option<&str>) -> Result<Vec<Quantity>, CommandError> {
        let found = text.map_or(Ok(Vec::new()), |text| quantity::read_text(text, &self.names()));
        let found = found.map_err(|error| CommandError::Refused(format!("sweep: {error}")))?;
        self.need_stages("sweep", &found)?;
        Ok(found)
    }

    /// Refuses quantities of a load history that the scenario does not have.
    pub(super) fn need_stages(&self, command: &str, quantities: &[Quantity]) -> Result<(), CommandError> {
        match quantities.iter().find(|quantity| quantity.is_of_history()) {
            Some(quantity) if self.now.scenario.stages.is_empty() => Err(CommandError::Refused(format!(
                "{command}: {quantity} is of the load history, and the scenario has no `stages`"
            ))),
            _ => Ok(()),
        }
    }

    /// The columns of a sweep with their units: parameters, what every sweep has, quantities.
    fn with_units(&self, columns: &[String], grid: &Grid, quantities: &[Quantity]) -> Vec<(String, Option<String>)> {
        let scenario = &*self.now.scenario;
        let units = &scenario.units;
        let is_plain = matches!(scenario.source, Source::Lcp(_));
        let unit = |(k, name): (usize, &String)| match quantities.iter().find(|one| one.to_string() == *name) {
            _ if k < grid.axes.len() => scenario.unit_of(name).map(str::to_owned),
            Some(quantity) => quantity.unit(units),
            None if is_plain => None,
            None => view::sweep::unit_of(name, units),
        };
        columns.iter().enumerate().map(|(k, name)| (name.clone(), unit((k, name)))).collect()
    }

    fn run_sweep(&mut self, asked: &Sweep, io: &mut Output<'_>) -> Result<(), CommandError> {
        let axes = axes(&asked.words)?;
        let grid = Grid::new(&self.now.scenario, axes)?;
        let quantities = self.columns(asked.columns.as_deref())?;
        let ground = self.ground(io.watch)?;
        let sweep = sweep::Sweep {
            case: ground.case(io.watch),
            grid: &grid,
            shard: asked.shard.unwrap_or(Shard::WHOLE),
            format: match &asked.out {
                Some(path) => format_of(path)?,
                None => Format::Json,
            },
            quantities: &quantities,
        };
        if let Some(path) = &asked.out {
            let done = run_to_file(&sweep, path, asked.resume, io.watch)?;
            return Ok(io.say(&done_sentence(&done, path))?);
        }
        let points = sweep.shard.points(grid.len()).len();
        if points > ROWS {
            return Err(CommandError::Refused(format!(
                "{points} rows are too many to show: `--out FILE` writes them to a file"
            )));
        }
        let mut text = Vec::new();
        let done = sweep.run(0, &mut text, io.watch)?;
        let columns = sweep.columns();
        let rows: Vec<Vec<Value>> = text
            .split(|byte| *byte == b'\n')
            .filter(|line| !line.is_empty())
            .map(|line| {
                let row: serde_json::Map<String, Value> = serde_json::from_slice(line).unwrap_or_default();
                columns.iter().map(|name| row.get(name).cloned().unwrap_or_default()).collect()
            })
            .collect();
        let table = Arc::new(Table { columns: columns.clone(), rows: rows.clone() });
        let report = SweepReport { columns: &columns, rows: &rows, complete: done.is_complete() };
        io.show(&report, |out, style| {
            view::sweep::write(out, &self.with_units(&columns, &grid, &quantities), &rows, grid.axes.len(), style)?;
            if !done.is_complete() {
                writeln!(out, "stopped after {} of {} points", done.written, done.total)?;
            }
            Ok(())
        })?;
        self.swept = Some(table);
        Ok(())
    }
}

/// A sweep as the shell asks for it.
pub struct SweepRequest<'a> {
    /// `NAME=FROM:TO:STEP`, `NAME=FROM..TO/COUNT` or `NAME=VALUE`, up to three.
    pub axes: &'a [String],
    /// Part of it.
    pub shard: Option<Shard>,
    /// CSV or JSON lines; otherwise by the ending of `out`, or CSV.
    pub format: Option<Format>,
    /// File; otherwise the stream.
    pub out: Option<&'a Path>,
    /// Continue the file.
    pub resume: bool,
    /// Quantities with columns of their own, separated by commas.
    pub columns: Option<&'a str>,
}

impl Session {
    /// Sweeps over the present values into a file, or else into `stream`.
    ///
    /// # Errors
    /// An impossible grid, a file that cannot be written or belongs to another sweep.
    pub fn sweep_into(
        &self,
        request: &SweepRequest<'_>,
        stream: &mut dyn Write,
        watch: &dyn Watch,
    ) -> Result<Done, CommandError> {
        let axes = request.axes.iter().map(|axis| Axis::parse(axis)).collect::<Result<_, _>>()?;
        let grid = Grid::new(&self.now.scenario, axes)?;
        let ground = self.ground(watch)?;
        let quantities = self.columns(request.columns)?;
        let sweep = sweep::Sweep {
            case: ground.case(watch),
            grid: &grid,
            shard: request.shard.unwrap_or(Shard::WHOLE),
            format: match (request.format, request.out) {
                (Some(format), _) => format,
                (None, Some(path)) => format_of(path)?,
                (None, None) => Format::Csv,
            },
            quantities: &quantities,
        };
        match request.out {
            Some(path) => Ok(run_to_file(&sweep, path, request.resume, watch)?),
            None => {
                stream.write_all(sweep.preamble().as_bytes())?;
                Ok(sweep.run(0, stream, watch)?)
            }
        }
    }
}

/// Joins the shards of a sweep into `out`, or into the file `to`; the number of rows.
///
/// # Errors
/// Shards that do not make a whole; a place that cannot be written.
pub fn merge(
    files: &[PathBuf],
    to: Option<&Path>,
    out: &mut dyn Write,
    watch: &dyn Watch,
) -> Result<usize, CommandError> {
    let listed = files.to_vec();
    let shards = worker::run(watch, move |watch| Shards::open(&listed, watch))??;
    let Some(path) = to else {
        let mut buffer = std::io::BufWriter::new(out);
        shards.write(&mut buffer, watch)?;
        return Ok(shards.rows());
    };
    let mut result = Ok(());
    let written = atomic::write(path, |file| {
        result = shards.write(file, watch);
        match &result {
            Ok(()) => Ok(()),
            Err(error) => Err(std::io::Error::other(error.to_string())),
        }
    });
    result?;
    written.map_err(|error| CommandError::Refused(error.to_string()))?;
    Ok(shards.rows())
}

/// CSV or JSON by the ending of a file.
///
/// # Errors
/// Another ending.
pub fn format_of(path: &Path) -> Result<Format, CommandError> {
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("csv") => Ok(Format::Csv),
        Some("json" | "jsonl") => Ok(Format::Json),
        _ => Err(CommandError::Refused(format!("{} must end in .csv or .json", path.display()))),
    }
}

/// What a sweep into a file did.
pub fn done_sentence(done: &Done, path: &Path) -> String {
    let found = match done.found {
        0 => String::new(),
        found => format!(", {found} were there already"),
    };
    let rest = if done.is_complete() {
        "complete".to_owned()
    } else {
        let left = done.total - done.found - done.written;
        format!("stopped, {left} are left: the same command with --resume goes on")
    };
    format!("{} rows written to {}{found}; {rest}", done.written, path.display())
}

/// Reads `P A..B [N]` up to three times.
fn axes(words: &[String]) -> Result<Vec<Axis>, CommandError> {
    let form =
        || CommandError::Refused("sweep: expected PARAMETER A..B [N], e.g. `sweep f 0..1 21 F2 0..400`".to_owned());
    let mut axes = Vec::new();
    let mut rest = words;
    while let Some((name, after)) = rest.split_first() {
        let (range, after) = after.split_first().ok_or_else(form)?;
        let (from, to) = range.trim_start().split_once("..").ok_or_else(form)?;
        let number = |word: &str| {
            word.parse::<f64>()
                .ok()
                .filter(|value| value.is_finite())
                .ok_or_else(|| CommandError::Refused(format!("sweep: `{word}` is not a number")))
        };
        let (count, after) = match after.split_first() {
            Some((word, after)) if word.parse::<f64>().is_ok() => {
                let count = word
                    .parse::<usize>()
                    .map_err(|_| CommandError::Refused(format!("sweep: `{word}` is not a number of points")))?;
                (count, after)
            }
            _ => (POINTS, after),
        };
        axes.push(Axis::counted(name, number(from)?, number(to)?, count)?);
        rest = after;
    }
    Ok(axes)
}
