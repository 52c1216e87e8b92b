//! A footing on ground that cannot pull.

use super::{Need, Template};

pub const TEMPLATE: Template = Template {
    kind: "footing",
    counts: &[],
    needs: &[Need { less: "e", than: "B/2", why: "the load would act beside the footing" }],
    text: |_| include_str!("../../../scenarios/footing.json").to_owned(),
};
