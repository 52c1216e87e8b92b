//! The way back from the joints to the displacements of the nodes.

use nalgebra::DVector;

use super::assembly::on_masters;
use super::displacements::{Displacements, Tail};
use super::main_system::MainSystem;
use super::refinement::{Field, Refinement};
use crate::doubled::{Doubled, Real};
use crate::model::vector::length;
use crate::watch::Quiet;

impl MainSystem {
    /// u under Σ factor·F and the mutual displacements `z` of all joints (the whole mutual displacement B u: with
    /// an initial gap g it is z_n − g); those of repeated joints follow from the others.
    ///
    /// # Panics
    /// If there are not as many factors as load cases and as many z as joints.
    pub fn displacements(&self, factors: &[f64], z: &DVector<f64>) -> Displacements {
        let z = &self.of_independent(z);
        if let Some(k) = &self.doubled {
            let refinement = Refinement { dofs: &self.dofs, k, elimination: &self.elimination, factor: &self.factor };
            let f = sum_of_cases(self.f.iter().map(Some), factors).unwrap_or_default();
            let settled = self.settlement(factors);
            let field = Field { f: &f, settled: settled.as_deref(), z: z.as_slice() };
            // R and RF came from the same equations, so these converge too.
            if let Ok(Some((u, error))) = refinement.displacements(field, &Quiet) {
                let part = |part: fn(Doubled) -> f64| {
                    let u: Vec<f64> = u.iter().map(|&u| part(u)).collect();
                    self.dofs.scatter(&u)
                };
                return Displacements(part(Real::to_f64), Some(Tail { values: part(Doubled::tail), error }));
            }
        }
        Displacements(self.dofs.scatter(&self.plain_displacements(factors, z)), None)
    }

    /// Σ factor·S s on the base dofs; `None` if no support settles.
    pub(super) fn settlement(&self, factors: &[f64]) -> Option<Vec<f64>> {
        sum_of_cases(self.settled.iter().map(Option::as_ref), factors)
    }

    /// The base dofs from the f64 factor, with one step of refinement: then the error of each equation is a few ε of
    /// the terms of that equation (Skeel 1980), not of the largest of all.
    pub(super) fn plain_displacements(&self, factors: &[f64], z: &DVector<f64>) -> Vec<f64> {
        let RightSide { f, settled, mut v } = self.loaded(factors, z);
        self.factor.solve(&mut v);
        let u = self.elimination.expand(&v, z.as_slice());
        let mut rest = self.k.times(&u);
        for (rest, f) in std::iter::zip(&mut rest, &f) {
            *rest = f - *rest;
        }
        let mut correction = on_masters(&self.elimination, &rest);
        self.factor.solve(&mut correction);
        for (v, correction) in std::iter::zip(&mut v, correction) {
            *v += correction;
        }
        self.expanded(&v, z, settled.as_deref())
    }

    /// The base dofs of several states, (factors, z) each, from the f64 factor as it is.
    pub(super) fn unrefined_displacements(&self, states: &[(&[f64], DVector<f64>)]) -> Vec<Vec<f64>> {
        let loaded: Vec<RightSide> = states.iter().map(|(factors, z)| self.loaded(factors, z)).collect();
        let (mut right, settled): (Vec<_>, Vec<_>) = loaded.into_iter().map(|state| (state.v, state.settled)).unzip();
        self.factor.solve_many(&mut right);
        let all = right.iter().zip(states).zip(settled);
        all.map(|((v, (_, z)), settled)| self.expanded(v, z, settled.as_deref())).collect()
    }

    /// The right side of K_m v = Tᵀ (F − K S s) − C z, in place of v.
    fn loaded(&self, factors: &[f64], z: &DVector<f64>) -> RightSide {
        assert_eq!(z.len(), self.joints.len(), "a z for every joint");
        assert_eq!(factors.len(), self.f.len(), "a factor for every load case");
        let mut f = sum_of_cases(self.f.iter().map(Some), factors).unwrap_or_else(|| vec![0.0; self.dofs.count()]);
        let settled = self.settlement(factors);
        if let Some(settled) = &settled {
            for (f, k) in std::iter::zip(&mut f, self.k.times(settled)) {
                *f -= k;
            }
        }
        let mut v = on_masters(&self.elimination, &f);
        for &(row, joint, value) in &self.c {
            v[row as usize] -= value * z[joint as usize];
        }
        RightSide { f, settled, v }
    }

    /// u = T v + G z + S s.
    fn expanded(&self, v: &[f64], z: &DVector<f64>, settled: Option<&[f64]>) -> Vec<f64> {
        let mut u = self.elimination.expand(v, z.as_slice());
        for (u, settled) in std::iter::zip(&mut u, settled.into_iter().flatten()) {
            *u += settled;
        }
        u
    }

    /// z (lengths) of the [repeated](Self::repeated) joints under each load case per unit factor where no independent
    /// joint moves: what supports that settle make of them.
    pub fn repeated_offsets(&self) -> Vec<Vec<f64>> {
        let of = |settled: &Option<Vec<f64>>, joint: usize| {
            let Some(settled) = settled else { return 0.0 };
            let mut z = 0.0;
            self.each_term(&self.all_joints[joint], |dof, a| z += a * settled[dof]);
            z
        };
        self.settled.iter().map(|case| self.repeated.iter().map(|joint| of(case, joint.joint)).collect()).collect()
    }

    /// Largest difference of a repeated joint's z from B u, as a share of the displacements of its nodes. Nodes at rest
    /// have the rounding of the largest displacement, and of the largest of the `terms` that each z is the sum of.
    pub fn compatibility_residual(&self, u: &Displacements, z: &DVector<f64>, terms: &DVector<f64>) -> f64 {
        if self.repeated.is_empty() {
            return 0.0;
        }
        let length = |&[x, y, z, ..]: &[f64; 6]| length([x, y, z]);
        let rounding = 64.0 * f64::EPSILON * u.0.iter().map(length).fold(terms.amax(), f64::max);
        let share = |joint: usize| {
            let (mut rest, mut size) = (z[joint], z[joint].abs());
            for (node, a) in &self.all_joints[joint].terms {
                rest -= std::iter::zip(a, &u.0[*node]).map(|(a, u)| a * u).sum::<f64>();
                size += length(&u.0[*node]);
            }
            if rest.abs() <= rounding { 0.0 } else { rest.abs() / size }
        };
        self.repeated.iter().map(|repeated| share(repeated.joint)).fold(0.0, f64::max)
    }

    /// The entries of the independent joints of a vector over all joints.
    pub(super) fn of_independent(&self, z: &DVector<f64>) -> DVector<f64> {
        assert_eq!(z.len(), self.all_joints.len(), "a z for every joint");
        DVector::from_iterator(self.independent.len(), self.independent.iter().map(|&joint| z[joint]))
    }
}

/// What stands on the right side of the equations of the main system.
struct RightSide {
    /// F − K S s on the base dofs.
    f: Vec<f64>,
    /// S s, where supports settle.
    settled: Option<Vec<f64>>,
    /// On the masters.
    v: Vec<f64>,
}

/// Σ factor·vector over the load cases that have one; `None` if none does.
fn sum_of_cases<'a>(cases: impl Iterator<Item = Option<&'a Vec<f64>>>, factors: &[f64]) -> Option<Vec<f64>> {
    let mut sum: Option<Vec<f64>> = None;
    for (case, factor) in cases.zip(factors) {
        let Some(case) = case else { continue };
        let sum = sum.get_or_insert_with(|| vec![0.0; case.len()]);
        for (sum, value) in std::iter::zip(sum, case) {
            *sum += factor * value;
        }
    }
    sum
}
