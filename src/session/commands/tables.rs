//! `pairs`, `displacements`, `members`, `reactions`: the tables of the answer.

use std::collections::HashMap;
use std::io::{self, Write};

use clap::Args;

use crate::answer::diagram::{Diagram, Internal};
use crate::answer::record::{MemberForces, NodeDisplacement, PairState, PlainSolution, Reaction};
use crate::export::json as json_export;
use crate::model::pair::Pair;
use crate::model::quantity::{Meaning, entry};
use crate::model::scenario::Source;
use crate::session::language::command::{Action, Command};
use crate::session::language::selection::{Rows, displacement_keys, member_keys, no_pair, pair_keys, sort};
use crate::session::{CommandError, Next, Output, Session};
use crate::text::number::short;
use crate::view;
use crate::view::style::{Role, Style};

/// Show state, forces and slip of the contact pairs, at the pivot chosen by `step`
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  pairs\n  pairs c1 c3\n  pairs joint[0..4] sort z_t\n  pairs c* sort reserve top 3")]
pub struct Pairs {
    /// Pairs, ranges A..B and c[A..B] or patterns with `*`; then `sort KEY` and `top N`
    #[arg(value_name = "PAIRS")]
    words: Vec<String>,
}

pub const PAIRS: Command = Command {
    usage: Some("[PAIR…] [sort KEY]"),
    complete: |asked| asked.rows(&asked.names.pairs, &pair_keys(asked.names.dimension)),
    ..Command::of::<Pairs>("pairs")
};

impl Action for Pairs {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.report_pairs(&self.words, io)?;
        Ok(Next::Continue)
    }
}

/// Show the displacements of the nodes, at the pivot chosen by `step`
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  displacements\n  displacements s1 s3..s5\n  displacements s* sort ux top 3")]
pub struct Displacements {
    /// Nodes, ranges A..B or patterns with `*`; then `sort u|ux|uy|rz` and `top N`
    #[arg(value_name = "NODES")]
    words: Vec<String>,
}

pub const DISPLACEMENTS: Command = Command {
    complete: |asked| asked.rows(&asked.names.nodes, &displacement_keys(asked.names.dimension)),
    ..Command::of::<Displacements>("displacements")
};

impl Action for Displacements {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.report_displacements(&self.words, io)?;
        Ok(Next::Continue)
    }
}

/// Show N, Q, M at the ends of the elements of the bars
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  members\n  members AB\n  members b1..b3 sort M top 2")]
pub struct Members {
    /// Bars, ranges A..B or patterns with `*`; then `sort N|Q|M` and `top N`
    #[arg(value_name = "BARS")]
    words: Vec<String>,
}

pub const MEMBERS: Command = Command {
    complete: |asked| asked.rows(&asked.names.bars, &member_keys(asked.names.dimension)),
    ..Command::of::<Members>("members")
};

impl Action for Members {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.report_members(&self.words, io)?;
        Ok(Next::Continue)
    }
}

/// Show the forces of supports and springs on the structure
///
/// One row for each node that is held or sprung, the sum of both where it is both; then the totals. Forces of contact
/// stand under the pairs.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  reactions")]
pub struct Reactions;

pub const REACTIONS: Command = Command::of::<Reactions>("reactions");

impl Action for Reactions {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.report_reactions(io)?;
        Ok(Next::Continue)
    }
}

impl Session {
    /// `pairs [IDS] [sort KEY]`.
    pub(in crate::session) fn report_pairs(&self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        self.need_answer()?;
        if let (Source::Lcp(_), Some(solution)) = (&self.now.scenario.source, self.solution()) {
            return self.report_solution(&solution, io);
        }
        let rows = Rows::read(words, "pairs", &pair_keys(self.now.scenario.source.dimension()))?;
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
        io.show(&chosen, |out, style| {
            self.write_place_shown(out, style)?;
            view::pairs::write(out, &chosen, &self.now.scenario.units, style)
        })?;
        Ok(())
    }

    /// z and w of a bare LCP, in the place of pairs.
    fn report_solution(&self, solution: &PlainSolution, io: &mut Output<'_>) -> Result<(), CommandError> {
        io.show(solution, |out, style| self.write_solution(solution, out, style))?;
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
        let keys = displacement_keys(self.now.scenario.source.dimension());
        let rows = Rows::read(words, "displacements", &keys)?;
        let answer = self.need_quantities()?;
        let all = self.quantity_displacements().ok_or_else(|| self.none("displacements", answer))?;
        let ids: Vec<&str> = all.iter().map(|node| node.node.as_str()).collect();
        let mut chosen: Vec<NodeDisplacement> =
            rows.chosen("node", &ids)?.into_iter().map(|index| all[index].clone()).collect();
        rows.order(&mut chosen, "u", |node, key| match entry(key).map(|entry| entry.meaning) {
            Some(Meaning::Node(which)) => which.of(node).map_or(0.0, f64::abs),
            _ => node.length(),
        });
        io.show(&chosen, |out, style| {
            self.write_place_shown(out, style)?;
            view::displacements::write(out, &chosen, &self.now.scenario.units, style)
        })?;
        Ok(())
    }

    /// `members [BARS] [sort KEY] [top N]`.
    pub(in crate::session) fn report_members(&self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        let keys = member_keys(self.now.scenario.source.dimension());
        let rows = Rows::read(words, "members", &keys)?;
        let answer = self.need_quantities()?;
        let all = answer.members.as_ref().ok_or_else(|| self.none("member forces", answer))?;
        let bars: Vec<&str> = all.iter().map(|member| member.bar.as_str()).collect();
        let mut chosen: Vec<MemberForces> =
            rows.chosen("bar", &bars)?.into_iter().map(|index| all[index].clone()).collect();
        let main = if all.iter().any(|member| member.start.space.is_some()) { "Mz" } else { "M" };
        rows.order(&mut chosen, main, |member, key| {
            let all = Internal::of(member.start.space.is_some());
            let which = all.iter().copied().find(|which| which.symbol() == key);
            let extremes = which.zip(Diagram::of_element(member)).map(|(which, diagram)| diagram.extremes(which));
            extremes.map_or(0.0, |ends| ends.iter().fold(0.0, |size, place| size.max(place.value.abs())))
        });
        io.show(&chosen.iter().map(json_export::member).collect::<Vec<_>>(), |out, style| {
            self.write_history_place(out, style)?;
            // The extremes of a whole bar are given where only that is shown.
            let bar = match rows {
                Rows { names: [bar], top: None, .. } => bars.iter().find(|known| *known == bar).copied(),
                _ => None,
            };
            view::members::write(out, &chosen, bar, &self.now.scenario.units, style)
        })?;
        Ok(())
    }

    /// Σ (m + x × f).
    fn moment_about_origin(&self, reactions: &[Reaction]) -> [f64; 3] {
        let Source::Structure(structure) = &self.now.scenario.source else { return [0.0; 3] };
        let positions: HashMap<&str, [f64; 3]> =
            structure.nodes.iter().map(|node| (node.id.as_str(), node.position)).collect();
        [0, 1, 2].map(|axis| {
            let terms = |reaction: &Reaction| {
                let (x, f) = (positions.get(reaction.node.as_str()).copied().unwrap_or_default(), reaction.force());
                let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
                [reaction.moment()[axis], x[a] * f[b], -x[b] * f[a]]
            };
            crate::answer::rounding::balance(reactions.iter().flat_map(terms))
        })
    }

    pub(in crate::session) fn report_reactions(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let answer = self.need_quantities()?;
        let reactions = answer.reactions.as_ref().ok_or_else(|| self.none("reactions", answer))?;
        io.show(reactions, |out, style| {
            self.write_history_place(out, style)?;
            let moment = self.moment_about_origin(reactions);
            view::reactions::write(out, reactions, moment, &self.now.scenario.units, style)?;
            let on_ground = matches!(&self.now.scenario.source, Source::Structure(structure)
                if structure.pairs.iter().any(Pair::is_on_ground));
            if on_ground {
                style.paragraph(out, Role::Muted, "what contact with the ground carries is not among them: `pairs`")?;
            }
            Ok(())
        })?;
        Ok(())
    }
}
