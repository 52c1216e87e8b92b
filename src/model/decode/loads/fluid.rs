//! `fluid`: the pressure γ·max(level − y, 0) of a fluid at rest into the body, in space γ·max(level − z, 0).

use super::{edge, nodal};
use crate::model::decode::builder::Builder;
use crate::model::decode::reader::{Cursor, Fields};
use crate::model::face::FaceSpot;
use crate::model::structure::{Dimension, Load};
use crate::model::uses::Region;

pub fn read<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    if builder.structure.dimension == Dimension::Space {
        return on_face(builder, cursor);
    }
    let fields = cursor.fields(&["edge", "level", "weight"])?;
    let edge = fields.required("edge").and_then(|at| edge(builder, at, "a fluid"));
    let (level, weight) = (level(&fields), weight(&fields));
    let (edge, level, weight) = (edge?, level?, weight?);
    let structure = &builder.structure;
    let forces = edge.consistent_forces(&structure.nodes, Some(level), &|spot| {
        let pressure = weight * (level - spot.position[1]).max(0.0);
        let thickness = structure.elements[spot.element].area();
        spot.outward.map(|n| -pressure * thickness * n)
    });
    Some(nodal(forces))
}

fn on_face<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let fields = cursor.fields(&["face", "level", "weight"])?;
    let face = fields.required("face").and_then(|at| builder.face(at));
    let (level, weight) = (level(&fields), weight(&fields));
    let (face, level, weight) = (face?, level?, weight?);
    let pushes = |spot: &FaceSpot| {
        let pressure = weight * spot.depth.max(0.0);
        spot.outward.map(|n| -pressure * n)
    };
    Some(nodal(face.consistent_forces(&builder.structure.nodes, Some(level), &pushes)))
}

fn level(fields: &Fields<'_>) -> Option<f64> {
    fields.required("level")?.of(Region::Load).number()
}

fn weight(fields: &Fields<'_>) -> Option<f64> {
    let at = fields.required("weight")?;
    at.number_that("the weight of a fluid per volume", "0 or more", |weight| weight >= 0.0)
}
