//! Schemes of a rate problem that leave a motion of the kernel to itself.
//!
//! Where pairs open or slip so that a body can move without strain, the equations of the scheme are singular, and what their
//! rounding makes of them are rates of any size: the load's rate divided by a stiffness that is rounding. Either the motion is
//! not driven, and its rate is 0 for all that is known, or nothing balances the load's rate and there are no rates.

use nalgebra::DVector;

use super::rate_problem::{RateProblem, Rates, moved, terms};
use super::standing::Standing;
use crate::contact::sum::{HIDDEN, LAW_ROUNDING};
use crate::lcp::problem::NOISE;

impl RateProblem<'_> {
    /// The motion that the scheme of these rates leaves to itself and that drives them; `None` where all that they obey holds
    /// without it.
    pub(super) fn unresisted(&self, standing: &Standing, rates: &Rates) -> Option<DVector<f64>> {
        let (laws, released) = (self.laws, &self.released);
        let moving = rates.moving.iter().map(|row| moved(laws, *row).0);
        let Some((joints, loose)) = released.loose_with(&laws.problem.system, moving) else {
            return self.beyond_measure(rates).then(|| rates.z.clone());
        };
        let mut motion = DVector::zeros(rates.z.len());
        let part = DVector::from_fn(joints.len(), |at, _| rates.z[joints[at]]);
        let along = &loose * loose.tr_mul(&part);
        joints.iter().zip(along.iter()).for_each(|(&joint, rate)| motion[joint] = *rate);
        let z = &rates.z - &motion;
        let (force, sizes) = (laws.force(&z, self.rate), laws.force_sizes(&z, self.sizes));
        let balances = |terms: &[(usize, f64)]| {
            let sum = |of: &DVector<f64>| terms.iter().map(|(joint, by)| by * of[*joint]).sum::<f64>();
            let size: f64 = terms.iter().map(|(joint, by)| (by * sizes[*joint]).abs()).sum();
            sum(&force).abs() <= NOISE * size
        };
        let is_driven = released.joints.iter().any(|&joint| !balances(&[(joint, 1.0)]))
            || rates.moving.iter().any(|row| !balances(&terms(laws, *row, standing.is_open(row.pair))));
        is_driven.then_some(motion)
    }

    /// Whether the terms of the forces that these rates give exceed the load's rate so much that rounding hides it: next to
    /// nothing resists them.
    fn beyond_measure(&self, rates: &Rates) -> bool {
        let sizes = self.laws.force_sizes(&rates.z, self.sizes);
        LAW_ROUNDING * sizes.amax() > HIDDEN * self.sizes.amax()
    }
}
