//! The answer in space followed over a load or over friction, on Coulomb's cone.
//!
//! Directions of slip turn on the way, so that nothing is affine between two breakpoints: the way is taken in steps,
//! each an answer of its own that Newton's method finds from the one before. Where pairs do something else at the end
//! of a step the place is searched for between its ends. Every place of the path is freshly checked; that none was
//! overlooked between two of them is not proved.

mod aim;
mod edge;
mod over;
mod stand;
mod turn;
mod unseen;
mod walk;

use self::over::Path;
use self::stand::displacements;
use super::beside::{no_limit, search};
use super::change::Breakpoint;
use super::cone_step::Stepper;
use super::end::PathEnd;
use super::load::LoadReach;
use super::load_parameter::LoadParameter;
use super::start::PathError;
use super::{friction, start};
use crate::answer::record::PairState;
use crate::contact::system::ContactSystem;
use crate::model::rules::Rules;
use crate::solve::{Case, Prepared, Solved};

pub use self::over::Over;
pub use self::stand::Place;

/// Across a breakpoint displacements that change by more than this share of the largest have jumped.
const JUMP: f64 = 1e-5;

/// A path in space.
#[derive(Clone, Debug)]
pub struct ConePath {
    /// The load case or parameter.
    pub name: String,
    /// What it is followed over.
    pub over: Over,
    /// Where it starts.
    pub start: f64,
    /// Whether it starts from factor 0 because the present state is no answer, or one that no path starts from …
    pub from_zero: bool,
    /// … and whether it is the latter.
    pub is_present_off_paths: bool,
    /// The places, in order.
    pub places: Vec<Place>,
    /// The breakpoints: each at the place before the change.
    pub breakpoints: Vec<Breakpoint>,
    /// Why it ends.
    pub end: PathEnd,
    /// Whether it ends in a collapse that goes on at every value up to the target: followed over a load.
    pub for_good: bool,
}

impl ConePath {
    /// The value at its end, of what it is followed over.
    pub fn last(&self) -> f64 {
        self.places.last().map_or(self.start, |last| last.value)
    }

    /// The limit, a value of what it is followed over, where it ends in one.
    pub fn limit(&self) -> Option<f64> {
        matches!(self.end, PathEnd::Collapse(_)).then(|| self.last())
    }

    /// How it ended, in a sentence.
    pub fn end_sentence(&self) -> String {
        let sentence = self.end.sentence(&self.name, self.last());
        match self.end {
            PathEnd::AnswerBeyond(beyond) if !self.over.is_friction() => {
                no_limit(&sentence, &search(&self.name, beyond, beyond - self.start))
            }
            // The friction polygon may still have one.
            PathEnd::NoAnswer => format!("{sentence} on Coulomb's cone"),
            _ => sentence,
        }
    }

    /// Indices of the places in each scheme, in order.
    fn schemes(&self) -> Vec<std::ops::Range<usize>> {
        let ends = self.breakpoints.iter().map(|at| at.place + 1).chain([self.places.len()]);
        let starts = std::iter::once(0).chain(self.breakpoints.iter().map(|at| at.place + 1));
        starts.zip(ends).map(|(start, end)| start..end).collect()
    }

    /// The places, and which of them are in the last scheme.
    fn last_scheme(&self) -> (&[Place], std::ops::Range<usize>) {
        let start = self.breakpoints.last().map_or(0, |at| at.place + 1);
        (&self.places, start..self.places.len())
    }

    /// The values between which one scheme holds, in the order of the path.
    pub fn stretches(&self) -> Vec<[f64; 2]> {
        // A scheme ends where the next begins.
        let value = |place: usize| self.places[place.min(self.places.len() - 1)].value;
        self.schemes().into_iter().map(|scheme| [value(scheme.start), value(scheme.end)]).collect()
    }

    /// The pairs at a value within a scheme, from the neighbouring places; `None` where there is no answer near.
    pub(super) fn pairs_within(&self, case: Case<'_>, scheme: usize, value: f64) -> Option<Vec<PairState>> {
        let places = &self.places[self.schemes().get(scheme)?.clone()];
        let (first, last) = (places.first()?, places.last()?);
        let sign = if last.value < first.value { -1.0 } else { 1.0 };
        let after = places.partition_point(|place| (value - place.value) * sign > 0.0).min(places.len() - 1);
        let [before, after] = [&places[after.saturating_sub(1)], &places[after]];
        if (value - after.value) * sign >= 0.0 {
            return Some(after.pairs.clone());
        }
        let path = Path::new(case, &self.name, &self.over);
        let problem = path.problem(value).ok()?;
        let [from, to] = [before, after].map(|place| displacements(&problem, &place.pairs));
        let way = after.value - before.value;
        let share = if way == 0.0 { 0.0 } else { (value - before.value) / way };
        let stepper = Stepper::new(case.rules.facets, case.watch);
        let found = path.near(&stepper, value, &(&from + (to - &from) * share)).ok()??;
        Some(found.place.pairs)
    }
}

/// Whether the answer of a problem in space can be followed.
pub(super) fn leads(prepared: &Prepared, rules: Rules) -> bool {
    prepared.system().is_some() && rules.cone
}

fn refuse(prepared: &Prepared, rules: Rules) -> Result<&ContactSystem, PathError> {
    let system = prepared.system().ok_or(PathError::Plain("trace"))?;
    if !rules.cone {
        let why = "in space answers are followed on Coulomb's cone: `set cone on` (`solver.cone`: true) first";
        return Err(PathError::Missing(why.to_owned()));
    }
    Ok(system)
}

/// Follows the answer over a load.
///
/// # Errors
/// See [`PathError`].
pub fn trace_load(
    case: Case<'_>,
    solved: Option<&Solved>,
    name: &str,
    reach: LoadReach,
) -> Result<ConePath, PathError> {
    let (parameter, grown) = LoadParameter::find(case, name)?;
    let system = refuse(grown.as_deref().unwrap_or(case.prepared), case.rules)?;
    if parameter.direction(system).amax() == 0.0 {
        return Err(PathError::Idle(parameter.name));
    }
    start::finite_target(name, reach.to)?;
    let shown = solved.filter(|solved| solved.stands(true));
    let present = parameter.present;
    let over = Over::Load(parameter, grown);
    let path = Path::new(case, name, &over);
    if shown.is_none() {
        return path.follow(None, 0.0, reach);
    }
    match path.follow(shown, present, reach) {
        Err(PathError::OffPaths { .. }) if present != 0.0 => {
            Ok(ConePath { is_present_off_paths: true, ..path.follow(None, 0.0, reach)? })
        }
        followed => followed,
    }
}

/// Follows the answer over a friction parameter from its present value.
///
/// # Errors
/// See [`PathError`].
pub fn trace_friction(case: Case<'_>, solved: Option<&Solved>, name: &str, to: f64) -> Result<ConePath, PathError> {
    refuse(case.prepared, case.rules)?;
    let start = friction::start_of(case, name, to)?;
    let shown = solved.filter(|solved| solved.stands(true));
    Path::new(case, name, &Over::Friction).follow(shown, start, LoadReach { to: Some(to), through: false })
}
