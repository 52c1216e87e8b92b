//! The kernel of R, made exact (method §2).
//!
//! R z = 0 exactly for z = B u, u in ker K. The rigid motions of loose parts give Z to rounding; R is then replaced
//! by (1 − Z Zᵀ) R (1 − Z Zᵀ), so that mechanisms are free to the last digit.

use std::collections::{BTreeSet, HashMap};

use nalgebra::{DMatrix, DVector};

use super::error::{FreeDirection, MainSystemError};
use super::loose::{Motion, shortest_side};
use crate::model::pair::Joint;
use crate::model::structure::Structure;
use crate::model::vector::length;
use stickslip_numerics::decompositions::{is_above, largest_eigenvalue, svd, symmetric_eigen};

/// Eigenvalues of R below this share of the largest are suspected of being zero.
pub const ZERO_EIGENVALUE: f64 = 1e-10;

/// Above this share the smallest eigenvalue is surely not one of those, and no decomposition is needed: the largest
/// eigenvalue is known within less than a factor of 4.
const SURELY_POSITIVE: f64 = 4.0 * ZERO_EIGENVALUE;

/// Singular values below this share of the largest: motions that no joint feels. Rounding of a small decomposition.
const UNFELT: f64 = 1024.0 * f64::EPSILON;

/// Rigid motions and their trace on the joints.
#[derive(Clone)]
pub struct RigidKernel {
    /// Orthonormal basis of their mutual displacements, k × r.
    pub z: DMatrix<f64>,
    /// Column j of `z` is B applied to Σ_i coefficients[(i, j)] · motion i; r × r.
    pub coefficients: DMatrix<f64>,
}

/// z = B u, lengths: > 0 where the pair opens, or its second side moves along +t.
pub fn mutual_displacements(joints: &[Joint], u: &[[f64; 6]]) -> DVector<f64> {
    DVector::from_iterator(
        joints.len(),
        joints.iter().map(|joint| {
            joint.terms.iter().map(|(node, a)| a[0] * u[*node][0] + a[1] * u[*node][1] + a[2] * u[*node][2]).sum()
        }),
    )
}

/// The kernel from rigid motions of loose parts.
///
/// # Errors
/// Mechanism: a motion that no joint feels.
pub fn rigid_kernel(
    structure: &Structure,
    joints: &[Joint],
    motions: &[Motion],
) -> Result<RigidKernel, MainSystemError> {
    let (k, r) = (joints.len(), motions.len());
    if r == 0 {
        return Ok(RigidKernel { z: DMatrix::zeros(k, 0), coefficients: DMatrix::zeros(0, 0) });
    }
    let mut traces = DMatrix::zeros(k, r);
    for (i, motion) in motions.iter().enumerate() {
        traces.set_column(i, &mutual_displacements(joints, &motion.u));
    }
    let svd = svd(&traces).ok_or(MainSystemError::NoConvergence)?;
    let largest = svd.sigma[0];
    if svd.sigma[r - 1] <= UNFELT * largest || largest == 0.0 {
        let mut u = vec![[0.0; 6]; structure.nodes.len()];
        for (motion, c) in std::iter::zip(motions, svd.v.column(r - 1).iter()) {
            add_scaled(&mut u, *c, &motion.u);
        }
        return Err(mechanism(structure, &u));
    }
    let mut coefficients = svd.v;
    for (mut column, sigma) in std::iter::zip(coefficients.column_iter_mut(), &svd.sigma) {
        column /= *sigma;
    }
    Ok(RigidKernel { z: svd.u.columns(0, r).into_owned(), coefficients })
}

fn add_scaled(sum: &mut [[f64; 6]], factor: f64, u: &[[f64; 6]]) {
    for (sum, u) in std::iter::zip(sum, u) {
        for (sum, u) in std::iter::zip(sum, u) {
            *sum += factor * u;
        }
    }
}

/// The error that names the node that moves most. Where some side is no more than rounding beside the whole, what it holds
/// cannot be told from what nothing holds.
pub fn mechanism(structure: &Structure, u: &[[f64; 6]]) -> MainSystemError {
    let size = structure.extent().into_iter().fold(0.0, f64::max);
    let share = shortest_side(structure) / size;
    if share <= UNFELT {
        return MainSystemError::Lost { node: most_moved(u), share };
    }
    // What a turn moves by no more than the rounding of the places does not move.
    let farthest = structure.nodes.iter().map(|node| length(node.position)).fold(0.0, f64::max);
    let turn = u.iter().map(|&[.., x, y, z]| length([x, y, z])).fold(0.0, f64::max);
    let moves = |[x, y, z, ..]: &[f64; 6]| length([*x, *y, *z]) > UNFELT * turn * farthest;
    let mut u = u.to_vec();
    if !u.iter().any(moves) {
        u.iter_mut().for_each(|u| u[..3].fill(0.0));
    }
    let node = most_moved(&u);
    let body = body_of(structure, node);
    MainSystemError::Mechanism {
        node,
        node_id: structure.nodes[node].id.clone(),
        beside: body.as_deref().and_then(|body| beside(structure, body)),
        body,
        direction: FreeDirection::of(structure.dimension, u[node]),
    }
}

/// The plate, brick, mesh or part of a mesh to which a node belongs.
fn body_of(structure: &Structure, node: usize) -> Option<String> {
    let has = |element: &usize| {
        let nodes = &structure.elements[*element].nodes;
        nodes.len() > 2 && nodes.contains(&node)
    };
    let contains = |name: &&str| structure.elements_of_body(name).is_some_and(|elements| elements.iter().any(has));
    // The parts of a mesh come last.
    structure.bodies().into_iter().rfind(contains).map(str::to_owned)
}

/// Ids of a node of a body and of one of another part at the same place, where no contact or tie has the first.
fn beside(structure: &Structure, body: &str) -> Option<Box<[String; 2]>> {
    let own: BTreeSet<usize> = (structure.elements_of_body(body)?.into_iter())
        .flat_map(|element| structure.elements[element].nodes.iter().copied())
        .collect();
    let of_pairs = structure.pairs.iter().flat_map(|pair| pair.weights.iter().map(|(node, _)| *node));
    let joined: BTreeSet<usize> =
        of_pairs.chain(structure.ties.iter().flat_map(|tie| tie.nodes.iter().copied())).collect();
    let size = structure.extent().into_iter().fold(0.0, f64::max);
    let place = |node: usize| structure.nodes[node].position.map(|x| (x / (UNFELT * size)).round() as i64);
    let others: HashMap<[i64; 3], usize> =
        (0..structure.nodes.len()).filter(|node| !own.contains(node)).map(|node| (place(node), node)).collect();
    let free = own.into_iter().filter(|node| !joined.contains(node));
    let (node, other) = free.filter_map(|node| Some((node, *others.get(&place(node))?))).next()?;
    Some(Box::new([node, other].map(|node| structure.nodes[node].id.clone())))
}

/// The node with the largest translation, or rotation where nothing translates.
pub fn most_moved(u: &[[f64; 6]]) -> usize {
    let most = |size: &dyn Fn(&[f64; 6]) -> f64| {
        let largest = u.iter().map(size).fold(0.0, f64::max);
        // The first of those that are equal to rounding.
        let node = u.iter().position(|u| size(u) >= largest * (1.0 - 1e-6));
        (largest, node.unwrap_or(0))
    };
    let (translation, node) = most(&|&[x, y, z, ..]| length([x, y, z]));
    if translation == 0.0 { most(&|&[.., x, y, z]| length([x, y, z])).1 } else { node }
}

/// R ← (1 − Z Zᵀ) R (1 − Z Zᵀ), exactly symmetric.
pub fn project(r: &mut DMatrix<f64>, z: &DMatrix<f64>) {
    if z.ncols() == 0 {
        return;
    }
    if z.ncols() == r.nrows() {
        r.fill(0.0);
        return;
    }
    // R − Z Yᵀ − Y Zᵀ with Y = R Z − ½ Z (Zᵀ R Z).
    let rz = &*r * z;
    let y = &rz - z * (z.transpose() * &rz) * 0.5;
    r.gemm(-1.0, z, &y.transpose(), 1.0);
    r.gemm(-1.0, &y, &z.transpose(), 1.0);
    for i in 0..r.nrows() {
        for j in 0..i {
            let mean = 0.5 * (r[(i, j)] + r[(j, i)]);
            r[(i, j)] = mean;
            r[(j, i)] = mean;
        }
    }
}

/// Eigenvectors of R outside Z that look like zero-energy motions: to be checked against K.
pub struct Suspects {
    /// How many there are: the first columns of `vectors`.
    pub count: usize,
    /// All eigenvectors.
    pub vectors: DMatrix<f64>,
    values: Vec<f64>,
}

impl Suspects {
    /// The dislocation outside the suspects that gives the joint forces `force`.
    pub fn resisting(&self, force: &DVector<f64>) -> DVector<f64> {
        let mut z = DVector::zeros(force.len());
        for (column, value) in std::iter::zip(self.vectors.column_iter(), &self.values).skip(self.count) {
            z.axpy(column.dot(force) / value, &column, 1.0);
        }
        z
    }
}

/// The suspects, if there are any.
///
/// # Errors
/// The decomposition did not converge.
pub fn suspects(r: &DMatrix<f64>, z: &DMatrix<f64>) -> Result<Option<Suspects>, MainSystemError> {
    if r.nrows() == z.ncols() {
        return Ok(None);
    }
    let largest = largest_eigenvalue(r);
    let mut lifted = r.clone();
    // Z gets the largest eigenvalue: what is small now is new.
    lifted.gemm(largest, z, &z.transpose(), 1.0);
    if is_above(&lifted, SURELY_POSITIVE * largest) {
        return Ok(None);
    }
    let (values, vectors) = symmetric_eigen(&lifted).ok_or(MainSystemError::NoConvergence)?;
    let largest = values.last().copied().unwrap_or(0.0);
    let count = values.iter().filter(|value| **value < ZERO_EIGENVALUE * largest).count();
    Ok((count > 0).then_some(Suspects { count, vectors, values }))
}

/// Z with one more direction, orthonormal; `None` if it is in the span already.
pub fn extend(z: &DMatrix<f64>, direction: &DVector<f64>) -> Option<DMatrix<f64>> {
    let mut new = direction.clone();
    // Twice is enough (Kahan, Parlett).
    for _ in 0..2 {
        let inside = z * (z.transpose() * &new);
        new -= inside;
    }
    let norm = new.norm();
    if norm < 1e-6 * direction.norm() {
        return None;
    }
    let at = z.ncols();
    let mut z = z.clone().insert_column(at, 0.0);
    z.set_column(at, &(new / norm));
    Some(z)
}
