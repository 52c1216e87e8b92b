//! `save`: the present values and rules, edited into the text of the file that was loaded.

use std::path::Path;

use jsonc_parser::ParseOptions;
use jsonc_parser::cst::{CstInputValue, CstObject, CstRootNode};
use thiserror::Error;

use crate::export::atomic;
use crate::model::amend::{self, Amended};
use crate::model::load::load_text;
use crate::model::parameter::ParameterValues;
use crate::model::problem::Problems;
use crate::model::rules::Rules;
use crate::model::scenario::Scenario;

/// A scenario that could not be saved; the file is as it was.
#[derive(Debug, Error)]
pub enum SaveError {
    /// The text of the file does not have the shape it had when it was loaded.
    #[error("cannot save: `{0}` was not found in the text of the scenario; please report this")]
    Shape(String),
    /// The edited text is not a scenario any more.
    #[error("cannot save, the edited scenario would not load; please report this: {0}")]
    Reload(Problems),
    /// The edited text means something else.
    #[error("cannot save, the edited scenario would load with another `{0}`; please report this")]
    Other(String),
    /// The file cannot be written.
    #[error("cannot save: {0}")]
    Write(#[from] atomic::WriteError),
}

/// Writes the scenario with `values` and `rules` to `path`: whole or not at all. Gives back what stands there now.
///
/// Everything that did not change keeps its place and its characters.
///
/// # Errors
/// [`SaveError`].
pub fn save(scenario: &Scenario, values: &ParameterValues, rules: Rules, path: &Path) -> Result<Scenario, SaveError> {
    let text = edited(scenario, values, rules, path)?;
    let again = load_text(&path.display().to_string(), &text, Some(path)).map_err(SaveError::Reload)?;
    if again.rules != rules {
        return Err(SaveError::Other("solver".into()));
    }
    let loaded = again.parameter_values();
    for (name, value) in values {
        if loaded.get(name).map(|value| value.to_bits()) != Some(value.to_bits()) {
            return Err(SaveError::Other(name.clone()));
        }
    }
    atomic::write(path, |out| out.write_all(text.as_bytes()))?;
    Ok(again)
}

/// The new text.
fn edited(scenario: &Scenario, values: &ParameterValues, rules: Rules, path: &Path) -> Result<String, SaveError> {
    let shape = |what: &str| SaveError::Shape(what.to_owned());
    let root =
        CstRootNode::parse(&scenario.text, &ParseOptions::default()).map_err(|_| shape("the outermost object"))?;
    let object = root.object_value().ok_or_else(|| shape("the outermost object"))?;
    for (name, value) in values.free() {
        let Some(file) = scenario.parameters.get(name) else {
            return Err(shape(name));
        };
        if file.value.to_bits() == value.to_bits() {
            continue;
        }
        amend::set_parameter(&object, name, Amended::Value, value).map_err(SaveError::Shape)?;
    }
    let file = scenario.rules;
    let changed: Vec<(&str, CstInputValue)> = [
        ("covering", file.covering != rules.covering, rules.covering.to_string()),
        ("tie_break", file.tie_break != rules.tie_break, rules.tie_break.to_string()),
        ("engine", file.engine != rules.engine, rules.engine.to_string()),
    ]
    .into_iter()
    .filter(|(_, changed, _)| *changed)
    .map(|(key, _, word)| (key, CstInputValue::String(word)))
    .chain((file.facets != rules.facets).then(|| ("facets", CstInputValue::Number(rules.facets.to_string()))))
    .chain((file.cone != rules.cone).then_some(("cone", CstInputValue::Bool(rules.cone))))
    .collect();
    if !changed.is_empty() {
        let solver = object.object_value_or_create("solver").ok_or_else(|| shape("solver"))?;
        for (key, value) in changed {
            put(&solver, key, value);
        }
    }
    keep_file_references(&object, scenario, path);
    Ok(root.to_string())
}

fn put(object: &CstObject, key: &str, value: CstInputValue) {
    match object.get(key) {
        Some(property) => property.set_value(value),
        None => {
            object.append(key, value);
        }
    }
}

/// A matrix or mesh file named relative to the old place is named in full when the scenario moves to another folder.
fn keep_file_references(object: &CstObject, scenario: &Scenario, path: &Path) {
    let Some(old) = scenario.path.as_deref() else {
        return;
    };
    let folder = |path: &Path| {
        let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
        std::fs::canonicalize(parent.unwrap_or(Path::new(".")))
    };
    let (Ok(from), Ok(to)) = (folder(old), folder(path)) else {
        return;
    };
    if from == to {
        return;
    }
    let system = object.object_value("contact_system");
    let matrix = |key: &str| system.as_ref().and_then(|system| system.object_value(key));
    let matrices = ["stiffness", "compliance"].into_iter().filter_map(|key| matrix(key)?.get("file"));
    let meshes = object.array_value("meshes").map(|meshes| meshes.elements()).unwrap_or_default();
    let meshes = meshes.into_iter().filter_map(|mesh| mesh.as_object()?.get("file"));
    for property in matrices.chain(meshes) {
        if let Some(name) = property.value().and_then(|value| value.as_string_lit())
            && let Ok(name) = name.decoded_value()
            && Path::new(&name).is_relative()
        {
            let full = from.join(name).display().to_string();
            property.set_value(CstInputValue::String(full));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::embedded;

    #[test]
    fn only_what_changed_is_written_anew() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("saved.json");
        let scenario = embedded::load("beam").unwrap();
        let mut values = scenario.parameter_values();
        let name = values.keys().next().unwrap().clone();
        let odd = 0.1 + 0.2;
        values.insert(name.clone(), odd);
        save(&scenario, &values, scenario.rules, &path).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let differing = text.lines().zip(scenario.text.lines()).filter(|(a, b)| a != b).count();
        assert_eq!(text.lines().count(), scenario.text.lines().count());
        assert_eq!(differing, 1);
        let again = crate::model::load::load_file(&path).unwrap();
        assert_eq!(again.parameters[&name].value.to_bits(), odd.to_bits());
    }

    #[test]
    fn rules_go_into_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("saved.json");
        let scenario = embedded::load("beam").unwrap();
        let rules =
            Rules { covering: "weight".parse().unwrap(), tie_break: "random:7".parse().unwrap(), ..scenario.rules };
        save(&scenario, &scenario.parameter_values(), rules, &path).unwrap();
        assert_eq!(crate::model::load::load_file(&path).unwrap().rules, rules);
    }
}
