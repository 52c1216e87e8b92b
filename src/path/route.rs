//! The answer over a parameter from one value to another along an exact path: what `find` and `envelope` look at.
//!
//! The path starts from a cold answer at the lower end; where there is none, at the upper end, or else at the present
//! value in both directions. Between two breakpoints one working scheme holds, so that every quantity is a smooth
//! function there; on a load path those that are linear in forces and displacements are straight lines.

use std::sync::Arc;

use super::friction::{self, FrictionEnd, FrictionPath, is_friction};
use super::load::{self, LoadEnd, LoadPath, LoadReach};
use super::quantity::{Facts, NoValue, Value};
use super::start::PathError;
use crate::answer::record::PairState;
use crate::model::parameter::{Number, ParameterValues};
use crate::model::quantity::Quantity;
use crate::model::rules::Rules;
use crate::model::scenario::Scenario;
use crate::solve::numbers::factors;
use crate::solve::{PrepareError, Prepared, Solved};
use crate::watch::Watch;

/// What a search over a parameter starts from: the scenario made ready for its present values.
#[derive(Clone, Copy)]
pub struct Basis<'a> {
    /// Made ready for `values`.
    pub prepared: &'a Prepared,
    /// The scenario.
    pub scenario: &'a Scenario,
    /// Present values.
    pub values: &'a ParameterValues,
    /// Rules of every solve.
    pub rules: Rules,
    /// Sees progress and may ask to stop.
    pub watch: &'a dyn Watch,
}

/// The scenario with one parameter, or the factor of one case, at another value.
pub struct There {
    /// Made ready for it.
    pub prepared: Arc<Prepared>,
    /// The values.
    pub values: ParameterValues,
}

impl Basis<'_> {
    /// The scenario with a parameter, or the factor of a load case, at another value.
    ///
    /// # Errors
    /// A value that it cannot take.
    pub fn at(&self, name: &str, value: f64) -> Result<There, PathError> {
        self.at_all(&[(name, value)])
    }

    /// The same with several of them.
    ///
    /// # Errors
    /// As [`Basis::at`].
    pub fn at_all(&self, settings: &[(&str, f64)]) -> Result<There, PathError> {
        let Basis { prepared, scenario, watch, .. } = *self;
        let mut values = self.values.clone();
        let mut fixed: Vec<(usize, f64)> = Vec::new();
        for &(name, value) in settings {
            if let Some(case) = prepared.cases.iter().position(|(known, _)| known == name) {
                fixed.push((case, value));
                continue;
            }
            if let Some(refusal) = scenario.refusal(name, value) {
                return Err(PathError::Target(refusal));
            }
            values.insert(name.to_owned(), value);
        }
        if let Some(refusal) = scenario.law_refusal(&values) {
            return Err(PathError::Target(refusal));
        }
        let renewed = prepared.renewed(scenario, &values, watch).map_err(|error| match error {
            PrepareError::Interrupted => PathError::Interrupted,
            PrepareError::Problems(problems) => PathError::Target(problems.to_string()),
        })?;
        let mut there = renewed.map_or_else(|| prepared.clone(), |(there, _)| there);
        for (case, value) in fixed {
            there.cases[case].1 = Number::Value(value);
        }
        Ok(There { prepared: Arc::new(there), values })
    }

    /// A cold solve there; a collapse is proved where that can be done, but not explained.
    ///
    /// # Errors
    /// An interruption, a refusal.
    pub fn solve(&self, there: &There) -> Result<Solved, PathError> {
        let solved = there.prepared.solve_briefly(self.scenario, &there.values, self.rules, self.watch);
        solved.map_err(|error| {
            if error.is_interrupted() { PathError::Interrupted } else { PathError::Target(error.to_string()) }
        })
    }
}

/// A path in one direction.
enum Way {
    Load(Box<LoadPath>),
    Friction(Box<FrictionPath>),
}

/// A path from a start, with the scenario made ready there.
struct Leg {
    way: Way,
    there: Arc<There>,
    /// How it ended before its target.
    end: Option<String>,
}

/// A part of the path in which one scheme holds, upwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Its lower end.
    pub from: f64,
    /// Its upper end.
    pub to: f64,
    leg: usize,
    /// The knot or scheme at its end nearer to the start of the path.
    index: usize,
}

/// The answer over a parameter.
pub struct Route<'a> {
    basis: Basis<'a>,
    name: String,
    legs: Vec<Leg>,
    /// Its parts, upwards, without those of no length.
    pub stretches: Vec<Stretch>,
}

impl<'a> Route<'a> {
    /// Follows the answer over `range`. `None` where no exact path leads over this parameter.
    ///
    /// # Errors
    /// No answer at either end or at the present value; see [`PathError`].
    pub fn new(basis: Basis<'a>, name: &str, range: [f64; 2]) -> Result<Option<Route<'a>>, PathError> {
        Route::from_end(basis, name, range, false)
    }

    /// The same, looking for a start at the upper end first: where there are several answers it may be another one.
    ///
    /// # Errors
    /// As [`Route::new`].
    pub fn from_end(
        basis: Basis<'a>,
        name: &str,
        range: [f64; 2],
        upper: bool,
    ) -> Result<Option<Route<'a>>, PathError> {
        let mut route = Route { basis, name: name.to_owned(), legs: Vec::new(), stretches: Vec::new() };
        let present = match basis.prepared.cases.iter().find(|(known, _)| known == name) {
            Some((_, factor)) => factor.value(basis.values),
            None => basis.values.get(name).copied().unwrap_or_default(),
        };
        let [low, high] = range;
        let mut starts = vec![(low, vec![high]), (high, vec![low])];
        if upper {
            starts.reverse();
        }
        if low < present && present < high {
            starts.push((present, vec![low, high]));
        }
        let mut how = String::new();
        for (start, targets) in starts {
            let there = basis.at(name, start)?;
            let solved = basis.solve(&there)?;
            if !solved.answer.is_answer() {
                how = crate::path::quantity::written(&solved.answer.outcome);
                continue;
            }
            let there = Arc::new(there);
            for target in targets {
                match route.leg(&there, &solved, target) {
                    Ok(leg) => route.take(leg),
                    // Another dependence, or numbers that broke down: no exact path.
                    Err(
                        PathError::Mixed { .. }
                        | PathError::Unknown { .. }
                        | PathError::Idle(_)
                        | PathError::Breakdown { .. },
                    ) => return Ok(None),
                    Err(error) => return Err(error),
                }
            }
            route.stretches.sort_by(|a, b| a.from.total_cmp(&b.from));
            return Ok(Some(route));
        }
        Err(PathError::NoStart { name: name.to_owned(), at: low, how: format!("with the outcome {how}") })
    }
}

impl Route<'_> {
    fn leg(&self, there: &Arc<There>, solved: &Solved, target: f64) -> Result<Leg, PathError> {
        let Basis { scenario, watch, .. } = self.basis;
        let There { prepared, values } = &**there;
        let is_case = prepared.cases.iter().any(|(case, _)| *case == self.name);
        let (way, end) = if is_friction(prepared, values, &self.name) && !is_case {
            let path = friction::trace(prepared, scenario, values, Some(solved), &self.name, target, watch)?;
            let end = (path.end != FrictionEnd::Target).then(|| path.end_sentence());
            (Way::Friction(Box::new(path)), end)
        } else {
            let reach = LoadReach { to: Some(target), through: false };
            let path = load::trace(prepared, scenario, values, Some(solved), &self.name, reach, watch)?;
            let end = (path.end != LoadEnd::Target).then(|| path.end_sentence());
            (Way::Load(Box::new(path)), end)
        };
        Ok(Leg { way, there: Arc::clone(there), end })
    }

    fn take(&mut self, leg: Leg) {
        let ends: Vec<[f64; 2]> = match &leg.way {
            Way::Load(path) => path.factors.windows(2).map(|ends| [ends[0], ends[1]]).collect(),
            Way::Friction(path) => path.schemes.iter().map(|scheme| [scheme.from, scheme.to]).collect(),
        };
        let number = self.legs.len();
        self.legs.push(leg);
        for (index, [a, b]) in ends.into_iter().enumerate().filter(|(_, [a, b])| a != b) {
            self.stretches.push(Stretch { from: a.min(b), to: a.max(b), leg: number, index });
        }
    }

    /// The values of the parameter between which the answer was followed.
    pub fn covered(&self) -> [f64; 2] {
        let low = self.stretches.iter().map(|stretch| stretch.from).fold(f64::INFINITY, f64::min);
        [low, self.stretches.iter().map(|stretch| stretch.to).fold(f64::NEG_INFINITY, f64::max)]
    }

    /// Whether everything on it is straight between its breakpoints: a path over a load.
    pub fn is_straight(&self) -> bool {
        self.legs.iter().all(|leg| matches!(leg.way, Way::Load(_)))
    }

    /// Why the path does not lead to both ends of the range, in sentences.
    pub fn ends(&self) -> Vec<String> {
        self.legs.iter().filter_map(|leg| leg.end.clone()).collect()
    }

    /// What changes at a value, in words; `None` where nothing does.
    pub fn change(&self, value: f64) -> Option<String> {
        let near = |at: f64| (at - value).abs() <= 1e-9 * value.abs().max(at.abs());
        self.legs.iter().find_map(|leg| match &leg.way {
            Way::Load(path) => path.breakpoints.iter().find(|at| near(at.factor)).map(|at| at.sentence.clone()),
            Way::Friction(path) => path.breakpoints.iter().find(|at| near(at.value)).map(|at| at.sentence.clone()),
        })
    }

    /// The pairs at a value within a stretch; `None` where its equations are singular.
    pub fn pairs(&self, stretch: &Stretch, at: f64) -> Option<Vec<PairState>> {
        let leg = &self.legs[stretch.leg];
        let prepared = &leg.there.prepared;
        match &leg.way {
            Way::Load(path) => path.pairs_within(path.ground(prepared), stretch.index, at),
            Way::Friction(path) => path.pairs_within(prepared, &self.values_at(leg, at), stretch.index),
        }
    }

    fn values_at(&self, leg: &Leg, at: f64) -> ParameterValues {
        let mut values = leg.there.values.clone();
        if values.contains_key(&self.name) {
            values.insert(self.name.clone(), at);
        }
        values
    }

    /// A quantity at a value within a stretch.
    ///
    /// # Errors
    /// Where it has none.
    pub fn value(&self, stretch: &Stretch, at: f64, quantity: &Quantity) -> Result<Value, NoValue> {
        let Basis { scenario, watch, .. } = self.basis;
        let leg = &self.legs[stretch.leg];
        let values = self.values_at(leg, at);
        let pairs = self.pairs(stretch, at).ok_or_else(|| NoValue("no answer".to_owned()))?;
        let (prepared, factors) = match &leg.way {
            Way::Load(path) => (path.ground(&leg.there.prepared), path.case_factors(at)),
            Way::Friction(_) => (&*leg.there.prepared, factors(&leg.there.prepared, &values)),
        };
        Facts::of_state(scenario, prepared, &values, factors, &pairs, watch).value(quantity)
    }
}
