//! How bars bend between their nodes.

use super::element::{finite_element, slots};
use super::loads::ActingLoads;
use crate::model::structure::Structure;

/// The elastic curves of the bars of a structure under loads.
pub struct ElasticCurves<'a> {
    structure: &'a Structure,
    acting: ActingLoads<'a>,
}

impl<'a> ElasticCurves<'a> {
    /// Under Σ factor·case; without factors those of a motion without loads.
    pub fn of(structure: &'a Structure, factors: &[f64]) -> Self {
        // loads on anything else, of which there may be many, bend no bar
        let factors = if structure.elements.iter().any(|element| element.bends()) { factors } else { &[] };
        ElasticCurves { structure, acting: ActingLoads::of(structure, factors) }
    }

    /// Displacements (u_x, u_y, u_z) of an element at these shares of its length from its start (ascending), under the
    /// displacements u of the nodes; `None` for one that does not bend.
    pub fn places(&self, element: usize, u: &[[f64; 6]], shares: &[f64]) -> Option<Vec<[f64; 3]>> {
        let slots = slots(self.structure.elements.get(element)?);
        let rows = slots.into_iter().map(|(node, component)| u.get(node).map_or(0.0, |u| u[component as usize]));
        let rows: Vec<f64> = rows.collect();
        finite_element(self.structure, element).ok()?.elastic_curve(&rows, self.acting.on(element), shares)
    }
}
