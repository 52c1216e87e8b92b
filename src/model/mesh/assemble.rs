//! The [`Mesh`] that is made of what a reader collected: numbers become indices, what is written twice becomes one,
//! areas are judged and turned.

use std::collections::HashMap;

use super::raw::{RawMembers, RawMesh};
use super::{Group, Members, Mesh, MeshElement, MeshProblem, Place};
use crate::model::shape::ShapeFault;
use crate::model::words::counted;

/// Nodes count as in one plane if they are this near to it, relative to the size of the mesh: what Gmsh itself allows
/// its geometry (`Geometry.Tolerance`).
const IN_PLANE: f64 = 1e-8;

/// Problems of many items: the first of each kind and how many others there are.
#[derive(Default)]
struct Faults(Vec<(&'static str, MeshProblem, usize)>);

impl Faults {
    fn add(&mut self, kind: &'static str, problem: impl FnOnce() -> MeshProblem) {
        match self.0.iter_mut().find(|(known, ..)| *known == kind) {
            Some((_, _, count)) => *count += 1,
            None => self.0.push((kind, problem(), 1)),
        }
    }

    fn end(self) -> Result<(), Vec<MeshProblem>> {
        let said = self.0.into_iter().map(|(_, mut problem, count)| {
            if count > 1 {
                problem.message += &format!(" (and {} like it)", counted(count - 1, "more element", "more elements"));
            }
            problem
        });
        let said: Vec<MeshProblem> = said.collect();
        if said.is_empty() { Ok(()) } else { Err(said) }
    }
}

/// The checked mesh.
///
/// # Errors
/// What is wrong with it: one problem of each kind.
pub fn mesh(raw: RawMesh) -> Result<Mesh, Vec<MeshProblem>> {
    if raw.elements.is_empty() {
        let message = "the mesh has no elements";
        return Err(vec![raw.problem(Place::default(), message, "mesh the geometry and save it with its elements")]);
    }
    let (mut elements, final_index) = resolved(&raw)?;
    let dimension = elements.iter().map(|element| element.shape.dimension()).max().unwrap_or(0);
    if dimension == 2 {
        in_one_plane(&raw, &elements)?;
    }
    let turned = judged(&raw, &mut elements, dimension)?;
    let mut notes = raw.notes.clone();
    let turned_count = turned.iter().filter(|turned| **turned).count();
    if let Some(first) = turned.iter().position(|turned| *turned) {
        let first = &elements[first];
        notes.push(format!(
            "{} {} and {} turned round, the first at {}: element {}",
            match (turned_count, dimension) {
                (1, 2) => "1 element runs".into(),
                (1, _) => "1 element is".into(),
                (count, 2) => format!("{count} elements run"),
                (count, _) => format!("{count} elements are"),
            },
            if dimension == 2 { "clockwise" } else { "inside out" },
            if turned_count == 1 { "is" } else { "are" },
            raw.line_of(first.place),
            first.tag
        ));
    }
    let (groups, empty) = groups(&raw, &elements, &final_index, &turned).map_err(|problem| vec![problem])?;
    let empty_groups = raw.empty_groups.into_iter().chain(empty).collect();
    let mut element_of = HashMap::new();
    for (element, index) in raw.elements.iter().zip(&final_index) {
        element_of.insert(element.tag, *index);
    }
    Ok(Mesh {
        files: raw.files,
        format: raw.format,
        nodes: raw.nodes,
        elements,
        dimension,
        groups,
        empty_groups,
        ignores_case: raw.ignores_case,
        notes,
        skipped: raw.skipped,
        node_of: raw.node_of,
        element_of,
    })
}

/// The elements with indices of nodes, each once, and the index of each that was added.
fn resolved(raw: &RawMesh) -> Result<(Vec<MeshElement>, Vec<u32>), Vec<MeshProblem>> {
    let mut faults = Faults::default();
    let mut elements: Vec<MeshElement> = Vec::with_capacity(raw.elements.len());
    let mut final_index = Vec::with_capacity(raw.elements.len());
    let mut by_tag: HashMap<u64, u32> = HashMap::with_capacity(raw.elements.len());
    let mut by_nodes: HashMap<Box<[u32]>, u32> = HashMap::with_capacity(raw.elements.len());
    let dimension = (0..raw.element_count()).map(|index| raw.element(index).1.dimension()).max().unwrap_or(0);
    for index in 0..raw.element_count() {
        let (tag, shape, tags) = raw.element(index);
        let place = raw.elements[index as usize].place;
        if let Some(node) = tags.iter().find(|tag| raw.node(**tag).is_none()) {
            faults.add("node", || {
                raw.problem(
                    place,
                    format!("element {tag} names node {node}, which the file does not have"),
                    "save the mesh with all its nodes",
                )
            });
            final_index.push(0);
            continue;
        }
        let nodes: Vec<u32> = tags.iter().filter_map(|tag| raw.node(*tag)).collect();
        if let Some(node) = nodes.iter().enumerate().find_map(|(k, node)| nodes[..k].contains(node).then_some(*node)) {
            faults.add("twice", || {
                raw.problem(
                    place,
                    format!("element {tag} has node {} twice", raw.nodes[node as usize].tag),
                    format!("{} has different nodes: mesh again", shape.words()),
                )
            });
        }
        let mut key: Box<[u32]> = nodes.as_slice().into();
        key.sort_unstable();
        let same_tag = by_tag.get(&tag).copied();
        let same_nodes = by_nodes.get(&key).copied().filter(|&other| elements[other as usize].shape == shape);
        match (same_tag, same_nodes) {
            (_, Some(other)) if raw.repeats_elements && same_tag.is_none_or(|same| same == other) => {
                by_tag.insert(tag, other);
                final_index.push(other);
                continue;
            }
            (Some(other), _) => faults.add("tag", || {
                raw.problem(
                    place,
                    format!("duplicate element {tag}{}", raw.first_at(elements[other as usize].place)),
                    "every element has a number of its own: renumber one of the two",
                )
            }),
            (None, Some(other)) if shape.dimension() == dimension.max(2) => faults.add("nodes", || {
                let other = &elements[other as usize];
                raw.problem(
                    place,
                    format!("element {tag} has the same nodes as element {}{}", other.tag, raw.first_at(other.place)),
                    "two elements on top of each other count twice: remove one of the two",
                )
            }),
            _ => {}
        }
        by_tag.insert(tag, elements.len() as u32);
        by_nodes.insert(key, elements.len() as u32);
        final_index.push(elements.len() as u32);
        let line_type = raw.elements[index as usize].line_type;
        elements.push(MeshElement { tag, shape, nodes, line_type, place });
    }
    faults.end()?;
    Ok((elements, final_index))
}

/// The nodes of the areas lie in one plane z = const.
fn in_one_plane(raw: &RawMesh, elements: &[MeshElement]) -> Result<(), Vec<MeshProblem>> {
    let areas = || elements.iter().filter(|element| element.shape.is_area());
    let Some(first) = areas().next().map(|element| element.nodes[0] as usize) else { return Ok(()) };
    let position = |node: u32| raw.nodes[node as usize].position;
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for node in areas().flat_map(|element| &element.nodes) {
        for (axis, x) in position(*node).into_iter().enumerate() {
            (low[axis], high[axis]) = (low[axis].min(x), high[axis].max(x));
        }
    }
    let size = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
    // Areas of smaller elements are too small for f64; coincident nodes have messages of their own.
    const SMALLEST: f64 = 1e-150;
    if size > 0.0 && size < SMALLEST {
        let message = format!("the mesh is {size:e} wide and high, which is too small to compute with");
        return Err(vec![raw.problem(
            Place::default(),
            message,
            "lengths are numbers from 1e-150: choose other units",
        )]);
    }
    let plane = raw.nodes[first].position[2];
    let mut faults = Faults::default();
    for element in areas() {
        if let Some(&node) = element.nodes.iter().find(|&&node| (position(node)[2] - plane).abs() > IN_PLANE * size) {
            faults.add("plane", || {
                raw.problem(
                    element.place,
                    format!(
                        "element {} lies outside the plane of the mesh: its node {} has z = {}, node {} has z = {plane}",
                        element.tag,
                        raw.nodes[node as usize].tag,
                        position(node)[2],
                        raw.nodes[first].tag
                    ),
                    "a structure lies in the x-y plane: every node has the same z",
                )
            });
        }
    }
    faults.end()
}

/// Turns clockwise areas and solids that are inside out round and says which; refuses those that enclose nothing. Areas
/// of a mesh that has solids are no elements, and have no sense.
fn judged(raw: &RawMesh, elements: &mut [MeshElement], dimension: u8) -> Result<Vec<bool>, Vec<MeshProblem>> {
    let mut faults = Faults::default();
    let mut turned = vec![false; elements.len()];
    for (element, turned) in elements.iter_mut().zip(&mut turned) {
        if element.shape.dimension() < dimension.max(2) {
            continue;
        }
        let positions: Vec<[f64; 3]> = element.nodes.iter().map(|node| raw.nodes[*node as usize].position).collect();
        let is_turned = if element.shape.is_solid() {
            element.shape.is_inside_out(&positions)
        } else {
            element.shape.is_clockwise(&positions.iter().map(|[x, y, _]| [*x, *y]).collect::<Vec<_>>())
        };
        match is_turned {
            Ok(false) => {}
            Ok(true) if element.shape.is_solid() => {
                element.nodes = element.shape.mirrored(&element.nodes);
                *turned = true;
            }
            Ok(true) => {
                element.nodes = element.shape.turned(&element.nodes);
                *turned = true;
            }
            Err(fault) => {
                let (kind, what, help) = said(raw, element, fault);
                faults.add(kind, || raw.problem(element.place, format!("element {} {what}", element.tag), help));
            }
        }
    }
    faults.end()?;
    Ok(turned)
}

fn said(raw: &RawMesh, element: &MeshElement, fault: ShapeFault) -> (&'static str, String, &'static str) {
    let tag = |k: usize| raw.nodes[element.nodes[k] as usize].tag;
    match fault {
        ShapeFault::Coincident(a, b) => (
            "coincident",
            format!("has no length between its nodes {} and {}, which are at the same place", tag(a), tag(b)),
            "remove the element, or join its neighbours over it",
        ),
        ShapeFault::BowTie => (
            "bow tie",
            "is a bow tie: two of its sides cross".into(),
            "list its corners in the order in which they go round",
        ),
        ShapeFault::NoArea if element.shape.is_solid() => (
            "volume",
            format!("is {} without volume: its corners lie in one plane", element.shape.words()),
            "a mesh of the plane has triangles and quadrilaterals; remove the element, or mesh again",
        ),
        ShapeFault::Folded if element.shape.is_solid() => (
            "folded",
            "is folded: its nodes are so far from their places that its Jacobian is not positive everywhere".into(),
            "list its nodes in the order of the format, or mesh again",
        ),
        ShapeFault::NoArea => {
            ("area", "has zero area: its corners lie on one line".into(), "remove the element, or mesh again")
        }
        ShapeFault::NotConvex => (
            "convex",
            "is not convex: a corner has 180° or more, so the Jacobian is not positive there".into(),
            "split it into triangles, or mesh again",
        ),
        ShapeFault::Folded => (
            "folded",
            "has middle nodes so far from the middle of their sides that its Jacobian is not positive everywhere"
                .into(),
            "move them to the middle half of their sides, or mesh with straight sides",
        ),
    }
}

/// Name and place of an empty group.
type Empty = (String, Place);

/// Groups that have members, lines, areas and solids apart; and those that have none.
fn groups(
    raw: &RawMesh,
    elements: &[MeshElement],
    final_index: &[u32],
    turned: &[bool],
) -> Result<(Vec<Group>, Vec<Empty>), MeshProblem> {
    let (mut groups, mut empty) = (Vec::new(), Vec::new());
    for group in &raw.groups {
        let name = group.name.clone().unwrap_or_else(|| group.number.to_string());
        let nodes = |tags: &[u64]| -> Result<Vec<u32>, MeshProblem> {
            let found = tags.iter().map(|&tag| {
                raw.node(tag).ok_or_else(|| {
                    raw.problem(
                        group.place,
                        format!("the group \"{name}\" names node {tag}, which the file does not have"),
                        "save the mesh with all its nodes",
                    )
                })
            });
            Ok(once(found.collect::<Result<Vec<u32>, MeshProblem>>()?))
        };
        let all = match &group.members {
            RawMembers::Points(tags) => vec![Members::Points(nodes(tags)?)],
            RawMembers::NodeSet(tags) => vec![Members::NodeSet(nodes(tags)?)],
            RawMembers::Elements(indices) => {
                let indices = once(indices.iter().map(|&index| final_index[index as usize]).collect());
                let of = |dimension: u8| -> Vec<u32> {
                    let fits = |index: &&u32| elements[**index as usize].shape.dimension() == dimension;
                    indices.iter().filter(fits).copied().collect()
                };
                vec![Members::Lines(of(1)), Members::Areas(of(2)), Members::Solids(of(3))]
            }
            RawMembers::Sides(sides) => {
                let side = |&(index, corner): &(u32, Option<u8>)| {
                    let index = final_index[index as usize];
                    let shape = elements[index as usize].shape;
                    let turned_side = |k: u8| match shape.is_solid() {
                        true => shape.mirrored_face(k as usize) as u8,
                        false => shape.corners() as u8 - 1 - k,
                    };
                    let corner = corner.map(|k| if turned[index as usize] { turned_side(k) } else { k });
                    (index, corner)
                };
                vec![Members::Sides(once(sides.iter().map(side).collect()))]
            }
        };
        if all.iter().all(|members| members.count() == 0) {
            empty.push((name.clone(), group.place));
        }
        groups.extend(all.into_iter().filter(|members| members.count() > 0).map(|members| Group {
            name: name.clone(),
            is_named: group.name.is_some(),
            members,
            place: group.place,
        }));
    }
    Ok((groups, empty))
}

/// Each member once, in the order of the first time.
fn once<T: Copy + Eq + std::hash::Hash>(members: Vec<T>) -> Vec<T> {
    let mut seen = std::collections::HashSet::with_capacity(members.len());
    members.into_iter().filter(|member| seen.insert(*member)).collect()
}
