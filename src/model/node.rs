//! Nodes and their displacement components.

/// A node: its name and its place in the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// `A`, `AB/1`, `lower[0,8]`.
    pub id: String,
    /// Coordinates (x, y), in the author's unit of length.
    pub position: [f64; 2],
}

/// One of the displacement components of a node, in the global axes; its number is its place in
/// [`Component::ALL`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Component {
    /// Displacement along x.
    X,
    /// Displacement along y.
    Y,
    /// Rotation, counter-clockwise. Exists only at nodes of frame bars and of rigid bodies.
    R,
}

impl Component {
    /// All of them, in the order of a node's unknowns.
    pub const ALL: [Component; 3] = [Component::X, Component::Y, Component::R];

    /// Those that are lengths, in the order of the coordinates.
    pub const TRANSLATIONS: [Component; 2] = [Component::X, Component::Y];

    /// The words in files.
    pub const WORDS: [(&'static str, Component); 3] = [("x", Component::X), ("y", Component::Y), ("r", Component::R)];

    /// Its word in files.
    pub fn word(self) -> &'static str {
        Component::WORDS[self as usize].0
    }
}
