//! `gravity`: density × acceleration in every element, or in the named ones.

use super::elements;
use crate::model::decode::builder::Builder;
use crate::model::decode::reader::Cursor;
use crate::model::structure::{ElementLoad, Load};

pub fn read<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let fields = cursor.fields(&["acceleration", "on"])?;
    if builder.has_no_elements() {
        let (what, help) = if builder.structure.superelement.is_some() {
            ("a superelement has none", "put the weights into its loads")
        } else {
            ("there are none", "give the weights as `point` loads")
        };
        cursor.problem(format!("gravity needs elements with a density; {what}"), help);
        return None;
    }
    let acceleration = fields.required("acceleration").and_then(Cursor::vector);
    let elements = elements(builder, fields.optional("on"));
    let (acceleration, elements) = (acceleration?, elements?);
    let structure = &builder.structure;
    let weights = elements.into_iter().filter_map(|element| {
        let density = structure.materials[structure.elements[element].material].density;
        (density != 0.0).then(|| Load::Element { element, load: ElementLoad::Body(acceleration.map(|a| density * a)) })
    });
    Some(weights.collect())
}
