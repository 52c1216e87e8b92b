//! All answers of a small problem, side by side.

use ratatui::text::{Line, Span};
use unicode_width::UnicodeWidthStr;

use crate::session::AllAnswers;
use crate::session::results::PairState;
use crate::view::pairs::state_words;
use crate::view::scale::Scale;
use crate::view::style::{Role, pad_left, pad_right};

use super::theme::Look;

/// Answers in columns, as many side by side as fit.
pub fn side_by_side(found: &AllAnswers, look: Look, width: usize) -> Vec<Line<'static>> {
    let mut lines = Vec::new();
    let count = found.answers.len();
    let head = match (count, found.complete) {
        (0, true) => "No working scheme is an answer: there is none.".to_owned(),
        (0, false) => "No answer was found, but not every scheme could be decided.".to_owned(),
        (1, true) => "One answer, and no other.".to_owned(),
        (n, true) => format!("{n} answers, and no others: which one the structure takes depends on its history."),
        (n, false) => format!("{n} answers; not every scheme could be decided."),
    };
    let report = look.report(width);
    for line in report.wrap(&head, width) {
        lines.push(Line::styled(line, look.role(Role::Title)));
    }
    lines.push(Line::default());
    let Some(first) = found.answers.first() else {
        return lines;
    };
    let id = first.pairs.iter().map(|pair| pair.id.width()).max().unwrap_or(0).max(4);
    const NUMBER: usize = 11;
    let words = found.answers.iter().flat_map(|answer| &answer.pairs);
    let word = words.map(|pair| state_words(pair).len()).max().unwrap_or(0) + 1;
    let block = word + 3 * NUMBER + 2;
    let fit = (width.saturating_sub(id + 1) / block).max(1);
    let all = || found.answers.iter().flat_map(|answer| &answer.pairs);
    let forces = Scale::of(all().flat_map(|pair| [pair.x_n, pair.x_t]));
    let lengths = Scale::of(all().map(|pair| pair.z_t));
    let headed = |head: &str, scale: Scale| {
        let power = scale.unit(None, look.ascii).map_or(String::new(), |power| format!(" {power}"));
        pad_left(&format!("{}{power}", look.text(head)), NUMBER)
    };
    for (group, answers) in found.answers.chunks(fit).enumerate() {
        if group > 0 {
            lines.push(Line::default());
        }
        let mut head = vec![Span::raw(" ".repeat(id + 1))];
        for (i, answer) in answers.iter().enumerate() {
            let mut name = format!("answer {}", group * fit + i + 1);
            if answer.shown {
                name.push_str(", the one shown");
            }
            if answer.continuum {
                name.push_str(", one of many beside it");
            } else if !answer.exact {
                name.push_str(", up to rounding");
            }
            head.push(Span::styled(
                pad_right(&look.fit(&name, block - 1), block),
                look.role(if answer.shown { Role::Accent } else { Role::Header }),
            ));
        }
        lines.push(Line::from(head));
        let columns = format!(
            "{}{}{}{}  ",
            pad_right("state", word),
            headed("x_n", forces),
            headed("x_τ", forces),
            headed("z_τ", lengths)
        );
        lines.push(Line::styled(
            format!("{} {}", pad_right("pair", id), columns.repeat(answers.len())),
            look.role(Role::Muted),
        ));
        for row in 0..first.pairs.len() {
            let mut spans = vec![Span::raw(format!("{} ", pad_right(&look.text(&first.pairs[row].id), id)))];
            for answer in answers {
                let pair: &PairState = &answer.pairs[row];
                spans.push(Span::styled(pad_right(state_words(pair), word), look.role(Role::State(pair.state))));
                let numbers = [forces.measured(pair.x_n), forces.measured(pair.x_t), lengths.measured(pair.z_t)];
                let text: String = numbers.iter().map(|n| pad_left(n, NUMBER)).collect();
                spans.push(Span::raw(format!("{text}  ")));
            }
            lines.push(Line::from(spans));
        }
    }
    lines
}
