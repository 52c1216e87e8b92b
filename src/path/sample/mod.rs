//! The probability of collapse, and how quantities are spread, where parameters are distributed: exactly of one parameter or
//! two, else from points drawn at random.
//!
//! A point counts as a collapse only where it is certified or proved that there is no answer; what is neither this nor
//! an answer is counted apart.

pub mod distribution;
pub mod draw;
mod exact;
pub mod rare;
pub mod statistics;

use std::io::BufRead;

use serde::Serialize;
use serde_json::Value;

use self::draw::{Draw, Rule, Variable};
use self::statistics::{Drawn, Found, Share, Spread};
use super::grid::{Grid, Shard};
use super::start::PathError;
use super::sweep::{Format, Sweep};
use crate::model::quantity::{OfAnswer, Quantity};
use crate::model::scenario::Scenario;
use crate::model::words::no_such;
use crate::solve::Case;
use crate::text::number::short;

/// Points drawn where no number is given.
pub const DRAWS: usize = 2000;
/// Most parameters.
pub const MOST_PARAMETERS: usize = 60;
/// More points than this belong in a file.
pub const MOST_SHOWN: usize = 200_000;

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    pub variables: Vec<Variable>,
    /// How many points; `None`: none where exact results suffice, else [`DRAWS`].
    pub count: Option<usize>,
    pub seed: u64,
    pub quantities: Vec<Quantity>,
    /// Whether draws stay where the parameters are, rare collapse or not.
    pub crude: bool,
}

/// What was found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sampled {
    /// `f=uniform(0.2,0.6)`, one for each parameter.
    pub parameters: Vec<String>,
    /// Whether the probabilities are exact.
    pub exact: bool,
    /// Probability that there is no answer: certified or proved.
    pub collapse: f64,
    /// Its standard error; 0 where it is exact.
    pub standard_error: f64,
    /// Collapses drawn.
    pub collapses: Option<usize>,
    /// Where none was drawn: the probability below which it lies with 95 %.
    pub below: Option<f64>,
    /// Probability of neither an answer nor a proof that there is none.
    pub undecided: f64,
    pub undecided_error: f64,
    /// Points drawn; 0 where none was.
    pub draws: usize,
    pub seed: u64,
    /// The load near whose limit they were drawn.
    pub near: Option<String>,
    pub quantities: Vec<Spread>,
    pub notes: Vec<String>,
}

/// Reads `f=uniform(0.2,0.6)`.
///
/// # Errors
/// What it is not.
pub fn variable(text: &str) -> Result<Variable, String> {
    let form = || format!("`{text}`: expected PARAMETER=DISTRIBUTION, e.g. f=uniform(0.2,0.6)");
    let (name, of) = text.split_once('=').ok_or_else(form)?;
    let of = of.parse().map_err(|error: distribution::DistributionError| error.to_string())?;
    Ok(Variable { name: name.trim().to_owned(), of })
}

impl Request {
    /// Checks the parameters against the scenario and cuts off what a law of contact cannot take; says what was cut.
    ///
    /// # Errors
    /// No such parameter, one twice, a formula, too many.
    pub fn fit(&mut self, scenario: &Scenario) -> Result<Vec<String>, String> {
        let mut notes = Vec::new();
        if self.variables.is_empty() || self.variables.len() > MOST_PARAMETERS {
            return Err(format!(
                "sample: expected one to {MOST_PARAMETERS} parameters, found {}",
                self.variables.len()
            ));
        }
        for k in 0..self.variables.len() {
            let (before, rest) = self.variables.split_at_mut(k);
            let Variable { name, of } = &mut rest[0];
            if before.iter().any(|other| other.name == *name) {
                return Err(format!("sample: {name} is given twice"));
            }
            if !scenario.parameters.contains_key(name) {
                let known = scenario.parameters.keys().map(String::as_str);
                return Err(format!("sample: {}", no_such("parameter", name, known)));
            }
            if let Some(refusal) = scenario.refusal(name, 1.0) {
                return Err(format!("sample: {refusal}"));
            }
            if scenario.refusal(name, -1.0).is_some() && of.share(0.0) > 0.0 && of.least.is_none() {
                let cut = of.share(0.0);
                let whole = of.to_string();
                of.least = Some(0.0);
                if of.ends().is_some_and(|[low, high]| low >= high) || cut >= 1.0 - f64::EPSILON {
                    return Err(format!("sample: {name} must not be negative, and {whole} is"));
                }
                notes.push(format!(
                    "{name} must not be negative: {whole} is cut off below 0, where a share of {} of it lies",
                    short(cut)
                ));
            }
        }
        Ok(notes)
    }

    /// The points to be drawn; near the limit of a load where collapse is rare.
    ///
    /// # Errors
    /// An interruption.
    pub fn draw(&self, case: Case<'_>) -> Result<(Draw, Option<String>), PathError> {
        let rule = Rule { seed: self.seed, centre: None };
        let mut draw = Draw { variables: self.variables.clone(), rule, count: self.count.unwrap_or(DRAWS) };
        let mut near = None;
        if !self.crude
            && let Some(centre) = rare::centre(case, &draw)?
        {
            draw.rule.centre = Some(centre.place);
            near = Some(centre.load);
        }
        Ok((draw, near))
    }
}

/// The quantities asked for, after the verdict, which tells a collapse from what is undecided.
pub fn with_verdict(quantities: &[Quantity]) -> Vec<Quantity> {
    std::iter::once(Quantity::Answer(OfAnswer::Verdict)).chain(quantities.iter().cloned()).collect()
}

/// Draws that are solved at once, in memory.
struct Sampler<'a> {
    case: Case<'a>,
    draw: Draw,
    quantities: &'a [Quantity],
}

impl Sampler<'_> {
    /// The draws; those that were ready where it was stopped.
    fn run(&self) -> Result<Vec<Drawn>, PathError> {
        let grid = Grid::of_draw(self.draw.clone());
        let sweep = Sweep {
            case: self.case,
            grid: &grid,
            shard: Shard::WHOLE,
            format: Format::Json,
            quantities: self.quantities,
        };
        let mut rows = Vec::new();
        // Memory takes it.
        let _ = sweep.run(0, &mut rows, self.case.watch);
        Ok(read(&mut &rows[..], &grid, Format::Json, &sweep.columns()))
    }
}

/// The rows of a sweep over drawn points, from the first on.
fn read(rows: &mut dyn BufRead, grid: &Grid, format: Format, columns: &[String]) -> Vec<Drawn> {
    let Some(draw) = &grid.drawn else { return Vec::new() };
    let at = |name: &str| columns.iter().position(|column| column == name).unwrap_or_default();
    let (outcome, verdict) = (at("outcome"), at("verdict"));
    let of = |(index, line): (usize, String)| {
        let cells = cells(&line, format, columns);
        let word = |at: usize| cells.get(at).and_then(Value::as_str).unwrap_or_default();
        let found = match (word(outcome), word(verdict)) {
            ("trivial" | "normal", _) => Found::Answer,
            ("ray", "certified" | "proved") => Found::Collapse,
            _ => Found::Undecided,
        };
        let values = cells.get(verdict + 1..columns.len() - 1).unwrap_or_default().to_vec();
        Drawn { weight: draw.point(index).1, found, values }
    };
    rows.lines().map_while(Result::ok).enumerate().map(of).collect()
}

/// The fields of a row.
fn cells(line: &str, format: Format, columns: &[String]) -> Vec<Value> {
    match format {
        Format::Json => {
            let row: serde_json::Map<String, Value> = serde_json::from_str(line).unwrap_or_default();
            columns.iter().map(|column| row.get(column).cloned().unwrap_or_default()).collect()
        }
        Format::Csv => {
            let mut cells = vec![String::new()];
            let mut quoted = false;
            for c in line.chars() {
                match c {
                    '"' => quoted = !quoted,
                    ',' if !quoted => cells.push(String::new()),
                    c => cells.last_mut().into_iter().for_each(|cell| cell.push(c)),
                }
            }
            let value = |cell: String| match cell.parse::<f64>() {
                _ if cell.is_empty() => Value::Null,
                Ok(number) if number.is_finite() => serde_json::json!(number),
                _ => Value::String(cell),
            };
            cells.into_iter().map(value).collect()
        }
    }
}

/// Whether a file of a sweep holds drawn points, read from the end of its preamble on: what they say.
///
/// # Errors
/// The file cannot be read.
pub fn of_file(sweep: &Sweep<'_>, path: &std::path::Path) -> std::io::Result<Vec<Drawn>> {
    let mut reader = std::io::BufReader::new(std::fs::File::open(path)?);
    for _ in sweep.preamble().lines() {
        reader.read_line(&mut String::new())?;
    }
    Ok(read(&mut reader, sweep.grid, sweep.format, &sweep.columns()))
}

/// Samples: exactly where one parameter is followed, or the map of two shows it, else by draws.
///
/// # Errors
/// An interruption; a value that the scenario cannot take.
pub fn sample(case: Case<'_>, request: &Request) -> Result<Sampled, PathError> {
    let mut exact = None;
    if !request.crude && case.prepared.system().is_some_and(|system| !system.is_in_space()) {
        let found = match &request.variables[..] {
            // What takes a history or a search of its own at each value is drawn.
            [one] if !request.quantities.iter().all(Quantity::is_of_state) => exact::of_one(case, one, &[]),
            [one] => exact::of_one(case, one, &request.quantities),
            [one, other] => exact::of_two(case, [one, other]),
            _ => Ok(None),
        };
        exact = match found {
            Err(PathError::Interrupted) => return Err(PathError::Interrupted),
            // Values without a model, or paths that break down: drawn points show what they can.
            found => found.ok().flatten(),
        };
    }
    let exact = match exact.map(|exact| Sampled::of_exact(request, &exact)) {
        Some(found) if found.quantities.len() == request.quantities.len() => return Ok(found),
        other => other,
    };
    // Draws near the limit would estimate the quantities badly where the collapse is known.
    let (draw, near) = match exact {
        Some(_) => Request { crude: true, ..request.clone() }.draw(case)?,
        None => request.draw(case)?,
    };
    let asked = draw.count;
    let quantities = with_verdict(&request.quantities);
    let draws = Sampler { case, draw, quantities: &quantities }.run()?;
    let drawn = Sampled::of_draws(request, &draws, near);
    let mut found = match exact {
        None => drawn,
        Some(mut exact) => {
            exact.notes.push("the quantities are drawn".to_owned());
            Sampled { draws: drawn.draws, quantities: drawn.quantities, ..exact }
        }
    };
    if draws.len() < asked {
        found.notes.push(format!("stopped after {} of {asked} draws", draws.len()));
    }
    Ok(found)
}

impl Sampled {
    fn of_exact(request: &Request, exact: &exact::Exact) -> Sampled {
        let [collapse, undecided] = exact::shares(exact);
        Sampled {
            exact: true,
            quantities: exact.spreads.clone(),
            notes: exact.notes.clone(),
            ..Sampled::of_shares(request, collapse, undecided)
        }
    }

    /// What drawn points say; `near` is the load near whose limit they were drawn.
    pub fn of_draws(request: &Request, draws: &[Drawn], near: Option<String>) -> Sampled {
        let collapse = Share::of(draws, Found::Collapse);
        let undecided = Share::of(draws, Found::Undecided);
        let spread = |(column, quantity): (usize, &Quantity)| Spread::of(draws, column, quantity.to_string());
        let mut notes = Vec::new();
        if let Some(load) = &near {
            notes.push(format!(
                "collapse is rare: most draws were made near the limit of {load} and count with weights"
            ));
        }
        Sampled {
            draws: draws.len(),
            below: if near.is_none() { collapse.below(draws.len()) } else { None },
            near,
            quantities: request.quantities.iter().enumerate().map(spread).collect(),
            notes,
            ..Sampled::of_shares(request, collapse, undecided)
        }
    }

    fn of_shares(request: &Request, collapse: Share, undecided: Share) -> Sampled {
        Sampled {
            parameters: request.variables.iter().map(Variable::to_string).collect(),
            exact: false,
            collapse: collapse.probability,
            standard_error: collapse.standard_error,
            collapses: collapse.count,
            below: None,
            undecided: undecided.probability,
            undecided_error: undecided.standard_error,
            draws: 0,
            seed: request.seed,
            near: None,
            quantities: Vec::new(),
            notes: Vec::new(),
        }
    }
}
