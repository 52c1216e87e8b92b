//! From the loads of a structure to nodal forces, and to what acts on each of its elements.

use std::collections::BTreeMap;

use super::dof::Dofs;
use super::element::{Acting, finite_element, slots};
use super::elimination::Elimination;
use super::error::MainSystemError;
use crate::model::structure::{Component, ElementLoad, Load, LoadCase, Structure};

/// F per load case and unit factor on the base dofs: forces along x, y, z and moments about them.
///
/// # Errors
/// A moment where there is no rotation.
pub fn load_vectors(structure: &Structure, dofs: &Dofs) -> Result<Vec<Vec<f64>>, MainSystemError> {
    let mut vectors = Vec::with_capacity(structure.load_cases.len());
    for (load_case, case) in structure.load_cases.iter().enumerate() {
        let mut f = vec![0.0; dofs.count()];
        let mut add = |node: usize, component: Component, value: f64| {
            if let Some(dof) = dofs.of(node, component) {
                f[dof] += value;
            }
        };
        for load in &case.loads {
            match *load {
                Load::Nodal { node, force, moment } => {
                    let turning = std::iter::zip(Component::ROTATIONS, moment);
                    if turning.clone().any(|(about, moment)| moment != 0.0 && dofs.of(node, about).is_none()) {
                        return Err(MainSystemError::MomentWithoutRotation {
                            load_case,
                            case: case.name.clone(),
                            node,
                            node_id: structure.nodes[node].id.clone(),
                        });
                    }
                    std::iter::zip(Component::TRANSLATIONS, force)
                        .chain(turning)
                        .for_each(|(c, value)| add(node, c, value));
                }
                Load::Element { element: index, ref load } => {
                    // One without shape is refused by its stiffness.
                    let Ok(element) = finite_element(structure, index) else { continue };
                    let forces = element.nodal_forces(&[(1.0, load)]);
                    std::iter::zip(slots(&structure.elements[index]), forces).for_each(|((n, c), f)| add(n, c, f));
                }
                Load::Settlement { .. } => {}
            }
        }
        vectors.push(f);
    }
    Ok(vectors)
}

/// Imposed displacements (lengths and radians) of every base dof per load case and unit factor, S s; `None` for a case
/// without settlements.
///
/// # Errors
/// Supports that move as one by ties, of which some settle differently.
pub fn settlements(
    structure: &Structure,
    dofs: &Dofs,
    elimination: &Elimination,
) -> Result<Vec<Option<Vec<f64>>>, MainSystemError> {
    let of_case = |case: &LoadCase| {
        let mut values: BTreeMap<usize, f64> = BTreeMap::new();
        for load in &case.loads {
            if let Load::Settlement { node, component, value } = *load
                && let Some(dof) = dofs.of(node, component)
            {
                values.insert(dof, value);
            }
        }
        if values.is_empty() {
            return Ok(None);
        }
        let mut s = BTreeMap::new();
        for support in &structure.supports {
            let Some(dof) = dofs.of(support.node, support.component) else { continue };
            let Some(number) = elimination.settlement(dof) else { continue };
            let value = values.get(&dof).copied().unwrap_or(0.0);
            let (first, known) = *s.entry(number).or_insert((support.node, value));
            if known != value {
                return Err(MainSystemError::UnequalSettlements {
                    case: case.name.clone(),
                    nodes: [first, support.node].map(|node| structure.nodes[node].id.clone()),
                });
            }
        }
        let count = s.keys().last().map_or(0, |last| last + 1);
        let s: Vec<f64> = (0..count).map(|number| s.get(&number).map_or(0.0, |(_, value)| *value)).collect();
        Ok(Some(elimination.settled(&s)))
    };
    structure.load_cases.iter().map(of_case).collect()
}

/// What acts on each element under Σ factor·case.
pub struct ActingLoads<'a>(BTreeMap<usize, Vec<(f64, &'a ElementLoad)>>);

impl<'a> ActingLoads<'a> {
    /// All of them; cases with the factor 0 are left out.
    pub fn of(structure: &'a Structure, factors: &[f64]) -> ActingLoads<'a> {
        let mut all: BTreeMap<usize, Vec<(f64, &ElementLoad)>> = BTreeMap::new();
        for (case, &factor) in structure.load_cases.iter().zip(factors).filter(|(_, factor)| **factor != 0.0) {
            for load in &case.loads {
                if let Load::Element { element, load } = load {
                    all.entry(*element).or_default().push((factor, load));
                }
            }
        }
        ActingLoads(all)
    }

    /// Those on one element.
    pub fn on(&self, element: usize) -> &Acting<'a> {
        self.0.get(&element).map_or(&[], Vec::as_slice)
    }
}
