//! The source *contact system*: CSM and CLV computed elsewhere.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use super::law::{LawKind, NUMBERS, per_pair};
use super::lcp::square;
use super::loads::{check_case_name, factor};
use super::matrix_file;
use super::matrix_market::Size;
use super::reader::{Cursor, Fields};
use super::words::{counted, is_id, quoted};
use crate::model::memory;
use crate::model::pair::Law;
use crate::model::parameter::Number;
use crate::model::scenario::{GivenContactSystem, GivenLoad};
use crate::model::uses::Region;

/// R may differ from its transpose by this much of its largest entry.
const SYMMETRY: f64 = 1e-8;

/// R z of a kernel vector may be this much of the largest entry of R times that of z.
const KERNEL: f64 = 1e-8;

/// Reads a contact system; `path` is the scenario file, for the file of the matrix.
pub fn read(cursor: Cursor<'_>, path: Option<&Path>) -> Option<GivenContactSystem> {
    let fields = cursor.fields(&[
        "pairs",
        "positions",
        "stiffness",
        "loads",
        "law",
        "friction",
        "cohesion",
        "gap",
        "bound",
        "kernel",
    ])?;
    let pairs = fields.required("pairs").and_then(pair_ids);
    let stiffness = fields.required("stiffness");
    let loads = fields.required("loads");
    // Everything else is measured by the number of pairs.
    let pairs = pairs?;
    let count = pairs.len();
    let positions = match fields.optional("positions") {
        Some(cursor) => Some(cursor.numbers(count, "one per pair")?),
        None => None,
    };
    let laws = laws(&fields, count);
    let stiffness = stiffness.and_then(|cursor| csm(cursor, count, path));
    let loads = loads.and_then(|cursor| load_cases(cursor, count));
    let kernel = match (fields.optional("kernel"), &stiffness) {
        (Some(cursor), Some(stiffness)) => Some(kernel(cursor, count, stiffness)?),
        _ => None,
    };
    Some(GivenContactSystem { pairs, positions, stiffness: stiffness?, loads: loads?, laws: laws?, kernel })
}

fn pair_ids(cursor: Cursor<'_>) -> Option<Vec<String>> {
    let mut seen = HashSet::new();
    let mut ids = Vec::new();
    let mut is_right = true;
    for entry in cursor.list()? {
        let Some(id) = entry.string() else {
            is_right = false;
            continue;
        };
        if !is_pair_id(id) {
            entry.problem(
                format!("{} cannot be the id of a pair", quoted(id)),
                "ids are letters, digits, `_` and `-`, starting with a letter; an index may follow: joint[0]",
            );
            is_right = false;
        } else if !seen.insert(id) {
            entry.problem(format!("duplicate id {}", quoted(id)), "every pair has an id of its own");
            is_right = false;
        }
        ids.push(id.to_string());
    }
    if ids.is_empty() && is_right {
        cursor.problem("there are no pairs", "name at least one");
        return None;
    }
    is_right.then_some(ids)
}

/// `c1`, and as the pairs of an edge are called, `joint[0]`.
fn is_pair_id(text: &str) -> bool {
    match text.strip_suffix(']').and_then(|rest| rest.split_once('[')) {
        Some((id, index)) => is_id(id) && !index.is_empty() && index.bytes().all(|byte| byte.is_ascii_digit()),
        None => is_id(text),
    }
}

fn csm(cursor: Cursor<'_>, pairs: usize, path: Option<&Path>) -> Option<Vec<Vec<f64>>> {
    let size = 2 * pairs;
    if let Some(refusal) = memory::refusal(memory::for_joints(size as f64)) {
        cursor.problem(format!("the contact system is too large: with {pairs} pairs it {refusal}"), "use fewer pairs");
        return None;
    }
    let (matrix, at): (_, Option<Cursor<'_>>) = if cursor.is_object() {
        let (matrix, at) = matrix_file::read(cursor, Size::OfPairs(pairs), path)?;
        (matrix, Some(at))
    } else {
        let rows = cursor.list()?.len();
        if rows != size {
            cursor.problem(
                format!(
                    "the matrix has {}, expected 2m = {size} for {}",
                    counted(rows, "row", "rows"),
                    counted(pairs, "pair", "pairs")
                ),
                "rows and columns: all normals, then all tangentials",
            );
            return None;
        }
        (square(cursor)?, None)
    };
    let largest = largest(&matrix);
    for (i, row) in matrix.iter().enumerate() {
        for (j, &a) in row.iter().enumerate().take(i) {
            let b = matrix[j][i];
            if (a - b).abs() > SYMMETRY * largest {
                at.unwrap_or(cursor).problem(
                    format!(
                        "the matrix is not symmetric: row {}, column {} is {a}, row {}, column {} is {b}",
                        i + 1,
                        j + 1,
                        j + 1,
                        i + 1
                    ),
                    "a contact stiffness matrix is symmetric: correct one of the two",
                );
                return None;
            }
        }
    }
    Some(matrix)
}

fn largest(matrix: &[Vec<f64>]) -> f64 {
    matrix.iter().flatten().fold(0.0_f64, |largest, entry| largest.max(entry.abs()))
}

fn load_cases(cursor: Cursor<'_>, pairs: usize) -> Option<Vec<GivenLoad>> {
    let mut cases = Vec::new();
    let mut is_right = true;
    for entry in cursor.entries()? {
        check_case_name(entry);
        let Some(fields) = entry.value().fields(&["factor", "vector"]) else {
            is_right = false;
            continue;
        };
        let factor = factor(&fields);
        let vector =
            fields.required("vector").and_then(|cursor| cursor.of(Region::Amount).numbers(2 * pairs, TWO_EACH));
        match (factor, vector) {
            (Some(factor), Some(vector)) => cases.push(GivenLoad { name: entry.name().to_string(), factor, vector }),
            _ => is_right = false,
        }
    }
    is_right.then_some(cases)
}

const TWO_EACH: &str = "all normals, then all tangentials";

fn kernel(cursor: Cursor<'_>, pairs: usize, stiffness: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let scale = largest(stiffness);
    let mut motions = Vec::new();
    let mut is_right = true;
    for entry in cursor.list()? {
        let Some(motion) = entry.numbers(2 * pairs, TWO_EACH) else {
            is_right = false;
            continue;
        };
        let size = motion.iter().fold(0.0_f64, |size, z| size.max(z.abs()));
        if size == 0.0 {
            entry.problem("this motion is zero", "remove it");
            is_right = false;
            continue;
        }
        let force = stiffness
            .iter()
            .map(|row| row.iter().zip(&motion).map(|(r, z)| r * (z / size)).sum::<f64>())
            .fold(0.0_f64, |force, row| force.max(row.abs()));
        if force > KERNEL * scale {
            entry.problem(
                format!(
                    "this motion is not in the kernel: R z reaches {:.3e} of the largest entry of R",
                    force / scale
                ),
                "`kernel` holds motions with R z = 0: correct it, or remove it",
            );
            is_right = false;
        }
        motions.push(motion);
    }
    is_right.then_some(motions)
}

fn laws(fields: &Fields<'_>, pairs: usize) -> Option<Vec<Law>> {
    let kinds: Option<Vec<LawKind>> = match fields.optional("law") {
        Some(cursor) => {
            let entries = cursor.list_of(pairs, "one per pair")?;
            let kinds: Vec<_> = entries.map(|entry| entry.choice(&LawKind::WORDS)).collect();
            kinds.into_iter().collect()
        }
        None => Some(vec![LawKind::Coulomb; pairs]),
    };
    let mut numbers: HashMap<&str, Vec<Number>> = HashMap::new();
    let mut is_right = true;
    for (key, _) in NUMBERS {
        let Some(cursor) = fields.optional(key) else {
            continue;
        };
        match per_pair(cursor, key, pairs, false) {
            Some(values) => {
                if let Some(kinds) = &kinds {
                    is_right &= only_where_taken(cursor, key, kinds, &values);
                }
                numbers.insert(key, values);
            }
            None => is_right = false,
        }
    }
    let kinds = kinds?;
    if kinds.contains(&LawKind::Bound) && fields.optional("bound").is_none() {
        fields.required("bound");
        return None;
    }
    if !is_right {
        return None;
    }
    let law = |(pair, kind): (usize, LawKind)| kind.with(|key| numbers.get(key).map(|values| values[pair].clone()));
    Some(kinds.into_iter().enumerate().map(law).collect())
}

/// Where a pair's law does not take the number, 0 stands in the list.
fn only_where_taken(cursor: Cursor<'_>, key: &str, kinds: &[LawKind], values: &[Number]) -> bool {
    let Some(entries) = cursor.list() else {
        return false;
    };
    let mut is_right = true;
    for ((entry, kind), value) in entries.zip(kinds).zip(values) {
        if !kind.takes(key) && *value != Number::Value(0.0) {
            entry.problem(
                format!("`{key}` does not belong to the law {} of this pair", kind.word()),
                "write 0 here, or change `law`",
            );
            is_right = false;
        }
    }
    is_right
}
