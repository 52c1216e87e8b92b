//! The part of the structure in view.

use crate::view::plot::canvas::Canvas;
use crate::view::plot::skeleton::Skeleton;
use crate::view::projection::Projection;

/// The part of the structure in view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewport {
    /// 1 shows all of it.
    pub zoom: f64,
    /// Centre of the view from the centre of the structure, in its larger side.
    pub centre: (f64, f64),
}

impl Default for Viewport {
    fn default() -> Self {
        Viewport { zoom: 1.0, centre: (0.0, 0.0) }
    }
}

/// From the picture of the structure to dots of the canvas.
pub struct View {
    /// Dots of a unit of length.
    pub pitch: f64,
    from: (f64, f64),
    to: (f64, f64),
    dots: (f64, f64),
    middle: (f64, f64),
    size: f64,
}

impl View {
    /// The view of `viewport` on a canvas; `None` where there is nothing to see.
    pub fn new(skeleton: &Skeleton, projection: &Projection, viewport: Viewport, canvas: &Canvas) -> Option<View> {
        let [(left, right), (bottom, top)] = skeleton.seen_by(projection)?;
        let size = (right - left).max(top - bottom);
        if !size.is_finite() {
            return None;
        }
        let size = if size > 0.0 { size } else { 1.0 };
        let dots = (canvas.dots_x(), canvas.dots_y());
        // room for displacements of a tenth of the size at every side, and for the signs of the loads
        let wide = (right - left) + 0.24 * size;
        let high = (top - bottom) + 0.24 * size;
        let flat = top - bottom < 0.05 * size;
        let pitch_y = (dots.1 - 8.0).max(4.0) / high;
        let pitch = if flat { (dots.0 - 4.0).max(4.0) / wide } else { pitch_y.min((dots.0 - 4.0).max(4.0) / wide) }
            * viewport.zoom;
        Some(View {
            pitch,
            from: (0.5 * (left + right) + viewport.centre.0 * size, 0.5 * (bottom + top) + viewport.centre.1 * size),
            to: (0.5 * dots.0, 0.5 * dots.1),
            dots,
            middle: (0.5 * (left + right), 0.5 * (bottom + top)),
            size: (right - left).max(top - bottom),
        })
    }

    /// Dot of a point.
    pub fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        ((x - self.from.0) * self.pitch + self.to.0, (y - self.from.1) * self.pitch + self.to.1)
    }

    /// Dot of the middle of the structure, and its larger side in dots.
    pub fn extent(&self) -> ((f64, f64), f64) {
        (self.place(self.middle), self.size * self.pitch)
    }

    /// Whether a dot is in view.
    pub fn holds(&self, (x, y): (f64, f64)) -> bool {
        (-0.5..=self.dots.0 + 0.5).contains(&x) && (-0.5..=self.dots.1 + 0.5).contains(&y)
    }

    /// The pieces of lines that are in view, in dots.
    pub fn clip(&self, all: &[Vec<(f64, f64)>]) -> Vec<Vec<(f64, f64)>> {
        let mut pieces = Vec::new();
        for line in all {
            let mut piece: Vec<(f64, f64)> = Vec::new();
            let placed: Vec<(f64, f64)> = line.iter().map(|point| self.place(*point)).collect();
            for ends in placed.windows(2) {
                match segment(ends[0], ends[1], self.dots) {
                    Some((a, b)) => {
                        if piece.last() != Some(&a) {
                            if piece.len() > 1 {
                                pieces.push(std::mem::take(&mut piece));
                            }
                            piece = vec![a];
                        }
                        piece.push(b);
                    }
                    None if piece.len() > 1 => pieces.push(std::mem::take(&mut piece)),
                    None => piece.clear(),
                }
            }
            if piece.len() > 1 {
                pieces.push(piece);
            }
        }
        pieces
    }
}

/// The part of a segment within 0 … dots (Liang and Barsky).
fn segment(a: (f64, f64), b: (f64, f64), dots: (f64, f64)) -> Option<((f64, f64), (f64, f64))> {
    if ![a.0, a.1, b.0, b.1].iter().all(|x| x.is_finite()) {
        return None;
    }
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for (p, q) in [(-dx, a.0), (dx, dots.0 - a.0), (-dy, a.1), (dy, dots.1 - a.1)] {
        if p == 0.0 {
            if q < 0.0 {
                return None;
            }
        } else if p < 0.0 {
            from = from.max(q / p);
        } else {
            to = to.min(q / p);
        }
    }
    (from <= to).then_some(((a.0 + from * dx, a.1 + from * dy), (a.0 + to * dx, a.1 + to * dy)))
}
