//! How a structure is seen: a parallel projection of space on the plane of a picture.

use crate::model::structure::Dimension;
use crate::model::vector::dot;
use crate::text::number::short;

/// Where the viewer stands, infinitely far away; z is up in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// Degrees from x towards y, from −180 (excluded) to 180.
    azimuth: f64,
    /// Degrees above the plane of x and y, from −90 to 90.
    elevation: f64,
}

/// The elevation from which the three axes are equally long: its tangent is 1/√2.
const ISOMETRIC: f64 = 35.264_389_682_754_654;

impl Viewpoint {
    /// The named ones: isometric; from above; along y, seen from −y; along x, seen from +x.
    pub const NAMED: [(&'static str, Viewpoint); 4] = [
        ("ISO", Viewpoint { azimuth: -45.0, elevation: ISOMETRIC }),
        ("XY", Viewpoint { azimuth: -90.0, elevation: 90.0 }),
        ("XZ", Viewpoint { azimuth: -90.0, elevation: 0.0 }),
        ("YZ", Viewpoint { azimuth: 0.0, elevation: 0.0 }),
    ];

    /// From any side; `None` for angles that are not numbers, or for an elevation beyond the vertical.
    pub fn new(azimuth: f64, elevation: f64) -> Option<Viewpoint> {
        let turned = 180.0 - (180.0 - azimuth).rem_euclid(360.0);
        (turned.is_finite() && elevation.abs() <= 90.0).then_some(Viewpoint { azimuth: turned, elevation })
    }

    /// The one of this name, in capitals or not.
    pub fn named(name: &str) -> Option<Viewpoint> {
        let found = Self::NAMED.iter().find(|(word, _)| word.eq_ignore_ascii_case(name));
        found.map(|(_, viewpoint)| *viewpoint)
    }

    /// Turned by these degrees to the right and up; it stops at the vertical.
    pub fn turned(self, right: f64, up: f64) -> Viewpoint {
        Viewpoint::new(self.azimuth + right, (self.elevation + up).clamp(-90.0, 90.0)).unwrap_or(self)
    }

    /// The named one after this one; the first after any other.
    pub fn next(self) -> Viewpoint {
        let at = Self::NAMED.iter().position(|(_, named)| *named == self);
        Self::NAMED[at.map_or(0, |at| (at + 1) % Self::NAMED.len())].1
    }

    /// Azimuth and elevation in degrees.
    pub fn angles(self) -> [f64; 2] {
        [self.azimuth, self.elevation]
    }

    /// `ISO`, `XZ`, `30°, 20°`.
    pub fn words(self) -> String {
        let named = Self::NAMED.iter().find(|(_, named)| *named == self);
        named.map_or_else(
            || format!("{}°, {}°", short(self.azimuth), short(self.elevation)),
            |(word, _)| (*word).to_owned(),
        )
    }
}

impl Default for Viewpoint {
    /// Isometric.
    fn default() -> Self {
        Self::NAMED[0].1
    }
}

/// Unit vectors of a picture in the axes of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    right: [f64; 3],
    up: [f64; 3],
    /// Out of the picture, to the viewer.
    towards: [f64; 3],
}

impl Default for Projection {
    /// That of the plane.
    fn default() -> Self {
        Projection::PLANE
    }
}

impl Projection {
    /// The plane as it is: x to the right, y up.
    pub const PLANE: Projection = Projection { right: [1.0, 0.0, 0.0], up: [0.0, 1.0, 0.0], towards: [0.0, 0.0, 1.0] };

    /// Of space seen from `viewpoint`; a structure in the plane is seen as it is from everywhere.
    pub fn new(dimension: Dimension, viewpoint: Viewpoint) -> Projection {
        if dimension == Dimension::Plane {
            return Projection::PLANE;
        }
        let ((sa, ca), (se, ce)) = (sine_cosine(viewpoint.azimuth), sine_cosine(viewpoint.elevation));
        Projection { right: [-sa, ca, 0.0], up: [-se * ca, -se * sa, ce], towards: [ce * ca, ce * sa, se] }
    }

    /// A place or a vector in the picture: to the right, up, and towards the viewer.
    pub fn seen(&self, at: [f64; 3]) -> [f64; 3] {
        [dot(self.right, at), dot(self.up, at), dot(self.towards, at)]
    }

    /// The same without its depth.
    pub fn flat(&self, at: [f64; 3]) -> (f64, f64) {
        (dot(self.right, at), dot(self.up, at))
    }

    /// Where the axes of the model lead in the picture: `x ↘ y ↗ z ↑`; ⊙ is towards the viewer.
    pub fn axes_in_words(&self) -> String {
        let unit = |c: usize| std::array::from_fn(|k| f64::from(u8::from(k == c)));
        let words: Vec<String> = ["x", "y", "z"]
            .iter()
            .enumerate()
            .map(|(c, name)| format!("{name} {}", arrow(self.seen(unit(c)))))
            .collect();
        words.join(" ")
    }

    /// Whether lengths in the picture are those of the model along two of its axes.
    pub fn is_along_axes(&self) -> bool {
        [self.right, self.up].iter().all(|axis| axis.iter().filter(|entry| **entry != 0.0).count() == 1)
    }
}

/// The sign for a direction in a picture.
fn arrow([x, y, towards]: [f64; 3]) -> char {
    if x.hypot(y) < 0.1 * towards.abs() {
        return if towards > 0.0 { '⊙' } else { '⊗' };
    }
    // eighths of a turn from → on, counter-clockwise
    const SIGNS: [char; 8] = ['→', '↗', '↑', '↖', '←', '↙', '↓', '↘'];
    let eighth = (y.atan2(x) / std::f64::consts::FRAC_PI_4).round().rem_euclid(8.0);
    SIGNS[eighth as usize % 8]
}

/// Sine and cosine of degrees; exact at the multiples of a right angle.
fn sine_cosine(degrees: f64) -> (f64, f64) {
    let turns = (degrees / 90.0).round();
    let (s, c) = (degrees - 90.0 * turns).to_radians().sin_cos();
    match turns.rem_euclid(4.0) as u8 {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn projection(word: &str) -> Projection {
        let (_, viewpoint) = Viewpoint::NAMED.into_iter().find(|(known, _)| *known == word).unwrap();
        Projection::new(Dimension::Space, viewpoint)
    }

    /// The three views along an axis have the coordinates themselves, exactly.
    #[test]
    fn views_along_the_axes_show_two_coordinates() {
        let at = [3.7, -1.3, 0.9];
        assert_eq!(projection("XY").seen(at), [3.7, -1.3, 0.9]);
        assert_eq!(projection("XZ").seen(at), [3.7, 0.9, 1.3]);
        assert_eq!(projection("YZ").seen(at), [-1.3, 0.9, 3.7]);
        for word in ["XY", "XZ", "YZ"] {
            assert!(projection(word).is_along_axes());
        }
        assert!(!projection("ISO").is_along_axes());
    }

    /// In the isometric view every axis is √(2/3) long, x and y lie 30° below and above the horizontal, z upright.
    #[test]
    fn the_isometric_view_shortens_the_axes_alike() {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| projection("ISO").flat(axis));
        for (x, y) in axes {
            assert!((x.hypot(y) - (2.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        }
        for ((x, y), degrees) in axes.into_iter().zip([-30.0, 30.0, 90.0]) {
            assert!((y.atan2(x).to_degrees() - degrees).abs() < 1e-12);
        }
    }

    /// Any view is a turn of space: right, up and towards are orthonormal and right-handed.
    #[test]
    fn views_are_turns() {
        for azimuth in [-180.0, -77.0, 12.5, 90.0, 180.0, 800.0] {
            for elevation in [-90.0, -33.0, 0.0, 61.0, 90.0] {
                let view = Viewpoint::new(azimuth, elevation).unwrap();
                let Projection { right, up, towards } = Projection::new(Dimension::Space, view);
                let third = crate::model::vector::cross(right, up);
                assert!((0..3).all(|c| (third[c] - towards[c]).abs() < 1e-15));
                for (a, b, value) in [(right, right, 1.0), (up, up, 1.0), (right, up, 0.0)] {
                    assert!((dot(a, b) - value).abs() < 1e-15);
                }
            }
        }
        assert_eq!(Viewpoint::new(0.0, 91.0), None);
        assert_eq!(Viewpoint::new(f64::NAN, 0.0), None);
    }

    #[test]
    fn axes_are_told_by_arrows() {
        assert_eq!(projection("ISO").axes_in_words(), "x ↘ y ↗ z ↑");
        assert_eq!(projection("XY").axes_in_words(), "x → y ↑ z ⊙");
        assert_eq!(projection("XZ").axes_in_words(), "x → y ⊗ z ↑");
    }

    #[test]
    fn the_plane_is_seen_as_it_is() {
        let (_, view) = Viewpoint::NAMED[2];
        assert_eq!(Projection::new(Dimension::Plane, view), Projection::PLANE);
        assert_eq!(Projection::PLANE.seen([0.1, -0.7, 0.0]), [0.1, -0.7, 0.0]);
    }

    #[test]
    fn turning_goes_round_and_stops_at_the_vertical() {
        let (_, side) = Viewpoint::NAMED[3];
        assert_eq!(side.turned(-190.0, 100.0).angles(), [170.0, 90.0]);
        assert_eq!(side.turned(180.0, 0.0).angles(), [180.0, 0.0]);
        assert_eq!(side.words(), "YZ");
        assert_eq!(side.turned(15.0, 20.0).words(), "15°, 20°");
        assert_eq!(Viewpoint::default().next().words(), "XY");
        assert_eq!(side.next(), Viewpoint::default());
        assert_eq!(side.turned(1.0, 0.0).next(), Viewpoint::default());
    }
}
