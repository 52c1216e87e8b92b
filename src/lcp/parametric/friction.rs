//! The answer after a change of friction, from the dictionary of the old one.

use super::super::dictionary::{Place, Slot};
use super::super::outcome::Point;
use super::super::variable::Variable;
use super::Parametric;
use stickslip_numerics::products::add_response;

/// A scheme holds at another friction while nothing falls below −this multiple of the largest of its kind.
const HOLDS: f64 = 1e-12;

impl Parametric {
    /// Row of the normal force that the bound of row i depends on; `None` where there is none, and in an open pair.
    fn normal_row(&self, i: usize) -> Option<usize> {
        let n = self.state.lcp.mirrors[i].as_ref()?.normal?;
        match self.state.dictionary.place(Slot::W(n)) {
            Place::Row(r) => Some(r),
            Place::Column(_) => None,
        }
    }

    /// The answer of the same scheme after a change of friction, f_i + `change`_i, per primary row; `extra` is half of
    /// what the constants b_i of the present LCP exceed those of the problem by (extra cohesion). The dictionary stays
    /// that of the old friction: a slipping row's new w = 0 means w = extra − change·w_n in it, a small system in the
    /// w_n of the slipping rows that is solved by iteration. `None` where the iteration does not settle or the scheme
    /// does not hold.
    pub fn at_friction(&mut self, change: &[f64], extra: &[f64]) -> Option<Point> {
        self.sharpen();
        // Slipping rows: their own column, and which of the `pressed` rows is that of their w_n (none in an open
        // pair).
        let mut pressed: Vec<usize> = Vec::new();
        let mut slipping: Vec<(usize, usize, Option<usize>)> = Vec::new();
        for i in 0..change.len() {
            let Some(c) = self.state.column_of(Slot::W(i)) else {
                continue;
            };
            let normal = self.normal_row(i).filter(|_| change[i] != 0.0);
            if normal.is_some() || extra[i] != 0.0 {
                slipping.push((i, c, normal.map(|_| pressed.len())));
                pressed.extend(normal);
            }
        }
        // What one imposed unit on each slipping row does to the w_n of the pressed ones.
        let columns: Vec<usize> = slipping.iter().map(|&(_, c, _)| c).collect();
        let influence = self.state.dictionary.block(&pressed, &columns);
        let (d, lcp) = (&self.state.dictionary, &self.state.lcp);
        let start: Vec<f64> = pressed.iter().map(|&r| d.value[r]).collect();
        let size = start.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let mut normals = start.clone();
        let imposed = |normals: &[f64]| -> Vec<f64> {
            let of = |&(i, _, k): &(usize, usize, Option<usize>)| extra[i] - change[i] * k.map_or(0.0, |k| normals[k]);
            slipping.iter().map(of).collect()
        };
        let mut settled = slipping.is_empty();
        for _ in 0..60 {
            let mut next = start.clone();
            add_response(&mut next, &influence, &imposed(&normals));
            let moved = next.iter().zip(&normals).fold(0.0, |a: f64, (next, now)| a.max((next - now).abs()));
            normals = next;
            if moved <= 4.0 * f64::EPSILON * size {
                settled = true;
                break;
            }
        }
        if !settled {
            return None;
        }
        let terms: Vec<(usize, f64)> =
            slipping.iter().zip(imposed(&normals)).map(|(&(_, c, _), imposed)| (c, imposed)).collect();
        let mut value = d.value.clone();
        for (value, change) in value.iter_mut().zip(d.combined_columns(&terms)) {
            *value += change;
        }
        let n = lcp.full_size;
        let mut point = Point { z: vec![0.0; n], w: vec![0.0; n], p: 0.0 };
        for (r, &local) in d.row.iter().enumerate() {
            match self.state.variable(local, false) {
                Variable::Z(k) => point.z[k] = value[r],
                Variable::W(k) => point.w[k] = value[r],
                Variable::P => return None,
            }
        }
        for i in 0..lcp.size() {
            let Some(mirror) = &lcp.mirrors[i] else {
                continue;
            };
            let w_n = self.normal_row(i).map_or(0.0, |r| value[r]);
            let own = match d.place(Slot::W(i)) {
                Place::Row(r) => value[r] - extra[i] + change[i] * w_n,
                Place::Column(_) => 0.0,
            };
            let sum = 2.0 * (mirror.friction + change[i]) * w_n + mirror.constant - 2.0 * extra[i];
            for (mirror_row, w) in [(false, own), (true, sum - own)] {
                if let Variable::W(k) = self.state.variable(Slot::W(i), mirror_row) {
                    point.w[k] = w;
                }
            }
        }
        let largest = |all: &[f64]| all.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let above = |all: &[f64], size: f64| all.iter().all(|one| *one >= -HOLDS * size);
        (above(&point.z, largest(&point.z)) && above(&point.w, largest(&point.w))).then_some(point)
    }
}
