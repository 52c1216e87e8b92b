//! `why PAIR`: its state from its numbers, and the pivots that turned it; `why z[NAME]` of a bare LCP.

use clap::Args;
use serde::Serialize;

use crate::answer::record::{PairDirection, PairState, PivotRecord};
use crate::explain::margin::Margin;
use crate::explain::pair_state;
use crate::explain::plain_why::Vertex;
use crate::solve::prepared::Geometry;
use crate::solve::state::RunData;
use crate::text::number::short;
use crate::view;
use crate::watch::Quiet;

use crate::model::words::no_such;
use crate::session::language::candidates::Candidate;
use crate::session::language::command::{Action, Command};
use crate::session::language::selection::no_pair;
use crate::session::{CommandError, Next, Output, Session};
use crate::view::style::Role;

/// Say why a pair is in its state, and which pivots brought it there; of a bare LCP, why a variable has its value
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  why c6; load murty6; why z[1]; why w[2]")]
pub struct Why {
    /// The pair; of a bare LCP z[NAME] or w[NAME]
    #[arg(value_name = "PAIR")]
    pair: String,
}

pub const WHY: Command =
    Command { complete: |asked| Candidate::plain(&asked.names.pairs), ..Command::of::<Why>("why") };

impl Action for Why {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.report_why(&self.pair, io)?;
        Ok(Next::Continue)
    }

    fn needs_pivots(&self) -> bool {
        true
    }
}

#[derive(Serialize)]
struct WhyReport<'a> {
    pair: &'a PairState,
    cause: &'a str,
    pivots: &'a [&'a PivotRecord],
    margins: &'a [Margin],
    ray: Option<&'a PairDirection>,
}

impl Session {
    /// How far the final scheme holds; empty at a pivot on the way.
    fn margins(&self, id: &str) -> Vec<Margin> {
        let (Some(prepared), Some(solved), None) = (self.prepared_shown(), &self.solved, self.position) else {
            return Vec::new();
        };
        let pair = solved.answer.pairs.iter().position(|pair| pair.id == id);
        pair.map_or_else(Vec::new, |pair| solved.margins(self.now.case(prepared, &Quiet), pair))
    }

    /// `why PAIR`: its state from its numbers, and the pivots that turned it.
    pub(in crate::session) fn report_why(&self, id: &str, io: &mut Output<'_>) -> Result<(), CommandError> {
        let answer = self.need_answer()?;
        if answer.solution.is_some() {
            return self.report_plain_why(id, io);
        }
        let pairs = self.pairs();
        let pair = pairs.iter().find(|pair| pair.id == id).ok_or_else(|| no_pair(id, &pairs))?;
        let units = &self.now.scenario.units;
        let state = view::pairs::state_words(pair);
        let cause = pair_state::cause(pair, units);
        let shown = self.shown_step();
        let margins = self.margins(id);
        let moved = answer.ray.as_ref().filter(|_| self.position.is_none()).and_then(|ray| {
            let direction = ray.direction.pairs().iter().find(|direction| direction.pair == id)?;
            Some((direction, view::ray::motion_words(direction)))
        });
        let turned: Vec<_> = answer
            .pivots
            .iter()
            .filter(|pivot| shown.is_none_or(|shown| pivot.step <= shown))
            .filter(|pivot| pivot.turned.as_ref().is_some_and(|turned| turned.pair == id))
            .collect();
        let ray = moved.as_ref().map(|(direction, _)| *direction);
        let report = WhyReport { pair, cause: &cause, pivots: &turned, margins: &margins, ray };
        io.show(&report, |out, style| {
            self.write_not_of_history("", out, style)?;
            let label = format!("{id} {state}: ");
            for line in style.hanging(&style.text(&label), &style.text(&cause)) {
                writeln!(out, "{line}")?;
            }
            if let Some((direction, words)) = &moved {
                let text = match words {
                    Some(words) => format!(
                        "it {words}: z̄_n = {}, z̄_τ = {} of the largest displacement",
                        short(direction.z_n),
                        short(direction.z_t.scalar())
                    ),
                    None => "it does not move".to_owned(),
                };
                for line in style.hanging("in the ray: ", &style.text(&text)) {
                    writeln!(out, "{line}")?;
                }
            }
            if turned.is_empty() {
                writeln!(out, "no pivot turned it: it is as in the main system")?;
            }
            for pivot in &turned {
                let label = format!("  pivot {}: ", pivot.step);
                for line in style.hanging(&label, &style.text(&pivot.sentence)) {
                    writeln!(out, "{line}")?;
                }
            }
            view::pivots::whose_directions(out, answer, &turned, style)?;
            if !margins.is_empty() {
                writeln!(out, "How far the working scheme holds:")?;
            }
            view::why::write(out, id, &margins, style)
        })?;
        Ok(())
    }

    /// `why z[NAME]`, `why w[NAME]`: the row of the couple, and the pivots at which it changed places.
    fn report_plain_why(&self, variable: &str, io: &mut Output<'_>) -> Result<(), CommandError> {
        let (Some(solved), Some(prepared), Some(solution)) = (&self.solved, &self.now.prepared, self.solution()) else {
            return Err(CommandError::Refused("not solved yet: `solve`".into()));
        };
        let (RunData::Plain { lcp, .. }, Geometry::Plain { names, .. }) = (&solved.run, &*prepared.geometry) else {
            return Err(CommandError::Refused(format!("no pair `{variable}`")));
        };
        let done = self.position.map_or(solved.answer.pivots.len(), |step| step + 1);
        let pivots = &solved.answer.pivots[..done.min(solved.answer.pivots.len())];
        let p = self.p().unwrap_or(0.0);
        let vertex = Vertex { lcp, names, solution: &solution, p, pivots };
        let Some((letter, row)) = vertex.find(variable) else {
            let known: Vec<String> =
                ['z', 'w'].iter().flat_map(|l| names.iter().map(move |name| format!("{l}[{name}]"))).collect();
            let said = no_such("variable", variable, known.iter().map(String::as_str));
            return Err(CommandError::Refused(said));
        };
        let why = vertex.why(letter, row);
        io.show(&why, |out, style| {
            style.paragraph(out, Role::Plain, &why.cause)?;
            for line in style.hanging("  ", &style.text(&why.row)) {
                writeln!(out, "{line}")?;
            }
            if why.pivots.is_empty() {
                writeln!(out, "no pivot moved it or its complement")?;
            }
            for pivot in &why.pivots {
                let label = format!("  pivot {}: ", pivot.step);
                for line in style.hanging(&label, &style.text(&pivot.sentence)) {
                    writeln!(out, "{line}")?;
                }
            }
            Ok(())
        })?;
        Ok(())
    }
}
