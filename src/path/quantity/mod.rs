//! The values of quantities: of an answer, of a pivot, of a place on a path. One file for each family of the words of
//! [`crate::model::quantity`]; each match is exhaustive, so that a new word is refused until it has its reader.

mod answer;
mod facts;
mod joint;
mod member;
mod node;
mod pair;
mod path;
mod stress;
mod value;

use crate::model::quantity::{Over, Quantity};

pub use facts::Facts;
pub use joint::Resultant;
pub use path::history_for;
pub use stress::Field;
pub use value::{NoValue, OnPath, Value};

impl Facts<'_> {
    /// The value of a quantity; a reason where it has none.
    ///
    /// # Errors
    /// See [`NoValue`].
    pub fn value(&self, quantity: &Quantity) -> Result<Value, NoValue> {
        let number = match quantity {
            Quantity::Answer(which) => return self.of_the_answer(*which),
            Quantity::State(id) => return Ok(Value::Word(self.pair(id)?.state.word().to_owned())),
            Quantity::Stage(stage, inner) => return self.of_stage(*stage, inner),
            Quantity::Probe(_, inner) => return self.value(inner),
            Quantity::Pair(which, id) => which.of(self.pair(id)?),
            Quantity::Pairs(over, which, pattern) => self.of_pairs(*over, *which, pattern)?.0,
            Quantity::Count(state, pattern) => self.count(state, pattern)?,
            Quantity::Resultant(joint, part) => self.of_joint(joint, *part)?,
            Quantity::Node(which, node) => self.of_node(*which, node)?,
            Quantity::LargestDisplacement => self.largest_displacement()?.0,
            Quantity::Bar(which, bar, place) => self.of_bar(*which, bar, *place)?,
            Quantity::NodeStress(which, node) => self.at_node(*which, node)?,
            Quantity::ElementStress(which, name) => self.in_element(*which, name)?,
            Quantity::Stresses(over, which, body) => self.extreme_stress(*over, *which, body.as_deref())?.0,
            Quantity::Load(which, name) => self.of_load(*which, name)?,
            Quantity::Critical(parameter) => self.critical(parameter)?,
        };
        Value::finite(number)
    }

    /// The node or pair at which a largest or least value stands; none where it is 0, which is nowhere more than elsewhere.
    pub fn place(&self, quantity: &Quantity) -> Option<String> {
        let (value, place) = match quantity {
            Quantity::Probe(_, inner) => return self.place(inner),
            Quantity::Stage(stage, inner) => {
                let history = self.history.filter(|history| *stage <= history.stages.len())?;
                return self.at_stage(history, stage - 1).place(inner);
            }
            Quantity::Pairs(over, which, pattern) if *over != Over::Sum => {
                self.of_pairs(*over, *which, pattern).map(|(value, pair)| (value, pair.to_owned()))
            }
            Quantity::LargestDisplacement => self.largest_displacement(),
            Quantity::Stresses(over, which, body) => self.extreme_stress(*over, *which, body.as_deref()),
            _ => return None,
        }
        .ok()?;
        (value != 0.0).then_some(place)
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::answer::record::{OutcomeKind, RayClass, State, Verdict};
    use crate::model::quantity::{WORDS, entry};

    /// The words of a line in the table, but for `besides`, are those of results, and these are written as they are said.
    fn same_words<T: Copy + serde::Serialize>(
        entry_word: &str,
        besides: &[&str],
        word: fn(T) -> &'static str,
        all: &[T],
    ) {
        let mut known: Vec<&str> = entry(entry_word).unwrap().choices.to_vec();
        known.retain(|choice| !besides.contains(choice));
        let mut said: Vec<&str> = all.iter().copied().map(word).collect();
        all.iter().zip(&said).for_each(|(one, said)| assert_eq!(json!(one), json!(said)));
        known.sort_unstable();
        said.sort_unstable();
        assert_eq!(known, said, "{entry_word}");
    }

    #[test]
    fn words_of_the_table_are_those_of_results() {
        use OutcomeKind::{Breakdown, CheckFailed, Normal, PivotLimit, Ray, Trivial};
        same_words(
            "outcome",
            &["answer"],
            OutcomeKind::word,
            &[Trivial, Normal, Ray, PivotLimit, Breakdown, CheckFailed],
        );
        use RayClass::{Artefact, Fault, Mechanism, NoEquilibrium};
        same_words("class", &[], RayClass::word, &[Mechanism, Artefact, Fault, NoEquilibrium]);
        same_words("verdict", &[], Verdict::word, &[Verdict::Certified, Verdict::Proved, Verdict::Undecided]);
        let states = [State::Open, State::Stick, State::SlipPlus, State::SlipMinus, State::Slip, State::Closed];
        same_words("state", &[], State::word, &states);
    }

    #[test]
    fn each_word_has_one_meaning_and_each_meaning_one_word() {
        for line in WORDS {
            assert_eq!(entry(line.word).map(|entry| entry.meaning), Some(line.meaning));
            assert_eq!(line.meaning.word(), line.word);
            assert_eq!(line.choices.is_empty(), !matches!(line.word, "outcome" | "class" | "verdict" | "state"));
        }
    }
}
