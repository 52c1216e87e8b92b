//! What `at` may name.

use crate::model::edge::Edge;
use crate::model::face::Face;

/// A node, an edge or a face.
#[derive(Clone)]
pub enum Spot {
    Node(usize),
    Edge(Edge),
    Face(Face),
}

impl Spot {
    /// `node`.
    pub fn word(&self) -> &'static str {
        match self {
            Spot::Node(_) => "node",
            Spot::Edge(_) => "edge",
            Spot::Face(_) => "face",
        }
    }
}
