//! `fluid`: the pressure γ·max(level − y, 0) of a fluid at rest into the body.

use super::{edge, nodal};
use crate::model::decode::builder::Builder;
use crate::model::decode::reader::Cursor;
use crate::model::structure::Load;
use crate::model::uses::Region;

pub fn read<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let fields = cursor.fields(&["edge", "level", "weight"])?;
    let edge = fields.required("edge").and_then(|at| edge(builder, at, "a fluid"));
    let level = fields.required("level").and_then(|at| at.of(Region::Load).number());
    let weight = fields
        .required("weight")
        .and_then(|at| at.number_that("the weight of a fluid per volume", "0 or more", |weight| weight >= 0.0));
    let (edge, level, weight) = (edge?, level?, weight?);
    let structure = &builder.structure;
    let forces = edge.consistent_forces(&structure.nodes, Some(level), &|spot| {
        let pressure = weight * (level - spot.position[1]).max(0.0);
        let thickness = structure.elements[spot.element].area();
        spot.outward.map(|n| -pressure * thickness * n)
    });
    Some(nodal(forces))
}
