//! Displacements per node.

use crate::doubled::Doubled;

/// Displacements per node in the order of `Component::ALL`, 0 where there is none; and, where the main system
/// is solved in doubled precision, what f64 leaves of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Displacements(pub Vec<[f64; 6]>, pub(super) Option<Tail>);

/// The second half of displacements in doubled precision.
#[derive(Clone, Debug, PartialEq)]
pub struct Tail {
    /// Per node.
    pub(super) values: Vec<[f64; 6]>,
    /// What is left of the energy of their error, as the solver sees it.
    pub(super) error: f64,
}

impl From<Vec<[f64; 6]>> for Displacements {
    fn from(nodes: Vec<[f64; 6]>) -> Displacements {
        Displacements(nodes, None)
    }
}

impl Displacements {
    /// In doubled precision.
    pub(super) fn doubled(&self) -> Vec<[Doubled; 6]> {
        (0..self.0.len()).map(|node| self.doubled_at(node)).collect()
    }

    /// The same of one node.
    pub(super) fn doubled_at(&self, node: usize) -> [Doubled; 6] {
        let tail = self.1.as_ref().map_or([0.0; 6], |tail| tail.values[node]);
        std::array::from_fn(|c| Doubled::sum(self.0[node][c], tail[c]))
    }
}
