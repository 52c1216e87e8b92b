//! Slip, friction force, opening and pressure over a face of contact, whose pairs lie on a plane and not on a line: a
//! map of cells, each shown like its nearest pair.

use std::collections::HashSet;
use std::io::{self, Write};

use super::lines::straight_order;
use super::structure::pair_sign;
use super::zone::Quantity;
use crate::answer::record::{PairState, State};
use crate::answer::rounding::denoised;
use crate::model::structure::Structure;
use crate::model::units::Units;
use crate::model::vector::{dot, way};
use crate::text::number::{measured, short};
use crate::view::area_load_unit;
use crate::view::style::{Role, Style};

/// Nodes this far out of the plane, of the size of the face, are on another one.
const FLAT: f64 = 1e-6;
/// Levels of a value, from 0 on.
pub const LEVELS: usize = 10;
/// Rows that a character is higher than wide.
const ASPECT: f64 = 2.0;

/// A pair on a face.
#[derive(Clone, Debug, PartialEq)]
pub struct Spot {
    /// Its place along t1 and t2.
    pub at: (f64, f64),
    /// Its name.
    pub id: String,
    /// Its state.
    pub state: State,
    /// The value shown there.
    pub value: f64,
    /// Unit vector of its slip along t1 and t2; `None` where it does not slip.
    pub towards: Option<(f64, f64)>,
}

/// A quantity over one face, as seen from the second side.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceMap {
    /// What is shown, with the name of the face.
    pub title: String,
    /// Unit of the values.
    pub unit: Option<String>,
    /// The pairs.
    pub spots: Vec<Spot>,
    /// The largest value.
    pub largest: f64,
    /// Least distance of two pairs along t1 and along t2.
    pub spacing: (f64, f64),
    /// t1 and t2.
    pub tangents: [[f64; 3]; 2],
    quantity: Quantity,
}

/// The faces among the contacts of a structure, each with this quantity, and the pairs that are on none: in the plane all.
pub fn faces(
    structure: &Structure,
    states: &[PairState],
    quantity: Quantity,
    units: &Units,
) -> (Vec<FaceMap>, Vec<PairState>) {
    let (mut maps, mut on_no_face) = (Vec::new(), Vec::new());
    // those of a face are `joint[0]`, `joint[1]` …; a contact of a single node is not a face
    let mut contacts: Vec<(Option<&str>, Vec<usize>)> = Vec::new();
    for (index, state) in states.iter().enumerate() {
        let name = state.id.split_once('[').map(|(name, _)| name);
        match contacts.iter_mut().find(|(known, _)| *known == name) {
            Some((_, pairs)) => pairs.push(index),
            None => contacts.push((name, vec![index])),
        }
    }
    for (name, pairs) in contacts {
        match name.and_then(|_| FaceMap::of(structure, states, &pairs, quantity, units)) {
            Some(map) => maps.push(map),
            None => on_no_face.extend(pairs),
        }
    }
    on_no_face.sort_unstable();
    (maps, on_no_face.into_iter().map(|pair| states[pair].clone()).collect())
}

/// What the pairs of each face carry per area, normal and tangential; `areas` are those of the pairs.
pub fn tractions(
    structure: &Structure,
    states: &[PairState],
    areas: &[Option<f64>],
    units: &Units,
) -> (Vec<FaceMap>, Vec<PairState>) {
    let per_area = |(state, area): (&PairState, &Option<f64>)| {
        let area = area.unwrap_or(1.0); // of pairs on no face, which are not drawn from these
        PairState { x_n: state.x_n / area, x_t: state.x_t / area, ..state.clone() }
    };
    let spread: Vec<PairState> = states.iter().zip(areas).map(per_area).collect();
    let (mut maps, rest) = faces(structure, &spread, Quantity::Pressure, units);
    maps.extend(faces(structure, &spread, Quantity::Force, units).0);
    for map in &mut maps {
        map.title = format!("{}, per area", map.title);
        map.unit = area_load_unit(units);
    }
    let left: HashSet<&str> = rest.iter().map(|state| state.id.as_str()).collect();
    let is_left = |state: &&PairState| left.contains(state.id.as_str());
    (maps, states.iter().filter(is_left).cloned().collect())
}

impl FaceMap {
    /// Of these pairs; `None` where they are on no plane, or on a line.
    fn of(
        structure: &Structure,
        states: &[PairState],
        pairs: &[usize],
        quantity: Quantity,
        units: &Units,
    ) -> Option<FaceMap> {
        let first = structure.pairs.get(*pairs.first()?)?;
        let &[t1, t2] = &first.tangents[..] else { return None };
        let place = |pair: usize| structure.nodes[structure.pairs[pair].node].position;
        let places: Vec<[f64; 3]> = pairs.iter().map(|&pair| place(pair)).collect();
        if straight_order(&places).is_some() {
            return None;
        }
        let from = places[0];
        let at: Vec<(f64, f64)> = places.iter().map(|&p| (dot(way(from, p), t1), dot(way(from, p), t2))).collect();
        let size = at.iter().map(|(x, y)| x.hypot(*y)).fold(0.0, f64::max);
        if places.iter().any(|&p| dot(way(from, p), first.normal).abs() > FLAT * size) {
            return None;
        }
        let value = |state: &PairState| match quantity {
            Quantity::Slip => state.z_t.abs(),
            Quantity::Force => state.x_t.abs(),
            Quantity::Gap => state.z_n,
            Quantity::Pressure => state.x_n,
        };
        let of = || pairs.iter().map(|&pair| &states[pair]);
        // what is rounding beside the other values of its unit is nothing
        let scale = of().map(|state| match quantity {
            Quantity::Slip | Quantity::Gap => state.z_t.abs().max(state.z_n),
            Quantity::Force | Quantity::Pressure => state.x_t.abs().max(state.x_n),
        });
        let scale = scale.fold(0.0, f64::max);
        let spot = |(state, at): (&PairState, (f64, f64))| Spot {
            at,
            id: state.id.clone(),
            state: state.state,
            value: denoised(value(state), scale),
            towards: direction(&state.slip()).filter(|_| state.state == State::Slip),
        };
        let spots: Vec<Spot> = of().zip(at.iter().copied()).map(spot).collect();
        let largest = spots.iter().map(|spot| spot.value).fold(0.0, f64::max);
        let name = match spots[0].id.split_once('[') {
            Some((face, _)) => face,
            None => &spots[0].id,
        };
        let unit = quantity.unit(units);
        // the unit stands with the largest value, mm or µm of lengths
        let title = format!("{} over {name}", quantity.name(true));
        let spacing = (least_step(at.iter().map(|at| at.0), size), least_step(at.iter().map(|at| at.1), size));
        Some(FaceMap { title, unit, spots, largest, spacing, tangents: [t1, t2], quantity })
    }

    /// Level of a value, 0 … [`LEVELS`] − 1: tenths of the largest.
    pub fn level(&self, value: f64) -> usize {
        if self.largest <= 0.0 {
            return 0;
        }
        ((value / self.largest * LEVELS as f64) as usize).min(LEVELS - 1)
    }

    /// Least and largest place along t1 and t2, half a cell beyond the pairs.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        let range = |read: fn(&Spot) -> f64, step: f64| {
            let values = self.spots.iter().map(read);
            let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
            [low - 0.5 * step, high + 0.5 * step]
        };
        [range(|spot| spot.at.0, self.spacing.0), range(|spot| spot.at.1, self.spacing.1)]
    }

    /// What stands under the map.
    pub fn notes(&self) -> Vec<String> {
        let most = self.spots.iter().max_by(|a, b| a.value.total_cmp(&b.value));
        let largest = match most.filter(|_| self.largest > 0.0) {
            Some(most) => {
                format!("0 … 9: tenths of the largest, {} at {}", measured(self.largest, self.unit.as_deref()), most.id)
            }
            None => "0 everywhere".to_owned(),
        };
        let vector = |v: [f64; 3]| format!("({}, {}, {})", short(tidy(v[0])), short(tidy(v[1])), short(tidy(v[2])));
        let [t1, t2] = self.tangents.map(vector);
        let mut notes = vec![largest, format!("to the right t1 = {t1}, upwards t2 = {t2}")];
        if matches!(self.quantity, Quantity::Slip | Quantity::Force) {
            let slipping = self.spots.iter().filter(|spot| spot.state == State::Slip).count();
            notes.push(format!("{slipping} of {} pairs slip", self.spots.len()));
        }
        notes
    }

    /// Columns and rows of a map in characters, and the size of a column.
    fn raster(&self, width: usize, height: usize) -> (usize, usize, f64) {
        let [[left, right], [bottom, top]] = self.bounds();
        let (wide, high) = (right - left, top - bottom);
        let least = (wide / width.max(1) as f64).max(high / (ASPECT * height.max(1) as f64));
        // a whole number of columns to a pair, where there is room
        let columns_to_a_pair = (self.spacing.0 / least).floor();
        let column = if columns_to_a_pair >= 1.0 { self.spacing.0 / columns_to_a_pair } else { least };
        let count = |size: f64, most: usize| ((size).round() as usize).clamp(1, most.max(1));
        (count(wide / column, width), count(high / (ASPECT * column), height), column)
    }

    /// Draws the map, at most `height` rows high.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: &mut dyn Write, height: usize, style: &Style) -> io::Result<()> {
        writeln!(out, "{}", style.paint(Role::Title, &style.fit(&style.text(&self.title), style.width)))?;
        let (columns, rows, _) = self.raster(style.width.saturating_sub(2).max(4), height);
        let [[left, right], [bottom, top]] = self.bounds();
        let at = |k: f64, count: usize, [low, high]: [f64; 2]| low + (high - low) * k / count as f64;
        let cell = |spot: &Spot| {
            let share = |x: f64, [low, high]: [f64; 2]| (x - low) / (high - low);
            let column = (share(spot.at.0, [left, right]) * columns as f64) as usize;
            let row = ((1.0 - share(spot.at.1, [bottom, top])) * rows as f64) as usize;
            (column.min(columns - 1), row.min(rows - 1))
        };
        // a pair has a sign of its own where its cell is wide enough to show its level too
        let has_signs = columns as f64 * self.spacing.0 >= 3.0 * (right - left);
        let border = self.border();
        for row in 0..rows {
            let y = at((rows - row) as f64 - 0.5, rows, [bottom, top]);
            let mut cells: Vec<(char, Role)> = vec![(' ', Role::Plain)];
            for column in 0..columns {
                let x = at(column as f64 + 0.5, columns, [left, right]);
                cells.push(self.nearest((x, y), &border).map_or((' ', Role::Plain), |spot| {
                    if has_signs && cell(spot) == (column, row) {
                        return (pair_sign(spot.state, spot.towards, style.ascii), Role::State(spot.state));
                    }
                    let level = self.level(spot.value);
                    (char::from(b'0' + level as u8), level_role(level))
                }));
            }
            writeln!(out, "{}", super::canvas::paint_runs(&cells, style))?;
        }
        let mut notes = self.notes();
        if has_signs {
            notes.push(self.states_in_words(style));
        }
        style.paragraph(out, Role::Muted, &notes.join(&format!(" {} ", style.dot())))
    }

    /// The signs that occur with their words.
    fn states_in_words(&self, style: &Style) -> String {
        let mut words: Vec<String> = Vec::new();
        for spot in &self.spots {
            let sign = match spot.state {
                State::Slip => {
                    if style.ascii {
                        '>'
                    } else {
                        '▶'
                    }
                }
                state => pair_sign(state, None, style.ascii),
            };
            let word = format!("{sign} {}", spot.state.word());
            if !words.contains(&word) {
                words.push(word);
            }
        }
        words.join(", ")
    }

    /// The pair nearest to a place, if one is near and the face reaches there.
    fn nearest(&self, (x, y): (f64, f64), border: &[(f64, f64)]) -> Option<&Spot> {
        let (dx, dy) = self.spacing;
        let away = |spot: &Spot| ((spot.at.0 - x) / dx).hypot((spot.at.1 - y) / dy);
        let nearest = self.spots.iter().min_by(|a, b| away(a).total_cmp(&away(b)))?;
        // the corner of a cell is √½ away
        let is_near = away(nearest) <= 1.0;
        let cell = ((nearest.at.0 - x) / dx).abs().max(((nearest.at.1 - y) / dy).abs());
        (is_near && (cell <= 0.5 || reaches(border, (x / dx, y / dy)))).then_some(nearest)
    }

    /// The border of the pairs, counter-clockwise around all of them, in spacings.
    fn border(&self) -> Vec<(f64, f64)> {
        let mut places: Vec<(f64, f64)> =
            self.spots.iter().map(|spot| (spot.at.0 / self.spacing.0, spot.at.1 / self.spacing.1)).collect();
        places.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let half = |places: &mut dyn Iterator<Item = &(f64, f64)>| {
            let mut half: Vec<(f64, f64)> = Vec::new();
            for &next in places {
                while let [.., a, b] = half[..] {
                    if turn(a, b, next) > 0.0 {
                        break;
                    }
                    half.pop();
                }
                half.push(next);
            }
            half.pop();
            half
        };
        let mut border = half(&mut places.iter());
        border.extend(half(&mut places.iter().rev()));
        border
    }
}

/// > 0 where the way from a over b to c turns left: twice the area of the triangle.
fn turn(a: (f64, f64), b: (f64, f64), c: (f64, f64)) -> f64 {
    (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)
}

/// Whether a place lies within a border, or no more than half a spacing outside.
fn reaches(border: &[(f64, f64)], place: (f64, f64)) -> bool {
    let sides = || border.iter().zip(border.iter().cycle().skip(1));
    let is_inside = sides().all(|(&a, &b)| turn(a, b, place) >= 0.0);
    let away = |(&a, &b): (&(f64, f64), &(f64, f64))| {
        let (side, way) = ((b.0 - a.0, b.1 - a.1), (place.0 - a.0, place.1 - a.1));
        let square = side.0 * side.0 + side.1 * side.1;
        let share = ((side.0 * way.0 + side.1 * way.1) / square).clamp(0.0, 1.0);
        (way.0 - share * side.0).hypot(way.1 - share * side.1)
    };
    is_inside || sides().any(|side| away(side) <= 0.5)
}

/// Unit vector along a slip.
fn direction(slip: &[f64]) -> Option<(f64, f64)> {
    let &[along, across] = slip else { return None };
    let size = along.hypot(across);
    (size > 0.0).then(|| (along / size, across / size))
}

/// −0 and what is rounding of a unit vector are 0.
fn tidy(entry: f64) -> f64 {
    if entry.abs() < 1e-12 { 0.0 } else { entry }
}

/// The least step between values that differ; `size` where they do not.
fn least_step(values: impl Iterator<Item = f64>, size: f64) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let steps = values.windows(2).map(|two| two[1] - two[0]).filter(|step| *step > 1e-3 * size);
    let least = steps.fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { size }
}

/// From cold to hot.
fn level_role(level: usize) -> Role {
    match level {
        0 => Role::Muted,
        1..=2 => Role::Series(4),
        3..=4 => Role::Series(0),
        5..=6 => Role::Series(3),
        7..=8 => Role::Series(1),
        _ => Role::Series(5),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::tests::sample::{block, block_states, units};

    /// Pairs of a block on a grid of 3 × 2 elements, whose slip grows with x: the largest at the right edge.
    #[test]
    fn a_face_is_a_map_and_a_line_is_none() {
        let structure = block([3, 2, 1], [3.0, 2.0, 1.0]);
        let states = block_states(&structure);
        let (maps, rest) = faces(&structure, &states, Quantity::Slip, &units());
        let [map] = &maps[..] else { panic!("{maps:?}") };
        assert!(rest.is_empty());
        assert_eq!(map.title, "Slip |z_τ| over g");
        assert_eq!((map.spacing, map.bounds()), ((1.0, 1.0), [[-0.5, 3.5], [-0.5, 2.5]]));
        // z_t = x mm at (x, y)
        assert!((map.largest - 3e-3).abs() < 1e-15);
        let levels: Vec<usize> = map.spots.iter().map(|spot| map.level(spot.value)).collect();
        assert_eq!(levels, [0, 3, 6, 9].repeat(3));
        // it slips at 30° from t1 except at x = 0, where it sticks
        for spot in &map.spots {
            match spot.towards {
                Some((c, s)) => assert!((s.atan2(c).to_degrees() - 30.0).abs() < 1e-9 && spot.at.0 > 0.0),
                None => assert_eq!(spot.at.0, 0.0),
            }
        }
        let mut line = structure.clone();
        line.pairs.truncate(4);
        let (maps, rest) = faces(&line, &states[..4], Quantity::Slip, &units());
        assert!(maps.is_empty() && rest.len() == 4);
        // a pair above the others is on no plane with them
        let mut bent = structure.clone();
        bent.pairs[0].node = bent.nodes.len() - 1;
        assert!(faces(&bent, &states, Quantity::Slip, &units()).0.is_empty());
    }

    /// Pairs on one half of a square are drawn as the triangle that they are: each row ends a cell before the one below it.
    #[test]
    fn a_triangle_is_a_triangle() {
        let structure = block([6, 6, 1], [6.0, 6.0, 1.0]);
        let states = block_states(&structure);
        let (maps, _) = faces(&structure, &states, Quantity::Slip, &units());
        let mut map = maps[0].clone();
        map.spots.retain(|spot| spot.at.0 + spot.at.1 <= 6.0 + 1e-9);
        let mut out = Vec::new();
        map.write(&mut out, 7, &Style { width: 16, ascii: true, ..Style::default() }).unwrap();
        let text = String::from_utf8(out).unwrap();
        let lengths: Vec<usize> = text.lines().skip(1).take(7).map(|line| line.trim().len()).collect();
        assert_eq!(lengths.len(), 7);
        assert!(lengths.is_sorted() && lengths[0] <= 4 && lengths[6] >= 12, "{lengths:?}\n{text}");
    }

    #[test]
    fn a_map_in_characters_shows_levels_and_states() {
        let structure = block([3, 2, 1], [3.0, 2.0, 1.0]);
        let states = block_states(&structure);
        let (maps, _) = faces(&structure, &states, Quantity::Slip, &units());
        for style in [Style { width: 40, ..Style::default() }, Style { width: 40, ascii: true, ..Style::default() }] {
            let mut out = Vec::new();
            maps[0].write(&mut out, 12, &style).unwrap();
            let text = String::from_utf8(out).unwrap();
            insta::assert_snapshot!(if style.ascii { "face_map_ascii" } else { "face_map" }, text);
        }
    }
}
