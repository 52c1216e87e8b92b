//! The contact problem in rationals, as enumeration works on it: every statement of the laws is the sign of a linear
//! form in z.

use nalgebra::DMatrix;
use num_rational::BigRational;
use num_traits::Zero;

use crate::lcp::exact::dyadic::{WholeRows, rational, rational_rows};
use crate::lcp::exact::polyhedron::{GoOn, Polyhedron, State};
use crate::lcp::exact::rational_solve::{clear_denominators, product, rank_modulo_prime};

use crate::contact::problem::ContactProblem;
use crate::contact::schemes::scheme::{PairScheme, Tangential};
use crate::contact::system::ContactSystem;

/// Entries of the kernel this close to a whole number are that number: they come out of f64 linear algebra.
const WHOLE: f64 = 64.0 * f64::EPSILON;

/// λ = R z + constants, exactly.
pub(crate) struct ExactSystem<'a> {
    pub problem: &'a ContactProblem,
    /// R, its kernel exact.
    pub stiffness: Vec<Vec<BigRational>>,
    /// RF − R·(g, 0).
    pub constants: Vec<BigRational>,
}

/// The variables of a pair in the polyhedron.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PairVariables {
    pub z_n: usize,
    /// `None`: bilateral.
    pub x_n: Option<usize>,
    /// z_τ, x⁺, x⁻; `None`: frictionless.
    pub tangential: Option<[usize; 3]>,
}

impl<'a> ExactSystem<'a> {
    pub fn new(problem: &'a ContactProblem) -> Self {
        let system = &*problem.system;
        let (stored, mut constants) = stored(problem);
        let stiffness = with_exact_kernel(system, stored);
        for (k, gap) in problem.gaps().enumerate().filter(|(_, gap)| *gap != 0.0) {
            let gap = rational(gap);
            constants.iter_mut().zip(&stiffness).for_each(|(constant, row)| *constant -= &row[k] * &gap);
        }
        Self { problem, stiffness, constants }
    }

    /// Variables: z of all joints, then x_n, x⁺, x⁻ pair by pair.
    pub fn variables(&self) -> Vec<PairVariables> {
        let mut next = self.problem.system.joint_count();
        let mut take = || {
            next += 1;
            next - 1
        };
        self.problem
            .system
            .pairs
            .iter()
            .enumerate()
            .map(|(i, pair)| PairVariables {
                z_n: i,
                x_n: (!pair.law.is_bilateral()).then(&mut take),
                tangential: pair.plane_tangential().map(|joint| [joint, take(), take()]),
            })
            .collect()
    }

    /// What every answer obeys whatever its scheme: all signs but those of the slips, and the `sides` (joint, lowest and
    /// highest displacement) of a box that holds it.
    pub fn polyhedron(&self, sides: &[(usize, f64, f64)], go_on: &mut GoOn) -> (Polyhedron, State) {
        let k = self.problem.system.joint_count();
        let mut rows = WholeRows::default();
        for i in 0..self.problem.system.pair_count() {
            if !self.problem.system.pairs[i].law.is_bilateral() {
                rows.push_rational(&self.form(i, None));
            }
            if self.problem.system.pairs[i].rubs() {
                rows.push_rational(&self.form(i, Some(true)));
                rows.push_rational(&self.form(i, Some(false)));
            }
        }
        for &(joint, low, high) in sides {
            let mut row = vec![0.0; k + 1];
            for (sign, end) in [(1.0, -low), (-1.0, high)] {
                (row[joint], row[k]) = (sign, end);
                // A normal is ≥ 0 as it is.
                if end.is_finite() && (joint >= self.problem.system.pair_count() || sign < 0.0) {
                    rows.push(&row);
                }
            }
        }
        let slips: Vec<usize> = self.problem.system.pairs.iter().flat_map(|pair| pair.tangential.clone()).collect();
        let mut made = Polyhedron::new(k, rows, &slips);
        let mut state = made.restore(go_on);
        if state == State::Feasible {
            let pairs = &self.problem.system.pairs;
            let bilateral = (0..pairs.len()).filter(|&i| pairs[i].law.is_bilateral());
            (state, _) = made.fix_all(bilateral, go_on);
        }
        (made, state)
    }

    /// x_n of a pair, or its x⁺ or x⁻: coefficients over z, the constant last.
    fn form(&self, pair: usize, reserve: Option<bool>) -> Vec<BigRational> {
        let whole = |joint: usize| self.stiffness[joint].iter().chain([&self.constants[joint]]);
        let Some((plus, joint)) = reserve.zip(self.problem.system.pairs[pair].plane_tangential()) else {
            return whole(pair).cloned().collect();
        };
        let f = rational(self.problem.laws[pair].friction());
        let mut row: Vec<BigRational> = whole(joint)
            .zip(whole(pair))
            .map(|(t, n)| {
                let bound = if f.is_zero() { BigRational::zero() } else { &f * n };
                if plus { bound + t } else { bound - t }
            })
            .collect();
        if let Some(constant) = row.last_mut() {
            *constant += rational(self.problem.laws[pair].fixed_bound());
        }
        row
    }

    /// λ at z.
    pub fn force(&self, z: &[BigRational]) -> Vec<BigRational> {
        self.stiffness
            .iter()
            .zip(&self.constants)
            .map(|(row, constant)| {
                let terms = row.iter().zip(z).filter(|(r, z)| !r.is_zero() && !z.is_zero());
                terms.map(|(r, z)| r * z).sum::<BigRational>() + constant
            })
            .collect()
    }
}

impl PairVariables {
    /// What a scheme of this pair asks for.
    pub fn impose(&self, polyhedron: &mut Polyhedron, scheme: PairScheme, holds: bool, go_on: &mut GoOn) -> State {
        let mut state = State::Feasible;
        let mut fix = |polyhedron: &mut Polyhedron, variable: usize| {
            if state == State::Feasible {
                state = polyhedron.fix(variable, go_on);
            }
            state
        };
        if let Some(x_n) = self.x_n {
            fix(polyhedron, if scheme.open { x_n } else { self.z_n });
        }
        let Some([z, plus, minus]) = self.tangential else { return state };
        // An open pair that nothing holds slips freely: both reserves are zero.
        if scheme.open && !holds {
            fix(polyhedron, plus);
            return fix(polyhedron, minus);
        }
        let state = fix(
            polyhedron,
            [z, plus, minus][match scheme.tangential {
                Tangential::Stick => 0,
                Tangential::SlipPlus => 1,
                Tangential::SlipMinus => 2,
            }],
        );
        if state != State::Feasible || scheme.tangential == Tangential::Stick {
            return state;
        }
        if scheme.tangential == Tangential::SlipMinus {
            polyhedron.negate(z);
        }
        polyhedron.restrict(z, go_on)
    }
}

/// R and RF as they are stored; of a file with frictionless pairs from its own entries, the released tangential joints
/// condensed out exactly.
fn stored(problem: &ContactProblem) -> (Vec<Vec<BigRational>>, Vec<BigRational>) {
    let system = &*problem.system;
    let own = || (rational_rows(&system.stiffness), problem.load.iter().map(|entry| rational(*entry)).collect());
    let (Some(file), Some(load)) = (&system.file, &problem.file_load) else { return own() };
    if file.compliance {
        return own();
    }
    let mut rows = rational_rows(&file.matrix);
    rows.iter_mut().zip(load.vector.iter()).for_each(|(row, load)| row.push(rational(*load)));
    for released in file.factor.independent().iter().map(|&row| file.released[row]) {
        let pivot = rows[released].clone();
        if pivot[released].is_zero() {
            continue;
        }
        for row in &mut rows {
            if row[released].is_zero() {
                continue;
            }
            let factor = &row[released] / &pivot[released];
            row.iter_mut().zip(&pivot).for_each(|(entry, pivot)| *entry -= &factor * pivot);
        }
    }
    let last = file.matrix.ncols();
    let row_of = |&i: &usize| file.kept.iter().map(|&j| rows[i][j].clone()).collect();
    (file.kept.iter().map(row_of).collect(), file.kept.iter().map(|&i| rows[i][last].clone()).collect())
}

/// R with Z exactly in its kernel, unless its own digits have it already.
fn with_exact_kernel(system: &ContactSystem, mut stored: Vec<Vec<BigRational>>) -> Vec<Vec<BigRational>> {
    let Some((telling, motions)) = telling_joints(&system.kernel) else {
        return stored;
    };
    let mut whole = WholeRows::default();
    stored.iter().for_each(|row| whole.push_rational(row));
    if rank_modulo_prime(&whole.rows) + system.kernel.ncols() != system.joint_count() {
        let exact = |column: usize| motions.column(column).iter().map(|entry| rational(*entry)).collect();
        give_kernel(&mut stored, &telling, &(0..telling.len()).map(exact).collect::<Vec<_>>());
    }
    stored
}

/// Puts motions into the kernel of R: each is 1 at its own joint of P (`telling`) and 0 at the others of P, Z = [G; 1] over
/// the other joints N and P. Only R_NN is taken from what is stored, R_NP = −R_NN G and R_PP = Gᵀ R_NN G, which
/// differ from it by its rounding.
pub(crate) fn give_kernel(stiffness: &mut [Vec<BigRational>], telling: &[usize], motions: &[Vec<BigRational>]) {
    let others: Vec<usize> = (0..stiffness.len()).filter(|joint| !telling.contains(joint)).collect();
    let cleared = |entry: &dyn Fn(usize) -> BigRational| {
        clear_denominators(&others.iter().map(|&joint| entry(joint)).collect::<Vec<_>>())
    };
    let rows: Vec<_> = others.iter().map(|&n| cleared(&|joint| stiffness[n][joint].clone())).collect();
    let motions: Vec<_> = motions.iter().map(|motion| cleared(&|joint| motion[joint].clone())).collect();
    for (motion, &p) in motions.iter().zip(telling) {
        for (row, &n) in rows.iter().zip(&others) {
            let entry = -product(row, motion);
            stiffness[n][p].clone_from(&entry);
            stiffness[p][n] = entry;
        }
    }
    let columns: Vec<_> = telling.iter().map(|&p| cleared(&|joint| stiffness[joint][p].clone())).collect();
    for (motion, &p) in motions.iter().zip(telling) {
        for (column, &other) in columns.iter().zip(telling) {
            stiffness[p][other] = -product(motion, column);
        }
    }
}

/// Rows P of Z with a safe inverse, and Z Z_P⁻¹; `None` without a kernel.
pub(crate) fn telling_joints(kernel: &DMatrix<f64>) -> Option<(Vec<usize>, DMatrix<f64>)> {
    let (k, r) = kernel.shape();
    if r == 0 {
        return None;
    }
    // Gauss–Jordan over the columns with the largest entry as pivot.
    let mut z = kernel.clone();
    let mut telling = Vec::with_capacity(r);
    for column in 0..r {
        let mut best = (0, column, 0.0);
        for j in column..r {
            for i in (0..k).filter(|i| !telling.contains(i)) {
                if z[(i, j)].abs() > best.2 {
                    best = (i, j, z[(i, j)].abs());
                }
            }
        }
        let (row, from, size) = best;
        if size <= WHOLE {
            return None; // dependent columns: an orthonormal basis never is
        }
        z.swap_columns(column, from);
        let pivot = z[(row, column)];
        z.column_mut(column).iter_mut().for_each(|entry| *entry /= pivot);
        let own = z.column(column).into_owned();
        for j in (0..r).filter(|&j| j != column) {
            let factor = z[(row, j)];
            for i in 0..k {
                z[(i, j)] -= factor * own[i];
            }
        }
        telling.push(row);
    }
    for entry in z.iter_mut() {
        if (*entry - entry.round()).abs() <= WHOLE {
            *entry = entry.round();
        }
    }
    Some((telling, z))
}
