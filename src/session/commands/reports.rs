//! Commands that show something and change nothing.

use std::collections::HashMap;
use std::io::{self, Write};

use serde_json::{Value, json};

use crate::answer::diagram::{Diagram, Internal};
use crate::answer::record::{Answer, MemberForces, NodeDisplacement, PairState, PlainSolution, Reaction};
use crate::export::json as json_export;
use crate::model::scenario::Source;
use crate::view;
use crate::view::number::{short, with_unit};
use crate::view::style::{Role, Style};

use crate::session::language::selection::{DISPLACEMENT_KEYS, MEMBER_KEYS, Rows, SORT_KEYS, no_pair, sort};
use crate::session::{CommandError, Output, Session};

impl Session {
    /// The present answer.
    ///
    /// # Errors
    /// There is none because `auto` is off.
    pub(in crate::session) fn need_answer(&self) -> Result<&Answer, CommandError> {
        self.answer().ok_or_else(|| CommandError::Refused("not solved yet: `solve`, or `set auto on`".into()))
    }

    /// Outcome, pivots, parameters and rules.
    pub(in crate::session) fn status_json(&self) -> Value {
        let values = json!(self.now.values);
        match self.answer() {
            None => json!({"outcome": null, "parameters": values}),
            Some(answer) => {
                let mut report = json!({
                    "outcome": answer.outcome,
                    "marginal": answer.marginal,
                    "ray": answer.ray.as_ref().map(|ray| json!(ray.class)),
                    "p": answer.p,
                    "pivots": answer.pivot_count,
                    "parameters": values,
                    "covering": answer.rules.covering,
                    "tie_break": answer.rules.tie_break,
                    "engine": answer.rules.engine,
                });
                if let (Some(failure), Value::Object(map)) = (&answer.failure, &mut report) {
                    map.insert("failure".into(), json!(failure));
                }
                report
            }
        }
    }

    pub(in crate::session) fn report_status(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let answer = self.need_answer()?;
        io.report(
            || self.status_json(),
            |out, style| {
                view::status::write(out, answer, &self.now.scenario, &self.now.values, style)?;
                view::loose::write(out, &self.loose(), style)?;
                if !self.auto {
                    writeln!(out, "auto is off: changes wait for `solve`")?;
                }
                match self.position {
                    Some(step) => {
                        writeln!(out, "shown at {}: `step last` for the end", view::pivots::title(step))
                    }
                    None => Ok(()),
                }
            },
        )?;
        Ok(())
    }

    pub(in crate::session) fn report_parameters(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let scenario = &self.now.scenario;
        io.report(
            || {
                self.now
                    .values
                    .iter()
                    .map(|(name, value)| {
                        let file = scenario.parameters.get(name);
                        json!({
                            "name": name,
                            "value": value,
                            "file": file.map(|p| p.value),
                            "formula": file.and_then(|p| Some(p.formula.as_ref()?.text().to_owned())),
                            "min": file.and_then(|p| p.min),
                            "max": file.and_then(|p| p.max),
                            "step": file.and_then(|p| p.step),
                            "unit": file.and_then(|p| p.unit.clone()),
                            "about": file.and_then(|p| p.about.clone()),
                        })
                    })
                    .collect()
            },
            |out, style| view::parameters::write(out, scenario, &self.now.values, style),
        )?;
        Ok(())
    }

    /// `diff`: against the file.
    pub(in crate::session) fn report_difference(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let scenario = &self.now.scenario;
        let mut rows: Vec<(String, String, String, Option<&str>)> = Vec::new();
        for (name, value) in &self.now.values {
            let Some(file) = scenario.parameters.get(name) else {
                continue;
            };
            if file.value.to_bits() != value.to_bits() {
                rows.push((name.clone(), file.value.to_string(), value.to_string(), file.unit.as_deref()));
            }
        }
        let (now, file) = (self.now.rules, scenario.rules);
        for (name, file, now) in [
            ("covering", file.covering.to_string(), now.covering.to_string()),
            ("tie-break", file.tie_break.to_string(), now.tie_break.to_string()),
            ("engine", file.engine.to_string(), now.engine.to_string()),
        ] {
            if file != now {
                rows.push((name.to_owned(), file, now, None));
            }
        }
        io.report(
            || rows.iter().map(|(name, file, now, _)| json!({"name": name, "file": file, "now": now})).collect(),
            |out, style| {
                if rows.is_empty() {
                    return writeln!(out, "nothing differs from the file");
                }
                for (name, file, now, unit) in &rows {
                    let line = format!("{name:<14} {} (file: {file})", with_unit(now, *unit));
                    writeln!(out, "{}", style.text(&line))?;
                }
                Ok(())
            },
        )?;
        Ok(())
    }

    /// `pairs [IDS] [sort KEY]`.
    pub(in crate::session) fn report_pairs(&self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        self.need_answer()?;
        if let (Source::Lcp(_), Some(solution)) = (&self.now.scenario.source, self.solution()) {
            return self.report_solution(&solution, io);
        }
        let rows = Rows::read(words, "pairs", SORT_KEYS)?;
        let place = self.history_place();
        let all = self.quantity_pairs();
        let ids: Vec<&str> = all.iter().map(|pair| pair.id.as_str()).collect();
        if let ([], Some(name)) = (&ids[..], rows.names.first()) {
            return Err(no_pair(name, &all));
        }
        let mut chosen: Vec<PairState> =
            rows.chosen("pair", &ids)?.into_iter().map(|index| all[index].clone()).collect();
        match rows.sort {
            Some(key) => {
                sort(&mut chosen, key);
                rows.cut(&mut chosen);
            }
            None => rows.order(&mut chosen, "z_t", |pair, _| pair.z_t.abs()),
        }
        io.report(
            || json!(chosen),
            |out, style| {
                if let Some(place) = &place {
                    writeln!(out, "{}", style.paint(Role::Muted, place))?;
                } else if let Some(step) = self.position {
                    let p = self.p().map_or(String::new(), |p| format!(", p = {}", short(p)));
                    writeln!(out, "{}", style.paint(Role::Muted, &format!("at {}{p}", view::pivots::title(step))))?;
                }
                view::pairs::write(out, &chosen, &self.now.scenario.units, style)
            },
        )?;
        Ok(())
    }

    /// z and w of a bare LCP, in the place of pairs.
    fn report_solution(&self, solution: &PlainSolution, io: &mut Output<'_>) -> Result<(), CommandError> {
        io.report(|| json!(solution), |out, style| self.write_solution(solution, out, style))?;
        Ok(())
    }

    /// Names of the rows of a bare LCP.
    pub(super) fn solution_names(&self, solution: &PlainSolution) -> Vec<String> {
        match &self.now.scenario.source {
            Source::Lcp(lcp) => lcp.names.clone(),
            _ => (1..=solution.z.len()).map(|i| i.to_string()).collect(),
        }
    }

    fn write_solution(&self, solution: &PlainSolution, out: &mut dyn Write, style: &Style) -> io::Result<()> {
        let names = self.solution_names(solution);
        let wide = names.iter().map(|name| name.chars().count()).max().unwrap_or(0).max(4);
        let head = format!("{:<wide$} {:>14} {:>14}", "row", "z", "w");
        writeln!(out, "{}", style.paint(Role::Header, &head))?;
        for (name, (z, w)) in names.iter().zip(solution.z.iter().zip(&solution.w)) {
            writeln!(out, "{:<wide$} {:>14} {:>14}", style.text(name), short(*z), short(*w))?;
        }
        Ok(())
    }

    /// Writes the pairs at the pivot shown, or z and w of a bare LCP.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_pairs(&self, out: &mut dyn Write, style: &Style) -> io::Result<()> {
        match self.solution() {
            Some(solution) => self.write_solution(&solution, out, style),
            None => view::pairs::write(out, &self.pairs(), &self.now.scenario.units, style),
        }
    }

    /// `displacements [NODES] [sort KEY] [top N]`.
    pub(in crate::session) fn report_displacements(
        &self,
        words: &[String],
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let rows = Rows::read(words, "displacements", DISPLACEMENT_KEYS)?;
        let answer = self.need_quantities()?;
        let all = self.quantity_displacements().ok_or_else(|| self.none("displacements", answer))?;
        let ids: Vec<&str> = all.iter().map(|node| node.node.as_str()).collect();
        let mut chosen: Vec<NodeDisplacement> =
            rows.chosen("node", &ids)?.into_iter().map(|index| all[index].clone()).collect();
        rows.order(&mut chosen, "u", |node, key| match key {
            "ux" => node.ux.abs(),
            "uy" => node.uy.abs(),
            "rz" => node.rz.abs(),
            _ => node.ux.hypot(node.uy),
        });
        io.report(
            || json!(chosen),
            |out, style| {
                self.write_place(out, style)?;
                view::displacements::write(out, &chosen, &self.now.scenario.units, style)
            },
        )?;
        Ok(())
    }

    /// The error of a result that this answer or source does not have.
    pub(in crate::session) fn none(&self, what: &str, answer: &Answer) -> CommandError {
        CommandError::Refused(match self.now.scenario.source {
            Source::Structure(_) if !answer.is_answer() => {
                format!("no {what}: there is no answer ({})", view::status::outcome_word(answer.outcome))
            }
            Source::Structure(_) => format!("no {what} at this pivot: `step last`"),
            Source::ContactSystem(_) => {
                format!("no {what}: the scenario is a contact system, not a structure")
            }
            Source::Lcp(_) => format!("no {what}: the scenario is a bare LCP"),
        })
    }

    /// `members [BARS] [sort KEY] [top N]`.
    pub(in crate::session) fn report_members(&self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        let rows = Rows::read(words, "members", MEMBER_KEYS)?;
        let answer = self.need_quantities()?;
        let all = answer.members.as_ref().ok_or_else(|| self.none("member forces", answer))?;
        let bars: Vec<&str> = all.iter().map(|member| member.bar.as_str()).collect();
        let mut chosen: Vec<MemberForces> =
            rows.chosen("bar", &bars)?.into_iter().map(|index| all[index].clone()).collect();
        rows.order(&mut chosen, "M", |member, key| {
            let which = Internal::ALL.into_iter().find(|which| which.symbol() == key);
            let extremes = which.zip(Diagram::of_element(member)).map(|(which, diagram)| diagram.extremes(which));
            extremes.map_or(0.0, |ends| ends.iter().fold(0.0, |size, place| size.max(place.value.abs())))
        });
        io.report(
            || chosen.iter().map(json_export::member).collect(),
            |out, style| {
                self.write_place(out, style)?;
                // The extremes of a whole bar are told where only that is shown.
                let bar = match rows {
                    Rows { names: [bar], top: None, .. } => bars.iter().find(|known| *known == bar).copied(),
                    _ => None,
                };
                view::members::write(out, &chosen, bar, &self.now.scenario.units, style)
            },
        )?;
        Ok(())
    }

    /// Σ (m + x f_y − y f_x).
    fn moment_about_origin(&self, reactions: &[Reaction]) -> f64 {
        let Source::Structure(structure) = &self.now.scenario.source else { return 0.0 };
        let positions: HashMap<&str, [f64; 2]> =
            structure.nodes.iter().map(|node| (node.id.as_str(), node.position)).collect();
        let moment = |reaction: &Reaction| {
            let [x, y] = positions.get(reaction.node.as_str()).copied().unwrap_or_default();
            [reaction.m, x * reaction.fy, -y * reaction.fx]
        };
        view::number::balance(reactions.iter().flat_map(moment))
    }

    pub(in crate::session) fn report_reactions(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let answer = self.need_quantities()?;
        let reactions = answer.reactions.as_ref().ok_or_else(|| self.none("reactions", answer))?;
        io.report(
            || json!(reactions),
            |out, style| {
                self.write_place(out, style)?;
                let moment = self.moment_about_origin(reactions);
                view::reactions::write(out, reactions, moment, &self.now.scenario.units, style)
            },
        )?;
        Ok(())
    }

    pub(in crate::session) fn report_check(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let answer = self.need_quantities()?;
        io.report(
            || json!(answer.check),
            |out, style| {
                self.write_place(out, style)?;
                view::check::write(out, answer, style)
            },
        )?;
        Ok(())
    }

    /// `pivots [FROM..TO]`.
    pub(in crate::session) fn report_pivots(
        &self,
        range: Option<&str>,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let answer = self.need_answer()?;
        let last = answer.pivots.last().map_or(0, |pivot| pivot.step);
        let range = match range {
            None => None,
            Some(text) => {
                let bad = || {
                    CommandError::Refused(format!(
                        "pivots: `{text}` is no range; expected K, FROM..TO, FROM.. or ..TO with 0 … {last}"
                    ))
                };
                let end = |word: &str, open: usize| match word.trim() {
                    "" => Ok(open),
                    word => word.parse::<usize>().map_err(|_| bad()),
                };
                let (from, to) = match text.split_once("..") {
                    Some((from, to)) => (end(from, 0)?, end(to.trim_start_matches('='), last)?),
                    None => {
                        let one = text.parse().map_err(|_| bad())?;
                        (one, one)
                    }
                };
                if from > to || from > last {
                    return Err(bad());
                }
                Some(from..=to)
            }
        };
        io.report(
            || {
                answer
                    .pivots
                    .iter()
                    .filter(|pivot| range.as_ref().is_none_or(|range| range.contains(&pivot.step)))
                    .map(|pivot| json!(pivot))
                    .collect()
            },
            |out, style| {
                view::pivots::write(out, answer, range.clone(), self.position, &self.now.scenario.units, style)
            },
        )?;
        Ok(())
    }

    /// The sentence of the pivot that `step` came to.
    pub(in crate::session) fn report_step(
        &self,
        to: usize,
        last: usize,
        stayed: bool,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let answer = self.need_answer()?;
        let pivot = answer.pivots.iter().find(|pivot| pivot.step == to);
        io.report(
            || json!({"step": to, "last": last, "pivot": pivot}),
            |out, style| {
                let sentence = pivot.map_or("", |pivot| pivot.sentence.as_str());
                let end = match (stayed, to == last, to == 0) {
                    (true, true, _) => " (the last pivot)",
                    (true, _, true) => " (the first pivot)",
                    _ => "",
                };
                let label = format!("{} of {last}{end}: ", view::pivots::title(to));
                for line in style.hanging(&label, &style.text(sentence)) {
                    writeln!(out, "{line}")?;
                }
                Ok(())
            },
        )?;
        Ok(())
    }

    pub(in crate::session) fn report_history(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        io.report(
            || json!(self.history),
            |out, style| {
                for (index, command) in self.history.iter().enumerate() {
                    writeln!(out, "{:>5}  {}", index + 1, style.text(command))?;
                }
                Ok(())
            },
        )?;
        Ok(())
    }
}
