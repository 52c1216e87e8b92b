//! The answer on one screen: resultants, extremes, reactions with their sums, safety of each load case.

use std::io::{self, Write};

use super::number::{balance, short, with_unit};
use super::quantities::shown;
use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use super::{force_unit, length_unit};
use crate::answer::record::Reaction;
use crate::model::quantity::Quantity;
use crate::model::scenario::Units;
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
    /// Pair or bar; empty where there is none.
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
    /// Why there is no limit.
    pub reason: Option<String>,
}

impl Summary {
    /// Σ fx and Σ fy of the reactions.
    pub fn sum_of_reactions(&self) -> [f64; 2] {
        let of = |component: fn(&Reaction) -> f64| balance(self.reactions.iter().map(component));
        [of(|reaction| reaction.fx), of(|reaction| reaction.fy)]
    }
}

/// The table of the resultants of edge contacts.
pub fn resultants_table(resultants: &[Resultant], units: &Units) -> Table {
    let force = force_unit(units);
    let mut table = Table::new(vec![
        Column::words("joint"),
        Column::numbers("N", force.clone()),
        Column::numbers("T", force),
        Column::numbers("e", length_unit(units)),
    ]);
    for one in resultants {
        let e = one.eccentricity.map_or("no force".to_owned(), short);
        let cells = [one.joint.clone(), short(one.normal), short(one.tangential), e];
        table.rows.push(Row::new(cells.into_iter().map(Cell::from).collect()));
    }
    table
}

/// Writes all of it, parts that are empty left out.
pub fn write(out: &mut dyn Write, summary: &Summary, units: &Units, style: &Style) -> io::Result<()> {
    let force = force_unit(units);
    let head = |out: &mut dyn Write, text: &str| writeln!(out, "{}", style.paint(Role::Header, text));
    if !summary.resultants.is_empty() {
        resultants_table(&summary.resultants, units).write(out, style)?;
    }
    if !summary.peaks.is_empty() {
        head(out, "largest")?;
        for peak in &summary.peaks {
            let value = with_unit(&short(peak.value), peak.quantity.unit(units).as_deref());
            let at = if peak.at.is_empty() { String::new() } else { format!(" at {}", peak.at) };
            writeln!(out, "{}", style.fit(&style.text(&format!("  {:<18} {value}{at}", peak.what)), style.width))?;
        }
    }
    if !summary.reactions.is_empty() {
        head(out, "reactions")?;
        let of = |value: f64| with_unit(&short(value), force.as_deref());
        for reaction in summary.reactions.iter().filter(|_| summary.reactions.len() <= REACTIONS) {
            let text = format!("  {:<18} fx {}, fy {}", reaction.node, of(reaction.fx), of(reaction.fy));
            writeln!(out, "{}", style.fit(&style.text(&text), style.width))?;
        }
        let [fx, fy] = summary.sum_of_reactions();
        let text = format!("  {:<18} fx {}, fy {}", format!("sum of {}", summary.reactions.len()), of(fx), of(fy));
        writeln!(out, "{}", style.fit(&style.text(&text), style.width))?;
    }
    if !summary.safety.is_empty() {
        head(out, "safety")?;
        for safety in &summary.safety {
            let text = match (safety.limit, safety.safety, &safety.reason) {
                (Some(limit), Some(factor), _) => format!("{} (limit {})", short(factor), short(limit)),
                (Some(limit), None, _) => format!("limit {}", short(limit)),
                (None, _, Some(reason)) => reason.clone(),
                (None, _, None) => "no limit".to_owned(),
            };
            let label = format!("  {:<18} ", safety.case);
            for line in style.hanging(&label, &style.text(&text)) {
                writeln!(out, "{line}")?;
            }
        }
    }
    if !summary.probes.is_empty() {
        head(out, "probes")?;
        for (name, quantity, value) in &summary.probes {
            let text = format!("  {name:<18} {}", shown(quantity, value, units).0);
            writeln!(out, "{}", style.fit(&style.text(&text), style.width))?;
        }
    }
    Ok(())
}
