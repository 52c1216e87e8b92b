//! `temperature`: free expansion α ΔT, and the free curvature of frame bars that are warmer on one side.

use super::elements;
use crate::model::decode::builder::Builder;
use crate::model::decode::reader::Cursor;
use crate::model::structure::{Dimension, ElementLoad, Load};

pub fn read<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let fields = cursor.fields(&["change", "on", "gradient"])?;
    let change = match fields.optional("change") {
        Some(at) => at.number().map(Some),
        None => Some(None),
    };
    let gradient = match fields.optional("gradient") {
        Some(at) => gradients(at).map(|gradient| Some((at, gradient))),
        None => Some(None),
    };
    let elements = fields.required("on").and_then(|on| elements(builder, Some(on)));
    let (change, gradient) = (change?, gradient?);
    if change.is_none() && gradient.is_none() {
        cursor.problem(
            "a `temperature` load needs `change` or `gradient`, or both",
            "give the change of temperature, or how much warmer the +y side of bars is than the other",
        );
        return None;
    }
    let change = change.unwrap_or(0.0);
    let structure = &builder.structure;
    let mut loads = Vec::new();
    for element in elements? {
        let expansion = structure.materials[structure.elements[element].material].expansion;
        let curvature = match gradient {
            // Warmer above, longer above: it bends towards the −y side, against positive curvature.
            Some((at, gradient)) => {
                let of = |axis: usize| {
                    let needed = axis == 0 || gradient[axis] != 0.0;
                    if needed {
                        Some(-expansion * gradient[axis] / depth(builder, at, element, axis)?)
                    } else {
                        Some(0.0)
                    }
                };
                [of(0)?, of(1)?]
            }
            None => [0.0; 2],
        };
        let load = ElementLoad::FreeStrain { strain: expansion * change, curvature };
        loads.push(Load::Element { element, load });
    }
    Some(loads)
}

/// How much warmer bars are on the +y side, and in space on the +z side.
fn gradients(at: Cursor<'_>) -> Option<[f64; 2]> {
    match at.dimension() {
        Dimension::Plane => Some([at.number()?, 0.0]),
        Dimension::Space => {
            let both = at.list_of(2, "how much warmer the +y and the +z side are")?;
            let both: Vec<f64> = both.map(Cursor::number).collect::<Option<_>>()?;
            Some([both[0], both[1]])
        }
    }
}

/// Depth of the section of a frame bar along its local y (0) or z (1), over which its temperature varies.
fn depth<'d>(builder: &Builder<'d>, at: Cursor<'d>, element: usize, axis: usize) -> Option<f64> {
    let structure = &builder.structure;
    let Some(bar) = structure.bar_of(element).filter(|_| structure.elements[element].bends()) else {
        at.problem(
            "a `gradient` bends frame bars only, and `on` names something else",
            "give plates and truss bars a `temperature` load of their own with `change` alone",
        );
        return None;
    };
    let section = builder.bar_sections[bar];
    let depth = builder.sections.get(section).and_then(|section| section.depth[axis]);
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
