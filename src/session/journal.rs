//! Every change of an interactive session, written to disk as it happens, so that a crash loses nothing.
//!
//! A journal is a file of commands in the user's state directory. While its session lives it is locked; a journal
//! that is not locked belongs to a session that ended without `quit`.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// First line of a journal.
const HEADER: &str = "# stickslip journal";

/// The user's state directory of this program: `$XDG_STATE_HOME/stickslip` or `~/.local/state/stickslip`; `None`
/// where neither variable is set to an absolute path.
pub fn state_directory() -> Option<PathBuf> {
    let absolute = |name: &str| std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    absolute("XDG_STATE_HOME")
        .or_else(|| absolute("HOME").map(|home| home.join(".local/state")))
        .map(|base| base.join("stickslip"))
}

/// The journal of a running session. The file is made at the first change.
#[derive(Debug)]
pub struct Journal {
    folder: PathBuf,
    workplace: String,
    /// Commands that bring the session to where its first change found it.
    opening: Vec<String>,
    file: Option<(File, PathBuf)>,
}

/// A journal left behind.
#[derive(Debug)]
pub struct LeftOver {
    path: PathBuf,
    /// Locked, so that two sessions do not restore the same one.
    _file: File,
    /// Its commands.
    pub commands: Vec<String>,
}

impl LeftOver {
    /// How many changes it holds; the first command only loads.
    pub fn changes(&self) -> usize {
        self.commands.len().saturating_sub(1)
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
            opening: Vec::new(),
            file: None,
        }
    }

    /// The commands written ahead of the first change.
    pub fn set_opening(&mut self, commands: Vec<String>) {
        self.opening = commands;
    }

    fn key(&self) -> String {
        let mut hasher = DefaultHasher::new();
        self.workplace.hash(&mut hasher);
        format!("{:016x}", hasher.finish())
    }

    /// Appends one command; on disk when this returns.
    pub fn append(&mut self, command: &str) -> io::Result<()> {
        if self.file.is_none() {
            self.file = Some(self.create()?);
        }
        let Some((file, _)) = &mut self.file else {
            return Ok(());
        };
        file.write_all(format!("{}\n", one_line(command)).as_bytes())?;
        file.flush()
    }

    fn create(&self) -> io::Result<(File, PathBuf)> {
        fs::create_dir_all(&self.folder)?;
        for attempt in 0..1000 {
            let path = self.folder.join(format!("{}-{}-{attempt}.stick", self.key(), std::process::id()));
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(mut file) => {
                    file.lock()?;
                    let mut head = format!("{HEADER} of {}\n", one_line(&self.workplace));
                    for command in &self.opening {
                        head.push_str(&one_line(command));
                        head.push('\n');
                    }
                    file.write_all(head.as_bytes())?;
                    return Ok((file, path));
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        Err(io::Error::other("no free name for a journal"))
    }

    /// The newest journal of this workplace whose session is gone.
    pub fn left_over(&self) -> Option<LeftOver> {
        let key = self.key();
        let head = format!("{HEADER} of {}", one_line(&self.workplace));
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
            if lines.next().map(str::trim_end) != Some(head.as_str()) {
                continue;
            }
            // a last line without its end was cut off by the crash
            let commands: Vec<String> = lines
                .filter(|line| line.ends_with('\n'))
                .map(|line| line.trim_end().to_owned())
                .filter(|line| !line.is_empty() && !line.starts_with('#'))
                .collect();
            if commands.len() < 2 {
                let _ = fs::remove_file(&path);
                continue;
            }
            return Some(LeftOver { path, _file: file, commands });
        }
        None
    }

    /// The session ended in order: nothing is left behind.
    pub fn close(&mut self) -> io::Result<()> {
        match self.file.take() {
            Some((_, path)) => fs::remove_file(path),
            None => Ok(()),
        }
    }
}

/// A command without line ends, which would break the journal's lines.
fn one_line(text: &str) -> String {
    text.replace(['\n', '\r'], " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_living_session_is_not_offered_and_a_dead_one_is() {
        let folder = tempfile::tempdir().unwrap();
        let place = Path::new("/somewhere");
        let mut journal = Journal::new(folder.path(), place);
        journal.set_opening(vec!["load beam".into()]);
        assert!(journal.left_over().is_none());
        journal.append("set F2 120").unwrap();
        journal.append("set f 0.3").unwrap();
        assert!(Journal::new(folder.path(), place).left_over().is_none());
        drop(journal);
        assert!(Journal::new(folder.path(), Path::new("/else")).left_over().is_none());
        let left = Journal::new(folder.path(), place).left_over().unwrap();
        assert_eq!(left.commands, ["load beam", "set F2 120", "set f 0.3"]);
        assert_eq!(left.changes(), 2);
        left.discard().unwrap();
        assert!(Journal::new(folder.path(), place).left_over().is_none());
    }

    #[test]
    fn a_half_written_line_is_left_out() {
        let folder = tempfile::tempdir().unwrap();
        let place = Path::new("/somewhere");
        let mut journal = Journal::new(folder.path(), place);
        journal.set_opening(vec!["load beam".into()]);
        journal.append("set F2 120").unwrap();
        let path = journal.file.as_ref().unwrap().1.clone();
        drop(journal);
        let mut file = OpenOptions::new().append(true).open(path).unwrap();
        file.write_all(b"set F2 1\xff").unwrap();
        drop(file);
        let left = Journal::new(folder.path(), place).left_over().unwrap();
        assert_eq!(left.commands, ["load beam", "set F2 120"]);
    }

    #[test]
    fn a_closed_session_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let mut journal = Journal::new(folder.path(), Path::new("/a"));
        journal.append("set F2 120").unwrap();
        journal.close().unwrap();
        assert_eq!(fs::read_dir(folder.path().join("journals")).unwrap().count(), 0);
    }
}
