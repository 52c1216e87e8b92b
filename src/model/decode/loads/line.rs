//! `line`: force per length of a bar, constant or linear, on all of it or between two distances.

use super::{bar, between, one_or_two_vectors};
use crate::model::bar_axes::BarAxes;
use crate::model::decode::builder::Builder;
use crate::model::decode::reader::{Cursor, Fields};
use crate::model::structure::{ElementLoad, Load};
use crate::model::uses::Region;

/// The axes in which `value` is given.
#[derive(Clone, Copy)]
enum Axes {
    /// Global x and y, per length of bar.
    Global,
    /// Along the bar and across it, per length of bar.
    Local,
    /// Global; each component per length across it: the x component per vertical length, the y component per horizontal
    /// length.
    Projected,
}

const AXES: [(&str, Axes); 3] = [("global", Axes::Global), ("local", Axes::Local), ("projected", Axes::Projected)];

impl Axes {
    /// Global force per length of a bar with these axes.
    fn to_global(self, force: [f64; 3], axes: &BarAxes) -> [f64; 3] {
        let ([x, y, z], [a, b, c]) = (force, axes.x);
        match self {
            Axes::Global => force,
            Axes::Local => axes.to_global(force),
            Axes::Projected => [x * b.hypot(c), y * a.hypot(c), z * a.hypot(b)],
        }
    }
}

pub fn read<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let fields = cursor.fields(&["bar", "value", "range", "axes"])?;
    let value = fields.required("value").and_then(one_or_two_vectors);
    let axes = match fields.optional("axes") {
        Some(at) => at.choice(&AXES),
        None => Some(Axes::Global),
    };
    let bar = fields.required("bar").and_then(|at| bar(builder, at))?;
    let stretches = builder.stretches(bar);
    // A bar has at least one element.
    let total = stretches.last().map_or(0.0, |stretch| stretch.from + stretch.length);
    let [a, b] = range(&fields, total, &builder.structure.bars[bar].id)?;
    let (value, axes) = (value?, axes?);
    let loads = stretches.into_iter().filter_map(|stretch| {
        let ends = [a.max(stretch.from), b.min(stretch.from + stretch.length)];
        if ends[1] <= ends[0] {
            return None;
        }
        let bar_axes = builder.bar_axes(&stretch)?;
        let load = ElementLoad::Line {
            range: ends.map(|s| s - stretch.from),
            value: ends.map(|s| axes.to_global(between(value, (s - a) / (b - a)), &bar_axes)),
        };
        Some(Load::Element { element: stretch.element, load })
    });
    Some(loads.collect())
}

/// Distances from the start of the bar between which the load acts.
fn range(fields: &Fields<'_>, total: f64, bar: &str) -> Option<[f64; 2]> {
    let Some(at) = fields.optional("range").map(|at| at.of(Region::Load)) else { return Some([0.0, total]) };
    let entries: Vec<Cursor<'_>> = at.list_of(2, "distances from the start of the bar")?.collect();
    let [a, b] = [entries[0].number()?, entries[1].number()?];
    // Ends computed by an expression may miss the end of the bar by rounding.
    let room = 4.0 * f64::EPSILON * total;
    if !(a >= -room && b <= total + room) {
        at.problem(
            format!("the range [{a}, {b}] reaches beyond the bar \"{bar}\", which is {total} long"),
            format!("give distances from its start between 0 and {total}"),
        );
        return None;
    }
    if a >= b {
        at.problem(format!("the range [{a}, {b}] is empty"), "give the nearer distance first");
        return None;
    }
    Some([a.max(0.0), b.min(total)])
}
