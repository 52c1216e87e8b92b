//! `export`: results to files. What is written is what the commands show, in the format that the ending of the file
//! says.

mod exported;
mod lcp;
mod pictures;
mod report;
mod stiffness;
pub(super) mod tables;
mod vtu;

use std::fs;
use std::io::Read;
use std::path::Path;

use clap::Args;

use crate::model::scenario::FORMAT;
use crate::session::commands::find;
use crate::session::commands::plots::of_path;
use crate::session::language::candidates::{Asked, Candidate};
use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session};

use exported::Exported;

/// Write tables, pictures, a report, the mesh with its results, or the LCP, to a file
///
/// Tables go to .csv or .json: `export WHAT [OF] FILE`, where OF are the quantities of `quantities` and `envelope`, or
/// the words that `sensitivity`, `critical`, `find`, `cycle`, `limit` and `check` take. A table is what the command shows, at
/// the pivot chosen by `step`, after `stages` at the end of the history.
///
/// `export report FILE.html` is one file with its figures, `FILE.md` has them beside it as FILE-structure.svg and so
/// on. It bears no date, so that the same answer gives the same file; `export report date FILE` adds it.
///
/// `export vtu FILE.vtu` is the state shown for ParaView: the nodes with displacement, rotation and stress, the
/// elements with stress or N, Q, M, and a vertex for each pair with its state (0 open, 1 stick, 2 slip+, 3 slip-,
/// 4 closed) and the vectors of force, friction and slip. `export vtu FILE.pvd` is a series, of the moments of the
/// history after `stages`, else of the pivots: FILE-0000.vtu, FILE-0001.vtu … stand beside it.
///
/// Pictures go to .svg: `slip`, `force`, `gap`, `pressure` and `traction` of the state shown or at pivots that are
/// named; `moment`, `shear` and `axial` of all bars on the structure, or of the bar that is named; `path` as `plot
/// path` draws it, with the same words. `export path QUANTITY FILE.csv` has the quantities at every place of the path.
///
/// `export lcp` writes M, q and the covering d, in the units of the scenario: to .json as a scenario of this program,
/// or M to FILE.mtx, q to FILE.q.mtx and d to FILE.d.mtx in Matrix Market format; a scenario reads M back with
/// `"M": { "file": "FILE.mtx" }`.
///
/// `export system` writes the contact system, R with the motions in its kernel and the load as they stand, or the bare
/// LCP, at the present values: what a proof is about (`help prove`), a scenario of its own.
///
/// `export stiffness` writes K of the elements to FILE.mtx, F of each load case to FILE.CASE.mtx, and to FILE.json the
/// scenario that reads them back as a superelement: with the dofs of the rows, and supports, ties, springs and contacts
/// beside it at the present values.
///
/// A file that is there is replaced, whole or not at all; never the scenario itself.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  export pairs pairs.csv\n  export envelope x_n c1, max u envelope.csv\n  export vtu beam.vtu\n  export structure beam.svg\n  export report beam.html\n  export path force c6 c5 path.svg\n  export result answer.json\n  export lcp beam-lcp.json\n  export find F2 0..400 where z_t c3 > 0 places.csv\n  export stiffness k.mtx"
)]
pub struct Export {
    /// What to write
    #[arg(value_name = "WHAT")]
    what: Exported,
    /// Its ending says the format; of what stands before it
    #[arg(value_name = "OF FILE", required = true, trailing_var_arg = true, allow_hyphen_values = true)]
    words: Vec<String>,
}

pub const EXPORT: Command =
    Command { usage: Some("WHAT [OF] FILE"), complete: words, ..Command::of::<Export>("export") };

impl Action for Export {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.export(self.what, &self.words, io)?;
        Ok(Next::Continue)
    }

    fn needs_pivots(&self) -> bool {
        true
    }
}

/// The file, and before it what belongs to what is written.
fn words(asked: &Asked<'_>) -> Vec<Candidate> {
    let (what, of) = asked.given.split_first().map_or(("", asked.given), |(what, of)| (what.as_str(), of));
    let mut all = asked.files();
    all.extend(match what {
        "quantities" | "envelope" => asked.quantities(of),
        "sensitivity" | "critical" => asked.parameters(),
        "limit" => asked.varied(),
        "find" => find::words(&Asked { given: of, ..*asked }),
        "check" => Candidate::plain(["exact"]),
        "moment" | "shear" | "axial" | "Vz" | "T" | "My" => Candidate::plain(&asked.names.bars),
        "slip" | "force" | "gap" | "pressure" | "traction" => Candidate::plain(["first", "last"]),
        "path" => of_path(asked, of),
        _ => Vec::new(),
    });
    all
}

/// How far into a file its format is looked for.
const HEAD: u64 = 1 << 16;

/// Whether a file says that it is a scenario.
fn is_scenario(path: &Path) -> bool {
    let mut head = Vec::new();
    let read = fs::File::open(path).and_then(|file| file.take(HEAD).read_to_end(&mut head));
    let head = String::from_utf8_lossy(&head);
    let format = head.split_once("\"format\"").and_then(|(_, rest)| rest.trim_start().strip_prefix(':'));
    read.is_ok() && format.is_some_and(|format| format.trim_start().starts_with(&format!("\"{FORMAT}\"")))
}

impl Session {
    /// `export WHAT [OF] FILE`.
    pub(super) fn export(&mut self, what: Exported, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
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
        if let Some(word) = of.get(what.most_words()) {
            return Err(CommandError::Refused(format!(
                "export: `{word}` makes no sense here; `help export` says what does"
            )));
        }
        match what {
            Exported::Lcp | Exported::Stiffness | Exported::System => self.spare_scenario(path)?,
            _ => self.spare_scenarios(path)?,
        }
        match what {
            Exported::Lcp => return self.export_lcp(path, io),
            Exported::Stiffness => return self.export_stiffness(path, io),
            Exported::System => self.export_system(path, io),
            Exported::Report => self.export_report(of, path, io),
            Exported::Vtu => self.export_vtu(path, ending == "pvd", io),
            _ if ending == "svg" => self.export_picture(what, of, path, io.watch),
            _ => self.export_table(what, of, path, ending == "csv", io),
        }?;
        Ok(io.say(&format!("wrote {}", path.display()))?)
    }

    /// Refuses to write what is not a scenario over a file that is one.
    pub(in crate::session) fn spare_scenarios(&self, path: &Path) -> Result<(), CommandError> {
        self.spare_scenario(path)?;
        if fs::metadata(path).is_ok_and(|file| file.is_file()) && is_scenario(path) {
            let refusal = format!("{} is a scenario and stays as it is: write to another file", path.display());
            return Err(CommandError::Refused(refusal));
        }
        Ok(())
    }

    /// Refuses to write over the scenario.
    pub(in crate::session) fn spare_scenario(&self, path: &Path) -> Result<(), CommandError> {
        let scenario = self.now.scenario.path.as_ref().and_then(|path| fs::canonicalize(path).ok());
        if scenario.is_some() && fs::canonicalize(path).ok() == scenario {
            let refusal = format!("{} is the scenario itself: export to another file", path.display());
            return Err(CommandError::Refused(refusal));
        }
        Ok(())
    }
}
