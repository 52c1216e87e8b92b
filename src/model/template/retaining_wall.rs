//! A cantilever retaining wall.

use super::{Need, Template};

pub const TEMPLATE: Template = Template {
    kind: "retaining-wall",
    counts: &[],
    needs: &[Need { less: "phi", than: "90", why: "no earth has such an angle of friction" }],
    text: |_| include_str!("../../../scenarios/retaining-wall.json").to_owned(),
};
