//! Whether the K of a superelement can be a stiffness.

use super::assembly::given_entries;
use super::dof::Dofs;
use super::error::MainSystemError;
use super::factor::Factor;
use super::order::Places;
use super::sparse::SymmetricSparse;
use crate::model::structure::Structure;
use crate::watch::Watch;

/// An eigenvalue of K at unit diagonal may be this far below zero by rounding.
const INDEFINITE: f64 = 1e-9;

/// Refuses a K with an eigenvalue below −1e-9 after scaling to unit diagonal: it has a Cholesky factor once that much
/// is added to the diagonal, or it is indefinite.
///
/// # Errors
/// Indefinite; too large; interrupted.
pub fn refuse_indefinite(structure: &Structure, dofs: &Dofs, watch: &dyn Watch) -> Result<(), MainSystemError> {
    let Some(element) = &structure.superelement else { return Ok(()) };
    let mut diagonal = vec![0.0_f64; dofs.count()];
    given_entries(structure, dofs, |row, column, value| {
        if row == column {
            diagonal[row] = value;
        }
    });
    let shifted = |row: usize| if diagonal[row] > 0.0 { INDEFINITE * diagonal[row] } else { 1.0 };
    let k = SymmetricSparse::from_terms::<std::convert::Infallible>(
        dofs.count(),
        |count| {
            (0..dofs.count()).for_each(&mut *count);
            given_entries(structure, dofs, |_, column, _| count(column));
        },
        |push| {
            (0..dofs.count()).for_each(|row| push(row, row, shifted(row)));
            given_entries(structure, dofs, push);
            Ok(())
        },
    );
    let Ok(mut k) = k;
    let node: Vec<u32> = dofs.nodes().map(|node| node as u32).collect();
    let coordinates: Vec<[f64; 3]> = structure.nodes.iter().map(|node| node.position).collect();
    let places = Places { node: &node, coordinates: &coordinates, last: &vec![false; dofs.count()] };
    if Factor::new(&mut k, &[], places, 0, watch)?.is_shifted() {
        return Err(MainSystemError::Indefinite { file: element.file.clone() });
    }
    Ok(())
}
