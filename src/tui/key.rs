//! A key: read from the configuration, taken from an event, shown in the help.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// A key in a form that can be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Key {
    /// The key without modifiers.
    pub code: KeyCode,
    /// Whether Ctrl is held.
    pub control: bool,
    /// Whether Alt is held.
    pub alt: bool,
}

/// Names of keys that are no characters.
const NAMED: &[(&str, KeyCode, &str)] = &[
    ("left", KeyCode::Left, "←"),
    ("right", KeyCode::Right, "→"),
    ("up", KeyCode::Up, "↑"),
    ("down", KeyCode::Down, "↓"),
    ("home", KeyCode::Home, "Home"),
    ("end", KeyCode::End, "End"),
    ("pageup", KeyCode::PageUp, "PgUp"),
    ("pagedown", KeyCode::PageDown, "PgDn"),
    ("tab", KeyCode::Tab, "Tab"),
    ("shift-tab", KeyCode::BackTab, "Shift-Tab"),
    ("enter", KeyCode::Enter, "Enter"),
    ("esc", KeyCode::Esc, "Esc"),
    ("backspace", KeyCode::Backspace, "Backspace"),
    ("delete", KeyCode::Delete, "Del"),
    ("insert", KeyCode::Insert, "Ins"),
    ("space", KeyCode::Char(' '), "Space"),
];

impl Key {
    /// Reads `q`, `Q`, `ctrl-z`, `alt-x`, `f1`, `pageup`, `space`.
    pub fn parse(text: &str) -> Option<Key> {
        let mut rest = text;
        let (mut control, mut alt) = (false, false);
        loop {
            if let Some(more) = rest.strip_prefix("ctrl-").filter(|more| !more.is_empty()) {
                (control, rest) = (true, more);
            } else if let Some(more) = rest.strip_prefix("alt-").filter(|more| !more.is_empty()) {
                (alt, rest) = (true, more);
            } else {
                break;
            }
        }
        let mut characters = rest.chars();
        let code = match (characters.next(), characters.next()) {
            (Some(c), None) => KeyCode::Char(c),
            _ => match NAMED.iter().find(|(name, _, _)| *name == rest) {
                Some((_, code, _)) => *code,
                None => KeyCode::F(rest.strip_prefix('f')?.parse().ok().filter(|n| (1..=12).contains(n))?),
            },
        };
        Some(Key { code, control, alt })
    }

    /// The key of an event.
    pub fn of(event: &KeyEvent) -> Key {
        let control = event.modifiers.contains(KeyModifiers::CONTROL);
        let code = match event.code {
            // with Ctrl the case depends on the terminal
            KeyCode::Char(c) if control => KeyCode::Char(c.to_ascii_lowercase()),
            code => code,
        };
        Key { code, control, alt: event.modifiers.contains(KeyModifiers::ALT) }
    }

    /// As it is shown.
    pub fn label(&self, ascii: bool) -> String {
        let mut label = String::new();
        if self.control {
            label.push_str("Ctrl-");
        }
        if self.alt {
            label.push_str("Alt-");
        }
        match NAMED.iter().find(|(_, code, _)| *code == self.code) {
            Some((name, _, shown)) if ascii && !shown.is_ascii() => label.push_str(name),
            Some((_, _, shown)) => label.push_str(shown),
            None => match self.code {
                KeyCode::Char(c) if self.control => label.extend(c.to_uppercase()),
                KeyCode::Char(c) => label.push(c),
                KeyCode::F(n) => label.push_str(&format!("F{n}")),
                _ => label.push('?'),
            },
        }
        label
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_have_names() {
        for (text, label) in [
            ("q", "q"),
            ("ctrl-z", "Ctrl-Z"),
            ("alt-x", "Alt-x"),
            ("pageup", "PgUp"),
            ("f12", "F12"),
            ("space", "Space"),
            ("-", "-"),
            ("left", "←"),
            ("shift-tab", "Shift-Tab"),
        ] {
            assert_eq!(Key::parse(text).unwrap().label(false), label);
        }
        for text in ["", "qq", "f0", "f13", "ctrl-", "hyper-x"] {
            assert_eq!(Key::parse(text), None, "{text}");
        }
        assert_eq!(Key::parse("left").unwrap().label(true), "left");
    }
}
