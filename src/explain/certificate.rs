//! Are there contact forces within the laws' bounds that balance the loads on every motion that costs nothing? If not,
//! a motion proves it.
//!
//! ```text
//!   find λ:  x_n ≥ 0,  |x_τ| ≤ f x_n + c,   Zᵀ λ = Zᵀ RF           (bilateral pairs: x_n free)
//!   none  ⇔  a motion ζ with  ζ_n ≥ f |ζ_τ|  in every pair and  work of the loads > Σ c |ζ_τ|
//! ```
//! The second line is the Farkas alternative: on ζ every admissible λ takes at most Σ c |ζ_τ|, and the loads do more.
//! In space |ζ_τ| is the length of a vector and the program has cones: what it proves holds for Coulomb's law itself,
//! not for a polygon in its place.
//!
//! The motion looked for is the one with the largest least margin: the signs of such a motion have room, so that f64
//! sums with the bounds of their rounding prove them (method §4, "Rays"). Where a part is confined on both sides no
//! motion has room everywhere: then the inequalities that must hold as equations are found, solved in rationals, and
//! every sign that has no room is evaluated exactly. A program only *proposes*; no verified motion, no certificate. For
//! a system that a file gives, the motions are exact, and so is a last linear program ([`super::exact_certificate`]).

use std::time::Instant;

use nalgebra::DVector;

use super::exact_certificate::certify_exactly;
use super::exact_equations::{Equations, Solved};
use super::known_normals::with_known_normals;
use super::motions::{Entry, FreeMotions};
use super::proof::{BUDGET, Certificate, CertificateSearch};
use crate::contact::cone::ConePair;
use crate::contact::law::SENSES;
use crate::contact::on_cone::widest_cone_pairs;
use crate::contact::problem::ContactProblem;
use crate::contact::sum::Sum;
use crate::lcp::exact::dyadic::Dyadic;
use crate::lcp::linear_program::{LinearProgram, Outcome, TOLERANCE};

/// A margin below this share of the motion is looked at more closely: the program cannot tell it from 0.
const UNCLEAR: f64 = 1e-5;
/// Magnifications of the closer looks.
const ZOOMS: [f64; 2] = [1e6, 1e9];
/// A share of the motion that the program can tell from 0.
const CLEAR: f64 = 1e-7;
/// An inequality that can be slack by no more than this share must hold as an equation.
const TIGHT: f64 = 1e-6;
/// A room that the program can tell from none.
const ROOM: f64 = 10.0 * TOLERANCE;

/// Looks for a certificate. In the plane a problem whose normal forces the load decides is left to the search through
/// its schemes.
pub fn certify(problem: &ContactProblem, motions: &FreeMotions) -> CertificateSearch {
    let system = &*problem.system;
    let end = Instant::now() + BUDGET;
    let load = Load { forces: &system.forces_of(&problem.load), terms: &system.forces_of(&problem.load_terms) };
    let search = |pairs: &[ConePair]| {
        let found = certify_pairs(pairs, motions, load, end);
        // In space the exact program has a polygon around the disk: it finds more, and does not refute.
        let is_settled = match found.certificate {
            None => load.does_no_work(motions),
            Some(_) => system.is_in_space(),
        };
        if is_settled {
            return found;
        }
        let Some(exactly) = certify_exactly(problem, pairs, end) else { return found };
        let out_of_time = exactly.out_of_time;
        // Exact data decide, what f64 makes of their motions is a proposal.
        let undecided = out_of_time || system.is_in_space();
        let agree = exactly.certificate.is_some() && found.certificate.is_some();
        if agree || (exactly.certificate.is_none() && undecided) {
            CertificateSearch { out_of_time, ..found }
        } else {
            exactly
        }
    };
    let pairs = widest_cone_pairs(problem);
    let found = search(&pairs);
    if found.certificate.is_some() || load.does_no_work(motions) {
        return found;
    }
    let of_this_load = with_known_normals(problem, &pairs).and_then(|pairs| {
        let found = search(&pairs).certificate?;
        Some(Certificate { of_this_load: true, ..found })
    });
    CertificateSearch { certificate: of_this_load, ..found }
}

/// The certificate if these amounts of the motions, found for other loads or other friction, are one here, too.
pub fn certify_again(problem: &ContactProblem, motions: &FreeMotions, amounts: &[f64]) -> Option<Certificate> {
    if amounts.len() != motions.count() {
        return None;
    }
    let system = &*problem.system;
    let pairs = widest_cone_pairs(problem);
    let load = Load { forces: &system.forces_of(&problem.load), terms: &system.forces_of(&problem.load_terms) };
    let end = Instant::now() + BUDGET;
    MotionProgram::new(&pairs, motions, load, end)?.verified(amounts, None).or_else(|| {
        let pairs = with_known_normals(problem, &pairs)?;
        let found = MotionProgram::new(&pairs, motions, load, end)?.verified(amounts, None)?;
        Some(Certificate { of_this_load: true, ..found })
    })
}

/// Forces over the joints with the magnitudes that each was summed from.
#[derive(Clone, Copy, Debug)]
pub struct Load<'a> {
    /// RF.
    pub forces: &'a DVector<f64>,
    /// The magnitudes.
    pub terms: &'a DVector<f64>,
}

impl Load<'_> {
    fn does_no_work(self, motions: &FreeMotions) -> bool {
        motions.work(self.forces, self.terms).iter().all(|work| work.value == 0.0)
    }
}

/// Looks until `end` for a motion that is proved by f64 sums or, where it has no room, by rationals: what is proved
/// depends on the motions, the load and the laws alone.
pub fn certify_pairs(pairs: &[ConePair], motions: &FreeMotions, load: Load, end: Instant) -> CertificateSearch {
    let Some(mut program) = MotionProgram::new(pairs, motions, load, end) else { return CertificateSearch::default() };
    let certificate = program.with_room().or_else(|| program.confined());
    let out_of_time = certificate.is_none() && program.out_of_time;
    CertificateSearch { certificate, out_of_time }
}

type Terms = Vec<(usize, f64)>;

/// ζ_n − f |ζ_τ| ≥ 0 of a pair, in the plane one of its two senses: Σ `most` ≥ |Σ `parts`|.
struct Slack {
    pair: usize,
    /// ± 1 in the plane; `None` in space and without friction.
    sense: Option<f64>,
    most: Terms,
    parts: Vec<Terms>,
}

impl Slack {
    /// Demands it with this room.
    fn demand(&self, program: &mut LinearProgram, room: Option<usize>) {
        let most: Terms = self.most.iter().copied().chain(room.map(|room| (room, -1.0))).collect();
        program.at_least_length(&most, &self.parts);
    }
}

struct MotionProgram<'a> {
    pairs: &'a [ConePair],
    motions: &'a FreeMotions,
    /// Work of the loads per unit of each motion.
    work: Vec<Sum>,
    /// Largest work of a motion.
    scale: f64,
    end: Instant,
    out_of_time: bool,
}

/// A sparse row plus `factor` times another one.
fn combined(row: &[Entry], factor: f64, other: &[Entry]) -> Terms {
    let mut terms: Terms = row.iter().map(|entry| (entry.motion, entry.part.value)).collect();
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

fn exactly(row: &[Entry]) -> Vec<(usize, Dyadic)> {
    row.iter().map(|entry| (entry.motion, entry.exact.clone())).collect()
}

impl<'a> MotionProgram<'a> {
    /// `None` where the loads do no work on any motion.
    fn new(pairs: &'a [ConePair], motions: &'a FreeMotions, load: Load, end: Instant) -> Option<Self> {
        let work = motions.work(load.forces, load.terms);
        let scale = work.iter().fold(0.0, |a: f64, work| a.max(work.value.abs()));
        (scale > 0.0).then_some(MotionProgram { pairs, motions, work, scale, end, out_of_time: false })
    }

    /// Rows of the tangential joints of a pair.
    fn tangential(&self, pair: usize) -> Vec<&'a [Entry]> {
        self.pairs[pair].tangents.clone().map(|joint| self.motions.row(joint)).collect()
    }

    /// Every inequality that some motion touches.
    fn slacks(&self) -> Vec<Slack> {
        let mut slacks = Vec::new();
        for (pair, ConePair { law, .. }) in self.pairs.iter().enumerate().filter(|(_, pair)| !pair.law.is_bilateral()) {
            let normal = self.motions.row(pair);
            let f = law.friction();
            let tangential = if f > 0.0 { self.tangential(pair) } else { Vec::new() };
            let mut add = |sense: Option<f64>, most: Terms, parts: Vec<Terms>| {
                if !most.is_empty() || parts.iter().any(|part| !part.is_empty()) {
                    slacks.push(Slack { pair, sense, most, parts });
                }
            };
            match tangential[..] {
                [] => add(None, combined(normal, 0.0, &[]), Vec::new()),
                [tangential] => {
                    SENSES.iter().for_each(|side| add(Some(*side), combined(normal, -side * f, tangential), Vec::new()))
                }
                _ => {
                    let part = |row: &&[Entry]| combined(&[], f, row);
                    add(None, combined(normal, 0.0, &[]), tangential.iter().map(part).collect());
                }
            }
        }
        slacks
    }

    /// The joints that no motion of a proof may move: bilateral normals.
    fn held(&self) -> impl Iterator<Item = usize> {
        (0..self.pairs.len()).filter(|&i| self.pairs[i].law.is_bilateral())
    }

    /// The amounts of the motions within ±1, bilateral pairs held, and the terms of
    /// (work of the loads − what cohesion and bounds take) / scale.
    fn base(&self) -> (LinearProgram, Terms) {
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
        let mut surplus: Terms = self.work.iter().enumerate().map(|(k, work)| (k, work.value / self.scale)).collect();
        for (pair, ConePair { law, .. }) in self.pairs.iter().enumerate() {
            let c = law.fixed_bound();
            let slip: Vec<Terms> = self.tangential(pair).iter().map(|row| combined(row, 0.0, &[])).collect();
            if c > 0.0 && slip.iter().any(|part| !part.is_empty()) {
                let most = program.variable(0.0);
                program.at_least_length(&[(most, 1.0)], &slip);
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
        let above: Terms = surplus.iter().copied().chain([(margin, -1.0)]).collect();
        program.at_least_length(&above, &[]);
        self.slacks().iter().for_each(|slack| slack.demand(&mut program, Some(margin)));
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
        slacks.iter().for_each(|slack| slack.demand(&mut program, None));
        program.set_costs(surplus.iter().map(|(k, a)| (*k, -a)));
        let mut x = self.solve(&program)?;
        let surplus_at = |x: &[f64]| surplus.iter().map(|(k, a)| a * x[*k]).sum::<f64>();
        // Just beyond a limit little is left over, and the program could not tell what has no room beside it.
        let zoom = (TIGHT * surplus_at(&x) <= ROOM).then_some(ZOOMS[0]);
        if let Some(zoom) = zoom {
            x = program.refined(&x, zoom, self.seconds())?;
        }
        let (most, clear) = (surplus_at(&x), CLEAR / zoom.unwrap_or(1.0));
        if most <= clear {
            return None;
        }
        // As much room as there can be in all inequalities at once.
        let (mut program, _) = self.base();
        let mut rooms = Vec::new();
        for slack in &slacks {
            let room = program.variable(-1.0);
            slack.demand(&mut program, Some(room));
            program.at_most(vec![(room, 1.0)], most);
            program.at_most(vec![(room, -1.0)], 0.0);
            rooms.push(room);
        }
        program.at_most(surplus.iter().map(|(k, a)| (*k, -a)).collect(), -0.5 * most);
        let mut x = self.solve(&program)?;
        let mut none = TIGHT * most;
        if let Some(zoom) = zoom {
            (x, none) = (program.refined(&x, zoom, self.seconds())?, f64::max(none, clear));
        }
        let tight: Vec<&Slack> =
            slacks.iter().zip(&rooms).filter(|(_, room)| x[**room] < none).map(|(s, _)| s).collect();
        self.proof(&x, &tight)
    }

    /// The certificate if these amounts, corrected where inequalities must hold as equations, are one.
    fn proof(&mut self, x: &[f64], tight: &[&Slack]) -> Option<Certificate> {
        let mut amounts = x[..self.motions.count()].to_vec();
        let mut equations = Equations::new(amounts.len(), self.end);
        let held: Vec<usize> = self.held().collect();
        for joint in held {
            equations.add(exactly(self.motions.row(joint)));
        }
        for slack in tight {
            self.as_equations(slack).into_iter().for_each(|terms| equations.add(terms));
        }
        let exactly = match equations.nearest(&amounts) {
            Solved::Free => None,
            Solved::Exactly(exactly) => {
                amounts = exactly.iter().map(Dyadic::to_f64).collect();
                Some(exactly)
            }
            Solved::OutOfTime => {
                self.out_of_time = true;
                return None;
            }
        };
        self.verified(&amounts, exactly.as_deref())
    }

    /// What an inequality without room demands, with the exact numbers of the data: in the plane an equation, in space
    /// that the pair is at rest.
    fn as_equations(&self, slack: &Slack) -> Vec<Vec<(usize, Dyadic)>> {
        let normal = exactly(self.motions.row(slack.pair));
        let Some(sense) = slack.sense else {
            let slips = if slack.parts.is_empty() { Vec::new() } else { self.tangential(slack.pair) };
            return std::iter::once(normal).chain(slips.into_iter().map(exactly)).collect();
        };
        let f = Dyadic::from(-sense * self.pairs[slack.pair].law.friction());
        let slip = self.tangential(slack.pair).into_iter().flat_map(exactly).map(|(k, a)| (k, a.times(&f)));
        vec![normal.into_iter().chain(slip).collect()]
    }

    /// Every sign of the proof: by f64 sums with the bounds of their rounding, exactly where they have no room.
    fn verified(&mut self, amounts: &[f64], exact_amounts: Option<&[Dyadic]>) -> Option<Certificate> {
        let own: Vec<Dyadic> = amounts.iter().map(|amount| Dyadic::from(*amount)).collect();
        let exact = exact_amounts.unwrap_or(&own);
        let value = |row: &[Entry]| {
            exactly(row).into_iter().fold(Dyadic::default(), |sum, (k, a)| sum.plus(&a.times(&exact[k])))
        };
        let mut taken = Sum::default();
        let mut needed_exact = false;
        for (pair, ConePair { law, tangents }) in self.pairs.iter().enumerate() {
            let normal = self.motions.displacement(pair, amounts);
            let slip = tangents.clone().fold(Sum::default(), |slip, joint| {
                let part = self.motions.displacement(joint, amounts);
                Sum { value: slip.value.hypot(part.value), magnitude: slip.magnitude + part.magnitude }
            });
            let (f, c) = (law.friction(), law.fixed_bound());
            taken = taken.plus(c, slip);
            let error = normal.error() + 2.0 * f * slip.error();
            let sure = normal.value - f * slip.value > error;
            let still = normal.magnitude == 0.0 && (f == 0.0 || slip.magnitude == 0.0);
            if still || (sure && !law.is_bilateral()) {
                continue;
            }
            if Instant::now() > self.end {
                self.out_of_time = true;
                return None;
            }
            needed_exact = true;
            let normal = value(self.motions.row(pair));
            if law.is_bilateral() {
                if !normal.is_zero() {
                    return None;
                }
                continue;
            }
            // What is neither 0 nor clear of its rounding proves nothing.
            let slips: Vec<Dyadic> = self.tangential(pair).into_iter().map(value).collect();
            let square = slips.iter().fold(Dyadic::default(), |sum, slip| sum.plus(&slip.times(slip)));
            let length = slips.iter().map(Dyadic::to_f64).fold(0.0, f64::hypot);
            let f_exact = Dyadic::from(f);
            let touches = !normal.is_negative() && normal.times(&normal) == square.times(&f_exact).times(&f_exact);
            if !touches && normal.to_f64() - f * length <= error {
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
            exact: needed_exact || exact_amounts.is_some(),
            of_this_load: false,
            amounts: exact.iter().map(Dyadic::to_rational).collect(),
        })
    }
}

#[cfg(test)]
#[path = "certificate_tests.rs"]
mod tests;
