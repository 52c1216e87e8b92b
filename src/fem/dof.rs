//! Numbering of the displacement components, and the elimination of everything that holds them:
//! u = T v + G z, with v the free unknowns of the main system and z the mutual displacements of the joints.
//!
//! Supports and ties make classes of equal components (or zero). Each joint row B u = z then gives up one class
//! (Gaussian elimination with pivoting on rows of a few entries), preferably on the `node` side, so that G has
//! entries on that side only. Because all rows are kept fully reduced, B T = 0 and B G = I.

use std::collections::BTreeMap;

use super::error::{DependentJoint, Holder};
use crate::model::pair::Joint;
use crate::model::structure::{Component, ElementKind, Structure};

/// Components in the order x, y, r.
const COMPONENTS: [Component; 3] = [Component::X, Component::Y, Component::R];

/// A coefficient below this share of a unit row counts as zero: the row was dependent on others.
const DEPENDENT: f64 = 1e-9;

/// A pivot on the `node` side is taken if it has this share of the largest coefficient.
const PREFER_NODE_SIDE: f64 = 0.1;

/// Numbers of the nodal components ("base dofs"): x, y at every node, r where a frame bar is rigidly attached.
#[derive(Clone, Debug, PartialEq)]
pub struct Dofs {
    first: Vec<u32>,
    has_rotation: Vec<bool>,
    count: usize,
    frame_nodes_only_hinged: usize,
}

impl Dofs {
    /// Numbers the components node by node.
    pub fn new(structure: &Structure) -> Dofs {
        let mut frame = vec![false; structure.nodes.len()];
        let mut has_rotation = vec![false; structure.nodes.len()];
        for element in &structure.elements {
            if let ElementKind::Frame { hinges, .. } = &element.kind {
                for (end, &node) in element.nodes.iter().enumerate() {
                    frame[node] = true;
                    has_rotation[node] |= !hinges[end];
                }
            }
        }
        let mut count = 0;
        let first = has_rotation
            .iter()
            .map(|&rotation| {
                let first = count;
                count += if rotation { 3 } else { 2 };
                first as u32
            })
            .collect();
        let frame_nodes_only_hinged = std::iter::zip(&frame, &has_rotation)
            .filter(|(frame, rotation)| **frame && !**rotation)
            .count();
        Dofs {
            first,
            has_rotation,
            count,
            frame_nodes_only_hinged,
        }
    }

    /// Number of base dofs.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Nodal components before supports and ties as they are reported: a frame node counts 3 even where all its
    /// bars are hinged.
    pub fn unknowns(&self) -> usize {
        self.count + self.frame_nodes_only_hinged
    }

    /// The base dof of a component; `None` for a rotation that does not exist.
    pub fn of(&self, node: usize, component: Component) -> Option<usize> {
        let first = self.first[node] as usize;
        match component {
            Component::X => Some(first),
            Component::Y => Some(first + 1),
            Component::R => self.has_rotation[node].then_some(first + 2),
        }
    }

    /// Displacements [u_x, u_y, θ] per node from base dofs; θ = 0 where there is none.
    pub fn to_nodes(&self, u: &[f64]) -> Vec<[f64; 3]> {
        std::iter::zip(&self.first, &self.has_rotation)
            .map(|(&first, &rotation)| {
                let first = first as usize;
                let theta = if rotation { u[first + 2] } else { 0.0 };
                [u[first], u[first + 1], theta]
            })
            .collect()
    }

    /// Base dofs from displacements per node.
    pub fn from_nodes(&self, u: &[[f64; 3]]) -> Vec<f64> {
        let mut base = vec![0.0; self.count];
        for (node, values) in u.iter().enumerate() {
            for (component, value) in COMPONENTS.into_iter().zip(values) {
                if let Some(dof) = self.of(node, component) {
                    base[dof] = *value;
                }
            }
        }
        base
    }

    /// Which base dofs are rotations.
    pub fn is_rotation(&self) -> Vec<bool> {
        let mut rotations = vec![false; self.count];
        for (&first, &rotation) in std::iter::zip(&self.first, &self.has_rotation) {
            if rotation {
                rotations[first as usize + 2] = true;
            }
        }
        rotations
    }
}

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
    pub fn new(
        structure: &Structure,
        dofs: &Dofs,
        joints: &[Joint],
    ) -> Result<Elimination, Vec<DependentJoint>> {
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
        for dof in 0..dofs.count() {
            if is_class(dof) && !reduction.slaves.contains_key(&(dof as u32)) {
                master[dof] = masters;
                masters += 1;
            }
        }
        let mut sums = Vec::with_capacity(reduction.slaves.len());
        let mut sum_of = BTreeMap::new();
        for (&dof, row) in &reduction.slaves {
            sum_of.insert(dof, sums.len() as u32);
            sums.push(Sum {
                free: row
                    .terms
                    .iter()
                    .map(|(&other, &a)| (master[other as usize], -a))
                    .collect(),
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
        Ok(Elimination {
            rows,
            sums,
            class,
            held,
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
        single
            .into_iter()
            .chain(many.map(|&(v, a)| (v as usize, a)))
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
    pub fn expand(&self, v: &[f64], z: &[f64]) -> Vec<f64> {
        (0..self.rows.len())
            .map(|dof| {
                self.free_terms(dof).map(|(i, a)| a * v[i]).sum::<f64>()
                    + self.joint_terms(dof).map(|(j, a)| a * z[j]).sum::<f64>()
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
    let class: Vec<u32> = (0..dofs.count())
        .map(|dof| root(&mut parent, dof) as u32)
        .collect();
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

/// Root of a union-find tree, with path halving.
pub(super) fn root(parent: &mut [u32], mut at: usize) -> usize {
    while parent[at] as usize != at {
        parent[at] = parent[parent[at] as usize];
        at = parent[at] as usize;
    }
    at
}

/// Σ terms·class = Σ joints·z; a slave's own class has coefficient 1 and is left out of `terms`.
#[derive(Clone, Debug, Default)]
struct JointRow {
    terms: BTreeMap<u32, f64>,
    joints: BTreeMap<u32, f64>,
    /// Classes on the `node` side as the joint itself names them.
    node_side: Vec<u32>,
}

impl JointRow {
    fn new(index: usize, joint: &Joint, dofs: &Dofs, class: &[u32], held: &[bool]) -> JointRow {
        let mut row = JointRow::default();
        row.joints.insert(index as u32, 1.0);
        for (side, (dof, a)) in joint_dofs(joint, dofs) {
            if !held[dof] {
                *row.terms.entry(class[dof]).or_default() += a;
                if side == 0 {
                    row.node_side.push(class[dof]);
                }
            }
        }
        row
    }

    fn subtract(&mut self, factor: f64, slave: &JointRow) {
        for (&class, &a) in &slave.terms {
            *self.terms.entry(class).or_default() -= factor * a;
        }
        for (&joint, &a) in &slave.joints {
            *self.joints.entry(joint).or_default() -= factor * a;
        }
    }

    fn drop_rounding(&mut self) {
        self.terms.retain(|_, a| a.abs() > 1e-14);
        self.joints.retain(|_, a| a.abs() > 1e-14);
    }
}

/// The (side, (base dof, coefficient)) of a joint, zero coefficients left out; side 0 is `node`.
fn joint_dofs<'a>(
    joint: &'a Joint,
    dofs: &'a Dofs,
) -> impl Iterator<Item = (usize, (usize, f64))> + 'a {
    joint
        .terms
        .iter()
        .enumerate()
        .flat_map(move |(side, (node, a))| {
            let x = dofs.of(*node, Component::X).map(|dof| (dof, a[0]));
            let y = dofs.of(*node, Component::Y).map(|dof| (dof, a[1]));
            [x, y].into_iter().flatten().map(move |term| (side, term))
        })
        .filter(|(_, (_, a))| *a != 0.0)
}

/// Joint rows eliminated so far, fully reduced: no slave occurs in another slave's row.
#[derive(Default)]
struct JointReduction {
    slaves: BTreeMap<u32, JointRow>,
    /// Slaves in whose rows a class occurs (may name a slave too many, never one too few).
    users: BTreeMap<u32, Vec<u32>>,
}

impl JointReduction {
    /// Adds a row, or gives the reduced row back if nothing is left of it.
    fn add(&mut self, mut row: JointRow) -> Result<(), JointRow> {
        let hit: Vec<u32> = row
            .terms
            .keys()
            .copied()
            .filter(|class| self.slaves.contains_key(class))
            .collect();
        for class in hit {
            // Present by the filter above; slaves' rows hold no slaves.
            let Some(factor) = row.terms.remove(&class) else {
                continue;
            };
            let slave = &self.slaves[&class];
            row.subtract(factor, slave);
        }
        row.drop_rounding();
        let largest = row.terms.values().fold(0.0_f64, |m, a| m.max(a.abs()));
        if largest < DEPENDENT {
            return Err(row);
        }
        let best = |candidates: &mut dyn Iterator<Item = (u32, f64)>| {
            candidates.fold(None::<(u32, f64)>, |best, (class, a)| match best {
                Some((_, b)) if b.abs() >= a.abs() => best,
                _ => Some((class, a)),
            })
        };
        let node_side = best(
            &mut row
                .terms
                .iter()
                .filter(|(class, _)| row.node_side.contains(class))
                .map(|(&class, &a)| (class, a)),
        )
        .filter(|(_, a)| a.abs() >= PREFER_NODE_SIDE * largest);
        let Some((pivot, a)) =
            node_side.or_else(|| best(&mut row.terms.iter().map(|(&c, &a)| (c, a))))
        else {
            return Err(row);
        };
        row.terms.remove(&pivot);
        for value in row.terms.values_mut().chain(row.joints.values_mut()) {
            *value /= a;
        }
        // Take the new slave out of the rows that use it.
        for user in self.users.remove(&pivot).unwrap_or_default() {
            let Some(other) = self.slaves.get_mut(&user) else {
                continue;
            };
            if let Some(factor) = other.terms.remove(&pivot) {
                other.subtract(factor, &row);
                other.drop_rounding();
                for &class in row.terms.keys() {
                    self.users.entry(class).or_default().push(user);
                }
            }
        }
        for &class in row.terms.keys() {
            self.users.entry(class).or_default().push(pivot);
        }
        self.slaves.insert(pivot, row);
        Ok(())
    }
}

/// Who holds a joint whose reduced row is zero: the joints it was reduced with, and the supports and ties met by
/// it and by them.
fn holders(
    structure: &Structure,
    dofs: &Dofs,
    joints: &[Joint],
    class: &[u32],
    held: &[bool],
    row: &JointRow,
    joint: &Joint,
) -> Vec<Holder> {
    let mut holders = Vec::new();
    let others = row
        .joints
        .iter()
        .filter(|(j, a)| joints[**j as usize] != *joint && a.abs() > DEPENDENT)
        .map(|(j, _)| &joints[*j as usize]);
    let mut involved = vec![joint];
    for other in others {
        involved.push(other);
    }
    for joint in &involved {
        for (_, (dof, a)) in joint_dofs(joint, dofs) {
            if held[dof] && a.abs() > DEPENDENT {
                for support in &structure.supports {
                    let at = dofs.of(support.node, support.component);
                    if at.is_some_and(|at| class[at] == class[dof]) {
                        let holder = Holder::Support {
                            node: structure.nodes[support.node].id.clone(),
                            component: support.component,
                        };
                        if !holders.contains(&holder) {
                            holders.push(holder);
                        }
                    }
                }
            }
        }
    }
    for tie in &structure.ties {
        let tied = |node: &usize| tie.nodes.contains(node);
        for joint in &involved {
            let nodes: Vec<usize> = joint.terms.iter().map(|(node, _)| *node).collect();
            if let [a, b] = nodes[..]
                && tied(&a)
                && tied(&b)
            {
                for &component in &tie.components {
                    let used = joint_dofs(joint, dofs)
                        .any(|(_, (dof, _))| dofs.of(a, component) == Some(dof));
                    let holder = Holder::Tie {
                        nodes: [a, b].map(|n| structure.nodes[n].id.clone()),
                        component,
                    };
                    if used && !holders.contains(&holder) {
                        holders.push(holder);
                    }
                }
            }
        }
    }
    holders.extend(involved[1..].iter().map(|other| Holder::Joint {
        pair: structure.pairs[other.pair].id.clone(),
        direction: other.direction,
    }));
    if holders.is_empty() {
        // A chain of several ties: name the first tie that has the node.
        let node = joint.terms[0].0;
        if let Some(tie) = structure.ties.iter().find(|tie| tie.nodes.contains(&node)) {
            let other = tie.nodes.iter().copied().find(|&n| n != node);
            holders.push(Holder::Tie {
                nodes: [node, other.unwrap_or(node)].map(|n| structure.nodes[n].id.clone()),
                component: tie.components.first().copied().unwrap_or(Component::X),
            });
        }
    }
    holders
}
