//! `critical`: the friction above which several answers are possible.

use clap::Args;
use serde::Serialize;

use crate::contact::schemes::critical::Coverage;
use crate::model::uses::Region;
use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session};
use crate::view;

/// Find the friction above which more than one answer is possible
///
/// Exact up to 8 pairs (in space up to 3 on 8 facets, of whose polygon the value is); beyond, a search among drawn working
/// schemes, reported as such.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  load klarbring; critical f")]
pub struct Critical {
    /// The friction parameter
    #[arg(value_name = "PARAMETER")]
    friction: String,
}

pub const CRITICAL: Command = Command { complete: |asked| asked.parameters(), ..Command::of::<Critical>("critical") };

impl Action for Critical {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.critical(&self.friction, io)?;
        Ok(Next::Continue)
    }
}

#[derive(Serialize)]
struct CriticalReport<'a> {
    parameter: &'a str,
    value: Option<f64>,
    scheme: Option<String>,
    exact: bool,
    examined: u64,
    singular: u64,
}

impl Session {
    pub(in crate::session) fn critical(&self, friction: &str, io: &mut Output<'_>) -> Result<(), CommandError> {
        let (values, rules) = (self.now.values.clone(), self.now.rules);
        let name = friction.to_owned();
        if self.now.scenario.uses.place(&name, Region::Geometry).is_some() {
            return Err(CommandError::Refused(format!(
                "{name} stands in the geometry or stiffness: `critical` varies a friction that stands nowhere else"
            )));
        }
        let found = self.ask(io, move |prepared, _, watch| prepared.critical_friction(&values, &name, rules, watch))?;
        let pairs = self.pairs();
        let ids: Vec<&str> = pairs.iter().map(|pair| pair.id.as_str()).collect();
        let report = CriticalReport {
            parameter: friction,
            value: found.value,
            scheme: found.scheme.as_ref().map(|scheme| view::critical::scheme_words(&ids, scheme, found.polygon)),
            exact: found.coverage == Coverage::Exact,
            examined: found.examined,
            singular: found.singular,
        };
        io.show(&report, |out, style| view::critical::write(out, friction, &found, &ids, style))?;
        Ok(())
    }
}
