//! Every change of an interactive session, written to disk as it happens, so that a crash loses nothing.
//!
//! A journal is a file of records, one JSON object a line, in the user's state directory. Each holds all values and
//! rules after a change, none a command that would be run again: a file that was saved over since, or a record that is
//! missing, cannot lead to other values. While its session lives the journal is locked; one that is not locked belongs
//! to a session that ended without `quit`.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::text::hash::Hash;

/// Format of the header line.
const FORMAT: &str = "stickslip-journal/2";

/// Opens a file of the state directory for writing at its end; nobody but the user may read it.
///
/// # Errors
/// Those of the system.
pub fn append_privately(path: &Path, new: bool) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.append(true).create(true).create_new(new);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    let file = options.open(path)?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // one that an earlier version made for everybody
        if file.metadata()?.permissions().mode() & 0o077 != 0 {
            file.set_permissions(fs::Permissions::from_mode(0o600))?;
        }
    }
    Ok(file)
}

/// First line of a journal.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Header {
    format: String,
    workplace: String,
}

/// What the user has chosen, as it is written down.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Chosen {
    /// Name or path of the scenario, as given.
    pub scenario: String,
    /// Whether it is a file; otherwise it is embedded.
    pub file: bool,
    /// Hash of its text.
    pub text: String,
    /// Every parameter that can be set.
    pub values: IndexMap<String, f64>,
    /// Covering, tie-break and engine, as `set` takes them.
    pub rules: Vec<String>,
}

/// One line of a journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Record {
    /// What the first change found.
    Start(Chosen),
    /// A change: the command as typed and what it led to.
    Change(String, Chosen),
    /// The last change was taken back.
    Undo,
    /// It was done again.
    Redo,
    /// Values and rules were saved: the scenario of this name is the session's from here on, also where changes are
    /// taken back.
    Saved(Chosen),
    /// `set auto`.
    Auto(bool),
}

/// The journal of a running session. The file is made at the first change.
#[derive(Debug)]
pub struct Journal {
    folder: PathBuf,
    workplace: String,
    file: Option<Open>,
    /// Whether a record could not be written since the last one that could.
    broken: bool,
}

#[derive(Debug)]
struct Open {
    file: File,
    path: PathBuf,
    /// Bytes that are known to be whole records.
    length: u64,
}

/// A journal left behind.
#[derive(Debug)]
pub struct LeftOver {
    path: PathBuf,
    /// Locked, so that two sessions do not restore the same one.
    _file: File,
    /// Its records, the first a [`Record::Start`].
    pub records: Vec<Record>,
}

impl LeftOver {
    /// How many changes it holds.
    pub fn changes(&self) -> usize {
        self.records.len().saturating_sub(1)
    }

    /// The scenario of its last change, as it was given.
    pub fn scenario(&self) -> Option<&str> {
        self.records.iter().rev().find_map(|record| match record {
            Record::Start(chosen) | Record::Change(_, chosen) | Record::Saved(chosen) => Some(chosen.scenario.as_str()),
            Record::Undo | Record::Redo | Record::Auto(_) => None,
        })
    }

    /// Removes it.
    pub fn discard(self) -> io::Result<()> {
        fs::remove_file(&self.path)
    }
}

impl Journal {
    /// A journal in `folder` (made if need be) for sessions working in `workplace`, usually the working directory.
    pub fn new(folder: &Path, workplace: &Path) -> Self {
        Journal {
            folder: folder.join("journals"),
            workplace: workplace.to_string_lossy().into_owned(),
            file: None,
            broken: false,
        }
    }

    fn key(&self) -> String {
        Hash::of(&self.workplace).short()
    }

    /// Appends records; on disk when this returns. At the beginning, and after records that could not be written, what
    /// was `before` them comes first.
    ///
    /// # Errors
    /// What the system says; the journal then holds what it held before.
    pub fn append(&mut self, before: impl FnOnce() -> Chosen, records: &[Record]) -> io::Result<()> {
        let broken = std::mem::replace(&mut self.broken, true);
        let (open, first) = match &mut self.file {
            Some(open) => (open, broken.then(|| Record::Change("what could not be written down".into(), before()))),
            None => {
                let open = create(&self.folder, &self.key(), &self.workplace)?;
                (self.file.insert(open), Some(Record::Start(before())))
            }
        };
        let mut lines = String::new();
        for record in first.iter().chain(records) {
            lines.push_str(&serde_json::to_string(record)?);
            lines.push('\n');
        }
        if broken {
            // a line that was cut off must not run into the next one
            open.file.set_len(open.length)?;
        }
        open.file.write_all(lines.as_bytes()).and_then(|()| open.file.sync_data())?;
        open.length += lines.len() as u64;
        self.broken = false;
        Ok(())
    }

    /// The newest journal of this workplace whose session is gone.
    pub fn left_over(&self) -> Option<LeftOver> {
        let key = self.key();
        let header = Header { format: FORMAT.to_owned(), workplace: self.workplace.clone() };
        let mut found: Vec<(std::time::SystemTime, PathBuf)> = fs::read_dir(&self.folder)
            .ok()?
            .flatten()
            .filter(|entry| entry.file_name().to_string_lossy().starts_with(&key))
            .filter_map(|entry| Some((entry.metadata().ok()?.modified().ok()?, entry.path())))
            .collect();
        found.sort();
        for (_, path) in found.into_iter().rev() {
            let Ok(file) = OpenOptions::new().read(true).write(true).open(&path) else {
                continue;
            };
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) | Err(TryLockError::Error(_)) => continue,
            }
            // bytes of a half-written last line may be no UTF-8
            let text = String::from_utf8_lossy(&fs::read(&path).unwrap_or_default()).into_owned();
            let mut lines = text.split_inclusive('\n');
            if lines.next().and_then(|line| serde_json::from_str(line).ok()).as_ref() != Some(&header) {
                continue;
            }
            // a last line without its end was cut off by the crash
            let whole = |line: &str| line.strip_suffix('\n').and_then(|line| serde_json::from_str(line).ok());
            let records: Vec<Record> = lines.map_while(whole).collect();
            if records.len() < 2 {
                let _ = fs::remove_file(&path);
                continue;
            }
            return Some(LeftOver { path, _file: file, records });
        }
        None
    }

    /// The session ended in order: nothing is left behind.
    pub fn close(&mut self) -> io::Result<()> {
        match self.file.take() {
            Some(open) => fs::remove_file(open.path),
            None => Ok(()),
        }
    }
}

/// A new journal, locked, with its header.
fn create(folder: &Path, key: &str, workplace: &str) -> io::Result<Open> {
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(folder)?;
    for attempt in 0..1000 {
        let path = folder.join(format!("{key}-{}-{attempt}.jsonl", std::process::id()));
        match append_privately(&path, true) {
            Ok(mut file) => {
                let header = Header { format: FORMAT.to_owned(), workplace: workplace.to_owned() };
                let line = format!("{}\n", serde_json::to_string(&header)?);
                // the name of the file has to reach the disk as well
                let made = file
                    .lock()
                    .and_then(|()| file.write_all(line.as_bytes()))
                    .and_then(|()| file.sync_all())
                    .and_then(|()| File::open(folder)?.sync_all());
                if let Err(error) = made {
                    let _ = fs::remove_file(&path);
                    return Err(error);
                }
                return Ok(Open { file, path, length: line.len() as u64 });
            }
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
    Err(io::Error::other("no free name for a journal"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(f: f64) -> Chosen {
        Chosen {
            scenario: "beam".into(),
            file: false,
            text: Hash::of("").long(),
            values: [("f".to_owned(), f)].into_iter().collect(),
            rules: ["cohesive", "lexicographic", "scheme"].map(str::to_owned).to_vec(),
        }
    }

    fn set(journal: &mut Journal, from: f64, to: f64) {
        journal.append(|| chosen(from), &[Record::Change(format!("set f {to}"), chosen(to))]).unwrap();
    }

    #[test]
    fn a_living_session_is_not_offered_and_a_dead_one_is() {
        let folder = tempfile::tempdir().unwrap();
        let place = Path::new("/somewhere");
        let mut journal = Journal::new(folder.path(), place);
        assert!(journal.left_over().is_none());
        set(&mut journal, 0.5, 0.1);
        set(&mut journal, 0.1, 0.30000000000000004);
        assert!(Journal::new(folder.path(), place).left_over().is_none());
        drop(journal);
        assert!(Journal::new(folder.path(), Path::new("/else")).left_over().is_none());
        let left = Journal::new(folder.path(), place).left_over().unwrap();
        let end = Record::Change("set f 0.30000000000000004".into(), chosen(0.1 + 0.2));
        assert_eq!((left.records.first(), left.records.last()), (Some(&Record::Start(chosen(0.5))), Some(&end)));
        assert_eq!(left.changes(), 2);
        left.discard().unwrap();
        assert!(Journal::new(folder.path(), place).left_over().is_none());
    }

    #[test]
    fn a_half_written_line_is_left_out_and_runs_into_no_other() {
        let folder = tempfile::tempdir().unwrap();
        let place = Path::new("/somewhere");
        let mut journal = Journal::new(folder.path(), place);
        set(&mut journal, 0.5, 0.1);
        // as on a full disk: half of a record, and an error
        journal.file.as_mut().unwrap().file.write_all(b"{\"change\":[\"set f 0.2\xff").unwrap();
        journal.broken = true;
        set(&mut journal, 0.2, 0.3);
        journal.file.as_mut().unwrap().file.write_all(b"{\"change\":[\"set f 0.4\xff").unwrap();
        drop(journal);
        let left = Journal::new(folder.path(), place).left_over().unwrap();
        let states: Vec<f64> = left
            .records
            .iter()
            .map(|record| match record {
                Record::Start(chosen) | Record::Change(_, chosen) => chosen.values["f"],
                other => panic!("{other:?}"),
            })
            .collect();
        assert_eq!(states, [0.5, 0.1, 0.2, 0.3]);
    }

    #[test]
    #[cfg(unix)]
    fn nobody_else_reads_it() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let mut journal = Journal::new(folder.path(), Path::new("/a"));
        set(&mut journal, 0.5, 0.1);
        let path = &journal.file.as_ref().unwrap().path;
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!((mode(path), mode(path.parent().unwrap())), (0o600, 0o700));
        // the same place has the same name in every build of the program
        assert!(path.file_name().unwrap().to_string_lossy().starts_with(&Hash::of("/a").short()));
    }

    #[test]
    fn a_closed_session_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let mut journal = Journal::new(folder.path(), Path::new("/a"));
        set(&mut journal, 0.5, 0.1);
        journal.close().unwrap();
        assert_eq!(fs::read_dir(folder.path().join("journals")).unwrap().count(), 0);
    }
}
