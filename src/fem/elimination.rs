//! The elimination of everything that holds the displacements:
//! u = T v + G z, with v the free unknowns of the main system and z the mutual displacements of the joints.
//!
//! Supports and ties make classes of equal components (or zero). Each joint row B u = z then gives up one class
//! (Gaussian elimination with pivoting on rows of a few entries, see `joint_rows`), preferably on the `node` side,
//! so that G has entries on that side only. Because all rows are kept fully reduced, B T = 0 and B G = I.

use std::collections::BTreeMap;

use super::dof::{Dofs, root};
use super::doubled::Real;
use super::error::DependentJoint;
use super::joint_rows::{JointReduction, JointRow, holders};
use crate::model::pair::Joint;
use crate::model::structure::Structure;

/// One base dof in terms of v and z.
#[derive(Clone, Debug, PartialEq)]
enum Row {
    /// Held by a support.
    Zero,
    /// Equal to one unknown.
    Free(u32),
    /// A sum: index into `sums`.
    Sum(u32),
}

/// Σ coefficient·v + Σ coefficient·z.
#[derive(Clone, Debug, Default, PartialEq)]
struct Sum {
    free: Vec<(u32, f64)>,
    joints: Vec<(u32, f64)>,
}

/// u = T v + G z.
#[derive(Clone, Debug, PartialEq)]
pub struct Elimination {
    rows: Vec<Row>,
    sums: Vec<Sum>,
    /// Representative of the class of each base dof.
    class: Vec<u32>,
    /// Whether the class of each base dof is held by a support.
    held: Vec<bool>,
    free: usize,
    masters: usize,
    joints: usize,
}

impl Elimination {
    /// Eliminates supports, ties, then the joints.
    ///
    /// # Errors
    /// All joints that depend on supports, ties and earlier joints.
    pub fn new(structure: &Structure, dofs: &Dofs, joints: &[Joint]) -> Result<Elimination, Vec<DependentJoint>> {
        let (class, held) = classes(structure, dofs);
        let is_class = |dof: usize| class[dof] as usize == dof && !held[dof];
        let free = (0..dofs.count()).filter(|&dof| is_class(dof)).count();

        let mut reduction = JointReduction::default();
        let mut dependent = Vec::new();
        for (index, joint) in joints.iter().enumerate() {
            let row = JointRow::new(index, joint, dofs, &class, &held);
            if let Err(row) = reduction.add(row) {
                dependent.push(DependentJoint {
                    pair: joint.pair,
                    pair_id: structure.pairs[joint.pair].id.clone(),
                    direction: joint.direction,
                    holders: holders(structure, dofs, joints, &class, &held, &row, joint),
                });
            }
        }
        if !dependent.is_empty() {
            return Err(dependent);
        }

        // Number the classes that are left, then write out the rows.
        let mut master = vec![u32::MAX; dofs.count()];
        let mut masters = 0;
        for (dof, master) in master.iter_mut().enumerate() {
            if is_class(dof) && !reduction.slaves.contains_key(&(dof as u32)) {
                *master = masters;
                masters += 1;
            }
        }
        let mut sums = Vec::with_capacity(reduction.slaves.len());
        let mut sum_of = BTreeMap::new();
        for (&dof, row) in &reduction.slaves {
            sum_of.insert(dof, sums.len() as u32);
            sums.push(Sum {
                free: row.terms.iter().map(|(&other, &a)| (master[other as usize], -a)).collect(),
                joints: row.joints.iter().map(|(&j, &a)| (j, a)).collect(),
            });
        }
        let rows = (0..dofs.count())
            .map(|dof| {
                let root = class[dof];
                if held[dof] {
                    Row::Zero
                } else if let Some(&sum) = sum_of.get(&root) {
                    Row::Sum(sum)
                } else {
                    Row::Free(master[root as usize])
                }
            })
            .collect();
        Ok(Elimination { rows, sums, class, held, free, masters: masters as usize, joints: joints.len() })
    }

    /// Unknowns after supports and ties, before the joints.
    pub fn free(&self) -> usize {
        self.free
    }

    /// Length of v.
    pub fn masters(&self) -> usize {
        self.masters
    }

    /// Length of z.
    pub fn joints(&self) -> usize {
        self.joints
    }

    /// Representative of the class of tied components to which a base dof belongs.
    pub fn class(&self, dof: usize) -> usize {
        self.class[dof] as usize
    }

    /// Whether a base dof is held by a support (perhaps through a tie).
    pub fn is_held(&self, dof: usize) -> bool {
        self.held[dof]
    }

    /// Whether the row of a base dof is a single unknown with coefficient one.
    pub fn single(&self, dof: usize) -> Option<usize> {
        match self.rows[dof] {
            Row::Free(v) => Some(v as usize),
            _ => None,
        }
    }

    /// Entries of a row of T: (index into v, coefficient).
    pub fn free_terms(&self, dof: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let (single, sum) = match &self.rows[dof] {
            Row::Zero => (None, None),
            Row::Free(v) => (Some((*v as usize, 1.0)), None),
            Row::Sum(sum) => (None, Some(&self.sums[*sum as usize])),
        };
        let many = sum.into_iter().flat_map(|sum| &sum.free);
        single.into_iter().chain(many.map(|&(v, a)| (v as usize, a)))
    }

    /// Entries of a row of G: (joint, coefficient).
    pub fn joint_terms(&self, dof: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let sum = match &self.rows[dof] {
            Row::Sum(sum) => Some(&self.sums[*sum as usize]),
            _ => None,
        };
        let many = sum.into_iter().flat_map(|sum| &sum.joints);
        many.map(|&(j, a)| (j as usize, a))
    }

    /// u = T v + G z on the base dofs.
    pub fn expand<T: Real>(&self, v: &[T], z: &[f64]) -> Vec<T> {
        let sum = |sum: T, term: T| sum + term;
        (0..self.rows.len())
            .map(|dof| {
                let own = self.free_terms(dof).map(|(i, a)| T::from(a) * v[i]).fold(T::zero(), sum);
                self.joint_terms(dof).map(|(j, a)| T::from(a) * T::from(z[j])).fold(own, sum)
            })
            .collect()
    }
}

/// Classes of equal components and whether a support holds them, for every base dof.
fn classes(structure: &Structure, dofs: &Dofs) -> (Vec<u32>, Vec<bool>) {
    let mut parent: Vec<u32> = (0..dofs.count() as u32).collect();
    for tie in &structure.ties {
        for &component in &tie.components {
            let mut tied = tie.nodes.iter().filter_map(|&n| dofs.of(n, component));
            let Some(first) = tied.next() else { continue };
            for other in tied {
                let (a, b) = (root(&mut parent, first), root(&mut parent, other));
                parent[a.max(b)] = a.min(b) as u32;
            }
        }
    }
    let class: Vec<u32> = (0..dofs.count()).map(|dof| root(&mut parent, dof) as u32).collect();
    let mut held_class = vec![false; dofs.count()];
    for support in &structure.supports {
        // A support of a rotation that does not exist holds nothing.
        if let Some(dof) = dofs.of(support.node, support.component) {
            held_class[class[dof] as usize] = true;
        }
    }
    let held = class.iter().map(|&c| held_class[c as usize]).collect();
    (class, held)
}
