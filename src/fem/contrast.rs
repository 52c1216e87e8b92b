//! Which parts of a structure are the stiffest and the softest, and by how much.

use super::element::{Stiffness, stiffness};
use super::error::MainSystemError;
use crate::doubled::Real;
use crate::model::structure::Structure;

/// The largest entries of the softest and of the stiffest element or spring.
pub struct Stiffnesses {
    softest: f64,
    stiffest: f64,
}

impl Stiffnesses {
    /// Of the springs alone.
    pub fn of_springs(structure: &Structure) -> Stiffnesses {
        let mut all = Stiffnesses { softest: f64::INFINITY, stiffest: 0.0 };
        let springs = structure.springs.iter().map(|spring| spring.stiffness);
        springs.filter(|stiffness| *stiffness > 0.0).for_each(|stiffness| all.add(stiffness));
        all
    }

    /// An element more.
    pub fn take<T: Real>(&mut self, k: &Stiffness<T>) {
        self.add((0..k.nrows()).map(|i| k[(i, i)].to_f64()).fold(0.0, f64::max));
    }

    fn add(&mut self, stiffness: f64) {
        self.softest = self.softest.min(stiffness);
        self.stiffest = self.stiffest.max(stiffness);
    }

    /// The stiffest over the softest.
    pub fn contrast(&self) -> f64 {
        if self.stiffest > 0.0 { self.stiffest / self.softest } else { 1.0 }
    }
}

/// A contrast below this is not what doubled precision, of 32 digits, fails at.
const EXPLAINS: f64 = 1e10;

/// The refusal of a structure whose stiffness is lost beside that of its stiffest part.
pub fn refusal(structure: &Structure) -> MainSystemError {
    let id = |node: usize| structure.nodes[node].id.as_str();
    // (stiffness against translation of its first node, that node, name)
    let mut parts: Vec<(f64, usize, String)> = Vec::new();
    let rigid = structure.rigid_elements();
    for (index, element) in structure.elements.iter().enumerate().filter(|(index, _)| !rigid[*index]) {
        if let Ok(k) = stiffness::<f64>(structure, index) {
            let name = match structure.bar_of(index) {
                Some(bar) => format!("bar {}", structure.bars[bar].id),
                None => structure.element_in_words(index),
            };
            parts.push((
                (0..structure.dimension.coordinates()).map(|c| k[(c, c)]).fold(0.0, f64::max),
                element.nodes[0],
                name,
            ));
        }
    }
    for spring in &structure.springs {
        let node = spring.terms[0].node;
        parts.push((spring.stiffness, node, format!("the spring at {}", id(node))));
    }
    let given = structure.superelement.iter().flat_map(|element| {
        let diagonal = element.entries.iter().filter(|(i, j, _)| i == j);
        diagonal.map(|&(i, _, k)| (k, element.dofs[i]))
    });
    for (k, (node, component)) in given.filter(|(_, (_, component))| !component.is_rotation()) {
        parts.push((
            k,
            node,
            format!("row {} of {} of the superelement", structure.dimension.word(component), id(node)),
        ));
    }
    parts.retain(|(k, ..)| *k > 0.0);
    parts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (Some((soft, _, softest)), Some((stiff, node, stiffest))) = (parts.first(), parts.last()) else {
        return MainSystemError::NotFinite;
    };
    if stiff / soft < EXPLAINS {
        return MainSystemError::Slender { node: *node, stiffest: stiffest.clone() };
    }
    MainSystemError::Contrast {
        node: *node,
        contrast: stiff / soft,
        stiffest: stiffest.clone(),
        softest: softest.clone(),
    }
}
