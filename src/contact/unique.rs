//! A bound of friction below which a system has at most one answer, whatever its loads and gaps.
//!
//! Two states that obey the laws under the same load differ by v over the joints, their forces by R v. In every pair
//! ```text
//!   Δx_n Δz_n ≤ 0,      Δx_τ Δz_τ ≤ (r' − r)(|z_τ| − |z_τ'|) ≤ f |Δx_n| |Δz_τ|        (r = f x_n + c)
//! ```
//! so with any weight s > 0 on the normal joints, P = diag(s, 1), and any α > 0
//! ```text
//!   vᵀ P R v  ≤  Σ f_i |(R v)_n,i| |v_τ,i|  ≤  ½ Σ f_i (α (R v)_n,i² + v_τ,i² / α)
//! ```
//! Where the matrix A = ½ (P R + R P) − ½ R_n F R_nᵀ α − ½ F / α of the difference of both sides is positive definite,
//! but for the kernel of R, there is no such v outside the kernel: the forces are the only ones. Everything is scaled to a
//! unit diagonal of R before; s and α are chosen so that the bound is large. A larger weight on the normals helps the
//! more, the less tangential and normal joints feel one another (R_nτ).

use nalgebra::{DMatrix, DVector};

use super::problem::ContactProblem;
use super::system::ContactSystem;
use stickslip_numerics::decompositions::Cholesky;

/// Weights of the normal joints that are tried.
const WEIGHTS: [f64; 6] = [1.0, 3.0, 10.0, 30.0, 100.0, 300.0];
/// Steps of the power iteration for the eigenvalues from which the weight is chosen; nothing is proved by them.
const STEPS: usize = 12;
/// A matrix of unit size whose Cholesky factorization works after (this · n² ε) was taken from its diagonal is positive
/// definite (Rump, *Verification of positive definiteness*, 2006), the rounding of its entries included.
const ROUNDING: f64 = 8.0;

/// R of unit diagonal with the best weight.
#[derive(Clone, Debug)]
struct Form {
    stiffness: DMatrix<f64>,
    /// √(R_nn / R_ττ) of every pair: what its friction is multiplied by.
    stretch: Vec<f64>,
    /// ½ (P R + R P).
    weighted: DMatrix<f64>,
    /// Z, its columns of length one; no columns where R has no kernel.
    kernel: DMatrix<f64>,
    alpha: f64,
}

/// Whether the problem, whatever its load and its gaps, is proved to have at most one state of forces.
pub fn is_unique(problem: &ContactProblem) -> bool {
    let system = &*problem.system;
    if system.force_form.is_some() {
        return false;
    }
    let frictions = problem.frictions();
    Form::of(system, &frictions).is_some_and(|form| form.proves(system, &frictions))
}

impl Form {
    /// The form with the weight and the α under which the bound is largest in the direction of `frictions`; `None`
    /// where R itself is not positive definite outside its kernel.
    fn of(system: &ContactSystem, frictions: &[f64]) -> Option<Form> {
        let stiffness = system.pivot_stiffness();
        let k = system.joint_count();
        let size = |joint: usize| {
            let own = stiffness[(joint, joint)];
            if own > 0.0 { own.sqrt().recip() } else { 1.0 }
        };
        let sizes: Vec<f64> = (0..k).map(size).collect();
        let scaled = DMatrix::from_fn(k, k, |i, j| sizes[i] * stiffness[(i, j)] * sizes[j]);
        let mut kernel = DMatrix::from_fn(k, system.kernel.ncols(), |i, j| system.kernel[(i, j)] / sizes[i]);
        kernel.column_iter_mut().for_each(|mut motion| {
            motion.normalize_mut();
        });
        let stretch: Vec<f64> = (system.pairs.iter().enumerate())
            .map(|(i, pair)| pair.plane_tangential().map_or(0.0, |joint| sizes[joint] / sizes[i]))
            .collect();
        let form = |weight: f64| {
            let normals = system.pair_count();
            let of = |joint: usize| if joint < normals { weight } else { 1.0 };
            let weighted = DMatrix::from_fn(k, k, |i, j| 0.5 * (of(i) + of(j)) * scaled[(i, j)]);
            Form { stiffness: scaled.clone(), stretch: stretch.clone(), weighted, kernel: kernel.clone(), alpha: 1.0 }
        };
        let mut best: Option<(f64, Form)> = None;
        for weight in WEIGHTS {
            let mut form = form(weight);
            let Some([forces, slips]) = form.largest(system, frictions) else { continue };
            if forces > 0.0 && slips > 0.0 {
                form.alpha = (slips / forces).sqrt();
            }
            let bound = (forces * slips).sqrt();
            if best.as_ref().is_none_or(|(least, _)| bound < *least) {
                best = Some((bound, form));
            }
        }
        best.map(|(_, form)| form)
    }

    /// Estimates of the largest eigenvalues of R_n F R_nᵀ and of F relative to the weighted R; `None` where that is not
    /// positive definite.
    fn largest(&self, system: &ContactSystem, frictions: &[f64]) -> Option<[f64; 2]> {
        let factor = Cholesky::new(&(&self.weighted + &self.kernel * self.kernel.transpose()))?;
        let k = self.weighted.nrows();
        let forces = |v: &DVector<f64>| {
            let mut pressed = &self.stiffness * v;
            for joint in 0..k {
                pressed[joint] *= frictions.get(joint).zip(self.stretch.get(joint)).map_or(0.0, |(f, s)| f * s);
            }
            &self.stiffness * pressed
        };
        let slips = |v: &DVector<f64>| {
            let mut slipped = DVector::zeros(k);
            for (i, pair) in system.pairs.iter().enumerate() {
                if let Some(joint) = pair.plane_tangential() {
                    slipped[joint] = frictions[i] * self.stretch[i] * v[joint];
                }
            }
            slipped
        };
        let largest = |apply: &dyn Fn(&DVector<f64>) -> DVector<f64>| {
            // Alternating signs and a constant part: near no eigenvector.
            let mut v = DVector::from_fn(k, |i, _| 1.0 + 0.5 * f64::from((i % 7) as u32) - f64::from((i % 2) as u32));
            let mut value = 0.0;
            for _ in 0..STEPS {
                v.normalize_mut();
                v = apply(&v);
                factor.solve(v.as_mut_slice());
                value = v.norm();
                if value == 0.0 {
                    break;
                }
            }
            value
        };
        Some([largest(&forces), largest(&slips)])
    }

    /// Whether A is positive definite under these frictions.
    fn proves(&self, system: &ContactSystem, frictions: &[f64]) -> bool {
        let k = self.weighted.nrows();
        let mut a = self.weighted.clone();
        let columns: Vec<usize> = (0..frictions.len()).filter(|&i| frictions[i] * self.stretch[i] > 0.0).collect();
        if !columns.is_empty() {
            let share = |i: usize| frictions[i] * self.stretch[i];
            let pressed = DMatrix::from_fn(k, columns.len(), |row, c| {
                let i = columns[c];
                self.stiffness[(row, i)] * (0.5 * self.alpha * share(i)).sqrt()
            });
            a -= &pressed * pressed.transpose();
            for &i in &columns {
                if let Some(joint) = system.pairs[i].plane_tangential() {
                    a[(joint, joint)] -= 0.5 * share(i) / self.alpha;
                }
            }
        }
        let size = a.diagonal().amax().max(self.weighted.diagonal().amax());
        let rounding = ROUNDING * (k * k) as f64 * f64::EPSILON * size;
        if self.kernel.ncols() > 0 {
            // The motions of the kernel must cost nothing in A either: then A + Z Zᵀ shows the others alone.
            if (&a * &self.kernel).amax() > rounding {
                return false;
            }
            a += &self.kernel * self.kernel.transpose();
        }
        for joint in 0..k {
            a[(joint, joint)] -= rounding;
        }
        Cholesky::new(&a).is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::full_lcp::tests::{coulomb, plain};
    use crate::contact::law::PairLaw;

    /// One pair: the answer is unique for every load just where f < R_ττ / |R_nτ| (Klarbring 1990). Nothing is claimed
    /// beyond.
    #[test]
    fn of_one_pair_no_more_is_proved_than_holds() {
        for coupling in [0.05, 0.3, 0.6, -0.3] {
            let system = coulomb(DMatrix::from_row_slice(2, 2, &[1.0, coupling, coupling, 1.0]));
            let critical = 1.0 / f64::abs(coupling);
            let mut largest = 0.0;
            for step in 1..80 {
                let f = 0.025 * f64::from(step) * critical;
                if is_unique(&plain(&system, f, &[1.0, 0.0])) {
                    largest = f64::max(largest, f);
                }
            }
            assert!(largest < critical, "{coupling}: {largest} of {critical}");
            assert!(largest > 0.8 * critical, "{coupling}: {largest} of {critical}");
        }
    }

    /// Normal and tangential joints that do not feel one another: the answer is unique under any friction.
    #[test]
    fn without_coupling_much_friction_is_proved() {
        let chain = |i: usize, j: usize| match i.abs_diff(j) {
            0 => 2.0,
            1 => -0.9,
            _ => 0.0,
        };
        let r = DMatrix::from_fn(8, 8, |i, j| if (i < 4) == (j < 4) { chain(i % 4, j % 4) } else { 0.0 });
        let problem = plain(&coulomb(r), 2.0, &[1.0; 8]);
        assert!(is_unique(&problem));
        let less = ContactProblem { laws: vec![PairLaw::rubbing(0.3, 0.0, 0.0); 4], ..problem };
        assert!(is_unique(&less));
        // Without friction the kernel does no harm to the forces.
        let mut free = DMatrix::identity(4, 4);
        (free[(0, 1)], free[(1, 0)]) = (-1.0, -1.0);
        let mut system = coulomb(free);
        system.kernel = DMatrix::from_column_slice(4, 1, &[0.5_f64.sqrt(), 0.5_f64.sqrt(), 0.0, 0.0]);
        assert!(is_unique(&plain(&system, 0.0, &[1.0; 4])));
        // Both pairs slip freely along the kernel: nothing bounds the slip that friction turns into pressure.
        let mut slides = system.clone();
        slides.kernel = DMatrix::from_column_slice(4, 1, &[0.0, 0.0, 0.5_f64.sqrt(), 0.5_f64.sqrt()]);
        slides.stiffness = DMatrix::from_row_slice(
            4,
            4,
            &[1.0, 0.0, 0.1, -0.1, 0.0, 1.0, 0.1, -0.1, 0.1, 0.1, 1.0, -1.0, -0.1, -0.1, -1.0, 1.0],
        );
        assert!(!is_unique(&plain(&slides, 0.01, &[1.0; 4])));
    }
}
