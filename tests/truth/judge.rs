//! An independent judge: of answers row by row in doubled precision, of claims that there is none by an exhaustive search
//! in exact rationals.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use stickslip::answer::record::Answer;

/// Residuals above this share of the terms of their own row are violations.
const ROUNDING: f64 = 1e-12;

/// A contact problem as its file states it, in the order normals, tangentials.
#[derive(Clone, Debug)]
pub struct Problem {
    pub r: Vec<Vec<f64>>,
    pub load: Vec<f64>,
    pub law: Vec<&'static str>,
    pub friction: Vec<f64>,
    pub cohesion: Vec<f64>,
    pub gap: Vec<f64>,
    pub bound: Vec<f64>,
}

type Exact = BigRational;

fn exact(value: f64) -> Exact {
    Exact::from_float(value).expect("a finite number")
}

/// A sum in twice the precision of f64 and the sum of the magnitudes of its terms.
#[derive(Clone, Copy, Default)]
struct Sum {
    high: f64,
    low: f64,
    size: f64,
}

impl Sum {
    fn of(value: f64) -> Sum {
        Sum { high: value, low: 0.0, size: value.abs() }
    }

    fn add(&mut self, term: f64) {
        let sum = self.high + term;
        let part = sum - self.high;
        self.low += (self.high - (sum - part)) + (term - part);
        self.high = sum;
    }

    fn add_product(&mut self, a: f64, b: f64) {
        let product = a * b;
        self.low += a.mul_add(b, -product);
        self.size += product.abs();
        self.add(product);
    }

    fn plus(mut self, factor: f64, other: &Sum) -> Sum {
        let size = self.size + factor.abs() * other.size;
        self.add_product(factor, other.high);
        self.add_product(factor, other.low);
        Sum { size, ..self }
    }

    /// Whether the value lies below zero or (`zero`) away from it by more than rounding of its terms.
    fn violates(&self, zero: bool) -> bool {
        let (value, allowed) = (self.high + self.low, ROUNDING * self.size);
        !(value >= -allowed && (!zero || value <= allowed))
    }
}

impl Problem {
    pub fn pairs(&self) -> usize {
        self.law.len()
    }

    /// What is wrong with an answer; `None` if nothing is.
    pub fn fault_of(&self, answer: &Answer) -> Option<String> {
        let m = self.pairs();
        let z = |k: usize| {
            let pair = &answer.pairs[k % m];
            if k < m { (pair.z_n, self.gap[k]) } else { (pair.z_t, 0.0) }
        };
        let force: Vec<Sum> = (0..2 * m)
            .map(|i| {
                let mut sum = Sum::of(self.load[i]);
                for k in 0..2 * m {
                    let (z, gap) = z(k);
                    sum.add_product(self.r[i][k], z);
                    sum.add_product(-self.r[i][k], gap);
                }
                sum
            })
            .collect();
        for i in 0..m {
            let pair = &answer.pairs[i];
            let wrong = |what: &str| Some(format!("pair {}: {what}: {pair:?}", i + 1));
            let reported = |value: f64, force: &Sum| force.plus(-1.0, &Sum::of(value));
            let (normal, tangential) = (&force[i], &force[m + i]);
            if reported(pair.x_n, normal).violates(true) {
                return wrong("x_n is not R z + RF");
            }
            if reported(pair.x_t, tangential).violates(true) {
                return wrong("x_t is not R z + RF");
            }
            let bound = match self.law[i] {
                "bound" => {
                    if pair.z_n != 0.0 {
                        return wrong("a bilateral joint moves");
                    }
                    Sum::of(self.bound[i])
                }
                law => {
                    if pair.z_n < 0.0 || normal.violates(pair.z_n > 0.0) {
                        return wrong("x_n and z_n");
                    }
                    if law == "frictionless" {
                        if tangential.violates(true) {
                            return wrong("a frictionless pair carries x_t");
                        }
                        continue;
                    }
                    Sum::of(self.cohesion[i]).plus(self.friction[i], normal)
                }
            };
            // Slip + goes with x⁺ = 0.
            if bound.plus(1.0, tangential).violates(pair.z_t > 0.0)
                || bound.plus(-1.0, tangential).violates(pair.z_t < 0.0)
            {
                return wrong("reserves and slip");
            }
        }
        None
    }

    /// Whether R is positive definite by more than the rounding of its entries, exactly: then an answer exists
    /// (Haslinger 1983).
    fn is_definite(&self) -> bool {
        let n = 2 * self.pairs();
        let mut a: Vec<Vec<Exact>> = self.r.iter().map(|row| row.iter().map(|v| exact(*v)).collect()).collect();
        (0..n).for_each(|k| a[k][k] *= exact(1.0 - 1e-12));
        for k in 0..n {
            let line = a[k].clone();
            if !line[k].is_positive() {
                return false;
            }
            for other in a.iter_mut().skip(k + 1) {
                let factor = &other[k] / &line[k];
                other.iter_mut().zip(&line).for_each(|(entry, pivot)| *entry -= &factor * pivot);
            }
        }
        true
    }

    fn choices(&self) -> Vec<Vec<(bool, i8)>> {
        let of = |law: &&str| match *law {
            "frictionless" => vec![(false, 0), (true, 0)],
            "bound" => vec![(false, 0), (false, 1), (false, -1)],
            _ => vec![(false, 0), (false, 1), (false, -1), (true, 0), (true, 1), (true, -1)],
        };
        self.law.iter().map(of).collect()
    }

    /// Whether an answer can be shown to exist: by going through all working schemes where they are few, by R where they
    /// are many.
    pub fn must_have_answer(&self) -> bool {
        let schemes: usize = self.choices().iter().map(Vec::len).product();
        if schemes <= 40 { self.has_answer() } else { self.is_definite() }
    }

    /// Whether some working scheme is an answer of sensible size, exactly.
    fn has_answer(&self) -> bool {
        let choices = self.choices();
        let count: usize = choices.iter().map(Vec::len).product();
        (0..count).any(|mut index| {
            let scheme: Vec<(bool, i8)> = (choices.iter())
                .map(|choices| {
                    let choice = choices[index % choices.len()];
                    index /= choices.len();
                    choice
                })
                .collect();
            self.holds(&scheme)
        })
    }

    /// Whether a scheme (open, side of slip) has displacements that obey every sign: a linear feasibility problem.
    fn holds(&self, scheme: &[(bool, i8)]) -> bool {
        let m = self.pairs();
        // Unknowns ≥ 0: joint and sign of its displacement.
        let mut columns: Vec<(usize, i8)> = Vec::new();
        for (i, (open, slip)) in scheme.iter().enumerate() {
            if *open {
                columns.push((i, 1));
            }
            match self.law[i] {
                "frictionless" => columns.extend([(m + i, 1), (m + i, -1)]),
                _ if *slip != 0 => columns.push((m + i, *slip)),
                _ => {}
            }
        }
        // Not beyond all sense: a matrix that is singular but for its last digits answers with z of 1e16.
        let reach: f64 = (0..2 * m)
            .filter(|&k| self.r[k][k] > 0.0)
            .map(|k| {
                let root = self.r[k][k].sqrt();
                1e8 * self.load[k].abs() / root + if k < m { 10.0 * self.gap[k] * root } else { 0.0 }
            })
            .sum();
        // λ over (columns, constant).
        let gap = |k: usize| if k < m { exact(self.gap[k]) } else { Exact::zero() };
        let force: Vec<Vec<Exact>> = (0..2 * m)
            .map(|i| {
                let mut row: Vec<Exact> =
                    columns.iter().map(|(k, sign)| exact(self.r[i][*k]) * exact(f64::from(*sign))).collect();
                let closed: Exact = (0..2 * m).map(|k| exact(self.r[i][k]) * gap(k)).sum();
                row.push(exact(self.load[i]) - closed);
                row
            })
            .collect();
        let mix = |terms: &[(f64, usize)], fixed: f64| -> Vec<Exact> {
            let mut row: Vec<Exact> = (0..=columns.len())
                .map(|c| terms.iter().map(|(factor, i)| exact(*factor) * &force[*i][c]).sum())
                .collect();
            *row.last_mut().expect("a constant") += exact(fixed);
            row
        };
        let (mut zero, mut positive) = (Vec::new(), Vec::new());
        for (c, (k, _)) in columns.iter().enumerate().filter(|(_, (k, _))| self.r[*k][*k] > 0.0) {
            let mut row = vec![Exact::zero(); columns.len() + 1];
            row[c] = -Exact::one();
            row[columns.len()] = exact(reach / self.r[*k][*k].sqrt());
            positive.push(row);
        }
        for (i, (open, slip)) in scheme.iter().enumerate() {
            let fixed = match self.law[i] {
                "bound" => self.bound[i],
                law => {
                    let normal = mix(&[(1.0, i)], 0.0);
                    if *open {
                        zero.push(normal)
                    } else {
                        positive.push(normal)
                    }
                    if law == "frictionless" {
                        zero.push(mix(&[(1.0, m + i)], 0.0));
                        continue;
                    }
                    self.cohesion[i]
                }
            };
            let f = if self.law[i] == "bound" { 0.0 } else { self.friction[i] };
            let reserve = |side: i8| mix(&[(f, i), (f64::from(side), m + i)], fixed);
            for side in [1, -1] {
                if *slip == side { zero.push(reserve(side)) } else { positive.push(reserve(side)) }
            }
        }
        feasible(&zero, &positive)
    }
}

/// Whether some y ≥ 0 has rows·(y, 1) = 0 in `zero` and ≥ 0 in `positive`: phase one of the simplex method with Bland's
/// rule, in rationals.
fn feasible(zero: &[Vec<Exact>], positive: &[Vec<Exact>]) -> bool {
    let rows = zero.len() + positive.len();
    let unknowns = zero.iter().chain(positive).next().map_or(0, |row| row.len() - 1);
    let slacks = positive.len();
    // Columns: y, slacks, artificials, right side.
    let width = unknowns + slacks + rows + 1;
    let mut table: Vec<Vec<Exact>> = Vec::new();
    for (k, row) in zero.iter().chain(positive).enumerate() {
        let mut line = vec![Exact::zero(); width];
        line[..unknowns].clone_from_slice(&row[..unknowns]);
        if k >= zero.len() {
            line[unknowns + k - zero.len()] = -Exact::one();
        }
        line[width - 1] = -&row[unknowns];
        if line[width - 1].is_negative() {
            line.iter_mut().for_each(|v| *v = -&*v);
        }
        line[unknowns + slacks + k] = Exact::one();
        table.push(line);
    }
    let mut basis: Vec<usize> = (0..rows).map(|k| unknowns + slacks + k).collect();
    // Minimize the sum of the artificials: reduced costs of the others are −Σ rows.
    let mut cost: Vec<Exact> = (0..width).map(|c| -table.iter().map(|line| &line[c]).sum::<Exact>()).collect();
    let free = unknowns + slacks;
    while let Some(enter) = (0..free).find(|&c| cost[c].is_negative()) {
        let leave = (0..rows).filter(|&k| table[k][enter].is_positive()).min_by(|&a, &b| {
            let ratio = |k: usize| &table[k][width - 1] / &table[k][enter];
            ratio(a).cmp(&ratio(b)).then(basis[a].cmp(&basis[b]))
        });
        // The sum of artificials is bounded below: some row stops.
        let Some(leave) = leave else { return false };
        let pivot = table[leave][enter].clone();
        table[leave].iter_mut().for_each(|v| *v /= &pivot);
        let line = table[leave].clone();
        for (k, other) in table.iter_mut().enumerate() {
            if k != leave && !other[enter].is_zero() {
                let factor = other[enter].clone();
                other.iter_mut().zip(&line).for_each(|(v, p)| *v -= &factor * p);
            }
        }
        let factor = cost[enter].clone();
        cost.iter_mut().zip(&line).for_each(|(v, p)| *v -= &factor * p);
        basis[leave] = enter;
    }
    // −cost of the right side is what is left of the artificials.
    cost[width - 1].is_zero()
}
