//! Printed lines that are wider than their window: sentences are broken anew, tables and pictures are left as they are.

use ratatui::text::{Line, Span};
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// What lines, blocks and dots are drawn with.
const DRAWN: std::ops::RangeInclusive<char> = '\u{2500}'..='\u{28ff}';

/// The lines, none of those that are sentences wider than `width` columns.
pub fn within(lines: &[Line<'static>], width: usize) -> Vec<Line<'static>> {
    let broken = |line: &Line<'static>| match hanging(&line.to_string()) {
        Some(indent) if line.width() > width => broken(line, if indent * 2 > width { 0 } else { indent }, width),
        _ => vec![line.clone()],
    };
    lines.iter().flat_map(broken).collect()
}

/// Columns ahead of what follows the first line of a sentence, behind its label (`meaning     The run …`) if it has one;
/// `None` of what is no sentence: the columns of a table are apart by more than a blank, and so are the parts of pictures.
fn hanging(text: &str) -> Option<usize> {
    let body = text.trim_start();
    let indent = text.width() - body.width();
    let mut parts = body.trim_end().split("  ").filter(|part| !part.is_empty());
    let (second, third) = (parts.nth(1), parts.next());
    if third.is_some() || body.chars().any(|c| DRAWN.contains(&c)) {
        return None;
    }
    Some(match second {
        None => indent,
        Some(said) => text.trim_end().width() - said.trim_start().width(),
    })
}

/// A line broken at blanks, with `indent` ahead of all but the first part.
fn broken(line: &Line<'static>, indent: usize, width: usize) -> Vec<Line<'static>> {
    let letters: Vec<(char, ratatui::style::Style)> =
        line.spans.iter().flat_map(|span| span.content.chars().map(|c| (c, span.style))).collect();
    let columns = |c: char| c.width().unwrap_or(0);
    let mut lines = Vec::new();
    let (mut from, mut ahead) = (0, 0);
    while from < letters.len() {
        let mut used = ahead;
        let rest = &letters[from..];
        let fits = rest.iter().position(|&(c, _)| {
            used += columns(c);
            used > width
        });
        let end = match fits {
            None => rest.len(),
            // A word that fills the line is cut; the label and its blanks are no place to break at.
            Some(fits) => {
                let least = if from == 0 { indent } else { 0 };
                let blank = (least + 1..=fits).rev().find(|&at| rest[at].0 == ' ' && rest[at - 1].0 != ' ');
                blank.unwrap_or(fits.max(1))
            }
        };
        lines.push(of_letters(&rest[..end], ahead));
        from += end;
        from += letters[from..].iter().take_while(|(c, _)| *c == ' ').count();
        ahead = indent;
    }
    lines
}

/// A line of letters with their styles, `ahead` blanks before it.
fn of_letters(letters: &[(char, ratatui::style::Style)], ahead: usize) -> Line<'static> {
    let mut spans = vec![Span::raw(" ".repeat(ahead))];
    for run in letters.chunk_by(|a, b| a.1 == b.1) {
        spans.push(Span::styled(run.iter().map(|(c, _)| *c).collect::<String>(), run[0].1));
    }
    Line::from(spans)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wrapped(text: &str, width: usize) -> Vec<String> {
        within(&[Line::raw(text.to_owned())], width).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn sentences_are_broken_behind_their_label() {
        assert_eq!(
            wrapped("meaning   The run found no state at all", 22),
            ["meaning   The run", "          found no", "          state at all"]
        );
        assert_eq!(wrapped("  a bc d", 5), ["  a", "  bc", "  d"]);
        assert_eq!(wrapped("abcdefgh", 3), ["abc", "def", "gh"]);
        assert_eq!(wrapped("漢漢 漢", 3), ["漢", "漢", "漢"]);
        assert_eq!(wrapped("", 3), [""]);
    }

    #[test]
    fn tables_and_pictures_stay() {
        for text in ["c1  open  0.25  0", "12 ┤ ⡠⠤ a", "one  two  three four five"] {
            assert_eq!(wrapped(text, 5), [text]);
        }
    }
}
