//! Bars: read first, divided once every other node is known.

use std::sync::Arc;

use super::builder::{Builder, Section, id_of, material_of};
use super::reader::{Cursor, Fields};
use crate::model::structure::{Bar, Element, ElementKind, Node};

/// A bar before its division.
pub struct BarOutline<'d> {
    pub cursor: Cursor<'d>,
    id: &'d str,
    section: &'d str,
    /// The nodes of the file along it: two, or those of its `polyline`.
    nodes: Vec<Cursor<'d>>,
    /// Of each segment between them.
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
    let fields = cursor.fields(&["id", "nodes", "polyline", "kind", "material", "section", "divisions", "hinges"])?;
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
    let kind = bar_kind(at, name, section, is_frame, hinges?)?;
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
) -> Option<ElementKind> {
    if !is_frame {
        return Some(ElementKind::Truss { area: section.area });
    }
    let Some(inertia) = section.inertia else {
        at.problem(
            format!("the section \"{name}\" has no `inertia`, which a frame bar needs"),
            format!("add sections.{name}.inertia, or make the bar a truss"),
        );
        return None;
    };
    Some(ElementKind::Frame { area: section.area, inertia, shear_area: section.shear_area, hinges })
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
pub fn divide<'d>(builder: &mut Builder<'d>, bar: BarOutline<'d>, place: Arc<str>) {
    let nodes: Vec<Option<usize>> = bar.nodes.iter().map(|&node| builder.node(node)).collect();
    let Some(nodes) = nodes.into_iter().collect::<Option<Vec<usize>>>() else {
        builder.broken.insert(bar.id);
        return;
    };
    let mut chain = vec![nodes[0]];
    for ends in nodes.windows(2) {
        let [from, to] = [0, 1].map(|end| builder.structure.nodes[ends[end]].position);
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let size = [from[0], from[1], to[0], to[1]].iter().fold(0.0_f64, |size, x| size.max(x.abs()));
        // Written so that an unknown place (NaN, reported at the node) passes.
        if ends[0] == ends[1] || length <= 1e-12 * size {
            let what = if nodes.len() == 2 {
                format!("the bar \"{}\" has no length: both ends are", bar.id)
            } else {
                format!("a segment of the bar \"{}\" has no length: both its ends are", bar.id)
            };
            bar.cursor.problem(format!("{what} at ({}, {})", from[0], from[1]), "join two nodes at different places");
            builder.broken.insert(bar.id);
            return;
        }
        for inner in 1..bar.divisions {
            let t = inner as f64 / bar.divisions as f64;
            let node = Node {
                id: format!("{}/{}", bar.id, chain.len()),
                position: std::array::from_fn(|c| from[c] + t * (to[c] - from[c])),
            };
            chain.push(builder.add_node(node, place.clone()));
        }
        chain.push(ends[1]);
    }
    let first = builder.structure.elements.len();
    let last = chain.len() - 2;
    for (index, pair) in chain.windows(2).enumerate() {
        let mut kind = bar.kind.clone();
        if let ElementKind::Frame { hinges, .. } = &mut kind {
            // A hinge stays only at the end of the bar that has it.
            hinges[0] &= index == 0;
            hinges[1] &= index == last;
        }
        builder.structure.elements.push(Element { nodes: pair.to_vec(), material: bar.material, kind });
        builder.places.elements.push(place.clone());
    }
    builder.bars.insert(bar.id.into(), builder.structure.bars.len());
    builder.bar_sections.push(bar.section);
    builder.structure.bars.push(Bar { id: bar.id.to_string(), elements: first..builder.structure.elements.len() });
}
