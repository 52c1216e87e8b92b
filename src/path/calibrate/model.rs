//! What the structure does under given friction, in the measured quantities, and how fast it changes.

use nalgebra::{DMatrix, DVector};

use crate::answer::record::PairState;
use crate::model::measurement::Measurement;
use crate::model::quantity::Quantity;
use crate::path::quantity::{Facts, Value};
use crate::path::sensitivity::{PairRate, sensitivity};
use crate::path::stages::{self, HistoryEnd};
use crate::path::start::PathError;
use crate::solve::case::There;
use crate::solve::error::QuestionError;
use crate::solve::problem::factors;
use crate::solve::{Case, Solved};

/// The state is moved by this share of its size along its exact rates: what is linear in it (displacements, forces) then
/// has its exact derivative, the rest one to about as many digits.
const MOVED: f64 = 1e-3;
/// Step of a difference between answers of their own, as a share of the value or the range.
const STEP: f64 = 1e-6;

/// Measured quantities of a structure whose friction is sought.
pub(super) struct Model<'a> {
    pub(super) case: Case<'a>,
    /// The friction parameters and their ranges.
    pub(super) groups: &'a [(String, [f64; 2])],
    pub(super) measured: &'a [Measurement],
    /// Whether they were measured in the course of the load history.
    pub(super) history: bool,
}

/// The quantities at some friction.
pub(super) struct Look {
    pub(super) values: Vec<f64>,
    pub(super) pairs: Vec<PairState>,
    /// The answer; `None` of a history.
    solved: Option<Solved>,
}

impl Model<'_> {
    pub(super) fn there(&self, at: &[f64]) -> Result<There, QuestionError> {
        let settings: Vec<(&str, f64)> =
            self.groups.iter().zip(at).map(|((name, _), value)| (name.as_str(), *value)).collect();
        self.case.at_all(&settings)
    }

    /// Their values, or why there are none.
    pub(super) fn look(&self, at: &[f64]) -> Result<Result<Look, String>, PathError> {
        if self.case.watch.stop() {
            return Err(PathError::Interrupted);
        }
        let there = match self.there(at) {
            Ok(there) => there,
            Err(QuestionError::Refused(why)) => return Ok(Err(why)),
            Err(error) => return Err(error.into()),
        };
        let case = there.case(self.case);
        if self.history {
            let history = stages::follow(case)?;
            if history.end != HistoryEnd::Complete {
                return Ok(Err(history.end_sentence()));
            }
            let facts = Facts::of_state(case, Vec::new(), &[]).of_history(&history);
            let pairs = history.answer().map_or_else(Vec::new, |end| end.pairs.clone());
            return Ok(self.read(&facts).map(|values| Look { values, pairs, solved: None }));
        }
        let solved = case.solve_briefly()?;
        if !solved.answer.is_answer() {
            return Ok(Err(format!("the outcome is {}", solved.answer.outcome.word())));
        }
        let pairs = solved.answer.pairs.clone();
        let values = self.read(&Facts::of_state(case, factors(case.prepared, case.values), &pairs));
        Ok(values.map(|values| Look { values, pairs, solved: Some(solved) }))
    }

    pub(super) fn read(&self, facts: &Facts<'_>) -> Result<Vec<f64>, String> {
        let value = |measured: &Measurement| match facts.value(&measured.quantity) {
            Ok(Value::Number(value)) => Ok(value),
            Ok(Value::Word(_)) => Err(format!("{} is a word", measured.quantity)),
            Err(why) => Err(format!("{}: {}", measured.quantity, why.0)),
        };
        self.measured.iter().map(value).collect()
    }

    /// Weights: what each residual is multiplied by.
    pub(super) fn weights(&self) -> Vec<f64> {
        self.measured.iter().map(|measured| measured.error.map_or(1.0, f64::recip)).collect()
    }

    /// Computed less measured, weighted.
    pub(super) fn residuals(&self, values: &[f64]) -> DVector<f64> {
        let each = self.measured.iter().zip(values).zip(self.weights());
        DVector::from_vec(each.map(|((measured, value), weight)| weight * (value - measured.value)).collect())
    }

    /// d(quantity)/d(friction), a column for each group: from the exact rates within the working scheme, in a history by
    /// differences.
    pub(super) fn slopes(&self, at: &[f64], here: &Look) -> Result<DMatrix<f64>, PathError> {
        let exact = self.measured.iter().all(|measured| is_of_rates(&measured.quantity));
        let rates = match &here.solved {
            Some(solved) if exact => self.rates(at, solved)?,
            _ => None,
        };
        let mut slopes = DMatrix::zeros(self.measured.len(), self.groups.len());
        for k in 0..self.groups.len() {
            let own = rates.as_ref().and_then(|rates| rates[k].as_ref());
            let column = match own {
                Some(rates) => self.along_rates(at, here, rates)?,
                None => self.difference(at, here, k)?,
            };
            slopes.set_column(k, &column);
        }
        Ok(slopes)
    }

    /// The exact rates of the pairs over each group; `None` where there are none.
    fn rates(&self, at: &[f64], solved: &Solved) -> Result<Option<Vec<Option<Vec<PairRate>>>>, PathError> {
        let there = self.there(at)?;
        match sensitivity(there.case(self.case), solved) {
            Ok(found) => {
                let of = |name: &String| found.parameters.iter().find(|rate| rate.parameter == *name);
                Ok(Some(self.groups.iter().map(|(name, _)| of(name).map(|rate| rate.pairs.clone())).collect()))
            }
            Err(PathError::Interrupted) => Err(PathError::Interrupted),
            Err(_) => Ok(None),
        }
    }

    fn along_rates(&self, at: &[f64], here: &Look, rates: &[PairRate]) -> Result<DVector<f64>, PathError> {
        let largest =
            |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |most: f64, value| most.max(value.abs()));
        let length = largest(&mut here.pairs.iter().flat_map(|pair| [pair.z_n, pair.z_t]));
        let force = largest(&mut here.pairs.iter().flat_map(|pair| [pair.x_n, pair.x_t]));
        let length_rate = largest(&mut rates.iter().flat_map(|rate| [rate.z_n, rate.z_t]));
        let force_rate = largest(&mut rates.iter().flat_map(|rate| [rate.x_n, rate.x_t]));
        let step =
            [(length, length_rate), (force, force_rate)].into_iter().filter(|(size, rate)| *size > 0.0 && *rate > 0.0);
        let step = MOVED * step.map(|(size, rate)| size / rate).fold(f64::INFINITY, f64::min);
        if !step.is_finite() {
            return Ok(DVector::zeros(self.measured.len()));
        }
        let moved: Vec<PairState> = here.pairs.iter().zip(rates).map(|(pair, rate)| rate.moved(pair, step)).collect();
        let there = self.there(at)?;
        let case = there.case(self.case);
        let after = self.read(&Facts::of_state(case, factors(case.prepared, case.values), &moved));
        let after = after.unwrap_or_else(|_| here.values.clone());
        Ok(DVector::from_fn(after.len(), |i, _| (after[i] - here.values[i]) / step))
    }

    /// From answers of their own on both sides, or on one where the other has none.
    fn difference(&self, at: &[f64], here: &Look, group: usize) -> Result<DVector<f64>, PathError> {
        let [low, high] = self.groups[group].1;
        let step = STEP * at[group].abs().max(1e-3 * (high - low));
        let mut ends: Vec<(f64, Vec<f64>)> = Vec::new();
        for value in [at[group] - step, at[group] + step] {
            let mut there = at.to_vec();
            there[group] = value;
            if value >= 0.0
                && let Ok(look) = self.look(&there)?
            {
                ends.push((value, look.values));
            }
        }
        ends.push((at[group], here.values.clone()));
        let ((a, f), (b, g)) = (&ends[0], &ends[1]);
        Ok(if a == b { DVector::zeros(f.len()) } else { DVector::from_fn(f.len(), |i, _| (g[i] - f[i]) / (b - a)) })
    }
}

/// Whether its rate follows from those of displacements and forces.
fn is_of_rates(quantity: &Quantity) -> bool {
    let word = quantity.word();
    !(word == "bound" || word.starts_with("reserve"))
}
