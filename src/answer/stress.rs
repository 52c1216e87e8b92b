//! Stresses as they are asked for: components, principal values, von Mises.

use nalgebra::Matrix3;
use serde::ser::{Serialize, SerializeMap, Serializer};

use crate::model::quantity::{Meaning, OfStress};
use crate::model::structure::Dimension;

/// Where a stress stands.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum StressPlace {
    /// At a node: the mean of the elements that meet there.
    Node(String),
    /// In the middle of an element.
    Element(String),
}

/// A stress, tension positive, in the user's units of force per length squared.
#[derive(Clone, Debug, PartialEq)]
pub struct Stress {
    /// Its place.
    pub place: StressPlace,
    dimension: Dimension,
    /// σ_xx, σ_yy, σ_xy, σ_zz, σ_yz, σ_zx.
    components: [f64; 6],
    /// The largest first; in the plane the two there.
    principal: [f64; 3],
}

impl Stress {
    /// From (σ_xx, σ_yy, σ_xy, σ_zz, σ_yz, σ_zx); in the plane the last two are 0.
    pub fn new(dimension: Dimension, place: StressPlace, components: [f64; 6]) -> Stress {
        let [x, y, xy, z, yz, zx] = components;
        let principal = match dimension {
            Dimension::Plane => {
                let (middle, radius) = (0.5 * (x + y), (0.5 * (x - y)).hypot(xy));
                [middle + radius, middle - radius, z]
            }
            Dimension::Space => {
                let mut values: [f64; 3] = Matrix3::new(x, xy, zx, xy, y, yz, zx, yz, z).symmetric_eigenvalues().into();
                values.sort_by(|a, b| b.total_cmp(a));
                values
            }
        };
        Stress { place, dimension, components, principal }
    }

    /// One of its numbers.
    pub fn value(&self, which: OfStress) -> f64 {
        let [x, y, xy, z, yz, zx] = self.components;
        let [first, second, third] = self.principal;
        match which {
            OfStress::X => x,
            OfStress::Y => y,
            OfStress::Z => z,
            OfStress::Xy => xy,
            OfStress::Yz => yz,
            OfStress::Xz => zx,
            OfStress::First => first,
            OfStress::Second => second,
            OfStress::Third => third,
            OfStress::Mises => {
                let distortion = 0.5 * ((x - y).powi(2) + (y - z).powi(2) + (z - x).powi(2));
                (distortion + 3.0 * xy * xy + 3.0 * yz * yz + 3.0 * zx * zx).sqrt()
            }
        }
    }
}

impl Serialize for Stress {
    /// `node` or `element`, then its numbers by their words.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        match &self.place {
            StressPlace::Node(id) => map.serialize_entry("node", id)?,
            StressPlace::Element(name) => map.serialize_entry("element", name)?,
        }
        for which in OfStress::ALL.into_iter().filter(|which| which.is_of(self.dimension)) {
            map.serialize_entry(Meaning::Stress(which).word(), &self.value(which))?;
        }
        map.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pure shears in all three planes: principal values 2τ, −τ, −τ and von Mises 3τ; under even pressure von Mises is
    /// 0.
    #[test]
    fn a_stress_in_space() {
        let at = || StressPlace::Node("n".to_owned());
        let of = |components| {
            let stress = Stress::new(Dimension::Space, at(), components);
            [OfStress::First, OfStress::Second, OfStress::Third, OfStress::Mises].map(|which| stress.value(which))
        };
        let near = |found: [f64; 4], right: [f64; 4]| {
            assert!(found.iter().zip(right).all(|(a, b)| (a - b).abs() < 1e-14), "{found:?} {right:?}");
        };
        near(of([0.0, 0.0, 1.0, 0.0, 1.0, 1.0]), [2.0, -1.0, -1.0, 3.0]);
        near(of([-4.0, -4.0, 0.0, -4.0, 0.0, 0.0]), [-4.0, -4.0, -4.0, 0.0]);
        // 3 along (3, 0, 4)/5.
        near(of([3.0 * 0.36, 0.0, 0.0, 3.0 * 0.64, 0.0, 3.0 * 0.48]), [3.0, 0.0, 0.0, 3.0]);
        let words = serde_json::to_value(Stress::new(Dimension::Space, at(), [1.0, 2.0, 4.0, 3.0, 5.0, 6.0])).unwrap();
        for (word, value) in [("sx", 1.0), ("sy", 2.0), ("sz", 3.0), ("sxy", 4.0), ("syz", 5.0), ("sxz", 6.0)] {
            assert_eq!(words[word], value, "{word}");
        }
    }
}
