//! The user's configuration: `$XDG_CONFIG_HOME/stickslip/config.json` or `~/.config/stickslip/config.json`.
//!
//! ```json
//! { "keys": { "leave": "x", "step-on": ["right", "l"] }, "mouse": false, "explain": false }
//! ```

use std::path::Path;
use std::{fs, io};

use serde_json::Value;

use super::keymap::Keymap;
use crate::session::places;
use crate::text::file::reason;

/// What the user may choose.
#[derive(Clone, Debug)]
pub struct Config {
    /// The keys.
    pub keys: Keymap,
    /// Whether the mouse is taken at the start.
    pub mouse: bool,
    /// Whether the panes explain themselves at the start.
    pub explain: bool,
    /// What could not be understood, a sentence each; the rest holds.
    pub problems: Vec<String>,
}

impl Default for Config {
    fn default() -> Self {
        Config { keys: Keymap::default(), mouse: true, explain: true, problems: Vec::new() }
    }
}

/// The configuration of the user; the defaults if there is none.
pub fn load() -> Config {
    places::configuration().map_or_else(Config::default, |path| read(&path))
}

fn read(path: &Path) -> Config {
    let problem = |text: String| Config { problems: vec![format!("{}: {text}", path.display())], ..Config::default() };
    match fs::read_to_string(path) {
        Ok(text) => {
            let mut config = parse(&text);
            for problem in &mut config.problems {
                *problem = format!("{}: {problem}", path.display());
            }
            config
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => Config::default(),
        Err(error) => problem(format!("cannot be read: {}", reason(&error))),
    }
}

/// Reads the text of a configuration.
pub fn parse(text: &str) -> Config {
    let mut config = Config::default();
    let value: Value = match serde_json::from_str(text) {
        Ok(value) => value,
        Err(error) => {
            config.problems.push(error.to_string());
            return config;
        }
    };
    let Value::Object(entries) = value else {
        config.problems.push("expected an object { … }".into());
        return config;
    };
    for (key, value) in entries {
        match (key.as_str(), value) {
            ("mouse", Value::Bool(mouse)) => config.mouse = mouse,
            ("explain", Value::Bool(explain)) => config.explain = explain,
            ("keys", Value::Object(keys)) => {
                for (name, value) in keys {
                    let words = match &value {
                        Value::String(key) => vec![key.clone()],
                        Value::Array(keys) if keys.iter().all(Value::is_string) => {
                            keys.iter().filter_map(|key| key.as_str().map(ToOwned::to_owned)).collect()
                        }
                        _ => {
                            config.problems.push(format!("keys.{name}: expected a key or a list of keys"));
                            continue;
                        }
                    };
                    if let Err(problem) = config.keys.bind(&name, &words) {
                        config.problems.push(format!("keys.{problem}"));
                    }
                }
            }
            (key @ ("mouse" | "explain"), _) => config.problems.push(format!("{key}: expected true or false")),
            ("keys", _) => config.problems.push("keys: expected an object { \"action\": \"key\" }".into()),
            (key, _) => config.problems.push(format!("{key}: unknown; expected keys, mouse or explain")),
        }
    }
    config
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::action::Do;
    use crate::tui::bindings::Context;
    use crate::tui::key::Key;

    #[test]
    fn keys_are_taken_over_and_mistakes_told() {
        let config = parse(
            r#"{"keys": {"leave": "x", "play": ["ctrl-p"], "fly": "f", "up": 1, "down": "hyper"}, "mouse": false, "m": 1}"#,
        );
        let find = |key: &str| config.keys.find(Context::Everywhere, Key::parse(key).unwrap());
        assert_eq!(find("x"), Some(Do::Leave));
        assert_eq!(find("ctrl-p"), Some(Do::Play));
        assert!(!config.mouse);
        assert_eq!(config.problems.len(), 4, "{:?}", config.problems);
        assert_eq!(parse("{").problems.len(), 1);
        assert_eq!(parse("[]").problems.len(), 1);
        assert!(parse("{}").problems.is_empty());
    }
}
