//! Displacements and reactions of nodes.

use super::facts::Facts;
use super::value::NoValue;
use crate::answer::record::{NodeDisplacement, Reaction};
use crate::answer::rounding::{denoised, of_reactions};
use crate::model::quantity::{Meaning, OfNode};
use crate::model::vector::length;

impl OfNode {
    /// Of a displaced node, a length or radians; `None` for components of a reaction.
    pub fn of(self, node: &NodeDisplacement) -> Option<f64> {
        self.displaced().map(|component| node.all()[component as usize])
    }

    /// A component of a reaction, and the scale up to whose rounding it is 0.
    fn of_reaction(self, reaction: &Reaction, [force, moment]: [f64; 2]) -> f64 {
        let ([fx, fy, fz], [mx, my, mz]) = (reaction.force(), reaction.moment());
        match self {
            OfNode::Fx => denoised(fx, force),
            OfNode::Fy => denoised(fy, force),
            OfNode::Fz => denoised(fz, force),
            OfNode::Mx => denoised(mx, moment),
            OfNode::My => denoised(my, moment),
            _ => denoised(mz, moment),
        }
    }
}

impl Facts<'_> {
    pub(super) fn of_node(&self, which: OfNode, node: &str) -> Result<f64, NoValue> {
        let (_, main) = self.structure()?;
        let Some(component) = which.displaced() else {
            let reactions = self.reactions()?;
            let found = reactions.iter().find(|reaction| reaction.node == node);
            let found = found.ok_or_else(|| NoValue(format!("no support at node {node}")))?;
            return Ok(which.of_reaction(found, of_reactions(&reactions)));
        };
        let at = self.node(node)?;
        if !main.has(at, component) {
            return Err(NoValue(match component.is_rotation() {
                true => format!(
                    "the node {node} has no rotation: no frame bar is rigidly attached to it, and it is of no rigid body"
                ),
                false => {
                    format!("the node {node} has no {}: the superelement leaves it out", Meaning::Node(which).word())
                }
            }));
        }
        Ok(self.displacements()?.0[at][component as usize])
    }

    /// The largest displacement, and the first node at which it stands.
    pub(super) fn largest_displacement(&self) -> Result<(f64, String), NoValue> {
        let (structure, u) = (self.structure()?.0, self.displacements()?);
        let sizes = u.0.iter().map(|&[x, y, z, ..]| length([x, y, z])).zip(&structure.nodes);
        let most = sizes.reduce(|most, next| if next.0 > most.0 { next } else { most });
        most.map(|(size, node)| (size, node.id.clone())).ok_or_else(|| self.missing())
    }
}
