//! All answers of a small contact problem, by a search over working schemes.
//!
//! Depth first, one pair after the other. Every quantity is kept as an affine function of the displacements of the
//! pairs not yet decided; deciding a pair eliminates its one or two displacements. A partial scheme is cut when
//! some sign of it fails for every admissible displacement of the others: normals z_n ≥ 0, and, where R is positive
//! definite, the box around the ellipsoid zᵀR z ≤ −zᵀq that every answer lies in (zᵀλ ≤ 0 for every answer; q is RF −
//! R·(g, 0)). Complete schemes that pass loosely are solved again with full pivoting, judged by the laws, and looked at
//! in exact arithmetic. Singular partial schemes are searched without elimination.

use std::ops::ControlFlow;

use crate::model::pair::Law;

use super::answer_box::ellipsoid;
use super::exact_check::{Finding, exact_check};
use super::numbers::ContactNumbers;
use super::scheme_solve::{JointState, SchemeSolution, Sizes, law_violation, solve_scheme};
use super::scheme_word::{PairScheme, Tangential};
use super::system::ContactSystem;
use super::whole::{fixed_bound, friction, joint_constants, tangential_joint};

/// Most pairs that [`enumerate`] takes.
pub const MOST_PAIRS: usize = 10;
/// Relative violation up to which an eliminated scheme is looked at again.
const LOOSE: f64 = 1e-6;
/// Relative violation up to which a freshly solved scheme is an answer.
const ACCEPTED: f64 = 1e-9;
/// The same for a point of a continuum, found by linear programming.
const ACCEPTED_CONTINUUM: f64 = 1e-7;
/// Pivots of the elimination below this times R_jj count as singular.
const SINGULAR: f64 = 1e-6;
/// Relative distance below which two answers are one.
const SAME: f64 = 1e-7;

/// One answer.
#[derive(Clone, Debug, PartialEq)]
pub struct EnumeratedAnswer {
    /// The working schemes that lead to it: several where pairs are exactly on their limits.
    pub schemes: Vec<Vec<PairScheme>>,
    /// z and λ.
    pub state: JointState,
    /// One of the schemes holds in exact arithmetic for the f64 data; otherwise it holds up to rounding.
    pub exact: bool,
    /// A scheme of singular equations: other answers may lie next to this one.
    pub continuum: bool,
    /// Largest relative violation of the laws.
    pub violation: f64,
}

/// What the search found.
#[derive(Clone, Debug, PartialEq)]
pub struct Enumeration {
    /// All answers, in the order of the search.
    pub answers: Vec<EnumeratedAnswer>,
    /// Complete schemes that were solved.
    pub visited: u64,
    /// Partial schemes that were cut off.
    pub cut: u64,
    /// All schemes there are.
    pub total: u64,
    /// Complete schemes that f64 could not decide.
    pub undecided: u64,
    /// Whether the search came to its end.
    pub complete: bool,
}

impl Enumeration {
    /// No answer, and no doubt about it.
    pub fn no_answer(&self) -> bool {
        self.complete && self.undecided == 0 && self.answers.is_empty()
    }
}

/// More pairs than can be searched.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{found} contact pairs are too many to enumerate: at most {MOST_PAIRS}")]
pub struct TooManyPairs {
    /// Number of pairs.
    pub found: usize,
}

/// The states that a pair can be in.
fn choices(system: &ContactSystem, numbers: &ContactNumbers, pair: usize) -> Vec<PairScheme> {
    let closed = [PairScheme::STICK, PairScheme::SLIP_PLUS, PairScheme::SLIP_MINUS];
    match system.pairs[pair].law {
        Law::Frictionless { .. } => vec![PairScheme::STICK, PairScheme::OPEN_STICK],
        Law::Bound { .. } => closed.to_vec(),
        Law::Coulomb { .. } if numbers.cohesion[pair] > 0.0 => {
            closed.into_iter().chain(closed.map(|scheme| PairScheme { open: true, ..scheme })).collect()
        }
        Law::Coulomb { .. } => closed.into_iter().chain([PairScheme::OPEN]).collect(),
    }
}

/// Finds every answer. `observer` hears the number of complete schemes solved so far and may stop the search.
///
/// # Errors
/// More than [`MOST_PAIRS`] pairs.
pub fn enumerate(
    system: &ContactSystem,
    numbers: &ContactNumbers,
    observer: &mut dyn FnMut(u64) -> ControlFlow<()>,
) -> Result<Enumeration, TooManyPairs> {
    let m = system.pair_count();
    if m > MOST_PAIRS {
        return Err(TooManyPairs { found: m });
    }
    let mut search = Search::new(system, numbers);
    let mut scheme = Vec::with_capacity(m);
    let root = search.root.clone();
    let ended = search.descend(Some(&root), &mut scheme, observer);
    search.found.complete = ended.is_continue();
    Ok(search.found)
}

/// Rows: one per joint, pair by pair (n, then τ), holding λ_j or z_j, whichever is not fixed. Columns: the undecided
/// joints from `first` on, then the constant.
#[derive(Clone)]
struct Level {
    first: usize,
    rows: Vec<f64>,
}

/// An affine function of the undecided displacements, the constant last.
type Row = Vec<f64>;

struct Search<'a> {
    system: &'a ContactSystem,
    numbers: &'a ContactNumbers,
    sizes: Sizes,
    /// First joint of every pair in the pair by pair order, and their number at the end.
    offsets: Vec<usize>,
    /// Joint of R of every joint in the pair by pair order.
    joints: Vec<usize>,
    /// Box of every displacement.
    bounds: Vec<(f64, f64)>,
    /// Scaled size of displacements in the box; `None` where there is none.
    extent: Option<f64>,
    choices: Vec<Vec<PairScheme>>,
    root: Level,
    found: Enumeration,
}

impl<'a> Search<'a> {
    fn new(system: &'a ContactSystem, numbers: &'a ContactNumbers) -> Self {
        let m = system.pair_count();
        let mut joints = Vec::new();
        let mut offsets = vec![0];
        for pair in 0..m {
            joints.push(pair);
            if !matches!(system.pairs[pair].law, Law::Frictionless { .. }) {
                joints.push(tangential_joint(system, pair));
            }
            offsets.push(joints.len());
        }
        let k = joints.len();
        let constants = joint_constants::<f64>(system, numbers);
        let mut rows = Vec::with_capacity(k * (k + 1));
        for i in &joints {
            rows.extend(joints.iter().map(|j| system.stiffness[(*i, *j)]));
            rows.push(constants[*i]);
        }
        let mut bounds: Vec<(f64, f64)> = joints
            .iter()
            .map(|joint| if *joint < m { (0.0, f64::INFINITY) } else { (f64::NEG_INFINITY, f64::INFINITY) })
            .collect();
        let sizes = Sizes::new(system, numbers);
        let extent = ellipsoid(system, &sizes, &joints, &constants).map(|boxes| {
            for (bound, (low, high)) in bounds.iter_mut().zip(boxes.sides) {
                *bound = (bound.0.max(low), bound.1.min(high));
            }
            boxes.extent
        });
        let choices: Vec<Vec<PairScheme>> = (0..m).map(|pair| choices(system, numbers, pair)).collect();
        let total = choices.iter().map(|c| c.len() as u64).product();
        Self {
            system,
            numbers,
            sizes,
            offsets,
            joints,
            bounds,
            extent,
            choices,
            root: Level { first: 0, rows },
            found: Enumeration { answers: Vec::new(), visited: 0, cut: 0, total, undecided: 0, complete: false },
        }
    }

    /// `level` is `None` below a singular partial scheme.
    fn descend(
        &mut self,
        level: Option<&Level>,
        scheme: &mut Vec<PairScheme>,
        observer: &mut dyn FnMut(u64) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let pair = scheme.len();
        if pair == self.choices.len() {
            self.found.visited += 1;
            self.judge(scheme);
            return ControlFlow::Continue(());
        }
        for choice in self.choices[pair].clone() {
            scheme.push(choice);
            let next = level.and_then(|level| self.decide(level, pair, choice));
            let last = pair + 1 == self.choices.len();
            let result = if next.as_ref().is_some_and(|next| self.hopeless(next, scheme)) {
                if last {
                    self.found.visited += 1;
                } else {
                    self.found.cut += 1;
                }
                ControlFlow::Continue(())
            } else {
                self.descend(next.as_ref(), scheme, observer)
            };
            scheme.pop();
            result?;
            if (self.found.visited + self.found.cut).is_multiple_of(1024) {
                observer(self.found.visited)?;
            }
        }
        ControlFlow::Continue(())
    }

    /// The dictionary with this pair decided; `None` when that is (nearly) singular.
    fn decide(&self, level: &Level, pair: usize, choice: PairScheme) -> Option<Level> {
        let k = self.joints.len();
        let width = k + 1 - level.first;
        let n = self.offsets[pair];
        let next = self.offsets[pair + 1];
        let tangential = next - n == 2;
        let row = |i: usize| &level.rows[i * width..(i + 1) * width];
        let f = friction(self.system, self.numbers, pair);
        let root = |i: usize| self.sizes.root[self.joints[i]];

        // Equations to be solved for the displacement of a joint, with the size their pivot is judged by.
        let mut equations: Vec<(usize, Row, f64)> = Vec::new();
        if choice.open {
            equations.push((n, row(n).to_vec(), root(n) * root(n)));
        }
        let slip = choice.tangential.sign();
        if tangential && slip != 0.0 {
            // x^± = 0: λ_τ ± (f λ_n + c) = 0; λ_n = 0 where open.
            let f = if choice.open { 0.0 } else { f };
            let mut equation: Row = row(n + 1).iter().zip(row(n)).map(|(t, n)| t + slip * f * n).collect();
            equation[width - 1] += slip * fixed_bound(self.system, self.numbers, pair);
            let size = root(n + 1) * (root(n + 1) + f * root(n));
            equations.push((n + 1, equation, size));
        }
        // Displacements of this pair in terms of the undecided ones; 0 where the joint is on.
        let mut displacement: [Option<Row>; 2] = [None, None];
        let column = |joint: usize| joint - level.first;
        if let [(_, first, first_size), (_, second, second_size)] = &mut equations[..] {
            // Two by two with the larger pivot first.
            let (a, b) = (first[column(n)], second[column(n + 1)]);
            let normal_first = a.abs() / *first_size >= b.abs() / *second_size;
            let (lead, lead_at, follow, follow_at) = if normal_first {
                (&*first, column(n), &mut *second, column(n + 1))
            } else {
                (&*second, column(n + 1), &mut *first, column(n))
            };
            let pivot = lead[lead_at];
            let (lead_size, follow_size) =
                if normal_first { (*first_size, *second_size) } else { (*second_size, *first_size) };
            if pivot.abs() <= SINGULAR * lead_size {
                return None;
            }
            let factor = follow[lead_at] / pivot;
            for (x, y) in follow.iter_mut().zip(lead) {
                *x -= factor * y;
            }
            follow[lead_at] = 0.0;
            let pivot_of_follow = follow[follow_at];
            if pivot_of_follow.abs() <= SINGULAR * follow_size {
                return None;
            }
            let mut z_follow: Row = follow.iter().map(|x| -x / pivot_of_follow).collect();
            z_follow[follow_at] = 0.0;
            let coupling = lead[follow_at];
            let mut z_lead: Row = lead.iter().zip(&z_follow).map(|(x, z)| -(x + coupling * z) / pivot).collect();
            z_lead[lead_at] = 0.0;
            z_lead[follow_at] = 0.0;
            displacement = if normal_first { [Some(z_lead), Some(z_follow)] } else { [Some(z_follow), Some(z_lead)] };
        } else if let [(joint, equation, size)] = &equations[..] {
            let pivot = equation[column(*joint)];
            if pivot.abs() <= SINGULAR * size {
                return None;
            }
            let mut z: Row = equation.iter().map(|x| -x / pivot).collect();
            z[column(*joint)] = 0.0;
            displacement[joint - n] = Some(z);
        }

        let skip = next - level.first;
        let new_width = width - skip;
        let mut rows = Vec::with_capacity(k * new_width);
        for i in 0..k {
            if (n..next).contains(&i)
                && let Some(z) = &displacement[i - n]
            {
                rows.extend_from_slice(&z[skip..]);
                continue;
            }
            let old = row(i);
            let start = rows.len();
            rows.extend_from_slice(&old[skip..]);
            for joint in n..next {
                if let Some(z) = &displacement[joint - n] {
                    let factor = old[column(joint)];
                    if factor != 0.0 {
                        for (x, z) in rows[start..].iter_mut().zip(&z[skip..]) {
                            *x += factor * z;
                        }
                    }
                }
            }
        }
        Some(Level { first: next, rows })
    }

    /// Whether some sign of the decided pairs fails for all displacements of the others.
    fn hopeless(&self, level: &Level, scheme: &[PairScheme]) -> bool {
        let width = self.joints.len() + 1 - level.first;
        let row = |i: usize| &level.rows[i * width..(i + 1) * width];
        let bounds = &self.bounds[level.first..];
        // Size of displacements: the box, or at a complete scheme the displacements themselves.
        let extent = self.extent.or_else(|| {
            (width == 1).then(|| {
                scheme
                    .iter()
                    .enumerate()
                    .flat_map(|(pair, s)| self.released(pair, *s))
                    .map(|i| row(i)[0].abs() * self.sizes.root[self.joints[i]])
                    .fold(0.0, f64::max)
            })
        });
        // Largest value of Σ (factor · row) + fixed is below −(LOOSE · size)?
        let fails = |terms: &[(usize, f64)], fixed: f64, size: f64| {
            let mut largest = fixed;
            let entry = |column: usize| -> f64 { terms.iter().map(|(i, f)| f * row(*i)[column]).sum() };
            for (column, (low, high)) in bounds.iter().enumerate() {
                let a = entry(column);
                // Not 0 · ∞.
                if a != 0.0 {
                    largest += a * if a > 0.0 { high } else { low };
                }
                if largest == f64::INFINITY {
                    return false;
                }
            }
            largest += entry(width - 1);
            largest < -LOOSE * size
        };
        let force = self.sizes.force;
        scheme.iter().enumerate().any(|(pair, state)| {
            let n = self.offsets[pair];
            let tangential = self.offsets[pair + 1] - n == 2;
            let bilateral = matches!(self.system.pairs[pair].law, Law::Bound { .. });
            let f = friction(self.system, self.numbers, pair);
            let fixed = fixed_bound(self.system, self.numbers, pair);
            let moves = |i: usize, sign: f64| {
                extent.is_some_and(|extent| fails(&[(i, sign)], 0.0, extent / self.sizes.root[self.joints[i]]))
            };
            if state.open {
                if moves(n, 1.0) {
                    return true;
                }
            } else if !bilateral && fails(&[(n, 1.0)], 0.0, force) {
                return true;
            }
            if !tangential {
                return false;
            }
            match state.tangential {
                // An open pair without cohesion slips freely.
                _ if state.open && fixed == 0.0 => false,
                Tangential::Stick => [1.0, -1.0].into_iter().any(|side| {
                    let f = if state.open { 0.0 } else { f };
                    fails(&[(n, f), (n + 1, side)], fixed, force)
                }),
                Tangential::SlipPlus => moves(n + 1, 1.0),
                Tangential::SlipMinus => moves(n + 1, -1.0),
            }
        })
    }

    /// Rows of a decided pair that hold displacements.
    fn released(&self, pair: usize, scheme: PairScheme) -> impl Iterator<Item = usize> {
        let n = self.offsets[pair];
        let tangential = self.offsets[pair + 1] - n == 2 && scheme.tangential != Tangential::Stick;
        scheme.open.then_some(n).into_iter().chain(tangential.then_some(n + 1))
    }

    /// Solves a complete scheme afresh and keeps it if it is an answer.
    fn judge(&mut self, scheme: &[PairScheme]) {
        let (state, continuum) = match solve_scheme(self.system, self.numbers, scheme) {
            SchemeSolution::Unique(state) => (state, false),
            SchemeSolution::Continuum(state) => (state, true),
            SchemeSolution::Nothing => return,
            SchemeSolution::Undecided => {
                self.found.undecided += 1;
                return;
            }
        };
        let violation = law_violation(self.system, self.numbers, &state);
        if violation > LOOSE {
            return;
        }
        let exact = match exact_check(self.system, self.numbers, scheme, &mut |_| ControlFlow::Continue(())).finding {
            Finding::Proved { .. } => Some(true),
            Finding::Refuted { .. } | Finding::Singular { consistent: false, .. } => Some(false),
            _ => None,
        };
        let accepted = if continuum { ACCEPTED_CONTINUUM } else { ACCEPTED };
        if violation > accepted && exact != Some(true) {
            if exact.is_none() {
                self.found.undecided += 1;
            }
            return;
        }
        let mut scheme = scheme.to_vec();
        for (pair, state_of) in scheme.iter_mut().enumerate() {
            let free = state_of.open && fixed_bound(self.system, self.numbers, pair) == 0.0;
            if free
                && let Some(tangential) = self.system.pairs[pair].tangential
                && state_of.tangential != Tangential::Stick
                && state.z[tangential] < 0.0
            {
                state_of.tangential = Tangential::SlipMinus;
            }
        }
        let exact = exact == Some(true);
        let same = |known: &EnumeratedAnswer| self.same(&known.state, &state);
        if let Some(place) = self.found.answers.iter().position(same) {
            let known = &mut self.found.answers[place];
            known.schemes.push(scheme);
            known.continuum |= continuum;
            if (exact, -violation) > (known.exact, -known.violation) {
                known.state = state;
                known.violation = violation;
            }
            known.exact |= exact;
        } else {
            self.found.answers.push(EnumeratedAnswer { schemes: vec![scheme], state, exact, continuum, violation });
        }
    }

    fn same(&self, a: &JointState, b: &JointState) -> bool {
        let size = self.sizes.displacement(&a.z).max(self.sizes.displacement(&b.z));
        let still = a.z.amax() == 0.0 && b.z.amax() == 0.0;
        let moved =
            (0..self.system.joint_count()).map(|j| ((a.z[j] - b.z[j]) * self.sizes.root[j]).abs()).fold(0.0, f64::max);
        let force = (&a.force - &b.force).amax();
        (still || moved <= SAME * size) && force <= SAME * self.sizes.force
    }
}

#[cfg(test)]
#[path = "enumerate_tests.rs"]
mod tests;
