//! `meshes`: files of other programs, and which of their groups are what.

use std::path::Path;
use std::sync::Arc;

use super::bars::{bar_kind, section_of};
use super::bricks::solid_material;
use super::builder::{Builder, id_of, material_of};
use super::plates::{membrane, modes};
use super::reader::{Cursor, Entry, Fields};
use super::words::{counted, did_you_mean, listed, quoted};
use crate::model::mesh::{self, Group, LineType, Members, Mesh, Shape};
use crate::model::structure::{Dimension, ElementKind};

/// The key for elements in no group.
const REST: &str = "*";

/// What a group of areas or solids is made of.
#[derive(Clone, PartialEq)]
pub struct Part {
    pub material: usize,
    /// Incompatible modes are taken by the elements that can have them.
    pub kind: ElementKind,
}

/// A group of lines that are bars.
pub struct Lines<'d> {
    pub group: String,
    pub material: usize,
    pub section: &'d str,
    /// Index and kind of each line.
    pub lines: Vec<(u32, ElementKind)>,
}

/// A mesh before its nodes are known.
pub struct MeshOutline<'d> {
    pub cursor: Cursor<'d>,
    pub id: &'d str,
    pub mesh: Arc<Mesh>,
    pub scale: f64,
    /// For each element of the file what it is made of; `None` for what is not a part of a body.
    pub parts: Vec<Option<Part>>,
    /// Groups of lines that are bars.
    pub bars: Vec<Lines<'d>>,
}

impl MeshOutline<'_> {
    fn used_elements(&self) -> impl Iterator<Item = u32> {
        let parts = (0..).zip(&self.parts).filter(|(_, part)| part.is_some()).map(|(index, _)| index);
        parts.chain(self.bars.iter().flat_map(|bars| bars.lines.iter().map(|(index, _)| *index)))
    }

    /// Nodes it will have.
    pub fn node_count(&self) -> f64 {
        self.used_nodes().iter().filter(|used| **used).count() as f64
    }

    /// Which nodes of the file it will have.
    pub fn used_nodes(&self) -> Vec<bool> {
        let mut used = vec![false; self.mesh.nodes.len()];
        for element in self.used_elements() {
            for node in &self.mesh.elements[element as usize].nodes {
                used[*node as usize] = true;
            }
        }
        used
    }
}

/// Reads one mesh.
pub fn outline<'d>(builder: &mut Builder<'d>, cursor: Cursor<'d>) -> Option<MeshOutline<'d>> {
    let fields = cursor.fields(&["id", "file", "scale", "materials"])?;
    let id = id_of(builder, &fields, "mesh");
    let outline = read_outline(builder, cursor, &fields, id);
    if outline.is_none() {
        builder.broken.extend(id);
    }
    outline
}

fn read_outline<'d>(
    builder: &Builder<'d>,
    cursor: Cursor<'d>,
    fields: &Fields<'d>,
    id: Option<&'d str>,
) -> Option<MeshOutline<'d>> {
    let file = fields.required("file");
    let mesh = file.and_then(mesh_of);
    let scale = match fields.optional("scale") {
        Some(at) => at.positive("scale"),
        None => Some(1.0),
    };
    let materials = fields.required("materials")?;
    let Some(mesh) = mesh else {
        // Where the file cannot be read, only the values can be checked.
        for entry in materials.entries()? {
            let _ = entry.value().entries();
        }
        return None;
    };
    let dimension = builder.structure.dimension;
    if let Some(at) = file.filter(|_| mesh.is_solid() != (dimension == Dimension::Space)) {
        wrong_dimension(at, &mesh);
        return None;
    }
    let mut outline = MeshOutline {
        cursor,
        id: id.unwrap_or_default(),
        scale: scale.unwrap_or(1.0),
        parts: vec![None; mesh.elements.len()],
        bars: Vec::new(),
        mesh,
    };
    let is_right = groups(builder, &mut outline, materials)?;
    (is_right && id.is_some() && scale.is_some()).then_some(outline)
}

/// A mesh of solids in the plane, or one without in space.
fn wrong_dimension(at: Cursor<'_>, mesh: &Mesh) {
    let file = &mesh.files[0];
    match mesh.of_bodies().next().filter(|_| mesh.is_solid()) {
        Some(first) => {
            let element = &mesh.elements[first as usize];
            at.problem(
                format!(
                    "{}: element {} is {}, and the structure lies in the plane",
                    mesh.at(element.place),
                    element.tag,
                    element.shape.words()
                ),
                "put it into space with \"dimension\": 3, or mesh a surface and save no volumes",
            );
        }
        None => at.problem(
            format!("{file} has no solids, and the structure lies in space"),
            "mesh the volume with tetrahedra or hexahedra and save them",
        ),
    }
}

/// The mesh that a name means, from what was read before or from its file beside the scenario.
fn mesh_of(at: Cursor<'_>) -> Option<Arc<Mesh>> {
    let name = at.string()?;
    let mut known = at.reading.meshes.borrow_mut();
    if let Some(mesh) = known.0.get(name) {
        return Some(Arc::clone(mesh));
    }
    let Some(scenario) = &at.reading.path else {
        at.problem(
            "a scenario without a file of its own cannot name another file",
            "save the scenario to a file beside the mesh",
        );
        return None;
    };
    match mesh::read(&scenario.parent().unwrap_or(Path::new("")).join(name), name) {
        Ok(mesh) => {
            let mesh = Arc::new(mesh);
            known.0.insert(name.to_owned(), Arc::clone(&mesh));
            Some(mesh)
        }
        Err(found) => {
            for problem in found {
                at.problem(format!("{}: {}", problem.place(), problem.message), problem.help);
            }
            None
        }
    }
}

/// What each group is made of; `Some(false)` if a group or an element has no place.
fn groups<'d>(builder: &Builder<'d>, outline: &mut MeshOutline<'d>, materials: Cursor<'d>) -> Option<bool> {
    let mut is_right = true;
    let mut rest = None;
    // Index of the entry that gave an element its material.
    let mut given: Vec<Option<&'d str>> = vec![None; outline.mesh.elements.len()];
    for entry in materials.entries()? {
        let is_line = entry.value().has_key("section") || entry.value().has_key("kind");
        if entry.name() == REST {
            match part(builder, entry) {
                Some(part) => {
                    let all: Vec<u32> = outline.mesh.of_bodies().collect();
                    is_right &= takes_modes(&outline.mesh, entry, &part, &all);
                    rest = Some(part);
                }
                None => is_right = false,
            }
            continue;
        }
        let mesh = Arc::clone(&outline.mesh);
        let Some(group) = group_of(&mesh, &entry, is_line) else {
            is_right = false;
            continue;
        };
        match &group.members {
            Members::Lines(lines) => match lines_of(builder, &mesh, entry, group, lines) {
                Some(of) => outline.bars.push(of),
                None => is_right = false,
            },
            Members::Areas(of_body) | Members::Solids(of_body) => match part(builder, entry) {
                Some(of) => {
                    is_right &= takes_modes(&mesh, entry, &of, of_body);
                    is_right &= give(outline, entry, of, of_body, &mut given);
                }
                None => is_right = false,
            },
            _ => is_right = false,
        }
    }
    if is_right {
        is_right = is_complete(outline, materials, rest);
    }
    Some(is_right)
}

/// The group of a key, lines or areas.
fn group_of<'m>(mesh: &'m Mesh, entry: &Entry<'_>, is_line: bool) -> Option<&'m Group> {
    let name = entry.name();
    let fits = |group: &Group| match group.members {
        Members::Lines(_) => is_line,
        _ => !is_line && mesh.is_body(group),
    };
    let all: Vec<&Group> = mesh.groups.iter().filter(|group| mesh.same_name(&group.name, name)).collect();
    if let Some(group) = all.iter().find(|group| fits(group)) {
        return Some(group);
    }
    let file = &mesh.files[0];
    match all.first() {
        Some(group) => entry.key_problem(
            format!(
                "the group {} of {file} consists of {}, not of {}",
                quoted(name),
                group.members.what(),
                match (is_line, mesh.is_solid()) {
                    (true, _) => "lines",
                    (_, true) => "solids",
                    _ => "elements",
                }
            ),
            match mesh.is_solid() {
                true => "a group of solids gets `material`; areas on their surface are faces and need none",
                false => {
                    "a group of elements gets `material`, `thickness` and `plane`, a group of lines `material` and \
                     `section`"
                }
            },
        ),
        None if mesh.empty_group(name).is_some() => entry.key_problem(
            format!("the group {} of {file} is empty: nothing of the mesh is in it", quoted(name)),
            "remove it here, or put elements into it",
        ),
        None => {
            let known = mesh
                .groups
                .iter()
                .filter(|group| mesh.is_body(group) || matches!(group.members, Members::Lines(_)) && !mesh.is_solid());
            let known: Vec<&str> = known.map(|group| group.name.as_str()).collect();
            entry.key_problem(
                format!("{file} has no group {}{}", quoted(name), did_you_mean(name, known.iter().copied())),
                match known[..] {
                    [] => "it has no groups of elements: give all of them the material of \"*\"".to_owned(),
                    _ => format!("expected {} (or \"*\" for elements in no group)", listed(&known)),
                },
            );
        }
    }
    None
}

fn part<'d>(builder: &Builder<'d>, entry: Entry<'d>) -> Option<Part> {
    if builder.structure.dimension == Dimension::Space {
        let fields = entry.value().fields(&["material", "element"])?;
        let material = solid_material(builder, &fields);
        let incompatible = modes(&fields)?;
        return Some(Part { material: material?, kind: ElementKind::Solid { incompatible } });
    }
    let fields = entry.value().fields(&["material", "thickness", "plane", "element"])?;
    let common = membrane(builder, &fields);
    let incompatible = modes(&fields)?;
    let (thickness, material, plane) = common?;
    Some(Part { material, kind: ElementKind::Membrane { thickness, plane, incompatible } })
}

/// Incompatible modes are those of quadrilaterals of four nodes and hexahedra of eight.
fn takes_modes(mesh: &Mesh, entry: Entry<'_>, of: &Part, members: &[u32]) -> bool {
    let can = |index: &u32| mesh.elements[*index as usize].shape.can_be_incompatible();
    let takes = !of.kind.is_incompatible() || members.iter().any(can);
    if !takes {
        entry.key_problem(
            format!(
                "{} has no {}, which alone can be \"incompatible\"",
                if entry.name() == REST {
                    "the mesh".to_owned()
                } else {
                    format!("the group {}", quoted(entry.name()))
                },
                if mesh.is_solid() { "hexahedra of eight nodes" } else { "elements of four nodes" }
            ),
            "remove `element`",
        );
    }
    takes
}

/// Gives the members of a group their material; an element in two groups has the same in both.
fn give<'d>(
    outline: &mut MeshOutline<'d>,
    entry: Entry<'d>,
    of: Part,
    members: &[u32],
    given: &mut [Option<&'d str>],
) -> bool {
    for index in members {
        let index = *index as usize;
        match (&outline.parts[index], given[index]) {
            (Some(other), Some(first)) if *other != of => {
                let element = &outline.mesh.elements[index];
                entry.key_problem(
                    format!(
                        "{}: element {} is in the groups {} and {}, which are made of different things",
                        outline.mesh.at(element.place),
                        element.tag,
                        quoted(first),
                        quoted(entry.name())
                    ),
                    match outline.mesh.is_solid() {
                        true => "give both the same material and element, or name one of them only",
                        false => "give both the same material, thickness, plane and element, or name one of them only",
                    },
                );
                return false;
            }
            _ => (outline.parts[index], given[index]) = (Some(of.clone()), Some(entry.name())),
        }
    }
    true
}

/// Whether every element has a material; those in no group get that of `rest`.
fn is_complete(outline: &mut MeshOutline<'_>, materials: Cursor<'_>, rest: Option<Part>) -> bool {
    let mesh = Arc::clone(&outline.mesh);
    let mut is_right = true;
    let mut named = vec![false; mesh.elements.len()];
    let example = match mesh.is_solid() {
        true => "{ \"material\": … }",
        false => "{ \"material\": …, \"thickness\": …, \"plane\": … }",
    };
    for group in mesh.groups.iter().filter(|group| group.is_named && mesh.is_body(group)) {
        let (Members::Areas(members) | Members::Solids(members)) = &group.members else { continue };
        let without = |index: &&u32| outline.parts[**index as usize].is_none() && !named[**index as usize];
        let first = members.iter().find(without).copied();
        let count = members.iter().filter(without).count();
        if let Some(first) = first {
            let element = &mesh.elements[first as usize];
            materials.problem(
                format!(
                    "{}: the group {} has no material: {} in it without one, the first is element {} ({})",
                    mesh.at(group.place),
                    quoted(&group.name),
                    counted(count, "element is", "elements are"),
                    element.tag,
                    mesh.at(element.place)
                ),
                format!("add {}: {example}", quoted(&group.name)),
            );
            is_right = false;
        }
        members.iter().for_each(|index| named[*index as usize] = true);
    }
    let mut bare = mesh.of_bodies().filter(|index| outline.parts[*index as usize].is_none() && !named[*index as usize]);
    match (rest, bare.next()) {
        (_, None) => {}
        (Some(rest), Some(first)) => {
            for index in std::iter::once(first).chain(bare).collect::<Vec<u32>>() {
                outline.parts[index as usize] = Some(rest.clone());
            }
        }
        (None, Some(first)) => {
            let element = &mesh.elements[first as usize];
            let count = 1 + bare.count();
            materials.problem(
                format!(
                    "{}: element {} is in no group that has a material{}",
                    mesh.at(element.place),
                    element.tag,
                    if count > 1 { format!(" (and {} more)", count - 1) } else { String::new() }
                ),
                format!("add \"*\": {example} for the elements in no group"),
            );
            is_right = false;
        }
    }
    is_right
}

/// What bars of a group of lines are.
fn lines_of<'d>(
    builder: &Builder<'d>,
    mesh: &Mesh,
    entry: Entry<'d>,
    group: &Group,
    lines: &[u32],
) -> Option<Lines<'d>> {
    let fields = entry.value().fields(&["material", "section", "kind"])?;
    if mesh.is_solid() {
        entry.key_problem(
            format!(
                "the group {} consists of lines, and bars beside solids are not read from a mesh",
                quoted(entry.name())
            ),
            "put the bars under `bars`, between nodes of the mesh",
        );
        return None;
    }
    let material = material_of(builder, &fields);
    let section = section_of(builder, &fields);
    let is_frame = match fields.optional("kind") {
        Some(at) => at.choice(&[("frame", Some(true)), ("truss", Some(false))]),
        None => Some(None),
    };
    let (at, section, data) = section?;
    let (material, is_frame) = (material?, is_frame?);
    let plane = mesh.nodes[mesh.elements[lines[0] as usize].nodes[0] as usize].position[2];
    let mut kinds = Vec::with_capacity(lines.len());
    for &index in lines {
        let line = &mesh.elements[index as usize];
        let [a, b] = [0, 1].map(|end| mesh.nodes[line.nodes[end] as usize].position);
        let wrong = if line.shape == Shape::Line3 {
            Some(("has three nodes", "bars have two: mesh the lines linearly"))
        } else if a[..2] == b[..2] {
            Some(("has no length", "remove the line"))
        } else if (a[2] - plane).abs().max((b[2] - plane).abs()) > 1e-8 * (b[0] - a[0]).hypot(b[1] - a[1]) {
            Some(("is not in the plane of the mesh", "a structure lies in the x-y plane"))
        } else {
            None
        };
        if let Some((what, help)) = wrong {
            entry.key_problem(
                format!("{}: element {} of the group {} {what}", mesh.at(line.place), line.tag, quoted(&group.name)),
                help,
            );
            return None;
        }
        let is_frame = is_frame.unwrap_or(line.line_type == LineType::Beam);
        kinds.push((index, bar_kind(at, section, data, is_frame, [false; 2], None)?));
    }
    Some(Lines { group: group.name.clone(), material, section, lines: kinds })
}
