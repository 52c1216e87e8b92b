//! Pieces of the outside of a mesh by the direction in which they look.

/// A piece of the boundary or of the surface that faces one way.
pub struct Facing<P> {
    /// `top`: that of its outward normal.
    pub direction: &'static str,
    /// `top`, or `top1`, `top2` … where there are several.
    pub name: String,
    /// The edge or the face, with indices into the mesh.
    pub piece: P,
}

impl<P> Facing<P> {
    /// The pieces of one direction in their order, with their names.
    pub(super) fn named(direction: &'static str, pieces: Vec<P>) -> impl Iterator<Item = Facing<P>> {
        let is_single = pieces.len() == 1;
        pieces.into_iter().zip(1..).map(move |(piece, number)| {
            let name = if is_single { direction.to_owned() } else { format!("{direction}{number}") };
            Facing { direction, name, piece }
        })
    }

    /// Whether it is what a name means, alone or with the others of its direction.
    pub fn is_named(&self, name: &str) -> bool {
        self.name == name || self.direction == name
    }
}
