//! The answer of a bare LCP made as true to its data as f64 allows: refined in doubled precision, and where that is not
//! enough, solved exactly.

use num_rational::BigRational;
use num_traits::{Signed, Zero};

use crate::answer::check_plain::{ROW_ROUNDING, check_plain, row};
use crate::lcp::basis::Basis;
use crate::lcp::basis_solution::corrected;
use crate::lcp::exact::dyadic::rational;
use crate::lcp::exact::rational_solve::{Quotients, RationalSolution, clear_denominators, solve};
use crate::lcp::exact::scalar::{BigInt, ratio_to_f64};
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::Point;
use crate::lcp::problem::NOISE;
use crate::lcp::variable::Variable;
use crate::watch::Watch;

/// Steps of refinement; each gains as many digits as the first solution has right.
const STEPS: usize = 2;
/// A z that refinement leaves smaller than this part of its first correction was nothing but rounding.
const VANISHED: f64 = 1e-8;
/// Most rows of a basis that is solved exactly.
const EXACT_BASIS: usize = 400;

/// The point of a basis without p at which all the signs hold, as near as f64 can tell; else the point as it was.
pub(super) fn settled(lcp: &MirroredLcp, basis: &Basis, point: &Point, watch: &dyn Watch) -> Point {
    let refined = refined(lcp, basis, point);
    if let Some(refined) = refined.filter(|refined| check_plain(lcp, &refined.z, ROW_ROUNDING).passed) {
        return refined;
    }
    exact(lcp, basis, watch).map_or_else(|| point.clone(), |z| at(lcp, basis, z))
}

/// Refined with residuals in doubled precision; what vanishes is zero.
fn refined(lcp: &MirroredLcp, basis: &Basis, point: &Point) -> Option<Point> {
    let residual = |z: &[f64]| -> Vec<f64> { (0..lcp.size()).map(|i| row(lcp, z, i).value()).collect() };
    let mut refined = corrected(lcp, basis, point, &residual(&point.z))?;
    let first: Vec<f64> = refined.z.iter().zip(&point.z).map(|(new, old)| (new - old).abs()).collect();
    for _ in 1..STEPS {
        refined = corrected(lcp, basis, &refined, &residual(&refined.z))?;
    }
    for (z, first) in refined.z.iter_mut().zip(first) {
        if z.abs() <= VANISHED * first {
            *z = 0.0;
        }
    }
    Some(at(lcp, basis, refined.z))
}

/// The point with w from the data: exactly zero in the rows of the basis, and where only rounding is left.
fn at(lcp: &MirroredLcp, basis: &Basis, z: Vec<f64>) -> Point {
    let w = (0..lcp.size())
        .map(|i| {
            let w = row(lcp, &z, i);
            let zero = basis.active.binary_search(&i).is_ok() || w.value().abs() <= NOISE * w.magnitude();
            if zero { 0.0 } else { w.value() }
        })
        .collect();
    Point { w, z, p: 0.0 }
}

/// z of the basis, solved in rationals and rounded, where it is an answer; `None` where it is none, where its equations are
/// singular or many, or when stopped.
fn exact(lcp: &MirroredLcp, basis: &Basis, watch: &dyn Watch) -> Option<Vec<f64>> {
    let whole = WholeBasis::new(lcp, basis, None)?;
    let solution = whole.solve(&|row| -&row.q, watch)?;
    whole.signs_hold(&solution, &|row| &row.q).then(|| {
        let mut z = vec![0.0; lcp.size()];
        for (&j, numerator) in basis.z.iter().zip(&solution.numerators) {
            z[j] = ratio_to_f64(numerator, &solution.denominator);
        }
        z
    })
}

/// Whether the ray in which `entering` grows from the vertex of the basis is one in exact arithmetic too; `None` where that
/// is not examined: too many rows, singular equations, stopped.
pub(super) fn ray_holds(lcp: &MirroredLcp, basis: &Basis, entering: Variable, watch: &dyn Watch) -> Option<bool> {
    let whole = WholeBasis::new(lcp, basis, Some(entering))?;
    let vertex = whole.solve(&|row| -&row.q, watch)?;
    let direction = whole.solve(
        &|row| match entering {
            Variable::W(k) if k == row.index => row.scale.clone(),
            _ => -&row.entering,
        },
        watch,
    )?;
    Some(whole.signs_hold(&vertex, &|row| &row.q) && whole.signs_hold(&direction, &|row| &row.entering))
}

/// A row of the LCP multiplied by `scale`, which makes its entries integers.
struct WholeRow {
    index: usize,
    /// Of the basic z, then of p where it is basic.
    basic: Vec<BigInt>,
    q: BigInt,
    /// Of the z that is to enter.
    entering: BigInt,
    scale: BigInt,
}

/// The equations of a basis in integers.
struct WholeBasis<'a> {
    basis: &'a Basis,
    rows: Vec<WholeRow>,
}

impl<'a> WholeBasis<'a> {
    fn new(lcp: &MirroredLcp, basis: &'a Basis, entering: Option<Variable>) -> Option<WholeBasis<'a>> {
        let k = basis.z.len() + usize::from(basis.p);
        if basis.active.len() != k || k > EXACT_BASIS {
            return None;
        }
        let row = |index: usize| {
            let entry = |j: usize| lcp.base[(index, j)];
            let columns = basis.z.iter().map(|&j| entry(j)).chain(basis.p.then(|| lcp.covering[index]));
            let enters = match entering {
                Some(Variable::Z(j)) => entry(j),
                _ => 0.0,
            };
            let all: Vec<BigRational> = columns.chain([lcp.q[index], enters]).map(rational).collect();
            let (mut basic, scale) = clear_denominators(&all);
            let entering = basic.pop().unwrap_or_default();
            let q = basic.pop().unwrap_or_default();
            WholeRow { index, basic, q, entering, scale }
        };
        Some(WholeBasis { basis, rows: (0..lcp.size()).map(row).collect() })
    }

    /// The basic variables that solve the active rows for the right side `right`.
    fn solve(&self, right: &dyn Fn(&WholeRow) -> BigInt, watch: &dyn Watch) -> Option<Quotients> {
        let active = || self.basis.active.iter().map(|&i| &self.rows[i]);
        let matrix: Vec<Vec<BigInt>> = active().map(|row| row.basic.clone()).collect();
        let right: Vec<BigInt> = active().map(right).collect();
        let mut progress = |_| watch.go_on();
        match solve(&matrix, &right, &mut progress) {
            RationalSolution::Unique(solution) => Some(solution),
            _ => None,
        }
    }

    /// Whether no basic variable is negative; `constant` is what a row has besides their terms.
    fn signs_hold(&self, solution: &Quotients, constant: &dyn for<'r> Fn(&'r WholeRow) -> &'r BigInt) -> bool {
        let inactive = self.rows.iter().filter(|row| self.basis.active.binary_search(&row.index).is_err());
        !solution.numerators.iter().any(Signed::is_negative)
            && inactive.into_iter().all(|row| {
                let terms = row.basic.iter().zip(&solution.numerators).filter(|(m, z)| !m.is_zero() && !z.is_zero());
                let sum: BigInt = terms.map(|(m, z)| m * z).sum();
                !(sum + constant(row) * &solution.denominator).is_negative()
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lcp::problem::{Lcp, Scale};
    use crate::watch::Quiet;

    fn lcp(matrix: Vec<Vec<f64>>, q: Vec<f64>) -> MirroredLcp {
        let scale = Scale::plain(&matrix);
        MirroredLcp::plain(&Lcp { covering: vec![1.0; q.len()], scale, matrix, q })
    }

    #[test]
    fn a_sign_below_rounding_is_told_exactly() {
        let lcp =
            lcp(vec![vec![1.0, 0.0, 0.0], vec![0.0, 1.0, 0.0], vec![-1.0, -1.0, 1.0]], vec![-0.1, -0.2, 0.1 + 0.2]);
        // z_3 = z_1 + z_2 − q_3 = 0.1 + 0.2 − fl(0.1 + 0.2) < 0: the sum was rounded up.
        let basis = Basis { z: vec![0, 1, 2], active: vec![0, 1, 2], p: false };
        assert_eq!(exact(&lcp, &basis, &Quiet), None);
        let basis = Basis { z: vec![0, 1], active: vec![0, 1], p: false };
        // Without z_3: w_3 = fl(0.1 + 0.2) − 0.1 − 0.2 > 0.
        assert_eq!(exact(&lcp, &basis, &Quiet), Some(vec![0.1, 0.2, 0.0]));
    }

    #[test]
    fn a_ray_is_told_from_one_by_rounding() {
        // Bimatrix form: z_1 enters after w_1 made room for p, and nothing falls.
        let zero = lcp(vec![vec![0.0, 1.0], vec![1.0, 0.0]], vec![-1.0, -1.0]);
        let basis = Basis { z: vec![], active: vec![0], p: true };
        assert_eq!(ray_holds(&zero, &basis, Variable::Z(0), &Quiet), Some(true));
        // With 1e-30 on the diagonal p falls, however slowly.
        let nearly = lcp(vec![vec![1e-30, 1.0], vec![1.0, 0.0]], vec![-1.0, -1.0]);
        assert_eq!(ray_holds(&nearly, &basis, Variable::Z(0), &Quiet), Some(false));
    }
}
