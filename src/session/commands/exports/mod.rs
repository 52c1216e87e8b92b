//! `export`: results to files. What is written is what the commands show, in the format that the ending of the file
//! says.

mod lcp;
mod pictures;
mod report;
mod stiffness;
pub(super) mod tables;
mod vtu;

use std::fs;
use std::path::Path;

use crate::session::language::export::Export;
use crate::session::{CommandError, Output, Session};

impl Session {
    /// `export WHAT [OF] FILE`.
    pub(super) fn export(&mut self, what: Export, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        let Some((file, of)) = words.split_last() else {
            return Err(CommandError::Refused("export: to which file?".to_owned()));
        };
        let path = Path::new(file);
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        let fitting = what.endings();
        if !fitting.contains(&ending) {
            let (last, before) = fitting.split_last().unwrap_or((&"", &[]));
            let before: String = before.iter().map(|ending| format!(".{ending}, ")).collect();
            let or = if before.is_empty() { "" } else { "or " };
            let fitting = format!("{}{or}.{last}", if fitting.len() == 2 { before.replace(',', "") } else { before });
            return Err(CommandError::Refused(format!(
                "{file} must end in {fitting}: `help export` says what goes where"
            )));
        }
        if let Some(word) = of.get(what.most_words(ending)) {
            return Err(CommandError::Refused(format!(
                "export: `{word}` makes no sense here; `help export` says what does"
            )));
        }
        self.spare_scenario(path)?;
        match what {
            Export::Lcp => return self.export_lcp(path, io),
            Export::Stiffness => return self.export_stiffness(path, io),
            Export::Report => self.export_report(of, path, io),
            Export::Vtu => self.export_vtu(path, ending == "pvd", io),
            _ if ending == "svg" => self.export_picture(what, of, path, io.watch),
            _ => self.export_table(what, of, path, ending == "csv", io),
        }?;
        Ok(io.say(&format!("wrote {}", path.display()))?)
    }

    /// Refuses to write over the scenario.
    fn spare_scenario(&self, path: &Path) -> Result<(), CommandError> {
        let scenario = self.now.scenario.path.as_ref().and_then(|path| fs::canonicalize(path).ok());
        if scenario.is_some() && fs::canonicalize(path).ok() == scenario {
            let refusal = format!("{} is the scenario itself: export to another file", path.display());
            return Err(CommandError::Refused(refusal));
        }
        Ok(())
    }
}
