//! All answers of a small problem.

use std::io::{self, Write};

use super::pairs::state_words;
use super::style::{Role, Style};
use crate::answer::record::{Answer, PairDirection, PairState};
use crate::contact::polygon::degrees;
use crate::solve::all_answers::{AllAnswers, Continuum, Moving};
use crate::text::number::short;

fn vector(z: &[f64]) -> String {
    let z: Vec<String> = z.iter().map(|z| short(*z)).collect();
    format!("({})", z.join(", "))
}

/// "c1 open, c2 slip+", in space "c2 slip towards 45°", or z of a bare LCP.
fn states(answer: &Answer) -> String {
    if let Some(solution) = &answer.solution {
        return format!("z = {}", vector(&solution.z));
    }
    let towards = |pair: &PairState| match pair.direction() {
        Some(direction) => format!(" towards {}", degrees(direction)),
        None => String::new(),
    };
    let word = |pair: &PairState| format!("{} {}{}", pair.id, state_words(pair), towards(pair));
    let words: Vec<String> = answer.pairs.iter().map(word).collect();
    words.join(", ")
}

/// "z_n c1 1, z_t c2 −0.5" of a direction.
fn motion(pairs: &[PairDirection]) -> String {
    let mut words = Vec::new();
    for pair in pairs {
        let slip = pair.slip();
        let names: &[&str] = if slip.len() == 1 { &["z_t"] } else { &["z_t1", "z_t2"] };
        for (name, value) in std::iter::once((&"z_n", pair.z_n)).chain(names.iter().zip(slip)) {
            if value != 0.0 {
                words.push(format!("{name} {} by {}", pair.pair, short(value)));
            }
        }
    }
    words.join(", ")
}

/// "every answer between 1 and 2" or "z = (0, 1) + t (1, 1), t ≥ 0".
fn continuum(all: &AllAnswers, piece: &Continuum) -> String {
    let numbers: Vec<String> = piece.corners.iter().map(|corner| (corner + 1).to_string()).collect();
    let start = piece.corners.first().and_then(|first| all.answers[*first].answer.solution.as_ref());
    let single = piece.corners.len() == 1;
    let hull = if single { format!("from {} on", numbers[0]) } else { format!("between {}", numbers.join(", ")) };
    let ways: Vec<String> = piece
        .directions
        .iter()
        .map(|direction| match (direction, start) {
            (Moving::Plain(z), Some(start)) if single && piece.directions.len() == 1 => {
                format!("z = {} + t {}, t ≥ 0", vector(&start.z), vector(z))
            }
            (Moving::Plain(z), _) => vector(z),
            (Moving::Pairs(pairs), _) => motion(pairs),
        })
        .collect();
    match ways.len() {
        0 => format!("continuum: every state {hull} is an answer"),
        _ => format!("continuum: every state {hull} is an answer, without end along {}", ways.join("; ")),
    }
}

/// "2 answers", "infinitely many answers: 3 corners of 1 continuum", "no answer".
fn count(all: &AllAnswers) -> String {
    let many = |count: usize, word: &str| if count == 1 { format!("one {word}") } else { format!("{count} {word}s") };
    let answers = all.answers.len();
    if !all.continua.is_empty() {
        let inside = all.continuum.iter().filter(|near| **near).count();
        let alone = answers - inside;
        let pieces =
            if all.continua.len() == 1 { "one continuum".into() } else { format!("{} continua", all.continua.len()) };
        let apart = if alone > 0 { format!(", and {} apart", many(alone, "answer")) } else { String::new() };
        return format!("infinitely many answers: {pieces} with {}{apart}", many(inside, "corner"));
    }
    match answers {
        0 if all.within_rounding => {
            "no answer of the numbers as stored; whether there is one within their rounding is open".to_owned()
        }
        0 if all.none() => "no answer: proved by going through all of them".to_owned(),
        0 => "no answer found".to_owned(),
        _ if all.answers.iter().all(|solved| !solved.answer.is_answer()) => {
            "no answer that passes its check".to_owned()
        }
        1 if all.exact == [false] => {
            "one answer up to rounding; the numbers as stored, taken exactly, have none".to_owned()
        }
        _ => many(answers, "answer"),
    }
}

/// Writes the answers, one a line, and how the search went.
pub fn write(out: &mut dyn Write, all: &AllAnswers, style: &Style) -> io::Result<()> {
    for (k, solved) in all.answers.iter().enumerate() {
        let answer = &solved.answer;
        let largest = answer.pairs.iter().flat_map(|pair| [pair.z_n, pair.z_t]).fold(0.0, |a: f64, z| a.max(z.abs()));
        let exact = all.exact.get(k).copied().unwrap_or_default();
        let proof = match exact {
            true => "proved in exact arithmetic",
            false if answer.is_answer() => "holds up to rounding",
            false => "of the numbers as stored, and it fails its check",
        };
        let near = if all.continuum.get(k).copied().unwrap_or_default() { "; others lie next to it" } else { "" };
        let size =
            if answer.solution.is_none() { format!("; largest motion {}", short(largest)) } else { String::new() };
        let text = format!("{} ({proof}{near}{size})", states(answer));
        for line in style.hanging(&format!("{:>3}  ", k + 1), &style.text(&text)) {
            writeln!(out, "{line}")?;
        }
    }
    for piece in &all.continua {
        for line in style.hanging("     ", &style.text(&continuum(all, piece))) {
            writeln!(out, "{line}")?;
        }
    }
    let cut = if all.cut > 0 { format!(", {} branches cut by their signs", all.cut) } else { String::new() };
    let doubt = match all.undecided {
        0 => String::new(),
        n => format!("; {n} sets of answers have too many corners to list them all"),
    };
    let of = if all.total == u64::MAX { String::new() } else { format!(" of {}", all.total) };
    let mut text = format!("{}; {}{of} working schemes solved{cut}{doubt}", count(all), all.visited);
    if !all.complete {
        text = format!("stopped: there may be more. So far {text}");
    }
    if let Some(facets) = all.facets {
        text += &format!(
            "; all of it on the polygon of {facets} facets, not on the cone, whose answer `solve` ends with (`set facets`)"
        );
    }
    style.paragraph(out, Role::Muted, &text)?;
    if all.answers.len() > 1 {
        let text = "`enumerate K` shows the Kth; `solve` goes back to Lemke's";
        writeln!(out, "{}", style.paint(Role::Muted, text))?;
    }
    Ok(())
}
