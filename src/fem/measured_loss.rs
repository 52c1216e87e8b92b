//! What the R of the f64 factor lost where an estimate of its rounding cannot tell: measured on a few dislocations, against
//! K in doubled precision, and given back.
//!
//! The estimate of [`MainSystem::take_loads`] counts the rounding of every term of uᵀ K u; in plates of long
//! elements those are large, and the errors of neighbours cancel. What counts is what R is used for: rows of R z, in
//! which every zero test allows for rounding of the size √R_jj Σ_k √R_kk |z_k| (method §4, "Zero").

use nalgebra::{DMatrix, DVector};
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
const RANDOM: usize = 3;

/// A round of corrections leads on if it leaves at most this share of what was lost: the loss is of few directions then.
const PROGRESS: f64 = 0.1;

impl MainSystem {
    /// Makes every row of R z right, up to [`BELIEVED`], where a few directions hold all that R lost: long parts of many
    /// elements turn and bend as a whole, which the rounding of the entries of K resists. The range of the loss E is found
    /// from E z of random dislocations (Halko, Martinsson, Tropp 2011, 4.1), each joint by as much as its own stiffness
    /// bears. R then takes the exact forces of these directions and is otherwise changed as little as that allows (Powell
    /// 1970). Whether that is enough, dislocations tell that R has not seen. `false` if a round does
    /// not help, or more would have to be solved for than R has columns.
    ///
    /// # Errors
    /// Interrupted.
    pub(super) fn correct_stiffness(
        &mut self,
        structure: &Structure,
        watch: &dyn Watch,
    ) -> Result<bool, MainSystemError> {
        let (mut taken, mut last) = (0, f64::INFINITY);
        for round in 0.. {
            let sizes = self.r.diagonal().map(|stiffness| stiffness.max(0.0).sqrt());
            let own = sizes.map(|size| if size > 0.0 { size.recip() } else { 0.0 });
            let scaled = |mut columns: DMatrix<f64>| {
                columns.column_iter_mut().for_each(|mut column| column.component_mul_assign(&own));
                columns
            };
            let test = self.without_kernel(scaled(shapes(self.joints.len(), round)));
            let Some(lost) = self.lost(&test, structure, watch)? else { return Ok(false) };
            let share = share_of_believed(&lost, &test, &sizes);
            if share <= 1.0 {
                return Ok(true);
            }
            taken += 2 * test.ncols();
            // NaN is not less.
            let leads_on = share < last * PROGRESS && share.is_finite();
            if taken + test.ncols() > self.joints.len() || !leads_on {
                return Ok(false);
            }
            last = share;
            let directions = scaled(lost).qr().q();
            let Some(lost) = self.lost(&self.without_kernel(scaled(directions.clone())), structure, watch)? else {
                return Ok(false);
            };
            let lost = scaled(lost);
            let inner = directions.transpose() * &lost;
            let half = lost - &directions * (&inner + inner.transpose()) * 0.25;
            let change = half * directions.transpose();
            for i in 0..sizes.len() {
                for j in 0..sizes.len() {
                    self.r[(i, j)] += sizes[i] * sizes[j] * (change[(i, j)] + change[(j, i)]);
                }
            }
            self.project();
        }
        Ok(false)
    }

    /// The forces that dislocations, the columns, take by K in doubled precision, less those by R.
    ///
    /// # Errors
    /// Interrupted.
    fn lost(
        &mut self,
        z: &DMatrix<f64>,
        structure: &Structure,
        watch: &dyn Watch,
    ) -> Result<Option<DMatrix<f64>>, MainSystemError> {
        let idle = vec![0.0; self.dofs.count()];
        let joints = z.nrows();
        let columns = (0..z.ncols()).map(|column| &z.as_slice()[joints * column..joints * (column + 1)]);
        let fields: Vec<Field> = columns.map(|z| Field { f: &idle, settled: None, z }).collect();
        let forces = self.refinement(structure, watch)?.joint_forces(&fields, watch)?;
        Ok(forces.map(|forces| DMatrix::from_columns(&forces) - &self.r * z))
    }

    /// Dislocations without what no force feels.
    fn without_kernel(&self, z: DMatrix<f64>) -> DMatrix<f64> {
        let free = &self.z * (self.z.transpose() * &z);
        z - free
    }
}

/// By how much the forces that `lost` dislocations `z` exceed what is believed of them, the most of any row.
fn share_of_believed(lost: &DMatrix<f64>, z: &DMatrix<f64>, sizes: &DVector<f64>) -> f64 {
    let shares = std::iter::zip(lost.column_iter(), z.column_iter()).flat_map(|(lost, z)| {
        let believed = BELIEVED * sizes.dot(&z.abs());
        let share =
            move |joint: usize| if lost[joint] == 0.0 { 0.0 } else { lost[joint].abs() / (believed * sizes[joint]) };
        (0..z.len()).map(share).collect::<Vec<f64>>()
    });
    // NaN stays.
    shares.fold(0.0, |worst: f64, share| if worst.is_nan() || share <= worst { worst } else { share })
}

/// Dislocations that R is measured on, other random ones in each round, as the columns: each joint's relative to what
/// costs it as much as others.
fn shapes(joints: usize, round: u64) -> DMatrix<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(round);
    // Box and Muller 1958.
    let mut normal = || {
        let (radius, turn): (f64, f64) = (1.0 - random.random::<f64>(), random.random());
        (-2.0 * radius.ln()).sqrt() * (std::f64::consts::TAU * turn).cos()
    };
    DMatrix::from_fn(joints, RANDOM + 2, |i, column| match column {
        RANDOM.. if column == RANDOM => 1.0,
        RANDOM.. => (i as f64 + 0.5) / joints as f64 - 0.5,
        _ => normal(),
    })
}
