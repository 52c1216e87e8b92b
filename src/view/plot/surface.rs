//! The surface of solids: the faces that only one element has, and their edges.

use std::collections::HashMap;

use crate::model::faces::Faces;
use crate::model::shape::side_corners;
use crate::model::structure::Structure;
use crate::model::vector::{cross, dot, unit, way};

/// Edges where the surface bends by less than this cosine allows are lines of the mesh on one face.
const SMOOTH: f64 = 0.94;

/// An edge of the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceEdge {
    /// Its nodes from end to end, that in its middle among them.
    pub nodes: Vec<usize>,
    /// Whether the surface bends there, or ends.
    pub is_sharp: bool,
}

/// The surface of the solids of a structure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Nodes round each outer face, counter-clockwise as seen from outside.
    pub faces: Vec<Vec<usize>>,
    /// Their edges, each once.
    pub edges: Vec<SurfaceEdge>,
}

impl Surface {
    /// Of all solids of a structure.
    pub fn of(structure: &Structure) -> Surface {
        let mut sides = Faces::default();
        for (index, element) in structure.elements.iter().enumerate().filter(|(_, element)| element.shape().is_solid())
        {
            sides.add(index, element.shape(), &element.nodes);
        }
        let faces: Vec<Vec<usize>> = sides.surface().into_iter().map(|side| ring(&side.nodes)).collect();
        let edges = edges_of(structure, &faces);
        Surface { faces, edges }
    }
}

/// The nodes of a side as they lie round it, middles between their corners.
fn ring(nodes: &[usize]) -> Vec<usize> {
    let corners = side_corners(nodes.len());
    (0..corners).flat_map(|k| [Some(nodes[k]), nodes.get(corners + k).copied()]).flatten().collect()
}

fn edges_of(structure: &Structure, faces: &[Vec<usize>]) -> Vec<SurfaceEdge> {
    let place = |node: usize| structure.nodes[node].position;
    let normal = |face: &Vec<usize>| {
        let first = place(face[0]);
        let mut sum = [0.0; 3];
        for k in 1..face.len() - 1 {
            let part = cross(way(first, place(face[k])), way(first, place(face[k + 1])));
            sum = std::array::from_fn(|c| sum[c] + part[c]);
        }
        unit(sum).unwrap_or_default()
    };
    let normals: Vec<[f64; 3]> = faces.iter().map(normal).collect();
    let mut found: HashMap<[usize; 2], usize> = HashMap::new();
    let mut edges: Vec<(SurfaceEdge, usize)> = Vec::new();
    for (index, face) in faces.iter().enumerate() {
        // corners and middles alternate in the rings of quadratic elements
        let step = if face.len() > 4 { 2 } else { 1 };
        for k in (0..face.len()).step_by(step) {
            let nodes: Vec<usize> = (k..=k + step).map(|k| face[k % face.len()]).collect();
            let (a, b) = (nodes[0], nodes[step]);
            match found.get(&[a.min(b), a.max(b)]) {
                Some(&known) => {
                    let (edge, other) = &mut edges[known];
                    edge.is_sharp = dot(normals[*other], normals[index]) < SMOOTH;
                }
                None => {
                    found.insert([a.min(b), a.max(b)], edges.len());
                    edges.push((SurfaceEdge { nodes, is_sharp: true }, index));
                }
            }
        }
    }
    edges.into_iter().map(|(edge, _)| edge).collect()
}
