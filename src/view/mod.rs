//! Reports: from records to text on any `dyn Write`. Nothing here knows a terminal; width, colour and the set of
//! characters come in as a [`style::Style`].

pub mod calibrate;
pub mod check;
pub mod combinations;
pub mod compare;
pub mod critical;
pub mod cycle;
pub mod data;
pub mod difference;
pub mod displacements;
pub mod enumerate;
pub mod exact;
pub mod find;
pub mod map;
pub mod members;
pub mod mesh;
pub mod pairs;
pub mod parameters;
pub mod path;
pub mod pivots;
pub mod plot;
pub mod projection;
pub mod quantities;
pub mod ray;
pub mod reactions;
pub mod report;
pub mod sample;
pub mod scale;
pub mod sensitivity;
pub mod stages;
pub mod status;
pub mod style;
pub mod summary;
pub mod svg;
pub mod sweep;
pub mod table;
pub mod tableau;
pub mod templates;
pub mod ties;
pub mod warnings;
pub mod why;

#[cfg(test)]
pub(crate) mod tests;

use crate::model::units::Units;

/// Unit of a displacement, if the author named one.
pub fn length_unit(units: &Units) -> Option<String> {
    units.length.clone()
}

/// Unit of a force, if the author named one.
pub fn force_unit(units: &Units) -> Option<String> {
    units.force.clone()
}

/// Unit of a force per length, `kN/m`, if the author named both its parts.
pub fn line_load_unit(units: &Units) -> Option<String> {
    match (&units.force, &units.length) {
        (Some(force), Some(length)) => Some(format!("{force}/{length}")),
        _ => None,
    }
}

/// Unit of a force per area, `kN/m²`, if the author named both its parts.
pub fn area_load_unit(units: &Units) -> Option<String> {
    line_load_unit(units).map(|unit| format!("{unit}²"))
}

/// Unit of a moment, `kN·m`, if the author named both its parts.
pub fn moment_unit(units: &Units) -> Option<String> {
    match (&units.force, &units.length) {
        (Some(force), Some(length)) => Some(format!("{force}·{length}")),
        _ => None,
    }
}
