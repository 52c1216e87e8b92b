//! `expect`: a test of the answer.

use clap::Args;

use crate::model::quantity::{OfAnswer, Quantity};
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

/// What the last `sample` tells.
const SAMPLED: [&str; 2] = ["collapse", "undecided"];

pub const EXPECT: Command = Command { complete: words, keeps_error: true, ..Command::of::<Expect>("expect") };

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
    match asked.given {
        [] => {
            let mut all = Candidate::plain(expect::subjects());
            all.extend(asked.quantities(&[]));
            all
        }
        [subject] if subject != "state" && !expect::choices(subject).is_empty() => {
            Candidate::plain(expect::choices(subject))
        }
        [.., subject, _] if subject == "state" => Candidate::plain(expect::choices("state")),
        given => asked.quantities(given),
    }
}

impl Session {
    fn expect(&mut self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        if let Some((subject, rest)) = words.split_first().filter(|(first, _)| SAMPLED.contains(&first.as_str())) {
            let bound = expect::bound(rest, &self.now.values)?;
            let sampled = self.need_sample()?;
            let found = if subject == SAMPLED[0] { sampled.collapse } else { sampled.undecided };
            if !bound.holds(found) {
                let unmet = expect::Unmet { expected: format!("{subject} {bound}"), found: found.to_string() };
                return Err(unmet.into());
            }
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
