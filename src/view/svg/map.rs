//! The map of two parameters as SVG.

use std::fmt::Write;

use super::{Anchor, BLACK, COLOURS, Caption, Drawing, GREY, MARGIN, SMALL, WIDTH, points, width_of};
use crate::path::map::Map;
use crate::text::number::{heading, short};
use crate::view::map::{Labels, meaning};
use crate::view::path::exact;

/// Height of the plane, in px.
const HEIGHT: f64 = 420.0;

/// The figure: regions in colour, each with its letter; under it what each is.
pub fn figure(map: &Map, labels: &Labels<'_>, caption: &Caption) -> String {
    let mut drawing = Drawing::new(caption);
    let [x, y] = [map.axes[0].range, map.axes[1].range];
    let ends = y.map(short);
    let gutter = ends.iter().map(|label| width_of(label, SMALL)).fold(0.0, f64::max);
    let (left, right) = (MARGIN + gutter + 10.0, WIDTH - MARGIN - 12.0);
    let name = |axis: usize| heading(&map.axes[axis].name, labels.units[axis]);
    let top = drawing.y + 22.0;
    let bottom = top + HEIGHT;
    drawing.text((left, top - 8.0), &name(1), SMALL, Anchor::Start, BLACK, "");
    let place = |[a, b]: [f64; 2]| {
        (left + (a - x[0]) / (x[1] - x[0]) * (right - left), bottom - (b - y[0]) / (y[1] - y[0]) * HEIGHT)
    };
    drawing.put(
        "<defs><pattern id=\"several\" width=\"8\" height=\"8\" patternUnits=\"userSpaceOnUse\" \
         patternTransform=\"rotate(45)\"><line x1=\"0\" y1=\"0\" x2=\"0\" y2=\"8\" stroke=\"#1a1a1a\" \
         stroke-width=\"1.2\"/></pattern></defs>",
    );
    for (index, region) in map.regions.iter().enumerate() {
        let mut path = String::new();
        for outline in map.outlines(index) {
            let corners: Vec<(f64, f64)> = outline.into_iter().map(place).collect();
            let _ = write!(path, "M{}Z", points(&corners));
        }
        let (fill, opacity) = match &region.states {
            Some(_) => (COLOURS[index % COLOURS.len()], [0.3, 0.55][(index / COLOURS.len()) % 2]),
            None => ("#9a9a9a", 0.55),
        };
        drawing.put(&format!("<path d=\"{path}\" fill=\"{fill}\" fill-opacity=\"{opacity}\"/>"));
        if region.has_several() {
            drawing.put(&format!("<path d=\"{path}\" fill=\"url(#several)\" fill-opacity=\"0.35\"/>"));
        }
    }
    borders(&mut drawing, map, &place);
    for region in &map.regions {
        let at = place(region.at);
        drawing.text_if_free((at.0, at.1 + 4.0), &region.letter, Anchor::Middle, BLACK);
    }
    drawing.line((left, top), (left, bottom), BLACK, 1.2, "");
    drawing.line((left, bottom), (right, bottom), BLACK, 1.2, "");
    drawing.text((left - 6.0, bottom), &ends[0], SMALL, Anchor::End, BLACK, "");
    drawing.text((left - 6.0, top + SMALL), &ends[1], SMALL, Anchor::End, BLACK, "");
    let base = bottom + SMALL + 6.0;
    drawing.text((left, base), &short(x[0]), SMALL, Anchor::Start, BLACK, "");
    drawing.text((right, base), &short(x[1]), SMALL, Anchor::End, BLACK, "");
    drawing.text((0.5 * (left + right), base), &name(0), SMALL, Anchor::Middle, BLACK, "");
    drawing.y = base + 12.0;
    for region in &map.regions {
        let value = match (&region.value, &labels.quantity) {
            (Some(value), Some((quantity, _))) => {
                let value = value.as_f64().map_or_else(|| value.as_str().unwrap_or_default().to_owned(), short);
                format!("; {quantity} = {value}")
            }
            _ => String::new(),
        };
        let text = format!("{}: area {}{value}; {}", region.letter, exact(region.area), meaning(region));
        drawing.paragraph(&text, SMALL, "", BLACK);
    }
    for note in &map.notes {
        drawing.paragraph(note, SMALL, "", GREY);
    }
    drawing.finish()
}

/// The lines between regions: along the bounds within panels, and across where panels meet in different regions.
fn borders(drawing: &mut Drawing, map: &Map, place: &dyn Fn([f64; 2]) -> (f64, f64)) {
    let mut lines: Vec<Vec<(f64, f64)>> = Vec::new();
    for panel in &map.panels {
        for part in 1..panel.areas.len() {
            lines.push(panel.lines.iter().map(|line| place(map.place(line.parts[part].from, line.at))).collect());
        }
    }
    for (number, two) in map.panels.windows(2).enumerate() {
        let (below, above) = (&two[0].lines[two[0].lines.len() - 1], &two[1].lines[0]);
        for (i, a) in below.parts.iter().enumerate() {
            for (j, b) in above.parts.iter().enumerate() {
                let (from, to) = (a.from.max(b.from), a.to.min(b.to));
                if from < to && map.region_of[number][i] != map.region_of[number + 1][j] {
                    lines.push(vec![place(map.place(from, below.at)), place(map.place(to, below.at))]);
                }
            }
        }
    }
    drawing.lines(&lines, BLACK, 1.0, "");
}
