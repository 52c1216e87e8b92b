//! The source *superelement*: K and F of another program, in place of elements and nodes.

use std::collections::HashMap;
use std::path::Path;

use super::builder::Builder;
use super::loads::{check_case_name, factor};
use super::matrix_file;
use super::matrix_market::{Entries, Size};
use super::reader::{Cursor, Entry};
use crate::model::structure::{Component, Load, LoadCase};
use crate::model::superelement::Superelement;

/// K may differ from its transpose by this much after scaling to unit diagonal.
const SYMMETRY: f64 = 1e-8;

/// Reads the superelement: its nodes, dofs, K and loads.
pub fn read<'d>(builder: &mut Builder<'d>, at: Cursor<'d>, path: Option<&Path>) -> Option<()> {
    let own = at.fields(&["stiffness", "loads", "nodes", "dofs"])?;
    builder.add_nodes(own.required("nodes"), "superelement.nodes");
    let dofs = own.required("dofs").and_then(|at| dofs(builder, at));
    let stiffness = own.required("stiffness").and_then(|at| at.fields(&["file"])?.required("file"));
    let dofs = dofs?;
    let loads = own.optional("loads").and_then(Cursor::entries).unwrap_or_default();
    for entry in loads {
        match load_case(entry, &dofs, path) {
            Some(case) => builder.structure.load_cases.push(case),
            None => {
                builder.broken.insert(entry.name());
            }
        }
    }
    let stiffness = stiffness?;
    let entries = matrix_file::entries(stiffness, Size::OfDofs(dofs.len()), path)?;
    let lower = lower_triangle(stiffness, entries)?;
    let name = stiffness.string().unwrap_or_default();
    // A node without a usable place was reported: any will do, as long as it is one.
    let mut nodes = builder.structure.nodes.clone();
    for coordinate in nodes.iter_mut().flat_map(|node| &mut node.position).filter(|coordinate| coordinate.is_nan()) {
        *coordinate = 0.0;
    }
    let (element, notes) = Superelement::new(builder.structure.dimension, &nodes, name, dofs, lower);
    builder.notes.extend(notes.into_iter().map(|note| format!("{name}: {note}")));
    builder.structure.superelement = Some(element);
    Some(())
}

/// The node and the component of each row.
fn dofs<'d>(builder: &Builder<'d>, at: Cursor<'d>) -> Option<Vec<(usize, Component)>> {
    let mut dofs = Vec::new();
    let mut row_of = HashMap::new();
    let mut is_right = true;
    let what = format!("a node and one of {}", builder.structure.dimension.quoted_words());
    for (row, entry) in at.list()?.enumerate() {
        let Some(words) = entry.list_of(2, &what) else {
            is_right = false;
            continue;
        };
        let words: Vec<Cursor<'d>> = words.collect();
        let (Some(node), Some(component)) = (builder.node(words[0]), words[1].component()) else {
            is_right = false;
            continue;
        };
        if let Some(first) = row_of.insert((node, component), row) {
            entry.problem(
                format!(
                    "{} of \"{}\" is named twice: rows {} and {}",
                    words[1].quoted(),
                    builder.node_id(node),
                    first + 1,
                    row + 1
                ),
                "every row of K is a displacement of its own",
            );
            is_right = false;
        }
        dofs.push((node, component));
    }
    if is_right && dofs.is_empty() {
        at.problem("there are no dofs", "name the node and the component of every row of K");
        return None;
    }
    is_right.then_some(dofs)
}

/// A load case from a file with one force for each dof.
fn load_case<'d>(entry: Entry<'d>, dofs: &[(usize, Component)], path: Option<&Path>) -> Option<LoadCase> {
    check_case_name(entry);
    let fields = entry.value().fields(&["file", "factor"])?;
    let factor = factor(&fields);
    let file = matrix_file::entries(fields.required("file")?, Size::Forces(dofs.len()), path)?;
    let mut loads: Vec<Load> = Vec::new();
    for (row, _, value) in file.entries.into_iter().filter(|(_, _, value)| *value != 0.0) {
        let (node, component) = dofs[row];
        let along = |wanted: Component| if component == wanted { value } else { 0.0 };
        loads.push(Load::Nodal {
            node,
            force: Component::TRANSLATIONS.map(along),
            moment: Component::ROTATIONS.map(along),
        });
    }
    Some(LoadCase { name: entry.name().to_owned(), factor: factor?, loads })
}

/// The lower triangle of a symmetric matrix without negative diagonal.
fn lower_triangle(at: Cursor<'_>, file: Entries) -> Option<Vec<(usize, usize, f64)>> {
    let name = at.string()?;
    let mut diagonal = vec![0.0; file.rows];
    for &(i, j, value) in &file.entries {
        if i == j {
            diagonal[i] = value;
        }
    }
    if let Some(row) = diagonal.iter().position(|value| *value < 0.0) {
        at.problem(
            format!(
                "{name}: row {0}, column {0} is {1}: a stiffness matrix is positive semidefinite",
                row + 1,
                diagonal[row]
            ),
            "a displacement costs no negative energy: correct the entry, or its sign",
        );
        return None;
    }
    let mut upper: HashMap<(usize, usize), f64> = HashMap::new();
    let mut lower: Vec<(usize, usize, f64)> = Vec::new();
    for (i, j, value) in file.entries.into_iter().filter(|(_, _, value)| *value != 0.0) {
        if i >= j {
            lower.push((i, j, value));
        } else {
            upper.insert((j, i), value);
        }
    }
    if !file.symmetric {
        let size = |i: usize, j: usize| (diagonal[i] * diagonal[j]).sqrt();
        let differ = |i: usize, j: usize, a: f64, b: f64| {
            at.problem(
                format!(
                    "{name}: the matrix is not symmetric: row {0}, column {1} is {a}, row {1}, column {0} is {b}",
                    i + 1,
                    j + 1
                ),
                "a stiffness matrix is symmetric: correct one of the two",
            );
        };
        for (i, j, value) in lower.iter_mut().filter(|(i, j, _)| i != j) {
            let other = upper.remove(&(*i, *j)).unwrap_or(0.0);
            if (*value - other).abs() > SYMMETRY * size(*i, *j) {
                differ(*i, *j, *value, other);
                return None;
            }
            if *value != other {
                *value = 0.5 * (*value + other);
            }
        }
        let mut left: Vec<((usize, usize), f64)> = upper.into_iter().collect();
        left.sort_by_key(|(place, _)| *place);
        for ((i, j), value) in left {
            if value.abs() > SYMMETRY * size(i, j) {
                differ(i, j, 0.0, value);
                return None;
            }
            lower.push((i, j, 0.5 * value));
        }
    }
    // |K_ij| ≤ √(K_ii K_jj), the first that a positive semidefinite matrix has to obey.
    let outside =
        lower.iter().find(|(i, j, value)| value.abs() > (1.0 + SYMMETRY) * (diagonal[*i] * diagonal[*j]).sqrt());
    if let Some(&(i, j, value)) = outside {
        at.problem(
            format!(
                "{name}: row {}, column {} is {value}, more than the diagonal {} and {} of its rows allows: a stiffness \
                 matrix is positive semidefinite",
                i + 1,
                j + 1,
                diagonal[i],
                diagonal[j]
            ),
            "correct the entry, or the diagonal",
        );
        return None;
    }
    Some(lower)
}
