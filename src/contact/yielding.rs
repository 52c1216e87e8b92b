//! Contact problems in space whose joints repeat one another: solved with joints that yield a little, which is then
//! taken back.
//!
//! No R gives λ for every z of joints that repeat one another, and friction in space is not a couple of joints that
//! could change sides as in [`super::force_form`]. Joints T that self-stress reaches are given a small compliance ε
//! instead:
//!
//! ```text
//!     y = B p + y₀ + ε λ,     p: z of the independent joints of T,   B = [I; A],   y₀ = (0, h)
//!     λ_T = [N Nᵀ/ε + B G⁻¹ R_PP H Bᵀ] (y − y₀) + B H (R_PN z_N + RF_P),     G = BᵀB,   H = (G + ε R_PP)⁻¹,   BᵀN = 0
//! ```
//! so that R of the yielding system is symmetric, regular where the structure stands, and differs from that of the
//! structure by rounding only in motions that its joints can make. From its answer Newton's method goes on with the joints
//! as they are ([`super::cone::MixedProblem`]); where that leads nowhere multipliers bring it nearer (Hestenes, "Multiplier
//! and gradient methods", 1969): y = B p + y₀ + ε (λ − λ′) with λ′ of the answer before. Where self-stress leaves forces
//! undetermined the first answer is, up to ε, that of least norm, and it stays. Multipliers alone lead on, until λ is λ′,
//! under a load that is none of the cases.

use std::sync::Arc;

use nalgebra::{Cholesky, DMatrix, DVector};

use super::pivoted::orthonormal;
use super::problem::ContactProblem;
use super::sum::Sum;
use super::system::{ContactSystem, JointLoad, Yielding};
use super::written::power_of_two;

/// ε times the largest R_ii: forces lose a factor of some 1e5 in accuracy, and each multiplier gains as much.
const COMPLIANCE: f64 = 1.0 / 131_072.0;
/// A self-stress below this share of the largest belongs to no joint.
pub const FELT: f64 = 1e-9;

/// The yielding system of one whose repeated joints stand in force form.
pub fn yielding(exact: ContactSystem) -> ContactSystem {
    let blocks = Blocks::of(&exact);
    let stiffness = blocks.stiffness();
    let loads: Vec<JointLoad> = exact.loads.iter().map(|load| blocks.load(load, &stiffness)).collect();
    let (joints, compliance) = (blocks.yielding.clone(), blocks.compliance);
    let yielding = Yielding { joints, compliance, exact: Arc::new(exact) };
    let exact = &yielding.exact;
    ContactSystem {
        pairs: exact.pairs.clone(),
        tangents: exact.tangents,
        stiffness,
        loads,
        rounded: true,
        groups: Vec::new(),
        kernel: exact.kernel.clone(),
        corrected: None,
        force_form: None,
        yielding: Some(Box::new(yielding)),
        file: None,
    }
}

/// The mixed matrix of a system, taken apart.
struct Blocks<'a> {
    mixed: &'a DMatrix<f64>,
    /// N: independent joints that nothing repeats.
    others: Vec<usize>,
    /// P, then D.
    yielding: Vec<usize>,
    /// P: the first of them.
    independent: usize,
    compliance: f64,
    /// Orthonormal N: the self-stress of T.
    self_stress: DMatrix<f64>,
    /// H Bᵀ, and B G⁻¹ R_PP H Bᵀ.
    reduced: DMatrix<f64>,
    stretched: DMatrix<f64>,
}

impl<'a> Blocks<'a> {
    fn of(exact: &'a ContactSystem) -> Blocks<'a> {
        let mixed = &exact.stiffness;
        let k = mixed.nrows();
        let repeated: Vec<usize> = (0..k).filter(|&joint| exact.is_forced(joint)).collect();
        let (partners, others): (Vec<usize>, Vec<usize>) = (0..k)
            .filter(|&joint| !exact.is_forced(joint))
            .partition(|&joint| repeated.iter().any(|&one| mixed[(one, joint)] != 0.0));
        let stiffest = others.iter().chain(&partners).map(|&joint| mixed[(joint, joint)]).fold(0.0, f64::max);
        let compliance = if stiffest > 0.0 { power_of_two(COMPLIANCE / stiffest) } else { 1.0 };
        let independent = partners.len();
        let yielding: Vec<usize> = partners.iter().chain(&repeated).copied().collect();
        let compatible = DMatrix::from_fn(yielding.len(), independent, |i, j| match i.checked_sub(independent) {
            None => f64::from(i == j),
            Some(one) => mixed[(repeated[one], partners[j])],
        });
        let own = DMatrix::from_fn(independent, independent, |i, j| mixed[(partners[i], partners[j])]);
        let gram = compatible.tr_mul(&compatible);
        // G ≥ I, so both are well conditioned.
        let solve = |matrix: DMatrix<f64>, right: &DMatrix<f64>| match Cholesky::new(matrix) {
            Some(factor) => factor.solve(right),
            None => DMatrix::from_element(right.nrows(), right.ncols(), f64::NAN),
        };
        let reduced = solve(&gram + compliance * &own, &compatible.transpose());
        let stretched = &compatible * solve(gram, &(own * &reduced));
        let stress = exact.force_form.as_ref().map(|form| &form.self_stress);
        let columns: Vec<DVector<f64>> = (stress.into_iter().flat_map(DMatrix::column_iter))
            .map(|column| DVector::from_iterator(yielding.len(), yielding.iter().map(|&joint| column[joint])))
            .collect();
        let self_stress = orthonormal(&columns, yielding.len());
        Blocks { mixed, others, yielding, independent, compliance, self_stress, reduced, stretched }
    }

    /// R_NP: what the other joints feel of the partners.
    fn coupling(&self) -> DMatrix<f64> {
        DMatrix::from_fn(self.others.len(), self.independent, |i, j| self.mixed[(self.others[i], self.yielding[j])])
    }

    fn stiffness(&self) -> DMatrix<f64> {
        let (coupling, k) = (self.coupling(), self.mixed.nrows());
        // R_NP H R_PN: H is the part of H Bᵀ under the identity of B.
        let inner = self.reduced.columns(0, self.independent).into_owned();
        let relieved = &coupling * inner * coupling.transpose();
        let across = &coupling * &self.reduced;
        let own = &self.self_stress * self.self_stress.transpose() / self.compliance + &self.stretched;
        let mut stiffness = DMatrix::zeros(k, k);
        for (a, &i) in self.others.iter().enumerate() {
            for (b, &j) in self.others.iter().enumerate() {
                let relief = 0.5 * (relieved[(a, b)] + relieved[(b, a)]);
                stiffness[(i, j)] = self.mixed[(i, j)] - self.compliance * relief;
            }
            for (b, &j) in self.yielding.iter().enumerate() {
                (stiffness[(i, j)], stiffness[(j, i)]) = (across[(a, b)], across[(a, b)]);
            }
        }
        for (a, &i) in self.yielding.iter().enumerate() {
            for (b, &j) in self.yielding.iter().enumerate() {
                stiffness[(i, j)] = 0.5 * (own[(a, b)] + own[(b, a)]);
            }
        }
        stiffness
    }

    /// RF of the yielding system: RF of the independent joints through the springs, less what R makes of y₀.
    fn load(&self, load: &JointLoad, stiffness: &DMatrix<f64>) -> JointLoad {
        let coupling = self.coupling();
        let passed_on = self.reduced.transpose();
        let relief = self.compliance * &coupling * self.reduced.columns(0, self.independent);
        let partners = |of: &DVector<f64>| DVector::from_fn(self.independent, |i, _| of[self.yielding[i]]);
        let combined = |of: &DVector<f64>, [passed_on, relief, stiffness]: [&DMatrix<f64>; 3], sign: f64| {
            let (own, mut all) = (partners(of), of.clone());
            let (through, relief) = (passed_on * &own, relief * &own);
            self.others.iter().zip(relief.iter()).for_each(|(&joint, relief)| all[joint] += sign * relief);
            self.yielding.iter().zip(through.iter()).for_each(|(&joint, through)| all[joint] = *through);
            for &one in &self.yielding[self.independent..] {
                all.axpy(sign * of[one], &stiffness.column(one), 1.0);
            }
            all
        };
        JointLoad {
            name: load.name.clone(),
            vector: combined(&load.vector, [&passed_on, &relief, stiffness], -1.0),
            terms: combined(&load.terms, [&passed_on.abs(), &relief.abs(), &stiffness.abs()], 1.0),
        }
    }
}

impl Yielding {
    /// What multipliers λ′ add to the load of the system of this R, and the magnitude of their terms.
    pub fn held_by(&self, stiffness: &DMatrix<f64>, forces: &[Sum]) -> [DVector<f64>; 2] {
        let mut held = [DVector::zeros(stiffness.nrows()), DVector::zeros(stiffness.nrows())];
        for &joint in &self.joints {
            let moved = self.compliance * forces[joint].value;
            held[0].axpy(moved, &stiffness.column(joint), 1.0);
            held[1].axpy(moved.abs(), &stiffness.column(joint).abs(), 1.0);
        }
        held
    }

    /// Whether λ is λ′ to what rounding leaves of it.
    pub fn is_settled(&self, before: &[Sum], forces: &[Sum]) -> bool {
        self.joints.iter().all(|&joint| forces[joint].plus(-1.0, before[joint]).is_zero())
    }

    /// The same problem with joints in force form, where its load is that of the cases.
    pub fn exactly(&self, problem: &ContactProblem) -> Option<ContactProblem> {
        let of_cases = ContactProblem::new(&problem.system, Vec::new(), &problem.factors);
        (!problem.factors.is_empty() && of_cases.load == problem.load)
            .then(|| ContactProblem::new(&self.exact, problem.laws.clone(), &problem.factors))
            .map(|exact| ContactProblem { cone: problem.cone, polygon: problem.polygon, ..exact })
    }

    /// Pairs whose forces a motion z leaves undetermined: those that a self-stress reaches which obeys what the open
    /// and the slipping pairs demand. With `sticking` none slips: where another self-stress may hold another motion.
    pub fn undetermined(&self, problem: &ContactProblem, z: &DVector<f64>, sticking: bool) -> Vec<usize> {
        let Some(form) = &self.exact.force_form else { return Vec::new() };
        let (stress, system) = (&form.self_stress, &self.exact);
        let mut demands: Vec<DVector<f64>> = Vec::new();
        let mut demand = |terms: &[(usize, f64)]| {
            let row = terms.iter().fold(DVector::zeros(stress.ncols()), |sum: DVector<f64>, &(joint, factor)| {
                sum + factor * stress.row(joint).transpose()
            });
            demands.push(row);
        };
        for (i, pair) in system.pairs.iter().enumerate() {
            let (law, slip) = (&problem.laws[i], pair.slip(z));
            let (open, size) = (z[i] > 0.0, slip[0].hypot(slip[1]));
            if open {
                demand(&[(i, 1.0)]);
            }
            if open || (law.friction() == 0.0 && law.fixed_bound() == 0.0) {
                pair.tangential.clone().for_each(|joint| demand(&[(joint, 1.0)]));
            } else if !sticking && size > 0.0 && problem.cone {
                let pressed = slip.map(|slip| law.friction() * slip / size);
                (pair.tangential.clone().zip(pressed)).for_each(|(joint, f)| demand(&[(joint, 1.0), (i, f)]));
            } else if !sticking {
                let slips = problem.polygon.slips(slip).into_iter().enumerate();
                for (facet, _) in slips.filter(|(_, slip)| *slip > 0.0) {
                    let along = pair.tangential.clone().zip(problem.polygon.direction(facet));
                    demand(&along.chain([(i, law.friction())]).collect::<Vec<_>>());
                }
            }
        }
        let demands = orthonormal(&demands, stress.ncols());
        let left = DMatrix::identity(stress.ncols(), stress.ncols()) - &demands * demands.transpose();
        let left: Vec<DVector<f64>> =
            left.column_iter().map(|column| column.into_owned()).filter(|column| column.norm() > FELT).collect();
        let free = stress * orthonormal(&left, stress.ncols());
        let largest = free.amax();
        let felt = |joint: usize| free.row(joint).iter().any(|entry| entry.abs() > FELT * largest);
        (0..system.pairs.len()).filter(|&i| felt(i) || system.pairs[i].tangential.clone().any(felt)).collect()
    }
}
