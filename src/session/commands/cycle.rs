//! `cycle` and `limit cycle`: a load that goes to and fro.

use clap::Args;
use serde::Serialize;

use crate::answer::record::Ray;
use crate::model::quantity::fits;
use crate::model::words::no_such;
use crate::path::cycle::{Kind, MOST, PairSlip, Turn, cycle};
use crate::path::cycle_starts::{StartResult, Starts, from_all};
use crate::path::exact_cycle::Repetition;
use crate::path::record::PathRecord;
use crate::path::shakedown_limit::shakedown_limit;
use crate::path::stages::Begin;
use crate::path::static_shakedown::Static;
use crate::session::error::refused;
use crate::session::language::candidates::{Asked, Candidate};
use crate::session::language::command::{Action, Command};
use crate::session::language::range;
use crate::session::{CommandError, Next, Output, Session, worker};
use crate::view;

/// Repeat a load: does the structure shake down, slip to and fro, or creep further with every cycle?
///
/// `cycle LOAD A..B [N]`: from the unloaded structure to A, the other loads at their present factors, then to B and
/// back to A until a cycle repeats to 1e-12, at most N (256) times. Where the forces and gaps at the end of a cycle are
/// those at its beginning, every further cycle is the same; in small problems a proof of it in rationals is looked for.
/// LOAD is a load case or a parameter that factors of load cases depend on. `plot path` draws the loops.
///
/// `… from SLIPS` begins at A with slips that something before has left behind: `PAIR=SLIP …` (others 0; a name of an
/// edge contact or `*` stands for all its pairs), or one number for each pair; in space two numbers, along t1 and t2:
/// `PAIR=SLIP,SLIP`. Where these do not stand, pairs slip back at
/// once. `… from all` begins without slips and with the largest and least slip of each pair at which the structure stands,
/// to see whether the start decides. Where no slip changes a contact force, Melan's theorem may prove shakedown from
/// every start; it is asked, and said not to hold elsewhere.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  cycle F2 0..61\n  cycle pull -50..50 20\n  cycle F2 0..61 from c6=0.001 c5=-0.0002\n  cycle F2 0..61 from all"
)]
pub struct Repeated {
    /// The load, its two values, the most cycles, `from` and the slips
    #[arg(value_name = "REPEATED", required = true, trailing_var_arg = true, allow_hyphen_values = true)]
    words: Vec<String>,
}

pub const CYCLE: Command = Command { in_0_1: false, complete: candidates, ..Command::of::<Repeated>("cycle") };

impl Action for Repeated {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.cycle(&self.words, io)?;
        Ok(Next::Continue)
    }

    fn is_of_own_factors(&self, _: &Session) -> bool {
        true
    }
}

fn candidates(asked: &Asked<'_>) -> Vec<Candidate> {
    match asked.given {
        [] => asked.varied(),
        [.., word] if word == "from" => {
            let mut all = vec![Candidate::new("all", "no slips, and the largest both ways")];
            all.extend(slips(asked));
            all
        }
        given if given.iter().any(|word| word == "from") => slips(asked),
        [_] => Vec::new(),
        _ => vec![Candidate::new("from", "slips to begin with")],
    }
}

fn slips(asked: &Asked<'_>) -> Vec<Candidate> {
    asked.names.pairs.iter().map(|pair| Candidate::new(format!("{pair}="), "slip")).collect()
}

/// Where a cycle begins.
enum From {
    Begin(Begin),
    All,
}

/// What the static theorem says of every start.
#[derive(Serialize)]
struct StaticReport {
    applies: bool,
    proved: bool,
    least_reserve: Option<f64>,
    sentence: String,
}

impl StaticReport {
    /// `None` where it was not asked.
    fn of(found: &Static) -> Option<StaticReport> {
        let reserve = if let Static::Proved(reserve) = found { Some(*reserve) } else { None };
        Some(StaticReport {
            applies: !matches!(found, Static::Inapplicable(_)),
            proved: reserve.is_some(),
            least_reserve: reserve,
            sentence: view::cycle::every_start(found)?,
        })
    }
}

/// What is proved in rationals of the repetition.
#[derive(Serialize)]
struct ProofReport {
    proved: bool,
    working_schemes: Option<usize>,
    /// `identical`, `contracting`, `open`.
    map: Option<&'static str>,
    /// The largest difference between a contact force of the exact cycle and of the one followed, a force.
    distance: Option<f64>,
    /// The largest slip that the exact cycle leaves behind, a length.
    net: Option<f64>,
    sentence: String,
}

impl ProofReport {
    /// `None` where there was nothing to prove.
    fn of(found: &Repetition) -> Option<ProofReport> {
        let proved = if let Repetition::Proved(proved) = found { Some(proved) } else { None };
        Some(ProofReport {
            proved: proved.is_some(),
            working_schemes: proved.map(|proved| proved.schemes),
            map: proved.map(|proved| proved.map.word()),
            distance: proved.map(|proved| proved.distance),
            net: proved.map(|proved| proved.net),
            sentence: view::cycle::repetition(found)?,
        })
    }
}

#[derive(Serialize)]
struct StartsReport<'a> {
    load: &'a str,
    from: f64,
    to: f64,
    decides: bool,
    starts: &'a [StartResult],
    #[serde(rename = "static")]
    every_start: Option<StaticReport>,
    sentence: String,
}

#[derive(Serialize)]
struct CycleReport<'a> {
    load: &'a str,
    from: f64,
    to: f64,
    kind: Kind,
    cycles: &'a [Turn],
    collapse: Option<&'a Ray>,
    /// Slips at the first value.
    start: Vec<PairSlip>,
    proof: Option<ProofReport>,
    #[serde(rename = "static")]
    every_start: Option<StaticReport>,
    sentence: &'a str,
}

#[derive(Serialize)]
struct ShakedownReport<'a> {
    load: &'a str,
    from: f64,
    shakes_down: Option<f64>,
    beyond: Option<f64>,
    kind_beyond: Option<Kind>,
    /// Where the history broke down beyond, or gets to no other end at all: why.
    #[serde(skip_serializing_if = "Option::is_none")]
    why_beyond: Option<String>,
    /// Where it is undecided beyond: a value farther out that does not shake down, and what it comes to.
    #[serde(skip_serializing_if = "Option::is_none")]
    decided_beyond: Option<(f64, Kind)>,
    /// Up to where it shakes down from every start.
    from_every_start: Option<f64>,
    #[serde(rename = "static")]
    every_start: Option<StaticReport>,
}

impl Session {
    /// `cycle LOAD A..B [N] [from SLIPS | from all]`.
    pub(in crate::session) fn cycle(&mut self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        let at = words.iter().position(|word| word == "from");
        let (words, from) = match at {
            Some(at) => (&words[..at], self.begin(&words[at + 1..])?),
            None => (words, From::Begin(Begin::Unloaded)),
        };
        let (name, span, most) = match words {
            [name, span] => (name, span, MOST),
            [name, span, count] => match count.parse::<usize>() {
                Ok(most @ 1..=100_000) => (name, span, most),
                _ => return refused(format!("cycle: `{count}` is not a number of cycles; expected 1 to 100000")),
            },
            _ => {
                return refused(
                    "cycle: expected `cycle LOAD A..B [N] [from SLIPS | from all]`, e.g. `cycle pull 0..61`",
                );
            }
        };
        let (name, ends) = (self.varied(name)?.to_owned(), range::either_way(span, "cycle")?);
        let ground = self.ground(io.watch)?;
        let what = name.clone();
        let begin = match from {
            From::Begin(begin) => begin,
            From::All => {
                let found = worker::run(io.watch, move |watch| from_all(ground.case(watch), &what, ends, most))??;
                return self.show_starts(&found, io);
            }
        };
        let found = worker::run(io.watch, move |watch| cycle(ground.case(watch), &what, ends, most, &begin))??;
        let units = &self.now.scenario.units;
        let report = CycleReport {
            load: &name,
            from: ends[0],
            to: ends[1],
            kind: found.kind,
            cycles: &found.turns,
            collapse: found.collapse(),
            start: found.start(),
            proof: ProofReport::of(&found.repetition),
            every_start: StaticReport::of(&found.every_start),
            sentence: &found.sentence,
        };
        io.show(&report, |out, style| view::cycle::write(out, &found, self.now.scenario.unit_of(&name), units, style))?;
        self.keep_result(&report);
        self.keep_path(PathRecord::of_history(&found.history));
        Ok(())
    }

    fn show_starts(&mut self, found: &Starts, io: &mut Output<'_>) -> Result<(), CommandError> {
        let report = StartsReport {
            load: &found.name,
            from: found.ends[0],
            to: found.ends[1],
            decides: found.decides,
            starts: &found.starts,
            every_start: StaticReport::of(&found.every_start),
            sentence: found.sentence(),
        };
        let (unit, units) = (self.now.scenario.unit_of(&found.name), &self.now.scenario.units);
        io.show(&report, |out, style| view::cycle::write_starts(out, found, unit, units, style))?;
        self.keep_result(&report);
        Ok(())
    }

    /// What follows `from`: `all`, the numbers of each pair, or `PAIR=SLIP …`.
    fn begin(&self, words: &[String]) -> Result<From, CommandError> {
        let text = words.join(" ").replace(['(', ')', ','], " ").replace("= ", "=");
        let words: Vec<&str> = text.split_whitespace().collect();
        if words == ["all"] {
            return Ok(From::All);
        }
        let pairs = self.names().pairs;
        let named = words.iter().any(|word| word.contains('='));
        let form = "expected `from all`, `from PAIR=SLIP …` or `from` and a slip for each pair";
        if words.is_empty() {
            return refused(format!("cycle: nothing stands behind `from`; {form}"));
        }
        if let (["all", other, ..], _) | ([other, ..], false) = (&words[..], named)
            && finite(other).is_none()
        {
            return refused(match words[0] {
                "all" => format!("cycle: `from all` chooses the slips itself; `{other}` is one too many"),
                _ if pairs.contains(other) => format!("cycle: how far has {other} slipped? e.g. `from {other}=0.001`"),
                _ => format!("cycle: `{other}` is not a slip; {form}"),
            });
        }
        let parts = self.now.scenario.source.dimension().slips();
        if named {
            return named_slips(&words, &pairs, parts).map(|slips| From::Begin(Begin::Slips(slips)));
        }
        let numbers: Vec<f64> = words.iter().filter_map(|word| finite(word)).collect();
        if numbers.len() != words.len() || numbers.len() != parts * pairs.len() {
            let of_each = if parts == 1 { "one for each pair" } else { "two for each pair, along t1 and t2" };
            return refused(format!(
                "cycle: expected {} slips behind `from`, {of_each}, found {}; `from PAIR=SLIP …` names some",
                parts * pairs.len(),
                words.join(" ")
            ));
        }
        Ok(From::Begin(Begin::Slips(numbers.chunks(parts).map(slip_of).collect())))
    }

    /// `limit cycle LOAD [A..B]`: from A, 0 if it is left out; B is looked at first.
    pub(in crate::session) fn limit_cycle(
        &mut self,
        words: &[String],
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let (name, span) = match words {
            [name] => (name, None),
            [name, span] => (name, Some(range::either_way(span, "cycle")?)),
            _ => return refused("limit cycle: expected `limit cycle LOAD [A..B]`"),
        };
        let name = self.varied(name)?.to_owned();
        let ground = self.ground(io.watch)?;
        let present = ground.case(io.watch).present(&name).unwrap_or_default();
        let ends = span.unwrap_or([0.0, if present == 0.0 { 1.0 } else { present }]);
        let what = name.clone();
        let found = worker::run(io.watch, move |watch| shakedown_limit(ground.case(watch), &what, ends))??;
        let report = ShakedownReport {
            load: &name,
            from: found.from,
            shakes_down: found.shakes_down,
            beyond: found.beyond.as_ref().map(|beyond| beyond.value),
            kind_beyond: found.beyond.as_ref().map(|beyond| beyond.kind),
            why_beyond: found.beyond.as_ref().and_then(|beyond| beyond.why.clone()),
            decided_beyond: found.beyond.as_ref().and_then(|beyond| beyond.decided),
            from_every_start: found.every_start.0,
            every_start: StaticReport::of(&found.every_start.1),
        };
        io.show(&report, |out, style| {
            view::cycle::write_limit(out, &name, &found, self.now.scenario.unit_of(&name), style)
        })?;
        self.keep_result(&report);
        Ok(())
    }
}

fn finite(word: &str) -> Option<f64> {
    word.parse::<f64>().ok().filter(|value| value.is_finite())
}

/// Its parts along t, or along t1 and t2.
fn slip_of(parts: &[f64]) -> [f64; 2] {
    std::array::from_fn(|part| parts.get(part).copied().unwrap_or_default())
}

/// The slips of all pairs from `PAIR=SLIP …`, each of `parts` numbers; 0 for those that are not named.
fn named_slips(words: &[&str], pairs: &[&str], parts: usize) -> Result<Vec<[f64; 2]>, CommandError> {
    let mut slips: Vec<Option<[f64; 2]>> = vec![None; pairs.len()];
    let mut words = words.iter().copied().peekable();
    while let Some(word) = words.next() {
        let Some((pattern, first)) = word.split_once('=').and_then(|(id, slip)| Some((id, finite(slip)?))) else {
            return refused(format!("cycle: `{word}` is not a slip; expected PAIR=SLIP, e.g. `c1=0.001`"));
        };
        let mut numbers = vec![first];
        let more = std::iter::from_fn(|| words.next_if(|word| finite(word).is_some()));
        numbers.extend(more.take(parts - 1).filter_map(finite));
        if numbers.len() != parts {
            return refused(format!(
                "cycle: how far has {pattern} slipped along t1 and along t2? e.g. `{pattern}=0.001,-0.002`"
            ));
        }
        let fitting: Vec<usize> =
            pairs.iter().enumerate().filter(|(_, id)| fits(pattern, id)).map(|(index, _)| index).collect();
        if fitting.is_empty() {
            return refused(no_such("pair", pattern, pairs.iter().copied()));
        }
        if let Some(twice) = fitting.iter().find(|index| slips[**index].is_some()) {
            return refused(format!("cycle: the slip of {} is given twice", pairs[*twice]));
        }
        fitting.into_iter().for_each(|index| slips[index] = Some(slip_of(&numbers)));
    }
    Ok(slips.into_iter().map(Option::unwrap_or_default).collect())
}
