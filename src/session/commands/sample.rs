//! `sample`: the probability of collapse, and how quantities are spread.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use clap::Args;
use serde_json::Value as Json;

use crate::model::quantity::{OfAnswer, Quantity};
use crate::path::grid::{Grid, Shard};
use crate::path::sample::{self, MOST_SHOWN, Request, Sampled, variable};
use crate::path::sweep;
use crate::path::sweep_file::run_to_file;
use crate::session::commands::sweep::{done_sentence, format_of};
use crate::session::error::refused;
use crate::session::language::candidates::{Asked, Candidate};
use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session, worker};
use crate::view;

/// How long the draws that are ready are waited for where the rest is stopped.
const PATIENCE: Duration = Duration::from_secs(2);
/// The seed where none is given.
const SEED: u64 = 1;

/// Show the probability of collapse, and how quantities are spread, where parameters are distributed
///
/// `sample P=DISTRIBUTION … [N] [of QUANTITY, …]`, where DISTRIBUTION is uniform(LEAST, GREATEST), normal(MEAN, DEVIATION),
/// lognormal(MEAN, DEVIATION) of the value itself, or triangular(LEAST, LIKELIEST, GREATEST). What a law of contact cannot
/// take (a negative friction) is cut off, and that is said.
///
/// Of one parameter that is followed exactly (loads, friction) the probability is exact, and so are the quantiles; of two
/// uniform ones it is the area in the map. Else N points are drawn (2000 if left out), and standard errors are told. Where
/// collapse is rare, most points are drawn near the limit of the load that leads to it, and count with weights;
/// `--crude` draws all of them as the parameters are distributed. An outcome that is neither an answer nor proved to be
/// none is counted apart, as undecided.
///
/// The same seed gives the same points. With `--out` the points go to a .csv or .json file as they are solved, as those
/// of `sweep` do: on any number of threads the same bytes, `--shard K/N` for a part, `stickslip merge` joins them, and
/// `--out JOINED --resume` reads what is there and shows it.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  set F2 150; sample f=uniform(0.2,0.6)\n  sample f=normal(0.4,0.05) F2=triangular(100,150,220) 5000 of z_t c6, max u\n  sample f=uniform(0.2,0.6) 1e5 --seed 7 --out draws.csv"
)]
pub struct Sample {
    /// Parameters with their distributions, the number of points, `of` and quantities
    #[arg(value_name = "SAMPLED", required = true, allow_negative_numbers = true)]
    words: Vec<String>,
    /// Seed of the draws
    #[arg(long, value_name = "SEED", default_value_t = SEED)]
    seed: u64,
    /// Draw all points as the parameters are distributed
    #[arg(long)]
    crude: bool,
    /// File for the points: .csv, or .json for one object a line
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Continue the file
    #[arg(long, requires = "out")]
    resume: bool,
    /// Only part K of N
    #[arg(long, value_name = "K/N", requires = "out")]
    shard: Option<Shard>,
}

pub const SAMPLE: Command = Command { in_0_1: false, complete: candidates, ..Command::of::<Sample>("sample") };

impl Action for Sample {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.sample(self, io)?;
        Ok(Next::Continue)
    }

    fn is_of_own_factors(&self, _: &Session) -> bool {
        true
    }
}

/// Parameters with the beginning of a distribution; after `of` quantities.
fn candidates(asked: &Asked<'_>) -> Vec<Candidate> {
    if asked.option.is_some() {
        return Vec::new();
    }
    if let Some(at) = asked.given.iter().position(|word| word == "of") {
        return asked.quantities(&asked.given[at + 1..]);
    }
    let mut all = asked.parameters();
    if !asked.given.is_empty() {
        all.extend(Candidate::plain(["of"]));
    }
    all
}

/// Words joined again that stand within parentheses or beside an equals sign.
fn joined(words: &[String]) -> Vec<String> {
    let mut joined: Vec<String> = Vec::new();
    let mut open = 0i32;
    for word in words {
        match joined.last_mut().filter(|last| open > 0 || word.starts_with('=') || last.ends_with('=')) {
            Some(last) => last.push_str(word),
            None => joined.push(word.clone()),
        }
        open += word.matches('(').count() as i32 - word.matches(')').count() as i32;
    }
    joined
}

/// A number of points: `2000`, `1e5`.
fn count(word: &str) -> Option<Result<usize, CommandError>> {
    let number = word.parse::<f64>().ok()?;
    let whole = number.fract() == 0.0 && (2.0..=1e9).contains(&number);
    Some(if whole {
        Ok(number as usize)
    } else {
        refused(format!("sample: `{word}` is not a number of points; expected a whole number from 2 to 1e9"))
    })
}

impl Session {
    fn sample_request(&self, asked: &Sample) -> Result<(Request, Vec<String>), CommandError> {
        let (words, quantities) = match asked.words.iter().position(|word| word == "of") {
            None => (&asked.words[..], Vec::new()),
            Some(at) => (&asked.words[..at], self.quantities(&asked.words[at + 1..])?),
        };
        if quantities.is_empty() && words.len() < asked.words.len() {
            return refused("sample: expected a quantity after `of`, e.g. `sample f=uniform(0.2,0.6) of max u`");
        }
        self.need_stages("sample", &quantities)?;
        if let Some(quantity) = quantities.iter().find(|quantity| quantity.is_word() && !quantity.is_of_state()) {
            return refused(match quantity {
                Quantity::Answer(OfAnswer::Outcome) => {
                    "sample: the probability of collapse is told by every sample, with and without `of`: leave `outcome` out"
                        .to_owned()
                }
                _ => format!("sample: `{quantity}` is a word, which has no mean and no quantiles"),
            });
        }
        let mut request =
            Request { variables: Vec::new(), count: None, seed: asked.seed, quantities, crude: asked.crude };
        for word in joined(words) {
            match count(&word) {
                Some(found) if request.count.is_none() => request.count = Some(found?),
                Some(_) => return refused("sample: one number of points is enough"),
                None => request
                    .variables
                    .push(variable(&word).map_err(|why| CommandError::Refused(format!("sample: {why}")))?),
            }
        }
        let notes = request.fit(&self.now.scenario).map_err(CommandError::Refused)?;
        Ok((request, notes))
    }

    fn sample(&mut self, asked: &Sample, io: &mut Output<'_>) -> Result<(), CommandError> {
        let (request, notes) = self.sample_request(asked)?;
        let mut found = match &asked.out {
            Some(path) => match self.sample_into(asked, path, &request, io)? {
                Some(found) => found,
                None => return Ok(()),
            },
            None if request.count.is_some_and(|count| count > MOST_SHOWN) => {
                return refused(format!("sample: more than {MOST_SHOWN} points belong in a file: `--out FILE`"));
            }
            None => {
                let ground = self.ground(io.watch)?;
                let asked = request.clone();
                worker::run_patiently(io.watch, PATIENCE, move |watch| sample::sample(ground.case(watch), &asked))??
            }
        };
        for (spread, quantity) in found.quantities.iter_mut().zip(&request.quantities) {
            spread.unit = quantity.unit(&self.now.scenario.units);
        }
        found.notes.splice(0..0, notes);
        let found = Arc::new(found);
        io.show(&*found, |out, style| view::sample::write(out, &found, style))?;
        self.keep_result(&*found);
        self.sampled = Some(found);
        Ok(())
    }

    /// The points into a file; what they say where the file has all of them.
    fn sample_into(
        &self,
        asked: &Sample,
        path: &Path,
        request: &Request,
        io: &mut Output<'_>,
    ) -> Result<Option<Sampled>, CommandError> {
        let format = format_of(path)?;
        let ground = self.ground(io.watch)?;
        let (draw, near) = {
            let (ground, request) = (ground.clone(), request.clone());
            worker::run(io.watch, move |watch| request.draw(ground.case(watch)))??
        };
        let grid = Grid::of_draw(draw);
        let quantities: Vec<Quantity> = sample::with_verdict(&request.quantities);
        let sweep = sweep::Sweep {
            case: ground.case(io.watch),
            grid: &grid,
            shard: asked.shard.unwrap_or(Shard::WHOLE),
            format,
            quantities: &quantities,
        };
        let done = run_to_file(&sweep, path, asked.resume, io.watch)?;
        if !done.is_complete() || sweep.shard != Shard::WHOLE {
            io.say(&done_sentence(&done, path))?;
            return Ok(None);
        }
        let draws = sample::of_file(&sweep, path)?;
        let mut found = Sampled::of_draws(request, &draws, near);
        found.notes.push(done_sentence(&done, path));
        Ok(Some(found))
    }

    /// The last sample.
    ///
    /// # Errors
    /// There is none.
    pub(in crate::session) fn need_sample(&self) -> Result<&Sampled, CommandError> {
        match &self.sampled {
            Some(found) => Ok(found),
            None => refused("nothing was sampled yet: `sample PARAMETER=DISTRIBUTION`"),
        }
    }

    /// The last sample as a table of numbers: what they are of, and which.
    pub(in crate::session) fn sample_rows(&self) -> Result<Json, CommandError> {
        let found = self.need_sample()?;
        let row = |of: &str, what: String, value: Json| serde_json::json!({"of": of, "what": what, "value": value});
        let mut rows = vec![
            row("collapse", "probability".into(), found.collapse.into()),
            row("collapse", "standard error".into(), found.standard_error.into()),
            row("undecided", "probability".into(), found.undecided.into()),
            row("undecided", "standard error".into(), found.undecided_error.into()),
        ];
        for spread in &found.quantities {
            let of = spread.quantity.as_str();
            for (what, value) in [
                ("known", Some(spread.known)),
                ("mean", spread.mean),
                ("standard error of the mean", spread.mean_error),
                ("deviation", spread.deviation),
                ("least", spread.least),
                ("most", spread.most),
            ] {
                rows.extend(value.map(|value| row(of, what.into(), value.into())));
            }
            rows.extend(spread.quantiles.iter().map(|(p, value)| row(of, format!("quantile {p}"), (*value).into())));
            let bar = |bar: &sample::statistics::Bar| {
                row(of, format!("probability of {}..{}", bar.from, bar.to), bar.probability.into())
            };
            rows.extend(spread.histogram.iter().map(bar));
            rows.extend(
                spread.words.iter().map(|(word, share)| row(of, format!("probability of {word}"), (*share).into())),
            );
        }
        Ok(Json::Array(rows))
    }
}
