//! From displacements to member forces, stresses and reactions.

use nalgebra::DVector;

use super::displacements::Displacements;
use super::element::bar_load::{Internal, Piece};
use super::element::{Stress, finite_element, slots, spring};
use super::loads::ActingLoads;
use super::main_system::MainSystem;
use crate::doubled::{Doubled, Real};
use crate::model::structure::{Component, Structure};

/// Internal forces of one element of a bar.
#[derive(Clone, Debug, PartialEq)]
pub struct MemberForces {
    /// Index into [`Structure::bars`].
    pub bar: usize,
    /// Element along the bar, from 0.
    pub element: usize,
    /// At its start.
    pub start: Internal,
    /// At its end.
    pub end: Internal,
    /// Exactly in between; ranges are distances from the start of the bar.
    pub pieces: Vec<Piece>,
}

/// Stress of one area or solid element at its centre, tension positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementStress {
    /// Index into [`Structure::elements`].
    pub element: usize,
    /// Its components.
    pub stress: Stress,
}

/// Stress at a node, tension positive: the mean of what the area and solid elements around it say there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeStress {
    /// The node.
    pub node: usize,
    /// Its components.
    pub stress: Stress,
}

/// Force of the supports and springs of a node on the structure, global axes, in the units of the loads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reaction {
    /// The node.
    pub node: usize,
    /// (F_x, F_y, F_z).
    pub force: [f64; 3],
    /// (M_x, M_y, M_z); in the plane M_z alone, counter-clockwise.
    pub moment: [f64; 3],
}

/// Takes out pieces of no length: where a load ends at a node but for the rounding of the distances (few ε of the
/// distance from the start of the bar). Their neighbours meet.
fn take_out_slivers(pieces: &mut Vec<Piece>) {
    let is_sliver = |piece: &Piece| piece.range[1] - piece.range[0] <= 8.0 * f64::EPSILON * piece.range[1].abs();
    let mut kept: Vec<Piece> = Vec::with_capacity(pieces.len());
    let mut from = None;
    for mut piece in pieces.drain(..) {
        if is_sliver(&piece) {
            match kept.last_mut() {
                Some(before) => before.range[1] = piece.range[1],
                None => from = from.or(Some(piece.range[0])),
            }
            continue;
        }
        if let Some(from) = from.take() {
            piece.range[0] = from;
        }
        kept.push(piece);
    }
    *pieces = kept;
}

impl MainSystem {
    /// Internal forces of every bar element under Σ factor·F and the displacements `u`: at both ends and in between.
    pub fn member_forces(&self, structure: &Structure, u: &Displacements, factors: &[f64]) -> Vec<MemberForces> {
        let loads = ActingLoads::of(structure, factors);
        let mut members = Vec::new();
        for (bar, data) in structure.bars.iter().enumerate() {
            let mut from = 0.0;
            for (position, index) in data.elements.clone().enumerate() {
                // A bar without length was refused by its stiffness.
                let Ok(element) = finite_element(structure, index) else { continue };
                let u = own_displacements(structure, index, u);
                let Some(mut forces) = element.bar_forces(&u, loads.on(index)) else { continue };
                for piece in &mut forces.pieces {
                    piece.range = piece.range.map(|s| from + s);
                }
                take_out_slivers(&mut forces.pieces);
                from += forces.length;
                let [start, end] = forces.ends;
                members.push(MemberForces { bar, element: position, start, end, pieces: forces.pieces });
            }
        }
        members
    }

    /// Stresses at the centres of all area and solid elements under the displacements `u` and Σ factor·case.
    pub fn element_stresses(&self, structure: &Structure, u: &Displacements, factors: &[f64]) -> Vec<ElementStress> {
        let loads = ActingLoads::of(structure, factors);
        let stresses = (0..structure.elements.len()).filter_map(|index| {
            let element = finite_element(structure, index).ok()?;
            let stress = element.stress(&own_displacements(structure, index, u), loads.on(index))?;
            Some(ElementStress { element: index, stress })
        });
        stresses.collect()
    }

    /// Stresses at all nodes of area and solid elements, in the order of the nodes: means over the elements that meet
    /// there, each extrapolated from the points where its stresses are best.
    pub fn node_stresses(&self, structure: &Structure, u: &Displacements, factors: &[f64]) -> Vec<NodeStress> {
        let loads = ActingLoads::of(structure, factors);
        let mut sums = vec![(Stress::default(), 0_u32); structure.nodes.len()];
        for (index, element) in structure.elements.iter().enumerate() {
            let Ok(finite) = finite_element(structure, index) else { continue };
            let stresses = finite.node_stresses(&own_displacements(structure, index, u), loads.on(index));
            for (&node, stress) in element.nodes.iter().zip(stresses.into_iter().flatten()) {
                let (sum, count) = &mut sums[node];
                for (sum, stress) in sum.iter_mut().zip(stress) {
                    *sum += stress;
                }
                *count += 1;
            }
        }
        let means = sums.into_iter().enumerate().filter(|(_, (_, count))| *count > 0);
        means
            .map(|(node, (sum, count))| NodeStress { node, stress: sum.map(|stress| stress / f64::from(count)) })
            .collect()
    }

    /// Force, or moment, of every spring, > 0 where it is stretched, in the order of [`Structure::springs`]; on a
    /// term's component it acts with minus the term's factor.
    pub fn spring_forces(&self, structure: &Structure, u: &Displacements) -> Vec<f64> {
        structure.springs.iter().map(|s| spring::force(s, &u.0)).collect()
    }

    /// Forces of the ground on the structure, contact aside: one entry per node that is held by a support or sprung, in
    /// the order of the nodes, for the displacements `u` and the joint forces `lambda` under Σ factor·F. Where a
    /// support holds several tied nodes it carries what they all hand over; if several supports hold them, the first
    /// of those does.
    pub fn reactions(
        &self,
        structure: &Structure,
        u: &Displacements,
        lambda: &DVector<f64>,
        factors: &[f64],
    ) -> Vec<Reaction> {
        let forces = self.unbalanced(u, lambda, factors);
        let rounding = self.rounding(u, factors, None);
        let mut supported = vec![false; forces.len()];
        // The support that takes the forces of the unsupported nodes of a class.
        let mut taker = vec![usize::MAX; forces.len()];
        let mut nodes: Vec<usize> = Vec::new();
        for support in &structure.supports {
            nodes.push(support.node);
            if let Some(dof) = self.dofs.of(support.node, support.component) {
                supported[dof] = true;
                let taker = &mut taker[self.elimination.class(dof)];
                *taker = (*taker).min(dof);
            }
        }
        let mut reaction = vec![0.0; forces.len()];
        let mut noise = vec![0.0; forces.len()];
        for (dof, force) in forces.iter().enumerate() {
            if self.elimination.is_held(dof) {
                // A held class has a support, hence a taker.
                let at = if supported[dof] { dof } else { taker[self.elimination.class(dof)] };
                reaction[at] += force;
                noise[at] += rounding[dof];
            }
        }
        for (spring, force) in std::iter::zip(&structure.springs, self.spring_forces(structure, u)) {
            let node = spring.terms[0].node;
            if !spring.is_to_ground() || structure.yielding_ground.binary_search(&node).is_ok() {
                continue;
            }
            nodes.push(node);
            for term in &spring.terms {
                if let Some(dof) = self.dofs.of(node, term.component) {
                    reaction[dof] -= term.factor * force;
                }
            }
        }
        nodes.sort_unstable();
        nodes.dedup();
        let value = |node, component| {
            let dof = self.dofs.of(node, component);
            // What rounding leaves of the forces that meet there is no reaction.
            dof.filter(|&dof| reaction[dof].abs() > noise[dof]).map_or(0.0, |dof| reaction[dof])
        };
        nodes
            .into_iter()
            .map(|node| Reaction {
                node,
                force: Component::TRANSLATIONS.map(|component| value(node, component)),
                moment: Component::ROTATIONS.map(|component| value(node, component)),
            })
            .collect()
    }
}

/// Displacements of the rows of an element without the motion of its first node (translation, and rotation where it
/// turns): that costs no force, and what is left has lost nothing beside it.
pub(super) fn own_displacements(structure: &Structure, index: usize, u: &Displacements) -> Vec<f64> {
    let element = &structure.elements[index];
    let first = element.nodes[0];
    let slots = slots(element);
    let mut with = u.doubled_at(first);
    for rotation in Component::ROTATIONS {
        if !slots.contains(&(first, rotation)) {
            with[rotation as usize] = Doubled::default();
        }
    }
    let own = slots.iter().map(|&(node, component)| {
        let value = u.doubled_at(node)[component as usize];
        let mut moved = with[component as usize];
        if !component.is_rotation() {
            let place = |node: usize, c: usize| structure.nodes[node].position[c];
            let arm: [Doubled; 3] = std::array::from_fn(|c| Doubled::difference(place(node, c), place(first, c)));
            for (rotation, lever) in component.levers(arm) {
                moved += with[rotation as usize] * lever;
            }
        }
        (value - moved).to_f64()
    });
    own.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_without_length_are_taken_out_and_leave_no_gap() {
        let piece =
            |a: f64, b: f64| Piece { range: [a, b], start: [1.0, 2.0, 3.0, 0.0, 0.0, 0.0], q: [[0.0, -1.0, 0.0]; 2] };
        let beside = |x: f64| x * (1.0 + 2.0 * f64::EPSILON);
        let mut pieces = vec![piece(1.7, 1.7), piece(1.7, 2.0), piece(2.0, beside(2.0)), piece(beside(2.0), 2.5)];
        take_out_slivers(&mut pieces);
        assert_eq!(pieces.iter().map(|p| p.range).collect::<Vec<_>>(), [[1.7, beside(2.0)], [beside(2.0), 2.5]]);
        let mut pieces = vec![piece(0.0, 1e-9), piece(1e-9, 1.0), piece(1.0, 1.0)];
        take_out_slivers(&mut pieces);
        assert_eq!(pieces.iter().map(|p| p.range).collect::<Vec<_>>(), [[0.0, 1e-9], [1e-9, 1.0]]);
    }
}
