//! Two rings, one shrunk onto the other.

use super::{Count, Need, Template, lines};

pub const TEMPLATE: Template = Template {
    kind: "press-fit",
    counts: &[
        Count { name: "segments", default: 12, range: (2, 60), about: "number of elements around a quarter" },
        Count { name: "inner", default: 2, range: (1, 20), about: "number of elements through the inner ring" },
        Count { name: "outer", default: 3, range: (1, 20), about: "number of elements through the outer ring" },
    ],
    needs: &[
        Need { less: "a", than: "b", why: "the inner ring would have no wall" },
        Need { less: "b", than: "c", why: "the outer ring would have no wall" },
        Need { less: "d", than: "b/10", why: "no ring bears such an interference" },
    ],
    text: |counts| text(counts[0], counts[1], counts[2]),
};

/// A ring: the letter of its ids, its radii and layers.
struct Ring {
    id: char,
    radii: [&'static str; 2],
    layers: usize,
}

impl Ring {
    fn radius(&self, circle: usize) -> String {
        let [inside, outside] = self.radii;
        match circle {
            0 => inside.to_owned(),
            _ if circle == self.layers => outside.to_owned(),
            _ => format!("({inside} + {circle}/{}*({outside} - {inside}))", self.layers),
        }
    }

    fn nodes(&self, segments: usize) -> impl Iterator<Item = String> {
        (0..=self.layers).map(move |circle| {
            let radius = self.radius(circle);
            let node = |k: usize| match k {
                0 => format!(r#""{}{circle}-0": ["{radius}", 0]"#, self.id),
                _ if k == segments => format!(r#""{}{circle}-{k}": [0, "{radius}"]"#, self.id),
                _ => format!(r#""{}{circle}-{k}": ["{radius}*cos({k}*turn)", "{radius}*sin({k}*turn)"]"#, self.id),
            };
            (0..=segments).map(node).collect::<Vec<_>>().join(", ")
        })
    }

    fn quads(&self, segments: usize) -> impl Iterator<Item = String> {
        let id = self.id;
        (0..self.layers).flat_map(move |l| {
            (0..segments).map(move |k| {
                format!(
                    r#"{{ "id": "{id}q{l}-{k}", "nodes": ["{id}{l}-{k}", "{id}{u}-{k}", "{id}{u}-{n}", "{id}{l}-{n}"], "thickness": "w", "material": "steel", "plane": "stress", "element": "incompatible" }}"#,
                    u = l + 1,
                    n = k + 1
                )
            })
        })
    }

    fn edge(&self, circle: usize, segments: usize) -> String {
        (0..=segments).map(|k| format!(r#""{}{circle}-{k}""#, self.id)).collect::<Vec<_>>().join(", ")
    }

    fn supports(&self, segments: usize) -> impl Iterator<Item = String> {
        let id = self.id;
        (0..=self.layers).map(move |circle| {
            format!(
                r#"{{ "at": "{id}{circle}-0", "fixed": ["y"] }}, {{ "at": "{id}{circle}-{segments}", "fixed": ["x"] }}"#
            )
        })
    }
}

fn text(segments: usize, inner: usize, outer: usize) -> String {
    let inner = Ring { id: 'i', radii: ["a", "b"], layers: inner };
    let outer = Ring { id: 'o', radii: ["b", "c"], layers: outer };
    let both = [&inner, &outer];
    TEXT.replace("// nodes", &lines(both.iter().flat_map(|ring| ring.nodes(segments))))
        .replace("// quads", &lines(both.iter().flat_map(|ring| ring.quads(segments))))
        .replace("// supports", &lines(both.iter().flat_map(|ring| ring.supports(segments))))
        .replace("SEAT", &inner.edge(inner.layers, segments))
        .replace("BORE", &outer.edge(0, segments))
        .replace("INNER", &inner.layers.to_string())
        .replace("OUTER", &outer.layers.to_string())
        .replace("SEGMENTS", &segments.to_string())
        .replace("MIDDLE", &(segments / 2).to_string())
        .replace("HALFWAY", &(outer.layers / 2).to_string())
}

const TEXT: &str = r#"{
  // A quarter of two rings, the inner one too large by d: it is pressed, or shrunk, into the outer one.
  "format": "stickslip/1",
  "title": "Press fit of two rings",
  "description": "The inner ring (radii a and b) is larger than the bore of the outer one (b and c) by d in radius. Lame: for one material p = E d (b^2 - a^2)(c^2 - b^2)/(2 b^3 (c^2 - a^2)), the hoop stress at the bore is p (c^2 + b^2)/(c^2 - b^2). The mesh has SEGMENTS segments in a quarter; the error falls with the square of their size.",
  "units": { "length": "mm", "force": "N" },
  "parameters": {
    "d": { "value": 0.01, "min": 0, "max": 0.1, "step": 0.002, "unit": "mm", "about": "interference in radius" },
    "a": { "value": 10, "min": 1, "max": 100, "step": 1, "unit": "mm", "about": "bore of the inner ring" },
    "b": { "value": 20, "min": 2, "max": 200, "step": 1, "unit": "mm", "about": "radius of the seat" },
    "c": { "value": 35, "min": 3, "max": 300, "step": 1, "unit": "mm", "about": "outside of the outer ring" },
    "w": { "value": 1, "min": 0.1, "max": 100, "step": 1, "unit": "mm", "about": "width of the rings" },
    "E": { "value": 2.1e5, "min": 5e4, "max": 4e5, "step": 1e4, "unit": "N/mm²", "about": "modulus of both rings" },
    "f": { "value": 0.15, "min": 0, "max": 0.5, "step": 0.05, "about": "friction of the seat" },
    // shown, not set
    "p": {
      "formula": "E*d*(b^2 - a^2)*(c^2 - b^2)/(2*b^3*(c^2 - a^2))",
      "unit": "N/mm²",
      "about": "pressure by Lame"
    },
    "turn": { "formula": "pi/2/SEGMENTS", "about": "angle of a segment, in radians" },
    "segment": { "formula": "p*w*b*turn", "unit": "N", "about": "force on a segment by Lame" },
    "torque": { "formula": "f*p*2*pi*b^2*w", "unit": "N·mm", "about": "that the whole fit bears" }
  },
  "materials": { "steel": { "E": "E", "nu": 0.3 } },
  // i, o: inner and outer ring; circle from the inside; segment from the x axis
  "nodes": {
    // nodes
  },
  "quads": [
    // quads
  ],
  "edges": {
    "seat": [SEAT],
    "bore": [BORE]
  },
  // planes of symmetry
  "supports": [
    // supports
  ],
  // the joint is radial at its ends too, where symmetry holds the tangential direction already
  "contacts": [
    { "id": "first", "node": "iINNER-0", "against": "o0-0", "normal": [-1, 0], "law": "frictionless", "gap": "-d" },
    { "id": "fit", "edge": "seat", "against": "bore", "law": "coulomb", "friction": "f", "gap": "-d", "skip": [0, SEGMENTS] },
    { "id": "last", "node": "iINNER-SEGMENTS", "against": "o0-SEGMENTS", "normal": [0, -1], "law": "frictionless", "gap": "-d" }
  ],
  "probes": {
    "pair_force": "x_n fit[MIDDLE]",
    "hoop": "s1 oqHALFWAY-MIDDLE",
    "widening": "ux oOUTER-0"
  }
}
"#;
