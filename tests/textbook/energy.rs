//! Strain energy: of the forces inside, with the loads between nodes and without what expands freely.

use serde_json::{Value, json};

use crate::common::lines::{read, report};
use crate::common::*;

const E: f64 = 200.0;
const NU: f64 = 0.25;
const AREA: f64 = 0.5;
const INERTIA: f64 = 0.1;
const L: f64 = 4.0;

/// `energy` of a scenario with this material and these sections.
fn energy(mut scenario: Value) -> f64 {
    let in_space = scenario["dimension"] == 3;
    scenario["materials"] = json!({ "m": { "E": E, "nu": NU, "expansion": 0.001, "density": 1 } });
    if scenario["bars"].is_array() {
        scenario["sections"] = match in_space {
            false => json!({ "s": { "area": AREA, "inertia": INERTIA, "depth": 0.2 },
                             "soft": { "area": AREA, "inertia": INERTIA, "shear_area": 0.3 } }),
            true => json!({ "s": { "area": AREA, "inertia_y": INERTIA, "inertia_z": 2.0 * INERTIA, "torsion": 0.3,
                                   "shear_area_y": 0.3, "shear_area_z": 0.2 } }),
        };
    }
    let mut session = read(&scenario_text(scenario));
    report(&mut session, "show energy").unwrap_or_else(|e| panic!("{e}"))[0]["value"].as_f64().expect("a number")
}

/// A bar from the origin in pieces, with these supports under one load.
fn bar(divisions: usize, section: &str, end: [f64; 2], supports: &Value, load: &Value) -> f64 {
    energy(json!({
        "nodes": { "a": [0, 0], "b": end },
        "bars": [{ "id": "ab", "nodes": ["a", "b"], "material": "m", "section": section, "divisions": divisions }],
        "supports": supports,
        "loads": { "q": { "items": [load] } }
    }))
}

/// A simple beam under q: q² L⁵/240EI, with a shear area q² L³/24GA_s more; a cantilever under q along and across it:
/// q_x² L³/6EA + q_y² L⁵/40EI. In one piece or several.
#[test]
fn loads_between_nodes_bend() {
    let (q, ei) = (3.0_f64, E * INERTIA);
    let ga = E / (2.0 * (1.0 + NU)) * 0.3;
    let simple = json!([{ "at": "a", "fixed": ["x", "y"] }, { "at": "b", "fixed": ["y"] }]);
    let clamped = json!([{ "at": "a", "fixed": ["x", "y", "r"] }]);
    let line = |value: [f64; 2]| json!({ "line": { "bar": "ab", "value": value } });
    let bends = q * q * L.powi(5) / (240.0 * ei);
    for divisions in [1, 3] {
        close("simple", bar(divisions, "s", [L, 0.0], &simple, &line([0.0, -q])), bends, 1e-12);
        let shears = q * q * L.powi(3) / (24.0 * ga);
        close("soft", bar(divisions, "soft", [L, 0.0], &simple, &line([0.0, -q])), bends + shears, 1e-12);
        let right = 4.0 * L.powi(3) / (6.0 * E * AREA) + q * q * L.powi(5) / (40.0 * ei);
        close("cantilever", bar(divisions, "s", [L, 0.0], &clamped, &line([2.0, -q])), right, 1e-12);
    }
}

/// Warmed by α ΔT and bent by a gradient: freely without energy; held along it N = −EA α ΔT stores N² L/2EA. A truss bar
/// that hangs: q² L³/6EA.
#[test]
fn heat_and_trusses() {
    let heat = json!({ "temperature": { "change": 10, "gradient": 5, "on": ["ab"] } });
    let free = json!([{ "at": "a", "fixed": ["x", "y"] }, { "at": "b", "fixed": ["y"] }]);
    let held = json!([{ "at": "a", "fixed": ["x", "y"] }, { "at": "b", "fixed": ["x", "y"] }]);
    let right = E * AREA * 0.01_f64.powi(2) * L / 2.0;
    for divisions in [1, 3] {
        near("free", bar(divisions, "s", [L, 0.0], &free, &heat), 0.0, 1e-24, right);
        close("held", bar(divisions, "s", [L, 0.0], &held, &heat), right, 1e-12);
    }
    let hung = energy(json!({
        "nodes": { "a": [0, 0], "b": [0, -L], "c": [1, -L] },
        "bars": [{ "id": "ab", "nodes": ["a", "b"], "kind": "truss", "material": "m", "section": "s" },
                 { "id": "bc", "nodes": ["b", "c"], "kind": "truss", "material": "m", "section": "s" }],
        "supports": [{ "at": "a", "fixed": ["x", "y"] }, { "at": "c", "fixed": ["x", "y"] }],
        "loads": { "q": { "items": [{ "line": { "bar": "ab", "value": [0, -3] } },
                                    { "line": { "bar": "bc", "value": [0, 0] } }] } }
    }));
    // bc stays at right angles to what b does.
    close("hung", hung, 9.0 * L.powi(3) / (6.0 * E * AREA), 1e-12);
}

/// A cantilever in space under q along all axes and a torque T at its end: q_x² L³/6EA + Σ (q² L⁵/40EI + q² L³/6GA_s)
/// + T² L/2GJ.
#[test]
fn bars_in_space() {
    let (g, t) = (E / (2.0 * (1.0 + NU)), 0.7);
    let found = energy(json!({
        "dimension": 3,
        "nodes": { "a": [0, 0, 0], "b": [L, 0, 0] },
        "bars": [{ "id": "ab", "nodes": ["a", "b"], "material": "m", "section": "s", "divisions": 2, "orientation": [0, 1, 0] }],
        "supports": [{ "at": "a", "fixed": ["x", "y", "z", "rx", "ry", "rz"] }],
        "loads": { "q": { "items": [{ "line": { "bar": "ab", "value": [1, 2, 3] } },
                                    { "point": { "at": "b", "moment": [t, 0, 0] } }] } }
    }));
    let across =
        |q: f64, inertia: f64, area: f64| q * q * (L.powi(5) / (40.0 * E * inertia) + L.powi(3) / (6.0 * g * area));
    let right = L.powi(3) / (6.0 * E * AREA)
        + across(2.0, 2.0 * INERTIA, 0.3)
        + across(3.0, INERTIA, 0.2)
        + t * t * L / (2.0 * g * 0.3);
    close("in space", found, right, 1e-12);
}

/// Plates and bricks of 2 × 1 (× 1), α ΔT = 0.01: held all round σ = −E α ΔT/(1 − ν) in plane stress and
/// p = E α ΔT/(1 − 2ν) with ε_z = 0; free in the plane only σ_z = −E α ΔT where that is held; pulled by σ, σ² V/2E.
#[test]
fn areas_and_solids() {
    let (strain, volume) = (0.01_f64, 2.0);
    let squeezed = 1.5 * E * strain * strain / (1.0 - 2.0 * NU) * volume;
    let heat = json!({ "temperature": { "change": 10, "on": ["p"] } });
    let plate = |plane: &str, supports: Value, load: &Value| {
        energy(json!({
            "plates": [{ "id": "p", "origin": [0, 0], "size": [2, 1], "divisions": [3, 2], "thickness": 1, "material": "m",
                         "plane": plane }],
            "supports": supports,
            "loads": { "q": { "items": [load] } }
        }))
    };
    let held: Vec<Value> =
        ["left", "right", "bottom", "top"].map(|edge| json!({ "at": format!("p.{edge}"), "fixed": ["x", "y"] })).into();
    let free = || json!([{ "at": "p.left", "fixed": ["x"] }, { "at": "p.bottom", "fixed": ["y"] }]);
    close("plane stress", plate("stress", json!(held), &heat), E * strain * strain / (1.0 - NU) * volume, 1e-12);
    close("plane strain", plate("strain", json!(held), &heat), squeezed, 1e-12);
    near("free", plate("stress", free(), &heat), 0.0, 1e-24, squeezed);
    close("free but for z", plate("strain", free(), &heat), E * strain * strain / 2.0 * volume, 1e-12);
    let pull = json!({ "traction": { "edge": "p.right", "value": [10, 0] } });
    close("pulled", plate("stress", free(), &pull), 100.0 / (2.0 * E) * volume, 1e-12);

    let brick = |supports: Value, load: &Value| {
        energy(json!({
            "dimension": 3,
            "bricks": [{ "id": "p", "origin": [0, 0, 0], "size": [2, 1, 1], "divisions": [2, 1, 2], "material": "m" }],
            "supports": supports,
            "loads": { "q": { "items": [load] } }
        }))
    };
    let all = ["left", "right", "front", "back", "bottom", "top"];
    let held: Vec<Value> = all.map(|face| json!({ "at": format!("p.{face}"), "fixed": ["x", "y", "z"] })).into();
    let free = || json!([{ "at": "p.left", "fixed": ["x"] }, { "at": "p.front", "fixed": ["y"] }, { "at": "p.bottom", "fixed": ["z"] }]);
    close("solid", brick(json!(held), &heat), squeezed, 1e-12);
    near("free solid", brick(free(), &heat), 0.0, 1e-24, squeezed);
    let pull = json!({ "traction": { "face": "p.right", "value": [10, 0, 0] } });
    close("pulled solid", brick(free(), &pull), 100.0 / (2.0 * E) * volume, 1e-12);
}

/// Clapeyron: under forces at nodes the energy is ½ F u, whatever it is stored in: membranes and bricks that bend with their own
/// modes, springs.
#[test]
fn half_the_work_of_the_forces() {
    let half = |mut scenario: Value, shown: &str, force: f64| {
        scenario["materials"] = json!({ "m": { "E": E, "nu": NU } });
        let mut session = read(&scenario_text(scenario));
        let mut value = |what: &str| {
            let shown = report(&mut session, &format!("show {what}")).unwrap_or_else(|e| panic!("{e}"));
            shown[0]["value"].as_f64().expect("a number")
        };
        close(shown, value("energy"), 0.5 * force * value(shown), 1e-10);
    };
    for plane in ["stress", "strain"] {
        half(
            json!({
                "plates": [{ "id": "p", "origin": [0, 0], "size": [4, 1], "divisions": [3, 2], "thickness": 1,
                             "material": "m", "plane": plane }],
                "supports": [{ "at": "p.left", "fixed": ["x", "y"] }],
                "springs": [{ "at": "p[3,0]", "direction": [3, 4], "stiffness": 5 },
                            { "between": ["p[1,0]", "p[3,2]"], "direction": [0, 1], "stiffness": 7 }],
                "loads": { "q": { "items": [{ "point": { "at": "p[3,2]", "force": [0, 2] } }] } }
            }),
            "uy p[3,2]",
            2.0,
        );
    }
    half(
        json!({
            "dimension": 3,
            "bricks": [{ "id": "p", "origin": [0, 0, 0], "size": [4, 1, 1], "divisions": [2, 1, 1], "material": "m" }],
            "supports": [{ "at": "p.left", "fixed": ["x", "y", "z"] }],
            "loads": { "q": { "items": [{ "point": { "at": "p[2,1,1]", "force": [0, 0, 2] } }] } }
        }),
        "uz p[2,1,1]",
        2.0,
    );
}
