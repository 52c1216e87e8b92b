//! What a file gives of a contact system, kept beside what is condensed from it: answers are evaluated and checked from
//! it.
//!
//! ```text
//!   stiffness     λ = R (z − (g, 0)) + RF over all 2m joints; λ_τ = 0 along the tangents of frictionless pairs
//!   compliance    z − (g, 0) − v = W λ over the joints that carry force, v = Σ factor·vector
//! ```

use nalgebra::{DMatrix, DVector};

use super::pivoted::PivotedCholesky;
use super::sum::Sum;
use crate::doubled::dot;

/// Rounds of refinement of a solution whose residual is summed in doubled precision.
const ROUNDS: usize = 3;

/// The matrix of a file and its load vectors.
#[derive(Clone, Debug, PartialEq)]
pub struct FileData {
    /// R or W: all normals, then all tangentials, in space t1 and t2 of each pair.
    pub matrix: DMatrix<f64>,
    /// Whether `matrix` is the compliance W.
    pub compliance: bool,
    /// Vector of each load case per unit factor.
    pub loads: Vec<DVector<f64>>,
    /// Row of the matrix of each joint that is kept, in the order of the joints.
    pub kept: Vec<usize>,
    /// Tangential rows of frictionless pairs: they carry nothing.
    pub released: Vec<usize>,
    /// Frictionless pair of each released row; in space it has two.
    pub released_pairs: Vec<usize>,
    /// R over the released rows, or W over the kept ones: what has to be solved with.
    pub factor: PivotedCholesky,
}

/// Σ factor·vector of a file, 2m, with the magnitudes it was summed from.
#[derive(Clone, Debug, PartialEq)]
pub struct FileLoad {
    /// The sum.
    pub vector: DVector<f64>,
    /// Σ |factor·vector|.
    pub terms: DVector<f64>,
}

/// Forces and slips of a state, from the file.
#[derive(Clone, Debug, PartialEq)]
pub struct FileForces {
    /// λ of the kept joints.
    pub joints: Vec<Sum>,
    /// Residuals of the file's equations in the rows that were solved for: rounding, or else the state does not obey
    /// them.
    pub left: Vec<Sum>,
    /// z_τ of the frictionless pairs.
    pub slips: DVector<f64>,
}

impl FileData {
    /// Σ factor·vector.
    pub fn load(&self, factors: &[f64]) -> FileLoad {
        let n = self.matrix.nrows();
        let mut load = FileLoad { vector: DVector::zeros(n), terms: DVector::zeros(n) };
        for (vector, factor) in self.loads.iter().zip(factors) {
            load.vector += *factor * vector;
            load.terms += factor.abs() * vector.abs();
        }
        load
    }

    /// A row of the matrix times x, plus a start, each summed in doubled precision.
    fn row(&self, row: usize, x: &DVector<f64>, start: f64) -> f64 {
        dot(start, self.matrix.column(row).iter().zip(x.iter()))
    }

    /// The same with the magnitudes of its terms, those of x given.
    fn row_sum(&self, row: usize, (x, sizes): (&DVector<f64>, &DVector<f64>), start: f64, size: f64) -> Sum {
        let terms: f64 = self.matrix.column(row).iter().zip(sizes.iter()).map(|(a, x)| (a * x).abs()).sum();
        Sum { value: self.row(row, x, start), magnitude: size + terms }
    }

    /// z − (g, 0) − v − W λ in every kept row, each zero in a state that obeys the compliance; `moved` is z − (g, 0),
    /// known to a few ε of `sizes`.
    pub fn left_by(&self, forces: &[Sum], moved: &DVector<f64>, sizes: &DVector<f64>, load: &FileLoad) -> Vec<Sum> {
        let (mut all, mut all_sizes) = (DVector::zeros(self.matrix.nrows()), DVector::zeros(self.matrix.nrows()));
        for (force, &row) in forces.iter().zip(&self.kept) {
            (all[row], all_sizes[row]) = (force.value, force.magnitude);
        }
        let left = |(i, &row): (usize, &usize)| {
            let start = load.vector[row] - moved[i];
            self.row_sum(row, (&all, &all_sizes), start, sizes[i] + load.terms[row])
        };
        self.kept.iter().enumerate().map(left).collect()
    }

    /// z_τ (lengths, > 0 along +t) of the frictionless pairs under the forces of the kept joints of a compliance.
    pub fn slips_under(&self, forces: &DVector<f64>, load: &FileLoad) -> DVector<f64> {
        let mut all = DVector::zeros(self.matrix.nrows());
        self.kept.iter().zip(forces.iter()).for_each(|(&row, force)| all[row] = *force);
        DVector::from_iterator(
            self.released.len(),
            self.released.iter().map(|&row| self.row(row, &all, load.vector[row])),
        )
    }

    /// Forces at displacements z − (g, 0) of the kept joints, which are known to a few ε of `sizes` = |z| + |(g, 0)|.
    pub fn forces(&self, z: &DVector<f64>, sizes: &DVector<f64>, load: &FileLoad) -> FileForces {
        if self.compliance {
            self.forces_of_compliance(z, sizes, load)
        } else {
            self.forces_of_stiffness(z, sizes, load)
        }
    }

    fn forces_of_stiffness(&self, z: &DVector<f64>, sizes: &DVector<f64>, load: &FileLoad) -> FileForces {
        let mut all = DVector::zeros(self.matrix.nrows());
        for (value, &row) in z.iter().zip(&self.kept) {
            all[row] = *value;
        }
        let released = &self.released;
        for _ in 0..if released.is_empty() { 0 } else { ROUNDS } {
            let force = released.iter().map(|&row| self.row(row, &all, load.vector[row]));
            let step = self.factor.solve(&DVector::from_iterator(released.len(), force));
            step.iter().zip(released).for_each(|(step, &row)| all[row] -= step);
        }
        let mut all_sizes = all.abs();
        for (size, &row) in sizes.iter().zip(&self.kept) {
            all_sizes[row] = *size;
        }
        let sum = |row: &usize| self.row_sum(*row, (&all, &all_sizes), load.vector[*row], load.terms[*row]);
        FileForces {
            joints: self.kept.iter().map(sum).collect(),
            left: released.iter().map(sum).collect(),
            slips: DVector::from_iterator(released.len(), released.iter().map(|&row| all[row])),
        }
    }

    fn forces_of_compliance(&self, z: &DVector<f64>, sizes: &DVector<f64>, load: &FileLoad) -> FileForces {
        let kept = &self.kept;
        let target = DVector::from_fn(kept.len(), |i, _| z[i] - load.vector[kept[i]]);
        let mut all = DVector::zeros(self.matrix.nrows());
        for _ in 0..ROUNDS {
            let missing = DVector::from_fn(kept.len(), |i, _| -self.row(kept[i], &all, -target[i]));
            let step = self.factor.solve(&missing);
            step.iter().zip(kept).for_each(|(step, &row)| all[row] += step);
        }
        let left = (kept.iter().enumerate())
            .map(|(i, &row)| self.row_sum(row, (&all, &all), -target[i], sizes[i] + load.terms[row]))
            .collect();
        let slip = |&row: &usize| self.row(row, &all, load.vector[row]);
        FileForces {
            // Known as accurately as they were solved for, which `left` shows.
            joints: kept.iter().map(|&row| Sum::exactly(all[row])).collect(),
            left,
            slips: DVector::from_iterator(self.released.len(), self.released.iter().map(slip)),
        }
    }
}
