//! A block on a rough plane, pushed.

use super::{Count, Template};

pub const TEMPLATE: Template = Template {
    kind: "block",
    counts: &[
        Count { name: "columns", default: 4, range: (1, 60), about: "number of elements along the base" },
        Count { name: "rows", default: 8, range: (1, 60), about: "number of elements over the height" },
    ],
    needs: &[],
    text: |counts| TEXT.replace("COLUMNS, ROWS", &format!("{}, {}", counts[0], counts[1])),
};

const TEXT: &str = r#"{
  // A block that stands on a rough plane by its weight and is pushed at its top.
  "format": "stickslip/1",
  "title": "Block on a rough plane",
  "description": "A block b wide, h high and t thick with weight W is pushed at its top by H towards +x. It slides at H = f W and overturns at H = W b/(2 h), whichever is less: `limit push`.",
  "units": { "length": "m", "force": "kN" },
  "parameters": {
    "b": { "value": 1, "min": 0.1, "max": 10, "step": 0.1, "unit": "m", "about": "width of the base" },
    "h": { "value": 2, "min": 0.1, "max": 10, "step": 0.1, "unit": "m", "about": "height" },
    "t": { "value": 1, "min": 0.1, "max": 10, "step": 0.1, "unit": "m", "about": "thickness, out of the plane" },
    "gamma": { "value": 25, "min": 1, "max": 80, "step": 1, "unit": "kN/m³", "about": "weight per volume" },
    "f": { "value": 0.4, "min": 0, "max": 1, "step": 0.05, "about": "friction of the base" },
    "H": { "value": 10, "min": -50, "max": 50, "step": 1, "unit": "kN", "about": "push at the top, towards +x" },
    // shown, not set
    "W": { "formula": "gamma*b*h*t", "unit": "kN", "about": "weight" },
    "slides": { "formula": "f*W", "unit": "kN", "about": "push at which it slides" },
    "overturns": { "formula": "W*b/(2*h)", "unit": "kN", "about": "push at which it overturns" }
  },
  // density: weight per volume, times an acceleration of 1
  "materials": { "concrete": { "E": 3e7, "nu": 0.2, "density": "gamma" } },
  "plates": [
    {
      "id": "block", "origin": [0, 0], "size": ["b", "h"], "divisions": [COLUMNS, ROWS],
      "thickness": "t", "material": "concrete", "plane": "stress", "element": "incompatible"
    }
  ],
  "contacts": [{ "id": "base", "edge": "block.bottom", "against": "ground", "friction": "f" }],
  "loads": {
    "weight": { "items": [{ "gravity": { "acceleration": [0, -1] } }] },
    "push": { "factor": "H", "items": [{ "point": { "at": "block.top", "force": [1, 0] } }] }
  },
  "probes": {
    "normal": "resultant base N",
    "shear": "resultant base T",
    "eccentricity": "resultant base e",
    "open": "count open base",
    "sway": "max u"
  }
}
"#;
