//! `probes`, names for quantities, and `measured`, what was found of them on the real structure.

use super::reader::{Cursor, Entry};
use super::words::quoted;
use crate::model::measurement::Measurement;
use crate::model::quantity::{self, Names, Quantity};
use crate::model::scenario::Scenario;

/// Names for quantities.
pub fn probes(cursor: Cursor<'_>, scenario: &Scenario) -> Option<Vec<(String, Quantity)>> {
    let names = Names::of(scenario);
    let mut probes = Vec::new();
    let mut is_right = true;
    for entry in cursor.entries()? {
        let name = entry.name();
        let plain =
            !name.trim().is_empty() && name.trim() == name && !name.contains(|c: char| c.is_control() || c == '"');
        if quantity::entry(name).is_some() || !plain {
            let why = if plain { "is a quantity itself" } else { "cannot be a name" };
            entry.key_problem(format!("a probe cannot be named {}: it {why}", quoted(name)), "choose another name");
            is_right = false;
        }
        let Some(text) = entry.value().string() else {
            is_right = false;
            continue;
        };
        match quantity::read_text(text, &names).map(<[Quantity; 1]>::try_from) {
            Ok(Ok([quantity])) => probes.push((name.to_owned(), quantity)),
            Ok(Err(found)) => {
                let message = format!("a probe is one quantity, found {} in {}", found.len(), quoted(text));
                entry.value().problem(message, "write e.g. \"M AB start\" or \"z_n c1\"");
                is_right = false;
            }
            Err(error) => {
                entry.value().problem(error.to_string(), "quantities are listed by `help show`");
                is_right = false;
            }
        }
    }
    is_right.then_some(probes)
}

/// Quantities with what was measured: a number, or `{ "value", "error" }`.
pub fn measured(cursor: Cursor<'_>, scenario: &Scenario) -> Option<Vec<Measurement>> {
    let names = Names::of(scenario);
    let found: Vec<Option<Measurement>> = cursor.entries()?.into_iter().map(|entry| one(entry, &names)).collect();
    found.into_iter().collect()
}

fn one(entry: Entry<'_>, names: &Names<'_>) -> Option<Measurement> {
    let quantity = quantity_of(entry, names);
    let cursor = entry.value();
    let (value, error) = if cursor.is_object() {
        let fields = cursor.fields(&["value", "error"])?;
        let value = fields.required("value").and_then(Cursor::literal);
        let error = match fields.optional("error") {
            None => Some(None),
            Some(cursor) => match cursor.literal()? {
                error if error > 0.0 => Some(Some(error)),
                error => {
                    cursor.problem(
                        format!("the error of a measurement must be positive, found {error}"),
                        "give its standard error, in the unit of the value, or leave it out",
                    );
                    None
                }
            },
        };
        (value?, error?)
    } else {
        (cursor.literal()?, None)
    };
    Some(Measurement { quantity: quantity?, value, error })
}

/// The key as one quantity whose value is a number.
fn quantity_of(entry: Entry<'_>, names: &Names<'_>) -> Option<Quantity> {
    let text = entry.name();
    match quantity::read_text(text, names).map(<[Quantity; 1]>::try_from) {
        Ok(Ok([quantity])) if !quantity.is_word() => return Some(quantity),
        Ok(Ok([quantity])) => {
            entry.key_problem(
                format!("{quantity} is a word, not a number that is measured"),
                "name a slip or a displacement",
            );
        }
        Ok(Err(found)) => entry.key_problem(
            format!("a measurement is of one quantity, found {} in {}", found.len(), quoted(text)),
            "write e.g. \"ux s3\" or \"z_t c1\"",
        ),
        Err(error) => entry.key_problem(error.to_string(), "quantities are listed by `help show`"),
    }
    None
}
