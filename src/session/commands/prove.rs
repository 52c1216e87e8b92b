//! `prove`: the proof of what stands, for somebody else to check.

use std::path::Path;

use clap::Args;
use serde::Serialize;

use crate::export::{atomic, proof as proof_export};
use crate::model::words::counted;
use crate::session::error::refused;
use crate::session::language::candidates::{Asked, Candidate};
use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session};
use crate::solve::prove::system::ProvedSystem;
use crate::solve::prove::{Claim, Proof};
use crate::text::printable;
use crate::text::words::short;
use crate::view::style::Role;

/// Write the proof of what stands, for a short independent script to check
///
/// `prove FILE.json`: of an answer its scheme and every quantity as a fraction; of a collapse the motion, its work and
/// the most that contact can take; of another problem without an answer the sums that are negative whatever moves.
/// `prove all FILE.json`: the tree of all working schemes, in which every end is an answer or a contradiction: these are
/// all the answers, or there is none. Beside it FILE.system.json holds the numbers that the proof is about, as a
/// scenario; `export system` writes the same.
///
/// In space answers are those of the friction polygon, whose directions the proof gives; a collapse is proved on Coulomb's
/// cone itself where it can be.
///
/// `examples/check_proof.py FILE.json` reads both and trusts neither: it needs Python and nothing else. What is proved
/// is proved of these doubles, each taken as the fraction it is; how far they are from the structure is not part of it.
/// An answer has at most 120 pairs and 48 motions that only contact holds (an LCP 240 rows), a proof of all answers at most
/// 12 (30), 5000 branches and a minute of work.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  prove answer.json\n  load klarbring; prove all answers.json")]
pub struct Prove {
    /// `all`, and the file
    #[arg(value_name = "[all] FILE", required = true, num_args = 1..=2)]
    words: Vec<String>,
}

pub const PROVE: Command = Command { in_0_1: false, complete: candidates, ..Command::of::<Prove>("prove") };

impl Action for Prove {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.prove(&self.words, io)?;
        Ok(Next::Continue)
    }

    fn needs_pivots(&self) -> bool {
        true
    }
}

fn candidates(asked: &Asked<'_>) -> Vec<Candidate> {
    let mut all = asked.files();
    if asked.given.is_empty() {
        all.extend(Candidate::plain(["all"]));
    }
    all
}

#[derive(Serialize)]
struct ProofReport {
    claim: &'static str,
    sentence: String,
    /// Of a proof of all answers.
    answers: Option<usize>,
    file: String,
    system: String,
}

impl Session {
    fn prove(&mut self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        let (all, file) = match words {
            [all, file] if all == "all" => (true, file),
            [file] if file != "all" => (false, file),
            _ => return refused("prove: expected a file, `prove FILE.json` or `prove all FILE.json`"),
        };
        let path = Path::new(file);
        if path.extension().is_none_or(|ending| ending != "json") {
            return refused(format!("prove: expected the name of a file that ends in .json, found `{file}`"));
        }
        let beside = path.with_extension("system.json");
        if self.followed.is_some() {
            return refused(
                "prove: what stands is a moment of a history; `solve` goes back to the answer at once, which can be proved",
            );
        }
        self.spare_scenarios(path)?;
        self.spare_scenario(&beside)?;
        let proof = self.ask(io, move |prepared, solved, watch| match all {
            true => prepared.prove_all(solved, watch),
            false => prepared.prove(solved, watch),
        })?;
        let system = self.write_system(&proof.system, &beside)?;
        let text =
            serde_json::to_string_pretty(&proof_export::proof(&proof, &system)).map_err(std::io::Error::other)?;
        write(path, &(text + "\n"))?;
        let (claim, answers) = match &proof.claim {
            Claim::Answer(_) => ("answer", None),
            Claim::Collapse(_) => ("collapse", None),
            Claim::Answers(all) => ("answers", Some(all.answers.len())),
        };
        let named = |path: &Path| path.display().to_string();
        let report =
            ProofReport { claim, sentence: sentence(&proof), answers, file: named(path), system: named(&beside) };
        io.show(&report, |out, style| {
            style.paragraph(out, Role::Plain, &report.sentence)?;
            writeln!(
                out,
                "wrote {} and {}: `python3 check_proof.py {}` checks it",
                report.file, report.system, report.file
            )
        })?;
        self.keep_result(&report);
        Ok(())
    }

    /// Writes the numbers of proofs as a scenario; its text.
    fn write_system(&self, system: &ProvedSystem, path: &Path) -> Result<String, CommandError> {
        let title = format!("System of {}: {}", self.now.scenario.name, self.now.scenario.title);
        let value = proof_export::system(system, &title, &self.now.scenario.units);
        let text = printable::json(serde_json::to_string(&value).map_err(std::io::Error::other)?) + "\n";
        write(path, &text)?;
        Ok(text)
    }

    /// `export system FILE.json`.
    pub(in crate::session) fn export_system(&self, path: &Path, io: &Output<'_>) -> Result<(), CommandError> {
        let system = self.ask(io, |prepared, solved, _| prepared.proved_system(solved, "export system"))?;
        self.write_system(&system, path).map(drop)
    }
}

fn write(path: &Path, text: &str) -> Result<(), CommandError> {
    atomic::write(path, |out| out.write_all(text.as_bytes())).map_err(|error| CommandError::Refused(error.to_string()))
}

/// What is proved.
fn sentence(proof: &Proof) -> String {
    let claimed = claimed(proof);
    match proof.polygon() {
        None => claimed,
        Some(polygon) => format!(
            "{claimed} All of it is about the polygon of {} facets with the directions that the proof gives, not about the \
             cone{}.",
            polygon.facets(),
            if matches!(proof.claim, Claim::Answer(_)) {
                ", to which Newton's method goes on from this answer"
            } else {
                ""
            }
        ),
    }
}

fn claimed(proof: &Proof) -> String {
    let [one, many] = match &proof.system {
        ProvedSystem::Contact(_) => ["pair", "pairs"],
        ProvedSystem::Plain { .. } => ["row", "rows"],
    };
    let units = counted(proof.forms.groups.len(), one, many);
    match &proof.claim {
        Claim::Answer(_) => {
            format!("Proved: the answer, {} signs of {units} in rationals.", proof.forms.names.len())
        }
        Claim::Collapse(found) => {
            let number = |value| short(crate::lcp::exact::dyadic::nearest(value));
            format!(
                "Proved: no contact forces balance the loads. There is a motion on which the loads do the work {} and contact takes at \
                 most {}.",
                number(&found.work),
                number(&found.bound)
            )
        }
        Claim::Answers(all) => {
            let count = match (all.answers.len(), all.sets) {
                (0, _) => "there is no answer".to_owned(),
                (1, 0) => "there is one answer and no other".to_owned(),
                (count, 0) => format!("there are {count} answers and no others"),
                (count, sets) => format!(
                    "every answer is one of {count} or lies in one of {sets} sets, each all that a branch leaves, with some of these in it"
                ),
            };
            format!("Proved: {count}; {}.", counted(all.nodes, "branch", "branches"))
        }
    }
}
