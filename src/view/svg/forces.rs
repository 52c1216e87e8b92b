//! Member forces drawn along the bars of a structure: moments on the tension side.

use super::structure::{AROUND, Place, draw_lines};
use super::{Anchor, BLACK, COLOURS, Caption, Drawing, SMALL};
use crate::answer::diagram::{Diagram, Internal};
use crate::answer::record::MemberForces;
use crate::answer::rounding::{denoised, largest};
use crate::model::structure::{Bar, Structure};
use crate::text::number::short;
use crate::view::plot::bar_line::BarLine;
use crate::view::plot::diagram::series;
use crate::view::plot::scene::Scene;

/// Height of the largest ordinate.
const ORDINATE: f64 = 60.0;

/// Which forces are drawn.
pub struct Bars<'a> {
    /// The structure.
    pub structure: &'a Structure,
    /// Its forces.
    pub members: &'a [MemberForces],
    /// Ids of the bars.
    pub bars: &'a [&'a str],
    /// What is drawn of them.
    pub force: Internal,
}

/// The figure; `unit` is that of lengths.
pub fn figure(scene: &Scene, of: &Bars<'_>, unit: Option<&str>, caption: &Caption) -> String {
    let Bars { structure, members, bars, force } = *of;
    let mut drawing = Drawing::new(caption);
    let Some(bounds) = scene.bounds else {
        drawing.paragraph("nothing to draw", SMALL, "", BLACK);
        return drawing.finish();
    };
    let place = Place::new(&drawing, bounds, AROUND + ORDINATE);
    let end = drawing.y + (bounds[1][1] - bounds[1][0]) * place.scale + 2.0 * (AROUND + ORDINATE);
    draw_lines(&mut drawing, scene, &place);
    let drawn: Vec<(&Bar, Vec<(f64, f64)>)> = structure
        .bars
        .iter()
        .filter(|bar| bars.contains(&bar.id.as_str()))
        .filter_map(|bar| Some((bar, series(members, &bar.id, force)?.points)))
        .collect();
    let most = largest(drawn.iter().flat_map(|(_, points)| points.iter().map(|(_, value)| *value)));
    let mut labels: Vec<Label> = Vec::new();
    for (bar, points) in &drawn {
        let axis = BarLine::of(structure, bar, force);
        let ordinate = |(at, across): ([f64; 3], [f64; 3]), value: f64| {
            let ((x, y), (nx, ny)) = (place.at(scene.projection.flat(at)), scene.projection.flat(across));
            let height = if most > 0.0 { denoised(value, most) / most * ORDINATE } else { 0.0 };
            ((x, y), (x + height * nx, y - height * ny))
        };
        let feet = axis.feet(points).into_iter();
        let ends: Vec<_> = feet.zip(points).map(|(foot, &(_, value))| ordinate(foot, value)).collect();
        let shape: Vec<(f64, f64)> =
            ends.iter().map(|(_, tip)| *tip).chain(ends.iter().rev().map(|(foot, _)| *foot)).collect();
        let words: Vec<String> = shape.iter().map(|(x, y)| format!("{},{}", super::px(*x), super::px(*y))).collect();
        let colour = COLOURS[0];
        drawing.put(&format!(
            "<polygon points=\"{}\" fill=\"{colour}\" fill-opacity=\"0.15\" stroke=\"{colour}\" stroke-width=\"1.3\" \
             stroke-linejoin=\"round\"/>",
            words.join(" ")
        ));
        if let Some(diagram) = Diagram::of(members, &bar.id) {
            for extreme in diagram.extremes(force) {
                let value = denoised(extreme.value, most);
                // a constant one is named in its middle
                let constant =
                    diagram.extremes(force).iter().all(|other| denoised(other.value - extreme.value, most) == 0.0);
                let distance = if constant { 0.5 * diagram.length() } else { extreme.distance };
                if value != 0.0 {
                    let (foot, tip) = ordinate(axis.at(distance, false), value);
                    labels.push(Label { foot, tip, value });
                }
            }
        }
    }
    name_extremes(&mut drawing, labels);
    drawing.y = end;
    place.scale_bar(&mut drawing, unit);
    drawing.finish()
}

/// An ordinate that is named.
struct Label {
    foot: (f64, f64),
    tip: (f64, f64),
    value: f64,
}

/// Writes the values beyond the tips of their ordinates, the largest first: where there is no room the small ones stay
/// out. What meets with the same value is named once.
fn name_extremes(drawing: &mut Drawing, mut labels: Vec<Label>) {
    labels.sort_by(|a, b| b.value.abs().total_cmp(&a.value.abs()));
    let mut named: Vec<((f64, f64), String)> = Vec::new();
    for Label { foot, tip, value } in labels {
        let text = short(value);
        let (x, y) = tip;
        if named.iter().any(|((other_x, other_y), other)| *other == text && (x - other_x).hypot(y - other_y) < 3.0) {
            continue;
        }
        let (dx, dy) = (tip.0 - foot.0, tip.1 - foot.1);
        let (at, anchor) = match (dx.abs() > dy.abs(), dx > 0.0, dy > 0.0) {
            (true, true, _) => ((x + 6.0, y + 4.0), Anchor::Start),
            (true, false, _) => ((x - 6.0, y + 4.0), Anchor::End),
            (false, _, true) => ((x, y + 15.0), Anchor::Middle),
            (false, _, false) => ((x, y - 5.0), Anchor::Middle),
        };
        if drawing.text_if_free(at, &text, anchor, BLACK) {
            named.push((tip, text));
        }
    }
}
