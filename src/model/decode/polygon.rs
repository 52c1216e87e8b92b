//! `solver.facets` and `solver.cone`: how friction in space is solved.

use super::reader::{Cursor, Fields};
use crate::model::rules::{self, FACETS, FACETS_EXPECTED, Rules};

/// Keys of the solver that belong to problems in space.
pub const KEYS: [&str; 2] = ["facets", "cone"];

/// K of the friction polygon.
pub fn facets(fields: &Fields<'_>) -> u16 {
    let Some(cursor) = fields.optional("facets") else {
        return FACETS;
    };
    let Some(found) = cursor.whole("number of facets", 4) else {
        return FACETS;
    };
    rules::facets(found).unwrap_or_else(|| {
        cursor.problem(format!("a friction polygon cannot have {found} facets"), format!("expected {FACETS_EXPECTED}"));
        FACETS
    })
}

/// Whether the answer is taken from the polygon to Coulomb's cone.
pub fn cone(fields: &Fields<'_>) -> bool {
    fields.optional("cone").and_then(Cursor::boolean).unwrap_or(Rules::default().cone)
}

/// In the plane there is no polygon to choose.
pub fn refuse_in_plane(solver: Option<Cursor<'_>>, known: &[&'static str]) {
    let Some(fields) = solver.filter(|cursor| cursor.is_object()).and_then(|cursor| cursor.fields(known)) else {
        return;
    };
    fields.refuse(
        &KEYS,
        |key| format!("`solver.{key}` belongs to problems in space: in the plane a pair slips along +t or −t only"),
        "remove it",
    );
}
