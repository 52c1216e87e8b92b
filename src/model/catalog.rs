//! Scenarios by name: those that come with the program, and files.

use std::path::Path;

use super::embedded;
use super::load::load_file;
use super::problem::Problems;
use super::scenario::Scenario;
use super::words::did_you_mean;

/// Loads what a user names: an embedded scenario, or a file if the word holds a slash, ends in `.json` or is the
/// name of an existing file that is not an embedded scenario.
pub fn load_named_or_file(word: &str) -> Result<Scenario, Problems> {
    let path = Path::new(word);
    let looks_like_a_path = word.contains(['/', std::path::MAIN_SEPARATOR])
        || path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"));
    if !looks_like_a_path {
        if embedded::text(word).is_some() {
            return embedded::load(word);
        }
        if !path.exists() {
            return Err(unknown(word));
        }
    }
    load_file(path)
}

fn unknown(word: &str) -> Problems {
    let names: Vec<&str> = embedded::names().collect();
    Problems::of_file(
        word,
        format!("no embedded scenario and no file has this name{}", did_you_mean(word, names.iter().copied())),
        format!("expected the path of a scenario file or one of {}", names.join(", ")),
    )
}
