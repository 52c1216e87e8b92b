//! Numbering of the displacement components.

use super::held_hinges::held_hinges;
use crate::doubled::Real;
use crate::model::pair::Joint;
use crate::model::structure::{Component, Structure};

/// Numbers of the nodal components ("base dofs"): the translations at every node, rotations where a frame bar is
/// rigidly attached, at the nodes of rigid bodies and at [hinges that something holds](held_hinges); of a superelement the
/// components of its rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Dofs {
    first: Vec<u32>,
    /// Whether each component exists: nodes of a superelement have those of its dofs.
    has: Vec<[bool; 6]>,
    count: usize,
    /// Rotations of nodes at which all frame bars are hinged.
    released: usize,
}

impl Dofs {
    /// Numbers the components node by node.
    pub fn new(structure: &Structure) -> Dofs {
        let of = |components: &[Component]| {
            let mut has = [false; 6];
            components.iter().for_each(|&component| has[component as usize] = true);
            has
        };
        let dimension = structure.dimension;
        let mut frame = vec![false; structure.nodes.len()];
        let mut has = match &structure.superelement {
            None => vec![of(dimension.translations()); structure.nodes.len()],
            Some(element) => {
                let mut has = vec![[false; 6]; structure.nodes.len()];
                element.dofs.iter().for_each(|&(node, component)| has[node][component as usize] = true);
                has
            }
        };
        for element in structure.elements.iter().filter(|element| element.bends()) {
            for (end, &node) in element.nodes.iter().enumerate() {
                frame[node] = true;
                element.components(end).iter().for_each(|&component| has[node][component as usize] = true);
            }
        }
        for &node in structure.rigid.iter().flat_map(|body| &body.nodes) {
            has[node] = of(dimension.components());
        }
        for (has, _) in std::iter::zip(&mut has, held_hinges(structure)).filter(|(_, held)| *held) {
            *has = of(dimension.components());
        }
        let mut count = 0;
        let first = has
            .iter()
            .map(|has| {
                let first = count;
                count += has.iter().filter(|has| **has).count();
                first as u32
            })
            .collect();
        let turns = |has: &[bool; 6]| dimension.rotations().iter().any(|&rotation| has[rotation as usize]);
        let only_hinged = std::iter::zip(&frame, &has).filter(|(frame, has)| **frame && !turns(has)).count();
        Dofs { first, has, count, released: only_hinged * dimension.rotations().len() }
    }

    /// Number of base dofs.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Nodal components before supports and ties as they are reported: a frame node counts its rotations even where all
    /// its bars are hinged.
    pub fn unknowns(&self) -> usize {
        self.count + self.released
    }

    /// The base dof of a component; `None` for one that does not exist.
    pub fn of(&self, node: usize, component: Component) -> Option<usize> {
        let (has, at) = (self.has[node], component as usize);
        has[at].then(|| self.first[node] as usize + has[..at].iter().filter(|has| **has).count())
    }

    /// Displacements per node, in the order of [`Component::ALL`], from base dofs; 0 where there is none.
    pub fn scatter<T: Real>(&self, u: &[T]) -> Vec<[T; 6]> {
        let of_node = |(has, &first): (&[bool; 6], &u32)| {
            let mut own = u[first as usize..].iter();
            has.map(|has| if has { own.next().copied().unwrap_or(T::zero()) } else { T::zero() })
        };
        self.has.iter().zip(&self.first).map(of_node).collect()
    }

    /// Base dofs from displacements per node.
    pub fn gather<T: Real>(&self, u: &[[T; 6]]) -> Vec<T> {
        let mut base = vec![T::zero(); self.count];
        for ((has, &first), values) in self.has.iter().zip(&self.first).zip(u) {
            let own = values.iter().zip(has).filter(|(_, has)| **has);
            base[first as usize..].iter_mut().zip(own).for_each(|(base, (value, _))| *base = *value);
        }
        base
    }

    /// Node of each base dof.
    pub fn nodes(&self) -> impl Iterator<Item = usize> + '_ {
        let components = self.has.iter().enumerate();
        components.flat_map(|(node, has)| std::iter::repeat_n(node, has.iter().filter(|has| **has).count()))
    }

    /// Which base dofs are rotations.
    pub fn is_rotation(&self) -> Vec<bool> {
        let components = self.has.iter().flat_map(|has| Component::ALL.into_iter().filter(|&c| has[c as usize]));
        components.map(Component::is_rotation).collect()
    }
}

/// The (side, (base dof, coefficient)) of a joint, zero coefficients left out; side 0 is `node`. Coefficients make
/// lengths of the unknowns: those of translations have no unit, those of rotations are lengths.
pub fn joint_dofs<'a>(joint: &'a Joint, dofs: &'a Dofs) -> impl Iterator<Item = (usize, (usize, f64))> + 'a {
    joint
        .terms
        .iter()
        .enumerate()
        .flat_map(move |(side, (node, a))| {
            let translations = std::iter::zip(Component::TRANSLATIONS, a);
            translations.filter_map(move |(component, a)| Some((side, (dofs.of(*node, component)?, *a))))
        })
        .filter(|(_, (_, a))| *a != 0.0)
}
