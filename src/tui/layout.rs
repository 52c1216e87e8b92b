//! Where everything stands on a screen of this size: the same for drawing and for the mouse.

use ratatui::layout::Rect;

use super::app::State;
use super::paint::inside;
use super::pane::Pane;
use super::shown::Shown;
use super::{panes, tour};
use crate::model::structure::Dimension;

/// No pane makes sense below this.
pub const SMALLEST: (u16, u16) = (40, 12);
/// From here on several panes at once.
const SEVERAL: (u16, u16) = (76, 20);
/// From here on all panes at once.
const ALL: (u16, u16) = (120, 36);

/// The screen divided.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Places {
    /// First line: scenario and outcome.
    pub title: Rect,
    /// The panes shown.
    pub panes: Vec<(Pane, Rect)>,
    /// The pane that shares its place with others, and those: their names stand in its border.
    pub tabs: Option<(Rect, Vec<Pane>)>,
    /// Sentence of the pivot, or the step of the tour.
    pub sentence: Rect,
    /// About the selected row.
    pub about: Rect,
    /// Last line: hints, message or what is typed.
    pub bottom: Rect,
}

/// Panes that share the large place of a middling screen.
pub const SHARED: [Pane; 7] =
    [Pane::Structure, Pane::Plot, Pane::Pairs, Pane::Answer, Pane::Quantities, Pane::Loading, Pane::Map];
/// Panes that share a place of a large screen.
pub const SIDE: [Pane; 3] = [Pane::Answer, Pane::Quantities, Pane::Loading];

/// Those that have something to say, and the one in front.
fn offered(state: &State, panes: &[Pane], front: Pane) -> Vec<Pane> {
    panes.iter().copied().filter(|pane| *pane == front || state.offers(*pane)).collect()
}

/// Divides the screen; `None` if it is too small.
pub fn places(state: &State) -> Option<Places> {
    let (width, height) = state.size;
    if width < SMALLEST.0 || height < SMALLEST.1 {
        return None;
    }
    let mut left = height;
    let mut take = |rows: u16| {
        left -= rows;
        Rect::new(0, left, width, rows)
    };
    let bottom = take(1);
    let roomy = height >= SEVERAL.1;
    let about = take(u16::from(roomy));
    let sentence = match (state.tour, roomy) {
        (Some(at), true) => {
            let lines = tour::lines(state, at, usize::from(width)).map_or(2, |(lines, _)| lines.len());
            // at most 6
            take(lines.clamp(2, 6) as u16)
        }
        (Some(_), false) => take(4),
        (None, true) if state.shown.at_ray() => {
            // what a ray means takes more words than a pivot
            let sentence = panes::pivots::sentence(state);
            let columns = usize::from(width);
            let lines = state.look.report(columns).wrap(&sentence, columns).len();
            // at most 6
            take(lines.clamp(2, if height >= ALL.1 { 6 } else { 4 }) as u16)
        }
        (None, _) => take(2),
    };
    let body = Rect::new(0, 1, width, left - 1);
    let mut places = Places { title: Rect::new(0, 0, width, 1), sentence, about, bottom, ..Places::default() };
    if state.maximized || width < SEVERAL.0 || height < SEVERAL.1 {
        places.panes.push((state.focus, body));
        places.tabs = Some((body, offered(state, &Pane::ALL, state.focus)));
    } else if width < ALL.0 || height < ALL.1 {
        middle(state, body, &mut places);
    } else {
        wide(state, body, &mut places);
    }
    Some(places)
}

/// Rows of the parameters with their border, the line about the marked one included.
fn parameter_rows(state: &State) -> u16 {
    let count = state.shown.values.len().clamp(1, 12);
    // at most 12
    count as u16 + 2
}

fn cut_rows(area: Rect, rows: u16) -> (Rect, Rect) {
    let rows = rows.min(area.height);
    (Rect::new(area.x, area.y, area.width, rows), Rect::new(area.x, area.y + rows, area.width, area.height - rows))
}

fn cut_columns(area: Rect, columns: u16) -> (Rect, Rect) {
    let columns = columns.min(area.width);
    (
        Rect::new(area.x, area.y, columns, area.height),
        Rect::new(area.x + columns, area.y, area.width - columns, area.height),
    )
}

fn middle(state: &State, body: Rect, places: &mut Places) {
    let (left, right) = cut_columns(body, body.width - (body.width * 2 / 5).clamp(30, 44));
    let (parameters, pivots) = cut_rows(right, parameter_rows(state).min(right.height / 2));
    if is_flat(&state.shown) {
        // a beam needs few rows: there is room for what happens along it
        let (structure, rest) = cut_rows(left, 8);
        let front = match state.tab {
            Pane::Structure => Pane::Plot,
            tab => tab,
        };
        places.panes = vec![(front, rest), (Pane::Structure, structure)];
        places.tabs = Some((rest, offered(state, &SHARED[1..], front)));
    } else if state.tab == Pane::Map && state.shown.structure().is_some() {
        // what the cursor shows stands beside it
        let (map, structure) = cut_rows(left, left.height - left.height * 2 / 5);
        places.panes = vec![(Pane::Map, map), (Pane::Structure, structure)];
        places.tabs = Some((map, offered(state, &SHARED[1..], Pane::Map)));
    } else {
        places.panes = vec![(state.tab, left)];
        places.tabs = Some((left, offered(state, &SHARED, state.tab)));
    }
    places.panes.push((Pane::Parameters, parameters));
    places.panes.push((Pane::Pivots, pivots));
}

fn wide(state: &State, body: Rect, places: &mut Places) {
    let (left, right) = cut_columns(body, body.width - (body.width / 2).clamp(56, 90));
    let rows = match state.shown.structure() {
        Some(_) if !is_flat(&state.shown) => left.height / 2,
        Some(_) => left.height / 4,
        None if state.shown.pairs().is_empty() => 5,
        None => 9,
    };
    let (structure, plot) = cut_rows(left, rows.max(5));
    let pivot_rows = state.shown.answer().map_or(0, |answer| answer.pivots.len());
    let (parameters, rest) = cut_rows(right, parameter_rows(state).min(right.height / 3));
    let sides = offered(state, &SIDE, state.side);
    let needed = if sides.len() > 1 { 11 } else { 9 };
    let (rest, side) = cut_rows(rest, rest.height - needed.min(rest.height / 4));
    // the pivots take what they need, at most half, then the pairs; what is left goes to the side
    let needed = u16::try_from(pivot_rows).unwrap_or(u16::MAX).saturating_add(3);
    let (pivots, pairs) = cut_rows(rest, needed.clamp(6, rest.height / 2));
    let needed = u16::try_from(panes::pairs::height(state, inside(pairs))).unwrap_or(u16::MAX).saturating_add(2);
    let (pairs, spare) = cut_rows(pairs, needed.max(6));
    let side = Rect { y: side.y - spare.height, height: side.height + spare.height, ..side };
    places.panes = vec![
        (Pane::Structure, structure),
        (state.lower, plot),
        (Pane::Parameters, parameters),
        (Pane::Pivots, pivots),
        (Pane::Pairs, pairs),
        (state.side, side),
    ];
    places.tabs = (sides.len() > 1).then_some((side, sides));
}

/// Whether the structure is so low that it needs few rows; one in space is turned.
fn is_flat(shown: &Shown) -> bool {
    let in_plane = shown.structure().is_some_and(|structure| structure.dimension == Dimension::Plane);
    in_plane && shown.skeleton().is_some_and(|skeleton| skeleton.side(1) < 0.12 * skeleton.side(0))
}

/// Where a pane stands, if it is shown.
pub fn area_of(state: &State, pane: Pane) -> Option<Rect> {
    places(state)?.panes.into_iter().find(|(shown, _)| *shown == pane).map(|(_, area)| area)
}

/// The pane at a place of the screen.
pub fn pane_at(places: &Places, x: u16, y: u16) -> Option<(Pane, Rect)> {
    places.panes.iter().copied().find(|(_, area)| area.contains((x, y).into()))
}

/// Names of tabs in a border with the columns they take: (start, pane, name). They are as long as there is room for all
/// of them, that of the pane in front longest; where even the shortest do not, the last ones are numbers.
pub fn tab_names(area: Rect, panes: &[Pane], front: Pane) -> Vec<(u16, Pane, String)> {
    /// Blanks around a name and the line to the next one.
    const BETWEEN: usize = 3;
    type Form = fn(Pane) -> &'static str;
    let name = |pane: Pane, form: Form| format!("{} {}", pane.index() + 1, form(pane)).trim_end().to_owned();
    let all = |(of_front, of_others): (Form, Form)| -> Vec<String> {
        panes.iter().map(|pane| name(*pane, if *pane == front { of_front } else { of_others })).collect()
    };
    let room = usize::from(area.width).saturating_sub(2);
    let fits = |names: &[String]| names.iter().map(|name| name.len() + BETWEEN).sum::<usize>() <= room;
    let forms: [(Form, Form); 4] = [
        (Pane::title, Pane::title),
        (Pane::title, Pane::short),
        (Pane::title, Pane::shortest),
        (Pane::short, Pane::shortest),
    ];
    let mut names = forms.into_iter().map(all).find(|names| fits(names)).unwrap_or_else(|| all(forms[2]));
    for at in (0..panes.len()).rev().filter(|at| panes[*at] != front) {
        if !fits(&names) {
            names[at] = name(panes[at], |_| "");
        }
    }
    let mut x = area.x + 1;
    let mut tabs = Vec::new();
    for (pane, name) in panes.iter().zip(names) {
        let start = x;
        // names are ASCII and short
        x += (name.len() + BETWEEN) as u16;
        if x <= area.right() {
            tabs.push((start, *pane, name));
        }
    }
    tabs
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tabs on the left of a screen of 80 columns: 48 columns.
    #[test]
    fn tabs_are_shortened_before_they_become_numbers() {
        let names = |panes: &[Pane], front: Pane, width: u16| -> String {
            let tabs = tab_names(Rect::new(0, 0, width, 10), panes, front);
            tabs.iter().map(|(_, _, name)| name.as_str()).collect::<Vec<_>>().join("|")
        };
        let four = &SHARED[..4];
        assert_eq!(names(four, Pane::Pairs, 48), "1 Structure|5 Plots|3 Pairs|6 Answer");
        let five = [four, &[Pane::Quantities]].concat();
        assert_eq!(names(&five, Pane::Pairs, 60), "1 Struct|5 Plots|3 Pairs|6 Answer|7 Quant");
        assert_eq!(names(&five, Pane::Pairs, 48), "1 Str|5 Plot|3 Pairs|6 Ans|7 Qty");
        assert_eq!(names(&five, Pane::Quantities, 48), "1 Str|5 Plot|3 Pair|6 Ans|7 Quant");
        assert_eq!(names(&SHARED, Pane::Map, 48), "1 Str|5 Plot|3 Pair|6|7|8|9 Map");
        assert_eq!(
            names(&SHARED, Pane::Structure, 120),
            "1 Structure|5 Plots|3 Pairs|6 Answer|7 Quantities|8 Loading|9 Map"
        );
    }
}
