//! Bars: read first, divided once every other node is known.

use std::sync::Arc;

use super::elements::{id_of, material_of};
use super::reader::{Cursor, Fields};
use super::structure::Builder;
use crate::model::structure::{Bar, Element, ElementKind, Node};

/// A bar before its division.
pub struct BarOutline<'d> {
    pub cursor: Cursor<'d>,
    id: &'d str,
    ends: [Cursor<'d>; 2],
    pub divisions: usize,
    material: usize,
    kind: ElementKind,
}

/// Reads one bar; its nodes are resolved by [`divide`], once those of the plates are known.
pub fn bar<'d>(builder: &mut Builder<'d>, cursor: Cursor<'d>) -> Option<BarOutline<'d>> {
    let fields = cursor.fields(&["id", "nodes", "kind", "material", "section", "divisions", "hinges"])?;
    let id = id_of(builder, &fields, "bar");
    let outline = bar_outline(builder, cursor, &fields, id);
    if outline.is_none() {
        builder.broken.extend(id);
        // The rest of the entry is wrong, but its nodes are looked up all the same.
        let ends = fields.optional("nodes").filter(|nodes| nodes.is_list()).and_then(Cursor::list);
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
    let ends = fields.required("nodes").and_then(|nodes| {
        let ends = nodes.list_of(2, "the nodes at start and end")?;
        <[Cursor<'d>; 2]>::try_from(ends.collect::<Vec<_>>()).ok()
    });
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
    let section = fields.required("section").and_then(|cursor| {
        let name = cursor.string()?;
        let section = builder.sections.get(name);
        if section.is_none() {
            let mut known: Vec<&str> = builder.sections.keys().copied().collect();
            known.sort_unstable();
            cursor.unknown("section", name, &known);
        }
        Some((cursor, name, section?))
    });
    let is_frame = is_frame?;
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
    let kind = if is_frame {
        let Some(inertia) = section.inertia else {
            at.problem(
                format!("the section \"{name}\" has no `inertia`, which a frame bar needs"),
                format!("add sections.{name}.inertia, or make the bar a truss"),
            );
            return None;
        };
        ElementKind::Frame { area: section.area, inertia, shear_area: None, hinges: hinges? }
    } else {
        ElementKind::Truss { area: section.area }
    };
    Some(BarOutline { cursor, id: id?, ends: ends?, divisions: divisions?, material: material?, kind })
}

fn hinges(cursor: Cursor<'_>) -> Option<[bool; 2]> {
    let mut hinges = [false; 2];
    for entry in cursor.list()? {
        let end = entry.choice(&[("start", 0), ("end", 1)])?;
        hinges[end] = true;
    }
    Some(hinges)
}

/// Resolves the ends of a bar and appends its inner nodes and elements.
pub fn divide<'d>(builder: &mut Builder<'d>, bar: BarOutline<'d>, place: Arc<str>) {
    let ends = [builder.node(bar.ends[0]), builder.node(bar.ends[1])];
    let [Some(start), Some(end)] = ends else {
        builder.broken.insert(bar.id);
        return;
    };
    let (from, to) = (builder.structure.nodes[start].position, builder.structure.nodes[end].position);
    let length = (to[0] - from[0]).hypot(to[1] - from[1]);
    let size = [from[0], from[1], to[0], to[1]].iter().fold(0.0_f64, |size, x| size.max(x.abs()));
    // Written so that an unknown place (NaN, reported at the node) passes.
    if start == end || length <= 1e-12 * size {
        bar.cursor.problem(
            format!("the bar \"{}\" has no length: both ends are at ({}, {})", bar.id, from[0], from[1]),
            "join two nodes at different places",
        );
        builder.broken.insert(bar.id);
        return;
    }
    let mut chain = vec![start];
    for inner in 1..bar.divisions {
        let t = inner as f64 / bar.divisions as f64;
        let node = Node {
            id: format!("{}/{inner}", bar.id),
            position: [from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])],
        };
        chain.push(builder.add_node(node, place.clone()));
    }
    chain.push(end);
    let first = builder.structure.elements.len();
    for (index, pair) in chain.windows(2).enumerate() {
        let mut kind = bar.kind.clone();
        if let ElementKind::Frame { hinges, .. } = &mut kind {
            // A hinge stays only at the end of the bar that has it.
            hinges[0] &= index == 0;
            hinges[1] &= index + 1 == bar.divisions;
        }
        builder.structure.elements.push(Element { nodes: pair.to_vec(), material: bar.material, kind });
        builder.places.elements.push(place.clone());
    }
    builder.bars.insert(bar.id, builder.structure.bars.len());
    builder.structure.bars.push(Bar { id: bar.id.to_string(), elements: first..builder.structure.elements.len() });
}
