//! A matrix that stands in a file of its own: `{ "file": "M.mtx" }`, relative to the scenario.

use std::path::Path;

use super::matrix_market::{self, Entries, MatrixError, Size};
use super::reader::Cursor;
use super::words::quoted;
use crate::text::file::{read_text, reason};

/// Reads the matrix that `cursor`, an object, names; also where the name stands.
pub fn read<'a>(cursor: Cursor<'a>, size: Size, path: Option<&Path>) -> Option<(Vec<Vec<f64>>, Cursor<'a>)> {
    let at = cursor.fields(&["file"])?.required("file")?;
    Some((named(at, path, |text| matrix_market::read(text, size))?, at))
}

/// Reads the entries of the matrix in the file that `at` names.
pub fn entries(at: Cursor<'_>, size: Size, path: Option<&Path>) -> Option<Entries> {
    named(at, path, |text| matrix_market::entries(text, size))
}

fn named<T>(at: Cursor<'_>, path: Option<&Path>, read: impl Fn(&str) -> Result<T, MatrixError>) -> Option<T> {
    let name = at.string()?;
    let Some(scenario) = path else {
        at.problem(
            "a scenario without a file of its own cannot name another file",
            "write the matrix out, or save the scenario to a file",
        );
        return None;
    };
    let file = scenario.parent().unwrap_or(Path::new("")).join(name);
    let text = match read_text(&file) {
        Ok(text) => text,
        Err(error) => {
            at.problem(
                format!("cannot read the matrix {}: {}", quoted(name), reason(&error)),
                "the file is looked for beside the scenario file",
            );
            return None;
        }
    };
    read(&text).map_err(|error| at.problem(format!("{name}:{}: {}", error.line, error.message), error.help)).ok()
}
