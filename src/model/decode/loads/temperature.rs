//! `temperature`: free expansion α ΔT, and the free curvature of frame bars that are warmer on one side.

use super::elements;
use crate::model::decode::builder::Builder;
use crate::model::decode::reader::Cursor;
use crate::model::structure::{ElementLoad, Load};

pub fn read<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let fields = cursor.fields(&["change", "on", "gradient"])?;
    let number = |key: &str| match fields.optional(key) {
        Some(at) => Some(Some((at, at.number()?))),
        None => Some(None),
    };
    let (change, gradient) = (number("change"), number("gradient"));
    let elements = fields.required("on").and_then(|on| elements(builder, Some(on)));
    let (change, gradient) = (change?, gradient?);
    if change.is_none() && gradient.is_none() {
        cursor.problem(
            "a `temperature` load needs `change` or `gradient`, or both",
            "give the change of temperature, or how much warmer the +y side of bars is than the other",
        );
        return None;
    }
    let change = change.map_or(0.0, |(_, change)| change);
    let structure = &builder.structure;
    let mut loads = Vec::new();
    for element in elements? {
        let expansion = structure.materials[structure.elements[element].material].expansion;
        let curvature = match gradient {
            // Warmer above, longer above: it bends towards the −y side, against positive curvature.
            Some((at, gradient)) => -expansion * gradient / depth(builder, at, element)?,
            None => 0.0,
        };
        let load = ElementLoad::FreeStrain { strain: expansion * change, curvature };
        loads.push(Load::Element { element, load });
    }
    Some(loads)
}

/// Depth of the section of a frame bar, over which its temperature varies.
fn depth<'d>(builder: &Builder<'d>, at: Cursor<'d>, element: usize) -> Option<f64> {
    let structure = &builder.structure;
    let Some(bar) = structure.bar_of(element).filter(|_| structure.elements[element].bends()) else {
        at.problem(
            "a `gradient` bends frame bars only, and `on` names something else",
            "give plates and truss bars a `temperature` load of their own with `change` alone",
        );
        return None;
    };
    let section = builder.bar_sections[bar];
    let depth = builder.sections.get(section).and_then(|section| section.depth);
    if depth.is_none() {
        at.problem(
            format!(
                "a `gradient` needs the depth of the section, and \"{section}\" of the bar \"{}\" has none",
                structure.bars[bar].id
            ),
            format!("add sections.{section}.depth"),
        );
    }
    depth
}
