//! The answer followed over a friction coefficient: the intervals in which one working scheme holds, their ends by
//! safeguarded root search on the exact dependence (method §6).
//!
//! Within a scheme every variable is a rational function of f. Its values and slopes at both ends of a step and its
//! value in the middle tell whether a cubic stands for it; then a zero inside the step shows, and is found on the
//! function itself. Beyond a zero the scheme is the one that the LCP of the rates takes, so ties need no rule of
//! their own; where it finds none, there is no continuous way on and the answer jumps.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::change::{Change, changes, sentence};
use super::rate::{number_rates, place_beside_laws, rate, rate_lcp};
use super::start::{PathError, cold, final_basis, state_of};
use crate::answer::pairs::pair_states;
use crate::answer::record::PairState;
use crate::contact::lcp::{ContactLcp, RowKind, contact_lcp};
use crate::contact::load_path::order;
use crate::contact::numbers::ContactNumbers;
use crate::contact::system::ContactSystem;
use crate::explain::words::short;
use crate::lcp::basis_solution::{Basis, vertex};
use crate::lcp::outcome::Point;
use crate::lcp::parametric::{End, Parametric, Reach};
use crate::model::jet::Dependence;
use crate::model::pair::Law;
use crate::model::parameter::{Number, ParameterValues};
use crate::model::rules::Covering;
use crate::model::scenario::Scenario;
use crate::solve::numbers::{contact_numbers, factors};
use crate::solve::{Prepared, Solved};
use crate::watch::Watch;

/// A variable below minus this multiple of the largest of its kind has gone through zero.
const ZERO: f64 = 1e-12;
/// Relative difference between cubic and function up to which the cubic stands for it.
const FAITHFUL: f64 = 1e-3;
/// Relative distance beyond a jump at which the next answer is looked for.
const BEYOND: f64 = 1e-9;
/// Steps and breakpoints of one path.
const STEPS: usize = 20_000;

/// An interval in which one scheme holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Interval {
    /// End nearer to the start of the path.
    pub from: f64,
    /// The other end.
    pub to: f64,
    /// The pairs halfway.
    pub pairs: Vec<PairState>,
}

/// A part of the path in one working scheme.
#[derive(Clone, Debug, PartialEq)]
pub struct Scheme {
    /// End nearer to the start of the path.
    pub from: f64,
    /// The other end.
    pub to: f64,
    basis: Basis,
}

/// A value at which the scheme changes.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionBreakpoint {
    /// The value, to 1e-10 relative or better.
    pub value: f64,
    /// The pairs that change.
    pub changes: Vec<Change>,
    /// Whether the answer jumps: at this value there are several answers, and the one followed ends.
    pub jump: bool,
    /// In words.
    pub sentence: String,
}

/// Why a friction path ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrictionEnd {
    /// At the target.
    Target,
    /// The answer followed ends and no other was found beyond.
    NoAnswer,
}

/// A followed path over friction.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionPath {
    /// The parameter.
    pub name: String,
    /// Where it starts.
    pub start: f64,
    /// The intervals, in the order of the path.
    pub intervals: Vec<Interval>,
    /// The breakpoints between them.
    pub breakpoints: Vec<FrictionBreakpoint>,
    /// Why it ends.
    pub end: FrictionEnd,
    /// The schemes in which it runs, in the order of the path.
    pub schemes: Vec<Scheme>,
    /// Places of the path for plots: value of the parameter and the pairs there.
    pub samples: Vec<(f64, Vec<PairState>)>,
}

impl FrictionPath {
    /// The pairs in a scheme of the path under `values`; `None` where its equations are singular.
    pub fn pairs_within(&self, prepared: &Prepared, values: &ParameterValues, scheme: usize) -> Option<Vec<PairState>> {
        let system = prepared.system()?;
        let factors = factors(prepared, values);
        let numbers = contact_numbers(system, &factors, values);
        let contact = contact_lcp(system, &numbers, Covering::Ones).ok()?;
        let point = vertex(&contact.lcp, &self.schemes.get(scheme)?.basis)?;
        let state = state_of(system, &numbers, &contact, &point);
        let mut pairs = pair_states(system, &numbers, &contact, &state);
        prepared.add_released_slips(&mut pairs, &numbers, &factors, &state.z);
        Some(pairs)
    }

    /// How the path ended, in a sentence.
    pub fn end_sentence(&self) -> String {
        let at = short(self.intervals.last().map_or(self.start, |last| last.to));
        let name = &self.name;
        match self.end {
            FrictionEnd::Target => format!("the target {name} = {at} is reached"),
            FrictionEnd::NoAnswer => {
                format!("the answer that was followed ends at {name} = {at}, and no other was found beyond")
            }
        }
    }
}

/// Whether the friction of some pair depends on a parameter (which so can be followed here).
pub fn is_friction(prepared: &Prepared, values: &ParameterValues, name: &str) -> bool {
    let along = values.along(name);
    prepared.system().is_some_and(|system| {
        let mut frictions = system.pairs.iter().filter_map(|pair| pair.law.friction());
        frictions.any(|friction| along.dependence(friction) != Dependence::Constant)
    })
}

struct Follower<'a> {
    prepared: &'a Prepared,
    system: &'a ContactSystem,
    values: &'a ParameterValues,
    name: &'a str,
    factors: Vec<f64>,
    /// +1 upwards, −1 downwards.
    sign: f64,
}

/// The answer of a scheme at one value, with its slopes along the path.
struct Place {
    value: f64,
    numbers: ContactNumbers,
    contact: ContactLcp,
    point: Point,
    /// Signed distances from the limits, each relative to the largest of its kind; and their slopes per unit of
    /// path.
    margins: Vec<f64>,
    slopes: Vec<f64>,
}

/// Follows the answer over a friction parameter from its present value.
///
/// # Errors
/// See [`PathError`].
pub fn trace(
    prepared: &Prepared,
    scenario: &Scenario,
    values: &ParameterValues,
    solved: Option<&Solved>,
    name: &str,
    to: f64,
    watch: &dyn Watch,
) -> Result<FrictionPath, PathError> {
    let system = prepared.system().ok_or(PathError::Plain("trace"))?;
    let mixed = |why: String| PathError::Mixed { name: name.to_owned(), why };
    if let Some(why) = place_beside_laws(scenario, name) {
        return Err(mixed(why));
    }
    let along = values.along(name);
    let moves = |number: &Number| along.dependence(number) != Dependence::Constant;
    let others = |law: &Law| law.numbers().into_iter().any(|(key, number)| key != "friction" && moves(number));
    if system.pairs.iter().any(|pair| others(&pair.law)) || prepared.cases.iter().any(|(_, factor)| moves(factor)) {
        return Err(mixed(
            "it is a friction coefficient and something else as well; give them parameters of their own".to_owned(),
        ));
    }
    let mut at_target = values.clone();
    at_target.insert(name.to_owned(), to);
    if let Some(refusal) = scenario.refusal(name, to).or_else(|| scenario.law_refusal(&at_target)) {
        return Err(PathError::Target(refusal));
    }
    // `is_friction` holds for a parameter of the scenario only.
    let start = values.get(name).copied().unwrap_or_default();
    let follower = Follower {
        prepared,
        system,
        values,
        name,
        factors: factors(prepared, values),
        sign: if to < start { -1.0 } else { 1.0 },
    };
    let mut path = FrictionPath {
        name: name.to_owned(),
        start,
        intervals: Vec::new(),
        breakpoints: Vec::new(),
        end: FrictionEnd::Target,
        schemes: Vec::new(),
        samples: Vec::new(),
    };
    let basis = match solved.and_then(final_basis) {
        Some(basis) => basis,
        None => {
            let found = cold(system, &follower.numbers(start), watch)?;
            let how = found.how().to_owned();
            found.basis.ok_or(PathError::NoStart { name: name.to_owned(), at: start, how })?
        }
    };
    follower.follow(&mut path, basis, to, watch)?;
    Ok(path)
}

impl Follower<'_> {
    fn values(&self, value: f64) -> ParameterValues {
        let mut values = self.values.clone();
        values.insert(self.name.to_owned(), value);
        values
    }

    fn numbers(&self, value: f64) -> ContactNumbers {
        contact_numbers(self.system, &self.factors, &self.values(value))
    }

    /// d(numbers)/dθ at a value: an expression has another rate everywhere.
    fn rates(&self, value: f64) -> ContactNumbers {
        number_rates(self.prepared, self.system, &self.values(value), self.name, &[]).0
    }

    fn place(&self, value: f64, basis: &Basis) -> Option<Place> {
        let numbers = self.numbers(value);
        let contact = contact_lcp(self.system, &numbers, Covering::Ones).ok()?;
        let point = vertex(&contact.lcp, basis)?;
        let lcp = rate_lcp(self.system, &numbers, &contact, &point, &self.rates(value), self.sign);
        let slope = rate(&lcp, basis)?;
        let mut place = Place { value, margins: Vec::new(), slopes: Vec::new(), numbers, contact, point };
        let largest = |values: &[f64]| {
            let size = values.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
            if size > 0.0 { size } else { 1.0 }
        };
        let (force, length) = (largest(&place.point.w), largest(&place.point.z));
        for (row, meaning) in place.contact.rows.iter().enumerate() {
            let is_active = basis.active.binary_search(&row).is_ok();
            // In an open pair without cohesion both reserves stay zero and the slip is free in sign.
            let free = meaning.couple != RowKind::Normal
                && place.numbers.laws[meaning.pair].fixed_bound() == 0.0
                && place.contact.normal_row[meaning.pair]
                    .is_some_and(|normal| basis.active.binary_search(&normal).is_ok() != place.contact.swapped[normal]);
            let (margin, slope) = match (free, is_active) {
                (true, _) => (1.0, 0.0),
                (_, true) => (place.point.z[row] / length, slope.z[row] / length),
                _ => (place.point.w[row] / force, slope.w[row] / force),
            };
            place.margins.push(margin);
            place.slopes.push(slope);
        }
        (place.margins.iter().chain(&place.slopes)).all(|value| value.is_finite()).then_some(place)
    }

    fn pairs(&self, place: &Place) -> Vec<PairState> {
        let state = state_of(self.system, &place.numbers, &place.contact, &place.point);
        let mut pairs = pair_states(self.system, &place.numbers, &place.contact, &state);
        self.prepared.add_released_slips(&mut pairs, &place.numbers, &self.factors, &state.z);
        pairs
    }

    fn follow(&self, path: &mut FrictionPath, mut basis: Basis, to: f64, watch: &dyn Watch) -> Result<(), PathError> {
        let singular = |at: f64| PathError::Breakdown {
            name: self.name.to_owned(),
            at,
            why: "the equations of the working scheme are singular".to_owned(),
        };
        let mut here = self.place(path.start, &basis).ok_or_else(|| singular(path.start))?;
        // The start may stand exactly on a limit.
        if let Ok(next) = self.scheme_beyond(&here, &basis)
            && let Some(place) = self.place(here.value, &next)
        {
            basis = next;
            here = place;
        }
        let mut before: Option<Vec<PairState>> = None;
        let mut jump = false;
        for _ in 0..STEPS {
            let from = here.value;
            let first = path.samples.len();
            path.samples.push((from, self.pairs(&here)));
            let reached = self.to_next_zero(here, &basis, to, path, watch)?;
            let middle = 0.5 * (from + reached.value);
            path.schemes.push(Scheme { from, to: reached.value, basis: basis.clone() });
            let halfway = self.place(middle, &basis).ok_or_else(|| singular(middle))?;
            let pairs = self.pairs(&halfway);
            if path.samples.len() == first + 1 {
                path.samples.push((middle, pairs.clone()));
            }
            path.samples.push((reached.value, self.pairs(&reached)));
            if let Some(before) = &before {
                let changes = changes(before, &pairs);
                if !changes.is_empty() {
                    path.breakpoints.push(FrictionBreakpoint {
                        value: from,
                        sentence: sentence(&changes),
                        changes,
                        jump,
                    });
                }
            }
            let merged = path.breakpoints.last().is_none_or(|last| last.value != from);
            match path.intervals.last_mut() {
                // Nothing that a pair shows changed here.
                Some(last) if merged => last.to = reached.value,
                _ => path.intervals.push(Interval { from, to: reached.value, pairs: pairs.clone() }),
            }
            before = Some(pairs);
            if reached.value == to {
                return Ok(());
            }
            jump = false;
            let next = self.scheme_beyond(&reached, &basis).ok().and_then(|next| {
                let beyond = self.beside(reached.value, to);
                let place = self.place(beyond, &next)?;
                // To first order a scheme may do that fails at once: then it is none.
                let holds = place.margins.iter().all(|margin| *margin >= -1e-7);
                (next != basis && holds).then_some(next)
            });
            here = match next {
                Some(next) => {
                    basis = next;
                    self.place(reached.value, &basis).ok_or_else(|| singular(reached.value))?
                }
                None => {
                    let beyond = self.beside(reached.value, to);
                    let found = cold(self.system, &self.numbers(beyond), watch)?;
                    let Some(next) = found.basis else {
                        path.end = FrictionEnd::NoAnswer;
                        return Ok(());
                    };
                    let place = self.place(beyond, &next).ok_or_else(|| singular(beyond))?;
                    jump = self.differs(&reached, &place);
                    basis = next;
                    // The interval starts at the breakpoint where the new scheme holds there too.
                    match self.place(reached.value, &basis) {
                        Some(place) if place.margins.iter().all(|m| *m >= -1e-7) => place,
                        _ => place,
                    }
                }
            };
        }
        Err(PathError::Breakdown {
            name: self.name.to_owned(),
            at: path.intervals.last().map_or(path.start, |last| last.to),
            why: format!("more than {STEPS} breakpoints"),
        })
    }

    /// A value a little further on.
    fn beside(&self, value: f64, to: f64) -> f64 {
        let beyond = value + self.sign * BEYOND * value.abs().max(1e-3);
        if self.sign > 0.0 { beyond.min(to) } else { beyond.max(to) }
    }

    fn differs(&self, a: &Place, b: &Place) -> bool {
        let z = |place: &Place| state_of(self.system, &place.numbers, &place.contact, &place.point).z;
        let (a, b) = (z(a), z(b));
        (&a - &b).amax() > 1e-6 * a.amax().max(b.amax())
    }

    /// The scheme just beyond a place, from the LCP of the rates there.
    fn scheme_beyond(&self, place: &Place, basis: &Basis) -> Result<Basis, ()> {
        let rates = self.rates(place.value);
        let lcp = rate_lcp(self.system, &place.numbers, &place.contact, &place.point, &rates, self.sign);
        let order = order(&place.contact);
        let mut engine = Parametric::new(Arc::new(lcp), basis, order).ok_or(())?;
        let reach = Reach {
            // Only the changes at the place itself: any step at all reaches this.
            target: 1e-13 * place.value.abs().max(1e-3),
            through: false,
            pivots: super::start::PIVOTS,
        };
        let path = engine.follow(reach, &mut |_| ControlFlow::Continue(()));
        match path.end {
            End::Target => Ok(path.last_scheme()),
            _ => Err(()),
        }
    }

    /// Goes on within the scheme to the first zero of a variable, or to the target.
    fn to_next_zero(
        &self,
        mut here: Place,
        basis: &Basis,
        to: f64,
        path: &mut FrictionPath,
        watch: &dyn Watch,
    ) -> Result<Place, PathError> {
        let span = (to - path.start).abs().max(f64::MIN_POSITIVE);
        let least = 1e-13 * here.value.abs().max(to.abs());
        let mut step = span / 8.0;
        for _ in 0..STEPS {
            let left = (to - here.value).abs();
            if left == 0.0 {
                return Ok(here);
            }
            watch.progress(&format!("{} = {}", self.name, short(here.value)), 1.0 - left / span);
            if watch.stop() {
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
            let faithful =
                cubics.iter().zip(&middle.margins).all(|(cubic, margin)| (cubic.at(0.5) - margin).abs() <= FAITHFUL);
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
                    return Ok(probe);
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
        let fallen: Vec<usize> = (0..bad.margins.len()).filter(|&k| bad.margins[k] < -ZERO).collect();
        let least = |place: &Place| fallen.iter().map(|&k| place.margins[k]).fold(f64::INFINITY, f64::min);
        let (mut a, mut b) = (good.value, bad.value);
        let (mut f_a, mut f_b) = (least(good).max(0.0), least(&bad));
        let mut best = bad;
        for round in 0..200 {
            let width = (b - a).abs();
            if width <= 4.0 * f64::EPSILON * a.abs().max(b.abs()) || f_a == 0.0 {
                break;
            }
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
                return place;
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
        self.place(b, basis).unwrap_or(best)
    }
}

/// Cubic through values and slopes at both ends of a step, on 0 … 1.
struct Cubic {
    values: [f64; 2],
    slopes: [f64; 2],
}

impl Cubic {
    fn new(a: &Place, b: &Place, k: usize, length: f64) -> Cubic {
        Cubic { values: [a.margins[k], b.margins[k]], slopes: [a.slopes[k] * length, b.slopes[k] * length] }
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
