//! What a mesh holds, as JSON.

use serde_json::{Value, json};

use crate::model::mesh::Mesh;
use crate::model::mesh::overview::Overview;

/// What `check` says of a mesh file.
pub fn overview(name: &str, mesh: &Mesh, overview: &Overview) -> Value {
    let elements = overview.shapes.iter().map(|(shape, count)| {
        let kind = ["line", "triangle", "quadrilateral"][shape.corners() - 2];
        json!({ "shape": kind, "nodes": shape.nodes(), "count": count })
    });
    let groups = overview.groups.iter().map(|group| {
        let mut object = json!({
            "name": group.name, "dimension": group.dimension, "members": group.what, "count": group.count,
            "place": group.place,
        });
        if let Some(measure) = group.measure {
            object[if group.dimension == 2 { "area" } else { "length" }] = json!(measure);
        }
        if let Some(fault) = &group.fault {
            object["no_edge"] = json!(fault);
        }
        object
    });
    let boundary =
        overview.boundary.iter().map(|edge| json!({ "name": edge.name, "nodes": edge.nodes, "length": edge.length }));
    json!({
        "mesh": name,
        "format": mesh.format,
        "nodes": mesh.nodes.len(),
        "unused_nodes": overview.unused_nodes,
        "elements": elements.collect::<Vec<_>>(),
        "area": overview.area,
        "extent": overview.extent,
        "groups": groups.collect::<Vec<_>>(),
        "boundary": boundary.collect::<Vec<_>>(),
        "worst": overview.worst.as_ref().map(|worst| {
            json!({ "element": worst.tag, "quality": worst.quality, "place": worst.place })
        }),
        "notes": mesh.notes,
        "skipped": mesh.skipped,
    })
}
