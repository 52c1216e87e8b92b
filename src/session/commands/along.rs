//! The values of quantities at the places of a path: `trace … of`, `plot path QUANTITY`.

use serde::Serialize;

use crate::model::quantity::Quantity;
use crate::path::quantity::{Facts, NoValue, OnPath};
use crate::path::record::{Followed, PathPlace, PathRecord};
use crate::session::{CommandError, Session};
use crate::solve::Prepared;
use crate::solve::problem::factors;
use crate::watch::Watch;

impl Session {
    /// What quantities are read from at a place of a path.
    ///
    /// # Errors
    /// Values under which there is no model.
    pub(in crate::session) fn with_place<T>(
        &self,
        prepared: &Prepared,
        path: &PathRecord,
        place: &PathPlace,
        watch: &dyn Watch,
        read: impl FnOnce(&Facts<'_>) -> T,
    ) -> Result<T, NoValue> {
        let mut values = self.now.values.clone();
        if path.followed != Followed::Stages && values.contains_key(&path.name) {
            values.insert(path.name.clone(), place.value);
        }
        // Where the parameter stands in the loads themselves, each place has load vectors of its own.
        let renewed =
            prepared.renewed(&self.now.scenario, &values, watch).map_err(|error| NoValue(error.to_string()))?;
        let prepared = renewed.as_ref().map_or(prepared, |(there, _)| there);
        let factors = if place.factors.is_empty() { factors(prepared, &values) } else { place.factors.clone() };
        let case = prepared.case(&self.now.scenario, &values).watched(watch);
        Ok(read(&Facts::of_state(case, factors, &place.pairs)))
    }

    /// The values of a quantity at the places of a path; `None` where it has none.
    fn along(
        &self,
        prepared: &Prepared,
        path: &PathRecord,
        quantity: &Quantity,
        watch: &dyn Watch,
    ) -> Result<Vec<Option<f64>>, CommandError> {
        let number = |facts: &Facts<'_>| facts.value(quantity).ok()?.number();
        let at = |place| match watch.stop() {
            true => Err(CommandError::Interrupted),
            false => Ok(self.with_place(prepared, path, place, watch, number).ok().flatten()),
        };
        path.places.iter().map(at).collect()
    }

    /// The table of `trace … of`: as JSON and as rows.
    pub(in crate::session) fn report_along(
        &self,
        prepared: &Prepared,
        path: &PathRecord,
        quantities: &[Quantity],
        watch: &dyn Watch,
    ) -> Result<Vec<OnPath>, CommandError> {
        if let Some(quantity) = quantities.iter().find(|quantity| quantity.is_of_history()) {
            return Err(CommandError::Refused(format!(
                "`{quantity}` is of the load history, which a path does not follow at each of its places: \
                 `sweep NAME A..B N --columns '{quantity}'` does"
            )));
        }
        let of = |quantity: &Quantity| Ok((quantity.clone(), self.along(prepared, path, quantity, watch)?));
        let all: Vec<_> = quantities.iter().map(of).collect::<Result<_, CommandError>>()?;
        match all.iter().find(|(_, values)| values.iter().all(Option::is_none)) {
            Some((quantity, _)) => {
                let why = |facts: &Facts<'_>| facts.value(quantity).err();
                let first = path.places.first().map(|place| self.with_place(prepared, path, place, watch, why));
                let why =
                    first.and_then(|read| read.unwrap_or_else(Some)).map_or(String::new(), |why| format!(": {why}"));
                Err(CommandError::Refused(format!("{quantity} has no value on this path{why}")))
            }
            None => Ok(all),
        }
    }
}

/// The values of quantities on a path.
#[derive(Serialize)]
pub(in crate::session) struct Along<'a> {
    values: Vec<f64>,
    quantities: Vec<Values<'a>>,
}

#[derive(Serialize)]
struct Values<'a> {
    quantity: String,
    values: &'a [Option<f64>],
}

impl<'a> Along<'a> {
    pub(in crate::session) fn of(path: &PathRecord, along: &'a [OnPath]) -> Self {
        let values = |(quantity, values): &'a OnPath| Values { quantity: quantity.to_string(), values };
        Along { values: path.abscissas(None), quantities: along.iter().map(values).collect() }
    }
}
