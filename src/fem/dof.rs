//! Numbering of the displacement components.

use crate::doubled::Real;
use crate::model::pair::Joint;
use crate::model::structure::{Component, Structure};

/// Numbers of the nodal components ("base dofs"): x, y at every node, r where a frame bar is rigidly attached
/// and at the nodes of rigid bodies; of a superelement what its rows are.
#[derive(Clone, Debug, PartialEq)]
pub struct Dofs {
    first: Vec<u32>,
    /// Whether there are x, y, r: nodes of a superelement have those of its dofs.
    has: Vec<[bool; 3]>,
    count: usize,
    frame_nodes_only_hinged: usize,
}

impl Dofs {
    /// Numbers the components node by node.
    pub fn new(structure: &Structure) -> Dofs {
        let mut frame = vec![false; structure.nodes.len()];
        let mut has_rotation = vec![false; structure.nodes.len()];
        for element in &structure.elements {
            if element.bends() {
                for (end, &node) in element.nodes.iter().enumerate() {
                    frame[node] = true;
                    has_rotation[node] |= element.components(end).contains(&Component::R);
                }
            }
        }
        let mut has: Vec<[bool; 3]> = match &structure.superelement {
            None => has_rotation.iter().map(|&rotation| [true, true, rotation]).collect(),
            Some(element) => {
                let mut has = vec![[false; 3]; structure.nodes.len()];
                element.dofs.iter().for_each(|&(node, component)| has[node][component as usize] = true);
                has
            }
        };
        for &node in structure.rigid.iter().flat_map(|body| &body.nodes) {
            has[node] = [true; 3];
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
        let frame_nodes_only_hinged =
            std::iter::zip(&frame, &has).filter(|(frame, [.., rotation])| **frame && !*rotation).count();
        Dofs { first, has, count, frame_nodes_only_hinged }
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

    /// The base dof of a component; `None` for one that does not exist.
    pub fn of(&self, node: usize, component: Component) -> Option<usize> {
        let (has, at) = (self.has[node], component as usize);
        has[at].then(|| self.first[node] as usize + has[..at].iter().filter(|has| **has).count())
    }

    /// Displacements [u_x, u_y, θ] per node from base dofs; 0 where there is none.
    pub fn scatter<T: Real>(&self, u: &[T]) -> Vec<[T; 3]> {
        let value = |node: usize, component| self.of(node, component).map_or(T::zero(), |dof| u[dof]);
        (0..self.has.len()).map(|node| Component::ALL.map(|component| value(node, component))).collect()
    }

    /// Base dofs from displacements per node.
    pub fn gather<T: Real>(&self, u: &[[T; 3]]) -> Vec<T> {
        let mut base = vec![T::zero(); self.count];
        for (node, values) in u.iter().enumerate() {
            for (component, value) in Component::ALL.into_iter().zip(values) {
                if let Some(dof) = self.of(node, component) {
                    base[dof] = *value;
                }
            }
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
        let mut rotations = vec![false; self.count];
        for dof in (0..self.has.len()).filter_map(|node| self.of(node, Component::R)) {
            rotations[dof] = true;
        }
        rotations
    }
}

/// The (side, (base dof, coefficient)) of a joint, zero coefficients left out; side 0 is `node`.
pub fn joint_dofs<'a>(joint: &'a Joint, dofs: &'a Dofs) -> impl Iterator<Item = (usize, (usize, f64))> + 'a {
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
