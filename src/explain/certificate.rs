//! Are there contact forces within the laws' bounds that balance the loads on every motion that costs nothing? If not,
//! a motion proves it.
//!
//! ```text
//!   find λ:  x_n ≥ 0,  |x_τ| ≤ f x_n + c,   Zᵀ λ = Zᵀ RF           (bilateral pairs: x_n free)
//!   none  ⇔  a motion ζ with  ζ_n ≥ f |ζ_τ|  in every pair and  work of the loads > Σ c |ζ_τ|
//! ```
//! The second line is the Farkas alternative: on ζ every admissible λ takes at most Σ c |ζ_τ|, and the loads do more.
//!
//! The motion looked for is the one with the largest least margin: the signs of such a motion have room, so that f64
//! sums with the bounds of their rounding prove them (method §4, "Rays"). Where a part is confined
//! on both sides no motion has room everywhere: then the inequalities that must hold as equations are found, solved in
//! rationals, and every sign that has no room is evaluated exactly. A linear program only *proposes*; no verified
//! motion, no certificate. Of a system that a file gives, the motions are exact, and so is a last linear program
//! ([`super::exact_certificate`]).

use std::time::Instant;

use num_rational::BigRational;
use num_traits::Zero;

use super::exact_certificate::certify_exactly;
use super::exact_equations::{Equations, Solved};
use super::motions::{Entry, FreeMotions};
use super::proof::{BUDGET, Certificate, CertificateSearch};
use crate::contact::law::SENSES;
use crate::contact::problem::ContactProblem;
use crate::contact::sum::Sum;
use crate::lcp::exact::dyadic::{nearest, rational};
use crate::lcp::linear_program::{LinearProgram, Outcome};

/// A margin below this share of the motion is looked at more closely: the linear program cannot tell it from 0.
const UNCLEAR: f64 = 1e-5;
/// Magnifications of the closer looks.
const ZOOMS: [f64; 2] = [1e6, 1e9];
/// A share of the motion that the linear program can tell from 0.
const CLEAR: f64 = 1e-7;
/// An inequality that can be slack by no more than this share must hold as an equation.
const TIGHT: f64 = 1e-6;

/// Looks for a certificate.
pub fn certify(problem: &ContactProblem, motions: &FreeMotions) -> CertificateSearch {
    let system = &*problem.system;
    let work = motions.work(&system.forces_of(&problem.load), &system.forces_of(&problem.load_terms));
    let scale = work.iter().fold(0.0, |a: f64, work| a.max(work.value.abs()));
    if scale == 0.0 {
        return CertificateSearch::default();
    }
    let mut program = MotionProgram { problem, motions, work, scale, end: Instant::now() + BUDGET, out_of_time: false };
    let certificate = program.with_room().or_else(|| program.confined());
    if certificate.is_some() {
        return CertificateSearch { certificate, out_of_time: false };
    }
    let exactly = certify_exactly(problem, program.end);
    CertificateSearch { out_of_time: program.out_of_time || exactly.out_of_time, ..exactly }
}

/// ζ_n − side · f ζ_τ ≥ 0 of a pair.
struct Slack {
    pair: usize,
    side: f64,
    terms: Vec<(usize, f64)>,
}

struct MotionProgram<'a> {
    problem: &'a ContactProblem,
    motions: &'a FreeMotions,
    /// Work of the loads per unit of each motion.
    work: Vec<Sum>,
    /// Largest work of a motion.
    scale: f64,
    end: Instant,
    out_of_time: bool,
}

/// A sparse row plus `factor` times another one.
fn combined(row: &[Entry], factor: f64, other: &[Entry]) -> Vec<(usize, f64)> {
    let mut terms: Vec<(usize, f64)> = row.iter().map(|entry| (entry.motion, entry.part.value)).collect();
    for entry in other {
        let value = factor * entry.part.value;
        match terms.iter_mut().find(|(motion, _)| *motion == entry.motion) {
            Some((_, sum)) => *sum += value,
            None => terms.push((entry.motion, value)),
        }
    }
    terms.retain(|(_, value)| *value != 0.0);
    terms
}

impl MotionProgram<'_> {
    fn tangential(&self, pair: usize) -> &[Entry] {
        self.problem.system.pairs[pair].plane_tangential().map_or(&[], |joint| self.motions.row(joint))
    }

    /// Every inequality that some motion touches.
    fn slacks(&self) -> Vec<Slack> {
        let mut slacks = Vec::new();
        for (pair, law) in self.problem.laws.iter().enumerate().filter(|(_, law)| !law.is_bilateral()) {
            let normal = self.motions.row(pair);
            let f = law.friction();
            let sides: &[f64] = if f > 0.0 { &SENSES } else { &[0.0] };
            for &side in sides {
                let terms = combined(normal, -side * f, self.tangential(pair));
                if !terms.is_empty() {
                    slacks.push(Slack { pair, side, terms });
                }
            }
        }
        slacks
    }

    /// The joints that no motion of a proof may move: bilateral normals.
    fn held(&self) -> impl Iterator<Item = usize> {
        (0..self.problem.laws.len()).filter(|&i| self.problem.laws[i].is_bilateral())
    }

    /// The amounts of the motions within ±1, bilateral pairs held, and the terms of
    /// (work of the loads − what cohesion and bounds take) / scale.
    fn base(&self) -> (LinearProgram, Vec<(usize, f64)>) {
        let mut program = LinearProgram::default();
        for k in 0..self.motions.count() {
            program.variable(0.0);
            program.at_most(vec![(k, 1.0)], 1.0);
            program.at_most(vec![(k, -1.0)], 1.0);
        }
        for joint in self.held() {
            let terms = combined(self.motions.row(joint), 0.0, &[]);
            if !terms.is_empty() {
                program.equal(terms, 0.0);
            }
        }
        let mut surplus: Vec<(usize, f64)> =
            self.work.iter().enumerate().map(|(k, work)| (k, work.value / self.scale)).collect();
        for (pair, law) in self.problem.laws.iter().enumerate() {
            let c = law.fixed_bound();
            let slip = combined(self.tangential(pair), 0.0, &[]);
            if c > 0.0 && !slip.is_empty() {
                let most = program.variable(0.0);
                for sign in [1.0, -1.0] {
                    let mut terms: Vec<(usize, f64)> = slip.iter().map(|(k, a)| (*k, sign * a)).collect();
                    terms.push((most, -1.0));
                    program.at_most(terms, 0.0);
                }
                surplus.push((most, -c / self.scale));
            }
        }
        (program, surplus)
    }

    fn seconds(&self) -> f64 {
        self.end.saturating_duration_since(Instant::now()).as_secs_f64()
    }

    fn solve(&mut self, program: &LinearProgram) -> Option<Vec<f64>> {
        match program.solve(self.seconds()) {
            Outcome::Optimum(found) => Some(found.x),
            Outcome::OutOfTime => {
                self.out_of_time = true;
                None
            }
            _ => None,
        }
    }

    /// The motion with the largest least margin, verified.
    fn with_room(&mut self) -> Option<Certificate> {
        let (mut program, surplus) = self.base();
        let margin = program.variable(-1.0);
        let below = |terms: &[(usize, f64)]| -> Vec<(usize, f64)> {
            terms.iter().map(|(k, a)| (*k, -a)).chain([(margin, 1.0)]).collect()
        };
        program.at_most(below(&surplus), 0.0);
        for slack in self.slacks() {
            program.at_most(below(&slack.terms), 0.0);
        }
        let mut x = self.solve(&program)?;
        let found = self.proof(&x, &[]);
        if found.is_some() || x[margin] > UNCLEAR {
            return found;
        }
        for zoom in ZOOMS {
            x = program.refined(&x, zoom, self.seconds())?;
            if x[margin] <= 0.0 {
                return None;
            }
            let found = self.proof(&x, &[]);
            if found.is_some() {
                return found;
            }
        }
        None
    }

    /// A motion that leaves no room where a part is confined: the inequalities that must hold as equations are found,
    /// and solved exactly.
    fn confined(&mut self) -> Option<Certificate> {
        let (mut program, surplus) = self.base();
        let slacks = self.slacks();
        for slack in &slacks {
            program.at_most(slack.terms.iter().map(|(k, a)| (*k, -a)).collect(), 0.0);
        }
        program.set_costs(surplus.iter().map(|(k, a)| (*k, -a)));
        let x = self.solve(&program)?;
        let most: f64 = surplus.iter().map(|(k, a)| a * x[*k]).sum();
        if most <= CLEAR {
            return None;
        }
        // As much room as there can be in all inequalities at once.
        let (mut program, _) = self.base();
        let mut rooms = Vec::new();
        for slack in &slacks {
            let room = program.variable(-1.0);
            program.at_most(slack.terms.iter().map(|(k, a)| (*k, -a)).chain([(room, 1.0)]).collect(), 0.0);
            program.at_most(vec![(room, 1.0)], most);
            program.at_most(vec![(room, -1.0)], 0.0);
            rooms.push(room);
        }
        program.at_most(surplus.iter().map(|(k, a)| (*k, -a)).collect(), -0.5 * most);
        let x = self.solve(&program)?;
        let tight: Vec<&Slack> =
            slacks.iter().zip(&rooms).filter(|(_, room)| x[**room] < TIGHT * most).map(|(s, _)| s).collect();
        self.proof(&x, &tight)
    }

    /// The certificate if these amounts, put right where inequalities must hold as equations, are one.
    fn proof(&mut self, x: &[f64], tight: &[&Slack]) -> Option<Certificate> {
        let mut amounts = x[..self.motions.count()].to_vec();
        let mut equations = Equations::new(amounts.len(), self.end);
        let held: Vec<usize> = self.held().collect();
        for joint in held {
            equations.add(self.motions.row(joint).iter().map(|entry| (entry.motion, rational(entry.part.value))));
        }
        for slack in tight {
            equations.add(self.exact_terms(slack.pair, slack.side));
        }
        let exactly = match equations.nearest(&amounts) {
            Solved::Free => None,
            Solved::Exactly(exactly) => {
                amounts = exactly.iter().map(nearest).collect();
                Some(exactly)
            }
            Solved::OutOfTime => {
                self.out_of_time = true;
                return None;
            }
        };
        self.verified(&amounts, exactly.as_deref())
    }

    /// Terms of ζ_n − side · f ζ_τ as the data have them.
    fn exact_terms(&self, pair: usize, side: f64) -> Vec<(usize, BigRational)> {
        let f = rational(side * self.problem.laws[pair].friction());
        let normal = self.motions.row(pair).iter().map(|entry| (entry.motion, rational(entry.part.value)));
        let tangential = self.tangential(pair).iter().map(|entry| (entry.motion, -rational(entry.part.value) * &f));
        normal.chain(tangential).collect()
    }

    /// Every sign of the proof: by f64 sums with the bounds of their rounding, exactly where they have no room.
    fn verified(&mut self, amounts: &[f64], exactly: Option<&[BigRational]>) -> Option<Certificate> {
        let amount = |k: usize| exactly.map_or_else(|| rational(amounts[k]), |exactly| exactly[k].clone());
        let value = |terms: Vec<(usize, BigRational)>| -> BigRational {
            terms.into_iter().filter(|(k, _)| amounts[*k] != 0.0).map(|(k, a)| a * amount(k)).sum()
        };
        let mut taken = Sum::default();
        let mut needed_exact = false;
        for (pair, law) in self.problem.laws.iter().enumerate() {
            let normal = self.motions.displacement(pair, amounts);
            let slip = self.problem.system.pairs[pair]
                .plane_tangential()
                .map_or(Sum::default(), |joint| self.motions.displacement(joint, amounts));
            let (f, c) = (law.friction(), law.fixed_bound());
            taken = taken.plus(c, Sum { value: slip.value.abs(), ..slip });
            let sure = normal.value - f * slip.value.abs() > normal.error() + 2.0 * f * slip.error();
            let still = normal.magnitude == 0.0 && (f == 0.0 || slip.magnitude == 0.0);
            if still || (sure && !law.is_bilateral()) {
                continue;
            }
            if Instant::now() > self.end {
                self.out_of_time = true;
                return None;
            }
            needed_exact = true;
            // What is neither 0 nor clear of its rounding proves nothing.
            let error = normal.error() + 2.0 * f * slip.error();
            let holds = if law.is_bilateral() {
                value(self.exact_terms(pair, 0.0)).is_zero()
            } else {
                SENSES.iter().all(|side| {
                    let slack = value(self.exact_terms(pair, *side));
                    slack.is_zero() || nearest(&slack) > error
                })
            };
            if !holds {
                return None;
            }
        }
        let mut power = Sum::default();
        for (work, amount) in self.work.iter().zip(amounts) {
            power = power.plus(*amount, *work);
        }
        if power.value - taken.value <= power.error() + 2.0 * taken.error() {
            return None;
        }
        let direction = self.motions.displacements(amounts);
        let largest = direction.amax();
        Some(Certificate {
            direction: direction / largest,
            power: power.value / largest,
            dissipation: taken.value / largest,
            exact: needed_exact || exactly.is_some(),
            amounts: (0..amounts.len()).map(amount).collect(),
        })
    }
}
