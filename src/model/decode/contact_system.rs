//! The source *contact system*: CSM and CLV computed elsewhere.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use super::law::{NUMBERS, per_pair};
use super::lcp::square;
use super::loads::{check_case_name, factor};
use super::matrix_file;
use super::matrix_market::Size;
use super::reader::{Cursor, Fields};
use super::words::{counted, is_id, quoted};
use crate::model::dimension::Dimension;
use crate::model::memory;
use crate::model::pair::{Law, LawKind};
use crate::model::parameter::Number;
use crate::model::scenario::{GivenContactSystem, GivenLoad, GivenMatrix};
use crate::model::uses::Region;

/// R may differ from its transpose by this much after scaling to unit diagonal.
const SYMMETRY: f64 = 1e-8;

/// R z of a kernel vector may be this much of Σ √R_ii √R_kk |z_k|.
const KERNEL: f64 = 1e-8;

/// Rounding of an entry of an R that was computed in f64, as a share of the largest one.
const STORED: f64 = 256.0 * f64::EPSILON;

/// Reads a contact system; `path` is the scenario file, for the file of the matrix.
pub fn read(cursor: Cursor<'_>, path: Option<&Path>) -> Option<GivenContactSystem> {
    let fields = cursor.fields(&[
        "pairs",
        "tangents",
        "positions",
        "stiffness",
        "compliance",
        "loads",
        "law",
        "friction",
        "cohesion",
        "gap",
        "bound",
        "kernel",
    ])?;
    let pairs = fields.required("pairs").and_then(pair_ids);
    let matrix = matrix_of(&fields);
    let loads = fields.required("loads");
    // Everything else is measured by the number of pairs.
    let pairs = pairs?;
    let count = pairs.len();
    let in_space = fields.cursor().dimension() == Dimension::Space;
    let tangents = match fields.optional("tangents") {
        Some(at) => tangents(at, in_space)?,
        None => 1 + usize::from(in_space),
    };
    let order = Size::OfPairs { pairs: count, tangents }.order();
    let positions = match fields.optional("positions") {
        Some(cursor) => Some(cursor.numbers(count, "one per pair")?),
        None => None,
    };
    let laws = laws(&fields, count);
    let matrix = matrix.and_then(|(cursor, is_compliance)| {
        let rows = symmetric_matrix(cursor, (count, tangents), is_compliance, path)?;
        Some(if is_compliance { GivenMatrix::Compliance(rows) } else { GivenMatrix::Stiffness(rows) })
    });
    let loads = loads.and_then(|cursor| load_cases(cursor, (1 + tangents) * count, order));
    let kernel = match (fields.optional("kernel"), &matrix) {
        (Some(cursor), Some(GivenMatrix::Stiffness(rows))) => Some(kernel(cursor, order, rows)?),
        (Some(cursor), Some(GivenMatrix::Compliance(_))) => {
            cursor.problem(
                "`kernel` belongs to `stiffness`",
                "a compliance matrix exists only where every motion is resisted: remove `kernel`, or give `stiffness`",
            );
            return None;
        }
        _ => None,
    };
    Some(GivenContactSystem { pairs, tangents, positions, matrix: matrix?, loads: loads?, laws: laws?, kernel })
}

/// Tangential joints per pair; two where the file says that it lies in space.
fn tangents(cursor: Cursor<'_>, in_space: bool) -> Option<usize> {
    let found = cursor.whole("number of tangents", 1)?;
    if found < 2 && in_space {
        cursor.problem("a pair in space has 2 tangents, and `dimension` is 3", "write 2, or leave `dimension` out");
        return None;
    }
    if found > 2 {
        cursor.problem(
            format!("a pair cannot have {found} tangents"),
            "1 in the plane (2m rows), 2 in space (3m rows: all normals, then t1 and t2 of each pair)",
        );
        return None;
    }
    Some(found)
}

/// The matrix and whether it is a compliance; a problem where there is none or two.
fn matrix_of<'d>(fields: &Fields<'d>) -> Option<(Cursor<'d>, bool)> {
    match (fields.optional("stiffness"), fields.optional("compliance")) {
        (Some(_), Some(compliance)) => {
            compliance.problem("both `stiffness` and `compliance` are given", "give one of them: W = R⁻¹");
            None
        }
        (None, Some(compliance)) => Some((compliance, true)),
        // Without either the usual one is asked for.
        _ => fields.required("stiffness").map(|stiffness| (stiffness, false)),
    }
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

fn symmetric_matrix(
    cursor: Cursor<'_>,
    (pairs, tangents): (usize, usize),
    is_compliance: bool,
    path: Option<&Path>,
) -> Option<Vec<Vec<f64>>> {
    let size = (1 + tangents) * pairs;
    let expected = Size::OfPairs { pairs, tangents };
    if let Some(refusal) = memory::refusal(memory::for_joints(size as f64)) {
        cursor.problem(format!("the contact system is too large: with {pairs} pairs it {refusal}"), "use fewer pairs");
        return None;
    }
    let (matrix, at): (_, Option<Cursor<'_>>) = if cursor.is_object() {
        let (matrix, at) = matrix_file::read(cursor, expected, path)?;
        (matrix, Some(at))
    } else {
        let rows = cursor.list()?.len();
        if rows != size {
            cursor.problem(
                format!(
                    "the matrix has {}, expected {}m = {size} for {}",
                    counted(rows, "row", "rows"),
                    1 + tangents,
                    counted(pairs, "pair", "pairs")
                ),
                format!("rows and columns: {}", expected.order()),
            );
            return None;
        }
        (square(cursor)?, None)
    };
    let roots = diagonal_roots(&matrix);
    for (i, row) in matrix.iter().enumerate() {
        for (j, &a) in row.iter().enumerate().take(i) {
            let b = matrix[j][i];
            if (a - b).abs() > SYMMETRY * roots[i] * roots[j] {
                at.unwrap_or(cursor).problem(
                    format!(
                        "the matrix is not symmetric: row {}, column {} is {a}, row {}, column {} is {b}",
                        i + 1,
                        j + 1,
                        j + 1,
                        i + 1
                    ),
                    format!("a {} matrix is symmetric: correct one of the two", matrix_word(is_compliance)),
                );
                return None;
            }
        }
    }
    Some(matrix)
}

fn matrix_word(is_compliance: bool) -> &'static str {
    if is_compliance { "compliance" } else { "contact stiffness" }
}

/// √a_ii of every row, what scales the matrix to unit diagonal; of a row without a diagonal the smallest of the others,
/// 1 where there is none.
fn diagonal_roots(matrix: &[Vec<f64>]) -> Vec<f64> {
    let diagonal = || matrix.iter().enumerate().map(|(i, row)| row[i].abs()).filter(|entry| *entry > 0.0);
    let least = diagonal().fold(f64::INFINITY, f64::min);
    let least = if least.is_finite() { least } else { 1.0 };
    let root = |(i, row): (usize, &Vec<f64>)| if row[i] == 0.0 { least.sqrt() } else { row[i].abs().sqrt() };
    matrix.iter().enumerate().map(root).collect()
}

fn load_cases(cursor: Cursor<'_>, rows: usize, order: &str) -> Option<Vec<GivenLoad>> {
    let mut cases = Vec::new();
    let mut is_right = true;
    for entry in cursor.entries()? {
        check_case_name(entry);
        let Some(fields) = entry.value().fields(&["factor", "vector"]) else {
            is_right = false;
            continue;
        };
        let factor = factor(&fields);
        let vector = fields.required("vector").and_then(|cursor| cursor.of(Region::Amount).numbers(rows, order));
        match (factor, vector) {
            (Some(factor), Some(vector)) => cases.push(GivenLoad { name: entry.name().to_string(), factor, vector }),
            _ => is_right = false,
        }
    }
    is_right.then_some(cases)
}

fn kernel(cursor: Cursor<'_>, order: &str, stiffness: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let roots = diagonal_roots(stiffness);
    let largest = roots.iter().fold(0.0_f64, |largest, root| largest.max(root * root));
    let mut motions = Vec::new();
    let mut is_right = true;
    for entry in cursor.list()? {
        let Some(motion) = entry.numbers(stiffness.len(), order) else {
            is_right = false;
            continue;
        };
        let size = motion.iter().fold(0.0_f64, |size, z| size.max(z.abs()));
        if size == 0.0 {
            entry.problem("this motion is zero", "remove it");
            is_right = false;
            continue;
        }
        // |(R z)_i| / (√R_ii Σ √R_kk |z_k|), the worst of all rows. Where R was computed in f64 a joint that nothing
        // resists has rounding of the largest entry in its row: that is no stiffness.
        let terms: f64 = roots.iter().zip(&motion).map(|(root, z)| root * (z / size).abs()).sum();
        let force = (stiffness.iter().zip(&roots))
            .map(|(row, root)| {
                let force = row.iter().zip(&motion).map(|(r, z)| r * (z / size)).sum::<f64>().abs();
                if force <= STORED * largest { 0.0 } else { force / (root * terms) }
            })
            .fold(0.0_f64, f64::max);
        if force > KERNEL {
            entry.problem(
                format!("this motion is not in the kernel: R z reaches {force:.3e} of the terms it is summed from"),
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

/// Whether the list has 0 for every pair whose law does not take the number.
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
