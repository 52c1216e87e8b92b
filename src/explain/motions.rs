//! The motions that cost no energy as a sparse table: what each does to each joint, with the rounding it carries.
//!
//! For a structure the motions are those of its loose parts, so a joint moves with the few parts that meet there; for
//! a contact system read from a file they are the columns of its kernel.

use nalgebra::{DMatrix, DVector};

use super::exact_motions::{ZERO, exact_motions};
use super::kernel::clean;
use crate::contact::sum::Sum;
use crate::contact::system::ContactSystem;
use crate::fem::MainSystem;
use crate::lcp::exact::dyadic::Dyadic;
use crate::lcp::problem::NOISE;
use crate::model::pair::joints;
use crate::model::structure::Structure;

/// A motion found as an eigenvector is known to about this share of its largest displacement: the rounding of R over
/// the distance of its zero eigenvalue to the next (1e-16 / 1e-10).
const EIGENVECTOR: f64 = 1e-6;

/// An entry of a motion below this share of its largest is rounding.
const ROUNDING: f64 = 1e-11;

/// A motion over the joints scaled to largest 1, without what is rounding; a motion of zeros as it is.
pub fn direction_of(motion: DVector<f64>) -> DVector<f64> {
    let largest = motion.amax();
    let scaled = if largest > 0.0 { motion / largest } else { motion };
    // What is rounding becomes 0, never −0.
    scaled.map(|z| if z.abs() <= ROUNDING { 0.0 } else { z })
}

/// The part of one motion in the displacement of one joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Index of the motion.
    pub motion: usize,
    /// Mutual displacement of the joint per unit of the motion, with the magnitudes of its terms.
    pub part: Sum,
    /// The same as proofs take it: of the parts of a structure to the last digit, else the f64 number.
    pub exact: Dyadic,
}

impl Entry {
    /// A number that counts as exact.
    fn of(motion: usize, part: Sum) -> Entry {
        Entry { motion, part, exact: Dyadic::from(part.value) }
    }
}

/// Motions that cost no energy, joint by joint.
#[derive(Clone, Debug)]
pub struct FreeMotions {
    rows: Vec<Vec<Entry>>,
    count: usize,
}

impl FreeMotions {
    /// Of a contact system, and of the structure behind it where there is one.
    pub fn new(system: &ContactSystem, structure: Option<(&Structure, &MainSystem)>) -> FreeMotions {
        match structure {
            Some((structure, main)) => FreeMotions::of_structure(structure, main),
            None => FreeMotions::of_kernel(&system.kernel, &system.stiffness.diagonal()),
        }
    }

    fn of_structure(structure: &Structure, main: &MainSystem) -> FreeMotions {
        let motions = main.kernel_motions();
        if let Some(rows) = main.traces().and_then(|traces| exact_motions(traces, main.joint_count())) {
            let entry = |(motion, exact): (usize, Dyadic)| {
                let value = exact.to_f64();
                Entry { motion, part: Sum::exactly(value), exact }
            };
            let rows = rows.into_iter().map(|row| row.into_iter().map(entry).collect()).collect();
            return FreeMotions { rows, count: motions.len() };
        }
        let known = |internal: bool| if internal { EIGENVECTOR / NOISE } else { 1.0 };
        let rows = joints(&structure.pairs)
            .iter()
            .map(|joint| {
                let entry = |(motion, k): (&crate::fem::Motion, usize)| {
                    let mut sum = Sum::default();
                    for (node, a) in &joint.terms {
                        for (a, u) in a.iter().zip(&motion.u[*node]) {
                            sum = sum.plus(1.0, Sum::exactly(a * u));
                        }
                    }
                    let value = if sum.value.abs() <= ZERO * sum.magnitude { 0.0 } else { sum.value };
                    let magnitude = sum.magnitude * known(motion.internal);
                    (magnitude > 0.0).then_some(Entry::of(k, Sum { value, magnitude }))
                };
                motions.iter().zip(0..).filter_map(entry).collect()
            })
            .collect();
        FreeMotions { rows, count: motions.len() }
    }

    /// The columns of an orthonormal basis over the joints, of these own stiffnesses. What is noise beside the largest entry
    /// of a column is zero, but where the joint is so much stiffer than others that it may not be noise there.
    pub fn of_kernel(kernel: &DMatrix<f64>, stiffness: &DVector<f64>) -> FreeMotions {
        let simple = clean(kernel);
        let force = |joint: usize, motion: usize| kernel[(joint, motion)].abs() * stiffness[joint].max(0.0).sqrt();
        let largest: Vec<f64> = (0..kernel.ncols())
            .map(|motion| (0..kernel.nrows()).map(|joint| force(joint, motion)).fold(0.0, f64::max))
            .collect();
        let rows = (0..kernel.nrows())
            .map(|joint| {
                // The columns are orthonormal to rounding: every entry is wrong by some ε of 1.
                let entry = |motion: usize| {
                    let counts = simple[(joint, motion)] != 0.0 || force(joint, motion) > NOISE * largest[motion];
                    let part = Sum { value: kernel[(joint, motion)], magnitude: 1.0 };
                    counts.then_some(Entry::of(motion, part))
                };
                (0..kernel.ncols()).filter_map(entry).collect()
            })
            .collect();
        FreeMotions { rows, count: kernel.ncols() }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// What moves a joint.
    pub fn row(&self, joint: usize) -> &[Entry] {
        &self.rows[joint]
    }

    /// Displacement of a joint under these amounts of the motions.
    pub fn displacement(&self, joint: usize, amounts: &[f64]) -> Sum {
        let mut sum = Sum::default();
        for entry in &self.rows[joint] {
            sum = sum.plus(amounts[entry.motion], entry.part);
        }
        sum
    }

    /// Displacements of all joints under these amounts of the motions.
    pub fn displacements(&self, amounts: &[f64]) -> DVector<f64> {
        DVector::from_fn(self.rows.len(), |joint, _| self.displacement(joint, amounts).value)
    }

    /// Work −RF·z of a load over the joints, per unit of each motion; `terms`: what each entry of the load was summed
    /// from.
    pub fn work(&self, load: &DVector<f64>, terms: &DVector<f64>) -> Vec<Sum> {
        let mut work = vec![Sum::default(); self.count];
        for (row, (load, terms)) in self.rows.iter().zip(load.iter().zip(terms.iter())) {
            for entry in row {
                let Sum { value, magnitude } = entry.part;
                let own = Sum { value: -load * value, magnitude: terms.max(load.abs()) * magnitude };
                work[entry.motion] = work[entry.motion].plus(1.0, own);
            }
        }
        work
    }
}
