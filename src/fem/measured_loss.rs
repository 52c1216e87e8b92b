//! Whether the R of the f64 factor can be believed where an estimate of its rounding cannot tell: measured on a few
//! dislocations, against K in doubled precision.
//!
//! The estimate of [`MainSystem::take_loads`] counts the rounding of every term of uᵀ K u; in plates of long
//! elements those are large, and the errors of neighbours cancel. What counts is what R is used for: rows of R z, in
//! which every zero test allows for rounding of the size √R_jj Σ_k √R_kk |z_k| (method §4, "Zero").

use nalgebra::DVector;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::error::MainSystemError;
use super::main_system::MainSystem;
use super::refinement::Field;
use crate::model::structure::Structure;
use crate::watch::Watch;

/// R z is believed up to this share of √R_jj Σ_k √R_kk |z_k| in every row j: a quarter of what is noise in the pivots.
pub(super) const BELIEVED: f64 = 64.0 * f64::EPSILON;

/// Random dislocations, normally distributed. An error b of a row gives |bᵀ ω| ≤ ‖b‖/10 for all of three by chance in
/// less than one of a thousand cases (Halko, Martinsson, Tropp 2011, lemma 4.1).
const RANDOM: u32 = 3;

impl MainSystem {
    /// Whether every row of R z is right, up to [`BELIEVED`], for random dislocations z, each joint by as much as its
    /// own stiffness bears, and for the smooth ones that cost least: all joints alike, and more and more along them.
    ///
    /// # Errors
    /// Interrupted.
    pub(super) fn stiffness_is_right(
        &mut self,
        structure: &Structure,
        watch: &dyn Watch,
    ) -> Result<bool, MainSystemError> {
        let sizes = self.r.diagonal().map(|stiffness| stiffness.max(0.0).sqrt());
        let idle = vec![0.0; self.dofs.count()];
        let dislocations = self.dislocations();
        let fields: Vec<Field> =
            dislocations.iter().map(|z| Field { f: &idle, settled: None, z: z.as_slice() }).collect();
        let Some(forces) = self.refinement(structure, watch)?.joint_forces(&fields, watch)? else { return Ok(false) };
        // NaN is not right.
        Ok(std::iter::zip(&dislocations, forces).all(|(z, exact)| {
            let (plain, bearable) = (&self.r * z, BELIEVED * sizes.dot(&z.abs()));
            (0..z.len()).all(|joint| (plain[joint] - exact[joint]).abs() <= bearable * sizes[joint])
        }))
    }

    /// The dislocations that R is measured on, none of them in the kernel.
    fn dislocations(&self) -> Vec<DVector<f64>> {
        let k = self.joints.len();
        let own = self.r.diagonal().map(|stiffness| if stiffness > 0.0 { stiffness.sqrt().recip() } else { 0.0 });
        let mut random = ChaCha8Rng::seed_from_u64(0);
        // Box and Muller 1958.
        let mut normal = || {
            let (radius, turn): (f64, f64) = (1.0 - random.random::<f64>(), random.random());
            (-2.0 * radius.ln()).sqrt() * (std::f64::consts::TAU * turn).cos()
        };
        let random = (0..RANDOM).map(|_| DVector::from_fn(k, |_, _| normal()));
        let along = DVector::from_fn(k, |i, _| (i as f64 + 0.5) / k as f64 - 0.5);
        let shapes = random.chain([DVector::repeat(k, 1.0), along]);
        shapes
            .map(|shape| {
                let z = shape.component_mul(&own);
                &z - &self.z * (self.z.transpose() * &z)
            })
            .collect()
    }
}
