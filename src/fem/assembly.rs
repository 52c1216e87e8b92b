//! K and F of the free structure, and their share in the main system.
//!
//! With u = T v + G z (see `elimination`): K_m = Tᵀ K T, C = Tᵀ K G, D = Gᵀ K G.

use nalgebra::DMatrix;

use super::dof::Dofs;
use super::element::{Number, Stiffness, check_spring, slots, spring, stiffness};
use super::elimination::Elimination;
use super::error::MainSystemError;
use super::sparse::SymmetricSparse;
use super::threads::each_element;
use crate::doubled::Real;
use crate::model::structure::{Spring, Structure};

/// Elements that are assembled between two looks at the watcher.
const ELEMENTS_PER_LOOK: usize = 4096;

/// K on the base dofs, with neither supports nor ties nor joints. Elements inside a rigid body are left out: nothing
/// strains them, and the rounding of their stiffness could hide what the body stands on.
///
/// # Errors
/// An element without stiffness because of its shape; interrupted.
pub fn assemble<T: Number>(
    structure: &Structure,
    dofs: &Dofs,
    stop: &dyn Fn() -> bool,
) -> Result<SymmetricSparse<T>, MainSystemError> {
    assemble_seen(structure, dofs, stop, |_| {})
}

/// The same; `see` is shown the stiffness of every element.
///
/// # Errors
/// As [`assemble`].
pub fn assemble_seen<T: Number>(
    structure: &Structure,
    dofs: &Dofs,
    stop: &dyn Fn() -> bool,
    mut see: impl FnMut(&Stiffness<T>),
) -> Result<SymmetricSparse<T>, MainSystemError> {
    let element_dofs = |index: usize, visit: &mut dyn FnMut(&[Option<usize>])| {
        let slots = slots(&structure.elements[index]);
        let at: Vec<Option<usize>> = slots.iter().map(|&(node, component)| dofs.of(node, component)).collect();
        visit(&at);
    };
    let rigid = structure.rigid_elements();
    let elements = || (0..structure.elements.len()).filter(|&index| !rigid[index]);
    let spring_dofs = |spring: &Spring| -> Vec<Option<usize>> {
        spring.terms.iter().map(|term| dofs.of(term.node, term.component)).collect()
    };
    let lower = |at: &[Option<usize>], visit: &mut dyn FnMut(usize, usize, usize, usize)| {
        for (i, row) in at.iter().enumerate() {
            for (j, column) in at.iter().enumerate() {
                if let (Some(row), Some(column)) = (*row, *column)
                    && row >= column
                {
                    visit(row, column, i, j);
                }
            }
        }
    };
    SymmetricSparse::from_terms(
        dofs.count(),
        |count| {
            // Every dof has its diagonal entry, also where nothing is attached.
            (0..dofs.count()).for_each(&mut *count);
            for index in elements() {
                element_dofs(index, &mut |at| lower(at, &mut |_, column, _, _| count(column)));
            }
            for spring in &structure.springs {
                lower(&spring_dofs(spring), &mut |_, column, _, _| {
                    count(column);
                });
            }
            given_entries(structure, dofs, |_, column, _| count(column));
        },
        |push| {
            (0..dofs.count()).for_each(|dof| push(dof, dof, T::zero()));
            each_element(
                elements(),
                |index| stiffness(structure, index),
                |index, k| {
                    if index % ELEMENTS_PER_LOOK == 0 && stop() {
                        return Err(MainSystemError::Interrupted);
                    }
                    let k = k?;
                    see(&k);
                    element_dofs(index, &mut |at| {
                        lower(at, &mut |row, column, i, j| push(row, column, k[(i, j)]));
                    });
                    Ok(())
                },
            )?;
            for element in &structure.springs {
                check_spring(structure, element)?;
                lower(&spring_dofs(element), &mut |row, column, i, j| {
                    push(row, column, spring::stiffness(element, i, j));
                });
            }
            given_entries(structure, dofs, |row, column, value| push(row, column, T::from(value)));
            Ok(())
        },
    )
}

/// Visits the entries of a superelement's K: (row, column, value) in base dofs, row ≥ column.
pub fn given_entries(structure: &Structure, dofs: &Dofs, mut visit: impl FnMut(usize, usize, f64)) {
    let Some(element) = &structure.superelement else { return };
    // Every row has its dof.
    let at: Vec<Option<usize>> = element.dofs.iter().map(|&(node, component)| dofs.of(node, component)).collect();
    for &(i, j, value) in &element.entries {
        if let (Some(row), Some(column)) = (at[i], at[j]) {
            visit(row.max(column), row.min(column), value);
        }
    }
}

/// A term of C: row, joint, value.
pub type Coupling = (u32, u32, f64);

/// K_m, C and D of the main system.
#[derive(Clone, Debug)]
pub struct MainMatrices {
    /// K_m = Tᵀ K T.
    pub k_m: SymmetricSparse,
    /// C = Tᵀ K G as terms, perhaps repeated.
    pub c: Vec<Coupling>,
    /// D = Gᵀ K G.
    pub d: DMatrix<f64>,
}

/// K_m = Tᵀ K T.
pub fn main_stiffness(k: &SymmetricSparse, elimination: &Elimination) -> SymmetricSparse {
    // The terms of K_m that one entry of the lower triangle of K gives.
    let terms = |i: usize, j: usize, value: f64, push: &mut dyn FnMut(usize, usize, f64)| {
        if let (Some(a), Some(b)) = (elimination.single(i), elimination.single(j)) {
            // i ≠ j with a = b: two entries of K fall on one diagonal entry.
            let twice = if i != j && a == b { 2.0 } else { 1.0 };
            push(a.max(b), a.min(b), twice * value);
            return;
        }
        for (a, ca) in elimination.free_terms(i) {
            for (b, cb) in elimination.free_terms(j) {
                let term = value * ca * cb;
                if i != j {
                    push(a.max(b), a.min(b), if a == b { 2.0 * term } else { term });
                } else if a >= b {
                    push(a, b, term);
                }
            }
        }
    };
    let k_m = SymmetricSparse::from_terms::<std::convert::Infallible>(
        elimination.masters(),
        |count| {
            (0..elimination.masters()).for_each(&mut *count);
            each_entry(k, |i, j, value| terms(i, j, value, &mut |_, column, _| count(column)));
        },
        |push| {
            (0..elimination.masters()).for_each(|v| push(v, v, 0.0));
            each_entry(k, |i, j, value| terms(i, j, value, &mut *push));
            Ok(())
        },
    );
    let Ok(k_m) = k_m;
    k_m
}

/// Visits the entries of the lower triangle, column by column.
fn each_entry(k: &SymmetricSparse, mut visit: impl FnMut(usize, usize, f64)) {
    for column in 0..k.order() {
        for (row, value) in k.column(column) {
            visit(row, column, value);
        }
    }
}

/// Splits K by u = T v + G z.
pub fn main_matrices(k: &SymmetricSparse, elimination: &Elimination) -> MainMatrices {
    let k_m = main_stiffness(k, elimination);
    let mut c = Vec::new();
    let mut d = DMatrix::zeros(elimination.joints(), elimination.joints());
    each_entry(k, |i, j, value| {
        let mut directed = |i: usize, j: usize| {
            for (joint, g) in elimination.joint_terms(j) {
                for (v, t) in elimination.free_terms(i) {
                    c.push((v as u32, joint as u32, value * t * g));
                }
                for (other, h) in elimination.joint_terms(i) {
                    d[(other, joint)] += value * h * g;
                }
            }
        };
        directed(i, j);
        if i != j {
            directed(j, i);
        }
    });
    MainMatrices { k_m, c, d }
}

/// Tᵀ f.
pub fn on_masters<T: Real>(elimination: &Elimination, f: &[T]) -> Vec<T> {
    let mut out = vec![T::zero(); elimination.masters()];
    for (dof, &value) in f.iter().enumerate().filter(|(_, value)| !value.is_zero()) {
        for (v, t) in elimination.free_terms(dof) {
            out[v] += T::from(t) * value;
        }
    }
    out
}

/// Gᵀ f.
pub fn on_joints<T: Real>(elimination: &Elimination, f: &[T]) -> Vec<T> {
    let mut out = vec![T::zero(); elimination.joints()];
    for (dof, &value) in f.iter().enumerate().filter(|(_, value)| !value.is_zero()) {
        for (joint, g) in elimination.joint_terms(dof) {
            out[joint] += T::from(g) * value;
        }
    }
    out
}
