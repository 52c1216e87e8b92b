//! Whether a partial scheme can be completed, decided with balls (f64 with error bounds).
//!
//! Every quantity is kept as an affine function of the displacements of the pairs not yet decided; deciding a pair
//! eliminates its displacements, and a sign that fails for all displacements of the others in their box ends the
//! branch. The box: normals z_n ≥ 0 and, where R is positive definite, that around the ellipsoid zᵀR z ≤ −zᵀq that
//! every answer lies in (zᵀλ ≤ 0 for every answer; q is RF − R·(g, 0)), with proved bounds
//! ([`crate::contact::schemes::bounding_box`]).

use crate::contact::problem::ContactProblem;
use crate::contact::schemes::ball::{Ball, Row, eliminated};
use crate::contact::schemes::bounding_box::ellipsoid;
use crate::contact::schemes::exact_system::ExactSystem;
use crate::contact::schemes::scheme::{PairScheme, Tangential, slip_forms};

/// The dictionary of a partial scheme. Rows: one per joint, pair by pair (n, then the tangential ones), holding λ_j or
/// z_j, whichever is not fixed. Columns: the undecided joints from `first` on, then the constant.
pub(crate) struct Level {
    first: usize,
    rows: Vec<Ball>,
}

pub(crate) struct Pruning<'a> {
    problem: &'a ContactProblem,
    /// First joint of every pair in the pair by pair order, and their number at the end.
    offsets: Vec<usize>,
    /// Joint of R of every joint in the pair by pair order.
    joints: Vec<usize>,
    /// RF − R·(g, 0) of each joint of R, with what rounding may have made of it.
    constants: Vec<Ball>,
    /// Box of every displacement.
    bounds: Vec<(f64, f64)>,
    /// Whether the box has more sides than z_n ≥ 0.
    pub has_box: bool,
    /// The forms of the slip that tell its direction.
    forms: Vec<[f64; 2]>,
}

impl<'a> Pruning<'a> {
    pub fn new(exact: &ExactSystem<'a>, constants: Vec<Ball>) -> Self {
        let problem = exact.problem;
        let system = &*problem.system;
        let mut joints = Vec::new();
        let mut offsets = vec![0];
        for (i, pair) in system.pairs.iter().enumerate() {
            joints.push(i);
            joints.extend(pair.tangential.clone());
            offsets.push(joints.len());
        }
        let is_normal = |joint: usize| joint < system.pair_count();
        let mut bounds: Vec<(f64, f64)> = joints
            .iter()
            .map(|&joint| if is_normal(joint) { (0.0, f64::INFINITY) } else { (f64::NEG_INFINITY, f64::INFINITY) })
            .collect();
        let sides = ellipsoid(&exact.stiffness, &constants, &joints);
        let has_box = sides.is_some();
        for (bound, (low, high)) in bounds.iter_mut().zip(sides.into_iter().flatten()) {
            *bound = (bound.0.max(low), bound.1.min(high));
        }
        Self { problem, offsets, joints, constants, bounds, has_box, forms: slip_forms(problem.polygon) }
    }

    /// Nothing decided yet.
    pub fn root(&self, exact: &ExactSystem<'_>) -> Level {
        let mut rows = Vec::with_capacity(self.joints.len() * (self.joints.len() + 1));
        for &i in &self.joints {
            rows.extend(self.joints.iter().map(|&j| Ball::around(&exact.stiffness[i][j])));
            rows.push(self.constants[i]);
        }
        Level { first: 0, rows }
    }

    /// The box: of every joint of R its lowest and highest displacement.
    pub fn sides(&self) -> Vec<(usize, f64, f64)> {
        self.joints.iter().zip(&self.bounds).map(|(joint, (low, high))| (*joint, *low, *high)).collect()
    }

    /// The dictionary with this pair decided; `None` when a pivot may be zero.
    pub fn decide(&self, level: &Level, pair: usize, choice: PairScheme) -> Option<Level> {
        let k = self.joints.len();
        let width = k + 1 - level.first;
        let n = self.offsets[pair];
        let next = self.offsets[pair + 1];
        let row = |i: usize| &level.rows[i * width..(i + 1) * width];

        // Equations to be solved for the displacements of the released joints, as many as there are of these.
        let (mut equations, mut released): (Vec<Row>, Vec<usize>) = (Vec::new(), Vec::new());
        if choice.open {
            equations.push(row(n).to_vec());
            released.push(n);
        }
        if next - n > 1 && choice.tangential != Tangential::Stick {
            released.extend(n + 1..next);
            equations.extend(self.slip_equations(pair, choice, (level.first, width), &row));
        }
        let columns: Vec<usize> = released.iter().map(|joint| joint - level.first).collect();
        let solved = eliminated(equations, &columns)?;
        // Displacements of this pair in terms of the undecided ones; 0 where the joint is on.
        let mut displacement: Vec<Option<Row>> = vec![None; next - n];
        released.iter().zip(solved).for_each(|(joint, row)| displacement[joint - n] = Some(row));
        let column = |joint: usize| joint - level.first;

        let skip = next - level.first;
        let mut rows = Vec::with_capacity(k * (width - skip));
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
                    if !factor.is_nothing() {
                        for (x, z) in rows[start..].iter_mut().zip(&z[skip..]) {
                            *x = x.plus(factor.times(*z));
                        }
                    }
                }
            }
        }
        Some(Level { first: next, rows })
    }

    /// Whether some sign of the decided pairs fails for all displacements of the others.
    pub fn hopeless(&self, level: &Level, scheme: &[PairScheme]) -> bool {
        let (system, laws) = (&self.problem.system, &self.problem.laws);
        let polygon = self.problem.polygon;
        let width = self.joints.len() + 1 - level.first;
        let row = |i: usize| &level.rows[i * width..(i + 1) * width];
        let bounds = &self.bounds[level.first..];
        // Σ factor · row + fixed is negative throughout.
        let fails = |terms: &[(usize, f64)], fixed: f64| {
            let entry = |column: usize| {
                let scaled = |&(i, factor): &(usize, f64)| Ball::exactly(factor).times(row(i)[column]);
                terms.iter().map(scaled).fold(Ball::ZERO, Ball::plus)
            };
            let constant = entry(width - 1).plus(Ball::exactly(fixed));
            let mut largest = Ball::exactly(constant.largest_times(1.0, 1.0));
            for (column, (low, high)) in bounds.iter().enumerate() {
                let most = entry(column).largest_times(*low, *high);
                if most == f64::INFINITY {
                    return false;
                }
                largest = largest.plus(Ball::exactly(most));
            }
            largest.middle + largest.radius < 0.0
        };
        scheme.iter().enumerate().any(|(pair, state)| {
            let n = self.offsets[pair];
            let bilateral = system.pairs[pair].law.is_bilateral();
            let fixed = laws[pair].fixed_bound();
            // z_n where open, x_n where closed.
            if !bilateral && fails(&[(n, 1.0)], 0.0) {
                return true;
            }
            let tangents = self.offsets[pair + 1] - n - 1;
            if tangents == 0 {
                return false;
            }
            let along = |parts: [f64; 2]| (0..tangents).map(move |t| (n + 1 + t, parts[t]));
            match state.tangential {
                // An open pair without cohesion slips freely.
                _ if state.open && fixed == 0.0 => false,
                Tangential::Stick => (0..polygon.facets()).any(|facet| {
                    let f = if state.open { 0.0 } else { laws[pair].friction() };
                    fails(&along(polygon.direction(facet)).chain([(n, f)]).collect::<Vec<_>>(), fixed)
                }),
                slip => slip.conditions(polygon).signs.into_iter().any(|(form, up)| {
                    let sign = if up { 1.0 } else { -1.0 };
                    fails(&along(self.forms[form].map(|part| sign * part)).collect::<Vec<_>>(), 0.0)
                }),
            }
        })
    }

    /// What a slip asks for, as rows over the undecided displacements: its reserves are zero and, along one facet in
    /// space, so is the slip across it.
    fn slip_equations<'b>(
        &self,
        pair: usize,
        choice: PairScheme,
        (first, width): (usize, usize),
        row: &dyn Fn(usize) -> &'b [Ball],
    ) -> Vec<Row> {
        let (law, polygon) = (&self.problem.laws[pair], self.problem.polygon);
        let (n, next) = (self.offsets[pair], self.offsets[pair + 1]);
        // λ_n = 0 where open.
        let f = if choice.open { Ball::ZERO } else { Ball::exactly(law.friction()) };
        let reserve = |facet: usize| {
            let mut equation: Row = row(n).iter().map(|entry| f.times(*entry)).collect();
            for (joint, part) in (n + 1..next).zip(polygon.direction(facet)) {
                equation
                    .iter_mut()
                    .zip(row(joint))
                    .for_each(|(sum, entry)| *sum = sum.plus(Ball::exactly(part).times(*entry)));
            }
            equation[width - 1] = equation[width - 1].plus(Ball::exactly(law.fixed_bound()));
            equation
        };
        let across = |form: usize| {
            let mut equation = vec![Ball::ZERO; width];
            (n + 1..next).zip(self.forms[form]).for_each(|(joint, part)| equation[joint - first] = Ball::exactly(part));
            equation
        };
        // Without cohesion all reserves of an open pair are zero: λ_τ = 0.
        if choice.open && law.fixed_bound() == 0.0 {
            return (n + 1..next).map(|joint| row(joint).to_vec()).collect();
        }
        let conditions = choice.tangential.conditions(polygon);
        let reserves = conditions.reserves.into_iter().map(reserve);
        reserves.chain(conditions.zero.into_iter().map(across)).collect()
    }
}
