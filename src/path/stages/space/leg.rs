//! A leg of a history: a piece of the way in which no pair changes what it does.
//!
//! Slips turn on the way, so that steps ([`crate::path::cone_step`]) are right to first order only: friction stands against the
//! direction at their end. The same leg is taken in one step, in two, in three …; what the ends tend to as the steps get
//! shorter is found by extrapolation (Aitken and Neville), whose last correction is the error that is left. Every end has
//! the schemes of the leg, so there is no kink in what is extrapolated. Where nothing turns one step is exact, and two say so.

use nalgebra::DVector;

use crate::answer::pairs::pairs_in_space;
use crate::contact::problem::ContactProblem;
use crate::contact::system::ContactSystem;
use crate::path::cone_step::{Scheme, Step, Stepper, margins};
use crate::path::stages::course::Course;
use crate::path::stages::integrals::Integrals;
use crate::path::start::PathError;

/// A joint is as good as without stiffness where the root of its R_ii is this share of the largest.
const RIGID: f64 = 1e-5;
/// The error of a leg may be this share of the largest displacement, that of its loss of the energy of such a displacement.
pub(super) const TOLERANCE: f64 = 1e-10;
/// The leg is taken in this many steps at most.
const ROWS: usize = 8;
/// A leg is given up where, after this many steps, its corrections are still this large: a shorter one is cheaper.
const HOPELESS: (usize, f64) = (4, 1e-4);
/// Corrections up to this that do not get smaller are rounding, which gets larger with every row: ε times the stiffest of
/// what yields by the softest.
const ROUNDED: f64 = 1e-6;

/// Where a leg begins.
pub(super) struct Begin<'a> {
    pub(super) t: f64,
    /// Total z.
    pub(super) z: &'a DVector<f64>,
    /// λ.
    pub(super) force: &'a DVector<f64>,
    /// ż, as far as it is known: where the first step is looked for.
    pub(super) rate: &'a DVector<f64>,
    /// What every pair does on the leg.
    pub(super) scheme: &'a Scheme,
}

/// A leg that was taken.
pub(super) struct Leg {
    /// Total z at its end, extrapolated.
    pub(super) z: DVector<f64>,
    /// λ there, likewise.
    pub(super) force: DVector<f64>,
    pub(super) way: Integrals,
    /// Steps at its end give this z rate.
    pub(super) rate: DVector<f64>,
    /// Largest last correction of a z or of an integral, as a share of the size.
    pub(super) error: f64,
    /// In how many steps it was taken at last.
    pub(super) rows: usize,
}

impl Leg {
    /// Whether nothing turned on it: one step led where two did.
    pub(super) fn is_straight(&self) -> bool {
        self.rows == 2
    }
}

/// What became of a leg.
pub(super) enum Taken {
    Whole(Leg),
    /// A pair does something else within it.
    Changes,
    /// There is no answer near, or the corrections stay too large.
    Shorter,
}

/// What legs are measured by: displacements of all joints are compared by the root of their stiffness, R_ii.
pub(super) struct Measure {
    scale: DVector<f64>,
    /// Joints without stiffness of their own, whose forces are not a measure of any displacement.
    rigid: Vec<bool>,
    /// The largest scaled displacement so far, those included that forces would cause where they are held.
    size: f64,
}

impl Measure {
    pub(super) fn new(system: &ContactSystem) -> Measure {
        // Of joints that repeat one another the independent ones are the measure, as they are and not as they yield.
        let system = system.yielding.as_ref().map_or(system, |yielding| &yielding.exact);
        let own = |joint: usize| if system.is_forced(joint) { 0.0 } else { system.stiffness[(joint, joint)].max(0.0) };
        let roots = DVector::from_fn(system.joint_count(), |joint, _| own(joint).sqrt());
        let largest = roots.amax();
        let rigid: Vec<bool> = roots.iter().map(|root| *root <= RIGID * largest).collect();
        let or = if largest > 0.0 { largest } else { 1.0 };
        let scale = DVector::from_fn(roots.len(), |joint, _| if rigid[joint] { or } else { roots[joint] });
        Measure { scale, rigid, size: 0.0 }
    }

    /// The largest entry of scaled displacements.
    pub(super) fn of(&self, z: &DVector<f64>) -> f64 {
        z.iter().zip(&self.scale).fold(0.0, |a: f64, (z, scale)| a.max((z * scale).abs()))
    }

    /// The size with another state in it.
    pub(super) fn size_with(&self, z: &DVector<f64>, force: &DVector<f64>) -> f64 {
        let felt = (0..force.len()).filter(|&joint| !self.rigid[joint]);
        felt.fold(self.size.max(self.of(z)), |size, joint| size.max((force[joint] / self.scale[joint]).abs()))
    }

    pub(super) fn meet(&mut self, z: &DVector<f64>, force: &DVector<f64>) {
        self.size = self.size_with(z, force);
    }

    /// A difference of displacements as a share of the size.
    pub(super) fn share(&self, difference: &DVector<f64>) -> f64 {
        share(self.of(difference), self.size)
    }
}

fn share(difference: f64, size: f64) -> f64 {
    if difference == 0.0 { 0.0 } else { difference.abs() / size }
}

/// A row of the tableau: z, λ, ∫ z dt, ∫ λ dt and the dissipation, one after the other.
type Row = Vec<DVector<f64>>;

/// Takes a leg of length `h` on the course; `problem` is the problem at a place of the course.
pub(super) fn taken(
    stepper: &Stepper<'_>,
    problem: &dyn Fn(f64) -> ContactProblem,
    begin: &Begin<'_>,
    h: f64,
    measure: &Measure,
) -> Result<Taken, PathError> {
    let mut before: Row = Vec::new();
    let mut best: Option<Leg> = None;
    for n in 1..=ROWS {
        let ([end, force], way, last) = match in_steps(stepper, problem, begin, (h, n))? {
            InSteps::Whole { end, way, last } => (end, way, last),
            InSteps::Changes => return Ok(Taken::Changes),
            InSteps::Nowhere => return Ok(Taken::Shorter),
        };
        let (k, size) = (end.len(), measure.size_with(&end, &force));
        let vectors = [&end, &force, &way.z, &way.force].into_iter().flat_map(|vector| vector.iter().copied());
        let mut row: Row = vec![DVector::from_iterator(4 * k + 1, vectors.chain([way.dissipated]))];
        for (column, old) in before.iter().enumerate() {
            // From n − column − 1 steps to n of them.
            let ratio = n as f64 / (n - column - 1) as f64;
            let now = &row[column];
            row.push(now + (now - old) / (ratio - 1.0));
        }
        if n > 1 {
            // Where a leg ends may not depend on its way, as where a pair opens at its end: the integrals do.
            let correction = &row[n - 1] - &row[n - 2];
            let part = |from: usize| share(measure.of(&correction.rows(from, k).into_owned()), size);
            // Scaled displacements are roots of energies.
            let error = part(0).max(part(2 * k) / h).max(share(correction[4 * k], size * size));
            let falls = best.as_ref().is_none_or(|best| error < best.error);
            if falls {
                let row = &row[n - 1];
                let [z, force, of_z, of_force] = [0, 1, 2, 3].map(|part| row.rows(part * k, k).into_owned());
                let way = Integrals { z: of_z, force: of_force, dissipated: row[4 * k] };
                let rate = (&end - &last) * (n as f64 / h);
                best = Some(Leg { z, force, way, rate, error, rows: n });
            }
            let enough = if falls { TOLERANCE } else { ROUNDED };
            if let Some(leg) = best.take_if(|leg| leg.error <= enough) {
                return Ok(Taken::Whole(leg));
            }
            if error.is_nan() || (n >= HOPELESS.0 && error > HOPELESS.1) {
                break;
            }
        }
        before = row;
    }
    Ok(Taken::Shorter)
}

/// Where steps of one length lead to.
enum InSteps {
    /// z and λ at the end, z before the last of them, and their integrals.
    Whole { end: [DVector<f64>; 2], way: Integrals, last: DVector<f64> },
    /// To something else that a pair does.
    Changes,
    /// To a step that has no answer.
    Nowhere,
}

/// Takes a leg in n steps.
fn in_steps(
    stepper: &Stepper<'_>,
    problem: &dyn Fn(f64) -> ContactProblem,
    begin: &Begin<'_>,
    (h, n): (f64, usize),
) -> Result<InSteps, PathError> {
    let step = h / n as f64;
    let (mut z, mut force) = (begin.z.clone(), begin.force.clone());
    let (mut last, mut rate) = (z.clone(), begin.rate.clone());
    let none = DVector::zeros(z.len());
    let mut way = Integrals { z: none.clone(), force: none, dissipated: 0.0 };
    for j in 1..=n {
        let at = problem(begin.t + h * (j as f64 / n as f64));
        let Some(next) = stepper.onward(at.clone(), (&z, &force), &(&z + &rate * step))? else {
            return Ok(InSteps::Nowhere);
        };
        if next.scheme != *begin.scheme {
            return Ok(InSteps::Changes);
        }
        let Step { z: to, increments, .. } = next;
        way = way.plus(&Integrals::straight(step, [&z, &to], [&force, &increments.force], &at.system));
        rate = (&to - &z) / step;
        last = std::mem::replace(&mut z, to);
        force = increments.force;
    }
    Ok(InSteps::Whole { end: [z, force], way, last })
}

/// The place on the way from `begin` up to which single steps keep the scheme, between 0 and h, to `digits` of a stage.
pub(super) fn change_within(
    stepper: &Stepper<'_>,
    problem: &dyn Fn(f64) -> ContactProblem,
    begin: &Begin<'_>,
    h: f64,
    digits: f64,
) -> Result<f64, PathError> {
    let (mut low, mut high) = (0.0, h);
    // The last two places in the scheme with what was left of it there, where it was thought to end, and where to look next.
    let mut known: [Option<(f64, Vec<f64>)>; 2] = [None, None];
    let (mut thought, mut next): (Option<f64>, Vec<f64>) = (None, Vec::new());
    while high - low > digits {
        let inside = next.pop().filter(|at| *at > low && *at < high);
        let at = inside.unwrap_or(0.5 * (low + high));
        let there = problem(begin.t + at);
        let found = stepper.onward(there.clone(), (begin.z, begin.force), &(begin.z + begin.rate * at))?;
        let Some(found) = found.filter(|found| found.scheme == *begin.scheme) else {
            high = at;
            continue;
        };
        low = at;
        let pairs = pairs_in_space(&there, &found.increments);
        let left = pairs.iter().flat_map(margins).map(|margin| margin.unwrap_or(f64::INFINITY));
        known = [known[1].take(), Some((at, left.collect()))];
        if let (true, Some(end)) = (next.is_empty(), end_of(&known)) {
            let unsure = thought.map_or(0.01 * (high - low), |before| (end - before).abs());
            let unsure = unsure.min(0.25 * (high - low)).max(0.25 * digits);
            (thought, next) = (Some(end), vec![end + unsure, end - unsure]);
        }
    }
    Ok(low)
}

/// Where the first margin runs out, straight on from two places; `None` where none falls.
fn end_of(known: &[Option<(f64, Vec<f64>)>; 2]) -> Option<f64> {
    let [Some((a, before)), Some((b, now))] = known else { return None };
    let falling = before.iter().zip(now).filter(|(before, now)| before.is_finite() && now < before);
    falling.map(|(before, now)| b + now * (b - a) / (before - now)).min_by(f64::total_cmp)
}

/// A course as the problem at each of its places.
pub(super) fn along<'c>(problem: &'c ContactProblem, course: &'c Course) -> impl Fn(f64) -> ContactProblem + 'c {
    move |t| problem.clone().with_gaps(&course.gaps_at(t)).with_factors(&course.factors_at(t))
}
