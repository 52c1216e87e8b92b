//! How a report looks: its width, whether it may use colour, whether it must do without Unicode.

use std::io::{self, Write};

use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

use crate::answer::record::{OutcomeKind, State};
use crate::text::printable;

/// What the place that shows a report can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// Characters per line; no line gets longer.
    pub width: usize,
    /// Whether ANSI colours (the 16 of every terminal) may be used. Colour never carries meaning alone.
    pub color: bool,
    /// Whether everything must be printable ASCII.
    pub ascii: bool,
}

impl Default for Style {
    /// 80 columns, Unicode, no colour: what a pipe gets.
    fn default() -> Self {
        Style { width: 80, color: false, ascii: false }
    }
}

/// What a piece of text is, as far as its colour goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Plain text.
    Plain,
    /// Heading of a report.
    Title,
    /// Heading of a column.
    Header,
    /// Less important: units, legends, hints.
    Muted,
    /// An answer, a check that passed.
    Good,
    /// Worth a look.
    Warning,
    /// No answer, a check that failed.
    Bad,
    /// The present position, a changed value.
    Accent,
    /// State of a pair.
    State(State),
    /// The i-th of several curves.
    Series(usize),
}

impl Role {
    /// Role of an outcome.
    pub fn of_outcome(outcome: OutcomeKind) -> Role {
        match outcome {
            OutcomeKind::Ray => Role::Warning,
            outcome if outcome.is_answer() => Role::Good,
            _ => Role::Bad,
        }
    }

    /// SGR parameters; `None` for plain text.
    fn sgr(self) -> Option<&'static str> {
        // Colours of the curves: cyan, yellow, magenta, green, blue, red.
        const CURVES: [&str; 6] = ["36", "33", "35", "32", "34", "31"];
        match self {
            Role::Plain => None,
            Role::Title | Role::Header => Some("1"),
            Role::Muted => Some("90"),
            Role::Good => Some("32"),
            Role::Warning => Some("33"),
            Role::Bad => Some("1;31"),
            Role::Accent => Some("1;36"),
            Role::State(State::Stick) => Some("32"),
            Role::State(State::SlipPlus | State::Slip) => Some("33"),
            Role::State(State::SlipMinus) => Some("35"),
            Role::State(State::Open) => Some("34"),
            Role::State(State::Closed) => Some("36"),
            Role::Series(i) => Some(CURVES[i % CURVES.len()]),
        }
    }
}

impl Style {
    /// `text` in the colour of `role`, where colour is allowed.
    pub fn paint(&self, role: Role, text: &str) -> String {
        match role.sgr() {
            Some(sgr) if self.color && !text.is_empty() => format!("\x1b[{sgr}m{text}\x1b[0m"),
            _ => text.to_owned(),
        }
    }

    /// `text` in one line of the characters allowed here (see [`printable::line`]).
    pub fn text(&self, text: &str) -> String {
        let plain = printable::line(text);
        if !self.ascii || plain.is_ascii() {
            return plain;
        }
        let mut translated = String::with_capacity(plain.len());
        for c in plain.chars() {
            if c.is_ascii() {
                translated.push(c);
            } else {
                translated.push_str(ascii(c));
            }
        }
        translated
    }

    /// The dot between parts of a line.
    pub fn dot(&self) -> &'static str {
        if self.ascii { "-" } else { "·" }
    }

    /// The arrow of a change.
    pub fn arrow(&self) -> &'static str {
        if self.ascii { "->" } else { "→" }
    }

    /// Marks the present position in a list; one character.
    pub fn mark(&self) -> char {
        if self.ascii { '>' } else { '▸' }
    }

    /// Stands for what was left out.
    pub fn ellipsis(&self) -> &'static str {
        if self.ascii { "~" } else { "…" }
    }

    /// `text` cut to `width` characters, with an ellipsis if something is lost.
    pub fn fit(&self, text: &str, width: usize) -> String {
        if text.width() <= width {
            return text.to_owned();
        }
        let mut cut = String::new();
        let mut used = 0;
        for c in text.chars() {
            let w = c.width().unwrap_or(0);
            if used + w + 1 > width {
                break;
            }
            used += w;
            cut.push(c);
        }
        if width > 0 {
            cut.push_str(self.ellipsis());
        }
        cut
    }

    /// `text` broken between words into lines of at most `width` characters; a longer word is broken inside.
    pub fn wrap(&self, text: &str, width: usize) -> Vec<String> {
        let width = width.max(1);
        let mut lines = Vec::new();
        let mut line = String::new();
        for word in self.text(text).split_whitespace() {
            let gap = usize::from(!line.is_empty());
            if line.width() + gap + word.width() <= width {
                if gap == 1 {
                    line.push(' ');
                }
                line.push_str(word);
                continue;
            }
            if !line.is_empty() {
                lines.push(std::mem::take(&mut line));
            }
            for c in word.chars() {
                if line.width() + c.width().unwrap_or(0) > width && !line.is_empty() {
                    lines.push(std::mem::take(&mut line));
                }
                line.push(c);
            }
        }
        if !line.is_empty() {
            lines.push(line);
        }
        lines
    }

    /// Writes `text` in the colour of `role`, broken between words into lines of the width of the output.
    pub fn paragraph(&self, out: &mut dyn Write, role: Role, text: &str) -> io::Result<()> {
        self.wrap(text, self.width).iter().try_for_each(|line| writeln!(out, "{}", self.paint(role, line)))
    }

    /// An error as it is shown, its lines kept.
    pub fn error(&self, message: &str) -> String {
        let lines: Vec<String> = message.lines().map(|line| self.text(line)).collect();
        let gap = if lines.first().is_some_and(String::is_empty) { "" } else { " " };
        format!("{}{gap}{}", self.paint(Role::Bad, "error:"), lines.join("\n"))
    }

    /// The same for a reader at a terminal: lines that do not fit are broken between words.
    pub fn error_in_lines(&self, message: &str) -> String {
        const LABEL: &str = "error: ";
        let broken = |(index, line): (usize, &str)| -> Vec<String> {
            let line = self.text(line);
            let label = if index == 0 { LABEL } else { "" };
            if label.len() + line.width() <= self.width {
                return vec![line];
            }
            let indent = " ".repeat(line.len() - line.trim_start().len());
            let mut lines = self.wrap(&format!("{label}{line}"), self.width.saturating_sub(indent.len()));
            // A word as wide as the line goes on beneath the label, which is alone in its line then.
            if let Some(first) = lines.first_mut() {
                *first = first.strip_prefix(label.trim_end()).unwrap_or(first).trim_start().to_owned();
            }
            lines.into_iter().map(|line| format!("{indent}{line}")).collect()
        };
        let lines: Vec<String> = message.lines().enumerate().flat_map(broken).collect();
        self.error(&lines.join("\n"))
    }

    /// `label` and after it `text`, broken into lines that hang under the text's first word; under the label where that
    /// takes more than half of the width.
    pub fn hanging(&self, label: &str, text: &str) -> Vec<String> {
        let label = self.text(label);
        if label.width() > self.width / 2 {
            let lines = self.wrap(&format!("{label}{text}"), self.width.saturating_sub(2));
            let under = |(i, line): (usize, String)| if i == 0 { line } else { format!("  {line}") };
            return lines.into_iter().enumerate().map(under).collect();
        }
        let indent = label.width();
        let mut lines = self.wrap(text, self.width.saturating_sub(indent));
        if lines.is_empty() {
            lines.push(String::new());
        }
        for (i, line) in lines.iter_mut().enumerate() {
            let head = if i == 0 { self.fit(&label, indent) } else { " ".repeat(indent) };
            *line = self.fit(format!("{head}{line}").trim_end(), self.width);
        }
        lines
    }
}

/// ASCII for the characters this program uses; `?` for any other.
fn ascii(c: char) -> &'static str {
    match c {
        '·' | '−' | '–' | '—' | '⁻' => "-",
        '±' => "+-",
        '⁺' => "+",
        '→' => "->",
        '←' => "<-",
        '↗' => "/^",
        '↖' => "^\\",
        '↙' => "/v",
        '↘' => "\\v",
        '⊙' => "(.)",
        '⊗' => "(x)",
        'τ' => "t",
        '…' => "...",
        '≤' => "<=",
        '≥' => ">=",
        '≠' => "!=",
        '×' => "x",
        '²' => "2",
        '³' => "3",
        '⁴' => "4",
        '°' => "deg",
        'α' => "alpha",
        'φ' => "phi",
        'μ' => "mu",
        'µ' => "u", // of µm; the letter above is the Greek one
        'λ' => "lambda",
        'Δ' => "d",
        '√' => "sqrt ",
        '‖' => "|",
        'ᵀ' => "^T",
        '’' | '‘' | '′' => "'",
        '“' | '”' => "\"",
        '\u{304}' => "",
        '\u{a0}' => " ",
        _ => "?",
    }
}

/// `text` padded with spaces to `width` characters, at its right.
pub fn pad_right(text: &str, width: usize) -> String {
    format!("{text}{}", " ".repeat(width.saturating_sub(text.width())))
}

/// `text` padded with spaces to `width` characters, at its left.
pub fn pad_left(text: &str, width: usize) -> String {
    format!("{}{text}", " ".repeat(width.saturating_sub(text.width())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_is_never_cut() {
        let style = Style { width: 40, ..Style::default() };
        assert_eq!(
            style.hanging("note: ", "one two three four five six seven eight"),
            ["note: one two three four five six seven", "      eight",]
        );
        let label = "pivot 4 (p enters at 0) of 4: ";
        let lines = style.hanging(label, "pair c3 slips +; p falls to 0");
        assert_eq!(lines, ["pivot 4 (p enters at 0) of 4: pair c3", "  slips +; p falls to 0"]);
    }

    #[test]
    fn an_error_is_broken_between_words() {
        let style = Style { width: 30, ..Style::default() };
        let told = "unknown command `report`: `help` lists all commands\n  here: a line that is too long for them";
        assert_eq!(
            style.error_in_lines(told).lines().collect::<Vec<_>>(),
            [
                "error: unknown command",
                "`report`: `help` lists all",
                "commands",
                "  here: a line that is too",
                "  long for them",
            ]
        );
        assert_eq!(style.error_in_lines("short\nlines"), style.error("short\nlines"));
        // 29 letters fit into a line, but not beside the label
        let long = "x".repeat(29);
        assert_eq!(style.error_in_lines(&long), format!("error:\n{long}"));
        assert_eq!(style.error_in_lines(&format!("{long} is long")), format!("error:\n{long}\nis long"));
    }
}
