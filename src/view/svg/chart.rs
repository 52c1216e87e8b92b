//! Curves over an axis.

use super::{Anchor, BLACK, COLOURS, Caption, Drawing, FAINT, GREY, MARGIN, SMALL, Sign, WIDTH, width_of};
use crate::text::number::with_unit;
use crate::view::plot::chart::{Axes, Chart, Curve, Line, Values};
use crate::view::plot::ticks::{HUGE, round_places};
use crate::view::scale::Scale;

/// Height of the area of the curves.
const HEIGHT: f64 = 260.0;

/// The marker of a curve: shapes differ, not only colours.
fn marker(drawing: &mut Drawing, (x, y): (f64, f64), number: usize) {
    let colour = COLOURS[number % COLOURS.len()];
    let fill = if number.is_multiple_of(2) { colour } else { "#ffffff" };
    let r = 3.5;
    match (number / 2) % 3 {
        0 => drawing.circle((x, y), r, fill, colour),
        1 => drawing.polygon(&[(x, y - 1.3 * r), (x + 1.3 * r, y), (x, y + 1.3 * r), (x - 1.3 * r, y)], fill, colour),
        _ => drawing.polygon(&[(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)], fill, colour),
    }
}

/// A piece of a curve for the legend.
pub(super) fn sample(drawing: &mut Drawing, (x, y): (f64, f64), number: usize, line: Line) {
    let colour = COLOURS[number % COLOURS.len()];
    match line {
        Line::Dotted => drawing.line((x - 9.0, y), (x + 9.0, y), colour, 1.5, DOTTED),
        _ => {
            drawing.line((x - 9.0, y), (x + 9.0, y), colour, 1.7, "");
            if line != Line::Plain {
                marker(drawing, (x, y), number);
            }
        }
    }
}

const DOTTED: &str = "stroke-dasharray=\"2 4\"";

/// The figure, its title that of the chart; `note` stands under it.
pub fn figure(chart: &Chart, about: &str, note: &str) -> String {
    let axes = chart.axes(|_| 6);
    let title = chart.heading(axes.as_ref().map(|axes| &axes.scale), false);
    let mut drawing = Drawing::new(&Caption { title, about: about.to_owned() });
    match axes {
        Some(axes) => draw(&mut drawing, chart, &axes),
        None => drawing.paragraph("nothing to draw", SMALL, "", BLACK),
    }
    if !note.is_empty() {
        drawing.y += 12.0;
        drawing.paragraph(note, SMALL, "", BLACK);
    }
    drawing.finish()
}

/// The chart below what is drawn already, with its title.
pub(super) fn below(drawing: &mut Drawing, chart: &Chart) {
    if let Some(axes) = chart.axes(|_| 6) {
        drawing.y += 18.0;
        drawing.paragraph(&chart.heading(Some(&axes.scale), false), 15.0, "font-weight=\"bold\"", BLACK);
        draw(drawing, chart, &axes);
    }
}

/// The curves, their axes and their legend.
fn draw(drawing: &mut Drawing, chart: &Chart, axes: &Axes) {
    let (ticks, labels) = (&axes.ticks, axes.labels());
    let gutter = labels.iter().map(|label| width_of(label, SMALL)).fold(0.0, f64::max);
    let (left, right) = (MARGIN + gutter + 12.0, WIDTH - MARGIN - 12.0);
    let (top, bottom) = (drawing.y + 8.0, drawing.y + 8.0 + HEIGHT);
    let (first, last) = axes.range;
    let to_x = |x: f64| {
        if last > first { left + (x - first) / (last - first) * (right - left) } else { 0.5 * (left + right) }
    };
    let to_y = |y: f64| {
        let share = (y.clamp(-HUGE, HUGE) - ticks.low) / (ticks.high - ticks.low);
        if chart.inverted { top + share * HEIGHT } else { bottom - share * HEIGHT }
    };
    for (value, label) in ticks.values.iter().zip(&labels) {
        let y = to_y(*value);
        drawing.line((left, y), (right, y), FAINT, 0.7, "");
        drawing.text((left - 8.0, y + 4.0), label, SMALL, Anchor::End, BLACK, "");
    }
    drawing.line((left, to_y(0.0)), (right, to_y(0.0)), GREY, 1.2, "");
    drawing.line((left, top), (left, bottom), BLACK, 1.2, "");
    drawing.line((left, bottom), (right, bottom), BLACK, 1.2, "");
    // closer ones would hide what they part
    for x in chart.breaks.iter().filter(|_| chart.breaks.len() < 12) {
        drawing.line((to_x(*x), top), (to_x(*x), bottom), GREY, 1.0, DOTTED);
    }
    for curve in &chart.curves {
        draw_curve(drawing, curve, &|(x, y)| (to_x(x), to_y(y)));
    }
    drawing.y = bottom;
    name_abscissas(drawing, chart, (first, last), &to_x);
    let (marked, dotted): (Vec<&Curve>, Vec<&Curve>) = chart
        .curves
        .iter()
        .filter(|curve| !curve.series.label.is_empty())
        .partition(|curve| curve.line != Line::Dotted);
    let entries: Vec<(Sign, String)> = marked
        .into_iter()
        .chain(dotted)
        .map(|curve| (Sign::Curve(curve.number, curve.line), curve.series.label.clone()))
        .collect();
    drawing.legend(&entries);
}

fn draw_curve(drawing: &mut Drawing, curve: &Curve, place: &dyn Fn((f64, f64)) -> (f64, f64)) {
    let colour = COLOURS[curve.number % COLOURS.len()];
    let finite = curve.series.points.iter().filter(|(x, y)| x.is_finite() && y.is_finite());
    let points: Vec<(f64, f64)> = finite.map(|&point| place(point)).collect();
    if curve.line != Line::Points {
        let attributes = if curve.line == Line::Dotted { DOTTED } else { "" };
        drawing.lines(std::slice::from_ref(&points), colour, 1.7, attributes);
    }
    if matches!(curve.line, Line::Marked | Line::Points) {
        // markers closer than their size would make a band
        let mut before: Option<(f64, f64)> = None;
        for (index, &at) in points.iter().enumerate() {
            let apart = before.is_none_or(|before| (at.0 - before.0).hypot(at.1 - before.1) > 9.0);
            if apart || index + 1 == points.len() {
                marker(drawing, at, curve.number);
                before = Some(at);
            }
        }
    }
}

/// Ticks with names, where there are any, and with round values; what the abscissa is.
fn name_abscissas(drawing: &mut Drawing, chart: &Chart, (first, last): (f64, f64), to_x: &dyn Fn(f64) -> f64) {
    let bottom = drawing.y;
    let many = chart.names.len() > 150;
    for (x, _) in chart.names.iter().filter(|_| !many) {
        drawing.line((to_x(*x), bottom), (to_x(*x), bottom + 4.0), BLACK, 1.0, "");
    }
    if let Some(end) = chart.names.len().checked_sub(1) {
        drawing.y += 19.0;
        let y = drawing.y;
        for index in [0, end].into_iter().chain(1..end.max(1)) {
            let (x, name) = &chart.names[index];
            drawing.text_if_free((to_x(*x), y), name, Anchor::Middle, BLACK);
        }
    }
    let has_values = chart.values != Values::None && last > first;
    let scale = chart.abscissa_scale((first, last));
    if has_values {
        drawing.y += if chart.names.is_empty() { 20.0 } else { 17.0 };
        let y = drawing.y;
        for (x, label) in labelled(chart, &scale, (first, last)) {
            if chart.names.is_empty() {
                drawing.line((to_x(x), bottom), (to_x(x), bottom + 4.0), BLACK, 1.0, "");
            }
            drawing.text_if_free((to_x(x), y), &label, Anchor::Middle, GREY);
        }
    }
    if !chart.abscissa.is_empty() {
        let unit = scale.unit(chart.unit.as_deref(), false).filter(|_| has_values).map(|unit| format!("[{unit}]"));
        let text = with_unit(&chart.abscissa, unit.as_deref());
        drawing.y += 19.0;
        let y = drawing.y;
        drawing.text((0.5 * WIDTH, y), &text, SMALL, Anchor::Middle, BLACK, "");
    }
}

/// Where values are written at the abscissa.
fn labelled(chart: &Chart, scale: &Scale, (first, last): (f64, f64)) -> Vec<(f64, String)> {
    match &chart.values {
        Values::Pieces(places) => places.iter().map(|(x, value)| (*x, scale.number(*value))).collect(),
        _ => round_places(first, last, 8).into_iter().map(|value| (value, scale.number(value + 0.0))).collect(),
    }
}
