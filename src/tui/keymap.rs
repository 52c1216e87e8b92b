//! The keys in force: the table with those of the configuration file.

use super::action::Do;
use super::bindings::{BINDINGS, Binding, Context};
use super::key::Key;

/// The keys in force: the table with the user's own.
#[derive(Clone, Debug)]
pub struct Keymap {
    /// Keys of each row of [`BINDINGS`].
    keys: Vec<Vec<Key>>,
}

impl Default for Keymap {
    fn default() -> Self {
        Keymap {
            keys: BINDINGS.iter().map(|binding| binding.keys.iter().filter_map(|k| Key::parse(k)).collect()).collect(),
        }
    }
}

impl Keymap {
    /// Gives a row other keys; another row of the same place that had one of them loses it.
    ///
    /// # Errors
    /// No such row, or no such key: a sentence for the user.
    pub fn bind(&mut self, name: &str, keys: &[String]) -> Result<(), String> {
        let Some(row) = BINDINGS.iter().position(|binding| binding.name == name) else {
            return Err(format!("no action `{name}`: `?` lists the keys, the manual their names"));
        };
        let mut parsed = Vec::new();
        for key in keys {
            parsed.push(Key::parse(key).ok_or_else(|| {
                format!("{name}: no key `{key}`; expected a character, ctrl-x, alt-x, f1 … f12, left, pageup, tab …")
            })?);
        }
        for (other, binding) in BINDINGS.iter().enumerate() {
            if binding.context == BINDINGS[row].context {
                self.keys[other].retain(|key| !parsed.contains(key));
            }
        }
        self.keys[row] = parsed;
        Ok(())
    }

    /// What a key does in a place.
    pub fn find(&self, context: Context, key: Key) -> Option<Do> {
        BINDINGS
            .iter()
            .zip(&self.keys)
            .find(|(binding, keys)| binding.context == context && keys.contains(&key))
            .map(|(binding, _)| binding.action)
    }

    /// The rows of a place: keys as shown, and the row.
    pub fn rows(&self, context: Context, ascii: bool) -> Vec<(String, &'static Binding)> {
        BINDINGS
            .iter()
            .zip(&self.keys)
            .filter(|(binding, _)| binding.context == context)
            .map(|(binding, keys)| {
                let labels: Vec<String> = keys.iter().map(|key| key.label(ascii)).collect();
                (labels.join(" "), binding)
            })
            .collect()
    }

    /// The keys that do something in a place, as shown.
    pub fn of(&self, context: Context, action: Do, ascii: bool) -> String {
        let found = self.rows(context, ascii).into_iter().find(|(_, binding)| binding.action == action);
        found.map_or(String::new(), |(keys, _)| keys)
    }

    /// (keys, word) for the line of hints in these places.
    pub fn hints(&self, contexts: &[Context], ascii: bool) -> Vec<(String, &'static str)> {
        let mut hints: Vec<(String, &'static str)> = Vec::new();
        for (number, context) in contexts.iter().enumerate() {
            let taken = |key| contexts[..number].iter().any(|before| self.find(*before, key).is_some());
            for (binding, keys) in BINDINGS.iter().zip(&self.keys) {
                let (true, Some(key)) = (binding.context == *context && !binding.hint.is_empty(), keys.first()) else {
                    continue;
                };
                if taken(*key) {
                    continue;
                }
                let label = key.label(ascii);
                match hints.last_mut().filter(|(_, word)| *word == binding.hint) {
                    Some((keys, _)) => {
                        // `←→`, but `left/right`
                        if label.chars().count() > 1 {
                            keys.push('/');
                        }
                        keys.push_str(&label);
                    }
                    None => hints.push((label, binding.hint)),
                }
            }
        }
        hints
    }
}

/// The table as Markdown, for the manual.
pub fn manual() -> String {
    let keymap = Keymap::default();
    let mut text = String::new();
    for context in Context::ALL {
        let rows = keymap.rows(context, false);
        if rows.is_empty() {
            continue;
        }
        text.push_str(&format!("\n{}\n\n| key | name | what it does |\n| --- | --- | --- |\n", context.title()));
        for (keys, binding) in rows {
            let keys = keys.replace('|', "\\|");
            text.push_str(&format!("| {keys} | `{}` | {} |\n", binding.name, binding.help));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::pane::Pane;
    use std::collections::HashSet;

    #[test]
    fn no_key_is_bound_twice_in_a_place_and_every_row_is_documented() {
        let mut seen = HashSet::new();
        let mut names = HashSet::new();
        for binding in BINDINGS {
            assert!(names.insert(binding.name), "{} twice", binding.name);
            assert!(!binding.help.is_empty() && !binding.keys.is_empty());
            for key in binding.keys {
                let key = Key::parse(key).unwrap_or_else(|| panic!("{key}"));
                assert!(seen.insert((binding.context, key)), "{} twice in {:?}", key.label(false), binding.context);
            }
            assert!(Context::ALL.contains(&binding.context));
        }
    }

    #[test]
    fn own_keys_take_over() {
        let mut keymap = Keymap::default();
        keymap.bind("leave", &["x".into(), "+".into()]).unwrap();
        let find = |text: &str| keymap.find(Context::Everywhere, Key::parse(text).unwrap());
        assert_eq!(find("x"), Some(Do::Leave));
        assert_eq!(find("+"), Some(Do::Leave));
        assert_eq!(find("="), Some(Do::Vary(10)));
        assert_eq!(find("q"), None);
        assert!(keymap.bind("nothing", &[]).is_err());
        assert!(keymap.bind("leave", &["hyper".into()]).is_err());
    }

    #[test]
    fn hints_share_a_word() {
        let hints = Keymap::default().hints(&[Context::Everywhere], false);
        assert!(hints.contains(&("←→".to_owned(), "step")));
        assert!(hints.contains(&("+-".to_owned(), "vary")));
        // a key means what it does in the pane
        let hints = Keymap::default().hints(&[Context::Pane(Pane::Map), Context::Everywhere], false);
        assert_eq!(hints.iter().filter(|(keys, _)| keys == "←→").collect::<Vec<_>>(), [&("←→".to_owned(), "move")]);
        let hints = Keymap::default().hints(&[Context::Everywhere], true);
        assert!(hints.contains(&("left/right".to_owned(), "step")));
    }
}
