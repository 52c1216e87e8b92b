//! The elimination of everything that holds the displacements:
//! u = T v + G z + S s, with v the free unknowns of the main system, z the mutual displacements of the joints and s the
//! displacements imposed on supports.
//!
//! Supports and ties make classes of equal components (or zero). Each joint row B u = z then gives up one class
//! (Gaussian elimination with pivoting on rows of a few entries, see `joint_rows`), preferably on the `node` side,
//! so that G has entries on that side only. Because all rows are kept fully reduced, B T = 0 and B G = I. The rows of
//! rigid bodies (see `body_rows`) come first and go the same way.

use std::collections::BTreeMap;

use super::body_rows::{BodyRow, body_rows, over_constraint};
use super::classes::Classes;
use super::dof::Dofs;
use super::error::{DependentJoint, Holder, MainSystemError, OverConstraint};
use super::idle_spins::{IdleSpin, idle_spins};
use super::joint_rows::{JointReduction, JointRow, holders};
use super::parts::Parts;
use super::repeated::{Repeated, by_preference, is_explicit};
use crate::doubled::Real;
use crate::model::pair::{Joint, JointDirection};
use crate::model::structure::{Dimension, Structure};

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
    /// The spins that are held.
    spins: Vec<IdleSpin>,
    free: usize,
    masters: usize,
    joints: usize,
}

/// The entries of a part of a sum.
fn entries(part: &[(u32, f64)]) -> impl Iterator<Item = (usize, f64)> + '_ {
    part.iter().map(|&(at, a)| (at as usize, a))
}

impl Elimination {
    /// The joints that repeat others.
    ///
    /// # Errors
    /// Bodies that supports and ties hold more often than they can move; all joints that supports, ties and bodies
    /// alone hold.
    pub fn repeated(structure: &Structure, dofs: &Dofs, joints: &[Joint]) -> Result<Vec<Repeated>, MainSystemError> {
        // Where two joints differ by a small angle, a joint across them is independent and not what is left of the second:
        // what follows from that would be rounded as often as the angle is small.
        let clearly = Elimination::repeated_in(structure, dofs, joints, true)?;
        let fits = structure.dimension == Dimension::Space || is_explicit(&clearly, joints);
        if fits { Ok(clearly) } else { Elimination::repeated_in(structure, dofs, joints, false) }
    }

    /// The joints that repeat others where those that are `clearly` independent are taken first, or all by preference.
    fn repeated_in(
        structure: &Structure,
        dofs: &Dofs,
        joints: &[Joint],
        clearly: bool,
    ) -> Result<Vec<Repeated>, MainSystemError> {
        let classes = Classes::new(structure, dofs, joints.len());
        let mut reduction = JointReduction::default();
        let bodies = body_rows(structure, dofs, &held_spins(structure));
        let beyond_settled = joints.len() + classes.settled.len();
        reduce_bodies(structure, dofs, &classes, &bodies, beyond_settled, &mut reduction)
            .map_err(MainSystemError::OverConstrained)?;
        let (mut repeated, mut held) = (Vec::new(), Vec::new());
        let mut order = by_preference(structure, joints);
        if clearly {
            order.retain(|&index| reduction.add_clear(JointRow::new(index, &joints[index], dofs, &classes)).is_err());
        }
        for index in order {
            let joint = &joints[index];
            let Err(row) = reduction.add(JointRow::new(index, joint, dofs, &classes)) else { continue };
            if let Some(joint) = Repeated::of(index, &row, joints.len()) {
                repeated.push(joint);
                continue;
            }
            let mut holders = holders(structure, dofs, joints, &classes, &row, joint);
            let involved = row.joints.keys().filter_map(|row| (*row as usize).checked_sub(beyond_settled));
            for id in involved.filter_map(|row| Some(&structure.rigid[bodies[row].body?].id)) {
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
        held.sort_by_key(|joint| (joint.direction != JointDirection::Normal, joint.pair));
        if held.is_empty() { Ok(repeated) } else { Err(MainSystemError::DependentJoints(held)) }
    }

    /// Eliminates supports, ties, rigid bodies, then the joints, which are independent.
    ///
    /// # Errors
    /// Bodies that supports and ties hold more often than they can move.
    pub fn new(structure: &Structure, dofs: &Dofs, joints: &[Joint]) -> Result<Elimination, MainSystemError> {
        let classes = Classes::new(structure, dofs, joints.len());
        let Classes { class, held, settled, .. } = &classes;
        let is_class = |dof: usize| class[dof] as usize == dof && !held[dof];

        let mut reduction = JointReduction::default();
        let spins = held_spins(structure);
        let bodies = body_rows(structure, dofs, &spins);
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
        Ok(Elimination {
            rows,
            sums,
            class,
            held,
            bodies,
            spins,
            free,
            masters: masters as usize,
            joints: joints.len(),
        })
    }

    /// Unknowns after supports and ties, before the joints.
    pub fn free(&self) -> usize {
        self.free
    }

    /// Length of v.
    pub fn masters(&self) -> usize {
        self.masters
    }

    /// A node of each unknown of v.
    pub fn nodes(&self, dofs: &Dofs) -> Vec<u32> {
        let mut node = vec![0; self.masters];
        for (dof, at) in dofs.nodes().enumerate() {
            self.free_terms(dof).for_each(|(master, _)| node[master] = at as u32);
        }
        node
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

    /// The sum that a base dof is; `None` where it is held or a single unknown.
    fn sum(&self, dof: usize) -> Option<&Sum> {
        match self.rows[dof] {
            Row::Sum(sum) => Some(&self.sums[sum as usize]),
            Row::Held(_) | Row::Free(_) => None,
        }
    }

    /// Entries of a row of T: (index into v, coefficient).
    pub fn free_terms(&self, dof: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let single = self.single(dof).map(|v| (v, 1.0));
        single.into_iter().chain(entries(self.sum(dof).map_or(&[], |sum| &sum.free)))
    }

    /// Entries of a row of G: (joint, coefficient).
    pub fn joint_terms(&self, dof: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        entries(self.sum(dof).map_or(&[], |sum| &sum.joints))
    }

    /// The idle spins that are held.
    pub fn spins(&self) -> &[IdleSpin] {
        &self.spins
    }

    /// The rows of rigid bodies.
    pub fn bodies(&self) -> &[BodyRow] {
        &self.bodies
    }

    /// Entries of a row of G_A: (row of a body, coefficient).
    pub fn body_terms(&self, dof: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        entries(self.sum(dof).map_or(&[], |sum| &sum.bodies))
    }

    /// Number of the imposed displacement of a base dof, if a support that settles holds it.
    pub fn settlement(&self, dof: usize) -> Option<usize> {
        match self.rows[dof] {
            Row::Held(number) => number.map(|number| number as usize),
            _ => None,
        }
    }

    /// S s on the base dofs, lengths and radians: what follows the imposed displacements `s` with all joints on and
    /// v = 0.
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
        let add = |sum: T, term: T| sum + term;
        let of = |row: &Row| match row {
            Row::Held(_) => T::zero(),
            Row::Free(i) => v[*i as usize],
            Row::Sum(sum) => {
                let sum = &self.sums[*sum as usize];
                let own = sum.free.iter().map(|&(i, a)| T::from(a) * v[i as usize]).fold(T::zero(), add);
                sum.joints.iter().map(|&(j, a)| T::from(a) * T::from(z[j as usize])).fold(own, add)
            }
        };
        self.rows.iter().map(of).collect()
    }

    /// The magnitudes of the terms that T v + G z is the sum of, on the base dofs, where it is `u`; `z` are those of the joints.
    pub fn sizes(&self, u: &[f64], z: &[f64]) -> Vec<f64> {
        let mut v = vec![0.0; self.masters];
        for (dof, u) in u.iter().enumerate() {
            if let Some(single) = self.single(dof) {
                v[single] = u.abs();
            }
        }
        let of = |(dof, u): (usize, &f64)| match &self.rows[dof] {
            Row::Held(_) | Row::Free(_) => u.abs(),
            Row::Sum(_) => {
                let free: f64 = self.free_terms(dof).map(|(i, a)| a.abs() * v[i]).sum();
                let joints: f64 = self.joint_terms(dof).map(|(j, a)| a.abs() * z[j]).sum();
                u.abs().max(free + joints)
            }
        };
        u.iter().enumerate().map(of).collect()
    }

    /// Takes the forces inside rigid bodies out of nodal forces: f − Aᵀ μ with μ = G_Aᵀ f. What is left is for supports
    /// and ties; in balance it is zero where there are none.
    pub fn take_out_body_forces<T: Real>(&self, forces: &mut [T]) {
        let mut inner = vec![T::zero(); self.bodies().len()];
        for (dof, force) in forces.iter().enumerate() {
            for (row, a) in self.body_terms(dof) {
                inner[row] += T::from(a) * *force;
            }
        }
        for (row, inner) in std::iter::zip(self.bodies(), inner) {
            for &(dof, a) in &row.terms {
                forces[dof] -= T::from(a) * inner;
            }
        }
    }

    /// Adds to the sums of magnitudes of nodal forces the part of them that the bodies hand on.
    pub fn add_body_forces(&self, magnitudes: &mut [f64]) {
        let mut inner = vec![0.0; self.bodies().len()];
        for (dof, magnitude) in magnitudes.iter().enumerate() {
            for (row, a) in self.body_terms(dof) {
                inner[row] += a.abs() * magnitude;
            }
        }
        for (row, inner) in std::iter::zip(self.bodies(), inner) {
            for &(dof, a) in &row.terms {
                magnitudes[dof] += a.abs() * inner;
            }
        }
    }
}

/// The idle spins that have displacements to be held.
fn held_spins(structure: &Structure) -> Vec<IdleSpin> {
    let turns = || !structure.rigid.is_empty() || structure.elements.iter().any(|element| element.bends());
    if structure.dimension == Dimension::Plane || !turns() {
        return Vec::new();
    }
    idle_spins(structure, &Parts::new(structure)).into_iter().filter(|spin| !spin.turns.is_empty()).collect()
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
        // What else is held leaves an idle spin alone, so that its row cannot repeat others.
        let Some(body) = row.body else { continue };
        if wrong.last().is_none_or(|last| last.body != body) {
            let involved = left.joints.keys().filter_map(|other| rows.get((*other as usize).checked_sub(first)?));
            wrong.push(over_constraint(structure, dofs, classes, body, &involved.collect::<Vec<_>>()));
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong) }
}
