//! The static theorem of shakedown for friction: where contact forces do not depend on slips, a structure shakes down from
//! every start if there are slips which, left behind once and for all, keep every pair short of its bound (Klarbring,
//! Ciavarella & Barber 2007; Melan's theorem).
//!
//! With s̃ such slips, ½ (s − s̃)ᵀ R (s − s̃) falls at the rate (x̃_τ − x_τ) ṡ, which is at least the least reserve
//! under s̃ times |ṡ|: that bounds the slip in all. Where slips press pairs on (R_nτ ≠ 0) none of this holds.

use nalgebra::DVector;

use super::load_parameter::factors_at;
use super::stages::{Begin, HistoryEnd, Moment};
use super::start::PathError;
use super::to_and_fro::ToAndFro;
use crate::contact::problem::ContactProblem;
use crate::contact::system::ContactSystem;
use crate::lcp::linear_program::{LinearProgram, Outcome};
use crate::lcp::problem::NOISE;
use crate::solve::Case;
use crate::solve::problem::{contact_problem, factors};

/// Seconds for one programme: linear in the plane, with a cone for each pair in space.
pub(super) const SECONDS: f64 = 10.0;
/// How far before the end of the programme the proof is tried, as shares of the way: at the end itself no reserve is
/// left.
const BEFORE: [f64; 6] = [1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4];
/// Pairs up to which slips are sought.
pub const MOST_PAIRS: usize = 500;

/// What the theorem says of every start.
#[derive(Clone, Debug, PartialEq)]
pub enum Static {
    /// It was not asked.
    NotAsked,
    /// It does not hold here: why.
    Inapplicable(String),
    /// This many pairs are too many to look.
    TooLarge(usize),
    /// No such slips were found.
    Nothing,
    /// Shakes down from every start: the least reserve under slips that were checked.
    Proved(f64),
}

/// A place of the cycle: what bounds the pairs there, and what the loads alone do in the tangential joints.
struct Place {
    /// Share of the way.
    t: f64,
    /// By pair; `None` without a tangential joint.
    bounds: Vec<Option<f64>>,
    /// By joint.
    load: DVector<f64>,
    terms: DVector<f64>,
}

struct Search<'a> {
    problem: &'a ContactProblem,
    /// Every tangential joint.
    joints: Vec<usize>,
    /// Forces and displacements are divided by these in the programmes.
    units: (f64, f64),
}

/// Units of force and length of a programme in which the largest force and stiffness are these.
pub(super) fn units(force: f64, stiffness: f64) -> (f64, f64) {
    let force = if force > 0.0 { force } else { 1.0 };
    (force, if stiffness > 0.0 { force / stiffness } else { 1.0 })
}

/// Why the theorem cannot be asked; `None` where it can.
fn refusal(problem: &ContactProblem) -> Option<Static> {
    let system = &*problem.system;
    if system.force_form.is_some() || system.yielding.is_some() {
        let why = "joints repeat one another, so that contact forces are not unique and the static theorem of shakedown does \
                   not hold";
        return Some(Static::Inapplicable(why.to_owned()));
    }
    let Some((i, j)) = coupled(problem) else {
        let count = system.pair_count();
        return (count > MOST_PAIRS).then_some(Static::TooLarge(count));
    };
    let [pressed, slipping] = [i, j].map(|pair| &system.pairs[pair].id);
    Some(Static::Inapplicable(format!(
        "a slip of {slipping} changes the contact force of {pressed}, so that the static theorem of shakedown does not hold"
    )))
}

/// A pair whose contact force depends on the slip of another one.
fn coupled(problem: &ContactProblem) -> Option<(usize, usize)> {
    let system: &ContactSystem = &problem.system;
    let unilateral = (0..system.pair_count()).filter(|&i| !problem.laws[i].is_bilateral());
    unilateral.into_iter().find_map(|i| {
        let strong = |t: usize| system.stiffness[(i, t)].abs() > system.entry_noise(i, t);
        system.pairs.iter().position(|pair| pair.tangential.clone().any(strong)).map(|j| (i, j))
    })
}

impl Place {
    fn of(problem: &ContactProblem, moment: &Moment) -> Place {
        let there = problem.clone().with_factors(&moment.factors);
        let pairs = problem.system.pairs.iter().zip(&moment.pairs);
        let bounds = pairs.map(|(pair, state)| (!pair.tangential.is_empty()).then_some(state.bound)).collect();
        Place { t: moment.t, bounds, load: there.load, terms: there.load_terms }
    }
}

/// Terms of a row of a programme.
type Terms = Vec<(usize, f64)>;

impl Search<'_> {
    fn new<'p>(problem: &'p ContactProblem, places: &[Place]) -> Search<'p> {
        let joints: Vec<usize> = problem.system.pairs.iter().flat_map(|pair| pair.tangential.clone()).collect();
        let bounds = places.iter().flat_map(|place| place.bounds.iter().flatten());
        let loads = places.iter().flat_map(|place| joints.iter().map(|&t| &place.load[t]));
        let force = bounds.chain(loads).fold(0.0, |most: f64, value| most.max(value.abs()));
        let stiffness = joints.iter().map(|&t| problem.system.stiffness[(t, t)]).fold(0.0, f64::max);
        Search { problem, joints, units: units(force, stiffness) }
    }

    /// R s of a tangential joint as terms of a programme.
    fn forces(&self, joint: usize) -> Terms {
        let r = &self.problem.system.stiffness;
        let (force, length) = self.units;
        let entry = |&t: &usize| r[(joint, t)] * length / force;
        self.joints.iter().map(entry).enumerate().filter(|(_, entry)| *entry != 0.0).collect()
    }

    /// Variables for the slips, and one that is 1.
    fn program(&self) -> (LinearProgram, usize) {
        let mut program = LinearProgram::default();
        self.joints.iter().for_each(|_| _ = program.variable(0.0));
        let one = program.variable(0.0);
        program.equal(vec![(one, 1.0)], 1.0);
        (program, one)
    }

    /// Demands that, with the slips, no pair is beyond its bound at a place; `bound` of a pair (from its bound there)
    /// and `load` of a joint are terms over the unit of force.
    fn demand(
        &self,
        program: &mut LinearProgram,
        place: &Place,
        bound: impl Fn(usize, f64) -> Terms,
        load: impl Fn(usize) -> Terms,
    ) {
        let pairs = self.problem.system.pairs.iter().zip(&place.bounds).enumerate();
        for (i, (pair, most)) in pairs {
            let Some(most) = most else { continue };
            let part = |joint: usize| [self.forces(joint), load(joint)].concat();
            let parts: Vec<Terms> = pair.tangential.clone().map(part).collect();
            program.at_least_length(&bound(i, *most), &parts);
        }
    }

    /// The same at a place as it is, with `extra`: a variable taken from every bound.
    fn demand_at(&self, program: &mut LinearProgram, place: &Place, one: usize, extra: Option<usize>) {
        let force = self.units.0;
        let bound =
            |_, most: f64| [(one, most / force)].into_iter().chain(extra.map(|reserve| (reserve, -1.0))).collect();
        self.demand(program, place, bound, |joint| vec![(one, place.load[joint] / force)]);
    }

    /// The slips that leave the most reserve at these places.
    fn most_reserve(&self, places: &[Place]) -> Option<DVector<f64>> {
        let (mut program, one) = self.program();
        let reserve = program.variable(-1.0);
        program.at_most(vec![(reserve, 1.0)], 1.0);
        places.iter().for_each(|place| self.demand_at(&mut program, place, one, Some(reserve)));
        match program.solve(SECONDS) {
            Outcome::Optimum(found) => Some(self.slips(&found.x)),
            _ => None,
        }
    }

    fn slips(&self, x: &[f64]) -> DVector<f64> {
        let mut slips = DVector::zeros(self.problem.system.joint_count());
        self.joints.iter().zip(x).for_each(|(&joint, x)| slips[joint] = x * self.units.1);
        slips
    }

    /// The least reserve under slips, less its rounding.
    fn reserve(&self, slips: &DVector<f64>, places: &[Place]) -> f64 {
        let r = &self.problem.system.stiffness;
        let (own, sizes) = (r * slips, r.abs() * slips.abs());
        let mut least = f64::INFINITY;
        for place in places {
            for (pair, bound) in self.problem.system.pairs.iter().zip(&place.bounds) {
                let Some(bound) = bound else { continue };
                let joints = || pair.tangential.clone();
                let force = joints().fold(0.0, |force: f64, joint| force.hypot(place.load[joint] + own[joint]));
                let terms: f64 = joints().map(|joint| place.terms[joint] + sizes[joint]).sum();
                least = least.min(bound - force - NOISE * (terms + bound));
            }
        }
        least
    }
}

fn present(case: Case<'_>) -> Option<ContactProblem> {
    let Case { prepared, values, .. } = case;
    Some(contact_problem(prepared.system()?, &factors(prepared, values), values))
}

/// What the theorem says of a cycle that passes these places.
pub fn static_shakedown<'m>(case: Case<'_>, moments: impl Iterator<Item = &'m Moment>) -> Static {
    let Some(problem) = present(case) else { return Static::NotAsked };
    if let Some(refusal) = refusal(&problem) {
        return refusal;
    }
    let places: Vec<Place> = moments.map(|moment| Place::of(&problem, moment)).collect();
    let search = Search::new(&problem, &places);
    let reserve = search.most_reserve(&places).map(|slips| search.reserve(&slips, &places));
    reserve.filter(|reserve| *reserve > 0.0).map_or(Static::Nothing, Static::Proved)
}

/// The way of a load from one value to another.
struct SecondWay {
    problem: ContactProblem,
    places: Vec<Place>,
    /// Whether it reaches its end.
    complete: bool,
}

/// The second way of a load from the unloaded structure to one value and on to another. `Err` where the theorem says nothing.
fn second_way(case: Case<'_>, name: &str, [from, to]: [f64; 2]) -> Result<Result<SecondWay, Static>, PathError> {
    let Some(problem) = present(case) else { return Ok(Err(Static::NotAsked)) };
    if let Some(refusal) = refusal(&problem) {
        return Ok(Err(refusal));
    }
    let targets = [factors_at(case, name, from)?, factors_at(case, name, to)?];
    let load = ToAndFro { name, ends: [from, to] };
    let history = load.follow(case, &Begin::Unloaded, &targets, &mut |_| false)?;
    let Some(stage) = history.stages.get(1) else { return Ok(Err(Static::Nothing)) };
    let places = stage.moments.iter().map(|moment| Place::of(&problem, moment)).collect();
    Ok(Ok(SecondWay { problem, places, complete: history.end == HistoryEnd::Complete }))
}

/// Whether the theorem proves that a load between these values shakes down from every start.
///
/// # Errors
/// See [`super::cycle::cycle`].
pub(super) fn shakes_down_surely(case: Case<'_>, name: &str, ends: [f64; 2]) -> Result<bool, PathError> {
    let Ok(SecondWay { problem, places, complete: true }) = second_way(case, name, ends)? else { return Ok(false) };
    let search = Search::new(&problem, &places);
    Ok(search.most_reserve(&places).is_some_and(|slips| search.reserve(&slips, &places) > 0.0))
}

/// Up to where, from the first value towards the second, the theorem proves that the load shakes down from every start.
///
/// # Errors
/// See [`super::cycle::cycle`].
pub fn static_limit(case: Case<'_>, name: &str, [from, to]: [f64; 2]) -> Result<(Option<f64>, Static), PathError> {
    let (problem, places) = match second_way(case, name, [from, to])? {
        Ok(SecondWay { problem, places, .. }) => (problem, places),
        Err(nothing) => return Ok((None, nothing)),
    };
    let search = Search::new(&problem, &places);
    let (Some((t, slips)), Some(first)) = (search.farthest(&places), search.most_reserve(&places[..1])) else {
        return Ok((None, Static::Nothing));
    };
    for share in BEFORE {
        // Between the slips for the farthest place and those with the most reserve at the first.
        let (at, slips) = (t * (1.0 - share), &slips * (1.0 - share) + &first * share);
        let passed: Vec<Place> = passed(&places, at);
        let reserve = search.reserve(&slips, &passed);
        if reserve > 0.0 {
            return Ok((Some(from + at * (to - from)), Static::Proved(reserve)));
        }
    }
    Ok((None, Static::Nothing))
}

/// Between two places: everything is affine there.
fn between(places: &[Place], k: usize, t: f64) -> Place {
    let (from, to) = (&places[k - 1], &places[k]);
    let share = if to.t > from.t { (t - from.t) / (to.t - from.t) } else { 1.0 };
    let mix = |a: f64, b: f64| a + share * (b - a);
    let bounds = from.bounds.iter().zip(&to.bounds).map(|(a, b)| Some(mix((*a)?, (*b)?))).collect();
    let load = from.load.zip_map(&to.load, mix);
    Place { t, bounds, load, terms: from.terms.zip_map(&to.terms, f64::max) }
}

/// The places up to t, t included.
fn passed(places: &[Place], t: f64) -> Vec<Place> {
    let before = places.iter().take_while(|place| place.t < t).count().clamp(1, places.len() - 1);
    let mut all: Vec<Place> = (1..before).map(|k| between(places, k, places[k].t)).collect();
    all.push(between(places, 1, places[0].t));
    all.push(between(places, before, t));
    all
}

impl Search<'_> {
    /// The farthest place of the way up to which one choice of slips holds all pairs, and that choice.
    fn farthest(&self, places: &[Place]) -> Option<(f64, DVector<f64>)> {
        let mut best = None;
        for k in 1..places.len() {
            let (from, to) = (&places[k - 1], &places[k]);
            if to.t <= from.t {
                continue;
            }
            let (mut program, one) = self.program();
            let share = program.variable(-1.0);
            program.at_most(vec![(share, 1.0)], 1.0);
            program.at_most(vec![(share, -1.0)], 0.0);
            places[..k].iter().for_each(|place| self.demand_at(&mut program, place, one, None));
            let force = self.units.0;
            let mix = |start: f64, end: f64| vec![(one, start / force), (share, (end - start) / force)];
            let bound = |pair: usize, start: f64| mix(start, to.bounds[pair].unwrap_or(start));
            self.demand(&mut program, from, bound, |joint| mix(from.load[joint], to.load[joint]));
            let Outcome::Optimum(found) = program.solve(SECONDS) else { break };
            let reached = found.x[share].clamp(0.0, 1.0);
            best = Some((from.t + reached * (to.t - from.t), self.slips(&found.x)));
            if reached < 1.0 - 1e-7 {
                break;
            }
        }
        best
    }
}
