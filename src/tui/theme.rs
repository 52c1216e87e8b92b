//! Colours and characters of the screen, the same roles as in the reports.

use ratatui::style::{Color, Modifier, Style};
use ratatui::symbols::border;
use ratatui::text::{Line, Span};

use crate::view::style::{self, Role};

/// What the terminal may show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Look {
    /// Whether the 16 colours are used; without them bold, underline and reverse remain.
    pub color: bool,
    /// Whether everything must be printable ASCII.
    pub ascii: bool,
}

impl Look {
    /// The look of a report that is `width` characters wide.
    pub fn report(&self, width: usize) -> style::Style {
        style::Style { width, color: self.color, ascii: self.ascii }
    }

    /// Text in the characters allowed here.
    pub fn text(&self, text: &str) -> String {
        self.report(80).text(text)
    }

    /// `text` cut to `width` characters.
    pub fn fit(&self, text: &str, width: usize) -> String {
        let report = self.report(width);
        report.fit(&report.text(text), width)
    }

    /// The style of a role.
    pub fn role(&self, role: Role) -> Style {
        let painted = style::Style { color: true, ..self.report(80) }.paint(role, "x");
        let mut style =
            self.lines(&painted).first().and_then(|line| line.spans.first().map(|span| span.style)).unwrap_or_default();
        if !self.color {
            style.fg = None;
        }
        style
    }

    /// What is selected.
    pub fn selected(&self) -> Style {
        Style::new().add_modifier(Modifier::REVERSED)
    }

    /// The border of a pane.
    pub fn border(&self, focused: bool) -> Style {
        match (focused, self.color) {
            (true, true) => self.role(Role::Accent),
            (true, false) => Style::new().add_modifier(Modifier::BOLD),
            (false, _) => self.role(Role::Muted),
        }
    }

    /// The characters of a border; a pane with the focus has a double line, so that colour is not needed to see it.
    pub fn border_set(&self, focused: bool) -> border::Set<'static> {
        match (self.ascii, focused) {
            (false, false) => border::PLAIN,
            (false, true) => border::DOUBLE,
            (true, focused) => border::Set {
                top_left: "+",
                top_right: "+",
                bottom_left: "+",
                bottom_right: "+",
                vertical_left: "|",
                vertical_right: "|",
                horizontal_top: if focused { "=" } else { "-" },
                horizontal_bottom: if focused { "=" } else { "-" },
            },
        }
    }

    /// A character, or what stands for it in ASCII.
    pub fn sign(&self, fine: char, ascii: char) -> char {
        if self.ascii { ascii } else { fine }
    }

    /// Reports come with the colour codes of [`style::Style::paint`]: they become spans. Other control characters
    /// are left out.
    pub fn lines(&self, report: &str) -> Vec<Line<'static>> {
        report.lines().map(spans).collect()
    }
}

fn spans(line: &str) -> Line<'static> {
    let mut spans = Vec::new();
    let mut style = Style::new();
    let mut text = String::new();
    let mut rest = line.chars();
    while let Some(c) = rest.next() {
        if c != '\u{1b}' {
            if !c.is_control() {
                text.push(c);
            }
            continue;
        }
        if rest.next() != Some('[') {
            continue;
        }
        let mut codes = String::new();
        let end = rest.by_ref().find(|c| {
            let ends = c.is_ascii_alphabetic();
            if !ends {
                codes.push(*c);
            }
            ends
        });
        if end == Some('m') {
            if !text.is_empty() {
                spans.push(Span::styled(std::mem::take(&mut text), style));
            }
            for code in codes.split(';') {
                style = with_code(style, code);
            }
        }
    }
    if !text.is_empty() {
        spans.push(Span::styled(text, style));
    }
    Line::from(spans)
}

fn with_code(style: Style, code: &str) -> Style {
    const COLORS: [Color; 16] = [
        Color::Black,
        Color::Red,
        Color::Green,
        Color::Yellow,
        Color::Blue,
        Color::Magenta,
        Color::Cyan,
        Color::Gray,
        Color::DarkGray,
        Color::LightRed,
        Color::LightGreen,
        Color::LightYellow,
        Color::LightBlue,
        Color::LightMagenta,
        Color::LightCyan,
        Color::White,
    ];
    match code.parse::<usize>() {
        Ok(1) => style.add_modifier(Modifier::BOLD),
        Ok(n @ 30..=37) => style.fg(COLORS[n - 30]),
        Ok(n @ 90..=97) => style.fg(COLORS[n - 82]),
        _ => Style::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn painted_reports_become_spans() {
        let look = Look { color: true, ascii: false };
        let lines = look.lines("a \u{1b}[1;31mbad\u{1b}[0m\u{7} z\nnext");
        assert_eq!(lines.len(), 2);
        let first = &lines[0];
        assert_eq!(first.spans.len(), 3);
        assert_eq!(first.spans[1].content, "bad");
        assert_eq!(first.spans[1].style, Style::new().fg(Color::Red).add_modifier(Modifier::BOLD));
        assert_eq!(first.spans[2].content, " z");
        assert!(look.lines("\u{1b}[").len() == 1 && look.lines("\u{1b}").len() == 1);
    }

    #[test]
    fn without_colour_no_role_has_one() {
        let look = Look::default();
        for role in [Role::Bad, Role::Good, Role::Muted, Role::Accent] {
            assert_eq!(look.role(role).fg, None);
        }
    }
}
