//! Which parts of a structure are the stiffest and the softest, for the words of a refusal.

use super::element::stiffness;
use super::error::MainSystemError;
use crate::model::structure::Structure;

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
    MainSystemError::Contrast {
        node: *node,
        contrast: stiff / soft,
        stiffest: stiffest.clone(),
        softest: softest.clone(),
    }
}
