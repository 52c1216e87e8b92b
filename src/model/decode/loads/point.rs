//! `point`: a force and a moment at a node, on an edge or a face (the total), or at a place of a bar.

use super::{bar, nodal};
use crate::model::decode::builder::Builder;
use crate::model::decode::reader::{Cursor, Fields};
use crate::model::decode::spot::Spot;
use crate::model::space_section::EndJoint;
use crate::model::structure::{ElementKind, ElementLoad, Load};
use crate::model::uses::Region;
use crate::model::vector::{dot, length, way};

pub fn read<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let fields = cursor.fields(&["at", "bar", "distance", "force", "moment"])?;
    if fields.entry("bar").is_some() || fields.entry("distance").is_some() {
        return on_bar(builder, &fields);
    }
    let spot = fields.required("at").and_then(|at| builder.spot(at));
    let acting = acting(&fields);
    let spot = spot?;
    let (force, moment) = acting?;
    match spot {
        Spot::Node(node) => {
            let moment = match moment {
                Some((cursor, moment)) => {
                    builder.demand_rotation(cursor, node, "no `moment` can act there").then_some(moment)?
                }
                None => [0.0; 3],
            };
            builder.demand_displacement(cursor, node, force, "no force can act there").then_some(())?;
            Some(vec![Load::Nodal { node, force, moment }])
        }
        Spot::Edge(edge) => {
            refuse_moment(moment, "an edge")?;
            let nodes = &builder.structure.nodes;
            let total = edge.length(nodes);
            let per_length = force.map(|force| force / total);
            Some(nodal(edge.consistent_forces(nodes, None, &|_| per_length)))
        }
        Spot::Face(face) => {
            refuse_moment(moment, "a face")?;
            let nodes = &builder.structure.nodes;
            let area = face.area(nodes);
            let per_area = force.map(|force| force / area);
            Some(nodal(face.consistent_forces(nodes, None, &|_| per_area)))
        }
    }
}

/// A moment and where it is written.
type Moment<'d> = (Cursor<'d>, [f64; 3]);

/// What acts: a force, a moment or both.
fn acting<'d>(fields: &Fields<'d>) -> Option<([f64; 3], Option<Moment<'d>>)> {
    let force = match (fields.optional("force"), fields.entry("moment")) {
        (Some(cursor), _) => cursor.vector(),
        (None, Some(_)) => Some([0.0; 3]),
        (None, None) => fields.required("force").and_then(Cursor::vector),
    };
    let moment = match fields.optional("moment") {
        Some(cursor) => Some((cursor, cursor.moment()?)),
        None => None,
    };
    Some((force?, moment))
}

fn refuse_moment(moment: Option<Moment<'_>>, what: &str) -> Option<()> {
    let Some((cursor, _)) = moment else { return Some(()) };
    cursor.problem(
        format!("a `moment` cannot act on {what}: its nodes have no rotation"),
        "remove it, or give a couple of forces",
    );
    None
}

fn on_bar<'d>(builder: &Builder<'d>, fields: &Fields<'d>) -> Option<Vec<Load>> {
    fields.refuse(
        &["at"],
        |_| "`at` cannot stand beside `bar` and `distance`".into(),
        "give the node, or the bar and the distance from its start",
    );
    let bar = fields.required("bar").and_then(|at| bar(builder, at));
    let distance = fields.required("distance").and_then(|at| Some((at, at.of(Region::Load).number()?)));
    let (force, moment) = acting(fields)?;
    let (at, distance) = distance?;
    let (element, distance) = builder.place_on_bar(at, bar?, distance)?;
    if let Some((cursor, _)) = moment
        && !builder.structure.elements[element].bends()
    {
        cursor.problem("a truss bar carries no `moment`", "remove it, or make the bar a frame");
        return None;
    }
    if let Some((cursor, moment)) = moment
        && !takes_torque(builder, element, moment)
    {
        cursor.problem(
            "nothing takes the torque of this `moment`: the bar is hinged at both ends, to nodes without rotations",
            "give a moment across the bar, or remove a hinge",
        );
        return None;
    }
    let moment = moment.map_or([0.0; 3], |(_, moment)| moment);
    Some(vec![Load::Element { element, load: ElementLoad::Point { distance, force, moment } }])
}

/// Whether an element of a bar passes the torque of a moment on to one of its nodes.
fn takes_torque(builder: &Builder<'_>, element: usize, moment: [f64; 3]) -> bool {
    let element = &builder.structure.elements[element];
    let ElementKind::SpaceFrame { joints: [EndJoint::Ball, EndJoint::Ball], .. } = element.kind else { return true };
    let [a, b] = [0, 1].map(|end| builder.structure.nodes[element.nodes[end]].position);
    let along = way(a, b);
    // The direction of the bar, the moment and their product are rounded.
    dot(along, moment).abs() <= 8.0 * f64::EPSILON * length(along) * length(moment)
}
