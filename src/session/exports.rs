//! `export`: results to files.

use std::path::Path;

use serde_json::Value;

use crate::export::{atomic, csv, json as json_export, lcp as lcp_export};

use super::command::Export;
use super::{CommandError, Output, Session};

impl Session {
    /// `export WHAT FILE`.
    pub(super) fn export(&self, what: Export, path: &Path, io: &mut Output<'_>) -> Result<(), CommandError> {
        let answer = self.need_answer()?;
        // pairs and displacements are those at the pivot shown
        let mut shown = answer.clone();
        if self.position.is_some() {
            shown.pairs = self.pairs();
            shown.displacements = self.displacements();
        }
        let missing = match what {
            Export::Displacements => shown.displacements.is_none(),
            Export::Members => shown.members.is_none(),
            Export::Reactions => shown.reactions.is_none(),
            Export::Pairs | Export::Pivots | Export::Result | Export::Path | Export::Lcp => false,
        };
        if missing {
            let word = match what {
                Export::Displacements => "displacements",
                Export::Members => "member forces",
                _ => "reactions",
            };
            return Err(self.none(word, answer));
        }
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        let as_json = |value: Value| {
            atomic::write(path, |out| {
                let text = json_export::pretty(&value)?;
                writeln!(out, "{text}")
            })
        };
        let written = match (what, ending) {
            (Export::Pairs, "csv") => atomic::write(path, |out| csv::pairs(out, &shown)),
            (Export::Pivots, "csv") => atomic::write(path, |out| csv::pivots(out, &shown)),
            (Export::Displacements, "csv") => atomic::write(path, |out| csv::displacements(out, &shown)),
            (Export::Members, "csv") => atomic::write(path, |out| csv::members(out, &shown)),
            (Export::Reactions, "csv") => atomic::write(path, |out| csv::reactions(out, &shown)),
            (Export::Pairs, "json") => as_json(json_export::pairs(&shown)),
            (Export::Pivots, "json") => as_json(json_export::pivots(&shown)),
            (Export::Displacements, "json") => as_json(json_export::displacements(&shown)),
            (Export::Members, "json") => as_json(json_export::members(&shown)),
            (Export::Reactions, "json") => as_json(json_export::reactions(&shown)),
            (Export::Result, "json") => as_json(self.result(false).unwrap_or_default()),
            (Export::Result, _) => {
                return Err(CommandError::Refused(format!(
                    "the whole result is written as JSON: {} must end in .json",
                    path.display()
                )));
            }
            _ => {
                return Err(CommandError::Refused(format!("{} must end in .csv or .json", path.display())));
            }
        };
        written.map_err(|error| CommandError::Refused(error.to_string()))?;
        Ok(io.say(&format!("wrote {}", path.display()))?)
    }

    /// `export lcp FILE`.
    pub(super) fn export_lcp(&self, path: &Path, io: &mut Output<'_>) -> Result<(), CommandError> {
        let refused = |text: String| Err(CommandError::Refused(text));
        let Some(prepared) = &self.now.prepared else {
            return refused("nothing is solved yet: `solve` first".into());
        };
        let covering = self.now.rules.covering;
        let (lcp, names) = prepared.written_lcp(&self.now.values, covering);
        if lcp.covering.iter().any(|d| *d <= 0.0) {
            return refused(format!(
                "covering {covering} is 0 in a row without friction, and an lcp needs d > 0: `set covering cohesive` first"
            ));
        }
        let scenario = &self.now.scenario;
        let title = format!("LCP of {}: {}", scenario.name, scenario.title);
        let ending = path.extension().and_then(|ending| ending.to_str());
        let files = match ending {
            Some("json") => {
                let value = lcp_export::scenario(&lcp, &names, &title);
                atomic::write(path, |out| {
                    let text = json_export::pretty(&value)?;
                    writeln!(out, "{text}")
                })
                .map(|()| vec![path.to_owned()])
            }
            Some("mtx") => {
                let column = |values: &[f64]| values.iter().map(|v| vec![*v]).collect::<Vec<_>>();
                let parts = [
                    (path.to_owned(), "M", lcp.matrix.clone()),
                    (path.with_extension("q.mtx"), "q", column(&lcp.q)),
                    (path.with_extension("d.mtx"), "d", column(&lcp.covering)),
                ];
                parts
                    .into_iter()
                    .map(|(file, what, rows)| {
                        let comment = format!("{what} of w = M z + q + d p. {title}");
                        atomic::write(&file, |out| lcp_export::matrix_market(out, &rows, &comment)).map(|()| file)
                    })
                    .collect()
            }
            _ => return refused(format!("{} must end in .json or .mtx", path.display())),
        };
        let files = files.map_err(|error| CommandError::Refused(error.to_string()))?;
        let names: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
        Ok(io.say(&format!("wrote {}", names.join(", ")))?)
    }
}
