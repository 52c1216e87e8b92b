//! A path over a parameter, whatever that moves: loads or friction.

use super::change::Breakpoint;
use super::end::PathEnd;
use super::friction::{self, FrictionPath, is_friction};
use super::load::{self, LoadPath, LoadReach};
use super::start::PathError;
use crate::solve::{Case, Solved};

/// A path in one direction.
#[derive(Clone, Debug)]
pub enum Way {
    Load(Box<LoadPath>),
    Friction(Box<FrictionPath>),
}

impl Way {
    /// Follows the answer over a parameter, or over the factor of a load case, from its present value to `target`.
    ///
    /// # Errors
    /// See [`PathError`].
    pub fn follow(case: Case<'_>, solved: &Solved, name: &str, target: f64) -> Result<Way, PathError> {
        if is_friction(case, name) {
            let path = friction::trace(case, Some(solved), name, target)?;
            return Ok(Way::Friction(Box::new(path)));
        }
        let reach = LoadReach { to: Some(target), through: false };
        Ok(Way::Load(Box::new(load::trace(case, Some(solved), name, reach)?)))
    }

    /// Why it ends.
    pub fn end(&self) -> &PathEnd {
        match self {
            Way::Load(path) => &path.end,
            Way::Friction(path) => &path.end,
        }
    }

    /// The same in a sentence.
    pub fn end_sentence(&self) -> String {
        match self {
            Way::Load(path) => path.end_sentence(),
            Way::Friction(path) => path.end_sentence(),
        }
    }

    /// Where the scheme changes.
    pub fn breakpoints(&self) -> &[Breakpoint] {
        match self {
            Way::Load(path) => &path.breakpoints,
            Way::Friction(path) => &path.breakpoints,
        }
    }

    /// The values between which one scheme holds, in the order of the path.
    pub fn stretches(&self) -> Vec<[f64; 2]> {
        match self {
            Way::Load(path) => path.factors.windows(2).map(|ends| [ends[0], ends[1]]).collect(),
            Way::Friction(path) => path.schemes.iter().map(|scheme| [scheme.from, scheme.to]).collect(),
        }
    }
}
