//! `export vtu`: the state shown as a mesh with its results, or a series of states.

use std::path::Path;

use crate::export::atomic;
use crate::export::vtu::{Mesh, collection};
use crate::path::quantity::{Facts, NoValue};
use crate::path::record::PathPlace;
use crate::session::{CommandError, Output, Session};

/// A series of more states is too many files.
const MOST_STATES: usize = 1000;

impl Session {
    /// The state shown to FILE.vtu, or with `series` the states on the way to it to FILE.pvd.
    pub(super) fn export_vtu(&self, path: &Path, series: bool, io: &Output<'_>) -> Result<(), CommandError> {
        self.need_quantities()?;
        if self.structure().is_none() {
            return Err(CommandError::Refused("no mesh: the scenario has no structure".to_owned()));
        }
        if !series {
            return self.with_facts(io.watch, |facts| write(facts, path));
        }
        let name = path.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let file = |number: usize| format!("{name}-{number:04}.vtu");
        let beside = |number: usize| path.with_file_name(file(number));
        let times = match &self.followed {
            Some(_) => self.write_history(&beside, io)?,
            None => self.write_pivots(&beside, io)?,
        };
        let states: Vec<(f64, String)> =
            times.into_iter().enumerate().map(|(number, time)| (time, file(number))).collect();
        atomic::write(path, |out| collection(out, &states)).map_err(|error| CommandError::Refused(error.to_string()))
    }

    /// A file for every pivot; their numbers as times.
    fn write_pivots(
        &self,
        file: &dyn Fn(usize) -> std::path::PathBuf,
        io: &Output<'_>,
    ) -> Result<Vec<f64>, CommandError> {
        let (Some(solved), Some(shown)) = (&self.solved, self.prepared_shown()) else {
            return Err(CommandError::Refused("not solved yet: `solve`, or `set auto on`".to_owned()));
        };
        let pivots = solved.answer.pivots.len();
        few(pivots, "pivots")?;
        for step in 0..pivots {
            if io.watch.stop() {
                return Err(CommandError::Interrupted);
            }
            let gone = || CommandError::Refused(format!("pivot {step} cannot be shown"));
            let pairs = solved.pairs_at(shown, step).ok_or_else(gone)?;
            let displacements = solved.displacements_at(shown, step).ok_or_else(gone)?;
            let facts = Facts::of_answer(self.now.case(shown, io.watch), solved);
            write(&facts.at_pivot(&pairs, Some(&displacements), solved.p_at(step)), &file(step))?;
        }
        Ok((0..pivots).map(|step| step as f64).collect())
    }

    /// A file for every moment of the history; as times the stages that are done, with their parts.
    fn write_history(
        &self,
        file: &dyn Fn(usize) -> std::path::PathBuf,
        io: &Output<'_>,
    ) -> Result<Vec<f64>, CommandError> {
        let path = self.need_path()?;
        let Some(prepared) = &self.now.prepared else {
            return Err(CommandError::Refused("not solved yet: `solve`, or `set auto on`".to_owned()));
        };
        let time = |place: &PathPlace| place.stage.map_or(0, |stage| stage - 1) as f64 + place.value;
        // a stage begins where the one before it ended; of a jump the state after it counts
        let is_last =
            |index: &usize| path.places.get(index + 1).is_none_or(|next| time(next) != time(&path.places[*index]));
        let moments: Vec<&PathPlace> =
            (0..path.places.len()).filter(is_last).map(|index| &path.places[index]).collect();
        few(moments.len(), "moments")?;
        for (number, place) in moments.iter().enumerate() {
            if io.watch.stop() {
                return Err(CommandError::Interrupted);
            }
            self.with_place(prepared, path, place, io.watch, |facts| write(facts, &file(number)))
                .map_err(|reason| CommandError::Refused(format!("export: {reason}")))??;
        }
        Ok(moments.into_iter().map(time).collect())
    }
}

fn few(count: usize, of: &str) -> Result<(), CommandError> {
    match count {
        0 => Err(CommandError::Refused(format!("no series: there are no {of}"))),
        count if count > MOST_STATES => Err(CommandError::Refused(format!(
            "{count} {of} are more than {MOST_STATES} files: export single states, with `step to K; export vtu FILE.vtu`"
        ))),
        _ => Ok(()),
    }
}

fn write(facts: &Facts<'_>, path: &Path) -> Result<(), CommandError> {
    let field = facts
        .field()
        .map_err(|NoValue(reason)| CommandError::Refused(format!("no displacements to write: {reason}")))?;
    atomic::write(path, |out| Mesh(field).write(out)).map_err(|error| CommandError::Refused(error.to_string()))
}
