//! A hot pipe on resting supports.

use super::{Count, Need, Template, lines};

pub const TEMPLATE: Template = Template {
    kind: "pipeline",
    counts: &[Count { name: "supports", default: 6, range: (1, 100), about: "number of resting supports" }],
    needs: &[Need { less: "2*t", than: "D", why: "the pipe would be solid" }],
    text: |counts| text(counts[0]),
};

fn text(supports: usize) -> String {
    let nodes = lines((1..=supports).map(|k| format!(r#""s{k}": ["{k}*a", 0]"#)));
    let contacts = lines((1..=supports).map(|k| {
        format!(r#"{{ "id": "c{k}", "node": "s{k}", "against": "ground", "normal": [0, 1], "friction": "f" }}"#)
    }));
    let run: Vec<String> = (1..=supports).map(|k| format!(r#""s{k}""#)).collect();
    TEXT.replace("SUPPORTS", &supports.to_string())
        .replace("// nodes", &nodes)
        .replace("RUN", &run.join(", "))
        .replace("// contacts", &contacts)
}

const TEXT: &str = r#"{
  // A hot pipe that leaves a nozzle, turns by an elbow and runs along resting supports.
  "format": "stickslip/1",
  "title": "Heated pipe run on resting supports",
  "description": "A pipe leaves a nozzle downwards, turns by an elbow and runs along supports on which it rests. Heated by dT it grows: the riser lifts the run off its first supports, the run slides on the others, and friction there decides the moment at the nozzle. `stages` follows cold, hot, cold, hot: what slides out does not come back all the way.",
  "units": { "length": "m", "force": "kN" },
  "parameters": {
    "a": { "value": 3, "min": 1, "max": 12, "step": 0.25, "unit": "m", "about": "distance of the supports" },
    "h": { "value": 4, "min": 0.5, "max": 20, "step": 0.5, "unit": "m", "about": "height of the riser" },
    "D": { "value": 0.2191, "min": 0.02, "max": 2, "step": 0.01, "unit": "m", "about": "outer diameter of the pipe" },
    "t": { "value": 0.01, "min": 0.001, "max": 0.1, "step": 0.001, "unit": "m", "about": "thickness of its wall" },
    "w": { "value": 0.62, "min": 0.05, "max": 20, "step": 0.05, "unit": "kN/m", "about": "weight of pipe, contents and lagging" },
    "dT": { "value": 180, "min": 0, "max": 500, "step": 10, "unit": "K", "about": "heating" },
    "f": { "value": 0.3, "min": 0, "max": 1, "step": 0.05, "about": "friction on the supports" },
    // shown, not set
    "A": { "formula": "pi*(D - t)*t", "unit": "m²", "about": "area of the pipe" },
    "I": { "formula": "pi*(D^4 - (D - 2*t)^4)/64", "unit": "m⁴", "about": "inertia of the pipe" }
  },
  "materials": { "steel": { "E": 2e8, "nu": 0.3, "expansion": 1.2e-5 } },
  "sections": { "pipe": { "area": "A", "inertia": "I" } },
  "nodes": {
    "nozzle": [0, "h"],
    "elbow": [0, 0],
    // nodes
  },
  "bars": [
    { "id": "riser", "nodes": ["nozzle", "elbow"], "material": "steel", "section": "pipe" },
    { "id": "run", "polyline": ["elbow", RUN], "material": "steel", "section": "pipe" }
  ],
  "supports": [{ "at": "nozzle", "fixed": ["x", "y", "r"] }],
  "contacts": [
    // contacts
  ],
  "loads": {
    "weight": {
      "factor": "w",
      "items": [{ "line": { "bar": "riser", "value": [0, -1] } }, { "line": { "bar": "run", "value": [0, -1] } }]
    },
    // a rise by 1 K, times dT
    "hot": { "factor": "dT", "items": [{ "temperature": { "change": 1, "on": ["riser", "run"] } }] }
  },
  "stages": [
    { "weight": 1 },
    { "weight": 1, "hot": 1 },
    { "weight": 1, "hot": 0 },
    { "weight": 1, "hot": 1 }
  ],
  "combinations": { "cold": { "weight": 1 }, "hot": { "weight": 1, "hot": 1 } },
  "probes": {
    "nozzle_moment": "m nozzle",
    "nozzle_thrust": "fx nozzle",
    "nozzle_lift": "fy nozzle",
    "growth": "ux sSUPPORTS",
    "lift": "max z_n c*",
    "bending": "max M run"
  }
}
"#;
