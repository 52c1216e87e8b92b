//! A quantity over a face of contact: filled cells, with arrows where pairs slip.

use super::structure::{Place, pair};
use super::{Anchor, BLACK, Caption, Drawing, GREY, MARGIN, SMALL, Sign, chart};
use crate::answer::record::State;
use crate::text::number::measured;
use crate::view::plot::chart::Chart;
use crate::view::plot::face_map::{FaceMap, LEVELS};

/// From nothing to the largest value: light to dark, told apart without colours too.
const LIGHT: [f64; 3] = [247.0, 251.0, 255.0];
const MIDDLE: [f64; 3] = [107.0, 174.0, 214.0];
const DARK: [f64; 3] = [8.0, 48.0, 107.0];

/// The colour of a share of the largest value.
fn colour(share: f64) -> String {
    let share = share.clamp(0.0, 1.0);
    let (from, to, t) = if share < 0.5 { (LIGHT, MIDDLE, 2.0 * share) } else { (MIDDLE, DARK, 2.0 * share - 1.0) };
    let [r, g, b] = [0, 1, 2].map(|c| (from[c] + t * (to[c] - from[c])).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// The figure of these maps, one below the other; there is at least one. `beside`: the curves over pairs that lie on no face.
pub fn figure(maps: &[FaceMap], beside: Option<&Chart>, about: &str) -> String {
    let mut drawing = Drawing::new(&Caption { title: maps[0].title.clone(), about: about.to_owned() });
    for (number, map) in maps.iter().enumerate() {
        if number > 0 {
            drawing.y += 18.0;
            drawing.paragraph(&map.title, 15.0, "font-weight=\"bold\"", BLACK);
        }
        cells(&mut drawing, map);
        bar(&mut drawing, map);
        // the first one explains the levels of characters
        for note in map.notes().iter().skip(1) {
            drawing.paragraph(note, SMALL, "", GREY);
        }
    }
    if let Some(chart) = beside {
        chart::below(&mut drawing, chart);
    }
    drawing.finish()
}

fn cells(drawing: &mut Drawing, map: &FaceMap) {
    let place = Place::new(drawing, map.bounds(), 8.0);
    let (dx, dy) = map.spacing;
    for spot in &map.spots {
        let share = if map.largest > 0.0 { spot.value / map.largest } else { 0.0 };
        let corner = |sx: f64, sy: f64| place.at((spot.at.0 + 0.5 * sx * dx, spot.at.1 + 0.5 * sy * dy));
        let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        let value = measured(spot.value, map.unit.as_deref());
        drawing.put(&format!(
            "<polygon points=\"{}\" fill=\"{}\" stroke=\"#ffffff\" stroke-width=\"0.5\"><title>{}</title></polygon>",
            super::points(&corners),
            colour(share),
            super::escaped(&format!("{}: {value}", spot.id)),
        ));
    }
    let cell = dx.min(dy) * place.scale;
    let radius = (0.16 * cell).clamp(1.5, 6.0);
    for spot in &map.spots {
        let (x, y) = place.at(spot.at);
        match spot.towards {
            Some((c, s)) if cell > 9.0 => {
                let half = 0.36 * cell.min(40.0);
                let is_dark = map.largest > 0.0 && spot.value > 0.6 * map.largest;
                let ink = if is_dark { "#ffffff" } else { BLACK };
                drawing.arrow((x - half * c, y + half * s), (x + half * c, y - half * s), ink);
            }
            Some(_) => {}
            None => pair(drawing, (x, y), Some(spot.state), None, radius),
        }
    }
    drawing.y += place.height();
}

/// The colours with their values.
fn bar(drawing: &mut Drawing, map: &FaceMap) {
    drawing.y += 8.0;
    let (y, step) = (drawing.y, 20.0);
    for level in 0..LEVELS {
        let x = MARGIN + level as f64 * step;
        let fill = colour((level as f64 + 0.5) / LEVELS as f64);
        drawing.put(&format!(
            "<rect x=\"{}\" y=\"{}\" width=\"{step}\" height=\"12\" fill=\"{fill}\" stroke=\"{GREY}\" stroke-width=\"0.4\"/>",
            super::px(x),
            super::px(y)
        ));
    }
    let end = MARGIN + LEVELS as f64 * step;
    let largest = measured(map.largest, map.unit.as_deref());
    drawing.text((MARGIN, y + 26.0), "0", SMALL, Anchor::Start, BLACK, "");
    drawing.text((end, y + 26.0), &largest, SMALL, Anchor::Middle, BLACK, "");
    let signs =
        [State::Stick, State::Open, State::Closed].map(|state| (Sign::Pair(Some(state)), state.word().to_owned()));
    let occurs = |state: State| map.spots.iter().any(|spot| spot.state == state);
    drawing.y += 20.0;
    let signs: Vec<(Sign, String)> =
        signs.into_iter().filter(|(sign, _)| matches!(sign, Sign::Pair(Some(state)) if occurs(*state))).collect();
    drawing.legend(&signs);
    drawing.y += 8.0;
}
