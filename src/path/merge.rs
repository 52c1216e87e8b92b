//! The shards of a sweep joined into what one run would have written. Everything is looked at before anything is
//! written.

use std::io::{BufRead, BufReader, Cursor, Write};
use std::path::{Path, PathBuf};

use super::grid::{AXES, Axis, Grid, Shard};
use super::sample::draw::Draw;
use super::sample::variable;
use super::sweep::{Format, Header, columns_line, header_line, key};
use super::sweep_file::{SweepFileError, failed, next_line, read_header, same};
use crate::text::file;
use crate::watch::Watch;

/// Rows between two looks at whether to stop.
const LOOK: usize = 1024;

/// Where the rows of a shard come from.
enum Source {
    /// A file, read a second time when it is written out.
    File,
    /// What came through a pipe, which cannot be read twice.
    Bytes(Vec<u8>),
}

/// The file of one shard.
struct Part {
    path: PathBuf,
    source: Source,
    header: Header,
    format: Format,
    /// Second line of a CSV.
    columns: String,
}

/// All shards of a sweep, in their order, each found whole and unaltered.
pub struct Shards {
    parts: Vec<Part>,
    /// The points that their headers state.
    grid: Grid,
}

impl Source {
    fn reader(&self, path: &Path) -> Result<Box<dyn BufRead + '_>, SweepFileError> {
        Ok(match self {
            Source::File => Box::new(BufReader::new(file::open(path).map_err(failed(path))?)),
            Source::Bytes(bytes) => Box::new(Cursor::new(bytes)),
        })
    }
}

impl Part {
    fn open(path: &Path) -> Result<Part, SweepFileError> {
        let source = match path.is_file() {
            true => Source::File,
            false => Source::Bytes(file::read(path).map_err(failed(path))?),
        };
        let mut reader = source.reader(path)?;
        let mut line = String::new();
        next_line(&mut *reader, &mut line).map_err(failed(path))?;
        let (header, format) = read_header(path, &line)?;
        let mut columns = String::new();
        if format == Format::Csv {
            next_line(&mut *reader, &mut columns).map_err(failed(path))?;
            if columns != columns_line(&header.columns()) {
                return Err(SweepFileError::NoSweep {
                    path: path.to_owned(),
                    why: "its columns are different".to_owned(),
                });
            }
        }
        drop(reader);
        Ok(Part { path: path.to_owned(), source, header, format, columns })
    }

    fn points(&self) -> std::ops::Range<usize> {
        self.header.shard.points(self.header.points)
    }

    /// Hands every row to `take`, each found as it was written, at its point of `grid`.
    fn rows(
        &self,
        grid: &Grid,
        watch: &dyn Watch,
        take: &mut dyn FnMut(&str) -> std::io::Result<()>,
    ) -> Result<(), SweepFileError> {
        let path = &self.path;
        let mut reader = self.source.reader(path)?;
        let mut line = String::new();
        for _ in 0..if self.format == Format::Csv { 2 } else { 1 } {
            next_line(&mut *reader, &mut line).map_err(failed(path))?;
        }
        let points = self.points();
        let mut found = 0;
        while next_line(&mut *reader, &mut line).map_err(failed(path))? {
            let index = points.start + found;
            if found == points.len()
                || !self.header.is_row(index, self.format, &line)
                || !line.starts_with(&key(grid, self.format, index))
            {
                return Err(SweepFileError::Row { path: path.clone(), row: found + 1 });
            }
            take(&line).map_err(SweepFileError::Output)?;
            found += 1;
            if found % LOOK == 0 && watch.stop() {
                return Err(SweepFileError::Interrupted);
            }
        }
        if found != points.len() || !line.is_empty() {
            return Err(SweepFileError::Shards(format!(
                "{} is not complete: {found} of {} rows; run shard {} again with --resume",
                path.display(),
                points.len(),
                self.header.shard
            )));
        }
        Ok(())
    }
}

impl Shards {
    /// Opens the files of all shards of a sweep, in any order.
    ///
    /// # Errors
    /// Files of different sweeps, a shard that is missing, there twice, incomplete or altered.
    pub fn open(files: &[PathBuf], watch: &dyn Watch) -> Result<Shards, SweepFileError> {
        let mut parts: Vec<Part> = Vec::new();
        for path in files {
            let part = Part::open(path)?;
            if let Some(first) = parts.first() {
                same(path, &part.header, &first.header)?;
                let differs = if part.format == first.format {
                    let (found, expected) = (part.header.shard.of, first.header.shard.of);
                    (found != expected).then(|| ("number of shards", found.to_string(), expected.to_string()))
                } else {
                    Some(("format", format!("{:?}", part.format), format!("{:?}", first.format)))
                };
                if let Some((what, found, expected)) = differs {
                    return Err(SweepFileError::Another { path: path.clone(), what, found, expected });
                }
            }
            parts.push(part);
        }
        parts.sort_by_key(|part| part.header.shard.number);
        is_whole(&parts)?;
        let grid = grid_of(&parts[0])?;
        for part in &parts {
            part.rows(&grid, watch, &mut |_| Ok(()))?;
        }
        Ok(Shards { parts, grid })
    }

    /// Rows of the whole.
    pub fn rows(&self) -> usize {
        self.parts.iter().map(|part| part.points().len()).sum()
    }

    /// Writes what one run would have written.
    ///
    /// # Errors
    /// `out` does not take it; a file was altered meanwhile.
    pub fn write(&self, out: &mut dyn Write, watch: &dyn Watch) -> Result<(), SweepFileError> {
        if let Some(first) = self.parts.first() {
            let whole = Header { shard: Shard::WHOLE, ..first.header.clone() };
            let head = format!("{}{}", header_line(&whole, first.format), first.columns);
            out.write_all(head.as_bytes()).map_err(SweepFileError::Output)?;
        }
        for part in &self.parts {
            part.rows(&self.grid, watch, &mut |line| out.write_all(line.as_bytes()))?;
        }
        out.flush().map_err(SweepFileError::Output)
    }
}

/// The grid that the header of a part states, with as many points as it says.
fn grid_of(part: &Part) -> Result<Grid, SweepFileError> {
    let no = |why: String| SweepFileError::NoSweep { path: part.path.clone(), why };
    let Header { grid, points, drawn, .. } = &part.header;
    if let Some(rule) = drawn {
        let variables = grid.iter().map(|text| variable(text)).collect::<Result<_, _>>().map_err(no)?;
        return Ok(Grid::of_draw(Draw { variables, rule: rule.clone(), count: *points }));
    }
    if grid.is_empty() || grid.len() > AXES {
        return Err(no(format!("its header tells {} ranges, expected 1 to {AXES}", grid.len())));
    }
    let axes: Result<Vec<Axis>, _> = grid.iter().map(|range| Axis::parse(range)).collect();
    let axes = axes.map_err(|error| no(error.to_string()))?;
    let found: f64 = axes.iter().map(|axis| axis.values.len() as f64).product();
    if found != *points as f64 {
        return Err(no(format!("its header tells {points} points, and its grid {} has {found}", grid.join(" "))));
    }
    Ok(Grid { axes, drawn: None })
}

/// Whether every shard is there, once.
fn is_whole(parts: &[Part]) -> Result<(), SweepFileError> {
    let Some(first) = parts.first() else {
        return Err(SweepFileError::Shards("there is nothing to merge: name the files".to_owned()));
    };
    for pair in parts.windows(2) {
        if pair[0].header.shard == pair[1].header.shard {
            return Err(SweepFileError::Shards(format!(
                "shard {} is there twice: {} and {}",
                pair[0].header.shard,
                pair[0].path.display(),
                pair[1].path.display()
            )));
        }
    }
    let of = first.header.shard.of;
    let missing: Vec<String> = (1..=of)
        .filter(|number| parts.iter().all(|part| part.header.shard.number != *number))
        // a claim of many shards is not believed so far as to list them
        .take(10)
        .map(|number| number.to_string())
        .collect();
    if missing.is_empty() {
        return Ok(());
    }
    let more = if of - parts.len() > missing.len() { ", …" } else { "" };
    Err(SweepFileError::Shards(format!("shard {}{more} of {of} is missing", missing.join(", "))))
}
