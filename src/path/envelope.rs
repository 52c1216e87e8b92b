//! The least and the largest value of quantities over ranges of parameters: at the exact place where an exact path leads
//! over a single one, otherwise on a grid of answers, refined around its extremes.

use super::profile::{Shape, profile};
use super::quantity::{Facts, Value, history_for};
use super::route::Route;
use super::start::PathError;
use crate::model::quantity::Quantity;
use crate::solve::Case;
use crate::text::number::short;

/// Values of each parameter on a grid over one, two or three of them.
const POINTS: [usize; 3] = [41, 11, 7];
/// The distance to the neighbours of the best place of a grid is halved this often.
const HALVINGS: usize = 12;

/// A parameter, or the factor of a load case, and its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Its name.
    pub name: String,
    /// From … to.
    pub range: [f64; 2],
}

/// An extreme value and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Peak {
    /// The value.
    pub value: f64,
    /// The value of each parameter there.
    pub at: Vec<f64>,
    /// What changes there, in words.
    pub change: Option<String>,
}

/// The least and the largest value of a quantity; `None` where it has none anywhere.
pub type Peaks = [Option<Peak>; 2];

/// The envelope of several quantities.
#[derive(Clone, Debug, PartialEq)]
pub struct Envelope {
    /// In the order of the quantities.
    pub peaks: Vec<Peaks>,
    /// Whether the places are exact.
    pub exact: bool,
    /// The values between which the path was followed; `None` of a grid, whose notes count the points without an answer.
    pub covered: Option<[f64; 2]>,
    /// What limits it, in sentences.
    pub notes: Vec<String>,
}

/// The envelope of `quantities`, numbers all, over up to three axes.
///
/// # Errors
/// No answer to start from; see [`PathError`].
pub fn envelope(case: Case<'_>, axes: &[Axis], quantities: &[Quantity]) -> Result<Envelope, PathError> {
    if let ([axis], true) = (axes, quantities.iter().all(Quantity::is_of_state))
        && let Some(route) = Route::over_all(case, &axis.name, axis.range)?
    {
        return on_route(&route, axis, quantities);
    }
    on_grid(case, axes, quantities)
}

/// Takes a value into the peaks, the first of equals.
fn take(peaks: &mut Peaks, value: f64, at: &[f64]) {
    let [least, largest] = peaks;
    let peak = || Some(Peak { value, at: at.to_vec(), change: None });
    if least.as_ref().is_none_or(|least| value < least.value) {
        *least = peak();
    }
    if largest.as_ref().is_none_or(|largest| value > largest.value) {
        *largest = peak();
    }
}

fn on_route(route: &Route<'_>, axis: &Axis, quantities: &[Quantity]) -> Result<Envelope, PathError> {
    let of = |quantity: &Quantity| -> Result<Peaks, PathError> {
        let mut peaks: Peaks = [None, None];
        for piece in profile(route, quantity)? {
            match piece.shape {
                Shape::Curve(points) => points.iter().for_each(|(at, value)| take(&mut peaks, *value, &[*at])),
                Shape::Steady(Value::Number(value)) => take(&mut peaks, value, &[piece.stretch.from]),
                Shape::Steady(Value::Word(_)) | Shape::Nothing => {}
            }
        }
        for peak in peaks.iter_mut().flatten() {
            peak.change = peak.at.first().and_then(|at| route.change(*at));
        }
        Ok(peaks)
    };
    let peaks: Vec<Peaks> = quantities.iter().map(of).collect::<Result<_, _>>()?;
    let [low, high] = route.covered();
    let mut notes: Vec<String> = route.notes();
    notes.extend(quantities.iter().filter_map(|quantity| route.doubt(quantity)));
    let places = peaks.iter().flatten().flatten().map(|peak| peak.at[0]);
    notes.extend(route.other_answer(places.chain(axis.range))?);
    if low > axis.range[0] || high < axis.range[1] {
        let [low, high] = [low, high].map(short);
        notes.insert(0, format!("over {} from {low} to {high} only, as far as the path leads", axis.name));
    }
    Ok(Envelope {
        peaks,
        exact: quantities.iter().all(|quantity| route.is_exact(quantity)),
        covered: Some(route.covered()),
        notes,
    })
}

/// The quantities of an answer of its own; `None` without one.
fn values(
    case: Case<'_>,
    axes: &[Axis],
    at: &[f64],
    quantities: &[Quantity],
) -> Result<Option<Vec<Option<f64>>>, PathError> {
    let settings: Vec<(&str, f64)> = axes.iter().zip(at).map(|(axis, value)| (axis.name.as_str(), *value)).collect();
    let Some((there, solved)) = case.solved_at(&settings)?.filter(|(_, solved)| solved.answer.is_answer()) else {
        return Ok(None);
    };
    let there = there.case(case);
    let history = history_for(there, quantities)?;
    let facts = Facts::of_answer(there, &solved).beside(history.as_ref());
    Ok(Some(quantities.iter().map(|quantity| facts.value(quantity).ok()?.number()).collect()))
}

fn on_grid(case: Case<'_>, axes: &[Axis], quantities: &[Quantity]) -> Result<Envelope, PathError> {
    let points = POINTS[axes.len().clamp(1, POINTS.len()) - 1];
    let count = points.pow(axes.len() as u32);
    let mut all: Vec<Peaks> = vec![[None, None]; quantities.len()];
    let mut without = 0;
    for number in 0..count {
        case.watch.progress("envelope", number as f64 / count as f64);
        let mut rest = number;
        let at: Vec<f64> = axes
            .iter()
            .map(|Axis { range: [low, high], .. }| {
                let k = rest % points;
                rest /= points;
                if k + 1 == points { *high } else { low + (high - low) * k as f64 / (points - 1) as f64 }
            })
            .collect();
        match values(case, axes, &at, quantities)? {
            None => without += 1,
            Some(found) => {
                for (peaks, value) in all.iter_mut().zip(found) {
                    value.into_iter().for_each(|value| take(peaks, value, &at));
                }
            }
        }
    }
    for (peaks, quantity) in all.iter_mut().zip(quantities) {
        for (sign, peak) in [-1.0, 1.0].into_iter().zip(peaks.iter_mut()) {
            if let Some(peak) = peak {
                refine(case, axes, quantity, sign, 1.0 / (points - 1) as f64, peak)?;
            }
        }
    }
    let mut notes = vec![format!(
        "a grid of {count} answers, refined around its extremes: what stands out between its points is not seen"
    )];
    if without > 0 {
        notes.push(format!("{without} of its points have no answer"));
    }
    Ok(Envelope { peaks: all, exact: false, covered: None, notes })
}

/// Moves to a neighbour while that is better, then halves the distance.
fn refine(
    case: Case<'_>,
    axes: &[Axis],
    quantity: &Quantity,
    sign: f64,
    mut step: f64,
    peak: &mut Peak,
) -> Result<(), PathError> {
    for _ in 0..HALVINGS {
        step *= 0.5;
        for (k, Axis { range: [low, high], .. }) in axes.iter().enumerate() {
            for direction in [-1.0, 1.0] {
                let mut at = peak.at.clone();
                at[k] = (at[k] + direction * step * (high - low)).clamp(*low, *high);
                let found = values(case, axes, &at, std::slice::from_ref(quantity))?;
                let Some(value) = found.and_then(|found| found[0]) else { continue };
                if sign * value > sign * peak.value {
                    (peak.value, peak.at) = (value, at);
                    break;
                }
            }
        }
    }
    Ok(())
}
