//! The internal forces of bars, in the plane and in space.

use crate::model::structure;

/// An internal force of a bar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Internal {
    /// N, tension positive.
    Axial,
    /// Q = dM/dx.
    Shear,
    /// M, positive with tension on the −y side of the bar.
    Moment,
    /// V_z = dM_y/dx of a bar in space.
    ShearZ,
    /// M_y, positive with tension on the −z side of the bar.
    MomentY,
    /// T, along +x on the cut that faces it.
    Torsion,
    /// V_y: Q of a bar in space.
    ShearY,
    /// M_z: M of a bar in space.
    MomentZ,
}

impl Internal {
    /// All three of the plane in the order N, Q, M.
    pub const ALL: [Internal; 3] = [Internal::Axial, Internal::Shear, Internal::Moment];

    /// All six of space in the order of results.
    pub const IN_SPACE: [Internal; 6] =
        [Internal::Axial, Internal::ShearY, Internal::ShearZ, Internal::Torsion, Internal::MomentY, Internal::MomentZ];

    /// Those of a bar in space, or in the plane.
    pub fn of(is_in_space: bool) -> &'static [Internal] {
        if is_in_space { &Internal::IN_SPACE } else { &Internal::ALL }
    }

    /// Its place among the internal forces of a bar element.
    pub fn index(self) -> usize {
        match self {
            Internal::Axial => 0,
            Internal::Shear | Internal::ShearY => 1,
            Internal::Moment | Internal::MomentZ => 2,
            Internal::ShearZ => 3,
            Internal::MomentY => 4,
            Internal::Torsion => 5,
        }
    }

    /// Whether it is a moment.
    pub fn is_moment(self) -> bool {
        matches!(self, Internal::Moment | Internal::MomentZ | Internal::MomentY | Internal::Torsion)
    }

    /// Whether it is a bending moment.
    pub fn is_bending(self) -> bool {
        matches!(self, Internal::Moment | Internal::MomentZ | Internal::MomentY)
    }

    /// What the same picture shows of bars there: M and Q of the plane are M_z and V_y in space.
    pub fn drawn_in(self, dimension: structure::Dimension) -> Internal {
        match (self, dimension) {
            (Internal::Moment, structure::Dimension::Space) => Internal::MomentZ,
            (Internal::Shear, structure::Dimension::Space) => Internal::ShearY,
            _ => self,
        }
    }

    /// Whether bars of the plane, or of space, have it by this name.
    pub fn is_of(self, dimension: structure::Dimension) -> bool {
        Internal::of(dimension == structure::Dimension::Space).contains(&self)
    }

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Internal::Axial => "normal force",
            Internal::Shear => "shear force",
            Internal::Moment => "bending moment",
            Internal::ShearY => "shear force V_y",
            Internal::ShearZ => "shear force V_z",
            Internal::Torsion => "torque",
            Internal::MomentY => "bending moment M_y",
            Internal::MomentZ => "bending moment M_z",
        }
    }
}
