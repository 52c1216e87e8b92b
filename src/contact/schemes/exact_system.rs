//! The contact problem in rationals, as enumeration works on it: every statement of the laws is the sign of a linear
//! form in z.

use std::collections::HashMap;
use std::sync::OnceLock;

use nalgebra::DMatrix;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use crate::lcp::exact::dyadic::{self, WholeRows, rational, rational_rows};
use crate::lcp::exact::polyhedron::{GoOn, Polyhedron, State};
use crate::lcp::exact::rational_solve::{clear_denominators, common_multiple, product, rank_modulo_prime};
use crate::lcp::exact::scalar::BigInt;

use crate::contact::polygon::Polygon;
use crate::contact::problem::ContactProblem;
use crate::contact::rows::{RowId, RowKind};
use crate::contact::schemes::ball::Ball;
use crate::contact::schemes::scheme::{PairScheme, Tangential, slip_forms};
use crate::contact::schemes::telling::telling_joints;
use crate::contact::system::{ContactPair, ContactSystem};

/// λ = R z + constants, exactly.
pub(crate) struct ExactSystem<'a> {
    pub problem: &'a ContactProblem,
    /// R, its kernel exact.
    pub stiffness: Vec<Vec<BigRational>>,
    /// RF − R·(g, 0).
    pub constants: Vec<BigRational>,
    /// How far the force of each joint may lie from this, either way; empty where it is exact.
    rooms: Vec<f64>,
    /// Rows of R with their constant, as integers over a common denominator.
    whole: OnceLock<Vec<(Vec<BigInt>, BigInt)>>,
}

/// How far variables may lie from their forms, in parts of one.
#[derive(Default)]
pub(crate) struct Rooms {
    of: HashMap<usize, BigInt>,
    /// As many parts make one.
    common: BigInt,
}

impl Rooms {
    /// Whether every variable has the value of its form.
    pub fn are_none(&self) -> bool {
        self.of.is_empty()
    }

    /// Whether a [contradiction](Polyhedron::contradiction) stays one wherever in their rooms the variables lie.
    pub fn leave(&self, (factors, sum): &(Vec<(usize, BigInt)>, BigInt)) -> bool {
        let room = |(variable, factor): &(usize, BigInt)| Some(self.of.get(variable)? * factor.abs());
        factors.iter().filter_map(room).sum::<BigInt>() < -sum * &self.common
    }
}

/// The variables of a pair in the polyhedron.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PairVariables {
    pub z_n: usize,
    /// `None`: bilateral.
    pub x_n: Option<usize>,
    /// `None`: frictionless.
    pub tangential: Option<TangentialVariables>,
}

/// Those of its tangential joint.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TangentialVariables {
    /// z_τ along the tangents.
    pub slips: Vec<usize>,
    /// x^k of every facet.
    pub reserves: Vec<usize>,
    /// The forms that tell the direction of the slip ([`slip_forms`]).
    pub turns: Vec<usize>,
    pub polygon: Polygon,
}

impl<'a> ExactSystem<'a> {
    pub fn new(problem: &'a ContactProblem) -> Self {
        Self::with(problem, &problem.system.stiffness)
    }

    /// The system with zeros in place of their rounding in R, as proofs are exported.
    pub fn without_noise(problem: &'a ContactProblem) -> Self {
        Self::with(problem, &problem.system.stiffness_without_noise())
    }

    /// λ = R z + constants + e with any e of each joint, |e| ≤ its room.
    pub fn within(problem: &'a ContactProblem, rooms: &[f64]) -> Self {
        Self { rooms: rooms.to_vec(), ..Self::new(problem) }
    }

    fn with(problem: &'a ContactProblem, stiffness: &DMatrix<f64>) -> Self {
        let system = &*problem.system;
        let (stored, mut constants) = stored(problem, stiffness);
        let stiffness = with_exact_kernel(system, stored);
        for (k, gap) in problem.gaps().enumerate().filter(|(_, gap)| *gap != 0.0) {
            let gap = rational(gap);
            constants.iter_mut().zip(&stiffness).for_each(|(constant, row)| *constant -= &row[k] * &gap);
        }
        Self { problem, stiffness, constants, rooms: Vec::new(), whole: OnceLock::new() }
    }

    /// Number of the nonbasic variables that a polyhedron starts with: z of all joints, then e + room of those that have one.
    fn columns(&self) -> usize {
        self.problem.system.joint_count() + self.rooms.len()
    }

    /// Variables: z of all joints, then pair by pair x_n, the reserves of the facets and, in space, the forms of the
    /// slip.
    pub fn variables(&self) -> Vec<PairVariables> {
        let (system, polygon) = (&*self.problem.system, self.problem.polygon);
        let mut next = self.columns();
        let mut take = |count: usize| {
            next += count;
            (next - count..next).collect::<Vec<_>>()
        };
        let of = |(i, pair): (usize, &ContactPair)| PairVariables {
            z_n: i,
            x_n: if pair.law.is_bilateral() { None } else { take(1).pop() },
            tangential: pair.rubs().then(|| {
                let slips: Vec<usize> = pair.tangential.clone().collect();
                let reserves = take(polygon.facets());
                let turns = if slips.len() == 1 { slips.clone() } else { take(polygon.half()) };
                TangentialVariables { slips, reserves, turns, polygon }
            }),
        };
        system.pairs.iter().enumerate().map(of).collect()
    }

    /// What every answer obeys whatever its scheme: all signs but those of the slips, and the `sides` (joint, lowest
    /// and highest displacement) of a box that holds it.
    pub fn polyhedron(&self, sides: &[(usize, f64, f64)], go_on: &mut GoOn) -> (Polyhedron, State) {
        let (system, polygon) = (&*self.problem.system, self.problem.polygon);
        let k = self.columns();
        let mut rows = WholeRows::default();
        let mut free: Vec<usize> = system.pairs.iter().flat_map(|pair| pair.tangential.clone()).collect();
        for (i, pair) in system.pairs.iter().enumerate() {
            if !pair.law.is_bilateral() {
                rows.push_whole(self.form(RowId { pair: i, couple: RowKind::Normal }));
            }
            if !pair.rubs() {
                continue;
            }
            for facet in 0..polygon.facets() as u16 {
                rows.push_whole(self.form(RowId { pair: i, couple: RowKind::Facet(facet) }));
            }
            for form in slip_forms(polygon).into_iter().filter(|_| pair.is_in_space()) {
                let mut row = vec![0.0; k + 1];
                pair.tangential.clone().zip(form).for_each(|(joint, part)| row[joint] = part);
                free.push(k + rows.rows.len());
                rows.push(&row);
            }
        }
        for &(joint, low, high) in sides {
            let mut row = vec![0.0; k + 1];
            for (sign, end) in [(1.0, -low), (-1.0, high)] {
                (row[joint], row[k]) = (sign, end);
                // A normal is ≥ 0 as it is.
                if end.is_finite() && (joint >= system.pair_count() || sign < 0.0) {
                    rows.push(&row);
                }
            }
        }
        for (e, room) in self.rooms.iter().enumerate() {
            let mut row = vec![0.0; k + 1];
            (row[system.joint_count() + e], row[k]) = (-1.0, 2.0 * room);
            rows.push(&row);
        }
        let mut made = Polyhedron::new(k, rows, &free);
        let mut state = made.start(go_on);
        if state == State::Feasible {
            let bilateral = (0..system.pair_count()).filter(|&i| system.pairs[i].law.is_bilateral());
            (state, _) = made.fix_all(bilateral, go_on);
        }
        (made, state)
    }

    /// Rows of R with their constant, as integers over a common denominator.
    fn whole_rows(&self) -> &[(Vec<BigInt>, BigInt)] {
        self.whole.get_or_init(|| {
            let rows = self.stiffness.iter().zip(&self.constants);
            rows.map(|(row, constant)| clear_denominators(&[row, std::slice::from_ref(constant)].concat())).collect()
        })
    }

    /// The force of a row, x_n or a reserve: coefficients over z, the constant last, as integers over a common denominator.
    fn form(&self, row: RowId) -> (Vec<BigInt>, BigInt) {
        let law = &self.problem.laws[row.pair];
        let mut terms: Vec<(usize, f64)> = row.joints(&self.problem.system, self.problem.polygon).collect();
        let mut fixed = 0.0;
        if row.couple != RowKind::Normal {
            terms.push((row.pair, law.friction()));
            fixed = law.fixed_bound();
        }
        terms.retain(|(_, factor)| *factor != 0.0);
        let (k, columns, whole) = (self.stiffness.len(), self.columns(), self.whole_rows());
        let room = |joint: usize, factor: f64| self.rooms.get(joint).map(|room| dyadic::product(factor, *room));
        let exactly = |value: f64| dyadic::product(value, 1.0);
        // What all parts of the sum are integers over: a power of two times what the rows have.
        let exponents =
            terms.iter().flat_map(|&(joint, factor)| room(joint, factor).into_iter().chain([exactly(factor)]));
        let least = exponents.chain([exactly(fixed)]).fold(0, |least, (_, exponent)| exponent.min(least));
        let common = terms.iter().fold(BigInt::one(), |common, (joint, _)| common_multiple(common, &whole[*joint].1));
        let units = |(mantissa, exponent): (i128, i64)| dyadic::shifted(mantissa, exponent - least) * &common;
        let (mut form, mut constant) = (vec![BigInt::zero(); columns], units(exactly(fixed)));
        for &(joint, factor) in &terms {
            let (entries, denominator) = &whole[joint];
            let times = units(exactly(factor)) / denominator;
            let summed = form.iter_mut().zip(&entries[..k]).filter(|(_, entry)| !entry.is_zero());
            summed.for_each(|(sum, entry)| *sum += &times * entry);
            constant += &times * &entries[k];
            if let Some(room) = room(joint, factor) {
                constant -= units(room);
                form[k + joint] += units(exactly(factor));
            }
        }
        form.push(constant);
        (form, common << -least as u64)
    }

    /// RF − R·(g, 0) of each joint, within its `rooms` either way where there are any.
    pub fn constants_within(&self, rooms: &[f64]) -> Vec<Ball> {
        let room = |joint: usize| rooms.get(joint).copied().unwrap_or(0.0);
        self.constants.iter().enumerate().map(|(joint, constant)| Ball::around(constant).within(room(joint))).collect()
    }

    /// How far x_n and the reserves may lie from their forms where the force of each joint may lie as far from its own
    /// as its room.
    pub fn rooms_of(&self, variables: &[PairVariables], rooms: &[f64]) -> Rooms {
        let room = |row: RowId| {
            let friction = (row.couple != RowKind::Normal).then(|| (row.pair, self.problem.laws[row.pair].friction()));
            let terms = row.joints(&self.problem.system, self.problem.polygon).chain(friction);
            terms.map(|(joint, factor)| rational(factor.abs()) * rational(rooms[joint])).sum::<BigRational>()
        };
        let mut all = Vec::new();
        for (pair, of) in variables.iter().enumerate() {
            all.extend(of.x_n.map(|x_n| (x_n, room(RowId { pair, couple: RowKind::Normal }))));
            let reserves = of.tangential.iter().flat_map(|of| of.reserves.iter().enumerate());
            all.extend(reserves.map(|(facet, &at)| (at, room(RowId { pair, couple: RowKind::Facet(facet as u16) }))));
        }
        let (variables, values): (Vec<usize>, Vec<BigRational>) = all.into_iter().unzip();
        let (whole, common) = clear_denominators(&values);
        Rooms { of: variables.into_iter().zip(whole).collect(), common }
    }

    /// λ at z.
    pub fn force(&self, z: &[BigRational]) -> Vec<BigRational> {
        // The constants stand behind the rows.
        let mut point = clear_denominators(z);
        point.0.push(point.1.clone());
        self.whole_rows().iter().map(|row| product(row, &point)).collect()
    }
}

impl PairVariables {
    /// What a scheme of this pair asks for: [`Polyhedron::impose`].
    pub fn impose(
        &self,
        polyhedron: &mut Polyhedron,
        scheme: PairScheme,
        holds: bool,
        go_on: &mut GoOn,
    ) -> (State, Option<usize>) {
        let mut zero = Vec::new();
        if let Some(x_n) = self.x_n {
            zero.push(if scheme.open { x_n } else { self.z_n });
        }
        let Some(of) = &self.tangential else { return polyhedron.fix_all(zero, go_on) };
        // An open pair that nothing holds slips freely: all its reserves are zero, and with two of them the others.
        if scheme.open && !holds {
            zero.extend(of.reserves.iter().take(2));
            return polyhedron.fix_all(zero, go_on);
        }
        if scheme.tangential == Tangential::Stick {
            zero.extend(&of.slips);
            return polyhedron.fix_all(zero, go_on);
        }
        let conditions = scheme.tangential.conditions(of.polygon);
        zero.extend(conditions.reserves.iter().map(|facet| of.reserves[*facet]));
        zero.extend(conditions.zero.iter().map(|form| of.turns[*form]));
        let signs = conditions.signs.into_iter().map(|(form, up)| (of.turns[form], up));
        polyhedron.impose(zero, signs, go_on)
    }
}

/// R and RF as they are stored; of a file with frictionless pairs from its own entries, the released tangential joints
/// condensed out exactly.
fn stored(problem: &ContactProblem, stiffness: &DMatrix<f64>) -> (Vec<Vec<BigRational>>, Vec<BigRational>) {
    let system = &*problem.system;
    let own = || (rational_rows(stiffness), problem.load.iter().map(|entry| rational(*entry)).collect());
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

/// R with Z exactly in its kernel, unless its own digits have as large a kernel already.
fn with_exact_kernel(system: &ContactSystem, mut stored: Vec<Vec<BigRational>>) -> Vec<Vec<BigRational>> {
    let Some((telling, motions)) = telling_joints(&system.kernel) else {
        return stored;
    };
    let mut whole = WholeRows::default();
    stored.iter().for_each(|row| whole.push_rational(row));
    if rank_modulo_prime(&whole.rows) + system.kernel.ncols() > system.joint_count() {
        let exact = |column: usize| motions.column(column).iter().map(|entry| rational(*entry)).collect();
        give_kernel(&mut stored, &telling, &(0..telling.len()).map(exact).collect::<Vec<_>>());
    }
    stored
}

/// Puts motions into the kernel of R: each is 1 at its own joint of P (`telling`) and 0 at the others of P, Z = [G; 1]
/// over the other joints N and P. Only R_NN is taken from what is stored, R_NP = −R_NN G and R_PP = Gᵀ R_NN G, which
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
