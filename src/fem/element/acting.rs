//! What acts on an element.

use crate::model::structure::ElementLoad;

/// What acts on one element apart from its nodes, each load with its factor.
pub type Acting<'a> = [(f64, &'a ElementLoad)];

/// α ΔT of what acts.
pub(super) fn free_strain(acting: &Acting) -> f64 {
    let strains = acting.iter().map(|(factor, load)| match load {
        ElementLoad::FreeStrain { strain, .. } => factor * strain,
        ElementLoad::Body(_) | ElementLoad::Line { .. } | ElementLoad::Point { .. } => 0.0,
    });
    strains.sum()
}
