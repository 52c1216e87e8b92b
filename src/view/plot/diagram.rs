//! Normal force, shear force and bending moment along a bar.

use std::io::{self, Write};

use super::Series;
use super::chart::{Chart, Curve, Line};
use crate::answer::record::{EndForces, MemberForces};
use crate::model::scenario::Units;
use crate::model::structure::Structure;
use crate::view::number::{denoised, largest, short, with_unit};
use crate::view::style::Style;
use crate::view::{force_unit, length_unit, moment_unit};

/// Which internal force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Force {
    /// N, tension positive.
    Axial,
    /// Q = dM/dx.
    Shear,
    /// M, positive with tension on the −y side of the bar; drawn on the tension side.
    Moment,
}

/// Points within an element for a curved diagram.
const PARTS: usize = 8;

/// Length of each element of `bar`, from its start; `None` if there is no such bar.
fn lengths(structure: &Structure, bar: &str) -> Option<Vec<f64>> {
    let bar = structure.bars.iter().find(|b| b.id == bar)?;
    let elements = structure.elements.get(bar.elements.clone())?;
    elements
        .iter()
        .map(|element| {
            let [start, end] = element.nodes[..] else {
                return None;
            };
            let (a, b) = (structure.nodes.get(start)?, structure.nodes.get(end)?);
            let (a, b) = (a.position, b.position);
            Some((b[0] - a[0]).hypot(b[1] - a[1]))
        })
        .collect()
}

/// The force along `bar`, over the distance from its start. Between the nodes it is exact under line loads too:
/// with dM/dx = Q and Q (and N) linear, the values at the ends fix M = M₁ + Q₁ x + (Q₂ − Q₁) x²/2L.
/// `None` if there is no such bar or no forces of it.
pub fn series(structure: &Structure, members: &[MemberForces], bar: &str, force: Force) -> Option<Series> {
    let lengths = lengths(structure, bar)?;
    let value = |end: &EndForces| match force {
        Force::Axial => end.n,
        Force::Shear => end.q,
        Force::Moment => end.m,
    };
    let mine: Vec<&MemberForces> = members.iter().filter(|m| m.bar == bar).collect();
    let scale = largest(mine.iter().flat_map(|m| [value(&m.start), value(&m.end)]));
    let mut points = Vec::new();
    let mut at = 0.0;
    for (element, length) in lengths.iter().enumerate() {
        let member = mine.iter().find(|m| m.element == element)?;
        let (start, end) = (&member.start, &member.end);
        let curved = force == Force::Moment && start.q != end.q;
        let parts = if curved { PARTS } else { 1 };
        for part in 0..=parts {
            let share = part as f64 / parts as f64;
            let y = if part == parts {
                value(end)
            } else if curved {
                let x = share * length;
                start.m + start.q * x + (end.q - start.q) * x * share / 2.0
            } else {
                value(start) + share * (value(end) - value(start))
            };
            points.push((at + share * length, denoised(y, scale)));
        }
        at += length;
    }
    Some(Series { label: String::new(), points })
}

/// The points of `series` at the ends of the elements of `bar`.
fn node_points(structure: &Structure, bar: &str, series: &Series) -> Vec<(f64, f64)> {
    let mut at = 0.0;
    let mut ends = vec![at];
    for length in lengths(structure, bar).unwrap_or_default() {
        at += length;
        ends.push(at);
    }
    // The abscissas of `series` are the same sums.
    let is_end = |x: f64| ends.contains(&x);
    let points = series.points.iter().copied();
    points.filter(|(x, _)| is_end(*x)).collect()
}

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Diagram<'a> {
    /// The structure with the bar.
    pub structure: &'a Structure,
    /// End forces of its members.
    pub members: &'a [MemberForces],
    /// Id of the bar.
    pub bar: &'a str,
    /// Which force.
    pub force: Force,
    /// Rows of the drawing.
    pub height: usize,
}

/// Draws the force along a bar and names its extremes; says so where there is no such bar.
pub fn write(out: &mut dyn Write, diagram: &Diagram<'_>, units: &Units, style: &Style) -> io::Result<()> {
    let Diagram { structure, members, bar, force, height } = *diagram;
    let Some(series) = series(structure, members, bar, force) else {
        let text = format!("no member forces of a bar {bar}");
        return writeln!(out, "{}", style.fit(&style.text(&text), style.width));
    };
    let (name, unit) = match force {
        Force::Axial => ("Normal force N", force_unit(units)),
        Force::Shear => ("Shear force Q", force_unit(units)),
        Force::Moment => ("Bending moment M", moment_unit(units)),
    };
    let mut title = format!("{name} along {bar}");
    if let Some(unit) = &unit {
        title.push_str(&format!(" [{unit}]"));
    }
    if force == Force::Moment {
        title.push_str(", on the tension side");
    }
    let extreme = |pick: fn(f64, f64) -> bool| {
        series
            .points
            .iter()
            .filter(|(_, y)| y.is_finite())
            .copied()
            .reduce(|best, next| if pick(next.1, best.1) { next } else { best })
    };
    let length = length_unit(units);
    let told = |word: &str, point: Option<(f64, f64)>| {
        point.map(|(x, y)| {
            format!("{word} {} at {}", with_unit(&short(y), unit.as_deref()), with_unit(&short(x), length.as_deref()))
        })
    };
    let extremes: Vec<String> =
        [told("max", extreme(|a, b| a > b)), told("min", extreme(|a, b| a < b))].into_iter().flatten().collect();
    let joints = series
        .points
        .first()
        .zip(series.points.last())
        .map(|(first, last)| vec![(first.0, "start".to_owned()), (last.0, "end".to_owned())]);
    let nodes = Series { label: String::new(), points: node_points(structure, bar, &series) };
    let curve = |series: Series, line: Line| Curve { series, number: 0, line };
    Chart {
        title,
        curves: vec![curve(series, Line::Plain), curve(nodes, Line::Points)],
        names: joints.unwrap_or_default(),
        values: true,
        abscissa: format!("along {bar}"),
        unit: length_unit(units),
        inverted: force == Force::Moment,
        height,
    }
    .write(out, style)?;
    for line in style.wrap(&extremes.join(", "), style.width) {
        writeln!(out, "{line}")?;
    }
    Ok(())
}
