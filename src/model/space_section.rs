//! Bars in space: cross-section, and how their ends are joined.

/// Cross-section of a frame bar in space, along its local axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceSection {
    /// Area.
    pub area: f64,
    /// Second moment of area ∫ z² dA, which bends in the local x–z plane.
    pub inertia_y: f64,
    /// Second moment of area ∫ y² dA, which bends in the local x–y plane.
    pub inertia_z: f64,
    /// Torsion constant J: T = G J θ'.
    pub torsion: f64,
    /// Shear area for V_y; `None` for a bar that does not yield to it.
    pub shear_area_y: Option<f64>,
    /// Shear area for V_z likewise.
    pub shear_area_z: Option<f64>,
}

/// How an end of a frame bar in space is joined to its node.
///
/// A hinge releases both bending moments; the torque stays as long as the node has rotations that can take it, which is
/// what pins and cleats of buildings do, and keeps a bar with hinges at both ends from spinning. Where every bar of a
/// node is hinged there and nothing else holds its rotations, the node has none: a torque has nothing to act on, and
/// rotations held by the torques of hinged bars alone would leave the joint loose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EndJoint {
    /// It turns with its node.
    Rigid,
    /// M_y = M_z = 0; it turns with its node about its own axis.
    Hinge,
    /// M_y = M_z = T = 0: its node has no rotations.
    Ball,
}
