//! Displacements and reactions of nodes.

use super::facts::Facts;
use super::value::NoValue;
use crate::answer::record::{NodeDisplacement, Reaction};
use crate::answer::rounding::{denoised, of_reactions};
use crate::model::quantity::OfNode;
use crate::model::structure::Component;
use crate::model::vector::length;

impl OfNode {
    /// Of a displaced node; `None` for components of a reaction.
    pub fn of(self, node: &NodeDisplacement) -> Option<f64> {
        match self {
            OfNode::Ux => Some(node.ux),
            OfNode::Uy => Some(node.uy),
            OfNode::Rz => Some(node.rz),
            OfNode::Fx | OfNode::Fy | OfNode::M => None,
        }
    }

    /// A component of a reaction, and the scale up to whose rounding it is 0.
    fn of_reaction(self, reaction: &Reaction, [force, moment]: [f64; 2]) -> f64 {
        match self {
            OfNode::Fx => denoised(reaction.fx, force),
            OfNode::Fy => denoised(reaction.fy, force),
            _ => denoised(reaction.m, moment),
        }
    }
}

impl Facts<'_> {
    pub(super) fn of_node(&self, which: OfNode, node: &str) -> Result<f64, NoValue> {
        let component = match which {
            OfNode::Ux => Component::X,
            OfNode::Uy => Component::Y,
            OfNode::Rz => Component::Rz,
            OfNode::Fx | OfNode::Fy | OfNode::M => {
                let reactions = self.reactions()?;
                let found = reactions.iter().find(|reaction| reaction.node == node);
                let found = found.ok_or_else(|| NoValue(format!("no support at node {node}")))?;
                return Ok(which.of_reaction(found, of_reactions(&reactions)));
            }
        };
        let u = self.displacements()?;
        Ok(u.0[self.node(node)?][component as usize])
    }

    /// The largest displacement.
    pub(super) fn largest_displacement(&self) -> Result<f64, NoValue> {
        Ok(self.displacements()?.0.iter().map(|&[x, y, z, ..]| length([x, y, z])).fold(0.0, f64::max))
    }
}
