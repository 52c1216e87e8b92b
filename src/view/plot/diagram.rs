//! Normal force, shear force and bending moment along a bar.

use std::io::{self, Write};

use super::Series;
use super::chart::{Chart, Curve, Line, Values};
use crate::answer::diagram::{Diagram, Internal};
use crate::answer::record::MemberForces;
use crate::answer::rounding::{denoised, largest};
use crate::model::units::Units;
use crate::view::members::extremes;
use crate::view::style::{Role, Style};
use crate::view::{force_unit, length_unit, moment_unit};

/// Points within a piece whose diagram is curved.
const PARTS: usize = 8;

/// The force along `bar`, over the distance from its start: exact at its nodes, at its extremes and on both sides of a
/// jump. `None` if there are no forces of such a bar.
pub fn series(members: &[MemberForces], bar: &str, force: Internal) -> Option<Series> {
    let diagram = Diagram::of(members, bar)?;
    let scale = largest(diagram.extremes(force).map(|place| place.value));
    let mut points = Vec::new();
    for piece in diagram.pieces() {
        let [from, to] = piece.range;
        let [[ax, ay, az], [bx, by, bz]] = piece.q;
        let straight = match force {
            Internal::Axial => ax == 0.0 && bx == 0.0,
            Internal::Shear | Internal::ShearY => ay == by,
            Internal::Moment | Internal::MomentZ => ay == 0.0 && by == 0.0,
            Internal::ShearZ => az == bz,
            Internal::MomentY => az == 0.0 && bz == 0.0,
            Internal::Torsion => true,
        };
        let parts = if straight { 1 } else { PARTS };
        let mut places: Vec<f64> = (0..=parts)
            .map(|part| if part == parts { to } else { from + (to - from) * part as f64 / parts as f64 })
            .collect();
        places.extend(piece.candidates(force.index()));
        places.sort_by(f64::total_cmp);
        places.dedup();
        points.extend(places.into_iter().map(|s| (s, denoised(piece.at(s)[force.index()], scale))));
    }
    Some(Series { label: String::new(), points })
}

/// The points of `series` at the ends of the elements of `bar`.
fn node_points(members: &[MemberForces], bar: &str, series: &Series) -> Vec<(f64, f64)> {
    let mine = members.iter().filter(|member| member.bar == bar);
    let starts: Vec<f64> = mine.filter_map(|member| Some(member.pieces.first()?.range[0])).collect();
    let last = series.points.last().map(|point| point.0);
    let points = series.points.iter().copied();
    points.filter(|(x, _)| starts.contains(x) || Some(*x) == last).collect()
}

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Drawing<'a> {
    /// Forces of the members.
    pub members: &'a [MemberForces],
    /// Id of the bar.
    pub bar: &'a str,
    /// Which force.
    pub force: Internal,
    /// Rows of the drawing.
    pub height: usize,
}

/// Draws the force along a bar and names its extremes; says so where there is no such bar.
pub fn write(out: &mut dyn Write, drawing: &Drawing<'_>, units: &Units, style: &Style) -> io::Result<()> {
    let Drawing { members, bar, force, height } = *drawing;
    let (Some(chart), Some(diagram)) = (chart(members, bar, force, units), Diagram::of(members, bar)) else {
        let text = format!("no member forces of a bar {bar}");
        return writeln!(out, "{}", style.fit(&style.text(&text), style.width));
    };
    Chart { height, ..chart }.write(out, style)?;
    style.paragraph(out, Role::Plain, &extremes(&diagram, force, units))
}

/// Name of an internal force in a title, and its unit.
pub fn name(force: Internal, units: &Units) -> (&'static str, Option<String>) {
    match force {
        Internal::Axial => ("Normal force N", force_unit(units)),
        Internal::Shear => ("Shear force Q", force_unit(units)),
        Internal::Moment => ("Bending moment M", moment_unit(units)),
        Internal::ShearY => ("Shear force V_y", force_unit(units)),
        Internal::ShearZ => ("Shear force V_z", force_unit(units)),
        Internal::Torsion => ("Torque T", moment_unit(units)),
        Internal::MomentY => ("Bending moment M_y", moment_unit(units)),
        Internal::MomentZ => ("Bending moment M_z", moment_unit(units)),
    }
}

/// The chart of the force along a bar; `None` if there are no forces of such a bar.
pub fn chart(members: &[MemberForces], bar: &str, force: Internal, units: &Units) -> Option<Chart> {
    let series = series(members, bar, force)?;
    let (name, unit) = name(force, units);
    let joints = series
        .points
        .first()
        .zip(series.points.last())
        .map(|(first, last)| vec![(first.0, "start".to_owned()), (last.0, "end".to_owned())]);
    let nodes = Series { label: String::new(), points: node_points(members, bar, &series) };
    let curve = |series: Series, line: Line| Curve { series, number: 0, line };
    Some(Chart {
        title: format!("{name} along {bar}"),
        ordinate: unit,
        about: if force.is_bending() { ", on the tension side".to_owned() } else { String::new() },
        curves: vec![curve(series, Line::Plain), curve(nodes, Line::Points)],
        names: joints.unwrap_or_default(),
        values: Values::Lengths,
        abscissa: format!("along {bar}"),
        unit: length_unit(units),
        inverted: force.is_bending(),
        ..Chart::default()
    })
}
