//! `export`: results to files.

use std::path::Path;

use serde_json::Value;

use crate::export::{atomic, csv, json as json_export};

use super::command::Export;
use super::{CommandError, Output, Session};

impl Session {
    /// `export WHAT FILE`.
    pub(super) fn export(
        &self,
        what: Export,
        path: &Path,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
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
            Export::Pairs | Export::Pivots | Export::Result | Export::Path => false,
        };
        if missing {
            let word = match what {
                Export::Displacements => "displacements",
                Export::Members => "member forces",
                _ => "reactions",
            };
            return Err(self.none(word, answer));
        }
        let ending = path
            .extension()
            .and_then(|ending| ending.to_str())
            .unwrap_or_default();
        let as_json = |value: Value| {
            atomic::write(path, |out| {
                let text = serde_json::to_string_pretty(&value).map_err(std::io::Error::other)?;
                writeln!(out, "{text}")
            })
        };
        let written = match (what, ending) {
            (Export::Pairs, "csv") => atomic::write(path, |out| csv::pairs(out, &shown)),
            (Export::Pivots, "csv") => atomic::write(path, |out| csv::pivots(out, &shown)),
            (Export::Displacements, "csv") => {
                atomic::write(path, |out| csv::displacements(out, &shown))
            }
            (Export::Members, "csv") => atomic::write(path, |out| csv::members(out, &shown)),
            (Export::Reactions, "csv") => atomic::write(path, |out| csv::reactions(out, &shown)),
            (Export::Pairs, "json") => as_json(json_export::pairs(&shown)),
            (Export::Pivots, "json") => as_json(json_export::pivots(&shown)),
            (Export::Displacements, "json") => as_json(json_export::displacements(&shown)),
            (Export::Members, "json") => as_json(json_export::members(&shown)),
            (Export::Reactions, "json") => as_json(json_export::reactions(&shown)),
            (Export::Result, "json") => as_json(json_export::result(
                answer,
                &self.now.scenario.name,
                &self.now.values,
                false,
            )),
            (Export::Result, _) => {
                return Err(CommandError::Refused(format!(
                    "the whole result is written as JSON: {} must end in .json",
                    path.display()
                )));
            }
            _ => {
                return Err(CommandError::Refused(format!(
                    "{} must end in .csv or .json",
                    path.display()
                )));
            }
        };
        written.map_err(|error| CommandError::Refused(error.to_string()))?;
        Ok(io.say(&format!("wrote {}", path.display()))?)
    }
}
