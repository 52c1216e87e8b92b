//! Quantities in the language: the table of `help show`, and what may follow their words.

use crate::model::quantity::{self, Meaning, Over, WORDS, Word, states_of, words_of};
use crate::session::language::candidates::{Asked, Candidate};
use crate::session::language::tokens;
use crate::view::style::Style;

/// The table of all quantities, for `help show`.
pub fn help() -> String {
    let style = Style { width: 79, ..Style::default() };
    let rows = WORDS.iter().flat_map(|entry| {
        let usage = format!("{} {}", entry.word, entry.meaning.arguments());
        style.hanging(&format!("  {:<33} ", usage.trim_end()), entry.about)
    });
    let rows: Vec<String> = rows.collect();
    format!(
        "Quantities:\n{}\n\nPATTERN is a pair, an edge contact, or has `*` for any letters:\nsum x_n joint[*]; BODY is a plate, a brick, a mesh or \
         a part of one. The probes\nof the scenario are quantities by their names; quote names with blanks.",
        rows.join("\n")
    )
}

/// What the word of a quantity means and how it is asked for; `None` for any other word.
pub fn about(word: &str, style: &Style) -> Option<String> {
    let entry = quantity::entry(word)?;
    let usage = format!("{} {}", entry.word, entry.meaning.arguments());
    let usage = usage.trim_end();
    let mut lines = style.hanging(&format!("{usage}  "), entry.about);
    let choices = entry.choices.join(", ");
    lines.extend(style.wrap(&choices, style.width));
    let where_used = format!(
        "a quantity: `show {usage}`, `expect {usage} = …`, and in probes, `find`, `envelope`, `sweep --columns`, `plot path`; \
         `help show` lists all of them"
    );
    lines.extend(style.wrap(&where_used, style.width));
    Some(lines.join("\n") + "\n")
}

impl Asked<'_> {
    /// What may follow `given`, the words of quantities: the next argument of the last one, or another.
    pub fn quantities(&self, given: &[String]) -> Vec<Candidate> {
        let names = self.names;
        let words = || {
            let mut all: Vec<Candidate> =
                words_of(names.dimension).map(|entry| Candidate::new(entry.word, "")).collect();
            all.extend(Candidate::plain(names.probes.iter().map(|probe| tokens::quote(probe))));
            all
        };
        let at = given.iter().rposition(|word| quantity::entry(word).is_some());
        let Some((entry, after)) = at.and_then(|at| Some((quantity::entry(&given[at])?, &given[at + 1..]))) else {
            return words();
        };
        let pairs = || {
            let patterns = names.joints.iter().map(|joint| format!("{joint}[*]"));
            Candidate::plain(names.pairs.iter().cloned().chain(patterns).chain(["*".to_owned()]))
        };
        let over = at.and_then(|at| at.checked_sub(1)).is_some_and(|before| {
            quantity::entry(&given[before]).is_some_and(|before| matches!(before.meaning, Meaning::Over(_)))
        });
        match (entry.meaning, after) {
            (Meaning::Pair(_), []) if over => pairs(),
            (Meaning::Pair(_) | Meaning::State, []) => Candidate::plain(&names.pairs),
            (Meaning::Node(_), []) => Candidate::plain(&names.nodes),
            (Meaning::Stress(_), []) if over => Candidate::plain(&names.bodies),
            (Meaning::Stress(_), []) => Candidate::plain(names.nodes.iter().chain(&names.elements)),
            (Meaning::Bar(_), []) => Candidate::plain(&names.bars),
            (Meaning::Bar(_), [_]) if !over => Candidate::plain(["at", "start", "end"]),
            (Meaning::Resultant, []) => Candidate::plain(&names.joints),
            (Meaning::Resultant, [_]) => Candidate::plain(["N", "T", "e"]),
            (Meaning::Load(_), []) => Candidate::plain(&names.cases),
            (Meaning::Critical, []) => Candidate::plain(names.parameters.iter().map(|(name, _)| name)),
            (Meaning::Over(how), []) => {
                let goes_with = |entry: &&Word| match entry.meaning {
                    Meaning::Pair(_) => true,
                    Meaning::Bar(_) | Meaning::Stress(_) => how != Over::Sum,
                    _ => false,
                };
                let length = (how == Over::Max).then_some("u");
                Candidate::plain(words_of(names.dimension).filter(goes_with).map(|entry| entry.word).chain(length))
            }
            (Meaning::Count, []) => Candidate::plain(states_of(names.dimension)),
            (Meaning::Count, [_]) => pairs(),
            (Meaning::Stage, [_]) => words(),
            _ => Vec::new(),
        }
    }
}
