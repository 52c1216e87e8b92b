//! A portal frame that stands on its footings by weight alone.

use super::{Need, Template};

pub const TEMPLATE: Template = Template {
    kind: "portal",
    counts: &[],
    needs: &[Need { less: "b", than: "L", why: "the footings would overlap" }],
    text: |_| include_str!("../../../scenarios/portal.json").to_owned(),
};
