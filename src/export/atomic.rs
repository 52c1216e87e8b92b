//! A file is there whole or not at all.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::text::file::reason;

/// Writes what is to stand in a file: in a box, so that what follows is compiled once and not for each kind of content.
type Content<'a> = Box<dyn FnOnce(&mut dyn Write) -> io::Result<()> + 'a>;

/// A file that could not be written; the old one, if there was one, is untouched.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {}; {}", path.display(), reason(source), left(path))]
pub struct WriteError {
    /// The file.
    pub path: PathBuf,
    /// What the system said.
    #[source]
    pub source: io::Error,
}

/// What a failure leaves.
fn left(path: &Path) -> &'static str {
    if path.exists() { "the file is as it was before" } else { "nothing was written" }
}

/// Writes `path` by way of a temporary file in the same folder, renamed when everything has reached the disk.
/// An existing file keeps its permissions; a link keeps pointing to the file it points to, which is replaced.
///
/// # Errors
/// Whatever the system or `content` says; then `path` is as it was.
pub fn write(path: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), WriteError> {
    replace(path, Box::new(content)).map_err(|source| WriteError { path: path.to_owned(), source })
}

/// Writes a new file in the same way; one that is there already stays as it is.
///
/// # Errors
/// There is something of this name already; whatever the system or `content` says.
pub fn create(path: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), CreateError> {
    let there = |_| CreateError::There(path.to_owned());
    fs::symlink_metadata(path).map_or(Ok(()), |metadata| Err(there(metadata)))?;
    let failed = |source| CreateError::Failed { path: path.to_owned(), source };
    let file = written(path, Box::new(content), None).map_err(failed)?;
    // it may have come meanwhile
    file.persist_noclobber(path).map(drop).map_err(|error| match error.error.kind() {
        io::ErrorKind::AlreadyExists => CreateError::There(path.to_owned()),
        _ => failed(error.error),
    })
}

/// A new file that could not be written.
#[derive(Debug, thiserror::Error)]
pub enum CreateError {
    /// The name is taken.
    #[error("{} exists already and stays as it is: name another file, or move it away first", .0.display())]
    There(PathBuf),
    /// The system does not let it.
    #[error("cannot write {}: {}", path.display(), reason(source))]
    Failed {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
}

/// Why no temporary file can be made in `folder`, without the name of that file, which says nothing and differs from run
/// to run.
fn refusal(folder: &Path, error: &io::Error) -> io::Error {
    match fs::metadata(folder) {
        Err(missing) => missing,
        Ok(_) => io::Error::from(error.kind()),
    }
}

/// The file that a path stands for: the end of its links, also where nothing is there yet.
fn target(path: &Path) -> io::Result<PathBuf> {
    // as many links as the system follows
    const LINKS: usize = 40;
    let mut target = path.to_owned();
    for _ in 0..LINKS {
        match fs::symlink_metadata(&target) {
            Ok(metadata) if metadata.is_symlink() => {
                let next = fs::read_link(&target)?;
                // a relative link starts from the folder it stands in
                target = target.parent().unwrap_or(Path::new("")).join(next);
            }
            Ok(_) => return Ok(target),
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(target),
            Err(error) => return Err(error),
        }
    }
    // the error that the system has for it
    fs::canonicalize(path)
}

fn replace(path: &Path, content: Content<'_>) -> io::Result<()> {
    let target = target(path)?;
    let before = match fs::metadata(&target) {
        Ok(metadata) if metadata.is_file() => Some(metadata.permissions()),
        Ok(metadata) if metadata.is_dir() => return Err(io::Error::from(io::ErrorKind::IsADirectory)),
        // A pipe would wait for its reader; none of them can be there whole or not at all.
        Ok(_) => return Err(io::Error::other("it is a device or a pipe, expected a file")),
        Err(_) => None,
    };
    if before.as_ref().is_some_and(fs::Permissions::readonly) {
        return Err(io::Error::from(io::ErrorKind::PermissionDenied));
    }
    let file = written(&target, content, before)?;
    file.persist(&target).map_err(|error| error.error)?;
    Ok(())
}

/// The content in a temporary file beside `target`, with `permissions`, on the disk.
fn written(
    target: &Path,
    content: Content<'_>,
    permissions: Option<fs::Permissions>,
) -> io::Result<tempfile::NamedTempFile> {
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".stickslip-");
    // A new file gets what the user's umask leaves of rw-rw-rw-, as from any other program.
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder).map_err(|error| refusal(folder, &error))?;
    {
        let mut out = BufWriter::new(file.as_file_mut());
        content(&mut out)?;
        out.flush()?;
    }
    if let Some(permissions) = permissions {
        file.as_file().set_permissions(permissions)?;
    }
    file.as_file().sync_all()?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.csv");
        write(&path, |out| out.write_all(b"old")).expect("first");
        let failed = write(&path, |out| {
            out.write_all(b"half")?;
            Err(io::Error::other("disk full"))
        });
        assert!(failed.expect_err("fails").to_string().contains("disk full"));
        assert_eq!(fs::read(&path).expect("there"), b"old");
        assert_eq!(fs::read_dir(folder.path()).expect("folder").count(), 1);
    }

    #[test]
    fn a_new_file_takes_the_place_of_nothing() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.json");
        create(&path, |out| out.write_all(b"first")).expect("new");
        let error = create(&path, |_| unreachable!("nothing is asked for")).expect_err("there").to_string();
        assert!(error.contains("exists already"), "{error}");
        // one that comes while it is written
        let other = folder.path().join("b.json");
        let late = create(&other, |_| fs::write(&other, "theirs"));
        assert!(matches!(late, Err(CreateError::There(_))), "{late:?}");
        assert_eq!(fs::read(&path).expect("there"), b"first");
        assert_eq!(fs::read(&other).expect("there"), b"theirs");
        assert_eq!(fs::read_dir(folder.path()).expect("folder").count(), 2);
        let missing = create(&folder.path().join("no/such.json"), |_| Ok(())).expect_err("no folder").to_string();
        assert!(missing.contains("no/such.json") && !missing.contains(".stickslip-"), "{missing}");
    }

    #[test]
    #[cfg(unix)]
    fn permissions_and_links_are_kept() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.json");
        fs::write(&path, "old").expect("old");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).expect("mode");
        let link = folder.path().join("link");
        std::os::unix::fs::symlink(&path, &link).expect("link");
        write(&link, |out| out.write_all(b"new")).expect("written");
        assert_eq!(fs::read(&path).expect("there"), b"new");
        let mode = fs::metadata(&path).expect("there").permissions().mode();
        assert_eq!(mode & 0o777, 0o640);
        assert!(fs::symlink_metadata(&link).expect("link").is_symlink());
        // links to links, relative ones, and one to a file that is not there yet
        let (inner, outer) = (folder.path().join("inner"), folder.path().join("outer"));
        std::os::unix::fs::symlink("b.json", &inner).expect("link");
        std::os::unix::fs::symlink("inner", &outer).expect("link");
        write(&outer, |out| out.write_all(b"first")).expect("written");
        assert_eq!(fs::read(folder.path().join("b.json")).expect("there"), b"first");
        assert!([&inner, &outer].iter().all(|link| fs::symlink_metadata(link).expect("link").is_symlink()));
        let round = folder.path().join("round");
        std::os::unix::fs::symlink("round", &round).expect("link");
        assert!(write(&round, |_| Ok(())).is_err());
    }

    #[test]
    #[cfg(unix)]
    fn what_is_no_file_is_not_written_to() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let fifo = folder.path().join("fifo");
        assert!(std::process::Command::new("mkfifo").arg(&fifo).status().expect("mkfifo").success());
        for path in [&fifo, Path::new("/dev/null")] {
            let error = write(path, |_| unreachable!("nothing is asked for")).expect_err("no file").to_string();
            assert!(error.contains("a device or a pipe, expected a file"), "{error}");
        }
    }

    #[test]
    fn a_missing_folder_is_an_error_that_names_the_file() {
        let error = write(Path::new("/no/such/folder/x.csv"), |_| Ok(())).expect_err("fails");
        let text = error.to_string();
        assert!(text.contains("/no/such/folder/x.csv"), "{text}");
        assert!(!text.contains(".stickslip-"), "{text}");
    }
}
