//! `strain`: lack of fit or prestress of bars, N = EA (ε − ε₀).

use crate::model::decode::reader::Cursor;
use crate::model::decode::structure::Builder;
use crate::model::structure::{ElementKind, Load};

pub fn read<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let fields = cursor.fields(&["on", "value"])?;
    let strain = fields.required("value").and_then(Cursor::number);
    let mut elements = Vec::new();
    let mut is_right = true;
    for at in fields.required("on")?.list()? {
        let Some(found) = builder.elements_of(at) else {
            is_right = false;
            continue;
        };
        for element in found {
            if matches!(builder.structure.elements[element].kind, ElementKind::Membrane { .. }) {
                at.problem(
                    format!("{} is no bar: `strain` is the lack of fit of bars", at.quoted()),
                    "name bars; plates expand by `temperature`",
                );
                is_right = false;
                break;
            }
            elements.push(element);
        }
    }
    elements.sort_unstable();
    elements.dedup();
    let strain = strain?;
    let loads = elements.into_iter().map(|element| Load::FreeStrain { element, strain, curvature: 0.0 });
    is_right.then(|| loads.collect())
}
