//! A bar as a line in the model, with the side on which its ordinates stand.

use crate::answer::diagram::Internal;
use crate::model::bar_axes::BarAxes;
use crate::model::structure::{Bar, Element, ElementKind, Structure};

/// Where a distance from the start of a bar is, and the side on which positive values of a force are drawn there.
pub struct BarLine {
    /// Distance of the start, place of the start and axes of each element.
    elements: Vec<(f64, [f64; 3], BarAxes)>,
    force: Internal,
}

impl BarLine {
    /// Of a bar; elements without a length are left out.
    pub fn of(structure: &Structure, bar: &Bar, force: Internal) -> BarLine {
        let mut from = 0.0;
        let mut elements = Vec::new();
        for element in &structure.elements[bar.elements.clone()] {
            if let Some(axes) = axes(structure, element) {
                elements.push((from, structure.nodes[element.nodes[0]].position, axes));
                from += axes.length;
            }
        }
        BarLine { elements, force }
    }

    /// For values along the bar, the places on it and the side there; of two values at one distance the second belongs
    /// to the element after it.
    pub fn feet(&self, points: &[(f64, f64)]) -> Vec<([f64; 3], [f64; 3])> {
        let late = |i: usize| i == 0 || points[i - 1].0 == points[i].0;
        points.iter().enumerate().map(|(i, &(distance, _))| self.at(distance, late(i))).collect()
    }

    /// The place at a distance, and the side; `late` takes the element after a node that lies there.
    pub fn at(&self, distance: f64, late: bool) -> ([f64; 3], [f64; 3]) {
        let begun = |start: f64| if late { start <= distance } else { start < distance };
        let element = self.elements.iter().rev().find(|(start, ..)| begun(*start)).or(self.elements.first());
        let Some((start, a, axes)) = element else { return ([0.0; 3], [0.0; 3]) };
        (std::array::from_fn(|c| a[c] + (distance - start) * axes.x[c]), self.side(axes))
    }

    /// Bending moments lie on the side in tension, all others on the positive side of the axis along which they act.
    fn side(&self, axes: &BarAxes) -> [f64; 3] {
        match self.force {
            Internal::Moment | Internal::MomentZ => axes.y.map(|y| -y),
            Internal::MomentY => axes.z.map(|z| -z),
            Internal::ShearZ => axes.z,
            Internal::Axial | Internal::Shear | Internal::ShearY | Internal::Torsion => axes.y,
        }
    }
}

fn axes(structure: &Structure, element: &Element) -> Option<BarAxes> {
    let ends = [0, 1].map(|end| structure.nodes[element.nodes[end]].position);
    match &element.kind {
        ElementKind::SpaceFrame { orientation, .. } | ElementKind::SpaceTruss { orientation, .. } => {
            BarAxes::in_space(ends, *orientation).ok()
        }
        ElementKind::Frame { .. } | ElementKind::Truss { .. } => BarAxes::in_plane(ends.map(|[x, y, _]| [x, y])),
        ElementKind::Membrane { .. } | ElementKind::Solid { .. } => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bar along x has y upwards and z along −y: what has tension on its −z side is drawn there, which is +y.
    #[test]
    fn forces_stand_on_their_side_of_a_bar_in_space() {
        let axes = BarAxes::in_space([[0.0; 3], [4.0, 0.0, 0.0]], None).unwrap();
        let side = |force: Internal| BarLine { elements: vec![(0.0, [0.0; 3], axes)], force }.at(1.0, false);
        for (force, expected) in [
            (Internal::ShearY, [0.0, 0.0, 1.0]),
            (Internal::MomentZ, [0.0, 0.0, -1.0]),
            (Internal::ShearZ, [0.0, -1.0, 0.0]),
            (Internal::MomentY, [0.0, 1.0, 0.0]),
            (Internal::Torsion, [0.0, 0.0, 1.0]),
        ] {
            assert_eq!(side(force), ([1.0, 0.0, 0.0], expected), "{force:?}");
        }
    }
}
