//! `find`: values of a parameter at which a quantity is as wanted, or up to which there is an answer.

use clap::Args;
use serde::Serialize;

use crate::model::quantity::{OfAnswer, Quantity};
use crate::path::edge::{Which, edge};
use crate::path::find::{Found, Order, Wanted, find};
use crate::view;

use crate::model::words::no_such;
use crate::session::error::refused;
use crate::session::language::candidates::{Asked, Candidate};
use crate::session::language::command::{Action, Command};
use crate::session::language::expect::{self, Expectation, Operator};
use crate::session::language::{range, tokens};
use crate::session::{CommandError, Next, Output, Session, worker};

/// Find the values of a parameter or load at which a quantity is as wanted
///
/// `find NAME [A..B] where QUANTITY < | <= | = | >= | > VALUE` (or `QUANTITY WORD`) tells every interval and place in the
/// range, which is that of the slider if it is left out. Where an exact path leads over NAME (loads, friction) they are exact
/// and in order, in space found along Coulomb's cone in steps; elsewhere (geometry, stiffness) they are brackets
/// between runs of their own. `find least|most NAME [A..B] where outcome answer` brackets the first value with an
/// answer between a checked answer and a proved collapse; with another condition it is the first or the last place at
/// which that holds. Of a quantity that may bend either way between two changes (`min mises`) not all places need show;
/// a note says so.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  find F2 0..400 where z_t c3 > 0\n  find f 0..1 where x_t c1 = -50\n  find F2 where state c3 = slip+\n  find most F2 where outcome answer"
)]
pub struct Find {
    /// `least` or `most`, the parameter or load case, the range, `where` and the condition
    #[arg(value_name = "FOUND", required = true, trailing_var_arg = true, allow_hyphen_values = true)]
    words: Vec<String>,
}

pub const FIND: Command = Command { in_0_1: false, complete: words, ..Command::of::<Find>("find") };

impl Action for Find {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.find(&self.words, io)?;
        Ok(Next::Continue)
    }

    fn is_of_own_factors(&self, _: &Session) -> bool {
        true
    }
}

/// `least` or `most`, the parameter or load case, `where`, the condition.
pub(super) fn words(asked: &Asked<'_>) -> Vec<Candidate> {
    if let Some(at) = tokens::place_of(asked.given, "where") {
        let choices = |subject: &str| expect::choices(subject, asked.names.dimension);
        return match &asked.given[at + 1..] {
            [subject, _] if subject == "state" => Candidate::plain(["="]),
            [.., subject, sign] if sign == "=" && !choices(subject).is_empty() => Candidate::plain(choices(subject)),
            [subject, _, sign] if sign == "=" && subject == "state" => Candidate::plain(choices("state")),
            rest => asked.quantities(rest),
        };
    }
    match asked.given {
        [] => {
            let mut all = asked.varied();
            all.push(Candidate::new("least", "the first value with an answer"));
            all.push(Candidate::new("most", "the last one"));
            all
        }
        [word] if word == "least" || word == "most" => asked.varied(),
        _ => vec![Candidate::new("where", "the condition")],
    }
}

/// What follows `find`.
struct Request {
    which: Option<Which>,
    name: String,
    range: [f64; 2],
    quantity: Quantity,
    wanted: Wanted,
    /// The condition as written.
    condition: String,
}

impl Session {
    /// The name of a parameter that can be set, or of a load case.
    pub(in crate::session) fn varied<'w>(&self, name: &'w str) -> Result<&'w str, CommandError> {
        let scenario = &self.now.scenario;
        let cases = self.vocabulary().cases;
        if cases.iter().any(|case| case == name) {
            return Ok(name);
        }
        if !self.now.values.contains_key(name) {
            // as the shell's `--vary` has it
            if let Some((known, range)) = name.split_once('=')
                && (self.now.values.contains_key(known) || cases.iter().any(|case| case == known))
            {
                return refused(format!("`{name}`: here the range stands behind the name: `{known} {range}`"));
            }
            let names = self.now.values.iter().map(|(name, _)| name.as_str()).chain(cases.iter().map(String::as_str));
            return refused(no_such("parameter or load case", name, names));
        }
        match scenario.refusal(name, self.now.values[name]) {
            Some(refusal) => refused(refusal),
            None => Ok(name),
        }
    }

    /// The range of the slider of a parameter.
    pub(in crate::session) fn slider(&self, name: &str, command: &str) -> Result<[f64; 2], CommandError> {
        let parameter = self.now.scenario.parameters.get(name);
        match parameter.and_then(|parameter| Some([parameter.min?, parameter.max?])) {
            Some(range) => Ok(range),
            None => refused(format!(
                "{command}: in which range? {name} has no slider with `min` and `max`: write `{command} {name} A..B …`"
            )),
        }
    }

    fn request(&self, words: &[String]) -> Result<Request, CommandError> {
        let form = "find: expected `find NAME [A..B] where QUANTITY = VALUE` or `find least|most NAME [A..B] where outcome \
                    answer`";
        let at = tokens::place_of(words, "where");
        let Some((head, condition)) = at.map(|at| (&words[..at], &words[at + 1..])) else { return refused(form) };
        let (which, head) = match head {
            [word, name, ..] if self.varied(name).is_err() && self.varied(word).is_ok() => (None, head),
            [word, rest @ ..] if word == "least" && !rest.is_empty() => (Some(Which::Least), rest),
            [word, rest @ ..] if word == "most" && !rest.is_empty() => (Some(Which::Most), rest),
            head => (None, head),
        };
        let (name, range) = match head {
            [name] => (self.varied(name)?, self.slider(name, "find")?),
            [name, text] => (self.varied(name)?, range::upwards(text, "find")?),
            _ => return refused(form),
        };
        let read = expect::read(condition, &self.names(), &self.now.values)
            .map_err(|error| CommandError::Refused(error.said_by("find")))?;
        let (quantity, wanted) = match read {
            Expectation::Word { quantity, word, equal: true } => (quantity, Wanted::Word(word)),
            Expectation::Number { quantity, bound } => {
                let order = match bound.parts() {
                    (Operator::Less, ..) => Order::Less,
                    (Operator::LessEqual, ..) => Order::AtMost,
                    (Operator::Equal, _, 0.0) => Order::Equal,
                    (Operator::GreaterEqual, ..) => Order::AtLeast,
                    (Operator::Greater, ..) => Order::Greater,
                    _ => return refused("find: expected < <= = >= or > and a number, without a tolerance"),
                };
                (quantity, Wanted::Compared(order, bound.parts().1))
            }
            _ => return refused("find: expected QUANTITY < | <= | = | >= | > VALUE, or QUANTITY and a word"),
        };
        let (name, condition) = (name.to_owned(), condition.join(" "));
        Ok(Request { which, name, range, quantity, wanted, condition })
    }

    /// `find NAME [A..B] where …`, `find least|most NAME [A..B] where …`.
    pub(in crate::session) fn find(&mut self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        let request = self.request(words)?;
        let ground = self.ground(io.watch)?;
        let (name, range) = (request.name.clone(), request.range);
        let unit = self.now.scenario.unit_of(&name).map(str::to_owned);
        let outcome = matches!(&request.quantity, Quantity::Answer(OfAnswer::Outcome))
            && request.wanted == Wanted::Word("answer".to_owned());
        let name = request.name.clone();
        if let (Some(which), true) = (request.which, outcome) {
            let found = worker::run(io.watch, move |watch| edge(ground.case(watch), &name, range, which))??;
            let word = if which == Which::Least { "least" } else { "most" };
            let report = FindReport::of(&request, &found, Some(word));
            io.show(&report, |out, style| {
                view::find::write_edge(out, (&request.name, word), unit.as_deref(), &found, style)
            })?;
            self.keep_result(&report);
            return Ok(());
        }
        let (quantity, wanted) = (request.quantity.clone(), request.wanted.clone());
        let mut found =
            worker::run(io.watch, move |watch| find(ground.case(watch), &name, range, &quantity, &wanted))??;
        if let Some(which) = request.which {
            keep_end(&mut found, which);
        }
        let asked =
            view::find::Asked { name: &request.name, unit: unit.as_deref(), range, condition: &request.condition };
        let report = FindReport::of(&request, &found, None);
        io.show(&report, |out, style| view::find::write(out, &asked, &found, style))?;
        self.keep_result(&report);
        Ok(())
    }
}

/// What was asked, and what was found.
#[derive(Serialize)]
struct FindReport<'a, F> {
    parameter: &'a str,
    from: f64,
    to: f64,
    condition: &'a str,
    #[serde(flatten)]
    found: &'a F,
    #[serde(skip_serializing_if = "Option::is_none")]
    which: Option<&'a str>,
}

impl<'a, F> FindReport<'a, F> {
    fn of(request: &'a Request, found: &'a F, which: Option<&'a str>) -> Self {
        let Request { name, range: [from, to], condition, .. } = request;
        FindReport { parameter: name, from: *from, to: *to, condition, found, which }
    }
}

/// Keeps the first or the last value at which the condition holds.
fn keep_end(found: &mut Found, which: Which) {
    let values = || found.holds.iter().flatten().copied().chain(found.places.iter().map(|place| place.value));
    let end = match which {
        Which::Least => values().fold(f64::INFINITY, f64::min),
        Which::Most => values().fold(f64::NEG_INFINITY, f64::max),
    };
    found.holds.retain(|ends| ends.contains(&end));
    found.places.retain(|place| place.value == end);
}
