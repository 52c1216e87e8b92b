//! What lies behind faces: their depth over a raster of the picture.

/// Cells along the longer side of the picture.
const CELLS: usize = 400;
/// Pieces of a line that are shorter than this many cells take the look of what they follow.
const SHORT: usize = 3;

/// A point of a picture: to the right, up, towards the viewer.
pub type Seen = [f64; 3];

/// A line of a picture.
pub type Line = Vec<(f64, f64)>;

/// For every cell, how near to the viewer the nearest face is.
#[derive(Clone, Debug)]
pub struct Depths {
    corner: [f64; 2],
    /// Side of a cell.
    cell: f64,
    columns: usize,
    rows: usize,
    nearest: Vec<f64>,
}

impl Depths {
    /// Of faces, each the ring of its corners; `None` where there is nothing to see.
    pub fn of(faces: &[Vec<Seen>]) -> Option<Depths> {
        let points = || faces.iter().flatten().filter(|point| point.iter().all(|x| x.is_finite()));
        let range = |axis: usize| {
            let values = points().map(|point| point[axis]);
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
        };
        let [x, y, z] = [range(0), range(1), range(2)];
        let size = (x[1] - x[0]).max(y[1] - y[0]);
        if !(size.is_finite() && size > 0.0) {
            return None;
        }
        let cell = size / CELLS as f64;
        let count = |[low, high]: [f64; 2]| ((high - low) / cell).ceil() as usize + 1;
        let (columns, rows) = (count(x), count(y));
        let nearest = vec![f64::NEG_INFINITY; columns * rows];
        let mut depths = Depths { corner: [x[0], y[0]], cell, columns, rows, nearest };
        // of faces at the same depth none hides the other
        let least = 1e-3 * size.max(z[1] - z[0]);
        for face in faces {
            for k in 1..face.len().saturating_sub(1) {
                depths.add([face[0], face[k], face[k + 1]], least);
            }
        }
        Some(depths)
    }

    /// A triangle, moved away from the viewer by as much as its depth changes within two cells, so that it does not hide
    /// its own edges.
    fn add(&mut self, [a, b, c]: [Seen; 3], least: f64) {
        if ![a, b, c].iter().flatten().all(|x| x.is_finite()) {
            return;
        }
        let (p, q) = ([b[0] - a[0], b[1] - a[1], b[2] - a[2]], [c[0] - a[0], c[1] - a[1], c[2] - a[2]]);
        let area = p[0] * q[1] - p[1] * q[0];
        // seen nearly along itself it hides nothing
        let normal = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2]];
        if area.abs() <= 0.02 * normal[0].hypot(normal[1]) || area == 0.0 {
            return;
        }
        let slope = [-normal[0] / area, -normal[1] / area];
        let away = least + 2.0 * self.cell * (slope[0].abs() + slope[1].abs());
        let cells = |axis: usize, count: usize| {
            let low = a[axis].min(b[axis]).min(c[axis]);
            let high = a[axis].max(b[axis]).max(c[axis]);
            let at =
                |value: f64| ((value - self.corner[axis]) / self.cell).floor().clamp(0.0, count as f64 - 1.0) as usize;
            at(low)..=at(high)
        };
        let (across, up) = (cells(0, self.columns), cells(1, self.rows));
        for row in up {
            for column in across.clone() {
                let d = [
                    self.corner[0] + (column as f64 + 0.5) * self.cell - a[0],
                    self.corner[1] + (row as f64 + 0.5) * self.cell - a[1],
                ];
                let s = (d[0] * q[1] - d[1] * q[0]) / area;
                let t = (p[0] * d[1] - p[1] * d[0]) / area;
                if s >= -1e-9 && t >= -1e-9 && s + t <= 1.0 + 1e-9 {
                    let depth = a[2] + slope[0] * d[0] + slope[1] * d[1] - away;
                    let nearest = &mut self.nearest[row * self.columns + column];
                    *nearest = nearest.max(depth);
                }
            }
        }
    }

    /// Whether a face lies before a point.
    pub fn hides(&self, [x, y, z]: Seen) -> bool {
        let at = |value: f64, axis: usize, count: usize| {
            let k = ((value - self.corner[axis]) / self.cell).floor();
            (k >= 0.0 && k < count as f64).then_some(k as usize)
        };
        match (at(x, 0, self.columns), at(y, 1, self.rows)) {
            (Some(column), Some(row)) => z < self.nearest[row * self.columns + column],
            _ => false,
        }
    }

    /// A line in its parts: those seen, and those behind faces.
    pub fn split(&self, line: &[Seen]) -> [Vec<Line>; 2] {
        // samples: place and whether it is hidden
        let mut samples: Vec<((f64, f64), bool)> = Vec::new();
        for ends in line.windows(2) {
            let [a, b] = [ends[0], ends[1]];
            let steps = ((b[0] - a[0]).hypot(b[1] - a[1]) / self.cell).ceil();
            let steps = if steps.is_finite() { steps.clamp(1.0, 4.0 * CELLS as f64) as usize } else { 1 };
            for step in 0..steps {
                // in the middle of each piece: corners belong to several faces
                let t = (step as f64 + 0.5) / steps as f64;
                let at = |t: f64| std::array::from_fn(|c| a[c] + t * (b[c] - a[c]));
                let start: Seen = at(step as f64 / steps as f64);
                samples.push(((start[0], start[1]), self.hides(at(t))));
            }
        }
        let Some(end) = line.last().filter(|_| !samples.is_empty()) else { return [Vec::new(), Vec::new()] };
        even_out(&mut samples);
        let mut parts = [Vec::new(), Vec::new()];
        let mut from = 0;
        for k in 1..=samples.len() {
            if k == samples.len() || samples[k].1 != samples[from].1 {
                let mut part: Line = samples[from..k].iter().map(|(at, _)| *at).collect();
                part.push(samples.get(k).map_or((end[0], end[1]), |(at, _)| *at));
                parts[usize::from(samples[from].1)].push(straightened(part));
                from = k;
            }
        }
        parts
    }
}

/// Short pieces between longer ones are doubtful cells.
fn even_out(samples: &mut [((f64, f64), bool)]) {
    let mut from = 0;
    for k in 1..=samples.len() {
        if k == samples.len() || samples[k].1 != samples[from].1 {
            if k - from < SHORT && k - from < samples.len() {
                let look = if from > 0 { samples[from - 1].1 } else { samples[k].1 };
                samples[from..k].iter_mut().for_each(|(_, hidden)| *hidden = look);
            }
            from = k;
        }
    }
}

/// The line without the points that lie straight between their neighbours.
fn straightened(line: Line) -> Line {
    let mut kept: Line = Vec::new();
    for point in line {
        if let [.., a, b] = kept[..] {
            let (p, q) = ((b.0 - a.0, b.1 - a.1), (point.0 - b.0, point.1 - b.1));
            let goes_on = p.0 * q.0 + p.1 * q.1 >= 0.0;
            if goes_on && (p.0 * q.1 - p.1 * q.0).abs() <= 1e-9 * p.0.hypot(p.1) * q.0.hypot(q.1) {
                kept.pop();
            }
        }
        kept.push(point);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of side 2 at depth 1; a line at depth 0 is hidden between x = −1 and 1, one at depth 2 is not, and the
    /// square's own edges and diagonal are seen.
    #[test]
    fn lines_are_split_where_they_pass_behind() {
        let square = vec![[-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]];
        let depths = Depths::of(std::slice::from_ref(&square)).unwrap();
        let [seen, hidden] = depths.split(&[[-3.0, 0.1, 0.0], [3.0, 0.1, 0.0]]);
        let [before, after] = &seen[..] else { panic!("{seen:?}") };
        let [behind] = &hidden[..] else { panic!("{hidden:?}") };
        let near = |a: (f64, f64), x: f64| (a.0 - x).abs() < 0.02 && (a.1 - 0.1).abs() < 1e-12;
        assert!(near(before[0], -3.0) && near(before[1], -1.0) && before.len() == 2, "{before:?}");
        assert!(near(behind[0], -1.0) && near(behind[1], 1.0) && behind.len() == 2, "{behind:?}");
        assert!(near(after[0], 1.0) && near(after[1], 3.0) && after.len() == 2, "{after:?}");
        for line in [vec![[-3.0, 0.1, 2.0], [3.0, 0.1, 2.0]], square[..2].to_vec(), vec![square[0], square[2]]] {
            let [seen, hidden] = depths.split(&line);
            assert!(hidden.is_empty() && seen.len() == 1, "{line:?}: {hidden:?}");
        }
    }

    /// A face that leans away hides neither itself nor what stands on it.
    #[test]
    fn a_leaning_face_does_not_hide_its_lines() {
        let face = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 3.0], [1.0, 1.0, 4.0], [0.0, 1.0, 1.0]];
        let depths = Depths::of(std::slice::from_ref(&face)).unwrap();
        for (a, b) in [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)] {
            assert!(depths.split(&[face[a], face[b]])[1].is_empty());
        }
        // 0.4 behind its middle, which is at depth 2
        assert!(depths.hides([0.5, 0.5, 1.6]) && !depths.hides([0.5, 0.5, 2.0]));
    }

    #[test]
    fn without_faces_nothing_is_hidden() {
        assert!(Depths::of(&[]).is_none());
        assert!(Depths::of(&[vec![[f64::NAN; 3]; 3]]).is_none());
    }
}
