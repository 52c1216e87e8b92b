//! Blocks one on the other, shaken.

use super::{Count, Template, lines};

pub const TEMPLATE: Template = Template {
    kind: "block-stack",
    counts: &[Count { name: "blocks", default: 4, range: (1, 60), about: "number of blocks" }],
    needs: &[],
    text: |counts| text(counts[0]),
};

fn text(blocks: usize) -> String {
    let plates = lines((1..=blocks).map(|k| {
        format!(
            r#"{{ "id": "b{k}", "origin": [0, "{}*h"], "size": ["b", "h"], "divisions": [2, 1], "thickness": "t", "material": "stone", "plane": "stress" }}"#,
            k - 1
        )
    }));
    let contacts = lines((1..=blocks).map(|k| match k {
        1 => r#"{ "id": "base", "edge": "b1.bottom", "against": "ground", "friction": "f" }"#.to_owned(),
        k => {
            let under = k - 1;
            format!(r#"{{ "id": "j{under}", "edge": "b{k}.bottom", "against": "b{under}.top", "friction": "f" }}"#)
        }
    }));
    TEXT.replace("BLOCKS", &blocks.to_string()).replace("// plates", &plates).replace("// contacts", &contacts)
}

const TEXT: &str = r#"{
  // Blocks that stand on one another without mortar, loaded at the top and shaken.
  "format": "stickslip/1",
  "title": "Stack of blocks",
  "description": "Blocks b wide, h high and t thick stand on one another without mortar; P presses on the top one and a horizontal acceleration g, as a part of gravity, acts on all of them. With W the weight of all, everything above the base slides at g = f (P + W)/W, or overturns at g = (P + W) b/(n h W) for n blocks, whichever is less: `limit quake`.",
  "units": { "length": "m", "force": "kN" },
  "parameters": {
    "b": { "value": 0.6, "min": 0.1, "max": 5, "step": 0.1, "unit": "m", "about": "width of a block" },
    "h": { "value": 0.4, "min": 0.1, "max": 5, "step": 0.1, "unit": "m", "about": "height of a block" },
    "t": { "value": 0.6, "min": 0.1, "max": 5, "step": 0.1, "unit": "m", "about": "thickness, out of the plane" },
    "gamma": { "value": 24, "min": 1, "max": 80, "step": 1, "unit": "kN/m³", "about": "weight per volume" },
    "f": { "value": 0.6, "min": 0, "max": 1.5, "step": 0.05, "about": "friction between the blocks and under them" },
    "g": { "value": 0.1, "min": -1, "max": 1, "step": 0.05, "about": "horizontal acceleration, as a part of gravity" },
    "P": { "value": 0, "min": 0, "max": 100, "step": 5, "unit": "kN", "about": "load on the top" },
    // shown, not set
    "n": { "formula": "BLOCKS", "about": "number of blocks" },
    "W": { "formula": "n*gamma*b*h*t", "unit": "kN", "about": "weight of all" },
    "slides": { "formula": "f*(P + W)/W", "about": "acceleration at which they slide" },
    "overturns": { "formula": "(P + W)*b/(n*h*W)", "about": "acceleration at which they overturn" }
  },
  // density: weight per volume, times an acceleration of 1
  "materials": { "stone": { "E": 2e7, "nu": 0.2, "density": "gamma" } },
  // b1 is the lowest
  "plates": [
    // plates
  ],
  "contacts": [
    // contacts
  ],
  "loads": {
    "weight": { "items": [{ "gravity": { "acceleration": [0, -1] } }] },
    "top": { "factor": "P", "items": [{ "point": { "at": "bBLOCKS.top", "force": [0, -1] } }] },
    "quake": { "factor": "g", "items": [{ "gravity": { "acceleration": [1, 0] } }] }
  },
  "probes": {
    "normal": "resultant base N",
    "shear": "resultant base T",
    "eccentricity": "resultant base e",
    "sway": "max u"
  }
}
"#;
