//! All answers of a small problem.

use std::io::{self, Write};

use super::number::short;
use super::pairs::state_words;
use super::style::{Role, Style};
use crate::answer::record::Answer;
use crate::solve::all_answers::AllAnswers;

/// "c1 open, c2 slip+", or z of a bare LCP.
fn states(answer: &Answer) -> String {
    if let Some(solution) = &answer.solution {
        let z: Vec<String> = solution.z.iter().map(|z| short(*z)).collect();
        return format!("z = ({})", z.join(", "));
    }
    let words: Vec<String> = answer.pairs.iter().map(|pair| format!("{} {}", pair.id, state_words(pair))).collect();
    words.join(", ")
}

/// Writes the answers, one a line, and how the search went.
pub fn write(out: &mut dyn Write, all: &AllAnswers, style: &Style) -> io::Result<()> {
    for (k, solved) in all.answers.iter().enumerate() {
        let answer = &solved.answer;
        let largest = answer.pairs.iter().flat_map(|pair| [pair.z_n, pair.z_t]).fold(0.0, |a: f64, z| a.max(z.abs()));
        let exact = all.exact.get(k).copied().unwrap_or_default();
        let near = all.continuum.get(k).copied().unwrap_or_default();
        let proof = match (exact, near) {
            (true, false) => "proved in exact arithmetic",
            (true, true) => "proved in exact arithmetic; others lie next to it",
            (false, false) => "holds up to rounding",
            (false, true) => "holds up to rounding; others lie next to it",
        };
        let size =
            if answer.solution.is_none() { format!("; largest motion {}", short(largest)) } else { String::new() };
        let text = format!("{} ({proof}{size})", states(answer));
        for line in style.hanging(&format!("{:>3}  ", k + 1), &style.text(&text)) {
            writeln!(out, "{line}")?;
        }
    }
    let count = match all.answers.len() {
        0 if all.undecided == 0 => "no answer: proved by going through all of them".to_owned(),
        0 => "no answer found".to_owned(),
        1 => "one answer".to_owned(),
        n => format!("{n} answers"),
    };
    let cut = if all.cut > 0 { format!(", {} branches cut by their signs", all.cut) } else { String::new() };
    let doubt = if all.undecided > 0 { format!("; {} could not be decided", all.undecided) } else { String::new() };
    let text = format!("{count}; {} of {} working schemes solved{cut}{doubt}", all.visited, all.total);
    for line in style.wrap(&style.text(&text), style.width) {
        writeln!(out, "{}", style.paint(Role::Muted, &line))?;
    }
    if all.answers.len() > 1 {
        let text = "`enumerate K` shows the Kth; `solve` goes back to Lemke's";
        writeln!(out, "{}", style.paint(Role::Muted, text))?;
    }
    Ok(())
}
