//! Length and direction of a bar.

use crate::doubled::Real;

/// Length and direction of a bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis<T = f64> {
    /// Length L.
    pub length: T,
    /// cos of the angle from global x to local x.
    pub cos: T,
    /// sin of it.
    pub sin: T,
}

impl<T: Real> Axis<T> {
    /// From the first end to the second; `None` if they coincide.
    pub fn between([a, b]: [[f64; 2]; 2]) -> Option<Axis<T>> {
        let size = (b[0] - a[0]).hypot(b[1] - a[1]);
        if size == 0.0 {
            return None;
        }
        // A power of two, so that no square is too small or too large for a number.
        let unit = size.log2().round().exp2();
        let [dx, dy] = [0, 1].map(|c| T::difference(b[c], a[c]) / T::from(unit));
        let length = (dx * dx + dy * dy).sqrt();
        Some(Axis { length: length * T::from(unit), cos: dx / length, sin: dy / length })
    }
}

impl Axis {
    /// Components in bar axes (x from start to end, y = x turned +90°) of a global vector.
    pub fn to_local(self, v: [f64; 2]) -> [f64; 2] {
        [self.cos * v[0] + self.sin * v[1], self.cos * v[1] - self.sin * v[0]]
    }

    /// Global components of a vector in bar axes.
    pub fn to_global(self, v: [f64; 2]) -> [f64; 2] {
        [self.cos * v[0] - self.sin * v[1], self.sin * v[0] + self.cos * v[1]]
    }
}
