//! A beam over several spans, on bearings that can lift off and settle.

use super::{Count, Template, lines};

pub const TEMPLATE: Template = Template {
    kind: "continuous-beam",
    counts: &[Count { name: "spans", default: 3, range: (1, 40), about: "number of spans" }],
    needs: &[],
    text: |counts| text(counts[0]),
};

fn text(spans: usize) -> String {
    let lengths = (1..=spans).map(|k| {
        format!(
            r#""L{k}": {{ "value": 10, "min": 2, "max": 50, "step": 1, "unit": "m", "about": "length of span {k}" }}"#
        )
    });
    let settlements = (1..=spans + 1).map(|k| {
        let value = if k == 2 { "0.02" } else { "0" };
        format!(
            r#""s{k}": {{ "value": {value}, "min": 0, "max": 0.1, "step": 0.005, "unit": "m", "about": "settlement of bearing {k}" }}"#
        )
    });
    let places = (1..=spans + 1).map(|k| {
        let formula = match k {
            1 => "0".to_owned(),
            k => format!("x{} + L{}", k - 1, k - 1),
        };
        format!(r#""x{k}": {{ "formula": "{formula}", "unit": "m", "about": "place of bearing {k}" }}"#)
    });
    let bars = (1..=spans).map(|k| {
        format!(
            r#"{{ "id": "span{k}", "nodes": ["b{k}", "b{}"], "material": "steel", "section": "girder", "divisions": 4 }}"#,
            k + 1
        )
    });
    let line = |k| format!(r#"{{ "line": {{ "bar": "span{k}", "value": [0, -1] }} }}"#);
    let nodes = (1..=spans + 1).map(|k| format!(r#""b{k}": ["x{k}", 0], "head{k}": ["x{k}", 0]"#));
    let supports = (1..=spans + 1).map(|k| {
        format!(r#"{{ "at": "head{k}", "fixed": ["x", "y"], "settlement": [0, "-s{k}"], "case": "settlement" }}"#)
    });
    let contacts = (1..=spans + 1).map(|k| {
        format!(r#"{{ "id": "c{k}", "node": "b{k}", "against": "head{k}", "normal": [0, 1], "law": "frictionless" }}"#)
    });
    let reactions = (1..=spans + 1).map(|k| format!(r#""R{k}": "x_n c{k}""#));
    let supported = (2..=spans).map(|k| format!(r#""M{k}": "M span{} end""#, k - 1));
    let field = (1..=spans).map(|k| format!(r#""field{k}": "max M span{k}""#));
    TEXT.replace("// lengths", &lines(lengths))
        .replace("// settlements", &lines(settlements))
        .replace("// places", &lines(places))
        .replace("// nodes", &lines(nodes))
        .replace("// bars", &lines(bars))
        .replace("// supports", &lines(supports))
        .replace("// contacts", &lines(contacts))
        .replace("// items", &(1..=spans).map(line).collect::<Vec<_>>().join(",\n        "))
        .replace("// probes", &lines(reactions.chain(supported).chain(field)))
}

const TEXT: &str = r#"{
  // A beam over several spans. Its bearings carry compression only, and each may settle.
  "format": "stickslip/1",
  "title": "Continuous beam on bearings that settle",
  "description": "A beam under a uniform load q on bearings that can lift off; bearing k settles by s_k. While all bearings carry, Clapeyron's equation of three moments gives the moments over them; a bearing that settles further than the beam follows lifts off, and two spans become one.",
  "units": { "length": "m", "force": "kN" },
  "parameters": {
    // lengths,
    "q": { "value": 30, "min": 0, "max": 100, "step": 5, "unit": "kN/m", "about": "uniform load" },
    "I": { "value": 0.004, "min": 0.0001, "max": 0.1, "step": 0.0005, "unit": "m⁴", "about": "inertia of the beam" },
    "A": { "value": 0.05, "min": 0.001, "max": 1, "step": 0.01, "unit": "m²", "about": "area of the beam" },
    // settlements,
    // shown, not set
    // places
  },
  "materials": { "steel": { "E": 2.1e8, "nu": 0.3 } },
  "sections": { "girder": { "area": "A", "inertia": "I" } },
  // b, the beam; head, that of the pier under it
  "nodes": {
    // nodes
  },
  "bars": [
    // bars
  ],
  "supports": [
    { "at": "b1", "fixed": ["x"] }, // the fixed bearing; the others slide
    // supports
  ],
  "contacts": [
    // contacts
  ],
  "loads": {
    "load": {
      "factor": "q",
      "items": [
        // items
      ]
    },
    "settlement": { "items": [] } // times the settlements of the piers
  },
  "combinations": {
    "before": { "load": 1.35 },
    "after": { "load": 1.35, "settlement": 1 },
    "emptied": { "load": 0.5, "settlement": 1 }
  },
  "probes": {
    // probes
  }
}
"#;
