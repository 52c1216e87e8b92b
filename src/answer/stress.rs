//! Stresses in the plane as they are asked for: components, principal values, von Mises.

use serde::Serialize;

/// Where a stress stands.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum StressPlace {
    /// At a node: the mean of the elements that meet there.
    Node(String),
    /// In the middle of an element.
    Element(String),
}

/// A stress, tension positive, in the user's units of force per length squared.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stress {
    /// Its place.
    #[serde(flatten)]
    pub place: StressPlace,
    /// σ_xx.
    pub sx: f64,
    /// σ_yy.
    pub sy: f64,
    /// σ_xy.
    pub sxy: f64,
    /// The larger principal stress in the plane, s1 ≥ s2.
    pub s1: f64,
    /// The smaller one.
    pub s2: f64,
    /// Equivalent stress of von Mises, with σ_zz; ≥ 0.
    pub mises: f64,
}

impl Stress {
    /// From (σ_xx, σ_yy, σ_xy, σ_zz, …).
    pub fn new(place: StressPlace, [x, y, xy, z, ..]: [f64; 6]) -> Stress {
        let (middle, radius) = (0.5 * (x + y), (0.5 * (x - y)).hypot(xy));
        let distortion = 0.5 * ((x - y).powi(2) + (y - z).powi(2) + (z - x).powi(2)) + 3.0 * xy * xy;
        Stress { place, sx: x, sy: y, sxy: xy, s1: middle + radius, s2: middle - radius, mises: distortion.sqrt() }
    }
}
