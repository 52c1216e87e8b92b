//! Sliders: what a step is, and which value a place on the slider means.

use crate::model::parameter::Parameter;
use crate::text::number::rounded;

/// The step of a slider: the file's, or a fiftieth of the range, or a twentieth of the value.
pub fn step(value: f64, parameter: &Parameter) -> f64 {
    let usable = |step: f64| step.is_finite() && step > 0.0;
    if let Some(step) = parameter.step.filter(|step| usable(*step)) {
        return step;
    }
    if let Some((low, high)) = range(parameter) {
        return (high - low) / 50.0;
    }
    let share = value.abs() / 20.0;
    if usable(share) { nice(share) } else { 0.1 }
}

/// 1, 2 or 5 × 10^k, not more than `value`.
fn nice(value: f64) -> f64 {
    let power = 10f64.powi(value.log10().floor() as i32);
    [5.0, 2.0, 1.0]
        .into_iter()
        .map(|digit| digit * power)
        .find(|nice| *nice <= value)
        .filter(|nice| *nice > 0.0)
        .unwrap_or(value)
}

/// The range of a slider, if it has one.
pub fn range(parameter: &Parameter) -> Option<(f64, f64)> {
    let (low, high) = (parameter.min?, parameter.max?);
    (low < high && (high - low).is_finite()).then_some((low, high))
}

/// The value `tenths` tenths of a step from `value`: kept within the range, unless it was outside and comes closer.
pub fn varied(value: f64, parameter: &Parameter, tenths: i8) -> f64 {
    let step = step(value, parameter);
    let new = tidy(value + step * f64::from(tenths) / 10.0, step);
    let up = tenths > 0;
    match (parameter.min, parameter.max) {
        (_, Some(max)) if up && new > max => max.max(value),
        (Some(min), _) if !up && new < min => min.min(value),
        _ => new,
    }
}

/// The value at a share 0 … 1 of the slider, on its steps.
pub fn at(share: f64, parameter: &Parameter) -> Option<f64> {
    let (low, high) = range(parameter)?;
    let step = step(low, parameter);
    let steps = (share.clamp(0.0, 1.0) * (high - low) / step).round();
    Some(tidy(low + steps * step, step).clamp(low, high))
}

/// Where a value stands on the slider, 0 … 1.
pub fn share(value: f64, parameter: &Parameter) -> Option<f64> {
    let (low, high) = range(parameter)?;
    Some(((value - low) / (high - low)).clamp(0.0, 1.0))
}

/// Sums of steps without the dust of binary fractions.
fn tidy(value: f64, step: f64) -> f64 {
    if value.abs() < 1e-9 * step {
        return 0.0;
    }
    rounded(value, 12)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameter(min: Option<f64>, max: Option<f64>, step: Option<f64>) -> Parameter {
        Parameter { value: 0.0, formula: None, min, max, step, unit: None, about: None }
    }

    #[test]
    fn steps_leave_no_dust() {
        let f = parameter(Some(0.0), Some(1.0), Some(0.05));
        let mut value = 0.0;
        for _ in 0..6 {
            value = varied(value, &f, 10);
        }
        assert_eq!(value, 0.3);
        for _ in 0..6 {
            value = varied(value, &f, -10);
        }
        assert_eq!(value, 0.0);
        assert_eq!(varied(0.3, &f, 1), 0.305);
        assert_eq!(varied(0.3, &f, 100), 0.8);
    }

    #[test]
    fn the_range_holds_but_never_pulls() {
        let f = parameter(Some(0.0), Some(1.0), Some(0.05));
        assert_eq!(varied(0.98, &f, 10), 1.0);
        assert_eq!(varied(1.0, &f, 10), 1.0);
        assert_eq!(varied(1.7, &f, 10), 1.7);
        assert_eq!(varied(1.7, &f, -10), 1.65);
        assert_eq!(varied(0.02, &f, -10), 0.0);
        assert_eq!(varied(-3.0, &f, -10), -3.0);
    }

    #[test]
    fn a_slider_without_range_or_step() {
        let bare = parameter(None, None, None);
        assert_eq!(varied(250.0, &bare, 10), 260.0);
        assert_eq!(varied(0.0, &bare, 10), 0.1);
        assert_eq!(at(0.5, &bare), None);
        let odd = parameter(Some(1.0), Some(1.0), Some(-3.0));
        assert_eq!(at(0.5, &odd), None);
        assert!(varied(1.0, &odd, 10) >= 1.0);
    }

    #[test]
    fn places_fall_on_steps() {
        let f2 = parameter(Some(0.0), Some(400.0), Some(10.0));
        assert_eq!(at(0.0, &f2), Some(0.0));
        assert_eq!(at(1.0, &f2), Some(400.0));
        assert_eq!(at(0.333, &f2), Some(130.0));
        assert_eq!(at(7.0, &f2), Some(400.0));
        assert_eq!(share(100.0, &f2), Some(0.25));
        assert_eq!(share(1e9, &f2), Some(1.0));
    }
}
