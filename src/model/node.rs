//! Nodes and their displacement components.

use std::ops::Neg;

/// A node: its name and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// `A`, `AB/1`, `lower[0,8]`.
    pub id: String,
    /// Coordinates (x, y, z), in the author's unit of length; z = 0 in the plane.
    pub position: [f64; 3],
}

impl Node {
    /// (x, y), where nothing has a z.
    pub fn in_plane(&self) -> [f64; 2] {
        let [x, y, _] = self.position;
        [x, y]
    }
}

/// One of the displacement components of a node, in the global axes; its number is its place in
/// [`Component::ALL`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Component {
    /// Displacement along x.
    X,
    /// Displacement along y.
    Y,
    /// Displacement along z.
    Z,
    /// Rotation about x. Rotations exist only at nodes of frame bars and of rigid bodies.
    Rx,
    /// Rotation about y.
    Ry,
    /// Rotation about z; in the plane the only one, counter-clockwise.
    Rz,
}

impl Component {
    /// All of them, in the order of a node's unknowns.
    pub const ALL: [Component; 6] =
        [Component::X, Component::Y, Component::Z, Component::Rx, Component::Ry, Component::Rz];

    /// Those that are lengths, in the order of the coordinates.
    pub const TRANSLATIONS: [Component; 3] = [Component::X, Component::Y, Component::Z];

    /// The rotations about the axes, in the order of the coordinates.
    pub const ROTATIONS: [Component; 3] = [Component::Rx, Component::Ry, Component::Rz];

    /// Whether it is a rotation.
    pub fn is_rotation(self) -> bool {
        self >= Component::Rx
    }

    /// Its axis: 0, 1, 2 for x, y, z.
    pub fn axis(self) -> usize {
        self as usize % 3
    }

    /// Translation of a point at the end of `arm` from the place that turns: what a unit of each rotation does to this
    /// translation, (ω × arm) along its axis.
    pub fn levers<T: Copy + Neg<Output = T>>(self, arm: [T; 3]) -> [(Component, T); 2] {
        let [x, y, z] = arm;
        match self.axis() {
            0 => [(Component::Ry, z), (Component::Rz, -y)],
            1 => [(Component::Rx, -z), (Component::Rz, x)],
            _ => [(Component::Rx, y), (Component::Ry, -x)],
        }
    }
}
