//! Load paths and limits against closed forms (Example 1 of the paper, the two plates, the slope).

use stickslip::model::embedded;
use stickslip::model::scenario::Scenario;
use stickslip::path::end::PathEnd;
use stickslip::path::limit::limit;
use stickslip::path::load::{LoadPath, LoadReach, trace};
use stickslip::solve::{self, Prepared, Solved, prepare};
use stickslip::watch::Quiet;

struct Case {
    scenario: Scenario,
    prepared: Prepared,
    values: stickslip::model::parameter::ParameterValues,
}

impl Case {
    fn new(name: &str, set: &[(&str, f64)]) -> Case {
        let scenario = embedded::load(name).expect("embedded");
        let mut values = scenario.parameter_values();
        for (name, value) in set {
            values.insert((*name).to_owned(), *value).expect("a parameter");
        }
        Case { prepared: prepare(&scenario, &Quiet).expect("sound"), values, scenario }
    }

    fn case(&self) -> solve::Case<'_> {
        self.prepared.case(&self.scenario, &self.values)
    }

    fn solve(&self) -> Solved {
        self.case().solve().expect("solvable")
    }

    fn trace(&self, name: &str, to: Option<f64>) -> LoadPath {
        let reach = LoadReach { to, through: false };
        let solved = self.solve();
        trace(self.case(), Some(&solved), name, reach).expect("a path")
    }

    fn limit(&self, name: &str) -> stickslip::path::limit::Limit {
        let solved = self.solve();
        limit(self.case(), Some(&solved), name).expect("a path")
    }
}

fn close(found: f64, expected: f64, relative: f64) {
    assert!((found - expected).abs() <= relative * expected.abs(), "{found} is not {expected} within {relative:e}");
}

/// ```text
///   F   F   F   F   F   F
///   ●───●───●───●───●───● → F2      slip spreads from the pulled end: at F2 = k r the k-th support slips, r = f F
///   △   △   △   △   △   △
/// ```
#[test]
fn the_beam_slips_support_by_support_and_then_as_a_whole() {
    let case = Case::new("beam", &[("F2", 0.0)]);
    let path = case.trace("pull", None);
    let r = 50.0;
    assert_eq!(path.breakpoints.len(), 6);
    for (k, breakpoint) in path.breakpoints.iter().enumerate() {
        close(breakpoint.value, (k + 1) as f64 * r, 1e-12);
        assert_eq!(breakpoint.changes.len(), 1, "{breakpoint:?}");
        assert_eq!(breakpoint.changes[0].pair, format!("c{}", 6 - k));
        assert_eq!(breakpoint.changes[0].to, "slip+");
    }
    assert!(matches!(path.end, PathEnd::Limit(_)), "{:?}", path.end);
    // Between the breakpoints: z_j = (L/EA) [(n − j + 1) ρ + r (n − j)(n − j + 1)/2].
    let pairs = path.pairs_at(&case.prepared, 2.5 * r).expect("on the path");
    for (j, factor) in [(1usize, 2.0 * 0.5 + 1.0), (2, 0.5), (3, 0.0)] {
        assert!((pairs[6 - j].z_t - 1e-5 * r * factor).abs() <= 1e-12 * 1e-5 * r);
    }
    // The parameter is another name of the same factor; the limit does not depend on where the path starts.
    for start in [0.0, 100.0, 250.0] {
        let limit = Case::new("beam", &[("F2", start)]).limit("F2");
        close(limit.factor.expect("a limit"), 6.0 * r, 1e-12);
        assert!(limit.confirmed);
        let collapse = limit.collapse().expect("a mode");
        assert!(collapse.direction.pairs().iter().all(|d| (d.z_t.scalar() - 1.0).abs() < 1e-9 && d.z_n == 0.0));
    }
    // Beyond the limit there is no answer: the path starts from 0 and the safety is below 1.
    let limit = Case::new("beam", &[("F2", 400.0)]).limit("pull");
    assert!(limit.path.expect("a path").from_zero);
    close(limit.safety.expect("a limit"), 0.75, 1e-12);
}

#[test]
fn more_weight_on_a_sliding_beam_ends_nowhere() {
    let case = Case::new("beam", &[]);
    let path = case.trace("weight", None);
    assert_eq!(path.end, PathEnd::Unbounded);
    // F2 = 250 slips n = ⌊250 / (0.5 F)⌋ supports: the last breakpoint, to none, at F = 500.
    close(path.breakpoints.last().expect("some").value, 500.0, 1e-12);
    // Less weight instead: the limit from the other side, 6 f F = 250.
    let path = case.trace("F", Some(10.0));
    assert!(matches!(path.end, PathEnd::Limit(_)));
    close(*path.factors.last().expect("knots"), 250.0 / 3.0, 1e-12);
}

#[test]
fn everything_from_zero_load_at_once() {
    // No weight and no pull: every pair is degenerate at the start.
    let case = Case::new("beam", &[("F", 0.0), ("F2", 0.0)]);
    let path = case.trace("F", None);
    assert_eq!(path.end, PathEnd::Unbounded);
    assert!(path.breakpoints.is_empty(), "{:?}", path.breakpoints);
    let path = case.trace("F2", None);
    assert!(matches!(path.end, PathEnd::Limit(_)), "{:?}", path.end);
    assert_eq!(path.limit(), Some(0.0));
}

/// Two plates 8 × 4, the upper one free on the lower one: it slides at T = 200 f and overturns at T = 400.
#[test]
fn plates_slide_and_overturn_at_their_limits() {
    for (f, expected) in [(0.3, 60.0), (0.75, 150.0), (2.5, 400.0)] {
        let case = Case::new("plates-free", &[("f", f), ("q", 100.0), ("T", 0.0)]);
        let limit = case.limit("push");
        close(limit.factor.expect("a limit"), expected, 1e-9);
        assert!(limit.confirmed, "f = {f}");
        let collapse = limit.collapse().expect("a mode");
        assert_eq!(collapse.class, stickslip::answer::record::RayClass::Mechanism);
        let opens = collapse.direction.pairs().iter().any(|d| d.z_n > 1e-9);
        assert_eq!(opens, expected == 400.0, "{}", collapse.mode);
    }
}

/// NAFEMS CGS-4: F/G = (tan α + μ)/(1 − μ tan α) moves the block up, (tan α − μ)/(1 + μ tan α) down.
#[test]
fn a_slope_is_climbed_and_descended() {
    let (tan, mu) = (0.1, 0.3);
    let case = Case::new("slope", &[("F", 0.0)]);
    let up = case.trace("push", None);
    close(up.limit().expect("a limit"), (tan + mu) / (1.0 - mu * tan), 1e-9);
    let down = case.trace("push", Some(-1.0));
    close(down.limit().expect("a limit"), (tan - mu) / (1.0 + mu * tan), 1e-9);
}

/// The state on a path is the state solved for there, where there is only one.
#[test]
fn the_path_passes_through_the_answers_of_its_loads() {
    for (name, load, factors) in [
        ("plates-free", "T", vec![30.0, 75.0, 110.0, 140.0, 149.0]),
        ("plates-hinged", "V", vec![20.0, 45.0, 60.0, 80.0]),
        ("frame-rotated", "H", vec![-20.0, 10.0, 45.0]),
        ("block", "H", vec![0.05, 0.15, 0.24]),
    ] {
        let mut case = Case::new(name, &[(load, 0.0)]);
        if name == "plates-free" {
            case.values.insert("f".to_owned(), 0.75).expect("a parameter");
        }
        for factor in factors {
            case.values.insert(load.to_owned(), 0.0).expect("a parameter");
            let path = case.trace(load, Some(factor));
            assert_eq!(path.end, PathEnd::Target, "{name} {factor}");
            let found = path.pairs.last().expect("the end");
            case.values.insert(load.to_owned(), factor).expect("a parameter");
            let solved = case.solve();
            let size = |k: fn(&stickslip::answer::record::PairState) -> f64| {
                solved.answer.pairs.iter().map(|p| k(p).abs()).fold(0.0, f64::max)
            };
            let (force, length) = (size(|p| p.x_n), size(|p| p.z_t).max(size(|p| p.z_n)));
            for (a, b) in found.iter().zip(&solved.answer.pairs) {
                assert!((a.x_n - b.x_n).abs() <= 1e-9 * force, "{name} {factor} {a:?} {b:?}");
                assert!((a.x_t - b.x_t).abs() <= 1e-9 * force, "{name} {factor} {a:?} {b:?}");
                assert!((a.z_t - b.z_t).abs() <= 1e-9 * length, "{name} {factor} {a:?} {b:?}");
                assert_eq!(a.state, b.state, "{name} {factor} {}", a.id);
            }
        }
    }
}

/// A warm answer has no pivots of its own: its scheme is read from its vertex.
#[test]
fn a_warm_answer_can_be_followed_and_differentiated() {
    let mut case = Case::new("plates-free", &[("f", 0.75), ("q", 100.0), ("T", 60.0)]);
    let before = case.solve();
    case.values.insert("T".to_owned(), 110.0).expect("a parameter");
    let rules = case.scenario.rules;
    let warm = case.case().under(rules).follow(&before).expect("a way");
    let cold = case.solve();
    let basis = stickslip::path::start::final_basis(&warm).expect("a scheme");
    assert!(!basis.z.is_empty());
    let rates = |solved: &Solved| stickslip::path::sensitivity::sensitivity(case.case(), solved).expect("an answer");
    let (a, b) = (rates(&warm), rates(&cold));
    for (a, b) in a.parameters.iter().zip(&b.parameters) {
        let size = b.pairs.iter().map(|pair| pair.z_t.abs()).fold(0.0, f64::max);
        for (a, b) in a.pairs.iter().zip(&b.pairs) {
            assert!((a.z_t - b.z_t).abs() <= 1e-8 * size, "{a:?} {b:?}");
        }
    }
    let reach = LoadReach { to: None, through: false };
    let path = trace(case.case(), Some(&warm), "push", reach).expect("a path");
    close(path.limit().expect("a limit"), 150.0, 1e-9);
}
