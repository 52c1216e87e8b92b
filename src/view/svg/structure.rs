//! The structure with its supports, the states of its pairs, its loads and its deformed shape.

use super::{Anchor, BLACK, COLOURS, Caption, Drawing, FACE, FAINT, GREY, MARGIN, SMALL, Sign, WIDTH, points};
use crate::answer::record::State;
use crate::model::units::Units;
use crate::text::number::measured;
use crate::view::plot::lines::Face;
use crate::view::plot::loads::{Arrow, LoadKind};
use crate::view::plot::scene::Scene;
use crate::view::plot::structure::support_word;
use crate::view::projection::Projection;

/// px between arrows of loads.
const APART: f64 = 24.0;
/// Lengths of arrows in px, of a tiny one and of the largest of a kind.
const LENGTHS: [f64; 2] = [9.0, 34.0];
/// Most height of the structure itself.
const HEIGHT: f64 = 420.0;
/// Room around the structure for arrows, signs and names.
pub(super) const AROUND: f64 = 46.0;
/// The names of more pairs than this hide what they name.
const MOST_NAMES: usize = 16;
/// Grid lines closer than this are left out.
const GRID: f64 = 5.0;

/// The place of the model in a figure.
pub(super) struct Place {
    left: f64,
    top: f64,
    /// Of the model: least x, largest y.
    corner: (f64, f64),
    /// px per unit of length.
    pub(super) scale: f64,
    /// Height of the whole area.
    height: f64,
    /// Whether it is a single point.
    has_no_size: bool,
}

impl Place {
    /// Below what is drawn already; `room` is kept free around the structure.
    pub(super) fn new(drawing: &Drawing, bounds: [[f64; 2]; 2], room: f64) -> Place {
        let [[left, right], [bottom, top]] = bounds;
        let (wide, high) = ((right - left).max(0.0), (top - bottom).max(0.0));
        let width = WIDTH - 2.0 * MARGIN - 2.0 * room;
        let scale = f64::min(width / wide, HEIGHT / high);
        let scale = if scale.is_finite() && scale > 0.0 { scale } else { 1.0 };
        Place {
            left: 0.5 * (WIDTH - wide * scale),
            top: drawing.y + room,
            corner: (left, top),
            scale,
            height: high * scale + 2.0 * room,
            has_no_size: wide.max(high) <= 0.0,
        }
    }

    /// From the model to the figure.
    pub(super) fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (self.left + (x - self.corner.0) * self.scale, self.top + (self.corner.1 - y) * self.scale)
    }

    /// Height of the whole area.
    pub(super) fn height(&self) -> f64 {
        self.height
    }

    pub(super) fn all(&self, lines: &[Vec<(f64, f64)>]) -> Vec<Vec<(f64, f64)>> {
        lines.iter().map(|line| line.iter().map(|&point| self.at(point)).collect()).collect()
    }

    /// The axes of the model, each with a length of it as long as it is seen, in the right lower corner.
    fn axes(&self, drawing: &mut Drawing, projection: &Projection, unit: Option<&str>) {
        if self.has_no_size {
            return;
        }
        // below the structure, which may reach into the corner
        drawing.y += 36.0;
        let length = round_length(60.0 / self.scale);
        let origin = (WIDTH - MARGIN - 70.0, drawing.y - 16.0);
        for (c, name) in ["x", "y", "z"].into_iter().enumerate() {
            let (x, y) = projection.flat(std::array::from_fn(|k| if k == c { length * self.scale } else { 0.0 }));
            let tip = (origin.0 + x, origin.1 - y);
            drawing.line(origin, tip, BLACK, 1.2, "");
            let size = x.hypot(y).max(1.0);
            let beyond = (tip.0 + 9.0 * x / size, tip.1 - 9.0 * y / size + 4.0);
            drawing.text(beyond, name, SMALL, Anchor::Middle, BLACK, "");
        }
        let label = format!("{} along each axis", measured(length, unit));
        drawing.text((origin.0 - 64.0, drawing.y), &label, SMALL, Anchor::End, BLACK, "");
    }

    /// A length of the model, drawn as long as it is.
    pub(super) fn scale_bar(&self, drawing: &mut Drawing, unit: Option<&str>) {
        if self.has_no_size {
            return;
        }
        let length = round_length(150.0 / self.scale);
        let (x, y) = (WIDTH - MARGIN - length * self.scale, drawing.y);
        drawing.line((x, y), (WIDTH - MARGIN, y), BLACK, 1.5, "");
        for x in [x, WIDTH - MARGIN] {
            drawing.line((x, y - 4.0), (x, y + 4.0), BLACK, 1.5, "");
        }
        let label = measured(length, unit);
        drawing.text((x - 8.0, y + 4.0), &label, SMALL, Anchor::End, BLACK, "");
    }
}

/// A length of 5, 2 or 1 × 10^k, not above `most`.
fn round_length(most: f64) -> f64 {
    let power = 10f64.powi(most.log10().floor() as i32);
    [5.0, 2.0].into_iter().map(|digit| digit * power).find(|length| *length <= most).unwrap_or(power)
}

/// The sign of a pair; a slip points along `towards`, in the figure, and is a diamond where that cannot be seen.
pub(super) fn pair(
    drawing: &mut Drawing,
    at: (f64, f64),
    state: Option<State>,
    towards: Option<(f64, f64)>,
    radius: f64,
) {
    let (x, y) = at;
    let r = radius;
    match state {
        Some(State::Stick) => drawing.circle(at, r, COLOURS[0], COLOURS[0]),
        Some(State::Open) => drawing.circle(at, r, "#ffffff", BLACK),
        Some(State::Closed) => {
            let square = [(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)];
            drawing.polygon(&square, COLOURS[2], COLOURS[2]);
        }
        Some(State::SlipPlus | State::SlipMinus | State::Slip) => {
            let Some((c, s)) = towards else {
                drawing.polygon(&[(x, y - r), (x + r, y), (x, y + r), (x - r, y)], COLOURS[1], COLOURS[1]);
                return;
            };
            let (c, s) = (1.3 * r * c, 1.3 * r * s);
            let tip = (x + c, y + s);
            let wings =
                [(x - 0.7 * c - 0.8 * s, y - 0.7 * s + 0.8 * c), (x - 0.7 * c + 0.8 * s, y - 0.7 * s - 0.8 * c)];
            drawing.polygon(&[tip, wings[0], wings[1]], COLOURS[1], COLOURS[1]);
        }
        None => drawing.circle(at, 0.7 * r, "#ffffff", COLOURS[0]),
    }
}

/// The sign of a support that holds this many components, under its node.
pub(super) fn support(drawing: &mut Drawing, (x, y): (f64, f64), held: usize, r: f64) {
    match held {
        3.. => {
            let square = [(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)];
            drawing.polygon(&square, FAINT, BLACK);
            drawing.line((x - r, y + r), (x + r, y - r), BLACK, 1.0, "");
        }
        2 => drawing.polygon(&[(x, y - 0.4 * r), (x + r, y + 1.4 * r), (x - r, y + 1.4 * r)], "#ffffff", BLACK),
        _ => drawing.polygon(&[(x, y - r), (x + 0.8 * r, y), (x, y + r), (x - 0.8 * r, y)], "#ffffff", BLACK),
    }
}

/// The figure.
pub fn figure(scene: &Scene, units: &Units, caption: &Caption) -> String {
    let mut drawing = Drawing::new(caption);
    let Some(bounds) = scene.bounds else {
        drawing.paragraph("nothing to draw", SMALL, "", BLACK);
        return drawing.finish();
    };
    let place = Place::new(&drawing, bounds, AROUND);
    let top = drawing.y;
    draw_lines(&mut drawing, scene, &place);
    let mut legend = Vec::new();
    let note = |legend: &mut Vec<(Sign, String)>, sign: Sign, word: &str| {
        if !legend.iter().any(|(known, _)| *known == sign) {
            legend.push((sign, word.to_owned()));
        }
    };
    let radius = sign_radius(scene, &place);
    for &(at, held) in &scene.supports {
        support(&mut drawing, place.at(at), held, radius);
        drawing.take(place.at(at), 1.5 * radius);
        note(&mut legend, Sign::Support(held), support_word(held));
    }
    let arrows = scene.loads.arrows(APART / place.scale);
    draw_loads(&mut drawing, &arrows.arrows, &place, bounds);
    for mark in &scene.pairs {
        let at = place.at(mark.place);
        if mark.is_hidden {
            drawing.put("<g opacity=\"0.6\">");
        }
        pair(&mut drawing, at, mark.state, mark.towards.map(|(x, y)| (x, -y)), radius);
        if mark.is_hidden {
            drawing.put("</g>");
        }
        drawing.take(at, 1.4 * radius);
        note(&mut legend, Sign::Pair(mark.state), mark.state.map_or("contact pair", State::word));
    }
    name_pairs(&mut drawing, scene, &place);
    let mut entries: Vec<(Sign, String)> = Vec::new();
    entries.extend(scene.loads.legend(&arrows, units).into_iter().map(|(kind, text)| (Sign::Load(kind), text)));
    legend.extend(entries);
    if scene.is_deformed {
        note(&mut legend, Sign::Undeformed, "undeformed");
    }
    drawing.y = top + place.height;
    if scene.projection.is_along_axes() {
        place.scale_bar(&mut drawing, units.length.as_deref());
    } else {
        place.axes(&mut drawing, &scene.projection, units.length.as_deref());
    }
    drawing.y += 4.0;
    drawing.legend(&legend);
    drawing.finish()
}

/// Membranes as faces, their inner grid where there is room, bars and outlines; the undeformed ones dashed.
pub(super) fn draw_lines(drawing: &mut Drawing, scene: &Scene, place: &Place) {
    draw_faces(drawing, &scene.now.faces, place);
    if scene.is_deformed {
        drawing.lines(&place.all(&scene.before.outline.seen), GREY, 1.0, "stroke-dasharray=\"4 3\"");
    }
    if scene.now.grid.pitch * place.scale >= GRID {
        drawing.lines(&place.all(&scene.now.grid.lines), FAINT, 0.7, "");
    }
    drawing.lines(&place.all(&scene.now.outline.hidden), GREY, 0.7, "stroke-dasharray=\"1.5 3\"");
    drawing.lines(&place.all(&scene.now.outline.seen), BLACK, 2.0, "");
}

/// Faces in the order given, neighbours of one brightness as one shape.
fn draw_faces(drawing: &mut Drawing, faces: &[Face], place: &Place) {
    for alike in faces.chunk_by(|a, b| a.light == b.light) {
        let shape =
            |face: &Face| format!("M{}Z", points(&face.corners.iter().map(|&at| place.at(at)).collect::<Vec<_>>()));
        let shapes: String = alike.iter().map(shape).collect();
        let light = alike[0].light;
        if light == 1.0 {
            drawing.put(&format!("<path d=\"{shapes}\" fill=\"{FACE}\"/>"));
        } else {
            // a seam of its own colour covers the gaps between neighbours
            let grey = |full: f64| (full * (0.72 + 0.28 * light)).round() as u8;
            let colour = format!("#{:02x}{:02x}{:02x}", grey(238.0), grey(240.0), grey(242.0));
            drawing.put(&format!("<path d=\"{shapes}\" fill=\"{colour}\" stroke=\"{colour}\" stroke-width=\"0.6\"/>"));
        }
    }
}

/// Signs shrink where pairs or supports stand close together.
fn sign_radius(scene: &Scene, place: &Place) -> f64 {
    let closest = |places: Vec<(f64, f64)>| {
        let gaps = places.windows(2).map(|ends| (ends[1].0 - ends[0].0).hypot(ends[1].1 - ends[0].1));
        gaps.filter(|gap| *gap > 0.0).fold(f64::INFINITY, f64::min)
    };
    let pairs = closest(scene.pairs.iter().map(|pair| place.at(pair.place)).collect());
    let supports = closest(scene.supports.iter().map(|(at, _)| place.at(*at)).collect());
    (0.42 * pairs.min(supports)).clamp(3.0, 5.5)
}

/// An arrow for each load, as long as its share of the largest of its kind: from outside to its place, or from there
/// where it pulls away from the structure.
fn draw_loads(drawing: &mut Drawing, arrows: &[Arrow], place: &Place, [x, y]: [[f64; 2]; 2]) {
    let middle = (0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]));
    let extent = (x[1] - x[0]).max(y[1] - y[0]);
    for arrow in arrows {
        let here = place.at(arrow.at);
        let Some((c, up)) = arrow.direction() else {
            end_on(drawing, here, arrow.comes, colour(arrow.kind));
            continue;
        };
        let s = -up;
        let outward = (arrow.at.0 - middle.0) * c + (arrow.at.1 - middle.1) * up;
        let [from, to] = arrow.span(outward, extent, LENGTHS, 7.0);
        let on_line = |distance: f64| (here.0 + distance * c, here.1 + distance * s);
        drawing.arrow(on_line(from), on_line(to), colour(arrow.kind));
        for step in 0..=4 {
            drawing.take(on_line(from + (to - from) * f64::from(step) / 4.0), 4.0);
        }
    }
}

/// A force that leads straight to the viewer (its tip, a point) or away (the cross of its feathers).
fn end_on(drawing: &mut Drawing, (x, y): (f64, f64), comes: bool, colour: &str) {
    let r = 5.0;
    drawing.circle((x, y), r, "#ffffff", colour);
    if comes {
        drawing.circle((x, y), 0.3 * r, colour, colour);
    } else {
        let d = 0.7 * r;
        drawing.line((x - d, y - d), (x + d, y + d), colour, 1.2, "");
        drawing.line((x - d, y + d), (x + d, y - d), colour, 1.2, "");
    }
    drawing.take((x, y), r);
}

/// Loads at points are black, line loads and weights have colours of their own.
pub(super) fn colour(kind: LoadKind) -> &'static str {
    match kind {
        LoadKind::Force => BLACK,
        LoadKind::Line => COLOURS[3],
        LoadKind::Weight => GREY,
    }
}

/// The names of all pairs or, where they do not all find room, of the first and the last.
fn name_pairs(drawing: &mut Drawing, scene: &Scene, place: &Place) {
    let name = |drawing: &mut Drawing, index: usize| {
        let mark = &scene.pairs[index];
        let (x, y) = place.at(mark.place);
        let places = [
            ((x, y + 22.0), Anchor::Middle),
            ((x, y - 13.0), Anchor::Middle),
            ((x + 11.0, y + 4.0), Anchor::Start),
            ((x - 11.0, y + 4.0), Anchor::End),
        ];
        places.into_iter().any(|(at, anchor)| drawing.text_if_free(at, &mark.id, anchor, GREY))
    };
    let mut named = drawing.clone();
    if scene.pairs.len() <= MOST_NAMES && (0..scene.pairs.len()).all(|index| name(&mut named, index)) {
        *drawing = named;
    } else {
        name(drawing, 0);
        name(drawing, scene.pairs.len() - 1); // there is one: of none all have room
    }
}
