//! Files of sweeps: begun, continued after an interruption, and joined from shards.

use std::fs::{File, OpenOptions};
use std::io::{self, BufRead, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::sweep::{FORMAT, Format, Header, Sweep};
use super::sweep_run::Done;
use crate::text::file::reason;
use crate::watch::Watch;

/// A longer line stands in no file of a sweep.
const LONGEST_LINE: u64 = 1 << 20;

/// Why a file of a sweep cannot be written, continued or joined.
#[derive(Debug, thiserror::Error)]
pub enum SweepFileError {
    /// The system refuses.
    #[error("cannot read or write {path}: {}", reason(.error))]
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// The file is there already.
    #[error("{0} is there already: continue it with --resume, or remove it")]
    Exists(PathBuf),
    /// The file is not that of a sweep.
    #[error("{path} is not a file of a sweep: {why}")]
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
    /// A row that does not stand where it should, or not as it was written.
    #[error("{path}: row {row} is not as it was written at this place of the sweep; remove the file and begin again")]
    Row {
        /// The file.
        path: PathBuf,
        /// Which, from 1.
        row: usize,
    },
    /// The result of a merge cannot be written.
    #[error("cannot write the result: {}", reason(.0))]
    Output(io::Error),
    /// Shards that do not make a whole.
    #[error("{0}")]
    Shards(String),
    /// Someone asked to stop.
    #[error("interrupted: nothing was written")]
    Interrupted,
}

pub(super) fn failed(path: &Path) -> impl Fn(io::Error) -> SweepFileError + '_ {
    move |error| SweepFileError::Io { path: path.to_owned(), error }
}

/// Reads the next line into `line`; whether it is whole.
pub(super) fn next_line(reader: &mut dyn BufRead, line: &mut String) -> io::Result<bool> {
    line.clear();
    reader.take(LONGEST_LINE).read_line(line)?;
    if line.len() as u64 == LONGEST_LINE && !line.ends_with('\n') {
        return Err(io::Error::other(format!("a line has more than {LONGEST_LINE} bytes: no sweep wrote it")));
    }
    Ok(line.ends_with('\n'))
}

/// Reads the header line.
pub(super) fn read_header(path: &Path, line: &str) -> Result<(Header, Format), SweepFileError> {
    let no = |why: String| SweepFileError::NoSweep { path: path.to_owned(), why };
    let (text, format) = match line.strip_prefix("# ") {
        Some(text) => (text, Format::Csv),
        None => (line, Format::Json),
    };
    let header: Header = serde_json::from_str(text.trim_end())
        .map_err(|error| no(format!("its first line is not a header ({error})")))?;
    if header.format == "stickslip-sweep/1" {
        return Err(no(format!(
            "it is of an earlier version ({}), whose rows have no checksums; this one goes on with {FORMAT} only: run \
             the sweep again into another file",
            header.format
        )));
    }
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
    // The folder may be another one on another machine.
    let [name, wanted] = [found, expected].map(|header| {
        let name = Path::new(&header.scenario).file_name();
        name.map_or_else(|| header.scenario.clone(), |name| name.to_string_lossy().into_owned())
    });
    let pairs = [
        ("scenario", &name, &wanted),
        ("hash of the scenario, its files, values and rules", &found.hash, &expected.hash),
        ("version of the program", &found.version, &expected.version),
    ];
    for (what, a, b) in pairs {
        if a != b {
            return Some((what, a.clone(), b.clone()));
        }
    }
    if found.grid != expected.grid {
        return Some(("grid", found.grid.join(" "), expected.grid.join(" ")));
    }
    if found.points != expected.points {
        return Some(("number of points", found.points.to_string(), expected.points.to_string()));
    }
    if found.drawn != expected.drawn {
        let words = |header: &Header| serde_json::json!(header.drawn).to_string();
        return Some(("way of drawing", words(found), words(expected)));
    }
    let differ = found.quantities != expected.quantities;
    differ.then(|| ("list of quantities", found.quantities.join(", "), expected.quantities.join(", ")))
}

pub(super) fn same(path: &Path, found: &Header, expected: &Header) -> Result<(), SweepFileError> {
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
    if exists && !path.is_file() {
        return Err(SweepFileError::NoSweep { path: path.to_owned(), why: "it is not a regular file".to_owned() });
    }
    let mut file =
        OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path).map_err(failed(path))?;
    let (found, length) = if exists { scan(sweep, path, &file)? } else { (0, 0) };
    file.set_len(length).map_err(failed(path))?;
    file.seek(SeekFrom::End(0)).map_err(failed(path))?;
    let mut out = BufWriter::new(file);
    if length == 0 {
        out.write_all(sweep.preamble().as_bytes()).map_err(failed(path))?;
    }
    let done = sweep.run(found, &mut out, watch).map_err(failed(path))?;
    out.flush().and_then(|()| out.get_ref().sync_data()).map_err(failed(path))?;
    Ok(done)
}

/// Whole rows in a file of this sweep, and the length of the file up to the last of them.
fn scan(sweep: &Sweep<'_>, path: &Path, file: &File) -> Result<(usize, u64), SweepFileError> {
    let mut reader = BufReader::new(file);
    let expected = sweep.preamble();
    let mut length = 0u64;
    let mut line = String::new();
    let mut next = |line: &mut String| next_line(&mut reader, line).map_err(failed(path));
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
            return Err(SweepFileError::NoSweep { path: path.to_owned(), why: "its columns are different".to_owned() });
        }
        length += line.len() as u64;
    }
    let header = sweep.header();
    let points = sweep.shard.points(sweep.grid.len());
    let mut found = 0;
    while next(&mut line)? {
        let index = points.start + found;
        if found == points.len() || !header.is_row(index, sweep.format, &line) || !line.starts_with(&sweep.key(index)) {
            return Err(SweepFileError::Row { path: path.to_owned(), row: found + 1 });
        }
        found += 1;
        length += line.len() as u64;
    }
    Ok((found, length))
}
