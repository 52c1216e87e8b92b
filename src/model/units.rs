//! The author's units.

/// Labels of the author's units; nothing is converted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Units {
    /// Unit of length, e.g. `m`.
    pub length: Option<String>,
    /// Unit of force, e.g. `kN`.
    pub force: Option<String>,
}

impl Units {
    /// As a scenario has them; `None` without any.
    pub fn json(&self) -> Option<serde_json::Value> {
        let both = [("length", &self.length), ("force", &self.force)];
        let given = both.into_iter().filter_map(|(key, label)| Some((key.to_owned(), label.clone()?.into())));
        let given: serde_json::Map<String, serde_json::Value> = given.collect();
        (!given.is_empty()).then(|| given.into())
    }
}
