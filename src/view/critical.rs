//! Critical friction.

use std::io::{self, Write};

use super::style::{Role, Style};
use crate::contact::schemes::critical::{Coverage, CriticalFriction};
use crate::contact::schemes::scheme::PairScheme;
use crate::text::number::short;

/// "c1 open, c2 slip+".
pub fn scheme_words(ids: &[&str], scheme: &[PairScheme]) -> String {
    let words: Vec<String> = ids
        .iter()
        .zip(scheme)
        .map(|(id, scheme)| {
            let state = if scheme.open { "open" } else { scheme.tangential.word() };
            format!("{id} {state}")
        })
        .collect();
    words.join(", ")
}

/// The finding in a sentence.
pub fn sentence(parameter: &str, found: &CriticalFriction, ids: &[&str]) -> String {
    let scheme = found
        .scheme
        .as_ref()
        .map_or(String::new(), |scheme| format!(" (working scheme {})", scheme_words(ids, scheme)));
    match (found.value, found.coverage) {
        (Some(value), Coverage::Exact) if found.singular > 0 => format!(
            "{parameter} up to {}: no working scheme loses its uniqueness, nothing is said of the singular ones; above it, more \
             than one answer is possible{scheme}",
            precise(value)
        ),
        (Some(value), Coverage::Exact) => format!(
            "{parameter} up to {}: one answer for every load; above it, more than one is possible{scheme}",
            precise(value)
        ),
        (Some(value), Coverage::Sampled { count, seed }) => format!(
            "above {parameter} = {} more than one answer is possible{scheme}; a smaller value was not found in {count} \
             blocks drawn with seed {seed}",
            precise(value)
        ),
        (None, Coverage::Exact) if found.singular == 0 => {
            format!("one answer for every load, whatever {parameter}")
        }
        (None, Coverage::Exact) => {
            format!("no working scheme loses its uniqueness at any {parameter}; nothing is said of the singular ones")
        }
        (None, Coverage::Sampled { count, seed }) => {
            format!("no counter-example found in {count} blocks drawn with seed {seed}: nothing is proved")
        }
    }
}

/// Ten significant digits without trailing zeros.
fn precise(value: f64) -> String {
    let rounded: f64 = format!("{value:.9e}").parse().unwrap_or(value);
    if (1e-4..1e6).contains(&rounded.abs()) { format!("{rounded}") } else { short(value) }
}

/// Writes the finding and how it was found.
pub fn write(
    out: &mut dyn Write,
    parameter: &str,
    found: &CriticalFriction,
    ids: &[&str],
    style: &Style,
) -> io::Result<()> {
    let singular = if found.singular > 0 {
        format!("; {} of them singular without friction already (parts held by contact only)", found.singular)
    } else {
        String::new()
    };
    let how = format!("{} determinants examined{singular}", found.examined);
    for text in [sentence(parameter, found, ids), how] {
        style.paragraph(out, Role::Plain, &text)?;
    }
    Ok(())
}
