//! Elastic foundations along bars and edges: springs at the nodes, or, where they take no tension, contact pairs whose
//! ground is a spring.

use super::builder::{Builder, entries, id_of};
use super::face_sides;
use super::reader::{Cursor, Fields};
use super::spot::Spot;
use crate::model::face::Face;
use crate::model::pair::{Law, Pair};
use crate::model::parameter::Number;
use crate::model::structure::{Dimension, Spring};
use crate::model::uses::Region;
use crate::model::vector::{distance, length};

/// What a foundation has in common along its line.
struct Foundation<'d> {
    id: &'d str,
    /// Force per length of line (of a face per area) and displacement, along the normal.
    stiffness: f64,
    /// The same along the line.
    tangential: Option<f64>,
    tensionless: bool,
    friction: Option<Number>,
}

/// A node of the line or face: its normal (from the ground to the body) and the length or area that belongs to it.
struct Place {
    node: usize,
    normal: [f64; 3],
    length: f64,
}

/// Reads `foundations`.
pub fn read<'d>(builder: &mut Builder<'d>, fields: &Fields<'d>) {
    for (index, cursor) in entries(fields, "foundations").into_iter().enumerate() {
        if let Some((foundation, places)) = foundation(builder, cursor) {
            let place = format!("foundations[{index}]");
            for (pair, at) in places.iter().enumerate() {
                if foundation.tensionless {
                    tensionless(builder, &foundation, pair, at, &place);
                } else {
                    bonded(builder, &foundation, at);
                }
            }
        }
    }
}

fn foundation<'d>(builder: &mut Builder<'d>, cursor: Cursor<'d>) -> Option<(Foundation<'d>, Vec<Place>)> {
    let fields = cursor.fields(&["id", "on", "stiffness", "direction", "tangential", "tensionless", "friction"])?;
    let id = id_of(builder, &fields, "foundation");
    let stiffness = fields.required("stiffness").and_then(|at| at.positive("stiffness"));
    let tangential = match fields.optional("tangential") {
        Some(at) => Some(Some(at.number_that("tangential", "0 or more", |value| value >= 0.0)?)),
        None => Some(None),
    };
    let tensionless = match fields.optional("tensionless") {
        Some(at) => at.boolean(),
        None => Some(false),
    };
    let friction = match fields.optional("friction") {
        Some(at) => Some(Some(at.of(Region::Law).non_negative("friction")?)),
        None => Some(None),
    };
    let direction = match fields.optional("direction") {
        Some(at) => Some(Some(at.direction("direction")?)),
        None => Some(None),
    };
    let places = fields.required("on").and_then(|on| places(builder, on));
    let foundation = Foundation {
        id: id?,
        stiffness: stiffness?,
        tangential: tangential?,
        tensionless: tensionless?,
        friction: friction?,
    };
    if foundation.friction.is_some() && !foundation.tensionless {
        fields.refuse(
            &["friction"],
            |_| "a bonded foundation has no `friction`".into(),
            "add \"tensionless\": true, or give its `tangential` stiffness instead",
        );
        return None;
    }
    if foundation.tangential.is_some() && foundation.tensionless && foundation.friction.is_none() {
        fields.refuse(
            &["tangential"],
            |_| "`tangential` of a tensionless foundation acts through friction, and there is no `friction`".into(),
            "add `friction`, or remove `tangential`",
        );
        return None;
    }
    let mut places = places?;
    if let Some(direction) = direction? {
        places.iter_mut().for_each(|place| place.normal = direction);
    }
    Some((foundation, places))
}

/// The nodes of a bar or of an edge with their normals and lengths.
fn places<'d>(builder: &Builder<'d>, on: Cursor<'d>) -> Option<Vec<Place>> {
    if let Some(&bar) = builder.bars.get(on.string()?) {
        return Some(along_bar(builder, bar));
    }
    let edge = match builder.spot(on)? {
        Spot::Edge(edge) => edge,
        Spot::Face(face) => return over_face(builder, on, &face),
        other => {
            let (border, lies) = match builder.structure.dimension {
                Dimension::Plane => ("an edge", "along a line"),
                Dimension::Space => ("a face", "along a bar or under a face"),
            };
            on.problem(
                format!("expected a bar or {border}, found the {} {}", other.word(), on.quoted()),
                format!("a foundation lies {lies}; at one node use `springs`"),
            );
            return None;
        }
    };
    let nodes = &builder.structure.nodes;
    let place = |node: usize| nodes[node].position;
    let outward = edge.outward_normals(nodes);
    let mut places: Vec<Place> = edge
        .nodes
        .iter()
        .zip(outward)
        // Subtracting from 0 turns −0 into 0.
        .map(|(&node, outward)| Place { node, normal: outward.map(|n| 0.0 - n), length: 0.0 })
        .collect();
    for k in 1..places.len() {
        let (a, b) = (place(places[k - 1].node), place(places[k].node));
        let half = 0.5 * distance(a, b);
        places[k - 1].length += half;
        places[k].length += half;
    }
    if edge.distinct_nodes().len() < places.len()
        && let Some(last) = places.pop()
    {
        // A closed edge: half of its last side belongs to the first node.
        places[0].length += last.length;
    }
    Some(places)
}

/// The nodes of a face with their inward normals and areas.
fn over_face<'d>(builder: &Builder<'d>, on: Cursor<'d>, face: &Face) -> Option<Vec<Place>> {
    face_sides::refuse_quadratic(on, face, "springs or pairs at nodes")?;
    let nodes = &builder.structure.nodes;
    let outward: Option<Vec<[f64; 3]>> = face.outward_normals(nodes).into_iter().collect();
    if outward.is_none() {
        on.problem("the face has no normal where its sides cancel", "name one side of the body");
    }
    let places = face.nodes.iter().zip(outward?).zip(face.nodal_areas(nodes));
    Some(places.map(|((&node, n), length)| Place { node, normal: n.map(|n| 0.0 - n), length }).collect())
}

/// The ground lies on the −y side of a bar: the normal is its local y, at a corner the mean of both sides.
fn along_bar(builder: &Builder<'_>, bar: usize) -> Vec<Place> {
    let structure = &builder.structure;
    let mut places: Vec<Place> = Vec::new();
    for stretch in builder.stretches(bar) {
        let Some(axes) = builder.bar_axes(&stretch) else { continue };
        let normal = axes.y.map(|y| 0.0 + y);
        let half = 0.5 * stretch.length;
        let nodes = &structure.elements[stretch.element].nodes;
        if places.is_empty() {
            places.push(Place { node: nodes[0], normal: [0.0; 3], length: 0.0 });
        }
        let last = places.len() - 1;
        let before = &mut places[last];
        before.normal = std::array::from_fn(|c| before.normal[c] + normal[c]);
        before.length += half;
        places.push(Place { node: nodes[1], normal, length: half });
    }
    for place in &mut places {
        let length = length(place.normal);
        place.normal = place.normal.map(|n| n / length);
    }
    places
}

/// The directions in which it resists besides its normal; no zero has a sign.
fn tangents(builder: &Builder<'_>, at: &Place) -> Vec<[f64; 3]> {
    let tangents = builder.structure.dimension.tangents(at.normal);
    tangents.into_iter().map(|tangent| tangent.map(|t| 0.0 + t)).collect()
}

fn bonded(builder: &mut Builder<'_>, foundation: &Foundation<'_>, at: &Place) {
    let tangents = tangents(builder, at);
    let springs = &mut builder.structure.springs;
    springs.push(Spring::along(at.node, None, at.normal, foundation.stiffness * at.length));
    if let Some(tangential) = foundation.tangential.filter(|stiffness| *stiffness > 0.0) {
        let along = |tangent| Spring::along(at.node, None, tangent, tangential * at.length);
        springs.extend(tangents.into_iter().map(along));
    }
}

/// A pair against a node of its own on springs: along the normal, and along the line, where a spring that nothing
/// loads holds the node of a pair whose friction acts against the firm ground.
fn tensionless(builder: &mut Builder<'_>, foundation: &Foundation<'_>, index: usize, at: &Place, place: &str) {
    let id = format!("{}[{index}]", foundation.id);
    let position = builder.structure.nodes[at.node].position;
    let ground = builder.add_node(format!("{}/{index}", foundation.id), position);
    builder.place_nodes(place, false);
    builder.has_rotation.push(false);
    builder.structure.yielding_ground.push(ground);
    let tangents = tangents(builder, at);
    let along = foundation.tangential.filter(|stiffness| *stiffness > 0.0);
    let across = along.unwrap_or(foundation.stiffness);
    let springs = [(at.normal, foundation.stiffness)].into_iter().chain(tangents.into_iter().map(|t| (t, across)));
    for (direction, stiffness) in springs {
        builder.structure.springs.push(Spring::along(ground, None, direction, stiffness * at.length));
    }
    let law = match &foundation.friction {
        Some(friction) => {
            Law::Coulomb { friction: friction.clone(), cohesion: Number::Value(0.0), gap: Number::Value(0.0) }
        }
        None => Law::Frictionless { gap: Number::Value(0.0) },
    };
    let pair = Pair::at_node(id, at.node, Some(ground), at.normal, builder.structure.dimension, law);
    builder.structure.pairs.push(Pair { slides_on_ground: along.is_none(), ..pair });
    builder.places.pairs.push(place.into());
}
