//! The straight way of the loads through a stage, and of the gaps while parts with interference are put together.

use nalgebra::DVector;

use crate::contact::system::{ContactSystem, JointLoad};

/// Everything that is given moves in proportion from t = 0 to t = 1.
pub(super) struct Course {
    /// Factors of the load cases at both ends.
    pub(super) factors: [Vec<f64>; 2],
    /// Gaps of the pairs at both ends.
    pub(super) gaps: [Vec<f64>; 2],
}

fn between(ends: &[Vec<f64>; 2], t: f64) -> Vec<f64> {
    let mix = |(a, b): (&f64, &f64)| if t == 1.0 { *b } else { a + t * (b - a) };
    ends[0].iter().zip(&ends[1]).map(mix).collect()
}

impl Course {
    /// Factors of the load cases at t.
    pub(super) fn factors_at(&self, t: f64) -> Vec<f64> {
        between(&self.factors, t)
    }

    /// Gaps at t.
    pub(super) fn gaps_at(&self, t: f64) -> Vec<f64> {
        between(&self.gaps, t)
    }

    /// RF − R·(g, 0) at t, over the joints.
    pub(super) fn load_at(&self, system: &ContactSystem, t: f64) -> DVector<f64> {
        load(system, &self.factors_at(t), &self.gaps_at(t))
    }

    /// Σ |terms| of the load at t.
    pub(super) fn sizes_at(&self, system: &ContactSystem, t: f64) -> DVector<f64> {
        sizes(system, &self.factors_at(t), &self.gaps_at(t))
    }

    fn increments(ends: &[Vec<f64>; 2]) -> Vec<f64> {
        ends[0].iter().zip(&ends[1]).map(|(a, b)| b - a).collect()
    }

    /// The load's rate, per unit of t.
    pub(super) fn rate(&self, system: &ContactSystem) -> DVector<f64> {
        load(system, &Self::increments(&self.factors), &Self::increments(&self.gaps))
    }

    /// Σ |terms| of the load's rate.
    pub(super) fn rate_sizes(&self, system: &ContactSystem) -> DVector<f64> {
        sizes(system, &Self::increments(&self.factors), &Self::increments(&self.gaps))
    }
}

/// Σ factor·RF − R·(g, 0).
fn load(system: &ContactSystem, factors: &[f64], gaps: &[f64]) -> DVector<f64> {
    sum(system, factors, gaps, |load| &load.vector, |value| value)
}

/// Σ |terms| of that: RF of a case was itself summed from larger ones.
fn sizes(system: &ContactSystem, factors: &[f64], gaps: &[f64]) -> DVector<f64> {
    sum(system, factors, gaps, |load| &load.terms, f64::abs)
}

fn sum(
    system: &ContactSystem,
    factors: &[f64],
    gaps: &[f64],
    of_case: impl Fn(&JointLoad) -> &DVector<f64>,
    term: impl Fn(f64) -> f64,
) -> DVector<f64> {
    let mut sum = DVector::zeros(system.joint_count());
    let cases = system.loads.iter().zip(factors).map(|(load, factor)| (of_case(load).column(0), *factor));
    let columns = gaps.iter().enumerate().map(|(i, gap)| (system.stiffness.column(i), -gap));
    for (column, factor) in cases.chain(columns) {
        if factor != 0.0 {
            sum.zip_apply(&column, |sum: &mut f64, entry: f64| *sum += term(entry * factor));
        }
    }
    sum
}
