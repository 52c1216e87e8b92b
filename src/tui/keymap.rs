//! The keys: one table. What a key does, the help, the line of hints and the names in the configuration file all
//! come from [`BINDINGS`].

use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

use super::action::{Action, Do};
use super::app::{Input, Overlay, Pane, State};

/// Where a key is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Context {
    /// In every pane, unless the pane has the key for itself.
    Everywhere,
    /// In a pane.
    Pane(Pane),
    /// During the tour, ahead of the panes.
    Tour,
    /// While something lies over the panes.
    Overlay,
    /// While a line is typed.
    Entry,
}

impl Context {
    /// In the order of the help.
    pub const ALL: [Context; 10] = [
        Context::Everywhere,
        Context::Pane(Pane::Structure),
        Context::Pane(Pane::Parameters),
        Context::Pane(Pane::Pairs),
        Context::Pane(Pane::Pivots),
        Context::Pane(Pane::Plot),
        Context::Pane(Pane::Answer),
        Context::Tour,
        Context::Overlay,
        Context::Entry,
    ];

    /// Its heading in the help.
    pub fn title(self) -> &'static str {
        match self {
            Context::Everywhere => "Everywhere",
            Context::Pane(pane) => pane.title(),
            Context::Tour => "Tour",
            Context::Overlay => "Help, output, answers",
            Context::Entry => "Typing a command or a value",
        }
    }
}

/// One row of the table.
#[derive(Clone, Copy, Debug)]
pub struct Binding {
    /// Where it holds.
    pub context: Context,
    /// Its name in the configuration file.
    pub name: &'static str,
    /// Its keys, as in the configuration file.
    pub keys: &'static [&'static str],
    /// What it does.
    pub action: Do,
    /// The same in words.
    pub help: &'static str,
    /// A word for the line of hints; rows that follow each other with the same word share it. Empty: not there.
    pub hint: &'static str,
}

const fn row(
    context: Context,
    name: &'static str,
    keys: &'static [&'static str],
    action: Do,
    help: &'static str,
    hint: &'static str,
) -> Binding {
    Binding { context, name, keys, action, help, hint }
}

use Context::{Entry, Everywhere, Overlay as Over, Tour};
const STRUCTURE: Context = Context::Pane(Pane::Structure);
const PARAMETERS: Context = Context::Pane(Pane::Parameters);
const PAIRS: Context = Context::Pane(Pane::Pairs);

/// All keys.
#[rustfmt::skip]
pub const BINDINGS: &[Binding] = &[
    row(Everywhere, "help", &["?", "f1"], Do::Help, "show the keys", "help"),
    row(Everywhere, "next-pane", &["tab"], Do::NextPane, "next pane", "pane"),
    row(Everywhere, "step-back", &["left"], Do::StepBack, "one pivot back: every pane shows it", "step"),
    row(Everywhere, "step-on", &["right"], Do::StepOn, "one pivot on", "step"),
    row(Everywhere, "up", &["up"], Do::Up, "select the row above; in Pivots one pivot back, in Plots the plot before", "select"),
    row(Everywhere, "down", &["down"], Do::Down, "select the row below", "select"),
    row(Everywhere, "more", &["+", "="], Do::Vary(10), "selected parameter one step up, solved at once", "vary"),
    row(Everywhere, "less", &["-", "_"], Do::Vary(-10), "one step down", "vary"),
    row(Everywhere, "command", &[":"], Do::Command, "type any command of the REPL; Tab completes", "command"),
    row(Everywhere, "leave", &["q"], Do::Leave, "leave: back to where it was started, shell or command line", "quit"),
    row(Everywhere, "maximize", &["z"], Do::Maximize, "give the pane the whole screen, or take it back", "large"),
    row(Everywhere, "exit", &["Q"], Do::Exit, "end the program", ""),
    row(Everywhere, "to-repl", &["R"], Do::ToRepl, "go on at the command line, same session", ""),
    row(Everywhere, "previous-pane", &["shift-tab"], Do::PreviousPane, "pane before", ""),
    row(Everywhere, "structure", &["1"], Do::Focus(Pane::Structure), "go to Structure", ""),
    row(Everywhere, "parameters", &["2"], Do::Focus(Pane::Parameters), "go to Parameters", ""),
    row(Everywhere, "pairs", &["3"], Do::Focus(Pane::Pairs), "go to Pairs", ""),
    row(Everywhere, "pivots", &["4"], Do::Focus(Pane::Pivots), "go to Pivots", ""),
    row(Everywhere, "plots", &["5"], Do::Focus(Pane::Plot), "go to Plots", ""),
    row(Everywhere, "answer", &["6"], Do::Focus(Pane::Answer), "go to Answer", ""),
    row(Everywhere, "page-up", &["pageup"], Do::PageUp, "ten rows up", ""),
    row(Everywhere, "page-down", &["pagedown"], Do::PageDown, "ten rows down", ""),
    row(Everywhere, "step-first", &["home"], Do::StepFirst, "first pivot: the entry of p", ""),
    row(Everywhere, "step-last", &["end"], Do::StepLast, "end of the run: the answer, or the ray", ""),
    row(Everywhere, "play", &["space"], Do::Play, "run through the pivots, or pause", ""),
    row(Everywhere, "coarse-more", &["]"], Do::Vary(100), "ten steps up", ""),
    row(Everywhere, "coarse-less", &["["], Do::Vary(-100), "ten steps down", ""),
    row(Everywhere, "fine-more", &["."], Do::Vary(1), "a tenth of a step up", ""),
    row(Everywhere, "fine-less", &[","], Do::Vary(-1), "a tenth of a step down", ""),
    row(Everywhere, "value", &["v"], Do::TypeValue, "type the value: 120, +10%, += 5", ""),
    row(Everywhere, "reset", &["r"], Do::Reset, "parameter back to the value of the file", ""),
    row(Everywhere, "undo", &["u"], Do::Undo, "take back the last change", ""),
    row(Everywhere, "redo", &["U", "ctrl-y"], Do::Redo, "do it again", ""),
    row(Everywhere, "next-plot", &["p"], Do::NextPlot, "next plot: slip, force, pressure, opening, p, M Q N", ""),
    row(Everywhere, "previous-plot", &["P"], Do::PreviousPlot, "plot before", ""),
    row(Everywhere, "answers", &["a"], Do::Answers, "all answers side by side, up to 10 pairs", ""),
    row(Everywhere, "mode", &["m"], Do::Mode, "let the mode of a ray move, or stop it", ""),
    row(Everywhere, "before", &["b"], Do::Before, "show or hide the answer before the last change", ""),
    row(Everywhere, "explain", &["e"], Do::Explain, "show or hide the line that explains each pane", ""),
    row(Everywhere, "stop", &["esc", "ctrl-c"], Do::Stop, "stop what is computed or played", ""),
    row(Everywhere, "mouse", &["M"], Do::Mouse, "leave the mouse to the terminal (to copy text), or take it", ""),
    row(Everywhere, "redraw", &["ctrl-l"], Do::Redraw, "draw everything anew", ""),
    row(Everywhere, "suspend", &["ctrl-z"], Do::Suspend, "stop the program until `fg`", ""),

    row(STRUCTURE, "zoom-in", &["i"], Do::ZoomIn, "enlarge", "zoom"),
    row(STRUCTURE, "zoom-out", &["o"], Do::ZoomOut, "shrink", "zoom"),
    row(STRUCTURE, "fit", &["f"], Do::Fit, "show all of it", ""),
    row(STRUCTURE, "pan-left", &["h"], Do::Pan(-1, 0), "look further left", ""),
    row(STRUCTURE, "pan-right", &["l"], Do::Pan(1, 0), "look further right", ""),
    row(STRUCTURE, "pan-up", &["k"], Do::Pan(0, 1), "look further up", ""),
    row(STRUCTURE, "pan-down", &["j"], Do::Pan(0, -1), "look further down", ""),
    row(STRUCTURE, "deform-more", &["d"], Do::DeformMore, "displacements larger", "scale"),
    row(STRUCTURE, "deform-less", &["D"], Do::DeformLess, "displacements smaller", "scale"),
    row(STRUCTURE, "deform-auto", &["A"], Do::DeformAuto, "displacements at the automatic scale", ""),

    row(PARAMETERS, "type-value", &["enter"], Do::TypeValue, "type the value", "type"),

    row(PAIRS, "sort", &["s"], Do::Sort, "sort by the next key", "sort"),
    row(PAIRS, "sort-reverse", &["S"], Do::SortReverse, "turn the order round", ""),

    row(Tour, "tour-next", &["enter"], Do::TourNext, "next step of the tour", ""),
    row(Tour, "tour-back", &["backspace"], Do::TourBack, "step before", ""),
    row(Tour, "tour-end", &["esc"], Do::TourEnd, "end the tour", ""),

    row(Over, "close", &["esc", "enter", "q", "ctrl-c"], Do::Close, "close", "close"),
    row(Over, "over-up", &["up", "k"], Do::Up, "a line up", "scroll"),
    row(Over, "over-down", &["down", "j"], Do::Down, "a line down", "scroll"),
    row(Over, "over-page-up", &["pageup", "b"], Do::PageUp, "a page up", ""),
    row(Over, "over-page-down", &["pagedown", "space"], Do::PageDown, "a page down", ""),
    row(Over, "over-top", &["home", "g"], Do::Top, "the top", ""),
    row(Over, "over-bottom", &["end", "G"], Do::Bottom, "the end", ""),
    row(Over, "over-command", &[":"], Do::Command, "type another command", "command"),
    row(Over, "over-help", &["?", "f1"], Do::Help, "show the keys", ""),
    row(Over, "over-redraw", &["ctrl-l"], Do::Redraw, "draw everything anew", ""),
    row(Over, "over-suspend", &["ctrl-z"], Do::Suspend, "stop the program until `fg`", ""),

    row(Entry, "accept", &["enter"], Do::Accept, "run it, take it", ""),
    row(Entry, "cancel", &["esc", "ctrl-c"], Do::Cancel, "drop it", ""),
    row(Entry, "complete", &["tab"], Do::Complete, "complete the word, then the next way to", ""),
    row(Entry, "history-back", &["up"], Do::HistoryBack, "line typed before", ""),
    row(Entry, "history-on", &["down"], Do::HistoryOn, "line typed after", ""),
    row(Entry, "cursor-left", &["left"], Do::CursorLeft, "cursor left", ""),
    row(Entry, "cursor-right", &["right"], Do::CursorRight, "cursor right", ""),
    row(Entry, "cursor-home", &["home", "ctrl-a"], Do::CursorHome, "cursor to the start", ""),
    row(Entry, "cursor-end", &["end", "ctrl-e"], Do::CursorEnd, "cursor to the end", ""),
    row(Entry, "backspace", &["backspace", "ctrl-h"], Do::Backspace, "delete before the cursor", ""),
    row(Entry, "delete", &["delete", "ctrl-d"], Do::Delete, "delete at the cursor", ""),
    row(Entry, "delete-to-start", &["ctrl-u"], Do::DeleteToStart, "delete to the start", ""),
    row(Entry, "delete-word", &["ctrl-w"], Do::DeleteWord, "delete the word before the cursor", ""),
    row(Entry, "entry-redraw", &["ctrl-l"], Do::Redraw, "draw everything anew", ""),
    row(Entry, "entry-suspend", &["ctrl-z"], Do::Suspend, "stop the program until `fg`", ""),
];

/// A key in a form that can be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Key {
    code: KeyCode,
    control: bool,
    alt: bool,
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

    /// (keys, word) for the line of hints in these places.
    pub fn hints(&self, contexts: &[Context], ascii: bool) -> Vec<(String, &'static str)> {
        let mut hints: Vec<(String, &'static str)> = Vec::new();
        for context in contexts {
            for (binding, keys) in BINDINGS.iter().zip(&self.keys) {
                let (true, Some(key)) = (binding.context == *context && !binding.hint.is_empty(), keys.first()) else {
                    continue;
                };
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

/// The places in which a key is looked for now, in this order.
pub fn contexts(state: &State) -> Vec<Context> {
    if state.input != Input::None {
        vec![Context::Entry]
    } else if state.overlay != Overlay::None {
        vec![Context::Overlay]
    } else {
        let mut contexts = Vec::new();
        if state.tour.is_some() {
            contexts.push(Context::Tour);
        }
        contexts.push(Context::Pane(state.focus));
        contexts.push(Context::Everywhere);
        contexts
    }
}

/// What a key press means now; `None` if nothing.
pub fn action(state: &State, event: &KeyEvent) -> Option<Action> {
    if event.kind == KeyEventKind::Release {
        return None;
    }
    let key = Key::of(event);
    for context in contexts(state) {
        if let Some(action) = state.keys.find(context, key) {
            return Some(Action::Do(action));
        }
    }
    match key {
        Key { code: KeyCode::Char(c), control: false, alt: false } if state.input != Input::None => {
            Some(Action::Type(c))
        }
        _ => None,
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
        let hints = Keymap::default().hints(&[Context::Everywhere], true);
        assert!(hints.contains(&("left/right".to_owned(), "step")));
    }
}
