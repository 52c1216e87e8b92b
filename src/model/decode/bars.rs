//! Bars: read first, divided once every other node is known.

use std::sync::Arc;

use super::builder::{Bending, Builder, Section, id_of, material_of};
use super::reader::{Cursor, Fields};
use crate::model::bar_axes::{AxesFault, BarAxes};
use crate::model::grid::HIDDEN_SIDE;
use crate::model::space_section::EndJoint;
use crate::model::structure::{Bar, Dimension, Element, ElementKind};
use crate::model::vector::distance;
use crate::text::number::short;

/// A bar before its division.
pub struct BarOutline<'d> {
    pub cursor: Cursor<'d>,
    id: &'d str,
    section: &'d str,
    /// The nodes of the file along it: two, or those of its `polyline`.
    nodes: Vec<Cursor<'d>>,
    /// Elements of each segment between them.
    divisions: usize,
    material: usize,
    kind: ElementKind,
}

impl BarOutline<'_> {
    /// Elements it will have.
    pub fn element_count(&self) -> f64 {
        self.divisions as f64 * (self.nodes.len() - 1) as f64
    }
}

/// Reads one bar; its nodes are resolved by [`divide`], once those of the plates are known.
pub fn bar<'d>(builder: &mut Builder<'d>, cursor: Cursor<'d>) -> Option<BarOutline<'d>> {
    const KEYS: [&str; 9] =
        ["id", "nodes", "polyline", "kind", "material", "section", "divisions", "hinges", "orientation"];
    let fields = match cursor.dimension() {
        Dimension::Plane => cursor.fields(&KEYS[..8])?,
        Dimension::Space => cursor.fields(&KEYS)?,
    };
    let id = id_of(builder, &fields, "bar");
    let outline = bar_outline(builder, cursor, &fields, id);
    if outline.is_none() {
        builder.broken.extend(id);
        // The rest of the entry is wrong, but its nodes are looked up all the same.
        let ends = fields.optional("nodes").or(fields.optional("polyline"));
        let ends = ends.filter(|nodes| nodes.is_list()).and_then(Cursor::list);
        builder.ends_of_broken_bars.extend(ends.into_iter().flatten().filter(|end| end.is_string()));
    }
    outline
}

fn bar_outline<'d>(
    builder: &Builder<'d>,
    cursor: Cursor<'d>,
    fields: &Fields<'d>,
    id: Option<&'d str>,
) -> Option<BarOutline<'d>> {
    let nodes = line(fields);
    let is_frame = match fields.optional("kind") {
        Some(cursor) => cursor.choice(&[("frame", true), ("truss", false)]),
        None => Some(true),
    };
    let material = material_of(builder, fields);
    let divisions = match fields.optional("divisions") {
        Some(cursor) => cursor.whole("divisions", 1),
        None => Some(1),
    };
    let hinges = match fields.optional("hinges") {
        Some(cursor) => hinges(cursor),
        None => Some([false; 2]),
    };
    let orientation = match fields.optional("orientation") {
        Some(cursor) => cursor.direction("orientation").map(Some),
        None => Some(None),
    };
    let section = section_of(builder, fields);
    let is_frame = is_frame?;
    if !is_frame && fields.entry("polyline").is_some() {
        fields.refuse(
            &["polyline"],
            |_| "a truss bar cannot be a `polyline`: its inner nodes would move sideways freely".into(),
            "make a bar of each segment, or make it a frame",
        );
        return None;
    }
    if !is_frame
        && let (Some(count), Some(at)) = (divisions, fields.optional("divisions"))
        && count > 1
    {
        at.problem(
            format!("a truss bar cannot be divided, found {count} divisions"),
            "its inner nodes would move sideways freely: remove `divisions`, or make it a frame",
        );
        return None;
    }
    if !is_frame && hinges.is_some_and(|hinges| hinges != [false; 2]) {
        fields.refuse(
            &["hinges"],
            |_| "a truss bar has no `hinges`: it is hinged at both ends".into(),
            "remove it, or make the bar a frame",
        );
        return None;
    }
    let (at, name, section) = section?;
    let kind = bar_kind(at, name, section, is_frame, hinges?, orientation?)?;
    Some(BarOutline { cursor, id: id?, section: name, nodes: nodes?, divisions: divisions?, material: material?, kind })
}

/// Where a section is named, its name and the section.
pub fn section_of<'b, 'd>(builder: &'b Builder<'d>, fields: &Fields<'d>) -> Option<(Cursor<'d>, &'d str, &'b Section)> {
    let cursor = fields.required("section")?;
    let name = cursor.string()?;
    let section = builder.sections.get(name);
    if section.is_none() {
        let mut known: Vec<&str> = builder.sections.keys().copied().collect();
        known.sort_unstable();
        cursor.unknown("section", name, &known);
    }
    Some((cursor, name, section?))
}

/// What an element of a bar is; a section that does not suffice is reported.
pub fn bar_kind(
    at: Cursor<'_>,
    name: &str,
    section: &Section,
    is_frame: bool,
    hinges: [bool; 2],
    orientation: Option<[f64; 3]>,
) -> Option<ElementKind> {
    let area = section.area;
    if !is_frame {
        return Some(match at.dimension() {
            Dimension::Plane => ElementKind::Truss { area },
            Dimension::Space => ElementKind::SpaceTruss { area, orientation },
        });
    }
    match section.bending {
        Some(Bending::Plane { inertia, shear_area }) => Some(ElementKind::Frame { area, inertia, shear_area, hinges }),
        Some(Bending::Space(section)) => {
            let joints = hinges.map(|hinge| if hinge { EndJoint::Hinge } else { EndJoint::Rigid });
            Some(ElementKind::SpaceFrame { section, orientation, joints })
        }
        None => {
            let (needs, first) = match at.dimension() {
                Dimension::Plane => ("no `inertia`, which a frame bar needs", "inertia"),
                Dimension::Space => ("no `inertia_y`, `inertia_z` and `torsion`, which a frame bar needs", "inertia_y"),
            };
            at.problem(
                format!("the section \"{name}\" has {needs}"),
                format!("add sections.{name}.{first}, or make the bar a truss"),
            );
            None
        }
    }
}

/// The nodes along a bar: `nodes`, start and end, or `polyline`.
fn line<'d>(fields: &Fields<'d>) -> Option<Vec<Cursor<'d>>> {
    let Some(polyline) = fields.entry("polyline") else {
        let ends = fields.required("nodes")?.list_of(2, "the nodes at start and end")?;
        return Some(ends.collect());
    };
    if fields.entry("nodes").is_some() {
        polyline.key_problem("`polyline` cannot stand beside `nodes`", "give one of the two");
        return None;
    }
    let nodes: Vec<Cursor<'d>> = polyline.value().list()?.collect();
    if nodes.len() < 2 {
        polyline.value().problem(
            format!("a polyline needs two or more nodes, found {}", nodes.len()),
            "name the nodes from the start of the bar to its end",
        );
        return None;
    }
    Some(nodes)
}

fn hinges(cursor: Cursor<'_>) -> Option<[bool; 2]> {
    let mut hinges = [false; 2];
    for entry in cursor.list()? {
        let end = entry.choice(&[("start", 0), ("end", 1)])?;
        hinges[end] = true;
    }
    Some(hinges)
}

/// Resolves the nodes of a bar and appends its inner nodes and elements. The node before element k is `ID/k` unless the
/// file names it.
pub fn divide<'d>(builder: &mut Builder<'d>, bar: BarOutline<'d>, place: &Arc<str>) {
    let nodes: Vec<Option<usize>> = bar.nodes.iter().map(|&node| builder.node(node)).collect();
    let Some(nodes) = nodes.into_iter().collect::<Option<Vec<usize>>>() else {
        builder.broken.insert(bar.id);
        return;
    };
    let mut chain = vec![nodes[0]];
    for ends in nodes.windows(2) {
        let [from, to] = [0, 1].map(|end| builder.structure.nodes[ends[end]].position);
        let length = distance(from, to);
        let size = from.iter().chain(&to).fold(0.0_f64, |size, x| size.max(x.abs()));
        // Written so that an unknown place (NaN, reported at the node) passes.
        if ends[0] == ends[1] || length <= HIDDEN_SIDE * size {
            let part = if nodes.len() == 2 { "" } else { "a segment of " };
            let at = builder.structure.dimension.in_words(from);
            let (what, help) = if ends[0] == ends[1] || length == 0.0 {
                let both = if nodes.len() == 2 { "both ends are" } else { "both its ends are" };
                (format!("has no length: {both} at {at}"), "join two nodes at different places")
            } else {
                let what = format!("is only {} long, 1e-12 of its distance from the origin or less", short(length));
                (what, "put the origin of the coordinates near the structure")
            };
            bar.cursor.problem(format!("{part}the bar \"{}\" {what}", bar.id), help);
            builder.broken.insert(bar.id);
            return;
        }
        for inner in 1..bar.divisions {
            let t = inner as f64 / bar.divisions as f64;
            let id = format!("{}/{}", bar.id, chain.len());
            let position = std::array::from_fn(|c| from[c] + t * (to[c] - from[c]));
            chain.push(builder.add_node(id, position));
        }
        chain.push(ends[1]);
    }
    let first = builder.structure.elements.len();
    let last = chain.len() - 2;
    for (index, pair) in chain.windows(2).enumerate() {
        let mut kind = bar.kind.clone();
        // A hinge stays only at the end of the bar that has it.
        let is_end = [index == 0, index == last];
        match &mut kind {
            ElementKind::Frame { hinges, .. } => {
                hinges.iter_mut().zip(is_end).for_each(|(hinge, is_end)| *hinge &= is_end);
            }
            ElementKind::SpaceFrame { joints, .. } => {
                let inner = joints.iter_mut().zip(is_end).filter(|(_, is_end)| !is_end);
                inner.for_each(|(joint, _)| *joint = EndJoint::Rigid);
            }
            _ => {}
        }
        if let ElementKind::SpaceFrame { orientation, .. } | ElementKind::SpaceTruss { orientation, .. } = &kind {
            let ends = [0, 1].map(|end| builder.structure.nodes[pair[end]].position);
            // A node without a usable place was reported.
            let are_placed = ends.iter().flatten().all(|coordinate| coordinate.is_finite());
            if are_placed && BarAxes::<f64>::in_space(ends, *orientation).err() == Some(AxesFault::Orientation) {
                bar.cursor.problem(
                    format!("the orientation of the bar \"{}\" points along it, and should lie across it", bar.id),
                    "give a vector in its local x–y plane, on the side of +y",
                );
                builder.broken.insert(bar.id);
                return;
            }
        }
        builder.structure.elements.push(Element { nodes: pair.to_vec(), material: bar.material, kind });
        builder.places.elements.push(place.clone());
    }
    builder.bars.insert(bar.id.into(), builder.structure.bars.len());
    builder.bar_sections.push(bar.section);
    builder.structure.bars.push(Bar { id: bar.id.to_string(), elements: first..builder.structure.elements.len() });
}
