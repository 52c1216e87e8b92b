//! All working schemes of a small problem, gone through to accompany a solution.

use std::ops::ControlFlow;

use crate::contact::problem::ContactProblem;
use crate::contact::schemes::enumerate::{Enumeration, Progress, enumerate};
use crate::contact::schemes::near::enumerate_to_rounding;
use crate::watch::Watch;

/// Most pairs whose working schemes are all tried.
const MOST_PAIRS: usize = 10;
/// Steps times the cube of the number of joints after which that is given up.
const MOST_STEPS: u64 = 100_000_000;

/// Goes through all working schemes, of rounded data within their rounding; `None` where that takes too many steps or the
/// search was stopped.
pub fn all_answers(problem: &ContactProblem, watch: &dyn Watch) -> Option<Enumeration> {
    in_few_steps(problem, watch, enumerate_to_rounding)
}

/// The same of the data as they are stored: quicker where there is no answer, and no proof of that.
pub fn answers_as_stored(problem: &ContactProblem, watch: &dyn Watch) -> Option<Enumeration> {
    in_few_steps(problem, watch, enumerate)
}

fn in_few_steps(
    problem: &ContactProblem,
    watch: &dyn Watch,
    search: impl Fn(&ContactProblem, &mut dyn FnMut(Progress) -> ControlFlow<()>) -> Enumeration,
) -> Option<Enumeration> {
    let system = &*problem.system;
    let pairs = system.pairs.len();
    if pairs > MOST_PAIRS || system.force_form.is_some() || system.is_in_space() {
        return None;
    }
    let most = MOST_STEPS / (2 * pairs as u64).pow(3).max(1);
    let mut steps = 0;
    let found = search(problem, &mut |_| {
        steps += 1;
        if steps > most || watch.stop() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    found.complete.then_some(found)
}
