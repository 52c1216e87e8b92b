//! Strips of the map in which every line passes the same schemes in the same order, and the areas of their parts.

use std::f64::consts::{FRAC_PI_2, PI};

use rayon::prelude::*;

use super::line::{Line, Lines, Scheme};
use crate::path::route::Known;
use crate::path::start::PathError;
use crate::solve::known_collapses::KnownCollapses;
use crate::text::words::short;

/// A line without an answer at its ends is looked at in this many places where its neighbours have one.
const HINTS: usize = 4;
/// Strips looked at first.
const STRIPS: usize = 16;
/// Two lines nearer than this share of the range are one place: there the sequence changes.
const ONE_PLACE: f64 = 1e-12;
/// A place between two lines is a straight join up to this share of the range along them, and the area of a strip, by two
/// rules, agrees to this share of the whole map; otherwise it is halved.
const AGREED: f64 = 1e-12;
/// The same where bounds are narrowed to a few 1e-12 of the range, not found on exact paths.
const AGREED_IN_STEPS: f64 = 1e-10;
/// A strip is halved this often at most.
const HALVINGS: usize = 8;
/// Sequences within sequences are looked for this deep at most.
const NESTED: usize = 64;
/// Most lines of one map.
const LINES: usize = 20_000;
/// The same where each line is a row of answers, not an exact path: minutes in place of an hour.
const LINES_IN_STEPS: usize = 3_000;

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

/// Where the sequence of schemes is thought to change between `found` and the lines `ahead`: where a part of the lines on
/// one side would get no length. Not quite there, but on the side from which the lines come, or past it where they are
/// near; not nearer than `least`.
fn change(found: &[Line], ahead: &[Line], least: f64) -> Option<f64> {
    let side = |lines: &[Line]| -> Option<(f64, f64)> {
        let last = lines.last()?;
        let near: Vec<&Line> = lines.iter().rev().take(3).take_while(|line| line.same_sequence(last)).collect();
        let ends = |part: usize| {
            let length = |line: &&Line| (line.at, line.parts[part].to - line.parts[part].from);
            vanishing(&near.iter().map(length).collect::<Vec<_>>())
        };
        // The first that vanishes on the way.
        let all = (0..last.parts.len()).filter_map(ends);
        all.min_by(|a, b| (a.0 - last.at).abs().total_cmp(&(b.0 - last.at).abs()))
    };
    let (start, end) = (found.last()?.at, ahead.last()?.at);
    let guess = |lines: &[Line], [from, to]: [f64; 2], towards: f64| {
        let (at, unsure) = side(lines)?;
        let margin = least.max(unsure) * towards;
        let place = if (at - from) * towards > 2.0 * margin.abs() { at - margin } else { at + margin };
        // A little short of where it was missed.
        let past = (place - to) * towards;
        let place = if (0.0..16.0 * margin.abs()).contains(&past) { to - margin } else { place };
        (place > start && place < end).then_some((place, unsure))
    };
    let both = [guess(found, [start, end], 1.0), guess(ahead, [end, start], -1.0)];
    both.into_iter().flatten().min_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
}

/// Where a length that falls towards the first of these places is 0 beyond it, and how unsure that is.
fn vanishing(places: &[(f64, f64)]) -> Option<(f64, f64)> {
    let [(a, f), (b, g), ..] = *places else { return None };
    if f >= g {
        return None;
    }
    let straight = a + f * (a - b) / (g - f);
    let Some(&(c, h)) = places.get(2).filter(|place| place.1 > g) else {
        return Some((straight, 0.1 * (straight - a).abs()));
    };
    // x over the length by Lagrange's parabola, at 0.
    let curved = a * g * h / ((f - g) * (f - h)) + b * f * h / ((g - f) * (g - h)) + c * f * g / ((h - f) * (h - g));
    let beyond = (curved - a) * (a - b) > 0.0;
    Some(if beyond { (curved, 2.0 * (curved - straight).abs()) } else { (straight, 0.1 * (straight - a).abs()) })
}

/// Where the nearest lines on both sides have answers.
fn hints(seen: &[Line], at: f64) -> Vec<f64> {
    let answered = |line: &&Line| line.parts.iter().any(|part| part.scheme != Scheme::NoAnswer);
    let nearest = |sign: f64| {
        let side = seen.iter().filter(|line| (line.at - at) * sign > 0.0).filter(answered);
        side.min_by(|a, b| (a.at - at).abs().total_cmp(&(b.at - at).abs()))
    };
    let parts = [-1.0, 1.0].into_iter().filter_map(nearest).flat_map(|line| &line.parts);
    let parts = parts.filter(|part| part.scheme != Scheme::NoAnswer);
    parts.map(|part| 0.5 * (part.from + part.to)).take(HINTS).collect()
}

/// Cuts the map into strips.
pub struct Cutter<'a> {
    lines: &'a Lines<'a>,
    range: [f64; 2],
    /// All lines looked at.
    seen: Vec<Line>,
    /// Sequences within sequences that are being looked at.
    nested: usize,
    /// Shares of the whole work between which the present pass over the range lies.
    pass: [f64; 2],
    /// How well all lines are known.
    pub known: Known,
    /// Why the map was given up before its end, and how many lines it has.
    pub left_out: Option<(LeftOut, usize)>,
}

/// Why a map is not complete.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeftOut {
    /// It was stopped.
    Stopped,
    /// As many lines as a map may have did not tell its regions apart.
    Intricate,
}

impl<'a> Cutter<'a> {
    /// `range` of the parameter across.
    pub fn new(lines: &'a Lines<'a>, range: [f64; 2]) -> Cutter<'a> {
        Cutter { lines, range, seen: Vec::new(), nested: 0, pass: [0.0, 0.1], known: Known::Exactly, left_out: None }
    }

    /// The lines at these values.
    fn at(&mut self, places: &[f64]) -> Result<Vec<Line>, PathError> {
        let most = if self.known == Known::Exactly { LINES } else { LINES_IN_STEPS };
        if self.seen.len() + places.len() > most {
            self.left_out = Some((LeftOut::Intricate, self.seen.len()));
            return Err(PathError::Interrupted);
        }
        let ([low, high], [begun, ended], lines) = (self.range, self.pass, self.lines);
        let first = self.seen.len();
        let look = |at: &f64| {
            if lines.case.watch.stop() {
                return Err(PathError::Interrupted);
            }
            let done = begun + (at - low) / (high - low) * (ended - begun);
            lines.case.watch.progress(&format!("{} = {}", lines.across, short(*at)), done);
            lines.line(*at, &hints(&self.seen, *at))
        };
        // Those before one that was stopped are kept.
        let found: Vec<Result<(Line, Known, KnownCollapses), PathError>> = places.par_iter().map(look).collect();
        for found in found {
            let (line, known, collapses) = found?;
            self.known = self.known.max(known);
            // In the end those of the last line, whatever the number of threads.
            lines.known.become_as(&collapses);
            self.seen.push(line);
        }
        Ok(self.seen[first..].to_vec())
    }

    /// All strips, upwards; where it is stopped or too intricate, strips as the lines show them so far.
    ///
    /// # Errors
    /// A value that the scenario cannot take; an interruption before the first lines.
    pub fn panels(&mut self) -> Result<Vec<Panel>, PathError> {
        let mut panels = match self.exact_panels() {
            Err(PathError::Interrupted) if self.seen.len() > STRIPS => {
                self.left_out.get_or_insert((LeftOut::Stopped, self.seen.len()));
                self.rough_panels()
            }
            found => found?,
        };
        self.close(&mut panels);
        Ok(panels)
    }

    fn exact_panels(&mut self) -> Result<Vec<Panel>, PathError> {
        let [low, high] = self.range;
        // On the border itself a scheme may hold that holds nowhere inside (a friction of 0).
        let inside = ONE_PLACE * (high - low);
        let at = |strip: usize| low + inside + (high - low - 2.0 * inside) * strip as f64 / STRIPS as f64;
        let mut ahead = self.at(&(0..=STRIPS).map(at).collect::<Vec<_>>())?;
        ahead.reverse();
        let mut found = Vec::from_iter(ahead.pop());
        self.pass = [0.1, 0.4];
        self.between(ahead, &mut found)?;
        let mut panels: Vec<Panel> = Vec::new();
        self.pass = [0.4, 1.0];
        self.measure_all(&found, 0, &mut panels)?;
        Ok(panels)
    }

    /// Strips from all lines looked at, the bounds straight between them.
    fn rough_panels(&mut self) -> Vec<Panel> {
        let mut lines = std::mem::take(&mut self.seen);
        lines.sort_by(|a, b| a.at.total_cmp(&b.at));
        let strips = lines.chunk_by(Line::same_sequence).map(|strip| {
            // A line that stands alone is a strip of no width.
            let lines: Vec<Line> = strip.iter().chain((strip.len() == 1).then_some(&strip[0])).cloned().collect();
            let length = |line: &Line, part: usize| line.parts[part].to - line.parts[part].from;
            let area = |part: usize| {
                let between =
                    |two: &[Line]| 0.5 * (length(&two[0], part) + length(&two[1], part)) * (two[1].at - two[0].at);
                lines.windows(2).map(between).sum()
            };
            let areas = (0..lines[0].parts.len()).map(area).collect();
            Panel { lines, areas }
        });
        strips.collect()
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

    /// Appends the lines `ahead`, the nearest last, and between them as many that the sequence changes between neighbours at
    /// one place only.
    fn between(&mut self, mut ahead: Vec<Line>, found: &mut Vec<Line>) -> Result<(), PathError> {
        let one_place = ONE_PLACE * (self.range[1] - self.range[0]);
        let mut looks = 0;
        while let (Some(start), Some(end)) = (found.last(), ahead.last()) {
            let inside = |at: &f64| *at > start.at && *at < end.at;
            let middle = 0.5 * (start.at + end.at);
            let is_same = start.same_sequence(end);
            if is_same || end.at - start.at <= one_place || !inside(&middle) {
                found.extend(ahead.pop());
                looks = if is_same { looks } else { 0 };
                continue;
            }
            // Farther from a guess that was missed, and halving now and then: a bad one costs a few lines only.
            let least = 0.1 * one_place * f64::powi(4.0, looks);
            looks += 1;
            let guess = if looks % 4 == 0 { None } else { change(found, &ahead, least) };
            ahead.extend(self.at(&[guess.filter(inside).unwrap_or(middle)])?);
        }
        Ok(())
    }

    /// Places on [0, 1] with the weights of Kronrod's rule and of Gauss's. Bounds that come from steps are round: at
    /// the ends of a strip their distance goes like a square root, which x = sin²(π s/2) makes smooth.
    fn nodes(&self) -> Vec<(f64, f64, f64)> {
        let node = |k: usize| {
            let (half, sign) = if k < 8 { (k, -1.0) } else { (14 - k, 1.0) };
            let gauss = if half % 2 == 1 { GAUSS[half / 2] } else { 0.0 };
            let (x, kronrod, gauss) = (0.5 * (1.0 + sign * NODES[half]), 0.5 * KRONROD[half], 0.5 * gauss);
            if self.known == Known::Exactly {
                return (x, kronrod, gauss);
            }
            let (angle, turn) = (PI * x, FRAC_PI_2 * (PI * x).sin());
            (0.5 * (1.0 - angle.cos()), turn * kronrod, turn * gauss)
        };
        (0..15).map(node).collect()
    }

    fn agreed(&self) -> f64 {
        if self.known == Known::Exactly { AGREED } else { AGREED_IN_STEPS }
    }

    /// The areas between two lines of one sequence; cut again where a third shows that there is more between them.
    fn measure(&mut self, start: Line, end: Line, depth: usize, panels: &mut Vec<Panel>) -> Result<(), PathError> {
        let width = end.at - start.at;
        let along = self.lines.range[1] - self.lines.range[0];
        let nodes = self.nodes();
        // Straight bounds need three places: the middle and one beside it.
        let place = |k: usize| start.at + nodes[k].0 * width;
        let inner = self.at(&[place(7), place(4)])?;
        let agreed = self.agreed();
        let straight = |line: &Line| {
            let share = (line.at - start.at) / width;
            line.same_sequence(&start)
                && (start.bounds().zip(end.bounds()).zip(line.bounds()))
                    .all(|((a, b), found)| (a + share * (b - a) - found).abs() <= agreed * along)
        };
        let lengths = |line: &Line| line.parts.iter().map(|part| part.to - part.from).collect::<Vec<f64>>();
        if inner.iter().all(straight) {
            let areas = lengths(&start).iter().zip(lengths(&end)).map(|(a, b)| 0.5 * (a + b) * width).collect();
            panels.push(Panel { lines: vec![start, end], areas });
            return Ok(());
        }
        let others: Vec<f64> = (0..nodes.len()).filter(|k| ![7, 4].contains(k)).map(place).collect();
        let mut lines = self.at(&others)?;
        lines.extend(inner);
        lines.sort_by(|a, b| a.at.total_cmp(&b.at));
        let middle = lines[7].clone();
        if let Some(other) = lines.iter().find(|line| !line.same_sequence(&start)).cloned() {
            return self.cut_again(start, other, end, depth, panels);
        }
        let sum = |part: usize, weight: &dyn Fn(&(f64, f64, f64)) -> f64| -> f64 {
            nodes.iter().zip(&lines).map(|(node, line)| weight(node) * lengths(line)[part]).sum::<f64>() * width
        };
        let kronrod: Vec<f64> = (0..start.parts.len()).map(|part| sum(part, &|node| node.1)).collect();
        let whole = along * (self.range[1] - self.range[0]);
        let is_near = |(part, area): (usize, &f64)| (area - sum(part, &|node| node.2)).abs() <= agreed * whole;
        if !kronrod.iter().enumerate().all(is_near) && depth < HALVINGS {
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
        self.between(vec![end, other], &mut found)?;
        self.nested += 1;
        if self.nested > NESTED {
            self.left_out = Some((LeftOut::Intricate, self.seen.len()));
            return Err(PathError::Interrupted);
        }
        self.measure_all(&found, depth, panels)?;
        self.nested -= 1;
        Ok(())
    }

    /// Panels of the lines, one for every run of the same sequence.
    fn measure_all(&mut self, found: &[Line], depth: usize, panels: &mut Vec<Panel>) -> Result<(), PathError> {
        for mine in found.chunk_by(Line::same_sequence) {
            let (start, end) = (&mine[0], &mine[mine.len() - 1]);
            // What is met within one place is where others meet, and has no area.
            if end.at - start.at > ONE_PLACE * (self.range[1] - self.range[0]) {
                self.measure(start.clone(), end.clone(), depth, panels)?;
            }
        }
        Ok(())
    }
}
