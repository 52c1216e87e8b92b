//! The numbers of a stress.

use crate::model::structure::Dimension;

/// A stress at a node or in an element, tension positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OfStress {
    /// σ_xx.
    X,
    /// σ_yy.
    Y,
    /// σ_zz.
    Z,
    /// σ_xy.
    Xy,
    /// σ_yz.
    Yz,
    /// σ_xz.
    Xz,
    /// The largest principal stress; in the plane the larger of the two there.
    First,
    /// The second one; in the plane the smaller of the two there.
    Second,
    /// The least one, in space.
    Third,
    /// Equivalent stress of von Mises.
    Mises,
}

impl OfStress {
    /// All of space in the order of results; the plane has some of them.
    pub const ALL: [OfStress; 10] = [
        OfStress::X,
        OfStress::Y,
        OfStress::Z,
        OfStress::Xy,
        OfStress::Yz,
        OfStress::Xz,
        OfStress::First,
        OfStress::Second,
        OfStress::Third,
        OfStress::Mises,
    ];

    /// Whether it is one of the plane, or of space.
    pub fn is_of(self, dimension: Dimension) -> bool {
        dimension == Dimension::Space || !matches!(self, OfStress::Z | OfStress::Yz | OfStress::Xz | OfStress::Third)
    }
}
