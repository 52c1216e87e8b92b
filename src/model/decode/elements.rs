//! Everything that makes elements: materials and sections, then the bars, plates and quads that name them.

use std::sync::Arc;

use super::bars::{BarOutline, bar, divide};
use super::bricks::brick;
use super::builder::{Bending, Builder, Section, entries};
use super::mesh_elements;
use super::meshes::{self, MeshOutline};
use super::plates::plate;
use super::reader::{Cursor, Fields};
use super::single_elements::{quad, triangle};

use super::words::{ID_RULE, is_id, quoted};
use crate::model::brick::BrickGrid;
use crate::model::grid::PlateGrid;
use crate::model::memory;
use crate::model::space_section::SpaceSection;
use crate::model::structure::{Dimension, Element, Material, Plate, Structure};

/// Reads a single element and its id.
type ReadElement = for<'d> fn(&mut Builder<'d>, Cursor<'d>) -> Option<(&'d str, Element)>;

/// Reads everything that makes elements. `None` if the mesh would be too large to go on.
pub fn read<'d>(builder: &mut Builder<'d>, fields: &Fields<'d>) -> Option<()> {
    materials(builder, fields);
    sections(builder, fields);
    let bars = entries(fields, "bars");
    let plates = entries(fields, "plates");
    let plates: Vec<(Cursor<'d>, PlateGrid)> =
        plates.into_iter().filter_map(|cursor| Some((cursor, plate(builder, cursor)?))).collect();
    let bricks = entries(fields, "bricks");
    let bricks: Vec<(Cursor<'d>, BrickGrid)> =
        bricks.into_iter().filter_map(|cursor| Some((cursor, brick(builder, cursor)?))).collect();
    let meshes: Vec<MeshOutline<'d>> =
        entries(fields, "meshes").into_iter().filter_map(|cursor| meshes::outline(builder, cursor)).collect();
    let bars: Vec<BarOutline<'d>> = bars.into_iter().filter_map(|cursor| bar(builder, cursor)).collect();
    refuse_too_large(builder, &bars, &plates, &bricks, &meshes)?;

    for (index, (_, plate)) in plates.iter().enumerate() {
        let nodes = plate.append_nodes(&mut builder.structure.nodes);
        builder.structure.plates.push(Plate { id: plate.id.clone(), elements: 0..0, nodes });
        builder.place_nodes(format!("plates[{index}]"), false);
    }
    for (index, (_, brick)) in bricks.iter().enumerate() {
        let brick = brick.append_nodes(&mut builder.structure.nodes);
        builder.structure.bricks.push(brick);
        builder.place_nodes(format!("bricks[{index}]"), false);
    }
    let place = |index: usize| -> Arc<str> { format!("meshes[{index}]").into() };
    for (index, mesh) in meshes.iter().enumerate() {
        mesh_elements::append_nodes(builder, mesh);
        builder.place_nodes(place(index), false);
    }
    for (index, bar) in bars.into_iter().enumerate() {
        let place: Arc<str> = format!("bars[{index}]").into();
        divide(builder, bar, &place);
        builder.place_nodes(place, false);
    }
    for end in std::mem::take(&mut builder.ends_of_broken_bars) {
        builder.node(end);
    }
    for (index, (_, plate)) in plates.iter().enumerate() {
        let Structure { plates, elements, .. } = &mut builder.structure;
        plates[index].elements = plate.append_elements(&plates[index].nodes, elements);
        let place: Arc<str> = format!("plates[{index}]").into();
        builder.places.elements.resize(builder.structure.elements.len(), place);
    }
    for (index, (_, brick)) in bricks.iter().enumerate() {
        let Structure { bricks, elements, .. } = &mut builder.structure;
        brick.append_elements(&mut bricks[index], elements);
        builder.places.elements.resize(builder.structure.elements.len(), format!("bricks[{index}]").into());
    }
    for (index, mesh) in meshes.iter().enumerate() {
        mesh_elements::append_elements(builder, mesh, &place(index));
    }
    for (list, read) in [("triangles", triangle as ReadElement), ("quads", quad)] {
        for (index, cursor) in entries(fields, list).into_iter().enumerate() {
            if let Some((id, element)) = read(builder, cursor) {
                let at = builder.structure.elements.len();
                builder.single_elements.entry(id).or_insert(at);
                builder.structure.named_elements.push((id.to_owned(), at));
                builder.structure.elements.push(element);
                builder.places.elements.push(format!("{list}[{index}]").into());
            }
        }
    }
    Some(())
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
        builder.materials.insert(entry.name(), builder.structure.materials.len());
        builder.structure.materials.push(material);
    }
}

fn material(cursor: Cursor<'_>) -> Option<Material> {
    let fields = cursor.fields(&["E", "nu", "density", "expansion"])?;
    let modulus = fields.required("E").and_then(|c| c.positive("E"));
    let ratio = fields
        .required("nu")
        .and_then(|cursor| cursor.number_that("nu", "greater than -1 and at most 0.5", |nu| nu > -1.0 && nu <= 0.5));
    let density = match fields.optional("density") {
        Some(cursor) => cursor.number_that("density", "0 or more", |value| value >= 0.0),
        None => Some(0.0),
    };
    let expansion = match fields.optional("expansion") {
        Some(cursor) => cursor.number(),
        None => Some(0.0),
    };
    Some(Material { youngs_modulus: modulus?, poisson_ratio: ratio?, density: density?, expansion: expansion? })
}

fn sections<'d>(builder: &mut Builder<'d>, fields: &Fields<'d>) {
    let entries = fields.optional("sections").and_then(Cursor::entries);
    for entry in entries.unwrap_or_default() {
        if !is_id(entry.name()) {
            let message = format!("{} cannot name a section", quoted(entry.name()));
            entry.key_problem(message, ID_RULE);
        }
        // A wrong section stays known, so that its uses are not reported as well.
        let section = section(entry.value()).unwrap_or_else(|| {
            let space = SpaceSection {
                area: 1.0,
                inertia_y: 1.0,
                inertia_z: 1.0,
                torsion: 1.0,
                shear_area_y: None,
                shear_area_z: None,
            };
            let bending = match entry.value().dimension() {
                Dimension::Plane => Bending::Plane { inertia: 1.0, shear_area: None },
                Dimension::Space => Bending::Space(space),
            };
            Section { area: 1.0, bending: Some(bending), depth: [None; 2] }
        });
        builder.sections.insert(entry.name(), section);
    }
}

fn section(cursor: Cursor<'_>) -> Option<Section> {
    match cursor.dimension() {
        Dimension::Plane => section_in_plane(cursor),
        Dimension::Space => section_in_space(cursor),
    }
}

fn section_in_space(cursor: Cursor<'_>) -> Option<Section> {
    const FRAME: [&str; 3] = ["inertia_y", "inertia_z", "torsion"];
    let fields =
        cursor.fields(&["area", "inertia_y", "inertia_z", "torsion", "shear_area_y", "shear_area_z", "depth"])?;
    let area = fields.required("area").and_then(|c| c.positive("area"));
    // The outer `None`: a wrong value, reported.
    let optional = |key: &'static str| match fields.optional(key) {
        Some(cursor) => cursor.positive(key).map(Some),
        None => Some(None),
    };
    let frame = FRAME.map(optional);
    let shear = [optional("shear_area_y"), optional("shear_area_z")];
    let depth = match fields.optional("depth") {
        Some(cursor) => {
            let depths =
                cursor.list_of(2, "the depths along local y and z").map(|two| two.map(|d| d.positive("depth")));
            depths
                .and_then(|depths| depths.collect::<Option<Vec<f64>>>())
                .map(|depths| [Some(depths[0]), Some(depths[1])])
        }
        None => Some([None; 2]),
    };
    let [inertia_y, inertia_z, torsion] = frame;
    let [shear_area_y, shear_area_z] = shear;
    let (area, shear_area_y, shear_area_z) = (area?, shear_area_y?, shear_area_z?);
    let bending = match (inertia_y?, inertia_z?, torsion?) {
        (Some(inertia_y), Some(inertia_z), Some(torsion)) => {
            Some(Bending::Space(SpaceSection { area, inertia_y, inertia_z, torsion, shear_area_y, shear_area_z }))
        }
        (None, None, None) => None,
        _ => {
            for key in FRAME {
                let _ = fields.required(key);
            }
            return None;
        }
    };
    Some(Section { area, bending, depth: depth? })
}

fn section_in_plane(cursor: Cursor<'_>) -> Option<Section> {
    let fields = cursor.fields(&["area", "inertia", "depth", "shear_area"])?;
    let area = fields.required("area").and_then(|c| c.positive("area"));
    // The outer `None`: a wrong value, reported.
    let optional = |key: &'static str| match fields.optional(key) {
        Some(cursor) => cursor.positive(key).map(Some),
        None => Some(None),
    };
    let (inertia, depth, shear_area) = (optional("inertia"), optional("depth"), optional("shear_area"));
    let shear_area = shear_area?;
    let bending = inertia?.map(|inertia| Bending::Plane { inertia, shear_area });
    Some(Section { area: area?, bending, depth: [depth?, None] })
}

/// Reports a mesh that would not fit in memory, at its largest part, before it is made.
fn refuse_too_large(
    builder: &Builder<'_>,
    bars: &[BarOutline<'_>],
    plates: &[(Cursor<'_>, PlateGrid)],
    bricks: &[(Cursor<'_>, BrickGrid)],
    meshes: &[MeshOutline<'_>],
) -> Option<()> {
    const DIVISIONS: &str = "lower the `divisions`, here first";
    let bars = bars.iter().map(|bar| (bar.cursor, bar.element_count(), DIVISIONS));
    let plates = plates.iter().map(|(cursor, plate)| (*cursor, plate.node_count(), DIVISIONS));
    let bricks = bricks.iter().map(|(cursor, brick)| (*cursor, brick.node_count(), DIVISIONS));
    let meshes = meshes.iter().map(|mesh| (mesh.cursor, mesh.node_count(), "mesh more coarsely, here first"));
    let parts: Vec<(Cursor<'_>, f64, &str)> = bars.chain(plates).chain(bricks).chain(meshes).collect();
    let generated: f64 = parts.iter().map(|(_, nodes, _)| nodes).sum();
    let nodes = generated + builder.structure.nodes.len() as f64;
    let Some(refusal) = memory::refusal(memory::for_nodes(nodes)) else {
        return Some(());
    };
    let Some((largest, _, help)) = parts.iter().max_by(|a, b| a.1.total_cmp(&b.1)) else {
        // Only written-out nodes: the file itself was read, so it fits.
        return Some(());
    };
    largest.problem(format!("the model is too large: with {} nodes it {refusal}", count(nodes)), *help);
    None
}

fn count(nodes: f64) -> String {
    if nodes < 1e6 { format!("{nodes}") } else { format!("about {nodes:.1e}") }
}
