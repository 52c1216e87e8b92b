//! `pressure`: force per area into the body, constant or linear along an edge, constant on a face.

use super::{between, edge, nodal, one_or_two};
use crate::model::decode::builder::Builder;
use crate::model::decode::reader::Cursor;
use crate::model::face::FaceSpot;
use crate::model::structure::{Dimension, Load};

pub fn read<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    if builder.structure.dimension == Dimension::Space {
        return on_face(builder, cursor);
    }
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

fn on_face<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let fields = cursor.fields(&["face", "value"])?;
    let face = fields.required("face").and_then(|at| builder.face(at));
    let value = fields.required("value").and_then(Cursor::number);
    let (face, pressure) = (face?, value?);
    let pushes = |spot: &FaceSpot| spot.outward.map(|n| -pressure * n);
    Some(nodal(face.consistent_forces(&builder.structure.nodes, None, &pushes)))
}
