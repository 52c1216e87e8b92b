//! A gravity dam with water level and uplift.

use super::{Need, Template};

pub const TEMPLATE: Template = Template {
    kind: "dam",
    counts: &[],
    needs: &[Need { less: "crest", than: "B", why: "the downstream face would overhang" }],
    text: |_| include_str!("../../../scenarios/dam.json").to_owned(),
};
