//! A path over a parameter, whatever that moves: loads or friction; in space on Coulomb's cone.

use super::change::Breakpoint;
use super::end::PathEnd;
use super::friction::{self, FrictionPath, is_friction};
use super::load::{self, LoadPath, LoadReach};
use super::on_cone::{self, ConePath};
use super::start::PathError;
use crate::solve::{Case, Solved};

/// Friction without a target ends here.
pub const FRICTION: f64 = 10.0;

/// A path in one direction.
#[derive(Clone, Debug)]
pub enum Way {
    Load(Box<LoadPath>),
    Friction(Box<FrictionPath>),
    /// In space: in steps.
    OnCone(Box<ConePath>),
}

impl Way {
    /// Follows the answer over a parameter, or over the factor of a load case, from its present value to `target`.
    ///
    /// # Errors
    /// See [`PathError`].
    pub fn follow(case: Case<'_>, solved: &Solved, name: &str, target: f64) -> Result<Way, PathError> {
        Way::reach(case, solved, name, LoadReach { to: Some(target), through: false })
    }

    /// The same as far as it is to reach; friction up to [`FRICTION`] where nothing is said.
    ///
    /// # Errors
    /// See [`PathError`].
    pub fn reach(case: Case<'_>, solved: &Solved, name: &str, reach: LoadReach) -> Result<Way, PathError> {
        let solved = Some(solved);
        let in_space = case.prepared.is_in_space();
        let to = reach.to.unwrap_or(FRICTION);
        Ok(match (is_friction(case, name), in_space) {
            (true, false) => Way::Friction(Box::new(friction::trace(case, solved, name, to)?)),
            (false, false) => Way::Load(Box::new(load::trace(case, solved, name, reach)?)),
            (true, true) => Way::OnCone(Box::new(on_cone::trace_friction(case, solved, name, to)?)),
            (false, true) => Way::OnCone(Box::new(on_cone::trace_load(case, solved, name, reach)?)),
        })
    }

    /// Whether it starts from 0 in place of the answer it was to start from: followed over a load.
    pub fn is_from_zero(&self) -> bool {
        match self {
            Way::Load(path) => path.from_zero,
            Way::Friction(_) => false,
            Way::OnCone(path) => path.from_zero,
        }
    }

    /// Why it ends.
    pub fn end(&self) -> &PathEnd {
        match self {
            Way::Load(path) => &path.end,
            Way::Friction(path) => &path.end,
            Way::OnCone(path) => &path.end,
        }
    }

    /// The same in a sentence.
    pub fn end_sentence(&self) -> String {
        match self {
            Way::Load(path) => path.end_sentence(),
            Way::Friction(path) => path.end_sentence(),
            Way::OnCone(path) => path.end_sentence(),
        }
    }

    /// Where the scheme changes.
    pub fn breakpoints(&self) -> &[Breakpoint] {
        match self {
            Way::Load(path) => &path.breakpoints,
            Way::Friction(path) => &path.breakpoints,
            Way::OnCone(path) => &path.breakpoints,
        }
    }

    /// The values between which one scheme holds, in the order of the path.
    pub fn stretches(&self) -> Vec<[f64; 2]> {
        match self {
            Way::Load(path) => path.factors.windows(2).map(|ends| [ends[0], ends[1]]).collect(),
            Way::Friction(path) => path.schemes.iter().map(|scheme| [scheme.from, scheme.to]).collect(),
            Way::OnCone(path) => path.stretches(),
        }
    }
}
