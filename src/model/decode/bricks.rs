//! Bricks: boxes of hexahedra in space.

use super::builder::{Builder, id_of, material_of};
use super::plates::{modes, near_enough};
use super::reader::{Cursor, Fields};
use crate::model::brick::BrickGrid;

/// Reads one brick.
pub fn brick<'d>(builder: &mut Builder<'d>, cursor: Cursor<'d>) -> Option<BrickGrid> {
    let fields = cursor.fields(&["id", "origin", "size", "divisions", "material", "element"])?;
    let id = id_of(builder, &fields, "brick");
    let grid = grid(builder, &fields, id);
    match (&grid, id) {
        (Some(_), Some(id)) => {
            let index = builder.bricks.len();
            // A repeated id was reported; the first brick keeps it.
            builder.bricks.entry(id).or_insert(index);
        }
        (None, Some(id)) => {
            builder.broken.insert(id);
        }
        _ => {}
    }
    grid
}

fn grid<'d>(builder: &Builder<'d>, fields: &Fields<'d>, id: Option<&'d str>) -> Option<BrickGrid> {
    let origin = fields.required("origin").and_then(Cursor::vector);
    let size = fields.required("size").and_then(|cursor| {
        let size = cursor.vector()?;
        if size.iter().all(|length| *length > 0.0) {
            return Some(size);
        }
        let [x, y, z] = size;
        cursor.problem(
            format!("the size of a brick must be greater than 0, found [{x}, {y}, {z}]"),
            "give its lengths along x, y and z",
        );
        None
    });
    let divisions = fields.required("divisions").and_then(|cursor| {
        let entries = cursor.list_of(3, "along x, y and z")?;
        let counts: Vec<Option<usize>> = entries.map(|entry| entry.whole("divisions", 1)).collect();
        Some([counts[0]?, counts[1]?, counts[2]?])
    });
    let material = solid_material(builder, fields);
    let incompatible = modes(fields);
    let (lengths, counts) = (size?, divisions?);
    let sides = [0, 1, 2].map(|axis| lengths[axis] / counts[axis] as f64);
    near_enough(fields, &origin?, sides.into_iter().fold(f64::INFINITY, f64::min))?;
    Some(BrickGrid {
        id: id?.to_owned(),
        origin: origin?,
        size: lengths,
        divisions: counts,
        material: material?,
        incompatible: incompatible?,
    })
}

/// The material of a solid, which must not be incompressible.
pub fn solid_material<'d>(builder: &Builder<'d>, fields: &Fields<'d>) -> Option<usize> {
    let material = material_of(builder, fields)?;
    if builder.structure.materials[material].poisson_ratio == 0.5 {
        fields.required("material")?.problem(
            "a solid cannot have nu = 0.5: the material would be incompressible",
            "lower nu of the material below 0.5",
        );
        return None;
    }
    Some(material)
}
