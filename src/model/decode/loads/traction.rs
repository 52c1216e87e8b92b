//! `traction`: force per length of an edge, thickness already in it, constant or linear along it;
//! in space force per area of a face.

use super::{between, edge, nodal, one_or_two_vectors};
use crate::model::decode::builder::Builder;
use crate::model::decode::reader::Cursor;
use crate::model::structure::{Dimension, Load};

pub fn read<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    if builder.structure.dimension == Dimension::Space {
        return on_face(builder, cursor);
    }
    let fields = cursor.fields(&["edge", "value"])?;
    let edge = fields.required("edge").and_then(|at| edge(builder, at, "a traction"));
    let value = fields.required("value").and_then(one_or_two_vectors);
    let (edge, value) = (edge?, value?);
    Some(nodal(edge.consistent_forces(&builder.structure.nodes, None, &|spot| between(value, spot.along))))
}

fn on_face<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let fields = cursor.fields(&["face", "value"])?;
    let face = fields.required("face").and_then(|at| builder.face(at));
    let value = fields.required("value").and_then(Cursor::vector);
    let (face, value) = (face?, value?);
    Some(nodal(face.consistent_forces(&builder.structure.nodes, None, &|_| value)))
}
