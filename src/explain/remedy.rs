//! What would stop a mechanism, as far as it can be proved: a restraint, more friction, less (or more) of a load.
//!
//! "Needed" comes from the equilibrium LP: short of it no forces within the laws' bounds balance the loads. "Tried"
//! comes from solving: just inside it an answer was found, which is the proof that it is enough.

use nalgebra::DVector;

use super::certificate::balanced_multipliers;
use super::mode::{PartMotion, RigidMotion, direction_word};
use super::words::{list, short};
use crate::contact::numbers::ContactNumbers;
use crate::contact::system::ContactSystem;
use crate::model::pair::Law;
use crate::watch::Watch;

/// Most pairs for which friction and loads that would do are looked for.
pub const MOST_PAIRS: usize = 64;
/// Friction (or its multiplier) up to which is looked.
const MOST_FRICTION: f64 = 1e3;
/// How far inside a limit an answer is tried.
const INSIDE: f64 = 1e-6;

/// Something that would stop the mechanism.
#[derive(Clone, Debug, PartialEq)]
pub enum Remedy {
    /// A restraint of a part against its motion. It stops this mode; that no other follows is not proved.
    Restraint {
        /// The part.
        part: String,
        /// Against what: "along x", "against turning about …".
        against: String,
    },
    /// Friction of all Coulomb pairs.
    Friction {
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
        /// Factors between which balanced forces exist (may be infinite).
        between: [f64; 2],
        /// The factor just inside at which an answer was found.
        tried: Option<f64>,
    },
}

/// Solves under other numbers (and, if given, with another factor of one load case); whether an answer was found.
pub type Try<'a> = &'a dyn Fn(&ContactNumbers, Option<(usize, f64)>) -> bool;

/// Looks for what would stop the motion of these parts.
pub fn remedies(
    system: &ContactSystem,
    numbers: &ContactNumbers,
    cases: &[(String, f64)],
    parts: &[PartMotion],
    solves: Try,
    watch: &dyn Watch,
) -> Vec<Remedy> {
    let mut found: Vec<Remedy> = parts
        .iter()
        .map(|part| Remedy::Restraint {
            part: part.name.clone(),
            against: match &part.motion {
                RigidMotion::Translation(u) => {
                    format!("along {}", direction_word(*u).trim_start_matches(['+', '-']))
                }
                RigidMotion::Rotation { centre, .. } => {
                    format!("against turning about ({}, {})", short(centre[0]), short(centre[1]))
                }
            },
        })
        .collect();
    if system.pairs.len() > MOST_PAIRS {
        return found;
    }
    found.extend(friction(system, numbers, solves, watch));
    for (k, (case, factor)) in cases.iter().enumerate() {
        if watch.stop() {
            break;
        }
        found.extend(load(system, numbers, k, case, *factor, solves));
    }
    found
}

fn is_balanced(system: &ContactSystem, numbers: &ContactNumbers) -> bool {
    let none = DVector::zeros(numbers.load.len());
    balanced_multipliers(system, numbers, &numbers.load, &none).is_some()
}

fn friction(system: &ContactSystem, numbers: &ContactNumbers, solves: Try, watch: &dyn Watch) -> Option<Remedy> {
    let coulomb: Vec<usize> =
        (0..system.pairs.len()).filter(|&i| matches!(system.pairs[i].law, Law::Coulomb { .. })).collect();
    let first = numbers.friction[*coulomb.first()?];
    let equal = coulomb.iter().all(|&i| numbers.friction[i] == first);
    let largest = coulomb.iter().map(|&i| numbers.friction[i]).fold(0.0, f64::max);
    let multiplier = !equal && largest > 0.0;
    let with = |value: f64| {
        let mut changed = numbers.clone();
        for &i in &coulomb {
            changed.friction[i] = if multiplier { value * numbers.friction[i] } else { value };
        }
        changed
    };
    let mut low = if multiplier { 1.0 } else { first };
    if is_balanced(system, &with(low)) {
        return None;
    }
    let mut high = if low > 0.0 { 2.0 * low } else { 0.125 };
    while !is_balanced(system, &with(high)) {
        if high >= MOST_FRICTION || watch.stop() {
            return Some(Remedy::Friction { needed: None, multiplier, tried: false });
        }
        low = high;
        high = (2.0 * high).min(MOST_FRICTION);
    }
    for _ in 0..40 {
        if high - low <= 1e-9 * high || watch.stop() {
            break;
        }
        let middle = 0.5 * (low + high);
        if is_balanced(system, &with(middle)) {
            high = middle;
        } else {
            low = middle;
        }
    }
    Some(Remedy::Friction { needed: Some(high), multiplier, tried: solves(&with(high * (1.0 + INSIDE)), None) })
}

fn load(
    system: &ContactSystem,
    numbers: &ContactNumbers,
    case: usize,
    name: &str,
    factor: f64,
    solves: Try,
) -> Option<Remedy> {
    let unit = &system.loads.get(case)?.vector;
    if unit.amax() == 0.0 {
        return None;
    }
    let fixed = &numbers.load - factor * unit;
    let between = balanced_multipliers(system, numbers, &fixed, unit)?;
    if between[0] <= factor && factor <= between[1] {
        return None;
    }
    // The end that is nearer to the present factor, and a little inside.
    let (end, other) = if factor > between[1] { (between[1], between[0]) } else { (between[0], between[1]) };
    let width = (end - other).abs().min(end.abs().max(f64::MIN_POSITIVE));
    let inside = end + (other - end).signum() * INSIDE * width;
    let mut changed = numbers.clone();
    changed.set_load(fixed + inside * unit);
    Some(Remedy::Load {
        case: name.to_owned(),
        present: factor,
        between,
        tried: solves(&changed, Some((case, inside))).then_some(inside),
    })
}

/// Six digits, trailing zeros dropped: limits are worth more than running text.
pub fn digits(value: f64) -> String {
    if value.is_infinite() {
        return if value > 0.0 { "∞" } else { "-∞" }.to_owned();
    }
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    let rounded = if rounded.abs() < 1e-9 { 0.0 } else { rounded };
    format!("{rounded}")
}

impl Remedy {
    /// As the end of "What would stop it: …".
    pub fn words(&self) -> String {
        match self {
            Remedy::Restraint { part, against } => {
                format!("a restraint of {part} {against} (stops this motion; that no other follows is not proved)")
            }
            Remedy::Friction { needed: None, .. } => {
                "no friction up to 1000 (none gives forces that balance the loads)".to_owned()
            }
            Remedy::Friction { needed: Some(needed), multiplier, tried } => {
                let what = if *multiplier {
                    format!("{} times the friction", digits(*needed))
                } else {
                    format!("friction above {}", digits(*needed))
                };
                let proof = if *tried {
                    "below it no forces balance the loads, just above it an answer was found"
                } else {
                    "below it no forces balance the loads; that it is enough is not proved"
                };
                format!("{what} ({proof})")
            }
            Remedy::Load { case, present, between: [low, high], tried } => {
                let what = if *present > *high {
                    format!("a factor of `{case}` below {}", digits(*high))
                } else {
                    format!("a factor of `{case}` above {}", digits(*low))
                };
                let proof = if tried.is_some() {
                    "beyond it no forces balance the loads, just inside it an answer was found"
                } else {
                    "beyond it no forces balance the loads; that this is enough is not proved"
                };
                format!("{what}, now {} ({proof})", digits(*present))
            }
        }
    }
}

/// All remedies as one sentence; empty without any.
pub fn sentence(remedies: &[Remedy]) -> String {
    if remedies.is_empty() {
        return String::new();
    }
    let words: Vec<String> = remedies.iter().map(Remedy::words).collect();
    let all = match words.as_slice() {
        [head @ .., last] if !head.is_empty() => format!("{}; or {last}", head.join("; ")),
        _ => list(&words),
    };
    format!(" What would stop it: {all}.")
}
