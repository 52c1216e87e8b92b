//! K and F of a structure as they are assembled, for other programs.

use super::assembly::assemble;
use super::dof::Dofs;
use super::error::MainSystemError;
use super::loads::load_vectors;
use crate::model::structure::{Component, Structure};
use crate::watch::Watch;

/// K of the elements and F of the load cases, with neither supports nor ties, springs nor joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrices {
    /// Node and component of each row.
    pub dofs: Vec<(usize, Component)>,
    /// Lower triangle of K: (row, column, value), row ≥ column, none of them 0, by columns.
    pub stiffness: Vec<(usize, usize, f64)>,
    /// F of each load case for a factor of 1, without settlements.
    pub forces: Vec<Vec<f64>>,
}

/// Assembles K and F.
///
/// # Errors
/// An element without stiffness because of its shape; a moment where there is no rotation; interrupted.
pub fn matrices(structure: &Structure, watch: &dyn Watch) -> Result<Matrices, MainSystemError> {
    // A spring may hold a rotation that no element has.
    let dofs = Dofs::new(structure);
    let bare = Structure { springs: Vec::new(), ..structure.clone() };
    let k = assemble::<f64>(&bare, &dofs, &|| watch.stop())?;
    let entries = (0..k.order()).flat_map(|column| k.column(column).map(move |(row, value)| (row, column, value)));
    let of_node = |node: usize| Component::ALL.map(|component| (node, component));
    let all = (0..bare.nodes.len()).flat_map(of_node);
    Ok(Matrices {
        dofs: all.filter(|&(node, component)| dofs.of(node, component).is_some()).collect(),
        stiffness: entries.filter(|(_, _, value)| *value != 0.0).collect(),
        forces: load_vectors(&bare, &dofs)?,
    })
}
