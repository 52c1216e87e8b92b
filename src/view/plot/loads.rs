//! Arrows of loads in a picture: each kind scaled by its largest, those close together thinned.

use std::collections::HashMap;

use super::depth::Seen;
use crate::model::units::Units;
use crate::model::vector::length as size;
use crate::text::number::measured;
use crate::view::projection::Projection;
use crate::view::{force_unit, line_load_unit};

/// Most load cases that a legend names.
const NAMED: usize = 3;

/// What a load is: forces, forces per length and weights are not drawn to one scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadKind {
    /// At a point.
    Force,
    /// Per length of a bar.
    Line,
    /// Of a bar, or of all membranes or solids that are connected, at its centre.
    Weight,
}

impl LoadKind {
    const ALL: [LoadKind; 3] = [LoadKind::Force, LoadKind::Line, LoadKind::Weight];
}

/// Load cases, a bit for each; those from 128 on share the last one.
pub type Cases = u128;

/// A point force or a weight: its kind, its place in the picture, its force in the model, its cases.
pub(super) type Point = (LoadKind, Seen, [f64; 3], Cases);

/// A line load: both ends of its line in the picture, its force per length at each in the model, its cases.
pub(super) type LineLoad = ([Seen; 2], [[f64; 3]; 2], Cases);

/// Loads in a picture, all cases added up.
#[derive(Clone, Debug, Default)]
pub struct Loads {
    /// How forces are seen.
    projection: Projection,
    /// Point forces and weights.
    pub(super) points: Vec<Point>,
    /// Line loads: ends and values there.
    pub(super) lines: Vec<LineLoad>,
    /// Names of the load cases.
    names: Vec<String>,
}

/// An arrow of a load.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrow {
    /// What it is.
    pub kind: LoadKind,
    /// Where it acts, in the picture.
    pub at: (f64, f64),
    /// Force, or force per length, in the model.
    pub force: [f64; 3],
    /// Its direction in the picture: shorter than 1 where it leads out of it.
    direction: (f64, f64),
    /// Whether it leads towards the viewer.
    pub comes: bool,
    /// Its size as a share of the largest of its kind.
    pub share: f64,
    /// The load cases that it sums.
    cases: Cases,
}

/// Arrows that find room.
#[derive(Clone, Debug, Default)]
pub struct Arrows {
    /// The arrows.
    pub arrows: Vec<Arrow>,
    /// Whether point forces close together were added up.
    pub is_added: bool,
}

/// A direction shorter than this is seen from its tip or its tail.
const END_ON: f64 = 0.1;

impl Arrow {
    /// Of a load that is as large as the largest of its kind.
    pub(super) fn new(kind: LoadKind, at: (f64, f64), force: [f64; 3], cases: Cases, projection: &Projection) -> Arrow {
        let [x, y, towards] = projection.seen(force.map(|f| f / size(force)));
        Arrow { kind, at, force, direction: (x, y), comes: towards > 0.0, share: 1.0, cases }
    }

    /// Unit vector along it in the picture; `None` where it leads straight out of it, or into it.
    pub fn direction(&self) -> Option<(f64, f64)> {
        let (x, y) = self.direction;
        let length = x.hypot(y);
        (length > END_ON).then(|| (x / length, y / length))
    }

    /// Tail and tip as distances along it from its place, `apart` from that: from outside to its place, or away from it
    /// where it pulls at the very end of the structure, whose middle lies `outward` behind and whose size is `extent`.
    pub fn span(&self, outward: f64, extent: f64, [shortest, longest]: [f64; 2], apart: f64) -> [f64; 2] {
        let longest = if self.kind == LoadKind::Line { 0.6 * longest } else { longest };
        let length = shortest + (longest - shortest) * self.share;
        if outward > 0.3 * extent { [apart, apart + length] } else { [-apart - length, -apart] }
    }
}

impl Loads {
    /// Loads of cases of these names in a picture; what acts at one place is added up.
    pub(super) fn new(names: Vec<String>, projection: &Projection, points: Vec<Point>, lines: Vec<LineLoad>) -> Loads {
        Loads { projection: *projection, points: together(points, 0.0).0, lines, names }
    }

    /// Arrows at least `apart` from one another: point forces nearer than that are added up, line loads have an arrow
    /// every `apart`. What cancels out has none.
    pub fn arrows(&self, apart: f64) -> Arrows {
        let (points, is_added) = together(self.points.clone(), apart);
        let arrow = |kind, at, force, cases| Arrow::new(kind, at, force, cases, &self.projection);
        let mut arrows: Vec<Arrow> =
            points.into_iter().map(|(kind, [x, y, _], force, cases)| arrow(kind, (x, y), force, cases)).collect();
        let mut last: Option<(f64, f64)> = None;
        for ([a, b], [from, to], cases) in &self.lines {
            let way = (b[0] - a[0]).hypot(b[1] - a[1]);
            let count = (way / apart).floor().clamp(1.0, 1e4) as usize;
            for step in 0..=count {
                let t = step as f64 / count as f64;
                let mix = |x: f64, y: f64| x + t * (y - x);
                let place = (mix(a[0], b[0]), mix(a[1], b[1]));
                if last.is_some_and(|last| (place.0 - last.0).hypot(place.1 - last.1) < 0.8 * apart) {
                    continue;
                }
                last = Some(place);
                let force = std::array::from_fn(|c| mix(from[c], to[c]));
                arrows.push(arrow(LoadKind::Line, place, force, *cases));
            }
        }
        for kind in LoadKind::ALL {
            let of_kind = || arrows.iter().filter(|arrow| arrow.kind == kind);
            let most = of_kind().map(|arrow| size(arrow.force)).fold(0.0, f64::max);
            for arrow in arrows.iter_mut().filter(|arrow| arrow.kind == kind) {
                arrow.share = if most > 0.0 { size(arrow.force) / most } else { 0.0 };
            }
        }
        arrows.retain(|arrow| arrow.share > 1e-9 && arrow.share.is_finite());
        Arrows { arrows, is_added }
    }

    /// Largest line load: its arrows need not stand where it is.
    fn largest_line(&self) -> f64 {
        self.lines.iter().flat_map(|(_, values, _)| values.map(size)).fold(0.0, f64::max)
    }

    /// The cases that weights act in; of the other kinds, where arrows sum several cases, those.
    fn summed(&self, kind: LoadKind, arrows: &Arrows) -> String {
        let of_kind = arrows.arrows.iter().filter(|arrow| arrow.kind == kind).map(|arrow| arrow.cases);
        let told = of_kind.filter(|cases| kind == LoadKind::Weight || cases.count_ones() > 1);
        let cases = told.fold(0, |all, cases| all | cases);
        let is_in = |number: &usize| cases & (1 << number.min(&127)) != 0;
        let names: Vec<&str> = (0..self.names.len()).filter(is_in).map(|number| self.names[number].as_str()).collect();
        match names.len() {
            0..=NAMED => names.join(" + "),
            more => format!("{} + {} more", names[..NAMED].join(" + "), more - NAMED),
        }
    }

    /// The kinds that occur with their largest value: `load up to 250 kN`, `weight + quake up to 30 kN`.
    pub fn legend(&self, arrows: &Arrows, units: &Units) -> Vec<(LoadKind, String)> {
        let force = force_unit(units);
        let line = line_load_unit(units);
        let words = |kind: LoadKind| {
            let of_kind = arrows.arrows.iter().filter(|arrow| arrow.kind == kind);
            let most = of_kind.map(|arrow| size(arrow.force)).reduce(f64::max)?;
            let summed = self.summed(kind, arrows);
            let or = |name: &str| if summed.is_empty() { name.to_owned() } else { summed.clone() };
            let (name, most, unit) = match kind {
                LoadKind::Force if arrows.is_added => (format!("{} (near ones added)", or("load")), most, &force),
                LoadKind::Force => (or("load"), most, &force),
                LoadKind::Line => (or("line load"), most.max(self.largest_line()), &line),
                LoadKind::Weight => (or("weight"), most, &force),
            };
            Some((kind, format!("{name} up to {}", measured(most, unit.as_deref()))))
        };
        LoadKind::ALL.into_iter().filter_map(words).collect()
    }
}

/// The weight of several elements, or the sum of several forces; each place is K vectors.
#[derive(Clone, Debug)]
pub(super) struct Weight<const K: usize> {
    pub(super) force: [f64; 3],
    /// Σ |force|, and Σ |force|·place.
    size: f64,
    moments: [[f64; 3]; K],
}

impl<const K: usize> Default for Weight<K> {
    fn default() -> Self {
        Weight { force: [0.0; 3], size: 0.0, moments: [[0.0; 3]; K] }
    }
}

impl<const K: usize> Weight<K> {
    pub(super) fn add(&mut self, place: [[f64; 3]; K], force: [f64; 3]) {
        let own = size(force);
        self.join(1.0, &Weight { force, size: own, moments: place.map(|at| at.map(|x| own * x)) });
    }

    /// Adds another one times a factor.
    pub(super) fn join(&mut self, factor: f64, other: &Weight<K>) {
        self.force = std::array::from_fn(|c| self.force[c] + factor * other.force[c]);
        self.size += factor.abs() * other.size;
        for (sum, moment) in self.moments.iter_mut().zip(&other.moments) {
            *sum = std::array::from_fn(|c| sum[c] + factor.abs() * moment[c]);
        }
    }

    pub(super) fn centre(&self) -> [[f64; 3]; K] {
        self.moments.map(|moment| moment.map(|sum| sum / self.size))
    }
}

/// Point loads of one kind nearer than `apart` (or at one place) added up, at the centre of their sizes; whether any were
/// at different places.
fn together(points: Vec<Point>, apart: f64) -> (Vec<Point>, bool) {
    let mut groups: Vec<(LoadKind, Seen, Weight<1>, Cases)> = Vec::new();
    let mut cells: HashMap<(bool, i64, i64), Vec<usize>> = HashMap::new();
    let cell = |[x, y, _]: Seen| match apart > 0.0 {
        true => ((x / apart).floor() as i64, (y / apart).floor() as i64),
        false => (x.to_bits() as i64, y.to_bits() as i64),
    };
    let mut is_added = false;
    for (kind, at, force, cases) in points {
        let (i, j) = cell(at);
        let is_weight = kind == LoadKind::Weight;
        let reach = if apart > 0.0 { -1..=1 } else { 0..=0 };
        let around = reach.clone().flat_map(|di| reach.clone().map(move |dj| (di, dj)));
        let near = around
            .filter_map(|(di, dj)| cells.get(&(is_weight, i.wrapping_add(di), j.wrapping_add(dj))))
            .flatten()
            .copied()
            .filter(|&group| {
                let (_, [x, y, z], ..) = groups[group];
                (x - at[0]).hypot(y - at[1]) <= 0.8 * apart && (apart > 0.0 || z == at[2])
            })
            .min();
        let group = near.unwrap_or_else(|| {
            groups.push((kind, at, Weight::default(), 0));
            cells.entry((is_weight, i, j)).or_default().push(groups.len() - 1);
            groups.len() - 1
        });
        is_added |= groups[group].1 != at;
        let (.., sum, of) = &mut groups[group];
        *of |= cases;
        sum.add([at], force);
    }
    let all = groups.into_iter().filter(|(.., sum, _)| sum.size > 0.0);
    let point = |(kind, _, sum, cases): (LoadKind, Seen, Weight<1>, Cases)| {
        let [centre] = sum.centre();
        (kind, centre, sum.force, cases)
    };
    (all.map(point).collect(), is_added)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::vector::flat;

    fn nodal(points: &[((f64, f64), [f64; 2])]) -> Loads {
        Loads {
            points: points.iter().map(|&(at, force)| (LoadKind::Force, [at.0, at.1, 0.0], flat(force), 1)).collect(),
            ..Loads::default()
        }
    }

    #[test]
    fn near_forces_are_added_up_and_far_ones_scaled() {
        let loads = nodal(&[((0.0, 0.0), [0.0, -3.0]), ((0.1, 0.0), [0.0, -1.0]), ((5.0, 0.0), [2.0, 0.0])]);
        let found = loads.arrows(1.0);
        assert!(found.is_added);
        let [first, second] = &found.arrows[..] else { panic!("{found:?}") };
        // 3 at 0 and 1 at 0.1: 4 at 0.025
        assert_eq!((first.force, first.share), ([0.0, -4.0, 0.0], 1.0));
        assert!((first.at.0 - 0.025).abs() < 1e-15 && first.at.1 == 0.0);
        assert_eq!((second.force, second.share), ([2.0, 0.0, 0.0], 0.5));
        let apart = loads.arrows(0.01);
        assert!(!apart.is_added && apart.arrows.len() == 3);
    }

    /// Two loads of which one stands behind the other are two, and are said to be added up where they are drawn as one.
    #[test]
    fn loads_behind_each_other_are_told_to_be_added_up() {
        let points = [1.0, 5.0].map(|depth| (LoadKind::Force, [0.0, 0.0, depth], [0.0, -2.0, 0.0], 1)).to_vec();
        let (kept, is_added) = together(points, 0.0);
        assert!(kept.len() == 2 && !is_added);
        let loads = Loads { points: kept, ..Loads::default() };
        let found = loads.arrows(1.0);
        assert!(found.is_added && found.arrows.len() == 1 && found.arrows[0].force == [0.0, -4.0, 0.0]);
    }

    #[test]
    fn what_cancels_out_has_no_arrow() {
        let loads = nodal(&[((0.0, 0.0), [1.0, 0.0]), ((0.0, 0.0), [-1.0, 0.0]), ((3.0, 0.0), [1.0, 0.0])]);
        let places: Vec<_> = loads.arrows(1.0).arrows.iter().map(|arrow| arrow.at).collect();
        assert_eq!(places, [(3.0, 0.0)]);
    }

    /// From 0 to 4 over a length of 8, an arrow every 2: 0 (none), 1, 2, 3, 4.
    #[test]
    fn a_line_load_has_arrows_as_long_as_its_values() {
        let line = ([[0.0; 3], [8.0, 0.0, 0.0]], [[0.0; 3], [0.0, -4.0, 0.0]], 1);
        let loads = Loads { lines: vec![line], ..Loads::default() };
        let found = loads.arrows(2.0);
        let shares: Vec<f64> = found.arrows.iter().map(|arrow| arrow.share).collect();
        assert_eq!(shares, [0.25, 0.5, 0.75, 1.0]);
        let units = Units { length: Some("m".into()), force: Some("kN".into()) };
        assert_eq!(loads.legend(&found, &units), [(LoadKind::Line, "line load up to 4 kN/m".to_owned())]);
    }

    /// A body of 20 under its weight and a quake of a quarter of it, pushed at one place by two cases, at another by one.
    #[test]
    fn an_arrow_is_labelled_by_what_it_sums() {
        let point = |kind, x: f64, force, cases| (kind, [x, 0.0, 0.0], flat(force), cases);
        let mut loads = Loads {
            points: vec![
                point(LoadKind::Weight, 0.0, [0.0, -20.0], 0b1),
                point(LoadKind::Weight, 0.0, [5.0, 0.0], 0b10),
                point(LoadKind::Force, 4.0, [3.0, 0.0], 0b100),
            ],
            names: ["weight", "quake", "push", "wind"].map(String::from).to_vec(),
            ..Loads::default()
        };
        let units = Units { length: Some("m".into()), force: Some("kN".into()) };
        let legend = |loads: &Loads| -> Vec<String> {
            loads.legend(&loads.arrows(1.0), &units).into_iter().map(|(_, text)| text).collect()
        };
        // √(20² + 5²) = 20.616
        assert_eq!(legend(&loads), ["load up to 3 kN", "weight + quake up to 20.616 kN"]);
        loads.points.push(point(LoadKind::Force, 4.0, [0.0, 4.0], 0b1000));
        assert_eq!(legend(&loads)[0], "push + wind up to 5 kN");
    }
}
