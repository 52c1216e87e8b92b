//! The rows B u = z of the joints, reduced one after the other; and who holds a joint of which nothing is left.

use std::collections::BTreeMap;

use super::classes::Classes;
use super::dof::{Dofs, joint_dofs};
use super::error::Holder;
use crate::model::pair::Joint;
use crate::model::structure::{Component, Structure};

/// A coefficient below this share of a unit row counts as zero: the row was dependent on others.
const DEPENDENT: f64 = 1e-9;

/// A row that the others leave this share of is clearly independent of them: what follows from it is hardly rounded.
const CLEAR: f64 = 0.25;

/// A pivot on the `node` side is taken if it has this share of the largest coefficient.
const PREFER_NODE_SIDE: f64 = 0.1;

/// Σ terms·class = Σ joints·z; a slave's own class has coefficient 1 and is left out of `terms`.
#[derive(Clone, Debug, Default)]
pub struct JointRow {
    /// Coefficient of each class.
    pub terms: BTreeMap<u32, f64>,
    /// Coefficient of each joint's z; the numbers after those of the joints are imposed displacements, then come the
    /// rows of rigid bodies.
    pub joints: BTreeMap<u32, f64>,
    /// Classes on the `node` side as the joint itself names them.
    node_side: Vec<u32>,
}

impl JointRow {
    /// The row of joint number `index`.
    pub fn new(index: usize, joint: &Joint, dofs: &Dofs, classes: &Classes) -> JointRow {
        JointRow::of_terms(index, joint_dofs(joint, dofs), classes)
    }

    /// Row number `index` from its (side, (base dof, coefficient)).
    pub fn of_terms(index: usize, terms: impl Iterator<Item = (usize, (usize, f64))>, classes: &Classes) -> JointRow {
        let mut row = JointRow::default();
        row.joints.insert(index as u32, 1.0);
        for (side, (dof, a)) in terms {
            let class = classes.class[dof];
            if !classes.held[dof] {
                *row.terms.entry(class).or_default() += a / classes.unit(class);
                if side == 0 {
                    row.node_side.push(class);
                }
            } else if let Some(&settled) = classes.settled.get(&class) {
                // Known, so it stands on the side of the z.
                *row.joints.entry(settled).or_default() -= a;
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

    /// Coefficients come from sines and cosines: what is 0 or ±1 but for a few roundings is just that, so that two
    /// sides that move as one are not strained by it.
    fn drop_rounding(&mut self) {
        for coefficients in [&mut self.terms, &mut self.joints] {
            coefficients.retain(|_, a| a.abs() > 1e-14);
            for a in coefficients.values_mut().filter(|a| (a.abs() - 1.0).abs() < 1e-14) {
                *a = a.signum();
            }
        }
    }
}

/// Joint rows eliminated so far, fully reduced: no slave occurs in another slave's row.
#[derive(Default)]
pub struct JointReduction {
    /// The row of each slave.
    pub slaves: BTreeMap<u32, JointRow>,
    /// Slaves in whose rows a class occurs (may name a slave too many, never one too few).
    users: BTreeMap<u32, Vec<u32>>,
}

impl JointReduction {
    /// Adds a row, or gives the reduced row back if nothing is left of it.
    pub fn add(&mut self, row: JointRow) -> Result<(), JointRow> {
        self.add_above(DEPENDENT, row)
    }

    /// Adds a row of which the other rows leave a good part, or gives the reduced row back.
    pub fn add_clear(&mut self, row: JointRow) -> Result<(), JointRow> {
        self.add_above(CLEAR, row)
    }

    /// Adds a row of which a coefficient of this size is left.
    fn add_above(&mut self, least: f64, mut row: JointRow) -> Result<(), JointRow> {
        let hit: Vec<u32> = row.terms.keys().copied().filter(|class| self.slaves.contains_key(class)).collect();
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
        if largest < least {
            return Err(row);
        }
        let best = |candidates: &mut dyn Iterator<Item = (u32, f64)>| {
            candidates.fold(None::<(u32, f64)>, |best, (class, a)| match best {
                Some((_, b)) if b.abs() >= a.abs() => best,
                _ => Some((class, a)),
            })
        };
        let node_side = best(
            &mut row.terms.iter().filter(|(class, _)| row.node_side.contains(class)).map(|(&class, &a)| (class, a)),
        )
        .filter(|(_, a)| a.abs() >= PREFER_NODE_SIDE * largest);
        let Some((pivot, a)) = node_side.or_else(|| best(&mut row.terms.iter().map(|(&c, &a)| (c, a)))) else {
            return Err(row);
        };
        row.terms.remove(&pivot);
        for value in row.terms.values_mut().chain(row.joints.values_mut()) {
            *value /= a;
        }
        row.drop_rounding();
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
pub fn holders(
    structure: &Structure,
    dofs: &Dofs,
    joints: &[Joint],
    classes: &Classes,
    row: &JointRow,
    joint: &Joint,
) -> Vec<Holder> {
    let Classes { class, held, .. } = classes;
    let mut holders = Vec::new();
    let others = row
        .joints
        .iter()
        .filter(|(_, a)| a.abs() > DEPENDENT)
        // Numbers beyond are imposed displacements and rows of bodies.
        .filter_map(|(j, _)| joints.get(*j as usize))
        .filter(|other| *other != joint);
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
                            component: structure.dimension.word(support.component),
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
                    let used = joint_dofs(joint, dofs).any(|(_, (dof, _))| dofs.of(a, component) == Some(dof));
                    let holder = Holder::Tie {
                        nodes: [a, b].map(|n| structure.nodes[n].id.clone()),
                        component: structure.dimension.word(component),
                    };
                    if used && !holders.contains(&holder) {
                        holders.push(holder);
                    }
                }
            }
        }
    }
    holders.extend(
        involved[1..]
            .iter()
            .map(|other| Holder::Joint { pair: structure.pairs[other.pair].id.clone(), direction: other.direction }),
    );
    if holders.is_empty() {
        // A chain of several ties: name the first tie that has the node.
        let node = joint.terms[0].0;
        if let Some(tie) = structure.ties.iter().find(|tie| tie.nodes.contains(&node)) {
            let other = tie.nodes.iter().copied().find(|&n| n != node);
            holders.push(Holder::Tie {
                nodes: [node, other.unwrap_or(node)].map(|n| structure.nodes[n].id.clone()),
                component: structure.dimension.word(tie.components.first().copied().unwrap_or(Component::X)),
            });
        }
    }
    holders
}
