//! `expect`: a test of the answer.

use clap::Args;
use serde::Serialize;
use serde_json::Value as Json;

use crate::model::quantity::{OfAnswer, Quantity};
use crate::session::error::refused;
use crate::session::language::candidates::{Asked, Candidate};
use crate::session::language::command::{Action, Command};
use crate::session::language::expect;
use crate::session::{CommandError, Next, Output, Session};

/// Test the answer: the script fails where it is not as expected
///
/// Forms, with OP one of = != < <= > >= and `± TOLERANCE` (or `+- TOLERANCE`) after `=`:
///   expect QUANTITY OP NUMBER               (`help show` lists the quantities)
///   expect outcome answer|trivial|normal|ray|pivot-limit|breakdown|check-failed
///   expect state PAIR open|stick|slip+|slip-|closed
///   expect x_n|x_t|z_n|z_t|bound|reserve_plus|reserve_minus PAIR OP NUMBER
///   expect ux|uy|rz NODE OP NUMBER
///   expect p OP NUMBER
///   expect pivots OP NUMBER
///   expect unknowns|free|lcp OP NUMBER      (sizes, as `status` shows them)
///   expect ray mechanism|artefact|fault|no-equilibrium
///   expect verdict certified|proved|undecided
///   expect collapse|undecided OP NUMBER     (probabilities, after `sample`)
///   expect result KEY OP NUMBER|WORD        (after map, cycle, …: key of its JSON)
///   expect stage S …                        (after `stages`: at the end of stage S)
///   expect error "part of the message"      (after a command that fails)
/// NUMBER and TOLERANCE may be formulas of the parameters: `2*f*F`, `q*L^2/8`; a tolerance also `1%`.
/// States, forces and p are those at the pivot chosen by `step`.
#[derive(Debug, Args)]
#[command(
    verbatim_doc_comment,
    after_help = "Example:\n  expect outcome normal\n  expect x_n c1 = 100 ± 1e-6\n  expect x_t c6 = -f*F ± 1%\n  expect pivots <= 20"
)]
pub struct Expect {
    /// What is expected
    #[arg(value_name = "EXPECTATION", required = true, trailing_var_arg = true, allow_hyphen_values = true)]
    words: Vec<String>,
}

/// Probabilities of the last `sample`.
const SAMPLED: [&str; 2] = ["collapse", "undecided"];

pub const EXPECT: Command = Command { complete: words, keeps_error: true, ..Command::of::<Expect>("expect") };

/// A value in a message: a word as it is, of a list its length, of an object its keys.
fn shown(value: &Json) -> String {
    match value {
        Json::String(word) => word.clone(),
        Json::Array(list) => format!("a list of {}", list.len()),
        Json::Object(entries) => format!("an object with {}", entries.keys().cloned().collect::<Vec<_>>().join(", ")),
        value => value.to_string(),
    }
}

impl Action for Expect {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.expect(&self.words, io)?;
        Ok(Next::Continue)
    }

    fn needs_pivots(&self) -> bool {
        true
    }

    fn expects_error(&self) -> bool {
        self.words.first().is_some_and(|word| word == "error")
    }
}

/// A subject, and what it is compared with.
fn words(asked: &Asked<'_>) -> Vec<Candidate> {
    let choices = |subject: &str| expect::choices(subject, asked.names.dimension);
    match asked.given {
        [] => {
            let mut all = Candidate::plain(expect::subjects(asked.names.dimension));
            all.extend(asked.quantities(&[]));
            all
        }
        [subject] if subject != "state" && !choices(subject).is_empty() => Candidate::plain(choices(subject)),
        [.., subject, _] if subject == "state" => Candidate::plain(choices("state")),
        given => asked.quantities(given),
    }
}

/// The entry of a report that a path like `groups[0].value` leads to; a negative number counts from the end of a list.
///
/// # Errors
/// What there is in the place of a key that is not there.
fn entry<'a>(report: &'a Json, path: &str) -> Result<&'a Json, String> {
    let mut at = report;
    for key in path.split(['.', '[']).map(|key| key.trim_end_matches(']')) {
        at = match at {
            Json::Object(entries) => entries.get(key).ok_or_else(|| {
                format!("no key `{key}`; there are {}", entries.keys().cloned().collect::<Vec<_>>().join(", "))
            })?,
            Json::Array(list) => {
                let place = key.parse::<i64>().ok();
                let place = place.map(|place| if place < 0 { place + list.len() as i64 } else { place });
                let found = place.and_then(|place| list.get(usize::try_from(place).ok()?));
                found.ok_or_else(|| format!("no entry [{key}]; the list has {}", list.len()))?
            }
            _ => return Err(format!("nothing has a key `{key}` there")),
        };
    }
    Ok(at)
}

impl Session {
    /// Remembers what a command reported, for `expect result`.
    pub(in crate::session) fn keep_result(&mut self, report: &impl Serialize) {
        self.result = serde_json::to_value(report).ok();
    }

    /// `KEY OP NUMBER|WORD`.
    fn expect_result(&self, words: &[String]) -> Result<(), CommandError> {
        let [key, rest @ ..] = words else {
            return refused("expect: expected `expect result KEY OP VALUE`, e.g. `expect result kind = shakes-down`");
        };
        let Some(report) = &self.result else {
            return refused("expect: no result yet: map, find, cycle, sample, prove and calibrate leave one");
        };
        let found = entry(report, key).map_err(|why| CommandError::Refused(format!("expect: {key}: {why}")))?;
        let (expected, holds) = match (found, rest) {
            (Json::Number(number), _) => {
                let bound = expect::bound(rest, &self.now.values)?;
                (bound.to_string(), number.as_f64().is_some_and(|number| bound.holds(number)))
            }
            (Json::Array(_) | Json::Object(_), _) => {
                return refused(format!("expect: {key} is not a single value: {}", shown(found)));
            }
            (_, [sign, word]) if sign == "=" || sign == "!=" => {
                (format!("{sign} {word}"), (shown(found) == *word) == (sign == "="))
            }
            _ => return refused(format!("expect: {key} is {}: expected `= WORD` or `!= WORD`", shown(found))),
        };
        match holds {
            true => Ok(()),
            false => Err(expect::Unmet { expected: format!("{key} {expected}"), found: shown(found) }.into()),
        }
    }

    fn expect(&mut self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        let apart = expect::apart(words, |_| false);
        if let Some((subject, rest)) = apart.split_first().filter(|(first, _)| SAMPLED.contains(&first.as_str())) {
            let bound = expect::bound(rest, &self.now.values)?;
            let sampled = self.need_sample()?;
            let found = if subject == SAMPLED[0] { sampled.collapse } else { sampled.undecided };
            if !bound.holds(found) {
                let unmet = expect::Unmet { expected: format!("{subject} {bound}"), found: found.to_string() };
                return Err(unmet.into());
            }
            return Ok(io.say(&format!("as expected: {}", words.join(" ")))?);
        }
        if let Some((_, rest)) = apart.split_first().filter(|(first, _)| *first == "result") {
            self.expect_result(rest)?;
            return Ok(io.say(&format!("as expected: {}", words.join(" ")))?);
        }
        let expectation = expect::read(words, &self.names(), &self.now.values)?;
        self.with_facts(io.watch, |facts| expectation.test(facts, self.last_error.as_deref()))?;
        match expectation {
            expect::Expectation::Word { quantity: Quantity::Answer(OfAnswer::Outcome), .. } => self.trouble = false,
            expect::Expectation::Error(_) => self.last_error = None,
            _ => {}
        }
        Ok(io.say(&format!("as expected: {}", words.join(" ")))?)
    }
}
