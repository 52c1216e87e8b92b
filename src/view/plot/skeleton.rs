//! What all pictures of a structure share, however it is moved and seen: what takes a walk over all of it is done once.

use super::surface::Surface;
use super::ticks::range;
use crate::model::structure::{Dimension, Structure};
use crate::model::vector::distance;
use crate::view::projection::Projection;

/// Straight pieces of a bent frame element where there are many of them, and where there are few.
const PIECES: [usize; 2] = [8, 32];
/// This many pieces of all bent elements together are enough: the more elements, the fewer pieces of each.
const ALL_PIECES: usize = 512;

/// What pictures of a structure share.
#[derive(Clone, Debug)]
pub struct Skeleton {
    /// Least and largest coordinate of the nodes along each axis.
    bounds: [(f64, f64); 3],
    /// Places among which are those farthest out to every side from which the structure may be seen.
    outer: Vec<[f64; 3]>,
    /// The surface of its solids.
    pub surface: Surface,
    /// Smallest distance of two grid lines of a plate; infinite without plates.
    pub pitch: f64,
    /// How many elements bend between their nodes.
    bending: usize,
}

impl Skeleton {
    /// That of a structure.
    pub fn of(structure: &Structure) -> Skeleton {
        let bounds = [0, 1, 2].map(|axis| range(structure.nodes.iter().map(|node| node.position[axis])));
        let surface = Surface::of(structure);
        Skeleton {
            outer: outer(structure, bounds, &surface),
            bounds,
            surface,
            pitch: plate_pitch(structure),
            bending: structure.elements.iter().filter(|element| element.bends()).count(),
        }
    }

    /// Whether any element bends between its nodes.
    pub fn bends(&self) -> bool {
        self.bending > 0
    }

    /// Where the elastic curve of a bar is drawn through, as shares of its length.
    pub fn shares(&self) -> Vec<f64> {
        let [many, few] = PIECES;
        let pieces = (ALL_PIECES / self.bending.max(1)).clamp(many, few);
        (0..=pieces).map(|i| i as f64 / pieces as f64).collect()
    }

    /// From the least to the largest coordinate along an axis.
    pub fn side(&self, axis: usize) -> f64 {
        let (low, high) = self.bounds[axis];
        (high - low).max(0.0)
    }

    /// Least and largest x and y in a picture of the structure where nothing is displaced; `None` without nodes.
    pub fn seen_by(&self, projection: &Projection) -> Option<[(f64, f64); 2]> {
        let seen: Vec<(f64, f64)> = self.outer.iter().map(|place| projection.flat(*place)).collect();
        let of = |axis: fn(&(f64, f64)) -> f64| range(seen.iter().map(axis));
        (!seen.is_empty()).then(|| [of(|at| at.0), of(|at| at.1)])
    }
}

/// See [`Skeleton::outer`]: in the plane, which is seen along its axes, the corners around it; in space all nodes that do
/// not lie within solids.
fn outer(structure: &Structure, bounds: [(f64, f64); 3], surface: &Surface) -> Vec<[f64; 3]> {
    if structure.nodes.is_empty() {
        return Vec::new();
    }
    if structure.dimension == Dimension::Plane {
        let [(left, right), (bottom, top), _] = bounds;
        return vec![[left, bottom, 0.0], [right, top, 0.0]];
    }
    let mut is_within = vec![false; structure.nodes.len()];
    for element in structure.elements.iter().filter(|element| element.shape().is_solid()) {
        element.nodes.iter().for_each(|&node| is_within[node] = true);
    }
    surface.faces.iter().flatten().for_each(|&node| is_within[node] = false);
    let nodes = structure.nodes.iter().zip(is_within);
    nodes.filter(|(_, is_within)| !is_within).map(|(node, _)| node.position).collect()
}

fn plate_pitch(structure: &Structure) -> f64 {
    let place = |node: &usize| structure.nodes.get(*node).map(|node| node.position);
    // a plate is a rectangle: its first row and column have all distances
    let lines = structure.plates.iter().flat_map(|plate| {
        let row: Vec<_> = plate.nodes.iter().take(1).flatten().filter_map(place).collect();
        let column: Vec<_> = plate.nodes.iter().filter_map(|row| row.first()).filter_map(place).collect();
        [row, column]
    });
    let smallest =
        |line: Vec<[f64; 3]>| line.windows(2).map(|two| distance(two[0], two[1])).fold(f64::INFINITY, f64::min);
    lines.map(smallest).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::projection::Viewpoint;
    use crate::view::tests::sample::block;

    /// A block of 3 × 2 × 4 bricks has nodes within; the others give its extent from every side.
    #[test]
    fn what_lies_within_solids_does_not_tell_their_extent() {
        let structure = block([3, 2, 4], [3.0, 1.0, 2.0]);
        let skeleton = Skeleton::of(&structure);
        // (3 − 1)(2 − 1)(4 − 1) nodes lie within
        assert_eq!(skeleton.outer.len(), 4 * 3 * 5 - 2 * 3);
        assert_eq!([0, 1, 2].map(|axis| skeleton.side(axis)), [3.0, 1.0, 2.0]);
        for angles in [(-45.0, 35.0), (-90.0, 0.0), (20.0, 70.0), (130.0, -10.0)] {
            let projection = Projection::new(Dimension::Space, Viewpoint::new(angles.0, angles.1).unwrap());
            let all: Vec<(f64, f64)> = structure.nodes.iter().map(|node| projection.flat(node.position)).collect();
            let expected = [range(all.iter().map(|at| at.0)), range(all.iter().map(|at| at.1))];
            assert_eq!(skeleton.seen_by(&projection), Some(expected));
        }
    }
}
