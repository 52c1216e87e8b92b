//! A bar in one plane of its axes: it stretches and bends, yields to shear where its section has a shear area, and may
//! have moment hinges.
//!
//! ```text
//!            EA/L on (u1, u2);      with Φ = 12EI/(G A_s L²), 0 without a shear area (Euler–Bernoulli)
//!            a = 12EI/L³(1+Φ), b = 6EI/L²(1+Φ), c = (4+Φ)EI/L(1+Φ), d = (2−Φ)EI/L(1+Φ)
//!
//!         v1  θ1  v2  θ2
//!     [   a   b  −a   b ]           x from start to end, v across it,
//!     [   b   c  −b   d ]           θ from x to v
//!     [  −a  −b   a  −b ]
//!     [   b   d  −b   c ]
//! ```
//!
//! A hinge releases the element's own rotation at that end, which is condensed out:
//! k ← k − k_r k_rᵀ / k_rr, f ← f − k_r f_r / k_rr. Its row and column are then zero. Loads between the nodes become
//! nodal forces by the exact displacements of the unloaded element, so that nodes move as in beam theory
//! (Przemieniecki, *Theory of Matrix Structural Analysis*, 1968, ch. 5 and 6).

use nalgebra::{SMatrix, SVector};

use super::bar_load::{BarForces, BarLoad, Bending, Piece};
use crate::doubled::Real;

/// Rows u, v, θ of the start, then of the end.
pub type Matrix6<T = f64> = SMatrix<T, 6, 6>;
pub type Vector6 = SVector<f64, 6>;

/// A bar in one plane of its axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    /// The plane.
    pub plane: Bending,
    /// EA.
    pub axial: f64,
    /// EI.
    pub bending: f64,
    /// G A_s; `None` for a bar that does not yield to shear.
    pub shear: Option<f64>,
    /// Moment hinge at start, at end.
    pub hinges: [bool; 2],
}

impl Beam {
    /// Φ = 12EI/(G A_s L²).
    fn shear_number<T: Real>(&self, length: T) -> T {
        self.shear.map_or(T::zero(), |shear| T::from(12.0 * self.bending / shear) / (length * length))
    }

    /// Stiffness in bar axes without hinges.
    fn rigid_ended<T: Real>(&self, length: T) -> Matrix6<T> {
        let phi = self.shear_number(length);
        let (o, number) = (T::zero(), T::from);
        let ea = number(self.axial) / length;
        let c1 = number(self.bending) / (T::one() + phi) / length;
        let b1 = c1 / length;
        let a = number(12.0) * b1 / length;
        let b = number(6.0) * b1;
        let c = (number(4.0) + phi) * c1;
        let d = (number(2.0) - phi) * c1;
        #[rustfmt::skip]
        let full = Matrix6::from_row_slice(&[
             ea,  o,  o, -ea,  o,  o,
              o,  a,  b,   o, -a,  b,
              o,  b,  c,   o, -b,  d,
            -ea,  o,  o,  ea,  o,  o,
              o, -a, -b,   o,  a, -b,
              o,  b,  d,   o, -b,  c,
        ]);
        full
    }

    /// Stiffness in bar axes: forces and moments at both ends per displacement and radian.
    pub fn stiffness<T: Real>(&self, length: T) -> Matrix6<T> {
        let ea = T::from(self.axial) / length;
        // The closed forms of the condensed matrices, so that zeros are exact zeros.
        let c3 = T::from(3.0 * self.bending) / (T::one() + T::from(0.25) * self.shear_number(length)) / length;
        let b3 = c3 / length;
        let a3 = b3 / length;
        let o = T::zero();
        let bending: Option<[(usize, T); 4]> = match self.hinges {
            [false, false] => return self.rigid_ended(length),
            // M = c3·(θ − chord rotation) at the end that is not released.
            [true, false] => Some([(1, a3), (2, o), (4, -a3), (5, b3)]),
            [false, true] => Some([(1, a3), (2, b3), (4, -a3), (5, o)]),
            [true, true] => None,
        };
        let mut k = Matrix6::zeros();
        for (i, j, value) in [(0, 0, ea), (3, 3, ea), (0, 3, -ea), (3, 0, -ea)] {
            k[(i, j)] = value;
        }
        if let Some(shear) = bending {
            // Row v1 is `shear`; row v2 its negative; the rotation that is left: b3·(v1 − v2) + c3·θ.
            for (j, value) in shear {
                k[(1, j)] = value;
                k[(4, j)] = -value;
            }
            let r = if self.hinges[0] { 5 } else { 2 };
            k[(r, 1)] = b3;
            k[(r, 4)] = -b3;
            k[(r, r)] = c3;
        }
        k
    }

    /// Displacements (along x, across it, rotation of the section) at a distance from the start when row `row` of the
    /// element without hinges is displaced by 1 and nothing acts between its nodes.
    fn shape(&self, row: usize, s: f64, length: f64) -> [f64; 3] {
        let phi = self.shear_number(length);
        let x = s / length;
        let (x2, x3, over) = (x * x, x * x * x, 1.0 / (1.0 + phi));
        match row {
            0 => [1.0 - x, 0.0, 0.0],
            3 => [x, 0.0, 0.0],
            1 => [0.0, (1.0 - 3.0 * x2 + 2.0 * x3 + phi * (1.0 - x)) * over, 6.0 / length * (x2 - x) * over],
            4 => [0.0, (3.0 * x2 - 2.0 * x3 + phi * x) * over, 6.0 / length * (x - x2) * over],
            2 => [
                0.0,
                length * (x - 2.0 * x2 + x3 + 0.5 * phi * (x - x2)) * over,
                (1.0 - 4.0 * x + 3.0 * x2 + phi * (1.0 - x)) * over,
            ],
            _ => [0.0, length * (x3 - x2 - 0.5 * phi * (x - x2)) * over, (3.0 * x2 - 2.0 * x + phi * x) * over],
        }
    }

    /// Forces and moments on the ends in bar axes that stand for the load between them.
    pub fn forces(&self, load: &BarLoad, length: f64) -> Vector6 {
        let mut f = Vector6::from_fn(|row, _| load.work(&|s| self.plane.motion(self.shape(row, s, length))));
        let (normal, moment) = (self.axial * load.strain, self.bending * load.curvature[self.plane as usize]);
        f += Vector6::from([-normal, 0.0, -moment, normal, 0.0, moment]);
        if self.hinges != [false; 2] {
            let mut k = self.rigid_ended(length);
            for (r, _) in [(2, 0), (5, 1)].into_iter().filter(|(_, end)| self.hinges[*end]) {
                let column: Vector6 = k.column(r).into();
                f -= column * (f[r] / k[(r, r)]);
                f[r] = 0.0;
                k -= column * column.transpose() / column[r];
            }
        }
        f
    }

    /// The elastic curve: displacements along the bar and across it at these distances from its start (ascending), from
    /// (u, v) at its start to v at its end.
    ///
    /// ```text
    ///     u' = N/EA + ε₀     θ' = M/EI + κ₀     v' = θ − V/(G A_s)
    /// ```
    pub fn curve(
        &self,
        load: &BarLoad,
        forces: &BarForces,
        start: [f64; 2],
        end: f64,
        places: &[f64],
    ) -> Vec<[f64; 2]> {
        let [shear, moment] = self.plane.forces();
        let curvature = load.curvature[self.plane as usize];
        // u, θ and v at a distance inside a piece, from those at its start
        let within = |piece: &Piece, powers: &[Vec<f64>; 6], [u, turn, v]: [f64; 3], s: f64| {
            let x = s - piece.range[0];
            let [[n, _], [q, _], [m, twice]] = [0, shear, moment].map(|which| integrals(&powers[which], x));
            let sheared = self.shear.map_or(0.0, |stiffness| q / stiffness);
            [
                u + n / self.axial + load.strain * x,
                turn + m / self.bending + curvature * x,
                v + turn * x + twice / self.bending + 0.5 * curvature * x * x - sheared,
            ]
        };
        // as if it began flat …
        let mut at = [0.0; 3];
        let pieces = forces.pieces.iter().map(|piece| {
            let (powers, from) = (piece.polynomials(), at);
            at = within(piece, &powers, from, piece.range[1]);
            (piece, powers, from)
        });
        let pieces: Vec<_> = pieces.collect();
        // … and tilted as it lies
        let tilt = (end - start[1] - at[2]) / forces.length;
        let place = |&s: &f64| {
            let piece = pieces.partition_point(|(piece, ..)| piece.range[1] < s);
            let (piece, powers, from) = &pieces[piece.min(pieces.len() - 1)];
            let [u, _, v] = within(piece, powers, *from, s);
            [start[0] + u, start[1] + tilt * s + v]
        };
        places.iter().map(place).collect()
    }
}

/// ∫ and ∫∫ of a polynomial from 0 to x.
fn integrals(powers: &[f64], x: f64) -> [f64; 2] {
    let (mut sums, mut power) = ([0.0; 2], x);
    for (coefficient, k) in powers.iter().zip(1..) {
        let k = f64::from(k);
        sums[0] += coefficient * power / k;
        sums[1] += coefficient * power * x / (k * (k + 1.0));
        power *= x;
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::super::bar_load::{PointForce, Span};
    use super::*;

    const LENGTH: f64 = 2.5;
    const HINGES: [[bool; 2]; 4] = [[false; 2], [true, false], [false, true], [true, true]];

    fn beam(hinges: [bool; 2], shear: Option<f64>) -> Beam {
        Beam { plane: Bending::Xy, axial: 21.0, bending: 14.0, shear, hinges }
    }

    fn uniform([x, y]: [f64; 2]) -> BarLoad {
        BarLoad { spans: vec![Span { range: [0.0, LENGTH], force: [[x, y, 0.0]; 2] }], ..BarLoad::default() }
    }

    /// The closed forms against k − k_r k_rᵀ / k_rr worked out from the full matrix.
    #[test]
    fn hinges_are_condensed_rotations() {
        for shear in [None, Some(5.0)] {
            let full = beam([false; 2], shear).stiffness(LENGTH);
            for hinges in HINGES {
                let mut k = full;
                for (r, released) in [(2, hinges[0]), (5, hinges[1])] {
                    if released {
                        let column: Vector6 = k.column(r).into();
                        k -= column * column.transpose() / column[r];
                    }
                }
                let closed = beam(hinges, shear).stiffness(LENGTH);
                assert!((closed - k).amax() < 1e-13 * full.amax(), "{hinges:?}");
            }
        }
    }

    /// qL/2 and ± qL²/12; with a hinge 3/8, 5/8 of qL and qL²/8 at the other end.
    #[test]
    fn uniform_load() {
        let (qx, qy, l) = (0.3, -1.7, LENGTH);
        for (hinges, [v1, m1, v2, m2]) in HINGES.into_iter().zip([
            [0.5, 1.0 / 12.0, 0.5, -1.0 / 12.0],
            [0.375, 0.0, 0.625, -0.125],
            [0.625, 0.125, 0.375, 0.0],
            [0.5, 0.0, 0.5, 0.0],
        ]) {
            let f = beam(hinges, None).forces(&uniform([qx, qy]), LENGTH);
            let t = qy * l;
            let right = Vector6::from([0.5 * qx * l, v1 * t, m1 * t * l, 0.5 * qx * l, v2 * t, m2 * t * l]);
            assert!((f - right).amax() < 1e-14, "{hinges:?}: {f}");
        }
    }

    /// Fixed-end moments of a force P at a from the start, b from the end: P a b²/L², −P a² b/L² (Roark); of a triangle
    /// from 0 to w: wL²/30, −wL²/20; of a couple m: m b(2a − b)/L², m a(2b − a)/L².
    #[test]
    fn fixed_end_moments() {
        let l = LENGTH;
        let (a, p, w, m) = (0.8, 3.0, 2.0, 4.0);
        let b = l - a;
        let point = |force, moment| BarLoad {
            points: vec![PointForce { at: a, force: [0.0, force, 0.0, 0.0, 0.0, moment] }],
            ..BarLoad::default()
        };
        let triangle =
            BarLoad { spans: vec![Span { range: [0.0, l], force: [[0.0; 3], [0.0, w, 0.0]] }], ..BarLoad::default() };
        let cases = [
            (point(p, 0.0), [p * a * b * b / (l * l), -p * a * a * b / (l * l)]),
            (triangle, [w * l * l / 30.0, -w * l * l / 20.0]),
            (point(0.0, m), [-m * b * (2.0 * a - b) / (l * l), -m * a * (2.0 * b - a) / (l * l)]),
        ];
        for (load, [start, end]) in cases {
            let f = beam([false; 2], None).forces(&load, LENGTH);
            assert!((f[2] - start).abs() < 1e-14 && (f[5] - end).abs() < 1e-14, "{load:?}: {f}");
        }
    }

    /// A part load is the difference of two that reach the end, and loads keep resultant and moment with any hinges
    /// and with shear: Σ f_y = P, Σ m + f_y2 L = P a.
    #[test]
    fn loads_keep_their_resultant() {
        let l = LENGTH;
        for shear in [None, Some(5.0)] {
            for hinges in HINGES {
                let load = BarLoad {
                    spans: vec![Span { range: [0.4, 1.9], force: [[0.5, 1.0, 0.0], [-0.3, -2.5, 0.0]] }],
                    points: vec![PointForce { at: 2.1, force: [0.7, -1.2, 0.0, 0.0, 0.0, 0.6] }],
                    ..BarLoad::default()
                };
                let f = beam(hinges, shear).forces(&load, LENGTH);
                // ∫ q_y = −0.75·1.5; its moment ∫ s q ds by Simpson, exact for a quadratic.
                let q = |s: f64| 1.0 + (s - 0.4) / 1.5 * -3.5;
                let first = 1.5 / 6.0 * (0.4 * q(0.4) + 4.0 * 1.15 * q(1.15) + 1.9 * q(1.9));
                let (force, moment) = (-0.75 * 1.5 - 1.2, first - 1.2 * 2.1 + 0.6);
                assert!((f[1] + f[4] - force).abs() < 1e-14, "{hinges:?}");
                assert!((f[2] + f[5] + f[4] * l - moment).abs() < 1e-13, "{hinges:?}");
                assert!((f[0] + f[3] - (0.1 * 1.5 + 0.7)).abs() < 1e-14);
            }
        }
    }

    /// Bending towards z is bending towards y: the same load there gives the same forces.
    #[test]
    fn both_planes_alike() {
        for hinges in HINGES {
            let xy = beam(hinges, Some(5.0));
            let xz = Beam { plane: Bending::Xz, ..xy.clone() };
            let load = |y: usize, turn: usize, sign: f64| {
                let (mut force, mut at) = ([[0.0; 3], [0.0; 3]], [0.0; 6]);
                (force[0][y], force[1][y], at[y], at[turn]) = (1.3, -0.4, 2.0, 0.7 * sign);
                let points = vec![PointForce { at: 0.9, force: at }];
                let mut curvature = [0.0; 2];
                curvature[y - 1] = 0.1;
                BarLoad { spans: vec![Span { range: [0.2, 1.9], force }], points, strain: 0.0, curvature }
            };
            assert_eq!(xy.forces(&load(1, 5, 1.0), LENGTH), xz.forces(&load(2, 4, -1.0), LENGTH));
        }
    }

    /// Under q, under P at a and under a free curvature κ₀, between ends that turn freely or not at all (Roark), with
    /// what shear adds: q x (L − x)/2GA_s; for P the moment diagram of the simple beam over GA_s.
    #[test]
    fn elastic_curves_of_beams_between_fixed_ends() {
        let (l, ei) = (LENGTH, 14.0);
        let places: Vec<f64> = (0..=10).map(|k| 0.25 * f64::from(k)).collect();
        let (q, p, a, kappa) = (-1.7, 3.0, 1.1, 0.03);
        let b = l - a;
        let point =
            BarLoad { points: vec![PointForce { at: a, force: [0.0, p, 0.0, 0.0, 0.0, 0.0] }], ..BarLoad::default() };
        let curved = BarLoad { curvature: [kappa, 0.0], ..BarLoad::default() };
        for shear in [None, Some(5.0)] {
            let by_shear = |moment: f64| shear.map_or(0.0, |stiffness| moment / stiffness);
            let simple_point = |x: f64| if x <= a { p * b * x / l } else { p * a * (l - x) / l };
            type Curve<'a> = Box<dyn Fn(f64) -> f64 + 'a>;
            let cases: [(_, _, Curve); 4] = [
                (
                    [true; 2],
                    uniform([0.0, q]),
                    Box::new(|x: f64| {
                        q * x * (l * l * l - 2.0 * l * x * x + x * x * x) / (24.0 * ei)
                            + by_shear(0.5 * q * x * (l - x))
                    }),
                ),
                (
                    [false; 2],
                    uniform([0.0, q]),
                    Box::new(|x: f64| q * (x * (l - x)).powi(2) / (24.0 * ei) + by_shear(0.5 * q * x * (l - x))),
                ),
                (
                    [true; 2],
                    point.clone(),
                    Box::new(|x: f64| {
                        let (near, far, x) = if x <= a { (x, b, x) } else { (l - x, a, l - x) };
                        p * far * near * (l * l - far * far - near * near) / (6.0 * l * ei)
                            + by_shear(simple_point(if far == b { x } else { l - x }))
                    }),
                ),
                ([true; 2], curved.clone(), Box::new(|x: f64| 0.5 * kappa * x * (x - l))),
            ];
            for (hinges, load, expected) in cases {
                let beam = beam(hinges, shear);
                // at rest at both ends: what acts is held by the forces that stand for it
                let f = -beam.forces(&load, l);
                let ends = [[-f[0], f[1], -f[2], 0.0, 0.0, 0.0], [f[3], -f[4], f[5], 0.0, 0.0, 0.0]];
                let curve = beam.curve(&load, &load.forces_along(ends, l), [0.0; 2], 0.0, &places);
                for (x, [u, v]) in places.iter().zip(&curve) {
                    assert!((v - expected(*x)).abs() < 1e-14, "{hinges:?} {load:?}: {v} at {x}, not {}", expected(*x));
                    assert_eq!(*u, 0.0);
                }
            }
        }
    }

    /// Without a load between the nodes: a sum of the shapes that the rows have.
    #[test]
    fn elastic_curves_of_unloaded_beams_are_their_shapes() {
        let (l, none) = (LENGTH, BarLoad::default());
        let local = Vector6::from([0.3, -0.2, 0.7, 0.9, 0.4, -1.1]);
        for shear in [None, Some(5.0)] {
            let beam = beam([false; 2], shear);
            let f = beam.stiffness(l) * local;
            let ends = [[-f[0], f[1], -f[2], 0.0, 0.0, 0.0], [f[3], -f[4], f[5], 0.0, 0.0, 0.0]];
            let places = [0.0, 0.4, 1.3, l];
            let curve = beam.curve(&none, &none.forces_along(ends, l), [local[0], local[1]], local[4], &places);
            for (s, found) in places.into_iter().zip(curve) {
                let shapes = (0..6).map(|row| (local[row], beam.shape(row, s, l)));
                let [u, v] = shapes.fold([0.0; 2], |[u, v], (size, shape)| [u + size * shape[0], v + size * shape[1]]);
                assert!((found[0] - u).abs() < 1e-14 && (found[1] - v).abs() < 1e-14, "{found:?} at {s}, not {u} {v}");
            }
        }
    }
}
