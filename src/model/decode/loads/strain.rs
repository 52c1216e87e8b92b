//! `strain`: lack of fit or prestress of bars, N = EA (ε − ε₀).

use super::named_elements;
use crate::model::decode::builder::Builder;
use crate::model::decode::reader::Cursor;
use crate::model::structure::{ElementLoad, Load};

pub fn read<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let fields = cursor.fields(&["on", "value"])?;
    let strain = fields.required("value").and_then(Cursor::number);
    let elements = named_elements(builder, fields.required("on")?, |at, element| {
        let is_bar = element.shape().dimension() == 1;
        if !is_bar {
            at.problem(
                format!("{} is not a bar: `strain` is the lack of fit of bars", at.quoted()),
                "name bars; plates expand by `temperature`",
            );
        }
        is_bar
    });
    let (elements, strain) = (elements?, strain?);
    let load = ElementLoad::FreeStrain { strain, curvature: [0.0; 2] };
    Some(elements.into_iter().map(|element| Load::Element { element, load }).collect())
}
