//! `strain`: lack of fit or prestress of bars, N = EA (ε − ε₀).

use super::named_elements;
use crate::model::decode::reader::Cursor;
use crate::model::decode::structure::Builder;
use crate::model::structure::{ElementKind, Load};

pub fn read<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let fields = cursor.fields(&["on", "value"])?;
    let strain = fields.required("value").and_then(Cursor::number);
    let elements = named_elements(builder, fields.required("on")?, |at, kind| {
        let is_bar = !matches!(kind, ElementKind::Membrane { .. });
        if !is_bar {
            at.problem(
                format!("{} is no bar: `strain` is the lack of fit of bars", at.quoted()),
                "name bars; plates expand by `temperature`",
            );
        }
        is_bar
    });
    let (elements, strain) = (elements?, strain?);
    Some(elements.into_iter().map(|element| Load::FreeStrain { element, strain, curvature: 0.0 }).collect())
}
