//! The source *lcp*: w = M z + q.

use std::collections::HashSet;
use std::path::Path;

use super::matrix_file;
use super::matrix_market::Size;
use super::reader::Cursor;
use super::words::quoted;
use crate::model::parameter::Number;
use crate::model::scenario::GivenLcp;
use crate::model::uses::Region;

/// Reads a bare LCP; `path` is the scenario file, for the file of M.
pub fn read(cursor: Cursor<'_>, path: Option<&Path>) -> Option<GivenLcp> {
    let fields = cursor.fields(&["M", "q", "covering", "names"])?;
    let rows = fields.required("M").and_then(|matrix| {
        if matrix.is_object() {
            let (matrix, _) = matrix_file::read(matrix, Size::Square, path)?;
            return Some((matrix.len(), Some(matrix)));
        }
        let rows = matrix.list()?;
        if rows.len() == 0 {
            matrix.problem("M is empty", "an lcp has at least one row");
            return None;
        }
        Some((rows.len(), square(matrix)))
    });
    let q = fields.required("q");
    let (count, matrix) = rows?;
    let like_m = "as many as M has rows";
    let q: Option<Vec<Number>> = q.and_then(|q| {
        let entries = q.list_of(count, like_m)?;
        let entries: Vec<_> = entries.map(|entry| entry.of(Region::Law).any_number()).collect();
        entries.into_iter().collect()
    });
    let covering = match fields.optional("covering") {
        Some(cursor) => {
            let entries = cursor.list_of(count, like_m)?;
            let entries: Vec<_> = entries.map(|entry| entry.positive("an entry of the covering vector")).collect();
            Some(entries.into_iter().collect::<Option<Vec<f64>>>()?)
        }
        None => None,
    };
    let names = match fields.optional("names") {
        Some(cursor) => names(cursor, count, like_m),
        None => Some((1..=count).map(|row| row.to_string()).collect()),
    };
    Some(GivenLcp { matrix: matrix?, q: q?, covering, names: names? })
}

/// A square matrix, row by row.
pub fn square(cursor: Cursor<'_>) -> Option<Vec<Vec<f64>>> {
    let rows = cursor.list()?;
    let count = rows.len();
    let what = format!("because the matrix has {count} rows and must be square");
    let rows: Vec<Option<Vec<f64>>> = rows.map(|row| row.numbers(count, &what)).collect();
    rows.into_iter().collect()
}

fn names(cursor: Cursor<'_>, count: usize, what: &str) -> Option<Vec<String>> {
    let mut seen = HashSet::new();
    let mut names = Vec::with_capacity(count);
    let mut is_right = true;
    for entry in cursor.list_of(count, what)? {
        let Some(name) = entry.string() else {
            is_right = false;
            continue;
        };
        // They stand in brackets in the names of variables, and are words of the command language.
        let plain = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '+' | '.');
        if name.is_empty() || !name.chars().all(plain) {
            entry.problem(
                format!("{} cannot name a row", quoted(name)),
                "names of rows are letters, digits, `_`, `-`, `+` and `.`",
            );
            is_right = false;
        } else if !seen.insert(name) {
            entry.problem(format!("duplicate name {}", quoted(name)), "every row has a name of its own");
            is_right = false;
        }
        names.push(name.to_string());
    }
    is_right.then_some(names)
}
