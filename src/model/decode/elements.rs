//! Materials, sections, bars, plates and quads.

use std::sync::Arc;

use super::reader::{Cursor, Fields};
use super::structure::{Builder, Section};
use super::words::{ID_RULE, is_id, quoted};
use crate::model::memory;
use crate::model::mesh::{GridLines, PlateGrid};
use crate::model::structure::{Bar, Element, ElementKind, Material, Node, Plane, Plate, Structure};

/// Reads everything that makes elements. `None` if the mesh would be too large to go on.
pub fn read<'d>(builder: &mut Builder<'d>, fields: &Fields<'d>) -> Option<()> {
    materials(builder, fields);
    sections(builder, fields);
    let bars = entries(fields, "bars");
    let plates = entries(fields, "plates");
    let plates: Vec<(Cursor<'d>, PlateGrid)> = plates
        .into_iter()
        .filter_map(|cursor| Some((cursor, plate(builder, cursor)?)))
        .collect();
    let bars: Vec<BarOutline<'d>> = bars
        .into_iter()
        .filter_map(|cursor| bar(builder, cursor))
        .collect();
    refuse_too_large(builder, &bars, &plates)?;

    for (index, (_, plate)) in plates.iter().enumerate() {
        let nodes = plate.append_nodes(&mut builder.structure.nodes);
        builder.structure.plates.push(Plate {
            id: plate.id.clone(),
            elements: 0..0,
            nodes,
        });
        let place: Arc<str> = format!("plates[{index}]").into();
        builder
            .places
            .nodes
            .resize(builder.structure.nodes.len(), place);
    }
    for (index, bar) in bars.into_iter().enumerate() {
        divide(builder, bar, format!("bars[{index}]").into());
    }
    for (index, (_, plate)) in plates.iter().enumerate() {
        let Structure {
            plates, elements, ..
        } = &mut builder.structure;
        plates[index].elements = plate.append_elements(&plates[index].nodes, elements);
        let place: Arc<str> = format!("plates[{index}]").into();
        builder
            .places
            .elements
            .resize(builder.structure.elements.len(), place);
    }
    for (index, cursor) in entries(fields, "quads").into_iter().enumerate() {
        if let Some(element) = quad(builder, cursor) {
            builder.structure.elements.push(element);
            let place = format!("quads[{index}]").into();
            builder.places.elements.push(place);
        }
    }
    Some(())
}

/// The entries of a list that may be left out.
pub fn entries<'d>(fields: &Fields<'d>, key: &str) -> Vec<Cursor<'d>> {
    fields
        .optional(key)
        .and_then(Cursor::list)
        .map(Iterator::collect)
        .unwrap_or_default()
}

fn materials<'d>(builder: &mut Builder<'d>, fields: &Fields<'d>) {
    let entries = fields.optional("materials").and_then(Cursor::entries);
    for entry in entries.unwrap_or_default() {
        if !is_id(entry.name()) {
            let message = format!("{} cannot name a material", quoted(entry.name()));
            entry.key_problem(message, ID_RULE);
        }
        // A wrong material stays known, so that its uses are not reported as well.
        let material = material(entry.value()).unwrap_or(Material {
            youngs_modulus: 1.0,
            poisson_ratio: 0.0,
            density: 0.0,
            expansion: 0.0,
        });
        builder
            .materials
            .insert(entry.name(), builder.structure.materials.len());
        builder.structure.materials.push(material);
    }
}

fn material(cursor: Cursor<'_>) -> Option<Material> {
    let fields = cursor.fields(&["E", "nu", "density", "expansion"])?;
    let modulus = fields.required("E").and_then(|c| c.positive("E"));
    let ratio = fields.required("nu").and_then(|cursor| {
        cursor.number_that("nu", "greater than -1 and at most 0.5", |nu| {
            nu > -1.0 && nu <= 0.5
        })
    });
    let density = match fields.optional("density") {
        Some(cursor) => cursor.number_that("density", "0 or more", |value| value >= 0.0),
        None => Some(0.0),
    };
    let expansion = match fields.optional("expansion") {
        Some(cursor) => cursor.number(),
        None => Some(0.0),
    };
    Some(Material {
        youngs_modulus: modulus?,
        poisson_ratio: ratio?,
        density: density?,
        expansion: expansion?,
    })
}

fn sections<'d>(builder: &mut Builder<'d>, fields: &Fields<'d>) {
    let entries = fields.optional("sections").and_then(Cursor::entries);
    for entry in entries.unwrap_or_default() {
        if !is_id(entry.name()) {
            let message = format!("{} cannot name a section", quoted(entry.name()));
            entry.key_problem(message, ID_RULE);
        }
        let section = section(entry.value()).unwrap_or(Section {
            area: 1.0,
            inertia: Some(1.0),
        });
        builder.sections.insert(entry.name(), section);
    }
}

fn section(cursor: Cursor<'_>) -> Option<Section> {
    let fields = cursor.fields(&["area", "inertia"])?;
    let area = fields.required("area").and_then(|c| c.positive("area"));
    let inertia = match fields.optional("inertia") {
        Some(cursor) => Some(cursor.positive("inertia")?),
        None => None,
    };
    Some(Section {
        area: area?,
        inertia,
    })
}

/// The index of the material that `material` names.
fn material_of<'d>(builder: &Builder<'d>, fields: &Fields<'d>) -> Option<usize> {
    let cursor = fields.required("material")?;
    let name = cursor.string()?;
    let index = builder.materials.get(name).copied();
    if index.is_none() {
        let mut known: Vec<&str> = builder.materials.keys().copied().collect();
        known.sort_unstable();
        cursor.unknown("material", name, &known);
    }
    index
}

/// Registers the `id` of an entry; marks it as broken if the rest of the entry is.
fn id_of<'d>(
    builder: &mut Builder<'d>,
    fields: &Fields<'d>,
    kind: &'static str,
) -> Option<&'d str> {
    let cursor = fields.required("id")?;
    let id = cursor.string()?;
    builder.register(cursor.place(), id, kind);
    Some(id)
}

/// A bar before its division.
struct BarOutline<'d> {
    cursor: Cursor<'d>,
    id: &'d str,
    ends: [Cursor<'d>; 2],
    divisions: usize,
    material: usize,
    kind: ElementKind,
}

fn bar<'d>(builder: &mut Builder<'d>, cursor: Cursor<'d>) -> Option<BarOutline<'d>> {
    let fields = cursor.fields(&[
        "id",
        "nodes",
        "kind",
        "material",
        "section",
        "divisions",
        "hinges",
    ])?;
    let id = id_of(builder, &fields, "bar");
    let outline = bar_outline(builder, cursor, &fields, id);
    if outline.is_none() {
        builder.broken.extend(id);
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
    if !is_frame && let (Some(count), Some(at)) = (divisions, fields.optional("divisions")) {
        if count > 1 {
            at.problem(
                format!("a truss bar cannot be divided, found {count} divisions"),
                "its inner nodes would move sideways freely: remove `divisions`, or make it a frame",
            );
            return None;
        }
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
        ElementKind::Frame {
            area: section.area,
            inertia,
            hinges: hinges?,
        }
    } else {
        ElementKind::Truss { area: section.area }
    };
    Some(BarOutline {
        cursor,
        id: id?,
        ends: ends?,
        divisions: divisions?,
        material: material?,
        kind,
    })
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
fn divide<'d>(builder: &mut Builder<'d>, bar: BarOutline<'d>, place: Arc<str>) {
    let ends = [builder.node(bar.ends[0]), builder.node(bar.ends[1])];
    let [Some(start), Some(end)] = ends else {
        builder.broken.insert(bar.id);
        return;
    };
    let (from, to) = (
        builder.structure.nodes[start].position,
        builder.structure.nodes[end].position,
    );
    let length = (to[0] - from[0]).hypot(to[1] - from[1]);
    let size = [from[0], from[1], to[0], to[1]]
        .iter()
        .fold(0.0_f64, |size, x| size.max(x.abs()));
    // Written so that an unknown place (NaN, reported at the node) passes.
    if start == end || length <= 1e-12 * size {
        bar.cursor.problem(
            format!(
                "the bar \"{}\" has no length: both ends are at ({}, {})",
                bar.id, from[0], from[1]
            ),
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
            position: [
                from[0] + t * (to[0] - from[0]),
                from[1] + t * (to[1] - from[1]),
            ],
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
        builder.structure.elements.push(Element {
            nodes: pair.to_vec(),
            material: bar.material,
            kind,
        });
        builder.places.elements.push(place.clone());
    }
    builder.bars.insert(bar.id, builder.structure.bars.len());
    builder.structure.bars.push(Bar {
        id: bar.id.to_string(),
        elements: first..builder.structure.elements.len(),
    });
}

fn plate<'d>(builder: &mut Builder<'d>, cursor: Cursor<'d>) -> Option<PlateGrid> {
    let fields = cursor.fields(&[
        "id",
        "origin",
        "size",
        "divisions",
        "x",
        "y",
        "rotation",
        "thickness",
        "material",
        "plane",
    ])?;
    let id = id_of(builder, &fields, "plate");
    let grid = plate_grid(builder, &fields, id);
    match (&grid, id) {
        (Some(_), Some(id)) => {
            let index = builder.plates.len();
            // A repeated id was reported; the first plate keeps it.
            builder.plates.entry(id).or_insert(index);
        }
        (None, Some(id)) => {
            builder.broken.insert(id);
        }
        _ => {}
    }
    grid
}

fn plate_grid<'d>(
    builder: &Builder<'d>,
    fields: &Fields<'d>,
    id: Option<&'d str>,
) -> Option<PlateGrid> {
    let origin = fields.required("origin").and_then(Cursor::vector);
    let rotation = match fields.optional("rotation") {
        Some(cursor) => cursor.number(),
        None => Some(0.0),
    };
    let lines = grid_lines(fields);
    let common = membrane(builder, fields);
    let [x, y] = lines?;
    let (thickness, material, plane) = common?;
    Some(PlateGrid {
        id: id?.to_string(),
        origin: origin?,
        rotation: rotation?,
        x,
        y,
        thickness,
        plane,
        material,
    })
}

/// Thickness, material and plane of a plate or quad.
fn membrane<'d>(builder: &Builder<'d>, fields: &Fields<'d>) -> Option<(f64, usize, Plane)> {
    let thickness = fields
        .required("thickness")
        .and_then(|cursor| cursor.positive("thickness"));
    let material = material_of(builder, fields);
    let at = fields.required("plane");
    let plane = at
        .and_then(|cursor| cursor.choice(&[("strain", Plane::Strain), ("stress", Plane::Stress)]));
    if let (Some(material), Some(Plane::Strain), Some(at)) = (material, plane, at)
        && builder.structure.materials[material].poisson_ratio == 0.5
    {
        at.problem(
            "plane strain cannot have nu = 0.5: the material would be incompressible",
            "lower nu of the material below 0.5, or use plane \"stress\"",
        );
        return None;
    }
    Some((thickness?, material?, plane?))
}

fn grid_lines(fields: &Fields<'_>) -> Option<[GridLines; 2]> {
    let graded = fields.entry("x").or(fields.entry("y")).is_some();
    let uniform = fields.entry("size").or(fields.entry("divisions")).is_some();
    if graded && uniform {
        fields.refuse(
            &["x", "y"],
            |key| format!("`{key}` cannot stand beside `size` and `divisions`"),
            "give either `size` and `divisions`, or the grid lines `x` and `y`",
        );
        return None;
    }
    if graded {
        let x = fields.required("x").and_then(increasing);
        let y = fields.required("y").and_then(increasing);
        return Some([GridLines::Graded(x?), GridLines::Graded(y?)]);
    }
    let size = fields.required("size").and_then(|cursor| {
        let size = cursor.vector()?;
        if size[0] > 0.0 && size[1] > 0.0 {
            return Some(size);
        }
        cursor.problem(
            format!(
                "the size of a plate must be greater than 0, found [{}, {}]",
                size[0], size[1]
            ),
            "give length and height; `rotation` turns a plate",
        );
        None
    });
    let divisions = fields.required("divisions").and_then(|cursor| {
        let entries = cursor.list_of(2, "along the length and up")?;
        let counts: Vec<Option<usize>> = entries.map(|entry| entry.whole("divisions", 1)).collect();
        Some([counts[0]?, counts[1]?])
    });
    let (size, divisions) = (size?, divisions?);
    Some([0, 1].map(|axis| GridLines::Uniform {
        size: size[axis],
        divisions: divisions[axis],
    }))
}

fn increasing(cursor: Cursor<'_>) -> Option<Vec<f64>> {
    let entries: Vec<Cursor<'_>> = cursor.list()?.collect();
    if entries.len() < 2 {
        cursor.problem(
            format!("expected at least two grid lines, found {}", entries.len()),
            "",
        );
        return None;
    }
    let lines: Vec<Option<f64>> = entries.iter().map(|entry| entry.number()).collect();
    let lines: Vec<f64> = lines.into_iter().collect::<Option<_>>()?;
    for k in 1..lines.len() {
        if lines[k] <= lines[k - 1] {
            entries[k].problem(
                format!(
                    "grid lines must increase, found {} after {}",
                    lines[k],
                    lines[k - 1]
                ),
                "give the distances from `origin` in increasing order, each once",
            );
            return None;
        }
    }
    Some(lines)
}

fn quad<'d>(builder: &mut Builder<'d>, cursor: Cursor<'d>) -> Option<Element> {
    let fields = cursor.fields(&["id", "nodes", "thickness", "material", "plane"])?;
    // Only an element's name in messages, but checked like every id.
    let id = id_of(builder, &fields, "quad");
    let common = membrane(builder, &fields);
    let corners = fields.required("nodes").and_then(|at| {
        let entries = at.list_of(4, "the corners counter-clockwise")?;
        let nodes: Vec<Option<usize>> = entries.map(|entry| builder.node(entry)).collect();
        let nodes: Vec<usize> = nodes.into_iter().collect::<Option<_>>()?;
        check_corners(builder, at, &nodes).then_some(nodes)
    });
    id?;
    let (thickness, material, plane) = common?;
    Some(Element {
        nodes: corners?,
        material,
        kind: ElementKind::Quad { thickness, plane },
    })
}

fn check_corners(builder: &Builder<'_>, cursor: Cursor<'_>, nodes: &[usize]) -> bool {
    for (k, node) in nodes.iter().enumerate() {
        if nodes[..k].contains(node) {
            cursor.problem(
                format!("the node \"{}\" is a corner twice", builder.node_id(*node)),
                "a quad has four different corners",
            );
            return false;
        }
    }
    let at = |k: usize| builder.structure.nodes[nodes[k % 4]].position;
    // Turn at corner k relative to its sides: the sine of the inner angle if counter-clockwise.
    let turns: Vec<f64> = (0..4)
        .map(|k| {
            let (a, b, c) = (at(k + 3), at(k), at(k + 1));
            let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
            (u[0] * v[1] - u[1] * v[0]) / (u[0].hypot(u[1]) * v[0].hypot(v[1]))
        })
        .collect();
    const FLAT: f64 = 1e-9;
    if turns.iter().all(|turn| *turn < -FLAT) {
        cursor.problem(
            "the corners of the quad run clockwise",
            "list them counter-clockwise, i.e. in the reverse order",
        );
        return false;
    }
    // A corner at an unknown place gives NaN and was reported there.
    let unknown = (0..4).any(|k| at(k)[0].is_nan());
    if !unknown && !turns.iter().all(|turn| *turn > FLAT) {
        cursor.problem(
            "the quad is not convex: a corner is flat, re-entrant, or two sides cross",
            "list the corners counter-clockwise and keep every inner angle below 180°",
        );
        return false;
    }
    true
}

/// Reports a mesh that would not fit in memory, at its largest part, before it is made.
fn refuse_too_large(
    builder: &Builder<'_>,
    bars: &[BarOutline<'_>],
    plates: &[(Cursor<'_>, PlateGrid)],
) -> Option<()> {
    let bars = bars.iter().map(|bar| (bar.cursor, bar.divisions as f64));
    let plates = plates
        .iter()
        .map(|(cursor, plate)| (*cursor, plate.node_count()));
    let parts: Vec<(Cursor<'_>, f64)> = bars.chain(plates).collect();
    let generated: f64 = parts.iter().map(|(_, nodes)| nodes).sum();
    let nodes = generated + builder.structure.nodes.len() as f64;
    let Some(refusal) = memory::refusal(memory::for_nodes(nodes)) else {
        return Some(());
    };
    let Some((largest, _)) = parts.iter().max_by(|a, b| a.1.total_cmp(&b.1)) else {
        // Only written-out nodes: the file itself was read, so it fits.
        return Some(());
    };
    largest.problem(
        format!(
            "the model is too large: with {} nodes it {refusal}",
            count(nodes)
        ),
        "lower the `divisions`, here first",
    );
    None
}

fn count(nodes: f64) -> String {
    if nodes < 1e6 {
        format!("{nodes}")
    } else {
        format!("about {nodes:.1e}")
    }
}
