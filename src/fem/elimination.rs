//! The elimination of everything that holds the displacements:
//! u = T v + G z + S s, with v the free unknowns of the main system, z the mutual displacements of the joints and s the
//! displacements imposed on supports.
//!
//! Supports and ties make classes of equal components (or zero). Each joint row B u = z then gives up one class
//! (Gaussian elimination with pivoting on rows of a few entries, see `joint_rows`), preferably on the `node` side,
//! so that G has entries on that side only. Because all rows are kept fully reduced, B T = 0 and B G = I. The rows of
//! rigid bodies (see `body_rows`) come first and go the same way.

use std::collections::BTreeMap;

use super::body_rows::{BodyRow, body_rows, over_constraint, reaches};
use super::dof::{Dofs, root};
use super::doubled::Real;
use super::error::{DependentJoint, Holder, MainSystemError, OverConstraint};
use super::joint_rows::{JointReduction, JointRow, holders};
use super::repeated::{Repeated, by_preference};
use crate::model::pair::{Joint, JointDirection};
use crate::model::structure::{Component, Load, Structure};

/// One base dof in terms of v and z.
#[derive(Clone, Debug, PartialEq)]
enum Row {
    /// Held by a support; the number of its imposed displacement if it has one.
    Held(Option<u32>),
    /// Equal to one unknown.
    Free(u32),
    /// A sum: index into `sums`.
    Sum(u32),
}

/// Σ coefficient·v + Σ coefficient·z + Σ coefficient·s.
#[derive(Clone, Debug, Default, PartialEq)]
struct Sum {
    free: Vec<(u32, f64)>,
    joints: Vec<(u32, f64)>,
    settled: Vec<(u32, f64)>,
    /// What the row would follow if the nodes of a body could leave their places: entries of G_A.
    bodies: Vec<(u32, f64)>,
}

/// What supports and ties make of the base dofs: classes of equal components.
pub struct Classes {
    /// Representative of the class of each base dof.
    pub class: Vec<u32>,
    /// Whether the class of each base dof is held by a support.
    pub held: Vec<bool>,
    /// The classes on which some load case imposes a displacement, with the numbers of those displacements in the rows
    /// of the joints: they follow the joints.
    pub settled: BTreeMap<u32, u32>,
    /// Of the rotations of rigid bodies the distance at which they are reduced as a displacement.
    pub reach: BTreeMap<u32, f64>,
}

impl Classes {
    /// What one unit of the reduced unknown of a class is divided by in the rows of the bodies and joints.
    pub fn unit(&self, class: u32) -> f64 {
        self.reach.get(&class).copied().unwrap_or(1.0)
    }
}

/// u = T v + G z + S s.
#[derive(Clone, Debug, PartialEq)]
pub struct Elimination {
    rows: Vec<Row>,
    sums: Vec<Sum>,
    /// Representative of the class of each base dof.
    class: Vec<u32>,
    /// Whether the class of each base dof is held by a support.
    held: Vec<bool>,
    /// The rows of rigid bodies.
    bodies: Vec<BodyRow>,
    free: usize,
    masters: usize,
    joints: usize,
}

impl Elimination {
    /// The joints that repeat others.
    ///
    /// # Errors
    /// Bodies that supports and ties hold more often than they can move; all joints that supports, ties and bodies alone
    /// hold.
    pub fn repeated(structure: &Structure, dofs: &Dofs, joints: &[Joint]) -> Result<Vec<Repeated>, MainSystemError> {
        let classes = classes(structure, dofs, joints.len());
        let mut reduction = JointReduction::default();
        let bodies = body_rows(structure, dofs);
        let beyond_settled = joints.len() + classes.settled.len();
        reduce_bodies(structure, dofs, &classes, &bodies, beyond_settled, &mut reduction)
            .map_err(MainSystemError::OverConstrained)?;
        let (mut repeated, mut held) = (Vec::new(), Vec::new());
        for index in by_preference(structure, joints) {
            let joint = &joints[index];
            let Err(row) = reduction.add(JointRow::new(index, joint, dofs, &classes)) else { continue };
            if let Some(joint) = Repeated::of(index, &row, joints.len()) {
                repeated.push(joint);
                continue;
            }
            let mut holders = holders(structure, dofs, joints, &classes, &row, joint);
            let involved = row.joints.keys().filter_map(|row| (*row as usize).checked_sub(beyond_settled));
            for id in involved.map(|row| &structure.rigid[bodies[row].body].id) {
                let holder = Holder::Body { id: id.clone() };
                if !holders.contains(&holder) {
                    holders.push(holder);
                }
            }
            held.push(DependentJoint {
                pair: joint.pair,
                pair_id: structure.pairs[joint.pair].id.clone(),
                direction: joint.direction,
                holders,
            });
        }
        held.sort_by_key(|joint| (joint.direction == JointDirection::Tangential, joint.pair));
        if held.is_empty() { Ok(repeated) } else { Err(MainSystemError::DependentJoints(held)) }
    }

    /// Eliminates supports, ties, rigid bodies, then the joints, which are independent.
    ///
    /// # Errors
    /// Bodies that supports and ties hold more often than they can move.
    pub fn new(structure: &Structure, dofs: &Dofs, joints: &[Joint]) -> Result<Elimination, MainSystemError> {
        let classes = classes(structure, dofs, joints.len());
        let Classes { class, held, settled, .. } = &classes;
        let is_class = |dof: usize| class[dof] as usize == dof && !held[dof];

        let mut reduction = JointReduction::default();
        let bodies = body_rows(structure, dofs);
        let beyond_settled = joints.len() + settled.len();
        reduce_bodies(structure, dofs, &classes, &bodies, beyond_settled, &mut reduction)
            .map_err(MainSystemError::OverConstrained)?;
        let free = (0..dofs.count()).filter(|&dof| is_class(dof)).count() - bodies.len();
        for (index, joint) in joints.iter().enumerate() {
            // Joints that repeat others were taken out before.
            let added = reduction.add(JointRow::new(index, joint, dofs, &classes));
            debug_assert!(added.is_ok(), "joints {added:?} are independent");
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
        let count = joints.len() as u32;
        let beyond = beyond_settled as u32;
        let mut sums = Vec::with_capacity(reduction.slaves.len());
        let mut sum_of = BTreeMap::new();
        for (&dof, row) in &reduction.slaves {
            sum_of.insert(dof, sums.len() as u32);
            let unit = classes.unit(dof);
            let part = |range: std::ops::Range<u32>| -> Vec<(u32, f64)> {
                row.joints.range(range.clone()).map(|(&j, &a)| (j - range.start, a / unit)).collect()
            };
            let own = |(&other, &a): (&u32, &f64)| (master[other as usize], -a * classes.unit(other) / unit);
            sums.push(Sum {
                free: row.terms.iter().map(own).collect(),
                joints: part(0..count),
                settled: part(count..beyond),
                bodies: part(beyond..u32::MAX),
            });
        }
        let rows = (0..dofs.count())
            .map(|dof| {
                let root = class[dof];
                if held[dof] {
                    Row::Held(settled.get(&root).map(|number| number - count))
                } else if let Some(&sum) = sum_of.get(&root) {
                    Row::Sum(sum)
                } else {
                    Row::Free(master[root as usize])
                }
            })
            .collect();
        let Classes { class, held, .. } = classes;
        Ok(Elimination { rows, sums, class, held, bodies, free, masters: masters as usize, joints: joints.len() })
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
            Row::Held(_) => (None, None),
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

    /// The rows of rigid bodies.
    pub fn bodies(&self) -> &[BodyRow] {
        &self.bodies
    }

    /// Entries of a row of G_A: (row of a body, coefficient).
    pub fn body_terms(&self, dof: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let sum = match &self.rows[dof] {
            Row::Sum(sum) => Some(&self.sums[*sum as usize]),
            _ => None,
        };
        let many = sum.into_iter().flat_map(|sum| &sum.bodies);
        many.map(|&(row, a)| (row as usize, a))
    }

    /// Number of the imposed displacement of a base dof, if a support that settles holds it.
    pub fn settlement(&self, dof: usize) -> Option<usize> {
        match self.rows[dof] {
            Row::Held(number) => number.map(|number| number as usize),
            _ => None,
        }
    }

    /// S s on the base dofs: what follows the imposed displacements `s` with all joints on and v = 0.
    pub fn settled(&self, s: &[f64]) -> Vec<f64> {
        let row = |row: &Row| match row {
            Row::Held(number) => number.map_or(0.0, |number| s[number as usize]),
            Row::Free(_) => 0.0,
            Row::Sum(sum) => self.sums[*sum as usize].settled.iter().map(|&(number, a)| a * s[number as usize]).sum(),
        };
        self.rows.iter().map(row).collect()
    }

    /// T v + G z on the base dofs.
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

/// Reduces the rows of the bodies; they are numbered from `first` on.
///
/// # Errors
/// Every body of which a row repeats what is held already.
fn reduce_bodies(
    structure: &Structure,
    dofs: &Dofs,
    classes: &Classes,
    rows: &[BodyRow],
    first: usize,
    reduction: &mut JointReduction,
) -> Result<(), Vec<OverConstraint>> {
    let mut wrong: Vec<OverConstraint> = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let terms = row.terms.iter().map(|&(dof, a)| (usize::from(dof != row.terms[0].0), (dof, a)));
        let Err(left) = reduction.add(JointRow::of_terms(first + index, terms, classes)) else { continue };
        if wrong.last().is_none_or(|last| last.body != row.body) {
            let involved = left.joints.keys().filter_map(|other| rows.get((*other as usize).checked_sub(first)?));
            wrong.push(over_constraint(structure, dofs, classes, row.body, &involved.collect::<Vec<_>>()));
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong) }
}

/// Classes of equal components, and which of them supports hold and move.
fn classes(structure: &Structure, dofs: &Dofs, joints: usize) -> Classes {
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
    for body in &structure.rigid {
        let turning = body.nodes.iter().filter_map(|&node| dofs.of(node, Component::R));
        for (first, other) in turning.clone().zip(turning.skip(1)) {
            let (a, b) = (root(&mut parent, first), root(&mut parent, other));
            parent[a.max(b)] = a.min(b) as u32;
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
    let mut settled = BTreeMap::new();
    for load in structure.load_cases.iter().flat_map(|case| &case.loads) {
        if let Load::Settlement { node, component, .. } = *load
            && let Some(dof) = dofs.of(node, component)
        {
            let next = (joints + settled.len()) as u32;
            settled.entry(class[dof]).or_insert(next);
        }
    }
    let reach = reaches(structure, dofs, &class);
    Classes { class, held, settled, reach }
}
