//! The last map: letters for its regions, a cursor whose answer the other panes show.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

use crate::session::DrawnMap;
use crate::session::language::tokens::quote;
use crate::tui::app::State;
use crate::tui::kept::The;
use crate::tui::paint::{inside, put_lines, put_text, report};
use crate::tui::pictures::MapKey;
use crate::view::map::{AROUND, cell, corner, gutter, meaning, picture, place, place_of};
use crate::view::style::Role;

/// The map, if one was drawn.
pub fn drawn(state: &State) -> Option<&DrawnMap> {
    state.shown.map.as_ref().map(|(drawn, _)| drawn.as_ref())
}

/// Columns and rows of the plane in the inside of a pane.
fn size(drawn: &DrawnMap, area: Rect) -> (usize, usize) {
    let columns = usize::from(area.width).saturating_sub(gutter(&drawn.map) - 1);
    (columns.max(1), usize::from(area.height).saturating_sub(AROUND).max(1))
}

/// The cell of a place in a pane, and how many columns and rows there are.
fn cell_in(drawn: &DrawnMap, at: [f64; 2], area: Rect) -> ((usize, usize), (usize, usize)) {
    let (width, height) = size(drawn, inside(area));
    (cell(&drawn.map, at, width, height), (width, height))
}

/// Where the present values lie in the map; `None` where one of its axes is a load case.
pub fn present(state: &State, drawn: &DrawnMap) -> Option<[f64; 2]> {
    let own = state.below.as_ref().unwrap_or(&state.shown);
    let value = |axis: usize| own.values.get(&drawn.map.axes[axis].name).copied();
    Some([value(0)?, value(1)?])
}

/// The place of the cursor.
pub fn cursor(state: &State) -> Option<[f64; 2]> {
    let drawn = drawn(state)?;
    let middle = || drawn.map.axes.each_ref().map(|axis| 0.5 * (axis.range[0] + axis.range[1]));
    Some(state.map_at.or_else(|| present(state, drawn)).unwrap_or_else(middle))
}

/// The place this many cells to the right and up from the cursor, in a pane of this size.
pub fn moved(state: &State, (right, up): (isize, isize), area: Rect) -> Option<[f64; 2]> {
    let drawn = drawn(state)?;
    let ((column, row), (width, height)) = cell_in(drawn, cursor(state)?, area);
    let to = |at: usize, by: isize, count: usize| at.saturating_add_signed(by).min(count - 1);
    Some(place_of(&drawn.map, (to(column, right, width), to(row, -up, height)), width, height))
}

/// The place in a character of the screen.
pub fn place_at(state: &State, area: Rect, (x, y): (u16, u16)) -> Option<[f64; 2]> {
    let drawn = drawn(state)?;
    let (inside, (left, top)) = (inside(area), corner(&drawn.map));
    let (width, height) = size(drawn, inside);
    let column = usize::from(x.checked_sub(inside.x)?).checked_sub(left).filter(|column| *column < width)?;
    let row = usize::from(y.checked_sub(inside.y)?).checked_sub(top).filter(|row| *row < height)?;
    Some(place_of(&drawn.map, (column, row), width, height))
}

/// The region under the cursor, and how many there are.
pub fn note(state: &State) -> String {
    let (Some(drawn), Some(at)) = (drawn(state), cursor(state)) else {
        return String::new();
    };
    if let Some((_, Some(stale))) = &state.shown.map {
        return format!("drawn {stale}");
    }
    let region = drawn.map.region_at(at).map(|region| &drawn.map.regions[region]);
    region.map_or(String::new(), |region| format!("{} of {} regions", region.letter, drawn.map.regions.len()))
}

/// The place of the cursor in words.
pub fn about(state: &State) -> Option<String> {
    let (drawn, at) = (drawn(state)?, cursor(state)?);
    Some(place(&drawn.map, &drawn.labels(&state.shown.scenario), at))
}

/// What holds under the cursor.
pub fn sentence(state: &State) -> Option<String> {
    let (drawn, at) = (drawn(state)?, cursor(state)?);
    let region = &drawn.map.regions[drawn.map.region_at(at)?];
    let several = if region.has_several() { "; more than one answer is possible here" } else { "" };
    Some(format!("Region {} of the map: {}{several}.", region.letter, meaning(region)))
}

/// The texts of the regions, to be searched.
pub fn regions(state: &State) -> Vec<String> {
    let regions = drawn(state).into_iter().flat_map(|drawn| &drawn.map.regions);
    regions.map(|region| format!("{} {}", region.letter, meaning(region))).collect()
}

/// The commands that set both parameters to the place of the cursor; why not, where one is a load case.
pub fn command(state: &State) -> Option<Result<String, String>> {
    let (drawn, at) = (drawn(state)?, cursor(state)?);
    let axes = &drawn.map.axes;
    if let Some(axis) = axes.iter().find(|axis| state.shown.values.get(&axis.name).is_none()) {
        let why = format!("{} is a load case: its factor is not a parameter that can be set", axis.name);
        return Some(Err(why));
    }
    let set = |axis: usize| format!("set {} {}", quote(&axes[axis].name), at[axis]);
    Some(Ok(format!("{}; {}", set(0), set(1))))
}

/// Draws the pane.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let look = state.look;
    let (Some(drawn), Some(at)) = (drawn(state), cursor(state)) else {
        put_text(look, &without(state), look.role(Role::Muted), area, buffer);
        return;
    };
    let size = size(drawn, area);
    let key = MapKey { map: state.shown.map.as_ref().map(|(drawn, _)| The::one(drawn)), size, look };
    let lines = state.pictures.map.of(key, || {
        let labels = drawn.labels(&state.shown.scenario);
        report(look, usize::from(area.width), |out, style| picture(out, &drawn.map, &labels, size, style))
    });
    put_lines(&lines, area, buffer);
    let (left, top) = corner(&drawn.map);
    let mut mark = |at: [f64; 2], sign: Option<char>, style: Style| {
        let (column, row) = cell(&drawn.map, at, size.0, size.1);
        // no wider and no higher than the area
        let (x, y) = (area.x + (left + column) as u16, area.y + (top + row) as u16);
        if area.contains((x, y).into())
            && let Some(cell) = buffer.cell_mut((x, y))
        {
            if let Some(sign) = sign {
                cell.set_char(sign);
            }
            cell.set_style(style);
        }
    };
    let inside =
        |at: &[f64; 2]| (0..2).all(|k| (drawn.map.axes[k].range[0]..=drawn.map.axes[k].range[1]).contains(&at[k]));
    if let Some(present) = present(state, drawn).filter(inside) {
        mark(present, Some(look.sign('◆', '+')), look.role(Role::Accent).add_modifier(Modifier::BOLD));
    }
    mark(at, None, look.selected());
}

/// What to do where there is no map: an example with parameters of this scenario.
fn without(state: &State) -> String {
    let mut names = state.shown.values.free().map(|(name, _)| quote(name));
    let example = names.next().zip(names.next()).map(|(p, q)| format!(", for example `:map {p} {q}`"));
    format!("no map yet: `:map P Q` draws one of two parameters{}", example.unwrap_or_default())
}
