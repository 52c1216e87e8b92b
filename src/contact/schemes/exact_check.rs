//! A working scheme proved or refuted in exact arithmetic.
//!
//! The f64 data R, RF, f, c, g are rationals; of a contact system from a file they are those of the file, the released
//! tangential joints of its frictionless pairs among them. The linear equations of the scheme (x_n = 0 where open, x^± = 0 where
//! slipping) are solved exactly and the sign of every other quantity is told exactly. The check judges the data as
//! they are stored: a structure whose loads are exactly at a limit on paper need not be so after rounding to f64.

use std::cmp::Ordering;
use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector};
use num_rational::BigRational;
use num_traits::{Signed, Zero};

use crate::contact::problem::ContactProblem;
use crate::contact::schemes::scheme::{PairScheme, Tangential};
use crate::contact::system::ContactSystem;
use crate::lcp::exact::dyadic::{product, rational, shifted};
use crate::lcp::exact::rational_solve::{self, Quotients, RationalSolution};
use crate::lcp::exact::scalar::{BigInt, ratio_to_f64};

/// A quantity of a pair that must not be negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// x_n.
    Xn,
    /// x⁺.
    XPlus,
    /// x⁻.
    XMinus,
    /// z_n.
    Zn,
    /// z⁺.
    ZPlus,
    /// z⁻.
    ZMinus,
}

impl Quantity {
    /// Its name in results.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Xn => "x_n",
            Quantity::XPlus => "x+",
            Quantity::XMinus => "x-",
            Quantity::Zn => "z_n",
            Quantity::ZPlus => "z+",
            Quantity::ZMinus => "z-",
        }
    }
}

/// A quantity whose sign has been told exactly.
#[derive(Clone, Debug, PartialEq)]
pub struct ExactSign {
    /// Index of the pair.
    pub pair: usize,
    /// Its id.
    pub id: String,
    /// Which quantity.
    pub quantity: Quantity,
    /// `Less`: violated; `Equal`: exactly on its limit.
    pub sign: Ordering,
    /// The value, rounded to f64 (its sign is right unless it underflows).
    pub value: f64,
}

/// What exact arithmetic says of a scheme.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// Every sign holds: the scheme is an answer of the data.
    Proved {
        /// Quantities that are exactly zero though the scheme does not ask for it.
        zeros: Vec<ExactSign>,
    },
    /// Some sign does not hold.
    Refuted {
        /// The negative quantities, in the order of the pairs.
        violations: Vec<ExactSign>,
    },
    /// The equations have no unique solution.
    Singular {
        /// Their exact rank.
        rank: usize,
        /// Whether they have solutions at all.
        consistent: bool,
    },
    /// Stopped by the caller.
    Interrupted,
    /// The exact solver gave up; see [`RationalSolution::Unlucky`].
    Failed,
}

/// The finding and the size of the system behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct ExactCheck {
    /// See [`Finding`].
    pub finding: Finding,
    /// Number of released joints.
    pub released: usize,
    /// Number of signs told.
    pub signs: usize,
    /// z over the joints, each rounded once, where the equations have one solution.
    pub z: Option<DVector<f64>>,
}

/// A linear form (Σ coefficient·z + constant) / scale over the released joints, scale > 0.
struct Form {
    coefficients: Vec<BigInt>,
    constant: BigInt,
    scale: BigInt,
}

struct Forms<'a> {
    problem: &'a ContactProblem,
    data: Data<'a>,
    /// Columns of the matrix whose displacement is unknown.
    unknown: Vec<usize>,
}

/// λ = matrix · (z − (g, 0)) + load over all joints of the data.
struct Data<'a> {
    matrix: &'a DMatrix<f64>,
    /// load − matrix · (g, 0).
    constants: Vec<BigRational>,
    /// Row of each joint.
    row: Vec<usize>,
    /// Rows that carry nothing and whose displacement is unknown whatever the scheme.
    released: Vec<usize>,
}

impl<'a> Data<'a> {
    fn of(problem: &'a ContactProblem) -> Data<'a> {
        let system = &*problem.system;
        match (&system.file, &problem.file_load) {
            (Some(file), Some(load)) if !file.compliance => Data {
                matrix: &file.matrix,
                constants: constants(&file.matrix, &load.vector, problem),
                row: file.kept.clone(),
                // Those that follow from others stay at rest: nothing tells where they are.
                released: file.factor.independent().iter().map(|&row| file.released[row]).collect(),
            },
            _ => Data {
                matrix: &system.stiffness,
                constants: constants(&system.stiffness, &problem.load, problem),
                row: (0..system.joint_count()).collect(),
                released: Vec::new(),
            },
        }
    }
}

/// load − matrix · (g, 0); the normal joint of pair i is row i.
fn constants(matrix: &DMatrix<f64>, load: &DVector<f64>, problem: &ContactProblem) -> Vec<BigRational> {
    let gaps: Vec<(usize, BigRational)> =
        problem.gaps().enumerate().filter(|(_, gap)| *gap != 0.0).map(|(k, gap)| (k, rational(gap))).collect();
    (0..matrix.nrows())
        .map(|i| gaps.iter().fold(rational(load[i]), |sum, (k, gap)| sum - rational(matrix[(i, *k)]) * gap))
        .collect()
}

impl Forms<'_> {
    /// Σ factor·λ_row + fixed.
    fn form(&self, terms: &[(usize, f64)], fixed: f64) -> Form {
        let factors = || terms.iter().map(|(joint, factor)| (*joint, *factor));
        let products = |k: usize| factors().map(move |(joint, factor)| product(factor, self.data.matrix[(joint, k)]));
        let constants = factors().map(|(joint, factor)| rational(factor) * &self.data.constants[joint]);
        let constant = constants.fold(rational(fixed), |sum, term| sum + term);
        // All of them are integers times powers of two: the least power makes them whole.
        let power = constant.denom().bits() as i64 - 1;
        let least = self.unknown.iter().flat_map(|k| products(*k)).filter(|(mantissa, _)| *mantissa != 0);
        let least = least.map(|(_, exponent)| exponent).fold(-power, i64::min);
        let whole = |k: &usize| -> BigInt {
            products(*k).map(|(mantissa, exponent)| shifted(mantissa, exponent - least)).sum()
        };
        Form {
            coefficients: self.unknown.iter().map(whole).collect(),
            constant: constant.numer() << (-power - least) as u64,
            scale: shifted(1, -least),
        }
    }

    fn normal(&self, pair: usize) -> Form {
        self.form(&[(self.data.row[pair], 1.0)], 0.0)
    }

    /// x⁺ (side 1) or x⁻ (side −1).
    fn reserve(&self, pair: usize, side: f64) -> Form {
        let f = self.problem.laws[pair].friction();
        let tangential = self.data.row[self.problem.system.pairs[pair].tangential.start];
        self.form(&[(tangential, side), (self.data.row[pair], f)], self.problem.laws[pair].fixed_bound())
    }
}

/// Solves `scheme` (one entry per pair) exactly and tells every sign. `progress` hears the share of the work done,
/// 0 … 1, and may stop it.
pub fn exact_check(
    problem: &ContactProblem,
    scheme: &[PairScheme],
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> ExactCheck {
    let system = &*problem.system;
    let opens = |pair: usize| scheme[pair].open && !system.pairs[pair].law.is_bilateral();
    let slip = |pair: usize| system.pairs[pair].plane_tangential().map_or(0.0, |_| scheme[pair].tangential.sign());
    let m = system.pair_count();
    let normals = (0..m).filter(|pair| opens(*pair));
    let tangentials = (0..m).filter(|pair| slip(*pair) != 0.0).map(|pair| system.pairs[pair].tangential.start);
    let data = Data::of(problem);
    let unknown: Vec<usize> = normals.chain(tangentials).map(|joint| data.row[joint]).collect();
    let released = unknown.len();
    let unknown = unknown.into_iter().chain(data.released.iter().copied()).collect();
    let forms = Forms { problem, data, unknown };
    let equations: Vec<Form> = (0..m)
        .filter(|pair| opens(*pair))
        .map(|pair| forms.normal(pair))
        .chain((0..m).filter(|pair| slip(*pair) != 0.0).map(|pair| forms.reserve(pair, slip(pair))))
        .chain(forms.data.released.iter().map(|&row| forms.form(&[(row, 1.0)], 0.0)))
        .collect();
    let rhs: Vec<BigInt> = equations.iter().map(|form| -&form.constant).collect();
    let matrix: Vec<Vec<BigInt>> = equations.into_iter().map(|form| form.coefficients).collect();
    let ended = |finding| ExactCheck { finding, released, signs: 0, z: None };
    let solution = match rational_solve::solve(&matrix, &rhs, &mut |share| progress(0.9 * share)) {
        RationalSolution::Unique(solution) => solution,
        RationalSolution::Singular { rank, particular } => {
            return ended(Finding::Singular { rank, consistent: particular.is_some() });
        }
        RationalSolution::Interrupted => return ended(Finding::Interrupted),
        RationalSolution::Unlucky => return ended(Finding::Failed),
    };

    let mut signs = Signs { system, forms: &forms, solution, told: 0, notable: Vec::new() };
    for (pair, state) in scheme.iter().enumerate() {
        signs.pair(pair, opens(pair), slip(pair), state.tangential);
        if progress(0.9 + 0.1 * (pair + 1) as f64 / m as f64).is_break() {
            return ended(Finding::Interrupted);
        }
    }
    let signs_told = signs.told;
    let joints = (0..system.joint_count()).map(|joint| {
        let (over, under) = signs.displacement(joint);
        ratio_to_f64(&over, &under)
    });
    let z = Some(DVector::from_iterator(system.joint_count(), joints));
    let (violations, zeros): (Vec<_>, Vec<_>) = signs.notable.into_iter().partition(|sign| sign.sign == Ordering::Less);
    ExactCheck {
        finding: if violations.is_empty() { Finding::Proved { zeros } } else { Finding::Refuted { violations } },
        released,
        signs: signs_told,
        z,
    }
}

struct Signs<'a> {
    system: &'a ContactSystem,
    forms: &'a Forms<'a>,
    solution: Quotients,
    told: usize,
    notable: Vec<ExactSign>,
}

impl Signs<'_> {
    fn value(&self, form: &Form) -> (BigInt, BigInt) {
        let sum: BigInt = form
            .coefficients
            .iter()
            .zip(&self.solution.numerators)
            .filter(|(c, n)| !c.is_zero() && !n.is_zero())
            .map(|(c, n)| c * n)
            .sum();
        let denominator = &self.solution.denominator;
        (sum + &form.constant * denominator, &form.scale * denominator)
    }

    fn tell(&mut self, pair: usize, quantity: Quantity, (over, under): (BigInt, BigInt)) {
        self.told += 1;
        if over.is_positive() {
            return;
        }
        self.notable.push(ExactSign {
            pair,
            id: self.system.pairs[pair].id.clone(),
            quantity,
            sign: over.cmp(&BigInt::zero()),
            value: ratio_to_f64(&over, &under),
        });
    }

    /// Displacement of a released joint.
    fn displacement(&self, joint: usize) -> (BigInt, BigInt) {
        let index = self.forms.unknown.iter().position(|column| *column == self.forms.data.row[joint]);
        // Asked for released joints only.
        let numerator = index.map_or_else(BigInt::zero, |i| self.solution.numerators[i].clone());
        (numerator, self.solution.denominator.clone())
    }

    fn pair(&mut self, pair: usize, open: bool, slip: f64, tangential: Tangential) {
        let of = &self.system.pairs[pair];
        if open {
            self.tell(pair, Quantity::Zn, self.displacement(pair));
        } else if !of.law.is_bilateral() {
            let x_n = self.value(&self.forms.normal(pair));
            self.tell(pair, Quantity::Xn, x_n);
        }
        if !of.rubs() {
            return;
        }
        let plus = (tangential != Tangential::SlipPlus).then(|| self.value(&self.forms.reserve(pair, 1.0)));
        let minus = (tangential != Tangential::SlipMinus).then(|| self.value(&self.forms.reserve(pair, -1.0)));
        // Both reserves are zero: r_f = 0, and the slip is free in sign.
        let free = slip != 0.0 && [&plus, &minus].into_iter().flatten().all(|(over, _)| over.is_zero());
        if free {
            self.told += 2;
            return;
        }
        if let Some(plus) = plus {
            self.tell(pair, Quantity::XPlus, plus);
        }
        if let Some(minus) = minus {
            self.tell(pair, Quantity::XMinus, minus);
        }
        if slip != 0.0 {
            let (z, scale) = self.displacement(self.system.pairs[pair].tangential.start);
            if slip > 0.0 {
                self.tell(pair, Quantity::ZPlus, (z, scale));
            } else {
                self.tell(pair, Quantity::ZMinus, (-z, scale));
            }
        }
    }
}

#[cfg(test)]
#[path = "exact_check_tests.rs"]
mod tests;
