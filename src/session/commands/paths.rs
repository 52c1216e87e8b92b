//! `trace`, `limit`, `sensitivity`, `sweep`, and what `plot path` and `export path` show of them.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::{Value, json};

use crate::export::atomic;
use crate::export::table::Table;
use crate::model::quantity::{self, Quantity};
use crate::path::friction::{self, is_friction};
use crate::path::grid::{Axis, Grid, GridError, POINTS};
use crate::path::limit;
use crate::path::load::{self, LoadReach};
use crate::path::merge::Shards;
use crate::path::quantity::{Facts, NoValue, OnPath};
use crate::path::rate::{fixed_place, place_beside_laws};
use crate::path::record::{Followed, PathPlace, PathRecord};
use crate::path::sensitivity::sensitivity;
use crate::path::start::PathError;
use crate::path::sweep::Sweep;
use crate::path::sweep_file::{SweepFileError, run_to_file};
use crate::solve::numbers::factors;
use crate::solve::{Case, Prepared, Solved};
use crate::view;
use crate::view::plot::chart::Chart;
use crate::view::plot::zone::Quantity as Zone;
use crate::watch::Watch;

use crate::session::language::command::did_you_mean;
use crate::session::language::selection::no_such;
use crate::session::{CommandError, Output, Session, Setup, worker};

pub use crate::path::grid::Shard;
pub use crate::path::sweep::{Done, Format};

/// A table with more rows than this belongs in a file.
const ROWS: usize = 2_000;
/// Friction without a target and without a slider ends here.
const FRICTION: f64 = 10.0;

impl From<PathError> for CommandError {
    fn from(error: PathError) -> Self {
        match error {
            PathError::Interrupted => CommandError::Interrupted,
            lost @ PathError::Breakdown { .. } => CommandError::Lost(lost.to_string()),
            error => CommandError::Refused(error.to_string()),
        }
    }
}

impl From<GridError> for CommandError {
    fn from(error: GridError) -> Self {
        CommandError::Refused(error.to_string())
    }
}

impl From<SweepFileError> for CommandError {
    fn from(error: SweepFileError) -> Self {
        match error {
            SweepFileError::Output(error) => CommandError::Output(error),
            SweepFileError::Interrupted => CommandError::Interrupted,
            error => CommandError::Refused(error.to_string()),
        }
    }
}

/// What every path starts from.
pub(in crate::session) struct PathStart {
    setup: Setup,
    pub(in crate::session) prepared: Arc<Prepared>,
    solved: Arc<Solved>,
}

impl PathStart {
    pub(in crate::session) fn case<'a>(&'a self, watch: &'a dyn Watch) -> Case<'a> {
        self.setup.case(&self.prepared, watch)
    }
}

impl Session {
    /// The present setup, solved.
    pub(in crate::session) fn ground(&self, watch: &dyn Watch) -> Result<PathStart, CommandError> {
        let mut setup = self.now.clone();
        let solved = match (&self.solved, &setup.prepared) {
            (Some(solved), Some(_)) => Arc::clone(solved),
            _ => setup.solve(watch)?,
        };
        let prepared = setup
            .prepared
            .clone()
            .ok_or_else(|| CommandError::Internal("a solved scenario has no prepared geometry".to_owned()))?;
        Ok(PathStart { setup, prepared, solved })
    }

    fn case_names(prepared: &Prepared) -> Vec<String> {
        prepared.cases.iter().map(|(name, _)| name.clone()).collect()
    }

    /// `trace NAME [to V] [of QUANTITY …] [--through]`.
    pub(in crate::session) fn trace(
        &mut self,
        name: &str,
        words: &[String],
        through: bool,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let (to, words) = match words {
            [word, value, rest @ ..] if word == "to" => {
                let to = value.parse::<f64>();
                (Some(to.map_err(|_| CommandError::Refused(format!("trace: `{value}` is no number")))?), rest)
            }
            words => (None, words),
        };
        let quantities = match words {
            [] => Vec::new(),
            [word, rest @ ..] if word == "of" && !rest.is_empty() => self.quantities(rest)?,
            _ => {
                return Err(CommandError::Refused(
                    "trace: expected `trace NAME`, `trace NAME to VALUE`, and then `of QUANTITY`".into(),
                ));
            }
        };
        let ground = self.ground(io.watch)?;
        let units = self.now.scenario.units.clone();
        let geometry = Arc::clone(&ground.prepared);
        let what = name.to_owned();
        if is_friction(ground.case(io.watch), name) {
            let to = to.unwrap_or_else(|| {
                let slider = self.now.scenario.parameters.get(name).and_then(|p| p.max);
                let present = self.now.values.get(name).copied().unwrap_or_default();
                slider.filter(|max| *max > present).unwrap_or(FRICTION.max(2.0 * present))
            });
            let path = worker::run(io.watch, move |watch| {
                friction::trace(ground.case(watch), Some(&ground.solved), &what, to)
            })??;
            let record = PathRecord::of_friction(&path);
            let along = self.report_along(&geometry, &record, &quantities, io.watch)?;
            io.report(
                || {
                    json!({
                        "along": along_json(&record, &along),
                        "parameter": path.name,
                        "intervals": path.intervals.iter().map(|interval| json!({
                            "from": interval.from,
                            "to": interval.to,
                            "states": interval.pairs.iter().map(|pair| (pair.id.clone(), json!(pair.state)))
                                .collect::<serde_json::Map<_, _>>(),
                        })).collect::<Vec<_>>(),
                        "breakpoints": path.breakpoints.iter().map(|at| json!({
                            "value": at.value, "changes": at.changes, "jump": at.jump, "sentence": at.sentence,
                        })).collect::<Vec<_>>(),
                        "end": record.end,
                    })
                },
                |out, style| {
                    view::path::write_friction(out, &path, &units, style)?;
                    view::quantities::write_along(out, &record, &along, &units, style)
                },
            )?;
            self.path = Some(Arc::new(record));
            return Ok(());
        }
        let path = worker::run(io.watch, move |watch| {
            load::trace(ground.case(watch), Some(&ground.solved), &what, LoadReach { to, through })
        })??;
        let record = PathRecord::of_load(&path, &Self::case_names(&geometry));
        let along = self.report_along(&geometry, &record, &quantities, io.watch)?;
        io.report(
            || {
                json!({
                    "along": along_json(&record, &along),
                    "load": path.parameter.name,
                    "start": path.start,
                    "from_zero": path.from_zero,
                    "breakpoints": path.breakpoints.iter().map(|at| json!({
                        "factor": at.value, "changes": at.changes, "sentence": at.sentence,
                        "at_constant_load": at.jump,
                    })).collect::<Vec<_>>(),
                    "limit": path.limit(),
                    "last": path.factors.last(),
                    "end": record.end,
                })
            },
            |out, style| {
                view::path::write_load(out, &path, &units, style)?;
                view::quantities::write_along(out, &record, &along, &units, style)
            },
        )?;
        self.path = Some(Arc::new(record));
        Ok(())
    }

    /// `limit LOAD`.
    pub(in crate::session) fn limit(&mut self, name: &str, io: &mut Output<'_>) -> Result<(), CommandError> {
        let ground = self.ground(io.watch)?;
        let cases = Self::case_names(&ground.prepared);
        let what = name.to_owned();
        let found = worker::run(io.watch, move |watch| limit::limit(ground.case(watch), Some(&ground.solved), &what))??;
        let unit = self.now.scenario.parameters.get(name).and_then(|parameter| parameter.unit.clone());
        io.report(
            || {
                json!({
                    "load": name,
                    "limit": found.factor,
                    "present": found.present,
                    "safety": found.safety,
                    "collapse": found.collapse,
                    "confirmed": found.confirmed,
                    "answer_beyond": found.beyond,
                    "end": found.end_sentence(),
                })
            },
            |out, style| view::path::write_limit(out, &found, unit.as_deref(), style),
        )?;
        let record = PathRecord::of_load(&found.path, &cases);
        // A single place draws no picture: a path that does is kept.
        if record.places.len() > 1 || self.path.is_none() {
            self.path = Some(Arc::new(record));
        }
        Ok(())
    }

    /// `sensitivity [PARAMETER]`.
    pub(in crate::session) fn sensitivity(
        &mut self,
        parameter: Option<&str>,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        if let Some(name) = parameter
            && !self.now.values.contains_key(name)
        {
            return Err(crate::session::language::setting::unknown_parameter(name, &self.now.scenario).into());
        }
        if let Some(name) = parameter
            && let Some(refusal) =
                self.now.scenario.refusal(name, 0.0).or_else(|| fixed_place(&self.now.scenario, name))
        {
            return Err(no_derivatives(name, &refusal));
        }
        let ground = self.ground(io.watch)?;
        let found = sensitivity(ground.case(io.watch), &ground.solved)?;
        if let Some(name) = parameter
            && !found.parameters.iter().any(|rate| rate.parameter == name)
        {
            let place = place_beside_laws(&self.now.scenario, name).unwrap_or_default();
            return Err(no_derivatives(name, &format!("the loads are no linear function of it: {place}")));
        }
        io.report(|| json!(found), |out, style| view::sensitivity::write(out, &found, parameter, style))?;
        Ok(())
    }

    /// The quantities of `--columns`.
    fn columns(&self, text: Option<&str>) -> Result<Vec<Quantity>, CommandError> {
        let found = text.map_or(Ok(Vec::new()), |text| quantity::read_text(text, &self.names()));
        found.map_err(|error| CommandError::Refused(format!("sweep: {error}")))
    }

    /// What quantities are read from at a place of a path.
    ///
    /// # Errors
    /// Values under which there is no model.
    pub(in crate::session) fn with_place<T>(
        &self,
        prepared: &Prepared,
        path: &PathRecord,
        place: &PathPlace,
        watch: &dyn Watch,
        read: impl FnOnce(&Facts<'_>) -> T,
    ) -> Result<T, NoValue> {
        let mut values = self.now.values.clone();
        if path.followed != Followed::Stages && values.contains_key(&path.name) {
            values.insert(path.name.clone(), place.value);
        }
        // Where the parameter stands in the loads themselves, each place has load vectors of its own.
        let renewed =
            prepared.renewed(&self.now.scenario, &values, watch).map_err(|error| NoValue(error.to_string()))?;
        let prepared = renewed.as_ref().map_or(prepared, |(there, _)| there);
        let factors = if place.factors.is_empty() { factors(prepared, &values) } else { place.factors.clone() };
        let case = prepared.case(&self.now.scenario, &values).watched(watch);
        Ok(read(&Facts::of_state(case, factors, &place.pairs)))
    }

    /// The values of a quantity at the places of a path; `None` where it has none.
    fn along(
        &self,
        prepared: &Prepared,
        path: &PathRecord,
        quantity: &Quantity,
        watch: &dyn Watch,
    ) -> Vec<Option<f64>> {
        let number = |facts: &Facts<'_>| facts.value(quantity).ok()?.number();
        path.places.iter().map(|place| self.with_place(prepared, path, place, watch, number).ok().flatten()).collect()
    }

    /// The table of `trace … of`: as JSON and as rows.
    fn report_along(
        &self,
        prepared: &Prepared,
        path: &PathRecord,
        quantities: &[Quantity],
        watch: &dyn Watch,
    ) -> Result<Vec<OnPath>, CommandError> {
        let all = quantities.iter().map(|quantity| (quantity.clone(), self.along(prepared, path, quantity, watch)));
        let all: Vec<_> = all.collect();
        match all.iter().find(|(_, values)| values.iter().all(Option::is_none)) {
            Some((quantity, _)) => Err(CommandError::Refused(format!("{quantity} has no value on this path"))),
            None => Ok(all),
        }
    }

    /// `sweep P A..B [N] … [--out FILE [--resume]] [--shard K/N]`.
    pub(in crate::session) fn sweep(
        &mut self,
        words: &[String],
        out: Option<&Path>,
        resume: bool,
        shard: Option<Shard>,
        columns: Option<&str>,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let axes = axes(words)?;
        let grid = Grid::new(&self.now.scenario, axes)?;
        let quantities = self.columns(columns)?;
        let ground = self.ground(io.watch)?;
        let sweep = Sweep {
            case: ground.case(io.watch),
            grid: &grid,
            shard: shard.unwrap_or(Shard::WHOLE),
            format: match out {
                Some(path) => format_of(path)?,
                None => Format::Json,
            },
            quantities: &quantities,
        };
        if let Some(path) = out {
            let done = run_to_file(&sweep, path, resume, io.watch)?;
            return Ok(io.say(&done_sentence(&done, path))?);
        }
        let points = sweep.shard.points(grid.len()).len();
        if points > ROWS {
            return Err(CommandError::Refused(format!(
                "{points} rows are too many to show: `--out FILE` writes them to a file"
            )));
        }
        let mut text = Vec::new();
        let done = sweep.run(0, &mut text, io.watch)?;
        let columns = sweep.columns();
        let rows: Vec<Vec<Value>> = text
            .split(|byte| *byte == b'\n')
            .filter(|line| !line.is_empty())
            .map(|line| {
                let row: serde_json::Map<String, Value> = serde_json::from_slice(line).unwrap_or_default();
                columns.iter().map(|name| row.get(name).cloned().unwrap_or_default()).collect()
            })
            .collect();
        let table = Arc::new(Table { columns: columns.clone(), rows: rows.clone() });
        io.report(
            || json!({"columns": columns, "rows": rows, "complete": done.is_complete()}),
            |out, style| {
                view::sweep::write(out, &columns, &rows, grid.axes.len(), style)?;
                if !done.is_complete() {
                    writeln!(out, "stopped after {} of {} points", done.written, done.total)?;
                }
                Ok(())
            },
        )?;
        self.swept = Some(table);
        Ok(())
    }

    /// `plot path [QUANTITY] [PAIRS] [over CASE]`, `plot path QUANTITY [over CASE]`.
    pub(in crate::session) fn plot_path(
        &self,
        of: &[String],
        height: usize,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let (chart, along) = self.path_chart(of, io.watch)?;
        let path = self.need_path()?;
        let report = || along.map_or_else(|| json!(path), |along| along_json(path, &along));
        io.report(report, |out, style| Chart { height, ..chart }.write(out, style))?;
        Ok(())
    }

    /// The chart of what was followed last; the quantities in it, where it is not of the numbers of pairs.
    pub(in crate::session) fn path_chart(
        &self,
        of: &[String],
        watch: &dyn Watch,
    ) -> Result<(Chart, Option<Vec<OnPath>>), CommandError> {
        let path = self.need_path()?;
        let units = &self.now.scenario.units;
        let (of, over) = match of {
            [of @ .., word, name] if word == "over" => (of, Some(abscissa(path, name)?)),
            of => (of, None),
        };
        let (quantity, names) = match of.split_first() {
            Some((word, rest)) if word == "slip" => (Zone::Slip, rest),
            Some((word, rest)) if word == "force" => (Zone::Force, rest),
            Some((word, rest)) if word == "gap" => (Zone::Gap, rest),
            Some((word, rest)) if word == "pressure" => (Zone::Pressure, rest),
            Some((word, _)) if !path.places.iter().any(|place| place.pairs.iter().any(|pair| pair.id == *word)) => {
                let quantities = self.quantities(of)?;
                let Some(prepared) = &self.now.prepared else {
                    return Err(CommandError::Refused("not solved yet: `solve`, or `set auto on`".into()));
                };
                let along = self.report_along(prepared, path, &quantities, watch)?;
                return Ok((view::plot::path::drawing_along(path, &along, over, units), Some(along)));
            }
            _ => (Zone::Slip, of),
        };
        let ids: Vec<&str> = path
            .places
            .first()
            .map(|place| place.pairs.iter().map(|pair| pair.id.as_str()).collect())
            .unwrap_or_default();
        let mut pairs = Vec::new();
        for name in names {
            let pair = ids.iter().position(|id| id == name).ok_or_else(|| {
                CommandError::Refused(format!("plot: no pair {name}{}", did_you_mean(name, ids.iter().copied())))
            })?;
            pairs.push(pair);
        }
        if pairs.is_empty() {
            pairs = busiest(path, &ids);
        }
        Ok((view::plot::path::drawing(path, quantity, &pairs, over, units), None))
    }

    pub(in crate::session) fn need_path(&self) -> Result<&PathRecord, CommandError> {
        self.path.as_deref().ok_or_else(|| {
            CommandError::Refused(
                "no path was followed yet: `trace CASE`, `trace FRICTION`, `limit CASE` or `stages`".into(),
            )
        })
    }
}

/// A sweep as the shell asks for it.
pub struct SweepRequest<'a> {
    /// `NAME=FROM:TO:STEP`, `NAME=FROM..TO/COUNT` or `NAME=VALUE`, up to three.
    pub axes: &'a [String],
    /// Part of it.
    pub shard: Option<Shard>,
    /// CSV or JSON lines; otherwise by the ending of `out`, or CSV.
    pub format: Option<Format>,
    /// File; otherwise the stream.
    pub out: Option<&'a Path>,
    /// Continue the file.
    pub resume: bool,
    /// Quantities with columns of their own, separated by commas.
    pub columns: Option<&'a str>,
}

impl Session {
    /// Sweeps over the present values into a file, or else into `stream`.
    ///
    /// # Errors
    /// A grid that cannot be, a file that cannot be written or belongs to another sweep.
    pub fn sweep_into(
        &self,
        request: &SweepRequest<'_>,
        stream: &mut dyn Write,
        watch: &dyn Watch,
    ) -> Result<Done, CommandError> {
        let axes = request.axes.iter().map(|axis| Axis::parse(axis)).collect::<Result<_, _>>()?;
        let grid = Grid::new(&self.now.scenario, axes)?;
        let mut setup = self.now.clone();
        if setup.prepared.is_none() {
            setup.solve(watch)?;
        }
        let prepared = setup
            .prepared
            .ok_or_else(|| CommandError::Internal("a solved scenario has no prepared geometry".to_owned()))?;
        let quantities = self.columns(request.columns)?;
        let sweep = Sweep {
            case: self.now.case(&prepared, watch),
            grid: &grid,
            shard: request.shard.unwrap_or(Shard::WHOLE),
            format: match (request.format, request.out) {
                (Some(format), _) => format,
                (None, Some(path)) => format_of(path)?,
                (None, None) => Format::Csv,
            },
            quantities: &quantities,
        };
        match request.out {
            Some(path) => Ok(run_to_file(&sweep, path, request.resume, watch)?),
            None => {
                stream.write_all(sweep.preamble().as_bytes())?;
                Ok(sweep.run(0, stream, watch)?)
            }
        }
    }
}

/// Joins the shards of a sweep into `out`, or into the file `to`; the number of rows.
///
/// # Errors
/// Shards that do not make a whole; a place that cannot be written.
pub fn merge(
    files: &[PathBuf],
    to: Option<&Path>,
    out: &mut dyn Write,
    watch: &dyn Watch,
) -> Result<usize, CommandError> {
    let listed = files.to_vec();
    let shards = worker::run(watch, move |watch| Shards::open(&listed, watch))??;
    let Some(path) = to else {
        let mut buffer = std::io::BufWriter::new(out);
        shards.write(&mut buffer, watch)?;
        return Ok(shards.rows());
    };
    let mut result = Ok(());
    let written = atomic::write(path, |file| {
        result = shards.write(file, watch);
        match &result {
            Ok(()) => Ok(()),
            Err(error) => Err(std::io::Error::other(error.to_string())),
        }
    });
    result?;
    written.map_err(|error| CommandError::Refused(error.to_string()))?;
    Ok(shards.rows())
}

/// The values of quantities on a path.
fn along_json(path: &PathRecord, along: &[OnPath]) -> Value {
    json!({
        "values": path.abscissas(None),
        "quantities": along.iter().map(|(quantity, values)| json!({
            "quantity": quantity.to_string(), "values": values,
        })).collect::<Vec<_>>(),
    })
}

fn no_derivatives(name: &str, why: &str) -> CommandError {
    CommandError::Refused(format!("no derivatives with respect to {name}: {why}"))
}

/// The load case whose factor a plot of a history goes over.
fn abscissa(path: &PathRecord, name: &str) -> Result<usize, CommandError> {
    let refusal = match path.followed {
        Followed::Stages => match path.cases.iter().position(|case| case == name) {
            Some(case) => return Ok(case),
            None => no_such("load case", name, path.cases.iter().map(String::as_str)),
        },
        _ => format!("plot: `over` chooses a load case of a history; this path goes over {}", path.name),
    };
    Err(CommandError::Refused(refusal))
}

/// The pairs that slip most on a path, at most four: what a plot shows if none is named.
fn busiest(path: &PathRecord, ids: &[&str]) -> Vec<usize> {
    let most = |pair: usize| {
        view::number::largest(path.places.iter().filter_map(|place| place.pairs.get(pair).map(|pair| pair.z_t)))
    };
    let mut pairs: Vec<usize> = (0..ids.len()).collect();
    pairs.sort_by(|&a, &b| most(b).total_cmp(&most(a)).then(a.cmp(&b)));
    pairs.truncate(4);
    pairs
}

/// CSV or JSON by the ending of a file.
///
/// # Errors
/// Another ending.
pub fn format_of(path: &Path) -> Result<Format, CommandError> {
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("csv") => Ok(Format::Csv),
        Some("json" | "jsonl") => Ok(Format::Json),
        _ => Err(CommandError::Refused(format!("{} must end in .csv or .json", path.display()))),
    }
}

/// What a sweep into a file did.
pub fn done_sentence(done: &Done, path: &Path) -> String {
    let found = match done.found {
        0 => String::new(),
        found => format!(", {found} were there already"),
    };
    let rest = if done.is_complete() {
        "complete".to_owned()
    } else {
        let left = done.total - done.found - done.written;
        format!("stopped, {left} are left: the same command with --resume goes on")
    };
    format!("{} rows written to {}{found}; {rest}", done.written, path.display())
}

/// Reads `P A..B [N]` up to three times.
fn axes(words: &[String]) -> Result<Vec<Axis>, CommandError> {
    let form =
        || CommandError::Refused("sweep: expected PARAMETER A..B [N], e.g. `sweep f 0..1 21 F2 0..400`".to_owned());
    let mut axes = Vec::new();
    let mut rest = words;
    while let Some((name, after)) = rest.split_first() {
        let (range, after) = after.split_first().ok_or_else(form)?;
        let (from, to) = range.trim_start().split_once("..").ok_or_else(form)?;
        let number = |word: &str| {
            word.parse::<f64>()
                .ok()
                .filter(|value| value.is_finite())
                .ok_or_else(|| CommandError::Refused(format!("sweep: `{word}` is no number")))
        };
        let (count, after) = match after.split_first() {
            Some((word, after)) if word.parse::<f64>().is_ok() => {
                let count = word
                    .parse::<usize>()
                    .map_err(|_| CommandError::Refused(format!("sweep: `{word}` is no number of points")))?;
                (count, after)
            }
            _ => (POINTS, after),
        };
        axes.push(Axis::counted(name, number(from)?, number(to)?, count)?);
        rest = after;
    }
    Ok(axes)
}
