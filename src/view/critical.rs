//! Critical friction.

use std::io::{self, Write};

use super::style::{Role, Style};
use crate::contact::polygon::{Polygon, angle, degrees};
use crate::contact::schemes::critical::{Coverage, CriticalFriction};
use crate::contact::schemes::scheme::{PairScheme, Tangential};
use crate::text::number::{rounded, short};

/// "c1 open, c2 slip+".
pub fn scheme_words(ids: &[&str], scheme: &[PairScheme], polygon: Polygon) -> String {
    let words: Vec<String> = ids
        .iter()
        .zip(scheme)
        .map(|(id, scheme)| {
            let state = if scheme.open { "open".to_owned() } else { slip_words(scheme.tangential, polygon) };
            format!("{id} {state}")
        })
        .collect();
    words.join(", ")
}

/// "stick", "slip+"; in space "slip along 45°", "slip between 45° and 90°".
pub fn slip_words(state: Tangential, polygon: Polygon) -> String {
    if polygon == Polygon::PLANE {
        return state.word(polygon);
    }
    let directions: Vec<String> =
        state.facets(polygon).into_iter().map(|facet| degrees(angle(polygon.direction(facet)))).collect();
    match &directions[..] {
        [] => state.word(polygon),
        [one] => format!("slip along {one}"),
        [first, second, ..] => format!("slip between {first} and {second}"),
    }
}

/// The finding in a sentence.
pub fn sentence(parameter: &str, found: &CriticalFriction, ids: &[&str]) -> String {
    let scheme = found
        .scheme
        .as_ref()
        .map_or(String::new(), |scheme| format!(" (working scheme {})", scheme_words(ids, scheme, found.polygon)));
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
    let rounded = rounded(value, 10);
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
    let of = (found.polygon != Polygon::PLANE).then(|| {
        format!(
            "this is said of the polygon of {} facets; of the cone itself it is an estimate (`set facets`: how it changes \
             with K)",
            found.polygon.facets()
        )
    });
    for text in [sentence(parameter, found, ids), how].into_iter().chain(of) {
        style.paragraph(out, Role::Plain, &text)?;
    }
    Ok(())
}
