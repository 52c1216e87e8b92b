//! The guided tours: a beam, a pipe, a dam, LCPs that fail. The first command of each loads its scenario.

mod beam;
mod dam;
mod lcp;
mod pipe;

use super::app::State;
use super::bindings::Context;
use super::pane::{Pane, Plot};
use crate::session::commands::screen::Tour;

/// One step.
pub struct Step {
    /// What is to be seen.
    pub text: &'static str,
    /// The commands that lead there.
    pub commands: &'static str,
    /// The pane to look at.
    pub pane: Pane,
    /// The plot to look at.
    pub plot: Plot,
}

/// The steps of a tour. The first loads its scenario; the others set all that matters, so that what the user varied in
/// between does no harm.
pub fn steps(tour: Tour) -> &'static [Step] {
    match tour {
        Tour::Beam => beam::STEPS,
        Tour::Pipe => pipe::STEPS,
        Tour::Dam => dam::STEPS,
        Tour::Lcp => lcp::STEPS,
    }
}

/// The text of a step with its keys, in lines of `width` columns; the keys are the first `usize` bytes.
pub fn lines(state: &State, (tour, at): (Tour, usize), width: usize) -> Option<(Vec<String>, usize)> {
    let step = steps(tour).get(at)?;
    let look = state.look;
    let keys = state.keys.rows(Context::Tour, look.ascii);
    let key = |name: &str| keys.iter().find(|(_, binding)| binding.name == name).map_or("", |(keys, _)| keys);
    let head = format!(
        "Tour {} of {} ({} on, {} back, {} ends):",
        at + 1,
        steps(tour).len(),
        key("tour-next"),
        key("tour-back"),
        key("tour-end")
    );
    let head = look.text(&head);
    let lines = look.report(width).wrap(&format!("{head} {}", step.text), width);
    Some((lines, head.len()))
}
