//! What `at` may name.

use crate::model::edge::Edge;

/// A node or an edge.
#[derive(Clone)]
pub enum Spot {
    Node(usize),
    Edge(Edge),
}
