//! Which friction explains what was measured: least squares over the friction of groups of pairs.
//!
//! ```text
//!   least Σ ((q_i(f) − m_i) / σ_i)²     q: the quantities of the answer (or of the load history) under friction f
//! ```
//! Between breakpoints the answer is a rational function of f. One friction is followed over its whole exact path; with
//! several, Gauss–Newton goes downhill from several starts with exact derivatives, and each is then looked at alone over its
//! path. Friction of pairs that stick does not show, beyond being enough for that; that of open pairs not at all.

mod fit;
mod model;

use nalgebra::DMatrix;

use super::start::PathError;
use crate::answer::record::{PairState, State};
use crate::model::jet::Dependence;
use crate::model::measurement::Measurement;
use crate::model::words::counted;
use crate::solve::Case;
use crate::text::number::short;
use fit::{AT_END, Along, BLIND, Fit};
use model::Model;

/// A stretch of a friction over which the measurements tell nothing counts from this share of its range on.
const LEVEL: f64 = 1e-6;
/// Minima over one friction from which descents start.
const MINIMA: usize = 12;
/// Rounds of each friction alone after the descents.
const ROUNDS: usize = 3;
/// Below this share of the measured values slopes by differences are rounding.
const DIFFERENCES: f64 = 1e-6;
/// Groups up to which there is a start towards every corner of the box.
const CORNERS: usize = 3;

/// What was found of one friction.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Group {
    /// The parameter.
    pub parameter: String,
    /// Its value.
    pub value: f64,
    /// Standard error; `None` where nothing determines it.
    pub standard_error: Option<f64>,
    /// Whether it stands at an end of its range, or of its path: beyond there may be a better one.
    pub at_end: bool,
    /// Whether the measurements determine it.
    pub identifiable: bool,
    /// Values that explain them as well, where they do not.
    pub interval: Option<[f64; 2]>,
    /// Why they do not.
    pub why: Option<String>,
    /// How many of its pairs are open.
    pub open: usize,
    /// How many stick.
    pub stick: usize,
    /// How many slip.
    pub slip: usize,
}

/// A measurement beside what the structure does.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Compared {
    /// As written.
    pub quantity: String,
    /// Its unit.
    #[serde(skip)]
    pub unit: Option<String>,
    /// Measured.
    pub measured: f64,
    /// Standard error of that.
    pub error: Option<f64>,
    /// Under the friction found.
    pub computed: f64,
    /// Computed less measured.
    pub residual: f64,
    /// d(computed)/d(friction), for each group.
    pub sensitivity: Vec<f64>,
}

/// Friction that explains measurements.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Calibration {
    /// The groups.
    pub groups: Vec<Group>,
    /// The measurements.
    pub measurements: Vec<Compared>,
    /// Σ of the squares of the residuals, divided by the errors where they are given.
    pub squares: f64,
    /// Measurements less identifiable groups.
    pub degrees_of_freedom: usize,
    /// Whether it is the least over the whole range, or only nearby.
    pub global: bool,
    /// Other values of the only friction at which the sum of squares is least nearby, with the sum.
    pub other_minima: Vec<[f64; 2]>,
    /// What was looked at.
    pub sentence: String,
}

/// Finds the friction of the groups, each within its range. `history`: whether the measurements belong to the load history.
///
/// # Errors
/// Fewer measurements than groups, no answer anywhere; see [`PathError`].
pub fn calibrate(
    case: Case<'_>,
    groups: &[(String, [f64; 2])],
    measured: &[Measurement],
    history: bool,
) -> Result<Calibration, PathError> {
    if case.prepared.system().is_none() {
        return Err(PathError::Plain("calibrate"));
    }
    if measured.len() < groups.len() {
        return Err(PathError::Missing(format!(
            "calibrate: {} cannot tell {} frictions; measure at least as many quantities, or name fewer",
            counted(measured.len(), "measurement", "measurements"),
            groups.len()
        )));
    }
    let model = Model { case, groups, measured, history };
    if let ([_], false) = (groups, history) {
        let at = model.present();
        if let Some(along) = model.along(&at, 0)? {
            return model.of_one(&along);
        }
    }
    model.of_several()
}

impl Model<'_> {
    fn present(&self) -> Vec<f64> {
        let value = |(name, [low, high]): &(String, [f64; 2])| {
            self.case.values.get(name).copied().unwrap_or_default().clamp(*low, *high)
        };
        self.groups.iter().map(value).collect()
    }

    /// The only friction, over its whole path.
    fn of_one(&self, along: &Along) -> Result<Calibration, PathError> {
        let mut fits: Vec<Fit> = Vec::new();
        for (value, _) in along.minima.iter().take(MINIMA) {
            fits.extend(self.descend_along(along, &[*value], 0)?);
        }
        fits.sort_by(|a, b| a.squares.total_cmp(&b.squares));
        fits.dedup_by(|a, b| (a.at[0] - b.at[0]).abs() <= 1e-7 * a.at[0].abs().max(b.at[0].abs()));
        let near = fits.first().map(|best| along.as_good(best.at[0], best.squares, self.size()));
        let level = fits.first().map(|best| along.level(best.at[0], best.squares, self.size()));
        let elsewhere = |fit: &&Fit| near.is_none_or(|[from, to]| fit.at[0] < from || fit.at[0] > to);
        let others = fits.iter().skip(1).filter(elsewhere).map(|fit| [fit.at[0], fit.squares]).collect();
        let name = &self.groups[0].0;
        let [low, high] = along.covered;
        // Its minima may all stand where no run of its own finds an answer.
        let Some(best) = fits.into_iter().next() else { return self.of_several() };
        let mut sentence = format!(
            "the least sum of squares on the exact path over {name} from {} to {}: every stretch between two breakpoints was \
             looked at",
            short(low),
            short(high)
        );
        along.ends.iter().for_each(|end| sentence.push_str(&format!("; the path ends there: {end}")));
        let level = level.filter(|[from, to]| to - from > LEVEL * (high - low));
        self.told(&best, level, (&[along.covered], others, sentence))
    }

    /// From several starts, then each friction alone.
    fn of_several(&self) -> Result<Calibration, PathError> {
        let starts = self.starts();
        let (mut best, mut tried): (Option<Fit>, usize) = (None, 0);
        for (index, start) in starts.iter().enumerate() {
            self.case.watch.progress("calibrate", 0.5 * index as f64 / starts.len() as f64);
            let Some(fit) = self.descend(start.clone())? else { continue };
            tried += 1;
            if best.as_ref().is_none_or(|best| fit.squares < best.squares) {
                best = Some(fit);
            }
        }
        let Some(mut best) = best else { return Err(self.nothing(&starts[0])?) };
        let mut alone = !self.history;
        for _ in 0..ROUNDS {
            let before = best.squares;
            for group in (0..self.groups.len()).filter(|_| !self.history) {
                let along = match self.along(&best.at, group) {
                    Ok(along) => along,
                    Err(PathError::Interrupted) => return Err(PathError::Interrupted),
                    Err(_) => None,
                };
                let least = along.and_then(|along| Some((along.minima.first().copied()?, along)));
                let Some(((value, squares), along)) = least else {
                    alone = false;
                    continue;
                };
                if squares < best.squares {
                    let mut at = best.at.clone();
                    at[group] = value;
                    best = self
                        .descend_along(&along, &at, group)?
                        .filter(|fit| fit.squares < best.squares)
                        .unwrap_or(best);
                }
            }
            if best.squares >= before * (1.0 - 1e-9) {
                break;
            }
        }
        let along = if alone { "; each friction alone is at the least of its whole exact path" } else { "" };
        let place = if self.history { ", by differences between histories of their own" } else { "" };
        let sentence =
            format!("local: the best of {tried} descents{place}{along}; a better one elsewhere is not ruled out");
        self.told(&best, None, (&[], Vec::new(), sentence))
    }

    /// The present values, the middle, and places between it and the corners.
    fn starts(&self) -> Vec<Vec<f64>> {
        let count = self.groups.len();
        let at = |share: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let place = |(k, (_, [low, high])): (usize, &(String, [f64; 2]))| low + share(k) * (high - low);
            self.groups.iter().enumerate().map(place).collect()
        };
        let mut starts = vec![self.present(), at(&|_| 0.5)];
        if count <= CORNERS {
            starts.extend((0..1_usize << count).map(|bits| at(&|k| if bits >> k & 1 == 1 { 0.75 } else { 0.25 })));
        } else {
            starts.extend([at(&|_| 0.25), at(&|_| 0.75)]);
        }
        starts
    }

    /// Why there is nothing to compare with.
    fn nothing(&self, at: &[f64]) -> Result<PathError, PathError> {
        let why = self.look(at)?.err().unwrap_or_default();
        let settings: Vec<String> =
            self.groups.iter().zip(at).map(|((name, _), at)| format!("{name} = {at}")).collect();
        Ok(PathError::Missing(format!(
            "calibrate: at no start is there an answer to compare with what was measured; at {}: {why}",
            settings.join(", ")
        )))
    }

    /// `followed`: the range of the only friction that its path leads over, none where the minimum is a local one.
    fn told(
        &self,
        best: &Fit,
        level: Option<[f64; 2]>,
        (followed, other_minima, sentence): (&[[f64; 2]], Vec<[f64; 2]>, String),
    ) -> Result<Calibration, PathError> {
        let slopes = self.slopes(&best.at, &best.look)?;
        let seen = Seen::of(self, &slopes);
        // Level around the best place, though it slopes on one side of it.
        let why = |k: usize| seen.why[k].or(level.map(|_| Blind::Alone));
        let known = (0..self.groups.len()).filter(|&k| why(k).is_none()).count();
        let degrees_of_freedom = self.measured.len() - known;
        let scatter = match self.measured.iter().all(|measured| measured.error.is_some()) {
            true => Some(1.0),
            false => (degrees_of_freedom > 0).then(|| best.squares / degrees_of_freedom as f64),
        };
        let mut groups = Vec::new();
        for (k, (name, range)) in self.groups.iter().enumerate() {
            let mut group = self.group(k, &best.look.pairs);
            (group.parameter, group.value) = (name.clone(), best.at[k]);
            let is_at = |[low, high]: &[f64; 2], end: f64| (best.at[k] - end).abs() <= AT_END * (high - low);
            let mut ranges = std::iter::once(range).chain(followed);
            group.at_end = ranges.any(|ends| is_at(ends, ends[0]) || is_at(ends, ends[1]));
            match why(k) {
                // At an end the sum of squares slopes: nothing says how far off the minimum would be.
                None if group.at_end => {}
                None => {
                    let [low, high] = *range;
                    group.standard_error = scatter.map(|scatter| (scatter * seen.variance[k]).sqrt() * (high - low));
                }
                Some(blind) => self.explain(&mut group, best, k, blind)?,
            }
            groups.push(group);
        }
        let compared = self.measured.iter().enumerate().map(|(i, measured)| Compared {
            quantity: measured.quantity.to_string(),
            unit: measured.quantity.unit(&self.case.scenario.units),
            measured: measured.value,
            error: measured.error,
            computed: best.look.values[i],
            residual: best.look.values[i] - measured.value,
            sensitivity: slopes.row(i).iter().copied().collect(),
        });
        let measurements = compared.collect();
        Ok(Calibration {
            groups,
            measurements,
            squares: best.squares,
            degrees_of_freedom,
            global: !followed.is_empty(),
            other_minima,
            sentence,
        })
    }

    /// The states of the pairs whose friction depends on a group.
    fn group(&self, k: usize, states: &[PairState]) -> Group {
        let along = self.case.values.along(&self.groups[k].0);
        let pairs = self.case.prepared.system().map_or(&[][..], |system| &system.pairs);
        let mut group = Group {
            parameter: String::new(),
            value: 0.0,
            standard_error: None,
            at_end: false,
            identifiable: true,
            interval: None,
            why: None,
            open: 0,
            stick: 0,
            slip: 0,
        };
        for (pair, state) in pairs.iter().zip(states) {
            if pair.law.friction().is_none_or(|friction| along.dependence(friction) == Dependence::Constant) {
                continue;
            }
            match state.state {
                State::Open | State::Closed => group.open += 1,
                State::Stick => group.stick += 1,
                State::SlipPlus | State::SlipMinus | State::Slip => group.slip += 1,
            }
        }
        group
    }

    /// Says of a friction that does not show what the measurements still say of it.
    fn explain(&self, group: &mut Group, best: &Fit, k: usize, blind: Blind) -> Result<(), PathError> {
        group.identifiable = false;
        let along = if self.history || blind == Blind::Mixed { None } else { self.along(&best.at, k).ok().flatten() };
        group.interval = along.map(|along| along.as_good(best.at[k], best.squares, self.size()));
        group.why = Some(match blind {
            Blind::Mixed => "it cannot be told apart from others: only a combination of them shows".to_owned(),
            Blind::Alone if group.slip == 0 && group.stick == 0 => "its pairs are open: nothing shows of it".to_owned(),
            Blind::Alone if group.slip == 0 => {
                "its pairs stick: it is enough for that, and more would not show".to_owned()
            }
            Blind::Alone => "no measurement depends on it".to_owned(),
        });
        Ok(())
    }
}

/// Why a friction does not show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Blind {
    /// Nothing measured depends on it.
    Alone,
    /// Only a combination with others does.
    Mixed,
}

/// What the slopes tell of each group.
struct Seen {
    why: Vec<Option<Blind>>,
    /// Variance per unit of scatter and of the range squared.
    variance: Vec<f64>,
}

impl Seen {
    fn of(model: &Model<'_>, slopes: &DMatrix<f64>) -> Seen {
        let scaled = model.scaled_slopes(slopes);
        let count = scaled.ncols();
        let floor = if model.history { DIFFERENCES } else { BLIND } * model.size();
        let mut why: Vec<Option<Blind>> =
            (0..count).map(|k| (scaled.column(k).norm() <= floor).then_some(Blind::Alone)).collect();
        let shown: Vec<usize> = (0..count).filter(|&k| why[k].is_none()).collect();
        let mut variance = vec![0.0; count];
        // Each column to length 1, so that a friction of little effect does not look like a combination.
        let columns: Vec<_> = shown.iter().map(|&k| scaled.column(k).normalize()).collect();
        if columns.is_empty() {
            return Seen { why, variance };
        }
        let svd = DMatrix::from_columns(&columns).svd(false, true);
        let Some(v_t) = svd.v_t else { return Seen { why, variance } };
        for (row, value) in svd.singular_values.iter().enumerate() {
            for (place, &k) in shown.iter().enumerate() {
                let part = v_t[(row, place)];
                if *value <= 1e-7 {
                    if part.abs() > 1e-3 {
                        why[k] = Some(Blind::Mixed);
                    }
                } else {
                    variance[k] += (part / value).powi(2) / scaled.column(k).norm_squared();
                }
            }
        }
        Seen { why, variance }
    }
}
