//! `export lcp`: the problem itself, for other solvers.

use std::path::Path;

use crate::export::{atomic, json as json_export, lcp as lcp_export};
use crate::session::{CommandError, Output, Session};

impl Session {
    /// `export lcp FILE`.
    pub(in crate::session) fn export_lcp(&self, path: &Path, io: &mut Output<'_>) -> Result<(), CommandError> {
        let refused = |text: String| Err(CommandError::Refused(text));
        let Some(prepared) = &self.now.prepared else {
            return refused("nothing is solved yet: `solve` first".into());
        };
        let rules = self.now.rules;
        let (lcp, names) = prepared.written_lcp(&self.now.values, rules);
        if lcp.covering.iter().any(|d| *d <= 0.0) {
            return refused(format!(
                "covering {} is 0 in a row without friction, and an lcp needs d > 0: `set covering cohesive` first",
                rules.covering
            ));
        }
        let scenario = &self.now.scenario;
        let title = format!("LCP of {}: {}", scenario.name, scenario.title);
        let ending = path.extension().and_then(|ending| ending.to_str());
        let files = match ending {
            Some("json") => {
                let value = lcp_export::scenario(&lcp, &names, &title, &scenario.units);
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
