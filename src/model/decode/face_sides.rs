//! The two sides of a contact of faces: which nodes meet which, along which normals.

use super::builder::Builder;
use super::reader::{Cursor, Fields};
use super::sides::{GROUND, Gap, NEAR, Sides, gap_of, is_misspelt_ground, turned};
use crate::model::face::Face;
use crate::model::pair::Pair;
use crate::model::vector::{dot, length, way};

/// The sides of a face against another one or the ground.
pub fn of_face<'d>(builder: &Builder<'d>, fields: &Fields<'d>, at: Cursor<'d>) -> Option<Sides> {
    let face = builder.face(at);
    let normal = match fields.optional("normal") {
        Some(cursor) => Some(cursor.direction("normal")?),
        None => None,
    };
    let against = fields.required("against")?;
    let face = face?;
    refuse_quadratic(at, &face, "pairs of nodes")?;
    let shares = face.nodal_areas(&builder.structure.nodes);
    if against.string()? == GROUND {
        let nodes = face.nodes.clone();
        let normals = match normal {
            Some(normal) => vec![normal; nodes.len()],
            None => outward(builder, at, &face)?.into_iter().map(turned).collect(),
        };
        return Some(Sides { shares, ..Sides::on_ground(nodes, normals) });
    }
    if is_misspelt_ground(builder, against.string()?) {
        against.unknown("face", against.string()?, &[GROUND]);
        return None;
    }
    let other = builder.face(against)?;
    refuse_quadratic(against, &other, "pairs of nodes")?;
    if other.sides == face.sides {
        against.problem(
            format!("the face {} is in contact with itself", against.quoted()),
            "name two different faces, or \"ground\"",
        );
        return None;
    }
    let own = outward(builder, against, &other)?;
    let partners = partners(builder, [at, against], [&face, &other], &own, gap_of(fields) == Gap::Geometry)?;
    let normals = partners.iter().map(|&partner| normal.unwrap_or(own[partner])).collect();
    let pairs = face.nodes.iter().zip(&partners).map(|(&node, &at)| Some(Pair::of_nodes(node, Some(other.nodes[at]))));
    Some(Sides { shares, ..Sides::new(builder, face.nodes.clone(), pairs.collect(), normals) })
}

/// Pairs and springs at nodes carry the nodal forces of what acts around them, and those of a pressure on quadratic
/// sides are zero at the corners of triangles and pull at those of quadrilaterals.
pub fn refuse_quadratic(at: Cursor<'_>, face: &Face, what: &str) -> Option<()> {
    let Some(side) = face.sides.iter().find(|side| side.nodes.len() > 4) else { return Some(()) };
    let (count, corners) = match side.nodes.len() {
        6 => (6, "nothing at all"),
        count => (count, "tension"),
    };
    at.problem(
        format!(
            "the face {} has sides of {count} nodes: a uniform pressure on such a side is {corners} at its corners, so \
             {what} cannot stand for it",
            at.quoted()
        ),
        "mesh the body there with linear elements (hexahedra of 8 nodes, tetrahedra of 4)",
    );
    None
}

/// Normals out of the body at the nodes.
fn outward<'d>(builder: &Builder<'d>, at: Cursor<'d>, face: &Face) -> Option<Vec<[f64; 3]>> {
    let normals = face.outward_normals(&builder.structure.nodes);
    if let Some(node) = normals.iter().position(Option::is_none) {
        at.problem(
            format!(
                "the face {} has no normal at \"{}\": those of its sides cancel there",
                at.quoted(),
                builder.node_id(face.nodes[node])
            ),
            "name one side of the body, or give `normal`",
        );
    }
    normals.into_iter().collect()
}

/// For each node of a face the position of its partner on the other one: at its place, or `apart` along the normal
/// there.
fn partners<'d>(
    builder: &Builder<'d>,
    [at, against]: [Cursor<'d>; 2],
    [face, other]: [&Face; 2],
    normals: &[[f64; 3]],
    apart: bool,
) -> Option<Vec<usize>> {
    let place = |node: usize| builder.structure.nodes[node].position;
    let refuse = |message: String| {
        against.problem(
            format!("the faces do not match: {message}"),
            "give both faces the same nodes; \"gap\": \"geometry\" lets partners be apart along the normal",
        );
        None
    };
    if face.nodes.len() != other.nodes.len() {
        let (count, others) = (face.nodes.len(), other.nodes.len());
        return refuse(format!("{} has {count} nodes, {} has {others}", at.quoted(), against.quoted()));
    }
    let first = place(face.nodes[0]);
    let extent = face.nodes.iter().map(|&node| length(way(first, place(node)))).fold(0.0, f64::max);
    let mut taken = vec![false; other.nodes.len()];
    let mut partners = Vec::with_capacity(face.nodes.len());
    for &node in &face.nodes {
        // How far a node is from being a partner.
        let off = |at: usize| {
            let way = way(place(other.nodes[at]), place(node));
            let along = if apart { dot(way, normals[at]) } else { 0.0 };
            length([0, 1, 2].map(|c| way[c] - along * normals[at][c]))
        };
        let free = (0..taken.len()).filter(|&at| !taken[at] && other.nodes[at] != node);
        let nearest = free.map(|at| (off(at), at)).min_by(|a, b| a.0.total_cmp(&b.0));
        match nearest {
            Some((off, at)) if off <= NEAR * extent => {
                taken[at] = true;
                partners.push(at);
            }
            _ => {
                let [x, y, z] = place(node);
                return refuse(format!(
                    "\"{}\" is at ({x}, {y}, {z}), and no node of {} is there",
                    builder.node_id(node),
                    against.quoted()
                ));
            }
        }
    }
    Some(partners)
}
