//! `fluid`: the pressure γ·max(level − y, 0) of a fluid at rest into the body, in space γ·max(level − z, 0).

use super::{edge, nodal};
use crate::model::decode::builder::Builder;
use crate::model::decode::reader::Cursor;
use crate::model::face::FaceSpot;
use crate::model::structure::{Dimension, Load};
use crate::model::uses::Region;

pub fn read<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let in_space = builder.structure.dimension == Dimension::Space;
    let fields = cursor.fields(&[if in_space { "face" } else { "edge" }, "level", "weight"])?;
    let (edge, face) = match in_space {
        true => (None, fields.required("face").and_then(|at| builder.face(at))),
        false => (fields.required("edge").and_then(|at| edge(builder, at, "a fluid")), None),
    };
    let level = fields.required("level").and_then(|at| at.of(Region::Load).number());
    let weight = fields
        .required("weight")
        .and_then(|at| at.number_that("the weight of a fluid per volume", "0 or more", |weight| weight >= 0.0));
    let (level, weight) = (level?, weight?);
    let structure = &builder.structure;
    if let Some(face) = face {
        let pushes = |spot: &FaceSpot| {
            let pressure = weight * spot.depth.max(0.0);
            spot.outward.map(|n| -pressure * n)
        };
        return Some(nodal(face.consistent_forces(&structure.nodes, Some(level), &pushes)));
    }
    let edge = edge?;
    let forces = edge.consistent_forces(&structure.nodes, Some(level), &|spot| {
        let pressure = weight * (level - spot.position[1]).max(0.0);
        let thickness = structure.elements[spot.element].area();
        spot.outward.map(|n| -pressure * thickness * n)
    });
    Some(nodal(forces))
}
