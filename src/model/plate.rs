//! Rectangular plates and their four edges.

use super::edge::{Edge, EdgeSide};

/// A rectangular plate of the file: a grid of quads.
#[derive(Clone, Debug, PartialEq)]
pub struct Plate {
    /// Name in the file.
    pub id: String,
    /// Its elements, row by row from the bottom: a range of
    /// [`Structure::elements`](super::structure::Structure::elements).
    pub elements: std::ops::Range<usize>,
    /// Node grid: `nodes[j][i]` is `id[i,j]`.
    pub nodes: Vec<Vec<usize>>,
}

impl Plate {
    /// How many elements lie side by side along its length.
    pub fn columns(&self) -> usize {
        self.nodes.first().map_or(0, |row| row.len().saturating_sub(1))
    }
}

/// One of the four edges of a plate, in the plate's own axes (before its rotation).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PlateSide {
    /// j = 0.
    Bottom,
    /// Largest j.
    Top,
    /// i = 0.
    Left,
    /// Largest i.
    Right,
}

impl PlateSide {
    /// The words in files.
    pub const WORDS: [(&'static str, PlateSide); 4] = [
        ("bottom", PlateSide::Bottom),
        ("top", PlateSide::Top),
        ("left", PlateSide::Left),
        ("right", PlateSide::Right),
    ];

    /// The edge, by increasing i or j.
    pub fn edge(self, plate: &Plate) -> Edge {
        // Every plate has at least two rows of at least two nodes.
        let rows = &plate.nodes;
        let (columns, lines) = (rows[0].len() - 1, rows.len() - 1);
        let nodes: Vec<usize> = match self {
            PlateSide::Bottom => rows[0].clone(),
            PlateSide::Top => rows[lines].clone(),
            PlateSide::Left => rows.iter().map(|row| row[0]).collect(),
            PlateSide::Right => rows.iter().map(|row| row[columns]).collect(),
        };
        let element = |k: usize| {
            plate.elements.start
                + match self {
                    PlateSide::Bottom => k,
                    PlateSide::Top => (lines - 1) * columns + k,
                    PlateSide::Left => k * columns,
                    PlateSide::Right => k * columns + columns - 1,
                }
        };
        let reversed = matches!(self, PlateSide::Top | PlateSide::Left);
        let sides = (1..nodes.len())
            .map(|k| EdgeSide { element: element(k - 1), ends: [nodes[k - 1], nodes[k]], middle: None, reversed })
            .collect();
        Edge { nodes, sides }
    }
}
