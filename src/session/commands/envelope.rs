//! `envelope`: the least and the largest value of quantities, over combinations or ranges of parameters.

use clap::Args;
use indexmap::IndexMap;
use serde::Serialize;

use crate::model::quantity::Quantity;
use crate::path::envelope::{Axis, Peak, envelope};
use crate::path::quantity::Facts;
use crate::session::commands::combine::Combined;
use crate::session::language::candidates::{Asked, Candidate};
use crate::session::language::command::{Action, Command};
use crate::session::language::range;
use crate::session::{CommandError, Next, Output, Session, worker};
use crate::view;
use crate::view::combinations::Extreme;
use crate::view::path::exact;

/// Show the least and the largest value of quantities, over load combinations or ranges of parameters
///
/// With the combination, or the place, that governs. Where an exact path leads over a single parameter (loads,
/// friction) the place is exact; otherwise it is that of a grid of answers, refined around its extremes, and said to
/// be so. A quantity that may bend either way between two changes (`min mises`, `max s2`; over friction any largest or
/// least of several) is looked at closely but not called exact. A range left out is that of the slider.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  envelope\n  envelope x_n c1, max u over combinations\n  envelope x_t c1 over f 0..1\n  envelope max u over F 50..150 F2 0..200"
)]
pub struct Envelope {
    /// The quantities, the probes if none is named; then `over combinations` or `over PARAMETER A..B …`
    #[arg(value_name = "QUANTITY", trailing_var_arg = true, allow_hyphen_values = true)]
    words: Vec<String>,
}

pub const ENVELOPE: Command = Command { in_0_1: false, complete: words, ..Command::of::<Envelope>("envelope") };

impl Action for Envelope {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.envelope(&self.words, io)?;
        Ok(Next::Continue)
    }

    fn is_of_own_factors(&self, _: &Session) -> bool {
        self.words.iter().skip_while(|word| *word != "over").nth(1).is_some_and(|what| what != "combinations")
    }
}

/// Quantities; after `over` what they are looked at over.
fn words(asked: &Asked<'_>) -> Vec<Candidate> {
    let over = asked.given.iter().any(|word| word == "over");
    let mut all = if over { asked.varied() } else { asked.quantities(asked.given) };
    if over {
        all.extend(Candidate::plain(["combinations"]));
    } else if !asked.given.is_empty() {
        all.extend(Candidate::plain(["over"]));
    }
    all
}

impl Session {
    /// `envelope [QUANTITY …] [over combinations | PARAMETER A..B …]`.
    pub(in crate::session) fn envelope(&mut self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        let (words, over) = match words.iter().position(|word| word == "over") {
            None => (words, None),
            Some(at) => (&words[..at], Some(&words[at + 1..])),
        };
        let quantities = if words.is_empty() { self.all_probes()? } else { self.quantities(words)? };
        if let Some(quantity) = quantities.iter().find(|quantity| quantity.is_word()) {
            return Err(CommandError::Refused(format!("envelope: `{quantity}` is a word, not a number")));
        }
        match over {
            None => self.envelope_of_combinations(quantities, io),
            Some([what]) if what == "combinations" => self.envelope_of_combinations(quantities, io),
            Some(ranges) => self.envelope_of_parameters(quantities, ranges, io),
        }
    }

    /// Least and largest of quantities over the combinations, and those without an answer.
    pub(super) fn extremes(
        &self,
        quantities: Vec<Quantity>,
        io: &mut Output<'_>,
    ) -> Result<(Vec<Extreme>, Vec<String>), CommandError> {
        let all = self.combined(None, io)?;
        let watch = io.watch;
        let without: Vec<String> = all
            .iter()
            .filter(|combined| !combined.solved.answer.is_answer())
            .map(|combined| format!("{} ({})", combined.name, combined.solved.answer.outcome.word()))
            .collect();
        let answered: Vec<(&Combined, Facts<'_>)> = all
            .iter()
            .filter(|combined| combined.solved.answer.is_answer())
            .map(|combined| (combined, self.facts_of(combined, watch)))
            .collect();
        Ok((quantities.into_iter().map(|quantity| extreme(quantity, &answered)).collect(), without))
    }

    fn envelope_of_combinations(&self, quantities: Vec<Quantity>, io: &mut Output<'_>) -> Result<(), CommandError> {
        let (extremes, without) = self.extremes(quantities, io)?;
        let units = &self.now.scenario.units;
        let end = |end: &Option<(f64, String)>| {
            end.as_ref().map(|(value, name)| InCombination { value: *value, combination: name.clone() })
        };
        let row = |extreme: &Extreme| EnvelopeRow {
            quantity: extreme.quantity.to_string(),
            unit: extreme.quantity.unit(units),
            least: end(&extreme.least),
            largest: end(&extreme.largest),
        };
        let report = OverCombinations { envelope: extremes.iter().map(row).collect(), without_answer: &without };
        io.show(&report, |out, style| {
            let notes: Vec<String> = match without.is_empty() {
                true => Vec::new(),
                false => vec![format!("without an answer: {}", without.join(", "))],
            };
            view::combinations::write_envelope(out, "in", &extremes, &notes, units, style)
        })?;
        Ok(())
    }

    /// Parameters and load cases with their ranges, those of their sliders where they are left out.
    pub(in crate::session) fn axes(&self, words: &[String], command: &str) -> Result<Vec<Axis>, CommandError> {
        let mut axes: Vec<Axis> = Vec::new();
        let mut rest = words;
        while let Some((name, after)) = rest.split_first() {
            let name = self.varied(name)?.to_owned();
            let (range, after) = match after.split_first() {
                Some((word, after)) if word.contains("..") => (range::upwards(word, command)?, after),
                _ => (self.slider(&name, command)?, after),
            };
            if axes.iter().any(|axis| axis.name == name) {
                return Err(CommandError::Refused(format!("{command}: {name} is named twice")));
            }
            axes.push(Axis { name, range });
            rest = after;
        }
        Ok(axes)
    }

    fn envelope_of_parameters(
        &self,
        quantities: Vec<Quantity>,
        words: &[String],
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let axes = self.axes(words, "envelope … over")?;
        if axes.is_empty() || axes.len() > 3 {
            return Err(CommandError::Refused(
                "envelope: expected `over combinations` or `over PARAMETER A..B`, up to three of them".to_owned(),
            ));
        }
        let ground = self.ground(io.watch)?;
        let (over, asked) = (axes.clone(), quantities.clone());
        let found = worker::run(io.watch, move |watch| envelope(ground.case(watch), &over, &asked))??;
        let units = &self.now.scenario.units;
        let place = |peak: &Peak| axes.iter().zip(&peak.at).map(|(axis, at)| (axis.name.clone(), *at)).collect();
        let end = |peak: &Option<Peak>| {
            peak.as_ref().map(|peak| AtPlace { value: peak.value, at: place(peak), change: peak.change.clone() })
        };
        let words = |peak: &Peak| {
            let at = axes.iter().zip(&peak.at).map(|(axis, at)| format!("{} = {}", axis.name, exact(*at)));
            let at = at.collect::<Vec<_>>().join(", ");
            (peak.value, peak.change.as_ref().map_or(at.clone(), |change| format!("{at}: {change}")))
        };
        let row = |(quantity, [least, largest]): (&Quantity, &[Option<Peak>; 2])| EnvelopeRow {
            quantity: quantity.to_string(),
            unit: quantity.unit(units),
            least: end(least),
            largest: end(largest),
        };
        let range = |axis: &Axis| Range { parameter: axis.name.clone(), from: axis.range[0], to: axis.range[1] };
        let report = OverParameters {
            envelope: quantities.iter().zip(&found.peaks).map(row).collect(),
            over: axes.iter().map(range).collect(),
            exact: found.exact,
            covered: found.covered,
            notes: &found.notes,
        };
        io.show(&report, |out, style| {
            let rows = quantities.iter().zip(&found.peaks).map(|(quantity, [least, largest])| Extreme {
                quantity: quantity.clone(),
                least: least.as_ref().map(words),
                largest: largest.as_ref().map(words),
            });
            view::combinations::write_envelope(out, "at", &rows.collect::<Vec<_>>(), &found.notes, units, style)
        })?;
        Ok(())
    }
}

/// The least and the largest value of a quantity, each with its place `E`.
#[derive(Serialize)]
struct EnvelopeRow<E> {
    quantity: String,
    unit: Option<String>,
    least: Option<E>,
    largest: Option<E>,
}

#[derive(Serialize)]
struct InCombination {
    value: f64,
    combination: String,
}

#[derive(Serialize)]
struct AtPlace {
    value: f64,
    at: IndexMap<String, f64>,
    change: Option<String>,
}

#[derive(Serialize)]
struct OverCombinations<'a> {
    envelope: Vec<EnvelopeRow<InCombination>>,
    without_answer: &'a [String],
}

#[derive(Serialize)]
struct OverParameters<'a> {
    envelope: Vec<EnvelopeRow<AtPlace>>,
    over: Vec<Range>,
    exact: bool,
    /// As `find` has it.
    #[serde(skip_serializing_if = "Option::is_none")]
    covered: Option<[f64; 2]>,
    notes: &'a [String],
}

#[derive(Serialize)]
struct Range {
    parameter: String,
    from: f64,
    to: f64,
}

/// The least and the largest value of a quantity, the first of equals.
fn extreme(quantity: Quantity, answered: &[(&Combined, Facts<'_>)]) -> Extreme {
    let mut found = Extreme { quantity, least: None, largest: None };
    for (combined, facts) in answered {
        let Some(value) = facts.value(&found.quantity).ok().and_then(|value| value.number()) else { continue };
        if found.least.as_ref().is_none_or(|(least, _)| value < *least) {
            found.least = Some((value, combined.name.clone()));
        }
        if found.largest.as_ref().is_none_or(|(largest, _)| value > *largest) {
            found.largest = Some((value, combined.name.clone()));
        }
    }
    found
}
