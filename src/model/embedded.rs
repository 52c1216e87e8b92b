//! The scenarios that come with the program, the same files as in `scenarios/`.

use super::load::load_text;
use super::problem::Problems;
use super::scenario::Scenario;

macro_rules! embedded {
    ($($name:literal),* $(,)?) => {
        /// Name and text, the default first.
        const SCENARIOS: &[(&str, &str)] = &[
            $(($name, include_str!(concat!("../../scenarios/", $name, ".json")))),*
        ];
    };
}

embedded!(
    "beam",
    "beam-limit",
    "beam-ray",
    "frame",
    "frame-rotated",
    "plates-hinged",
    "plates-free",
    "plates-slide",
    "block",
    "slope",
    "klarbring",
    "gap",
    "portal",
    "continuous-beam",
    "pipeline",
    "dam",
    "retaining-wall",
    "footing",
    "foundation",
    "arch",
    "wall",
    "press-fit",
    "tendon",
    "isolator",
    "bearing-two-way",
    "block-3d",
    "tower",
    "pipe-loop",
    "ratchet",
    "hertz",
    "greco",
    "murty6",
    "cycling",
    "painleve",
);

/// The scenario that opens when none is named.
pub const DEFAULT: &str = "beam";

/// The names, in the order of the list.
pub fn names() -> impl Iterator<Item = &'static str> {
    SCENARIOS.iter().map(|(name, _)| *name)
}

/// Name and title of every embedded scenario.
pub fn list() -> Vec<(&'static str, String)> {
    SCENARIOS
        .iter()
        .map(|(name, text)| {
            // A test loads every one of them, so the title is always there.
            let title = load_text(name, text, None).map_or(String::new(), |scenario| scenario.title);
            (*name, title)
        })
        .collect()
}

/// The text of an embedded scenario.
pub fn text(name: &str) -> Option<&'static str> {
    SCENARIOS.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// Loads an embedded scenario by its name.
pub fn load(name: &str) -> Result<Scenario, Problems> {
    match text(name) {
        Some(text) => load_text(name, text, None),
        None => Err(Problems::of_file(
            name,
            "no embedded scenario has this name",
            format!("expected one of {}", names().collect::<Vec<_>>().join(", ")),
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scenario_loads_and_has_a_title_and_a_description() {
        for name in names() {
            match load(name) {
                Ok(scenario) => {
                    assert!(scenario.description.is_some(), "{name}");
                    for (parameter, of) in &scenario.parameters {
                        assert!(of.about.is_some(), "{name}: {parameter}");
                        let slider = of.min.is_some() && of.max.is_some() && of.step.is_some();
                        assert!(slider || of.formula.is_some(), "{name}: {parameter}");
                    }
                }
                Err(problems) => panic!("{problems}"),
            }
        }
        assert!(list().iter().all(|(_, title)| !title.is_empty()));
        assert_eq!(list()[0].0, DEFAULT);
    }
}
