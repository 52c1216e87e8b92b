//! What would stop a mechanism, as far as it can be proved: a restraint, more friction, less (or more) of a load.
//!
//! "Needed" comes from balanced forces: short of it none within the laws' bounds balance the loads. "Tried" comes from
//! solving: just beyond it an answer was found, which is the proof that it is enough.

use serde::Serialize;

use super::balance::{Multiples, balanced_multiples, is_balanced};
use super::mode::PartMotion;
use super::motions::FreeMotions;
use super::rigid::{RigidMotion, direction_word};
use crate::contact::problem::ContactProblem;
use crate::text::number::rounded;
use crate::text::words::short;
use crate::watch::{Budget, Watch};

/// Largest friction (or multiplier of it) that is considered.
const MOST_FRICTION: f64 = 1e3;
/// How far inside a limit an answer is tried.
const INSIDE: f64 = 1e-6;
/// A threshold is found to this share of itself; nearer to the present value it says nothing.
const FOUND_TO: f64 = 1e-7;

/// Something that would stop the mechanism.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Remedy {
    /// A restraint of a part against its motion. It stops this mode; that no other follows is not proved.
    Restraint {
        /// The part.
        part: String,
        /// Against what: "along x", "against turning about …".
        against: String,
    },
    /// Friction of all pairs that have one.
    Friction {
        /// Present friction; 1 if `multiplier`.
        present: f64,
        /// Smallest friction (if `multiplier`: multiple of the present frictions) for which balanced forces exist;
        /// `None`: none up to 1000.
        needed: Option<f64>,
        /// Whether the pairs' frictions differ and `needed` multiplies them.
        multiplier: bool,
        /// Whether an answer was found just above.
        tried: bool,
    },
    /// Factor of a load case, the others as they are.
    Load {
        /// The case.
        case: String,
        /// Its present factor.
        present: f64,
        /// The end, nearer to `present`, of the factors for which balanced forces exist; of the sign of `present`.
        needed: f64,
        /// The factor just inside at which an answer was found.
        tried: Option<f64>,
    },
}

/// What was found.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Remedies {
    /// The remedies.
    pub remedies: Vec<Remedy>,
    /// Whether all were looked for; otherwise the time was up.
    pub complete: bool,
}

/// Solves a changed problem; whether an answer was found.
pub type Try<'a> = &'a dyn Fn(&ContactProblem) -> bool;

/// Looks for what would stop the motion of these parts.
pub fn remedies(
    problem: &ContactProblem,
    motions: &FreeMotions,
    parts: &[PartMotion],
    solves: Try,
    budget: &Budget,
) -> Remedies {
    let mut found: Vec<Remedy> = parts
        .iter()
        .map(|part| Remedy::Restraint {
            part: part.name.clone(),
            against: match &part.motion {
                RigidMotion::Translation(u) => {
                    format!("along {}", direction_word(*u, part.dimension).trim_start_matches(['+', '-']))
                }
                RigidMotion::Rotation { point, turn, .. } => {
                    format!("against turning about {}", RigidMotion::about(part.dimension, *point, *turn, short))
                }
            },
        })
        .collect();
    let search = RemedySearch { problem, motions, solves, budget };
    let mut complete = true;
    let mut note = |result: Option<Option<Remedy>>| match result {
        Some(remedy) => found.extend(remedy),
        None => complete = false,
    };
    note(search.friction());
    for (k, factor) in problem.factors.iter().enumerate() {
        note(search.load(k, *factor));
    }
    Remedies { remedies: found, complete }
}

/// The searches; each gives `None` when the time is up or nothing could be decided, `Some(None)` where there is no such
/// remedy.
struct RemedySearch<'a> {
    problem: &'a ContactProblem,
    motions: &'a FreeMotions,
    solves: Try<'a>,
    budget: &'a Budget<'a>,
}

impl RemedySearch<'_> {
    fn seconds(&self) -> f64 {
        self.budget.left().as_secs_f64()
    }

    fn is_balanced(&self, problem: &ContactProblem) -> Option<bool> {
        if self.budget.stop() {
            return None;
        }
        is_balanced(problem, self.motions, self.seconds())
    }

    fn friction(&self) -> Option<Option<Remedy>> {
        let system = &*self.problem.system;
        let problem = self.problem;
        let rubbing = system.pairs.iter().zip(&problem.laws).filter(|(pair, _)| pair.law.friction().is_some());
        let frictions: Vec<f64> = rubbing.map(|(_, law)| law.friction()).collect();
        let Some(&first) = frictions.first() else { return Some(None) };
        let equal = frictions.iter().all(|f| *f == first);
        let largest = frictions.iter().copied().fold(0.0, f64::max);
        let multiplier = !equal && largest > 0.0;
        let with = |value: f64| {
            let mut changed = problem.clone();
            for law in &mut changed.laws {
                *law = law.with_friction(if multiplier { value * law.friction() } else { value });
            }
            changed
        };
        let present = if multiplier { 1.0 } else { first };
        let mut low = present;
        if self.is_balanced(&with(low))? {
            return Some(None);
        }
        let mut high = if low > 0.0 { 2.0 * low } else { 0.125 };
        while !self.is_balanced(&with(high))? {
            if high >= MOST_FRICTION {
                return Some(Some(Remedy::Friction { present, needed: None, multiplier, tried: false }));
            }
            low = high;
            high = (2.0 * high).min(MOST_FRICTION);
        }
        while high - low > 0.1 * FOUND_TO * high {
            let middle = 0.5 * (low + high);
            if self.is_balanced(&with(middle))? {
                high = middle;
            } else {
                low = middle;
            }
        }
        if high - present <= FOUND_TO * high {
            return Some(None);
        }
        let tried = (self.solves)(&with(high * (1.0 + INSIDE)));
        Some(Some(Remedy::Friction { present, needed: Some(high), multiplier, tried }))
    }

    fn load(&self, case: usize, present: f64) -> Option<Option<Remedy>> {
        let system = &*self.problem.system;
        let problem = self.problem;
        // A load that does not act is no remedy, nor is one that has to be reversed or left out.
        let Some(unit) = system.loads.get(case).map(|load| &load.vector).filter(|unit| unit.amax() > 0.0) else {
            return Some(None);
        };
        if present == 0.0 {
            return Some(None);
        }
        if self.budget.stop() {
            return None;
        }
        let fixed = &problem.load - present * unit;
        let between = match balanced_multiples(problem, self.motions, &fixed, unit, self.seconds()) {
            Multiples::Between(between) => between,
            Multiples::None => return Some(None),
            Multiples::Unknown => return None,
        };
        let (needed, other) = if present > between[1] {
            (between[1], between[0])
        } else if present < between[0] {
            (between[0], between[1])
        } else {
            return Some(None);
        };
        let same_sign = needed * present > 0.0;
        if !same_sign
            || (needed - present).abs() <= FOUND_TO * present.abs()
            || needed.abs() <= FOUND_TO * present.abs()
        {
            return Some(None);
        }
        let width = (needed - other).abs().min(needed.abs());
        let inside = needed + (other - needed).signum() * INSIDE * width;
        let mut changed = problem.clone();
        changed.add_load(inside - present, unit, &system.loads[case].terms);
        changed.factors[case] = inside;
        let tried = (self.solves)(&changed).then_some(inside);
        Some(Some(Remedy::Load { case: system.loads[case].name.clone(), present, needed, tried }))
    }
}

/// Six digits, trailing zeros dropped: limits deserve more than running text.
pub fn digits(value: f64) -> String {
    written(value, 6)
}

fn written(value: f64, digits: usize) -> String {
    if value.is_infinite() {
        return if value > 0.0 { "∞" } else { "-∞" }.to_owned();
    }
    let rounded = rounded(value, digits);
    let rounded = if rounded.abs() < 1e-9 && digits == 6 { 0.0 } else { rounded };
    format!("{rounded}")
}

/// Two numbers with as many digits, six at least, as it takes to tell them apart.
pub fn told_apart(a: f64, b: f64) -> (String, String) {
    (6..17)
        .map(|digits| (written(a, digits), written(b, digits)))
        .find(|(a, b)| a != b)
        .unwrap_or_else(|| (format!("{a}"), format!("{b}")))
}

/// A remedy as a row of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RemedyWords {
    /// "more friction in every pair".
    pub remedy: String,
    /// "above 0.21"; empty where there is none.
    pub threshold: String,
    /// "0.2"; empty where there is none.
    pub now: String,
    /// What was shown of it.
    pub shown: &'static str,
}

impl Remedy {
    /// As a row of a table.
    pub fn words(&self) -> RemedyWords {
        match self {
            Remedy::Restraint { part, against } => RemedyWords {
                remedy: format!("a restraint of {part} {against}"),
                threshold: String::new(),
                now: String::new(),
                shown: "stops this motion, maybe not the next",
            },
            Remedy::Friction { present, needed: None, multiplier, .. } => RemedyWords {
                remedy: friction_words(*multiplier),
                threshold: "none up to 1000".to_owned(),
                now: digits(*present),
                shown: "no friction gives balanced forces",
            },
            Remedy::Friction { present, needed: Some(needed), multiplier, tried } => {
                let (threshold, now) = told_apart(*needed, *present);
                let shown = shown(*tried);
                RemedyWords { remedy: friction_words(*multiplier), threshold: format!("above {threshold}"), now, shown }
            }
            Remedy::Load { case, present, needed, tried } => {
                let (threshold, now) = told_apart(*needed, *present);
                let (word, side) = if present > needed { ("less", "below") } else { ("more", "above") };
                // For a negative factor, more of the load is a smaller number.
                let word = if *present < 0.0 { if word == "less" { "more" } else { "less" } } else { word };
                RemedyWords {
                    remedy: format!("{word} of load case `{case}` (its factor)"),
                    threshold: format!("{side} {threshold}"),
                    now,
                    shown: shown(tried.is_some()),
                }
            }
        }
    }
}

fn friction_words(multiplier: bool) -> String {
    if multiplier { "more friction (a multiple of all)" } else { "more friction in every pair" }.to_owned()
}

fn shown(tried: bool) -> &'static str {
    if tried { "an answer was found just beyond it" } else { "needed; not proved to be enough" }
}
