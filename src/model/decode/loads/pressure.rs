//! `pressure`: force per area into the body, constant or linear along an edge.

use super::{between, edge, nodal, one_or_two};
use crate::model::decode::builder::Builder;
use crate::model::decode::reader::Cursor;
use crate::model::structure::Load;

pub fn read<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let fields = cursor.fields(&["edge", "value"])?;
    let edge = fields.required("edge").and_then(|at| edge(builder, at, "a pressure"));
    let value = fields.required("value").and_then(one_or_two);
    let (edge, value) = (edge?, value?.map(|value| [value]));
    let structure = &builder.structure;
    let forces = edge.consistent_forces(&structure.nodes, None, &|spot| {
        let [pressure] = between(value, spot.along);
        let thickness = structure.elements[spot.element].area();
        spot.outward.map(|n| -pressure * thickness * n)
    });
    Some(nodal(forces))
}
