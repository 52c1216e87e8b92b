//! Loads between the ends of a bar element, and the internal forces along it that they leave.
//!
//! ```text
//!     N' = −q_x     Q' = q_y     M' = Q        bar axes: x from start to end, y = x turned +90°
//!     at a point:   N jumps by −F_x,  Q by F_y,  M by −m (m counter-clockwise)
//! ```

use super::Acting;
use super::axis::Axis;
use crate::model::structure::ElementLoad;

/// A force per length that varies linearly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Distances from the start of the element between which it acts.
    pub range: [f64; 2],
    /// (q_x, q_y) at both of them, bar axes.
    pub force: [[f64; 2]; 2],
}

/// A force and a moment at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointForce {
    /// Distance from the start of the element.
    pub at: f64,
    /// (F_x, F_y), bar axes.
    pub force: [f64; 2],
    /// Moment, counter-clockwise.
    pub moment: f64,
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
    /// Free curvature, > 0 when the −y side is the longer one: M = EI (κ − curvature).
    pub curvature: f64,
}

/// Internal forces (N, Q, M) at one place: N > 0 tension, Q = dM/dx, M > 0 tension on the −y side.
pub type Internal = [f64; 3];

/// Internal forces of a bar element.
pub struct BarForces {
    /// Its length.
    pub length: f64,
    /// At its start and at its end.
    pub ends: [Internal; 2],
    /// In between; distances from its start.
    pub pieces: Vec<Piece>,
}

impl Span {
    /// (q_x, q_y) at a distance from the start of the element.
    pub fn at(&self, s: f64) -> [f64; 2] {
        let [a, b] = self.range;
        let t = (s - a) / (b - a);
        std::array::from_fn(|i| (1.0 - t) * self.force[0][i] + t * self.force[1][i])
    }
}

impl BarLoad {
    /// All that acts on a bar element of this cross-section.
    pub fn of(acting: &Acting, axis: &Axis, area: f64) -> BarLoad {
        let mut all = BarLoad::default();
        for &(factor, load) in acting {
            match *load {
                ElementLoad::Line { range, value } => all.add_line(axis, range, value, factor),
                ElementLoad::Point { distance, force, moment } => all.add_point(axis, distance, force, moment, factor),
                ElementLoad::Body(value) => {
                    all.add_line(axis, [0.0, axis.length], [value.map(|b| area * b); 2], factor);
                }
                ElementLoad::FreeStrain { strain, curvature } => {
                    all.strain += factor * strain;
                    all.curvature += factor * curvature;
                }
            }
        }
        all
    }

    /// Adds a linear force per length given in global axes.
    fn add_line(&mut self, axis: &Axis, range: [f64; 2], force: [[f64; 2]; 2], factor: f64) {
        let force = force.map(|q| axis.to_local(q).map(|q| factor * q));
        if range[1] > range[0] && force != [[0.0; 2]; 2] {
            self.spans.push(Span { range, force });
        }
    }

    /// Adds a force in global axes and a moment at one place.
    fn add_point(&mut self, axis: &Axis, at: f64, force: [f64; 2], moment: f64, factor: f64) {
        let force = axis.to_local(force).map(|f| factor * f);
        if force != [0.0; 2] || moment * factor != 0.0 {
            self.points.push(PointForce { at, force, moment: factor * moment });
        }
    }

    /// ∫ weight(s)·q(s) ds + Σ weight(s)·F: what the distributed and single forces do on the displacements `weight`
    /// = (along x, along y, rotation) of the places. Exact for weights up to the fourth degree.
    pub fn work(&self, weight: &dyn Fn(f64) -> [f64; 3]) -> f64 {
        // Three Gauss points: exact to degree 5, of which the load takes one.
        let g = 0.6_f64.sqrt();
        let mut sum = 0.0;
        for span in &self.spans {
            let [a, b] = span.range;
            let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
            for (x, w) in [(-g, 5.0 / 9.0), (0.0, 8.0 / 9.0), (g, 5.0 / 9.0)] {
                let s = middle + half * x;
                let (q, n) = (span.at(s), weight(s));
                sum += w * half * (q[0] * n[0] + q[1] * n[1]);
            }
        }
        for point in &self.points {
            let n = weight(point.at);
            sum += point.force[0] * n[0] + point.force[1] * n[1] + point.moment * n[2];
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
                now = [now[0] - point.force[0], now[1] + point.force[1], now[2] - point.moment];
            }
            let middle = 0.5 * (ends[0] + ends[1]);
            let mut q = [[0.0; 2]; 2];
            for span in self.spans.iter().filter(|span| span.range[0] < middle && middle < span.range[1]) {
                for (q, s) in q.iter_mut().zip(ends) {
                    let [x, y] = span.at(*s);
                    *q = [q[0] + x, q[1] + y];
                }
            }
            let piece = Piece { range: [ends[0], ends[1]], start: now, q };
            now = piece.at(ends[1]);
            pieces.push(piece);
        }
        pieces
    }
}

/// A stretch of a bar without a jump: N and Q are quadratic, M is cubic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Distances of its ends.
    pub range: [f64; 2],
    /// (N, Q, M) at its start.
    pub start: Internal,
    /// (q_x, q_y) at its ends, bar axes.
    pub q: [[f64; 2]; 2],
}

impl Piece {
    /// (N, Q, M) at a distance inside it.
    pub fn at(&self, s: f64) -> Internal {
        let length = self.range[1] - self.range[0];
        let x = s - self.range[0];
        let slope = |i: usize| (self.q[1][i] - self.q[0][i]) / length;
        let [n, q, m] = self.start;
        let (qx, qy) = (self.q[0][0], self.q[0][1]);
        [
            n - x * (qx + 0.5 * slope(0) * x),
            q + x * (qy + 0.5 * slope(1) * x),
            m + x * (q + x * (0.5 * qy + slope(1) * x / 6.0)),
        ]
    }

    /// N, Q and M as polynomials in the distance from the start of the piece: coefficients of its powers from 0 on,
    /// without zeros at the end.
    pub fn polynomials(&self) -> [Vec<f64>; 3] {
        let length = self.range[1] - self.range[0];
        let slope = |i: usize| (self.q[1][i] - self.q[0][i]) / length;
        let [n, q, m] = self.start;
        let (qx, qy) = (self.q[0][0], self.q[0][1]);
        let all = [vec![n, -qx, -0.5 * slope(0)], vec![q, qy, 0.5 * slope(1)], vec![m, q, 0.5 * qy, slope(1) / 6.0]];
        all.map(|mut powers| {
            powers.truncate(powers.iter().rposition(|c| *c != 0.0).map_or(1, |last| last + 1));
            powers
        })
    }

    /// Places where N (0), Q (1) or M (2) may be largest or smallest: the ends and where the derivative vanishes.
    pub fn candidates(&self, which: usize) -> Vec<f64> {
        let [from, to] = self.range;
        let length = to - from;
        let slope = |i: usize| (self.q[1][i] - self.q[0][i]) / length;
        let inside: Vec<f64> = match which {
            0 => vec![-self.q[0][0] / slope(0)],
            1 => vec![-self.q[0][1] / slope(1)],
            _ => {
                // Q(x) = Q0 + q0 x + slope x²/2 = 0, without cancellation.
                let (a, b, c) = (0.5 * slope(1), self.q[0][1], self.start[1]);
                let root = (b * b - 4.0 * a * c).sqrt();
                let r = -0.5 * (b + b.signum() * root);
                vec![r / a, c / r]
            }
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
            spans: vec![Span { range: [0.0, length], force: [[0.0, 0.0], [0.0, -w]] }],
            ..BarLoad::default()
        };
        let pieces = load.pieces([0.0, w * length / 6.0, 0.0], length);
        let [piece] = &pieces[..] else { panic!("{pieces:?}") };
        let end = piece.at(length);
        assert!((end[1] + w * length / 3.0).abs() < 1e-14 && end[2].abs() < 1e-14);
        let best = piece.candidates(2).into_iter().map(|s| (s, piece.at(s)[2])).max_by(|a, b| a.1.total_cmp(&b.1));
        let (s, m) = best.unwrap();
        assert!((s - length / 3.0_f64.sqrt()).abs() < 1e-14);
        assert!((m - w * length * length / (9.0 * 3.0_f64.sqrt())).abs() < 1e-14);
    }

    /// A force, a couple and a part load: the jumps stand where they act, and the far end is what statics says.
    #[test]
    fn jumps_and_part_loads() {
        let load = BarLoad {
            spans: vec![Span { range: [1.0, 2.0], force: [[2.0, -6.0], [2.0, -6.0]] }],
            points: vec![
                PointForce { at: 0.5, force: [1.0, -4.0], moment: 0.0 },
                PointForce { at: 2.5, force: [0.0, 0.0], moment: 3.0 },
            ],
            ..BarLoad::default()
        };
        let pieces = load.pieces([10.0, 7.0, 1.0], 3.0);
        assert_eq!(pieces.len(), 5);
        let end = pieces[4].at(3.0);
        // N: 10 − 1 − 2; Q: 7 − 4 − 6; M: 1 + 7·3 − 4·2.5 − 6·1.5 − 3.
        for (found, right) in end.into_iter().zip([7.0, -3.0, 0.0]) {
            assert!((found - right).abs() < 1e-14, "{end:?}");
        }
        assert_eq!(pieces[1].start, [9.0, 3.0, 1.0 + 3.5]);
    }
}
