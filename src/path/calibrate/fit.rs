//! Least squares: downhill by Gauss–Newton within a box, and along one friction alone over its whole exact path.

use nalgebra::{DMatrix, DVector};

use super::model::{Look, Model};
use crate::path::profile::curve_of;
use crate::path::route::Route;
use crate::path::start::PathError;

/// Steps of one descent.
const STEPS: usize = 60;
/// A step is halved this often before it is given up.
const HALVINGS: usize = 24;
/// Where a minimum stands at an end of a path, its answer is sought this share of the path inside.
const INSIDE: [f64; 4] = [0.0, 1e-12, 1e-9, AT_END];
/// What is no farther from an end of the range or the path than this share of it stands there.
pub(super) const AT_END: f64 = 1e-6;
/// Singular values below this share of the largest tell nothing.
pub(super) const BLIND: f64 = 1e-9;
/// Sums of squares are as good as the least where they exceed it by less than this share, and than this share of the
/// measured values.
const AS_GOOD: f64 = 1e-6;
const ROUNDING: f64 = 1e-11;

/// Friction with its sum of weighted squares.
pub(super) struct Fit {
    pub(super) at: Vec<f64>,
    pub(super) squares: f64,
    pub(super) look: Look,
}

/// The sum of squares along one friction, the others held.
pub(super) struct Along {
    /// Its minima, the best first.
    pub(super) minima: Vec<(f64, f64)>,
    /// Values of it and sums of squares, upwards.
    pub(super) points: Vec<(f64, f64)>,
    /// Between which values it was followed.
    pub(super) covered: [f64; 2],
    /// Why not over the whole range, in sentences.
    pub(super) ends: Vec<String>,
}

impl Along {
    /// The range around a value over which it is as good as there, as far as measuring could tell.
    pub(super) fn as_good(&self, at: f64, squares: f64, size: f64) -> [f64; 2] {
        self.around(at, squares * (1.0 + AS_GOOD) + self.rounding(size))
    }

    /// The range around a value over which it is the same as there, to rounding.
    pub(super) fn level(&self, at: f64, squares: f64, size: f64) -> [f64; 2] {
        self.around(at, squares * (1.0 + ROUNDING) + self.rounding(size))
    }

    /// A sum of squares that is rounding beside what was measured and computed anywhere.
    fn rounding(&self, size: f64) -> f64 {
        let most = self.points.iter().fold(0.0, |most: f64, (_, squares)| most.max(*squares));
        ROUNDING.powi(2) * (size * size + most)
    }

    /// The range around a value over which the sum of squares was found to be no more than `most`.
    fn around(&self, at: f64, most: f64) -> [f64; 2] {
        let good = |(_, found): &&(f64, f64)| *found <= most;
        let from = self.points.iter().rev().skip_while(|(value, _)| *value > at).take_while(good).last();
        let to = self.points.iter().skip_while(|(value, _)| *value < at).take_while(good).last();
        [from.map_or(at, |point| point.0.min(at)), to.map_or(at, |point| point.0.max(at))]
    }
}

impl Model<'_> {
    /// The size of what was measured, weighted.
    pub(super) fn size(&self) -> f64 {
        self.measured
            .iter()
            .zip(self.weights())
            .map(|(measured, weight)| (weight * measured.value).powi(2))
            .sum::<f64>()
            .sqrt()
    }

    fn at(&self, at: Vec<f64>) -> Result<Option<Fit>, PathError> {
        let look = self.look(&at)?;
        Ok(look.ok().map(|look| Fit { squares: self.residuals(&look.values).norm_squared(), at, look }))
    }

    /// Slopes weighted and per unit of the range.
    pub(super) fn scaled_slopes(&self, slopes: &DMatrix<f64>) -> DMatrix<f64> {
        let weights = self.weights();
        DMatrix::from_fn(slopes.nrows(), slopes.ncols(), |i, k| {
            let [low, high] = self.groups[k].1;
            weights[i] * slopes[(i, k)] * (high - low)
        })
    }

    /// Downhill from a start; `None` where that has no answer.
    pub(super) fn descend(&self, start: Vec<f64>) -> Result<Option<Fit>, PathError> {
        let Some(mut best) = self.at(start)? else { return Ok(None) };
        for _ in 0..STEPS {
            let slopes = self.scaled_slopes(&self.slopes(&best.at, &best.look)?);
            let step = self.step(&slopes, &self.residuals(&best.look.values), &best.at);
            let mut length = 1.0;
            let mut next = None;
            for _ in 0..HALVINGS {
                let place = |(k, (_, [low, high])): (usize, &(String, [f64; 2]))| {
                    (best.at[k] + length * step[k] * (high - low)).clamp(*low, *high)
                };
                let at: Vec<f64> = self.groups.iter().enumerate().map(place).collect();
                if at == best.at {
                    break;
                }
                next = self.at(at)?.filter(|fit| fit.squares < best.squares);
                if next.is_some() {
                    break;
                }
                length *= 0.5;
            }
            let Some(next) = next else { break };
            best = next;
        }
        Ok(Some(best))
    }

    /// Downhill from a minimum over one friction. At an end of its path, beyond which there is no answer, there is one that
    /// only just is, and a run of its own may not find it: then from a little inside.
    pub(super) fn descend_along(&self, along: &Along, at: &[f64], group: usize) -> Result<Option<Fit>, PathError> {
        let [low, high] = along.covered;
        let towards = if at[group] < 0.5 * (low + high) { high - low } else { low - high };
        for share in INSIDE {
            let mut start = at.to_vec();
            start[group] += share * towards;
            let found = self.descend(start)?;
            if found.is_some() {
                return Ok(found);
            }
        }
        Ok(None)
    }

    /// The step of Gauss and Newton per unit of the ranges, without what points out of the box.
    fn step(&self, slopes: &DMatrix<f64>, residuals: &DVector<f64>, at: &[f64]) -> DVector<f64> {
        let mut slopes = slopes.clone();
        loop {
            let svd = slopes.clone().svd(true, true);
            let largest = svd.singular_values.amax();
            let step = svd.solve(residuals, BLIND * largest).map_or_else(|_| DVector::zeros(at.len()), |step| -step);
            let out = (0..at.len()).find(|&k| {
                let [low, high] = self.groups[k].1;
                (at[k] <= low && step[k] < 0.0) || (at[k] >= high && step[k] > 0.0)
            });
            match out {
                Some(k) => slopes.column_mut(k).fill(0.0),
                None => return step,
            }
        }
    }

    /// The sum of squares over one friction alone on its exact path; `None` where none leads over it.
    pub(super) fn along(&self, at: &[f64], group: usize) -> Result<Option<Along>, PathError> {
        // In space slips turn, and no exact path leads over friction: rates and answers of their own have to do.
        if self.case.prepared.is_in_space() {
            return Ok(None);
        }
        let (name, range) = &self.groups[group];
        let there = self.there(at)?;
        let case = there.case(self.case);
        let route = match Route::new(case, name, *range) {
            Ok(Some(route)) => route,
            // No path, or no answer at its ends to start from.
            Ok(None) | Err(PathError::NoStart { .. }) => return Ok(None),
            Err(error) => return Err(error),
        };
        let mut points: Vec<(f64, f64)> = Vec::new();
        for (index, stretch) in route.stretches.iter().enumerate() {
            if case.watch.stop() {
                return Err(PathError::Interrupted);
            }
            case.watch.progress(&format!("calibrate {name}"), index as f64 / route.stretches.len() as f64);
            let squares = |value: f64| -> Option<f64> {
                let values = route.with_facts(stretch, value, |facts| self.read(facts))?.ok()?;
                let squares = self.residuals(&values).norm_squared();
                // Where the measurements are met, what is left is rounding, not a curve.
                Some(if squares <= (ROUNDING * self.size()).powi(2) { 0.0 } else { squares })
            };
            points.extend(curve_of(&squares, stretch).unwrap_or_default());
        }
        if points.is_empty() {
            return Ok(None);
        }
        let mut minima = least_nearby(&points, (ROUNDING * self.size()).powi(2));
        minima.sort_by(|a, b| a.1.total_cmp(&b.1));
        Ok(Some(Along { minima, covered: route.covered(), ends: route.notes(), points }))
    }
}

/// The local minima, up to rounding; one for each level stretch.
fn least_nearby(points: &[(f64, f64)], rounding: f64) -> Vec<(f64, f64)> {
    let level = |a: f64, b: f64| (a - b).abs() <= rounding + ROUNDING * a.max(b);
    let mut minima = Vec::new();
    let mut first = 0;
    for next in 1..=points.len() {
        if points.get(next).is_some_and(|point| level(point.1, points[first].1)) {
            continue;
        }
        let falls_to = first == 0 || points[first - 1].1 > points[first].1;
        let rises_from = points.get(next).is_none_or(|point| point.1 > points[first].1);
        if falls_to && rises_from {
            let least = points[first..next].iter().copied().reduce(|a, b| if b.1 < a.1 { b } else { a });
            minima.extend(least);
        }
        first = next;
    }
    minima
}
