//! The answer over a parameter from one value to another along a path: what `find`, `envelope` and `map` look at.
//!
//! The path starts from a cold answer at the lower end; where there is none, at the upper end, or else at the present
//! value in both directions. Between two breakpoints one working scheme holds, so that every quantity is a smooth
//! function there; on a load path those that are linear in forces and displacements are straight lines. In space the path is
//! taken in steps on Coulomb's cone.

use std::sync::Arc;

use super::end::PathEnd;
use super::on_cone::leads;
use super::quantity::{Facts, NoValue, Value};
use super::start::PathError;
use super::way::Way;
use crate::answer::record::PairState;
use crate::model::parameter::ParameterValues;
use crate::model::quantity::{Bend, Quantity, fits};
use crate::solve::case::There;
use crate::solve::error::SolveError;
use crate::solve::problem::factors;
use crate::solve::{Case, Solved};
use crate::watch::Watch;

/// Finds an answer to start from, or gives the word for how the run ended without one.
pub type Start<'s> = &'s dyn Fn(Case<'_>) -> Result<Result<Solved, &'static str>, SolveError>;

/// A path from a start, with the scenario made ready there.
pub(super) struct Leg {
    pub(super) way: Way,
    pub(super) there: Arc<There>,
}

/// Whether paths lead on from an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Led {
    /// To all targets, or as far as they lead.
    On,
    /// From another answer only.
    OffPaths,
    /// None does over this parameter: another dependence, or numbers that broke down.
    Nowhere,
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

impl Stretch {
    /// The parts into which places within it, upwards, cut it.
    pub fn cut(self, places: &[f64]) -> Vec<Stretch> {
        let ends: Vec<f64> = std::iter::once(self.from).chain(places.iter().copied()).chain([self.to]).collect();
        ends.windows(2).map(|ends| Stretch { from: ends[0], to: ends[1], ..self }).collect()
    }
}

/// How well an answer over a parameter is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Known {
    /// Along exact paths.
    Exactly,
    /// In steps on Coulomb's cone: changes are narrowed to some 1e-12 of their place, what is done and undone within a step may
    /// be missed.
    InSteps,
    /// By answers of their own, with nothing between them.
    AtPlaces,
}

/// What is said of an answer followed in steps.
pub const IN_STEPS: &str = "followed on Coulomb's cone in steps, each an answer that passed its check; that nothing else \
                            happens within a step is not proved";

/// The answer over a parameter.
pub struct Route<'a> {
    pub(super) case: Case<'a>,
    pub(super) name: String,
    pub(super) legs: Vec<Leg>,
    /// Its parts, upwards, without those of no length.
    pub stretches: Vec<Stretch>,
}

impl<'a> Route<'a> {
    /// Without a path yet.
    pub(super) fn empty(case: Case<'a>, name: &str) -> Route<'a> {
        Route { case, name: name.to_owned(), legs: Vec::new(), stretches: Vec::new() }
    }

    /// Follows the answer over `range`. `None` where no path leads over this parameter, or where one ends with answers beyond.
    ///
    /// # Errors
    /// No answer at either end or at the present value; see [`PathError`].
    pub fn new(case: Case<'a>, name: &str, range: [f64; 2]) -> Result<Option<Route<'a>>, PathError> {
        let solve: Start<'_> = &|case: Case<'_>| Ok(case.solve_pairs()?.if_answer(case.rules.cone));
        let route = Route::from_start(case, name, range, false, solve)?;
        Ok(route.filter(|route| !route.stops_short()))
    }

    /// The same, to the end of a path, from an answer that `solve` finds, looking for a start at the upper end first where that
    /// is wanted: where there are several answers it may be another one.
    ///
    /// # Errors
    /// As [`Route::new`].
    pub fn from_start(
        case: Case<'a>,
        name: &str,
        range: [f64; 2],
        upper: bool,
        solve: Start<'_>,
    ) -> Result<Option<Route<'a>>, PathError> {
        if case.prepared.is_in_space() && !leads(case.prepared, case.rules) {
            return Ok(None);
        }
        let mut route = Route::empty(case, name);
        let present = case.present(name).unwrap_or_default();
        let [low, high] = range;
        let mut starts = vec![(low, vec![high]), (high, vec![low])];
        if upper {
            starts.reverse();
        }
        if low < present && present < high {
            starts.push((present, vec![low, high]));
        }
        let (mut how, mut off_paths) = ("", false);
        for (start, targets) in starts {
            let there = case.at(name, start)?;
            let solved = match solve(there.case(case))? {
                Ok(solved) => solved,
                Err(word) => {
                    how = word;
                    continue;
                }
            };
            match route.lead(Arc::new(there), &solved, &targets)? {
                Led::On => return Ok(Some(route)),
                Led::OffPaths => off_paths = true,
                Led::Nowhere => return Ok(None),
            }
        }
        if off_paths {
            return Ok(None);
        }
        Err(PathError::NoStart { name: name.to_owned(), at: low, how: format!("with the outcome {how}") })
    }
}

impl Route<'_> {
    /// Takes the paths from an answer to some values among its legs: all of them or none.
    pub(super) fn lead(&mut self, there: Arc<There>, solved: &Solved, targets: &[f64]) -> Result<Led, PathError> {
        let mut ways = Vec::new();
        for &target in targets {
            match Way::follow(there.case(self.case), solved, &self.name, target) {
                // A path, but not from the answer at the start.
                Ok(way) if way.is_from_zero() => return Ok(Led::OffPaths),
                Err(PathError::OffPaths { .. }) => return Ok(Led::OffPaths),
                Ok(way) => ways.push(way),
                Err(
                    PathError::Mixed { .. }
                    | PathError::Unknown { .. }
                    | PathError::Idle(_)
                    | PathError::Breakdown { .. },
                ) => return Ok(Led::Nowhere),
                Err(error) => return Err(error),
            }
        }
        ways.into_iter().for_each(|way| self.take(Leg { way, there: Arc::clone(&there) }));
        self.stretches.sort_by(|a, b| a.from.total_cmp(&b.from));
        Ok(Led::On)
    }

    fn take(&mut self, leg: Leg) {
        let ends = leg.way.stretches();
        let number = self.legs.len();
        self.legs.push(leg);
        for (index, [a, b]) in ends.into_iter().enumerate().filter(|(_, [a, b])| a != b) {
            self.stretches.push(Stretch { from: a.min(b), to: a.max(b), leg: number, index });
        }
    }

    /// Whether a path ends with answers beyond that it does not lead to.
    pub(super) fn stops_short(&self) -> bool {
        self.legs.iter().any(|leg| leg.way.end().answer_beyond().is_some())
    }

    /// What tells those who look at it to stop.
    pub fn watch(&self) -> &dyn Watch {
        self.case.watch
    }

    /// The values of the parameter between which the answer was followed.
    pub fn covered(&self) -> [f64; 2] {
        self.covered_by(0).unwrap_or([f64::INFINITY, f64::NEG_INFINITY])
    }

    /// The same of the legs from one on; `None` where they have no length.
    pub(super) fn covered_by(&self, first: usize) -> Option<[f64; 2]> {
        let of = self.stretches.iter().filter(|stretch| stretch.leg >= first).map(|stretch| [stretch.from, stretch.to]);
        of.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    /// How well it is known.
    pub fn known(&self) -> Known {
        let in_steps = self.legs.iter().any(|leg| matches!(leg.way, Way::OnCone(_)));
        if in_steps { Known::InSteps } else { Known::Exactly }
    }

    /// Whether everything on it is straight between its breakpoints: a path over a load.
    pub fn is_straight(&self) -> bool {
        self.legs.iter().all(|leg| matches!(leg.way, Way::Load(_)))
    }

    /// What is said of a quantity where its extremes and zeros are not found for certain; `None` where they are, if the path
    /// itself is exact.
    pub fn doubt(&self, quantity: &Quantity) -> Option<String> {
        let doubted = match quantity.bend(self.case.prepared.is_in_space()) {
            Bend::Smooth => false,
            Bend::Up | Bend::Down | Bend::UpBetweenTurns => !self.is_straight(),
            Bend::Either => true,
        };
        doubted.then(|| {
            format!(
                "{quantity} may bend either way between two changes: it was looked at in many places and around its turns, and \
                 what comes and goes between two of them is not seen"
            )
        })
    }

    /// Whether extremes and zeros of a quantity are found for certain.
    pub fn is_exact(&self, quantity: &Quantity) -> bool {
        self.known() == Known::Exactly && self.doubt(quantity).is_none()
    }

    /// The parts of a stretch in which a quantity bends one way, where that is known.
    pub fn parts(&self, stretch: &Stretch, quantity: &Quantity) -> Vec<Stretch> {
        let turns = match (quantity.bend(self.case.prepared.is_in_space()), quantity.pattern()) {
            (Bend::UpBetweenTurns, Some(pattern)) if self.is_straight() => self.turns(stretch, pattern),
            _ => Vec::new(),
        };
        stretch.cut(&turns)
    }

    /// Where friction of pairs of the plane that fit a pattern is 0 within a stretch, on a straight path.
    fn turns(&self, stretch: &Stretch, pattern: &str) -> Vec<f64> {
        let Stretch { from, to, .. } = *stretch;
        let (Some(first), Some(last)) = (self.pairs(stretch, from), self.pairs(stretch, to)) else { return Vec::new() };
        let turning = first.iter().zip(&last).filter(|(a, b)| fits(pattern, &a.id) && a.x_t * b.x_t < 0.0);
        let mut places: Vec<f64> = turning.map(|(a, b)| from + (to - from) * (a.x_t / (a.x_t - b.x_t))).collect();
        places.retain(|at| from < *at && *at < to);
        places.sort_by(f64::total_cmp);
        places.dedup();
        places
    }

    /// Why the path does not lead to both ends of the range, and how it was followed where not exactly, in sentences.
    pub fn notes(&self) -> Vec<String> {
        let early = self.legs.iter().filter(|leg| *leg.way.end() != PathEnd::Target);
        let steps = (self.known() == Known::InSteps).then(|| IN_STEPS.to_owned());
        early.map(|leg| leg.way.end_sentence()).chain(self.joint_notes()).chain(steps).collect()
    }

    /// Whether it is certified that there is no answer further on, downwards or upwards.
    pub fn ends_for_good(&self, upwards: bool) -> bool {
        self.legs.iter().any(|leg| {
            let ends = leg.way.stretches();
            let rises = ends.first().zip(ends.last()).is_some_and(|(first, last)| last[1] > first[0]);
            rises == upwards && matches!(&leg.way, Way::OnCone(path) if path.for_good)
        })
    }

    /// What changes at a value, in words; `None` where nothing does.
    pub fn change(&self, value: f64) -> Option<String> {
        let near = |at: f64| (at - value).abs() <= 1e-9 * value.abs().max(at.abs());
        let breakpoints = self.legs.iter().flat_map(|leg| leg.way.breakpoints());
        breakpoints.into_iter().find(|at| near(at.value)).map(|at| at.sentence.clone())
    }

    /// The pairs at a value within a stretch; `None` where its equations are singular.
    pub fn pairs(&self, stretch: &Stretch, at: f64) -> Option<Vec<PairState>> {
        let leg = &self.legs[stretch.leg];
        let prepared = &leg.there.prepared;
        match &leg.way {
            Way::Load(path) => path.pairs_within(path.ground(prepared), stretch.index, at),
            Way::Friction(path) => path.pairs_within(prepared, &self.values_at(leg, at), stretch.index),
            Way::OnCone(path) => path.pairs_within(leg.there.case(self.case), stretch.index, at),
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
        let value = self.with_facts(stretch, at, |facts| facts.value(quantity));
        value.unwrap_or_else(|| Err(NoValue("no answer".to_owned())))
    }

    /// What is read at a value within a stretch; `None` where there is no answer.
    pub fn with_facts<T>(&self, stretch: &Stretch, at: f64, read: impl FnOnce(&Facts<'_>) -> T) -> Option<T> {
        let leg = &self.legs[stretch.leg];
        let values = self.values_at(leg, at);
        let pairs = self.pairs(stretch, at)?;
        let (prepared, factors) = match &leg.way {
            Way::Load(path) => (path.ground(&leg.there.prepared), path.case_factors(at)),
            Way::Friction(_) => (&*leg.there.prepared, factors(&leg.there.prepared, &values)),
            Way::OnCone(path) => {
                (path.over.ground(&leg.there.prepared), path.over.factors(&leg.there.prepared, &values, at))
            }
        };
        Some(read(&Facts::of_state(Case { prepared, values: &values, ..self.case }, factors, &pairs)))
    }
}
