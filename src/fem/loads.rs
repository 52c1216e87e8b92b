//! From the loads of a structure to nodal forces, and to what acts between the nodes of its bars.

use std::collections::BTreeMap;

use super::dof::Dofs;
use super::element::bar_load::BarLoad;
use super::element::{BarElement, slots, with_membrane};
use super::elimination::Elimination;
use super::error::MainSystemError;
use crate::model::structure::{Component, Load, LoadCase, Structure};

/// F per load case and unit factor on the base dofs.
///
/// # Errors
/// A moment where there is no rotation.
pub fn load_vectors(structure: &Structure, dofs: &Dofs) -> Result<Vec<Vec<f64>>, MainSystemError> {
    let mut vectors = Vec::with_capacity(structure.load_cases.len());
    for (load_case, case) in structure.load_cases.iter().enumerate() {
        let mut f = vec![0.0; dofs.count()];
        for load in &case.loads {
            if let Load::Nodal { node, force, moment } = *load {
                let rotation = dofs.of(node, Component::R);
                if moment != 0.0 && rotation.is_none() {
                    return Err(MainSystemError::MomentWithoutRotation {
                        load_case,
                        case: case.name.clone(),
                        node,
                        node_id: structure.nodes[node].id.clone(),
                    });
                }
                let at = [dofs.of(node, Component::X), dofs.of(node, Component::Y), rotation];
                for (dof, value) in at.into_iter().zip([force[0], force[1], moment]) {
                    if let Some(dof) = dof {
                        f[dof] += value;
                    }
                }
                continue;
            }
            let Some((element, forces)) = element_forces(structure, load) else { continue };
            for (slot, force) in slots(&structure.elements[element]).iter().zip(&forces) {
                if let Some(dof) = slot.and_then(|(node, component)| dofs.of(node, component)) {
                    f[dof] += force;
                }
            }
        }
        vectors.push(f);
    }
    Ok(vectors)
}

/// Imposed displacements of every base dof per load case and unit factor, S s; nothing for a case without settlements.
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

/// The element of a load between nodes and its nodal forces, rows as in [`slots`]; `None` for a nodal load or a bar
/// without length (refused by its stiffness).
fn element_forces(structure: &Structure, load: &Load) -> Option<(usize, Vec<f64>)> {
    let index = element_of(load)?;
    if let Some(bar) = BarElement::of(structure, index) {
        let mut acts = BarLoad::default();
        add(structure, &bar, load, 1.0, &mut acts);
        return Some((index, bar.nodal_forces(&acts)));
    }
    let forces = with_membrane(structure, index, |membrane| match *load {
        Load::Body { value, .. } => Some(membrane.body_force(value)),
        Load::FreeStrain { strain, .. } => Some(membrane.expansion_force(strain)),
        _ => None,
    });
    Some((index, forces.flatten()?))
}

fn element_of(load: &Load) -> Option<usize> {
    match *load {
        Load::Nodal { .. } | Load::Settlement { .. } => None,
        Load::Line { element, .. }
        | Load::BarPoint { element, .. }
        | Load::Body { element, .. }
        | Load::FreeStrain { element, .. } => Some(element),
    }
}

/// Adds factor × `load` to what acts on the bar on which it lies.
fn add(structure: &Structure, bar: &BarElement, load: &Load, factor: f64, acts: &mut BarLoad) {
    let axis = bar.axis();
    match *load {
        Load::Nodal { .. } | Load::Settlement { .. } => {}
        Load::Line { range, value, .. } => acts.add_line(axis, range, value, factor),
        Load::BarPoint { distance, force, moment, .. } => acts.add_point(axis, distance, force, moment, factor),
        Load::Body { element, value } => {
            let area = structure.elements[element].kind.area();
            acts.add_line(axis, [0.0, axis.length], [value.map(|b| area * b); 2], factor);
        }
        Load::FreeStrain { strain, curvature, .. } => {
            acts.strain += factor * strain;
            acts.curvature += factor * curvature;
        }
    }
}

/// What acts between the nodes of each bar element under Σ factor·case; elements without anything are left out.
pub fn bar_loads(structure: &Structure, factors: &[f64]) -> BTreeMap<usize, BarLoad> {
    let mut loads: BTreeMap<usize, BarLoad> = BTreeMap::new();
    for (case, &factor) in structure.load_cases.iter().zip(factors).filter(|(_, factor)| **factor != 0.0) {
        for load in &case.loads {
            let Some(index) = element_of(load) else { continue };
            if let Some(bar) = BarElement::of(structure, index) {
                add(structure, &bar, load, factor, loads.entry(index).or_default());
            }
        }
    }
    loads.retain(|_, load| !load.is_empty());
    loads
}

/// α ΔT and the like of each element under Σ factor·case; membranes read their stresses against it.
pub fn free_strains(structure: &Structure, factors: &[f64]) -> BTreeMap<usize, f64> {
    let mut strains = BTreeMap::new();
    for (case, factor) in structure.load_cases.iter().zip(factors) {
        for load in &case.loads {
            if let Load::FreeStrain { element, strain, .. } = load {
                *strains.entry(*element).or_insert(0.0) += factor * strain;
            }
        }
    }
    strains
}
