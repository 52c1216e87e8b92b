//! `export report`: the scenario, its answer, tables and figures in one file.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{SystemTime, UNIX_EPOCH};

use serde_json::Value;

use super::exported::Exported;
use crate::answer::record::{Answer, EndForces, MemberForces};
use crate::export::atomic;
use crate::model::scenario::Source;
use crate::model::units::Units;
use crate::path::stages::{self, History};
use crate::session::{CommandError, Output, Session, worker};
use crate::solve::problem::factors;
use crate::text::number::short;
use crate::view;
use crate::view::combinations::envelope_table;
use crate::view::report::{Block, Report};
use crate::view::status;
use crate::view::style::Style;
use crate::view::table::{Cell, Column, Row, Table};
use crate::watch::Watch;

use super::tables::report as report_of;

impl Session {
    /// `export report [date] FILE.html|FILE.md`; figures of Markdown stand in files of their own beside it.
    pub(super) fn export_report(
        &mut self,
        of: &[String],
        path: &Path,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let date = match of.first().map(String::as_str) {
            None => String::new(),
            Some("date") => format!(" · {}", date(SystemTime::now())),
            Some(word) => {
                return Err(CommandError::Refused(format!(
                    "export: `{word}` makes no sense here: only `date` may stand between `report` and the file"
                )));
            }
        };
        let report = self.report(io)?;
        let footer = format!("stickslip {}{date}", env!("CARGO_PKG_VERSION"));
        let refused = |error: atomic::WriteError| CommandError::Refused(error.to_string());
        if path.extension().is_some_and(|ending| ending == "html") {
            let text = report.html(&footer);
            return atomic::write(path, |out| out.write_all(text.as_bytes())).map_err(refused);
        }
        let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let file = |name: &str| format!("{stem}-{}.svg", name.replace(' ', "-"));
        let figures: Vec<(PathBuf, &str)> = report
            .blocks
            .iter()
            .filter_map(|block| match block {
                Block::Figure { name, svg, .. } => Some((path.with_file_name(file(name)), svg.as_str())),
                _ => None,
            })
            .collect();
        for (figure, svg) in figures {
            atomic::write(&figure, |out| out.write_all(svg.as_bytes())).map_err(refused)?;
        }
        let text = report.markdown(&footer, &file);
        atomic::write(path, |out| out.write_all(text.as_bytes())).map_err(refused)
    }

    fn report(&mut self, io: &mut Output<'_>) -> Result<Report, CommandError> {
        let answer = self.need_quantities()?.clone();
        let scenario = Arc::clone(&self.now.scenario);
        let mut report = Report { title: scenario.title.clone(), blocks: Vec::new() };
        let blocks = &mut report.blocks;
        blocks.extend(scenario.description.clone().map(Block::Text));
        blocks.push(Block::Text(format!("Scenario: {}.{}", self.short_name(), in_units(&scenario.units))));
        if !scenario.parameters.is_empty() {
            blocks.push(Block::Heading("Parameters".into()));
            blocks.push(Block::Table(view::parameters::table(&scenario, &self.now.values), ""));
        }
        self.add_data(blocks);
        self.add_outcome(&answer, blocks);
        self.add_safety(io, blocks)?;
        self.add_figures(&answer, io.watch, blocks)?;
        self.add_tables(&answer, io, blocks)?;
        self.add_history(io.watch, blocks)?;
        self.add_combinations(io, blocks)?;
        Ok(report)
    }

    /// What the answer depends on beside the parameters.
    fn add_data(&self, blocks: &mut Vec<Block>) {
        for (heading, table) in view::data::tables(&self.now.scenario, &self.now.values) {
            blocks.push(Block::Heading(heading.into()));
            blocks.push(Block::Table(table, "see the scenario"));
        }
        self.add_factors(blocks);
    }

    /// The load cases with their factors under the combination that is shown, or where the file does not list them.
    fn add_factors(&self, blocks: &mut Vec<Block>) {
        let Some(prepared) = self.prepared_shown() else {
            return;
        };
        let is_superelement = self.structure().is_some_and(|structure| structure.superelement.is_some());
        if prepared.cases.is_empty() || !(self.combination.is_some() || is_superelement) {
            return;
        }
        let mut table = Table::new(vec![Column::words("load case"), Column::given("factor", None)]);
        for ((name, _), factor) in prepared.cases.iter().zip(factors(prepared, &self.now.values)) {
            table.rows.push(Row::new(vec![Cell::from(name.as_str()), Cell::number(factor)]));
        }
        let heading = match &self.combination {
            Some((name, _)) => format!("Factors of combination {name}, whose answer follows"),
            None => "Load factors".to_owned(),
        };
        blocks.push(Block::Heading(heading));
        blocks.push(Block::Table(table, ""));
    }

    /// The limit of each load case.
    fn add_safety(&self, io: &Output<'_>, blocks: &mut Vec<Block>) -> Result<(), CommandError> {
        let safeties = self.with_facts(io.watch, |facts| self.safeties(facts));
        if io.watch.stop() {
            return Err(CommandError::Interrupted);
        }
        if !safeties.is_empty() && self.followed.is_none() && self.combination.is_none() {
            blocks.push(Block::Heading("Safety".into()));
            let about =
                "Each load case grows alone from its factor, the others stay; safety is its limit over its factor.";
            blocks.push(Block::Text(about.into()));
            blocks.push(Block::Table(view::summary::safety_table(&safeties), ""));
        }
        Ok(())
    }

    fn add_outcome(&self, answer: &Answer, blocks: &mut Vec<Block>) {
        let style = Style { width: 1000, ..Style::default() };
        blocks.push(Block::Heading("Answer".into()));
        blocks.push(Block::Text(status::line(answer, None, &self.now.scenario.units, &style)));
        blocks.extend(answer.failure.clone().map(Block::Text));
        if let Some(ray) = &answer.ray {
            let verdict = ray.verdict.map_or(String::new(), |verdict| format!(" ({})", verdict.word()));
            blocks.push(Block::Text(format!("Mode{verdict}: {}", ray.mode)));
            blocks.push(Block::Text(ray.explanation.clone()));
        }
        let rules = format!(
            "Covering {}, tie-break {}, engine {}; {} unknowns of the LCP.",
            answer.rules.covering, answer.rules.tie_break, answer.rules.engine, answer.size.lcp
        );
        blocks.push(Block::Text(rules));
        blocks.extend(answer.notes.iter().cloned().map(Block::Text));
        if answer.is_answer() {
            blocks.push(Block::Heading("Check".into()));
            blocks.push(Block::Table(view::check::table(answer), ""));
            let word = if answer.check.passed { "passed" } else { "failed" };
            blocks.push(Block::Text(format!("The check from R, RF, the laws and K has {word}.")));
        }
    }

    /// Whatever there is to draw.
    fn add_figures(&self, answer: &Answer, watch: &dyn Watch, blocks: &mut Vec<Block>) -> Result<(), CommandError> {
        let pairs = self.quantity_pairs();
        let slips = pairs.iter().any(|pair| pair.z_t != 0.0);
        let rubs = pairs.iter().any(|pair| pair.x_t != 0.0 || pair.bound != 0.0);
        let ends: Vec<EndForces> =
            answer.members.iter().flatten().flat_map(|member| [member.start, member.end]).collect();
        let any = |symbols: &[&str]| {
            ends.iter().flat_map(EndForces::named).any(|(name, force)| symbols.contains(&name) && force != 0.0)
        };
        let structure = self.structure().is_some();
        let wanted = [
            (Exported::Structure, "structure", structure),
            (Exported::Mode, "mode", self.followed.is_none() && self.mode_shape().is_ok()),
            (Exported::Slip, "slip", slips),
            (Exported::Force, "force", rubs),
            (Exported::Pressure, "pressure", !pairs.is_empty()),
            (Exported::Traction, "traction", self.zone_states(&[]).and_then(|states| self.tractions(&states)).is_ok()),
            (Exported::Moment, "moment", any(&["M", "Q", "Mz", "Vy"])),
            (Exported::MomentY, "moment M_y", any(&["My", "Vz"])),
            (Exported::Torsion, "torque", any(&["T"])),
            (Exported::Axial, "axial", any(&["N"])),
            (Exported::Path, "path", self.need_path().is_ok() && self.stale_path().is_none()),
        ];
        if wanted.iter().any(|(.., is_there)| *is_there) {
            blocks.push(Block::Heading("Figures".into()));
        }
        for (what, name, _) in wanted.into_iter().filter(|(.., is_there)| *is_there) {
            let svg = self.figure(what, &[], watch)?;
            blocks.push(Block::Figure { name: name.to_owned(), title: name.to_owned(), svg });
        }
        Ok(())
    }

    fn add_tables(
        &mut self,
        answer: &Answer,
        io: &mut Output<'_>,
        blocks: &mut Vec<Block>,
    ) -> Result<(), CommandError> {
        let scenario = Arc::clone(&self.now.scenario);
        let units = &scenario.units;
        let pairs = self.quantity_pairs();
        if !pairs.is_empty() {
            blocks.push(Block::Heading("Contact pairs".into()));
            blocks.extend(self.place_shown().map(Block::Text));
            blocks.push(Block::Text(status::state_counts(&pairs)));
            blocks.push(Block::Table(view::pairs::table(&pairs, units), "`export pairs FILE.csv` writes all"));
        }
        if let Some(solution) = &answer.solution {
            let mut table =
                Table::new(vec![Column::words("row"), Column::numbers("z", None), Column::numbers("w", None)]);
            for ((z, w), number) in solution.z.iter().zip(&solution.w).zip(1..) {
                let name = match &scenario.source {
                    Source::Lcp(lcp) => lcp.names[number - 1].clone(),
                    _ => number.to_string(),
                };
                table.rows.push(Row::new(vec![Cell::from(name), Cell::number(*z), Cell::number(*w)]));
            }
            blocks.push(Block::Heading("Solution".into()));
            blocks.push(Block::Table(table, "`export result FILE.json` writes all"));
        }
        if !scenario.probes.is_empty() {
            let values = self.with_facts(io.watch, |facts| self.probed(facts));
            blocks.push(Block::Heading("Probes".into()));
            blocks.push(Block::Table(view::summary::probes_table(&values, units, false), ""));
        }
        let resultants = self.with_facts(io.watch, |facts| self.resultants(facts));
        if answer.is_answer() && !resultants.is_empty() {
            blocks.push(Block::Heading("Resultants of the edge contacts".into()));
            blocks.push(Block::Table(view::summary::resultants_table(&resultants, units), ""));
        }
        if let Some(reactions) = answer.reactions.as_ref().filter(|reactions| !reactions.is_empty()) {
            blocks.push(Block::Heading("Reactions".into()));
            let table = view::reactions::table(reactions, units);
            blocks.push(Block::Table(table, "`export reactions FILE.csv` writes all"));
        }
        if let Some(members) = answer.members.as_ref().filter(|members| !members.is_empty()) {
            let chosen: Vec<&MemberForces> = members.iter().collect();
            blocks.push(Block::Heading("Member forces".into()));
            blocks.push(Block::Table(view::members::table(&chosen, units), "`export members FILE.csv` writes all"));
        }
        if let Some(displacements) = self.quantity_displacements().filter(|displacements| !displacements.is_empty()) {
            blocks.push(Block::Heading("Displacements".into()));
            let table = view::displacements::table(&displacements, units);
            blocks.push(Block::Table(table, "`export displacements FILE.csv` writes all"));
        }
        Ok(())
    }

    /// The stages of the scenario, followed for the report where they were not; the session stays as it is.
    fn add_history(&self, watch: &dyn Watch, blocks: &mut Vec<Block>) -> Result<(), CommandError> {
        if self.now.scenario.stages.is_empty() {
            return Ok(());
        }
        let history: Arc<History> = match &self.followed {
            Some(history) => Arc::clone(history),
            None => {
                let ground = self.ground(watch)?;
                Arc::new(worker::run(watch, move |watch| stages::follow(ground.case(watch)))??)
            }
        };
        blocks.push(Block::Heading("Load history".into()));
        blocks.push(Block::Table(view::stages::table(&history, &self.now.scenario.units), "`export stages FILE.csv`"));
        blocks.push(Block::Text(history.end_sentence()));
        Ok(())
    }

    fn add_combinations(&mut self, io: &mut Output<'_>, blocks: &mut Vec<Block>) -> Result<(), CommandError> {
        if self.now.scenario.combinations.is_empty() {
            return Ok(());
        }
        let combined = report_of(io, |io| self.combine(None, io))?;
        let word = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let mut table =
            Table::new(vec![Column::words("combination"), Column::words("factors"), Column::words("outcome")]);
        for one in combined["combinations"].as_array().into_iter().flatten() {
            let factors = one["factors"].as_object().into_iter().flatten();
            let factors: Vec<String> = factors
                .map(|(case, factor)| format!("{case} {}", short(factor.as_f64().unwrap_or_default())))
                .collect();
            let outcome = match one["ray"].as_str() {
                Some(class) => format!("ray: {class}"),
                None => word(&one["outcome"]),
            };
            table.rows.push(Row::new([word(&one["name"]), factors.join(", "), outcome].map(Cell::from).into()));
        }
        blocks.push(Block::Heading("Load combinations".into()));
        blocks.push(Block::Table(table, "`export combinations FILE.csv` writes all"));
        let probes = self.all_probes().unwrap_or_default();
        let numbers: Vec<_> = probes.into_iter().filter(|quantity| !quantity.is_word()).collect();
        if !numbers.is_empty() {
            match self.extremes(numbers, io) {
                Ok((extremes, _)) => {
                    let table = envelope_table("in", &extremes, &self.now.scenario.units, false);
                    blocks.push(Block::Table(table, "`export envelope FILE.csv` writes all"));
                }
                Err(error) if error.is_interrupted() => return Err(error),
                Err(error) => blocks.push(Block::Text(format!("No envelope: {error}"))),
            }
        }
        Ok(())
    }
}

/// The units of all numbers, as a sentence.
fn in_units(units: &Units) -> String {
    let named: Vec<&str> = [&units.force, &units.length].into_iter().flatten().map(String::as_str).collect();
    if named.is_empty() { String::new() } else { format!(" Units: {}.", named.join(", ")) }
}

/// `2026-11-26`, in UTC (civil from days, after Howard Hinnant).
fn date(now: SystemTime) -> String {
    let days = now.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs() / 86_400) as i64 + 719_468;
    let era = days.div_euclid(146_097);
    let of_era = days.rem_euclid(146_097);
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    let year = year_of_era + era * 400 + i64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn days_have_dates() {
        // seconds as `date -u -d … +%s` gives them
        for (seconds, expected) in [(0, "1970-01-01"), (951_782_400, "2000-02-29"), (1_795_737_600, "2026-11-27")] {
            assert_eq!(date(UNIX_EPOCH + Duration::from_secs(seconds)), expected);
        }
    }
}
