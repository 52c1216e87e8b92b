//! What is stopped while it works ends with the next question, wherever that is asked.

use std::sync::atomic::{AtomicUsize, Ordering};

use stickslip::model::embedded;
use stickslip::model::quantity::Quantity;
use stickslip::path::envelope::{Axis, envelope};
use stickslip::path::limit::limit;
use stickslip::path::load::{LoadReach, trace};
use stickslip::path::start::PathError;
use stickslip::solve::prepared::prepare;
use stickslip::watch::{Quiet, Watch};

/// Wants to stop from its n-th question on.
struct From {
    first: usize,
    asked: AtomicUsize,
}

impl Watch for From {
    fn stop(&self) -> bool {
        self.asked.fetch_add(1, Ordering::Relaxed) + 1 >= self.first
    }
}

/// Whatever goes over the knots of a path asks at each of them: of the pull from 100 to 250 there are four.
#[test]
fn paths_stop_at_every_question() {
    const KNOTS: usize = 4;
    let scenario = embedded::load("beam").expect("embedded");
    let (values, prepared) = (scenario.parameter_values(), prepare(&scenario, &Quiet).expect("sound"));
    let largest = Quantity::LargestDisplacement;
    let axis = Axis { name: "F2".to_owned(), range: [100.0, 250.0] };
    let run = |command: &str, first: usize| {
        let watch = From { first, asked: AtomicUsize::new(0) };
        let case = prepared.case(&scenario, &values).watched(&watch);
        let ended = match command {
            "trace" => trace(case, None, "F2", LoadReach { to: Some(250.0), through: false }).map(|_| ()),
            _ => envelope(case, std::slice::from_ref(&axis), std::slice::from_ref(&largest)).map(|_| ()),
        };
        (ended, watch.asked.load(Ordering::Relaxed))
    };
    for command in ["trace", "envelope"] {
        let (ended, questions) = run(command, usize::MAX);
        assert!(ended.is_ok() && questions >= KNOTS, "{command}: {questions} questions, {ended:?}");
        for first in 1..=questions {
            let (ended, asked) = run(command, first);
            assert!(matches!(ended, Err(PathError::Interrupted)), "{command}, {first}: {ended:?}");
            assert!(asked >= first, "{command}, {first}: {asked}");
        }
    }
}

/// A path that is asked for after a stop, as that of the next load of a summary, ends before its matrices are made: it has
/// nothing to tell of any progress.
#[test]
fn what_is_asked_for_after_a_stop_does_not_begin() {
    struct Stopped(AtomicUsize);
    impl Watch for Stopped {
        fn progress(&self, _: &str, _: f64) {
            self.0.fetch_add(1, Ordering::Relaxed);
        }
        fn stop(&self) -> bool {
            true
        }
    }
    let scenario = embedded::load("beam").expect("embedded");
    let (values, prepared) = (scenario.parameter_values(), prepare(&scenario, &Quiet).expect("sound"));
    let solved = prepared.case(&scenario, &values).solve().expect("solved");
    let watch = Stopped(AtomicUsize::new(0));
    let case = prepared.case(&scenario, &values).watched(&watch);
    let reach = LoadReach { to: Some(250.0), through: false };
    assert!(matches!(trace(case, Some(&solved), "F2", reach), Err(PathError::Interrupted)));
    assert!(matches!(limit(case, Some(&solved), "F2"), Err(PathError::Interrupted)));
    assert_eq!(watch.0.into_inner(), 0);
}
