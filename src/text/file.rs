//! Files that others wrote, read with care: what never ends or does not fit into memory is an error.

use std::fs::{File, Metadata};
use std::io::{self, Read};
use std::path::Path;

/// Larger files hold no scenario, script or sweep that could be worked on: 10⁶ nodes take about 60 MB.
pub const LARGEST: u64 = 1 << 30;
/// Bytes read at once.
const PIECE: usize = 1 << 16;

/// What the system said, without its number: `permission denied`.
pub fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    let Some(code) = error.raw_os_error() else { return text };
    let text = text.strip_suffix(&format!(" (os error {code})")).unwrap_or(&text);
    let mut letters = text.chars();
    match (letters.next(), letters.clone().next()) {
        (Some(first), Some('a'..='z')) => first.to_lowercase().chain(letters).collect(),
        _ => text.to_owned(),
    }
}

fn refused(why: impl Into<String>) -> io::Error {
    io::Error::other(why.into())
}

/// Why something cannot be read to its end; `None` for a regular file and for a pipe.
fn refusal(metadata: &Metadata) -> Option<&'static str> {
    let kind = metadata.file_type();
    if kind.is_dir() {
        return Some("it is a folder");
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if kind.is_char_device() || kind.is_block_device() {
            return Some("it is a device, not a file or a pipe");
        }
    }
    None
}

/// Opens a file or a pipe for reading.
///
/// # Errors
/// Those of the system, and for anything that is neither.
pub fn open(path: &Path) -> io::Result<File> {
    // looked at by name first: some devices do something when they are opened
    if let Some(why) = refusal(&std::fs::metadata(path)?) {
        return Err(refused(why));
    }
    let file = File::open(path)?;
    match refusal(&file.metadata()?) {
        Some(why) => Err(refused(why)),
        None => Ok(file),
    }
}

/// The bytes of a file or a pipe, at most [`LARGEST`].
///
/// # Errors
/// Those of [`open`] and of reading; larger than [`LARGEST`], or than the memory that is left.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let file = open(path)?;
    let metadata = file.metadata()?;
    if metadata.is_file() && metadata.len() > LARGEST {
        return Err(too_large(LARGEST));
    }
    // A pipe, or a file that the system makes up as it is read, has length 0.
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(metadata.len() as usize).map_err(|_| no_room(0))?;
    read_up_to(LARGEST, file, bytes)
}

/// The text of a file or a pipe.
///
/// # Errors
/// Those of [`read`], and text that is not UTF-8.
pub fn read_text(path: &Path) -> io::Result<String> {
    text_of(read(path)?)
}

/// Bytes as text.
///
/// # Errors
/// They are not UTF-8.
pub fn text_of(bytes: Vec<u8>) -> io::Result<String> {
    String::from_utf8(bytes)
        .map_err(|error| refused(format!("it is not UTF-8 from byte {} on", error.utf8_error().valid_up_to() + 1)))
}

/// Everything `from` gives, at most [`LARGEST`] bytes.
///
/// # Errors
/// Those of reading; more than [`LARGEST`], or than the memory that is left.
pub fn read_all(from: impl Read) -> io::Result<Vec<u8>> {
    read_up_to(LARGEST, from, Vec::new())
}

fn read_up_to(largest: u64, mut from: impl Read, mut bytes: Vec<u8>) -> io::Result<Vec<u8>> {
    let mut piece = vec![0; PIECE];
    loop {
        let count = match from.read(&mut piece) {
            Ok(0) => return Ok(bytes),
            Ok(count) => count,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        };
        if (bytes.len() + count) as u64 > largest {
            return Err(too_large(largest));
        }
        bytes.try_reserve(count).map_err(|_| no_room(bytes.len()))?;
        bytes.extend_from_slice(&piece[..count]);
    }
}

fn no_room(read: usize) -> io::Error {
    refused(format!("the memory this process may use does not hold more than {read} bytes of it"))
}

fn too_large(largest: u64) -> io::Error {
    refused(format!("it has more than {} MiB", largest >> 20))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reason_has_no_number() {
        let missing = std::fs::File::open("/no/such/folder").unwrap_err();
        assert!(missing.raw_os_error().is_some());
        assert_eq!(reason(&missing), "no such file or directory");
        assert_eq!(reason(&refused("it is a folder")), "it is a folder");
    }

    #[test]
    #[cfg(unix)]
    fn devices_and_folders_are_refused() {
        for (path, why) in [("/dev/zero", "device"), ("/dev/null", "device"), ("/", "folder")] {
            let error = read(Path::new(path)).expect_err(path).to_string();
            assert!(error.contains(why), "{path}: {error}");
        }
    }

    #[test]
    fn what_never_ends_is_refused() {
        let error = read_up_to(3 << 20, io::repeat(b' '), Vec::new()).expect_err("endless").to_string();
        assert!(error.contains("3 MiB"), "{error}");
    }

    #[test]
    fn a_file_is_read_whole() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a");
        let text = "ü".repeat(PIECE);
        std::fs::write(&path, &text).expect("written");
        assert_eq!(read_text(&path).expect("read"), text);
        std::fs::write(&path, [b'a', 0xff]).expect("written");
        assert!(read_text(&path).expect_err("no text").to_string().contains("byte 2"));
    }
}
