//! Tables as CSV and JSON. Those that a command shows are made from its report.

use std::io::{self, Write};
use std::path::Path;

use serde_json::{Map, Value, json};

use super::exported::Exported;
use crate::answer::record::Answer;
use crate::answer::stress::StressPlace;
use crate::export::table::{Table, unfolded};
use crate::export::{atomic, csv, json as json_export, path as path_export};
use crate::session::commands::load::scenarios;
use crate::session::commands::stages::history_json;
use crate::session::{CommandError, Format, Output, Session};

impl Session {
    /// A table to a file.
    pub(super) fn export_table(
        &mut self,
        what: Exported,
        of: &[String],
        path: &Path,
        csv: bool,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let written = match what {
            Exported::Pairs | Exported::Pivots | Exported::Displacements | Exported::Members | Exported::Reactions
                if csv && !self.is_solution(what) =>
            {
                let shown = self.shown(what)?;
                atomic::write(path, |out| records_csv(what, &shown, out))
            }
            Exported::Path if csv && of.is_empty() => {
                let record = self.need_path()?;
                atomic::write(path, |out| path_export::csv(out, record))
            }
            _ => {
                let value = self.table_json(what, of, io)?;
                if csv {
                    let table = self.table(what, &value);
                    atomic::write(path, |out| table.csv(out))
                } else {
                    let text = json_export::pretty(&json_export::without_signed_zeros(value))?;
                    atomic::write(path, |out| writeln!(out, "{text}"))
                }
            }
        };
        written.map_err(|error| CommandError::Refused(error.to_string()))
    }

    /// The answer that the tables mean: at the pivot shown, or at the end of the history.
    fn shown(&self, what: Exported) -> Result<Answer, CommandError> {
        if what == Exported::Pivots {
            return Ok(self.need_answer()?.clone());
        }
        let answer = self.need_quantities()?;
        let mut shown = answer.clone();
        shown.pairs = self.quantity_pairs();
        shown.displacements = self.quantity_displacements();
        let missing = match what {
            Exported::Displacements if shown.displacements.is_none() => "displacements",
            Exported::Members if shown.members.is_none() => "member forces",
            Exported::Reactions if shown.reactions.is_none() => "reactions",
            _ => return Ok(shown),
        };
        Err(self.none(missing, answer))
    }

    /// Whether the pairs are z and w of a bare LCP.
    fn is_solution(&self, what: Exported) -> bool {
        what == Exported::Pairs && self.solution().is_some()
    }

    fn table_json(&mut self, what: Exported, of: &[String], io: &mut Output<'_>) -> Result<Value, CommandError> {
        let one = |command: &str, expected: &str| match of {
            [word] => Ok(word.clone()),
            _ => Err(CommandError::Refused(format!("export {command}: {expected}, as `{command}` takes it?"))),
        };
        Ok(match what {
            Exported::Pairs if self.is_solution(what) => self.solution_rows(),
            Exported::Pairs => json_export::pairs(&self.shown(what)?),
            Exported::Pivots => json_export::pivots(&self.shown(what)?),
            Exported::Displacements => json_export::displacements(&self.shown(what)?),
            Exported::Members => json_export::members(&self.shown(what)?),
            Exported::Reactions => json_export::reactions(&self.shown(what)?),
            Exported::Path if of.is_empty() => json!(self.need_path()?),
            Exported::Path => self.path_rows(of, io.watch)?,
            Exported::Map => self.map_json(&self.need_map()?),
            Exported::Sample => self.sample_rows()?,
            Exported::Result => {
                self.need_quantities()?;
                self.result(false).unwrap_or_default()
            }
            Exported::Stresses => Value::Array(self.stresses(io)?),
            Exported::Resultants => self.resultants_json(io)?,
            Exported::Stages => self.stages_json()?,
            Exported::Sweep => {
                let table = self.swept.as_ref().ok_or_else(|| {
                    CommandError::Refused("no sweep was shown yet: `sweep PARAMETER A..B`".to_owned())
                })?;
                let record = |row: &Vec<Value>| table.columns.iter().cloned().zip(row.iter().cloned()).collect();
                table.rows.iter().map(record).map(Value::Object).collect()
            }
            Exported::Quantities if of.is_empty() => {
                return Err(CommandError::Refused("export: of which quantities? `help show` lists them".to_owned()));
            }
            Exported::Quantities | Exported::Probes => report(io, |io| self.show(of, io))?,
            Exported::Ties => report(io, |io| self.report_ties(io))?,
            Exported::Tableau => report(io, |io| self.report_tableau(io))?,
            Exported::Diff => report(io, |io| self.report_difference(io))?,
            Exported::Check => match of.first().map(String::as_str) {
                None => report(io, |io| self.report_check(io))?,
                Some("exact") => report(io, |io| self.check_exactly(io))?,
                Some(word) => {
                    let refusal = format!("export check: `{word}` makes no sense here: only `exact` may follow");
                    return Err(CommandError::Refused(refusal));
                }
            },
            Exported::Ray => report(io, |io| self.report_ray(io))?,
            Exported::Remedies => {
                let mut ray = report(io, |io| self.report_ray(io))?;
                match ray["remedies"].take() {
                    Value::Null => {
                        let refusal = "no remedies: nothing is known that would stop this ray";
                        return Err(CommandError::Refused(refusal.to_owned()));
                    }
                    found => found,
                }
            }
            Exported::Critical => {
                let friction = one("critical", "of which friction parameter")?;
                report(io, |io| self.critical(&friction, io))?
            }
            Exported::Find if of.is_empty() => {
                let refusal = "export find: what? the words that `find` takes stand before the file";
                return Err(CommandError::Refused(refusal.to_owned()));
            }
            Exported::Find => report(io, |io| self.find(of, io))?,
            Exported::Cycle => report(io, |io| self.cycle(of, io))?,
            Exported::Calibrate => report(io, |io| self.calibrate(of, io))?,
            Exported::Limit => {
                let load = one("limit", "of which load")?;
                report(io, |io| self.limit(&load, io))?
            }
            Exported::Scenarios => report(io, scenarios)?,
            Exported::Parameters => report(io, |io| self.report_parameters(io))?,
            Exported::Combinations => report(io, |io| self.combine(None, io))?,
            Exported::Envelope => report(io, |io| self.envelope(of, io))?,
            Exported::Answers => report(io, |io| self.enumerate(None, io))?,
            Exported::Compare => report(io, |io| self.compare(io))?,
            Exported::Sensitivity => report(io, |io| self.sensitivity(of.first().map(String::as_str), io))?,
            Exported::Summary => report(io, |io| self.summary(io))?,
            // the others have formats of their own
            _ => Value::Null,
        })
    }

    /// The rows of what [`Session::table_json`] gave.
    fn table(&self, what: Exported, value: &Value) -> Table {
        let list = |key: &str| value[key].as_array().cloned().unwrap_or_default();
        let without = |mut records: Vec<Value>, keys: &[&str]| {
            for record in &mut records {
                if let Value::Object(record) = record {
                    record.retain(|key, _| !keys.contains(&key.as_str()));
                }
            }
            records
        };
        match what {
            Exported::Sweep => self.swept.as_deref().cloned().unwrap_or_default(),
            Exported::Combinations => Table::of(&without(list("combinations"), &["pairs"])),
            Exported::Envelope => Table::of(&list("envelope")),
            Exported::Calibrate => Table::of(&list("measurements")),
            Exported::Cycle if value.get("starts").is_some() => Table::of(&unfolded(&list("starts"), "slips")),
            Exported::Cycle => {
                let numbered = list("cycles").into_iter().enumerate().map(|(index, cycle)| {
                    json!({"cycle": index + 1, "difference": cycle["difference"], "pairs": cycle["pairs"]})
                });
                Table::of(&unfolded(&numbered.collect::<Vec<_>>(), "pairs"))
            }
            Exported::Compare => Table::of(&list("rows")),
            Exported::Sensitivity => Table::of(&unfolded(&list("parameters"), "pairs")),
            Exported::Ties => Table::of(&[list("ties"), list("degenerate")].concat()),
            Exported::Tableau => dictionary(value),
            Exported::Ray => Table::of(&list("direction")),
            Exported::Map => {
                let axes = list("axes");
                let mut regions = without(list("regions"), &["outlines"]);
                for region in &mut regions {
                    let at = region["at"].as_array().cloned().unwrap_or_default();
                    let named =
                        axes.iter().zip(at).filter_map(|(axis, x)| Some((axis["parameter"].as_str()?.to_owned(), x)));
                    region["at"] = named.collect::<Map<String, Value>>().into();
                }
                Table::of(&regions)
            }
            Exported::Limit => {
                let mut row = vec![value.clone()];
                if let Value::Object(collapse) = &mut row[0]["collapse"] {
                    collapse.remove("direction");
                }
                Table::of(&row)
            }
            Exported::Find if value.get("places").is_some() => {
                let holds = list("holds").into_iter().map(|ends| json!({"from": ends[0], "to": ends[1]}));
                Table::of(&holds.chain(list("places")).collect::<Vec<_>>())
            }
            Exported::Check | Exported::Critical | Exported::Find => Table::of(std::slice::from_ref(value)),
            Exported::Stages => {
                let stages = list("stages").into_iter().map(stage_row).collect();
                Table::of(&without(stages, &["pairs"]))
            }
            Exported::Answers => {
                let numbered = list("answers").into_iter().enumerate().map(
                    |(index, answer)| json!({"answer": index + 1, "exact": answer["exact"], "pairs": answer["pairs"]}),
                );
                Table::of(&unfolded(&numbered.collect::<Vec<_>>(), "pairs"))
            }
            _ => Table::of(value.as_array().map_or(&[], Vec::as_slice)),
        }
    }

    /// Rows with their names, z and w.
    fn solution_rows(&self) -> Value {
        let Some(solution) = self.solution() else { return Value::Null };
        let names = self.solution_names(&solution);
        let rows = names.iter().zip(solution.z.iter().zip(&solution.w));
        rows.map(|(name, (z, w))| json!({"row": name, "z": z, "w": w})).collect()
    }

    fn stresses(&self, io: &Output<'_>) -> Result<Vec<Value>, CommandError> {
        let answer = self.need_quantities()?;
        if answer.displacements.is_none() {
            return Err(self.none("stresses", answer));
        }
        let all = self.with_facts(io.watch, |facts| facts.stresses());
        let at_nodes = all.iter().filter(|stress| matches!(stress.place, StressPlace::Node(_)));
        let rows: Vec<Value> = at_nodes.map(|stress| json!(stress)).collect();
        if rows.is_empty() {
            return Err(CommandError::Refused(
                "no stresses: the structure has no plates, quads, triangles or solids".to_owned(),
            ));
        }
        Ok(rows)
    }

    fn resultants_json(&self, io: &Output<'_>) -> Result<Value, CommandError> {
        let answer = self.need_quantities()?;
        if answer.displacements.is_none() {
            return Err(self.none("resultants", answer));
        }
        let all = self.with_facts(io.watch, |facts| self.resultants(facts));
        if all.is_empty() {
            return Err(CommandError::Refused("no resultants: the scenario has no edge contacts".to_owned()));
        }
        Ok(json!(all))
    }

    /// The stages followed, each with its number and the factors by the names of their cases.
    fn stages_json(&self) -> Result<Value, CommandError> {
        let Some(history) = &self.followed else {
            return Err(CommandError::Refused("no history was followed: `stages` first".to_owned()));
        };
        let mut report = history_json(history);
        for (index, stage) in report["stages"].as_array_mut().into_iter().flatten().enumerate() {
            let Value::Object(fields) = stage.take() else { continue };
            let mut numbered = Map::new();
            numbered.insert("stage".to_owned(), (index + 1).into());
            numbered.extend(fields);
            let factors = numbered.get("factors").and_then(Value::as_array).cloned().unwrap_or_default();
            let named: Map<String, Value> = history.cases.iter().cloned().zip(factors).collect();
            numbered.insert("factors".to_owned(), named.into());
            *stage = numbered.into();
        }
        Ok(report)
    }
}

/// A stage with what its table shows: how often pairs change, and the slip of each pair in a column of its own.
fn stage_row(mut stage: Value) -> Value {
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    stage["changes"] = list(&stage["changes"]).len().into();
    let ids = list(&stage["pairs"]).into_iter().filter_map(|pair| Some(pair["id"].as_str()?.to_owned()));
    stage["slip_increment"] = ids.zip(list(&stage["slip_increment"])).collect::<Map<_, _>>().into();
    stage
}

/// A dictionary: what is basic, its value, and its rate in each variable that is not.
fn dictionary(value: &Value) -> Table {
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let names = list(&value["nonbasic"]).into_iter().filter_map(|name| Some(name.as_str()?.to_owned()));
    let columns = ["basic".to_owned(), "value".to_owned()].into_iter().chain(names).collect();
    let row = |((basic, value), rates): ((Value, Value), Value)| [vec![basic, value], list(&rates)].concat();
    let basic = list(&value["basic"]).into_iter().zip(list(&value["values"]));
    Table { columns, rows: basic.zip(list(&value["rates"])).map(row).collect() }
}

/// The report of a command.
pub(super) fn report(
    io: &Output<'_>,
    command: impl FnOnce(&mut Output<'_>) -> Result<(), CommandError>,
) -> Result<Value, CommandError> {
    let mut nowhere = io::sink();
    let mut inner = Output::new(&mut nowhere, io.style, Format::Values, io.watch);
    command(&mut inner)?;
    Ok(inner.report.take().unwrap_or_default())
}

fn records_csv(what: Exported, shown: &Answer, out: &mut dyn Write) -> io::Result<()> {
    match what {
        Exported::Pairs => csv::pairs(out, shown),
        Exported::Pivots => csv::pivots(out, shown),
        Exported::Displacements => csv::displacements(out, shown),
        Exported::Members => csv::members(out, shown),
        _ => csv::reactions(out, shown),
    }
}
