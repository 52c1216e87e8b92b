//! `traction`: force per length of an edge, thickness already in it, constant or linear along it.

use super::{between, edge, nodal, one_or_two_vectors};
use crate::model::decode::builder::Builder;
use crate::model::decode::reader::Cursor;
use crate::model::structure::Load;

pub fn read<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let fields = cursor.fields(&["edge", "value"])?;
    let edge = fields.required("edge").and_then(|at| edge(builder, at, "a traction"));
    let value = fields.required("value").and_then(one_or_two_vectors);
    let (edge, value) = (edge?, value?);
    Some(nodal(edge.consistent_forces(&builder.structure.nodes, None, &|spot| between(value, spot.along))))
}
