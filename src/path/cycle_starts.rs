//! One load cycle after different slips: does what it comes to depend on the start?
//!
//! Where slips press pairs on or off (R_nτ ≠ 0) it may. Besides no slips at all, slips that go as far as they can are
//! tried: for each pair the largest and the least slip with which the structure stands still under the first load,
//! ```text
//!   max ± s_i   over   λ = R z + load,  x_n ≥ 0,  |x_τ| ≤ f x_n + c,   x_n = 0 ≤ z_n in pairs that are open without slips
//! ```
//! and at rest in the motions that cost no force. In space s_i is each component of the slip, and a polygon inside
//! Coulomb's disk takes its place.

use std::f64::consts::PI;

use nalgebra::DVector;

use super::cycle::{Cycle, Kind, PairSlip, Turn, cycle, followed};
use super::load_parameter::factors_at;
use super::stages::{Begin, loose_motions};
use super::start::PathError;
use super::static_shakedown::{SECONDS, Static, units};
use crate::contact::polygon::Polygon;
use crate::contact::problem::ContactProblem;
use crate::contact::system::{ContactPair, ContactSystem};
use crate::lcp::linear_program::{LinearProgram, Outcome};
use crate::solve::Case;
use crate::solve::problem::contact_problem;
use crate::text::number::short;

/// Facets of the polygon inside the disk.
const FACETS: u16 = 16;
/// Pairs up to which each one's extreme slips are tried.
pub const MOST_PAIRS: usize = 40;
/// What two cycles dissipate and leave behind is the same where it differs by less than this share of the largest.
const SAME: f64 = 1e-9;
/// In space, where cycles come near to the one that repeats and are known to the accuracy of the steps.
const SAME_IN_SPACE: f64 = 1e-6;

/// What a cycle comes to after a start.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct StartResult {
    /// `no slips`, `most b`, `least b`.
    pub start: String,
    /// Slips with which the cycle begins.
    pub slips: Vec<PairSlip>,
    /// What it comes to.
    pub kind: Kind,
    /// Cycles until it repeats; 0 where the history breaks down.
    pub cycles: usize,
    /// Work lost in the last one; `None` where the history breaks down.
    pub dissipated: Option<f64>,
    /// The largest way that it leaves behind; 0 where it does not ratchet, `None` where the history breaks down.
    pub net: Option<f64>,
    /// Where the history breaks down: why.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

/// The same load cycle after different starts.
#[derive(Clone, Debug, PartialEq)]
pub struct Starts {
    /// The load case or parameter.
    pub name: String,
    /// Its values at both ends.
    pub ends: [f64; 2],
    /// What was found after each start.
    pub starts: Vec<StartResult>,
    /// Whether they come to different cycles.
    pub decides: bool,
    /// What is proved of every start.
    pub every_start: Static,
}

impl Starts {
    /// What they show together, in a sentence.
    pub fn sentence(&self) -> String {
        let count = self.starts.len();
        let decided: Vec<&StartResult> = self.starts.iter().filter(|start| start.is_decided()).collect();
        let which = match count - decided.len() {
            0 => format!("all {count} starts"),
            _ if decided.is_empty() => return format!("undecided after each of {count} starts"),
            _ => format!("those of {count} starts that are decided, {},", decided.len()),
        };
        let rest = "starts between them were not followed";
        if !self.decides && decided.iter().all(|start| start.kind == Kind::ShakesDown) {
            return format!("after {which} it shakes down, whatever slips are left behind; {rest}");
        }
        if !self.decides {
            return format!("{which} come to the same cycle; {rest}");
        }
        let lost = || decided.iter().filter_map(|start| start.dissipated);
        let (least, most) = (lost().fold(f64::INFINITY, f64::min), lost().fold(0.0, f64::max));
        format!("the start decides: after {which} a cycle dissipates from {} to {}; {rest}", short(least), short(most))
    }
}

/// Follows a load cycle after no slips and after the largest slips both ways of each pair.
///
/// # Errors
/// As [`cycle`]; too many pairs, joints that repeat one another.
pub fn from_all(case: Case<'_>, name: &str, ends: [f64; 2], most: usize) -> Result<Starts, PathError> {
    let system = case.prepared.system().ok_or(PathError::Plain("cycle … from all"))?;
    if let Some(refusal) = system.dependence_refusal("cycle … from all", "give slips with `from PAIR=SLIP …`") {
        return Err(PathError::Missing(refusal));
    }
    let count = system.pair_count();
    if count > MOST_PAIRS {
        return Err(PathError::Missing(format!(
            "cycle … from all: {count} pairs make {} histories; up to {MOST_PAIRS} pairs are followed: give slips with `from \
             PAIR=SLIP …`",
            1 + 2 * system.pairs.iter().map(|pair| pair.tangential.len()).sum::<usize>()
        )));
    }
    let zero = cycle(case, name, ends, most, &Begin::Slips(vec![[0.0; 2]; count]))?;
    let first = &zero.history.stages[0].end.pairs;
    let open: Vec<bool> = first.iter().map(|pair| pair.z_n > 0.0).collect();
    let problem = contact_problem(system, &factors_at(case, name, ends[0])?, case.values);
    let mut begins = extreme_slips(&problem, &open, case)?;
    begins.dedup_by(|a, b| close(&a.1, &b.1));
    let mut starts = vec![StartResult::of("no slips".to_owned(), &zero)];
    let every_start = zero.every_start;
    for (index, (label, slips)) in begins.iter().enumerate() {
        case.watch.progress(&format!("start {label}"), index as f64 / begins.len() as f64);
        starts.push(match followed(case, name, ends, most, &Begin::Slips(slips.clone())) {
            Ok(found) => StartResult::of(label.clone(), &found),
            // One start of which nothing is known says nothing of the others.
            Err(error @ PathError::Breakdown { .. }) => StartResult::broken(label.clone(), system, slips, &error),
            Err(error) => return Err(error),
        });
    }
    let decides = differ(&starts, if system.is_in_space() { SAME_IN_SPACE } else { SAME });
    Ok(Starts { name: name.to_owned(), ends, starts, decides, every_start })
}

impl StartResult {
    fn of(start: String, found: &Cycle) -> StartResult {
        let last = found.turns.last();
        let net = |turn: &Turn| turn.pairs.iter().fold(0.0, |most, pair| f64::max(most, pair.net.abs()));
        StartResult {
            start,
            slips: found.start(),
            kind: found.kind,
            cycles: found.turns.len(),
            // Where it shakes down what is left is rounding.
            dissipated: Some(
                last.filter(|_| found.kind != Kind::ShakesDown).map_or(0.0, |turn| turn.dissipated.iter().sum()),
            ),
            net: Some(last.filter(|_| found.kind == Kind::Ratchets).map_or(0.0, net)),
            why: None,
        }
    }

    fn broken(start: String, system: &ContactSystem, slips: &[[f64; 2]], error: &PathError) -> StartResult {
        let slip = |(pair, &[first, second]): (&ContactPair, &[f64; 2])| match pair.tangential.len() {
            2 => PairSlip { pair: pair.id.clone(), slip: first.hypot(second), z_t: Some([first, second]) },
            _ => PairSlip { pair: pair.id.clone(), slip: first, z_t: None },
        };
        StartResult {
            start,
            slips: system.pairs.iter().zip(slips).map(slip).collect(),
            kind: Kind::Undecided,
            cycles: 0,
            dissipated: None,
            net: None,
            why: Some(error.to_string()),
        }
    }

    fn is_decided(&self) -> bool {
        self.kind != Kind::Undecided
    }
}

/// Whether those that are decided come to different cycles; numbers are the same within this share of the largest.
fn differ(starts: &[StartResult], same: f64) -> bool {
    let decided = || starts.iter().filter(|start| start.is_decided());
    let numbers = |start: &StartResult| [start.dissipated, start.net].map(Option::unwrap_or_default);
    let largest = |which: usize| decided().map(|start| numbers(start)[which]).fold(0.0, f64::max);
    let tolerance = [0, 1].map(|which| same * largest(which));
    let Some(first) = decided().next() else { return false };
    decided().any(|start| {
        let apart = |which: usize| (numbers(start)[which] - numbers(first)[which]).abs();
        start.kind != first.kind || (0..2).any(|which| apart(which) > tolerance[which])
    })
}

fn close(a: &[[f64; 2]], b: &[[f64; 2]]) -> bool {
    let (a, b) = (a.as_flattened(), b.as_flattened());
    let size = a.iter().chain(b).fold(0.0, |most: f64, slip| most.max(slip.abs()));
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME * size)
}

/// Unit directions of slip, and the share of the bound within which the polygon that they make lies inside the disk: in
/// the plane ±t and all of it.
fn directions(tangents: usize) -> (Vec<Vec<f64>>, f64) {
    if tangents < 2 {
        return (vec![vec![1.0; tangents], vec![-1.0; tangents]], 1.0);
    }
    let polygon = Polygon::regular(FACETS, 0.0);
    let facets = (0..polygon.facets()).map(|facet| polygon.direction(facet).to_vec()).collect();
    (facets, (PI / polygon.facets() as f64).cos())
}

/// A start by its name, with the slips of all pairs.
type Named = (String, Vec<[f64; 2]>);

/// The slips of all pairs at which one of them is largest or least.
fn extreme_slips(problem: &ContactProblem, open: &[bool], case: Case<'_>) -> Result<Vec<Named>, PathError> {
    let system = &*problem.system;
    let mut moving: Vec<usize> = (0..system.pair_count()).filter(|&i| open[i]).collect();
    moving.extend(system.pairs.iter().flat_map(|pair| pair.tangential.clone()));
    let constants = problem.joint_constants();
    let stiffness = system.stiffness.diagonal().amax();
    let (force, length) = units(constants.amax(), stiffness);
    let mut program = LinearProgram::default();
    moving.iter().for_each(|_| _ = program.variable(0.0));
    let row = |joint: usize, sign: f64| -> Vec<(usize, f64)> {
        let entry = |&column: &usize| sign * system.stiffness[(joint, column)] / stiffness;
        moving.iter().map(entry).enumerate().filter(|(_, entry)| *entry != 0.0).collect()
    };
    for (i, pair) in system.pairs.iter().enumerate() {
        let law = &problem.laws[i];
        if open[i] {
            program.equal(row(i, 1.0), -constants[i] / force);
            let place = moving.iter().position(|&joint| joint == i).unwrap_or_default();
            program.at_most(vec![(place, -1.0)], 0.0);
        } else if !law.is_bilateral() {
            program.at_most(row(i, -1.0), constants[i] / force);
        }
        if pair.tangential.is_empty() {
            continue;
        }
        let (directions, inside) = directions(pair.tangential.len());
        let (f, c) = (if open[i] { 0.0 } else { inside * law.friction() }, inside * law.fixed_bound());
        for direction in directions {
            let mut terms = row(i, -f);
            let mut constant = f * constants[i] + c;
            for (joint, part) in pair.tangential.clone().zip(direction) {
                terms.extend(row(joint, part));
                constant -= part * constants[joint];
            }
            program.at_most(terms, constant / force);
        }
    }
    for motion in loose_motions(system, &moving).column_iter() {
        program.equal(motion.iter().copied().enumerate().filter(|(_, v)| *v != 0.0).collect(), 0.0);
    }
    let mut found = Vec::new();
    for (place, &joint) in moving.iter().enumerate() {
        let Some(pair) = system.pairs.iter().position(|pair| pair.tangential.contains(&joint)) else { continue };
        if open[pair] {
            continue;
        }
        let along = match system.pairs[pair].is_in_space() {
            true => format!(" along t{}", joint - system.pairs[pair].tangential.start + 1),
            false => String::new(),
        };
        for (word, sign) in [("most", -1.0), ("least", 1.0)] {
            if case.watch.stop() {
                return Err(PathError::Interrupted);
            }
            program.set_costs([(place, sign)]);
            let Outcome::Optimum(optimum) = program.solve(SECONDS) else { continue };
            let mut slips = DVector::zeros(system.joint_count());
            moving.iter().zip(&optimum.x).for_each(|(&joint, x)| slips[joint] = x * length);
            let of_pair = |pair: &ContactPair| {
                let mut parts = [0.0; 2];
                pair.tangential.clone().zip(&mut parts).for_each(|(joint, part)| *part = slips[joint]);
                parts
            };
            let label = format!("{word} {}{along}", system.pairs[pair].id);
            found.push((label, system.pairs.iter().map(of_pair).collect()));
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn result(kind: Kind, dissipated: Option<f64>) -> StartResult {
        let (start, slips, why) = (String::new(), Vec::new(), dissipated.is_none().then(|| "no rates".to_owned()));
        StartResult { start, slips, kind, cycles: 1, dissipated, net: dissipated.map(|_| 0.0), why }
    }

    #[test]
    fn a_start_of_which_nothing_is_known_decides_nothing() {
        let broken = || result(Kind::Undecided, None);
        let slides = |lost: f64| result(Kind::Alternates, Some(lost));
        let said = |starts: Vec<StartResult>| {
            let decides = differ(&starts, SAME);
            let name = "L".to_owned();
            (decides, Starts { name, ends: [0.0, 1.0], starts, decides, every_start: Static::Nothing }.sentence())
        };
        let (decides, sentence) = said(vec![slides(0.5), broken(), slides(0.5)]);
        assert!(
            !decides && sentence.starts_with("those of 3 starts that are decided, 2, come to the same"),
            "{sentence}"
        );
        let (decides, sentence) = said(vec![slides(0.5), broken(), slides(0.7)]);
        assert!(
            decides && sentence.contains("those of 3 starts that are decided, 2, a cycle dissipates from 0.5"),
            "{sentence}"
        );
        let (decides, sentence) = said(vec![result(Kind::Undecided, Some(0.1)), broken()]);
        assert!(!decides && sentence == "undecided after each of 2 starts", "{sentence}");
    }
}
