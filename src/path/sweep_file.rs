//! Files of sweeps: begun, continued after an interruption, and joined from shards.

use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::grid::Shard;
use super::sweep::{Done, FORMAT, Format, Header, Sweep, preamble};
use crate::watch::Watch;

/// Why a file of a sweep cannot be written, continued or joined.
#[derive(Debug, thiserror::Error)]
pub enum SweepFileError {
    /// The system refuses.
    #[error("{path}: {error}")]
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        error: std::io::Error,
    },
    /// The file is there already.
    #[error("{0} is there already: continue it with --resume, or remove it")]
    Exists(PathBuf),
    /// The file is none of a sweep.
    #[error("{path} is no file of a sweep: {why}")]
    NoSweep {
        /// The file.
        path: PathBuf,
        /// Why.
        why: String,
    },
    /// The file belongs to another sweep.
    #[error("{path} belongs to another sweep: its {what} is {found}, here it is {expected}")]
    Another {
        /// The file.
        path: PathBuf,
        /// What differs.
        what: &'static str,
        /// There.
        found: String,
        /// Here.
        expected: String,
    },
    /// A row that does not stand where it should.
    #[error("{path}: row {row} is not the one of this place in the sweep; remove the file and begin again")]
    Row {
        /// The file.
        path: PathBuf,
        /// Which, from 1.
        row: usize,
    },
    /// The result of a merge cannot be written.
    #[error("cannot write the result: {0}")]
    Output(std::io::Error),
    /// Shards that do not make a whole.
    #[error("{0}")]
    Shards(String),
}

fn io(path: &Path) -> impl Fn(std::io::Error) -> SweepFileError + '_ {
    move |error| SweepFileError::Io { path: path.to_owned(), error }
}

/// Reads the header line.
fn read_header(path: &Path, line: &str) -> Result<(Header, Format), SweepFileError> {
    let no = |why: String| SweepFileError::NoSweep { path: path.to_owned(), why };
    let (text, format) = match line.strip_prefix("# ") {
        Some(text) => (text, Format::Csv),
        None => (line, Format::Json),
    };
    let header: Header =
        serde_json::from_str(text.trim_end()).map_err(|error| no(format!("its first line is no header ({error})")))?;
    if header.format != FORMAT {
        return Err(no(format!("its format is {}, expected {FORMAT}", header.format)));
    }
    if header.shard.number == 0 || header.shard.number > header.shard.of {
        return Err(no(format!("its shard is {}", header.shard)));
    }
    Ok((header, format))
}

/// The first difference of two headers, shards aside.
fn difference(found: &Header, expected: &Header) -> Option<(&'static str, String, String)> {
    let pairs = [
        ("scenario or values", &found.hash, &expected.hash),
        ("version of the program", &found.version, &expected.version),
    ];
    for (what, a, b) in pairs {
        if a != b {
            return Some((what, a.clone(), b.clone()));
        }
    }
    (found.grid != expected.grid).then(|| ("grid", found.grid.join(" "), expected.grid.join(" ")))
}

fn same(path: &Path, found: &Header, expected: &Header) -> Result<(), SweepFileError> {
    match difference(found, expected) {
        None => Ok(()),
        Some((what, found, expected)) => Err(SweepFileError::Another { path: path.to_owned(), what, found, expected }),
    }
}

/// Runs a sweep into a file. With `resume` a file that an earlier run left is continued after its last whole row.
///
/// # Errors
/// See [`SweepFileError`].
pub fn run_to_file(sweep: &Sweep<'_>, path: &Path, resume: bool, watch: &dyn Watch) -> Result<Done, SweepFileError> {
    let exists = path.exists();
    if exists && !resume {
        return Err(SweepFileError::Exists(path.to_owned()));
    }
    let mut file =
        OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path).map_err(io(path))?;
    let (found, length) = if exists { scan(sweep, path, &file)? } else { (0, 0) };
    file.set_len(length).map_err(io(path))?;
    file.seek(SeekFrom::End(0)).map_err(io(path))?;
    let mut out = BufWriter::new(file);
    if length == 0 {
        out.write_all(sweep.preamble().as_bytes()).map_err(io(path))?;
    }
    let done = sweep.run(found, &mut out, watch).map_err(io(path))?;
    out.flush().map_err(io(path))?;
    Ok(done)
}

/// Whole rows in a file of this sweep, and the length of the file up to the last of them.
fn scan(sweep: &Sweep<'_>, path: &Path, file: &File) -> Result<(usize, u64), SweepFileError> {
    let mut reader = BufReader::new(file);
    let expected = sweep.preamble();
    let mut length = 0u64;
    let mut line = String::new();
    let mut next = |line: &mut String| -> Result<bool, SweepFileError> {
        line.clear();
        reader.read_line(line).map_err(io(path))?;
        Ok(line.ends_with('\n'))
    };
    for (k, wanted) in expected.split_inclusive('\n').enumerate() {
        let whole = next(&mut line)?;
        if !whole && wanted.starts_with(line.as_str()) {
            // Cut off before the first row: begin again.
            return Ok((0, 0));
        }
        if k == 0 && line != wanted {
            let (header, format) = read_header(path, &line)?;
            let mine = sweep.header();
            same(path, &header, &mine)?;
            let (what, found, expected) = if header.shard == mine.shard {
                ("format", format!("{format:?}"), format!("{:?}", sweep.format))
            } else {
                ("shard", header.shard.to_string(), mine.shard.to_string())
            };
            return Err(SweepFileError::Another { path: path.to_owned(), what, found, expected });
        }
        if line != wanted {
            return Err(SweepFileError::NoSweep { path: path.to_owned(), why: "its columns are others".to_owned() });
        }
        length += line.len() as u64;
    }
    let points = sweep.shard.points(sweep.grid.len());
    let mut found = 0;
    while next(&mut line)? {
        if found == points.len() || !line.starts_with(&sweep.key(points.start + found)) {
            return Err(SweepFileError::Row { path: path.to_owned(), row: found + 1 });
        }
        found += 1;
        length += line.len() as u64;
    }
    Ok((found, length))
}

/// Joins the shards of a sweep into what one run of the whole would have written; returns the number of rows.
///
/// # Errors
/// Files of different sweeps, a shard that is missing, there twice, or incomplete.
pub fn merge(files: &[PathBuf], out: &mut dyn Write) -> Result<usize, SweepFileError> {
    let mut shards: Vec<(Header, Format, &PathBuf)> = Vec::new();
    for path in files {
        let mut line = String::new();
        BufReader::new(File::open(path).map_err(io(path))?).read_line(&mut line).map_err(io(path))?;
        let (header, format) = read_header(path, &line)?;
        if let Some((first, other, _)) = shards.first() {
            same(path, &header, first)?;
            let differs = if format == *other {
                (header.shard.of != first.shard.of)
                    .then(|| ("number of shards", header.shard.of.to_string(), first.shard.of.to_string()))
            } else {
                Some(("format", format!("{format:?}"), format!("{other:?}")))
            };
            if let Some((what, found, expected)) = differs {
                return Err(SweepFileError::Another { path: path.clone(), what, found, expected });
            }
        }
        shards.push((header, format, path));
    }
    shards.sort_by_key(|(header, ..)| header.shard.number);
    let Some((first, format, _)) = shards.first().cloned() else {
        return Err(SweepFileError::Shards("there is nothing to merge: name the files".to_owned()));
    };
    for pair in shards.windows(2) {
        if pair[0].0.shard == pair[1].0.shard {
            return Err(SweepFileError::Shards(format!(
                "shard {} is there twice: {} and {}",
                pair[0].0.shard,
                pair[0].2.display(),
                pair[1].2.display()
            )));
        }
    }
    let missing: Vec<String> = (1..=first.shard.of)
        .filter(|number| shards.iter().all(|(header, ..)| header.shard.number != *number))
        .map(|number| number.to_string())
        .collect();
    if !missing.is_empty() {
        return Err(SweepFileError::Shards(format!("shard {} of {} is missing", missing.join(", "), first.shard.of)));
    }
    let mut rows = 0;
    for (k, (header, _, path)) in shards.iter().enumerate() {
        let mut reader = BufReader::new(File::open(path).map_err(io(path))?);
        let mut line = String::new();
        reader.read_line(&mut line).map_err(io(path))?;
        let mut columns = String::new();
        if format == Format::Csv {
            reader.read_line(&mut columns).map_err(io(path))?;
        }
        if k == 0 {
            let whole = Header { shard: Shard::WHOLE, ..header.clone() };
            let columns: Vec<String> = columns.trim_end().split(',').map(str::to_owned).collect();
            let text = preamble(&whole, format, &columns);
            out.write_all(text.as_bytes()).map_err(SweepFileError::Output)?;
        }
        let expected = header.shard.points(header.points).len();
        let mut found = 0;
        loop {
            line.clear();
            reader.read_line(&mut line).map_err(io(path))?;
            if !line.ends_with('\n') {
                break;
            }
            found += 1;
            out.write_all(line.as_bytes()).map_err(SweepFileError::Output)?;
        }
        if found != expected || !line.is_empty() {
            return Err(SweepFileError::Shards(format!(
                "{} is not complete: {found} of {expected} rows; run shard {} again with --resume",
                path.display(),
                header.shard
            )));
        }
        rows += found;
    }
    out.flush().map_err(SweepFileError::Output)?;
    Ok(rows)
}
