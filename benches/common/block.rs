//! A rigid block on a square grid of coupled springs, pressed, pushed at an angle, tilted and twisted: contact in space
//! with a dense R, of any number of pairs.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use stickslip::contact::cone::{ConeAnswer, ConeFailure, ConePair, ConeProblem, answer_on_cone};
use stickslip::contact::law::PairLaw;
use stickslip::watch::Quiet;

/// Friction of all pairs.
const FRICTION: f64 = 0.4;

/// R, RF and the laws.
pub struct Block {
    stiffness: DMatrix<f64>,
    load: DVector<f64>,
    kernel: DMatrix<f64>,
    pairs: Vec<ConePair>,
}

impl Block {
    /// side² pairs: springs of stiffness 1 along n and 0.6 along t, coupled with their neighbours, under a block of
    /// weight 1 a pair.
    pub fn new(side: usize) -> Block {
        let m = side * side;
        let place = |i: usize| [(i % side) as f64, (i / side) as f64].map(|x| x / (side - 1) as f64 - 0.5);
        let joint = |i: usize, direction: usize| if direction == 0 { i } else { m + 2 * i + direction - 1 };
        let mut springs = DMatrix::zeros(3 * m, 3 * m);
        let mut motions = DMatrix::zeros(3 * m, 6);
        for i in 0..m {
            let [x, y] = place(i);
            for (direction, stiffness) in [1.0, 0.6, 0.6].into_iter().enumerate() {
                springs[(joint(i, direction), joint(i, direction))] += stiffness;
                let right = (i % side + 1 < side).then_some(i + 1);
                for other in right.into_iter().chain((i + side < m).then_some(i + side)) {
                    let (a, b) = (joint(i, direction), joint(other, direction));
                    springs[(a, a)] += 0.5 * stiffness;
                    springs[(b, b)] += 0.5 * stiffness;
                    springs[(a, b)] -= 0.5 * stiffness;
                    springs[(b, a)] -= 0.5 * stiffness;
                }
                // Pressure pushes aside: n of a point with t1 of its neighbour.
                if let (0, Some(other)) = (direction, right) {
                    let (a, b) = (joint(i, 0), joint(other, 1));
                    springs[(a, b)] += 0.1;
                    springs[(b, a)] += 0.1;
                }
            }
            let rows = [[0.0, 0.0, 1.0, y, -x, 0.0], [1.0, 0.0, 0.0, 0.0, 0.0, -y], [0.0, 1.0, 0.0, 0.0, 0.0, x]];
            for (direction, row) in rows.iter().enumerate() {
                row.iter().enumerate().for_each(|(k, value)| motions[(joint(i, direction), k)] = *value);
            }
        }
        let weight = m as f64;
        let push = 0.8 * FRICTION * weight;
        let (sin, cos) = (17.0 / 360.0 * TAU).sin_cos();
        // Moments about x and y lift an edge; about z twist.
        let resultant = [push * cos, push * sin, -weight, 0.12 * weight, -0.15 * weight, 0.1 * FRICTION * weight];
        let forced = &springs * &motions;
        let inverse = motions.tr_mul(&forced).try_inverse().expect("six motions");
        let r = &springs - &forced * &inverse * forced.transpose();
        let load = -(&forced * inverse * DVector::from_row_slice(&resultant));
        Block {
            stiffness: DMatrix::from_fn(3 * m, 3 * m, |i, j| r[(i.min(j), i.max(j))]),
            load,
            kernel: motions.qr().q(),
            pairs: (0..m)
                .map(|i| ConePair { law: PairLaw::rubbing(FRICTION, 0.0, 0.0), tangents: joint(i, 1)..joint(i, 2) + 1 })
                .collect(),
        }
    }

    /// The answer on the cone that Newton's method finds from `start`.
    ///
    /// # Errors
    /// Where it finds none.
    pub fn answer(&self, start: &DVector<f64>) -> Result<ConeAnswer, ConeFailure> {
        let problem = ConeProblem {
            stiffness: &self.stiffness,
            load: &self.load,
            load_terms: &self.load.abs(),
            rounded: true,
            kernel: &self.kernel,
            pairs: &self.pairs,
        };
        answer_on_cone(&problem, start, &Quiet)
    }

    /// An answer with every displacement off by up to `share` of itself and every slip turned by up to a fifth of a
    /// radian: as far off as that of a polygon.
    pub fn perturbed(&self, z: &DVector<f64>, share: f64) -> DVector<f64> {
        let wave = |k: usize| (k as f64 * 1.7).sin();
        let mut z = DVector::from_fn(z.len(), |k, _| z[k] * (1.0 + share * wave(k)));
        for (i, pair) in self.pairs.iter().enumerate() {
            let (t, u) = (pair.tangents.start, pair.tangents.start + 1);
            let (sin, cos) = (0.2 * wave(3 * i)).sin_cos();
            (z[t], z[u]) = (cos * z[t] - sin * z[u], sin * z[t] + cos * z[u]);
        }
        z
    }

    /// R, z = 0 of all joints.
    pub fn at_rest(&self) -> DVector<f64> {
        DVector::zeros(self.load.len())
    }
}
