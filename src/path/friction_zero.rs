//! The first zero of a variable along friction, within one working scheme: stepped over with cubics where those stand
//! for the exact dependence, then found on the function itself.

use super::friction::{Follower, FrictionPath, Place, STEPS, ZERO};
use super::start::PathError;
use crate::lcp::basis::Basis;
use crate::text::words::short;

/// Relative difference between cubic and function up to which the cubic stands for it.
const FAITHFUL: f64 = 1e-3;

impl Follower<'_> {
    /// Goes on within the scheme to the first zero of a variable, or to the target.
    pub(super) fn to_next_zero(
        &self,
        mut here: Place,
        basis: &Basis,
        to: f64,
        path: &mut FrictionPath,
    ) -> Result<Place, PathError> {
        let span = (to - path.start).abs().max(f64::MIN_POSITIVE);
        let least = 1e-13 * here.value.abs().max(to.abs());
        let mut step = span / 8.0;
        for _ in 0..STEPS {
            let left = (to - here.value).abs();
            if left == 0.0 {
                return Ok(here);
            }
            self.case.watch.progress(&format!("{} = {}", self.name, short(here.value)), 1.0 - left / span);
            if self.case.watch.stop() {
                return Err(PathError::Interrupted);
            }
            let length = step.min(left);
            let at = |s: f64| {
                if s * length >= left { to } else { here.value + self.sign * s * length }
            };
            let (middle, end) = (self.place(at(0.5), basis), self.place(at(1.0), basis));
            let (Some(middle), Some(end)) = (middle, end) else {
                step = 0.5 * length;
                if step <= least {
                    return Ok(here);
                }
                continue;
            };
            let cubics: Vec<Cubic> = (0..here.margins.len()).map(|k| Cubic::new(&here, &end, k, length)).collect();
            let faithful = cubics.iter().enumerate().all(|(k, cubic)| {
                let margin = middle.margins[k] * middle.sizes[k] / cubic.size;
                (cubic.at(0.5) - margin).abs() <= FAITHFUL
            });
            if !faithful && length > least {
                step = 0.5 * length;
                continue;
            }
            let first = cubics.iter().filter_map(Cubic::first_negative).fold(f64::INFINITY, f64::min);
            if first > 1.0 {
                path.samples.push((end.value, self.pairs(&end)));
                here = end;
                step = 2.0 * length;
                continue;
            }
            // A place where something is below zero, if the function agrees with its cubic.
            let probe = if first == 1.0 {
                end
            } else {
                match self.place(at(first), basis) {
                    Some(place) => place,
                    None => end,
                }
            };
            if probe.margins.iter().all(|margin| *margin >= -ZERO) {
                // It only came near: go on from there.
                if (probe.value - here.value).abs() <= least {
                    let falls = |k: &usize| cubics[*k].first_negative() == Some(first);
                    let fallen = (0..cubics.len()).filter(falls).map(|k| (k, -ZERO)).collect();
                    return Ok(probe.ended_by(fallen));
                }
                here = probe;
                step = length;
                continue;
            }
            let zero = self.zero(&here, probe, basis);
            // The first zero: nothing may be negative before it.
            let before = self.place(0.5 * (here.value + zero.value), basis);
            match before {
                Some(before) if before.margins.iter().any(|margin| *margin < -ZERO) => {
                    return Ok(self.zero(&here, before, basis));
                }
                _ => return Ok(zero),
            }
        }
        Ok(here)
    }

    /// The zero between a place where all is well and one where some variables are negative, by the Illinois method
    /// on the least of those.
    fn zero(&self, good: &Place, bad: Place, basis: &Basis) -> Place {
        let below = (0..).zip(&bad.margins).filter(|(_, margin)| **margin < -ZERO);
        let fallen: Vec<(usize, f64)> = below.map(|(k, margin)| (k, *margin)).collect();
        let least = |place: &Place| fallen.iter().map(|(k, _)| place.margins[*k]).fold(f64::INFINITY, f64::min);
        let (mut a, mut b) = (good.value, bad.value);
        let (mut f_a, mut f_b) = (least(good).max(0.0), least(&bad));
        let mut best = bad;
        for round in 0..200 {
            let width = (b - a).abs();
            if width <= 4.0 * f64::EPSILON * a.abs().max(b.abs()) {
                break;
            }
            // Where one of them is 0 at the good place already, the secant leads nowhere and halving does.
            let secant = b - f_b * (b - a) / (f_b - f_a);
            let inside = (secant - a) * (secant - b) < 0.0;
            let x = if round % 3 == 2 || !inside { 0.5 * (a + b) } else { secant };
            if x == a || x == b {
                break;
            }
            let Some(place) = self.place(x, basis) else {
                break;
            };
            let f = least(&place);
            if f == 0.0 {
                return place.ended_by(fallen);
            }
            if f > 0.0 {
                a = x;
                f_a = f;
                f_b *= 0.5;
            } else {
                b = x;
                f_b = f;
                f_a *= 0.5;
            }
            best = place;
        }
        self.place(b, basis).unwrap_or(best).ended_by(fallen)
    }
}

/// Cubic through values and slopes at both ends of a step, on 0 … 1.
struct Cubic {
    values: [f64; 2],
    slopes: [f64; 2],
    /// What these are relative to: one size for both ends, for where slips begin the largest of them grows from 0, and beside
    /// itself it would be 1 from the first place on.
    size: f64,
}

impl Cubic {
    fn new(a: &Place, b: &Place, k: usize, length: f64) -> Cubic {
        let size = a.sizes[k].max(b.sizes[k]);
        let relative = |place: &Place, margin: f64| margin * place.sizes[k] / size;
        Cubic {
            values: [relative(a, a.margins[k]), relative(b, b.margins[k])],
            slopes: [relative(a, a.slopes[k] * length), relative(b, b.slopes[k] * length)],
            size,
        }
    }

    fn at(&self, s: f64) -> f64 {
        let ([a, b], [da, db]) = (self.values, self.slopes);
        let r = 1.0 - s;
        r * r * (1.0 + 2.0 * s) * a + s * s * (3.0 - 2.0 * s) * b + s * r * (r * da - s * db)
    }

    /// A place where it is below zero: its lowest between the ends, or the end.
    fn first_negative(&self) -> Option<f64> {
        let ([a, b], [da, db]) = (self.values, self.slopes);
        // Slope: 3 (A) s² + 2 (B) s + da.
        let cube = 2.0 * (a - b) + da + db;
        let square = 3.0 * (b - a) - 2.0 * da - db;
        let root = (square * square - 3.0 * cube * da).max(0.0).sqrt();
        let mut places = [(-square + root) / (3.0 * cube), (-square - root) / (3.0 * cube)];
        places.sort_by(f64::total_cmp);
        places.into_iter().filter(|s| *s > 0.0 && *s < 1.0).chain([1.0]).find(|&s| self.at(s) < -ZERO)
    }
}
