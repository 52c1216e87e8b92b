//! One working scheme solved in f64, and how well a state of the joints obeys the laws.

use microlp::{ComparisonOp, OptimizationDirection, Problem, SolveOutcome};
use nalgebra::{DMatrix, DVector};

use crate::model::pair::Law;

use super::numbers::ContactNumbers;
use super::scheme_word::PairScheme;
use super::system::ContactSystem;
use super::whole::{fixed_bound, friction, joint_constants, tangential_joint};

/// Singular values below this times the largest count as zero (R scaled to unit diagonal).
const RANK: f64 = 1e-11;
/// Relative residual up to which singular equations count as consistent.
const CONSISTENT: f64 = 1e-9;

/// Displacements and forces of all joints, in the order of R.
#[derive(Clone, Debug, PartialEq)]
pub struct JointState {
    /// z; of a normal joint the distance still open.
    pub z: DVector<f64>,
    /// λ = R (z − (g, 0)) + RF.
    pub force: DVector<f64>,
}

/// The solutions of a scheme's equations.
#[derive(Clone, Debug, PartialEq)]
pub enum SchemeSolution {
    /// The only one; its signs may be wrong.
    Unique(JointState),
    /// Singular equations with solutions, one of which obeys all signs: there may be a continuum of them.
    Continuum(JointState),
    /// No solution, or none that obeys the signs.
    Nothing,
    /// The linear program behind `Continuum` failed.
    Undecided,
}

/// One equation or inequality on the released joints: coefficients·z + constant.
struct Affine {
    coefficients: DVector<f64>,
    constant: f64,
}

/// Sizes that make residuals relative.
pub(crate) struct Sizes {
    /// √R_jj (the largest where that is zero).
    pub root: Vec<f64>,
    /// Largest |RF − R·(g, 0)|, c or r_f.
    pub force: f64,
}

impl Sizes {
    pub(crate) fn new(system: &ContactSystem, numbers: &ContactNumbers) -> Self {
        let k = system.joint_count();
        let diagonal = |j: usize| system.stiffness[(j, j)].max(0.0).sqrt();
        let largest = (0..k).map(diagonal).fold(0.0, f64::max);
        let spare = if largest > 0.0 { largest } else { 1.0 };
        let constants = joint_constants::<f64>(system, numbers);
        let fixed = (0..system.pair_count()).map(|pair| fixed_bound(system, numbers, pair));
        let force = constants.into_iter().chain(fixed).fold(0.0, |a: f64, x| a.max(x.abs()));
        Self {
            root: (0..k).map(|j| if diagonal(j) > 0.0 { diagonal(j) } else { spare }).collect(),
            force: if force > 0.0 { force } else { 1.0 },
        }
    }

    /// Largest √R_jj |z_j| (1 where nothing moves).
    pub(crate) fn displacement(&self, z: &DVector<f64>) -> f64 {
        let size = z.iter().zip(&self.root).fold(0.0, |a: f64, (z, root)| a.max((z * root).abs()));
        if size > 0.0 { size } else { 1.0 }
    }
}

fn state(system: &ContactSystem, constants: &[f64], z: DVector<f64>) -> JointState {
    let force = &system.stiffness * &z + DVector::from_column_slice(constants);
    JointState { z, force }
}

/// Solves the equations of `scheme` (one entry per pair).
pub fn solve_scheme(system: &ContactSystem, numbers: &ContactNumbers, scheme: &[PairScheme]) -> SchemeSolution {
    let sizes = Sizes::new(system, numbers);
    let constants = joint_constants::<f64>(system, numbers);
    let m = system.pair_count();
    let open = |pair: usize| scheme[pair].open && !matches!(system.pairs[pair].law, Law::Bound { .. });
    let slip = |pair: usize| match system.pairs[pair].law {
        Law::Frictionless { .. } => 0.0,
        Law::Coulomb { .. } | Law::Bound { .. } => scheme[pair].tangential.sign(),
    };
    let normals: Vec<usize> = (0..m).filter(|pair| open(*pair)).collect();
    let slipping: Vec<usize> = (0..m).filter(|pair| slip(*pair) != 0.0).collect();
    let released: Vec<usize> =
        normals.iter().copied().chain(slipping.iter().map(|pair| tangential_joint(system, *pair))).collect();
    let affine = |terms: &[(usize, f64)], fixed: f64| Affine {
        // Unknowns are √R_jj z_j.
        coefficients: DVector::from_iterator(
            released.len(),
            released.iter().map(|k| {
                terms.iter().map(|(joint, factor)| factor * system.stiffness[(*joint, *k)]).sum::<f64>()
                    / sizes.root[*k]
            }),
        ),
        constant: fixed + terms.iter().map(|(joint, a)| a * constants[*joint]).sum::<f64>(),
    };
    let normal = |pair: usize| affine(&[(pair, 1.0)], 0.0);
    let reserve = |pair: usize, side: f64| {
        affine(
            &[(tangential_joint(system, pair), side), (pair, friction(system, numbers, pair))],
            fixed_bound(system, numbers, pair),
        )
    };
    // Rows divided by their own size: unit diagonal where R alone decides.
    let equations: Vec<Affine> = normals
        .iter()
        .map(|pair| (normal(*pair), sizes.root[*pair]))
        .chain(slipping.iter().map(|pair| {
            let size =
                sizes.root[tangential_joint(system, *pair)] + friction(system, numbers, *pair) * sizes.root[*pair];
            (reserve(*pair, slip(*pair)), size)
        }))
        .map(|(row, size)| Affine { coefficients: row.coefficients / size, constant: row.constant / size })
        .collect();
    let k = released.len();
    let matrix = DMatrix::from_fn(k, k, |i, j| equations[i].coefficients[j]);
    let rhs = DVector::from_iterator(k, equations.iter().map(|row| -row.constant));
    let spread = |y: &DVector<f64>| {
        let mut z = DVector::zeros(system.joint_count());
        for (joint, value) in released.iter().zip(y.iter()) {
            z[*joint] = value / sizes.root[*joint];
        }
        state(system, &constants, z)
    };
    if k == 0 {
        return SchemeSolution::Unique(spread(&rhs));
    }
    let lu = matrix.clone().full_piv_lu();
    let pivots = lu.u().diagonal().map(f64::abs);
    if pivots.min() > RANK * pivots.max()
        && let Some(mut y) = lu.solve(&rhs)
    {
        // One step of refinement.
        if let Some(correction) = lu.solve(&(&rhs - &matrix * &y)) {
            y += correction;
        }
        return SchemeSolution::Unique(spread(&y));
    }
    let svd = matrix.clone().svd(true, true);
    let cut = 1e2 * RANK * svd.singular_values.max();
    let Ok(particular) = svd.solve(&rhs, cut) else {
        return SchemeSolution::Undecided;
    };
    if (&matrix * &particular - &rhs).amax() > CONSISTENT * rhs.amax().max(particular.amax()) {
        return SchemeSolution::Nothing;
    }
    let mut inequalities = Vec::new();
    for pair in 0..m {
        let law = &system.pairs[pair].law;
        if !open(pair) && !matches!(law, Law::Bound { .. }) {
            inequalities.push(normal(pair));
        }
        if !matches!(law, Law::Frictionless { .. }) {
            inequalities.push(reserve(pair, 1.0));
            inequalities.push(reserve(pair, -1.0));
        }
    }
    let bounds: Vec<(f64, f64)> = normals
        .iter()
        .map(|_| (0.0, f64::INFINITY))
        .chain(slipping.iter().map(
            |pair| {
                if slip(*pair) > 0.0 { (0.0, f64::INFINITY) } else { (f64::NEG_INFINITY, 0.0) }
            },
        ))
        .collect();
    // Unknown shift from the particular solution along the null space keeps the equations exactly solvable.
    feasible(&svd, cut, &particular, &bounds, &inequalities, sizes.force).map_or_else(
        |undecided| {
            if undecided { SchemeSolution::Undecided } else { SchemeSolution::Nothing }
        },
        |y| SchemeSolution::Continuum(spread(&y)),
    )
}

/// A point particular + N s within the bounds and inequalities; `Err(true)` when the linear program failed.
fn feasible(
    svd: &nalgebra::SVD<f64, nalgebra::Dyn, nalgebra::Dyn>,
    cut: f64,
    particular: &DVector<f64>,
    bounds: &[(f64, f64)],
    inequalities: &[Affine],
    force: f64,
) -> Result<DVector<f64>, bool> {
    let Some(v_t) = &svd.v_t else {
        return Err(true);
    };
    let null: Vec<DVector<f64>> = svd
        .singular_values
        .iter()
        .enumerate()
        .filter(|(_, s)| **s <= cut)
        .map(|(i, _)| v_t.row(i).transpose())
        .collect();
    let size = particular.amax().max(force.sqrt() * f64::EPSILON);
    let mut problem = Problem::new(OptimizationDirection::Minimize);
    let shifts: Vec<_> = null.iter().map(|_| problem.add_var(0.0, (f64::NEG_INFINITY, f64::INFINITY))).collect();
    // Slack of one billionth: rounding must not make a degenerate scheme infeasible.
    for (j, (low, high)) in bounds.iter().enumerate() {
        let row: Vec<_> = shifts.iter().zip(&null).map(|(s, n)| (*s, n[j])).collect();
        if *low == 0.0 {
            problem.add_constraint(&row, ComparisonOp::Ge, -particular[j] / size - 1e-9);
        }
        if *high == 0.0 {
            problem.add_constraint(&row, ComparisonOp::Le, -particular[j] / size + 1e-9);
        }
    }
    for inequality in inequalities {
        let a = &inequality.coefficients;
        let row: Vec<_> = shifts.iter().zip(&null).map(|(s, n)| (*s, a.dot(n) * size / force)).collect();
        let value = (a.dot(particular) + inequality.constant) / force;
        problem.add_constraint(&row, ComparisonOp::Ge, -value - 1e-9);
    }
    match problem.solve() {
        Ok(SolveOutcome::Solution(solution)) => {
            let mut y = particular.clone();
            for (shift, n) in shifts.iter().zip(&null) {
                y += n * (solution[*shift] * size);
            }
            Ok(y)
        }
        Err(microlp::Error::Infeasible) => Err(false),
        Ok(SolveOutcome::Interrupted(_)) | Err(_) => Err(true),
    }
}

/// Largest violation of the laws, of equilibrium apart: signs and complementarity, relative to the largest force and the
/// largest (stiffness-scaled) displacement. 0 is perfect, 1 entirely wrong.
pub fn law_violation(system: &ContactSystem, numbers: &ContactNumbers, state: &JointState) -> f64 {
    let sizes = Sizes::new(system, numbers);
    let displacement = sizes.displacement(&state.z);
    let z = |joint: usize| state.z[joint] * sizes.root[joint] / displacement;
    let x = |force: f64| force / sizes.force;
    let mut worst = 0.0f64;
    for pair in 0..system.pair_count() {
        let law = &system.pairs[pair].law;
        let x_n = state.force[pair];
        if matches!(law, Law::Bound { .. }) {
            worst = worst.max(z(pair).abs());
        } else {
            worst = worst.max(-x(x_n)).max(-z(pair)).max(x(x_n).min(z(pair)));
        }
        if matches!(law, Law::Frictionless { .. }) {
            continue;
        }
        let tangential = tangential_joint(system, pair);
        let bound = friction(system, numbers, pair) * x_n + fixed_bound(system, numbers, pair);
        let (plus, minus) = (bound + state.force[tangential], bound - state.force[tangential]);
        let slip = z(tangential);
        worst = worst.max(-x(plus)).max(-x(minus)).max(x(plus).min(slip)).max(x(minus).min(-slip));
    }
    worst
}
