//! Quantities of the answer as a whole.

use super::facts::Facts;
use super::value::{NoValue, Value, none};
use crate::answer::record::Ray;
use crate::model::quantity::OfAnswer;

impl Facts<'_> {
    pub(super) fn of_the_answer(&self, which: OfAnswer) -> Result<Value, NoValue> {
        let count = |count: usize| Ok(Value::Number(count as f64));
        let size = |size: Option<usize>| size.map_or_else(|| none("the scenario has no structure"), count);
        match which {
            OfAnswer::Outcome => Ok(Value::Word(self.answer()?.outcome.word().to_owned())),
            OfAnswer::Class => Ok(Value::Word(self.ray()?.class.word().to_owned())),
            OfAnswer::Verdict => match self.ray()?.verdict {
                Some(verdict) => Ok(Value::Word(verdict.word().to_owned())),
                None => none("no verdict"),
            },
            OfAnswer::P => Value::finite(self.p.ok_or_else(|| self.missing())?),
            OfAnswer::Pivots => count(self.answer()?.pivot_count),
            OfAnswer::Lcp => count(self.answer()?.size.lcp),
            OfAnswer::Unknowns => size(self.answer()?.size.unknowns),
            OfAnswer::Free => size(self.answer()?.size.free),
            OfAnswer::Answers => {
                let prepared = self.prepared.ok_or_else(|| self.missing())?;
                let all = prepared
                    .all_answers(self.values, self.rules, self.watch)
                    .map_err(|error| NoValue(error.to_string()))?;
                if all.continuum.iter().any(|continuum| *continuum) {
                    return none(
                        "there are infinitely many answers, some next to one another: `enumerate` lists their corners",
                    );
                }
                if all.undecided > 0 || all.within_rounding || !all.exact.iter().all(|exact| *exact) {
                    let found = all.answers.len();
                    let answers = if found == 1 { "answer was" } else { "answers were" };
                    return none(format!("{found} {answers} found, but it is not proved that there are no others"));
                }
                count(all.answers.len())
            }
            OfAnswer::Energy => {
                let (structure, main) = self.structure()?;
                Value::finite(main.strain_energy(structure, self.displacements()?, &self.factors))
            }
            OfAnswer::Dissipated => Value::finite(self.history()?.stages.iter().map(|stage| stage.dissipated).sum()),
        }
    }

    fn ray(&self) -> Result<&Ray, NoValue> {
        let answer = self.answer()?;
        answer.ray.as_ref().ok_or_else(|| NoValue(format!("outcome {}", answer.outcome.word())))
    }
}
