//! A voussoir arch, shaken.

use super::{Count, Need, Template, lines};

pub const TEMPLATE: Template = Template {
    kind: "arch",
    counts: &[Count { name: "blocks", default: 15, range: (3, 99), about: "number of blocks" }],
    needs: &[
        Need { less: "t", than: "2*R", why: "the arch would have no opening" },
        Need { less: "alpha", than: "175", why: "the arch would close to a ring" },
    ],
    text: |counts| text(counts[0]),
};

fn text(blocks: usize) -> String {
    // a joint k has its inner node at the end of block k and one more at the start of the next
    let node = |id: String, radius: &str, joint: usize| {
        format!(r#""{id}": ["{radius}*cos(start + {joint}*step)", "{radius}*sin(start + {joint}*step)"]"#)
    };
    let nodes = lines((1..=blocks).map(|k| {
        [("a", "inside", k - 1), ("b", "outside", k - 1), ("c", "outside", k), ("d", "inside", k)]
            .map(|(corner, radius, joint)| node(format!("{corner}{k}"), radius, joint))
            .join(", ")
    }));
    let quads = lines((1..=blocks).map(|k| {
        format!(
            r#"{{ "id": "v{k}", "nodes": ["a{k}", "b{k}", "c{k}", "d{k}"], "thickness": "w", "material": "stone", "plane": "stress" }}"#
        )
    }));
    let contact = |id: String, node: String, against: String, joint: usize, sign: &str, other: &str| {
        format!(
            r#"{{ "id": "{id}", "node": "{node}", "against": "{against}", "normal": ["{sign}sin(start + {joint}*step)", "{other}cos(start + {joint}*step)"], "friction": "f" }}"#
        )
    };
    let contacts = lines((0..=blocks).flat_map(|joint| {
        let (before, after) = (joint, joint + 1);
        [("in", "a", "d"), ("out", "b", "c")].map(|(side, first, last)| match joint {
            0 => contact(format!("right-{side}"), format!("{first}1"), "ground".into(), 0, "-", ""),
            _ if joint == blocks => {
                contact(format!("left-{side}"), format!("{last}{blocks}"), "ground".into(), blocks, "", "-")
            }
            _ => contact(
                format!("j{joint}-{side}"),
                format!("{first}{after}"),
                format!("{last}{before}"),
                joint,
                "-",
                "",
            ),
        })
    }));
    TEXT.replace("BLOCKS", &blocks.to_string())
        .replace("// nodes", &nodes)
        .replace("// quads", &quads)
        .replace("// contacts", &contacts)
}

const TEXT: &str = r#"{
  // Dry blocks in an arch: each touches the next at the inner and at the outer edge of their joint.
  "format": "stickslip/1",
  "title": "Voussoir arch",
  "description": "An arch of mean radius R and thickness t, w wide, stands by its own weight; seen from its centre it reaches alpha to both sides of the crown. A thin half circle falls by itself: with much friction one of many blocks needs t/R above 0.107. A horizontal acceleration g, as a part of gravity, brings it down at `limit quake`.",
  "units": { "length": "m", "force": "kN" },
  "parameters": {
    "R": { "value": 2, "min": 0.5, "max": 20, "step": 0.5, "unit": "m", "about": "mean radius" },
    "t": { "value": 0.3, "min": 0.05, "max": 2, "step": 0.05, "unit": "m", "about": "thickness of the arch" },
    "w": { "value": 1, "min": 0.1, "max": 10, "step": 0.1, "unit": "m", "about": "width, out of the plane" },
    "alpha": { "value": 90, "min": 20, "max": 90, "step": 5, "unit": "°", "about": "angle from the crown to a springing; 90 is a half circle" },
    "gamma": { "value": 24, "min": 1, "max": 80, "step": 1, "unit": "kN/m³", "about": "weight per volume" },
    "f": { "value": 0.7, "min": 0, "max": 1.5, "step": 0.05, "about": "friction in the joints" },
    "g": { "value": 0, "min": -0.5, "max": 0.5, "step": 0.01, "about": "horizontal acceleration, as a part of gravity" },
    // shown, not set
    "inside": { "formula": "R - t/2", "unit": "m", "about": "radius of the intrados" },
    "outside": { "formula": "R + t/2", "unit": "m", "about": "radius of the extrados" },
    "start": { "formula": "pi/2 - alpha*pi/180", "about": "angle of the right springing from the x axis, in radians" },
    "step": { "formula": "2*alpha*pi/180/BLOCKS", "about": "angle of a block, in radians" },
    "W": { "formula": "BLOCKS*gamma*w*R*t*sin(step)", "unit": "kN", "about": "weight of the arch" }
  },
  // density: weight per volume, times an acceleration of 1
  "materials": { "stone": { "E": 2e7, "nu": 0.2, "density": "gamma" } },
  // block k from the right springing: a, d inside, b, c outside
  "nodes": {
    // nodes
  },
  "quads": [
    // quads
  ],
  "contacts": [
    // contacts
  ],
  "loads": {
    "weight": { "items": [{ "gravity": { "acceleration": [0, -1] } }] },
    "quake": { "factor": "g", "items": [{ "gravity": { "acceleration": [1, 0] } }] }
  },
  "probes": {
    "springing": "sum x_n right-*",
    "springing_shear": "sum x_t right-*",
    "open": "count open *",
    "slipping": "count slip+ *",
    "sway": "max u"
  }
}
"#;
