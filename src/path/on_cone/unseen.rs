//! What a pair does and undoes between two places of a path.
//!
//! What is left of every inequality that keeps a pair in its state, a gap, a contact force, a reserve or the length of a
//! slip, is followed from place to place. Where a parabola through three of them dips towards 0, the place of its bottom is
//! looked at: it may lie beyond.

use super::over::Path;
use super::stand::Stand;
use crate::path::cone_step::{Stepper, margins};
use crate::path::start::PathError;

/// A margin whose parabola falls below this share of what was found so far is looked at there.
const DIPS: f64 = 0.5;
/// Looks at one dip.
const LOOKS: usize = 12;

/// What was found between places in one scheme.
pub(super) struct Dip {
    /// In another scheme.
    pub(super) there: Stand,
    /// Whether it lies before the middle of the three places.
    pub(super) before: bool,
}

/// Where the parabola through three points, with the places in order, is least, and its value there; `None` where that is
/// not between the first and the last.
fn bottom([(a, f), (b, g), (c, h)]: [(f64, f64); 3]) -> Option<(f64, f64)> {
    let (first, second) = ((g - f) / (b - a), (h - g) / (c - b));
    let curvature = (second - first) / (c - a);
    if curvature <= 0.0 {
        return None;
    }
    let at = 0.5 * (a + b) - 0.5 * first / curvature;
    let inside = (at - a) * (at - c) < 0.0 && at != b;
    inside.then_some((at, f + (at - a) * (first + curvature * (at - b))))
}

impl Path<'_> {
    /// A place between these three, which are in one scheme and in order, where another holds; `None` where none was found.
    pub(super) fn unseen(&self, stepper: &Stepper<'_>, three: [&Stand; 3]) -> Result<Option<Dip>, PathError> {
        for pair in 0..three[1].place.pairs.len() {
            for part in 0..2 {
                if let Some(dip) = self.dip(stepper, three, (pair, part))? {
                    return Ok(Some(dip));
                }
            }
        }
        Ok(None)
    }

    /// The same by one margin of one pair.
    fn dip(
        &self,
        stepper: &Stepper<'_>,
        three: [&Stand; 3],
        (pair, part): (usize, usize),
    ) -> Result<Option<Dip>, PathError> {
        let margin = |stand: &Stand| Some((stand.place.value, margins(&stand.place.pairs[pair])[part]?));
        let [Some(a), Some(b), Some(c)] = three.map(margin) else { return Ok(None) };
        let mut points = [a, b, c];
        // Places looked at on the way, between which guesses are made.
        let mut known: Vec<Stand> = Vec::new();
        for _ in 0..LOOKS {
            let least = points.iter().fold(f64::INFINITY, |least: f64, point| least.min(point.1));
            let Some((at, _)) = bottom(points).filter(|(_, value)| *value < DIPS * least) else { return Ok(None) };
            let nearest = known
                .iter()
                .chain(three)
                .min_by(|a, b| (a.place.value - at).abs().total_cmp(&(b.place.value - at).abs()));
            let Some(nearest) = nearest else { return Ok(None) };
            let Some(found) = self.near(stepper, at, &nearest.step.z)? else { return Ok(None) };
            if found.step.scheme != three[1].step.scheme {
                let before = (at - a.0) * (at - b.0) < 0.0;
                return Ok(Some(Dip { there: found, before }));
            }
            let Some(point) = margin(&found) else { return Ok(None) };
            known.push(found);
            points = around(points, point);
        }
        Ok(None)
    }
}

/// The three of four points around the lowest of them.
fn around([a, b, c]: [(f64, f64); 3], new: (f64, f64)) -> [(f64, f64); 3] {
    let four = if (new.0 - a.0) * (new.0 - b.0) < 0.0 { [a, new, b, c] } else { [a, b, new, c] };
    if four[1].1 < four[2].1 { [four[0], four[1], four[2]] } else { [four[1], four[2], four[3]] }
}

#[cfg(test)]
mod tests {
    use super::{around, bottom};

    /// (x − 2)² + 1/4 on places of either order; one that only falls has its bottom outside.
    #[test]
    fn the_bottom_of_a_parabola() {
        let f = |x: f64| (x, (x - 2.0) * (x - 2.0) + 0.25);
        for places in [[1.0, 2.5, 4.0], [4.0, 2.5, 1.0]] {
            let (at, value) = bottom(places.map(f)).expect("a bottom");
            assert!((at - 2.0).abs() < 1e-15 && (value - 0.25).abs() < 1e-15, "{at} {value}");
        }
        assert_eq!(bottom([2.5, 3.0, 4.0].map(f)), None);
        assert_eq!(bottom([(0.0, 1.0), (1.0, 2.0), (2.0, 1.0)]), None);
    }

    #[test]
    fn of_four_points_those_around_the_lowest_are_kept() {
        let points = [(0.0, 3.0), (1.0, 1.0), (3.0, 4.0)];
        assert_eq!(around(points, (2.0, 0.5)), [(1.0, 1.0), (2.0, 0.5), (3.0, 4.0)]);
        assert_eq!(around(points, (2.0, 2.0)), [(0.0, 3.0), (1.0, 1.0), (2.0, 2.0)]);
        assert_eq!(around(points, (0.5, 0.5)), [(0.0, 3.0), (0.5, 0.5), (1.0, 1.0)]);
    }
}
