//! Forces within the laws' bounds that balance the loads on every motion that costs nothing: whether there are any,
//! and for which multiples of a load. By a linear program in f64, in space one with Coulomb's cones: necessary for an answer,
//! neither sufficient nor a proof.

use nalgebra::DVector;

use super::motions::FreeMotions;
use crate::contact::law::SENSES;
use crate::contact::problem::ContactProblem;
use crate::lcp::linear_program::{LinearProgram, Outcome};

/// Multiples beyond this are infinite.
const FAR: f64 = 1e6;
/// Magnification of the closer look at the end of an interval.
const ZOOM: f64 = 1e6;

/// Work left over, per unit of load and motion, that the linear program cannot tell from 0 without a closer look.
const UNCLEAR: f64 = 1e-5;
/// The same with the closer look.
const BALANCED: f64 = 1e-11;

/// What is known of the multiples α of a load for which there are balanced forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Multiples {
    /// All in this interval, whose ends may be infinite.
    Between([f64; 2]),
    /// None.
    None,
    /// It could not be decided in the time.
    Unknown,
}

/// The forces of all pairs that some motion touches and how the motions are balanced by them.
struct Forces {
    program: LinearProgram,
    /// For each motion, the terms of its balance.
    balance: Vec<Vec<(usize, f64)>>,
}

/// Forces divided by `size`.
fn forces(problem: &ContactProblem, motions: &FreeMotions, size: f64) -> Forces {
    let system = &*problem.system;
    let mut program = LinearProgram::default();
    let mut balance = vec![Vec::new(); motions.count()];
    let mut put = |variable: usize, joint: usize| {
        for entry in motions.row(joint).iter().filter(|entry| entry.part.value != 0.0) {
            balance[entry.motion].push((variable, entry.part.value));
        }
    };
    for (pair, law) in problem.laws.iter().enumerate() {
        let tangential = system.pairs[pair].tangential.clone();
        let touched = |joint: usize| !motions.row(joint).is_empty();
        if !touched(pair) && !tangential.clone().any(touched) {
            continue;
        }
        let normal = program.variable(0.0);
        put(normal, pair);
        if !law.is_bilateral() {
            program.at_most(vec![(normal, -1.0)], 0.0);
        }
        let (f, c) = (law.friction(), law.fixed_bound() / size);
        if f == 0.0 && c == 0.0 {
            continue;
        }
        let friction: Vec<usize> = tangential.clone().map(|_| program.variable(0.0)).collect();
        friction.iter().zip(tangential).for_each(|(&force, joint)| put(force, joint));
        match friction[..] {
            [] => {}
            [force] => SENSES.iter().for_each(|sign| program.at_most(vec![(force, *sign), (normal, -f)], c)),
            _ => {
                let mut bound = vec![(normal, f)];
                if c > 0.0 {
                    let fixed = program.variable(0.0);
                    program.equal(vec![(fixed, 1.0)], c);
                    bound.push((fixed, 1.0));
                }
                let parts: Vec<Vec<(usize, f64)>> = friction.iter().map(|&force| vec![(force, 1.0)]).collect();
                program.at_least_length(&bound, &parts);
            }
        }
    }
    Forces { program, balance }
}

/// The multiples α for which there are balanced forces under `fixed` + α · `varied`.
pub fn balanced_multiples(
    problem: &ContactProblem,
    motions: &FreeMotions,
    fixed: &DVector<f64>,
    varied: &DVector<f64>,
    seconds: f64,
) -> Multiples {
    let system = &*problem.system;
    let (fixed, varied) = (&system.forces_of(fixed), &system.forces_of(varied));
    let size = fixed.amax().max(varied.amax());
    if motions.count() == 0 || size == 0.0 {
        return Multiples::Between([f64::NEG_INFINITY, f64::INFINITY]);
    }
    let Forces { mut program, balance } = forces(problem, motions, size);
    let multiple = program.variable(0.0);
    let (right, left) = (motions.work(fixed, fixed), motions.work(varied, varied));
    for ((mut row, right), left) in balance.into_iter().zip(right).zip(left) {
        if left.value != 0.0 {
            row.push((multiple, left.value / size));
        }
        program.equal(row, -right.value / size);
    }
    let mut ends = [0.0; 2];
    for (end, sign) in ends.iter_mut().zip([1.0, -1.0]) {
        program.set_costs([(multiple, sign)]);
        *end = match program.solve(seconds) {
            Outcome::Optimum(found) => {
                let found = program.refined(&found.x, ZOOM, seconds).unwrap_or(found.x)[multiple];
                if found.abs() > FAR { found.signum() * f64::INFINITY } else { found }
            }
            Outcome::Unbounded(_) => -sign * f64::INFINITY,
            Outcome::Infeasible(_) => return Multiples::None,
            Outcome::OutOfTime | Outcome::Undecided => return Multiples::Unknown,
        };
    }
    Multiples::Between(ends)
}

/// Whether there are balanced forces under the load of `problem`, as far as f64 can tell; `None` where that could not
/// be decided in the time.
pub fn is_balanced(problem: &ContactProblem, motions: &FreeMotions, seconds: f64) -> Option<bool> {
    let system = &*problem.system;
    let (load, terms) = (system.forces_of(&problem.load), system.forces_of(&problem.load_terms));
    let size = load.amax();
    if motions.count() == 0 || size == 0.0 {
        return Some(true);
    }
    // The least work that is left over on all motions together: a program that always has an optimum, unlike the
    // question itself, which has no room for an answer next to a limit.
    let Forces { mut program, balance } = forces(problem, motions, size);
    let mut left_over = Vec::new();
    for (mut row, work) in balance.into_iter().zip(motions.work(&load, &terms)) {
        for sign in [1.0, -1.0] {
            let left = program.variable(1.0);
            program.at_most(vec![(left, -1.0)], 0.0);
            row.push((left, sign));
            left_over.push(left);
        }
        program.equal(row, -work.value / size);
    }
    let sum = |x: &[f64]| left_over.iter().map(|left| x[*left]).sum::<f64>();
    match program.solve(seconds) {
        Outcome::Optimum(found) if sum(&found.x) > UNCLEAR => Some(false),
        Outcome::Optimum(found) => {
            let fine = program.refined(&found.x, ZOOM, seconds).unwrap_or(found.x);
            Some(sum(&fine) <= BALANCED)
        }
        _ => None,
    }
}
