//! What a mesh holds, as JSON.

use serde_json::{Value, json};

use crate::model::mesh::Mesh;
use crate::model::mesh::overview::Overview;

/// What `check` says of a mesh file.
pub fn overview(name: &str, mesh: &Mesh, overview: &Overview) -> Value {
    let elements = overview.shapes.iter().map(|(shape, count)| {
        let kind = shape.word();
        json!({ "shape": kind, "nodes": shape.nodes(), "count": count })
    });
    let groups = overview.groups.iter().map(|group| {
        let mut object = json!({
            "name": group.name, "dimension": group.dimension, "members": group.what, "count": group.count,
            "place": group.place,
        });
        if let Some(measure) = group.measure {
            object[measure_word(group.dimension)] = json!(measure);
        }
        if let Some(fault) = &group.fault {
            object[if overview.volume.is_some() { "no_face" } else { "no_edge" }] = json!(fault);
        }
        object
    });
    let dimension = if overview.volume.is_some() { 3 } else { 2 };
    let boundary = overview
        .boundary
        .iter()
        .map(|piece| json!({ "name": piece.name, "nodes": piece.nodes, measure_word(dimension - 1): piece.measure }));
    let extent = overview.extent.map(|corner| corner[..usize::from(dimension)].to_vec());
    let mut object = json!({
        "mesh": name,
        "format": mesh.format,
        "nodes": mesh.nodes.len(),
        "unused_nodes": overview.unused_nodes,
        "elements": elements.collect::<Vec<_>>(),
        "area": overview.area,
        "extent": extent,
        "groups": groups.collect::<Vec<_>>(),
        "boundary": boundary.collect::<Vec<_>>(),
        "worst": overview.worst.as_ref().map(|worst| {
            json!({ "element": worst.tag, "quality": worst.quality, "place": worst.place })
        }),
        "notes": mesh.notes,
        "skipped": mesh.skipped,
    });
    if let Some(volume) = overview.volume {
        object["volume"] = json!(volume);
    }
    object
}

/// What is measured of something with this many dimensions.
fn measure_word(dimension: u8) -> &'static str {
    match dimension {
        2 => "area",
        3 => "volume",
        _ => "length",
    }
}
