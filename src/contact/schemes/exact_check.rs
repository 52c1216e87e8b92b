//! A working scheme proved or refuted in exact arithmetic.
//!
//! The f64 data R, RF, f, c, g are rationals; of a contact system from a file they are those of the file, the released
//! tangential joints of its frictionless pairs among them. The linear equations of the scheme (x_n = 0 where open,
//! x^± = 0 where slipping, in space x^k = 0 of one facet or two) are solved exactly and the sign of every other
//! quantity is determined exactly. The directions d_k of the polygon are the f64 numbers that they are stored as. The
//! check judges the data as they are stored: a structure whose loads are exactly at a limit on paper need not be so
//! after rounding to f64.

use std::cmp::Ordering;
use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector};
use num_rational::BigRational;
use num_traits::{Signed, Zero};

use crate::contact::polygon::Polygon;
use crate::contact::problem::ContactProblem;
use crate::contact::rows::{Quantity, RowId, RowKind};
use crate::contact::schemes::scheme::{PairScheme, Tangential, slip_forms};
use crate::contact::system::ContactSystem;
use crate::lcp::exact::dyadic::{parts as parts_of, product, rational, shifted};
use crate::lcp::exact::rational_solve::{self, Quotients, RationalSolution};
use crate::lcp::exact::scalar::{BigInt, ratio_to_f64};

/// A force or displacement of the LCP whose sign has been determined exactly.
#[derive(Clone, Debug, PartialEq)]
pub struct ExactSign {
    /// Its pair and couple.
    pub row: RowId,
    /// Whether it is the force or the displacement of the couple.
    pub quantity: Quantity,
    /// `x_n[c1]`, `z+[c1]`, in space `z^3[c1]`.
    pub name: String,
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
    /// The friction of the data: in space this polygon, its directions the f64 numbers they are stored as.
    pub polygon: Polygon,
    /// Number of released joints.
    pub released: usize,
    /// Number of signs determined.
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

    /// x_n or a reserve.
    fn force(&self, row: RowId) -> Form {
        let law = &self.problem.laws[row.pair];
        let joints = row.joints(&self.problem.system, self.problem.polygon);
        let mut terms: Vec<(usize, f64)> = joints.map(|(joint, factor)| (self.data.row[joint], factor)).collect();
        if row.couple == RowKind::Normal {
            return self.form(&terms, 0.0);
        }
        terms.push((self.data.row[row.pair], law.friction()));
        self.form(&terms, law.fixed_bound())
    }

    /// Σ part·z over the tangential joints of a pair.
    fn slip(&self, pair: usize, parts: [f64; 2]) -> Form {
        let joints = self.problem.system.pairs[pair].tangential.clone().map(|joint| self.data.row[joint]);
        let parts: Vec<(usize, (i64, i64))> = joints.zip(parts.map(parts_of)).collect();
        let part = |column: &usize| parts.iter().find(|(row, _)| row == column).map_or((0, 0), |(_, part)| *part);
        let least = parts.iter().filter(|(_, part)| part.0 != 0).map(|(_, part)| part.1).fold(0, i64::min);
        let whole = |column: &usize| {
            let (mantissa, exponent) = part(column);
            if mantissa == 0 { BigInt::zero() } else { shifted(i128::from(mantissa), exponent - least) }
        };
        Form {
            coefficients: self.unknown.iter().map(whole).collect(),
            constant: BigInt::zero(),
            scale: shifted(1, -least),
        }
    }

    /// The equations of a slip: its reserves are zero, and so is what it has across its facet.
    fn slip_equations(&self, pair: usize, scheme: PairScheme) -> Vec<Form> {
        let (problem, polygon) = (self.problem, self.problem.polygon);
        // Without cohesion all reserves of an open pair are zero, in space with any two of them.
        if scheme.open && polygon != Polygon::PLANE && problem.laws[pair].fixed_bound() == 0.0 {
            return (0..2).map(|facet| self.force(reserve(pair, facet))).collect();
        }
        let conditions = scheme.tangential.conditions(polygon);
        let forms = slip_forms(polygon);
        let reserves = conditions.reserves.iter().map(|facet| self.force(reserve(pair, *facet)));
        reserves.chain(conditions.zero.iter().map(|form| self.slip(pair, forms[*form]))).collect()
    }
}

fn reserve(pair: usize, facet: usize) -> RowId {
    RowId { pair, couple: RowKind::Facet(facet as u16) }
}

/// Solves `scheme` (one entry per pair) exactly and determines every sign. `progress` hears the share of the work done,
/// 0 … 1, and may stop it.
pub fn exact_check(
    problem: &ContactProblem,
    scheme: &[PairScheme],
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> ExactCheck {
    let system = &*problem.system;
    let m = system.pair_count();
    let opens = |pair: &usize| scheme[*pair].open && !system.pairs[*pair].law.is_bilateral();
    let slips = |pair: &usize| system.pairs[*pair].rubs() && scheme[*pair].tangential != Tangential::Stick;
    let tangentials = (0..m).filter(slips).flat_map(|pair| system.pairs[pair].tangential.clone());
    let data = Data::of(problem);
    let unknown: Vec<usize> = (0..m).filter(opens).chain(tangentials).map(|joint| data.row[joint]).collect();
    let released = unknown.len();
    let unknown = unknown.into_iter().chain(data.released.iter().copied()).collect();
    let forms = Forms { problem, data, unknown };
    let normal = |pair| forms.force(RowId { pair, couple: RowKind::Normal });
    let scheme_of = |pair: usize| PairScheme { open: opens(&pair), ..scheme[pair] };
    let equations: Vec<Form> = (0..m)
        .filter(opens)
        .map(normal)
        .chain((0..m).filter(slips).flat_map(|pair| forms.slip_equations(pair, scheme_of(pair))))
        .chain(forms.data.released.iter().map(|&row| forms.form(&[(row, 1.0)], 0.0)))
        .collect();
    let rhs: Vec<BigInt> = equations.iter().map(|form| -&form.constant).collect();
    let matrix: Vec<Vec<BigInt>> = equations.into_iter().map(|form| form.coefficients).collect();
    let ended = |finding| ExactCheck { finding, polygon: problem.polygon, released, signs: 0, z: None };
    let solution = match rational_solve::solve(&matrix, &rhs, &mut |share| progress(0.9 * share)) {
        RationalSolution::Unique(solution) => solution,
        RationalSolution::Singular { rank, particular } => {
            return ended(Finding::Singular { rank, consistent: particular.is_some() });
        }
        RationalSolution::Interrupted => return ended(Finding::Interrupted),
        RationalSolution::Unlucky => return ended(Finding::Failed),
    };

    let mut signs = Signs { system, forms: &forms, solution, determined: 0, notable: Vec::new() };
    for pair in 0..m {
        signs.pair(pair, scheme_of(pair));
        if progress(0.9 + 0.1 * (pair + 1) as f64 / m as f64).is_break() {
            return ended(Finding::Interrupted);
        }
    }
    let determined = signs.determined;
    let joints = (0..system.joint_count()).map(|joint| {
        let (over, under) = signs.displacement(joint);
        ratio_to_f64(&over, &under)
    });
    let z = Some(DVector::from_iterator(system.joint_count(), joints));
    let (violations, zeros): (Vec<_>, Vec<_>) = signs.notable.into_iter().partition(|sign| sign.sign == Ordering::Less);
    ExactCheck {
        finding: if violations.is_empty() { Finding::Proved { zeros } } else { Finding::Refuted { violations } },
        polygon: problem.polygon,
        released,
        signs: determined,
        z,
    }
}

struct Signs<'a> {
    system: &'a ContactSystem,
    forms: &'a Forms<'a>,
    solution: Quotients,
    determined: usize,
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

    /// Determines the sign of over / under / scale, scale > 0, and keeps what is not positive.
    fn tell(&mut self, row: RowId, quantity: Quantity, (over, under): (BigInt, BigInt), scale: f64) {
        self.determined += 1;
        if over.is_positive() {
            return;
        }
        let letter = if quantity == Quantity::Force { 'x' } else { 'z' };
        self.notable.push(ExactSign {
            row,
            quantity,
            name: row.name(letter, self.system),
            sign: over.cmp(&BigInt::zero()),
            value: ratio_to_f64(&over, &under) / scale,
        });
    }

    /// Displacement of a released joint.
    fn displacement(&self, joint: usize) -> (BigInt, BigInt) {
        let index = self.forms.unknown.iter().position(|column| *column == self.forms.data.row[joint]);
        // Asked for released joints only.
        let numerator = index.map_or_else(BigInt::zero, |i| self.solution.numerators[i].clone());
        (numerator, self.solution.denominator.clone())
    }

    fn pair(&mut self, pair: usize, scheme: PairScheme) {
        let of = &self.system.pairs[pair];
        let normal = RowId { pair, couple: RowKind::Normal };
        if scheme.open {
            self.tell(normal, Quantity::Displacement, self.displacement(pair), 1.0);
        } else if !of.law.is_bilateral() {
            let x_n = self.value(&self.forms.force(normal));
            self.tell(normal, Quantity::Force, x_n, 1.0);
        }
        if !of.rubs() {
            return;
        }
        let polygon = self.forms.problem.polygon;
        let slipping = scheme.tangential.facets(polygon);
        let held = (0..polygon.facets()).filter(|facet| !slipping.contains(facet));
        let reserves: Vec<(usize, (BigInt, BigInt))> =
            held.map(|facet| (facet, self.value(&self.forms.force(reserve(pair, facet))))).collect();
        // All reserves are zero: r_f = 0, and the slip is free in direction.
        if !slipping.is_empty() && reserves.iter().all(|(_, (over, _))| over.is_zero()) {
            self.determined += reserves.len() + slipping.len();
            return;
        }
        for (facet, value) in reserves {
            self.tell(reserve(pair, facet), Quantity::Force, value, 1.0);
        }
        let other = |facet: usize| slipping.iter().copied().find(|own| *own != facet);
        for &facet in &slipping {
            let (parts, scale) = slip_along(polygon, facet, other(facet));
            let value = self.value(&self.forms.slip(pair, parts));
            self.tell(reserve(pair, facet), Quantity::Displacement, value, scale);
        }
    }
}

/// Components and a number > 0: ζ of `facet`, where the slip is along it or between it and `other`, is the product of
/// these components with z_τ over that number.
fn slip_along(polygon: Polygon, facet: usize, other: Option<usize>) -> ([f64; 2], f64) {
    let along = polygon.direction(facet);
    let Some(other) = other else { return (along, 1.0) };
    // ζ = (z × d') / (d × d'): z × d' is 0 for z = d'.
    let [a, b] = polygon.direction(other);
    let scale = along[0] * b - along[1] * a;
    let sign = scale.signum();
    ([sign * b, -sign * a], scale.abs())
}

#[cfg(test)]
#[path = "exact_check_tests.rs"]
mod tests;
