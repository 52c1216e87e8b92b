//! Loads between the ends of a bar element, and the internal forces along it that they leave.
//!
//! ```text
//!     N' = −q_x     V_y' = q_y   M_z' = V_y     V_z' = q_z   M_y' = V_z     T' = 0
//!     at a point:   N jumps by −F_x;  V_y by F_y, M_z by −m_z;  V_z by F_z, M_y by m_y;  T by −m_x
//! ```
//! in bar axes (x from start to end; in the plane y = x turned +90°), moments right-handed. In the plane V_y is Q and
//! M_z is M. In the x–z plane a bar bends as in x–y, with its rotation from x to z: −r_y.

use super::acting::Acting;
use crate::model::bar_axes::BarAxes;
use crate::model::structure::ElementLoad;

/// Displacements of a place of a bar, then its rotations: u_x, u_y, u_z, r_x, r_y, r_z; or forces and moments on it.
pub type Motion = [f64; 6];

/// A force per length that varies linearly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Distances from the start of the element between which it acts.
    pub range: [f64; 2],
    /// (q_x, q_y, q_z) at both of them, bar axes.
    pub force: [[f64; 3]; 2],
}

/// A force and a moment at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointForce {
    /// Distance from the start of the element.
    pub at: f64,
    /// (F_x, F_y, F_z, m_x, m_y, m_z), bar axes.
    pub force: Motion,
}

/// All that acts on one bar element between its nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BarLoad {
    /// Forces per length.
    pub spans: Vec<Span>,
    /// Forces and moments at places.
    pub points: Vec<PointForce>,
    /// Free axial strain (temperature, lack of fit): N = EA (ε − strain).
    pub strain: f64,
    /// Free curvature in x–y, > 0 when the −y side is the longer one, and in x–z likewise: M = EI (κ − curvature).
    pub curvature: [f64; 2],
}

/// Internal forces at one place: N, V_y, M_z, V_z, M_y, T. N > 0 tension; V_y = dM_z/dx, M_z > 0 tension on the −y
/// side; V_z = dM_y/dx, M_y > 0 tension on the −z side; T along +x on the cut that faces it. The plane has the first
/// three.
pub type Internal = [f64; 6];

/// The two planes in which a bar bends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bending {
    /// The local x–y plane: V_y, M_z.
    Xy,
    /// The local x–z plane: V_z, M_y.
    Xz,
}

/// Internal forces of a bar element.
pub struct BarForces {
    /// Its length.
    pub length: f64,
    /// At its start and at its end.
    pub ends: [Internal; 2],
    /// In between; distances from its start.
    pub pieces: Vec<Piece>,
}

impl BarForces {
    /// ∫ Σ force²/2·stiffness ds with the stiffness of the bar against each internal force: EA, GA_y, EI_z, GA_z, EI_y, GJ; it
    /// does not yield where one is infinite. Exact.
    pub(super) fn strain_energy(&self, stiffnesses: &Internal) -> f64 {
        // Four Gauss points: exact to degree 7; the square of a bending moment has degree 6.
        let of_place = |forces: Internal| -> f64 {
            let terms = std::iter::zip(forces, stiffnesses).filter(|(force, _)| *force != 0.0);
            terms.map(|(force, stiffness)| 0.5 * force * force / stiffness).sum()
        };
        let spread = 2.0 / 7.0 * 1.2_f64.sqrt();
        let [inner, outer] = [3.0 / 7.0 - spread, 3.0 / 7.0 + spread].map(f64::sqrt);
        let [heavy, light] = [18.0 + 30.0_f64.sqrt(), 18.0 - 30.0_f64.sqrt()].map(|weight| weight / 36.0);
        let of_piece = |piece: &Piece| -> f64 {
            let [a, b] = piece.range;
            let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
            let points = [(-outer, light), (-inner, heavy), (inner, heavy), (outer, light)];
            half * points.iter().map(|(x, weight)| weight * of_place(piece.at(middle + half * x))).sum::<f64>()
        };
        self.pieces.iter().map(of_piece).sum()
    }
}

impl Bending {
    /// Motion of a place that moves by `u` along the bar and by `v` across it, and turns by `turn` from x to the other
    /// axis.
    pub fn motion(self, [u, v, turn]: [f64; 3]) -> Motion {
        match self {
            Bending::Xy => [u, v, 0.0, 0.0, 0.0, turn],
            Bending::Xz => [u, 0.0, v, 0.0, -turn, 0.0],
        }
    }

    /// Shear force and bending moment among the internal forces.
    pub(super) fn forces(self) -> [usize; 2] {
        match self {
            Bending::Xy => [1, 2],
            Bending::Xz => [3, 4],
        }
    }

    /// The component of q that bends.
    fn across(self) -> usize {
        match self {
            Bending::Xy => 1,
            Bending::Xz => 2,
        }
    }
}

impl Span {
    /// (q_x, q_y, q_z) at a distance from the start of the element, bar axes, force per length.
    pub fn at(&self, s: f64) -> [f64; 3] {
        let [a, b] = self.range;
        let t = (s - a) / (b - a);
        std::array::from_fn(|i| (1.0 - t) * self.force[0][i] + t * self.force[1][i])
    }
}

impl BarLoad {
    /// All that acts on a bar element of this cross-section.
    pub fn of(acting: &Acting, axes: &BarAxes, area: f64) -> BarLoad {
        let mut all = BarLoad::default();
        for &(factor, load) in acting {
            match *load {
                ElementLoad::Line { range, value } => {
                    all.add_line(axes, range, value, factor);
                }
                ElementLoad::Point { distance, force, moment } => {
                    all.add_point(axes, distance, force, moment, factor);
                }
                ElementLoad::Body(value) => {
                    all.add_line(axes, [0.0, axes.length], [value.map(|b| area * b); 2], factor);
                }
                ElementLoad::FreeStrain { strain, curvature } => {
                    all.strain += factor * strain;
                    std::iter::zip(&mut all.curvature, curvature)
                        .for_each(|(all, curvature)| *all += factor * curvature);
                }
            }
        }
        all
    }

    /// Adds a linear force per length given in global axes.
    fn add_line(&mut self, axes: &BarAxes, range: [f64; 2], force: [[f64; 3]; 2], factor: f64) {
        let force = force.map(|q| axes.to_local(q).map(|q| factor * q));
        if range[1] > range[0] && force != [[0.0; 3]; 2] {
            self.spans.push(Span { range, force });
        }
    }

    /// Adds a force and a moment in global axes at one place.
    fn add_point(&mut self, axes: &BarAxes, at: f64, force: [f64; 3], moment: [f64; 3], factor: f64) {
        let ([x, y, z], [mx, my, mz]) = (axes.to_local(force), axes.to_local(moment));
        let force = [x, y, z, mx, my, mz].map(|f| factor * f);
        if force != [0.0; 6] {
            self.points.push(PointForce { at, force });
        }
    }

    /// ∫ weight(s)·q(s) ds + Σ weight(s)·F: the work of the distributed and single forces on the displacements `weight`
    /// of the places. Exact for weights up to the fourth degree.
    pub fn work(&self, weight: &dyn Fn(f64) -> Motion) -> f64 {
        // Three Gauss points: exact to degree 5, of which the load takes one.
        let g = 0.6_f64.sqrt();
        let mut sum = 0.0;
        for span in &self.spans {
            let [a, b] = span.range;
            let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
            for (x, w) in [(-g, 5.0 / 9.0), (0.0, 8.0 / 9.0), (g, 5.0 / 9.0)] {
                let s = middle + half * x;
                let (q, n) = (span.at(s), weight(s));
                sum += w * half * (q[0] * n[0] + q[1] * n[1] + q[2] * n[2]);
            }
        }
        for point in &self.points {
            let n = weight(point.at);
            sum += point.force.iter().zip(n).map(|(force, n)| force * n).sum::<f64>();
        }
        sum
    }

    /// The internal forces of an element of this length that has `ends` at its ends.
    pub fn forces_along(&self, ends: [Internal; 2], length: f64) -> BarForces {
        BarForces { length, ends, pieces: self.pieces(ends[0], length) }
    }

    /// The internal forces along an element of this length that begins with `start`: pieces between the places where
    /// a load begins, ends or acts, with nothing but a linear q inside.
    fn pieces(&self, start: Internal, length: f64) -> Vec<Piece> {
        let mut cuts: Vec<f64> = vec![0.0, length];
        cuts.extend(self.spans.iter().flat_map(|span| span.range));
        cuts.extend(self.points.iter().map(|point| point.at));
        cuts.retain(|s| (0.0..=length).contains(s));
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        let mut pieces = Vec::with_capacity(cuts.len());
        let mut now = start;
        for ends in cuts.windows(2) {
            for point in self.points.iter().filter(|point| point.at == ends[0]) {
                let [x, y, z, mx, my, mz] = point.force;
                let jumps = [-x, y, -mz, z, my, -mx];
                now.iter_mut().zip(jumps).for_each(|(force, jump)| *force += jump);
            }
            let middle = 0.5 * (ends[0] + ends[1]);
            let mut q = [[0.0; 3]; 2];
            for span in self.spans.iter().filter(|span| span.range[0] < middle && middle < span.range[1]) {
                for (q, s) in q.iter_mut().zip(ends) {
                    q.iter_mut().zip(span.at(*s)).for_each(|(q, more)| *q += more);
                }
            }
            let piece = Piece { range: [ends[0], ends[1]], start: now, q };
            now = piece.at(ends[1]);
            pieces.push(piece);
        }
        pieces
    }
}

/// A stretch of a bar without a jump: N and the shear forces are quadratic, the bending moments cubic, T is constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Distances of its ends.
    pub range: [f64; 2],
    /// The internal forces at its start.
    pub start: Internal,
    /// (q_x, q_y, q_z) at its ends, bar axes.
    pub q: [[f64; 3]; 2],
}

impl Piece {
    /// The internal forces at a distance inside it.
    pub fn at(&self, s: f64) -> Internal {
        let x = s - self.range[0];
        let mut all = self.start;
        let (qx, slope) = self.load(0);
        all[0] = self.start[0] - x * (qx + 0.5 * slope * x);
        for bending in [Bending::Xy, Bending::Xz] {
            let [shear, moment] = bending.forces();
            let (v, (q, slope)) = (self.start[shear], self.load(bending.across()));
            all[shear] = v + x * (q + 0.5 * slope * x);
            all[moment] = self.start[moment] + x * (v + x * (0.5 * q + slope * x / 6.0));
        }
        all
    }

    /// A component of q at the start, and by how much it grows per length.
    fn load(&self, component: usize) -> (f64, f64) {
        let [a, b] = self.q.map(|q| q[component]);
        (a, (b - a) / (self.range[1] - self.range[0]))
    }

    /// The internal forces, with the signs of the module, as polynomials in the distance from the start of the piece:
    /// coefficients of its powers from 0 on, without zeros at the end.
    pub fn polynomials(&self) -> [Vec<f64>; 6] {
        let mut all = self.start.map(|constant| vec![constant]);
        let (qx, slope) = self.load(0);
        all[0].extend([-qx, -0.5 * slope]);
        for bending in [Bending::Xy, Bending::Xz] {
            let [shear, moment] = bending.forces();
            let (q, slope) = self.load(bending.across());
            all[shear].extend([q, 0.5 * slope]);
            all[moment].extend([self.start[shear], 0.5 * q, slope / 6.0]);
        }
        all.map(|mut powers| {
            powers.truncate(powers.iter().rposition(|c| *c != 0.0).map_or(1, |last| last + 1));
            powers
        })
    }

    /// Places, distances from the start of the piece, where the internal force number `which` may be largest or
    /// smallest: the ends and where its derivative vanishes.
    pub fn candidates(&self, which: usize) -> Vec<f64> {
        let [from, to] = self.range;
        let length = to - from;
        let vanishes = |(q, slope): (f64, f64)| vec![-q / slope];
        let inside: Vec<f64> = match which {
            0 => vanishes(self.load(0)),
            1 => vanishes(self.load(1)),
            3 => vanishes(self.load(2)),
            2 | 4 => {
                let bending = if which == 2 { Bending::Xy } else { Bending::Xz };
                // V(x) = V0 + q0 x + slope x²/2 = 0, without cancellation.
                let (q, slope) = self.load(bending.across());
                let (a, b, c) = (0.5 * slope, q, self.start[bending.forces()[0]]);
                let root = (b * b - 4.0 * a * c).sqrt();
                let r = -0.5 * (b + b.signum() * root);
                vec![r / a, c / r]
            }
            _ => Vec::new(),
        };
        let inside = inside.into_iter().filter(|x| *x > 0.0 && *x < length).map(|x| from + x);
        [from].into_iter().chain(inside).chain([to]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Simple beam of length 4 under a triangle from 0 to w at its end: R = wL/6, Q(x) = R − w x²/2L,
    /// M = R x − w x³/6L, largest at L/√3: w L²/9√3.
    #[test]
    fn triangle_on_a_simple_beam() {
        let (w, length) = (3.0, 4.0);
        let load = BarLoad {
            spans: vec![Span { range: [0.0, length], force: [[0.0; 3], [0.0, -w, 0.0]] }],
            ..BarLoad::default()
        };
        let pieces = load.pieces([0.0, w * length / 6.0, 0.0, 0.0, 0.0, 0.0], length);
        let [piece] = &pieces[..] else { panic!("{pieces:?}") };
        let end = piece.at(length);
        assert!((end[1] + w * length / 3.0).abs() < 1e-14 && end[2].abs() < 1e-14);
        let best = piece.candidates(2).into_iter().map(|s| (s, piece.at(s)[2])).max_by(|a, b| a.1.total_cmp(&b.1));
        let (s, m) = best.unwrap();
        assert!((s - length / 3.0_f64.sqrt()).abs() < 1e-14);
        assert!((m - w * length * length / (9.0 * 3.0_f64.sqrt())).abs() < 1e-14);
    }

    /// A force, a couple and a part load: the jumps stand where they act, and the far end is what statics says. The
    /// same across z, where a couple from x to z is −m_y.
    #[test]
    fn jumps_and_part_loads() {
        let load = BarLoad {
            spans: vec![Span { range: [1.0, 2.0], force: [[2.0, -6.0, -3.0]; 2] }],
            points: vec![
                PointForce { at: 0.5, force: [1.0, -4.0, -2.0, 5.0, 0.0, 0.0] },
                PointForce { at: 2.5, force: [0.0, 0.0, 0.0, 1.0, -1.5, 3.0] },
            ],
            ..BarLoad::default()
        };
        let pieces = load.pieces([10.0, 7.0, 1.0, 3.5, 0.5, 2.0], 3.0);
        assert_eq!(pieces.len(), 5);
        let end = pieces[4].at(3.0);
        // N: 10 − 1 − 2; V_y: 7 − 4 − 6; M_z: 1 + 7·3 − 4·2.5 − 6·1.5 − 3; V_z and M_y half of them; T: 2 − 5 − 1.
        for (found, right) in end.into_iter().zip([7.0, -3.0, 0.0, -1.5, 0.0, -4.0]) {
            assert!((found - right).abs() < 1e-14, "{end:?}");
        }
        assert_eq!(pieces[1].start, [9.0, 3.0, 1.0 + 3.5, 1.5, 0.5 + 1.75, -3.0]);
    }

    /// Polynomials are what [`Piece::at`] says, and extremes lie at the zeros of the derivative: V_z = 1 − s + s²/4 − …
    #[test]
    fn both_planes_alike() {
        let start = [1.0, 2.0, -0.5, 2.0, -0.5, 4.0];
        let piece = Piece { range: [1.0, 3.0], start, q: [[0.5, -1.5, -1.5], [-0.25, -2.5, -2.5]] };
        let polynomials = piece.polynomials();
        for s in [1.0, 1.3, 2.9] {
            for (powers, value) in polynomials.iter().zip(piece.at(s)) {
                let sum: f64 = powers.iter().rev().fold(0.0, |sum, power| sum * (s - 1.0) + power);
                assert!((sum - value).abs() < 1e-14);
            }
        }
        assert_eq!((&polynomials[3], &polynomials[4]), (&polynomials[1], &polynomials[2]));
        assert_eq!((piece.candidates(1), piece.candidates(2)), (piece.candidates(3), piece.candidates(4)));
        // 2 − 1.5 x − 0.25 x² = 0 at x = −3 + √17.
        let at = piece.candidates(4)[1];
        assert!((at - (17.0_f64.sqrt() - 2.0)).abs() < 1e-15);
        assert_eq!(piece.candidates(5), [1.0, 3.0]);
    }
}
