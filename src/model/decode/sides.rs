//! The two sides of a contact: which nodes meet which, along which normals, how far apart.

use std::collections::{BTreeMap, HashSet};

use super::builder::Builder;
use super::reader::{Cursor, Fields};
use super::spot::Spot;
use super::words::near;
use crate::model::edge::Edge;
use crate::model::mortar::{self, MortarError, MortarPair};
use crate::model::pair::{Pair, Weights};
use crate::model::structure::Dimension;
use crate::model::vector::{dot, flat, way};

/// The word for the ground in `against`.
pub const GROUND: &str = "ground";

/// Two edges or faces lie on each other if every node is this near its partner, relative to the length of the edge, or
/// the extent of the face.
pub const NEAR: f64 = 1e-6;

/// The nodes of a contact in their order, those without a pair included.
pub struct Sides {
    pub nodes: Vec<usize>,
    /// Which nodes move against each other at each of them, see [`Pair::weights`]; `None` where nothing is opposite.
    pub weights: Vec<Option<Weights>>,
    /// Places of the pairs that are not at their node, see [`Pair::place`].
    pub places: BTreeMap<usize, Weights>,
    pub normals: Vec<[f64; 3]>,
    /// Distances of the two sides along the normals as they are drawn; `None` against the ground.
    pub gaps: Option<Vec<f64>>,
    /// The part of the area of a face, or of the common length of edges, that stands for each node; empty otherwise.
    pub shares: Vec<f64>,
}

/// How the pairs of two edges are made.
#[derive(Clone, Copy, PartialEq)]
enum Method {
    /// From nodes at the same place.
    Nodes,
    /// From a node and what lies opposite.
    Mortar,
}

impl Method {
    const WORDS: [(&'static str, Method); 2] = [("nodes", Method::Nodes), ("mortar", Method::Mortar)];
}

impl Sides {
    pub fn new<'d>(
        builder: &Builder<'d>,
        nodes: Vec<usize>,
        weights: Vec<Option<Weights>>,
        normals: Vec<[f64; 3]>,
    ) -> Sides {
        let place = |node: usize| builder.structure.nodes[node].position;
        let distance = |(weights, n): (&Option<Weights>, &[f64; 3])| {
            let weights = weights.iter().flatten();
            // Differences from the own node: coordinates may be large beside a gap.
            let own = weights.clone().next().map_or([0.0; 3], |&(node, _)| place(node));
            let terms = weights.map(|&(node, weight)| weight * dot(*n, way(own, place(node))));
            terms.sum::<f64>()
        };
        let gaps = weights.iter().zip(&normals).map(distance).collect();
        Sides { nodes, weights, places: BTreeMap::new(), normals, gaps: Some(gaps), shares: Vec::new() }
    }

    pub fn on_ground(nodes: Vec<usize>, normals: Vec<[f64; 3]>) -> Sides {
        let weights = nodes.iter().map(|&node| Some(Pair::of_nodes(node, None))).collect();
        Sides { nodes, weights, places: BTreeMap::new(), normals, gaps: None, shares: Vec::new() }
    }

    /// The same without the pairs at these positions: nothing is asked of the nodes there, and the others keep theirs.
    pub fn without(mut self, skipped: &HashSet<usize>) -> Sides {
        let of_skipped = self.weights.iter_mut().enumerate().filter(|(index, _)| skipped.contains(index));
        of_skipped.for_each(|(_, weights)| *weights = None);
        self
    }
}

/// Whether a `gap` is to be read from the geometry.
pub fn is_geometry(cursor: Cursor<'_>) -> bool {
    cursor.is_string() && cursor.string() == Some("geometry")
}

pub fn is_misspelt_ground(builder: &Builder<'_>, word: &str) -> bool {
    builder.node_named(word).is_none() && !near(word, [GROUND]).is_empty()
}

/// The sides of one node against another one or the ground.
pub fn of_node<'d>(builder: &Builder<'d>, fields: &Fields<'d>, at: Cursor<'d>) -> Option<Sides> {
    let node = builder.node(at);
    let normal = fields.required("normal").and_then(|cursor| cursor.direction("normal"));
    let against = fields.required("against").and_then(|cursor| match cursor.string()? {
        GROUND => Some(None),
        word if is_misspelt_ground(builder, word) => {
            cursor.unknown("node", word, &[GROUND]);
            None
        }
        _ => Some(Some((cursor, builder.node(cursor)?))),
    })?;
    let node = node?;
    if let Some((cursor, other)) = against
        && other == node
    {
        cursor.problem(
            format!("the node \"{}\" is in contact with itself", builder.node_id(node)),
            "name two different nodes, or \"ground\"",
        );
        return None;
    }
    let normals = vec![normal?];
    Some(match against {
        None => Sides::on_ground(vec![node], normals),
        Some((_, other)) => Sides::new(builder, vec![node], vec![Some(Pair::of_nodes(node, Some(other)))], normals),
    })
}

/// For each node the position of its partner: the nearest of those that are free, none for a node at a position in
/// `skipped`. `distance(k, at)` is that of the node at k from the partner at `at`, `None` where they cannot be partners.
/// Fails with the position of the first node without one.
pub fn matched(
    [nodes, others]: [&[usize]; 2],
    skipped: &HashSet<usize>,
    distance: impl Fn(usize, usize) -> Option<f64>,
) -> Result<Vec<Option<usize>>, usize> {
    let mut taken = vec![false; others.len()];
    let mut partner = |(k, &node): (usize, &usize)| {
        if skipped.contains(&k) {
            return Ok(None);
        }
        let free = (0..others.len()).filter(|&at| !taken[at] && others[at] != node);
        let possible = free.filter_map(|at| Some((distance(k, at)?, at)));
        let (_, at) = possible.min_by(|a, b| a.0.total_cmp(&b.0)).ok_or(k)?;
        taken[at] = true;
        Ok(Some(at))
    };
    nodes.iter().enumerate().map(&mut partner).collect()
}

/// The sides of an edge against another one or the ground; nodes at the positions in `skipped` need no partner.
pub fn of_edge<'d>(
    builder: &Builder<'d>,
    fields: &Fields<'d>,
    at: Cursor<'d>,
    skipped: &HashSet<usize>,
) -> Option<Sides> {
    let edge = builder.edge(at);
    let normal = given_normal(fields)?;
    let method = match fields.optional("method") {
        Some(cursor) => Some(cursor.choice(&Method::WORDS)?),
        None => None,
    };
    let against = fields.required("against")?;
    let edge = edge?;
    if against.string()? == GROUND {
        fields.refuse(&["method"], |key| format!("`{key}` belongs to contacts of two edges"), "remove it");
        let nodes = edge.distinct_nodes().to_vec();
        let inward = || edge.outward_normals(&builder.structure.nodes).into_iter().map(turned);
        let normals = normal.map_or_else(|| inward().take(nodes.len()).collect(), |normal| vec![normal; nodes.len()]);
        return Some(Sides::on_ground(nodes, normals));
    }
    if is_misspelt_ground(builder, against.string()?) {
        against.unknown("edge", against.string()?, &[GROUND]);
        return None;
    }
    let other = match builder.spot(against)? {
        Spot::Edge(edge) => edge,
        other => {
            against.problem(
                format!("expected an edge or \"ground\", found the {} {}", other.word(), against.quoted()),
                "an edge meets another edge, or the ground",
            );
            return None;
        }
    };
    if other == edge {
        against.problem(
            format!("the edge {} is in contact with itself", against.quoted()),
            "name two different edges, or \"ground\"",
        );
        return None;
    }
    let apart = gap_of(fields) == Gap::Geometry;
    let two = TwoEdges { builder, at, against, edge: &edge, other: &other, apart, skipped };
    // Where the method is free, edges that match but for what is skipped are left to the mortar: it counts the part of a
    // side that lies between two nodes too.
    let partners = match (two.partners(), method) {
        (Err(_), Some(Method::Nodes)) if !skipped.is_empty() => two.partners_of_the_rest(),
        (partners, _) => partners,
    };
    match (partners, method) {
        (Ok(partners), None | Some(Method::Nodes)) => Some(two.of_nodes(&partners, normal)),
        (Err(mismatch), Some(Method::Nodes)) => {
            let (message, help) = two.in_words(mismatch);
            against.problem(format!("the edges do not match: {message}"), help);
            None
        }
        _ => two.mortar(normal, gap_of(fields) == Gap::None),
    }
}

/// The direction in `normal`, if there is one.
pub fn given_normal(fields: &Fields<'_>) -> Option<Option<[f64; 3]>> {
    match fields.optional("normal") {
        Some(cursor) => cursor.direction("normal").map(Some),
        None => Some(None),
    }
}

/// What `gap` says.
#[derive(PartialEq)]
pub enum Gap {
    None,
    Number,
    Geometry,
}

pub fn gap_of(fields: &Fields<'_>) -> Gap {
    match fields.optional("gap") {
        None => Gap::None,
        Some(cursor) if is_geometry(cursor) => Gap::Geometry,
        Some(_) => Gap::Number,
    }
}

/// The opposite direction; subtracting from 0 turns −0 into 0.
pub fn turned(normal: [f64; 3]) -> [f64; 3] {
    normal.map(|n| 0.0 - n)
}

/// That the node at a position of `nodes`, those of the side `at`, has no partner on the other side.
pub fn no_partner(builder: &Builder<'_>, nodes: &[usize], k: usize, [at, against]: [Cursor<'_>; 2]) -> String {
    let node = &builder.structure.nodes[nodes[k]];
    let place = if builder.structure.dimension == Dimension::Space { &node.position[..] } else { &node.position[..2] };
    let place: Vec<String> = place.iter().map(f64::to_string).collect();
    format!(
        "\"{}\" (number {k} of {}) is at ({}), and no node of {} is there",
        builder.node_id(nodes[k]),
        at.quoted(),
        place.join(", "),
        against.quoted()
    )
}

/// Why two edges do not match node by node.
enum Mismatch {
    Count,
    Place {
        node: usize,
        partner: usize,
    },
    /// Beside nodes that are skipped.
    NoPartner {
        number: usize,
    },
}

struct TwoEdges<'a, 'd> {
    builder: &'a Builder<'d>,
    at: Cursor<'d>,
    against: Cursor<'d>,
    edge: &'a Edge,
    other: &'a Edge,
    /// Whether partners may be apart along the normal.
    apart: bool,
    /// Positions of the nodes that need no partner.
    skipped: &'a HashSet<usize>,
}

impl TwoEdges<'_, '_> {
    fn place(&self, node: usize) -> [f64; 2] {
        self.builder.structure.nodes[node].in_plane()
    }

    /// For each node the position of its partner on the other edge, which may run the other way and, where both are
    /// closed, begin elsewhere; each node must be at the place of its partner.
    fn partners(&self) -> Result<Vec<Option<usize>>, Mismatch> {
        let (nodes, others) = (self.edge.distinct_nodes(), self.other.distinct_nodes());
        let count = others.len();
        if count != nodes.len() {
            return Err(Mismatch::Count);
        }
        let normals = self.other.outward_normals(&self.builder.structure.nodes);
        let is_closed = |edge: &Edge| edge.distinct_nodes().len() < edge.nodes.len();
        let distance = |at: usize| self.distance(0, at);
        let nearest = || (0..count).min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(0);
        let (first, last) = match is_closed(self.edge) && is_closed(self.other) {
            true => (nearest(), nearest()),
            false => (0, count - 1),
        };
        let forward: Vec<usize> = (0..count).map(|k| (first + k) % count).collect();
        let backward: Vec<usize> = (0..count).map(|k| (last + count - k) % count).collect();
        // A repeated node is the shared corner of two edges of one plate.
        let wrong = |order: &[usize]| {
            (0..count).find(|&k| nodes[k] == others[order[k]] || !self.may_meet(k, order[k], &normals))
        };
        let (Some(ahead), Some(back)) = (wrong(&forward), wrong(&backward)) else {
            let order = if wrong(&forward).is_none() { forward } else { backward };
            return Ok(order.into_iter().map(Some).collect());
        };
        // Of the two ways the one that goes further is reported.
        let (k, order) = if back > ahead { (back, backward) } else { (ahead, forward) };
        Err(Mismatch::Place { node: nodes[k], partner: others[order[k]] })
    }

    /// The partners of the nodes that are not skipped, where the others have none.
    fn partners_of_the_rest(&self) -> Result<Vec<Option<usize>>, Mismatch> {
        let sides = [self.edge, self.other].map(Edge::distinct_nodes);
        let normals = self.other.outward_normals(&self.builder.structure.nodes);
        let distance = |k: usize, at: usize| self.may_meet(k, at, &normals).then(|| self.distance(k, at));
        matched(sides, self.skipped, distance).map_err(|number| Mismatch::NoPartner { number })
    }

    fn way(&self, a: usize, b: usize) -> [f64; 2] {
        let (a, b) = (self.place(a), self.place(b));
        [b[0] - a[0], b[1] - a[1]]
    }

    /// From a node to one of the other edge, by their positions.
    fn distance(&self, k: usize, at: usize) -> f64 {
        let [dx, dy] = self.way(self.edge.distinct_nodes()[k], self.other.distinct_nodes()[at]);
        dx.hypot(dy)
    }

    /// Whether a node is at the place of one of the other edge, or `apart` along its normal.
    fn may_meet(&self, k: usize, at: usize, normals: &[[f64; 3]]) -> bool {
        let nodes = self.edge.distinct_nodes();
        let ([dx, dy], n) = (self.way(nodes[k], self.other.distinct_nodes()[at]), normals[at]);
        // Edges have at least two nodes.
        let [ex, ey] = self.way(nodes[0], nodes[nodes.len() - 1]);
        let off = if self.apart { (dx * n[1] - dy * n[0]).abs() } else { self.distance(k, at) };
        off <= NEAR * ex.hypot(ey)
    }

    fn in_words(&self, mismatch: Mismatch) -> (String, &'static str) {
        match mismatch {
            Mismatch::Count => {
                let (nodes, others) = (self.edge.distinct_nodes().len(), self.other.distinct_nodes().len());
                let (at, against) = (self.at.quoted(), self.against.quoted());
                (
                    format!("{at} has {nodes} nodes, {against} has {others}"),
                    "give both sides the same nodes along the joint, or \"method\": \"mortar\"",
                )
            }
            Mismatch::Place { node, partner } => {
                let (a, b) = (self.place(node), self.place(partner));
                let (node, partner) = (self.builder.node_id(node), self.builder.node_id(partner));
                let message =
                    format!("\"{node}\" is at ({}, {}), its partner \"{partner}\" at ({}, {})", a[0], a[1], b[0], b[1]);
                (
                    message,
                    "every node must be at the place of its partner; \"gap\": \"geometry\" lets them be apart along the normal, \"method\": \"mortar\" beside each other",
                )
            }
            Mismatch::NoPartner { number } => (
                no_partner(self.builder, self.edge.distinct_nodes(), number, [self.at, self.against]),
                "name all nodes without a partner in `skip`, or give \"method\": \"mortar\"",
            ),
        }
    }

    /// `partners`: positions on the other edge.
    fn of_nodes(&self, partners: &[Option<usize>], normal: Option<[f64; 3]>) -> Sides {
        let (nodes, others) = (self.edge.distinct_nodes(), self.other.distinct_nodes());
        let own = self.other.outward_normals(&self.builder.structure.nodes);
        let normals = partners.iter().map(|&at| normal.unwrap_or(at.map_or([0.0; 3], |at| own[at]))).collect();
        let weights = nodes.iter().zip(partners).map(|(&node, at)| Some(Pair::of_nodes(node, Some(others[(*at)?]))));
        Sides::new(self.builder, nodes.to_vec(), weights.collect(), normals)
    }

    /// `must_touch`: no gap is given, so that the edges have to lie on each other.
    fn mortar(&self, normal: Option<[f64; 3]>, must_touch: bool) -> Option<Sides> {
        let nodes = &self.builder.structure.nodes;
        let (at, against) = (self.at.quoted(), self.against.quoted());
        let id = |node: usize| self.builder.node_id(node);
        let (message, help) = match mortar::pairs(self.edge, self.other, nodes) {
            Ok(pairs) => {
                let own = self.edge.outward_normals(nodes);
                let normal_of = |(k, pair): (usize, &Option<MortarPair>)| {
                    normal.unwrap_or_else(|| turned(pair.as_ref().map_or(own[k], |pair| flat(pair.normal))))
                };
                let normals = pairs.iter().enumerate().map(normal_of).collect();
                let weights = pairs.iter().map(|pair| pair.as_ref().map(|pair| pair.weights.clone())).collect();
                let mut sides = Sides::new(self.builder, self.edge.distinct_nodes().to_vec(), weights, normals);
                sides.shares = pairs.iter().map(|pair| pair.as_ref().map_or(0.0, |pair| pair.share)).collect();
                let places = pairs.into_iter().enumerate().filter_map(|(k, pair)| Some((k, pair?.place)));
                sides.places = places.filter(|(_, place)| place.len() > 1).collect();
                let room = NEAR * self.edge.length(nodes)
                    + mortar::chord_error(self.edge, nodes)
                    + mortar::chord_error(self.other, nodes);
                let of_nodes = sides.gaps.iter().flatten().zip(&sides.nodes).enumerate();
                let kept = of_nodes.filter(|(k, _)| !self.skipped.contains(k)).map(|(_, of_node)| of_node);
                let far = kept.into_iter().find(|(gap, _)| gap.abs() > room);
                match far.filter(|_| must_touch) {
                    None => return Some(sides),
                    Some((gap, &node)) => (
                        format!(
                            "the edges {at} and {against} do not touch: \"{}\" is {gap:.3e} away along the normal",
                            id(node)
                        ),
                        "give the gap: \"gap\": \"geometry\", or a number (0 if it is to count as closed)",
                    ),
                }
            }
            Err(MortarError::Apart) => (
                format!("the edges {at} and {against} do not face each other"),
                "name the edges of two bodies that lie opposite each other",
            ),
            Err(MortarError::Shared(node)) => (
                format!("the edges {at} and {against} have the node \"{}\" in common", id(node)),
                "each body needs nodes of its own along the joint; a node where the joint ends inside the body is left out \
                 by `skip` beside \"method\": \"nodes\"",
            ),
        };
        self.against.problem(message, help);
        None
    }
}
