//! The null space of sparse rows: by singular values where it is small, by elimination where it is large.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use stickslip_numerics::decompositions::svd;

/// Most columns of which a singular value decomposition is made: its time grows with their third power.
pub const DENSE: usize = 240;

/// Least pivot, as a share of the largest entry of its vector: a basis of vectors of about one size, and no more than one
/// digit lost a pivot.
const LEAST_PIVOT: f64 = 0.1;

/// Σ coefficient · unknown.
pub type Terms = Vec<(usize, f64)>;

/// The null space of some rows A.
pub struct NullSpace {
    /// Its basis, in echelon form: each vector has a leading one where the others are 0.
    pub basis: DMatrix<f64>,
    /// ‖A‖_F/σ_r, σ_r the least singular value that is not zero: where every coefficient of A is off by a share δ, a
    /// vector of the null space turns by no more than δ times this (Wedin, "Perturbation bounds in connection with
    /// singular value decomposition", BIT 12, 1972). After an elimination its smallest pivot stands for σ_r. 0 without
    /// rows.
    pub sensitivity: f64,
}

impl NullSpace {
    /// Whether its vectors are null vectors of the rows but for the share `null` of the largest terms that there can be.
    pub fn is_of(&self, rows: &[Terms], null: f64) -> bool {
        self.basis.column_iter().all(|vector| {
            let most = null * vector.amax();
            rows.iter().all(|row| {
                let (sum, size) = row
                    .iter()
                    .fold((0.0, 0.0), |(sum, size), &(unknown, a)| (sum + a * vector[unknown], size + a.abs()));
                f64::abs(sum) <= most * size
            })
        })
    }
}

/// The null space. Singular values below the share `null` of the largest count as zero, and in an elimination what is
/// below that share of the terms it sums. `None` if the decomposition does not converge, or an elimination took more than
/// `most` additions.
pub fn null_space(rows: &[Terms], columns: usize, null: f64, most: usize) -> Option<NullSpace> {
    if rows.is_empty() {
        return Some(NullSpace { basis: DMatrix::identity(columns, columns), sensitivity: 0.0 });
    }
    let (basis, least) = if columns <= DENSE {
        by_singular_values(rows, columns, null)?
    } else {
        by_elimination(rows, columns, null, most)?
    };
    let size = rows.iter().flatten().map(|(_, a)| a * a).sum::<f64>().sqrt();
    let sensitivity = if least > 0.0 { size / least } else { 0.0 };
    Some(NullSpace { basis: echelon(basis, columns), sensitivity })
}

/// A basis, and the least singular value that is not zero; 0 where all are.
type Found = (Vec<DVector<f64>>, f64);

fn by_singular_values(rows: &[Terms], columns: usize, null: f64) -> Option<Found> {
    let mut a = DMatrix::zeros(rows.len(), columns);
    for (i, row) in rows.iter().enumerate() {
        for &(j, value) in row {
            a[(i, j)] += value;
        }
    }
    let svd = svd(&a)?;
    let largest = svd.sigma.first().copied().unwrap_or(0.0);
    let is_zero = |sigma: f64| sigma <= null * largest;
    let basis = std::iter::zip(&svd.sigma, svd.v.column_iter())
        .filter(|(sigma, _)| is_zero(**sigma))
        .map(|(_, vector)| vector.into_owned());
    let least = svd.sigma.iter().copied().rfind(|sigma| !is_zero(*sigma)).unwrap_or(0.0);
    Some((basis.collect(), least))
}

/// What is left of a row: of each unknown the coefficient, and the sum of magnitudes that it is made of.
type Sums = BTreeMap<usize, (f64, f64)>;

fn add(sums: &mut Sums, unknown: usize, value: f64, magnitude: f64) {
    let (sum, all) = sums.entry(unknown).or_default();
    *sum += value;
    *all += magnitude;
}

/// Gaussian elimination row by row, with the largest entry of a row as its pivot.
fn by_elimination(rows: &[Terms], columns: usize, null: f64, most: usize) -> Option<Found> {
    let mut least = f64::INFINITY;
    let mut left = most;
    // Unknown = −Σ a · others, in the order in which they were found: none holds the unknown of an older one.
    let mut pivots: Vec<(usize, Terms)> = Vec::new();
    let mut pivot_of = vec![usize::MAX; columns];
    for row in rows {
        let mut sums = Sums::new();
        row.iter().for_each(|&(unknown, a)| add(&mut sums, unknown, a, a.abs()));
        let oldest = |sums: &Sums| sums.keys().map(|&unknown| pivot_of[unknown]).min().filter(|at| *at != usize::MAX);
        while let Some((unknown, terms)) = oldest(&sums).map(|at| &pivots[at]) {
            left = left.checked_sub(terms.len())?;
            let (value, magnitude) = sums.remove(unknown).unwrap_or_default();
            if value.abs() > null * magnitude {
                terms.iter().for_each(|&(other, a)| add(&mut sums, other, -value * a, magnitude * a.abs()));
            }
        }
        sums.retain(|_, (value, magnitude)| value.abs() > null * *magnitude);
        let largest = sums.iter().max_by(|a, b| a.1.0.abs().total_cmp(&b.1.0.abs()));
        let Some((&unknown, &(pivot, _))) = largest else { continue };
        sums.remove(&unknown);
        least = least.min(pivot.abs());
        pivot_of[unknown] = pivots.len();
        pivots.push((unknown, sums.into_iter().map(|(other, (value, _))| (other, value / pivot)).collect()));
    }
    let free = (0..columns).filter(|unknown| pivot_of[*unknown] == usize::MAX);
    let basis = free.map(|free| {
        let mut vector = DVector::zeros(columns);
        vector[free] = 1.0;
        for (unknown, terms) in pivots.iter().rev() {
            vector[*unknown] = -terms.iter().map(|&(other, a)| a * vector[other]).sum::<f64>();
        }
        vector
    });
    Some((basis.collect(), if least.is_finite() { least } else { 0.0 }))
}

/// Gauss–Jordan on the vectors, pivots from the left. A unit of a column in which all are small would make of them a basis
/// of large vectors that hardly differ, and of what they share many digits are lost: such a column waits for the next sweep.
/// A vector that is left has its largest entry in a column without pivot, so that each sweep finds one.
fn echelon(mut basis: Vec<DVector<f64>>, columns: usize) -> DMatrix<f64> {
    let mut done = 0;
    let mut is_pivot = vec![false; columns];
    let mut size: Vec<f64> = basis.iter().map(|vector| vector.amax()).collect();
    while done < basis.len() {
        let before = done;
        for column in 0..columns {
            let share = |i: usize| basis[i][column].abs() / size[i];
            let best = (done..basis.len()).max_by(|&a, &b| share(a).total_cmp(&share(b)));
            let Some(best) = best.filter(|&best| !is_pivot[column] && share(best) >= LEAST_PIVOT) else { continue };
            basis.swap(done, best);
            size.swap(done, best);
            let pivot = basis[done][column];
            basis[done] /= pivot;
            let leading = basis[done].clone();
            for (i, vector) in basis.iter_mut().enumerate() {
                let factor = vector[column];
                if i != done && factor != 0.0 {
                    vector.axpy(-factor, &leading, 1.0);
                    size[i] = vector.amax();
                }
            }
            is_pivot[column] = true;
            done += 1;
        }
        if done == before {
            break;
        }
    }
    for vector in &mut basis {
        vector.apply(|x| {
            if x.abs() < 1e-13 {
                *x = 0.0;
            }
        });
    }
    let mut out = DMatrix::zeros(columns, basis.len());
    for (i, vector) in basis.iter().enumerate() {
        out.set_column(i, vector);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ring of bodies pinned to their neighbours at random places, rows in any order, some of them twice: both ways
    /// find the same space, and it is the null space.
    #[test]
    fn elimination_finds_what_the_singular_values_find() {
        let bodies = 30;
        let mut state = 0.37_f64;
        let mut random = || {
            state = (state * 997.0).fract() + 1e-3;
            2.0 * state - 1.0
        };
        for supported in [0, 1, 7] {
            let mut rows: Vec<Terms> = Vec::new();
            for body in 0..bodies {
                let (one, other, arm) = (3 * body, 3 * ((body + 1) % bodies), [random(), random()]);
                let x: Terms = vec![(one, 1.0), (one + 2, -arm[1]), (other, -1.0), (other + 2, arm[1])];
                let y: Terms = vec![(one + 1, 1.0), (one + 2, arm[0]), (other + 1, -1.0), (other + 2, -arm[0])];
                rows.extend([x.clone(), y, x]);
            }
            (0..supported).for_each(|support| rows.push(vec![(9 * support, 1.0), (9 * support + 2, random())]));
            let columns = 3 * bodies;
            let null = 1024.0 * f64::EPSILON;
            let [one, other] =
                [by_singular_values(&rows, columns, null), by_elimination(&rows, columns, null, usize::MAX)]
                    .map(|found| echelon(found.unwrap().0, columns));
            // Two equations a pin; those round the ring leave its rotations.
            assert_eq!((one.ncols(), other.ncols()), (bodies - supported, bodies - supported));
            // Both bases together have no more than one of them.
            let found = one.ncols();
            let column = |j: usize| if j < found { one.column(j) } else { other.column(j - found) };
            let both = DMatrix::from_fn(columns, 2 * found, |i, j| column(j)[i]);
            let sigma = svd(&both).unwrap().sigma;
            assert!(sigma[found] < 1e-9 * sigma[0], "{sigma:?}");
            for row in &rows {
                for vector in other.column_iter() {
                    assert!(row.iter().map(|&(i, a)| a * vector[i]).sum::<f64>().abs() < 1e-11);
                }
            }
        }
    }

    /// A spring at (0, 0, h) of a body in space along a direction that hardly feels x: t + ω × a with d·(t + ω × a) = 0. With
    /// x for the first pivot the vectors had entries of 1/d_x; none may be far from the others.
    #[test]
    fn vectors_are_of_about_one_size() {
        let (d, h) = ([1e-4, 0.8, 0.6], 0.7);
        let row: Terms = vec![(0, d[0]), (1, d[1]), (2, d[2]), (3, -h * d[1]), (4, h * d[0])];
        let basis = null_space(std::slice::from_ref(&row), 6, 1024.0 * f64::EPSILON, usize::MAX).unwrap().basis;
        assert_eq!(basis.ncols(), 5);
        for vector in basis.column_iter() {
            assert!((1.0..=10.0).contains(&vector.amax()), "{basis}");
            let left = row.iter().map(|&(i, a)| a * vector[i]).sum::<f64>();
            assert!(left.abs() <= 8.0 * f64::EPSILON * vector.amax(), "{left:e}");
        }
        let sigma = svd(&basis).unwrap().sigma;
        assert!(sigma[4] >= 0.1 * sigma[0], "{sigma:?}");
    }

    /// A chain of thousands of bodies that share x and y at one place each, the first one clamped: rotations are left.
    #[test]
    fn long_chains_are_quick() {
        let bodies = 3000;
        let mut rows: Vec<Terms> = vec![vec![(0, 1.0)], vec![(1, 1.0)], vec![(2, 1.0)]];
        for other in (1..bodies).map(|body| 3 * body) {
            rows.extend((0..3).map(|c| vec![(other + c, 1.0), (other + c - 3, -1.0)]));
        }
        assert_eq!(null_space(&rows, 3 * bodies, 1024.0 * f64::EPSILON, usize::MAX).unwrap().basis.ncols(), 0);
    }
}
