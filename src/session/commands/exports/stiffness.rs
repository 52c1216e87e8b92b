//! `export stiffness`: K and F for other programs, and the scenario that reads them back.

use std::path::{Path, PathBuf};

use crate::export::stiffness::{Stiffness, matrix};
use crate::export::{atomic, json as json_export, lcp as lcp_export};
use crate::fem::matrices::matrices;
use crate::session::{CommandError, Output, Session};

impl Session {
    /// `export stiffness FILE`: K to FILE.mtx, F of each load case to FILE.CASE.mtx, the scenario to FILE.json.
    pub(super) fn export_stiffness(&self, path: &Path, io: &mut Output<'_>) -> Result<(), CommandError> {
        let refused = |text: &str| CommandError::Refused(text.to_owned());
        let structure = self.structure().ok_or_else(|| {
            refused("no stiffness matrix: the scenario has no structure; `export lcp` writes the problem itself")
        })?;
        if !structure.yielding_ground.is_empty() {
            return Err(refused(
                "a tensionless foundation cannot stand beside a superelement: without it the structure can be exported",
            ));
        }
        let scenario = path.with_extension("json");
        self.spare_scenario(&scenario)?;
        let matrices = matrices(structure, io.watch).map_err(|error| match io.watch.stop() {
            true => CommandError::Interrupted,
            false => CommandError::Refused(error.to_string()),
        })?;
        let file = |case: Option<&str>| match case {
            None => path.with_extension("mtx"),
            Some(case) => path.with_extension(format!("{case}.mtx")),
        };
        let name = |path: PathBuf| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let source = Stiffness { structure, values: &self.now.values, matrices: &matrices };
        let title = format!("K and F of {}", self.now.scenario.title);
        let (value, untold) = source.scenario(&title, &self.now.scenario.units, &|case| name(file(case)));
        let mut written = vec![scenario.clone(), file(None)];
        let failed = |error: atomic::WriteError| CommandError::Refused(error.to_string());
        let text = json_export::pretty(&json_export::without_signed_zeros(value)).map_err(CommandError::from)?;
        atomic::write(&scenario, |out| writeln!(out, "{text}")).map_err(failed)?;
        atomic::write(&file(None), |out| matrix(out, &matrices)).map_err(failed)?;
        for (case, forces) in structure.load_cases.iter().zip(&matrices.forces) {
            let column: Vec<Vec<f64>> = forces.iter().map(|force| vec![*force]).collect();
            let comment = format!("F of {} for a factor of 1; the rows are the dofs of the scenario", case.name);
            let path = file(Some(&case.name));
            atomic::write(&path, |out| lcp_export::matrix_market(out, &column, &comment)).map_err(failed)?;
            written.push(path);
        }
        let names: Vec<String> = written.iter().map(|file| file.display().to_string()).collect();
        let left = match untold {
            0 => String::new(),
            count => format!(
                "; {count} pairs of edges whose nodes do not match are not in it: beside a superelement a pair has one node \
                 on each side"
            ),
        };
        Ok(io.say(&format!("wrote {}{left}", names.join(", ")))?)
    }
}
