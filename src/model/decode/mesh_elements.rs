//! Nodes, bars, areas and solids of a mesh that was read, put into the structure.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use super::builder::Builder;
use super::mesh_names::MeshPart;
use super::meshes::{Lines, MeshOutline};
use crate::model::edge::Sides;
use crate::model::groups::Groups;
use crate::model::mesh::chain::{chains, oriented};
use crate::model::structure::{Bar, Body, Dimension, Element, ElementKind, MeshElements, Node};

/// Appends the nodes `ID/TAG` that are used.
pub fn append_nodes<'d>(builder: &mut Builder<'d>, outline: &MeshOutline<'d>) {
    let mut node_of = vec![None; outline.mesh.nodes.len()];
    for ((node, used), index) in outline.mesh.nodes.iter().zip(outline.used_nodes()).zip(&mut node_of) {
        if used {
            let [x, y, z] = node.position;
            // The plane of a mesh may have any z.
            let z = if builder.structure.dimension == Dimension::Space { z } else { 0.0 };
            *index = Some(builder.structure.nodes.len());
            let id = format!("{}/{}", outline.id, node.tag);
            builder.structure.nodes.push(Node { id, position: [x, y, z].map(|x| outline.scale * x) });
        }
    }
    let part = MeshPart::new(outline.id, Arc::clone(&outline.mesh), node_of);
    builder.meshes.entry(outline.id).or_insert(part);
}

/// Appends bars, areas and solids.
pub fn append_elements<'d>(builder: &mut Builder<'d>, outline: &MeshOutline<'d>, place: &Arc<str>) {
    for bars in &outline.bars {
        append_bars(builder, outline, bars);
    }
    let Some(part) = builder.meshes.get_mut(outline.id) else { return };
    let elements = &mut builder.structure.elements;
    let first = elements.len();
    let mut tags = Vec::new();
    for (index, of) in outline.parts.iter().enumerate() {
        let Some(of) = of else { continue };
        let element = &outline.mesh.elements[index];
        let mut kind = of.kind.clone();
        if let ElementKind::Membrane { incompatible, .. } | ElementKind::Solid { incompatible } = &mut kind {
            *incompatible &= element.shape.can_be_incompatible();
        }
        part.element_of[index] = Some(elements.len());
        // Nodes of used elements are there.
        let nodes = element.nodes.iter().filter_map(|node| part.node_of[*node as usize]).collect();
        elements.push(Element { nodes, material: of.material, kind });
        tags.push(element.tag);
    }
    let range = first..elements.len();
    let bodies = bodies(part, &elements[range.clone()], first, builder.structure.nodes.len());
    let sides = Sides::of(&elements[range.clone()]).all();
    builder.structure.meshes.push(MeshElements { id: outline.id.to_owned(), elements: range, tags, bodies, sides });
    builder.notes.extend(outline.mesh.notes.iter().map(|note| format!("{}: {note}", outline.id)));
    builder.places.elements.resize(builder.structure.elements.len(), place.clone());
}

/// The two nodes of a line, as indices into the mesh.
type Ends = [usize; 2];
/// A line as a bar runs along it, with its index in the mesh and what it is made of.
type Along<'l> = (Ends, &'l (u32, ElementKind));

/// A chain of lines is one bar `ID.GROUP` from left to right; otherwise every line is a bar `ID#TAG`.
fn append_bars<'d>(builder: &mut Builder<'d>, outline: &MeshOutline<'d>, group: &Lines<'d>) {
    let mesh = &outline.mesh;
    let lines: Vec<Along> = group
        .lines
        .iter()
        .map(|line| {
            let nodes = &mesh.elements[line.0 as usize].nodes;
            ([nodes[0] as usize, nodes[1] as usize], line)
        })
        .collect();
    let segments: Vec<Ends> = lines.iter().map(|(ends, _)| *ends).collect();
    let chain = chains(&segments).ok().and_then(|found| <[Vec<usize>; 1]>::try_from(found).ok());
    let bars: Vec<(String, Vec<Along>)> = match chain {
        Some([chain]) => {
            let of: HashMap<Ends, &(u32, ElementKind)> =
                lines.iter().flat_map(|&([a, b], line)| [([a, b], line), ([b, a], line)]).collect();
            let chain = oriented(chain, &|node| mesh.position(node as u32));
            let along = chain.windows(2).filter_map(|ends| Some(([ends[0], ends[1]], *of.get(ends)?)));
            vec![(format!("{}.{}", outline.id, group.group), along.collect())]
        }
        None => {
            let name = |index: u32| format!("{}#{}", outline.id, mesh.elements[index as usize].tag);
            lines.iter().map(|&(ends, line)| (name(line.0), vec![(ends, line)])).collect()
        }
    };
    let Some(part) = builder.meshes.get_mut(outline.id) else { return };
    for (id, along) in bars {
        let first = builder.structure.elements.len();
        for (ends, (index, kind)) in along {
            part.element_of[*index as usize] = Some(builder.structure.elements.len());
            let nodes = ends.iter().filter_map(|node| part.node_of[*node]).collect();
            let element = Element { nodes, material: group.material, kind: kind.clone() };
            builder.structure.elements.push(element);
        }
        builder.bars.insert(Cow::Owned(id.clone()), builder.structure.bars.len());
        builder.bar_sections.push(group.section);
        builder.structure.bars.push(Bar { id, elements: first..builder.structure.elements.len() });
    }
}

/// The connected parts of a mesh, with names: of the mesh, of a group that is just this part, or of a node.
fn bodies(part: &MeshPart, elements: &[Element], first: usize, nodes: usize) -> Vec<Body> {
    let mut groups = Groups::new(nodes);
    elements.iter().for_each(|element| groups.join_all(element.nodes.iter().copied()));
    let body_of = groups.numbers(elements.iter().map(|element| element.nodes[0]));
    let count = body_of.iter().max().map_or(0, |last| last + 1);
    let mut bodies: Vec<Body> = vec![Body { name: String::new(), elements: Vec::new() }; count];
    for (index, body) in body_of.into_iter().enumerate() {
        bodies[body].elements.push(first + index);
    }
    let single = bodies.len() == 1;
    for body in &mut bodies {
        body.name = match part.group_of_elements(&body.elements) {
            _ if single => part.id().to_owned(),
            Some(group) => format!("{}.{group}", part.id()),
            None => part.element_name(body.elements[0]),
        };
    }
    bodies
}
