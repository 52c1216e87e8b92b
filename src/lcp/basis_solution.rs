//! A vertex, or a direction, of a basis, computed from the data.

use nalgebra::{DMatrix, DVector};

use crate::lcp::basis::Basis;
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::{Point, RayDirection};
use crate::lcp::variable::Variable;
use stickslip_numerics::decompositions::Factor;

/// Rows and columns of the whole LCP read from the mirrored one.
struct Whole<'a> {
    lcp: &'a MirroredLcp,
    /// Primary row and whether it is the mirror, of each whole row.
    rows: Vec<(usize, bool)>,
}

/// What a row of M is made of: S_i + f S_n, or f S_n − S_i in a mirror.
struct Parts {
    row: usize,
    mirrored: bool,
    coupling: Option<(usize, f64)>,
}

impl<'a> Whole<'a> {
    fn new(lcp: &'a MirroredLcp) -> Whole<'a> {
        let rows = lcp.primary_rows();
        Whole { lcp, rows }
    }

    /// Row k of what `read` gives for the primary rows; see [`Mirror::reflect`].
    fn combine(&self, k: usize, read: impl Fn(usize) -> f64, p: f64, shift: f64) -> f64 {
        let (i, mirrored) = self.rows[k];
        match (&self.lcp.mirrors[i], mirrored) {
            (Some(mirror), true) => mirror.reflect(i, read, p, shift),
            _ => read(i),
        }
    }

    fn parts(&self, k: usize) -> Parts {
        let (row, mirrored) = self.rows[k];
        Parts { row, mirrored, coupling: self.lcp.coupling(row) }
    }

    /// Entries of a column of M in the rows made of the given parts.
    fn column<'b>(&'b self, column: usize, rows: &'b [Parts]) -> impl Iterator<Item = f64> + 'b {
        let (j, negative) = self.rows[column];
        let sign = if negative { -1.0 } else { 1.0 };
        let stored = self.lcp.base.column(j);
        rows.iter().map(move |parts| {
            let own = stored[parts.row];
            let own = if parts.mirrored { -own } else { own };
            sign * (own + parts.coupling.map_or(0.0, |(n, f)| f * stored[n]))
        })
    }

    fn q(&self, k: usize) -> f64 {
        self.combine(k, |i| self.lcp.q[i], 0.0, 1.0)
    }

    fn d(&self, k: usize) -> f64 {
        self.combine(k, |i| self.lcp.covering[i], 1.0, 0.0)
    }

    fn system(&self, basis: &Basis) -> Factor {
        let n = basis.active.len();
        let rows = self.active_parts(basis);
        let mut entries = Vec::with_capacity(n * n);
        for &column in &basis.z {
            entries.extend(self.column(column, &rows));
        }
        if basis.p {
            entries.extend(basis.active.iter().map(|&k| self.d(k)));
        }
        Factor::new(DMatrix::from_vec(n, n, entries))
    }

    fn active_parts(&self, basis: &Basis) -> Vec<Parts> {
        basis.active.iter().map(|&k| self.parts(k)).collect()
    }

    /// z over all rows, and p, of a basis in whose active rows M z + d p is `right`; `None` where there are more or
    /// fewer equations than unknowns, or where they are singular.
    fn solve(&self, basis: &Basis, right: Vec<f64>) -> Option<(Vec<f64>, f64)> {
        self.solve_by(&self.square(basis)?, basis, right)
    }

    /// The factor of the active rows, if they are as many as the unknowns.
    fn square(&self, basis: &Basis) -> Option<Factor> {
        (basis.z.len() + usize::from(basis.p) == basis.active.len()).then(|| self.system(basis))
    }

    fn solve_by(&self, factor: &Factor, basis: &Basis, right: Vec<f64>) -> Option<(Vec<f64>, f64)> {
        let solution = factor.solve(&DVector::from_vec(right))?;
        let mut z = vec![0.0; self.lcp.full_size];
        basis.z.iter().zip(solution.iter()).for_each(|(&k, value)| z[k] = *value);
        Some((z, if basis.p { solution[solution.len() - 1] } else { 0.0 }))
    }

    /// w = M z + shift q + d p of all whole rows, exact zero in the active ones.
    fn response(&self, basis: &Basis, z: &[f64], p: f64, shift: f64) -> Vec<f64> {
        let mut primary = vec![0.0; self.lcp.size()];
        for (k, &value) in z.iter().enumerate() {
            let (j, negative) = self.rows[k];
            primary[j] += if negative { -value } else { value };
        }
        let mut w = self.lcp.times(&primary);
        w += shift * &self.lcp.q + p * &self.lcp.covering;
        let mut whole: Vec<f64> = (0..self.lcp.full_size).map(|k| self.combine(k, |i| w[i], p, shift)).collect();
        for &k in &basis.active {
            whole[k] = 0.0;
        }
        whole
    }
}

/// Values of all variables at a basis; `None` where its equations are singular.
pub fn vertex(lcp: &MirroredLcp, basis: &Basis) -> Option<Point> {
    Some(factored_vertex(lcp, basis)?.0)
}

/// The same with the factor of its equations, which are those of every LCP with this M.
pub fn factored_vertex(lcp: &MirroredLcp, basis: &Basis) -> Option<(Point, Factor)> {
    let whole = Whole::new(lcp);
    let factor = whole.square(basis)?;
    let (z, p) = whole.solve_by(&factor, basis, basis.active.iter().map(|&row| -whole.q(row)).collect())?;
    let w = whole.response(basis, &z, p, 1.0);
    Some((Point { z, w, p }, factor))
}

/// The point of a basis after one step of Newton's method from `point`, whose w (of all rows, better known than from
/// the data) is given; signs are not checked. `None` where the equations are singular.
pub fn corrected(lcp: &MirroredLcp, basis: &Basis, point: &Point, w: &[f64]) -> Option<Point> {
    let whole = Whole::new(lcp);
    let (step, step_p) = whole.solve(basis, basis.active.iter().map(|&row| -w[row]).collect())?;
    let z: Vec<f64> = point.z.iter().zip(step).map(|(z, step)| z + step).collect();
    let p = point.p + step_p;
    let w = whole.response(basis, &z, p, 1.0);
    Some(Point { z, w, p })
}

/// Direction at a basis in which p, which is not in it, grows by 1, by the [factor](factored_vertex) of its equations;
/// `None` where they are singular.
pub fn direction_of_p(lcp: &MirroredLcp, basis: &Basis, factor: &Factor) -> Option<RayDirection> {
    let whole = Whole::new(lcp);
    let (z, _) = whole.solve_by(factor, basis, basis.active.iter().map(|&row| -whole.d(row)).collect())?;
    let w = whole.response(basis, &z, 1.0, 0.0);
    Some(RayDirection { entering: Variable::P, z, w, p: 1.0 })
}

/// Direction at a basis in which `entering` grows by 1; `None` where the equations are singular.
pub fn direction(lcp: &MirroredLcp, basis: &Basis, entering: Variable) -> Option<RayDirection> {
    let whole = Whole::new(lcp);
    let active = basis.active.iter();
    let right = match entering {
        Variable::Z(k) => whole.column(k, &whole.active_parts(basis)).map(|entry| -entry).collect(),
        Variable::W(k) => active.map(|&row| f64::from(row == k)).collect(),
        Variable::P => active.map(|&row| -whole.d(row)).collect(),
    };
    let (mut z, mut p) = whole.solve(basis, right)?;
    match entering {
        Variable::Z(k) => z[k] = 1.0,
        Variable::P => p = 1.0,
        Variable::W(_) => {}
    }
    let mut w = whole.response(basis, &z, p, 0.0);
    if let Variable::W(k) = entering {
        w[k] = 1.0;
    }
    Some(RayDirection { entering, z, w, p })
}
