//! The two sides of a contact of faces: which nodes meet which, along which normals.

use std::collections::HashSet;

use super::builder::Builder;
use super::reader::{Cursor, Fields};
use super::sides::{GROUND, Gap, NEAR, Sides, gap_of, given_normal, is_misspelt_ground, matched, no_partner, turned};
use crate::model::face::Face;
use crate::model::pair::Pair;
use crate::model::vector::{dot, length, way};

/// The sides of a face against another one or the ground; nodes at the positions in `skipped` need no partner.
pub fn of_face<'d>(
    builder: &Builder<'d>,
    fields: &Fields<'d>,
    at: Cursor<'d>,
    skipped: &HashSet<usize>,
) -> Option<Sides> {
    let face = builder.face(at);
    let normal = given_normal(fields)?;
    let against = fields.required("against")?;
    let face = face?;
    refuse_quadratic(at, &face, "pairs of nodes")?;
    let shares = face.nodal_areas(&builder.structure.nodes);
    if against.string()? == GROUND {
        let nodes = face.nodes.clone();
        let own = face.outward_normals(&builder.structure.nodes).into_iter().map(|normal| normal.map(turned)).collect();
        let wanted = (0..nodes.len()).map(|k| (!skipped.contains(&k)).then_some(k)).collect::<Vec<_>>();
        let normals = normals(builder, at, &face, (own, normal), &wanted)?;
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
    let own = other.outward_normals(&builder.structure.nodes);
    let apart = gap_of(fields) == Gap::Geometry;
    let partners = Faces { builder, at, against, face: &face, other: &other, apart, skipped }.partners(&own)?;
    let normals = normals(builder, against, &other, (own, normal), &partners)?;
    let pairs =
        face.nodes.iter().zip(&partners).map(|(&node, at)| Some(Pair::of_nodes(node, Some(other.nodes[(*at)?]))));
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

/// The normal given, or those of a face at these of its nodes (0 where none is wanted).
fn normals<'d>(
    builder: &Builder<'d>,
    at: Cursor<'d>,
    face: &Face,
    (own, given): (Vec<Option<[f64; 3]>>, Option<[f64; 3]>),
    wanted: &[Option<usize>],
) -> Option<Vec<[f64; 3]>> {
    let of = |node: &Option<usize>| given.or_else(|| node.map_or(Some([0.0; 3]), |node| own[node]));
    let normals: Option<Vec<_>> = wanted.iter().map(of).collect();
    if normals.is_none()
        && let Some(node) = wanted.iter().flatten().find(|node| own[**node].is_none())
    {
        at.problem(
            format!(
                "the face {} has no normal at \"{}\": those of its sides cancel there",
                at.quoted(),
                builder.node_id(face.nodes[*node])
            ),
            "name one side of the body, or give `normal`",
        );
    }
    normals
}

struct Faces<'a, 'd> {
    builder: &'a Builder<'d>,
    at: Cursor<'d>,
    against: Cursor<'d>,
    face: &'a Face,
    other: &'a Face,
    /// Whether partners may be apart along the normal.
    apart: bool,
    /// Positions of the nodes that need no partner.
    skipped: &'a HashSet<usize>,
}

impl Faces<'_, '_> {
    /// For each node of the face the position of its partner on the other one: at its place, or `apart` along the normal
    /// there.
    fn partners(&self, normals: &[Option<[f64; 3]>]) -> Option<Vec<Option<usize>>> {
        let (nodes, others) = (&self.face.nodes, &self.other.nodes);
        // Where nothing is skipped either side hanging over is found by the count before any place.
        if self.skipped.is_empty() && nodes.len() != others.len() {
            let (at, against) = (self.at.quoted(), self.against.quoted());
            return self.refuse(&format!("{at} has {} nodes, {against} has {}", nodes.len(), others.len()));
        }
        let place = |node: usize| self.builder.structure.nodes[node].position;
        let extent = nodes.iter().map(|&node| length(way(place(nodes[0]), place(node)))).fold(0.0, f64::max);
        let distance = |k: usize, at: usize| {
            let way = way(place(others[at]), place(nodes[k]));
            let n = normals[at].filter(|_| self.apart).unwrap_or([0.0; 3]);
            let along = dot(way, n);
            let off = length([0, 1, 2].map(|c| way[c] - along * n[c]));
            (off <= NEAR * extent).then(|| length(way))
        };
        let partners = matched([nodes, others], self.skipped, distance);
        match partners {
            Ok(partners) => Some(partners),
            Err(k) => self.refuse(&no_partner(self.builder, nodes, k, [self.at, self.against])),
        }
    }

    fn refuse<T>(&self, message: &str) -> Option<T> {
        let help = if self.skipped.is_empty() {
            "give both faces the same nodes; \"gap\": \"geometry\" lets partners be apart along the normal; where one face \
             hangs over, make it `face` and name its nodes without a partner by number in `skip`, or write contacts of \
             single nodes"
        } else {
            "name all nodes of `face` without a partner in `skip` (they count from 0), or write contacts of single nodes; \
             \"gap\": \"geometry\" lets partners be apart along the normal"
        };
        self.against.problem(format!("the faces do not match: {message}"), help);
        None
    }
}
