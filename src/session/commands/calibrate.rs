//! `calibrate`: the friction that explains what was measured.

use std::sync::Arc;

use clap::Args;

use crate::model::measurement::Measurement;
use crate::model::quantity::{Dimension, Quantity};
use crate::path::calibrate::calibrate;
use crate::path::friction::is_friction;
use crate::session::error::refused;
use crate::session::language::candidates::{Asked, Candidate};
use crate::session::language::command::{Action, Command};
use crate::session::language::expect::{self, Expectation, Operator};
use crate::session::{CommandError, Next, Output, Session, worker};
use crate::view;

use crate::session::language::range;

/// Find the friction that explains measured slips or displacements
///
/// `calibrate [FRICTION [A..B]] … [where QUANTITY = VALUE [± ERROR], …]`: least squares over the named friction parameters,
/// each within its range (that of its slider, else 0..1), or over all of them. A parameter stands for the group of pairs
/// whose friction it is. Without `where` the measurements are those of the key `measured` in the file: quantity and value,
/// or `{ "value": …, "error": … }` with a standard error. One friction is followed over its whole exact path, so that the
/// least is that of all its range; several are sought downhill from several starts. It is said which friction does not
/// show: pairs that stick tell a lower bound only, open pairs nothing. Quantities of a `stage`, and all of them after
/// `stages`, are those of the load history.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  calibrate\n  calibrate f 0..0.8\n  calibrate f where ux s3 = 0.0121 ± 0.0001, ux s6 = 0.0312 ± 0.0002"
)]
pub struct Calibrate {
    /// The friction parameters with their ranges, `where` and what was measured
    #[arg(value_name = "CALIBRATED", trailing_var_arg = true, allow_hyphen_values = true)]
    words: Vec<String>,
}

pub const CALIBRATE: Command = Command { in_0_1: false, complete: words, ..Command::of::<Calibrate>("calibrate") };

impl Action for Calibrate {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.calibrate(&self.words, io)?;
        Ok(Next::Continue)
    }

    fn is_of_own_factors(&self, _: &Session) -> bool {
        true
    }
}

fn words(asked: &Asked<'_>) -> Vec<Candidate> {
    if let Some(at) = asked.given.iter().position(|word| word == "where") {
        let last = asked.given[at + 1..].rsplit(|word| word.ends_with(',')).next().unwrap_or_default();
        return asked.quantities(last);
    }
    let mut all = asked.parameters();
    all.push(Candidate::new("where", "what was measured"));
    all
}

/// The range of a friction whose slider has none.
const RANGE: [f64; 2] = [0.0, 1.0];

/// Where the measurements after `where` begin and end: at words that end in a comma.
fn listed(words: &[String]) -> Vec<Vec<String>> {
    let mut parts = vec![Vec::new()];
    for word in words {
        let (piece, ends) = match word.strip_suffix(',') {
            Some(piece) => (piece, true),
            None => (word.as_str(), false),
        };
        if let Some(part) = parts.last_mut().filter(|_| !piece.trim().is_empty()) {
            part.push(piece.to_owned());
        }
        if ends {
            parts.push(Vec::new());
        }
    }
    parts.retain(|part| !part.is_empty());
    parts
}

impl Session {
    /// `calibrate [FRICTION [A..B]] … [where …]`.
    pub(in crate::session) fn calibrate(&mut self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        let at = words.iter().position(|word| word == "where");
        let ground = self.ground(io.watch)?;
        let groups = self.frictions(&words[..at.unwrap_or(words.len())], &ground)?;
        let measured = match at {
            Some(at) => self.measured(&words[at + 1..])?,
            None => self.now.scenario.measured.clone(),
        };
        if measured.is_empty() {
            return refused(
                "calibrate: nothing was measured: write `calibrate … where ux s3 = 0.0121, …`, or the key `measured` in the \
                 file",
            );
        }
        let history = self.judge(&measured)?;
        let measured: Arc<[Measurement]> = measured.into();
        let found = worker::run(io.watch, move |watch| calibrate(ground.case(watch), &groups, &measured, history))??;
        io.show(&found, |out, style| view::calibrate::write(out, &found, style))?;
        self.keep_result(&found);
        Ok(())
    }

    /// `QUANTITY = VALUE [± ERROR], …`.
    fn measured(&self, words: &[String]) -> Result<Vec<Measurement>, CommandError> {
        let form = "calibrate: expected `where QUANTITY = VALUE [± ERROR], …`, e.g. `where ux s3 = 0.0121 ± 1e-4`";
        let mut measured = Vec::new();
        let parts = listed(words);
        if parts.is_empty() {
            return refused(form);
        }
        for part in parts {
            let read = expect::read(&part, &self.names(), &self.now.values)
                .map_err(|error| CommandError::Refused(error.said_by("calibrate")))?;
            let Expectation::Number { quantity, bound } = read else { return refused(form) };
            let (Operator::Equal, value, error) = bound.parts() else { return refused(form) };
            let given = part.iter().any(|word| word.contains('±') || word.contains("+-"));
            if given && error == 0.0 {
                return refused(format!(
                    "calibrate: {quantity}: a standard error is greater than 0; leave `±` out where all measurements weigh the same"
                ));
            }
            measured.push(Measurement { quantity, value, error: given.then_some(error) });
        }
        Ok(measured)
    }

    /// Whether the measurements belong to the load history.
    ///
    /// # Errors
    /// Quantities that are not measured on a state; standard errors for only some of them; several kinds without
    /// errors.
    fn judge(&self, measured: &[Measurement]) -> Result<bool, CommandError> {
        fn inner(quantity: &Quantity) -> &Quantity {
            match quantity {
                Quantity::Stage(_, inside) => inside,
                Quantity::Probe(_, inside) => inner(inside),
                quantity => quantity,
            }
        }
        if let Some(other) = measured.iter().find(|measured| !inner(&measured.quantity).is_of_state()) {
            return refused(format!("calibrate: {} is not measured on a structure in one state", other.quantity));
        }
        let with = measured.iter().filter(|measured| measured.error.is_some()).count();
        if with > 0
            && let Some(without) = measured.iter().find(|measured| measured.error.is_none())
        {
            return refused(format!(
                "calibrate: {} has no error, others have: give one to each measurement, or to none",
                without.quantity
            ));
        }
        let kind = |measured: &Measurement| inner(&measured.quantity).dimension();
        if with == 0
            && let [first, rest @ ..] = measured
            && let Some(other) = rest.iter().find(|other| kind(other) != kind(first))
        {
            return refused(format!(
                "calibrate: {} and {} are of different kinds ({}): give each measurement its error, so that they weigh against \
                 one another",
                first.quantity,
                other.quantity,
                [kind(first), kind(other)].map(kind_word).join(" and ")
            ));
        }
        Ok(self.history_followed().is_some() || measured.iter().any(|measured| measured.quantity.is_of_history()))
    }

    /// The friction parameters named, or all, with their ranges.
    fn frictions(
        &self,
        words: &[String],
        ground: &crate::session::start::PathStart,
    ) -> Result<Vec<(String, [f64; 2])>, CommandError> {
        let scenario = &self.now.scenario;
        let case = ground.case(&crate::watch::Quiet);
        let own = |name: &str| {
            let parameter = scenario.parameters.get(name);
            parameter.and_then(|parameter| Some([parameter.min?.max(0.0), parameter.max?])).unwrap_or(RANGE)
        };
        let mut groups: Vec<(String, [f64; 2])> = Vec::new();
        for word in words {
            if let (true, Some(group)) = (word.contains(".."), groups.last_mut()) {
                group.1 = range::upwards(word, "calibrate")?;
                if group.1[0] < 0.0 {
                    return refused(format!("calibrate: friction is not negative: {word}"));
                }
                continue;
            }
            if word.trim().is_empty() {
                return refused("calibrate: expected the name of a friction parameter, found an empty one");
            }
            let name = self.varied(word)?;
            if !is_friction(case, name) {
                return refused(format!("calibrate: {name} is not the friction of any pair"));
            }
            if groups.iter().any(|(known, _)| known == name) {
                return refused(format!("calibrate: {name} is named twice"));
            }
            groups.push((name.to_owned(), own(name)));
        }
        if groups.is_empty() {
            let free = self.now.values.free().map(|(name, _)| name).filter(|name| is_friction(case, name));
            groups = free.map(|name| (name.clone(), own(name))).collect();
        }
        if groups.is_empty() {
            return refused(
                "calibrate: no pair has its friction from a parameter: write \"friction\": \"f\" in the contacts whose friction is \
                 sought",
            );
        }
        Ok(groups)
    }
}

fn kind_word(kind: Dimension) -> &'static str {
    match kind {
        Dimension::None | Dimension::Inner => "a number",
        Dimension::Length => "a length",
        Dimension::Force => "a force",
        Dimension::Moment => "a moment",
        Dimension::Stress => "a stress",
    }
}
