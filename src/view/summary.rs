//! The answer on one screen: resultants, extremes, reactions with their sums, safety of each load case.

use std::io::{self, Write};

use super::quantities::shown;
use super::scale::ByUnit;
use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use super::{force_unit, length_unit};
use crate::answer::record::Reaction;
use crate::answer::rounding::balance;
use crate::model::quantity::Quantity;
use crate::model::units::Units;
use crate::path::quantity::{NoValue, Resultant, Value};

/// More reactions than this are only summed.
const REACTIONS: usize = 10;

/// What a summary shows.
pub struct Summary {
    /// Of every edge contact.
    pub resultants: Vec<Resultant>,
    /// The largest of everything.
    pub peaks: Vec<Peak>,
    /// The reactions.
    pub reactions: Vec<Reaction>,
    /// Of every load case.
    pub safety: Vec<Safety>,
    /// Name, quantity and value of the probes.
    pub probes: Vec<(String, Quantity, Result<Value, NoValue>)>,
}

/// The largest of its kind.
pub struct Peak {
    /// In words.
    pub what: &'static str,
    /// For its unit.
    pub quantity: Quantity,
    /// With its sign.
    pub value: f64,
    /// Pair, bar or node; empty where there is none.
    pub at: String,
}

/// How far a load may grow.
pub struct Safety {
    /// The case.
    pub case: String,
    /// Its limit factor.
    pub limit: Option<f64>,
    /// Limit over present factor.
    pub safety: Option<f64>,
    /// In a few words why there is none, or what is not sure of it.
    pub brief: String,
    /// Why there is no limit.
    pub reason: Option<String>,
}

impl Summary {
    /// Sum of the reactions; F_z is 0 in the plane.
    pub fn sum_of_reactions(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| balance(self.reactions.iter().map(|reaction| reaction.force()[axis])))
    }

    /// Whether the structure stands in space.
    pub fn is_in_space(&self) -> bool {
        self.reactions.iter().any(|reaction| reaction.space.is_some())
    }
}

/// The table of the resultants of edge contacts.
pub fn resultants_table(resultants: &[Resultant], units: &Units) -> Table {
    let force = force_unit(units);
    let mut table = Table::new(vec![
        Column::words("joint"),
        Column::numbers("N", force.clone()).of(1),
        Column::numbers("T", force).of(1),
        Column::numbers("e", length_unit(units)),
    ]);
    for one in resultants {
        let why_none = if one.over_face { "of an edge only" } else { "no force" };
        let e = one.eccentricity.map_or_else(|| Cell::new(why_none, Role::Muted), Cell::number);
        let cells = [Cell::from(one.joint.as_str()), Cell::number(one.normal), Cell::number(one.tangential), e];
        table.rows.push(Row::new(cells.into()));
    }
    table
}

/// Writes all of it, parts that are empty left out.
pub fn write(out: &mut dyn Write, summary: &Summary, units: &Units, style: &Style) -> io::Result<()> {
    let mut begun = false;
    let mut part = |out: &mut dyn Write, table: Table| {
        if table.rows.is_empty() {
            return Ok(());
        }
        if std::mem::replace(&mut begun, true) {
            writeln!(out)?;
        }
        table.write(out, style)
    };
    part(out, resultants_table(&summary.resultants, units))?;
    part(out, peaks_table(&summary.peaks, units, style.ascii))?;
    part(out, reactions_table(summary, units))?;
    part(out, probes_table(&summary.probes, units, style.ascii))?;
    part(out, safety_table(&summary.safety))
}

/// The limits of the load cases.
pub fn safety_table(safeties: &[Safety]) -> Table {
    let mut table = Table::new(vec![
        Column::words("load case"),
        Column::plain("safety", None),
        Column::plain("limit", None),
        Column::words(""),
    ]);
    for Safety { case, limit, safety, brief, .. } in safeties {
        let cells =
            vec![case.as_str().into(), Cell::maybe(*safety), Cell::maybe(*limit), Cell::new(brief, Role::Muted)];
        table.rows.push(Row::new(cells));
    }
    table
}

/// A value and its unit with their power of ten.
fn written(scales: &ByUnit, value: f64, unit: Option<&str>, ascii: bool) -> [String; 2] {
    let scale = scales.of_row(&[value], unit);
    [scale.number(value), scale.unit(unit, ascii).unwrap_or_default()]
}

/// The largest of everything; values of one unit share their power of ten.
fn peaks_table(peaks: &[Peak], units: &Units, ascii: bool) -> Table {
    let mut table =
        Table::new(vec![Column::words("largest"), Column::numbers("", None), Column::words(""), Column::words("at")]);
    let values: Vec<_> = peaks.iter().map(|peak| (peak.quantity.unit(units), peak.value)).collect();
    let scales = ByUnit::of(&values);
    for (peak, (unit, value)) in peaks.iter().zip(&values) {
        let [number, unit] = written(&scales, *value, unit.as_deref(), ascii);
        let cells = [Cell::from(peak.what), number.into(), Cell::new(unit, Role::Muted), peak.at.as_str().into()];
        table.rows.push(Row::new(cells.into()));
    }
    table
}

/// The reactions and their sum, or the sum alone of many.
fn reactions_table(summary: &Summary, units: &Units) -> Table {
    let force = |head: &str| Column::numbers(head, force_unit(units)).of(1);
    let heads: &[&str] = if summary.is_in_space() { &["F_x", "F_y", "F_z"] } else { &["F_x", "F_y"] };
    let mut table = Table::new(vec![Column::words("reactions")]);
    table.columns.extend(heads.iter().map(|head| force(head)));
    let mut push = |name: &str, force: [f64; 3]| {
        let forces = force[..heads.len()].iter().map(|force| Cell::number(*force));
        table.rows.push(Row::new(std::iter::once(Cell::from(name)).chain(forces).collect()));
    };
    for reaction in summary.reactions.iter().filter(|_| summary.reactions.len() <= REACTIONS) {
        push(&reaction.node, reaction.force());
    }
    if !summary.reactions.is_empty() {
        push(&format!("sum of {}", summary.reactions.len()), summary.sum_of_reactions());
    }
    table
}

/// The probes; values of one unit share their power of ten.
pub fn probes_table(probes: &[(String, Quantity, Result<Value, NoValue>)], units: &Units, ascii: bool) -> Table {
    let mut table = Table::new(vec![Column::words("probes"), Column::numbers("", None), Column::words("")]);
    let number = |value: &Result<Value, NoValue>| value.as_ref().ok().and_then(Value::number);
    let values: Vec<_> = probes.iter().filter_map(|(_, of, value)| Some((of.unit(units), number(value)?))).collect();
    let scales = ByUnit::of(&values);
    for (name, quantity, value) in probes {
        let [text, unit] = match number(value) {
            Some(value) => written(&scales, value, quantity.unit(units).as_deref(), ascii),
            None => [shown(quantity, value, units).0, String::new()],
        };
        table.rows.push(Row::new(vec![Cell::from(name.as_str()), text.into(), Cell::new(unit, Role::Muted)]));
    }
    table
}
