//! Pictures of bars and faces in space, on statics.

use serde_json::Value;

use super::lines::{embedded, read, report};

/// A cantilever of 4 m along x, its local y upwards and z along −y, under 10 kN downwards and 3 kN along −y at its tip,
/// which hangs over ground that it does not reach.
const CANTILEVER: &str = r#"{
  "format": "stickslip/1", "title": "cantilever", "dimension": 3, "units": { "length": "m", "force": "kN" },
  "materials": { "m": { "E": 2e8, "nu": 0.3 } },
  "sections": { "s": { "area": 0.1, "inertia_y": 0.01, "inertia_z": 0.01, "torsion": 0.02 } },
  "nodes": { "A": [0, 0, 0], "B": [4, 0, 0] },
  "bars": [ { "id": "AB", "nodes": ["A", "B"], "material": "m", "section": "s" } ],
  "supports": [ { "at": "A", "fixed": ["x", "y", "z", "rx", "ry", "rz"] } ],
  "contacts": [ { "id": "c", "node": "B", "against": "ground", "normal": [0, 0, 1], "friction": 0.5, "gap": 5 } ],
  "loads": { "tip": { "items": [ { "point": { "at": "B", "force": [0, -3, -10], "moment": [7, 0, 0] } } ] } }
}"#;

/// M_z = −10·4 puts the upper side in tension, M_y = 3·4 the side of −z, which is +y; V = dM/dx; T = 7.
#[test]
fn forces_along_bars_in_space() {
    let mut session = read(CANTILEVER);
    for (picture, start, end) in [
        ("moment", -40.0, 0.0),
        ("shear", 10.0, 10.0),
        ("My", 12.0, 0.0),
        ("Vz", -3.0, -3.0),
        ("T", 7.0, 7.0),
        ("axial", 0.0, 0.0),
    ] {
        let shown = report(&mut session, &format!("plot {picture} AB")).unwrap();
        let points = shown["points"].as_array().unwrap_or_else(|| panic!("{shown}"));
        for (point, expected) in [(&points[0], start), (&points[points.len() - 1], end)] {
            let found = point[1].as_f64().unwrap();
            assert!((found - expected).abs() < 1e-9, "{picture}: {found}, expected {expected}");
        }
    }
}

#[test]
fn forces_of_space_are_refused_in_the_plane() {
    let mut session = embedded("frame");
    for picture in ["Vz", "T", "My"] {
        let refused = report(&mut session, &format!("plot {picture}")).unwrap_err();
        assert!(refused.starts_with(&format!("{picture} is a force of bars in space")), "{refused}");
    }
}

/// The block weighs 25 · 1 · 0.8 · 0.4 = 8 kN, which the pairs of its base carry, each over its area; all areas are 0.8 m².
#[test]
fn tractions_over_a_face_are_per_area() {
    let mut session = embedded("block-3d");
    let shown = report(&mut session, "plot traction").unwrap();
    let pairs = shown[0]["pairs"].as_array().unwrap_or_else(|| panic!("{shown}"));
    let of = |pair: &Value, key: &str| pair[key].as_f64().unwrap_or_else(|| panic!("{pair}"));
    let area: f64 = pairs.iter().map(|pair| of(pair, "area")).sum();
    let weight: f64 = pairs.iter().map(|pair| of(pair, "area") * of(pair, "normal")).sum();
    assert!((area - 0.8).abs() < 1e-12 && (weight - 8.0).abs() < 1e-9, "{area} {weight}");
}
