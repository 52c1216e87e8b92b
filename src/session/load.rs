//! Files read on a thread beside the session: a pipe that nobody writes into, or a file that takes long to read, is
//! given up at Ctrl-C.

use std::path::{Path, PathBuf};

use crate::model::mesh::overview::Overview;
use crate::model::mesh::{self, Mesh};
use crate::model::problem::Problems;
use crate::model::scenario::Scenario;
use crate::model::{catalog, load};
use crate::text::file;
use crate::watch::Watch;

use super::{CommandError, worker};

fn on_a_thread(
    watch: &dyn Watch,
    load: impl FnOnce() -> Result<Scenario, Problems> + Send + 'static,
) -> Result<Scenario, CommandError> {
    worker::run(watch, move |_| load())?.map_err(CommandError::Scenario)
}

/// What a user names: an embedded scenario, or a file.
///
/// # Errors
/// Problems of the scenario, an interruption.
pub fn scenario(word: &str, watch: &dyn Watch) -> Result<Scenario, CommandError> {
    let word = word.to_owned();
    on_a_thread(watch, move || catalog::load_named_or_file(&word))
}

/// A scenario from stdin.
///
/// # Errors
/// Problems of the scenario, an interruption.
pub fn stdin(watch: &dyn Watch) -> Result<Scenario, CommandError> {
    on_a_thread(watch, load::load_stdin)
}

/// A scenario in a file.
///
/// # Errors
/// Problems of the scenario, an interruption.
pub fn file(path: &Path, watch: &dyn Watch) -> Result<Scenario, CommandError> {
    let path = path.to_owned();
    on_a_thread(watch, move || load::load_file(&path))
}

/// A mesh file by itself, and what it holds.
///
/// # Errors
/// What is wrong with it, an interruption.
pub fn mesh(word: &str, watch: &dyn Watch) -> Result<(Mesh, Overview), CommandError> {
    let word = word.to_owned();
    let read = worker::run(watch, move |_| {
        let mesh = mesh::read(Path::new(&word), &word).map_err(|found| mesh::as_problems(&word, found))?;
        let overview = Overview::of(&mesh);
        Ok((mesh, overview))
    });
    read?.map_err(CommandError::Scenario)
}

/// The text of a script; `None` for stdin.
///
/// # Errors
/// It cannot be read or is not UTF-8; an interruption.
pub fn script(path: Option<&Path>, watch: &dyn Watch) -> Result<String, CommandError> {
    let path = path.map(Path::to_owned);
    worker::run(watch, move |_| {
        let read = match &path {
            Some(path) => file::read_text(path),
            None => file::read_all(std::io::stdin().lock()).and_then(file::text_of),
        };
        let path = path.unwrap_or_else(|| PathBuf::from("stdin"));
        read.map_err(|source| CommandError::File { doing: "read the script", path, source })
    })?
}
