//! Strips of the map in which every line passes the same schemes in the same order, and the areas of their parts.

use super::line::{Line, Lines};
use crate::path::start::PathError;
use crate::text::words::short;

/// Strips looked at first.
const STRIPS: usize = 16;
/// Two lines nearer than this share of the range are one place: there the sequence changes.
const ONE_PLACE: f64 = 1e-12;
/// A place between two lines is a straight join up to this share of the range along them.
const STRAIGHT: f64 = 1e-12;
/// The area of a strip, by two rules, agrees to this share of the whole map; otherwise it is halved.
const AGREED: f64 = 1e-12;
/// A strip is halved this often at most.
const HALVINGS: usize = 8;
/// Sequences within sequences are looked for this deep at most.
const NESTED: usize = 64;
/// Most lines of one map.
const LINES: usize = 20_000;

/// Nodes of the Gauss–Kronrod rule of 15 places on [0, 1] (its lower half and the middle); every second belongs to
/// Gauss's rule of 7. Piessens et al., QUADPACK (1983).
const NODES: [f64; 8] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_5,
    0.0,
];
const KRONROD: [f64; 8] = [
    0.022_935_322_010_529_2,
    0.063_092_092_629_978_6,
    0.104_790_010_322_250_2,
    0.140_653_259_715_525_9,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
    0.209_482_141_084_727_8,
];
const GAUSS: [f64; 4] =
    [0.129_484_966_168_869_7, 0.279_705_391_489_276_7, 0.381_830_050_505_118_9, 0.417_959_183_673_469_4];

/// A strip of the map.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Lines through it, upwards, the first and the last at its ends.
    pub lines: Vec<Line>,
    /// Areas of its parts.
    pub areas: Vec<f64>,
}

impl Panel {
    /// Its ends.
    pub fn ends(&self) -> [f64; 2] {
        [self.lines[0].at, self.lines[self.lines.len() - 1].at]
    }

    /// The bounds of its parts at a value between its ends, joined straight between its lines.
    pub fn bounds(&self, at: f64) -> Vec<f64> {
        let above = self.lines.partition_point(|line| line.at < at).clamp(1, self.lines.len() - 1);
        let (a, b) = (&self.lines[above - 1], &self.lines[above]);
        let share = if b.at > a.at { ((at - a.at) / (b.at - a.at)).clamp(0.0, 1.0) } else { 0.0 };
        a.bounds().zip(b.bounds()).map(|(a, b)| a + share * (b - a)).collect()
    }
}

fn too_intricate() -> PathError {
    PathError::Target(format!(
        "the map is too intricate: after {LINES} lines across it its regions are not told apart; take smaller ranges"
    ))
}

/// Cuts the map into strips.
pub struct Cutter<'a> {
    lines: &'a Lines<'a>,
    range: [f64; 2],
    count: usize,
    /// Sequences within sequences that are being looked at.
    nested: usize,
    /// Whether every line was exact.
    pub exact: bool,
}

impl<'a> Cutter<'a> {
    /// `range` of the parameter across.
    pub fn new(lines: &'a Lines<'a>, range: [f64; 2]) -> Cutter<'a> {
        Cutter { lines, range, count: 0, nested: 0, exact: true }
    }

    fn line(&mut self, at: f64) -> Result<Line, PathError> {
        self.count += 1;
        if self.count > LINES {
            return Err(too_intricate());
        }
        if self.lines.case.watch.stop() {
            return Err(PathError::Interrupted);
        }
        let [low, high] = self.range;
        let done = (at - low) / (high - low);
        self.lines.case.watch.progress(&format!("{} = {}", self.lines.across, short(at)), done);
        let (line, exact) = self.lines.line(at)?;
        self.exact &= exact;
        Ok(line)
    }

    /// All strips, upwards.
    ///
    /// # Errors
    /// A value that the scenario cannot take; too many lines; an interruption.
    pub fn panels(&mut self) -> Result<Vec<Panel>, PathError> {
        let [low, high] = self.range;
        // On the border itself a scheme may hold that holds nowhere inside (a friction of 0).
        let inside = ONE_PLACE * (high - low);
        let at = |strip: usize| low + inside + (high - low - 2.0 * inside) * strip as f64 / STRIPS as f64;
        let mut found = vec![self.line(at(0))?];
        for strip in 1..=STRIPS {
            let end = self.line(at(strip))?;
            self.between(end, &mut found)?;
        }
        let mut panels: Vec<Panel> = Vec::new();
        self.measure_all(&found, 0, &mut panels)?;
        self.close(&mut panels);
        Ok(panels)
    }

    /// Gives the slits between panels, and those at the border, to their neighbours.
    fn close(&self, panels: &mut [Panel]) {
        let ends: Vec<[f64; 2]> = panels.iter().map(Panel::ends).collect();
        for (k, panel) in panels.iter_mut().enumerate() {
            let before = if k == 0 { ends[k][0] - self.range[0] } else { 0.5 * (ends[k][0] - ends[k - 1][1]) };
            let after = match ends.get(k + 1) {
                Some(next) => 0.5 * (next[0] - ends[k][1]),
                None => self.range[1] - ends[k][1],
            };
            let (first, last) = (&panel.lines[0], &panel.lines[panel.lines.len() - 1]);
            for (area, (a, b)) in panel.areas.iter_mut().zip(first.parts.iter().zip(&last.parts)) {
                *area += before * (a.to - a.from) + after * (b.to - b.from);
            }
        }
    }

    /// Appends lines up to `end` so that the sequence changes between neighbours at one place only.
    fn between(&mut self, end: Line, found: &mut Vec<Line>) -> Result<(), PathError> {
        let Some(start) = found.last() else { return Ok(()) };
        let apart = end.at - start.at;
        if apart > ONE_PLACE * (self.range[1] - self.range[0]) && !start.same_sequence(&end) {
            let middle = 0.5 * (start.at + end.at);
            if middle > start.at && middle < end.at {
                let middle = self.line(middle)?;
                self.between(middle, found)?;
                return self.between(end, found);
            }
        }
        found.push(end);
        Ok(())
    }

    /// The areas between two lines of one sequence; cut again where a third shows that there is more between them.
    fn measure(&mut self, start: Line, end: Line, depth: usize, panels: &mut Vec<Panel>) -> Result<(), PathError> {
        let width = end.at - start.at;
        let along = self.lines.range[1] - self.lines.range[0];
        let mut nodes: Vec<(f64, f64, f64)> = (0..15)
            .map(|k| {
                let (half, sign) = if k < 8 { (k, -1.0) } else { (14 - k, 1.0) };
                let gauss = if half % 2 == 1 { GAUSS[half / 2] } else { 0.0 };
                (0.5 * (1.0 + sign * NODES[half]), 0.5 * KRONROD[half], 0.5 * gauss)
            })
            .collect();
        // Straight bounds need three places: the middle and one beside it.
        let mut inner: Vec<Line> = Vec::new();
        for share in [nodes[7].0, nodes[4].0] {
            inner.push(self.line(start.at + share * width)?);
        }
        let straight = |line: &Line| {
            let share = (line.at - start.at) / width;
            line.same_sequence(&start)
                && (start.bounds().zip(end.bounds()).zip(line.bounds()))
                    .all(|((a, b), found)| (a + share * (b - a) - found).abs() <= STRAIGHT * along)
        };
        let lengths = |line: &Line| line.parts.iter().map(|part| part.to - part.from).collect::<Vec<f64>>();
        if inner.iter().all(straight) {
            let areas = lengths(&start).iter().zip(lengths(&end)).map(|(a, b)| 0.5 * (a + b) * width).collect();
            panels.push(Panel { lines: vec![start, end], areas });
            return Ok(());
        }
        let mut lines: Vec<Line> = Vec::new();
        let (middle, beside) = (inner.remove(0), inner.remove(0));
        for (k, (share, ..)) in nodes.iter_mut().enumerate() {
            lines.push(match k {
                7 => middle.clone(),
                4 => beside.clone(),
                _ => self.line(start.at + *share * width)?,
            });
        }
        if let Some(other) = lines.iter().find(|line| !line.same_sequence(&start)).cloned() {
            return self.cut_again(start, other, end, depth, panels);
        }
        let sum = |part: usize, weight: &dyn Fn(&(f64, f64, f64)) -> f64| -> f64 {
            nodes.iter().zip(&lines).map(|(node, line)| weight(node) * lengths(line)[part]).sum::<f64>() * width
        };
        let kronrod: Vec<f64> = (0..start.parts.len()).map(|part| sum(part, &|node| node.1)).collect();
        let whole = along * (self.range[1] - self.range[0]);
        let agreed =
            kronrod.iter().enumerate().all(|(part, area)| (area - sum(part, &|node| node.2)).abs() <= AGREED * whole);
        if !agreed && depth < HALVINGS {
            self.measure(start, middle.clone(), depth + 1, panels)?;
            return self.measure(middle, end, depth + 1, panels);
        }
        lines.insert(0, start);
        lines.push(end);
        panels.push(Panel { lines, areas: kronrod });
        Ok(())
    }

    /// Between two lines of one sequence there is one of another.
    fn cut_again(
        &mut self,
        start: Line,
        other: Line,
        end: Line,
        depth: usize,
        panels: &mut Vec<Panel>,
    ) -> Result<(), PathError> {
        let mut found = vec![start];
        self.between(other, &mut found)?;
        self.between(end, &mut found)?;
        self.nested += 1;
        if self.nested > NESTED {
            return Err(too_intricate());
        }
        self.measure_all(&found, depth, panels)?;
        self.nested -= 1;
        Ok(())
    }

    /// Panels of the lines, one for every run of the same sequence.
    fn measure_all(&mut self, found: &[Line], depth: usize, panels: &mut Vec<Panel>) -> Result<(), PathError> {
        for mine in found.chunk_by(Line::same_sequence) {
            let (start, end) = (&mine[0], &mine[mine.len() - 1]);
            if end.at > start.at {
                self.measure(start.clone(), end.clone(), depth, panels)?;
            }
        }
        Ok(())
    }
}
