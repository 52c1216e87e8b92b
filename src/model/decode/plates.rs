//! Plates: grids of quads.

use super::builder::{Builder, id_of, material_of};
use super::reader::{Cursor, Fields};
use crate::model::grid::{GridLines, HIDDEN_SIDE, PlateGrid};
use crate::model::structure::Plane;
use crate::text::number::short;

/// Reads one plate.
pub fn plate<'d>(builder: &mut Builder<'d>, cursor: Cursor<'d>) -> Option<PlateGrid> {
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
        "element",
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

fn plate_grid<'d>(builder: &Builder<'d>, fields: &Fields<'d>, id: Option<&'d str>) -> Option<PlateGrid> {
    let origin = fields.required("origin").and_then(Cursor::vector).map(|[x, y, _]| [x, y]);
    let rotation = match fields.optional("rotation") {
        Some(cursor) => cursor.number(),
        None => Some(0.0),
    };
    let lines = grid_lines(fields);
    let common = membrane(builder, fields);
    let incompatible = modes(fields);
    let [x, y] = lines?;
    near_enough(fields, &origin?, x.least_part().min(y.least_part()))?;
    let (thickness, material, plane) = common?;
    Some(PlateGrid {
        id: id?.to_string(),
        origin: origin?,
        rotation: rotation?,
        x,
        y,
        thickness,
        plane,
        incompatible: incompatible?,
        material,
    })
}

/// Reports a grid whose shortest side is lost in the digits of coordinates as large as those of its origin.
pub fn near_enough(fields: &Fields<'_>, origin: &[f64], side: f64) -> Option<()> {
    let away = origin.iter().fold(0.0_f64, |away, x| away.max(x.abs()));
    if side > HIDDEN_SIDE * away {
        return Some(());
    }
    fields.required("origin")?.problem(
        format!("sides of its elements are only {} long, 1e-12 of its distance from the origin or less", short(side)),
        "put the origin of the coordinates near the structure",
    );
    None
}

/// Whether elements of four nodes have incompatible modes: the key `element`.
pub fn modes(fields: &Fields<'_>) -> Option<bool> {
    match fields.optional("element") {
        Some(cursor) => cursor.choice(&[("plain", false), ("incompatible", true)]),
        None => Some(false),
    }
}

/// Thickness, material and plane of a plate, triangle or quad.
pub fn membrane<'d>(builder: &Builder<'d>, fields: &Fields<'d>) -> Option<(f64, usize, Plane)> {
    let thickness = fields.required("thickness").and_then(|cursor| cursor.positive("thickness"));
    let material = material_of(builder, fields);
    let at = fields.required("plane");
    let plane = at.and_then(|cursor| cursor.choice(&[("strain", Plane::Strain), ("stress", Plane::Stress)]));
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
            format!("the size of a plate must be greater than 0, found [{}, {}]", size[0], size[1]),
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
    Some([0, 1].map(|axis| GridLines::Uniform { size: size[axis], divisions: divisions[axis] }))
}

fn increasing(cursor: Cursor<'_>) -> Option<Vec<f64>> {
    let entries: Vec<Cursor<'_>> = cursor.list()?.collect();
    if entries.len() < 2 {
        cursor.problem(
            format!("expected at least two grid lines, found {}", entries.len()),
            "give the first and the last at least",
        );
        return None;
    }
    let lines: Vec<Option<f64>> = entries.iter().map(|entry| entry.number()).collect();
    let lines: Vec<f64> = lines.into_iter().collect::<Option<_>>()?;
    for k in 1..lines.len() {
        if lines[k] <= lines[k - 1] {
            entries[k].problem(
                format!("grid lines must increase, found {} after {}", lines[k], lines[k - 1]),
                "give the distances from `origin` in increasing order, each once",
            );
            return None;
        }
    }
    Some(lines)
}
