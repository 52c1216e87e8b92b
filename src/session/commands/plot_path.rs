//! `plot path`: what was followed last.

use std::io::Write;
use std::sync::Arc;

use serde_json::{Map, Value};

use crate::model::parameter::ParameterValues;
use crate::model::words::did_you_mean_typed;
use crate::model::words::no_such;
use crate::path::quantity::OnPath;
use crate::path::record::{Followed, PathPlace, PathRecord};
use crate::session::commands::along::Along;
use crate::session::{CommandError, Format, Output, Session};
use crate::view;
use crate::view::plot::chart::Chart;
use crate::view::plot::zone::Quantity as Zone;
use crate::view::style::Style;
use crate::watch::Watch;

impl Session {
    /// `plot path [QUANTITY] [PAIRS] [over CASE]`, `plot path QUANTITY [over CASE]`.
    pub(in crate::session) fn plot_path(
        &self,
        of: &[String],
        height: usize,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let (chart, along) = self.path_chart(of, io.watch)?;
        let path = self.need_path()?;
        let write = |out: &mut dyn Write, style: &Style| Chart { height, ..chart }.write(out, style);
        match along {
            Some(along) => io.show(&Along::of(path, &along), write)?,
            None => io.show(path, write)?,
        }
        if let Some(stale) = self.stale_path().filter(|_| io.format == Format::Text) {
            io.say(&format!("the path was {stale}"))?;
        }
        Ok(())
    }

    /// The chart of what was followed last; the quantities in it, where it is not of the numbers of pairs.
    pub(in crate::session) fn path_chart(
        &self,
        of: &[String],
        watch: &dyn Watch,
    ) -> Result<(Chart, Option<Vec<OnPath>>), CommandError> {
        let path = self.need_path()?;
        let units = &self.now.scenario.units;
        let (of, over) = match of.iter().rposition(|word| word == "over") {
            Some(at) if at + 1 < of.len() => (&of[..at], Some(abscissa(path, &of[at + 1..].join(" "))?)),
            _ => (of, None),
        };
        let (quantity, names) = match of.split_first() {
            Some((word, rest)) if word == "slip" => (Zone::Slip, rest),
            Some((word, rest)) if word == "force" => (Zone::Force, rest),
            Some((word, rest)) if word == "gap" => (Zone::Gap, rest),
            Some((word, rest)) if word == "pressure" => (Zone::Pressure, rest),
            Some((word, _)) if !path.places.iter().any(|place| place.pairs.iter().any(|pair| pair.id == *word)) => {
                let quantities = self.quantities(of)?;
                let Some(prepared) = &self.now.prepared else {
                    return Err(CommandError::Refused("not solved yet: `solve`, or `set auto on`".into()));
                };
                let along = self.report_along(prepared, path, &quantities, watch)?;
                return Ok((view::plot::path::drawing_along(path, &along, over, units), Some(along)));
            }
            _ => (Zone::Slip, of),
        };
        let ids: Vec<&str> = path
            .places
            .first()
            .map(|place| place.pairs.iter().map(|pair| pair.id.as_str()).collect())
            .unwrap_or_default();
        let mut pairs = Vec::new();
        for name in names {
            let pair = ids.iter().position(|id| id == name).ok_or_else(|| {
                CommandError::Refused(format!("plot: no pair {name}{}", did_you_mean_typed(name, ids.iter().copied())))
            })?;
            pairs.push(pair);
        }
        if pairs.is_empty() {
            pairs = busiest(path, &ids);
        }
        Ok((view::plot::path::drawing(path, quantity, &pairs, over, units), None))
    }

    /// Quantities, or numbers of pairs as a picture of the path has them, at every place of it: with its stage, where there
    /// are stages, the value that was followed, the factors of the load cases and what changes there.
    pub(in crate::session) fn path_rows(&self, of: &[String], watch: &dyn Watch) -> Result<Value, CommandError> {
        let path = self.need_path()?;
        let (_, along) = self.path_chart(of, watch)?;
        let along = match along {
            Some(along) => along,
            None => {
                return Err(CommandError::Refused(format!(
                    "export: a table of a path takes quantities, e.g. `z_t {}`; without them it has all numbers of the pairs",
                    path.places.first().and_then(|place| place.pairs.first()).map_or("c1", |pair| pair.id.as_str())
                )));
            }
        };
        let row = |(k, place): (usize, &PathPlace)| {
            let mut row = Map::new();
            if let Some(stage) = place.stage {
                row.insert("stage".to_owned(), stage.into());
            }
            row.insert("value".to_owned(), place.value.into());
            for (case, factor) in path.cases.iter().zip(&place.factors) {
                row.insert(format!("factor {case}"), (*factor).into());
            }
            for (quantity, values) in &along {
                row.insert(quantity.to_string(), values.get(k).copied().flatten().into());
            }
            row.insert("change".to_owned(), place.change.as_str().into());
            Value::Object(row)
        };
        Ok(path.places.iter().enumerate().map(row).collect())
    }

    /// Keeps a path that was followed under the present values.
    pub(in crate::session) fn keep_path(&mut self, record: PathRecord) {
        self.path = Some(Arc::new(record));
        self.path_values = self.now.values.clone();
    }

    /// Says so where the path was followed under other values than the present ones; which, as far as they differ.
    pub(in crate::session) fn stale_path(&self) -> Option<String> {
        self.path.as_ref()?;
        self.other_values(&self.path_values, &[]).map(|stale| format!("followed {stale}"))
    }

    /// `under f = 0.5; the present values are others`, where they are; parameters in `besides` do not count.
    pub(in crate::session) fn other_values(&self, then: &ParameterValues, besides: &[&str]) -> Option<String> {
        let differs = |(name, value): &(&String, f64)| {
            !besides.contains(&name.as_str()) && self.now.values.get(name.as_str()).is_some_and(|now| now != value)
        };
        let named: Vec<String> = then.free().filter(differs).map(|(name, value)| format!("{name} = {value}")).collect();
        (!named.is_empty()).then(|| format!("under {}; the present values are others", named.join(", ")))
    }

    pub(in crate::session) fn need_path(&self) -> Result<&PathRecord, CommandError> {
        self.path.as_deref().ok_or_else(|| {
            CommandError::Refused(
                "no path was followed yet: `trace CASE`, `trace FRICTION`, `limit CASE` or `stages`".into(),
            )
        })
    }
}

/// The load case whose factor a plot of a history goes over.
fn abscissa(path: &PathRecord, name: &str) -> Result<usize, CommandError> {
    let refusal = match path.followed {
        Followed::Stages => match path.cases.iter().position(|case| case == name) {
            Some(case) => return Ok(case),
            None => no_such("load case", name, path.cases.iter().map(String::as_str)),
        },
        _ => format!("plot: `over` chooses a load case of a history; this path goes over {}", path.name),
    };
    Err(CommandError::Refused(refusal))
}

/// The pairs that slip most on a path, at most four: what a plot shows if none is named.
fn busiest(path: &PathRecord, ids: &[&str]) -> Vec<usize> {
    let most = |pair: usize| {
        crate::answer::rounding::largest(
            path.places.iter().filter_map(|place| place.pairs.get(pair).map(|pair| pair.z_t)),
        )
    };
    let mut pairs: Vec<usize> = (0..ids.len()).collect();
    pairs.sort_by(|&a, &b| most(b).total_cmp(&most(a)).then(a.cmp(&b)));
    pairs.truncate(4);
    pairs
}
