//! Stresses of membranes and solids, and the state over the whole structure.

use std::collections::HashSet;

use super::facts::Facts;
use super::value::{NoValue, none};
use crate::answer::record::{MemberForces, PairState};
use crate::answer::stress::{Stress, StressPlace};
use crate::fem::{ElementStress, NodeStress};
use crate::model::quantity::{OfStress, Over};
use crate::model::structure::Structure;

/// A state over the whole structure: at every node, in every element and pair.
pub struct Field<'a> {
    /// The structure.
    pub structure: &'a Structure,
    /// Displacements of every node.
    pub displacements: &'a [[f64; 6]],
    /// At the nodes of membranes.
    pub node_stresses: Vec<NodeStress>,
    /// At the centres of membranes.
    pub element_stresses: Vec<ElementStress>,
    /// Of the bars, element by element.
    pub members: &'a [MemberForces],
    /// The pairs, in the order of the structure.
    pub pairs: &'a [PairState],
}

impl Facts<'_> {
    pub(super) fn at_node(&self, which: OfStress, node: &str) -> Result<f64, NoValue> {
        let at = self.node(node)?;
        let dimension = self.structure()?.0.dimension;
        let found = self.node_stresses()?.into_iter().find(|stress| stress.node == at);
        let found = found.ok_or_else(|| NoValue(format!("no plate, quad, triangle or solid at node {node}")))?;
        Ok(Stress::new(dimension, StressPlace::Node(node.to_owned()), found.stress).value(which))
    }

    pub(super) fn in_element(&self, which: OfStress, name: &str) -> Result<f64, NoValue> {
        let structure = self.structure()?.0;
        let element = structure.element_named(name);
        let element = element.ok_or_else(|| NoValue(format!("no element {name}")))?;
        let found = self.element_stresses()?.into_iter().find(|stress| stress.element == element);
        let found = found.ok_or_else(|| self.missing())?;
        Ok(Stress::new(structure.dimension, StressPlace::Element(name.to_owned()), found.stress).value(which))
    }

    /// The largest or least of a stress over the nodes of areas and solids, each the mean of the elements around it, and
    /// the first node at which it stands.
    pub(super) fn extreme_stress(
        &self,
        over: Over,
        which: OfStress,
        body: Option<&str>,
    ) -> Result<(f64, String), NoValue> {
        let (structure, _) = self.structure()?;
        let inside = body.map(|body| {
            let elements = structure.elements_of_body(body).unwrap_or_default();
            let nodes = elements.iter().flat_map(|&element| &structure.elements[element].nodes);
            nodes.copied().collect::<HashSet<usize>>()
        });
        let mut best: Option<(f64, usize)> = None;
        for at in self.node_stresses()? {
            if inside.as_ref().is_some_and(|inside| !inside.contains(&at.node)) {
                continue;
            }
            let id = structure.nodes[at.node].id.clone();
            let value = Stress::new(structure.dimension, StressPlace::Node(id), at.stress).value(which);
            let is_better = best.is_none_or(|(best, _)| if over == Over::Min { value < best } else { value > best });
            best = if is_better { Some((value, at.node)) } else { best };
        }
        match best {
            Some((value, node)) => Ok((value, structure.nodes[node].id.clone())),
            None => none("no plate, quad, triangle or solid in the structure"),
        }
    }

    fn node_stresses(&self) -> Result<Vec<NodeStress>, NoValue> {
        let (structure, main) = self.structure()?;
        Ok(main.node_stresses(structure, self.displacements()?, &self.factors))
    }

    fn element_stresses(&self) -> Result<Vec<ElementStress>, NoValue> {
        let (structure, main) = self.structure()?;
        Ok(main.element_stresses(structure, self.displacements()?, &self.factors))
    }

    /// The stresses at the nodes of membranes and solids, then those in the elements; empty where there are none.
    pub fn stresses(&self) -> Vec<Stress> {
        let (Ok((structure, _)), Ok(nodes), Ok(elements)) =
            (self.structure(), self.node_stresses(), self.element_stresses())
        else {
            return Vec::new();
        };
        let at_nodes = nodes.into_iter().map(|at| (StressPlace::Node(structure.nodes[at.node].id.clone()), at.stress));
        let inside = elements
            .into_iter()
            .filter_map(|at| Some((StressPlace::Element(structure.element_name(at.element)?), at.stress)));
        at_nodes.chain(inside).map(|(place, stress)| Stress::new(structure.dimension, place, stress)).collect()
    }

    /// The state over the whole structure.
    ///
    /// # Errors
    /// No structure, or no displacements.
    pub fn field(&self) -> Result<Field<'_>, NoValue> {
        let ((structure, main), u) = (self.structure()?, self.displacements()?);
        Ok(Field {
            structure,
            displacements: &u.0,
            node_stresses: main.node_stresses(structure, u, &self.factors),
            element_stresses: main.element_stresses(structure, u, &self.factors),
            members: self.members()?,
            pairs: self.pairs,
        })
    }
}
