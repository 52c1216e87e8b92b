//! From a file or a text to a checked [`Scenario`].

use std::path::{Path, PathBuf};

use super::decode::{self, Under};
use super::locate::position;
use super::memory;
use super::mesh;
use super::parameter::ParameterValues;
use super::problem::{Problem, Problems};
use super::scenario::Scenario;
use crate::text::file::{self, reason};

/// Reads and checks a scenario file; the scenario's name is the path as given.
pub fn load_file(path: &Path) -> Result<Scenario, Problems> {
    let name = path.display().to_string();
    if mesh::is_mesh_name(path) && path.exists() {
        let shown = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        return Err(Problems::of_file(
            name,
            "this is a mesh, not a scenario",
            format!(
                "name it in a scenario, \"meshes\": [{{ \"id\": \"m\", \"file\": {shown:?}, \"materials\": … }}]; \
                 `stickslip check` lists what it holds"
            ),
        ));
    }
    load_bytes(
        &name,
        file::read(path),
        Some(path),
        "give the path of a scenario file, or the name of an embedded scenario",
    )
}

/// Reads and checks a scenario from stdin; its name is `-`. Files it names are relative to the working directory.
pub fn load_stdin() -> Result<Scenario, Problems> {
    load_bytes("-", file::read_all(std::io::stdin().lock()), Some(Path::new("-")), "write a scenario into the pipe")
}

fn load_bytes(
    name: &str,
    bytes: std::io::Result<Vec<u8>>,
    path: Option<&Path>,
    help: &str,
) -> Result<Scenario, Problems> {
    let bytes =
        bytes.map_err(|error| Problems::of_file(name, format!("cannot read the file: {}", reason(&error)), help))?;
    if let Some(refusal) = memory::refusal(memory::for_text(bytes.len())) {
        return Err(Problems::of_file(name, format!("the scenario {refusal}"), "use fewer entries, or more memory"));
    }
    match String::from_utf8(bytes) {
        Ok(text) => load_text(name, &text, path),
        Err(error) => {
            let valid = error.utf8_error().valid_up_to();
            let text = String::from_utf8_lossy(&error.as_bytes()[..valid]);
            let (line, column) = position(&text, text.len());
            Err(Problems {
                file: name.to_owned(),
                problems: vec![Problem {
                    line,
                    column,
                    path: String::new(),
                    message: "the file is not UTF-8".into(),
                    help: "save it as UTF-8".into(),
                }],
                more: 0,
            })
        }
    }
}

/// Checks the text of a scenario. `path` is the file it came from: other files it names are relative to it.
pub fn load_text(name: &str, text: &str, path: Option<&Path>) -> Result<Scenario, Problems> {
    decode::scenario(name, text, path.map(PathBuf::from), Under::default())
}

/// The scenario read once more, with its numbers under other values of its parameters.
///
/// # Errors
/// A model that these values make invalid, with the place.
pub fn at_values(scenario: &Scenario, values: &ParameterValues) -> Result<Scenario, Problems> {
    let under = Under { values: Some(values), along: None, meshes: scenario.meshes.clone() };
    decode::scenario(&scenario.name, &scenario.text, scenario.path.clone(), under)
}

/// The scenario with the rates of its loads along a parameter in place of their values: what the loads of every
/// case grow by per unit of it, its factor aside.
///
/// # Errors
/// A number of the loads that is not a linear function of it, with the place.
pub fn rates_along(scenario: &Scenario, values: &ParameterValues, parameter: &str) -> Result<Scenario, Problems> {
    let under = Under { values: Some(values), along: Some(parameter), meshes: scenario.meshes.clone() };
    decode::scenario(&scenario.name, &scenario.text, scenario.path.clone(), under)
}
