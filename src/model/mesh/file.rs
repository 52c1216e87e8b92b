//! The bytes of a mesh file, as far as they fit into memory together with what is made of them.

use std::io;
use std::path::Path;

use crate::model::memory;
use crate::text::file;

/// All bytes of a file.
///
/// # Errors
/// Those of reading; a file too large for the memory of this machine.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let bytes = file::read(path)?;
    match memory::refusal(memory::for_mesh(bytes.len())) {
        Some(refusal) => Err(io::Error::other(format!("it {refusal}"))),
        None => Ok(bytes),
    }
}
