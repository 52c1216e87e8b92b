//! Curves along the contact zone and over the pivots: as many, one below the other, as there is room for.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

use crate::session::diagram::Internal;
use crate::session::results::PairState;
use crate::tui::app::State;
use crate::tui::kept::The;
use crate::tui::paint::{paste, put_lines, put_text, report};
use crate::tui::pane::Plot;
use crate::tui::pictures::PlotKey;
use crate::view::pivots::title;
use crate::view::plot::face_map::{FaceMap, faces};
use crate::view::plot::scene::{Magnification, Picture};
use crate::view::plot::structure::write_with_diagrams;
use crate::view::plot::trace;
use crate::view::plot::zone::{self, Quantity};
use crate::view::style::Role;

/// Rows a plot needs to be read.
const ROWS: u16 = 12;
/// Rows around the drawing itself: title, axis, names, values, legend.
const AROUND: u16 = 5;

/// Draws the pane.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let look = state.look;
    if state.shown.answer().is_none() {
        put_text(look, "not solved yet", look.role(Role::Muted), area, buffer);
        return;
    }
    let key = PlotKey {
        moment: The::one(&state.shown.moment),
        size: (area.width, area.height),
        look,
        whole: state.shown.is_whole(),
        plot: state.plot,
        ghost: state.ghost,
    };
    paste(&state.pictures.plots.of(key, || picture(state, area)), area, buffer);
}

/// As many plots as there is room for, drawn anew.
fn picture(state: &State, area: Rect) -> Buffer {
    let area = Rect::new(0, 0, area.width, area.height);
    let mut buffer = Buffer::empty(area);
    let plots = state.plots();
    let from = plots.iter().position(|plot| *plot == state.plot).unwrap_or_default();
    let count = (area.height / ROWS).clamp(1, plots.len() as u16);
    let height = area.height / count;
    for i in 0..count {
        let plot = plots[(from + usize::from(i)) % plots.len()];
        let rest = area.height - i * height;
        let part = Rect::new(0, i * height, area.width, if i + 1 == count { rest } else { height });
        put_lines(&lines(state, plot, part), part, &mut buffer);
    }
    buffer
}

fn lines(state: &State, plot: Plot, area: Rect) -> Vec<Line<'static>> {
    let shown = &state.shown;
    let units = &shown.scenario.units;
    let width = usize::from(area.width);
    let quantity = match plot {
        Plot::Slip => Quantity::Slip,
        Plot::Force => Quantity::Force,
        Plot::Pressure => Quantity::Pressure,
        Plot::Gap => Quantity::Gap,
        Plot::P => return pivots(state, area),
        Plot::Ray => return ray(state, area),
        Plot::Moment => return along_bars(state, Internal::Moment, area),
        Plot::Shear => return along_bars(state, Internal::Shear, area),
        Plot::Axial => return along_bars(state, Internal::Axial, area),
        Plot::ShearZ => return along_bars(state, Internal::ShearZ, area),
        Plot::Torsion => return along_bars(state, Internal::Torsion, area),
        Plot::MomentY => return along_bars(state, Internal::MomentY, area),
    };
    let now_label = match shown.position {
        Some(step) => title(step),
        None if shown.at_ray() => {
            let p = shown.moment.p.map(crate::text::number::short).unwrap_or_default();
            format!("last vertex, p = {p}")
        }
        None => super::loading::note(state),
    };
    let before: Option<&[PairState]> = shown
        .before()
        .filter(|_| state.ghost && shown.has_before())
        .map(|answer| answer.pairs.as_slice())
        .filter(|pairs| *pairs != shown.pairs());
    let states: Vec<(&str, &[PairState])> = match before {
        Some(before) => vec![("now", shown.pairs()), ("before", before)],
        None => vec![(now_label.as_str(), shown.pairs())],
    };
    let over_zone = |states: &[(&str, &[PairState])], area: Rect| {
        fitting(area, |height| {
            report(state.look, width, |out, style| zone::write(out, quantity, states, units, height, style))
        })
    };
    if let Some(structure) = shown.structure() {
        let (maps, rest) = faces(structure, shown.pairs(), quantity, units);
        if !maps.is_empty() {
            let (above, below) = beside(area, &maps, &rest);
            let mut lines = over_faces(state, &maps, above);
            if !rest.is_empty() {
                let states = [(now_label.as_str(), rest.as_slice())];
                lines.resize(usize::from(above.height), Line::default());
                lines.extend(over_zone(&states, below));
            }
            return lines;
        }
    }
    over_zone(&states, area)
}

/// The room for maps, and below it that for the curves over pairs that lie on no face.
fn beside(area: Rect, maps: &[FaceMap], rest: &[PairState]) -> (Rect, Rect) {
    let parts = maps.len() + usize::from(!rest.is_empty());
    let above = (usize::from(area.height) * maps.len() / parts) as u16;
    (Rect { height: above, ..area }, Rect { height: area.height - above, ..area })
}

/// The maps of faces, one below the other.
fn over_faces(state: &State, maps: &[FaceMap], area: Rect) -> Vec<Line<'static>> {
    let share = usize::from(area.height) / maps.len();
    report(state.look, usize::from(area.width), |out, style| {
        // title and notes
        maps.iter().try_for_each(|map| map.write(out, share.saturating_sub(5).max(3), style))
    })
}

fn pivots(state: &State, area: Rect) -> Vec<Line<'static>> {
    let shown = &state.shown;
    let Some(answer) = shown.answer() else {
        return Vec::new();
    };
    if answer.pivots.is_empty() {
        return vec![
            Line::styled("p over the pivots", state.look.role(Role::Title)),
            Line::raw(answer.rules.why_no_pivots()),
        ];
    }
    fitting(area, |height| {
        report(state.look, usize::from(area.width), |out, style| {
            trace::write(out, &answer.pivots, shown.position, &shown.scenario.units, height, style)
        })
    })
}

/// A force along the bars, where they lie.
fn along_bars(state: &State, force: Internal, area: Rect) -> Vec<Line<'static>> {
    let shown = &state.shown;
    let (Some(structure), Some(members)) =
        (shown.structure(), shown.answer().and_then(|answer| answer.members.as_deref()))
    else {
        return Vec::new();
    };
    let force = force.drawn_in(structure.dimension);
    let title = if shown.position.is_some() { "at the end" } else { "" };
    fitting(area, |height| {
        let picture = Picture {
            title,
            structure,
            displacements: None,
            factors: &[],
            pairs: Some(shown.pairs()),
            magnification: Magnification::Auto,
            viewpoint: state.viewpoint(),
            height,
        };
        report(state.look, usize::from(area.width), |out, style| {
            write_with_diagrams(out, &picture, (members, force), &shown.scenario.units, style)
        })
    })
}

fn ray(state: &State, area: Rect) -> Vec<Line<'static>> {
    let shown = &state.shown;
    let Some(ray) = shown.answer().and_then(|answer| answer.ray.as_ref()) else {
        return Vec::new();
    };
    fitting(area, |height| {
        report(state.look, usize::from(area.width), |out, style| {
            zone::mode(out, ray, shown.pairs(), &shown.scenario.units, height, style)
        })
    })
}

/// A chart as high as the area: drawn once more where its legend took more lines than expected.
fn fitting(area: Rect, draw: impl Fn(usize) -> Vec<Line<'static>>) -> Vec<Line<'static>> {
    let room = usize::from(area.height);
    let height = usize::from(area.height.saturating_sub(AROUND)).max(3);
    let lines = draw(height);
    if lines.len() == room || height == 3 {
        return lines;
    }
    let better = (height + room).saturating_sub(lines.len()).max(3);
    // a chart of zeros stays low however much room there is
    let again = draw(better);
    if again.len() <= room { again } else { lines }
}
