//! `sensitivity`: derivatives with respect to the parameters.

use clap::Args;

use crate::path::rate::{fixed_place, place_beside_laws};
use crate::path::sensitivity::sensitivity;
use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session};
use crate::view;

/// Show what one more unit of a parameter does to forces and slips
///
/// Within the working scheme. In space it is that on Coulomb's cone, where friction turns with the slip.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  sensitivity\n  sensitivity f")]
pub struct Sensitivity {
    /// Parameter; all of them if none is named
    #[arg(value_name = "NAME")]
    parameter: Option<String>,
}

pub const SENSITIVITY: Command =
    Command { complete: |asked| asked.parameters(), ..Command::of::<Sensitivity>("sensitivity") };

impl Action for Sensitivity {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.sensitivity(self.parameter.as_deref(), io)?;
        Ok(Next::Continue)
    }

    fn needs_pivots(&self) -> bool {
        true
    }

    fn is_of_own_factors(&self, _: &Session) -> bool {
        true
    }
}

impl Session {
    /// `sensitivity [PARAMETER]`.
    pub(in crate::session) fn sensitivity(
        &mut self,
        parameter: Option<&str>,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        if let Some(name) = parameter
            && !self.now.values.contains_key(name)
        {
            return Err(crate::session::language::setting::unknown_parameter(name, &self.now.scenario).into());
        }
        if let Some(name) = parameter
            && let Some(refusal) =
                self.now.scenario.refusal(name, 0.0).or_else(|| fixed_place(&self.now.scenario, name))
        {
            return Err(no_derivatives(name, &refusal));
        }
        let ground = self.ground(io.watch)?;
        let mut found = sensitivity(ground.case(io.watch), &ground.solved)?;
        found.parameters.retain(|rate| parameter.is_none_or(|name| rate.parameter == name));
        if let Some(name) = parameter
            && found.parameters.is_empty()
        {
            let place = place_beside_laws(&self.now.scenario, name).unwrap_or_default();
            return Err(no_derivatives(name, &format!("the loads are not a linear function of it: {place}")));
        }
        io.show(&found, |out, style| {
            self.write_not_of_history("", out, style)?;
            view::sensitivity::write(out, &found, style)
        })?;
        Ok(())
    }
}

fn no_derivatives(name: &str, why: &str) -> CommandError {
    CommandError::Refused(format!("no derivatives with respect to {name}: {why}"))
}
