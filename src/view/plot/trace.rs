//! p over the pivots.

use std::io::{self, Write};

use super::Series;
use super::chart::{Chart, Curve, Line};
use crate::answer::record::PivotRecord;
use crate::answer::rounding::{denoised, largest};
use crate::model::units::Units;
use crate::view::force_unit;
use crate::view::pivots::of_contact;
use crate::view::style::Style;

/// p after each pivot over the number of the pivot.
pub fn p_series(label: &str, pivots: &[PivotRecord]) -> Series {
    let scale = largest(pivots.iter().map(|pivot| pivot.p));
    Series {
        label: label.to_owned(),
        points: pivots.iter().map(|pivot| (pivot.step as f64, denoised(pivot.p, scale))).collect(),
    }
}

/// Draws p over the pivots; the one of step `current` has a marker of its own.
pub fn write(
    out: &mut dyn Write,
    pivots: &[PivotRecord],
    current: Option<usize>,
    units: &Units,
    height: usize,
    style: &Style,
) -> io::Result<()> {
    Chart { height, ..drawing(pivots, current, units) }.write(out, style)
}

/// The chart of p over the pivots.
pub fn drawing(pivots: &[PivotRecord], current: Option<usize>, units: &Units) -> Chart {
    let series = p_series("", pivots);
    let mut curves = vec![Curve { series: series.clone(), number: 0, line: Line::Marked }];
    if let Some(current) = current
        && let Some(&point) = series.points.iter().find(|(x, _)| *x == current as f64)
    {
        curves.push(Curve {
            series: Series { label: format!("pivot {current}"), points: vec![point] },
            number: 1,
            line: Line::Marked,
        });
    }
    Chart {
        title: "p over the pivots".into(),
        ordinate: force_unit(units).filter(|_| of_contact(pivots)),
        curves,
        names: pivots.iter().map(|pivot| (pivot.step as f64, pivot.step.to_string())).collect(),
        abscissa: "pivot".into(),
        ..Chart::default()
    }
}
