//! Length and local axes of a bar, in the plane and in space.

use crate::doubled::Real;

/// A bar counts as upright, and a given orientation as along the bar, where the sine of the angle between them is below
/// this (as in the CSI Analysis Reference Manual, "Local Coordinate System" of frames): local axes are known to ε over
/// it.
const UPRIGHT: f64 = 1e-3;

/// Length of a bar and unit vectors along its axes, in global components.
///
/// Local x runs from start to end. In the plane y is x turned +90°. In space z = x × y, and y lies where x and the
/// orientation of the bar say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BarAxes<T = f64> {
    /// Length L.
    pub length: T,
    /// Along the bar.
    pub x: [T; 3],
    /// Across it.
    pub y: [T; 3],
    /// Across it; in the plane out of the plane.
    pub z: [T; 3],
}

/// Why a bar in space has no axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxesFault {
    /// Its ends are at one place.
    NoLength,
    /// Its orientation points along the bar, or nowhere.
    Orientation,
}

impl AxesFault {
    /// In words that follow the bar's name.
    pub fn words(self) -> &'static str {
        match self {
            AxesFault::NoLength => "its two nodes are at the same place",
            AxesFault::Orientation => "its orientation points along it, and should lie across it",
        }
    }
}

impl<T: Real> BarAxes<T> {
    /// The axes of a bar in the plane; `None` if its ends coincide.
    pub fn in_plane(ends: [[f64; 2]; 2]) -> Option<BarAxes<T>> {
        let (length, [cos, sin, _]) = direction(ends.map(|[x, y]| [x, y, 0.0]))?;
        let (o, one) = (T::zero(), T::one());
        Some(BarAxes { length, x: [cos, sin, o], y: [-sin, cos, o], z: [o, o, one] })
    }

    /// The axes of a bar in space. `orientation` is any vector in its local x–y plane, on the side of +y; without one
    /// it is global z, for [upright](is_upright) bars global x.
    ///
    /// # Errors
    /// See [`AxesFault`].
    pub fn in_space(ends: [[f64; 3]; 2], orientation: Option<[f64; 3]>) -> Result<BarAxes<T>, AxesFault> {
        let (length, x) = direction(ends).ok_or(AxesFault::NoLength)?;
        let guide = orientation.unwrap_or(if is_upright(ends) { [1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0] });
        let (_, guide) = direction([[0.0; 3], guide]).ok_or(AxesFault::Orientation)?;
        let across: [T; 3] = cross(x, guide);
        let sine = dot(across, across).sqrt();
        if sine.to_f64().is_nan() || sine.to_f64() < UPRIGHT {
            return Err(AxesFault::Orientation);
        }
        // `across` is square to x but for ε over the sine; y is so to ε, and z = x × y to both.
        let y = cross(across.map(|value| value / sine), x);
        let size = dot(y, y).sqrt();
        let y = y.map(|value| value / size);
        Ok(BarAxes { length, x, y, z: cross(x, y) })
    }

    /// Components along the axes of a global vector.
    pub fn to_local(&self, v: [T; 3]) -> [T; 3] {
        [dot(self.x, v), dot(self.y, v), dot(self.z, v)]
    }

    /// Global components of a vector given along the axes.
    pub fn to_global(&self, v: [T; 3]) -> [T; 3] {
        [0, 1, 2].map(|c| self.x[c] * v[0] + self.y[c] * v[1] + self.z[c] * v[2])
    }
}

/// Whether a bar is upright, so that global z gives it no orientation.
pub fn is_upright([a, b]: [[f64; 3]; 2]) -> bool {
    let level = (b[0] - a[0]).hypot(b[1] - a[1]);
    level < UPRIGHT * level.hypot(b[2] - a[2])
}

/// Length and unit vector from the first end to the second; `None` if the ends coincide.
pub fn direction<T: Real>([a, b]: [[f64; 3]; 2]) -> Option<(T, [T; 3])> {
    let size = (b[0] - a[0]).hypot(b[1] - a[1]).hypot(b[2] - a[2]);
    if size == 0.0 {
        return None;
    }
    // A power of two, so that no square is too small or too large for a number.
    let unit = size.log2().round().exp2();
    let d = [0, 1, 2].map(|c| T::difference(b[c], a[c]) / T::from(unit));
    let length = dot(d, d).sqrt();
    Some((length * T::from(unit), d.map(|d| d / length)))
}

fn dot<T: Real>(a: [T; 3], b: [T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::doubled::Doubled;

    fn axes(end: [f64; 3], orientation: Option<[f64; 3]>) -> Result<BarAxes, AxesFault> {
        BarAxes::in_space([[0.0; 3], end], orientation)
    }

    /// A level bar has z up as its local y, an upright one global x; z = x × y.
    #[test]
    fn axes_without_an_orientation() {
        let level = axes([0.0, 2.0, 0.0], None).unwrap();
        assert_eq!((level.length, level.x, level.y), (2.0, [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]));
        assert_eq!(level.z, [1.0, 0.0, 0.0]);
        let upright = axes([0.0, 0.0, -3.0], None).unwrap();
        assert_eq!((upright.y, upright.z), ([1.0, 0.0, 0.0], [0.0, -1.0, 0.0]));
        // On both sides of the sine that tells them apart.
        assert!(is_upright([[0.0; 3], [0.0, 0.99e-3, 1.0]]) && !is_upright([[0.0; 3], [0.0, 1.01e-3, 1.0]]));
        assert!((axes([0.0, 1.01e-3, 1.0], None).unwrap().y[1] + 1.0).abs() < 1e-6);
    }

    /// Any bar, however long, with an orientation at any angle down to the least: orthonormal to rounding,
    /// right-handed, y on the side of the orientation and in its plane; doubled precision says the same.
    #[test]
    fn axes_are_orthonormal() {
        let ends = [[0.3, -0.7, 0.2], [1e-50, 2e-50, -3e-50], [4e50, 1e50, 1e48]];
        for end in ends {
            let x = axes(end, None).unwrap().x;
            for guide in [[0.0, 1.0, 0.5], [-2e9, 1e9, 7e8], [x[0] + 2e-3, x[1] - 1e-3, x[2] + 1e-3]] {
                let axes = axes(end, Some(guide)).unwrap();
                let doubled = BarAxes::<Doubled>::in_space([[0.0; 3], end], Some(guide)).unwrap();
                let rows = [axes.x, axes.y, axes.z];
                for (i, a) in rows.iter().enumerate() {
                    for (j, b) in rows.iter().enumerate() {
                        // Products of unit vectors that are rounded in their last digits.
                        assert!((dot(*a, *b) - f64::from(i == j)).abs() < 8.0 * f64::EPSILON, "{end:?} {guide:?}");
                    }
                }
                assert!(dot(axes.y, guide) > 0.0);
                let size = dot(guide, guide).sqrt();
                // The plane of x and the orientation is known to ε over their sine.
                assert!(dot(axes.z, guide).abs() < 16.0 * f64::EPSILON / UPRIGHT * size);
                assert!((0..3).all(|c| (doubled.y[c].to_f64() - axes.y[c]).abs() < 16.0 * f64::EPSILON / UPRIGHT));
                let v = [0.4, -1.3, 2.2];
                let back = axes.to_global(axes.to_local(v));
                assert!((0..3).all(|c| (back[c] - v[c]).abs() < 1e-14));
            }
        }
    }

    #[test]
    fn bars_without_axes() {
        assert_eq!(axes([0.0; 3], None), Err(AxesFault::NoLength));
        for guide in [[0.0; 3], [2.0, 0.0, 0.0], [-1.0, 0.0, 0.9e-3], [f64::NAN, 0.0, 0.0]] {
            assert_eq!(axes([1.0, 0.0, 0.0], Some(guide)), Err(AxesFault::Orientation), "{guide:?}");
        }
    }

    /// The axes of the plane are those of space with an orientation in the plane, to the last digit.
    #[test]
    fn the_plane_in_space() {
        let ends = [[0.1, 0.2], [-1.7, 0.9]];
        let plane = BarAxes::<f64>::in_plane(ends).unwrap();
        let space = axes([-1.7 - 0.1, 0.9 - 0.2, 0.0], Some(plane.y)).unwrap();
        assert_eq!(plane.length, space.length);
        for (a, b) in [(plane.x, space.x), (plane.y, space.y), (plane.z, space.z)] {
            assert!((0..3).all(|c| (a[c] - b[c]).abs() < 4.0 * f64::EPSILON));
        }
    }
}
