//! The plane or space, and what a structure has in each.

use super::node::Component;
use super::vector::{cross, dot, unit};

/// Where a structure lies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dimension {
    /// In the plane z = 0; nothing moves out of it.
    #[default]
    Plane,
    /// In space.
    Space,
}

impl Dimension {
    /// The components that a node can have, in the order of its unknowns.
    pub fn components(self) -> &'static [Component] {
        match self {
            Dimension::Plane => &[Component::X, Component::Y, Component::Rz],
            Dimension::Space => &Component::ALL,
        }
    }

    /// Those that are lengths, one for each coordinate.
    pub fn translations(self) -> &'static [Component] {
        match self {
            Dimension::Plane => &[Component::X, Component::Y],
            Dimension::Space => &Component::TRANSLATIONS,
        }
    }

    /// Those that are rotations.
    pub fn rotations(self) -> &'static [Component] {
        &self.components()[self.translations().len()..]
    }

    /// Number of coordinates.
    pub fn coordinates(self) -> usize {
        self.translations().len()
    }

    /// The coordinates or entries that files and results show: (x, y) in the plane.
    pub fn shown<T>(self, vector: [T; 3]) -> Vec<T> {
        vector.into_iter().take(self.coordinates()).collect()
    }

    /// `the plane`, `space`.
    pub fn in_which(self) -> &'static str {
        match self {
            Dimension::Plane => "the plane",
            Dimension::Space => "space",
        }
    }

    /// A vector as it stands in messages: `(0.6, 0.8)`.
    pub fn in_words(self, vector: [f64; 3]) -> String {
        let entries: Vec<String> = self.shown(vector).iter().map(f64::to_string).collect();
        format!("({})", entries.join(", "))
    }

    /// The word for a component in files and messages: `x`, `y` and `r` in the plane, `x` … `rz` in space.
    pub fn word(self, component: Component) -> &'static str {
        match (self, component) {
            (_, Component::X) => "x",
            (_, Component::Y) => "y",
            (_, Component::Z) => "z",
            (_, Component::Rx) => "rx",
            (_, Component::Ry) => "ry",
            (Dimension::Plane, Component::Rz) => "r",
            (Dimension::Space, Component::Rz) => "rz",
        }
    }

    /// The words in files.
    pub fn words(self) -> Vec<(&'static str, Component)> {
        self.components().iter().map(|&component| (self.word(component), component)).collect()
    }

    /// The words in quotation marks, for messages: `"x", "y", "r"`.
    pub fn quoted_words(self) -> String {
        let words: Vec<String> = self.words().into_iter().map(|(word, _)| format!("\"{word}\"")).collect();
        words.join(", ")
    }

    /// In how many directions a pair slips.
    pub fn slips(self) -> usize {
        match self {
            Dimension::Plane => 1,
            Dimension::Space => 2,
        }
    }

    /// Unit tangents of the plane of contact with the unit normal `n`. In the plane its t: n turned by −90°
    /// (clockwise), n = (0, 1) gives t = (1, 0). In space t1, the projection of the global x on the plane of contact
    /// (of y where n ∥ x), and t2 = n × t1.
    pub fn tangents(self, n: [f64; 3]) -> Vec<[f64; 3]> {
        match self {
            Dimension::Plane => vec![[n[1], -n[0], 0.0]],
            Dimension::Space => {
                let x = [1.0, 0.0, 0.0];
                let along = projection(x, n).unwrap_or_else(|| projection([0.0, 1.0, 0.0], n).unwrap_or(x));
                vec![along, cross(n, along)]
            }
        }
    }
}

/// The unit vector along the projection of `a` on the plane with the unit normal `n`; `None` where they are parallel,
/// but for the rounding of n.
pub fn projection(a: [f64; 3], n: [f64; 3]) -> Option<[f64; 3]> {
    let along = dot(a, n);
    let rest = std::array::from_fn(|c| a[c] - along * n[c]);
    unit(rest).filter(|_| dot(rest, rest) > 64.0 * f64::EPSILON * dot(a, a))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tangents_in_space_are_right_handed_and_begin_with_x_where_they_can() {
        let tangents = |n| Dimension::Space.tangents(n);
        assert_eq!(tangents([0.0, 0.0, 1.0]), [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        assert_eq!(tangents([1.0, 0.0, 0.0]), [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        assert_eq!(tangents([0.0, -1.0, 0.0]), [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
        let n = [0.6, 0.0, 0.8];
        for (found, right) in tangents(n).into_iter().flatten().zip([0.8, 0.0, -0.6, 0.0, 1.0, 0.0]) {
            assert!((found - right).abs() < 1e-15);
        }
    }

    #[test]
    fn the_tangent_of_the_plane_is_the_normal_turned_clockwise() {
        assert_eq!(Dimension::Plane.tangents([0.6, 0.8, 0.0]), [[0.8, -0.6, 0.0]]);
    }
}
