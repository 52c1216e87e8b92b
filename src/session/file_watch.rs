//! The files of a scenario, looked at now and then: whoever saves one in another window sees it here.
//!
//! Looking again and again works over any file system, also where the machine that writes is another one. A file counts as
//! changed when its bytes do; one that is being written is left alone until it rests, and an empty or missing one, which
//! an editor may be about to write, for longer.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use super::shared::is_same;
use crate::model::scenario::Scenario;
use crate::text::file;
use crate::text::hash::Hash;

/// Between two looks: a change is seen, and seen to rest, within 0.15 s.
const LOOK: Duration = Duration::from_millis(50);
/// This many equal looks in a row mean that a file is at rest.
const REST: u32 = 2;
/// This many where the file is empty or missing: half a second.
const LONG_REST: u32 = 10;
/// A file system may date two changes within this time alike.
const COARSE: Duration = Duration::from_secs(2);
/// Files up to this size, in bytes, are read at every look while their date is that young.
const SMALL: u64 = 1 << 20;

/// What a file system says of a file without reading it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stamp {
    modified: Option<SystemTime>,
    length: u64,
    /// Another file of the same name, where the system numbers its files.
    number: u64,
}

impl Stamp {
    /// `None` where there is nothing now: an editor may be putting another file into its place.
    fn of(path: &Path) -> Option<Stamp> {
        let metadata = fs::metadata(path).ok()?;
        #[cfg(unix)]
        let number = std::os::unix::fs::MetadataExt::ino(&metadata);
        #[cfg(not(unix))]
        let number = 0;
        Some(Stamp { modified: metadata.modified().ok(), length: metadata.len(), number })
    }

    /// Whether it may look the same after another change.
    fn is_coarse(&self) -> bool {
        let age = self.modified.and_then(|modified| modified.elapsed().ok());
        self.length <= SMALL && age.is_none_or(|age| age < COARSE)
    }
}

/// One file, and what of it is known already.
#[derive(Debug)]
struct Look {
    path: PathBuf,
    /// The bytes that the session has, or was told of; `None` until the first look.
    known: Option<Hash>,
    stamp: Option<Stamp>,
    /// How many looks found the stamp as it was.
    rested: u32,
    /// Whether the stamp changed since the bytes were read.
    moved: bool,
    /// Whether it was told that there is no file.
    is_gone: bool,
}

impl Look {
    fn new(path: &Path, known: Option<Hash>) -> Look {
        Look { path: path.to_owned(), known, stamp: None, rested: 0, moved: true, is_gone: false }
    }

    /// Whether the file has come to rest with bytes that were not known, or is gone, or has come back.
    fn is_news(&mut self) -> bool {
        let stamp = Stamp::of(&self.path);
        if stamp != self.stamp {
            (self.stamp, self.rested, self.moved) = (stamp, 0, true);
        }
        self.rested = self.rested.saturating_add(1);
        let Some(stamp) = stamp else {
            // reported once
            return self.rested > LONG_REST && !std::mem::replace(&mut self.is_gone, true);
        };
        let rest = if stamp.length == 0 { LONG_REST } else { REST };
        if self.rested <= rest || !(self.moved || stamp.is_coarse()) {
            return false;
        }
        let Ok(bytes) = file::read(&self.path) else {
            return false;
        };
        // written on while it was read
        if Stamp::of(&self.path) != Some(stamp) {
            return false;
        }
        self.moved = false;
        let hash = Hash::default().and(&bytes);
        let before = self.known.replace(hash);
        let came_back = std::mem::take(&mut self.is_gone);
        came_back || before.is_some_and(|before| before != hash)
    }
}

#[derive(Default)]
struct Shared {
    aim: Mutex<Aim>,
    wake: Condvar,
}

#[derive(Default)]
struct Aim {
    scenario: Option<Arc<Scenario>>,
    looks: Vec<Look>,
    /// Whether there is news of this scenario that nobody has taken.
    news: bool,
    ends: bool,
}

/// Looks at the files of a scenario on a thread of its own, which sleeps while there is none.
pub struct FileWatch(Arc<Shared>);

impl FileWatch {
    /// `tell` is called each time one of the files has changed.
    ///
    /// # Errors
    /// The system has no thread.
    pub fn start(tell: impl Fn() + Send + 'static) -> io::Result<FileWatch> {
        let shared = Arc::new(Shared::default());
        let theirs = Arc::clone(&shared);
        std::thread::Builder::new().name("files".to_owned()).spawn(move || {
            let mut aim = theirs.aim.lock().unwrap_or_else(PoisonError::into_inner);
            while !aim.ends {
                if aim.looks.is_empty() {
                    aim = theirs.wake.wait(aim).unwrap_or_else(PoisonError::into_inner);
                    continue;
                }
                // each of them is looked at, also where the first one is news
                if aim.looks.iter_mut().fold(false, |news, look| look.is_news() | news) {
                    aim.news = true;
                    tell();
                }
                aim = theirs.wake.wait_timeout(aim, LOOK).unwrap_or_else(PoisonError::into_inner).0;
            }
        })?;
        Ok(FileWatch(shared))
    }

    /// Looks at the files of this scenario from now on; at none without one that has a file. What differs from the
    /// scenario already is news.
    pub fn aim(&self, scenario: Option<Arc<Scenario>>) {
        let mut aim = self.0.aim.lock().unwrap_or_else(PoisonError::into_inner);
        if is_same(&aim.scenario, &scenario) {
            return;
        }
        aim.looks = scenario.as_deref().map(looks).unwrap_or_default();
        aim.scenario = scenario;
        // what was reported of the one before may stand in this one already
        aim.news = false;
        self.0.wake.notify_one();
    }

    /// Whether there is news of the scenario aimed at; asking takes it.
    pub fn take_news(&self) -> bool {
        let mut aim = self.0.aim.lock().unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut aim.news)
    }
}

impl Drop for FileWatch {
    fn drop(&mut self) {
        self.0.aim.lock().unwrap_or_else(PoisonError::into_inner).ends = true;
        self.0.wake.notify_one();
    }
}

/// The file of a scenario, and the meshes it names.
fn looks(scenario: &Scenario) -> Vec<Look> {
    let Some(path) = scenario.path.as_deref() else {
        return Vec::new();
    };
    let own = Look::new(path, Some(Hash::of(&scenario.text)));
    let folder = path.parent().unwrap_or(Path::new(""));
    let meshes = scenario.meshes.0.keys().map(|name| Look::new(&folder.join(name), None));
    std::iter::once(own).chain(meshes).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::write;

    /// News within a few looks: the first sees a change, the next ones that it rests.
    fn news(look: &mut Look) -> bool {
        (0..=REST + 1).any(|_| look.is_news())
    }

    #[test]
    fn bytes_count_and_not_dates() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        write(&path, "one").unwrap();
        let mut look = Look::new(&path, Some(Hash::of("one")));
        assert!(!news(&mut look));
        write(&path, "one").unwrap();
        assert!(!news(&mut look));
        write(&path, "two").unwrap();
        assert!(news(&mut look) && !news(&mut look));
        // as an editor does that replaces the file, with nothing there for a moment
        fs::remove_file(&path).unwrap();
        assert!(!news(&mut look));
        write(folder.path().join("new"), "three").unwrap();
        fs::rename(folder.path().join("new"), &path).unwrap();
        assert!(news(&mut look) && !news(&mut look));
        // back to what it was before is news too: the screen may show the error of what was between
        write(&path, "one").unwrap();
        assert!(news(&mut look));
    }

    /// An editor that writes in place first cuts the file to nothing.
    #[test]
    fn an_empty_file_is_news_only_when_it_stays_empty() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        write(&path, "one").unwrap();
        let mut look = Look::new(&path, Some(Hash::of("one")));
        assert!(!news(&mut look));
        write(&path, "").unwrap();
        assert!(!(0..LONG_REST).any(|_| look.is_news()));
        write(&path, "two").unwrap();
        assert!(news(&mut look) && !news(&mut look));
        write(&path, "").unwrap();
        assert_eq!((0..3 * LONG_REST).filter(|_| look.is_news()).count(), 1);
    }

    #[test]
    fn a_file_that_is_gone_is_news_once_and_so_is_its_return() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        write(&path, "one").unwrap();
        let mut look = Look::new(&path, Some(Hash::of("one")));
        assert!(!news(&mut look));
        fs::remove_file(&path).unwrap();
        assert_eq!((0..3 * LONG_REST).filter(|_| look.is_news()).count(), 1);
        // with the same bytes: what was said of it holds no longer
        write(&path, "one").unwrap();
        assert!(news(&mut look) && !news(&mut look));
    }

    #[test]
    fn what_differed_from_the_beginning_is_news() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        write(&path, "new").unwrap();
        assert!(news(&mut Look::new(&path, Some(Hash::of("old")))));
        assert!(!news(&mut Look::new(&path, None)));
    }

    #[test]
    fn a_file_that_is_being_written_is_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        write(&path, "one").unwrap();
        let mut look = Look::new(&path, Some(Hash::of("one")));
        assert!(!news(&mut look));
        for length in 1..5 {
            write(&path, "x".repeat(length)).unwrap();
            assert!(!look.is_news(), "{length}");
        }
        assert!(news(&mut look));
    }
}
